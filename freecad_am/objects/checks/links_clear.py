# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the links of a robot touch in a document, with the shapes attached to them, on a whole
motion, between its points too; and the result of `cell.arm_clearance`.
"""

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
    """The capsules of each link of the robot; empty for machines with rotary axes, whose links no
    file describes well enough.
    """
    has_links = cell.arrangement.links_known
    return (
        link_cylinders.robot_cylinders(cell.robot.chain, meshes_of(cell.machine))
        if has_links
        else ()
    )


def arm_of(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    shapes: tuple[Mesh | None, ...],
    max_positions: int | None = None,
    clearance: float = 0.0,
) -> ArmTouches | None:
    """What the links of a robot touch, or come nearer to than `clearance` mm, checked at up to
    `max_positions` positions; None for machines with rotary axes, whose links no file describes
    well enough.
    """
    if not cell.arrangement.links_known:
        return None
    return _touches(
        motion,
        cell,
        toolpath,
        process,
        link_cylinders.robot_cylinders(cell.robot.chain, shapes),
        max_positions,
        clearance,
    )


def _touches(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    cylinders: arm_kept.Cylinders,
    max_positions: int | None,
    clearance: float,
) -> ArmTouches:
    deposited = deposit_obstacles(
        motion, toolpath.bead_width or process.bead_width, toolpath.layer_height
    )
    return arm_touches(
        motion,
        ArmContact(cell, cylinders, toolpath.surroundings, deposited, clearance),
        max_positions,
    )


def arm_issues(
    motion: Motion,
    cell: Cell,
    toolpath: Toolpath,
    process: ProcessParameters,
    cylinders: arm_kept.Cylinders,
    known_issues: Sequence[Issue],
) -> tuple[Issue, ...]:
    """An error for each bead without a known issue on which, or on the way to which, a link (given
    as cylinders) comes too near.
    """
    assert cell.arm_clearance is not None
    touches = _touches(motion, cell, toolpath, process, cylinders, None, cell.arm_clearance)
    reported = {(issue.layer, issue.bead) for issue in known_issues if issue.code == arm_kept.CODE}
    issues = []
    for row in np.flatnonzero(touches.link != NONE).tolist():
        location = int(motion.layer[row]), int(motion.bead[row])
        if location not in reported:
            reported.add(location)
            what = touches.names[touches.what[row]]
            link = touches.links[touches.link[row]]
            issues.append(
                arm_kept.clearance_issue(
                    cell, link, what, *location, on_way=not motion.deposit[row]
                )
            )
    return tuple(issues)
