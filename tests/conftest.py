"""Puts this folder on the path, so that every test may import `scenes` and `oracles`."""

import pytest

# Stale kernels are dropped by this import: once, before several processes begin to compile new ones.
import sealdyn  # noqa: F401

# In SI a picometre is something: `approx` forgives 1e-12 of anything unless it is told not to.
type(pytest.approx(1.0)).DEFAULT_ABSOLUTE_TOLERANCE = 0.0
