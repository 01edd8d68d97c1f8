# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of interest in a motion: limits, singularities, robot contacts and speed losses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..collision.bead_ends import LINK_GRAIN, Beads
from ..collision.obstacles import Obstacles
from ..issues import NOTE, Issue
from ..kinematics.cell import Cell
from ..kinematics.links.contact import LINKS_MORE, ArmContact
from ..kinematics.links.self_collision import NONE
from ..motion import Motion
from ..types import Array, ArrayLike, Index, Integers, Mask
from .achievable_feed import AchievableFeed

# sampling step of the fastest joint: STEP, rad, or SLIDE, mm; maximum number of samples, so long
# motions have coarser steps
STEP, SLIDE, MAX_LOOKS = float(np.radians(1.0)), 10.0, 40_000


@dataclass(frozen=True, eq=False)
class ArmTouches:
    """Contacts of links in a motion of n rows.

    link: (n,) index in `links` of the link in contact at the row or on the segment that ends there,
    NONE without contact. what: (n,) index in `names` of the body in contact. step: distance between
    two checked positions, rad.
    """

    link: Index
    what: Index
    names: tuple[str, ...]
    step: float
    links: tuple[str, ...]


def deposit_obstacles(motion: Motion, width: float, height: float) -> Obstacles | None:
    """Return the deposit of a motion as an obstacle for arms.

    Parameters
    ----------
    motion : Motion
        The motion, positions in the part.
    width : float
        Width of beads whose width the motion does not state, mm.
    height : float
        Height of beads, mm.

    Returns
    -------
    Obstacles or None
        The deposit in the part; None if there is no deposit.
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
    """Return the contacts of the arm along a motion.

    Parameters
    ----------
    motion : Motion
        The motion, n rows; rows without joint values have no contacts.
    arm : ArmContact
        Links, bodies and deposit to check.
    max_places : int, optional
        Maximum number of positions to check; MAX_LOOKS by default.

    Returns
    -------
    ArmTouches
        Link and body in contact at each row or on the segment that ends there.
    """
    n = len(motion)
    link, what = np.full(n, NONE, dtype=np.int64), np.full(n, NONE, dtype=np.int64)
    joints, row, step = places(motion.joints, max_places, tracks_of(arm.cell))
    deposited_before: Index = np.cumsum(motion.deposit) - motion.deposit
    touches = arm.touches(joints, deposited_before[row])
    # rows between samples take the result of the next sample; every run of rows ends with a sample
    reachable = np.flatnonzero(motion.reachable)
    next_place = np.searchsorted(row, reachable)
    link[reachable], what[reachable] = touches.link[next_place], touches.what[next_place]
    # several samples of a row: the first contact counts
    rows, first_places = np.unique(row[touches.any], return_index=True)
    link[rows], what[rows] = (
        touches.link[touches.any][first_places],
        touches.what[touches.any][first_places],
    )
    return ArmTouches(link, what, arm.names, step, arm.links)


def tracks_of(cell: Cell) -> Mask:
    """Return which axes of a cell are track axes.

    Parameters
    ----------
    cell : Cell
        The cell.

    Returns
    -------
    (axes,) array of bool
        True for prismatic external axes.
    """
    tracks: Mask = cell.machine.chain.sliding.copy()
    tracks[: cell.robot.chain.axes] = False
    return tracks


def places(
    joints: Array, max_places: int | None = None, sliding: Mask | None = None
) -> tuple[Array, Index, float]:
    """Sample a motion between its rows.

    Samples are at even steps of the joint that moves most, where SLIDE of a `sliding` axis counts
    as STEP. There are also samples at both ends of every run of rows with joint values, even of a
    single row. The unknown moves between two runs are not sampled.

    Parameters
    ----------
    joints : (n, axes) array
        Joint values of the rows, rad or mm; NaN if unreachable.
    max_places : int, optional
        Maximum number of steps; MAX_LOOKS by default.
    sliding : (axes,) array of bool, optional
        Axes in mm, with the step SLIDE.

    Returns
    -------
    joints : (k, axes) array
        Joint values of the samples, rad or mm.
    rows : (k,) array of int
        Rows at which the segments of the samples end, ascending.
    step : float
        Step between samples, rad, at least STEP.
    """
    n = len(joints)
    reachable: Mask = np.asarray(np.isfinite(joints).all(axis=1))
    goes_on = reachable & np.append(False, reachable[:-1])[:n]  # the previous row is reachable too
    travel = np.abs(np.diff(joints, axis=0, prepend=joints[:1]))
    if sliding is not None and sliding.any():
        travel[:, sliding] *= STEP / SLIDE
    moved = np.where(goes_on, travel.max(axis=1, initial=0.0), 0.0)
    travelled = np.cumsum(moved)
    total = float(travelled[-1]) if n else 0.0
    step = max(STEP, total / (MAX_LOOKS if max_places is None else max_places))
    positions = np.arange(step, total, step)
    # moving rows only, so both ends of their segments are known
    inner = np.searchsorted(travelled, positions, side="left")
    share = (positions - travelled[inner - 1]) / moved[inner]
    ends = np.flatnonzero(reachable & ~(goes_on & np.append(goes_on[1:], False)[:n]))
    row = np.concatenate([inner, ends])
    share = np.concatenate([share, np.ones(len(ends))])[:, None]
    sampled = np.where(
        share < 1.0, joints[row - 1] * (1.0 - share) + joints[row] * share, joints[row]
    )
    order = np.lexsort((share[:, 0], row))
    return sampled[order], row[order], step


# deg or mm; maximum distance to a limit that counts as near
NEAR_LIMIT_MARGIN = 0.5
# deg or mm; rounding error that is not a violation (programs have a margin of 0.05 deg)
_ROUNDING = 1e-6

UNREACHABLE, LIMIT, NEAR_LIMIT, SINGULAR, SLOWED, ISSUE = (
    "unreachable",
    "limit",
    "near limit",
    "singular",
    "slowed",
    "issue",
)
TOUCHES = "touches"


@dataclass(frozen=True)
class Finding:
    """A point of interest for a run of rows.

    row: first or worst row of the run. kind: one of the words above. label: the limit or axis, the
    message of an issue, or the axis that moves the link ('base' for the first) in contact with
    `other`. value, than: values at the run's worst row: margin in degrees or mm and 0; condition
    and threshold; or achieved and requested speed, mm/s.
    """

    row: int
    kind: str
    label: str = ""
    value: float = 0.0
    than: float = 0.0
    other: str = ""


@dataclass(frozen=True, eq=False)
class Watch:
    """The points of interest of a motion.

    margin: (n,) minimum margin to any limit, degrees or mm. limit: (n,) index of this limit in
    `Limits.labels`. condition, threshold: (n,), NaN if unknown. findings: points of interest in row
    order. touching: (n,) the link in contact, NONE without contact. arm_known: whether arm contacts
    were checked.
    """

    margin: Array
    limit: Index
    condition: Array
    threshold: Array
    findings: tuple[Finding, ...]
    touching: Integers
    arm_known: bool

    @cached_property
    def past(self) -> Mask:
        """Rows past a limit, (n,) bool."""
        with np.errstate(invalid="ignore"):
            past: Mask = self.margin < -_ROUNDING
        return past

    @cached_property
    def singular(self) -> Mask:
        """Rows nearer to a singularity than allowed, (n,) bool."""
        with np.errstate(invalid="ignore"):
            is_singular: Mask = self.condition < self.threshold * (1.0 - 1e-9)
        return is_singular


def shown_margins(cell: Cell, joints: ArrayLike) -> Array:
    """Return the distances of joints to every limit in display units.

    Parameters
    ----------
    cell : Cell
        The cell; its limits include those of coupled axes.
    joints : (..., axes) array_like
        Joint values, rad or mm.

    Returns
    -------
    (..., limits) array
        Distances in degrees, or mm for prismatic axes; negative past a limit.
    """
    units = cell.machine.unit_values
    coupled = np.full(len(cell.limits.labels) - len(units), np.radians(1.0))
    margins: Array = cell.limits.margin(joints) / np.concatenate([units, coupled])
    return margins


def bad_links(
    cell: Cell,
    margins: ArrayLike,
    ratios: ArrayLike,
    singular: bool,
    reachable: bool,
    touching: int = NONE,
) -> Mask:
    """Return the links to mark.

    A link is marked if its axis is near, at or past a limit, including coupled limits, if its axis
    would have to exceed its maximum speed, or if the link is in contact. All moving links are
    marked if the machine is near a singularity or cannot reach the point.

    Parameters
    ----------
    cell : Cell
        The cell.
    margins : (limits,) array_like
        Distances to limits, degrees or mm, from `shown_margins`.
    ratios : (axes,) array_like
        Requested axis speeds as fractions of the maximum speeds.
    singular : bool
        Whether the machine is near a singularity.
    reachable : bool
        Whether the machine reaches the point.
    touching : int, optional
        The link in contact, see `ArmTouches`.

    Returns
    -------
    (axes + 1,) array of bool
        Marks of the links, base first.
    """
    axes = len(cell.machine.axes)
    bad = np.zeros(axes + 1, dtype=bool)
    close = np.asarray(margins, float) < NEAR_LIMIT_MARGIN
    bad[1:] = close[:axes] | (np.asarray(ratios, float) > 1.0 + _ROUNDING)
    for coefficients in cell.limits.coefficients[close[axes:]]:
        bad[1:] |= coefficients != 0.0
    bad[1:] |= singular or not reachable
    if touching != NONE:  # contact of the load (part or nozzle) marks the carrier's link
        robot_axes = cell.robot.chain.axes
        if touching >= robot_axes + LINKS_MORE:
            bad[
                robot_axes + 1 + cell.shapes.external_links[touching - robot_axes - LINKS_MORE].axis
            ] = True
        else:
            on_positioner = touching == robot_axes + 1 and not cell.torch_stands
            bad[touching if touching <= robot_axes else -1 if on_positioner else robot_axes] = True
    return bad


def watch(
    motion: Motion,
    cell: Cell,
    feed: AchievableFeed,
    condition: Array,
    threshold: Array,
    issues: Sequence[Issue] = (),
    arm: ArmTouches | None = None,
) -> Watch:
    """Return the points of interest of a motion.

    Parameters
    ----------
    motion : Motion
        The motion, n rows.
    cell : Cell
        Limits and axes.
    feed : AchievableFeed
        The achievable feed.
    condition, threshold : (n,) array
        Inverse condition number and the minimum allowed; NaN if unknown.
    issues : sequence of Issue, optional
        Issues to list, except notes and issues without a layer.
    arm : ArmTouches, optional
        Contacts of the links; None if they were not checked.

    Returns
    -------
    Watch
        Margins of the rows, and findings in row order.
    """
    margins = shown_margins(cell, motion.joints)
    limit = np.argmin(np.where(np.isnan(margins), np.inf, margins), axis=1)
    margin = np.take_along_axis(margins, limit[:, None], axis=1)[:, 0]
    touching = np.full(len(motion), NONE, dtype=np.int64) if arm is None else arm.link
    watched = Watch(margin, limit, condition, threshold, (), touching, arm is not None)
    with np.errstate(invalid="ignore"):
        is_near = (margin < NEAR_LIMIT_MARGIN) & ~watched.past
    labels, axes = cell.limits.labels, cell.machine.axes
    findings = [
        Finding(row, UNREACHABLE) for row, _ in _runs(~motion.reachable, np.zeros(len(motion)))
    ]
    for kind, mask in (
        (LIMIT, watched.past),
        (NEAR_LIMIT, is_near),
    ):  # at the worst row, like the errors of planning
        findings += [
            Finding(worst, kind, labels[limit[worst]], float(margin[worst]))
            for _, worst in _runs(mask, margin)
        ]
    findings += [
        Finding(worst, SINGULAR, "", float(condition[worst]), float(threshold[worst]))
        for _, worst in _runs(watched.singular, condition)
    ]
    share = np.where(feed.slowed, feed.achieved / np.where(feed.asked > 0.0, feed.asked, 1.0), 1.0)
    findings += [
        Finding(
            row,
            SLOWED,
            axes[feed.axis[worst]],
            float(feed.achieved[worst]),
            float(feed.asked[worst]),
        )
        for row, worst in _runs(feed.slowed, share)
    ]
    if arm is not None:
        findings += _touching(arm)
    findings += [
        Finding(_row_of(motion, issue), ISSUE, issue.message)
        for issue in issues
        if issue.level != NOTE and issue.layer is not None
    ]
    findings.sort(key=lambda finding: finding.row)
    return replace(watched, findings=tuple(findings))


def _touching(arm: ArmTouches) -> list[Finding]:
    """Return a finding for every run of rows in which the same link touches the same body."""
    pair = np.where(arm.link == NONE, -1, arm.link * len(arm.names) + arm.what)
    starts = np.flatnonzero((pair != -1) & (np.diff(pair, prepend=-1) != 0))
    return [
        Finding(int(row), TOUCHES, arm.links[arm.link[row]], other=arm.names[arm.what[row]])
        for row in starts
    ]


def _runs(mask: Mask, values: Array) -> list[tuple[int, int]]:
    """Return, for every run of rows in the mask, the first row and the row of the minimum value."""
    starts = np.flatnonzero(mask & ~np.concatenate([[False], mask[:-1]]))
    ends = np.flatnonzero(mask & ~np.concatenate([mask[1:], [False]])) + 1
    return [
        (int(start), int(start + np.argmin(values[start:end]))) for start, end in zip(starts, ends)
    ]


def _row_of(motion: Motion, issue: Issue) -> int:
    """Return the deposit row of an issue, or else the first row of the layer."""
    layer = issue.layer or 0
    low, high = np.searchsorted(motion.layer, [layer, layer + 1])
    matches = np.ones(high - low, dtype=bool)
    for column, index in ((motion.bead, issue.bead), (motion.point, issue.point)):
        if index is not None:
            matches &= (column[low:high] == index) & motion.deposit[low:high]
    rows = np.flatnonzero(matches)
    return min(int(low + rows[0]) if len(rows) else int(low), len(motion) - 1)
