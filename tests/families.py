"""Random scenes from everything that the program accepts, for benchmarks and tests of what it promises."""

import math
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from sealdyn.numerics.piecewise_linear import PiecewiseLinear
from sealdyn.scene.excitation import AngularVibration, AxialVibration, Housing, Shaft, Whirl
from sealdyn.scene.film import Film, Pads, Reynolds
from sealdyn.scene.fluid import GASES, GasDam, GasReynolds
from sealdyn.scene.forces import Contact
from sealdyn.scene.patterns import Waviness
from sealdyn.scene.rings import AxialRunout, Rotor, SecondarySeal, Stator, Support
from sealdyn.scene.scene import Initial, RingStart, Scene


@dataclass(frozen=True)
class Drawn:
    """A scene with its run: `duration` (s), asked `accuracy`, `start` ("rest" or "steady"), and `words` for what makes
    it special."""

    scene: Scene
    duration: float
    accuracy: float
    start: str
    words: tuple[str, ...]

    @property
    def smooth(self) -> bool:
        """Whether nothing touches or slides dry."""
        return not {"contact", "o-ring"} & set(self.words)


def logarithmic(random, low, high) -> float:
    """A number between two, evenly over its logarithm."""
    return float(np.exp(random.uniform(math.log(low), math.log(high))))


def gas(random) -> Drawn:
    """A scene of `wide` whose film is a gas: a dam that the gas crosses from either side, subsonic to choked, laminar
    to turbulent, hot and cold; pressures, speeds and misalignments as there, tables of temperature too."""
    drawn, log = wide(random), partial(logarithmic, random)
    film, duration = drawn.scene.film, drawn.duration

    def lifted(pressure):
        """Above 1 bar, and at most 20 of them."""
        if isinstance(pressure, PiecewiseLinear):
            return PiecewiseLinear(pressure.time, tuple(1e5 + min(p, 2e6) for p in pressure.value))
        return 1e5 + min(pressure, 2e6)

    name = str(random.choice(sorted(GASES)))
    temperature, words = log(250.0, 590.0), (*drawn.words, "gas", name)
    if random.random() < 0.15:
        begin, end = np.sort(random.uniform(0.1, 0.9, 2)) * duration
        temperature = PiecewiseLinear((0.0, begin, end), (temperature, temperature, log(250.0, 590.0)))
        words = (*words, "temperature table")
    options = GasDam(
        entrance_loss=float(random.choice([1.0, 0.7])), friction=str(random.choice(["blend", "laminar", "turbulent"])),
        width=str(random.choice(["radial", "constant"])),
    )  # fmt: skip
    dam = replace(
        film, model="gas_dam", gas=name, temperature=temperature, viscosity=None, gas_dam=options,
        outer_pressure=lifted(film.outer_pressure), inner_pressure=lifted(film.inner_pressure),
    )  # fmt: skip
    return replace(drawn, scene=replace(drawn.scene, film=dam), words=words)


