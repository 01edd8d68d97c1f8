# SPDX-License-Identifier: LGPL-2.1-or-later
"""Clearance checks of the nozzle and the arm links."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..issues import Issue, Text, Word, values_in
from ..kinematics.cell import Cell
from ..kinematics.links.contact import LINKS_MORE
from ..kinematics.links.external_links import titles_without_shape
from ..kinematics.links.self_collision import NONE
from ..motion import Motion
from ..simulation.achievable_feed import speed_ratios
from ..simulation.rapid_contacts import RapidsLooked
from ..simulation.watch import ArmTouches, shown_margins
from ..strategies.clearance.nozzle_check import Looked
from ..types import Array
from .promise import PERCENT, Place, Promise, issue_place, number, row_place, select_issues

ROUNDING = 1e-7  # tolerance for rounding: deg or mm beyond a limit, or fraction of a speed
COMPUTED_MM = 1e-6  # mm; maximum difference between two computations of the same pose


def promises(
    motion: Motion, cell: Cell, condition: Array, threshold: Array, digits: float = 0.0
) -> list[Promise]:
    """Return the promises about the joints of a motion: limits, reach, speeds and singularities.

    Parameters
    ----------
    motion : Motion
        The motion, n rows.
    cell : Cell
        The cell.
    condition, threshold : (n,) array
        Inverse condition number and its required minimum; NaN if unknown.
    digits : float, optional
        Speed that rounded numbers of a text may add, % of the maximum speed of an axis.

    Returns
    -------
    list of Promise
        Four promises.
    """
    return [
        _limits(motion, cell),
        _reach(motion, cell),
        _speeds(motion, cell, PERCENT + digits),
        _singularities(motion, condition, threshold),
    ]


def _limits(motion: Motion, cell: Cell) -> Promise:
    what = "Every axis stays within its limits"
    how = "each point of the motion, rapids included, compared with the limits in the machine file"
    margins = shown_margins(cell, motion.joints)
    if not np.isfinite(margins).any():
        return Promise(what, "no axis has limits, or no point is reachable", None)
    row, limit = np.unravel_index(int(np.nanargmin(margins)), margins.shape)
    worst = float(margins[row, limit])
    units = cell.machine.units
    return Promise(
        what,
        how,
        bool(worst >= -ROUNDING),
        worst,
        units[limit] if limit < len(units) else "deg",
        0.0,
        row_place(motion, int(row)),
        at_least=True,
        row=int(row),
    )


def _reach(motion: Motion, cell: Cell) -> Promise:
    what = "The joint values reach every planned point"
    unreachable = np.flatnonzero(~motion.reachable)
    if len(unreachable):
        location = row_place(motion, int(unreachable[0]))
        return Promise(
            what,
            "closed-form inverse",
            False,
            float(len(unreachable)),
            "points",
            0.0,
            location,
            row=int(unreachable[0]),
        )
    deposited = np.flatnonzero(motion.deposit)
    distances = np.linalg.norm(
        cell.tip_at(motion.joints[deposited]) - motion.position[deposited], axis=1
    )
    row = int(deposited[int(distances.argmax())])
    how = "planned joint values of the deposit, converted to poses by the joint-frame chain, which planning does not use"
    worst = float(distances.max())
    return Promise(
        what, how, worst <= COMPUTED_MM, worst, "mm", COMPUTED_MM, row_place(motion, row), row=row
    )


def _speeds(motion: Motion, cell: Cell, max_percent: float) -> Promise:
    what = "No axis exceeds its maximum speed"
    if not np.isfinite(cell.machine.max_speed).any():
        return Promise(what, "the machine file has no maximum speeds", None)
    ratios = speed_ratios(motion.joints, motion.duration, cell.machine.max_speed).max(axis=1)
    if not np.isfinite(ratios).any():
        return Promise(what, "no point is reachable", None)
    row = int(np.nanargmax(ratios))
    worst = PERCENT * float(ratios[row])
    how = "mean speed of each axis on each move, rapids included, compared with the machine file"
    return Promise(
        what,
        how,
        bool(worst <= max_percent * (1.0 + ROUNDING)),
        worst,
        "%",
        max_percent,
        row_place(motion, row),
        row=row,
    )


def _singularities(motion: Motion, condition: Array, threshold: Array) -> Promise:
    what = "The tool stays away from singularities while depositing"
    is_known = np.isfinite(condition) & np.isfinite(threshold)
    if not is_known.any():
        return Promise(what, "not checked: machines of this kind have no condition number", None)
    spare = np.where(is_known, condition - threshold, np.inf)
    row = int(spare.argmin())
    how = "inverse condition number of the Jacobian at the deposit points, compared with the required minimum"
    return Promise(
        what,
        how,
        bool(spare[row] >= -ROUNDING),
        float(condition[row]),
        "",
        float(threshold[row]),
        row_place(motion, row),
        at_least=True,
        row=row,
    )


DEPOSITING = ("CLEARANCE", "OVER_PLATFORM")
ON_RAPIDS = "The nozzle stays clear on rapids"
RAPIDS = ("RAPID_COLLISION", "RAPID_UNREACHABLE", "RAPID_LIMIT", "RAPID_SINGULAR")


def nozzle(issues: Sequence[Issue], nozzle_check: Looked | None) -> Promise:
    """Return the promise that the nozzle stays clear while depositing; not checked if the job
    requests no clearance.
    """
    what = "The nozzle stays clear of deposit, part and platform while depositing"
    if nozzle_check is None:
        return Promise(what, "not checked: build_direction.clearance is none", None)
    collisions = select_issues(issues, DEPOSITING)
    how = Text(
        "nozzle cone at {} points, against platform, part and the deposit at that time, with "
        "nominal bead width and height",
        nozzle_check.count,
    )
    location = (
        issue_place(collisions)
        if collisions or nozzle_check.first_touch is None
        else Place(*nozzle_check.first_touch)
    )
    return Promise(
        what,
        how,
        not collisions and not nozzle_check.touched,
        float(nozzle_check.touched),
        "points",
        0.0,
        location,
    )


def rapids(issues: Sequence[Issue], rapids_check: RapidsLooked) -> Promise:
    """Return the promise that the nozzle stays clear on rapids."""
    collisions = select_issues(issues, RAPIDS)
    how = Text(
        "retracts, travels and approaches simulated again, at {} places {} mm apart, against "
        "obstacles, platform and beads with their width and height at that time",
        rapids_check.places,
        number(rapids_check.step),
    )
    location = issue_place(collisions) if rapids_check.place is None else Place(*rapids_check.place)
    return Promise(
        ON_RAPIDS,
        how,
        not collisions and not len(rapids_check.rows),
        float(len(rapids_check.rows)),
        "rapids",
        0.0,
        location,
    )


def arm(motion: Motion, cell: Cell, touches: ArmTouches | None, true_shapes: bool) -> Promise:
    """Return the promise that the arm links stay clear.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell, including the arm clearance.
    touches : ArmTouches or None
        Contacts; None if not checked.
    true_shapes : bool
        Whether the shapes are the manufacturer's. Links drawn from the kinematics leave the
        promise unchecked.

    Returns
    -------
    Promise
        With the number of motion points in contact.
    """
    what = "The arm stays clear of part, deposit, platform, nozzle and itself"
    if touches is None:
        return Promise(what, "not checked: the machine file gives no shapes for its links", None)
    rows, met = np.flatnonzero(touches.link != NONE), "nothing"
    location: Place | None = None
    if len(rows):
        location = row_place(motion, int(rows[0]))
        link, obstacle = touches.link[rows[0]], touches.names[touches.what[rows[0]]]
        met = Text("{} with {}", obstacle, touches.links[link])
    step = number(math.degrees(touches.step))
    contact_verb = (
        Text("come closer than {:g} mm to", cell.arm_clearance) if cell.arm_clearance else "touch"
    )
    if not true_shapes:
        how = Text(
            "not checked: without the manufacturer's shapes, links drawn from the kinematics {} {}, checked every "
            "{} deg",
            Word(contact_verb),
            Word(met),
            step,
        )
        return Promise(what, how, None, float(len(rows)), "points", None, location)
    how = Text(
        "shapes of all links, also against each other, every {} deg of the whole motion: they {} "
        "{}",
        step,
        Word(contact_verb),
        Word(met),
    )
    return Promise(what, how, not len(rows), float(len(rows)), "points", 0.0, location)


def external_links(
    motion: Motion,
    cell: Cell,
    touches: ArmTouches | None,
    true_shapes: bool,
    issues: Sequence[Issue],
) -> list[Promise]:
    """Return the promise that positioner and track stay clear.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell.
    touches : ArmTouches or None
        Contacts; None if not checked.
    true_shapes : bool
        Whether the robot shapes are the manufacturer's. Links drawn from the kinematics leave
        the promise unchecked.
    issues : sequence of Issue
        Issues of the plan; nozzle contacts with positioner or track break the promise.

    Returns
    -------
    list of Promise
        One promise; empty for a cell without external axes.
    """
    if cell.external is None:
        return []
    what = "Positioner and track stay clear of nozzle, torch, robot and obstacles"
    names = [item.name for item in cell.shapes.external_links]
    lacking = ", ".join(titles_without_shape(cell.external, cell.shapes.external_links))
    missing = Text("no file describes the shape of {}", lacking) if lacking else ""
    if touches is None or not names:
        return [
            Promise(what, Text("not checked: no file describes the shape of {}", lacking), None)
        ]
    robot_axes = cell.robot.chain.axes
    about = np.isin(touches.what, [touches.names.index(name) for name in names]) | (
        touches.link >= robot_axes + LINKS_MORE
    )
    rows = np.flatnonzero((touches.link != NONE) & about)
    rows = rows[
        np.argsort((touches.link[rows] <= robot_axes) & (not true_shapes), kind="stable")
    ]  # contacts that break the promise first
    met, location = "nothing", None
    if len(rows):
        location = row_place(motion, int(rows[0]))
        met = Text(
            "{} with {}", touches.names[touches.what[rows[0]]], touches.links[touches.link[rows[0]]]
        )
    text = [
        item
        for item in select_issues(issues, (*DEPOSITING, *RAPIDS))
        if not {*names}.isdisjoint(values_in(item.message))
    ]
    broken = bool(text) or bool(len(rows) and (true_shapes or touches.link[rows[0]] > robot_axes))
    is_complete = true_shapes and not lacking
    step = number(math.degrees(touches.step))
    how = Text(
        "{} moving links, checked every {} deg of the whole motion, and the nozzle every mm: "
        "they touch {}",
        len(names),
        step,
        Word(met),
    )
    if not is_complete:
        lacks = missing or "the links of the robot are drawn from the kinematics only"
        how = Text(
            "not checked in full, because {}: {} moving links, checked every {} deg of the whole "
            "motion, and the nozzle every mm; they touch {}",
            lacks,
            len(names),
            step,
            Word(met),
        )
    ok = None
    if broken or is_complete:
        ok = not broken
    return [
        Promise(
            what,
            how,
            ok,
            float(len(rows)),
            "points",
            0.0 if is_complete else None,
            issue_place(text) or location,
        )
    ]
