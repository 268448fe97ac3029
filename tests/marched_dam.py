"""Gas flow across a dam by integrating the differential equation of M^2, with nothing of the package.

    dM^2/dx = M^2 (1 + d M^2)/(1 - M^2) (-2 A'/A + 2 g f M^2/h),   d = (g - 1)/2

is marched upstream from the exit as two rates, of ln M^2 and of x, neither of which knows 1/(1 - M^2).
"""

import math
from typing import NamedTuple

from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar


class Dam(NamedTuple):
    """Edges: radius (m), film (m), pressure (Pa), of the side with the high pressure first; the rest as said."""

    radii: tuple[float, float]
    films: tuple[float, float]
    pressures: tuple[float, float]
    temperature: float
    gas_constant: float
    g: float
    viscosity: object  # of the static temperature at the entrance
    friction: object  # f of Re
    radial: bool = False
    local: bool = False
    loss: float = 1.0


class Flow(NamedTuple):
    """Per unit width at the mean radius: mass flow, gauge force (over true areas if friction is local); its centre over
    the dam's width from the entrance."""

    mass_flow: float
    force: float
    centre: float
    entrance_mach: float
    exit_mach: float


def marched(dam: Dam, mach: float, rtol: float):
    """(ln of M1^2 over that which the march arrives with, Flow); (None, None) if it would have been sonic inside."""
    (r_a, r_b), (h_a, h_b), (p_0, p_3) = dam.radii, dam.films, dam.pressures
    g, d = dam.g, (dam.g - 1) / 2
    width, r_mean = abs(r_b - r_a), (r_a + r_b) / 2
    taper, outward = (h_b - h_a) / width, math.copysign(1.0, r_b - r_a)
    m_1 = mach * mach
    p_1 = p_0 / (1 + d * m_1 / dam.loss**2) ** (g / (g - 1))
    q = p_1 * h_a * mach * math.sqrt(1 + d * m_1) * (r_a / r_mean if dam.radial else 1.0)
    mass_flow = q * math.sqrt(g / (dam.gas_constant * dam.temperature))
    reynolds = 2 * mass_flow / dam.viscosity(dam.temperature / (1 + d * m_1))
    ratio = q / (p_3 * h_b * (r_b / r_mean if dam.radial else 1.0))
    m_2 = min(1.0, 2 * ratio**2 / (1 + math.sqrt(1 + 4 * d * ratio**2)))
    f_mean = dam.friction(reynolds)

    def rates(_, y):
        m, x = math.exp(y[0]), y[1]
        h, r = h_a + taper * x, r_a + outward * x
        area, widening = (h * r / r_mean, taper + outward * h / r) if dam.radial else (h, taper)
        f = dam.friction(reynolds * r_mean / r) if dam.local else f_mean
        pressure = q / (area * math.sqrt(m * (1 + d * m)))
        step = (m - 1) * h
        load = (p_3 - pressure) * step * (r / r_mean if dam.local else 1.0)
        return [(1 + d * m) * 2 * (widening - g * f * m), step, load, load * x]

    def edge(_, y):
        return y[1]

    # The march leaves the exit at M = 1 towards smaller M, or not at all.
    def sonic(_, y):
        return y[0] - 1e-9

    edge.terminal = sonic.terminal = True
    # Both rates die out where M^2 stays at nearly 1, which it does if the film opens as fast as friction allows.
    load, longest = p_0 * width, 300 * width / min(h_a, h_b)
    done = solve_ivp(
        rates,
        (0.0, longest),
        [math.log(m_2), width, 0.0, 0.0],
        "DOP853",
        events=(edge, sonic),
        rtol=rtol,
        atol=[rtol, rtol * width, rtol * load, rtol * load * width],
    )
    if not len(done.y_events[0]):
        return None, None
    log, _, force, moment = done.y_events[0][0]
    return math.log(m_1) - log, Flow(mass_flow, force, moment / (force * width), mach, math.sqrt(m_2))


def flow(dam: Dam, rtol: float = 1e-12) -> Flow | None:
    """The flow; None if there is none."""

    def left(log):
        # Too large a flow would have been sonic inside.
        found = marched(dam, math.exp(log), rtol)[0]
        return 1.0 if found is None else found

    top = math.log(_largest_mach(dam))
    if left(top) < 0:
        return None
    log = brentq(left, math.log(1e-7), top, xtol=1e-12)
    remainder, found = marched(dam, math.exp(log), rtol)
    return found if remainder is not None and abs(remainder) < 1e-6 else None


def _largest_mach(dam: Dam) -> float:
    """Mach number at the entrance with the largest flow through it."""
    if dam.loss == 1.0:
        return 1.0
    g, d = dam.g, (dam.g - 1) / 2

    def flow(mach):
        m = mach * mach
        return -mach * math.sqrt(1 + d * m) / (1 + d * m / dam.loss**2) ** (g / (g - 1))

    return minimize_scalar(flow, bounds=(0, 1), method="bounded", options={"xatol": 1e-12}).x
