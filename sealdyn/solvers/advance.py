"""A run that does not get on ends: the pace of its motion against that of its steps and changes."""

from .contract import SolverFailure

# So many accepted steps, or changes of the equations, must bring the run on by this share of what it has before it.
STEPS, CHANGES = 20_000, 1000
SHARE_STEPS, SHARE_CHANGES = 2e-7, 1e-6
# What it has before it: the run, or so many of its shortest periods.
PERIODS = 1e4
_STEPS = (
    "no advance: {count} steps brought {span:.1e} s of motion, up to t = {time:.6g} s; try another run.solver (bdf or "
    "ida where the scene is stiff), a looser run.accuracy, or look whether the film is closing there"
)
_CHANGES = (
    "no advance: {count} changes between sticking and slipping within {span:.1e} s of motion, up to t = {time:.6g} s; "
    'dry friction cannot say what happens there: law = "regularised" and a width of the secondary seal can'
)


class Advance:
    """Watches how far a run of `length` (s) and shortest period `period` (s) gets.

    At the pace at which it gives up, the run would take 1e11 steps or 1e9 changes (stick-slip chatter): weeks.  Counts
    decide, not the clock: another machine finds the same."""

    def __init__(self, length: float, period: float):
        self.ahead, self.changes = min(length, PERIODS * period), 0
        # Time and count where a window began.
        self.since_step = self.since_change = None

    def see(self, time: float, steps: int) -> None:
        """So many `steps` were made, up to `time` (s).  Raises SolverFailure for a run that does not get on."""
        self.since_step = self._look(self.since_step, time, steps, STEPS, SHARE_STEPS * self.ahead, _STEPS)

    def change(self, time: float) -> None:
        """The equations changed at `time` (s).  Raises SolverFailure for a run that does not get on."""
        self.changes += 1
        self.since_change = self._look(
            self.since_change, time, self.changes, CHANGES, SHARE_CHANGES * self.ahead, _CHANGES
        )

    def _look(self, since, time, count, window, least, sentence):
        if since is None:
            return time, count
        if count - since[1] < window:
            return since
        if time - since[0] < least:
            raise SolverFailure(sentence.format(count=count - since[1], span=time - since[0], time=time))
        return time, count
