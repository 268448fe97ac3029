"""Films that store: choked flow, trapped gas, and cavities that follow the faces with their liquid."""

import math
from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import bisect, brentq
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu, spsolve

from ....analysis.sources import lebeck_1979
from ....closed_form.zuk_1972 import CRUISE, MIL
from ....dynamics.condensation import FilmDerivatives, LinearFilm
from ....dynamics.imposed_motion import rest_state
from ....dynamics.interface import Interface
from ....faces.geometry import (
    DZ,
    FLOW_INNER,
    FORCE,
    GAP_STATE_SIZE,
    INNER_PRESSURE,
    MEAN_SPIN,
    OUTER_PRESSURE,
    TEMPERATURE,
    VISCOSITY,
)
from ....faces.roughness import mean_film_cubed
from ....films import _gas_dam as sector
from ....films.gas_reynolds import film as gas
from ....films.gas_reynolds.cells import GRADING
from ....films.reynolds.mesh import AREA, SECTORS, films, table
from ....quantities import in_words
from ....scene.film import Film
from ....scene.fluid import GasReynolds, gas_of
from ....solvers.own_methods import D, W
from . import row

# Choked gas flow: marched with the flow, a gas dam's equation is singular where it chokes and repels where it widens.
#
#     d(M^2)/dx = 2 M^2 (1 + d M^2) (g f M^2 - h')/((1 - M^2) h),   d = (g - 1)/2
#
# of Zuk (1972), laminar, at his cruise condition; followed upstream it is regular at M = 1 and comes nearer to the line
# M^2 = h'/(g f) instead of leaving it.

STEPS = 20
# Faces that narrow outwards by 2 mrad at 0.3 mil; films from 0.45 to 1.35 mil.
WIDTH = CRUISE.outer_radius - CRUISE.inner_radius
NARROWING = 0.3 * MIL + 1e-3 * WIDTH, 0.3 * MIL - 1e-3 * WIDTH
WIDENING = 0.45 * MIL, 1.35 * MIL
# What the widening dam's entrance Mach number is off, relative.
OFF = 1e-9
EXCESS = (CRUISE.heat_ratio - 1) / 2


def solved(films) -> np.ndarray:
    """The program's solution (films/_gas_dam.py) of the choked dam with films (m) at the entrance and the exit."""
    gas = {"gas_constant": CRUISE.gas_constant, "heat_ratio": CRUISE.heat_ratio, "sutherland": CRUISE.sutherland}
    radii, out = (CRUISE.inner_radius, CRUISE.outer_radius), np.empty(sector.DAM_SIZE)
    f = sector.parameters(*radii, CRUISE.temperature, friction="laminar", width="constant", **gas)
    if sector.dam(f, *films, CRUISE.high_pressure, CRUISE.low_pressure, out) != sector.SOLVED:
        raise RuntimeError("the gas dam was not solved")
    return out


def entrance(mach, film) -> tuple[float, float]:
    """Mass flow (kg/(m s)) and friction factor that an entrance Mach number makes."""
    g, cooling = CRUISE.heat_ratio, 1 + EXCESS * mach**2
    temperature, (factor, s) = CRUISE.temperature / cooling, CRUISE.sutherland
    pressure = CRUISE.high_pressure / cooling ** (g / (g - 1))
    flow = pressure * film * mach * math.sqrt(g / (CRUISE.gas_constant * temperature))
    return flow, 24 * factor * temperature**1.5 / (temperature + s) / (2 * flow)


def slopes(m, x, films, friction) -> tuple[float, float]:
    """d(M^2) and dx over a common measure, which is regular: x grows, and M^2 with it, as long as M < 1."""
    taper = (films[1] - films[0]) / WIDTH
    h = films[0] + taper * x
    return 2 * m * (1 + EXCESS * m) * (CRUISE.heat_ratio * friction * m - taper), (1 - m) * h


