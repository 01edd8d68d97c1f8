# SPDX-License-Identifier: LGPL-2.1-or-later
"""Four axes (Dai 2020, section 5): which turning axis stands still and where, and how the tool is held then."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from ...issues import ERROR, NOTE, InputError, Issue, Text, Word
from ...kinematics.cell import Cell
from ...kinematics.inverse.five_axis import FiveAxis
from ...parameters.joints import JointParameters
from ...toolpath import Toolpath
from ...types import Array
from ..joint_path import BeadPath
from ..reserve import RESERVE
from .directed import Lock


def lock_of(cell: Cell, parameters: JointParameters, toolpath: Toolpath) -> Lock | None:
    """The axis that stands still and where: as asked, or where the largest residual is least; None where none does.

    Raises InputError NOT_FOR_SETUP for robots.
    """
    if parameters.lock == "none":
        return None
    if cell.machine.free:
        raise InputError(
            "NOT_FOR_SETUP",
            "joints.lock",
            "robots need all their axes; only five-axis machines can work with four; use none",
        )
    axis = 0 if parameters.lock == "first" else 1
    if not isinstance(parameters.lock_at, str):
        return Lock(axis, parameters.lock_at)
    arm, tools = (
        FiveAxis(cell.machine.chain),
        [cell.to_flange(bead.points, bead.tool)[1] for _, _, bead in toolpath],
    )
    directions: Array = np.unique(np.round(np.concatenate(tools), 5), axis=0)
    turning = arm.turning[axis]
    low = max(float(cell.limits.lower[turning]) + RESERVE, -math.pi)
    high = min(float(cell.limits.upper[turning]) - RESERVE, math.pi)
    return Lock(axis, arm.best_lock(axis, directions, cell.station[:3, 2], low, high))


def as_held(
    cell: Cell, paths: Sequence[BeadPath], lock: Lock | None, allowed: float
) -> tuple[list[BeadPath], list[Issue]]:
    """The paths with the tool axes that their beads will really be laid with, not those asked for at poles and where an axis
    stands; and of a lock what is missed most, an error beyond `allowed` rad. Robots hold it as asked for."""
    if cell.machine.free:
        return list(paths), []
    done, strays = list(paths), list[tuple[float, int, int, int]]()
    for k, path in enumerate(paths):
        if path.reachable:
            tool = cell.tip_in_part(cell.machine.chain.forward(path.joints))[1]
            missed = np.arctan2(
                np.linalg.norm(np.cross(tool, path.bead.tool), axis=1),
                (tool * path.bead.tool).sum(axis=1),
            )
            strays.append((float(missed.max()), path.layer, path.index, int(missed.argmax())))
            held = dataclasses.replace(path.bead, tool=tool / np.linalg.norm(tool, axis=1)[:, None])
            done[k] = dataclasses.replace(path, bead=held)
    return done, [_missed(cell, lock, max(strays), allowed)] if lock is not None and strays else []


def _missed(cell: Cell, lock: Lock, worst: tuple[float, int, int, int], allowed: float) -> Issue:
    name, (missed, *place) = (
        cell.machine.axes[FiveAxis(cell.machine.chain).turning[lock.axis]],
        worst,
    )
    stands, off, most = (math.degrees(angle) for angle in (lock.angle, missed, allowed))
    text = Text(
        "axis {} is locked at {:.4g} deg; the tool is up to {:.3g} deg off the requested direction",
        name,
        stands,
        off,
    )
    if missed <= allowed:
        return Issue(NOTE, "FOUR_AXES", text, *place)
    return Issue(
        ERROR,
        "FOUR_AXES",
        Text(
            "{}, more than joints.max_residual allows ({:.3g} deg); lock the other axis, use "
            "another position or none",
            Word(text),
            most,
        ),
        *place,
    )
