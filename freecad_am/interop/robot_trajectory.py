# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines as a trajectory of the Robot workbench, which plays it with robots of its own. Thinned, for it is slow with many."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD as App
import numpy as np

from ..core.geometry.frames import pose
from . import neighbour
from .lines import Line, attitudes, thinned


def add(document: Any, lines: Sequence[Line], label: str, tolerance: float, turn: float) -> Any:
    """A Robot::TrajectoryObject through so few points that the path keeps within `tolerance` mm and `turn` rad.

    Z of a waypoint points out of the nozzle. InputError NO_MODULE where this FreeCAD has no Robot workbench.
    """
    try:
        import Robot
    except ImportError:
        raise neighbour.lacking("trajectory", "Robot", "make a CAM path") from None
    obj = neighbour.added(document, "Robot::TrajectoryObject", "AmTrajectory", label)
    trajectory = Robot.Trajectory()
    trajectory.insertWaypoints(
        [
            Robot.Waypoint(placement, type="LIN", name=name, vel=speed)
            for name, placement, speed in waypoints(lines, tolerance, turn)
        ]
    )
    obj.Trajectory = trajectory
    obj.purgeTouched()  # nothing is left to recompute, which the tree would ask for
    return obj


def waypoints(lines: Sequence[Line], tolerance: float, turn: float) -> list[tuple[str, Any, float]]:
    """Name, placement and speed in mm/s of each waypoint; the end of one line and the same start of the next are one."""
    waypoints: list[tuple[str, Any, float]] = []
    end_point = None
    for line in lines:
        reduced = thinned(line, tolerance, turn)
        skipped = 1 if end_point is not None and np.array_equal(end_point, reduced.points[0]) else 0
        end_point = reduced.points[-1]
        poses = pose(attitudes(reduced.tool), reduced.points)
        speed = np.where(np.arange(len(reduced.speed)) == 0, reduced.speed[1], reduced.speed)
        waypoints += [
            (
                f"{line.name} {k}",
                App.Placement(App.Matrix(*poses[k].ravel().tolist())),
                float(speed[k]),
            )
            for k in range(skipped, len(reduced.points))
        ]
    return waypoints
