"""Wavy faces that wear, quasi-static: the balance of film and asperities over worn faces, the Archard depth rates, and
what the study says of it, the waves that are left over the hours and how long they live.

    depth(r, theta) = sum_j d_j phi_j(r) + sum_m c_m cos(m (n theta + phase)),   n the order of the waves
    d rate: k_w p_c |speed| r of each place, projected on that shape

A flat ring that turns under the waves wears evenly around, the waves where they press; travelling waves pass every
place of their own face, and wear both evenly.
**Source** Archard's law; Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 4, whose waves travel twice a day.
**Valid** aligned faces at rest in `reynolds`, one order of waves on the ring that stands, Christensen's heights; narrow
faces, whose waves wear alike at every radius (`left_out` says how much of the rate does not); travelling waves that
pass every place as a whole number of them, slowly against the shaft, quickly against the wear.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from ...answers import Answer, Axis, Level, Panel, Series, Table
from ...dynamics.equilibrium import crossing
from ...dynamics.imposed_motion import rest_state
from ...dynamics.interface import Interface, flow_at_rest, opening_law, prepared
from ...faces import contact
from ...faces.geometry import (
    CONTACT_AREA,
    CONTACT_FORCE,
    CONTACT_PRESSURE,
    CONTACT_TORQUE,
    FLOW_INNER,
    FORCE,
    SPIN_DIFFERENCE,
    TORQUE,
    WEAR,
)
from ...faces.roughness import contact_fraction
from ...films import film_of
from ...numerics.piecewise_linear import initially
from ...quantities import in_words
from ...scene.film import Profile, aligned_gaps, coned
from ...scene.forces import HALF_HEIGHT
from ...scene.patterns import HIGHEST_ORDER, MOST_WAVES
from ...scene.scene import Closing, SceneError, frozen_at_start
from ...status import Status
from .averages import profile_of, supports_of
from .rosenbrock import Average, HatBasis, NoAverage

# Gauss points over the touching part of a piece of radius: exact for the law's seventh degree, the arm and two hats.
GAUSS = 6
# Amplitude (m) of a harmonic that is there and does nothing: the same angles for all.
TINY = 1e-24
PIECES = 12
# First step in looking for a balance, and the furthest, in roughnesses; accuracy of the film.
STEP, FAR, FINE = 0.02, 100.0, 1e-10


class WaveBasis(HatBasis):
    """Hats over the radius, and beside them cosines around the circle, alike at every radius."""

    def __init__(self, radius, cosines: int):
        super().__init__(radius)
        self.n, self.cosines = len(self.radius), cosines
        self.hats = HatBasis(self.radius)
        self.even = 0.5 * float(self.hats.areas.sum())
        self.areas = np.concatenate([self.hats.areas, np.zeros(cosines)])

    def rates(self, nodal) -> tuple[np.ndarray, bool]:
        """As HatBasis, and amplitude rates (m/s) of the cosines."""
        rate, exact = self.hats.rates(nodal[: self.n])
        return np.concatenate([rate, nodal[self.n :] / self.even]), exact

    def slopes(self, slope, exact: bool) -> np.ndarray:
        """As HatBasis."""
        rows = self.hats.slopes(slope[: self.n], exact)
        return np.concatenate([rows, slope[self.n :] / self.even])


class BalancesOfWaves:
    """Average of a scene over worn faces: called with depths (n + cosines,) m as WaveBasis has them.

    Raises SceneError for a scene it is not of, NoAverage where nothing carries the closing force."""

    unstable, still, period = False, True, None

    def __init__(self, scene, radius, cosines: int, travelling: bool):
        _refuse(scene)
        scene = frozen_at_start(scene)
        # Cells of the waves as they were made.
        film = prepared(scene, film_of(scene))
        own = profile_of(film)
        self.scene, self.radius = replace(scene, film=film), np.asarray(radius, dtype=float)
        self.own = np.interp(self.radius, own.radius, own.depth)
        self.wave, self.travelling = scene.stator.waviness[0], travelling
        self.harmonics = 1 if travelling else min(cosines, HIGHEST_ORDER // int(self.wave.order), MOST_WAVES)
        self.basis = WaveBasis(radius, 0 if travelling else self.harmonics)
        faces = scene.contact
        self.stator, self.rotor = faces.stator_wear_coefficient, faces.rotor_wear_coefficient
        self.stiffness = supports_of(scene)[0]
        rest = Interface(self.scene, FINE)
        pressures = initially(film.inner_pressure), initially(film.outer_pressure)
        self.clearance = rest.clearance
        self.closing = float(rest.closing.at(*pressures, initially(rest.closing.spring)))

    def amplitudes(self, depth) -> np.ndarray:
        """Amplitudes (m) of the gap's cosines, of the order of the waves and its multiples."""
        found = np.zeros(self.harmonics)
        found[: self.basis.cosines] = depth[self.basis.n :]
        found[0] += self.wave.amplitude
        return found

    def travel(self, depth) -> float:
        """By how much (m) the ring has followed what is worn off."""
        return self.basis.volume(depth) / float(self.basis.areas.sum())

    def rise(self, depth) -> np.ndarray:
        """Profile (n,) m of the gap, counted from where the ring has gone."""
        return self.own + depth[: self.basis.n] - self.travel(depth)

    def worn(self, depth):
        """The scene over worn faces, where the ring has followed what is worn off on the mean."""
        waves = [replace(self.wave, order=int(self.wave.order) * (m + 1), amplitude=max(abs(a), TINY),
                         phase=(m + 1) * self.wave.phase + (math.pi if a < 0.0 else 0.0))
                 for m, a in enumerate(self.amplitudes(depth))]  # fmt: skip
        profile = Profile(tuple(self.radius.tolist()), tuple(self.rise(depth).tolist()))
        film = replace(self.scene.film, profile=profile)
        return replace(self.scene, film=film, stator=replace(self.scene.stator, waviness=waves))

    def balanced(self, depth, start: float) -> Interface:
        """The worn faces where they carry what presses them together, nearest to the clearance `start` (m)."""
        scene = self.worn(depth)
        law, closing = opening_law(scene), self.closing - self.stiffness * self.travel(depth)
        pressures = initially(scene.film.inner_pressure), initially(scene.film.outer_pressure)

        def excess(clearance):
            return law(clearance, *pressures) - closing

        near, left = start, excess(start)
        step = math.copysign(STEP * self.scene.contact.roughness, left)
        while excess(near + step) * left > 0.0:
            near, step = near + step, 1.3 * step
            if abs(near - start) > FAR * self.scene.contact.roughness:
                raise NoAverage(Status.FAILED, "worn so, the faces rest nowhere near where they were")
        clearance = crossing(excess, *sorted((near, near + step)))
        film = replace(scene.film, clearance=clearance)
        return Interface(replace(scene, film=film, closing=Closing()), FINE)

    def __call__(self, depth, motion=None) -> Average:
        depth = np.asarray(depth, dtype=float)
        interface = self.balanced(depth, motion or self.clearance)
        s, _ = rest_state(interface.scene, interface.clearance)
        flow_at_rest(interface, s)
        contact.contact_load_and_friction(interface.contact, interface.f, s)
        nodal, slope, seen = self.rubbed(interface, depth, abs(float(s[SPIN_DIFFERENCE])))
        film = interface.scene.film
        area, carried = math.pi * (film.outer_radius**2 - film.inner_radius**2), float(s[FORCE] + s[CONTACT_FORCE])
        high_inside = film.inner_pressure > film.outer_pressure
        amplitudes = self.amplitudes(depth)
        lowest = min(h for _, h in aligned_gaps(coned(interface.scene), 0.0)) + float(self.shape(amplitudes).min())
        row = {
            "contact_force": float(s[CONTACT_FORCE]), "closing_force": carried, "film_force": float(s[FORCE]),
            "load_support": float(s[FORCE]) / carried, "leakage": float(s[FLOW_INNER]) * (1.0 if high_inside else -1.0),
            "friction_power": abs(float((s[TORQUE] + s[CONTACT_TORQUE]) * s[SPIN_DIFFERENCE])),
            "contact_pressure": float(s[CONTACT_PRESSURE]), "contact_area_fraction": float(s[CONTACT_AREA]),
            "wear_rate": float(s[WEAR]), "clearance": interface.clearance, "h_min": interface.clearance + lowest,
            "waviness": 0.5 * float(np.ptp(self.shape(amplitudes))), "amplitudes": amplitudes.tolist(), **seen,
        }  # fmt: skip
        return Average(nodal, float(s[WEAR]) * area, slope, None, interface.clearance, row)

    def shape(self, amplitudes) -> np.ndarray:
        """Height (m) of the waves over the angles of one of them."""
        return np.cos(np.outer(self.angles(), np.arange(1, self.harmonics + 1))) @ amplitudes

    def angles(self) -> np.ndarray:
        """Angles n theta + phase of one wave, as many as the kernels of the asperities take."""
        many = contact.ANGLES_PER_WAVE * self.harmonics
        return 2.0 * math.pi * np.arange(many) / many

    def rubbed(self, interface, depth, speed: float) -> tuple[np.ndarray, np.ndarray, dict]:
        """Volume rates (m^3/s) at the hats and cosines, their slopes by depth (m^2/s) with the asperities alone and the
        ring moved so that they carry the same, and shares of the rate that neither has."""
        faces, basis = self.scene.contact, self.basis
        half = HALF_HEIGHT * faces.roughness
        radii, gaps = (np.array(one) for one in zip(*aligned_gaps(coned(interface.scene), interface.clearance),
                                                    strict=True))  # fmt: skip
        bump, angles = self.shape(self.amplitudes(depth)), self.angles()
        r, weight, h = _touching(radii, gaps, bump, half)
        # Of each point its hats, its pressure and what that loses with the gap.
        hats = np.stack([np.interp(r, self.radius, one) for one in np.eye(basis.n)], axis=-1)
        weight = weight * 2.0 * math.pi / len(angles) * r
        pressed = faces.compressive_strength * contact_fraction(h / half)
        steep = faces.compressive_strength / half * 35.0 / 32.0 * np.clip(1.0 - (h / half) ** 2, 0.0, None) ** 3
        cosines = np.cos(np.outer(angles, np.arange(1, basis.cosines + 1)))
        both, own = (self.stator + self.rotor) * speed, self.stator * speed

        def moments(value):
            """Integrals (basis,) of a value per area with hats and cosines."""
            return np.concatenate([np.einsum("tpq,tpqj->j", weight * value, hats),
                                   np.einsum("tpq,tm->m", weight * value, cosines)])  # fmt: skip

        scale = np.concatenate([np.full(basis.n, both), np.full(basis.cosines, own)])
        nodal = scale * moments(pressed * r)
        loss = weight * steep
        columns = [moments(steep * r * hats[..., j]) for j in range(basis.n)]
        columns += [moments(steep * r * cosines[:, m, None, None]) for m in range(basis.cosines)]
        slope = -scale[:, None] * np.array(columns).T
        force = np.concatenate([np.einsum("tpq,tpqj->j", loss, hats), np.einsum("tpq,tm->m", loss, cosines)])
        if (give := float(force[: basis.n].sum())) > 0.0:
            slope -= np.outer(slope[:, : basis.n].sum(axis=1), force) / give
        return nodal, slope, {"left_out": self._left_out(interface, depth, half, basis.rates(nodal)[0] / speed)}

    def _left_out(self, interface, depth, half, rate) -> float:
        """Root mean square of the depth rate of both faces that hats and cosines do not have, over its own."""
        film, faces = interface.scene.film, self.scene.contact
        r = np.linspace(film.inner_radius, film.outer_radius, 8 * PIECES + 1)
        plain = np.interp(r, *zip(*aligned_gaps(coned(interface.scene), interface.clearance), strict=True))
        bump = self.shape(self.amplitudes(depth))
        worn = faces.compressive_strength * contact_fraction((plain + bump[:, None]) / half) * r
        mean, n = worn.mean(axis=0), self.basis.n
        own = 0.0 if self.travelling else self.stator
        exact = own * worn + (self.stator + self.rotor - own) * mean
        shape = np.cos(np.outer(self.angles(), np.arange(1, self.basis.cosines + 1))) @ rate[n:]
        apart = exact - np.interp(r, self.radius, rate[:n]) - shape[:, None]
        size = float(np.sqrt(np.mean(exact**2)))
        return float(np.sqrt(np.mean(apart**2))) / size if size > 0.0 else 0.0

    def over_face(self, rate) -> np.ndarray:
        """Depth rates (m/s) at radii and angles of both faces together."""
        shape = np.cos(np.outer(self.angles(), np.arange(1, self.basis.cosines + 1))) @ rate[self.basis.n :]
        return rate[: self.basis.n] + shape[:, None]


