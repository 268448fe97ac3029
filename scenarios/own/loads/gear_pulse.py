"""Force by a Python function: what meshing teeth push along the shaft, a smooth pulse for each tooth.

    force = f exp(k (cos(z phi) - 1)),      moment about the y axis = - force times arm

with phi the angle of the shaft and k how narrow the pulses are.
**Source** the form of von Mises, a pulse with all its derivatives.  **Valid** a shaft of one speed.

    SEALDYN_PATH=scenarios/own sealdyn run scenarios/fms_reference.toml --set stator.load.model=gear_pulse \
        --set "stator.load.gear_pulse.force=20 N"
"""

from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt
from pydantic import Field

from sealdyn.units import Force, Length

Floats = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Options:
    """The `[stator.load.gear_pulse]` table."""

    force: Force
    """Largest force of a tooth, along the shaft axis."""
    arm: Length = 0.0
    """From the axis to the tooth, on the x axis."""
    teeth: Annotated[int, Field(gt=0)] = 3
    """Of the gear."""
    narrowness: Annotated[float, Field(ge=0.0, le=100.0)] = 4.0
    """None: one force; of the order of 10: pulses."""


def load(time: Floats, options: Options, scene: Any) -> tuple[Floats, float, Floats]:
    """Force (N) and moments (N m) at times (n,) (s)."""
    turned = np.cos(options.teeth * scene.shaft.speed * time)
    force: Floats = options.force * np.exp(options.narrowness * (turned - 1.0))
    return force, 0.0, -options.arm * force
