"""Design rules of gas films, in place of those of a gearbox's oil: whether the film carries statically, and whether it
is choked.

**Source** Zuk, NASA TM X-68022 (1972), whose figures are computed here of the scene's own film.
**Valid** aligned faces at the start of the scene, slow motion.
"""

from ..dynamics.imposed_motion import rest_state
from ..dynamics.model import Model
from ..scene.patterns import grooves_of
from ..scene.scene import frozen_at_start
from .film_matrices import State, matrices
from .seal_figures import Finding, Rule, Seal, Verdict, limit_finding, note, other_seals

ZUK = "Zuk, NASA TM X-68022 (1972)"


def film_stiffness(seal: Seal, limit) -> Finding:
    """Fail unless the film presses the harder the thinner it is (N/m above `limit`): under a constant closing force it
    would shut or blow open."""
    if grooves_of(seal.model.scene)[1]:
        return other_seals("the faces have grooves: sealdyn study coefficients FILE")
    try:
        stiffness = float(matrices(Model(frozen_at_start(seal.model.scene)), State())[0][0, 0])
    except ValueError as error:
        return other_seals(str(error))
    inner, *_, outer = (gap for _, gap in sorted(seal.model.aligned_gaps()))
    leaving, entering = (inner, outer) if seal.model.closing.outer_is_high else (outer, inner)
    along = "narrows" if leaving < entering else "opens" if leaving > entering else "is even"
    sentence = f"axial stiffness {1e-6 * stiffness:.4g} N/um at {1e6 * seal.model.clearance:.4g} um, of a gap that "
    sentence += f"{along} along the flow" + ("" if stiffness > limit else ": it holds no clearance by itself")
    own = sum(ring.support.axial_stiffness for ring in (seal.scene.stator, seal.scene.rotor) if ring.support)
    beyond = Verdict.NOTE if stiffness + own > limit else Verdict.FAIL
    if beyond == Verdict.NOTE and stiffness <= limit:
        sentence += f", the supports' {1e-6 * own:.4g} N/um do"
    return limit_finding(sentence, stiffness, least=limit, beyond=beyond, supports=own)


def choking(seal: Seal, limit) -> Finding:
    """A note where the gas leaves the dam with the speed of sound: what the low pressure does no longer reaches the
    film, and the leakage follows the high one alone."""
    film, f = seal.model.observed
    if film.exit_mach is None:
        return other_seals(f"the {film.name} film is viscous, without inertia of the gas; gas_dam knows Mach numbers")
    state = rest_state(seal.model.scene, seal.model.clearance, seal.model.start)[0]
    mach = film.exit_mach(f, state)[1]
    sentence = f"the gas leaves at Mach {mach:.3g}, {'choked' if mach >= limit else 'not choked'}"
    return note(sentence, mach) if mach >= limit else limit_finding(sentence, mach, most=limit)


OF_GAS = {
    "choking": Rule(choking, 1.0, "1", "choked dams of tables 1 and 2", "sealdyn study pressure FILE", ZUK),
    "film_stiffness": Rule(
        film_stiffness, 0.0, "N/m", "a parallel dam is unstable below 0.55 mil, computed",
        "sealdyn study equilibrium FILE", ZUK,
    ),
}  # fmt: skip
