"""Archives of runs and studies with bytes changed, and such as nobody but HDF5 could have written."""

import importlib
import json
import os
import random
import shutil
import signal
import time
from pathlib import Path

import h5py
import numpy as np

from sealdyn.archive import open_archive, partial_path
from sealdyn.scenario.reader import read_scenario
from sealdyn.simulation.simulate import simulate
from sealdyn.studies._runner import run_study

from .outcome import command, judged, read_in_forks, tried

SEAL = Path(__file__).parents[3] / "scenarios" / "fms_reference.toml"
SHORT = ("run.turns=4", "run.samples_per_turn=16")
LONGER = ("run.turns=4000",)
# Longest wait (s) for the first of each kind, whose kernels may have to be compiled.
COMPILING = 300
# Uses of each archive, drawn of all there are.
DRAWN = 5
# Of one archive in so many what is read apart is read in a process of its own, as the program does.
APART = 20
# What the verbs load: once, and not in every fork that is one.
LOADED = (
    "sealdyn.cli", "sealdyn.analysis.desk", "sealdyn.report.review", "sealdyn.report.comparison", "rich.progress",
    "sealdyn.report.charts.overview", "sealdyn.report.charts.orbit", "sealdyn.report.panels", "matplotlib.figure",
    "matplotlib.backends.backend_agg", "sealdyn.studies.equilibrium",
)  # fmt: skip


def made(folder: Path) -> dict[str, Path]:
    """Whole archives to begin with: of a run, of one that was broken off, of a study."""
    run, broken, study = (folder / f"{name}.h5" for name in ("run", "broken", "study"))
    scenario = read_scenario(SEAL, SHORT)
    simulate(scenario, run)
    broken_off(broken)
    run_study("steady_state", scenario, study, workers=1)
    return {"run": run, "broken": partial_path(broken), "study": study}


def broken_off(out: Path) -> None:
    """Leave what a killed run leaves."""
    child = os.fork()
    if child == 0:
        simulate(read_scenario(SEAL, LONGER), out)
        os._exit(0)
    while not partial_path(out).exists():
        time.sleep(0.01)
    time.sleep(0.1)
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)


def corrupted(chance, path: Path) -> None:
    """Some bytes changed, or a part lost."""
    data = bytearray(path.read_bytes())
    for _ in range(chance.choice((1, 1, 3, 30))):
        # The bookkeeping is at the front.
        at = int(len(data) * chance.random() ** chance.choice((1, 3)))
        way = chance.random()
        if way < 0.5:
            data[at] = chance.randrange(256)
        elif way < 0.65:
            data[at : at + 8] = chance.choice((b"\xff" * 8, b"\0" * 8, (1 << 40).to_bytes(8, "little")))
        elif way < 0.75:
            del data[at:]
        elif way < 0.85:
            length = chance.randrange(1, 4096)
            data[at : at + length] = bytes(length)
        elif way < 0.95:
            del data[at : at + chance.randrange(1, 64)]
        else:
            data[at:at] = chance.randbytes(chance.randrange(1, 64))
        data = data or bytearray(b"\0")
        at = min(at, len(data) - 1)
    path.write_bytes(bytes(data))


def crafted(chance, path: Path, elsewhere: Path) -> str:
    """Something in it that the program never writes; what."""
    with h5py.File(path, "r+") as file:
        names = []
        file.visit(names.append)
        name = chance.choice(names)
        way = chance.choice(WAYS)
        try:
            way(chance, file, name, elsewhere)
        except (LookupError, ValueError, TypeError, OSError, RuntimeError, AttributeError):
            # What HDF5 will not write nobody has to read.
            return "nothing"
    return way.__name__


def link_out(chance, file, name, elsewhere):
    del file[name]
    file[name] = h5py.ExternalLink(str(elsewhere), chance.choice(("/time", "/", "/events", "/nothing")))


def link_around(chance, file, name, elsewhere):
    del file[name]
    file[name] = chance.choice((h5py.SoftLink("/time"), h5py.SoftLink(f"/{name}"), h5py.SoftLink("/")))


def circle(chance, file, name, elsewhere):
    file.create_group("circle")["again"] = file["/"]


def virtual(chance, file, name, elsewhere):
    shape = file[name].shape
    del file[name]
    layout = h5py.VirtualLayout(shape, "<f8")
    layout[...] = h5py.VirtualSource(str(elsewhere), "time", shape)
    file.create_virtual_dataset(name, layout)


def external(chance, file, name, elsewhere):
    shape = file[name].shape
    del file[name]
    file.create_dataset(name, shape, "<f8", external=[(str(elsewhere), 0, h5py.h5f.UNLIMITED)])


def other_type(chance, file, name, elsewhere):
    shape = file[name].shape
    del file[name]
    kinds = ("i1", "<f4", "S7", "c16", h5py.string_dtype(), h5py.ref_dtype, h5py.vlen_dtype("f8"), [("a", "f8")], "V5")
    file.create_dataset(name, shape, chance.choice(kinds))


def other_shape(chance, file, name, elsewhere):
    del file[name]
    shapes = ((), (0,), (1,), (3, 3), (10**15,), (7, 10**12), (64,), (2, 16384))
    file.create_dataset(name, chance.choice(shapes), chance.choice(("<f8", "u1")), chunks=None)


def empty(chance, file, name, elsewhere):
    del file[name]
    file.create_dataset(name, data=h5py.Empty("f8"))


def packed(chance, file, name, elsewhere):
    data = file[name][()]
    del file[name]
    file.create_dataset(name, data=data, compression="gzip")


def nothing_there(chance, file, name, elsewhere):
    del file[name]


