"""The radial film (film.py) with its pressure floored at the cavitation pressure, between smooth or rough faces.

The circle is split where a line begins or stops being dry, Gauss panels in between.

A line that begins to be dry adds a term of power 1, 3/2 or 3 of the angle (a whole line at once, a dip inside the
face, an edge at the floor): a trapezoid over it converges as N^-2.  Here the places are found by bisection; between
them the variable x on [-1, 1] of gamma = middle + half (3 x - x^3)/2 turns each of those powers into a whole one,
and gamma, `tan(beta/2) = k tan(gamma/2)`, spreads the angles by the thinnest place evenly: for a flat face it is
Sommerfeld's (1904) substitution, in which 1/h^3 is a polynomial of cosines whatever the film's least thickness.
"""

import math
from dataclasses import replace
from functools import partial

import numpy as np

from ...faces.geometry import (
    CAVITATED,
    CONING_RATE,
    DZ_RATE,
    FLOOR,
    FORCE,
    INNER_PRESSURE,
    INNER_RADIUS,
    MOMENT_X,
    MOMENT_Y,
    OUTER_PRESSURE,
    OUTER_RADIUS,
    PLANAR,
    TILT_AT_MEAN,
    TORQUE,
    VISCOSITY,
    edges_of,
    regularised_thickness,
    tilt_frame,
)
from ...numerics.kernel import inner_kernel, value_kernel
from .._radial_quadrature import (
    CAVITATION,
    ERROR,
    centrifugal,
    opening_law,
    parameters,
    points_for,
    rule_at,
)
from .cavitated_line import HAS_DRY, HAS_WET, cavitated_line, line_state
from .film import FILM as PLAIN
from .film import rough_circle

# Angles scanned, and how far apart they may be in beta where that is farther; how closely a kink is sought (rad of
# gamma; it enters by the power 2 at least) and how long.
SCANNED, APART, CLOSE, MOST_TRIALS = 20, 0.6, 1e-8, 60
# Where the scan begins (rad of gamma): off the thinnest and thickest places, where a bare wedge has its kinks.
START = -3.0
# Panels: the most there may be, and the longest to begin with (rad of gamma).
MOST_PANELS, LONGEST = 96, 2.5
# The Gauss-Kronrod pair of 10 and 21 points: nodes, weights of the 21, weights of the 10 on every second node.
NODES = np.array(
    [
        0.99565716302580808, 0.97390652851717172, 0.93015749135570823, 0.86506336668898451, 0.78081772658641690,
        0.67940956829902441, 0.56275713466860468, 0.43339539412924719, 0.29439286270146020, 0.14887433898163121, 0.0,
    ]
)  # fmt: skip
KRONROD = np.array(
    [
        0.011694638867371874, 0.032558162307964727, 0.054755896574351996, 0.075039674810919953, 0.093125454583697606,
        0.10938715880229764, 0.12349197626206585, 0.13470921731147333, 0.14277593857706008, 0.14773910490133849,
        0.14944555400291690,
    ]
)  # fmt: skip
GAUSS = np.array(
    [0.066671344308688138, 0.14945134915058059, 0.21908636251598204, 0.26926671930999636, 0.29552422471475287]
)
# A panel: ends in gamma, ends in x, whether x is clustered; difference of the two rules in load, moments and wet share;
# integrals.
BEGIN, END, X_BEGIN, X_END, CLUSTERED, DEFECT = range(6)
SUMS, PANEL_SIZE = DEFECT + 4, DEFECT + 9
# Error of the wet share (rad of beta) that weighs as much as the error asked of load and moments.
WET_ERROR = 1e-5 * 2.0 * math.pi
LOAD, ALONG, ACROSS, SLOPE, WET = range(5)


@inner_kernel()
def _edges(f, s):
    """Constants of the circle in the tilt's own frame: see `_line_at`."""
    floor, (tilt, c_a, s_a, along, across) = f[FLOOR], tilt_frame(s)
    h_i, h_o, swing_i, swing_o = edges_of(f, s)
    thin_i, thin_o = h_i - swing_i, h_o - swing_o
    thick_i, thick_o = (
        regularised_thickness(thin_i + 2.0 * swing_i, floor),
        regularised_thickness(thin_o + 2.0 * swing_o, floor),
    )
    clipped_i, clipped_o = regularised_thickness(thin_i, floor), regularised_thickness(thin_o, floor)
    # Sommerfeld's k for each edge, and the one that keeps the zeros of both films equally far.
    spread = math.sqrt(math.sqrt(clipped_i / thick_i * clipped_o / thick_o))
    rule = max(points_for(f, clipped_i, clipped_o), points_for(f, thick_i, thick_o))
    return tilt, c_a, s_a, (thin_i, thin_o, swing_i, swing_o, along, across, spread), rule


