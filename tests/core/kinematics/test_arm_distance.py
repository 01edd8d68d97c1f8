# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far links stay from a box: by points on the sides of their cylinders and the distance of a point from a box."""

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
    cell = cell_of(setup)
    rods = external_links.robot_cylinders(cell.robot.chain)
    # links that are looked at against what is carried, or what stands still; and of bodies in part coordinates
    contact = ArmContact(cell, rods, [box(low)])
    group = next(one for one in contact.groups if one.seen_from == "part")
    every, met = anywhere(cell, 40, 3), 0
    nozzle = ArmContact(cell, rods)
    for q in every:
        place, best = placing(cell, q), REACH
        for number in group.links:
            if rods[number]:
                seen = np.linalg.inv(place.part) @ place.links[number]
                points = on_rods(rods[number], 12.0) @ seen[:3, :3].T + seen[:3, 3]
                outside = np.maximum(np.maximum(low - points, points - low - SIZE), 0.0)
                best = min(best, float(np.linalg.norm(outside, axis=1).min()))
        alone = min_distance(nozzle, q[None], np.zeros(1, dtype=np.int64), REACH)
        found = min_distance(contact, q[None], np.zeros(1, dtype=np.int64), REACH)
        # points are up to 12 mm apart, cylinders 0.2 mm larger; the nozzle may be nearer than the box
        assert min(best - 15.0, alone) - 1e-4 <= found <= min(best, alone) + 1e-6, q
        met += best <= alone - 15.0
    assert met > 5
    together = min_distance(contact, every, np.zeros(len(every), dtype=np.int64), REACH)
    each = [min_distance(contact, q[None], np.zeros(1, dtype=np.int64), REACH) for q in every]
    assert together == pytest.approx(min(each), abs=1e-4)
