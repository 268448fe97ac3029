"""Files of samples, drawn and mutated: whenever the program takes one, the numbers it holds are those of an independent
reader, by the rules of CF and of CSV; else it is refused in one line."""

import math
import random
from fractions import Fraction

import h5py
import numpy as np

from sealdyn.archive import ArchiveError
from sealdyn.scenario.motion_files import MOTION, file_columns
from sealdyn.units import QuantityError

from .outcome import LONGEST, place, read_in_forks, tried

NAMES = ("time", "axial", "tilt_x", "tilt_y")
# Exact factors to SI of units that are drawn; all others are to be refused.
LENGTHS = {"m": "1", "mm": "1/1000", "um": "1/1000000", "nm": "1/1000000000", "µm": "1/1000000", "in": "127/5000"}
TIMES = {"s": "1", "ms": "1/1000", "us": "1/1000000", "min": "60", "sec": "1"}
ANGLES = {"rad": "1", "mrad": "1/1000", "urad": "1/1000000"}
UNITS = {"time": TIMES, "axial": LENGTHS, "tilt_x": ANGLES, "tilt_y": ANGLES}
WRONG = (
    "furlong", "kg", "s/m", "Hz", "seconds since 2000-01-01", "1", "%", "um um", "\x1b[31m", "1e3 m", "TIR", "=1+1",
)  # fmt: skip
# Bytes, cells and titles that hurt.
BYTES = (0, 9, 10, 13, 34, 39, 44, 46, 59, 101, 255)
CELLS = ("", "nan", "inf", "1_0", "0x1", "１", "--", "1e999", '"1"', "=1", "1 2", "1,5", "#")
TITLES = ("{n} ({u})", "{n} [{u}]", "{n}({u})", " {n} ( {u} )", '"{n}\n({u})"', "{n} {u}", "{n}_{u}")
# One file of HDF5 in so many is read in a process of its own, as the program does.
APART = 20
# What is below it is nothing.
NOTHING = 1e-25


def motions(ledger, seed, numbers, folder) -> None:
    """Every second file is HDF5; a third have bytes changed."""
    for number in numbers:
        chance = random.Random(f"{seed} {number}")
        kind, write, held = ("HDF5", _hdf5, held_by_hdf5) if number % 2 else ("CSV", _csv, held_by_csv)
        path = folder / f"m{'.h5' if number % 2 else '.csv'}"
        path.unlink(missing_ok=True)
        write(chance, path)
        if chance.random() < 0.33:
            _damage(chance, path)
        try:
            with read_in_forks(really=number % APART == 1):
                columns, outcome, how = tried(lambda path=path: file_columns(path, MOTION))
                found = columns and {name: values for name, (values, _) in columns.items()}
        except QuantityError:
            found, outcome, how = None, "refused", ""
        if how.startswith("QuantityError"):
            outcome, how = "refused", "" if len(how) < LONGEST and "\n" not in how else "a long line"
        if found is not None:
            outcome, how = _compared(found, held, path)
        ledger.note(f"motion {kind}", outcome, how, f"{number}")


def _compared(found: dict, held, path) -> tuple[str, str]:
    try:
        own = held(path)
    except (ArchiveError, Exception) as error:
        return "escaped", f"taken, where an independent reader says {place(error)}"
    if set(own) != set(found):
        return "escaped", f"{sorted(found)} taken, {sorted(own)} there"
    for name, values in own.items():
        if len(values) != len(found[name]):
            return "escaped", f"{name}: {len(found[name])} of {len(values)} numbers"
        for mine, its in zip(values, found[name], strict=True):
            if abs(its - mine) > 1e-6 * abs(mine) + NOTHING or not math.isfinite(its):
                return "escaped", f"{name}: {its:g} taken for {float(mine):g}"
    return "done", ""


def _factor(name: str, unit: str) -> Fraction:
    return Fraction(UNITS[name][unit]) if unit else Fraction(1)


def _unit(chance, name: str) -> str:
    return chance.choice(WRONG) if chance.random() < 0.03 else chance.choice(("", *UNITS[name], *UNITS[name]))