@inner_kernel()
def _line_at(gamma, turn, floor):
    """cos and sin of beta, d beta/d gamma, films at both edges and the tilt rate seen at one angle."""
    thin_i, thin_o, swing_i, swing_o, along, across, spread = turn
    c, s = math.cos(0.5 * gamma), spread * math.sin(0.5 * gamma)
    per = 1.0 / (c * c + s * s)
    cos_b, sin_b, fall = (c * c - s * s) * per, 2.0 * s * c * per, 2.0 * s * s * per
    h_i, h_o = (
        regularised_thickness(thin_i + swing_i * fall, floor),
        regularised_thickness(thin_o + swing_o * fall, floor),
    )
    return cos_b, sin_b, spread * per, h_i, h_o, -(along * cos_b + across * sin_b)


@inner_kernel()
def _with_cone(f, s, tilt_rate):
    """Rates of the gap (m/s) and of the tilt seen at an angle (rad/s), with the coning's, which is a tilting of every
    radius alike."""
    return s[DZ_RATE] - s[CONING_RATE] * f[INNER_RADIUS], tilt_rate + s[CONING_RATE]


@inner_kernel()
def _state_at(gamma, turn, f, s, x_k, w_k):
    _, _, _, h_i, h_o, tilt_rate = _line_at(gamma, turn, f[FLOOR])
    z_rate, tilt_rate = _with_cone(f, s, tilt_rate)
    return line_state(
        x_k, w_k, f[INNER_RADIUS], f[OUTER_RADIUS], h_i, h_o, z_rate, tilt_rate, f[TILT_AT_MEAN] != 0.0,
        f[PLANAR] != 0.0, s[VISCOSITY], s[INNER_PRESSURE], s[OUTER_PRESSURE], f[CAVITATION], centrifugal(f, s),
    )  # fmt: skip


@inner_kernel()
def _angles(spread):
    """The gamma (rad) to scan, in order around the circle, first and last the same place: evenly spread, and in between
    evenly in beta where `spread` (Sommerfeld's k) puts most of the circle between two of them."""
    gammas, count = np.empty(SCANNED + 1 + math.ceil(2.0 * math.pi / APART)), 0
    for j in range(SCANNED):
        low, high = START + 2.0 * math.pi * j / SCANNED, START + 2.0 * math.pi * (j + 1) / SCANNED
        beta = 2.0 * math.atan2(spread * math.sin(0.5 * low), math.cos(0.5 * low))
        gap = 2.0 * math.atan2(spread * math.sin(0.5 * high), math.cos(0.5 * high)) - beta
        gammas[count], count, parts = low, count + 1, math.ceil(gap / APART)
        for part in range(1, parts):
            half = 0.5 * (beta + gap * part / parts)
            gammas[count], count = 2.0 * math.atan2(math.sin(half), spread * math.cos(half)), count + 1
    gammas[count] = START + 2.0 * math.pi
    return gammas[: count + 1]


@inner_kernel()
def _scan(turn, f, s, x_k, w_k):
    """Angles in order around the circle and the state of their lines.  Where an indicator comes near to a change
    of sign between two of them, an angle is moved to where a parabola sees its extreme."""
    gammas = _angles(turn[-1])
    last = len(gammas) - 1
    states, marks = np.empty(last + 1, np.int64), np.empty((3, last + 1))
    for j in range(last):
        states[j], marks[0, j], marks[1, j], marks[2, j] = _state_at(gammas[j], turn, f, s, x_k, w_k)
    # The circle closes: the same state, not one that rounding made another.
    states[last], marks[:, last] = states[0], marks[:, 0]
    for mark in marks:
        for j in range(1, last):
            before, here, after = abs(mark[j - 1]), abs(mark[j]), abs(mark[j + 1])
            alike = states[j - 1] == states[j] and states[j] == states[j + 1]
            if not (alike and here < before and here <= after):
                continue
            low, middle, high = gammas[j - 1], gammas[j], gammas[j + 1]
            for _ in range(4):
                a, b = (before - here) / (low - middle), (after - here) / (high - middle)
                bend = (b - a) / (high - low)
                best = middle - 0.5 * (a - bend * (low - middle)) / bend if bend > 0.0 else middle
                if not low < best < high or abs(best - middle) < 1e-9:
                    break
                state, m0, m1, m2 = _state_at(best, turn, f, s, x_k, w_k)
                if state != states[j]:
                    gammas[j], states[j] = best, state
                    break
                value = abs(m0 if mark[j] == marks[0, j] else (m1 if mark[j] == marks[1, j] else m2))
                if value >= here:
                    break
                if best < middle:
                    high, after = middle, here
                else:
                    low, before = middle, here
                middle, here = best, value
    return gammas, states


