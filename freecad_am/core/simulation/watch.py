# SPDX-License-Identifier: LGPL-2.1-or-later
"""Points of interest in a motion: rows beyond or near a limit or a singularity, robot contacts, and
speed losses.
"""

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

# a sample each time the fastest joint has turned by STEP rad or moved by SLIDE mm, at this number of
# samples at most: longer motions have fewer samples a turn
STEP, SLIDE, MAX_LOOKS = float(np.radians(1.0)), 10.0, 40_000


@dataclass(frozen=True, eq=False)
class ArmTouches:
    """Contacts of links in a motion of n rows.

    link: (n,) the link in contact at the row or on the segment that ends there, NONE without one.
    Its values are indices in `links`. what: (n,) index in `names` of the body in contact.
    step: rad between two checked positions.
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
        Width of beads where the motion does not state it, mm.
    height : float
        Height of beads, mm.

    Returns
    -------
    Obstacles or None
        The deposit in the part; None without any.
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
        Number of positions to check; by default MAX_LOOKS.

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
    """Return which axes of a cell belong to a track.

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

    Samples are at even steps of the joint that moves most, SLIDE of the `sliding`
    axes counting as STEP, and at both ends of every run of rows with joint values, even of a single
    row; the unknown moves between two runs have none.

    Parameters
    ----------
    joints : (n, axes) array
        Joint values of the rows, rad or mm; NaN if unreachable.
    max_places : int, optional
        Number of steps; by default MAX_LOOKS.
    sliding : (axes,) array of bool, optional
        Axes in mm that count by SLIDE.

    Returns
    -------
    joints : (k, axes) array
        Joint values of the samples, rad or mm.
    rows : (k,) array of int
        Rows at which their segments end, rising.
    step : float
        Step between samples, rad, at least STEP.
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
    # moving rows only, so that both of their ends are known
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


# deg or mm; a smaller distance to a limit counts as near
NEAR_LIMIT_MARGIN = 0.5
# programs keep 0.05 deg; what rounding leaves is not a violation, degrees or mm
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
    """A point of interest at a row, the first of a run of rows.

    kind: one of the words above. label: the limit or axis, or an issue's message, or the axis that
    moves the link ('base' for the first) in contact with `other`. value, than: worst margin in
    degrees or mm and 0; condition and its threshold; achieved and requested speeds, mm/s, of the
    run's worst row.
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

    margin: (n,) the smallest margin to any limit, in degrees or mm; limit: its index in
    `Limits.labels`. condition, threshold: (n,), NaN if unknown. findings: in the order of rows.
    touching: (n,) the link in contact, NONE without one; arm_known: whether arm contacts were
    checked.
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
        """(n,) rows past a limit."""
        with np.errstate(invalid="ignore"):
            past: Mask = self.margin < -_ROUNDING
        return past

    @cached_property
    def singular(self) -> Mask:
        """(n,) rows nearer to a singularity than is allowed."""
        with np.errstate(invalid="ignore"):
            is_singular: Mask = self.condition < self.threshold * (1.0 - 1e-9)
        return is_singular


def shown_margins(cell: Cell, joints: ArrayLike) -> Array:
    """Return the distances of joints to every limit in the units they are shown in.

    Parameters
    ----------
    cell : Cell
        The cell; its limits include those of coupled axes.
    joints : (..., axes) array_like
        Joint values, rad or mm.

    Returns
    -------
    (..., limits) array
        Degrees, or mm of prismatic axes; negative past a limit.
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

    A link is marked if its axis is at, past or near a limit, or asked to exceed its maximum speed,
    if a coupled limit of it is near, or if it touches something. All moving links are if the
    machine is near a singularity or does not reach.

    Parameters
    ----------
    cell : Cell
        The cell.
    margins : (limits,) array_like
        Distances to limits, degrees or mm, as by `shown_margins`.
    ratios : (axes,) array_like
        Requested shares of the maximum speeds.
    singular : bool
        Whether the machine is near a singularity.
    reachable : bool
        Whether it reaches the point.
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
    if touching != NONE:  # the load, part or nozzle, counts as its carrier
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
        The speeds that the machine can keep.
    condition, threshold : (n,) array
        Inverse condition number and the least one allowed; NaN if unknown.
    issues : sequence of Issue, optional
        Issues to list; notes and issues without a layer are not findings.
    arm : ArmTouches, optional
        Contacts of the links; None if they were not checked.

    Returns
    -------
    Watch
        Margins of the rows, and findings in their order.
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
    ):  # where it is worst, as errors of the plan say
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
    """A finding for every run of rows on which one link touches one thing."""
    pair = np.where(arm.link == NONE, -1, arm.link * len(arm.names) + arm.what)
    starts = np.flatnonzero((pair != -1) & (np.diff(pair, prepend=-1) != 0))
    return [
        Finding(int(row), TOUCHES, arm.links[arm.link[row]], other=arm.names[arm.what[row]])
        for row in starts
    ]


def _runs(mask: Mask, values: Array) -> list[tuple[int, int]]:
    """First row, and row of the smallest value, of every run of rows in which the mask holds."""
    starts = np.flatnonzero(mask & ~np.concatenate([[False], mask[:-1]]))
    ends = np.flatnonzero(mask & ~np.concatenate([mask[1:], [False]])) + 1
    return [
        (int(start), int(start + np.argmin(values[start:end]))) for start, end in zip(starts, ends)
    ]


def _row_of(motion: Motion, issue: Issue) -> int:
    """The deposit row an issue is about, or the first row of its layer."""
    layer = issue.layer or 0
    low, high = np.searchsorted(motion.layer, [layer, layer + 1])
    matches = np.ones(high - low, dtype=bool)
    for column, index in ((motion.bead, issue.bead), (motion.point, issue.point)):
        if index is not None:
            matches &= (column[low:high] == index) & motion.deposit[low:high]
    rows = np.flatnonzero(matches)
    return min(int(low + rows[0]) if len(rows) else int(low), len(motion) - 1)