def gas_reynolds(random, other_faces=True) -> Drawn:
    """A scene of `wide` without contact and dry friction whose film is a gas that stores, over few turns: pressures
    from either side or equal, squeeze numbers from far below to far above one, with and without slip, few and many
    cells; supports of which some do not damp; with `other_faces` standing waves and cones that follow time or speed."""
    log = partial(logarithmic, random)
    while not (drawn := wide(random, 5)).smooth:
        pass
    scene, film = drawn.scene, drawn.scene.film
    speed = scene.shaft.speed.value[0] if isinstance(scene.shaft.speed, PiecewiseLinear) else scene.shaft.speed
    cells = tuple(int(count) for count in (random.integers(5, 13), 2 * random.integers(8, 18)))
    slip, name, low = bool(random.random() < 0.3), str(random.choice(sorted(GASES))), log(3e4, 3e5)
    lifted = [
        PiecewiseLinear(p.time, tuple(low + min(v, 3e6) for v in p.value))
        if isinstance(p, PiecewiseLinear)
        else low + min(p, 3e6)
        for p in (film.inner_pressure, film.outer_pressure)
    ]
    words = [word for word in drawn.words if not word.startswith(("film", "viscosity"))]
    words, closing = [*words, "gas", name, *(["slip"] if slip else [])], scene.closing
    if random.random() < 0.15:
        # Nothing but its wedge and the springs holds such a film.
        lifted, closing, words = [lifted[0]] * 2, replace(closing, balance_ratio=0.8), [*words, "equal pressures"]
        lifted = [p.value[0] if isinstance(p, PiecewiseLinear) else p for p in lifted]
        words = [word for word in words if word != "pressure table"]
    # The squeeze number over the width, 12 mu speed width^2/(p h^2), sets the clearance.
    gas, temperature = GASES[name], log(250.0, 590.0)
    pressure = max(p.value[0] if isinstance(p, PiecewiseLinear) else p for p in lifted)
    squeeze, width = log(0.03, 300.0), film.outer_radius - film.inner_radius
    clearance = math.sqrt(12 * gas.viscosity(temperature) * speed * width**2 / (pressure * squeeze))
    clearance = min(max(clearance, 1e-6), 3e-5)
    times = clearance / film.clearance

    def resized(part, *keys):
        """Of a ring or tone, lengths and angles as they are to the clearance."""
        found = {}
        for key in keys:
            value = getattr(part, key, None)
            if isinstance(value, PiecewiseLinear):
                found[key] = PiecewiseLinear(value.time, tuple(times * v for v in value.value))
            elif value is not None:
                found[key] = times * value
        return replace(part, **found)

    def ring(part):
        part = resized(part, "misalignment", "runout")
        if part.support and random.random() < 0.3:
            part = replace(part, support=replace(part.support, axial_damping=0.0))
            words.append("undamped")
        return part

    rotor = ring(scene.rotor)
    rotor = replace(rotor, axial_runout=[resized(wave, "amplitude") for wave in rotor.axial_runout])
    tones = {kind: getattr(scene.housing, kind) for kind in ("axial", "angular")}
    shaken = {kind: [resized(tone, "displacement") for tone in of_kind] for kind, of_kind in tones.items()}
    shaft = replace(scene.shaft, whirl=[resized(whirl, "angle") for whirl in scene.shaft.whirl])
    table = replace(
        film, model="gas_reynolds", gas=name, temperature=temperature, viscosity=None, clearance=clearance,
        coning=times * film.coning, inner_pressure=lifted[0], outer_pressure=lifted[1],
        gas_reynolds=GasReynolds(slip=slip, cells=cells),
    )  # fmt: skip
    scene = replace(
        scene, shaft=shaft, film=table, housing=replace(scene.housing, **shaken), rotor=rotor,
        stator=ring(scene.stator), closing=closing,
    )  # fmt: skip
    if other_faces:
        scene = _with_other_faces(random, scene, drawn.duration, words)
    stator = scene.stator
    if other_faces and random.random() < 0.15 and stator.speed == 0.0:
        wave = Waviness(int(random.integers(2, 5)), clearance * log(0.01, 0.2), float(random.uniform(0, 6)))
        scene, words = replace(scene, stator=replace(scene.stator, waviness=[wave])), [*words, "waves"]
    return Drawn(scene, drawn.duration, log(1e-3, 3e-2), drawn.start, (*words, f"{cells[0]} x {cells[1]}"))


def reynolds(random) -> Drawn:
    """A scene of `wide` without dry friction whose film is a liquid with cavities, over few turns: sealed pressures
    from far above that of cavities to hardly above, few cells, standing waves, contact, any arrangement."""
    log = partial(logarithmic, random)
    while "o-ring" in (drawn := wide(random, 4)).words or drawn.scene.film.inertia:
        pass
    scene, film = drawn.scene, drawn.scene.film
    options = Reynolds(
        cells_r=int(random.integers(4, 9)), cells_theta=2 * int(random.integers(16, 25)), grid_accuracy=1.0
    )
    # Over the pressures that the wedge makes: cavities from none to half of the face.
    width = film.outer_radius - film.inner_radius
    speed = max(scene.shaft.speed.value) if isinstance(scene.shaft.speed, PiecewiseLinear) else scene.shaft.speed
    viscosity = max(film.viscosity.value) if isinstance(film.viscosity, PiecewiseLinear) else film.viscosity
    over = 6.0 * viscosity * abs(speed) * width**2 / film.clearance**2 * log(1e-3, 1.0)
    edges = [p.value if isinstance(p, PiecewiseLinear) else (p,) for p in (film.inner_pressure, film.outer_pressure)]
    cavities = min(min(edge) for edge in edges)
    lifted = [
        PiecewiseLinear(p.time, tuple(over + v for v in p.value)) if isinstance(p, PiecewiseLinear) else over + p
        for p in (film.inner_pressure, film.outer_pressure)
    ]
    words = [
        *(word for word in drawn.words if not word.startswith("film")),
        f"{options.cells_r} x {options.cells_theta}",
    ]
    table = replace(film, model="reynolds", reynolds=options, geometry="cylindrical", cavitation_pressure=cavities,
                    inner_pressure=lifted[0], outer_pressure=lifted[1])  # fmt: skip
    scene = replace(scene, film=table)
    if random.random() < 0.4 and scene.stator.speed == 0.0:
        wave = Waviness(int(random.integers(2, 5)), film.clearance * log(0.01, 0.6), float(random.uniform(0, 6)))
        scene, words = replace(scene, stator=replace(scene.stator, waviness=[wave])), [*words, "waves"]
    return Drawn(scene, drawn.duration, log(1e-3, 3e-2), "rest", tuple(words))


