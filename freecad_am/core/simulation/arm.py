# SPDX-License-Identifier: LGPL-2.1-or-later
"""Positions along a motion, between its rows too, where links of the robot touch an obstacle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..collision.bead_ends import LINK_GRAIN, Beads
from ..collision.obstacles import Obstacles
from ..kinematics.cell import Cell
from ..kinematics.links.contact import ArmContact
from ..kinematics.links.rounds import NONE
from ..motion import Motion
from ..types import Array, Index, Mask

# a sample each time the fastest joint has turned by STEP rad or moved by SLIDE mm, at this number of
# samples at most: longer motions have fewer samples a turn
STEP, SLIDE, MAX_LOOKS = float(np.radians(1.0)), 10.0, 40_000


@dataclass(frozen=True, eq=False)
class ArmTouches:
    """link: (n,) of the n rows of a motion the link that touches something on the segment that ends there, or at the row,
    NONE where none does: number of `links`. what: (n,) number of `names`, what it touches. step: rad between two places
    looked at."""

    link: Index
    what: Index
    names: tuple[str, ...]
    step: float
    links: tuple[str, ...]


def deposit_obstacles(motion: Motion, width: float, height: float) -> Obstacles | None:
    """Return the deposit of a motion as an obstacle for arms; width of beads where the motion does not
    state it, and height, mm.
    """
    deposit_rows = motion.deposit
    if not deposit_rows.any():
        return None
    wide = np.where(np.isnan(motion.width[deposit_rows]), width, motion.width[deposit_rows])
    return Beads(
        motion.position[deposit_rows],
        motion.build[deposit_rows],
        motion.tool[deposit_rows],
        wide,
        np.full(len(wide), height),
        motion.point[deposit_rows] == 0,
    ).solid(LINK_GRAIN)


def arm_touches(motion: Motion, arm: ArmContact, max_places: int | None = None) -> ArmTouches:
    """Return the contacts of the arm along the motion, checked at `max_places` positions at most. Rows
    without joint values have none.
    """
    n = len(motion)
    link, what = np.full(n, NONE, dtype=np.int64), np.full(n, NONE, dtype=np.int64)
    joints, row, step = places(motion.joints, max_places, tracks_of(arm.cell))
    deposited_before: Index = np.cumsum(motion.deposit) - motion.deposit
    touches = arm.touches(joints, deposited_before[row])
    # rows closer together than the samples take the result of the next sample: every run of rows ends with one
    reachable = np.flatnonzero(motion.reachable)
    next_place = np.searchsorted(row, reachable)
    link[reachable], what[reachable] = touches.link[next_place], touches.what[next_place]
    # and of the places of a row the first one that touches counts
    rows, first_places = np.unique(row[touches.any], return_index=True)
    link[rows], what[rows] = (
        touches.link[touches.any][first_places],
        touches.what[touches.any][first_places],
    )
    return ArmTouches(link, what, arm.names, step, arm.links)


def tracks_of(cell: Cell) -> Mask:
    """Return which axes (axes,) of a cell belong to a track."""
    tracks: Mask = cell.machine.chain.sliding.copy()
    tracks[: cell.robot.chain.axes] = False
    return tracks


def places(
    joints: Array, max_places: int | None = None, sliding: Mask | None = None
) -> tuple[Array, Index, float]:
    """Sample a motion between its rows.

    Returns joints (k, axes) along the motion (n, axes), the rows (k,) of their segments, rising, and
    the step, rad. Samples are at even steps of the joint that moves most, SLIDE of the `sliding`
    axes counting as STEP, and at both ends of every run of rows with joint values, even of a single
    row; the unknown moves between two runs have none.
    """
    n = len(joints)
    reachable: Mask = np.asarray(np.isfinite(joints).all(axis=1))
    goes_on = reachable & np.append(False, reachable[:-1])[:n]  # from the row before
    travel = np.abs(np.diff(joints, axis=0, prepend=joints[:1]))
    if sliding is not None and sliding.any():
        travel[:, sliding] *= STEP / SLIDE
    moved = np.where(goes_on, travel.max(axis=1, initial=0.0), 0.0)
    travelled = np.cumsum(moved)
    total = float(travelled[-1]) if n else 0.0
    step = max(STEP, total / (MAX_LOOKS if max_places is None else max_places))
    positions = np.arange(step, total, step)
    inner = np.searchsorted(
        travelled, positions, side="left"
    )  # rows that move, so that both of their ends are known
    share = (positions - travelled[inner - 1]) / moved[inner]
    ends = np.flatnonzero(reachable & ~(goes_on & np.append(goes_on[1:], False)[:n]))
    row = np.concatenate([inner, ends])
    share = np.concatenate([share, np.ones(len(ends))])[:, None]
    sampled = np.where(
        share < 1.0, joints[row - 1] * (1.0 - share) + joints[row] * share, joints[row]
    )
    order = np.lexsort((share[:, 0], row))
    return sampled[order], row[order], step
