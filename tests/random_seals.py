"""Seals drawn at random from what the program takes, as a scene and as the plain numbers of eigenvalue_scan.py."""

import math
from dataclasses import replace

import numpy as np
from patterned_faces import gas, liquid, pads, seal

from sealdyn.scene.excitation import Shaft
from sealdyn.scene.film import Coefficients, Film, aligned_gaps
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import Rotor, Stator, Support
from sealdyn.scene.scene import Scene

FILMS = ("radial", "green", "of radial", "given")


def drawn_seal(draw: np.random.Generator) -> Scene:
    """FMS, FMR or FMSR, co- and counter-rotating; clearance 0.5 to 50 um, flat, converging or diverging faces, either
    side high; light, heavy and massless rings on soft and stiff, damped and undamped supports; radial and linear
    films, thin and stiff ones among them (squeeze modes beyond 1e7 1/s); every third film with a floor of its
    pressure, half of them at the lower of the two pressures, which small motion does not meet either."""

    def number(low, high):
        return float(np.exp(draw.uniform(math.log(low), math.log(high))))

    clearance, outer, speed = number(0.5e-6, 50e-6), number(0.012, 0.08), number(50.0, 1e4)
    inner = outer * draw.uniform(0.7, 0.95)
    ratio = draw.choice([1.0, number(1.05, 6.0), number(0.15, 0.95)], p=[0.2, 0.5, 0.3])
    high, low = number(2e4, 5e6), float(draw.choice([0.0, 1e5]))
    sides = (high + low, low) if draw.random() < 0.7 else (low, high + low)
    kind = draw.choice(FILMS, p=[0.6, 0.15, 0.1, 0.15])
    coefficients = {"green": "green", "of radial": "radial", "radial": "green"}.get(kind)
    if kind == "given":
        damped = float(draw.random() < 0.9)
        coefficients = Coefficients(
            tilt_stiffness=number(10.0, 1e6), tilt_damping=damped * number(1e-2, 1e4),
            axial_stiffness=number(1e4, 1e9), axial_damping=damped * number(1e2, 1e7),
        )  # fmt: skip
    film = Film(
        model="radial" if kind == "radial" else "linear", inner_radius=inner, outer_radius=outer, clearance=clearance,
        coning=(float(ratio) - 1.0) * clearance / (outer - inner), viscosity=number(1e-4, 5e-2),
        outer_pressure=sides[0], inner_pressure=sides[1], coefficients=coefficients,
        geometry=str(draw.choice(["cylindrical", "planar"], p=[0.85, 0.15])),
        tilt_radius=str(draw.choice(["local", "mean"], p=[0.85, 0.15])),
    )  # fmt: skip

    def ring():
        mass = number(1e-3, 10.0)
        transverse = mass * outer**2 * draw.uniform(0.2, 1.2)
        inert = dict(mass=mass, transverse_inertia=transverse, polar_inertia=transverse * draw.uniform(0.1, 2.0))
        if draw.random() < 0.05:
            inert = dict.fromkeys(inert, 0.0)
        damped = float(draw.random() < 0.8)
        support = Support(
            axial_stiffness=number(1e3, 1e7), axial_damping=damped * number(1.0, 3e3),
            radius=outer * draw.uniform(0.7, 1.2),
        )  # fmt: skip
        return dict(**inert, support=support)

    arrangement = draw.choice(["fms", "fmr", "fmsr"])
    turning = float(draw.choice([0.0, -number(10.0, 1e4), number(10.0, 1e4)], p=[0.7, 0.2, 0.1]))
    stator = Stator(**(ring() if arrangement != "fmr" else {}), speed=turning)
    rotor = Rotor(**(ring() if arrangement != "fms" else {}))
    if draw.random() < 1 / 3:
        film = replace(film, cavitation_pressure=low - number(1e-3, low or 1.0) * float(draw.random() < 0.5))
    return Scene(shaft=Shaft(speed=speed), film=film, stator=stator, rotor=rotor)


