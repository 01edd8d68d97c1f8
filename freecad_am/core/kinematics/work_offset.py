# SPDX-License-Identifier: LGPL-2.1-or-later
"""The real pose of a part, from three or more of its points touched by the robot:
`cell.touched`.

The rigid motion with the smallest sum of squares (Arun, Huang, Blostein 1987, with the
sign of Umeyama 1991). The residual at each point shows how well it was touched, and
whether the points belong to this part at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry import frames
from ..issues import InputError, Text, Word
from ..parameters.cell import CellParameters
from ..parameters.external import PART, externals
from ..parameters.touched import WHERE, Touched, touched
from ..types import Array
from .arrangement import Arrangement

CODE = "TOUCHED"
MIN_POINTS = 3
LINE = 0.05  # of their spread that points are off a line at least
SAME_SIZE = 0.01  # of the distances between points
_UNITS = (
    (25.4, "inches"),
    (1000.0, "m"),
    (10.0, "cm"),
    (1.0 / 25.4, "inches"),
    (1e-3, "m"),
    (0.1, "cm"),
)


@dataclass(frozen=True, eq=False)
class WorkOffset:
    """pose: (4, 4) of the part's coordinates in the maker's base frame. residual: (n,) mm, how far each point is from where
    it was touched."""

    pose: Array
    residual: Array

    def six(self) -> Array:
        """x y z RX RY RZ of the pose, mm and deg (Bryant)."""
        return np.concatenate([self.pose[:3, 3], np.degrees(frames.to_bryant(self.pose[:3, :3]))])


def offset_of_cell(parameters: CellParameters, arrangement: Arrangement) -> WorkOffset | None:
    """Return the pose of the part of a cell from touched points; None without any. Raises
    InputError TOUCHED.
    """
    points = touched(parameters.touched)
    if not points:
        return None
    carried = any(external_axis.carries == PART for external_axis in externals(parameters.external))
    if arrangement.carries_part or carried:
        raise InputError(
            CODE,
            WHERE,
            "touched points calibrate a part that the robot moves, but here the part is fixed "
            "and the robot holds the tool; remove them, and measure cell.platform or the pose of "
            "the positioner",
        )
    return work_offset(points, parameters.touched_tolerance)


def work_offset(points: Sequence[Touched], tolerance: float) -> WorkOffset:
    """Return the pose of the part.

    Raises InputError TOUCHED for fewer than three points, points on a line, of another size,
    and if one is farther than `tolerance` mm from where it was touched.
    """
    if len(points) < MIN_POINTS:
        raise InputError(
            CODE,
            WHERE,
            "{} point(s) cannot locate a part; touch at least {}, spread out and not collinear",
            len(points),
            MIN_POINTS,
        )
    part_points, robot_points = (
        np.array([getattr(touched_point, side) for touched_point in points])
        for side in ("part", "robot")
    )
    centred_part, centred_robot = (
        part_points - part_points.mean(axis=0),
        robot_points - robot_points.mean(axis=0),
    )
    for side, centred in (("part", centred_part), ("robot", centred_robot)):
        spread = np.linalg.svd(centred, compute_uv=False)
        if not spread[1] > LINE * spread[0]:
            raise InputError(
                CODE,
                WHERE,
                "the points {} are collinear or coincide, so the rotation about their line is "
                "undetermined; touch a point off that line",
                Word("touched" if side == "robot" else "on the part"),
            )
    _refuse_other_size(float(np.linalg.norm(centred_robot) / np.linalg.norm(centred_part)))
    u, _, vt = np.linalg.svd(centred_part.T @ centred_robot)
    turn = (u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt).T
    pose = frames.pose(turn, robot_points.mean(axis=0) - turn @ part_points.mean(axis=0))
    residual = np.linalg.norm(part_points @ turn.T + pose[:3, 3] - robot_points, axis=1)
    worst = int(np.argmax(residual))
    if residual[worst] > tolerance:
        text = ", ".join(f"{value:.3g}" for value in residual)
        raise InputError(
            CODE,
            WHERE,
            "point {} is {:.3g} mm from its touched position (all points: {} mm), more than "
            "cell.touched_tolerance = {:g} mm; touch it again, and check the order of the "
            "points, the part, and the tip calibration",
            worst + 1,
            residual[worst],
            text,
            tolerance,
        )
    return WorkOffset(pose, residual)


def _refuse_other_size(ratio: float) -> None:
    """Reject touched points of another size than the planned part."""
    if abs(ratio - 1.0) <= SAME_SIZE:
        return
    unit = next((name for factor, name in _UNITS if abs(ratio * factor - 1.0) <= SAME_SIZE), "")
    raise InputError(
        CODE,
        WHERE,
        "the touched points are {:.4g} times as far apart as planned; {}",
        ratio,
        Word(
            Text("one set is in {}; give both in mm", unit)
            if unit
            else "the points belong to another part, or are in another order"
        ),
    )
