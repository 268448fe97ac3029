"""Symmetry of a scene: what all that differs around the circle has in common, and what follows from it."""

from dataclasses import replace

import numpy as np
import pytest
from patterned_faces import THREE, TWO, UM, gas, liquid, pads, scenario, seal

from sealdyn.dynamics import linearisation
from sealdyn.dynamics.interface import Interface
from sealdyn.dynamics.model import Model
from sealdyn.dynamics.run_state import Concern
from sealdyn.faces.geometry import GAP_STATE_SIZE, GX, GX_RATE, INNER_PRESSURE, OUTER_PRESSURE, VISCOSITY
from sealdyn.films.reynolds.pressure import ALIKE, STATUS
from sealdyn.scene.film import Coefficients, Reynolds
from sealdyn.scene.patterns import Waviness, alike_sectors
from sealdyn.scene.rings import Rotor
from sealdyn.scene.scene import Initial, RingStart, SceneError, tilting
from sealdyn.simulation.selection import prepare_run
from sealdyn.simulation.simulate import simulate_in_memory
from sealdyn.studies._runner import _moment, _refuse, study_info

FOUR, SIX = Waviness(4, UM), Waviness(6, UM)
COARSE = dict(cells=(4, 24))
TILTS = ["stator_tilt_x", "stator_tilt_y"]


def of(*waves, rotor=(), **film):
    return seal(liquid(**COARSE, **film), stator=waves, rotor=rotor)


@pytest.mark.core
@pytest.mark.parametrize(
    "sectors, scene",
    [
        (0, of()), (3, of(THREE)), (2, of(FOUR, SIX)), (1, of(TWO, THREE)), (1, of(THREE, rotor=(TWO,))),
        (2, of(FOUR, rotor=(SIX,))), (1, of(SIX, Waviness(10, UM), Waviness(15, UM))),
        # What has no height is not there.
        (3, of(THREE, Waviness(2, 0.0))), (0, of(Waviness(2, 0.0))), (3, seal(gas(pads(3, 0.7)), stator=(SIX,))),
        (1, seal(gas(pads(1, 1.5)))), (1, seal(gas(pads(2, 0.9), pads(3, 0.7)))), (2, seal(gas(pads(2, 0.9)))),
        (0, seal(gas(replace(pads(1, 1.5), depth=0.0)))),
        # A tilt is of order one, imposed, given or asked for.
        (1, replace(of(THREE), rotor=Rotor(runout=1e-9))), (1, tilting(of(THREE))), (1, tilting(of())),
        (1, replace(of(THREE), initial=Initial(stator=RingStart(tilt_y_rate=1e-3)))),
        (3, replace(of(THREE), initial=Initial(rotor=RingStart(tilt_x=1e-6), stator=RingStart(z=1e-7)))),
    ],
)  # fmt: skip
def test_the_whole_repeats_itself_as_often_as_its_parts_have_in_common(sectors, scene):
    assert alike_sectors(scene) == sectors


def names(scene):
    return Model(scene, 1e-3).unknowns.names


def test_tilts_are_unknowns_where_the_faces_tilt():
    for scene in (of(TWO, THREE), seal(gas(pads(1, 1.5), **COARSE))):
        unknowns = Model(scene, 1e-3).unknowns
        assert unknowns.names == ["stator_z", *TILTS] and unknowns.faces_tilt
    # In alike sectors no tilt begins; whether one grows, the modes say.
    for scene in (of(THREE), of(FOUR, SIX), seal(gas(pads(3, 0.7), **COARSE))):
        model = Model(scene, 1e-3)
        assert model.unknowns.names == ["stator_z"] and not model.unknowns.faces_tilt
        assert {mode.kind for mode in model.linear_scene().modes()} == {"axial", "tilt"}


def test_a_film_that_does_not_feel_the_faces_tilts_nothing():
    numbers = Coefficients(tilt_stiffness=1e3, tilt_damping=1.0, axial_stiffness=1e7, axial_damping=1e3)
    film = replace(liquid(), model="linear", coefficients=numbers, reynolds=None)
    assert names(seal(film, stator=(TWO, THREE))) == ["stator_z"]


ONE_PAD = seal(gas(pads(1, 1.5), **COARSE))


@pytest.mark.parametrize("made", [of(TWO, THREE), ONE_PAD], ids=["liquid", "gas"])
def test_linear_numbers_about_faces_that_do_not_stay_are_not_given(made):
    """They were: no misalignment, and any forcing far from contact."""
    asked = scenario(made, turns=None, duration=2e-4, accuracy=1e-2)
    # Stability is that of the tilted rest, nothing that would need a caution.
    assert Concern.ALIGNED not in {caution.concern for caution in prepare_run(asked)[0].cautions}
    summary = simulate_in_memory(asked)
    assert summary["status"] == "ok" and summary["relative_misalignment"]["max"] > 1e-7
    assert set(summary["closed_form"]) == {"road"} and summary["contact_margin"] is None


def test_where_no_rest_is_found_stability_says_it_is_of_aligned_faces(monkeypatch):
    monkeypatch.setattr(linearisation, "MOST_CORRECTIONS", 1)
    asked = scenario(of(TWO, THREE), turns=None, duration=2e-4, accuracy=1e-2)
    assert Concern.ALIGNED in {caution.concern for caution in prepare_run(asked)[0].cautions}


def test_only_alike_sectors_stand_for_each_other():
    def sectors(count):
        return Reynolds(cells_r=4, cells_theta=24, cavitation="none", sectors=count)

    for waves, count in (((THREE,), 3), ((SIX,), 2), ((), 7), ((TWO, THREE), 1)):
        assert Interface(of(*waves, reynolds=sectors(count)), 1e-6)
    for made in (of(TWO, THREE, reynolds=sectors(3)), tilting(of(THREE, reynolds=sectors(3)))):
        with pytest.raises(SceneError, match="sectors"):
            Interface(made, 1e-6)


@pytest.mark.parametrize("slot", [GX, GX_RATE])
def test_one_sector_has_no_tilted_film(slot):
    """Rather no number than that of a sector."""
    interface, s = Interface(of(THREE), 1e-6), np.zeros(GAP_STATE_SIZE)
    s[[INNER_PRESSURE, OUTER_PRESSURE, VISCOSITY]] = 1e5, 2e6, 3e-4
    interface.steady(interface.f, s)
    s[slot] = 1e-6
    with pytest.raises(SceneError, match=STATUS[ALIKE]):
        interface.steady(interface.f, s)
    whole = Interface(tilting(of(THREE)), 1e-6)
    whole.steady(whole.f, s)


def test_studies_of_aligned_faces_say_that_they_do_not_stay_or_refuse():
    """Which aligned balance there is may be asked; where shaken faces touch may not."""
    assert _moment(ONE_PAD) and not _moment(seal(gas(pads(2, 0.9))))
    _refuse("equilibrium", ONE_PAD, study_info("equilibrium").refuses)
    assert study_info("equilibrium").aligned
    with pytest.raises(SceneError, match="pads"):
        _refuse("vibration", ONE_PAD, study_info("vibration").refuses)
