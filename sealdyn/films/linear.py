"""Linear film: constant stiffness and damping about the aligned equilibrium.

    F = F_0 - K_z dz - D_z dz',     M = -[ K g + D (g' - i wm g) ]      (on the stator)

**Source** coefficients from Green (1987; appendix of Green 1989), from another film's linearisation, or
the user's own.  The term with the mean spin wm is the wedge (half-speed entrainment), the only
destabilising one.  Green's stiffness follows the pressure drop and his damping the viscosity, so both
follow tables over time; the user's own numbers stay as given.
**Valid** small motion: |g| r_o and dz well below the clearance; then it costs nothing.
Leakage and drag are those of the narrow seal at the tilted and wavy film (_line_laws.py).
"""

import numpy as np

from ..closed_form import film_coefficients, narrow_seal_opening_force
from ..faces.geometry import (
    CAVITATED,
    DZ,
    DZ_RATE,
    FACE_SIZE,
    FLOW_INNER,
    FLOW_OUTER,
    FORCE,
    GX,
    GX_RATE,
    GY,
    GY_RATE,
    INNER_PRESSURE,
    MEAN_SPIN,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    TORQUE,
    VISCOSITY,
    face_parameters,
)
from ..numerics.kernel import value_kernel
from ..numerics.piecewise_linear import initially
from ..scene.film import Coefficients, coning_varies
from ._contract import Film
from ._line_laws import forces_per_pressure, narrow_seal, normal_conditions


def accepts(film, waves=()) -> str:
    """What faces it takes, "" if it can take these: waves under the user's own numbers, if it is asked for by name."""
    if film is not None and film.profile is not None:
        return "plain cones only"
    if film is not None and film.inertia:
        return "a fluid without inertia"
    if film is not None and coning_varies(film):
        return "a coning that stays as it is"
    own = film is not None and film.model == "linear" and isinstance(film.coefficients, Coefficients)
    if film is not None and film.gas is not None and not (own and film.clearance is not None):
        return 'a gas with model = "linear", a clearance and a table film.coefficients of your own numbers'
    return "" if own or not waves else 'waves, with model = "linear" and a table film.coefficients of your own numbers'


# Block layout after the faces: each coefficient is a constant plus a part per pressure drop or viscosity.
# Then forces per pressure, and of a gas normal temperature over normal pressure (K/Pa), 0 of a liquid.
TILT_K, TILT_K_DP, TILT_D, TILT_D_MU, AXIAL_K, AXIAL_K_DP, AXIAL_D, AXIAL_D_MU, FORCE_I, FORCE_O, GAS = range(
    FACE_SIZE, FACE_SIZE + 11
)
BLOCK_SIZE = FACE_SIZE + 11


def parameters(film, clearance: float, error: float = 1e-8) -> np.ndarray:
    """The film's block of the parameter array, shape (BLOCK_SIZE,).  `error` is not needed: no quadrature."""
    f = np.zeros(BLOCK_SIZE)
    f[:FACE_SIZE] = face_parameters(film, clearance)
    if film.coefficients == "green":
        faces = film.inner_radius, film.outer_radius, clearance, initially(film.coning)
        c = film_coefficients(*faces, viscosity=1.0, pressure_drop=1.0)
        f[TILT_K_DP], f[TILT_D_MU] = c.tilt_stiffness, c.tilt_damping
        f[AXIAL_K_DP], f[AXIAL_D_MU] = c.axial_stiffness, c.axial_damping
    else:
        c = film.coefficients
        f[TILT_K], f[TILT_D], f[AXIAL_K], f[AXIAL_D] = (
            c.tilt_stiffness,
            c.tilt_damping,
            c.axial_stiffness,
            c.axial_damping,
        )
    f[GAS] = normal_conditions(film)
    f[FORCE_I], f[FORCE_O] = forces_per_pressure(film, clearance)
    return f


def opening_law(film, mean_spin=0.0, spin_difference=0.0):
    """Opening force (N) of the aligned narrow seal at rest, `force(clearance, inner_pressure, outer_pressure, floor)`;
    pressures absolute (Pa), clearance in m; it has no use for a floor."""
    faces = dict(inner_radius=film.inner_radius, outer_radius=film.outer_radius, coning=initially(film.coning))

    def force(clearance: float, inner_pressure: float, outer_pressure: float, floor: float | None = None) -> float:
        pressures = dict(inner_pressure=inner_pressure, outer_pressure=outer_pressure)
        return float(narrow_seal_opening_force(**faces, clearance=clearance, **pressures))

    return force


def matrices(f, s):
    """Stiffness and damping, each (3, 3), on (dz, g_x, g_y) at a gap state: the film's own numbers, to the last bit."""
    drop, mu = s[OUTER_PRESSURE] - s[INNER_PRESSURE], s[VISCOSITY]
    k, d = f[TILT_K] + f[TILT_K_DP] * drop, f[TILT_D] + f[TILT_D_MU] * mu
    wedge = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]) * d * s[MEAN_SPIN]
    stiffness = np.diag([f[AXIAL_K] + f[AXIAL_K_DP] * drop, k, k]) + wedge
    return stiffness, np.diag([f[AXIAL_D] + f[AXIAL_D_MU] * mu, d, d])


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    drop, mu = s[OUTER_PRESSURE] - s[INNER_PRESSURE], s[VISCOSITY]
    k, d = f[TILT_K] + f[TILT_K_DP] * drop, f[TILT_D] + f[TILT_D_MU] * mu
    k_z, d_z = f[AXIAL_K] + f[AXIAL_K_DP] * drop, f[AXIAL_D] + f[AXIAL_D_MU] * mu
    wedge = d * s[MEAN_SPIN]
    s[FORCE] = f[FORCE_I] * s[INNER_PRESSURE] + f[FORCE_O] * s[OUTER_PRESSURE] - k_z * s[DZ] - d_z * s[DZ_RATE]
    s[MOMENT_X] = -k * s[GX] - d * s[GX_RATE] - wedge * s[GY]
    s[MOMENT_Y] = -k * s[GY] - d * s[GY_RATE] + wedge * s[GX]
    s[CAVITATED] = 0.0


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) and friction torque on the rotor (N m) of the narrow seal at this gap."""
    wrench(f, s)
    volume, s[TORQUE] = narrow_seal(f, s, f[GAS])
    s[FLOW_INNER] = s[FLOW_OUTER] = volume


FILM = Film(
    name="linear",
    constant=True,
    fidelity=1,
    fluids=("liquid", "gas"),
    accepts=accepts,
    parameters=parameters,
    opening_law=opening_law,
    opening_slots=(FORCE_I, FORCE_O),
    matrices=matrices,
    wrench=wrench,
    flow=flow,
)
