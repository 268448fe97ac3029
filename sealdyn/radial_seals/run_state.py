"""What a run of a radial seal changes: its start, its segments, and what is observed on the way."""

import numpy as np

from .contact import Contacts
from .equations import RIDING
from .segments import RadialModel, RadialSegment
from .watch import Watch


class RadialRun:
    """A model over `duration` (s), as dynamics/run_state.py: `intervals`, start `y0` (size,), `last`, and the observers
    `stick_slip` (which finds the changes of contact), `extrema` and `contacts` (which watch), `seen` (None, or another
    whose state is kept).

    It begins with all followers on the shaft, wherever that pulls nowhere: the following orbit."""

    def __init__(self, model: RadialModel, duration: float):
        self.model, self.duration, self.intervals = model, duration, model.intervals(duration)
        self.stick_slip, self.extrema, self.contacts = Contacts(model), Watch(model), Late(model, 0.5 * duration)
        n = model.followers.count
        riding = {"modes": np.full(n, RIDING), "signs": np.zeros(n)}
        here = RadialSegment(model, self.intervals[0], 0, len(self.intervals) == 1, riding).surface(0.0)
        self.y0 = model.vector(here[:, 0], here[:, 1])
        self.last, self.seen = (0, 0.0, self.y0), None

    def segment(self, index: int = 0, modes=None) -> RadialSegment:
        """The equations over the interval `index`, in the modes of now or in `modes`."""
        index %= len(self.intervals)
        modes = modes or self.stick_slip.held()
        return RadialSegment(self.model, self.intervals[index], index, index + 1 == len(self.intervals), modes)

    def anew(self) -> "RadialRun":
        """The same run before its start."""
        return RadialRun(self.model, self.duration)

    @property
    def memory(self) -> float:
        """For how many shortest periods an error is remembered: who rides forgets, who is free is damped, or not."""
        found = self.model.followers
        decay = 0.5 * found.damping / found.mass
        longest = self.duration if decay * self.duration < 1.0 else 1.0 / decay
        return longest / self.model.shortest_period

    def end_time(self, index: int, tau: float) -> float:
        """Time (s) since the start of the run at time tau of a segment."""
        return self.intervals[index].time + tau

    def modes(self) -> dict:
        """What a continued run needs beside the unknowns."""
        return {
            "sticking": self.stick_slip.state(),
            "late": self.contacts.state(),
            "seen": self.seen and self.seen.state(),
        }

    def restore_modes(self, modes: dict):
        """Go on from `modes`."""
        self.stick_slip.restore(modes["sticking"])
        self.contacts.restore(modes["late"])


class Late(Watch):
    """The second half of a run: what is settled."""

    def tell(self, log, end=None):
        """Events are told as they happen."""
