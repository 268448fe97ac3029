"""The scenes of `families.wide` and `families.gas_reynolds` once more, in the tests' own words: nothing of the program
but the scene's data.

Frames as everywhere: z along the shaft from rotor to stator, tilts complex, `gamma = tilt_x + i tilt_y`, film thickness
`h = C + z_s - z_r + coning (r - r_i) + r (g_x sin(theta) - g_y cos(theta))` with the relative tilt g of the stator.
A ring of transverse inertia I, polar J, spin W on a carrier (housing or shaft) c, with its own misalignment m:

    M z'' = +-(film + asperities - closing) - K (z - z_c) - D (z - z_c)' + O-ring
    I gamma'' - i J W gamma' = +-(film + asperities) - K_s (gamma - gamma_c - m) - D_s q + O-ring
    q = (gamma - gamma_c)' - i W (gamma - gamma_c)
"""

import cmath
import math
import time

import numpy as np
import own_face
from own_face import DRAG, FLOW, FORCE, MOMENT_X, MOMENT_Y, PRESS, PRESS_X, PRESS_Y, RUB
from own_gas import LOADS, OwnGas
from scipy.integrate import DOP853, Radau

from sealdyn.scene.fluid import gas_of


def value_and_slope(quantity, start, end):
    """Value at `start` and slope of a number or table that has no kink between `start` and `end` (s)."""
    if not hasattr(quantity, "time"):
        return float(quantity), 0.0
    # Inside, so that it does not matter to which side a step at the ends belongs.
    width = end - start
    one, other = np.interp([start + 0.25 * width, start + 0.75 * width], quantity.time, quantity.value)
    slope = (other - one) / (0.5 * width)
    return one - 0.25 * width * slope, slope