def _touching(radii, gaps, bump, top) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Radii (m), weights (m) and gaps (m), each (angles, pieces, points), of Gauss points over the part of each piece
    of radius whose gap is below `top` (m), gaps linear between `radii`."""
    node, share = np.polynomial.legendre.leggauss(GAUSS)
    low, high = gaps[:-1] + bump[:, None], gaps[1:] + bump[:, None]
    slope = high - low
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = np.clip(np.where(slope == 0.0, 0.0, (top - low) / slope), 0.0, 1.0)
    begin = np.where(low < top, 0.0, crossing)
    end = np.where(high < top, 1.0, crossing)
    end = np.where((low >= top) & (high >= top), begin, end)
    at = begin[..., None] + 0.5 * (end - begin)[..., None] * (1.0 + node)
    width = np.diff(radii)[:, None]
    r = radii[:-1, None] + at * width
    return r, 0.5 * (end - begin)[..., None] * share * width, low[..., None] + at * slope[..., None]


def _refuse(scene) -> None:
    """Raises SceneError for what these balances do not know."""
    if len(scene.stator.waviness) != 1 or scene.rotor.waviness:
        found = f"{len(scene.stator.waviness)} waves of the stator, {len(scene.rotor.waviness)} of the rotor"
        raise SceneError("stator.waviness", found, "one of the stator, none of the rotor: wavy faces that wear")
    if scene.stator.elastic is not None:
        raise SceneError("stator.elastic", "a ring that bends", "nothing: its waves wear as those of a stiff ring")
    if scene.contact.law != "christensen":
        raise SceneError("contact.law", f'"{scene.contact.law}"', '"christensen" beside waves that wear')
    if scene.closing.balance_ratio is None:
        raise SceneError(
            "closing.balance_ratio", "nothing", "a value: worn faces rest where they carry the closing force"
        )


SEEN = ("waviness", "load_support", "leakage", "friction_power", "contact_force", "closing_force", "film_force",
        "contact_area_fraction", "contact_pressure", "h_min", "clearance", "wear_rate", "left_out")  # fmt: skip
# Shapes drawn; share of the rate that the shape of the depth leaves out beyond which it says so; angles of a shape.
LINES, COARSE, ANGLES = 6, 0.1, 129


def answer_of(balances, wears, rows, end, settings) -> Answer:
    """The answer of the rows of a history (studies/wear), of faces whose coefficients (1/Pa) are `wears`."""
    numbers = _numbers(balances, wears, rows, settings) | {"end": end}
    numbers["status"] = end["kind"] if end["kind"] in (Status.COLLAPSED, Status.FAILED) else Status.OK
    return Answer(numbers, _found(numbers), _tables(numbers), _panels(numbers), _limits(numbers, settings))


def _numbers(balances, wears, rows, settings) -> dict:
    """Histories, profiles of both faces (their means around the circle), waves of the gap and the balance of volume."""
    rows, basis = [row for row in rows if row["seen"]], balances.basis
    depth = np.array([row["depth"] for row in rows]).reshape(-1, len(basis.areas))
    even = depth[:, : basis.n]
    profile = {face: (k / sum(wears.values()) * even).tolist() for face, k in wears.items()}
    angle = 2.0 * math.pi / balances.wave.order * np.linspace(0.0, 1.0, ANGLES)
    amplitudes = np.array([row["seen"]["amplitudes"] for row in rows]).reshape(-1, balances.harmonics)
    phases = np.outer(np.arange(1, balances.harmonics + 1), balances.wave.order * angle + balances.wave.phase)
    history = {name: [row["seen"][name] for row in rows] for name in SEEN}
    history["time"] = [row["time"] for row in rows]
    for face in wears:
        history[f"{face}_volume"] = [basis.volume(np.array(one)) for one in np.pad(
            np.array(profile[face]).reshape(-1, basis.n), ((0, 0), (0, basis.cosines)))]  # fmt: skip
    volume, integral = (basis.volume(depth[-1]), rows[-1]["volume"]) if rows else (0.0, 0.0)
    return {
        "radius": basis.radius.tolist(), "waves": int(balances.wave.order), "made": balances.wave.amplitude,
        "travelling": balances.travelling, "coefficients": list(wears.values()), "profile": profile,
        "angle": angle.tolist(), "amplitudes": amplitudes.tolist(), "shape": (amplitudes @ np.cos(phases)).tolist(),
        "history": history, "life_share": settings.life,
        "life": _life(history["time"], history["waviness"], settings.life),
        "volume": {"profiles": volume, "integral": integral,
                   "residual": abs(volume - integral) / volume if volume else 0.0},
        "steps": max(len(rows) - 1, 0),
    }  # fmt: skip


def _life(time, waviness, share) -> float | None:
    """When (s) the waviness falls to a share of its first value, by a monotone cubic between steps; None if it does
    not."""
    if len(time) < 2 or min(waviness) > share * waviness[0]:
        return None
    return float(PchipInterpolator(time, np.array(waviness) / waviness[0]).solve(share, extrapolate=False)[0])


def _found(numbers) -> str:
    """How long the wave lives, what is left of it and what it carries."""
    said, history = numbers["end"]["said"], numbers["history"]
    said = f"{said[0].upper()}{said[1:]}"
    if not history["time"]:
        return f"{said}."
    if numbers["travelling"]:
        worn = max(max(one[-1]) for one in numbers["profile"].values())
        return f"{said}; travelling waves stay, and the faces lose {in_words('depth', worn)} at most."
    share = in_words("share", numbers["life_share"])
    life = f"in {in_words('time', numbers['life'])}" if numbers["life"] is not None else "not yet"
    carried = [in_words("share", history["load_support"][k]) for k in (0, -1)]
    made, left = (in_words("m", history["waviness"][k]) for k in (0, -1))
    return (
        f"{said}; the waves have fallen to {share} {life}, to {left} of {made} at the end; the film carries "
        f"{carried[0]}, then {carried[1]}."
    )


def _limits(numbers, settings) -> list[str]:
    """What the answer does not hold for."""
    most = max(numbers["history"]["left_out"], default=0.0)
    if most <= COARSE:
        return []
    return [
        f"Up to {in_words('share', most)} of the depth rate is not of the shape that the depth has: waves that wear "
        f"alike at every radius, with {settings.harmonics} harmonics."
    ]


def _tables(numbers) -> list[Table]:
    """The course over the hours."""
    columns = {"time": ("time", "time"), "waviness": ("m", "waviness"), "load_support": ("share", "load support"),
               "leakage": ("leakage", "leakage"), "friction_power": ("power", "friction"),
               "clearance": ("clearance", "clearance"), "wear_rate": ("wear_rate", "wear rate"),
               "stator_volume": ("volume", "stator worn"), "rotor_volume": ("volume", "rotor worn")}  # fmt: skip
    rows = zip(*(numbers["history"][name] for name in columns), strict=True)
    return [Table("history", list(columns.values()), [list(row) for row in rows])]


def _panels(numbers) -> list[Panel]:
    """The shape of one wave from early to late; beside, the course."""
    history = numbers["history"]
    if len(history["time"]) < 2:
        return [Panel("One wave", note=numbers["end"]["said"])]
    time = np.array(history["time"])
    shown = np.unique([int(np.argmin(np.abs(time - t))) for t in np.linspace(0.0, time[-1], LINES)])
    wave = [Series("line", numbers["angle"], numbers["shape"][k], style=f"{time[k] / time[-1]:.3g}",
                   label=in_words("time", time[k], digits=3)) for k in shown]  # fmt: skip
    radial = [Series("line", numbers["radius"], one[-1], label=face, style=face)
              for face, one in numbers["profile"].items() if max(one[-1]) > 0.0]  # fmt: skip
    over = Axis("time", "time of operation", low=0.0, high=float(time[-1]))
    level = [Level(numbers["life_share"] * history["waviness"][0], "life", style="contact dashed")]
    course = [
        ("Waviness", "m", "waviness", "film", level), ("Load support", "share", "load_support", "contact", []),
        ("Leakage", "leakage", "leakage", "leakage", []), ("Wear rate", "wear_rate", "wear_rate", "warn", []),
    ]  # fmt: skip
    return [
        Panel("One wave of the gap", Axis("angle"), Axis("m", "height"), wave),
        Panel("Worn off, mean around the circle", Axis("radius"), Axis("depth"), radial, down=True, below=False),
        *(Panel(title, over, Axis(quantity, " ", low=0.0), [Series("line", time.tolist(), history[name], style=style)],
                levels, below=k > 0, tall=0.6)
          for k, (title, quantity, name, style, levels) in enumerate(course)),
    ]  # fmt: skip
