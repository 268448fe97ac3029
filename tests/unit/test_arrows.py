"""The house: who may import whom, and which library is imported where."""

import ast
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "sealdyn"

# Room -> rooms it may import.  A folder is one room unless a file of it is named.
DOORS = {"units", "unit_names"}
PHYSICS = {"gap", "films", "legs", "imposed", "dynamics", "motion", "ring", "scene", "equilibrium", "closed_form",
           "contact", "secondary_seal"}  # fmt: skip
ALLOWED = {
    "units": {"unit_names"},
    "unit_names": set(),
    "gap": set(),
    "kernel_cache": set(),
    "asperities": set(),
    "annulus": {"asperities"},
    "contact": DOORS | {"annulus", "asperities", "gap"},
    "secondary_seal": DOORS,
    "dense": set(),
    "archive": set(),
    "audit": {"dense"},
    "batch": {"contact", "dynamics", "gap"},
    "step_error": {"dense"},
    "recorder": set(),
    "report": set(),
    "closed_form": set(),
    "methods": set(),
    "solve": {"dense", "audit", "methods"},
    "motion": DOORS,
    "ring": DOORS | {"secondary_seal"},
    "films": DOORS | {"gap", "closed_form"},
    "legs": DOORS,
    "imposed": {"legs"},
    "dynamics": {"contact", "gap", "imposed", "secondary_seal"},
    "watch": {"gap", "dense", "dynamics"},
    "design_rules": {"layout", "legs"},
    "ludwig": PHYSICS | {"methods", "solve"},
    "ludwig_released": PHYSICS | DOORS | {"ludwig", "problem", "recorder", "signals", "solve"},
    "lyapunov": set(),
    "methods_judged": {"methods"},
    "collocation": {"methods"},
    "observables": {"methods", "recorder", "signals", "solve", "watch"},
    "model_rungs": {"collocation", "faces", "films", "methods", "modes", "observables", "scenario", "simulation"},
    "who_is_fastest": set(),
    "exhibits": PHYSICS
    | DOORS
    | {
        "methods",
        "methods_judged",
        "modes",
        "orbit",
        "problem",
        "recorder",
        "scenario",
        "signals",
        "simulation",
        "solve",
    }
    | {"validation", "whirl"},
    "attractor": set(),
    "stroboscope": {"methods", "problem", "recorder", "scene", "signals", "solve"},
    "continuation": DOORS
    | {"attractor", "faces", "lyapunov", "problem", "recorder", "scenario", "scene", "solve", "stroboscope"},
    "ramps": PHYSICS
    | DOORS
    | {"continuation", "modes", "observables", "problem", "scenario", "simulation", "solve", "watch", "whirl"},
    "wear": set(),
    "worn_runs": PHYSICS | {"continuation", "problem", "recorder", "signals", "solve", "touches", "watch", "wear"},
    "invariants": {"attractor", "contact", "continuation", "lyapunov", "scenario", "stroboscope"},
    "touches": {"gap", "dense", "watch"},
    "sticking": {"dense", "dynamics", "imposed", "layout"},
    "modes": {"gap"},
    "scene": DOORS | {"contact", "films", "motion", "ring"},
    "equilibrium": DOORS | {"films", "legs", "scene"},
    "layout": DOORS | {"dynamics", "imposed", "legs"},
    "signals": {"batch", "contact", "dynamics", "gap", "layout", "legs"},
    "faces": PHYSICS | {"modes"},
    "linear_side": PHYSICS | {"faces", "modes"},
    "problem": PHYSICS | DOORS | {"batch", "faces", "layout", "linear_side", "modes", "sticking", "touches", "watch"},
    "scenario": PHYSICS | DOORS | {"scenario"},
    "summary": PHYSICS | DOORS | {"layout", "modes", "scenario", "watch"},
    "model_error": PHYSICS | {"batch", "faces"},
    "film_choice": {"model_error", "problem"},
    "certify": {"audit", "methods", "model_error", "problem", "recorder", "solve", "step_error", "touches", "watch"},
    "simulation": {"certify", "film_choice", "methods"}
    | PHYSICS
    | DOORS
    | {"archive", "audit", "layout", "problem", "scenario", "signals", "solve", "summary"},
    "validation": PHYSICS | {"modes", "problem", "recorder", "solve"},
    "charts": {"archive"},
    "pool": set(),
    "investigate": {"archive", "pool", "scenario", "studies"},
    "studies": PHYSICS
    | DOORS
    | {"audit", "layout", "methods", "modes", "orbit", "problem", "recorder", "scenario", "signals", "simulation"}
    | {"solve", "stability_map", "summary", "twin", "validation", "watch", "whirl"}
    | {"attractor", "collocation", "continuation", "exhibits", "faces", "invariants", "ludwig", "ludwig_released"}
    | {"ramps", "wear", "worn_runs", "lyapunov", "methods_judged", "model_rungs", "observables", "who_is_fastest"},
    "twin": PHYSICS | DOORS | {"modes", "problem"},
    "stability_map": PHYSICS | DOORS | {"modes", "problem", "scenario", "twin"},
    "whirl": PHYSICS | DOORS | {"methods", "modes", "problem", "recorder", "solve", "stroboscope", "watch"},
    "orbit": PHYSICS | DOORS | {"layout", "methods", "modes", "problem", "recorder", "solve", "watch"},
    "cli": None,
    "__init__": None,
}
ONLY_IN = {"sksundae": {"methods", "exhibits"}, "h5py": {"archive"}, "tomllib": {"scenario"},
           "pint": {"unit_names"}, "matplotlib": {"charts"}, "typer": {"cli"}, "rich": {"cli"}}  # fmt: skip


def room(path: Path) -> str:
    parts = path.relative_to(PACKAGE).parts
    name = parts[0].removesuffix(".py")
    return "scenario" if name.startswith("scenario") else name


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
        if parts[0] != "sealdyn":
            continue
        for target in names if len(parts) == 1 else [parts[1]]:
            if target != "__version__":
                yield "scenario" if target.startswith("scenario") else target


FILES = sorted(PACKAGE.rglob("*.py"))


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_arrows_point_one_way(path):
    here = room(path)
    assert here in ALLOWED, f"a new room {here!r}: say in this test what it may import"
    if ALLOWED[here] is None:
        return
    wrong = {r for r in rooms_imported(path) if r != here and r not in ALLOWED[here]}
    assert not wrong, f"{here} must not import {sorted(wrong)}"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_each_outside_library_has_one_room(path):
    for module, _ in imports(path):
        library = module.split(".")[0]
        if library in ONLY_IN:
            assert room(path) in ONLY_IN[library], f"{library} is imported in {room(path)}"


def test_no_film_imports_another():
    for path in (PACKAGE / "films").glob("*.py"):
        others = {
            name
            for module, names in imports(path)
            if module.startswith("sealdyn.films")
            for name in [*module.split(".")[2:3], *names]
        }
        films = {p.stem for p in (PACKAGE / "films").glob("*.py") if not p.stem.startswith("_")}
        assert not (others & films), path


def test_kernels_are_module_level():
    """A compiled kernel inside a function would be compiled anew in every process."""
    for path in FILES:
        for outer in ast.walk(ast.parse(path.read_text())):
            if isinstance(outer, ast.FunctionDef):
                for inner in ast.walk(outer):
                    if inner is not outer and isinstance(inner, ast.FunctionDef):
                        assert "njit" not in ast.dump(ast.Module(inner.decorator_list, [])), f"{path}: {inner.name}"
