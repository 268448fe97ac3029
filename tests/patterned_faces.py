"""Small seals whose faces differ around the circle, by waves or pads; nothing else tilts them."""

from dataclasses import replace
from pathlib import Path

from sealdyn import read_scenario
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film, Pads, Reynolds
from sealdyn.scene.fluid import GasReynolds
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene

REFERENCE = Path(__file__).parents[1] / "scenarios" / "fms_reference.toml"

UM, R_I, R_O = 1e-6, 0.040, 0.045
RING = dict(mass=0.05, transverse_inertia=5e-5, polar_inertia=9e-5,
            support=Support(axial_stiffness=4e4, axial_damping=600.0, radius=0.042))  # fmt: skip
# Twice and three times around: nothing in common but the whole circle.
TWO, THREE = Waviness(2, 0.6 * UM, 0.4), Waviness(3, 0.6 * UM)


def liquid(cells=(8, 96), **changes):
    """A film of cells without cavities."""
    given = dict(
        model="reynolds", viscosity=3e-4, inner_radius=R_I, outer_radius=R_O, inner_pressure=1e5, outer_pressure=2e6,
        clearance=3 * UM, coning=2e-4, reynolds=Reynolds(cells_r=cells[0], cells_theta=cells[1], cavitation="none"),
    )  # fmt: skip
    return Film(**(given | changes))


def gas(*pads, cells=(10, 120), **changes):
    """A film of gas that stores, over pads."""
    given = dict(
        model="gas_reynolds", gas="air", temperature=330.0, viscosity=2e-5, inner_radius=R_I, outer_radius=R_O,
        inner_pressure=2e5, outer_pressure=6e5, clearance=3 * UM, coning=3e-4, gas_reynolds=GasReynolds(cells=cells),
    )  # fmt: skip
    return Film(pads=pads, **(given | changes))


def pads(count, angle, phase=0.3):
    """Pads over the whole width, with flanks that few angles see."""
    return Pads(count, 2 * UM, angle, R_I, R_O, edge=12e-3, phase=phase)


def seal(film, speed=800.0, stator=(), rotor=(), floats="stator"):
    """A scene with waves on its faces; `floats`: "stator", "rotor" or both."""
    rings = {"stator": Stator(waviness=list(stator)), "rotor": Rotor(waviness=list(rotor))}
    rings |= {name: replace(rings[name], **RING) for name in floats.split()}
    return Scene(shaft=Shaft(speed=speed), film=film, **rings)


def scenario(scene, **run):
    """The scene as a scenario; `run`: keys of its [run] table."""
    given = read_scenario(REFERENCE)
    return replace(given, scene=scene, run=replace(given.run, **run), read=None)
