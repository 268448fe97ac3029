"""A tilted state that is asked for is that of the whole circle, whatever the symmetry of the scene: exactly what comes
where the scene itself tilts by next to nothing."""

from dataclasses import replace

import pytest
from patterned_faces import THREE, gas, liquid, pads, scenario, seal

from sealdyn.scene.film import Coefficients, Reynolds
from sealdyn.scene.patterns import Waviness
from sealdyn.studies import coefficients, pressure

OWN = Coefficients(tilt_stiffness=1e3, tilt_damping=1.0, axial_stiffness=1e7, axial_damping=1e3)
SIX = Waviness(6, 3e-7)
SCENES = {
    "plain": seal(liquid((4, 32))),
    "waves": seal(liquid((4, 36)), stator=(THREE,)),
    "waves of both faces, cavities": seal(
        liquid(cavitation_pressure=1e5, reynolds=Reynolds(cells_r=4, cells_theta=36)),
        0.0,
        stator=(THREE,),
        rotor=(SIX,),
    ),
    "gas over pads": seal(gas(pads(3, 0.7), cells=(4, 24))),
    "gas over waves": seal(gas(cells=(4, 24)), stator=(THREE,)),
    "linear": seal(replace(liquid(), model="linear", coefficients=OWN, reynolds=None), stator=(THREE,)),
}
RUNOUT = 1e-9
TILT = 2e-5


def both(name):
    """The scene that nothing tilts, and the one that runs out."""
    made = SCENES[name]
    return [scenario(one) for one in (made, replace(made, rotor=replace(made.rotor, runout=RUNOUT)))]


@pytest.mark.parametrize("name", SCENES)
def test_pressure_at_a_tilt(name):
    """Before, of one sector, without moments, and up to five times too low a force."""
    found, expected = (pressure.run(one, pressure.Settings(f"tilt={TILT}"), None).numbers for one in both(name))
    assert found == expected and found["tilt"] == TILT
    assert abs(found["moment"][0]) > 1e-4 * found["force"] * 0.04 * TILT / 6e-5


@pytest.mark.parametrize("name", SCENES)
def test_coefficients_at_a_tilt(name):
    settings = coefficients.Settings(tilt=TILT, points=3)
    found, expected = (coefficients.run(one, settings, None).numbers for one in both(name))
    assert found["tilted"] == expected["tilted"] and found["tilted"]["stiffness"] is not None
    assert found["against_tilt"] == expected["against_tilt"]