# How often the faces of `patterned` repeat themselves: by waves, and by sets of pads.  Some have a divisor in common.
WAVES = ((2, 3), (3, 4), (2, 5), (2, 4), (3,))
PADS = ((1,), (2, 3), (3,), (2, 4))
TILTING = ("angular tone", "whirl", "misalignment table", "rub", "waves")


def patterned(random) -> Drawn:
    """A scene of `reynolds` or `gas_reynolds` that nothing tilts but its faces: waves of several orders, or sets of
    pads under a gas; some of which tilt nothing either."""
    liquid = bool(random.random() < 0.5)
    while (drawn := reynolds(random) if liquid else gas_reynolds(random, other_faces=False)).scene.stator.speed != 0.0:
        pass
    scene, film, words = drawn.scene, drawn.scene.film, [word for word in drawn.words if word not in TILTING]
    if liquid or random.random() < 0.5:
        orders, height = WAVES[random.integers(len(WAVES))], film.clearance * logarithmic(random, 0.1, 0.4)
        waves = [Waviness(order, height, float(random.uniform(0, 6))) for order in orders]
        stator, words = replace(scene.stator, waviness=waves), [*words, f"waves {orders}"]
    else:
        counts, width = PADS[random.integers(len(PADS))], film.outer_radius - film.inner_radius
        size = dict(inner_radius=film.inner_radius, outer_radius=film.outer_radius, edge=0.24 * width)
        pads = [Pads(count, film.clearance * logarithmic(random, 0.1, 1.0), float(random.uniform(1.5, 3.0)) / count,
                     phase=float(random.uniform(0, 6)), **size) for count in counts]  # fmt: skip
        film = replace(film, pads=pads, gas_reynolds=replace(film.gas_reynolds, cells=(6, 96)))
        stator, words = scene.stator, [*words, f"pads {counts}"]
    # A throw keeps its way along the shaft.
    straight = {name: RingStart(z_rate=getattr(scene.initial, name).z_rate) for name in ("rotor", "stator")}
    scene = replace(
        scene, film=film, shaft=replace(scene.shaft, whirl=[]), housing=Housing(axial=scene.housing.axial),
        rotor=replace(scene.rotor, misalignment=0.0, runout=0.0), stator=replace(stator, misalignment=0.0),
        initial=Initial(**straight),
    )  # fmt: skip
    return replace(drawn, scene=scene, words=tuple(words))


def _with_other_faces(random, scene, duration, words):
    """Now and then a cone that follows time, or the speed."""
    film, speed = scene.film, scene.shaft.speed
    slope = film.clearance / (film.outer_radius - film.inner_radius)
    if random.random() < 0.15:
        cone = film.coning + 0.5 * slope * float(random.uniform(-0.3, 1.0))
        film = replace(film, coning=PiecewiseLinear((0.3 * duration, 0.8 * duration), (film.coning, cone)))
        words.append("coning table")
    if random.random() < 0.15:
        fastest = max(speed.value) if isinstance(speed, PiecewiseLinear) else speed
        film = replace(film, coning_per_speed_squared=slope / fastest**2 * float(random.uniform(-0.1, 0.5)))
        words.append("coning by speed")
    return replace(scene, film=film)


