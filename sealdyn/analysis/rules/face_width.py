"""Width of the face, by bore."""

import numpy as np

from ._finding import Verdict, missing, noted, within

SOURCE = "table 2.7"
COMMAND = "sealdyn study load-support FILE"

# Bore and width (m).
BORES = (25.4e-3, 50.8e-3, 76.2e-3, 101.6e-3)
WIDTHS = (1.58e-3, 1.58e-3, 1.98e-3, 2.39e-3)
# Of the table's width: how near counts as that width is not the guide's.
NEAR = 0.1


def finding(seal):
    """Pass within a tenth of the table's width, linear between its bores; else a note, for it is a width to begin with
    and no limit.  Beyond the table a note."""
    bore, width = seal.application.bore, seal.face_width
    if bore is None:
        return missing("application.bore")
    said = f"face {1e3 * width:.4g} mm wide at a bore of {1e3 * bore:.4g} mm"
    if not BORES[0] <= bore <= BORES[-1]:
        said += f", beyond the table ({1e3 * BORES[0]:g} to {1e3 * BORES[-1]:g} mm)"
        return noted(said, width, "m", usual=None)
    usual = float(np.interp(bore, BORES, WIDTHS))
    said += f"; {1e3 * usual:.4g} mm is usual"
    if width > (1 + NEAR) * usual:
        said += ": a wider face makes more heat"
    return within(said, width, "m", (1 - NEAR) * usual, (1 + NEAR) * usual, beyond=Verdict.NOTE, usual=usual)
