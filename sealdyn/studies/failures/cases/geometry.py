"""Faces and angles: degenerate geometry, fronts of cavities and of choking, phases of long runs."""

import math
from dataclasses import replace
from decimal import Decimal, localcontext

import numpy as np
from scipy.integrate import solve_ivp

from ....analysis.sources.green_1989 import reference_scene
from ....closed_form import film_coefficients
from ....closed_form.zuk_1972 import MIL
from ....dynamics.imposed_motion import (
    OSCILLATOR_COUNT,
    OSCILLATORS,
    PER_RING,
    ROW,
    TILT_X,
    TILT_Y,
    harmonics_of_segment,
    imposed_state,
)
from ....dynamics.intervals import LONGEST, TURN, split_at_breaks
from ....dynamics.run_state import Concern
from ....faces.geometry import (
    DZ_RATE,
    FORCE,
    GAP_STATE_SIZE,
    GY,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_Y,
    OUTER_PRESSURE,
    TEMPERATURE,
    VISCOSITY,
)
from ....films import _gas_dam as sector
from ....films._radial_quadrature import RADIAL_POINTS, RULE_SIZE, RULES
from ....films.gas_dam import film as gas_dam
from ....films.radial import film as radial
from ....films.radial import floored
from ....films.radial.cavitated_line import cavitated_line
from ....quantities import in_words
from ....scenario.reader import Scenario
from ....scenario.tables import Run
from ....scene.excitation import AxialVibration, Housing, Shaft
from ....scene.film import Film
from ....scene.fluid import viscosity_of
from ....scene.patterns import waves_of
from ....scene.rings import ROTOR, Rotor, Stator, Support
from ....scene.scene import Scene
from ....simulation.selection import prepare_run
from . import cruise_dam, integrated, row, run_from

# Degenerate geometry: nearly flat faces in logarithmic formulas, zero tilt in Euler coordinates.

# Coning, of the clearance, at which logarithms of film thicknesses cancel.
FLAT = 0.01
# Coning over the face, of the clearance: a nanometre.
CONE = 1e-4
END, STEPS, MISS, OWN = 2e-3, 200, 1e-6, 10e-6


# --- nearly flat faces -----------------------------------------------------------------------------------


def squeeze_by_logarithms(inner_radius, width, clearance, ratio, log):
    """Axial damping over 24 pi mu r_m of a coned strip, h = clearance (1 + ratio x), x from 0 to 1 over the width:
    `[r_i (m2 - m1^2/m0) + (m3 - m1 m2/m0) width/2]/r_m`, m_n = int x^n/h^3 dx by partial fractions, as any table of
    integrals has them.  All numbers, and `log`, of one type."""
    b, q = ratio, 1 + ratio
    once, twice = 1 - 1 / q, (1 - 1 / q**2) / 2
    m0, m1 = twice / b, (once - twice) / b**2
    m2 = (log(q) - 2 * once + twice) / b**3
    m3 = (q - 1 - 3 * log(q) + 3 * once - twice) / b**4
    total = inner_radius * (m2 - m1**2 / m0) + width / 2 * (m3 - m1 * m2 / m0)
    return width**3 / clearance**3 * total / (inner_radius + width / 2)


def flat_faces() -> list[dict]:
    """Axial damping of a strip coned by a nanometre: logarithms in floating point, in sixty digits, radial film."""
    film = replace(reference_scene("FMR").film, model="radial", geometry="planar")
    width, h = film.outer_radius - film.inner_radius, film.clearance
    film = replace(film, coning=CONE * h / width)
    naive = squeeze_by_logarithms(film.inner_radius, width, h, film.coning * width / h, math.log)
    with localcontext() as context:
        context.prec = 60
        r_i, r_o, c, cone = map(Decimal, (film.inner_radius, film.outer_radius, h, film.coning))
        exact = float(squeeze_by_logarithms(r_i, r_o - r_i, c, cone * (r_o - r_i) / c, Decimal.ln))
    s = np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[DZ_RATE] = 1.0, 1.0
    radial.wrench(radial.parameters(film, h, 1e-13), s)
    found = -s[FORCE] / (12 * math.pi * (film.inner_radius + film.outer_radius))
    return row(
        5, "Flat faces", ("logarithmic formula cancels (1 nm of coning)", abs(naive / exact - 1)),
        ("rational map of the radial film", abs(found / exact - 1)), "relative error of the film damping",
        "evaluates every film by a map without a singular limit: flat, converging and diverging faces alike",
    )  # fmt: skip