class OwnSeal:
    """Equations of motion of a scene over `duration` (s).  y holds the displacements `names` (n,) (m, rad), then their
    rates, then the unknowns of a gas film (own_gas.py); `breaks` (s) are the kinks of tables inside the run; `lengths`
    (n,) and `rate` (rad/s) the scales of `columns`.

    Three of its laws are definitions of the program: the film of rough faces that nearly touch (own_face.py), Gaussian
    asperities as polynomials (own_face.py), and the regularised O-ring, of which the whole wrench fades.  Raises
    NotImplementedError for what `wide` does not draw, and for O-rings that stick."""

    def __init__(self, scene, duration):
        self.scene, self.duration, film = scene, duration, scene.film
        both = (("stator", scene.stator), ("rotor", scene.rotor))
        self.floating = [(name, ring) for name, ring in both if ring.support]
        self.names = [f"{name}_{part}" for name, _ in self.floating for part in ("z", "tilt_x", "tilt_y")]
        self.n = len(self.names)
        self._refuse()
        gas = gas_of(film)
        self.gas = self._film_of(gas)
        viscosity = film.viscosity
        if gas and viscosity is None:
            hot, cold, s = film.temperature, gas.reference_temperature, gas.sutherland_temperature
            viscosity = gas.reference_viscosity * (hot / cold) ** 1.5 * (cold + s) / (hot + s)
        varying = {
            "spin_s": scene.stator.speed, "spin_r": scene.shaft.speed, "mu": viscosity,
            "p_i": film.inner_pressure, "p_o": film.outer_pressure, "tilt_s": scene.stator.misalignment,
            "tilt_r": scene.rotor.misalignment if scene.rotor.support else scene.rotor.runout,
        }  # fmt: skip
        kinks = {t for quantity in varying.values() for t in getattr(quantity, "time", ())}
        self.breaks = sorted(t for t in kinks if 0.0 < t < duration)
        self.edges = [0.0, *self.breaks, duration]
        self.pieces = [
            {name: value_and_slope(quantity, *ends) for name, quantity in varying.items()}
            for ends in zip(self.edges, self.edges[1:], strict=False)
        ]
        # Angles of stator and shaft at the start of each piece.
        self.angles = {"_s": [0.0], "_r": [0.0]}
        for k in range(len(self.pieces)):
            ends = self._at(self.edges[k + 1], k)
            for side, angles in self.angles.items():
                angles.append(ends["phi" + side])
        self._contact()
        # Closing area over face area (of the high side) that holds the aligned faces at the clearance at first.
        self.area, first = math.pi * (film.outer_radius**2 - film.inner_radius**2), self._at(0.0, 0)
        self.outside = first["p_o"] >= first["p_i"]
        at_rest = (film.clearance, 0.0, 0.0, 0.0, 0.0, 0.0)
        loads = self._loads(first, at_rest, self.gas.steady(first, at_rest) if gas else ())
        low, high = sorted((first["p_i"], first["p_o"]))
        self.balance = ((loads[FORCE] + loads[PRESS]) / self.area - low) / (high - low) if high > low else 1.0
        lengths = [film.clearance if name.endswith("z") else film.clearance / film.outer_radius for name in self.names]
        self.lengths, self.rate = np.array(lengths), self._reference_rate()

    def _film_of(self, gas):
        """A film with unknowns of its own, or None."""
        floor = 1.8 * self.scene.contact.roughness if self.scene.contact else 0.0
        return OwnGas(self.scene.film, gas, floor) if gas else None

    def _refuse(self):
        scene, film = self.scene, self.scene.film
        for name, ring in self.floating:
            if ring.secondary_seal and ring.secondary_seal.law != "regularised":
                raise NotImplementedError(f"{name}: an O-ring that sticks")
            if not (ring.mass > 0 and ring.transverse_inertia > 0):
                raise NotImplementedError(f"{name}: a ring without inertia")
        known = ("auto", "radial") if film.gas is None else ("gas_reynolds",)
        plain = film.geometry == "cylindrical" and film.tilt_radius == "local" and film.model in known
        extra = (film.inertia, film.profile, film.pads, film.cavitation_pressure is not None, film.clearance is None)
        # Between equal pressures the balance ratio is nothing.
        equal = film.inner_pressure == film.outer_pressure
        given = (scene.closing.balance_ratio is not None and not equal, scene.closing.spring_force is not None)
        if film.gas is not None and (hasattr(film.temperature, "time") or film.gas_reynolds is None):
            raise NotImplementedError("a gas that warms up, or cells by default")
        waves = scene.stator.waviness or scene.rotor.waviness
        coned = hasattr(film.coning, "time") or film.coning_per_speed_squared or film.coning_per_kelvin
        if not plain or any(extra) or any(given) or waves or coned:
            raise NotImplementedError("a film, waves or a closing force that `wide` does not draw")

    def _contact(self):
        film, contact = self.scene.film, self.scene.contact
        self.law, self.levels, floor = own_face.NONE, np.empty(0), 0.0
        self.touching = np.array([1.0, 0.0, 0.0, 0.0, 0.0])
        if contact:
            rms, height = contact.roughness, 3.0 * contact.roughness
            friction, shear, floor = contact.friction_coefficient, contact.shear_strength, 0.6 * height
            share = 0.0 if shear is not None else 0.1 if friction is None else friction
            if contact.law == "christensen":
                self.law, self.levels = own_face.CHRISTENSEN, np.array([height, floor, -height])
                laws = height, contact.compressive_strength, 1.0
            else:
                # Greenwood and Williamson: 4/3 n E sqrt(R) rms^(3/2) F_3/2 and pi n R rms F_1.
                number, radius = contact.asperity_density, contact.asperity_radius
                unit = 4.0 / 3.0 * number * contact.modulus * math.sqrt(radius) * rms**1.5
                self.law, self.levels = own_face.GAUSSIAN, np.array([5.0 * rms, floor, -height])
                laws = rms, unit, math.pi * number * radius * rms
            self.touching = np.array([*laws, share, shear or 0.0])
        self.face = np.array([film.inner_radius, film.outer_radius, film.coning, floor])

    def _reference_rate(self):
        ends = [self._at(self.edges[k + j], k) for k in range(len(self.pieces)) for j in (0, 1)]
        tones = [2 * math.pi * tone.frequency for tone in (*self.scene.housing.axial, *self.scene.housing.angular)]
        return max(*(abs(now["spin_r"]) for now in ends), *(abs(now["spin_r"] - now["spin_s"]) for now in ends), *tones)

    # --- conditions and motion ------------------------------------------------------------------------

    def piece(self, t):
        """Which piece of the tables holds from the time t (s) on."""
        return int(np.searchsorted(self.breaks, t, side="right"))

    def _at(self, t, piece):
        """Conditions at a time (s) of a piece, slopes as `NAME_rate`, angles of stator and shaft `phi_s`, `phi_r`."""
        dt, now = t - self.edges[piece], {}
        for name, (value, slope) in self.pieces[piece].items():
            now[name], now[name + "_rate"] = value + slope * dt, slope
        for side, angles in self.angles.items():
            speed, slope = self.pieces[piece]["spin" + side]
            now["phi" + side] = angles[piece] + dt * (speed + 0.5 * slope * dt)
        return now

    def _carriers(self, t, now):
        """Of housing and shaft: axial displacement, its rate, tilt, its rate."""

        def tones(table):
            total = rate = 0.0
            for tone in table:
                w = 2 * math.pi * tone.frequency
                size = -tone.acceleration / w**2 if tone.displacement is None else tone.displacement
                size = size * cmath.exp(1j * getattr(tone, "direction", 0.0))
                total += size * math.cos(w * t + tone.phase)
                rate -= size * w * math.sin(w * t + tone.phase)
            return total, rate

        (z, z_rate), (tilt, tilt_rate) = tones(self.scene.housing.axial), tones(self.scene.housing.angular)
        housing = (complex(z).real, complex(z_rate).real, tilt, tilt_rate)
        z = z_rate = tilt = tilt_rate = 0.0
        for wave in self.scene.rotor.axial_runout:
            angle = wave.order * now["phi_r"] + wave.phase
            z += wave.amplitude * math.cos(angle)
            z_rate -= wave.amplitude * wave.order * now["spin_r"] * math.sin(angle)
        for whirl in self.scene.shaft.whirl:
            one = cmath.rect(whirl.angle, whirl.ratio * now["phi_r"] + whirl.phase)
            tilt, tilt_rate = tilt + one, tilt_rate + 1j * whirl.ratio * now["spin_r"] * one
        return {"stator": housing, "rotor": (z, z_rate, tilt, tilt_rate)}

    def _motion(self, t, y, now):
        """Carriers and rings by name, each axial displacement, its rate, tilt, its rate; own misalignments by name."""
        carriers, rings, own, rotor = self._carriers(t, now), {}, {}, self.scene.rotor
        phases = {
            "stator": self.scene.stator.misalignment_direction,
            "rotor": rotor.misalignment_phase if rotor.support else rotor.runout_phase,
        }
        for name, phase in phases.items():
            side = "_" + name[0]
            # A misalignment turns with its ring.
            turning = cmath.exp(1j * (now["phi" + side] + phase))
            own[name] = now["tilt" + side] * turning
            z, v, tilt, rate = carriers[name]
            own_rate = now["tilt" + side + "_rate"] * turning + 1j * now["spin" + side] * own[name]
            rings[name] = z, v, tilt + own[name], rate + own_rate
        for k, (name, _) in enumerate(self.floating):
            (z, x, xi), (v, x_rate, xi_rate) = y[3 * k : 3 * k + 3], y[self.n + 3 * k : self.n + 3 * k + 3]
            rings[name] = z, v, complex(x, xi), complex(x_rate, xi_rate)
        return carriers, rings, own

    def _gap(self, rings):
        h, h_rate, g, g_rate = (one - other for one, other in zip(rings["stator"], rings["rotor"], strict=True))
        return self.scene.film.clearance + h, g.real, g.imag, h_rate, g_rate.real, g_rate.imag

    def _loads(self, now, gap, x):
        """Loads in the order of own_face.py; `x` the unknowns of a gas film."""
        if self.gas:
            return self._rates_and_loads(now, gap, x)[1]
        conditions = (now["mu"], now["p_i"], now["p_o"], now["spin_s"], now["spin_r"])
        return own_face.face_loads(self.face, conditions, gap, self.law, self.touching, self.levels)

    def _rates_and_loads(self, now, gap, x):
        """Rates of a gas film's unknowns, if there are any, and loads."""
        if not self.gas:
            return (), self._loads(now, gap, x)
        rates, loads = self.gas.rates_and_loads(now, gap, x)
        rough = np.zeros(9 - LOADS)
        if self.scene.contact:
            # The load of asperities knows no film.
            conditions = (now["mu"], now["p_i"], now["p_o"], now["spin_s"], now["spin_r"])
            rough = own_face.face_loads(self.face, conditions, gap, self.law, self.touching, self.levels)[LOADS:]
        return rates, np.concatenate([loads, rough])

    # --- what is asked --------------------------------------------------------------------------------

    def rates(self, t, y, piece=None):
        """dy/dt at a time (s) of the run; `piece`: of the tables, where t may be its end."""
        now = self._at(t, self.piece(t) if piece is None else piece)
        carriers, rings, own = self._motion(t, y, now)
        gap, x = self._gap(rings), y[2 * self.n :]
        film_rates, loads = self._rates_and_loads(now, gap, x)
        low, high = (now["p_i"], now["p_o"]) if self.outside else (now["p_o"], now["p_i"])
        opening = loads[FORCE] + loads[PRESS] - (high * self.balance + low * (1.0 - self.balance)) * self.area
        opening_moment = complex(loads[MOMENT_X] + loads[PRESS_X], loads[MOMENT_Y] + loads[PRESS_Y])
        out = np.empty(len(y))
        out[2 * self.n :] = film_rates
        out[: self.n] = y[self.n : 2 * self.n]
        for k, (name, ring) in enumerate(self.floating):
            sign, spin, support = 1.0 if name == "stator" else -1.0, now["spin_" + name[0]], ring.support
            (z_c, v_c, tilt_c, rate_c), (z, v, tilt, rate) = carriers[name], rings[name]
            stiffness, damping = support.tilt_stiffness or 0.0, support.tilt_damping or 0.0
            if support.radius is not None:
                stiffness, damping = (
                    part * support.radius**2 / 2 for part in (support.axial_stiffness, support.axial_damping)
                )
            sliding = rate - rate_c - 1j * spin * (tilt - tilt_c)
            force = sign * opening - support.axial_stiffness * (z - z_c) - support.axial_damping * (v - v_c)
            moment = sign * opening_moment - stiffness * (tilt - tilt_c - own[name]) - damping * sliding
            if ring.secondary_seal:
                axial, turning = friction(ring.secondary_seal, v - v_c, sliding)
                force, moment = force + axial, moment + turning
            turn = (moment + 1j * ring.polar_inertia * spin * rate) / ring.transverse_inertia
            out[self.n + 3 * k : self.n + 3 * k + 3] = force / ring.mass, turn.real, turn.imag
        return out

    def jacobian(self, t, y, piece=None):
        """d rates / d y (size, size), of the rings' unknowns by differences: for Newton's method."""
        at, m = self.rates(t, y, piece), 2 * self.n
        matrix, steps = np.zeros((len(y), len(y))), 1e-6 * np.concatenate([self.lengths, self.lengths * self.rate])
        for i, step in enumerate(steps):
            moved = y.copy()
            moved[i] += step
            matrix[:, i] = (self.rates(t, moved, piece) - at) / step
        if self.gas:
            now = self._at(t, self.piece(t) if piece is None else piece)
            gap = self._gap(self._motion(t, y, now)[1])
            matrix[m:, m:], loads = self.gas.slopes(now, gap, y[m:]), self.gas.loads_by_pressures(now, gap)
            for k, (name, ring) in enumerate(self.floating):
                inertia = np.array([[ring.mass], [ring.transverse_inertia], [ring.transverse_inertia]])
                first = self.n + 3 * k
                matrix[first : first + 3, m:] = (1.0 if name == "stator" else -1.0) * loads / inertia
        return matrix

    def begun(self, y0):
        """Unknowns from displacements and rates `y0` (2 n,): those of a gas film are of the steady one."""
        if not self.gas:
            return np.array(y0)
        now = self._at(0.0, 0)
        return np.concatenate([y0, self.gas.steady(now, self._gap(self._motion(0.0, y0, now)[1]))])

    def scale(self):
        """Scales (size,) of y."""
        mechanical = np.concatenate([self.lengths, self.lengths * self.rate])
        if not self.gas:
            return mechanical
        highest = max(piece[side][0] for piece in self.pieces for side in ("p_i", "p_o"))
        return np.concatenate([mechanical, np.full(self.gas.size, highest * self.scene.film.clearance)])

    def columns(self, t, y, piece=None):
        """Row (2 n + 5,) as ErrorScales has it: displacements over `lengths`, rates over these times `rate`, film force
        (N), moments about x and y (N m), flow (m^3/s), torque (N m)."""
        now = self._at(t, self.piece(t) if piece is None else piece)
        loads = self._loads(now, self._gap(self._motion(t, y, now)[1]), y[2 * self.n :])
        motion = [y[: self.n] / self.lengths, y[self.n : 2 * self.n] / (self.lengths * self.rate)]
        return np.concatenate([*motion, loads[: FLOW + 1], [loads[DRAG] + loads[RUB]]])

    def thinnest(self, t, y):
        """Thinnest film (m)."""
        aligned, g_x, g_y, *_ = self._gap(self._motion(t, y, self._at(t, self.piece(t)))[1])
        r_i, r_o, coning, _ = self.face
        tilt = math.hypot(g_x, g_y)
        return min(aligned - r_i * tilt, aligned + coning * (r_o - r_i) - r_o * tilt)


