"""A face seal for rotors of ROSS (ross-rotordynamics), from a table of sealdyn: it acts on z and on both tilts.

    # where sealdyn is
    json.dump(sealdyn.shaft_table("pump.toml", range(100, 400, 20)), open("seal.json", "w"))
    # where ROSS is; this file alone beside it, without sealdyn
    rotor = rs.Rotor(shaft, disks, [*bearings, FaceSeal(n=4, table=json.load(open("seal.json")))])

ROSS takes three degrees of freedom of a bearing; a radial bearing has x, y, z, a face seal z, alpha, beta, the tilts
about x and y.  Its matrices are those of the table at the frequency that ROSS asks for, straight lines between and the
ends beyond; run_modal asks at the speed, for which a table of synchronous whirl is made.  The seal counts its z along
the shaft from rotor to stator; a seal the other way round has the same matrices.
"""

import numpy as np
import ross as rs


class FaceSeal(rs.BearingElement):
    """A face seal at node `n`: `table` as `sealdyn.shaft_table` returns it; N, m, rad."""

    def __init__(self, n, table, tag=None, scale_factor=1, color="#77ACA2"):
        order = np.argsort(table["frequency"])
        at = np.array(table["frequency"], dtype=float)[order]
        stiffness, damping = (np.array(table[name], dtype=float)[order] for name in ("stiffness", "damping"))
        self.table, self.at, self.by_name = table, at, {"K": stiffness, "C": damping}
        super().__init__(n, kxx=0.0, cxx=0.0, kzz=float(stiffness[0, 0, 0]), czz=float(damping[0, 0, 0]), tag=tag,
                         scale_factor=scale_factor, color=color)  # fmt: skip

    def dof_mapping(self):
        """Places among the six of a node."""
        return {"z_0": 2, "alpha_0": 3, "beta_0": 4}

    def K(self, frequency):
        """Stiffness (3, 3) on z, alpha, beta."""
        return self._between("K", frequency)

    def C(self, frequency):
        """Damping (3, 3)."""
        return self._between("C", frequency)

    def M(self, frequency):
        """No mass: that of the rings is in the stiffness."""
        return np.zeros((3, 3))

    def G(self):
        """No gyroscopic moments: those of the rings are in the damping."""
        return np.zeros((3, 3))

    def _between(self, name, frequency):
        rows = self.by_name[name].reshape(len(self.at), 9)
        return np.array([np.interp(frequency, self.at, column) for column in rows.T]).reshape(3, 3)