def runge_kutta(mach, films) -> float:
    """Mach number at the exit by so many classical steps with the flow; infinite if it is sonic before."""
    friction, m, step = entrance(mach, films[0])[1], mach**2, WIDTH / STEPS

    def rate(m, x):
        change, dx = slopes(m, x, films, friction)
        return change / dx if m < 1 else math.inf

    for k in range(STEPS):
        x = k * step
        k_1 = rate(m, x)
        k_2 = rate(m + step / 2 * k_1, x + step / 2)
        k_3 = rate(m + step / 2 * k_2, x + step / 2)
        m += step / 6 * (k_1 + 2 * k_2 + 2 * k_3 + rate(m + step * k_3, x + step))
        if not m < 1:
            return math.inf
    return math.sqrt(m)


def with_the_flow(mach, films) -> tuple[float, float]:
    """Where along the dam (share of its width) a march in ever smaller steps ends, and the Mach number there."""
    friction = entrance(mach, films[0])[1]

    def edge(_, y):
        return y[1] - WIDTH

    def sonic(_, y):
        return y[0] - 1

    edge.terminal = sonic.terminal = True
    done = solve_ivp(lambda _, y: slopes(*y, films, friction), (0, 1e4 * WIDTH / films[0]), [mach**2, 0.0], "DOP853",
                     events=(edge, sonic), rtol=1e-12, atol=[1e-14, 1e-14 * WIDTH])  # fmt: skip
    return float(done.y[1, -1] / WIDTH), math.sqrt(done.y[0, -1])


def upstream(films) -> float:
    """Entrance Mach number of the choked dam: the one that a march upstream from the sonic exit arrives with."""

    def arrived(mach):
        friction = entrance(mach, films[0])[1]

        def edge(_, y):
            return y[1]

        edge.terminal = True
        done = solve_ivp(lambda _, y: -np.array(slopes(*y, films, friction)), (0, 1e4 * WIDTH / films[1]),
                         [1.0, WIDTH], "DOP853", events=edge, rtol=1e-13, atol=[1e-15, 1e-15 * WIDTH])  # fmt: skip
        return math.sqrt(done.y[0, -1])

    # A sonic exit needs h' < g f: a large flow has too little friction for it.
    taper = (films[1] - films[0]) / WIDTH
    most = 0.999
    if entrance(most, films[0])[1] * CRUISE.heat_ratio < taper:
        most = brentq(lambda mach: entrance(mach, films[0])[1] * CRUISE.heat_ratio - 1.0001 * taper, 1e-3, most)
    return brentq(lambda mach: mach - arrived(mach), 1e-3, most, xtol=1e-14, rtol=1e-14)


def meets_choked_gas(scene, run) -> str:
    """A dam that chokes somewhere at the start."""
    film = run.model.interface.film
    if film.exit_mach is None:
        return ""
    mach = film.exit_mach(run.model.f, run.segment(0).gap_state(0.0, run.y0))[1]
    return "its gas is as fast as sound at the exit" if mach >= 1.0 else ""


def show_choked_gas() -> list[dict]:
    """Leakage of a choked dam, and where a march through a widening one arrives."""
    found, right = solved(NARROWING), entrance(upstream(NARROWING), NARROWING[0])[0]
    largest = bisect(lambda mach: -1.0 if runge_kutta(mach, NARROWING) < 1 else 1.0, 1e-3, 0.9)
    marched = entrance(largest, NARROWING[0])[0]
    line, truth = solved(WIDENING)[sector.ENTRANCE_MACH], upstream(WIDENING)
    slow, fast = (with_the_flow(line * (1 + off), WIDENING) for off in (-OFF, OFF))
    return row(
        13, "Choked exit", (f"Runge-Kutta, {STEPS} steps to the exit", marched / right - 1),
        ("closed form, from the exit upstream", abs(found[sector.MASS_FLOW] / right - 1)), "leakage, relative",
        "follows the flow upstream in closed form: no steps, and nothing singular at M = 1",
    ) + row(
        13, "Invariant line",
        (f"march: sonic at {in_words('share', fast[0], digits=2)} of the dam, or M2 = {slow[1]:.2g}, {OFF:g} apart",
         1 - slow[1]),
        ("closed form, from the sonic exit upstream", abs(line - truth)), "Mach number where it arrives",
        "goes upstream, where flows approach the line M^2 = h'/(g f), which they leave the other way",
    )  # fmt: skip


