# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where PyKDL has the links of a machine: a chain of its own, of the joint frames of the machine file alone."""

import numpy as np
import PyKDL


class KdlLinks:
    """Frames (4, 4) of the links of a machine from where its chain begins, mm."""

    def __init__(self, machine):
        own = machine.chain
        self.order, self.links = own.order, len(own.order)
        self.chain = PyKDL.Chain()  # the solver does not keep it
        for origin, direction, value in zip(own.origins, own.directions, own.order, strict=True):
            kind = PyKDL.Joint.TransAxis if own.sliding[value] else PyKDL.Joint.RotAxis
            turning = PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*direction), kind)
            self.chain.addSegment(PyKDL.Segment(PyKDL.Joint(), _frame(origin)))
            self.chain.addSegment(PyKDL.Segment(turning, PyKDL.Frame()))
        self.chain.addSegment(PyKDL.Segment(PyKDL.Joint(), _frame(own.flange)))
        self.solver = PyKDL.ChainFkSolverPos_recursive(self.chain)
        self.angles, self.seen = PyKDL.JntArray(self.links), PyKDL.Frame()

    def frame(self, q, link=None):
        """That of a link, 0 the base, or of the flange, with joints q (axes,)."""
        for place, value in enumerate(self.order):
            self.angles[place] = float(q[value])
        self.solver.JntToCart(
            self.angles, self.seen, 2 * self.links + 1 if link is None else 2 * link
        )
        pose = np.eye(4)
        pose[:3, :3] = [[self.seen.M[i, j] for j in range(3)] for i in range(3)]
        pose[:3, 3] = [self.seen.p.x(), self.seen.p.y(), self.seen.p.z()]
        return pose


def _frame(pose):
    return PyKDL.Frame(PyKDL.Rotation(*pose[:3, :3].ravel()), PyKDL.Vector(*pose[:3, 3]))
