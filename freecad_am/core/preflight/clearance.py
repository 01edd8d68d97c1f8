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
from .promise import Place, Promise, issue_place, number, of_codes, row_place

DEPOSITING = ("CLEARANCE", "OVER_PLATFORM")
ON_RAPIDS = "The nozzle stays clear on the rapids"
RAPIDS = ("RAPID_COLLISION", "RAPID_UNREACHABLE", "RAPID_LIMIT", "RAPID_SINGULAR")


def nozzle(issues: Sequence[Issue], looked: Looked | None) -> Promise:
    """While depositing; None where the job asks for no clearance."""
    what = "The nozzle stays clear of deposit, part and platform while it deposits"
    if looked is None:
        return Promise(what, "not checked: build_direction.clearance is none", None)
    found = of_codes(issues, DEPOSITING)
    how = Text(
        "the nozzle as a cone at {} points, against platform, part and what is deposited by then; beads as wide and "
        "high as they count",
        looked.count,
    )
    place = (
        issue_place(found) if found or looked.first_touch is None else Place(*looked.first_touch)
    )
    return Promise(
        what, how, not found and not looked.touched, float(looked.touched), "points", 0.0, place
    )


def rapids(issues: Sequence[Issue], looked: RapidsLooked) -> Promise:
    """On the way between beads."""
    found = of_codes(issues, RAPIDS)
    how = Text(
        "retracts, travels and approaches driven again, at {} places {} mm apart, against bodies, platform and beads "
        "as wide and high as they are by then",
        looked.places,
        number(looked.step),
    )
    place = issue_place(found) if looked.place is None else Place(*looked.place)
    return Promise(
        ON_RAPIDS,
        how,
        not found and not len(looked.rows),
        float(len(looked.rows)),
        "rapids",
        0.0,
        place,
    )


def arm(motion: Motion, cell: Cell, touches: ArmTouches | None, true_shapes: bool) -> Promise:
    """Of the links. Plain ones, drawn from the kinematics alone, can neither keep the promise nor break it."""
    what = "The arm stays clear of part, deposit, platform, nozzle and itself"
    if touches is None:
        return Promise(what, "not checked: the machine file gives no shapes for its links", None)
    rows, met = np.flatnonzero(touches.link != NONE), "nothing"
    place: Place | None = None
    if len(rows):
        place = row_place(motion, int(rows[0]))
        link, other = touches.link[rows[0]], touches.names[touches.what[rows[0]]]
        met = Text("{} with {}", other, touches.links[link])
    step = number(math.degrees(touches.step))
    near = (
        Text("come nearer than {:g} mm to", cell.arm_clearance) if cell.arm_clearance else "touch"
    )
    if not true_shapes:
        how = Text(
            "not checked: without the manufacturer's shapes, links drawn from the kinematics {} {}, checked every "
            "{} deg",
            Word(near),
            Word(met),
            step,
        )
        return Promise(what, how, None, float(len(rows)), "points", None, place)
    how = Text(
        "shapes of all links, against each other too, every {} deg of the whole motion: they {} {}",
        step,
        Word(near),
        Word(met),
    )
    return Promise(what, how, not len(rows), float(len(rows)), "points", 0.0, place)


def external_links(
    motion: Motion,
    cell: Cell,
    touches: ArmTouches | None,
    true_shapes: bool,
    issues: Sequence[Issue],
) -> list[Promise]:
    """Of positioner and track; nothing of a cell without external axes. Links of the robot that are drawn from the
    kinematics alone can neither keep the promise nor break it."""
    if cell.external is None:
        return []
    what = "Positioner and track stay clear of nozzle, torch, robot and obstacles"
    names = [one.name for one in cell.external_links]
    lacking = ", ".join(titles_without_shape(cell.external, cell.external_links))
    missing = Text("no file says what {} is made of", lacking) if lacking else ""
    if touches is None or not names:
        return [Promise(what, Text("not checked: no file says what {} is made of", lacking), None)]
    own = cell.robot.chain.axes
    about = np.isin(touches.what, [touches.names.index(name) for name in names]) | (
        touches.link >= own + LINKS_MORE
    )
    rows = np.flatnonzero((touches.link != NONE) & about)
    rows = rows[
        np.argsort((touches.link[rows] <= own) & (not true_shapes), kind="stable")
    ]  # those that count first
    met, place = "nothing", None
    if len(rows):
        place = row_place(motion, int(rows[0]))
        met = Text(
            "{} with {}", touches.names[touches.what[rows[0]]], touches.links[touches.link[rows[0]]]
        )
    text = [
        one
        for one in of_codes(issues, (*DEPOSITING, *RAPIDS))
        if not {*names}.isdisjoint(values_in(one.message))
    ]
    broken = bool(text) or bool(len(rows) and (true_shapes or touches.link[rows[0]] > own))
    whole = true_shapes and not lacking
    step = number(math.degrees(touches.step))
    how = Text(
        "{} links that move with their axes, every {} deg of the whole motion, the nozzle every mm: they touch {}",
        len(names),
        step,
        Word(met),
    )
    if not whole:
        lacks = missing or "links of the robot are drawn from the kinematics"
        how = Text(
            "not checked in full, for {}: {} links that move with their axes, every {} deg of the whole motion, the "
            "nozzle every mm; they touch {}",
            lacks,
            len(names),
            step,
            Word(met),
        )
    ok = False if broken else True if whole else None
    return [
        Promise(
            what,
            how,
            ok,
            float(len(rows)),
            "points",
            0.0 if whole else None,
            issue_place(text) or place,
        )
    ]
