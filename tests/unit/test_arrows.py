"""The house: who may import whom, and which library is imported where."""

import ast
import pkgutil
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "sealdyn"

# Rooms, lowest first: a room may import only rooms of the lines above its own.
ORDER = (
    ("extensions", "status", "quantities"),
    ("kernel_cache",),
    ("answers",),
    ("numerics", "closed_form", "archive", "unit_names"),
    ("units", "solvers", "report"),
    ("scene",),
    ("faces",),
    ("films",),
    ("dynamics",),
    ("scenario",),
    ("radial_seals",),
    ("simulation",),
    ("analysis",),
    ("studies",),
    ("terminal",),
    ("cli",),
    ("__init__",),
)
# Files of the package, lines of a file but of the one named, lines of all that draws, charts of studies of their own,
# lines in which a name that is data asks for an attribute, in the rooms of physics and answers.
MOST_FILES, MOST_LINES, LONGER, MOST_DRAWN, MOST_CHARTS, MOST_ASKED = 250, 450, {"cli.py": 700}, 3500, 4, 15
ASKED_IN = ("films", "studies", "simulation", "dynamics")
# Most bytes of a page.
PAGES = {"README.md": 12, "scenarios/README.md": 60, "outputs/gallery/README.md": 25}
FLOOR = {room: floor for floor, rooms in enumerate(ORDER) for room in rooms}
MOST_ROOMS = 25
# Libraries, and the only folders or files that import them.
ONLY_IN = {
    "sksundae": ("solvers", "studies/failures/cases"),
    "h5py": ("archive",),
    "tomllib": ("scenario",),
    "tomlkit": ("answers.py",),
    "pint": ("unit_names.py",),
    "matplotlib": ("report/charts", "report/panels.py"),
    "typer": ("cli.py",),
    "rich": ("cli.py", "terminal.py"),
}