@inner_kernel()
def _change(low, high, state, turn, f, s, x_k, w_k):
    """First angle after `low` (of that state) where the state is another, and which: regula falsi on the indicator
    that changes sign, kept off the ends so that both close in, and halving where that fails."""
    _, a0, a1, a2 = _state_at(low, turn, f, s, x_k, w_k)
    beyond, b0, b1, b2 = _state_at(high, turn, f, s, x_k, w_k)
    for step in range(MOST_TRIALS):
        width = high - low
        if width < CLOSE:
            break
        a, b = (a0, b0) if a0 * b0 < 0.0 else ((a1, b1) if a1 * b1 < 0.0 else (a2, b2))
        share = a / (a - b) if a * b < 0.0 and step % 3 != 2 else 0.5
        middle = low + width * min(max(share, 0.003), 0.997)
        there, m0, m1, m2 = _state_at(middle, turn, f, s, x_k, w_k)
        if there == state:
            low, a0, a1, a2 = middle, m0, m1, m2
        else:
            high, beyond, b0, b1, b2 = middle, there, m0, m1, m2
    return high, beyond


@inner_kernel()
def _kinks(gammas, states, turn, f, s, x_k, w_k):
    """Angles where the state changes, and the state after each."""
    kinks, after, count = np.empty(4 * len(gammas)), np.empty(4 * len(gammas), np.int64), 0
    for j in range(len(gammas) - 1):
        low, state = gammas[j], states[j]
        # More than one thing may change inside: each in turn.
        for _ in range(4):
            if state == states[j + 1]:
                break
            low, state = _change(low, gammas[j + 1], state, turn, f, s, x_k, w_k)
            kinks[count], after[count] = low, state
            count += 1
    return kinks[:count], after[:count]