# Trapped gas: squeezed faster than it can flow out, a gas film is a spring, whatever it is to slow motion.
#
# Between narrow parallel faces at equal pressures p, squeezed at the frequency w, of p A/h
#
#     K + i w D = 1 - tanh z/z,   z = (L/2) sqrt(12 i w mu/(p h^2))
#
# at slow motion no stiffness and a damping of z^2/3, at fast motion p A/h and hardly any damping: what flows does so in
# a layer at both edges, of a width L/|z|.
# **Source** Langlois (1962), Quart. Appl. Math. 20, 131, for a long strip; derived here.

PRESSURE, CLEARANCE, MU, INNER, OUTER = 2e5, 5e-6, 1.8e-5, 0.0396, 0.040
# Squeeze numbers 12 w mu L^2/(p h^2) of a whirl in a stiff gas film, and of an edge layer of a twentieth of the width.
FAST, FASTEST, CELLS = 1e3, 2e3, 24


def exact(squeeze_number: float) -> complex:
    """K + i w D over p A/h."""
    z = 0.5 * np.sqrt(1j * squeeze_number)
    return complex(1.0 - np.tanh(z) / z)


def of_the_film(squeeze_number: float, grading: float = GRADING) -> tuple[complex, complex]:
    """The same of the film's cells, at this frequency and with the stiffness and damping of slow motion."""
    film = Film(
        inner_radius=INNER, outer_radius=OUTER, inner_pressure=PRESSURE, outer_pressure=PRESSURE, viscosity=MU,
        gas="air", temperature=300.0, model="gas_reynolds", clearance=CLEARANCE,
        gas_reynolds=GasReynolds(cells=(CELLS, 8)),
    )  # fmt: skip
    f, s = gas.parameters(film, CLEARANCE, grading=grading), np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[TEMPERATURE], s[INNER_PRESSURE], s[OUTER_PRESSURE] = MU, 300.0, PRESSURE, PRESSURE
    unknowns = gas.unknowns(f)
    x = np.empty(len(unknowns.names))
    if gas.start(f, s, x):
        raise RuntimeError("the gas film was not solved")
    step, pace = 1e-2 * CLEARANCE, 1e3
    steps = (step, step / OUTER, step * pace, step * pace / OUTER)
    linear = LinearFilm.about(FilmDerivatives(gas.FILM, unknowns, f), s, x, steps)
    omega = squeeze_number * PRESSURE * CLEARANCE**2 / (12.0 * MU * (OUTER - INNER) ** 2)
    stiff = PRESSURE * math.pi * (OUTER**2 - INNER**2) / CLEARANCE
    both = (linear.matrices(frequency) for frequency in (omega, 0.0))
    own, slow = (complex(k[0, 0], omega * d[0, 0]) / stiff for k, d in both)
    return own, slow


def meets_trapped_gas(scene, run) -> str:
    """A gas film that stores."""
    stores = run.model.unknowns.film_unknowns is not None and gas_of(scene.film) is not None
    return "its film stores gas" if stores else ""


def show_trapped_gas() -> list[dict]:
    """Dynamic stiffness by constant coefficients and at its own frequency; with even cells and with narrow ones."""
    right, right_fast = exact(FAST), exact(FASTEST)
    own, slow = of_the_film(FAST)
    graded, even = (of_the_film(FASTEST, grading)[0] for grading in (GRADING, 0.0))

    def off(found, true):
        return abs(found - true) / abs(true)

    return row(
        13, "Trapped gas", (f"K and D of slow motion, at a squeeze number of {FAST:g}", off(slow, right)),
        ("the film at its own frequency", off(own, right)), "dynamic stiffness, relative",
        "keeps the gas of every cell as an unknown; modes and responses meet the film at their own frequency",
    ) + row(
        13, "Layer at the edge",
        (f"{CELLS} even cells, at a squeeze number of {FASTEST:g}", off(even, right_fast)),
        (f"{CELLS} cells, narrow at the edges", off(graded, right_fast)), "dynamic stiffness, relative",
        "lays narrow cells where fast squeezed gas escapes, and says what half as many cells differ",
    )  # fmt: skip


