# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compute the poses of a machine's links with PyKDL, from the joint frames of the machine file
only."""

import numpy as np
import PyKDL


class KdlLinks:
    """Compute the frames (4, 4) of the links of a machine relative to the base of its chain, in
    mm."""

    def __init__(self, machine):
        chain = machine.chain
        self.order, self.links = chain.order, len(chain.order)
        # a reference must stay, because the solver does not keep the chain
        self.chain = PyKDL.Chain()
        for origin, direction, value in zip(
            chain.origins, chain.directions, chain.order, strict=True
        ):
            kind = PyKDL.Joint.TransAxis if chain.sliding[value] else PyKDL.Joint.RotAxis
            turning = PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*direction), kind)
            self.chain.addSegment(PyKDL.Segment(PyKDL.Joint(), _frame(origin)))
            self.chain.addSegment(PyKDL.Segment(turning, PyKDL.Frame()))
        self.chain.addSegment(PyKDL.Segment(PyKDL.Joint(), _frame(chain.flange)))
        self.solver = PyKDL.ChainFkSolverPos_recursive(self.chain)
        self.angles, self.seen = PyKDL.JntArray(self.links), PyKDL.Frame()

    def frame(self, q, link=None):
        """Return the frame of a link (0 is the base) or of the flange at joint values q (axes,)."""
        for index, value in enumerate(self.order):
            self.angles[index] = float(q[value])
        self.solver.JntToCart(
            self.angles, self.seen, 2 * self.links + 1 if link is None else 2 * link
        )
        pose = np.eye(4)
        pose[:3, :3] = [[self.seen.M[i, j] for j in range(3)] for i in range(3)]
        pose[:3, 3] = [self.seen.p.x(), self.seen.p.y(), self.seen.p.z()]
        return pose


def _frame(pose):
    return PyKDL.Frame(PyKDL.Rotation(*pose[:3, :3].ravel()), PyKDL.Vector(*pose[:3, 3]))
