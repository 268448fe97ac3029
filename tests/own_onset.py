"""When faces first touch, in the tests' own words: nothing of the program but the scene's data.

One ring floats, and a tilt of the other is all that acts.  Between plain or coned faces the settled motion then stands
still in the frame of that tilt (that of the shaft, of a runout), where faces entrain by their mean spin less that of
the frame.  The film is given by how far the faces are moved and tilted, (z, |g|); touch is one condition on both, the
axial balance the other, and the moments say which tilt of the other ring it takes.  Frames, signs: own_words.py; films:
a liquid by own_face.py, a gas dam by the march of marched_dam.py in even sectors.
"""

import math
from itertools import pairwise

import numpy as np
import own_face
from marched_dam import Dam, flow
from scipy.optimize import brentq

from sealdyn.scene.fluid import gas_of

# Sectors over the root of clearance over touch: the thinner the film the sharper what it carries around the circle
# (16 at a touch of 0.08 clearances erred by 2e-3 of the onset, 32 by 3e-6).
SECTORS = 16.0


def onset(scene, key, margin):
    """Value (rad) of `key`, "rotor.runout" under a stator that floats or "stator.misalignment" over a rotor that
    floats, at which the thinnest film is `margin` times the clearance, or where asperities meet."""
    film, speed = scene.film, scene.shaft.speed
    floats = "stator" if key == "rotor.runout" else "rotor"
    ring, frame = getattr(scene, floats), speed if floats == "stator" else 0.0
    support, spin = ring.support, speed if floats == "rotor" else scene.stator.speed
    width, touch = film.outer_radius - film.inner_radius, margin * film.clearance
    if scene.contact:
        touch = (3.0 if scene.contact.law == "christensen" else 5.0) * scene.contact.roughness
    spins = (scene.stator.speed - frame, speed - frame)
    sectors = 2 * math.ceil(0.5 * SECTORS * math.sqrt(film.clearance / touch))

    def loads(z, tilt):
        """Force (N) and the complex moment (N m) on the stator over the direction of the relative tilt (rad)."""
        if gas_of(film):
            return dams(film, film.clearance + z, tilt, sectors)
        face = np.array([film.inner_radius, film.outer_radius, film.coning, 0.0])
        conditions = (film.viscosity, film.inner_pressure, film.outer_pressure, *spins)
        gap = (film.clearance + z, tilt, 0.0, 0.0, 0.0, 0.0)
        found = own_face.face_loads(face, conditions, gap, own_face.NONE, np.zeros(5), np.empty(0))
        return found[own_face.FORCE], complex(found[own_face.MOMENT_X], found[own_face.MOMENT_Y])

    closing = loads(0.0, 0.0)[0]

    def moved(tilt):
        """Axial motion (m) with which a relative tilt touches."""
        edges = (film.inner_radius * tilt, film.outer_radius * tilt - film.coning * width)
        return touch - film.clearance + max(edges)

    def left(tilt):
        # Of either ring: the gap opens by what the force is more, over the spring.
        return loads(moved(tilt), tilt)[0] - closing - support.axial_stiffness * moved(tilt)

    unit = film.clearance / film.outer_radius
    tilts = unit * np.geomspace(0.2, 12.0, 10)
    for low, high in pairwise(tilts):
        if left(low) * left(high) <= 0.0:
            break
    else:
        raise NotImplementedError("no touch at any tilt")
    tilt = brentq(left, low, high, xtol=1e-10 * unit, rtol=1e-9)
    stiffness, damping = (k * support.radius**2 / 2 for k in (support.axial_stiffness, support.axial_damping))
    # I gamma'' - i J W gamma' + D (gamma' - i W gamma) + K gamma of a tilt that goes with the frame.
    held = ring.polar_inertia * spin * frame - ring.transverse_inertia * frame**2 + stiffness
    held += 1j * damping * (frame - spin)
    return abs(tilt - loads(moved(tilt), tilt)[1] / held)


def dams(film, aligned, tilt, sectors):
    """Force (N) and moment (N m) along the tilt of a gas dam of constant width, by marches."""
    gas, options = gas_of(film), film.gas_dam
    laws = {"laminar": lambda re: 24.0 / re, "turbulent": lambda re: 0.079 / re**0.25}
    laws["blend"] = lambda re: (laws["laminar"](re) ** 8 + laws["turbulent"](re) ** 8) ** 0.125

    def viscosity(temperature):
        hot, cold, s = temperature, gas.reference_temperature, gas.sutherland_temperature
        return gas.reference_viscosity * (hot / cold) ** 1.5 * (cold + s) / (hot + s)

    radii = (film.inner_radius, film.outer_radius)
    mean, pressures = 0.5 * sum(radii), (film.inner_pressure, film.outer_pressure)
    order = slice(None, None, 1 if pressures[0] > pressures[1] else -1)
    if options.width != "constant" or film.viscosity is not None:
        raise NotImplementedError("a dam of another width or viscosity")
    force = moment = 0.0
    for k in range(sectors // 2 + 1 if tilt else 1):
        # h = mean + r tilt sin(theta), alike on both sides of its thickest place.
        sin = math.cos(2.0 * math.pi * k / sectors)
        films = [aligned + film.coning * (r - radii[0]) + r * tilt * sin for r in radii]
        found = flow(
            Dam(radii[order], tuple(films[order]), pressures[order], film.temperature, gas.gas_constant,
                gas.heat_ratio, viscosity, laws[options.friction], loss=options.entrance_loss), 1e-10,
        )  # fmt: skip
        if found is None:
            raise NotImplementedError("no flow through a sector")
        # All but the thickest and the thinnest stand for two.
        count = 1 if not tilt else sectors / (2 if 0 < k < sectors / 2 else 1)
        share = 2.0 * math.pi * mean / count
        first, last = radii[order]
        force += share * found.force
        moment += share * found.force * (first + found.centre * (last - first)) * sin
    return force + min(pressures) * math.pi * (radii[1] ** 2 - radii[0] ** 2), complex(moment, 0.0)
