# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which pose of a cell is moved to place a part, and the cell with another one."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

from ..issues import InputError, Text
from ..kinematics.arrangement import arrangement_of
from ..parameters.cell import CellParameters, Pose
from ..parameters.external import MORE, PART, externals
from ..parameters.place import AUTO, PLATFORM, POINT, POSITIONER


def movable(settings: CellParameters) -> tuple[str, ...]:
    """The movable poses of a cell: those of POINT, PLATFORM, POSITIONER that it has, the usual one first."""
    arrangement = arrangement_of(settings.setup)
    if arrangement.holds_part:
        return (POINT, PLATFORM)
    if arrangement.carries_part:
        return (PLATFORM,)
    if any(mechanism.carries == PART for mechanism in externals(settings.external)):
        return (POSITIONER, PLATFORM)
    return (POINT,) if arrangement.planned else ()


def select_movable(settings: CellParameters, moves: str) -> str:
    """Return the pose to move. Raises InputError NOT_FOR_SETUP if the cell does not have it."""
    available = movable(settings)
    if moves == AUTO and available:
        return available[0]
    if moves not in available:
        raise InputError(
            "NOT_FOR_SETUP",
            "place.moves",
            "a cell with {} has no {} that places the part; use {}",
            settings.setup,
            moves,
            Text.joined(" or ", available) or "another set-up",
        )
    return moves


def pose_of(settings: CellParameters, moves: str) -> Pose:
    """The current pose of the movable, mm and rad."""
    if moves == POINT:
        return settings.deposition_point
    if moves == POSITIONER:
        return next(
            mechanism.pose
            for mechanism in externals(settings.external)
            if mechanism.carries == PART
        )
    platform = settings.platform
    return (
        (0.0, 0.0, float(platform), 0.0, 0.0, 0.0)
        if isinstance(platform, (int, float))
        else platform
    )


def replace_pose(settings: CellParameters, moves: str, pose: Sequence[float]) -> CellParameters:
    """Return the cell with another pose of the movable."""
    x, y, z, rx, ry, rz = (float(number) for number in pose)
    new_pose = (x, y, z, rx, ry, rz)
    if moves == POINT:
        return dataclasses.replace(settings, deposition_point=new_pose)
    if moves == PLATFORM:
        return dataclasses.replace(settings, platform=new_pose)
    mechanisms, is_replaced = [], False
    for mechanism in externals(settings.external):
        turns = mechanism.carries == PART and not is_replaced
        is_replaced |= turns
        mechanisms.append(
            str(dataclasses.replace(mechanism, pose=new_pose) if turns else mechanism)
        )
    return dataclasses.replace(settings, external=f"{MORE} ".join(mechanisms))


def outer(pose: Pose) -> list[float]:
    """A pose in mm and deg, digits that a sum of steps leaves behind rounded away."""
    return [
        round(value, 7) + 0.0 for value in (*pose[:3], *(math.degrees(angle) for angle in pose[3:]))
    ]