def friction(seal, v, sliding):
    """Force (N) and complex moment (N m) of a regularised O-ring on its ring, which slides at v (m/s) and the tilt rate
    `sliding` (rad/s)."""
    u = seal.radius * abs(sliding)
    speed = math.hypot(v, u)
    if speed == 0.0:
        return 0.0, 0.0
    line = seal.line_friction
    line = seal.friction_force / (2 * math.pi * seal.radius) if line is None else line
    # Integrals around the circle of sign(v + u sin(psi)) and of that times sin(psi); the sign changes at -turn.
    turn = math.asin(min(max(v / u, -1.0), 1.0)) if u > 0.0 else math.copysign(math.pi / 2, v)
    wrench = -line * seal.radius * speed / math.hypot(speed, seal.width)
    along = sliding / abs(sliding) if u > 0.0 else 0.0
    return wrench * 4.0 * turn, wrench * seal.radius * 4.0 * math.cos(turn) * along


def own(scene, duration, y0, times, tolerance, kind=DOP853, deadline=math.inf):
    """Columns (m, 2 n + 5) of `OwnSeal` at increasing times (s), from y0 on, by a solver class of SciPy that starts
    anew at each of them and at each break; fewer rows where the film closes or the solver gives up.  Raises
    TimeoutError after `deadline` (s, of time.process_time)."""
    seal, film = OwnSeal(scene, duration), scene.film
    scale = seal.scale()
    least = -3.0 * scene.contact.roughness if scene.contact else film.floor * film.clearance
    u, t, step, rows, wanted = seal.begun(y0) / scale, 0.0, None, [], {float(stop) for stop in times}
    for stop in sorted(wanted | {kink for kink in seal.breaks if kink < max(wanted)}):
        if stop > t:
            first, piece = min(step, stop - t) if step else None, seal.piece(t)

            def rates(t, u, piece=piece):
                return seal.rates(t, u * scale, piece) / scale

            def jacobian(t, u, piece=piece):
                return seal.jacobian(t, u * scale, piece) * scale / scale[:, None]

            options = {"jac": jacobian} if kind is Radau and seal.gas else {}
            with np.errstate(all="ignore"):
                # A squeezed film pushes by rates far below their scale.
                solver = kind(
                    rates, t, u, stop, rtol=max(tolerance, 1e-13), atol=0.01 * tolerance, first_step=first, **options
                )
                while solver.status == "running":
                    solver.step()
                    if time.process_time() > deadline:
                        raise TimeoutError
                    if solver.status == "failed" or not seal.thinnest(solver.t, solver.y * scale) > least:
                        return np.array(rows)
                    # The last step before a stop is cut short: no measure of the next.
                    step = solver.h_abs if solver.status == "running" else max(solver.h_abs, step or 0.0)
            u, t = solver.y, stop
        if stop in wanted:
            rows.append(seal.columns(t, u * scale))
    return np.array(rows)
