"""The lowest film rung that keeps the asked accuracy."""

from dataclasses import replace

from ..dynamics.model import Model
from ..films import film_names
from ..scene.waviness import waves_of
from .film_error import model_error


def select_film(scene, duration: float, accuracy: float, start) -> tuple[Model, float | None]:
    """The scene as a problem on the lowest film rung that keeps the accuracy, and the estimated error of a chosen
    linear film; `start(problem)` sets its unknowns.

    Only "auto" is chosen for: the linear film, with the radial film's coefficients, where its estimated error is
    below half the accuracy, else the radial film; of faces with a profile the profiled film.  Raises ImpossibleScene.
    """
    film = scene.film
    if film.model != "auto" or not {"linear", "radial"} <= set(film_names(film, waves_of(scene))):
        problem = Model(scene, duration, accuracy)
        start(problem)
        if film.model == "auto":
            said = f"film auto: the {problem.film_name} film; the faces have a profile, others know cones only"
            problem.reasons.append(said)
        return problem, model_error(problem) if problem.film_name == "linear" else None
    radial = Model(replace(scene, film=replace(film, model="radial")), duration, accuracy)
    start(radial)
    why = _why_not_linear(scene, radial)
    if why is None:
        linear = Model(replace(scene, film=replace(film, model="linear", coefficients="radial")), duration, accuracy)
        start(linear)
        error = model_error(linear, enough=0.5 * accuracy)
        if error is not None and error < 0.5 * accuracy:
            linear.observed = radial.observed
            said = f"film auto: the linear film, with the radial film's coefficients, is within {error:.1e} of it"
            linear.reasons.append(said)
            return linear, error
        why = (
            "the linear film's error cannot be estimated"
            if error is None
            else f"the linear film errs by {error:.1e} or more"
        )
    radial.reasons.append(f"film auto: the radial film; {why}")
    return radial, None


def _why_not_linear(scene, radial: Model) -> str | None:
    """What rules the linear film out before anything is tried, or None."""
    if scene.contact or radial.layout.seals:
        return "contact or friction is no place for a linear film"
    if scene.film.cavitation_pressure is not None:
        return "the pressure has a floor"
    if not radial.constant or radial.massless:
        return "conditions change, or a ring has no mass"
    # A tilt ratio t leaves errors of t^2: no estimate is needed to see that far.
    ratio = 1.0 - radial.start_film() / radial.clearance
    if ratio * ratio > 100.0 * radial.accuracy:
        return f"the film starts {abs(ratio):.2g} off the clearance, and a linear film errs by about the square"
    return None