# --- zero tilt -------------------------------------------------------------------------------------------


def equations():
    """Cartesian and Eulerian (nutation, precession) right-hand sides of Green's slender ring, driven by its own
    misalignment, which turns with the shaft."""
    scene = reference_scene("FMR", 3.0, turning=OWN)
    film, ring, w = scene.film, scene.rotor, scene.shaft.speed
    k_s, d_s = ring.support.tilt()
    found = film_coefficients(film.inner_radius, film.outer_radius, film.clearance, film.coning, film.viscosity,
                              film.outer_pressure - film.inner_pressure)  # fmt: skip
    inertia, polar = ring.transverse_inertia, ring.polar_inertia
    d, k, cross = d_s + found.tilt_damping, k_s + found.tilt_stiffness, w * (d_s + found.tilt_damping / 2)

    def cartesian(t, y):
        g, v = complex(y[0], y[1]), complex(y[2], y[3])
        push = k_s * OWN * np.exp(1j * w * t)
        a = (push - k * g - d * v + 1j * cross * g + 1j * polar * w * v) / inertia
        return [v.real, v.imag, a.real, a.imag]

    def eulerian(t, y):
        nutation, precession, rate, turning = y
        psi = precession - w * t
        inner = k_s * OWN * np.cos(psi) - k * nutation - d * rate - polar * w * turning * nutation
        across = (-d * turning + cross) * nutation + polar * w * rate - k_s * OWN * np.sin(psi)
        return [rate, turning, inner / inertia + turning**2 * nutation,
                (across / inertia - 2 * turning * rate) / nutation]  # fmt: skip

    return cartesian, eulerian, film.clearance / film.outer_radius, scene


def runge_kutta(slopes, y):
    """The classical method, equal steps."""
    t, h, y = 0.0, END / STEPS, np.array(y)
    for _ in range(STEPS):
        a = np.array(slopes(t, y))
        b = np.array(slopes(t + h / 2, y + h / 2 * a))
        c = np.array(slopes(t + h / 2, y + h / 2 * b))
        e = np.array(slopes(t + h, y + h * c))
        t, y = t + h, y + h / 6 * (a + 2 * b + 2 * c + e)
    return y


