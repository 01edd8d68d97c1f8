# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the links of a robot touch in a document, with the shapes that were attached to them, on a whole motion, between its
points too; and what comes of `cell.arm_clearance`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.issues import Issue
from ...core.kinematics.cell import Cell
from ...core.kinematics.links import cylinders as link_cylinders
from ...core.kinematics.links.contact import ArmContact
from ...core.kinematics.links.cylinders import Mesh
from ...core.kinematics.links.rounds import NONE
from ...core.motion import Motion
from ...core.parameters.process import ProcessParameters
from ...core.planning.arm import kept as arm_kept
from ...core.simulation.arm import ArmTouches, arm_touches, deposit_obstacles
from ...core.toolpath import Toolpath
from ..shapes.link_meshes import meshes_of


def cylinders_of(cell: Cell) -> arm_kept.Cylinders:
    """The rods of each link of the robot; none of machines with rotary axes, of whose links no file tells enough."""
    known = cell.arrangement.links_known
    return link_cylinders.of_robot(cell.robot.chain, meshes_of(cell.machine)) if known else ()


def arm_of(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    shapes: tuple[Mesh | None, ...],
    most: int | None = None,
    clearance: float = 0.0,
) -> ArmTouches | None:
    """What the links of a robot touch, or come nearer to than `clearance` mm, looked at in so many places at most; None for
    machines with rotary axes, of whose links no file tells enough."""
    if not cell.arrangement.links_known:
        return None
    return _touches(
        motion,
        cell,
        toolpath,
        process,
        link_cylinders.of_robot(cell.robot.chain, shapes),
        most,
        clearance,
    )


def _touches(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    cylinders: arm_kept.Cylinders,
    most: int | None,
    clearance: float,
) -> ArmTouches:
    deposited = deposit_obstacles(
        motion, toolpath.bead_width or process.bead_width, toolpath.layer_height
    )
    return arm_touches(
        motion, ArmContact(cell, cylinders, toolpath.surroundings, deposited, clearance), most
    )


def arm_issues(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    cylinders: arm_kept.Cylinders,
    known: Sequence[Issue],
) -> tuple[Issue, ...]:
    """An error for each bead that nothing known is told of, on which or on the way to which one of the links, which are
    these cylinders, comes too near."""
    assert cell.arm_clearance is not None
    touches = _touches(motion, cell, toolpath, process, cylinders, None, cell.arm_clearance)
    done = {(issue.layer, issue.bead) for issue in known if issue.code == arm_kept.CODE}
    found = []
    for row in np.flatnonzero(touches.link != NONE).tolist():
        place = int(motion.layer[row]), int(motion.bead[row])
        if place not in done:
            done.add(place)
            what = touches.names[touches.what[row]]
            link = touches.links[touches.link[row]]
            found.append(
                arm_kept.clearance_issue(cell, link, what, *place, on_way=not motion.deposit[row])
            )
    return tuple(found)
