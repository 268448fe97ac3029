"""The integrators by name: CVODE and IDA through scikit-sundae, SciPy's references, the matrix exponential."""

from .matrix_exponential import expm
from .scipy_methods import dop853_or_radau
from .sundials import cvode, ida
from .trbdf2 import trbdf2

METHODS = {
    "adams": cvode,
    "bdf": cvode,
    "ida": ida,
    "dop853": dop853_or_radau,
    "radau": dop853_or_radau,
    "expm": expm,
    "trbdf2": trbdf2,
}
