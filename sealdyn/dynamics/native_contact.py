"""dynamics/native.py with faces that may touch."""

from numba import carray, cfunc

from ..faces.contact import contact_load
from ..numerics.addresses import floats, integers
from .equations import rates, residual
from .native import BLOCK, CONTACT, FILM, GAP, PARAMETERS, RATES, RESIDUAL, SCRATCH, SIZE, WORK, array, film


@cfunc(RATES, cache=True)
def touching_rates_at(tau, y_at, yp_at, data):
    """The right-hand side."""
    block = carray(integers(data), BLOCK)
    y, yp, s = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE]), array(block, GAP)
    film(tau, y, yp, block)
    contact_load(array(block, CONTACT), array(block, FILM), s)
    rates(tau, y, array(block, PARAMETERS), array(block, SCRATCH), s, yp)
    return 0


@cfunc(RESIDUAL, cache=True)
def touching_residual_at(tau, y_at, yp_at, res_at, data):
    """The residual."""
    block = carray(integers(data), BLOCK)
    y, yp, s = carray(floats(y_at), block[SIZE]), carray(floats(yp_at), block[SIZE]), array(block, GAP)
    film(tau, y, yp, block)
    contact_load(array(block, CONTACT), array(block, FILM), s)
    p, w = array(block, PARAMETERS), array(block, SCRATCH)
    residual(tau, y, yp, p, w, s, array(block, WORK), carray(floats(res_at), block[SIZE]))
    return 0
