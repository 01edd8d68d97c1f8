# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machine files prove themselves: joint vectors with the flange poses that they give are computed again."""

from __future__ import annotations

import math

import numpy as np

from ...geometry import frames
from ...issues import Text
from ..chain import Chain
from ..inverse.opw import OpwArm
from .file import Node

# what rounding of the check poses may leave: mm, and entries of a rotation
POSITION_TOLERANCE, ROTATION_TOLERANCE = 1e-6, 1e-9
MOST_ROUNDING = (0.5, 0.1)  # that may be claimed for a check pose, mm and deg


def check(chain: Chain, opw: OpwArm | None, node: Node) -> None:
    """Reject a file (InputError BAD_MACHINE) whose check poses, `node`, do not match its chain
    and its closed form, if any.
    """
    poses = [pose.only("q", "origin", "rotation", "within") for pose in node.items()]
    if len(poses) < 3:
        raise node.bad(
            Text(
                "the file has {}; give at least 3 joint vectors with their flange poses", len(poses)
            )
        )
    q = np.array([pose["q"].numbers(chain.axes) for pose in poses]) * np.where(
        chain.sliding, 1.0, math.radians(1.0)
    )
    if not (q == 0.0).all(axis=1).any():
        raise node.bad("the pose at all zeros is missing; add it")
    expected = np.stack(
        [frames.pose(pose["rotation"].matrix(3, 3), pose["origin"].numbers(3)) for pose in poses]
    )
    allowed = np.array([_tolerance_of(pose) for pose in poses])
    solvers = {"the joint frames give": chain.forward}
    if opw is not None:
        solvers["opw gives"] = opw.forward
    for solver_gives, forward in solvers.items():
        off = np.abs(forward(q) - expected)
        position, rotation = off[:, :3, 3].max(axis=1), off[:, :3, :3].max(axis=(1, 2))
        wrong = (position > allowed[:, 0]) | (rotation > allowed[:, 1])
        if wrong.any():
            index = int(np.argmax(wrong))
            raise poses[index].bad(
                Text(
                    "{} a flange {:.6g} mm and {:.3g} (largest entry of the rotation) from it; correct the geometry or the "
                    "pose",
                    solver_gives,
                    position[index],
                    rotation[index],
                )
            )


def _tolerance_of(pose: Node) -> tuple[float, float]:
    """Return the tolerance of a check pose, mm and as entries of the rotation: `within` for a
    pose read from a display.
    """
    if not pose.has("within"):
        return POSITION_TOLERANCE, ROTATION_TOLERANCE
    node = pose["within"].only("mm", "deg")
    values = []
    for key, max_value in zip(("mm", "deg"), MOST_ROUNDING, strict=True):
        value = node[key].number()
        if not 0.0 <= value <= max_value:
            raise node[key].bad(
                Text(
                    "{:g} exceeds the rounding of a display; give 0 to {:g}",
                    value,
                    max_value,
                )
            )
        values.append(value)
    return max(values[0], POSITION_TOLERANCE), max(math.radians(values[1]), ROTATION_TOLERANCE)
