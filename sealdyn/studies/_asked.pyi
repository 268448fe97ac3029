# Written by `python tests/benchmark/typed_settings.py` from the settings of the studies.
import os
from collections.abc import Callable, Iterable
from typing import Any, Literal, TypedDict, Unpack, overload

from ..scenario.reader import Scenario
from ._runner import Answer

Source = Scenario | str | os.PathLike[str]

class How(TypedDict, total=False):
    out: str | os.PathLike[str] | None
    workers: int | None
    scheduler: Any
    results: str | os.PathLike[str] | None
    progress: Callable[[float, float, str], None] | None
    without: Iterable[str]

class Campbell(How, total=False):
    speed_from: Any
    speed_to: Any
    points: int | None
    unit: Any
    lines: Any

class Coefficients(How, total=False):
    tilt: Any
    tilt_direction: Any
    speed_to: Any
    clearance_from: Any
    clearance_to: Any
    points: int
    frequency: Any
    speed: Any
    coning: Any
    clearance: Any

class ContactOnset(How, total=False):
    key: Any
    margin: Any
    over: Any
    values: Any
    floor: bool
    tolerance: Any
    most: Any
    share: Any
    limit: Any

class CriticalSpeed(How, total=False):
    method: Any
    accuracy: Any
    turns: int
    speeds: int
    beyond: bool

class ElasticRing(How, total=False):
    net_from: Any
    net_to: Any
    points: int
    disturbance: Any
    duration: Any

class Equilibrium(How, total=False):
    clearance_from: Any
    clearance_to: Any
    points: int

class Failures(How, total=False):
    items: Any

class Followability(How, total=False):
    speed: Any
    vary: Any
    runs: int

class LoadSupport(How, total=False):
    vary: Any

class NeutralStability(How, total=False):
    turns: int
    accuracies: Any
    long: int

class Pressure(How, total=False):
    at: Any
    beside: Any

class Rub(How, total=False):
    key: Any
    values: Any
    down: bool
    ramp: int
    drop: int
    keep: int
    exponent_turns: int
    judge: Any
    judge_turns: int
    accuracy: Any
    whirl: bool
    whirl_speeds: Any

class Runup(How, total=False):
    key: Any
    begin: Any
    end: Any
    rates: Any
    hold: Any
    disturbance: Any
    touch: bool
    order: Any
    window: int | None
    samples_per_turn: int | None

class SealingNumber(How, total=False):
    force_ratios: Any
    starts: Any
    inertia: Any
    turns: Any
    last: Any
    accuracy: Any

class ShaftImpedance(How, total=False):
    frequency: Any

class Stability(How, total=False):
    x: Any
    y: Any
    confirm: int

class SteadyState(How, total=False):
    turns: int
    samples: int
    approach: Any
    longest: int

class Stribeck(How, total=False):
    speed_from: Any
    speed_to: Any
    points: int

class Sweep(How, total=False):
    vary: Any
    outputs: Any

class Tolerance(How, total=False):
    scatter: Any
    correlations: Any
    samples: int
    seed: int
    outputs: Any
    indices: bool
    margin: Any

class Transmissibility(How, total=False):
    speed_from: Any
    speed_to: Any
    points: int | None
    unit: Any
    time_points: int
    accuracy: Any
    longest: Any

class Vibration(How, total=False):
    direction: Any
    lowest: Any
    highest: Any
    points: int
    accelerations: Any
    runs: int

class WarmUp(How, total=False):
    start: Any
    hold: Any
    stop: Any
    rest: Any
    begin: Any

class WaveDesign(How, total=False):
    orders: Any
    stiffness_from: Any
    stiffness_to: Any
    rings: int
    leakage_limit: Any
    net_from: Any
    net_to: Any
    points: int

class Wear(How, total=False):
    duration: Any
    nodes: int
    accuracy: Any
    step: Any
    turns: int
    patience: int
    even: Any
    run_in: Any
    harmonics: int
    travelling: bool
    life: Any

class WorkPrecision(How, total=False):
    tolerances: int
    loosest: Any
    tightest: Any
    repeats: int
    longest: Any
    slowest: Any
    samples: int
    methods: Any
    judging: Any
    where: Any
    models: bool

@overload
def study(name: Literal["campbell"], source: Source, **settings: Unpack[Campbell]) -> Answer: ...
@overload
def study(name: Literal["coefficients"], source: Source, **settings: Unpack[Coefficients]) -> Answer: ...
@overload
def study(
    name: Literal["contact-onset", "contact_onset"], source: Source, **settings: Unpack[ContactOnset]
) -> Answer: ...
@overload
def study(
    name: Literal["critical-speed", "critical_speed"], source: Source, **settings: Unpack[CriticalSpeed]
) -> Answer: ...
@overload
def study(name: Literal["elastic-ring", "elastic_ring"], source: Source, **settings: Unpack[ElasticRing]) -> Answer: ...
@overload
def study(name: Literal["equilibrium"], source: Source, **settings: Unpack[Equilibrium]) -> Answer: ...
@overload
def study(name: Literal["failures"], source: Source, **settings: Unpack[Failures]) -> Answer: ...
@overload
def study(name: Literal["followability"], source: Source, **settings: Unpack[Followability]) -> Answer: ...
@overload
def study(name: Literal["load-support", "load_support"], source: Source, **settings: Unpack[LoadSupport]) -> Answer: ...
@overload
def study(
    name: Literal["neutral-stability", "neutral_stability"], source: Source, **settings: Unpack[NeutralStability]
) -> Answer: ...
@overload
def study(name: Literal["pressure"], source: Source, **settings: Unpack[Pressure]) -> Answer: ...
@overload
def study(name: Literal["rub"], source: Source, **settings: Unpack[Rub]) -> Answer: ...
@overload
def study(name: Literal["runup"], source: Source, **settings: Unpack[Runup]) -> Answer: ...
@overload
def study(
    name: Literal["sealing-number", "sealing_number"], source: Source, **settings: Unpack[SealingNumber]
) -> Answer: ...
@overload
def study(
    name: Literal["shaft-impedance", "shaft_impedance"], source: Source, **settings: Unpack[ShaftImpedance]
) -> Answer: ...
@overload
def study(name: Literal["stability"], source: Source, **settings: Unpack[Stability]) -> Answer: ...
@overload
def study(name: Literal["steady-state", "steady_state"], source: Source, **settings: Unpack[SteadyState]) -> Answer: ...
@overload
def study(name: Literal["stribeck"], source: Source, **settings: Unpack[Stribeck]) -> Answer: ...
@overload
def study(name: Literal["sweep"], source: Source, **settings: Unpack[Sweep]) -> Answer: ...
@overload
def study(name: Literal["tolerance"], source: Source, **settings: Unpack[Tolerance]) -> Answer: ...
@overload
def study(name: Literal["transmissibility"], source: Source, **settings: Unpack[Transmissibility]) -> Answer: ...
@overload
def study(name: Literal["vibration"], source: Source, **settings: Unpack[Vibration]) -> Answer: ...
@overload
def study(name: Literal["warm-up", "warm_up"], source: Source, **settings: Unpack[WarmUp]) -> Answer: ...
@overload
def study(name: Literal["wave-design", "wave_design"], source: Source, **settings: Unpack[WaveDesign]) -> Answer: ...
@overload
def study(name: Literal["wear"], source: Source, **settings: Unpack[Wear]) -> Answer: ...
@overload
def study(
    name: Literal["work-precision", "work_precision"], source: Source, **settings: Unpack[WorkPrecision]
) -> Answer: ...
