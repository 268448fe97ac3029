"""Degenerate geometry: nearly flat faces in logarithmic formulas, zero tilt in Euler coordinates."""

import math
from dataclasses import replace
from decimal import Decimal, localcontext

import numpy as np
from scipy.integrate import solve_ivp

from ....analysis.sources.green_1989 import reference_scene
from ....closed_form import film_coefficients
from ....faces.geometry import DZ_RATE, FORCE, GAP_STATE_SIZE, VISCOSITY
from ....films.radial import film as radial
from ....scene.contact import waves_of
from ._common import integrated, row, run_from

ITEM = 5
# Coning, of the clearance, at which logarithms of film thicknesses cancel.
FLAT = 0.01
# Coning over the face, of the clearance: a nanometre.
CONE = 1e-4
END, STEPS, MISS, OWN = 2e-3, 200, 1e-6, 10e-6


# --- nearly flat faces -----------------------------------------------------------------------------------


def squeeze_by_logarithms(inner_radius, width, clearance, ratio, log):
    """Axial damping over 24 pi mu r_m of a coned strip, h = clearance (1 + ratio x), x from 0 to 1 over the width:
    `[r_i (m2 - m1^2/m0) + (m3 - m1 m2/m0) width/2]/r_m`, m_n = int x^n/h^3 dx by partial fractions, as any table of
    integrals has them.  All numbers, and `log`, of one type."""
    b, q = ratio, 1 + ratio
    once, twice = 1 - 1 / q, (1 - 1 / q**2) / 2
    m0, m1 = twice / b, (once - twice) / b**2
    m2 = (log(q) - 2 * once + twice) / b**3
    m3 = (q - 1 - 3 * log(q) + 3 * once - twice) / b**4
    total = inner_radius * (m2 - m1**2 / m0) + width / 2 * (m3 - m1 * m2 / m0)
    return width**3 / clearance**3 * total / (inner_radius + width / 2)


def flat_faces() -> dict:
    """Axial damping of a strip coned by a nanometre: logarithms in floating point, in sixty digits, radial film."""
    film = replace(reference_scene("FMR").film, model="radial", geometry="planar")
    width, h = film.outer_radius - film.inner_radius, film.clearance
    film = replace(film, coning=CONE * h / width)
    naive = squeeze_by_logarithms(film.inner_radius, width, h, film.coning * width / h, math.log)
    with localcontext() as context:
        context.prec = 60
        r_i, r_o, c, cone = map(Decimal, (film.inner_radius, film.outer_radius, h, film.coning))
        exact = float(squeeze_by_logarithms(r_i, r_o - r_i, c, cone * (r_o - r_i) / c, Decimal.ln))
    s = np.zeros(GAP_STATE_SIZE)
    s[VISCOSITY], s[DZ_RATE] = 1.0, 1.0
    radial.wrench(radial.parameters(film, h, 1e-13), s)
    found = -s[FORCE] / (12 * math.pi * (film.inner_radius + film.outer_radius))
    return row(
        ITEM, "Flat faces", ("logarithmic formula cancels (1 nm of coning)", abs(naive / exact - 1)),
        ("rational map of the radial film", abs(found / exact - 1)), "relative error of the film damping",
        "evaluates every film by a map without a singular limit: flat, converging and diverging faces alike",
    )  # fmt: skip


# --- zero tilt -------------------------------------------------------------------------------------------


