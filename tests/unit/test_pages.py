"""The generated pages are current: scenarios/README.md and outputs/gallery/README.md; their scripts run as typed."""

import ast
import json
import re
from pathlib import Path

import pytest
from benchmark import gallery, key_reference, typed_settings

from sealdyn.scenario.tables import RadialFile
from sealdyn.studies._declared import json_schema


@pytest.mark.parametrize("made", [gallery, key_reference, typed_settings], ids=lambda made: made.__name__)
def test_page_is_what_its_script_writes(made):
    """`python tests/benchmark/NAME.py` writes it."""
    assert made.PAGE.read_text() == made.page()


def test_page_of_studies_is_what_its_script_writes():
    assert key_reference.STUDIES.read_text() == key_reference.studies()


def test_gallery_shows_every_picture_and_fills_every_table():
    page = gallery.page()
    assert set(re.findall(r"!\[.*?\]\((.*?)\)", page)) == {path.name for path in gallery.GALLERY.glob("*.png")}
    assert "{{" not in page


@pytest.mark.core
def test_every_shipped_scenario_is_charted():
    """Speed against accuracy, by the script that takes what is shipped."""
    folder = gallery.GALLERY.parents[1] / "scenarios"
    shipped = {path.stem for pattern in ("*.toml", "radial/*.toml") for path in folder.glob(pattern)}
    scenes = json.loads((gallery.GALLERY / "work_precision_all.json").read_text())["scenes"]
    assert {scene["name"] for scene in scenes} == shipped


def test_every_key_has_a_meaning():
    schema, radial = json_schema(), json_schema(RadialFile)
    for table in (schema, radial, *schema["$defs"].values(), *radial["$defs"].values()):
        for key, holds in table["properties"].items():
            meaning = holds.get("description", "").splitlines()[:1]
            assert meaning and not re.match("an? .* in ", meaning[0]), key


TESTS = Path(__file__).parents[1]


@pytest.mark.parametrize("script", sorted((TESTS / "benchmark").glob("*.py")), ids=lambda script: script.stem)
def test_a_script_finds_what_it_shares_with_the_tests(script):
    """Python looks beside the script alone."""
    imports = [node for node in ast.walk(ast.parse(script.read_text())) if isinstance(node, ast.ImportFrom)]
    shared = [node.module for node in imports if (TESTS / f"{(node.module or '').split('.')[0]}.py").exists()]
    assert not shared or "sys.path.insert(0, str(Path(__file__).parents[1]))" in script.read_text()
