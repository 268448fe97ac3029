"""Natural frequencies of the rings on their springs and dampers, without the film, and what may shake them."""

import math

from ...scene.rings import RING_NAMES
from ._finding import Finding, Verdict, missing

# A frequency nearer to a natural one than this share of it is at resonance; the guide gives no distance.
MARGIN = 0.1
# Damping ratio from which a ring that is shaken has no resonance.
NO_PEAK = math.sqrt(0.5)


def ring_modes(scene) -> list[dict]:
    """Modes of the floating rings at rest: `ring`, `motion` ("axial" | "tilt"), `frequency` (Hz) and `damping_ratio`;
    none of a ring without inertia or springs."""
    found = []
    for name, ring in zip(RING_NAMES, (scene.stator, scene.rotor), strict=True):
        if ring.support is None:
            continue
        support = ring.support
        axial = ring.mass, support.axial_stiffness, support.axial_damping
        tilt = ring.transverse_inertia, *support.tilt()
        for motion, (inertia, stiffness, damping) in {"axial": axial, "tilt": tilt}.items():
            if inertia > 0.0 and stiffness > 0.0:
                found.append({"ring": name, "motion": motion,
                              "frequency": math.sqrt(stiffness / inertia) / (2 * math.pi),
                              "damping_ratio": damping / (2 * math.sqrt(stiffness * inertia))})  # fmt: skip
    return found


def resonances(scene, bands: list[tuple[float, float]], what: str) -> Finding:
    """Fail if a mode that has a resonance lies in or near one of the `bands` (Hz, Hz) of `what` shakes the seal; an
    undamped mode elsewhere is a note, since flexibly mounted parts shall be damped."""
    modes = ring_modes(scene)
    if not modes:
        keys = ("mass", "transverse_inertia", "support")
        floating = [n for n, ring in zip(RING_NAMES, (scene.stator, scene.rotor), strict=True) if ring.support]
        return missing(*(f"{name}.{key}" for name in floating for key in keys))
    apart, nearest, band = min(
        ((_distance(mode["frequency"], band), mode, band) for mode in modes for band in bands),
        key=lambda one: (one[1]["damping_ratio"] >= NO_PEAK, one[0]),
    )
    shaken = f"{band[0]:.4g} Hz" if band[0] == band[1] else f"{band[0]:.4g} to {band[1]:.4g} Hz"
    said = (
        f"{what} shakes with {shaken}; on its springs alone the {nearest['ring']}'s {nearest['motion']} motion has "
        f"{nearest['frequency']:.4g} Hz, damping ratio {nearest['damping_ratio']:.2g}"
    )
    verdict = Verdict.PASS
    if nearest["damping_ratio"] >= NO_PEAK:
        said += ": damped so well that there is no resonance"
    elif apart <= MARGIN:
        verdict, said = Verdict.FAIL, f"{said}: resonance, unless the film prevents it"
    elif any(mode["damping_ratio"] == 0.0 for mode in modes):
        verdict, said = Verdict.NOTE, f"{said}: apart, but flexibly mounted parts shall be damped"
    return Finding(verdict, said, nearest["frequency"], "Hz", numbers={"modes": modes, "shaken": [*map(list, bands)]})


def _distance(frequency: float, band: tuple[float, float]) -> float:
    """How far a frequency lies from a band (both Hz), as a share of it; 0 inside."""
    return max(band[0] - frequency, frequency - band[1], 0.0) / frequency
