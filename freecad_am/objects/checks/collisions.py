# SPDX-License-Identifier: LGPL-2.1-or-later
"""Collisions of the arm and the platform, and axis margins, of a planned job.

Every joint path is checked, whether or not planning kept clearances.
"""

from __future__ import annotations

import numpy as np

from ...core.collision.bead_ends import LINK_GRAIN, Beads
from ...core.issues import ERROR, NOTE, WARNING, Issue, Text
from ...core.kinematics.cell import Cell
from ...core.kinematics.links import external_links
from ...core.kinematics.links.collisions import (
    Collision,
    arm_collisions,
    platform_collisions,
)
from ...core.motion import Motion
from ...core.parameters.process import ProcessParameters
from ...core.planning.joint_path import JointPath
from ...core.simulation.watch import deposit_obstacles, places, shown_margins, tracks_of
from ...core.toolpath import Toolpath
from ...core.types import Index
from ..shapes.cell_obstacles import meshes_of

ARM_COLLISION, PLATFORM_COLLISION, ARM_NEAR, LOW_MARGIN = (
    "ARM_COLLISION",
    "PLATFORM_COLLISION",
    "ARM_NEAR",
    "LOW_MARGIN",
)
ROUNDING = 1e-6  # deg or mm
LEAST_MARGIN = 0.5  # deg or mm; smaller margins to limits are reported, and marked in Simulate


def collision_issues(
    motion: Motion, cell: Cell, toolpath: Toolpath, process: ProcessParameters
) -> list[Issue]:
    """Return issues on collisions of the arm over the whole motion, and of the platform.

    Collisions of links whose shape is only derived from the kinematics are warnings and notes.
    Empty for machines whose links are not described well enough.
    """
    if not cell.arrangement.links_known:
        return []
    width = toolpath.bead_width or process.bead_width
    deposit = deposit_obstacles(motion, width, toolpath.layer_height)
    issues = in_platform(cell, toolpath, WARNING)
    joints, row, _ = places(motion.joints, None, tracks_of(cell))
    deposited_before = np.cumsum(motion.deposit) - motion.deposit
    shapes = meshes_of(cell.machine)
    collisions = arm_collisions(
        cell,
        external_links.robot_cylinders(cell.robot.chain, shapes),
        toolpath.surroundings,
        deposit,
        joints,
        deposited_before[row],
        [shape is not None for shape in shapes],
    )
    return [
        *issues,
        *(
            _arm_issue(collision, motion, row[collision.rows], len(joints))
            for collision in collisions
        ),
    ]


def look(path: JointPath, cell: Cell, toolpath: Toolpath) -> list[Issue]:
    """Return the collisions of a joint path at the points of its beads.

    The joint path may cover only some layers of the toolpath.
    """
    if not cell.arrangement.links_known:
        return []
    platform_issues = in_platform(cell, toolpath)
    if platform_issues:
        return platform_issues
    beads = [bead for _, _, bead in toolpath]
    width = toolpath.bead_width or toolpath.layer_height
    deposit = Beads.of(beads, width, toolpath.layer_height).solid(LINK_GRAIN)
    counts = np.cumsum([0, *(len(bead) for bead in beads)])
    start_index = {
        (layer, index): int(n) for (layer, index, _), n in zip(toolpath, counts, strict=False)
    }
    moment = [
        start_index.get((entry.layer, entry.index), start_index[entry.layer, 0])
        for entry in path.beads
    ]
    shapes = meshes_of(cell.machine)
    collisions = arm_collisions(
        cell,
        external_links.robot_cylinders(cell.robot.chain, shapes),
        toolpath.surroundings,
        deposit,
        path.joints,
        np.repeat(moment, [len(entry.joints) for entry in path.beads]),
        [shape is not None for shape in shapes],
    )
    return [
        Issue(ERROR, ARM_COLLISION, Text("{} with {}", entry.what, entry.link))
        for entry in collisions
        if entry.sure
    ]