def a_group(chance, file, name, elsewhere):
    del file[name]
    file.create_group(name)


def numbers(chance, file, name, elsewhere):
    values = file[name][...]
    values.flat[chance.randrange(values.size)] = chance.choice((np.nan, np.inf, 1e308, -1e308, 0.0))
    file[name][...] = values


def attribute(chance, file, name, elsewhere):
    item = file[chance.choice(("/", "/", name))]
    key = chance.choice(sorted(item.attrs))
    way = chance.random()
    if way < 0.2:
        del item.attrs[key]
        return
    others = (
        0, -1, 10**15, 1e308, np.nan, "", "x", "[]", "{}", '{"array": 3}', "[[[[", "\u0000", "x" * 60_000, [1, 2],
        b"\xff", h5py.Empty("f8"), np.zeros(100), True, "null", '{"state": null}', np.array(["a", "b"], "S1"), 1j,
    )  # fmt: skip
    value = chance.choice(others)
    if way < 0.6 and isinstance(item.attrs[key], str):
        value = altered(chance, item.attrs[key])
    # A seal may be taken off.
    if chance.random() < 0.7 and "seal" in file.attrs:
        del file.attrs["seal"]
    item.attrs[key] = value


def text(chance, file, name, elsewhere):
    """Of a study."""
    name = chance.choice(("answer", "resolved", "scenario"))
    found = altered(chance, file[name].asstr()[()])
    if chance.random() < 0.7 and "seal" in file.attrs:
        del file.attrs["seal"]
    del file[name]
    file.create_dataset(name, data=found, dtype=h5py.string_dtype())


def altered(chance, words: str) -> str:
    """JSON with something else at one of its places, or text with something else in it."""
    try:
        tree = json.loads(words)
    except ValueError:
        at = chance.randrange(max(1, len(words)))
        return words[:at] + chance.choice(("[", "\n", "0", "é", "=")) + words[at + 1 :]
    where, key, at = None, None, tree
    while isinstance(at, dict | list) and at and (where is None or chance.random() < 0.85):
        key = chance.choice(sorted(at)) if isinstance(at, dict) else chance.randrange(len(at))
        where, at = at, at[key]
    if where is None or chance.random() < 0.1:
        return chance.choice(("{}", "[]", "null", "3", '"x"'))
    if isinstance(where, dict) and chance.random() < 0.3:
        del where[key]
    else:
        where[key] = chance.choice(
            (None, "x", "", -1, 0, 1e308, float("nan"), float("inf"), [], {}, [None], {"a": 1}, True)
        )
    return json.dumps(tree)


WAYS = (
    link_out, link_around, circle, virtual, external, other_type, other_shape, empty, packed, nothing_there, a_group,
    numbers, attribute, attribute, attribute, attribute, attribute, text, text,
)  # fmt: skip


def archives(ledger, seed, numbers, folder: Path) -> None:
    """Corrupted ones (odd numbers) and crafted ones, each opened, and put to some of their uses."""
    for name in LOADED:
        importlib.import_module(name)
    whole = made(folder)
    for kind in whole:
        # Kernels that are compiled on the way would count as hangs.
        for words in uses(kind, whole[kind], folder, whole["run"]):
            command(*words, patience=COMPILING)
    for left in folder.glob("*again-*"), folder.glob("*from-*"):
        for path in left:
            path.unlink()
    whole = made(folder)
    for number in numbers:
        chance = random.Random(f"{seed} {number}")
        kind = chance.choice(sorted(whole))
        path = folder / f"{kind}-{number}.h5"
        if kind == "broken":
            path = partial_path(path)
        shutil.copyfile(whole[kind], path)
        name = "archive corrupted" if number % 2 else "archive crafted"
        if number % 2:
            corrupted(chance, path)
        else:
            crafted(chance, path, whole["run"])
        every = [*uses(kind, path, folder, whole["run"])]
        for words in chance.sample(every, min(DRAWN, len(every))):
            with read_in_forks(really=number % APART == 0):
                code, _, error = command(*words)
            outcome, how = judged(code, error)
            ledger.note(name, outcome, how and f"{words[0]} {how}", f"{number}: {' '.join(map(str, words))}\n{error}")
        if kind != "broken":
            _, outcome, how = tried(lambda path=path: open_archive(path).load())
            ledger.note(name, outcome, how and f"open_archive {how}", str(path))
        for left in folder.glob(f"*-{number}*"):
            left.unlink()


def uses(kind, path, folder, other):
    """Words of every verb that reads an archive of this kind; `other` a whole one of a run."""
    figure = folder / f"figure-{path.stem}.png"
    yield "show", path
    yield "show", path, "--json"
    yield "plot", path, "--out", figure
    if kind == "study":
        yield "show", path, "--csv", "--table", "table"
        yield "check", path
        yield "compare", path, path
        return
    short = ("--no-plot", *(word for override in SHORT for word in ("--set", override)))
    yield "report", path, "--out", folder / f"page-{path.stem}.html"
    yield "compare", other, path
    if kind == "run":
        yield "show", path, "--csv"
        yield "plot", path, "--kind", "orbit", "--out", figure
        yield "animate", path, "--out", figure
        yield "check", path
        out = folder / f"study-{path.stem}.h5"
        yield "study", "equilibrium", path, "--points", 5, "--workers", 1, "--no-plot", "--out", out
        yield "run", path, *short, "--out", folder / f"again-{path.stem}.h5"
        yield "run", SEAL, *short, "--set", f"run.start={path}", "--out", folder / f"from-{path.stem}.h5"
    else:
        out = path.with_name(path.name.replace(".partial", ""))
        yield "run", SEAL, "--set", *LONGER, "--no-plot", "--continue", "--out", out
