"""scikit-sundae, loaded without the whole of SciPy's optimisers.

It takes one function of theirs, `scipy.optimize._numdiff.group_columns`; a package loads all of itself for one module,
a fifth of a second at every start.  So that module is loaded alone, and `scipy.optimize` is left to be loaded by
whoever asks for it.
"""

import contextlib
import sys
from importlib import import_module
from importlib.util import find_spec, module_from_spec

PACKAGE = "scipy.optimize"


@contextlib.contextmanager
def _bare(package: str):
    """A package that is not loaded yet stands in `sys.modules` without having been run: its modules can be imported."""
    if package in sys.modules:
        yield
        return
    sys.modules[package] = module_from_spec(find_spec(package))
    try:
        yield
    finally:
        del sys.modules[package]


# If SciPy's module should need more of its package one day: then as anybody imports it.
with contextlib.suppress(ImportError), _bare(PACKAGE):
    import_module(f"{PACKAGE}._numdiff")

from sksundae.cvode import CVODE  # noqa: E402
from sksundae.ida import IDA  # noqa: E402

__all__ = ["CVODE", "IDA"]