def zero_tilt() -> list[dict]:
    """A ring whose path passes zero tilt at 1 urad, in 200 equal Runge-Kutta steps; and a start at rest."""
    cartesian, eulerian, scale, scene = equations()
    back = solve_ivp(cartesian, (3e-4, 0), [0.0, MISS, 0.03, 0.08], "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    exact = solve_ivp(cartesian, (0, END), back, "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    exact = complex(exact[0], exact[1])
    g, v = complex(*back[:2]), complex(*back[2:])
    with np.errstate(all="ignore"):
        turn = v / g
        told = runge_kutta(eulerian, [abs(g), np.angle(g), turn.real * abs(g), turn.imag])
        nutation = told[0] * np.exp(1j * told[1])
        stopped = solve_ivp(eulerian, (0, END), [0.0] * 4, "DOP853", rtol=1e-9, atol=1e-15)
    sound = abs(complex(*runge_kutta(cartesian, back)[:2]) - exact) / scale
    run = run_from(scene, END, 1e-9)
    rest, _ = integrated(run, "adams", 1e-9)
    at_end = solve_ivp(cartesian, (0, END), [0.0] * 4, "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    place = run.model.unknowns.names.index("rotor_tilt_x")
    apart = abs(complex(*rest.y[place : place + 2]) - complex(*at_end[:2])) / scale
    default = "integrates the two tilts about fixed axes, which do not know of the nutation"
    error = abs(nutation - exact) / scale
    passed = row(5, "Zero tilt passed", ("Euler angles, 1 urad off zero tilt", error if np.isfinite(error) else None),
                 ("tilts about fixed axes", sound), "tilt, of clearance / radius", default)  # fmt: skip
    ended = f"Euler angles: 0/0 after {stopped.nfev} evaluations", None if stopped.status < 0 else 0.0
    return passed + row(5, "Start at zero tilt", ended, ("tilts about fixed axes", apart),
                        "tilt, of clearance / radius", default)  # fmt: skip


def meets_degenerate_geometry(scene, run) -> str:
    """Faces all but parallel, and not wavy."""
    if waves_of(scene):
        return ""
    gaps = [h for _, h in run.model.aligned_gaps()]
    apart = (max(gaps) - min(gaps)) / run.model.clearance
    if apart == 0.0:
        return "its faces are parallel"
    share = in_words("share", apart, digits=2)
    return f"its film is {share} of the clearance thicker at one edge than at the other" if apart < FLAT else ""


# Fronts: where a film begins to cavitate its force has a kink that an even grid around the circle never resolves;
# where it begins to choke, a jump of its second derivative.

ANGLES = 256


def tilted_film():
    """Block and gap state of flat faces without a pressure drop, tilted and turning: one half runs dry."""
    film = replace(reference_scene("FMR").film, model="radial", coning=0.0, outer_pressure=0.0, cavitation_pressure=0.0)
    s = np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[MEAN_SPIN], s[GY] = film.viscosity, 500.0, 0.6 * film.clearance / film.outer_radius
    # The ring also sinks, so that the front lies at no angle that a grid would have.
    s[DZ_RATE] = -1e-4
    return film, floored.parameters(film, film.clearance, 1e-10), s


def by_trapezoid(angles: int) -> float:
    """Force (N) with the floored lines of so many evenly spaced angles."""
    film, f, s = tilted_film()
    rule = RULES + RULE_SIZE * (len(RADIAL_POINTS) - 1)
    x, w = f[rule + 2 : rule + 2 + RADIAL_POINTS[-1]], f[rule + 2 + RADIAL_POINTS[-1] : rule + RULE_SIZE]
    total = 0.0
    for theta in (np.arange(angles) + 0.37) * 2 * math.pi / angles:
        h_i, h_o = (film.clearance - r * s[GY] * math.cos(theta) for r in (film.inner_radius, film.outer_radius))
        rate = s[MEAN_SPIN] * s[GY] * math.sin(theta)
        total += cavitated_line(x, w, film.inner_radius, film.outer_radius, h_i, h_o, s[DZ_RATE], rate, False, False,
                              s[VISCOSITY], 0.0, 0.0, 0.0, 0.0)[0]  # fmt: skip
    return total * 2 * math.pi / angles


def cavitation() -> list[dict]:
    """Error of the film force; the reference is the trapezoid of 200 000 angles, extrapolated."""
    coarse, fine = by_trapezoid(2**16), by_trapezoid(2**17)
    exact = fine + (fine - coarse) / 3
    _, f, s = tilted_film()
    floored.wrench(f, s)
    return row(
        8, "Cavitation front", (f"trapezoid of {ANGLES} angles", abs(by_trapezoid(ANGLES) / exact - 1)),
        ("circle split at the fronts", abs(s[FORCE] / exact - 1)), "relative error of the film force",
        "finds the angles where a line begins to be dry and integrates between them",
    )  # fmt: skip


# --- choking ------------------------------------------------------------------------------------------


def tilted_dam():
    """Block and gap state of Zuk's parallel dam at cruise, 0.22 mil and tilted by a fifth of that: choked on the wide
    side only."""
    film = cruise_dam(clearance=0.22 * MIL)
    s = np.zeros(GAP_STATE_SIZE)
    s[INNER_PRESSURE], s[OUTER_PRESSURE] = film.inner_pressure, film.outer_pressure
    s[TEMPERATURE], s[VISCOSITY], s[GY] = film.temperature, viscosity_of(film), 0.2 * film.clearance / film.outer_radius
    return film, gas_dam.parameters(film, film.clearance, 1e-8), s


def moment_of_sectors(count: int) -> float:
    """Moment (N m) about the tilt axis of so many evenly spaced sectors."""
    film, f, s = tilted_dam()
    g, out = f[gas_dam.DAM : gas_dam.DAM + sector.BLOCK_SIZE].copy(), np.empty(sector.DAM_SIZE)
    g[sector.TEMPERATURE] = film.temperature
    middle, total = 0.5 * (film.inner_radius + film.outer_radius), 0.0
    for cos in np.cos(np.arange(count) * 2 * math.pi / count):
        films = (film.clearance - r * s[GY] * cos for r in (film.inner_radius, film.outer_radius))
        sector.dam(g, *films, film.inner_pressure, film.outer_pressure, out)
        total -= (middle * out[sector.FORCE] + out[sector.MOMENT]) * cos
    return total * 2 * math.pi * middle / count


def choking() -> list[dict]:
    """Error of the film's moment; the reference has 8192 sectors, where the error falls with their cube."""
    _, f, s = tilted_dam()
    gas_dam.wrench(f, s)
    exact, few = moment_of_sectors(2**13), gas_dam.sectors_for(f, s)
    return row(
        8, "Choking", (f"{few} sectors, enough for 1e-8 without choking", abs(moment_of_sectors(few) / exact - 1)),
        ("more of them where some are choked", abs(s[MOMENT_Y] / exact - 1)), "relative error of the film moment",
        "asks the thinnest and the thickest place first and takes more sectors if one of them is choked",
    )  # fmt: skip


def meets_fronts(scene, run) -> str:
    """A film with a floor of its pressure, or a dam that chokes on a part of the circle."""
    film = run.model.interface.film
    if film.exit_mach is not None:
        low, high = film.exit_mach(run.model.f, run.segment(0).gap_state(0.0, run.y0))
        return "its gas is as fast as sound on a part of the circle" if low < 1.0 <= high else ""
    floored = scene.film.cavitation_pressure is not None and run.model.unknowns.film_unknowns is None
    return "film.cavitation_pressure: where the film tears its force has a kink" if floored else ""


# Phases after a million turns, and a tone above half the sampling.

# Turns after which the digits of an angle are worth a thought.
MANY = 1e5
SPEED, TURNS, STEPS_PER_TURN = 1047.1975511965977, 1e6, 4
TONE, SHAFT, SAMPLES = 5400.0, 16.0, 36

SCENE = Scene(
    shaft=Shaft(speed=2 * math.pi * SHAFT),
    film=Film(model="linear", inner_radius=0.032, outer_radius=0.040, clearance=1e-5, coning=3.125e-3,
              viscosity=0.5e-3, outer_pressure=5e5, inner_pressure=0.0),
    stator=Stator(mass=1.0, transverse_inertia=8e-4, polar_inertia=16e-4,
                  support=Support(axial_stiffness=5e5, axial_damping=300.0, radius=0.04)),
    housing=Housing(axial=[AxialVibration(frequency=TONE, displacement=1e-8)]),
)  # fmt: skip


def kernel_phase(leg, tau: float) -> complex:
    """exp(i phase) of a runout turning with the shaft, from the compiled kernel."""
    rows = harmonics_of_segment(Shaft(speed=SPEED), Housing(), Rotor(runout=1.0), Stator(), leg)
    p, c = np.zeros(OSCILLATORS + ROW * len(rows)), np.zeros(2 * PER_RING)
    p[OSCILLATOR_COUNT], p[OSCILLATORS:] = len(rows), rows.ravel()
    imposed_state(tau, p, c)
    return complex(c[PER_RING * ROTOR + TILT_X], c[PER_RING * ROTOR + TILT_Y])


def phases() -> list[dict]:
    """Shaft angle in the last 2000 of a million turns: one float product, floats added step by step, intervals."""
    leg = split_at_breaks(2 * math.pi * TURNS / SPEED, SPEED, 0.0, [])[-1]
    product = kept = added = 0.0
    with localcontext() as context:
        context.prec = 60
        for tau in np.linspace(0.0, leg.length, 101):
            start = Decimal(leg.start.numerator) / Decimal(leg.start.denominator)
            angle = float(Decimal(SPEED) * (start + Decimal(float(tau))) % TURN)
            exact = complex(math.cos(angle), math.sin(angle))
            naive = SPEED * (leg.time + tau)
            product = max(product, abs(complex(math.cos(naive), math.sin(naive)) - exact))
            kept = max(kept, abs(kernel_phase(leg, float(tau)) - exact))
        # `angle` is now that of the end.
        steps = int(TURNS * STEPS_PER_TURN)
        summed = np.cumsum(np.full(steps, SPEED * ((leg.time + leg.length) / steps)))[-1]
        added = abs(complex(math.cos(summed), math.sin(summed)) - exact)
    default = f"sets the clock anew every {LONGEST} turns and reduces each phase in exact arithmetic"
    survivor = "clock set anew, exact reduction", kept
    phase = row(10, "Phase after 1e6 turns", ("cos(w t) in floats", product), survivor, "rad", default)
    steps = f"{STEPS_PER_TURN} float steps a turn", added
    return phase + row(10, "Angle added step by step", steps, survivor, "rad", default)


def apparent(per_turn: int) -> float:
    """Frequency (Hz) of the tallest line of the sampled tone."""
    count = 16 * per_turn
    t = np.arange(count) / (SHAFT * per_turn)
    lines = np.abs(np.fft.rfft(np.cos(2 * math.pi * TONE * t)))
    return float(np.argmax(lines)) * SHAFT * per_turn / count


def warns(per_turn: int) -> bool:
    """Whether a run with so many samples a turn is warned of."""
    run, *_ = prepare_run(Scenario(SCENE, Run(turns=8, samples_per_turn=per_turn)))
    return any(caution.concern == Concern.ALIASING for caution in run.cautions)


def aliasing() -> list[dict]:
    """5.4 kHz on a 16 Hz shaft at 36 samples a turn, and at what the warning asks for."""
    enough = math.ceil(2 * TONE / SHAFT) + 1
    folded, right = apparent(SAMPLES), apparent(enough)
    said = "warned, and" if warns(SAMPLES) and not warns(enough) else "not warned;"
    return row(
        10, "5.4 kHz on a 16 Hz shaft", (f"{SAMPLES} samples a turn: seen at {folded:.0f} Hz", abs(folded - TONE)),
        (f"{said} right at {enough} a turn", abs(right - TONE)), "Hz off",
        "compares the fastest forcing with the sampling before the run and says how many samples it takes",
    )  # fmt: skip


def meets_long_runs(scene, run) -> str:
    """So many turns that the angle of the shaft loses digits, or a tone between the samples."""
    if any(caution.concern == Concern.ALIASING for caution in run.cautions):
        return "something is faster than its samples"
    turns = run.duration * abs(run.model.speed_at(run.intervals[-1])) / (2 * math.pi)
    return f"{turns:.3g} turns of the shaft" if turns > MANY else ""


EXHIBITS = {
    "degenerate_geometry": (5, (flat_faces, zero_tilt), meets_degenerate_geometry),
    "fronts": (8, (cavitation, choking), meets_fronts),
    "long_runs": (10, (phases, aliasing), meets_long_runs),
}