# Cavities that move: Lebeck's seal with three waves, its clearance swinging with the shaft: the cavity behind each
# crest takes up liquid and gives it back, neither at once nor not at all.
# **Source** the film about its rest, linearised (dynamics/condensation.py), and the same motion step by step.

CAVITY_CELLS, TURNS, CAVITY_STEPS, SWING = (6, 36), 3, 64, 1e-4
SPEED = lebeck_1979.SPEED


@cache
def seal():
    """The film at rest: Interface, gap state, and linearised over the whole circle."""
    interface = Interface(lebeck_1979.scene_of(lebeck_1979.ROWS[1], CAVITY_CELLS), 1e-8)
    s, steps = rest_state(interface.scene, interface.clearance)
    return interface, s, interface.linear_film(s, steps)


def frozen_damping(linear) -> float:
    """Axial damping (N s/m) of pressures alone, with every cavity as large as it is at rest."""
    n = len(linear.by_gap) // 2
    pressed = splu(linear.by_x.tocsc()[:n, :n]).solve(linear.by_gap_rate[:n, 0])
    return float(linear.force_by_x[0, :n] @ pressed - linear.force_by_gap_rate[0, 0])


def swung(euler: bool) -> complex:
    """Axial dynamic stiffness (N/m) from the film's force while the gap swings with the shaft, CAVITY_STEPS to a
    turn; by implicit `euler`, or by TR-BDF2."""
    interface, rest, _ = seal()
    film, f, s = interface.film, interface.f, rest.copy()
    x, h, swing = interface.steady(f, s), 2.0 * math.pi / SPEED / CAVITY_STEPS, SWING * interface.clearance
    rate, forces, times = np.zeros_like(x), [], h * np.arange(1, TURNS * CAVITY_STEPS + 1)

    def stage(t, alpha, base):
        s[DZ] = swing * math.sin(SPEED * t)
        if film.settle(f, s, alpha, base, x):
            raise RuntimeError("the film was not solved")
        return alpha * (x - base)

    for t in times:
        at, begun = x.copy(), t - h
        if euler:
            stage(t, 1.0 / h, at)
        else:
            first = stage(begun + 2.0 * D * h, 1.0 / (D * h), at + D * h * rate)
            rate = stage(t, 1.0 / (D * h), at + h * W * (rate + first))
        film.wrench(f, s, x)
        forces.append(s[FORCE] - rest[FORCE])
    last = slice(-CAVITY_STEPS, None)
    forces = np.array(forces[last]) - np.mean(forces[last])
    # sin(w t) is the imaginary part of exp(i w t).
    return complex(-2.0 * np.mean(forces * 1j * np.exp(-1j * SPEED * times[last])) / swing)


