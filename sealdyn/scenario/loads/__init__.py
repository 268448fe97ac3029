"""Loads from outside on a floating ring: force and moments as functions of time, which become samples of the run.

A file `loads/NAME.py` (extensions.py) has `load(time, options, scene)`: force (N) and moments (N m) about the x and y
axis at times (n,) (s), each (n,) or a number.  Samples are doubled until the spline of fifth degree through them, along
which the equations take them, is as near between them as the run's accuracy asks.
**Valid** functions that are smooth, and that change no faster than a few times in the shortest of 1024 parts of the run
and 32 of a turn, from a little before the start to a little after the end; steps are for the functions of time beside.
"""

import dataclasses
import math

import numpy as np

from ...dynamics.intervals import time_of_angle
from ...extensions import OutsideError, folders, outside_module
from ...scene.forces import LOAD_COLUMNS, Load, LoadSamples
from ...scene.rings import RING_NAMES
from ...scene.scene import Scene, SceneError

__path__ = [*__path__, *folders("loads")]
# Samples at first, in all and of a turn, and at most; distance of the spline in shares of the run's accuracy, and where
# rounding ends.
FIRST, PER_TURN, MOST = 1024, 32, 1 << 17
SHARE, ROUNDING = 1e-2, 1e-12
# Samples before the start and after the end, where a spline is less near.
BESIDE = 12
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


def with_samples(scene: Scene, run) -> Scene:
    """The scene with samples of the loads that its floating rings name.  Raises SceneError."""
    for name in RING_NAMES:
        ring = scene.rings[name]
        if ring.load is not None and ring.load.model is not None and ring.support is not None:
            load = dataclasses.replace(ring.load, samples=_samples(scene, f"{name}.load", ring.load, run))
            scene = dataclasses.replace(scene, **{name: dataclasses.replace(ring, load=load)})
    return scene


def _samples(scene: Scene, key: str, load: Load, run) -> LoadSamples:
    speed, turns = scene.shaft.speed, run.turns or 0.0
    end = time_of_angle(speed, 2.0 * math.pi * turns) if run.duration is None else run.duration
    # From scipy where there is something to sample.
    from scipy.interpolate import make_interp_spline

    count, near = min(max(FIRST, math.ceil(PER_TURN * turns)), MOST), max(SHARE * run.accuracy, ROUNDING)
    while count <= MOST:
        time = np.arange(-BESIDE, count + BESIDE + 1) * (end / count)
        columns = _columns(scene, key, load, time)
        # Between all samples, at no place twice the same: a tone may have whole periods between samples.
        between = (np.arange(count) + np.modf(GOLDEN * np.arange(1, count + 1))[0]) * (end / count)
        off = make_interp_spline(time, columns, k=5, axis=1)(between) - _columns(scene, key, load, between)
        missed = np.abs(off).max(axis=1) / np.maximum(np.abs(columns).max(axis=1), np.finfo(float).tiny)
        if missed.max() <= near:
            return LoadSamples(
                time=tuple(time.tolist()), **dict(zip(LOAD_COLUMNS, map(tuple, columns.tolist()), strict=True))
            )
        count *= 2
    found = f'"{load.model}", which {MOST} samples follow to {missed.max():.2g} of its largest value'
    expected = f"a smooth function of time, followed to {near:.2g}; steps and kinks as functions of time of [{key}]"
    raise SceneError(f"{key}.model", found, expected)


def _columns(scene: Scene, key: str, load: Load, time: np.ndarray) -> np.ndarray:
    """Force and moments (3, n) at times (n,)."""
    options = getattr(load, load.model, None)
    try:
        parts = outside_module("loads", load.model, "load").load(time, options, scene)
        columns = np.array([np.broadcast_to(np.asarray(part, dtype=float), time.shape) for part in parts])
    except OutsideError as error:
        raise SceneError(f"{key}.model", error.found, error.expected) from None
    except Exception as error:
        found = f'"{load.model}", which fails ({type(error).__name__}: {error})'
        raise SceneError(f"{key}.model", found, "a function of time") from None
    if columns.shape != (3, len(time)) or not np.isfinite(columns).all():
        found = (
            f'"{load.model}", which answers {len(columns)} columns'
            if len(columns) != 3
            else f'"{load.model}", which is not finite'
        )
        raise SceneError(f"{key}.model", found, "force and two moments, finite at each time of the run")
    return columns
