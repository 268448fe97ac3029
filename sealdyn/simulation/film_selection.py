"""The lowest film model that keeps the asked accuracy."""

from collections.abc import Callable
from dataclasses import replace

from ..dynamics.model import Model
from ..dynamics.run_state import RunState
from .film_error import model_error


def select_film(scene, settings, start: Callable[[RunState], None]) -> tuple[RunState, float | None]:
    """A run of the scene with the lowest film model that keeps the accuracy, and the estimated error of a linear film
    that was chosen for it (None: not estimated).  `settings` as the `[run]` table: `accuracy`, and `duration` (s) or
    `turns`; `start(run)` sets the run's unknowns.

    Only "auto" is chosen for: the linear film, with the radial film's coefficients, where its estimated error is below
    half the accuracy, else the radial film; of faces with a profile the profiled film.  Raises SceneError.
    """
    film, accuracy = scene.film, settings.accuracy

    def started(scene, observed=None) -> RunState:
        model = Model(scene, accuracy, observed)
        run = RunState(model, model.time_of(settings.turns) if settings.duration is None else settings.duration)
        start(run)
        return run

    highest = started(scene)
    name = highest.model.interface.name
    if film.model != "auto":
        return highest, None
    if film.gas is not None:
        highest.reasons.append(f"film auto: the {name} film, for a gas")
        return highest, None
    if name != "radial":
        highest.reasons.append(f"film auto: the {name} film; the faces have a profile, others know cones only")
        return highest, None
    why = _why_not_linear(scene, highest)
    if why is None:
        simpler = replace(scene, film=replace(film, model="linear", coefficients="radial"))
        linear = started(simpler, highest.model.observed)
        error = model_error(linear, enough=0.5 * accuracy)
        if error is not None and error < 0.5 * accuracy:
            linear.reasons.append(
                f"film auto: the linear film, with the radial film's coefficients, is within {error:.1e} of it"
            )
            return linear, error
        why = (
            "the linear film's error cannot be estimated"
            if error is None
            else f"the linear film errs by {error:.1e} or more"
        )
    highest.reasons.append(f"film auto: the radial film; {why}")
    return highest, None


def _why_not_linear(scene, radial: RunState) -> str | None:
    """What rules the linear film out before anything is tried, or None."""
    unknowns = radial.model.unknowns
    if scene.contact or unknowns.seals:
        return "contact or friction is no place for a linear film"
    if scene.film.cavitation_pressure is not None:
        return "the pressure has a floor"
    if scene.film.inertia:
        return "the fluid has inertia"
    if not unknowns.constant or unknowns.has_residual_form:
        return "conditions change, or a ring has no mass"
    # A tilt ratio t leaves errors of t^2: no estimate is needed to see that far.
    ratio = 1.0 - radial.start_film() / radial.model.clearance
    if ratio * ratio > 100.0 * radial.model.accuracy:
        return f"the film starts {abs(ratio):.2g} off the clearance, and a linear film errs by about the square"
    return None