def rough_seal(draw: np.random.Generator) -> Scene:
    """A drawn seal whose faces ride on asperities of either law: these meet somewhere on it, the thinnest film from a
    fifth of their height to just below it, in a third of them within 1e-1 to 1e-12 of where their laws change."""
    scene = drawn_seal(draw)
    thinnest = min(h for _, h in aligned_gaps(scene.film, scene.film.clearance))
    share = draw.uniform(0.2, 1.0)
    if draw.random() < 1 / 3:
        share = float(draw.choice([0.6, 1.0])) * (1.0 + draw.choice([-1.0, 1.0]) * 10.0 ** -draw.uniform(1.0, 12.0))
    strength = math.exp(draw.uniform(math.log(1e6), math.log(1e9)))
    height, gaussian = thinnest / share / 3.0, draw.random() < 0.5
    if not gaussian:
        return replace(scene, contact=Contact(roughness=height, compressive_strength=strength))
    if draw.random() < 0.5:
        # They meet at 5 rms.
        height *= 0.6
    peaks = {"asperity_density": draw.uniform(0.01, 0.1) / height**2, "asperity_radius": height * draw.uniform(5, 50)}
    law = Contact(height, "greenwood-williamson", modulus=strength, **peaks)
    return replace(scene, contact=law)


def patterned_seal(draw: np.random.Generator) -> Scene:
    """A floating stator with waves, or pads, of one order under a film of liquid or of gas that stores: slow to fast,
    hardly and well damped, converging, over few cells."""

    def number(low, high):
        return float(np.exp(draw.uniform(math.log(low), math.log(high))))

    order, cells, coning = int(draw.integers(3, 6)), (5, 60), number(5e-5, 5e-4)
    gaseous, padded = draw.random() < 0.5, draw.random() < 0.5
    waves = [Waviness(order, number(1e-7, 1e-6), float(draw.uniform(0, 6)))]
    if gaseous:
        film = gas(*([pads(order, 3.0 / order)] if padded else []), cells=cells, coning=coning)
    else:
        film = liquid(cells=cells, coning=coning)
    scene = seal(film, speed=number(100.0, 1e5), stator=[] if gaseous and padded else waves)
    support = replace(scene.stator.support, axial_damping=number(1.0, 600.0), axial_stiffness=number(1e4, 1e6))
    heavier = number(1.0, 30.0)
    inert = {name: heavier * getattr(scene.stator, name) for name in ("mass", "transverse_inertia", "polar_inertia")}
    return replace(scene, stator=replace(scene.stator, support=support, **inert))


def plain(scene: Scene) -> dict:
    """The numbers of a scene, as eigenvalue_scan.py takes them."""
    film, rings = scene.film, {}
    names = ("inner_radius", "outer_radius", "clearance", "coning", "viscosity", "outer_pressure", "inner_pressure")
    numbers = {name: getattr(film, name) for name in names}
    numbers |= {"planar": film.geometry == "planar", "mean": film.tilt_radius == "mean"}
    if isinstance(film.coefficients, Coefficients):
        c = film.coefficients
        numbers |= {"kind": "given",
                    "numbers": (c.tilt_stiffness, c.tilt_damping, c.axial_stiffness, c.axial_damping)}  # fmt: skip
    else:
        green = film.model == "linear" and film.coefficients == "green"
        numbers["kind"] = "green" if green else "radial"
    if scene.contact:
        c = scene.contact
        numbers |= {"gaussian": c.law != "christensen", "rough": (3.0 * c.roughness, c.compressive_strength)}
        if numbers["gaussian"]:
            peaks = c.asperity_density * c.asperity_radius * c.roughness
            unit = 4.0 / 3.0 * peaks * c.modulus * math.sqrt(c.roughness / c.asperity_radius)
            numbers["rough"] = 3.0 * c.roughness, unit
    for name in ("stator", "rotor"):
        ring = getattr(scene, name)
        if ring.support is None:
            continue
        # The support is given by its circle of springs: the tilt coefficients follow as half the square of the radius.
        tilt_stiffness, tilt_damping = ring.support.tilt()
        rings[name] = dict(
            mass=ring.mass, transverse=ring.transverse_inertia, polar=ring.polar_inertia,
            axial_stiffness=ring.support.axial_stiffness, axial_damping=ring.support.axial_damping,
            tilt_stiffness=tilt_stiffness, tilt_damping=tilt_damping,
        )  # fmt: skip
    return {"film": numbers, "rings": rings, "speed": scene.shaft.speed, "stator_speed": scene.stator.speed}
