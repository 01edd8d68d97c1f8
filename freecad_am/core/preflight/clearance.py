# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the nozzle and the links of the arm keep clear of."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..issues import Issue, Text, Word, values_in
from ..kinematics.cell import Cell
from ..kinematics.links.contact import LINKS_MORE
from ..kinematics.links.external_links import titles_without_shape
from ..kinematics.links.rounds import NONE
from ..motion import Motion
from ..simulation.arm import ArmTouches
from ..simulation.rapid_look import RapidsLooked
from ..strategies.clearance.look import Looked
from .promise import Place, Promise, issue_place, number, row_place, select_issues

DEPOSITING = ("CLEARANCE", "OVER_PLATFORM")
ON_RAPIDS = "The nozzle stays clear on the rapids"
RAPIDS = ("RAPID_COLLISION", "RAPID_UNREACHABLE", "RAPID_LIMIT", "RAPID_SINGULAR")


def nozzle(issues: Sequence[Issue], nozzle_check: Looked | None) -> Promise:
    """Whether the nozzle keeps clear while depositing; not checked if the job asks for no clearance."""
    what = "The nozzle stays clear of deposit, part and platform while it deposits"
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
    """Whether the nozzle keeps clear on rapids."""
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
    """Whether the links keep clear. Links drawn from the kinematics only can neither keep the promise nor
    break it.
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
        Text("come nearer than {:g} mm to", cell.arm_clearance) if cell.arm_clearance else "touch"
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
    """Whether positioner and track keep clear; empty for a cell without external axes. Links of the robot
    that are drawn from the kinematics only can neither keep the promise nor break it.
    """
    if cell.external is None:
        return []
    what = "Positioner and track stay clear of nozzle, torch, robot and obstacles"
    names = [item.name for item in cell.external_links]
    lacking = ", ".join(titles_without_shape(cell.external, cell.external_links))
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
    ]  # those that count first
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
        "{} links that move with their axes, every {} deg of the whole motion, the nozzle every mm: they touch {}",
        len(names),
        step,
        Word(met),
    )
    if not is_complete:
        lacks = missing or "links of the robot are drawn from the kinematics"
        how = Text(
            "not checked in full, for {}: {} links that move with their axes, every {} deg of the whole motion, the "
            "nozzle every mm; they touch {}",
            lacks,
            len(names),
            step,
            Word(met),
        )
    ok = False if broken else True if is_complete else None
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