def wide(random, most_turns=25) -> Drawn:
    """One scene of all the families: arrangements, light and stiff rings, thin and thick, flat, converging and
    diverging films, either side high, tables, runouts, whirls, tones, contact of both laws, growing into a rub and hit
    by a thrown ring, O-rings."""

    log = partial(logarithmic, random)

    def chance(share, word):
        taken = random.random() < share
        words.extend([word] if taken else [])
        return taken

    words = [str(random.choice(["fms", "fmr", "fmsr"]))]
    arrangement, clearance, outer = words[0], log(5e-7, 5e-5), log(0.015, 0.08)
    inner, speed, turns = outer * random.uniform(0.7, 0.95), log(50.0, 2500.0), random.integers(2, most_turns)
    duration, tilt = float(turns) * 2 * math.pi / speed, clearance / outer

    def varying(value, share, word, low, high):
        """A number, or now and then a table that carries it to a multiple of itself."""
        if not chance(share, word):
            return value
        a, b = np.sort(random.uniform(0.1, 0.9, 2)) * duration
        return PiecewiseLinear((0.0, a, b), (value, value, value * random.uniform(low, high)))

    high, low_side = log(1e5, 5e6), float(random.choice([0.0, 1e5]))
    outside = random.random() < 0.6
    shape = str(random.choice(["flat", "cone", "cone", "cone"]))
    cone = 0.0 if shape == "flat" else clearance / (outer - inner) * log(0.1, 4.0)
    # Mostly a film that narrows in the direction of flow, which is the stable one.
    cone *= (1 if outside else -0.2) * (1 if random.random() < 0.85 else -0.2)
    words.append(shape if cone >= 0 else "negative cone")
    high_side = varying(high, 0.12, "pressure table", 0.3, 2.0)
    film = Film(
        model="auto" if random.random() < 0.3 else "radial", inner_radius=inner, outer_radius=outer, coning=cone,
        clearance=clearance, viscosity=varying(log(1e-4, 1e-2), 0.08, "viscosity table", 0.3, 3.0),
        outer_pressure=high_side if outside else low_side, inner_pressure=low_side if outside else high_side,
    )  # fmt: skip

    def ring():
        mass = log(0.02, 3.0)
        inertia = mass * outer**2 * random.uniform(0.4, 1.2)
        support = Support(axial_stiffness=log(1e4, 2e6), axial_damping=log(1.0, 1000.0), radius=outer)
        seal = None
        if chance(0.06, "o-ring"):
            law = dict(law="regularised", width=log(1e-5, 1e-3)) if random.random() < 0.4 else {}
            seal = SecondarySeal(radius=outer, friction_force=log(0.1, 20.0), **law)
        return dict(mass=mass, transverse_inertia=inertia, polar_inertia=inertia * random.uniform(0.3, 2.0),
                    support=support, secondary_seal=seal,
                    misalignment=varying(tilt * log(1e-3, 0.5), 0.05, "misalignment table", 0.2, 1.6))  # fmt: skip

    housing, whirl, axial = Housing(), [], []
    if chance(0.15, "angular tone"):
        frequency = speed / (2 * math.pi) * random.uniform(0.3, 4.0)
        housing.angular.append(AngularVibration(frequency=frequency, displacement=tilt * log(0.01, 0.2)))
    if chance(0.15, "axial tone"):
        frequency = speed / (2 * math.pi) * random.uniform(0.3, 4.0)
        housing.axial.append(AxialVibration(frequency=frequency, displacement=clearance * log(0.01, 0.3)))
    if chance(0.1, "whirl"):
        whirl.append(Whirl(ratio=random.uniform(-1.5, 1.5), angle=tilt * log(0.01, 0.2)))
    if chance(0.15, "axial runout"):
        axial.append(AxialRunout(order=float(random.integers(1, 4)), amplitude=clearance * log(0.01, 0.2)))
    shaft = Shaft(speed=varying(speed, 0.15, "speed table", 0.3, 2.0), whirl=whirl)
    fixed, initial, rough = varying(tilt * log(1e-3, 0.5), 0.08, "misalignment table", 0.2, 1.6), Initial(), None
    if chance(0.18, "contact"):
        rough = clearance * log(0.03, 0.3)
        if chance(0.5, "rub"):
            begun = fixed.value[0] if isinstance(fixed, PiecewiseLinear) else fixed
            fixed = PiecewiseLinear((0.0, random.uniform(0.2, 0.9) * duration), (begun, tilt * log(0.8, 5.0)))
        if chance(0.5, "throw"):
            rate, tumble = clearance * speed * log(0.1, 3.0), tilt * speed * log(0.1, 1.0)
            rings = {}
            for name, towards in (("rotor", 1.0), ("stator", -1.0)):
                if name[0] in arrangement[2:]:
                    rings[name] = RingStart(z_rate=towards * rate, tilt_x_rate=tumble * random.uniform(-1.0, 1.0))
            initial = Initial(**rings)
    stator_speed = -speed * random.uniform(0.2, 1.0) if chance(0.08, "counter-rotating") else 0.0
    rotor = Rotor(**ring(), axial_runout=axial) if "r" in arrangement[2:] else Rotor(runout=fixed, axial_runout=axial)
    stator = (
        Stator(**ring(), speed=stator_speed)
        if "s" in arrangement[2:]
        else Stator(misalignment=fixed, speed=stator_speed)
    )
    contact = None
    if rough:
        christensen = dict(compressive_strength=log(1e7, 1e9))
        gaussian = dict(law="greenwood-williamson", asperity_density=log(1e10, 1e11), asperity_radius=log(1e-6, 2e-5),
                        modulus=log(1e9, 5e10))  # fmt: skip
        contact = Contact(roughness=rough, **(christensen if random.random() < 0.6 else gaussian))
    made = Scene(shaft=shaft, film=film, housing=housing, rotor=rotor, stator=stator, contact=contact,
                 initial=initial)  # fmt: skip
    start = "rest" if initial.given else str(random.choice(["rest", "steady"]))
    return Drawn(made, duration, log(1e-7, 1e-2), start, (*words, f"film {film.model}", start))
