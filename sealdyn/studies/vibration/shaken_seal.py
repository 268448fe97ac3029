"""Small motion of a seal whose housing shakes, about its aligned equilibrium, and the acceleration that closes it; and
the nonlinear film shaken by a tone of the housing, until its motion repeats.

The housing carries the stator, on its support or rigidly; the shaft stands still.  With film K_f, D_f, support K, D and
inertia m of the ring that floats the gap moves, per unit motion of the housing at the angular frequency w, along z
    FMS: (K + i w D) / (K + K_f - m w^2 + i w (D + D_f))
    FMR: (K - m w^2 + i w D) / (K + K_f - m w^2 + i w (D + D_f))
and in tilt likewise with the wedge and the gyroscopic moment, which make an ellipse of it; with both rings afloat and
films that store the same balance of complex forces has the film's answer at that frequency.
**Source** equations of one ring on support and film (Green 1989, eqs. 1 and 2), the housing's motion added.
**Valid** motion that is small beside the film, stable seals.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.constants import g

from ...dynamics.extrema import H
from ...dynamics.model import Model
from ...dynamics.modes import Harmonic, verdict
from ...dynamics.run_state import RunState
from ...faces.geometry import DZ, GX, GY
from ...quantities import in_words
from ...scene.excitation import AngularVibration, AxialVibration, Housing
from ...scene.forces import touch_height
from ...scene.patterns import waves_of
from ...scene.rings import STATOR
from ...scene.scene import Initial, Scene, SceneError, frozen_at_start, unforced
from ...simulation.margin import largest_tilt, steady_state
from ...simulation.selection import choose_method
from ...simulation.verification_run import price
from ...solvers.contract import Cause, Recorder, SolverFailure, Status
from ...solvers.integrate import Outcome, solve

# Motion of the housing (z, tilt about x, tilt about y), and which modes it excites.
SHAPES = {"axial": (1.0, 0.0, 0.0), "angular": (0.0, 1.0, 0.0)}
KINDS = {"axial": "axial", "angular": "tilt"}
# Damping ratio from which a mode is not said to swing.
STILL = 0.995
# Small motion: share of the acceleration that closes the film by linear theory; what may be left of the transient, at
# first and of a step in acceleration; samples of a period.
SMALL, LEFT, LEFT_OF_STEP, PER_PERIOD = 2e-3, 1e-6, 1e-3, 64
# Accuracy of small motion, of films that store, which cost a hundred times more, and on the way to touch.
ACCURACY, STORED, ROUGHLY = 1e-8, 1e-6, 1e-5
# Accuracy over the share of the clearance to which rounding knows where the housing is: a stiff solver that is asked
# for more follows the rounding, in steps a hundred times too small.
ABOVE_ROUNDING = 1e4
# The way to touch, in the linear one: where it begins, first and last step (factors), where it ends.
BEGIN, STEP, LAST, MOST = 0.5, 1.25, 1.01, 10.0
# Acceleration (m/s^2) of linear touch, of angular vibration at the outer edge, beyond which nobody shakes a seal;
# tilt (rad) of the housing beyond which tilts are not small; compiled evaluations that a tone may cost in all, a few
# seconds.
BEYOND, TILTED, MOST_WORK = 1000.0 * g, 0.1, 400_000
# Periods that a transient may take, and how often it may take more than expected.
LONGEST, AGAIN = 1000, 4


class ShakenSeal:
    """A scene of which nothing moves but its housing.

    `model` of the aligned seal and its `linear` scene; `gaps` [(radius, film thickness)] (m) of the aligned faces where
    they may touch first, crests of waves taken off; `level` (m): the film at which they touch, the height of the
    asperities, or nothing where the faces are smooth or their asperities touch at rest (`riding`); `own` (m, rad): by
    how much the scene's own runout and misalignment close the gap axially, and tilt it.  Raises SceneError for a seal
    that is not stable, or not damped.
    """

    def __init__(self, scene: Scene):
        scene = replace(frozen_at_start(scene), housing=Housing(), initial=Initial())
        self.scene = replace(unforced(scene, scene.shaft.speed), initial=Initial())
        self.model = Model(self.scene)
        self.linear, self._at = self.model.linear_scene(), {}
        self.modes = self.linear.modes()
        if verdict(self.modes) != "stable":
            found = f"{in_words('speed', scene.shaft.speed)}, at which small motion does not die out"
            raise SceneError("shaft.speed", found, "a speed at which the seal is stable (sealdyn study critical-speed)")
        crests, shift = sum(wave.amplitude for wave in waves_of(self.model.scene)), self.model.axial_shift()
        self.gaps = [(r, h + shift - crests) for r, h in self.model.aligned_gaps()]
        rough, self.thinnest = touch_height(scene), min(h for _, h in self.gaps)
        self.riding = self.thinnest <= rough and rough > 0.0
        self.level = 0.0 if self.riding else rough
        tilt, _, closing, _ = steady_state(Model(scene))[-1]
        self.own = closing, tilt

    def gap_motion(self, direction: str, frequency: float) -> np.ndarray:
        """Complex amplitude (3,) of (dz, g_x, g_y) (m, rad), stator minus rotor, per unit motion (m, or rad about the x
        axis) of the housing in a `direction` ("axial" | "angular") at a `frequency` (Hz)."""
        shape, none = np.array(SHAPES[direction], dtype=complex), np.zeros(3, dtype=complex)
        shaken = Harmonic(2 * math.pi * frequency, STATOR, shape, none)
        # A film that stores is asked once at a frequency.
        if frequency not in self._at:
            self._at[frequency] = self.linear.at_frequency(shaken.frequency)
        linear = self._at[frequency]
        return linear.relative(shaken, linear.response(shaken))

    def gain(self, direction: str, frequency: float) -> float:
        """Largest motion of the gap over a period per unit motion of the housing: m/m axially, rad/rad in tilt."""
        axial, tilt = sizes(self.gap_motion(direction, frequency))
        return axial if direction == "axial" else tilt

    def touch(self, direction: str, frequency: float, aligned: bool = False) -> float:
        """Amplitude of the housing's acceleration (m/s^2, rad/s^2) at which the thinnest film reaches `level`, the
        scene's own runout and misalignment at their worst beside it, or without them (`aligned`); 0 where these touch
        alone."""
        axial, tilt = sizes(self.gap_motion(direction, frequency))
        closing, own_tilt = (0.0, 0.0) if aligned else self.own
        left = [(r, h - self.level - closing - r * own_tilt) for r, h in self.gaps]
        with np.errstate(divide="ignore"):
            displacement = min(np.float64(max(room, 0.0)) / (axial + r * tilt) for r, room in left)
        return float((2 * math.pi * frequency) ** 2 * displacement)

    def decay(self, direction: str) -> float:
        """Decay rate (1/s) of the slowest motion that vibration of this direction excites."""
        rates = [-mode.value.real for mode in self.modes if mode.kind == KINDS[direction]]
        # The tilt opens the gap, too.
        rates += [-mode.value.real for mode in self.modes] if direction == "angular" else []
        return min(rates, default=math.inf)

    def shaken(self, direction: str, frequency: float, acceleration: float) -> Scene:
        """The aligned scene, its housing shaken with an acceleration (m/s^2, rad/s^2) at a frequency (Hz)."""
        kind = {"axial": AxialVibration, "angular": AngularVibration}[direction]
        return replace(self.scene, housing=Housing(**{direction: [kind(frequency, acceleration=acceleration)]}))

    def resonances(self) -> list[dict]:
        """Modes at rest on the film: `kind` ("axial" | "tilt"), `direction` of whirl, natural `frequency` abs(p)/(2 pi)
        and `damped_frequency` (Hz), `damping_ratio` -Re p/abs(p) of the eigenvalue p; of one that hardly
        swings the `growth_rate` (1/s) alone."""
        found = []
        for mode in sorted(self.modes, key=lambda mode: (mode.kind, abs(mode.value))):
            row = {"kind": mode.kind, "direction": mode.direction, "growth_rate": mode.value.real}
            size = abs(mode.value)
            if mode.value.imag and -mode.value.real < STILL * size:
                row |= {"frequency": size / (2 * math.pi), "damped_frequency": mode.value.imag / (2 * math.pi),
                        "damping_ratio": -mode.value.real / size}  # fmt: skip
            found.append(row)
        return found


def sizes(motion) -> tuple[float, float]:
    """Largest axial motion (m) and tilt (rad) over a period of a complex motion (3,) of the gap: of the tilt, an
    ellipse, the longer half axis, the sum of a forward and a backward circle."""
    return float(abs(motion[0])), largest_tilt(motion)


# --- in time -----------------------------------------------------------------------------------------------


def measured(scene, point: dict) -> dict:
    """A tone of the housing in time on aligned faces, `point` {direction, frequency (Hz)}: `gain` of small motion and
    its `deviation` from linear theory, phase and all, as a share; `touch` (m/s^2, rad/s^2), the acceleration at which
    the faces touch, None where it was not found, which `said` tells; `ratio` to that of linear theory."""
    seal, direction, frequency = ShakenSeal(scene), point["direction"], point["frequency"]
    decay, linear = seal.decay(direction), seal.touch(direction, frequency, aligned=True)
    if decay <= 0.0:
        raise ValueError("a motion that is not damped: its transient does not die out")
    periods = math.ceil(-math.log(LEFT) * frequency / decay) + 2
    if periods > LONGEST:
        raise ValueError(f"the transient takes {periods} periods to die out, more than {LONGEST}")
    foretold = seal.gap_motion(direction, frequency)
    seen, work = _small_motion(seal, direction, frequency, SMALL * linear, periods)
    place = 0 if direction == "axial" else 1
    row = {"gain": sizes(seen)[place],
           "deviation": float(np.linalg.norm(seen - foretold) / np.linalg.norm(foretold)),
           "linear_touch": linear, "touch": None, "ratio": None, "said": ""}  # fmt: skip
    if seal.model.interface.stores:
        return row | {"said": "a film that stores is not followed to touch"}
    if linear * (seal.model.scene.film.outer_radius if direction == "angular" else 1.0) > BEYOND:
        return row | {"said": f"beyond {BEYOND / g:g} g touch is not looked for in time"}
    if direction == "angular" and linear > TILTED * (2 * math.pi * frequency) ** 2:
        return row | {"said": f"a housing that tilts by more than {TILTED:g} rad is not followed to touch in time"}
    periods = math.ceil(-math.log(LEFT_OF_STEP) * frequency / decay) + 2
    ratio, said = _touch(seal, direction, frequency, linear, periods, MOST_WORK - work)
    return row | {"touch": None if ratio is None else ratio * linear, "ratio": ratio, "said": said}


def _bounded(run, accuracy, sink, left: float) -> tuple[Outcome, float]:
    """How a run ends that gives up where so many compiled evaluations are `left`, and what it took of them."""
    method = choose_method(run)[0]
    outcome = solve(run, method, accuracy, sink, work=left / price(method))
    return outcome, outcome.counts.rhs * price(method)


def _small_motion(seal: ShakenSeal, direction, frequency, acceleration, periods) -> tuple[np.ndarray, float]:
    """Complex amplitude (3,) of the gap per unit motion of the housing in the last period of a run, which begins with
    half the motion that linear theory foretells; and the evaluations it took."""
    period, accuracy = 1.0 / frequency, _accuracy(seal, direction, frequency, acceleration, periods)
    run = RunState(Model(seal.shaken(direction, frequency, acceleration), accuracy), periods * period)
    with_housing = _carried(seal, run.model, direction, frequency, acceleration)
    run.y0 = 0.5 * (run.steady_start() + with_housing)
    recorder = Recorder(period / PER_PERIOD)
    outcome, cost = _bounded(run, accuracy, recorder, MOST_WORK)
    if outcome.cause == Cause.TOO_DEAR:
        reached = run.end_time(outcome.segment, outcome.tau) * frequency
        raise ValueError(f"small motion takes more than {MOST_WORK} evaluations: {reached:.0f} of {periods} periods")
    if outcome.status != Status.OK:
        raise ValueError(outcome.message)
    times, q, rates = (part[-PER_PERIOD:] for part in recorder.arrays())
    segment, model = run.segment(0), run.model
    gaps = np.array(
        [segment.gap_state(t, model.vector(*y))[[DZ, GX, GY]] for t, *y in zip(times, q, rates, strict=True)]
    )
    turned = np.exp(-2j * math.pi * frequency * times)
    # The housing's displacement is minus its acceleration over w^2.
    return 2.0 * (turned @ gaps) / PER_PERIOD / (-acceleration / (2 * math.pi * frequency) ** 2), cost


def _accuracy(seal: ShakenSeal, direction, frequency, acceleration, periods) -> float:
    """Accuracy of small motion that the run can have."""
    if seal.model.interface.stores:
        return STORED
    # The phase after so many periods is known to its rounding.
    arm = seal.model.scene.film.outer_radius if direction == "angular" else 1.0
    phase, displacement = 2 * math.pi * periods, arm * acceleration / (2 * math.pi * frequency) ** 2
    rounding = np.finfo(float).eps * phase * displacement / seal.model.clearance
    return min(max(ACCURACY, ABOVE_ROUNDING * rounding), ROUGHLY)


def _touch(seal: ShakenSeal, direction, frequency, linear, periods, left) -> tuple[float | None, str]:
    """The acceleration at which the faces touch in the motion that repeats, over that of linear theory, or None; and
    why, if there is none, or no more evaluations are `left`.  Acceleration grows in steps, ever smaller ones where the
    film closes; each run begins where the one before ended, so that no transient of its own closes it."""
    ratio, step, good, y = BEGIN, STEP, 0.0, None
    while ratio <= MOST:
        try:
            end, cost = _run(seal, direction, frequency, (good * linear, ratio * linear), periods, y, left)
        except SolverFailure:
            return None, f"the solver gave up at {ratio:.3g} times the linear acceleration, without a touch"
        left -= cost
        if left <= 0.0:
            return None, f"no touch up to {good:.3g} times the linear acceleration, with {MOST_WORK} evaluations"
        if end is not None:
            good, y = ratio, end
        elif y is None:
            ratio *= 0.5
            if ratio < 1e-3 * BEGIN:
                return None, "the film closes at any acceleration"
            continue
        else:
            step = math.sqrt(step)
            if step < LAST:
                return good * step, ""
        ratio = good * step
    return None, f"no touch up to {MOST:g} times the linear acceleration"


def _carried(seal: ShakenSeal, model, direction, frequency, acceleration) -> np.ndarray:
    """Unknowns (size,) that keep the gap as it is while the housing stands where this acceleration begins: a rotor goes
    with a rigid stator, a stator that floats stays."""
    y = np.zeros(model.unknowns.size)
    if not seal.scene.stator.support:
        name = {"axial": "rotor_z", "angular": "rotor_tilt_x"}[direction]
        y[model.unknowns.names.index(name)] = -acceleration / (2 * math.pi * frequency) ** 2
    return y


def _run(seal: ShakenSeal, direction, frequency, accelerations, periods, y, most) -> tuple[np.ndarray | None, float]:
    """Unknowns (size,) at the end of a run whose last two periods are alike, None if the faces touch in them or the
    film closes; and the evaluations it cost, given up beyond `most`.  It begins with the gap of `y`, the end of a run
    at the first of two `accelerations`, or, without, with what linear theory foretells, and is shaken with the second.
    """
    before, acceleration = accelerations
    model, period = Model(seal.shaken(direction, frequency, acceleration), ROUGHLY), 1.0 / frequency
    if y is not None:
        y = y + _carried(seal, model, direction, frequency, acceleration - before)
    cost = 0.0
    for _ in range(AGAIN):
        run = RunState(model, periods * period)
        run.y0 = run.steady_start() if y is None else y
        end = run.duration
        run.extrema.windows[1:] = [[end - period, end], [end - 2 * period, end - period]]
        outcome, spent = _bounded(run, ROUGHLY, Recorder(), most - cost)
        cost += spent
        if outcome.status == Status.COLLAPSED or cost >= most:
            return None, cost
        if outcome.status != Status.OK:
            raise SolverFailure(outcome.message)
        last, one_before = run.extrema.records[1:, H]
        y = outcome.y.copy()
        y[run.segment(0).works] = 0.0
        if abs(last - one_before) < LEFT_OF_STEP * model.clearance:
            break
    return (None if min(last, one_before) <= seal.level else y), cost
