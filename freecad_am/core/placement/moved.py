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
    """What there is to move in a cell: of POINT, PLATFORM, POSITIONER those it has, the usual one first."""
    arrangement = arrangement_of(settings.setup)
    if arrangement.holds_part:
        return (POINT, PLATFORM)
    if arrangement.carries_part:
        return (PLATFORM,)
    if any(one.carries == PART for one in externals(settings.external)):
        return (POSITIONER, PLATFORM)
    return (POINT,) if arrangement.planned else ()


def chosen(settings: CellParameters, moves: str) -> str:
    """What is moved. Raises InputError NOT_FOR_SETUP for what the cell does not have."""
    there = movable(settings)
    if moves == AUTO and there:
        return there[0]
    if moves not in there:
        raise InputError(
            "NOT_FOR_SETUP",
            "place.moves",
            "a cell with {} has no {} that places the part; use {}",
            settings.setup,
            moves,
            Text.joined(" or ", there) or "another set-up",
        )
    return moves


def pose_of(settings: CellParameters, moves: str) -> Pose:
    """The pose that is moved, as the cell has it, mm and rad."""
    if moves == POINT:
        return settings.deposition_point
    if moves == POSITIONER:
        return next(one.pose for one in externals(settings.external) if one.carries == PART)
    platform = settings.platform
    return (
        (0.0, 0.0, float(platform), 0.0, 0.0, 0.0)
        if isinstance(platform, (int, float))
        else platform
    )


def moved(settings: CellParameters, moves: str, pose: Sequence[float]) -> CellParameters:
    """The cell with another pose of what is moved."""
    x, y, z, rx, ry, rz = (float(number) for number in pose)
    there = (x, y, z, rx, ry, rz)
    if moves == POINT:
        return dataclasses.replace(settings, deposition_point=there)
    if moves == PLATFORM:
        return dataclasses.replace(settings, platform=there)
    mechanisms, done = [], False
    for one in externals(settings.external):
        turns = one.carries == PART and not done
        done |= turns
        mechanisms.append(str(dataclasses.replace(one, pose=there) if turns else one))
    return dataclasses.replace(settings, external=f"{MORE} ".join(mechanisms))


def outer(pose: Pose) -> list[float]:
    """A pose in mm and deg, digits that a sum of steps leaves behind rounded away."""
    return [
        round(value, 7) + 0.0 for value in (*pose[:3], *(math.degrees(angle) for angle in pose[3:]))
    ]