def _damage(chance, path) -> None:
    held = bytearray(path.read_bytes())
    for _ in range(chance.choice((1, 1, 2, 8))):
        at = chance.randrange(max(1, len(held)))
        way = chance.random()
        if way < 0.5:
            held[at : at + 1] = bytes([chance.choice((*BYTES, chance.randrange(256)))])
        elif way < 0.7:
            del held[at : at + chance.randrange(1, 9)]
        elif way < 0.9:
            held[at:at] = chance.choice((b'"', b",", b";", b"\n", b"1", b"e9", b"\x1b[2J", b"# ", b"\0", b"_", b" "))
        else:
            del held[at:]
    path.write_bytes(held)


# --- CSV -------------------------------------------------------------------------------------------------


def _csv(chance, path) -> None:
    names = ["time", *chance.sample(NAMES[1:], chance.randrange(1, 4)), *("x", "remark")[: chance.randrange(3)]]
    chance.shuffle(names)
    mark, comma = chance.choice(",,;\t"), chance.random() < 0.08
    titles = []
    for name in names:
        unit = _unit(chance, name) if name in NAMES else ""
        shape = chance.choice(TITLES if chance.random() < 0.3 else TITLES[:1])
        name = chance.choice((name, name, name, name.upper(), name.title()))
        titles.append(shape.format(n=name, u=unit) if unit else name)
    rows = [titles]
    for n in range(chance.choice((0, 3, 8, 20))):
        row = []
        for name in names:
            value = n * 1e-3 if name.lower() == "time" else chance.uniform(-5, 5)
            cell = chance.choice(("{:.4f}", "{:.6g}", "{:e}", " {:g} ", "+{:.3f}")).format(value).replace("+-", "-")
            if chance.random() < 0.004:
                cell = chance.choice(CELLS)
            row.append(cell.replace(".", ",") if comma else cell)
        if chance.random() < 0.01:
            row = chance.choice((row[:-1], [*row, "9"], [*row, ""]))
        rows.append(row)
    lines = [mark.join(row) for row in rows]
    if chance.random() < 0.2:
        lines.insert(chance.randrange(len(lines) + 1), chance.choice(("# a remark", "", "   ")))
    end = chance.choice(("\n", "\r\n"))
    text = chance.choice(("", "\ufeff")) + end.join(lines) + chance.choice(("", end))
    path.write_bytes(text.encode(chance.choice(("utf-8",) * 9 + ("utf-16",))))


def held_by_csv(path) -> dict[str, list[float]]:
    """Columns by hand: cells between separators, quotation marks around some; raises where one is no number."""
    text = path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    lines = [line for line in text.split("\n") if line.strip() and not line.startswith("#")]
    mark = ";" if ";" in lines[0] else "\t" if "\t" in lines[0] else ","
    rows, cell, row, inside = [], "", [], False
    for line in lines:
        n = 0
        while n < len(line):
            letter = line[n]
            if inside and letter == '"' and line[n + 1 : n + 2] == '"':
                cell, n = cell + '"', n + 1
            elif letter == '"' and (inside or not cell.strip(" ")):
                inside, cell = not inside, cell if inside else ""
            elif letter == mark and not inside:
                row, cell = [*row, cell], ""
            else:
                cell += letter
            n += 1
        if inside:
            cell += "\n"
        else:
            rows, row, cell = [*rows, [*row, cell]], [], ""
    if inside:
        rows.append([*row, cell])
    found = {}
    for at, title in enumerate(rows[0]):
        words = title.replace("[", "(").replace("]", ")").replace("\n", " ").strip()
        name, _, unit = words.partition("(")
        name, unit = name.strip().lower(), unit.rstrip().removesuffix(")").strip()
        if name in NAMES:
            if name in found:
                raise ValueError(f"{name} twice")
            numbers = [Fraction(line[at].strip()) for line in rows[1:]]
            found[name] = [float(number * _factor(name, unit)) for number in numbers]
    if any("".join(line[len(rows[0]) :]).strip() for line in rows[1:]):
        raise ValueError("cells below no name")
    return found


# --- HDF5 ------------------------------------------------------------------------------------------------


