"""What a rough film carries: means over Christensen's heights at a mean film thickness.

**Source** Lebeck, Teale & Pierce, ONR ME-95(79)ONR-414-1 (1979), ch. 2: density 35/(32 c^7) (c^2 - d^2)^3 of the
heights |d| < c = 3 rms; the mean film E(H) carries the Couette flow and is what the film stores, the mean cube E(H^3)
the Poiseuille flow in both directions, the mean reciprocal E(1/H) the shear.  H = max(h + d, 0).
**Valid** heights far lower than they are long, the same in every direction.  faces/roughness.py has the same means for
arrays.
"""

import math

import numpy as np

from ...faces.geometry import regularised_thickness
from ...numerics.kernel import inner_kernel

# Above the last asperity's foot, in c: nearer to it h is continued, so that no film closes altogether.
NEAREST = 0.05
# Films thinner than this share of c do not count in the shear: its mean would diverge.
CUTOFF = 0.1
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(16)


@inner_kernel()
def open_height(h, c, floor):
    """Mean film (m) as the flow sees it: h itself, and its positive continuation below the `floor` (m) of smooth faces
    (c = 0), or near -c between rough ones."""
    return regularised_thickness(h + c, lowest(c, floor)) - c


@inner_kernel()
def open_slope(h, c, floor):
    """How `open_height` moves with h."""
    low = lowest(c, floor)
    return 1.0 if h + c >= low else (low / (2.0 * low - h - c)) ** 2


@inner_kernel()
def lowest(c, floor):
    """Height (m) over the feet of the asperities from which on the film is continued."""
    return floor if c == 0.0 else NEAREST * c


@inner_kernel()
def contact_share(h, c):
    """Share of the area in contact, P(h/c); 0 between smooth faces (c = 0)."""
    if c == 0.0 or h >= c:
        return 0.0
    u = min(0.5 * (1.0 - h / c), 1.0)
    return u**4 * (35.0 - u * (84.0 - u * (70.0 - 20.0 * u)))


@inner_kernel()
def mean_film(h, c):
    """E(H) (m)."""
    if c == 0.0 or h >= c:
        return h
    # Factored about h = -c, where the film closes: nothing cancels.
    u = max(0.5 * (1.0 + h / c), 0.0)
    return c * u**5 * (14.0 - u * (28.0 - u * (20.0 - 5.0 * u)))


@inner_kernel()
def mean_cube(h, c):
    """E(H^3) (m^3)."""
    if c == 0.0:
        return h**3
    if h >= c:
        return h * (h * h + c * c / 3.0)
    u = max(0.5 * (1.0 + h / c), 0.0)
    return c**3 * u**7 * (8.0 - u * (12.0 - u * (20.0 / 3.0 - u * (4.0 / 3.0))))


@inner_kernel()
def mean_reciprocal(h, c):
    """E(1/H) (1/m) over films thicker than CUTOFF c: Gauss points in ln H, where the integrand is smooth."""
    if c == 0.0:
        return 1.0 / h
    x = h / c
    top, low = x + 1.0, max(x - 1.0, CUTOFF)
    if top <= low:
        return 0.0
    middle, half, total = 0.5 * math.log(top * low), 0.5 * math.log(top / low), 0.0
    for k in range(len(POINTS)):
        d = math.exp(middle + half * POINTS[k]) - x
        total += WEIGHTS[k] * (1.0 - d * d) ** 3
    return 35.0 / 32.0 * half * total / c