def in_platform(cell: Cell, toolpath: Toolpath, level: str = ERROR) -> list[Issue]:
    """Return the issues on substrate and fixtures that reach into the platform.

    The default plate size is a guess and does not affect programs. So these issues are warnings in
    a planned job, but a proposed cell must not have any.
    """
    collisions = platform_collisions(cell, toolpath.surroundings)
    return [_platform_issue(cell, collision, level) for collision in collisions]


def _platform_issue(cell: Cell, collision: Collision, level: str) -> Issue:
    return Issue(
        level,
        PLATFORM_COLLISION,
        Text(
            "{} extends into the platform, a plate {:.4g} mm below the origin of the platform "
            "frame; set cell.platform to the real clamping position and cell.platform_diameter "
            "to the real size (0 for none)",
            collision.what,
            cell.platform_diameter,
        ),
    )


def _arm_issue(collision: Collision, motion: Motion, rows: Index, sample_count: int) -> Issue:
    """Return the issue on a colliding link, located at the first colliding motion row."""
    row = int(rows[0])
    share = 100.0 * len(rows) / max(sample_count, 1)
    location = {
        "layer": int(motion.layer[row]),
        "bead": int(motion.bead[row]),
        "point": int(motion.point[row]),
    }
    x, y, z = (float(value) for value in motion.position[row])
    where = Text("({:.4g}, {:.4g}, {:.4g})", x, y, z)
    if collision.sure:
        return Issue(
            ERROR,
            ARM_COLLISION,
            Text(
                "link {} of the arm is inside {} on {:.3g} % of the motion, first with the nozzle at {}; move "
                "cell.platform or cell.deposition_point, choose another cell.branch, or set cell.arm_clearance",
                collision.link,
                collision.what,
                share,
                where,
            ),
            **location,
        )
    if collision.deep:
        return Issue(
            WARNING,
            ARM_NEAR,
            Text(
                "link {} of the arm, as drawn, has {} within half its radius on {:.3g} % of the "
                "motion, first with the nozzle at {}, and collides unless the robot is slimmer "
                "or hollow there; check the motion in Simulate, give the links the shapes of the "
                "manufacturer, or set cell.arm_clearance",
                collision.link,
                collision.what,
                share,
                where,
            ),
            **location,
        )
    return Issue(
        NOTE,
        ARM_NEAR,
        Text(
            "link {} of the arm, as drawn, touches {} on {:.3g} % of the motion, first with the "
            "nozzle at {}, although the inner half of its radius stays clear; check the motion "
            "in Simulate, or set cell.arm_clearance",
            collision.link,
            collision.what,
            share,
            where,
        ),
        **location,
    )


def margin_issues(motion: Motion, cell: Cell) -> list[Issue]:
    """Return an issue for each axis with a margin below LEAST_MARGIN, at the smallest margin.

    Issues are warnings, but notes for the last robot axis, because plans often use its full range
    for the tool rotation.
    """
    margins = shown_margins(cell, motion.joints)
    is_known = np.isfinite(margins)
    if not is_known.any():
        return []
    rows = np.argmin(np.where(is_known, margins, np.inf), axis=0)
    units, labels = cell.machine.units, cell.limits.labels
    last_axis = cell.robot.chain.axes - 1 if cell.machine.free else -1
    issues = []
    for limit, row in enumerate(rows.tolist()):
        margin = float(margins[row, limit])
        if not -ROUNDING <= margin < LEAST_MARGIN:
            continue
        share = float(cell.limits.shares(motion.joints[row][None])[0, limit])
        text = Text(
            "{} comes within {:.3g} {} of its limit, {:.1f} % of half its range; move the part, or choose another "
            "cell.branch or joints.rotation_range",
            labels[limit],
            max(margin, 0.0),
            units[limit] if limit < len(units) else "deg",
            100.0 * max(share, 0.0),
        )
        location = int(motion.layer[row]), int(motion.bead[row]), int(motion.point[row])
        issues.append(Issue(NOTE if limit == last_axis else WARNING, LOW_MARGIN, text, *location))
    return issues