def leakage_by_reynolds_condition() -> tuple[float, float]:
    """Leakage (m^3/s) where pressures are held above cavitation without a thought for the liquid, and where it is kept:
    the pressure is least, and its slope nothing, at the edge of a cavity; what flows there comes from nowhere."""
    interface, rest, _ = seal()
    f, s = interface.f, rest.copy()
    _, carried, ways, around = films(f, s)
    angles, cells = carried.shape
    own, area = np.arange(angles * cells).reshape(angles, cells), table(f, AREA)[:cells]
    rows, columns, values = [], [], []

    def between(a, b, way):
        for i, j, sign in ((a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)):
            rows.append(i.ravel()), columns.append(j.ravel()), values.append((sign * way).ravel())

    between(own[:, :-1], own[:, 1:], ways[:, 1:-1])
    between(own, np.roll(own, -1, 0), around)
    for edge, way in ((own[:, 0], ways[:, 0]), (own[:, -1], ways[:, -1])):
        rows.append(edge), columns.append(edge), values.append(way)
    whole = csc_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))))
    right = s[MEAN_SPIN] * area * (np.roll(carried, 1, 0) - carried)
    right[:, 0] += ways[:, 0] * s[INNER_PRESSURE]
    right[:, -1] += ways[:, -1] * s[OUTER_PRESSURE]
    right, full = right.ravel(), np.full(angles * cells, True)
    while True:
        p = np.zeros(len(right))
        p[full] = spsolve(whole[full][:, full], right[full])
        now = np.where(full, p >= 0.0, right - whole @ p > 0.0)
        if np.array_equal(now, full):
            break
        full = now
    inner = f[SECTORS] * float(ways[:, 0] @ (p.reshape(angles, cells)[:, 0] - s[INNER_PRESSURE]))
    interface.film.flow(f, s, interface.steady(f, s))
    return inner, -float(s[FLOW_INNER])


def leakage_of_the_mean_cube() -> float:
    """Leakage (m^3/s) in closed form: weighted with ln r the balance of all cells leaves a flow through the mean of
    E(H^3), wherever cavities are, for what is dragged around the circle comes back."""
    interface, half = seal()[0], lebeck_1979.HALF
    film = interface.scene.film
    waves = lebeck_1979.ROWS[1].amplitude * np.cos(2.0 * math.pi * np.arange(4096) / 4096)
    cube = half**3 * float(np.mean(mean_film_cubed(interface.clearance / half + waves)))
    fall = film.outer_pressure - film.inner_pressure
    return 2.0 * math.pi * cube * fall / (12.0 * film.viscosity * math.log(film.outer_radius / film.inner_radius))


def meets_moving_cavity(scene, run) -> str:
    """A film of cells that tear and fill."""
    return "cavities that keep their liquid move in its film" if run.model.interface.film.settle is not None else ""


def show_moving_cavity() -> list[dict]:
    """Stiffness of slow motion, damping of a frozen cavity, implicit Euler, Reynolds' condition."""
    interface, rest, linear = seal()
    interface.film.wrench(interface.f, rest, interface.steady(interface.f, rest))
    k, d = (float(part[0, 0]) for part in linear.matrices(SPEED))
    true = complex(k, SPEED * d)
    kept, euler = swung(False), swung(True)
    loose, right = leakage_by_reynolds_condition()
    slow = float(linear.slow[0][0, 0])
    by_steps = "the motion step by step, TR-BDF2, 64 steps a turn"
    keeps = "keeps the liquid of every cell as an unknown"
    at_once, frozen = abs(slow / k - 1.0), abs(frozen_damping(linear) / d - 1.0)
    return [
        *row(14, "Cavity that follows at once", ("stiffness of slow motion, at shaft speed", at_once),
             (by_steps, abs(kept.real / k - 1.0)), "axial film stiffness, relative", keeps),
        *row(14, "Frozen cavity", ("damping of the pressures alone", frozen),
             (by_steps, abs(kept.imag / SPEED / d - 1.0)), "axial film damping, relative", keeps),
        *row(14, "Implicit Euler", ("implicit Euler, 64 steps a turn", abs(euler - true) / abs(true)),
             ("TR-BDF2, 64 steps a turn", abs(kept - true) / abs(true)), "dynamic stiffness, relative",
             "steps with TR-BDF2 where cells tear and fill"),
        *row(14, "Reynolds' condition", ("p >= p_cav alone", abs(loose / right - 1.0)),
             ("void and pressure, the liquid kept", abs(right / leakage_of_the_mean_cube() - 1.0)), "leakage, relative",
             "keeps the liquid; a floor of the radial film says that it does not"),
    ]  # fmt: skip


EXHIBITS = {
    "choked_gas": (13, (show_choked_gas,), meets_choked_gas),
    "trapped_gas": (13, (show_trapped_gas,), meets_trapped_gas),
    "moving_cavity": (14, (show_moving_cavity,), meets_moving_cavity),
}
