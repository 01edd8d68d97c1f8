# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where along a motion the links of a robot touch what is in the cell, between its rows too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..kinematics.arm_contact import NONE, ArmContact, Deposit, deposit
from ..motion import Motion

Array = NDArray[np.float64]
Index = NDArray[np.int64]

# joints are looked at whenever the fastest of them has turned by so many rad (or moved by so many mm), at so many places at
# most: of longer motions at fewer places of each turn
STEP, MOST = float(np.radians(1.0)), 40_000


@dataclass(frozen=True)
class ArmTouches:
    """link: (n,) of the n rows of a motion the link that touches something on the segment that ends there, or at the row,
    NONE where none does. what: (n,) number of `names`, what it touches. step: rad between two places looked at."""

    link: Index
    what: Index
    names: tuple[str, ...]
    step: float


def laid(motion: Motion, width: float, height: float) -> Deposit | None:
    """The deposit of a motion as arms can touch it; width of beads where the motion does not tell it, and height, mm."""
    points = motion.position[motion.deposit]
    if not len(points):
        return None
    widest = float(np.nanmax(np.append(motion.width[motion.deposit], width)))
    return deposit(points, motion.build[motion.deposit], widest, height)


def arm_touches(motion: Motion, arm: ArmContact) -> ArmTouches:
    """What the arm touches on the way. Rows without joint values touch nothing."""
    n = len(motion)
    link, what = np.full(n, NONE, dtype=np.int64), np.full(n, NONE, dtype=np.int64)
    joints, row, step = places(motion.joints)
    before: Index = np.cumsum(motion.deposit) - motion.deposit
    found = arm.touches(joints, before[row])
    # rows that lie closer than the places looked at are as the next of these is
    here = np.minimum(np.searchsorted(row, np.arange(n)), len(row) - 1) if len(row) else np.zeros(0, dtype=np.int64)
    if len(here):
        link[:], what[:] = found.link[here], found.what[here]
        link[~motion.reachable], what[~motion.reachable] = NONE, NONE
    # and of the places of a row the first one that touches counts
    rows, first = np.unique(row[found.any], return_index=True)
    link[rows], what[rows] = found.link[found.any][first], found.what[found.any][first]
    return ArmTouches(link, what, arm.names, step)


def places(joints: Array) -> tuple[Array, Index, float]:
    """Joints (k, axes) along a motion (n, axes) at even steps of the joint that moves most, the rows (k,) whose segments
    they are on, and the step. Between rows that are not both reachable there are none."""
    n = len(joints)
    if n == 0:
        return joints, np.zeros(0, dtype=np.int64), STEP
    moved = np.nan_to_num(np.abs(np.diff(joints, axis=0, prepend=joints[:1])).max(axis=1))
    way = np.cumsum(moved)
    step = max(STEP, float(way[-1]) / MOST)
    at = np.arange(0.0, way[-1] + step, step)
    at[-1] = way[-1]
    row = np.searchsorted(way, at, side="left")
    before = np.maximum(row - 1, 0)
    share = np.divide(at - way[before], moved[row], out=np.ones(len(at)), where=moved[row] > 0.0)[:, None]
    seen = joints[before] * (1.0 - share) + joints[row] * share
    whole = share[:, 0] == 1.0
    seen[whole] = joints[row[whole]]
    kept = np.isfinite(seen).all(axis=1)
    return seen[kept], row[kept], step