def equations():
    """Cartesian and Eulerian (nutation, precession) right-hand sides of Green's slender ring, driven by its own
    misalignment, which turns with the shaft."""
    scene = reference_scene("FMR", 3.0, turning=OWN)
    film, ring, w = scene.film, scene.rotor, scene.shaft.speed
    k_s, d_s = ring.support.tilt()
    found = film_coefficients(film.inner_radius, film.outer_radius, film.clearance, film.coning, film.viscosity,
                              film.outer_pressure - film.inner_pressure)  # fmt: skip
    inertia, polar = ring.transverse_inertia, ring.polar_inertia
    d, k, cross = d_s + found.tilt_damping, k_s + found.tilt_stiffness, w * (d_s + found.tilt_damping / 2)

    def cartesian(t, y):
        g, v = complex(y[0], y[1]), complex(y[2], y[3])
        push = k_s * OWN * np.exp(1j * w * t)
        a = (push - k * g - d * v + 1j * cross * g + 1j * polar * w * v) / inertia
        return [v.real, v.imag, a.real, a.imag]

    def eulerian(t, y):
        nutation, precession, rate, turning = y
        psi = precession - w * t
        inner = k_s * OWN * np.cos(psi) - k * nutation - d * rate - polar * w * turning * nutation
        across = (-d * turning + cross) * nutation + polar * w * rate - k_s * OWN * np.sin(psi)
        return [rate, turning, inner / inertia + turning**2 * nutation,
                (across / inertia - 2 * turning * rate) / nutation]  # fmt: skip

    return cartesian, eulerian, film.clearance / film.outer_radius, scene


def runge_kutta(slopes, y):
    """The classical method, equal steps."""
    t, h, y = 0.0, END / STEPS, np.array(y)
    for _ in range(STEPS):
        a = np.array(slopes(t, y))
        b = np.array(slopes(t + h / 2, y + h / 2 * a))
        c = np.array(slopes(t + h / 2, y + h / 2 * b))
        e = np.array(slopes(t + h, y + h * c))
        t, y = t + h, y + h / 6 * (a + 2 * b + 2 * c + e)
    return y


def zero_tilt() -> list[dict]:
    """A ring whose path passes zero tilt at 1 urad, in 200 equal Runge-Kutta steps; and a start at rest."""
    cartesian, eulerian, scale, scene = equations()
    back = solve_ivp(cartesian, (3e-4, 0), [0.0, MISS, 0.03, 0.08], "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    exact = solve_ivp(cartesian, (0, END), back, "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    exact = complex(exact[0], exact[1])
    g, v = complex(*back[:2]), complex(*back[2:])
    with np.errstate(all="ignore"):
        turn = v / g
        told = runge_kutta(eulerian, [abs(g), np.angle(g), turn.real * abs(g), turn.imag])
        nutation = told[0] * np.exp(1j * told[1])
        stopped = solve_ivp(eulerian, (0, END), [0.0] * 4, "DOP853", rtol=1e-9, atol=1e-15)
    sound = abs(complex(*runge_kutta(cartesian, back)[:2]) - exact) / scale
    run = run_from(scene, END, 1e-9)
    rest, _ = integrated(run, "adams", 1e-9)
    at_end = solve_ivp(cartesian, (0, END), [0.0] * 4, "DOP853", rtol=1e-13, atol=1e-20).y[:, -1]
    place = run.model.unknowns.names.index("rotor_tilt_x")
    apart = abs(complex(*rest.y[place : place + 2]) - complex(*at_end[:2])) / scale
    default = "integrates the two tilts about fixed axes, which do not know of the nutation"
    error = abs(nutation - exact) / scale
    return [
        row(ITEM, "Zero tilt passed", ("Euler angles, 1 urad off zero tilt", error if np.isfinite(error) else None),
            ("tilts about fixed axes", sound), "tilt, of clearance / radius", default),
        row(ITEM, "Start at zero tilt",
            (f"Euler angles: 0/0 after {stopped.nfev} evaluations", None if stopped.status < 0 else 0.0),
            ("tilts about fixed axes", apart), "tilt, of clearance / radius",
            default),
    ]  # fmt: skip


def meets(scene, run) -> str:
    """Faces all but parallel, and not wavy."""
    if waves_of(scene):
        return ""
    gaps = [h for _, h in run.model.aligned_gaps()]
    apart = (max(gaps) - min(gaps)) / run.model.clearance
    if apart == 0.0:
        return "its faces are parallel"
    return (
        f"its film is {100 * apart:.2g} % of the clearance thicker at one edge than at the other"
        if apart < FLAT
        else ""
    )


def show() -> list[dict]:
    """Both."""
    return [flat_faces(), *zero_tilt()]
