# SPDX-License-Identifier: LGPL-2.1-or-later
"""What comes of `cell.arm_clearance` in a document: the links with the shapes that were attached to them, and the whole
motion looked at once more, between its points too."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.issues import Issue
from ..core.kinematics import link_rods
from ..core.kinematics.arm_contact import NONE, ArmContact
from ..core.kinematics.cell import Cell
from ..core.motion import Motion
from ..core.parameters.process import ProcessParameters
from ..core.planning import arm_kept
from ..core.simulation.arm import arm_touches, laid
from ..core.toolpath import Toolpath
from .link_meshes import meshes_of


def rods_of(cell: Cell) -> arm_kept.Rods:
    """The rods of each link of the robot; none of machines with rotary axes, of whose links no file tells enough."""
    return () if cell.machine.is_table else link_rods.of_robot(cell.robot.chain, meshes_of(cell.machine))


def arm_issues(
    motion: Motion, cell: Cell, toolpath: Toolpath, process: ProcessParameters, rods: arm_kept.Rods, known: Sequence[Issue]
) -> tuple[Issue, ...]:
    """An error for each bead that nothing known is told of, on which or on the way to which a link comes too near."""
    assert cell.arm_clearance is not None
    deposited = laid(motion, toolpath.bead_width or process.bead_width, toolpath.layer_height)
    contact = ArmContact(cell, rods, toolpath.surroundings, deposited, cell.arm_clearance)
    touches = arm_touches(motion, contact)
    done = {(issue.layer, issue.bead) for issue in known if issue.code == arm_kept.CODE}
    found = []
    for row in np.flatnonzero(touches.link != NONE).tolist():
        place = int(motion.layer[row]), int(motion.bead[row])
        if place not in done:
            done.add(place)
            found.append(arm_kept.told(
                contact, int(touches.link[row]), int(touches.what[row]), *place, on_way=not motion.deposit[row]
            ))
    return tuple(found)
