"""A wavy ring that bends: which waviness it has under load, of the one it was made with.

    h_deflected,n = [ (n^2 + A)/(n^6 - 2 n^4 + n^2) ] (r_c^3/(E J)) [ int (p + p_c) r dr ]_n,   A = E J/(G J_t)

Film and asperities press on the standing ring where the film is thin and so level its waves: what it had at first is
the waviness that is left (net) less the deflection, which pushes the ring away where the pressure is high.
**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), eqs. 3-1 to 3-12; re-derived from the strain energy of
bending and torsion of a ring of uniform section.
**Valid** one order n >= 2 of waves, small deflections, a ring thin in its radius, loads that turn no section by
themselves; static.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from ..dynamics.interface import Interface, flow_at_rest, rest_state
from ..faces.geometry import CONTACT_FORCE, FORCE
from ..faces.roughness import contact_fraction
from ..films.reynolds.mesh import ANGLE_STEP, AREA, SCALE, table
from ..films.reynolds.wrench import of_cells
from ..scene.contact import HALF_HEIGHT
from ..scene.waviness import Waviness

# Angles of a wave for the asperities.
FINE = 2048


@dataclass(frozen=True)
class ElasticRing:
    """Bending stiffness E J (N m^2) out of its plane, its ratio A to the torsional one G J_t, radius of its centroid
    (m)."""

    bending_stiffness: float
    torsion_ratio: float
    radius: float

    def compliance(self, order: int) -> float:
        """Deflection (m) per n-th harmonic (N) of a load int p r dr, with A and the centroid's radius as above, m/N."""
        bends = order**2 * (order**2 - 1) ** 2
        return (order**2 + self.torsion_ratio) * self.radius**3 / (self.bending_stiffness * bends)

    def largest_waviness(self, order: int, pressure: float, length: float) -> float:
        """Largest waviness (m) that a pressure (Pa) between two O-rings `length` (m) apart can give the ring, by a
        couple that follows cos(n theta): eq. 3-12, length^2 (1 + A) r^3 pressure/(8 E J (n^2 - 1)^2)."""
        couple = 0.125 * length**2 * pressure * self.radius**3 / self.bending_stiffness
        return couple * (1.0 + self.torsion_ratio) / (order**2 - 1) ** 2


@dataclass(frozen=True)
class OperatingPoint:
    """Waviness under load, `net`, and that of the ring without, `initial` (m); load support (film over film and
    asperities), and clearance (m)."""

    net: float
    initial: float
    load_support: float
    clearance: float


def operating_point(scene, ring: ElasticRing, order: int, net: float) -> OperatingPoint:
    """Where film and asperities of a scene carry its closing force when the standing ring has a `net` waviness (m) of
    this order, and the waviness that it was made with.  Raises SceneError where nothing carries it."""
    waves = [Waviness(order=order, amplitude=net)]
    interface = Interface(replace(scene, stator=replace(scene.stator, waviness=waves)), 1e-8)
    s, _ = rest_state(interface.scene, interface.clearance)
    flow_at_rest(interface, s)
    deflected = ring.compliance(order) * _harmonic(interface, s, order, net)
    support = float(s[FORCE] / (s[FORCE] + s[CONTACT_FORCE]))
    return OperatingPoint(net, abs(net - deflected), support, interface.clearance)


def operating_points(scene, ring, order, initial, nets) -> list[tuple[OperatingPoint, bool]]:
    """Every operating point of a ring made with an `initial` waviness (m), and whether it holds; `nets` rising (m),
    between which they are looked for.  It holds where more waviness left would need more to begin with.

    **Source** Lebeck et al. (1979), ch. 3: the slope of the initial over the net waviness."""
    found, before = [], operating_point(scene, ring, order, nets[0])
    for net in nets[1:]:
        here = operating_point(scene, ring, order, net)
        if (before.initial - initial) * (here.initial - initial) <= 0.0 and before.initial != here.initial:
            at = brentq(lambda h: operating_point(scene, ring, order, h).initial - initial, before.net, net, rtol=1e-6)
            found.append((operating_point(scene, ring, order, at), here.initial > before.initial))
        before = here
    return found


def _harmonic(interface, s, order, net) -> complex:
    """n-th harmonic (N per rad) of the load int (p + p_c) r dr on the ring, cosine part real."""
    f, contact = interface.f, interface.scene.contact
    u = of_cells(f, interface.steady(f, s))
    load = np.maximum(u, 0.0) @ table(f, AREA)[: u.shape[1]] * f[SCALE]
    film = 2.0 * np.mean(load * np.exp(1j * order * f[ANGLE_STEP] * np.arange(len(load))))
    if contact is None:
        return complex(film)
    # Of one wave, as fine as it takes.
    theta = 2.0 * math.pi / FINE * np.arange(FINE)
    touching = contact_fraction((interface.clearance + net * np.cos(theta)) / (HALF_HEIGHT * contact.roughness))
    faces = 0.5 * (interface.scene.film.outer_radius**2 - interface.scene.film.inner_radius**2)
    return complex(film + 2.0 * contact.compressive_strength * faces * np.mean(touching * np.cos(theta)))