def _hdf5(chance, path) -> None:
    count = chance.choice((6, 12))
    with h5py.File(path, "w") as file:
        for name in ("time", *chance.sample(NAMES[1:], chance.randrange(1, 4))):
            drawn = range(count) if name == "time" else [chance.randrange(-90, 90) for _ in range(count)]
            values = np.array(drawn, float)
            kind = chance.choice(("f8", "f8", "f4", ">f4", "i2", "i4", ">i2", "u1", "i1", "i8"))
            values = (values + 100 if kind == "u1" else values).astype(kind)
            more = {"chunks": True, "compression": "gzip"} if chance.random() < 0.2 else {}
            if chance.random() < 0.05:
                values = values.reshape(2, -1)
            shown = chance.choice((name,) * 8 + (name.upper(), name.title()))
            more |= chance.choice(({}, {}, {}, {"fillvalue": values.flat[2]}))
            item = file.create_dataset(shown, data=values, **more)
            for key, value in _attributes(chance, name, values).items():
                item.attrs[key] = value


def _attributes(chance, name: str, values) -> dict:
    found = {}
    if unit := _unit(chance, name):
        row = np.array([unit], dtype=h5py.string_dtype())
        key = chance.choice(("units", "units", "units", "unit", "Unit", "UNITS", "Units"))
        found[key] = chance.choice((unit, unit, row, np.bytes_(unit.encode()), np.bytes_(unit.encode() + b"\0")))
        if chance.random() < 0.05:
            found[chance.choice(("unit", "units"))] = _unit(chance, name) or "s"
    pick = chance.random
    if pick() < 0.3:
        found["scale_factor"] = chance.choice(
            (0.01, np.float32(0.5), [2.0], 1) * 6 + ("2", [1.0, 2.0], math.nan, 0.0, 1e300)
        )
    if pick() < 0.2:
        found["add_offset"] = chance.choice((5.0, np.float32(-100.0), [0.25], 3) * 6 + ("1", math.inf))
    if pick() < 0.15:
        own = values.flat[chance.randrange(values.size)]
        key = chance.choice(("_FillValue", "missing_value"))
        found[key] = chance.choice((own, *(values.dtype.type(127), -999.0, 1e20) * 4))
    if pick() < 0.1:
        found["valid_range"] = chance.choice(([-200, 300], [-200, 300], [-10.0, 10.0], [5]))
    if pick() < 0.1:
        found[chance.choice(("valid_min", "valid_max"))] = chance.choice((0, -1000, 1000.0, "0"))
    if pick() < 0.1:
        found["_Unsigned"] = chance.choice(("true", "false", b"true"))
    return found


def held_by_hdf5(path) -> dict[str, list[float]]:
    """Columns by CF's rules, in exact numbers; raises where a sample is missing or an attribute is none."""
    found = {}
    with h5py.File(path, "r") as file:
        for key, item in file.items():
            name = key.lower()
            if name not in NAMES:
                continue
            said = {key.lower(): np.ravel(value) for key, value in item.attrs.items()}
            words = [said[key][0] for key in ("unit", "units") if key in said]
            words = {word.decode() if isinstance(word, bytes) else str(word) for word in words}
            (unit,) = {word.strip("\0 ") for word in words} or {""}
            stored = [number.item() for number in item[()]]
            unsigned = [w[0] in ("true", b"true") for k, w in said.items() if k == "_unsigned"]
            turn = 2 ** (8 * item.dtype.itemsize) if unsigned == [True] and item.dtype.kind == "i" else 0
            stored = [number + turn if number < 0 else number for number in stored]

            def numbers(key, said=said, turn=turn):
                return [n.item() + turn if n < 0 and n.dtype.kind == "i" else n.item() for n in said.get(key, ())]

            missing = [n for key in ("_fillvalue", "missing_value") for n in numbers(key)]
            low, high = numbers("valid_range") or (-math.inf, math.inf)
            low, high = max([low, *numbers("valid_min")]), min([high, *numbers("valid_max")])
            if any(n in missing or n < low or n > high for n in stored):
                raise ValueError("a sample is missing")
            (scale,), (offset,) = numbers("scale_factor") or [1.0], numbers("add_offset") or [0.0]
            factor = _factor(name, unit)
            found[name] = [float((Fraction(n) * Fraction(scale) + Fraction(offset)) * factor) for n in stored]
    return found