@inner_kernel()
def _integrate(panel, turn, f, s, x_k, w_k):
    """Fill a panel's integrals and by how much its two rules differ in load, moments and wet share."""
    middle, half = 0.5 * (panel[BEGIN] + panel[END]), 0.5 * (panel[END] - panel[BEGIN])
    x_m, x_h = 0.5 * (panel[X_BEGIN] + panel[X_END]), 0.5 * (panel[X_END] - panel[X_BEGIN])
    r_i, r_o, mean, g = f[INNER_RADIUS], f[OUTER_RADIUS], f[TILT_AT_MEAN] != 0.0, centrifugal(f, s)
    defect, fine = panel[DEFECT:SUMS], panel[SUMS:]
    panel[DEFECT:] = 0.0
    for k in range(21):
        node = k if k <= 10 else 20 - k
        x = x_m + x_h * (NODES[node] if k < 10 else -NODES[node])
        if panel[CLUSTERED] != 0.0:
            gamma, stretch = middle + half * 0.5 * x * (3.0 - x * x), 1.5 * half * (1.0 - x * x)
        else:
            gamma, stretch = middle + half * x, half
        cos_b, sin_b, per, h_i, h_o, tilt_rate = _line_at(gamma, turn, f[FLOOR])
        z_rate, tilt_rate = _with_cone(f, s, tilt_rate)
        load, moment, wet = cavitated_line(
            x_k, w_k, r_i, r_o, h_i, h_o, z_rate, tilt_rate, mean, f[PLANAR] != 0.0, s[VISCOSITY],
            s[INNER_PRESSURE], s[OUTER_PRESSURE], f[CAVITATION], g,
        )  # fmt: skip
        weight = stretch * per * x_h
        full, part = weight * KRONROD[node], weight * GAUSS[node // 2] if node % 2 == 1 else 0.0
        fine[LOAD] += full * load
        fine[ALONG] -= full * cos_b * moment
        fine[ACROSS] -= full * sin_b * moment
        fine[SLOPE] -= full * sin_b * (0.5 * (r_i + r_o) * load if mean else moment)
        fine[WET] += full * wet
        defect[LOAD] += (full - part) * load
        defect[ALONG] -= (full - part) * cos_b * moment
        defect[ACROSS] -= (full - part) * sin_b * moment
        defect[3] += (full - part) * wet


@inner_kernel()
def _panels(kinks, after, first_state, panels):
    """Panels between the kinks (wholly dry ones left out): how many."""
    count, pieces = 0, max(len(kinks), 1)
    for k in range(pieces):
        begin = kinks[k] if len(kinks) else START
        end = begin + 2.0 * math.pi
        if len(kinks):
            end = kinks[k + 1] if k + 1 < len(kinks) else kinks[0] + 2.0 * math.pi
        state = after[k] if len(kinks) else first_state
        if not state & HAS_WET or end <= begin:
            continue
        clustered = 1.0 if state & HAS_DRY else 0.0
        cuts = math.ceil((end - begin) / LONGEST)
        for c in range(cuts):
            if count >= MOST_PANELS:
                break
            panel = panels[count]
            panel[BEGIN], panel[END], panel[CLUSTERED] = begin, end, clustered
            panel[X_BEGIN], panel[X_END] = 2.0 * c / cuts - 1.0, 2.0 * (c + 1) / cuts - 1.0
            count += 1
    return count


@inner_kernel()
def _refine(panels, count, turn, f, s, x_k, w_k):
    """Halve the worst panel until the sum of errors is what was asked for; returns how many panels there are."""
    r_o = f[OUTER_RADIUS]
    while True:
        load, along, across = 0.0, 0.0, 0.0
        for panel in panels[:count]:
            load += panel[SUMS + LOAD]
            along += panel[SUMS + ALONG]
            across += panel[SUMS + ACROSS]
        # A moment that nearly vanishes need not be better than a small share of the load's own.
        moment = max(math.hypot(along, across), 1e-3 * r_o * load, 1e-300)
        load = max(load, 1e-300)
        total, worst, worst_error, wet_weight = 0.0, 0, 0.0, f[ERROR] / WET_ERROR
        for k in range(count):
            panel = panels[k]
            defect = max(abs(panel[DEFECT]) / load, math.hypot(panel[DEFECT + 1], panel[DEFECT + 2]) / moment)
            defect = max(defect, abs(panel[DEFECT + 3]) * wet_weight)
            # The difference is the 10-point rule's error; that of 21 points is some three fifths more digits away.
            error = min(defect, 100.0 * defect * math.sqrt(defect))
            total += error
            if error > worst_error:
                worst, worst_error = k, error
        if total <= 0.2 * f[ERROR] or count >= MOST_PANELS or worst_error < 1e-14:
            return count
        old, new = panels[worst], panels[count]
        new[:] = old
        old[X_END] = new[X_BEGIN] = 0.5 * (old[X_BEGIN] + old[X_END])
        count += 1
        _integrate(old, turn, f, s, x_k, w_k)
        _integrate(new, turn, f, s, x_k, w_k)


@inner_kernel()
def cavitated_circle(f, s):
    """Force (N) and moments (N m) with the pressure floored at the cavitation pressure after solving (half-Sommerfeld,
    or Guembel, condition), into the gap state; returns whether anything is dry, and the torque (N m) of the pressure on
    the film's slope.
    If nothing is dry nothing is done: the film is the full one.

    **Source** Ludwig & Allen, NASA TN D-8102 (1976), who drop the sub-ambient half of the film.
    **Valid** as an estimate only: it does not conserve mass.  The quadrature's error is estimated panel by panel and
    the worst panel halved until the error is what was asked for, up to MOST_PANELS.
    """
    tilt, c_a, s_a, turn, rule = _edges(f, s)
    x_k, w_k = rule_at(f, rule)
    gammas, states = _scan(turn, f, s, x_k, w_k)
    kinks, after = _kinks(gammas, states, turn, f, s, x_k, w_k)
    if len(kinks) == 0 and not states[0] & HAS_DRY:
        return False, 0.0
    panels = np.empty((MOST_PANELS, PANEL_SIZE))
    count = _panels(kinks, after, states[0], panels)
    for panel in panels[:count]:
        _integrate(panel, turn, f, s, x_k, w_k)
    count = _refine(panels, count, turn, f, s, x_k, w_k)

    load = along = across = slope = wet = 0.0
    for panel in panels[:count]:
        load += panel[SUMS + LOAD]
        along += panel[SUMS + ALONG]
        across += panel[SUMS + ACROSS]
        slope += panel[SUMS + SLOPE]
        wet += panel[SUMS + WET]
    s[FORCE] = load + math.pi * f[CAVITATION] * (f[OUTER_RADIUS] ** 2 - f[INNER_RADIUS] ** 2)
    s[MOMENT_X] = c_a * along - s_a * across
    s[MOMENT_Y] = s_a * along + c_a * across
    s[CAVITATED] = max(1.0 - wet / (2.0 * math.pi), 0.0)
    return True, 0.5 * tilt * slope


@value_kernel()
def wrench(f, s):
    """Force (N) and moments (N m) of the film on the stator, from the gap state, into the gap state."""
    if not cavitated_circle(f, s)[0]:
        rough_circle(f, s, False)


@value_kernel()
def flow(f, s):
    """As `wrench`; also flow in +r (m^3/s) at both radii and the friction torque on the rotor (N m).  The leakage of a
    floored film is that of the film not floored."""
    by_pressure = rough_circle(f, s, True)
    dry, by_floored_pressure = cavitated_circle(f, s)
    if dry:
        s[TORQUE] += by_floored_pressure - by_pressure


FILM = replace(
    PLAIN,
    parameters=parameters,
    opening_law=partial(opening_law, parameters, wrench),
    wrench=wrench,
    flow=flow,
    floored=None,
    rough=None,
)
