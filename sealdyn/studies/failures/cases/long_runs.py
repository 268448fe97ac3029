"""Long runs and high frequencies: phases after a million turns, and a tone above half the sampling."""

import math
from decimal import Decimal, localcontext

import numpy as np

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
from ....scenario.reader import Scenario
from ....scenario.tables import Run
from ....scene.excitation import AxialVibration, Housing, Shaft
from ....scene.film import Film
from ....scene.rings import ROTOR, Rotor, Stator, Support
from ....scene.scene import Scene
from ....simulation.selection import prepare_run
from . import row

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
    return [
        row(10, "Phase after 1e6 turns", ("cos(w t) in floats", product), survivor, "rad", default),
        row(10, "Angle added step by step", (f"{STEPS_PER_TURN} float steps a turn", added), survivor, "rad",
            default),
    ]  # fmt: skip


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


def aliasing() -> dict:
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


def show_long_runs() -> list[dict]:
    """All three."""
    return [*phases(), aliasing()]


EXHIBITS = {"long_runs": (10, show_long_runs, meets_long_runs)}