def room(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


def imports(path: Path):
    """(module, names) of every import in a file, relative ones resolved to the package."""
    inside = path.relative_to(PACKAGE).parts[:-1]
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from ((alias.name, ()) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                base = ["sealdyn", *inside][: len(inside) + 2 - node.level]
                yield ".".join([*base, *([node.module] if node.module else [])]), [a.name for a in node.names]
            else:
                yield node.module, [a.name for a in node.names]


def rooms_imported(path: Path):
    for module, names in imports(path):
        parts = module.split(".")
        if parts[0] == "sealdyn":
            yield from (name for name in (names if len(parts) == 1 else [parts[1]]) if name != "__version__")


FILES = sorted(PACKAGE.rglob("*.py"))


@pytest.mark.core
def test_rooms_are_few_and_known():
    rooms = {room(path) for path in FILES}
    assert rooms == set(FLOOR)
    assert len(rooms) <= MOST_ROOMS


def test_the_house_is_as_small_as_it_is_said_to_be():
    """Bounds that grow back, one finding at a time, where nothing holds them."""
    lines = {path.relative_to(PACKAGE).as_posix(): len(path.read_text().splitlines()) for path in FILES}
    assert len(lines) <= MOST_FILES
    assert {name: n for name, n in lines.items() if n > LONGER.get(name, MOST_LINES)} == {}
    charts = {name: n for name, n in lines.items() if name.startswith(("report/charts/", "report/panels.py"))}
    assert sum(charts.values()) <= MOST_DRAWN and sum("/study_" in name for name in charts) <= MOST_CHARTS
    asked = [
        f"{path.relative_to(PACKAGE)}: {line.strip()}"
        for path in FILES
        if room(path) in ASKED_IN
        for line in path.read_text().splitlines()
        if re.search(r"\b(has|get)attr\(", line)
    ]
    assert len(asked) <= MOST_ASKED, asked
    for page, most in PAGES.items():
        assert (PACKAGE.parent / page).stat().st_size <= 1024 * most, page


def test_arrows_point_one_way():
    for path in FILES:
        here = room(path)
        upward = {other for other in rooms_imported(path) if other != here and FLOOR[other] >= FLOOR[here]}
        assert not upward, f"{path}: {here} must not import {sorted(upward)}"


@pytest.mark.core
def test_files_stand_in_no_circle():
    """No file imports itself by way of others, imports inside of functions counted."""
    named = (".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts) for path in FILES)
    modules = {name.removesuffix(".__init__"): path for name, path in zip(named, FILES, strict=True)}
    ahead = {}
    for name, path in modules.items():
        asked = {
            f"{module}.{one}" if f"{module}.{one}" in modules else module
            for module, names in imports(path)
            for one in names or [""]
        }
        # The version stands in the package itself.
        ahead[name] = (asked & set(modules)) - {name, "sealdyn"}
    # What is left after files that import nothing more have been taken away again and again, from both ends.
    while ends := [name for name in ahead if not ahead[name] or not any(name in others for others in ahead.values())]:
        ahead = {name: others - set(ends) for name, others in ahead.items() if name not in ends}
    assert not ahead, sorted(ahead)


def test_each_outside_library_has_one_room():
    for path in FILES:
        place = path.relative_to(PACKAGE).as_posix()
        for module, _ in imports(path):
            allowed = ONLY_IN.get(module.split(".")[0])
            assert allowed is None or place.startswith(allowed), f"{module} is imported in {place}"


def test_text_is_read_once():
    """Scenes are handed on, not text: whoever parses it stands at the door."""
    for path in FILES:
        at_the_door = room(path) in ("scenario", "cli")
        assert at_the_door or "parse_scenario" not in path.read_text(), path


def test_no_film_imports_another():
    """What films share stands in files that begin with an underscore."""
    for path in (PACKAGE / "films").rglob("*.py"):
        own = path.relative_to(PACKAGE / "films").parts[0].removesuffix(".py")
        others = {
            name.split(".")[0]
            for module, names in imports(path)
            if module.startswith("sealdyn.films")
            for name in ([module.removeprefix("sealdyn.films.")] if module != "sealdyn.films" else names)
        }
        films = {p.name.removesuffix(".py") for p in (PACKAGE / "films").iterdir() if p.name[0] != "_"}
        assert not (others & films - {own}), path


def test_kernels_are_module_level():
    """A compiled kernel inside a function would be compiled anew in every process."""
    for path in FILES:
        for outer in ast.walk(ast.parse(path.read_text())):
            if isinstance(outer, ast.FunctionDef):
                for inner in ast.walk(outer):
                    if inner is not outer and isinstance(inner, ast.FunctionDef):
                        assert "njit" not in ast.dump(ast.Module(inner.decorator_list, [])), f"{path}: {inner.name}"


TESTS = Path(__file__).parents[1]
# What stands in a string, where no linter looks: imports of a program that a test runs, and what a patch replaces.
IMPORTED = re.compile(r"^\s*from (sealdyn[\w.]*) import \(?([\w, ]+)", re.M)
NAMED = re.compile(r"sealdyn(?:\.\w+)+")
# Made by the tests or the build.
MADE = {"sealdyn.scenarios", "sealdyn.films.fed_film.FILM"}


def named_in_strings(path: Path):
    """Dotted names of the package in the strings of a file, but those that a format completes."""
    tree = ast.parse(path.read_text())
    parts = {id(part) for node in ast.walk(tree) if isinstance(node, ast.JoinedStr) for part in node.values}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in parts:
            yield from (
                f"{module}.{name.split()[0]}" for module, names in IMPORTED.findall(node.value)
                for name in names.strip(", ").split(",")
            )  # fmt: skip
            yield from [node.value] if NAMED.fullmatch(node.value) else []


def test_what_strings_of_tests_name_is_there():
    found = {name: path.name for path in sorted(TESTS.rglob("*.py")) for name in named_in_strings(path)}
    gone = []
    for name in found.keys() - MADE:
        try:
            pkgutil.resolve_name(name)
        except (ImportError, AttributeError):
            gone.append((found[name], name))
    assert len(found) > 30 and gone == []
