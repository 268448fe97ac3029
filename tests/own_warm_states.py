"""Warm states in the tests' own words: cone, asperities, liquid, heat and their balance; nothing of the program.

An aligned cone, h = c + coning (r - r_i): r h^3 p' constant, shear mu r speed / h, asperities of Christensen's heights.
Radii lie so that the film grows by equal factors from one to the next: along them every integrand is smooth.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

X, W = (part / 2 for part in leggauss(28))
X = X + 0.5
ZERO = 273.15
# Clearances that are looked at for one rise.
FINE = 640


@dataclass(frozen=True)
class OwnSeal:
    """Radii, pressures inside and outside, speed, sealed temperature, cold coning, closing force; rings as (resistance,
    coning per watt, time constant); an oil's (K, mm^2/s) points or None of water; roughness, strength and friction of
    asperities or None.  SI."""

    r_i: float
    r_o: float
    p_i: float
    p_o: float
    speed: float
    sealed: float
    coning: float
    balance: float
    spring: float
    rings: tuple
    oil: tuple | None
    rough: tuple | None

    @property
    def closing(self):
        high, low = max(self.p_i, self.p_o), min(self.p_i, self.p_o)
        area = math.pi * (self.r_o**2 - self.r_i**2)
        return area * (self.balance * high + (1.0 - self.balance) * low) + self.spring

    @property
    def conductance(self):
        return sum(1.0 / r for r, _, _ in self.rings)

    @property
    def per_kelvin(self):
        return sum(x / r for r, x, _ in self.rings)

    @property
    def capacity(self):
        return sum(tau / r for r, _, tau in self.rings)

    @property
    def highest(self):
        return (self.oil[1][0] if self.oil else ZERO + 150.0) - self.sealed

    def liquid(self, rise):
        """Viscosity (Pa s) and heat capacity of a volume (J/(m^3 K))."""
        t = self.sealed + np.asarray(rise, float)
        if self.oil:
            (t1, nu1), (t2, nu2) = self.oil
            w1, w2 = (math.log10(math.log10(nu + 0.7)) for nu in (nu1, nu2))
            w = w1 + (w2 - w1) * np.log10(t / t1) / math.log10(t2 / t1)
            return 870e-6 * (10.0 ** (10.0**w) - 0.7), 870.0 * 2000.0 * np.ones_like(t)
        c = (t - ZERO) / 100.0
        density = np.polyval((-6.14552, 26.7366, -65.0028, 2.74266, 1000.0), c)
        heat = np.polyval((93.198, -299.399, 427.949, -220.039, 4214.72), c)
        return np.exp(-10.57455285 + 552.34120971 / (t - 142.78519617)), density * heat

    def loads(self, rise, clearance):
        """Excess of opening over closing force (N), heat made (W), heat capacity of the leakage (W/K), dampings of the
        clearance (N s/m) and of the cone about r_i (N s/rad), of a rise (K) and a clearance (m) there; broadcast."""
        rise, clearance = np.broadcast_arrays(np.asarray(rise, float), np.asarray(clearance, float))
        mu, capacity = self.liquid(rise)
        width, slope = self.r_o - self.r_i, self.coning + self.per_kelvin * rise
        gaps = clearance, clearance + slope * width
        if self.rough:
            # Below 1.8 rms the film at an edge goes on as a hyperbola.
            floor = 1.8 * self.rough[0]
            films = [np.where(h >= floor, h, floor**2 / (2.0 * floor - np.minimum(h, floor))) for h in gaps]
        else:
            films = gaps
        growth = np.log(films[1] / films[0])
        growth = np.where(np.abs(growth) < 1e-7, 1e-7, growth)[..., None]
        along = np.expm1(X * growth) / np.expm1(growth)
        r, dr = self.r_i + width * along, W * width * growth * np.exp(X * growth) / np.expm1(growth)
        h = films[0][..., None] + (films[1] - films[0])[..., None] * along

        def moment(n):
            return np.sum(dr * r**n / h**3, axis=-1)

        # Force by parts: pi (p_o r_o^2 - p_i r_i^2) - int pi r^2 p' dr, p' = slope_p / (r h^3).
        low, one, three = moment(-1), moment(1), moment(3)
        slope_p = (self.p_o - self.p_i) / low
        force = math.pi * (self.p_o * self.r_o**2 - self.p_i * self.r_i**2 - slope_p * one)
        leakage = math.pi * np.abs(slope_p) / (6.0 * mu)
        power = 2.0 * math.pi * mu * self.speed**2 * np.sum(dr * r**3 / h, axis=-1)
        if self.rough:
            rms, strength, friction = self.rough
            x = np.minimum((gaps[0][..., None] + slope[..., None] * width * along) / (3.0 * rms), 1.0)
            share = 0.5 - 35.0 / 32.0 * (x - x**3 + 0.6 * x**5 - x**7 / 7.0)
            force = force + 2.0 * math.pi * strength * np.sum(dr * r * share, axis=-1)
            power = power + 2.0 * math.pi * strength * friction * self.speed * np.sum(dr * r**2 * share, axis=-1)
        power = power + leakage * abs(self.p_o - self.p_i)
        # Volumes that a rate of the gap displaces, r^2/2 and r^3/3 - r_i r^2/2, with the same slope of p as above.
        two, four = moment(2), moment(4)
        damping = 6.0 * math.pi * mu * (three - one**2 / low)
        cone = four / 3.0 - self.r_i * three / 2.0 - (two / 3.0 - self.r_i * one / 2.0) * one / low
        return force - self.closing, power, capacity * leakage, damping, 12.0 * math.pi * mu * cone

    def surplus(self, rise, clearance):
        """Heat made and not carried away (W)."""
        _, power, carried, *_ = self.loads(rise, clearance)
        return power - (self.conductance + carried) * rise

    def held(self, rises, points=80):
        """The widest clearances (m) at rises (n,) at which the excess falls through zero, the thinnest
        film above a thousandth of the cone's height; nan where it does not."""
        rises = np.asarray(rises, float)
        across = (self.coning + self.per_kelvin * rises) * (self.r_o - self.r_i)
        least, size = np.maximum(0.0, -across), np.maximum(np.abs(across), 1e-6)
        grid = least[:, None] + size[:, None] * np.geomspace(1e-3, 5e2, points)
        excess = self.loads(rises[:, None], grid)[0]
        falls = (excess[:, :-1] > 0.0) & (excess[:, 1:] <= 0.0)
        # An excess within rounding is none: flat faces carry the same load at any clearance.
        falls &= np.maximum(np.abs(excess[:, :-1]), np.abs(excess[:, 1:])) > 1e-9 * self.closing
        some = falls.any(axis=1)
        last = falls.shape[1] - 1 - np.argmax(falls[:, ::-1], axis=1)
        low, high = grid[np.arange(len(rises)), last], grid[np.arange(len(rises)), last + 1]
        for _ in range(48):
            middle = 0.5 * (low + high)
            opens = self.loads(rises, middle)[0] > 0.0
            low, high = np.where(opens, middle, low), np.where(opens, high, middle)
        return np.where(some, 0.5 * (low + high), np.nan)

    def states(self, points=300):
        """Every (rise, clearance) of balance that a dense scan of the rise finds."""
        rises = np.unique(np.concatenate([
            self.highest * np.geomspace(1e-6, 1.0, points // 2), np.linspace(0.0, self.highest, points // 2),
        ]))  # fmt: skip
        clearances = self.held(rises, 160 if points > 600 else 80)
        left, found = self.surplus(rises, clearances), []

        def at(rise):
            return float(self.surplus(rise, self.held([rise], FINE)[0]))

        for k in np.flatnonzero(left[:-1] * left[1:] < 0.0):
            rise = brentq(at, rises[k], rises[k + 1], xtol=1e-12, rtol=1e-12)
            found.append((rise, float(self.held([rise], FINE)[0])))
        return found

    def loop_gain(self, rise):
        """Change of the heat with the rise, the clearance following, over that of what leaves."""
        step = 1e-4 * max(rise, 1e-3)
        ends = [float(self.loads(t, self.held([t], FINE)[0])[1]) for t in (rise - step, rise + step)]
        carried = float(self.loads(rise, self.held([rise], FINE)[0])[2])
        return (ends[1] - ends[0]) / (2.0 * step) / (self.conductance + carried)

    def growth(self, rise, clearance, period):
        """Growth rate (1/s) of a small departure from a state, from two motions of rise and clearance sampled every
        `period` (s): the largest factor of the map from one sample to the next."""

        small = 1e-5

        def rates(_, departure):
            t, c = rise * (1.0 + small * departure[0]), clearance * (1.0 + small * departure[1])
            excess, _, _, damping, cone = self.loads(t, c)
            warmed = float(self.surplus(t, c)) / self.capacity
            squeezed = float((excess - cone * self.per_kelvin * warmed) / damping)
            return np.array([warmed / (rise * small), squeezed / (clearance * small)])

        # A state balances as well as it is known: what is left would be taken for growth.
        left = rates(0.0, (0.0, 0.0))
        times, sampled = np.arange(4) * period, []
        for start in ((1.0, 0.0), (0.0, 1.0)):
            motion = solve_ivp(
                lambda t, y: rates(t, y) - left, (0.0, times[-1]), start, "Radau", times, rtol=1e-6, atol=1e-6
            )
            sampled.append(motion.y)
        before, after = (np.hstack([y[:, s] for y in sampled]) for s in (slice(0, 3), slice(1, 4)))
        factors = np.linalg.eigvals(np.linalg.lstsq(before.T, after.T, rcond=None)[0])
        return float(np.log(np.max(np.abs(factors))) / period)


def drawn(rng, contact=None, inside=None):
    """A random seal: water or oil, sealed outside or inside, with or without asperities."""
    inside = rng.random() < 0.4 if inside is None else inside
    contact = rng.random() < 0.3 if contact is None else contact
    oil = ((313.15, 32.0), (373.15, 5.4)) if rng.random() < 0.3 else None
    r_i = rng.uniform(0.02, 0.05)
    high, low = 10.0 ** rng.uniform(5.6, 6.5), 1e5
    coning = 10.0 ** rng.uniform(-4.7, -3.2) * (-1.0 if inside else 1.0)
    if rng.random() < 0.15:
        # Nearly flat when cold, or closing.
        coning = rng.uniform(-3e-5, 3e-5)
    rings = tuple(
        (10.0 ** rng.uniform(-1.5, 0.0), rng.uniform(-0.05, 1.0) * 10.0 ** rng.uniform(-6.5, -5.3),
         10.0 ** rng.uniform(-0.5, 1.3))
        for _ in range(rng.integers(1, 3))
    )  # fmt: skip
    return OwnSeal(
        r_i=r_i, r_o=r_i + rng.uniform(0.0025, 0.006), p_i=high if inside else low, p_o=low if inside else high,
        speed=10.0 ** rng.uniform(1.7, 2.9), sealed=rng.uniform(315.0, 345.0) if oil else rng.uniform(280.0, 350.0),
        coning=coning, balance=rng.uniform(0.62, 0.85), spring=rng.uniform(10.0, 100.0), rings=rings, oil=oil,
        rough=(10.0 ** rng.uniform(-7.3, -6.5), 10.0 ** rng.uniform(7.5, 8.5), rng.uniform(0.05, 0.15))
        if contact else None,
    )  # fmt: skip


def as_changes(seal):
    """What makes the pump of warm_seals.py this seal."""
    names = ("stator", "rotor")
    heat = {
        name: {"resistance": r, "coning_per_watt": x, "time_constant": tau}
        for name, (r, x, tau) in zip(names, seal.rings, strict=False)
    }
    liquid = "water"
    if seal.oil:
        points = [[t, f"{nu!r} mm^2/s"] for t, nu in seal.oil]
        liquid = {"density": 870.0, "specific_heat": 2000.0, "viscosity": points}
    changes = {
        "film.inner_radius": seal.r_i, "film.outer_radius": seal.r_o, "film.inner_pressure": seal.p_i,
        "film.outer_pressure": seal.p_o, "shaft.speed": seal.speed, "film.temperature": seal.sealed,
        "film.coning": seal.coning, "closing.balance_ratio": seal.balance, "closing.spring_force": seal.spring,
        "film.liquid": liquid, "film.heat": heat,
    }  # fmt: skip
    if seal.rough:
        rms, strength, friction = seal.rough
        changes["contact"] = {
            "roughness": rms, "compressive_strength": strength, "friction_coefficient": friction,
        }  # fmt: skip
    return changes
