"""A run as charts want it: turns instead of time, series thinned without losing an extreme, words for titles."""

from functools import cached_property
from itertools import takewhile

import numpy as np

from ...archive import column, read_info
from ...quantities import by_size, everyday, factor_of, printed
from ..text import question_of, written_units

BLOCK = 1 << 16
POINTS = 20_000
MILLISECONDS = factor_of("s", "ms") or 1.0
# A run (s) that is read in seconds.
LONG = 2.0
# How many of the everyday unit of radii, of that of films, and of that of angles make one in SI.
MM, UM, DEG = (everyday(name)[1] for name in ("radius", "m", "angle"))


class Run:
    """One archive, read when asked, never held whole.  `rows` is fixed when it is opened, so that the
    panels of one figure agree while the run goes on."""

    def __init__(self, path, over_time: bool = False):
        self.path, self.info = path, read_info(path)
        self.rows, self.summary, self.status = self.info["rows"], self.info["summary"], self.info["status"]
        self.message = self.info.get("message", "")
        self.resolved = self.info["resolved"]
        # Of a run-up more is read over time than over turns.
        self.over_time = over_time and self.varies
        self.written = written_units(self.info)
        self._sizes: dict[tuple[str, int], float] = {}

    def has(self, *names: str) -> bool:
        """Whether all these series are there, with at least two rows."""
        return self.rows > 1 and all(name in self.info["series"] for name in names)

    def values(self, name: str, start: int = 0, stop: int | None = None) -> np.ndarray:
        """Rows `start` to `stop` of a series (SI)."""
        return column(self.path, name, slice(start, self.rows if stop is None else min(stop, self.rows)))

    def shown(self, name: str, first: int = 0, size: float | None = None) -> tuple[str, float]:
        """The unit that people read a series in from row `first` on, and how many of it make one SI unit: what the
        archive says, the everyday one by size, by default the largest.  Both components of a tilt have one unit."""
        return self._shown(self.info["series"][name], self.largest(name, first) if size is None else size)

    def field_shown(self, name: str, size: float) -> tuple[str, float]:
        """The same of a field over the face or around the shaft of a `size` (SI)."""
        return self._shown(self.info["fields"][name], size)

    def _shown(self, held, size: float) -> tuple[str, float]:
        """The unit that the scenario has for what a series or field is, or one by its `size` (SI) where its everyday
        one is not that."""
        unit = self.written.get({"m": "clearance", "rad": "tilt", "Pa": "pressure"}.get(held.units))
        if unit is None or held.display_unit != everyday(held.units)[0]:
            return by_size(held.units, held.display_unit or held.units, held.display_factor, size)
        return printed(unit), factor_of(held.units, unit)

    def largest(self, name: str, first: int = 0) -> float:
        """Largest magnitude of a series (SI), or of both components of a tilt."""
        key = (name.removesuffix("_x").removesuffix("_y"), first)
        if key not in self._sizes:
            names = [f"{key[0]}_{axis}" for axis in "xy"] if name != key[0] else [name]
            parts = [(n, start) for n in names if n in self.info["series"] for start in range(first, self.rows, BLOCK)]
            sizes = [np.abs(self.values(n, start, start + BLOCK)) for n, start in parts]
            self._sizes[key] = float(max((np.nanmax(s, initial=0.0) for s in sizes), default=0.0))
        return self._sizes[key]

    @cached_property
    def turns(self) -> np.ndarray:
        """Turns of the shaft since the first row: its angle unwrapped, the speed deciding how often it went
        round between two rows; in blocks, since there may be millions of rows."""
        turns, total, carry = np.zeros(self.rows), 0.0, None
        if not self.has("shaft_angle", "shaft_speed"):
            return turns
        for start in range(0, self.rows, BLOCK):
            block = [self.values(n, start, start + BLOCK) for n in ("time", "shaft_angle", "shaft_speed")]
            if carry is not None:
                block = [np.concatenate([[last], b]) for last, b in zip(carry, block, strict=True)]
            time, angle, speed = block
            expected = (speed[1:] + speed[:-1]) / 2 * np.diff(time) / (2 * np.pi)
            seen = np.diff(angle) / (2 * np.pi)
            grown = total + np.cumsum(np.abs(seen + np.round(expected - seen)))
            turns[start + (carry is None) : start + (carry is None) + len(grown)] = grown
            total, carry = (grown[-1] if len(grown) else total), [b[-1] for b in block]
        return turns

    @cached_property
    def turned(self) -> bool:
        """Whether the shaft turns at all."""
        return self.rows > 1 and self.turns[-1] > 0

    @property
    def turning(self) -> bool:
        """Whether the x axes show turns."""
        return self.turned and not self.over_time

    @cached_property
    def progress(self) -> np.ndarray:
        """What the x axes show: turns, or time."""
        if self.turning:
            return self.turns
        return (factor_of("s", self.progress_unit) or 1.0) * (self.values("time") - self.values("time", 0, 1))

    @cached_property
    def progress_unit(self) -> str:
        if self.turning:
            return "turns"
        return "s" if self.rows and self.values("time", self.rows - 1)[0] >= LONG else "ms"

    @property
    def varies(self) -> bool:
        """Whether the speed of the shaft does."""
        speed = self.resolved.get("shaft", {}).get("speed")
        return isinstance(speed, dict) and self.has("shaft_speed") and len(set(speed["value"])) > 1

    @property
    def progress_label(self) -> str:
        return "turns of the shaft" if self.turning else f"time, {self.progress_unit}"

    def last(self, amount: float, most_rows: int = POINTS) -> int:
        """First row of the last `amount` of turns (of everything, if the shaft stands still), at most
        `most_rows` back."""
        if not self.turned:
            return max(self.rows - most_rows, 0)
        first = int(np.searchsorted(self.turns, self.turns[-1] - amount * (1 + 1e-9)))
        return max(first, self.rows - most_rows, 0)

    def envelope(self, name: str, first: int = 0) -> tuple[np.ndarray, np.ndarray]:
        """Progress and values from row `first`; a long series keeps the smallest and the largest value of
        every stretch, where they are, so no extreme is lost."""
        if self.rows - first <= POINTS:
            return self.progress[first:], self.values(name, first)
        stretch = -(-(self.rows - first) // (POINTS // 2))
        kept_x, kept_y = [], []
        for start in range(first, self.rows, stretch * max(1, BLOCK // stretch)):
            values = self.values(name, start, start + stretch * max(1, BLOCK // stretch))
            edges = np.arange(0, len(values), stretch)
            padded = np.concatenate([values, np.full(-len(values) % stretch, values[-1])]).reshape(-1, stretch)
            at = np.sort(np.stack([padded.argmin(1), padded.argmax(1)], 1), 1) + edges[:, None]
            at = np.minimum(at.ravel(), len(values) - 1)
            kept_x.append(self.progress[start + at])
            kept_y.append(values[at])
        return np.concatenate(kept_x), np.concatenate(kept_y)

    def drawn(self, name: str, first: int = 0) -> tuple[np.ndarray, np.ndarray, str]:
        """Progress, values and unit of a series as people read it, from row `first`, as `envelope`."""
        (unit, per), (x, values) = self.shown(name, first), self.envelope(name, first)
        return x, per * values, unit

    # -- the scene in numbers and words ------------------------------------------------------------

    def film(self, name: str) -> float | None:
        """A number of the resolved `[film]` table, None when absent or varying."""
        value = self.resolved.get("film", {}).get(name)
        return value if isinstance(value, int | float) else None

    def housing(self, kind: str) -> list[dict]:
        """The resolved `[[housing.KIND]]` tables."""
        return (self.resolved.get("housing") or {}).get(kind) or []

    @cached_property
    def clearance(self) -> float | None:
        """Design clearance (m): given, or from the first row's h_min = C + dz + shape(r) - r tilt + waves."""
        if self.film("clearance"):
            return self.film("clearance")
        if not self.has("h_min", "axial_gap_change"):
            return None
        first = {n: self.values(n, 0, 1)[0] for n in self.info["series"]}
        radius = first.get("h_min_radius", self.film("inner_radius") or 0.0)
        wedge = radius * first.get("relative_misalignment", 0)
        if self.wave_orders:
            angle = first["h_min_angle"]
            wedge = radius * (first["relative_tilt_y"] * np.cos(angle) - first["relative_tilt_x"] * np.sin(angle))
            for n in self.wave_orders:
                wedge -= first[f"gap_cos_{n}"] * np.cos(n * angle) + first[f"gap_sin_{n}"] * np.sin(n * angle)
        return first["h_min"] - first["axial_gap_change"] - float(self.shape(radius, first.get("coning"))) + wedge

    def shape(self, radius, coning=None):
        """By how much (m) the aligned gap is wider than the clearance at radii: `coning` (rad; without it the
        scenario's), and the faces' profile."""
        profile = self.resolved.get("film", {}).get("profile")
        depth = np.interp(radius, profile["radius"], profile["depth"]) if profile else 0.0
        if coning is None:
            coning = self.film("coning") or 0.0
        return coning * (radius - (self.film("inner_radius") or 0.0)) + depth

    @cached_property
    def wave_orders(self) -> list[int]:
        """Orders of the waves between the faces: those of the series gap_cos_n and gap_sin_n."""
        return sorted(int(name.removeprefix("gap_cos_")) for name in self.info["series"] if name.startswith("gap_cos_"))

    @property
    def touch_at(self) -> float:
        """Film thickness (m) at which the faces touch: where asperities meet, or zero."""
        level = (self.summary.get("contact") or {}).get("touch_at")
        return level if isinstance(level, int | float) else 0.0

    @cached_property
    def touches(self) -> bool:
        """Whether any sample shows contact."""
        return self.has("contact_force") and bool(np.nanmax(self.envelope("contact_force")[1]) > 0)

    @cached_property
    def contact_tilt(self) -> float | None:
        """Relative misalignment (rad) at which faces without waves touch at the design clearance."""
        inner, outer = self.film("inner_radius"), self.film("outer_radius")
        if not (self.clearance and inner and outer) or self.wave_orders:
            return None
        profile = self.resolved.get("film", {}).get("profile")
        radii = np.array(profile["radius"] if profile else [inner, outer])
        coning = self.values("coning", 0, 1)[0] if self.has("coning") else None
        return float(np.min((self.clearance + self.shape(radii, coning)) / radii))

    @property
    def question(self) -> str:
        """The scenario's opening question, or the opening comment, or the archive's name."""
        comment = takewhile(lambda line: line.startswith("#"), self.info.get("scenario", "").splitlines())
        words = " ".join(line.lstrip("# ").strip() for line in comment).strip()
        return question_of(words) or self.info.get("title", "")

    @property
    def description(self) -> str:
        """Name, model and stability verdict, as far as the summary has them."""
        model, stability = self.summary.get("model") or {}, self.summary.get("stability") or {}
        whirl, unknowns = stability.get("whirl_ratio"), model.get("unknowns")
        verdict = stability.get("verdict") and f"linear stability: {stability['verdict']}"
        if verdict and isinstance(whirl, int | float):
            verdict += f", whirl ratio {whirl:.3g}"
        parts = (
            self.info.get("title"),
            model.get("film") and f"{model['film']} film",
            unknowns and f"{len(unknowns)} unknown{'s' * (len(unknowns) != 1)}",
            model.get("solver") and f"solver {model['solver']}",
            verdict,
        )
        return "   ·   ".join(filter(None, parts))
