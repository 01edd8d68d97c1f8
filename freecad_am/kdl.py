# SPDX-License-Identifier: LGPL-2.1-or-later
"""A machine as a PyKDL chain: the second opinion on our own kinematics. The only user of PyKDL.

Built from the joint frames of the machine file alone; numbers go in and come out one at a time, so this is for
checks, not for planning.
"""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np

from .core.geometry import frames
from .core.kinematics.machines.machine import Machine
from .core.types import Array, ArrayLike

SOLVERS = ("nr", "lma")
ITERATIONS = 100


def available() -> bool:
    """Whether PyKDL is installed."""
    try:
        _kdl()
    except ImportError:
        return False
    return True


def _kdl() -> ModuleType:
    import PyKDL  # only where it is used: most jobs start without it

    module: ModuleType = PyKDL
    return module


class KdlArm:
    """The chain of a machine in PyKDL. Poses (n, 4, 4) of the flange in base_link, mm; joint values (n, axes) rad and mm."""

    def __init__(self, machine: Machine) -> None:
        self.kdl = _kdl()
        self.axes = len(machine.axes)
        self.order = machine.chain.order  # which of the joint values each joint takes
        # a fixed segment to the first joint's frame, then each joint about its axis, the way to the next frame behind it
        self.chain = self.kdl.Chain()
        self.chain.addSegment(
            self.kdl.Segment(self.kdl.Joint(), self.frame(machine.chain.origins[0]))
        )
        behind = [*machine.chain.origins[1:], machine.chain.flange]
        for value, direction, link in zip(
            machine.chain.order.tolist(), machine.chain.directions, behind, strict=True
        ):
            kind = (
                self.kdl.Joint.TransAxis if machine.chain.sliding[value] else self.kdl.Joint.RotAxis
            )
            joint = self.kdl.Joint(
                f"q{value + 1}", self.kdl.Vector(), self.kdl.Vector(*direction), kind
            )
            self.chain.addSegment(self.kdl.Segment(joint, self.frame(link)))
        self._forward = self.kdl.ChainFkSolverPos_recursive(self.chain)
        self._jacobian = self.kdl.ChainJntToJacSolver(self.chain)

    def forward(self, q: ArrayLike) -> Array:
        """Flange poses (n, 4, 4) of joint angles `q` (n, axes)."""
        values = np.asarray(q, float)[:, self.order]
        frame, angles, solve = (
            self.kdl.Frame(),
            self.kdl.JntArray(self.axes),
            self._forward.JntToCart,
        )
        # these calls are much of the time of a read-back: parts of the frame are looked up once, for the solver fills it in
        # place; a quaternion is one call where a matrix is nine; and joints that stay where they are need not be told again
        x, y, z, turned = frame.p.x, frame.p.y, frame.p.z, frame.M.GetQuaternion
        put, all_axes = angles.__setitem__, tuple(range(self.axes))
        numbers: list[float] = []
        for row, axes in zip(values.tolist(), _changed_axes(values), strict=True):
            if len(axes) == self.axes:
                any(map(put, all_axes, row))  # puts them all, for it gives back nothing
            else:
                for axis in axes:
                    put(axis, row[axis])
            solve(angles, frame)
            numbers += x(), y(), z()
            numbers += turned()
        rows = np.array(numbers).reshape(-1, 7)
        return frames.pose(_rotations(rows[:, 3:]), rows[:, :3])

    def jacobian(self, q: ArrayLike) -> Array:
        """Geometric Jacobians (n, 6, axes) at the flange's origin in base_link: rows velocity, angular velocity."""
        result = np.empty((len(np.asarray(q)), 6, self.axes))
        columns = self.kdl.Jacobian(self.axes)
        for row, angles in zip(result, np.asarray(q, float), strict=True):
            self._jacobian.JntToJac(self.angles(angles), columns)
            row[:, self.order] = [[columns[i, k] for k in range(self.axes)] for i in range(6)]
        return result

    def inverse(
        self, poses: ArrayLike, seeds: ArrayLike, solver: str = "nr", tolerance: float = 1e-6
    ) -> Array:
        """Joint angles (n, axes) found numerically from `seeds` (n, axes); NaN where the solver gives up.

        `solver` is 'nr' (Newton-Raphson) or 'lma' (Levenberg-Marquardt); `tolerance` in mm and rad.
        """
        solve = self.solver(solver, tolerance)
        seeds = np.asarray(seeds, float)
        result = np.full(seeds.shape, np.nan)
        solution = self.kdl.JntArray(self.axes)
        for row, pose, seed in zip(result, np.asarray(poses, float), seeds, strict=True):
            if solve.CartToJnt(self.angles(seed), self.frame(pose), solution) >= 0:
                row[self.order] = [solution[i] for i in range(self.axes)]
        return result

    def solver(self, name: str, tolerance: float = 1e-6) -> Any:
        """PyKDL's own solver object 'nr' or 'lma'."""
        if name == "lma":
            return self.kdl.ChainIkSolverPos_LMA(self.chain, tolerance, ITERATIONS)
        if name != "nr":
            raise ValueError(f"{name!r} is none of {', '.join(SOLVERS)}")
        # the solvers keep no reference of their own to one another
        self._velocity = self.kdl.ChainIkSolverVel_pinv(self.chain)
        return self.kdl.ChainIkSolverPos_NR(
            self.chain, self._forward, self._velocity, ITERATIONS, tolerance
        )

    def angles(self, angles: Array) -> Any:
        """Joint angles (axes,) as PyKDL's JntArray."""
        array = self.kdl.JntArray(self.axes)
        for index, value in enumerate(self.order):
            array[index] = float(angles[value])
        return array

    def frame(self, pose: Array) -> Any:
        """A pose (4, 4) as PyKDL's Frame."""
        rotation = self.kdl.Rotation(*(float(entry) for entry in pose[:3, :3].ravel()))
        return self.kdl.Frame(rotation, self.kdl.Vector(*(float(entry) for entry in pose[:3, 3])))


def _changed_axes(values: Array) -> Iterator[tuple[int, ...]]:
    """Which joints of (n, axes) have another value than in the row before; in the first one all."""
    axes = values.shape[1]
    changed = np.ones(values.shape, dtype=np.int64)
    changed[1:] = values[1:] != values[:-1]
    subsets = [tuple(axis for axis in range(axes) if code >> axis & 1) for code in range(1 << axes)]
    return (subsets[code] for code in (changed @ (1 << np.arange(axes))).tolist())


def _rotations(quaternions: Array) -> Array:
    """The rotations (n, 3, 3) of quaternions x y z w (n, 4)."""
    x, y, z, w = quaternions.T
    rows = (
        1 - 2 * (y * y + z * z),
        2 * (x * y - z * w),
        2 * (x * z + y * w),
        2 * (x * y + z * w),
        1 - 2 * (x * x + z * z),
        2 * (y * z - x * w),
        2 * (x * z - y * w),
        2 * (y * z + x * w),
        1 - 2 * (x * x + y * y),
    )
    result: Array = np.stack(rows, axis=1).reshape(-1, 3, 3)
    return result
