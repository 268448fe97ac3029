"""How far the forcing of a seal may grow in linear theory, and what ends it: touch, or what the theory stands on."""

import math
from collections.abc import Callable

from scipy.optimize import brentq

from ..dynamics import modes
from ..dynamics.interface import flow_at_rest, rest_state
from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from ..faces.geometry import CONTACT_TORQUE, FLOW_INNER, INNER_PRESSURE, OUTER_PRESSURE, SPIN_DIFFERENCE, TORQUE, TOUCH
from ..scene.patterns import waves_of
from ..scene.rings import SMALL_TILT
from .plausibility import room_to_open
from .stability import found_alone

# What ends the growth of the forcing: touch, small tilts, or one of those of `room_to_open`.
TOUCHED, TILTED = "touch", "small tilts"
# Of the value at which something ends, relative.
LOCATED = 1e-9


def state_at_rest(model, at):
    """Gap state of the aligned faces where they rest under the conditions `at` an instant."""
    return rest_state(model.scene, model.clearance, at, shift=model.axial_shift(at))[0]


def aligned_flow(model, at) -> tuple[float, float]:
    """Leakage (m^3/s, from high to low pressure; as volume of a gas at normal conditions) and friction (W) of these.
    Raises SceneError where there is no flow."""
    s = state_at_rest(model, at)
    flow_at_rest(model.interface, s, model.observed)
    from_high_to_low = -1.0 if s[OUTER_PRESSURE] >= s[INNER_PRESSURE] else 1.0
    torque = s[TORQUE] + (0.0 if model.contact is None else s[CONTACT_TORQUE])
    return from_high_to_low * s[FLOW_INNER], torque * s[SPIN_DIFFERENCE]


def contact_margin(model, at, linear, tilt, answers) -> tuple[float, str | None]:
    """Factor by which the forcing may grow in linear theory, and what ends it: at "touch" the gap closes at an edge,
    to the height of the asperities where there are any (0 where they touch without forcing), or before "small tilts"
    are over (SMALL_TILT), or a "laminar film" or a "slow gas" at the edge that opens; one that is neither at rest has a
    caution instead.  Unknown of wavy faces, of aligned ones that press with a moment, and of a sweep, which is over
    in the last segment."""
    if waves_of(model.scene) or model.scene.housing.sweeps:
        return math.nan, None
    face = model.face
    inner = model.clearance + model.axial_shift(at)
    outer = inner + (face[3] + model.coning_change(at)) * (face[1] - face[0])
    height = max(face[TOUCH], 0.0)
    if min(inner, outer) <= height:
        return 0.0, TOUCHED
    if tilt is None or modes.verdict(linear.modes()) != "stable":
        return math.nan, None
    most, _, closing, _ = tilt
    ends, tilted = [(math.inf, None)], modes.tilt_bound(answers())
    # Without it the margin is that of touch; that it is missing is told beside it.
    leakage = found_alone([], "leakage", lambda: aligned_flow(model, at)[0]) or math.nan
    for gap, radius in ((inner, face[0]), (outer, face[1])):
        if (reach := radius * most + closing) > 0.0:
            ends.append(((gap - height) / reach, TOUCHED))
            # An edge opens by as much as it closes.
            ends += [(room / reach, name) for room, name in room_to_open(model, leakage, radius, gap)]
    if tilted > 0.0:
        ends.append((SMALL_TILT / tilted, TILTED))
    return min(ends, key=lambda end: end[0])


def limit_of_forcing(model_of: Callable[[float], Model], most: float) -> dict | None:
    """The least `value` of a forcing, up to `most`, at which something ends in linear theory, and what (`by`), of the
    `model_of` a value at its start; None where nothing does, or where that is not known."""

    def found(value):
        model = model_of(value)
        linear, period = model.linear_scene(), RunState(model, 1.0).period()
        answers = linear.answers(model.segment().harmonics())
        tilt = (*modes.steady_extremes(linear, answers, period), period)
        return contact_margin(model, model.start, linear, tilt, lambda: answers)

    def beyond(value):
        margin = found(value)[0]
        return 1.0 / margin - 1.0 if margin != 0.0 else math.inf

    ends = beyond(0.0), beyond(most)
    if not ends[0] < 0.0 <= ends[1] < math.inf:
        return None
    value = float(brentq(beyond, 0.0, most, rtol=LOCATED))
    return {"value": value, "by": found(value)[1]}
