# SPDX-License-Identifier: LGPL-2.1-or-later
"""Four-axis motion (Dai 2020, section 5): the locked rotary axis, its angle and the resulting tool
axes.
"""

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
    """Return the locked axis and its angle: the requested one, or the angle with the least maximum
    residual.

    None without a lock. Raises InputError NOT_FOR_SETUP for robots.
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
    """Return the paths with the actual tool axes of their beads, and an issue for the worst
    residual of a lock.

    Actual and requested axes differ at poles and with a locked axis. A residual beyond `allowed`
    rad is an error. Robots keep the requested axes.
    """
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
