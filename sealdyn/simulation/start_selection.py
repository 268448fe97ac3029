"""Where a run starts: as its scenario says, and of "auto" on the linear steady response where that is stable and
open."""

from dataclasses import dataclass

from ..dynamics import modes
from ..faces.geometry import COLLAPSE


@dataclass(frozen=True)
class Start:
    """Where a run starts: `taken` "rest", "steady" or an archive; `why` a sentence, empty where it was asked for."""

    taken: str
    why: str = ""


def choose_start(run, asked: str) -> Start:
    """The start of a run (RunState, still at rest) whose scenario says `asked` (`run.start`)."""
    if asked != "auto":
        return Start(asked)
    ruled_out = _no_steady_response(run)
    if ruled_out:
        return Start("rest", f"at rest: {ruled_out}")
    floor = run.model.face[COLLAPSE]
    # Where both are closed the response is the one to tell of.
    if run.start_film(run.steady_start()) <= floor < run.start_film():
        return Start("rest", "at rest: the linear steady response closes the film")
    return Start("steady", "on the linear steady response, which is stable")


def _no_steady_response(run) -> str:
    """Why a run cannot start on a linear steady response, or cannot be trusted to stay near it; else empty."""
    model, unknowns = run.model, run.model.unknowns
    if model.scene.initial.given:
        return "[initial] gives the rest"
    if model.contact is not None:
        return "contact is not linear"
    if unknowns.seals:
        return "what a secondary seal holds is not linear"
    if unknowns.film_unknowns is not None:
        return "a film with unknowns of its own starts with them settled"
    if not unknowns.constant:
        return "conditions change with time"
    if not model.loads_are_balanced(model.start):
        return "no gap at which the film holds the loads"
    verdict = modes.verdict(model.linear_scene().modes())
    return "" if verdict == "stable" else f"the linear steady response is {verdict}"
