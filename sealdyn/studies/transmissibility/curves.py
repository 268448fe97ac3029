"""Amplitudes and phases of relative tilts."""

import numpy as np

QUANTITIES = ("static", "dynamic", "total")
PHASES = ("static_phase", "dynamic_phase")


def phases(speeds, static, dynamic) -> tuple:
    """Phases (deg) of the relative tilts (stator minus rotor, in the frame of the forcing) behind their forcings."""
    sense = np.where(np.asarray(speeds) < 0, -1.0, 1.0)
    # The rotor carries the dynamic forcing: counted from it, the relative tilt has the other sign.  (+ 0 for no -0.)
    return tuple(0.0 - sense * np.degrees(np.angle(tilt)) + 0.0 for tilt in (static, -np.asarray(dynamic)))


def curves(speeds, tilts) -> dict:
    """Amplitudes and phases over speed, phases without jumps."""
    static, dynamic = np.abs(tilts)
    lags = [_without_jumps(lag).tolist() for lag in phases(speeds, *tilts)]
    amplitudes = [a.tolist() for a in (static, dynamic, static + dynamic)]
    return dict(zip((*QUANTITIES, *PHASES), (*amplitudes, *lags), strict=True))


def _without_jumps(lag) -> np.ndarray:
    """Phases (deg) that run on; of those that begin behind and ahead at once, half a turn away, as near to zero as they
    can be told."""
    lag = np.unwrap(lag, period=360.0)
    return lag - 360.0 * np.round(lag.mean() / 360.0) if abs(lag[0]) > 90.0 else lag


def phases_apart(one, other) -> float:
    """Largest distance (deg) of two rows of phases: 359 deg apart is 1 deg apart."""
    away = np.abs(np.asarray(one) - other) % 360.0
    return float(np.max(np.minimum(away, 360.0 - away)))
