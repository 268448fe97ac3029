"""A wavy ring that bends, let go: film and asperities level its waves, in time.

**Source** balance and compliance as in dynamics/elastic_ring.py; the film's own flow, with its cavities in motion,
decides how fast.
**Valid** ring and film without inertia, aligned faces, one order of waves on the ring that stands still.
"""

import cmath
import contextlib
from dataclasses import replace

import numpy as np

from ..dynamics.elastic_ring import harmonic, order_of, state
from ..faces import contact
from ..faces.geometry import CLEARANCE, CONTACT_FORCE, DZ, FORCE
from ..faces.waviness import lay_waves
from ..numerics.piecewise_linear import initially
from ..scene.scene import Scene

# Newton's iterations of a step at most, their differences and what counts as solved, in the wave.
MOST, APART, SOLVED = 25, 1e-5, 1e-8
# How often a step without solution is halved.
HALVINGS = 10


def release(scene: Scene, net: float, start: float, duration: float, steps: int) -> tuple[np.ndarray, ...]:
    """What becomes of an operating point when its wave is another one, `start` (m) in place of `net`: times (s), net
    waves (complex, m) and clearances (m), shapes (steps + 1,); implicit Euler's method with `steps` that grow towards
    the `duration` (s).

    Raises ValueError where a step has no solution."""
    _, interface, s, _, initial = state(scene, net)
    soft, order, film = scene.stator.elastic.compliance(order_of(scene)), order_of(scene), interface.film
    closing = interface.closing.at(initially(scene.film.inner_pressure), initially(scene.film.outer_pressure),
                                   initially(interface.closing.spring))  # fmt: skip
    f, wave = interface.f, scene.stator.waviness[0]

    def lay(at):
        """Clearance and waves of the unknowns into the block and the gap state."""
        a = complex(at[1], at[2])
        lay_waves(f, [replace(wave, amplitude=abs(a), phase=-cmath.phase(a), order=order)], [])
        s[DZ] = at[0] - f[CLEARANCE]

    def excess(at, dt, held, x):
        """What the step's end leaves of axial and wave balance."""
        lay(at)
        code = film.settle(f, s, 1.0 / dt, held, x)
        if code:
            raise ValueError(film.status[code])
        film.wrench(f, s, x)
        rough = 0.0
        if interface.contact is not None:
            contact.contact_load(interface.contact, f, s)
            rough = s[CONTACT_FORCE]
        a = complex(at[1], at[2])
        left = a - initial - soft * harmonic(interface, x, a, at[0])
        return np.array([(s[FORCE] + rough) / closing - 1.0, left.real / start, left.imag / start])

    def step(at, dt, held, x):
        """The unknowns after a step; None where Newton's iterations find none."""
        for _ in range(MOST):
            left = excess(at, dt, held, x)
            jacobian = np.empty((3, 3))
            for k in range(3):
                moved = at.copy()
                moved[k] += APART * start
                jacobian[:, k] = (excess(moved, dt, held, x.copy()) - left) / (APART * start)
            change = np.linalg.solve(jacobian, -left)
            # Not further at once than half the wave.
            change *= min(1.0, 0.5 * start / max(np.max(np.abs(change)), 1e-300))
            at = at + change
            if np.max(np.abs(change)) < SOLVED * start:
                excess(at, dt, held, x)
                return at
        return None

    def advanced(at, dt, x, halvings=0):
        """As `step`, in halves where it finds none."""
        before = x.copy()
        with contextlib.suppress(ValueError, np.linalg.LinAlgError):
            after = step(at, dt, before, x)
            if after is not None:
                return after
        if halvings == HALVINGS:
            wave = abs(complex(at[1], at[2]))
            raise ValueError(f"a step of {dt:.3g} s from a wave of {1e6 * wave:.4g} um has no solution")
        x[:] = before
        return advanced(advanced(at, 0.5 * dt, x, halvings + 1), 0.5 * dt, x, halvings + 1)

    at = np.array([interface.clearance, start, 0.0])
    lay(at)
    x = interface.steady(f, s)
    times, found = np.concatenate([[0.0], np.geomspace(1e-3, 1.0, steps) * duration]), [at]
    for dt in np.diff(times):
        at = advanced(at, dt, x)
        found.append(at)
    at = np.array(found)
    return times, at[:, 1] + 1j * at[:, 2], at[:, 0]
