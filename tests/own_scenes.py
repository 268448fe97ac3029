"""Seals drawn at random for a judgement by equations in the tests' own words (own_films.py, own_torn.py, own_onset.py):
rubs, pads, waves, O-rings, gas and cavities, over short runs."""

import math
from dataclasses import replace
from functools import partial

from families import logarithmic

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Film, Pads, Reynolds
from sealdyn.scene.fluid import GasDam, GasReynolds
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor, SecondarySeal, Stator, Support
from sealdyn.scene.scene import Scene


def seal(random, film=None, arrangement=None, tilts=(0.05, 0.35), wide=(0.82, 0.93), stiff=(2e4, 5e5)):
    """A scene with a liquid film ("radial"), and its run's length (s) of one turn; `film`: changes of it; `tilts`: of
    runout and misalignment, over clearance per outer radius; `wide`: inner over outer radius; `stiff`: springs, N/m."""
    log = partial(logarithmic, random)
    outer, clearance, speed = random.uniform(0.02, 0.05), log(1.5e-6, 6e-6), log(150.0, 1200.0)
    inner = outer * random.uniform(*wide)
    cone = clearance / (outer - inner) * log(0.1, 1.5)
    table = Film(
        model="radial", inner_radius=inner, outer_radius=outer, clearance=clearance, coning=cone,
        viscosity=log(2e-4, 2e-3), inner_pressure=1e5, outer_pressure=log(3e5, 3e6),
    )  # fmt: skip
    table = replace(table, **(film or {}))
    arrangement, unit = arrangement or str(random.choice(["fms", "fmr", "fmsr"])), clearance / outer

    def ring():
        mass = log(0.03, 0.5)
        inertia = mass * outer**2 * random.uniform(0.4, 1.0)
        support = Support(
            axial_stiffness=log(*stiff), axial_damping=log(30.0, 600.0), radius=outer * random.uniform(0.85, 1.1)
        )
        return dict(mass=mass, transverse_inertia=inertia, polar_inertia=inertia * random.uniform(0.5, 1.8),
                    support=support)  # fmt: skip

    one, other = (unit * random.uniform(*tilts) for _ in range(2))
    rotor = Rotor(**ring(), misalignment=one) if "r" in arrangement[2:] else Rotor(runout=one)
    stator = Stator(**ring(), misalignment=other) if "s" in arrangement[2:] else Stator(misalignment=other)
    return Scene(shaft=Shaft(speed=speed), film=table, rotor=rotor, stator=stator), 2.0 * math.pi / speed


def gas(random, cells=(8, 48)):
    """Changes of a film that make it one of gas that stores."""
    low = logarithmic(random, 1e5, 3e5)
    return dict(
        model="gas_reynolds", gas=str(random.choice(["air", "nitrogen"])), temperature=random.uniform(280.0, 420.0),
        viscosity=logarithmic(random, 1.6e-5, 3e-5), inner_pressure=low,
        outer_pressure=low * logarithmic(random, 2.0, 8.0),
        gas_reynolds=GasReynolds(cells=cells, slip=bool(random.random() < 0.3)),
    )  # fmt: skip


def rubbing(random, scene, length, gaussian=True):
    """The scene with rough faces, into which the misalignment of one ring grows over `length` (s)."""
    log, film = partial(logarithmic, random), scene.film
    rough, unit = film.clearance * log(0.05, 0.25), film.clearance / film.outer_radius
    strength = log(3e7, 5e8)
    law = dict(compressive_strength=strength)
    if gaussian and random.random() < 0.4:
        law = dict(law="greenwood-williamson", asperity_density=log(1e10, 1e11), asperity_radius=log(1e-6, 2e-5),
                   modulus=log(1e9, 3e10))  # fmt: skip
    elif random.random() < 0.3:
        law["shear_strength"] = 0.1 * strength
    if "shear_strength" not in law:
        law["friction_coefficient"] = random.uniform(0.05, 0.3)
    # A ring follows but for what its support holds against the film.
    ring = scene.rotor if scene.rotor.support else scene.stator
    load = math.pi * (film.outer_radius**2 - film.inner_radius**2) * (film.outer_pressure - film.inner_pressure)
    follows = load * film.outer_radius**2 / film.clearance / ring.support.tilt()[0]
    most = min(unit * (1.0 + follows) * log(0.2, 1.0), 0.015)
    grown = PiecewiseLinear((0.0, random.uniform(0.3, 0.7) * length), (0.1 * unit, most))
    if scene.stator.support is None:
        scene = replace(scene, stator=replace(scene.stator, misalignment=grown))
    elif scene.rotor.support is None:
        scene = replace(scene, rotor=replace(scene.rotor, runout=grown))
    else:
        scene = replace(scene, stator=replace(scene.stator, misalignment=grown))
    return replace(scene, contact=Contact(roughness=rough, **law))


def with_seal(random, scene, sticks):
    """The scene with an O-ring on a ring that floats, that sticks or creeps."""
    name = "stator" if scene.stator.support else "rotor"
    ring, film = getattr(scene, name), scene.film
    law = {}
    if not sticks:
        law = dict(law="regularised", width=film.clearance * scene.shaft.speed * logarithmic(random, 0.02, 0.5))
    seal = SecondarySeal(radius=film.outer_radius, friction_force=logarithmic(random, 0.3, 10.0), **law)
    return replace(scene, **{name: replace(ring, secondary_seal=seal)})


def waves(random, scene):
    """The scene with one or two standing waves."""
    high = scene.film.clearance * logarithmic(random, 0.08, 0.35)
    orders = ((2,), (3,), (2, 3))[random.integers(3)]
    given = [Waviness(order, high / len(orders), float(random.uniform(0.0, 6.0))) for order in orders]
    return replace(scene, stator=replace(scene.stator, waviness=given))


def padded(random, scene):
    """The scene with a row of pads over the whole width."""
    film, count = scene.film, int(random.integers(2, 4))
    pads = Pads(count, film.clearance * logarithmic(random, 0.2, 0.8), float(random.uniform(1.8, 3.6)) / count,
                film.inner_radius, film.outer_radius, edge=0.24 * (film.outer_radius - film.inner_radius),
                phase=float(random.uniform(0.0, 6.0)))  # fmt: skip
    return replace(scene, film=replace(film, pads=[pads]))


def liquid(random, cells=(8, 64), cavities=False):
    """Changes of a film that make it one of cells, which tears or does not."""
    kind = dict(cavitation_pressure=random.uniform(0.6e5, 0.97e5)) if cavities else {}
    tears = "mass-conserving" if cavities else "none"
    return dict(model="reynolds", viscosity=logarithmic(random, 2e-4, 1e-3),
                outer_pressure=logarithmic(random, 2e5, 1e6),
                reynolds=Reynolds(cells_r=cells[0], cells_theta=cells[1], cavitation=tears, grid_accuracy=0.05),
                **kind)  # fmt: skip


def dam(random):
    """Changes of a film that make it a gas dam of constant width."""
    options = GasDam(entrance_loss=float(random.choice([1.0, 0.7])), width="constant",
                     friction=str(random.choice(["blend", "laminar"])))  # fmt: skip
    low = logarithmic(random, 1e5, 2e5)
    return dict(model="gas_dam", gas="air", viscosity=None, temperature=random.uniform(280.0, 500.0), gas_dam=options,
                inner_pressure=low, outer_pressure=low * logarithmic(random, 2.0, 10.0))  # fmt: skip
