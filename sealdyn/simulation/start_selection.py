"""Where a run starts: as its scenario says, and of "auto" on the linear steady response where that is stable and
open, and the motion stays near it or the faces would overlap at rest."""

from dataclasses import dataclass

from ..dynamics import modes
from ..faces.geometry import COLLAPSE

STABLE = "on the linear steady response, which is stable"


@dataclass(frozen=True)
class Start:
    """Where a run starts: `taken` "rest", "steady" or an archive; `why` a sentence, empty where it was asked for."""

    taken: str
    why: str = ""


def choose_start(run, asked: str) -> Start:
    """The start of a run (RunState, still at rest) whose scenario says `asked` (`run.start`)."""
    if asked != "auto":
        return Start(asked)
    closed = run.start_film() <= run.model.face[COLLAPSE]
    doubt = _response_is_doubtful(run)
    if doubt and not closed:
        return Start("rest", f"at rest: {doubt}")
    ruled_out = _no_steady_response(run)
    if ruled_out:
        return Start("rest", f"at rest: {ruled_out}")
    if closed:
        # Where both are closed the response is the one to tell of.
        overlap = f"at rest the faces would overlap; on the linear steady response, though {doubt}"
        return Start("steady", overlap if doubt else STABLE)
    if run.start_film(run.steady_start()) <= run.model.face[COLLAPSE]:
        return Start("rest", "at rest: the linear steady response closes the film")
    return Start("steady", STABLE)


def _response_is_doubtful(run) -> str:
    """Why the motion need not stay near a linear steady response; else empty."""
    unknowns = run.model.unknowns
    if run.model.scene.initial.given:
        return "[initial] gives the rest"
    if run.model.contact is not None:
        return "contact is not linear"
    if unknowns.seals:
        return "what a secondary seal holds is not linear"
    if unknowns.film_unknowns is not None:
        return "a film with unknowns of its own starts with them settled"
    return "" if unknowns.constant else "conditions change with time"


def _no_steady_response(run) -> str:
    """Why a run cannot start on a linear steady response; else empty."""
    model = run.model
    if model.scene.initial.given:
        return "[initial] gives the rest"
    if not model.loads_are_balanced(model.start):
        return "no gap at which the film holds the loads"
    verdict = modes.verdict(model.linear_scene().modes())
    return "" if verdict == "stable" else f"the linear steady response is {verdict}"
