"""The scene chooses its unknowns: which there are, why, where they stand in `y`, and their scales."""

import math

import numpy as np

from ..faces.geometry import offset_block
from ..numerics.piecewise_linear import PiecewiseLinear
from ..scene.film import follows_speed
from ..scene.forces import load_of, pulls
from ..scene.patterns import alike_sectors, face_orders, faces_tilt, waves_of
from ..scene.rings import RING_NAMES, ROTOR, STATOR
from ..scene.scene import turning_supports
from ..scene.sweep import largest_amplitude, tilts
from . import equations
from .imposed_motion import AXIAL, ON_RING, PULL, UNBALANCE, fluid_conditions, harmonics_of_segment
from .intervals import largest_value
from .native import SEAL_TYPE, Value
from .swept_motion import records, splines

# Works and the sum of their absolute values; with contact or a secondary seal two more works and an impulse.
WORKS, MORE = 6, 3
# A rate below this share of the largest is one of rounding: nothing moves at it.
ROUNDING = 1e-13


class Unknowns:
    """Unknowns of a scene.

    `y` = [displacements | velocities | film | impulse | works | sum of absolute works]: slices `film` and `works`, and
    the place of the `impulse` (None without).  `names` of the `n` displacements; `rate_places` where their rates stand,
    -1 for those of which `lacks_inertia` (n,) is true; `n_mechanical` displacements and rates, `size` of y;
    `film_unknowns` what the film owns (films/_contract.py), None of an algebraic one; `has_residual_form` whether they
    obey a residual only, since a ring is massless or the film has unknowns; `ring_block` the constant part of the
    parameters; `floats` per ring, `seals` the rings with a secondary seal, of
    which those in `coulomb_rings` stick rigidly and those in `elastic_rings` give, `with_axial`, `with_tilt`, `linear`,
    `constant` (no table anywhere), `extended` (contact or a secondary seal), `faces_tilt` (aligned faces press with a
    moment), `reasons`.
    """

    def __init__(self, scene, closing, linear: bool, film_unknowns=None):
        self.scene = scene
        self.seals = [
            k for k, ring in ((STATOR, scene.stator), (ROTOR, scene.rotor)) if ring.support and ring.secondary_seal
        ]
        self.elastic_rings = [k for k in self.seals if self.seal(k).stiffness is not None]
        stick = [k for k in self.seals if self.seal(k).law == "coulomb"]
        self.coulomb_rings = [k for k in stick if k not in self.elastic_rings]
        self.extended = bool(scene.contact or self.seals)
        self.turning_supports = turning_supports(scene)
        # Contact, friction, supports that change as they turn and offset faces couple what a linear film keeps apart.
        self.linear = linear and not (self.extended or self.turning_supports or scene.film.offset)
        rings = {STATOR: scene.stator, ROTOR: scene.rotor}
        self.floats = {k: ring.support is not None for k, ring in rings.items()}
        starts = {STATOR: scene.initial.stator, ROTOR: scene.initial.rotor}
        moved = [start for k, start in starts.items() if self.floats[k]]
        shifted = any(v for s in moved for v in (s.z, s.z_rate))
        film = scene.film
        # A cone that opens moves the equilibrium.
        cones = (film.coning, scene.shaft.speed) if follows_speed(film) else (film.coning,)
        loads = (film.inner_pressure, film.outer_pressure, film.temperature, closing.spring, *cones)
        outside = [q for ring in rings.values() if (load := load_of(ring)) for q in load.varying()]
        self.loaded = any(isinstance(q, PiecewiseLinear) for q in loads)
        others = (scene.shaft.speed, scene.stator.speed, *fluid_conditions(film).values(), scene.rotor.runout)
        tilts = (scene.rotor.misalignment, scene.stator.misalignment)
        self.constant = not any(isinstance(q, PiecewiseLinear) for q in (*loads, *others, *tilts, *outside))
        # Samples have no frequency and sweeps have many: nothing that needs one, a steady response, a period, is there.
        self.constant = self.constant and not (records(scene) or scene.housing.sweeps)
        # Of films that take waves and pads, those without unknowns press as between plain faces.
        pressed = film_unknowns is not None
        self.faces_tilt = pressed and faces_tilt(scene)
        tilted = alike_sectors(scene, pressed) == 1
        self._choose(tilted, shifted or _axial_motion_is_imposed(scene))
        self.film_unknowns = film_unknowns
        self._place((scene.stator, scene.rotor))
        if self.faces_tilt:
            orders = " and ".join(map(str, face_orders(scene)))
            self.reasons.append(f"faces of order {orders} press with a moment when aligned: rings rest tilted")
        if waves_of(scene) and not pressed:
            self.reasons.append("wavy faces: the gap and leakage have the waves, the film's forces are as given")
        for name in self.turning_supports:
            self.reasons.append(f"{name}: two tilt stiffnesses that turn, so that the tilts are driven twice a turn")
        if self.elastic_rings and self.with_tilt:
            self.reasons.append("secondary seal that gives: place by place around its circle")
        if self.massless:
            self.reasons.append("massless ring: no rates among its unknowns, first order in time (IDA)")
        if film_unknowns:
            self.reasons.append(f"film with {len(film_unknowns.names)} unknowns of its own: residual form")
            if np.any(film_unknowns.differential):
                self.reasons.append("film that stores: each mode and response meets it at its own frequency")

    def seal(self, k: int):
        """Secondary seal of ring k (0 stator, 1 rotor), or None."""
        return (self.scene.stator, self.scene.rotor)[k].secondary_seal

    @property
    def massless(self) -> bool:
        """Whether any displacement lacks inertia."""
        return bool(np.any(self.lacks_inertia))

    @property
    def has_residual_form(self) -> bool:
        """Whether only a residual says how the unknowns move: no explicit right-hand side."""
        return self.massless or self.film_unknowns is not None

    def among_three(self) -> list[int]:
        """Places of the displacements among three per floating ring."""
        parts = [i for i in range(3) if (i == 0 and self.with_axial) or (i > 0 and self.with_tilt)]
        return [3 * a + i for a in range(sum(self.floats.values())) for i in parts]

    def _choose(self, tilted: bool, shifted: bool):
        """Which kinds of motion the scene has, and why."""
        arrangement = {(True, False): "FMS", (False, True): "FMR", (True, True): "FMSR"}
        floating = " and ".join(RING_NAMES[k] for k in (STATOR, ROTOR) if self.floats[k])
        self.reasons = [f"{arrangement[self.floats[STATOR], self.floats[ROTOR]]}: support under {floating}"]
        self.with_tilt, self.with_axial = tilted, True
        if not tilted:
            self.reasons.append("aligned faces and no angular forcing: axial unknowns only")
        elif self.linear and not (shifted or self.loaded):
            self.with_axial = False
            self.reasons.append("linear film and no axial forcing: axial motion decouples and stays at rest")
        elif self.linear:
            self.reasons.append("linear film: axial and angular motion decouple, both are driven")

    def _place(self, rings):
        """Places in `y`: displacements of both rings, their rates, the film, what only measures."""
        self.ring_block, self.names = np.zeros(equations.LEG_AT), []
        self.ring_block[equations.OFFSET : equations.LEG_AT] = offset_block(self.scene.film)
        blocks = [self.ring_block[equations.RING * k : equations.RING * (k + 1)] for k in range(2)]
        place = 0
        for k, (ring, block) in enumerate(zip(rings, blocks, strict=True)):
            block[equations.AT_Z : equations.SEAL_LINE] = -1
            if not self.floats[k]:
                continue
            support, seal = ring.support, ring.secondary_seal
            block[equations.SEAL_LINE :] = 0.0
            block[equations.UNEVEN_K], block[equations.AXIS] = support.tilt_difference(), support.tilt_axis
            if seal:
                block[equations.SEAL_LINE], block[equations.SEAL_RADIUS] = seal.line(), seal.radius
                block[equations.SEAL_SMOOTH] = seal.law == "regularised"
                # Loaded only where a ring has it.
                if k in self.elastic_rings:
                    from .secondary_seal import elastic_friction as friction
                else:
                    from .secondary_seal import friction_on_ring as friction
                block[equations.SEAL_KERNEL] = Value(friction, SEAL_TYPE).address
            block[equations.FLOATS : equations.AXIAL_K] = 1.0, ring.mass, ring.transverse_inertia, ring.polar_inertia
            block[equations.AXIAL_K : equations.AT_Z] = support.axial_stiffness, support.axial_damping, *support.tilt()
            if self.with_axial:
                block[equations.AT_Z], place = place, place + 1
                self.names.append(f"{RING_NAMES[k]}_z")
            if self.with_tilt:
                block[equations.AT_TILT], place = place, place + 2
                self.names += [f"{RING_NAMES[k]}_tilt_x", f"{RING_NAMES[k]}_tilt_y"]
        self.n = place
        self.rate_places = np.full(self.n, -1)
        for ring, block in zip(rings, blocks, strict=True):
            z, tilt = int(block[equations.AT_Z]), int(block[equations.AT_TILT])
            if z >= 0 and ring.mass > 0:
                block[equations.AT_Z_RATE] = self.rate_places[z] = place
                place += 1
            if tilt >= 0 and ring.transverse_inertia > 0:
                block[equations.AT_TILT_RATE] = place
                self.rate_places[tilt : tilt + 2] = place, place + 1
                place += 2
        self.lacks_inertia = self.rate_places < 0
        self.n_mechanical = place
        place += len(self.film_unknowns.names) if self.film_unknowns else 0
        self.film = slice(self.n_mechanical, place)
        self.size = place + WORKS + (MORE if self.extended else 0)
        self.impulse = place if self.extended else None
        self.works = slice(self.size - WORKS - (2 if self.extended else 0), self.size - 1)
        self.ring_block[equations.WORKS_AT], self.ring_block[equations.EXTENDED] = self.works.start, self.extended

    def algebraic(self, film_damping: np.ndarray) -> list[int]:
        """Places of the algebraic unknowns: displacements without mass and without any damping on them, and those of
        the film.  `film_damping` (3, 3)."""
        places = []
        for k in range(2):
            block = self.ring_block[equations.RING * k : equations.RING * (k + 1)]
            z, tilt = int(block[equations.AT_Z]), int(block[equations.AT_TILT])
            if z >= 0 and self.rate_places[z] < 0 and not (block[equations.AXIAL_D] or film_damping[0, 0]):
                places.append(z)
            if tilt >= 0 and self.rate_places[tilt] < 0 and not (block[equations.TILT_D] or film_damping[1, 1]):
                places += [tilt, tilt + 1]
        if self.film_unknowns:
            places += [self.film.start + int(i) for i in np.flatnonzero(~self.film_unknowns.differential)]
        return places

    def scales(self, model):
        """Scales of the unknowns (size,): clearance, clearance / outer radius, times the reference rate for rates, an
        energy for the works; also that rate (rad/s) and the shortest period of interest (s)."""
        scene = self.scene
        length, tilt = model.clearance, model.clearance / scene.film.outer_radius
        displacement = np.array([length if name.endswith("_z") else tilt for name in self.names])
        values, _ = model.linear_scene().eigen()
        # What only decays sets no pace: a squeezed film forgets within nanoseconds, and the steps pass over that.  The
        # slowest decay is the motion of a scene in which nothing turns, shakes or rings.
        natural, sizes = float(np.max(np.abs(values.imag), initial=0.0)), np.abs(values)
        slowest = float(np.min(sizes[sizes > ROUNDING * np.max(sizes, initial=0.0)], initial=np.inf))
        forced = [2 * math.pi * v.frequency for v in scene.housing.tones]
        forced += [2 * math.pi * max(sweep.frequency) for sweep in scene.housing.sweeps]
        forced += [sampled.rate for sampled in splines(scene).values()]
        alone = natural or (slowest if slowest < np.inf else 1.0)
        rate = largest_value(scene.shaft.speed) or max(forced, default=alone)
        scales = np.full(self.size, self._energy(model, length, tilt))
        scales[: self.n] = displacement
        for i, place in enumerate(self.rate_places):
            if place >= 0:
                scales[place] = displacement[i] * rate
        if self.film_unknowns:
            scales[self.film] = self.film_unknowns.scales
        if self.impulse is not None:
            scales[self.impulse] = max(abs(model.closing_force()), 1.0) / rate
        return scales, rate, 2 * math.pi / max([rate, *forced, natural])

    def _energy(self, model, length, tilt) -> float:
        """Energy of the motion to be expected: stiffness times the square of what is imposed (at most of the
        clearance), so that a gentle scene is audited as sharply as a violent one."""
        stiffness, _ = model.film_matrices()
        blocks = [self.ring_block[equations.RING * k : equations.RING * (k + 1)] for k in range(2)]
        spring_z, spring_t = (sum(block[i] for block in blocks) for i in (equations.AXIAL_K, equations.TILT_K))
        axial, angular = spring_z + abs(stiffness[0, 0]), spring_t + abs(stiffness[1, 1])
        # A changing load moves the equilibrium by an unknown part of the clearance.
        scene, amplitude = self.scene, 0.1 if self.loaded else 1e-3
        for row in harmonics_of_segment(scene.shaft, scene.housing, scene.rotor, scene.stator, model.start):
            size = length if row[1] == AXIAL else tilt
            if row[1] in ON_RING:
                held = axial * length if row[1] == PULL else angular * tilt
                size = max(held, 1e-300) / (row[7] ** 2 if row[1] == UNBALANCE else 1.0)
            amplitude = max(amplitude, abs(row[2]) / size)
        for key, record in records(scene).items():
            scales = (axial * length, *2 * [angular * tilt]) if ".load." in key else (length, tilt, tilt)
            for column, scale in zip(record.columns(), scales, strict=True):
                amplitude = max(amplitude, max(map(abs, column)) / max(scale, 1e-300))
        for sweep in scene.housing.sweeps:
            amplitude = max(amplitude, largest_amplitude(sweep) / (tilt if tilts(sweep) else length))
        for start in (scene.initial.stator, scene.initial.rotor):
            for given, scale in ((start.z, length), (start.tilt_x, tilt), (start.tilt_y, tilt)):
                amplitude = max(amplitude, abs(given or 0.0) / scale)
        largest = max(axial * length**2, angular * tilt**2)
        return max(largest * min(amplitude, 1.0) ** 2, 1e-30)


def _axial_motion_is_imposed(scene) -> bool:
    """Whether anything but its own start ever moves a ring axially."""
    runouts = any(runout.amplitude for runout in scene.rotor.axial_runout)
    sampled = any(m.moves("axial") for m in (scene.housing.motion, scene.shaft.motion) if m)
    vibrations = [*scene.housing.axial_tones, *scene.housing.axial_sweep]
    shaken = any(one.displacement or one.acceleration for one in vibrations)
    return runouts or sampled or shaken or any(pulls(load_of(ring)) for ring in (scene.stator, scene.rotor))
