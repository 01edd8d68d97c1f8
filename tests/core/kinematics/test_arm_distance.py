# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distances of links from a box, against points on the sides of their cylinders and the distance of
a point from a box."""

import numpy as np
import pytest

from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.contact import ArmContact, min_distance
from freecad_am.core.simulation.table_links import placing
from tests.core.kinematics.test_arm_contact import (
    PART_ON_ROBOT,
    SIZE,
    TOOL_ON_ROBOT,
    anywhere,
    box,
    cell_of,
)
from tests.core.planning.test_arm_clearance import on_rods

REACH = 400.0


@pytest.mark.parametrize(("setup", "low"), [
    (PART_ON_ROBOT, np.array([300.0, -90.0, 150.0])), (TOOL_ON_ROBOT, np.array([-500.0, 100.0, 300.0])),
], ids=["part on robot", "tool on robot"])  # fmt: skip
@pytest.mark.always("part on robot")
def test_the_least_distance_is_that_of_points_on_links(setup, low):
    """The least distance agrees with points on the links."""
    cell = cell_of(setup)
    rods = external_links.robot_cylinders(cell.robot.chain)
    # links that move against the carried bodies or the fixed ones; and bodies in part coordinates
    contact = ArmContact(cell, rods, [box(low)])
    group = next(candidate for candidate in contact.groups if candidate.seen_from == "part")
    joints, met = anywhere(cell, 40, 3), 0
    nozzle = ArmContact(cell, rods)
    for q in joints:
        placed_cell, best = placing(cell, q), REACH
        for number in group.links:
            if rods[number]:
                link_in_part = np.linalg.inv(placed_cell.part) @ placed_cell.links[number]
                points = on_rods(rods[number], 12.0) @ link_in_part[:3, :3].T + link_in_part[:3, 3]
                outside = np.maximum(np.maximum(low - points, points - low - SIZE), 0.0)
                best = min(best, float(np.linalg.norm(outside, axis=1).min()))
        alone = min_distance(nozzle, q[None], np.zeros(1, dtype=np.int64), REACH)
        distance = min_distance(contact, q[None], np.zeros(1, dtype=np.int64), REACH)
        # points are up to 12 mm apart, cylinders 0.2 mm larger; the nozzle may be nearer than the
        # box
        assert min(best - 15.0, alone) - 1e-4 <= distance <= min(best, alone) + 1e-6, q
        met += best <= alone - 15.0
    assert met > 5
    together = min_distance(contact, joints, np.zeros(len(joints), dtype=np.int64), REACH)
    single_distances = [
        min_distance(contact, q[None], np.zeros(1, dtype=np.int64), REACH) for q in joints
    ]
    assert together == pytest.approx(min(single_distances), abs=1e-4)
