# SPDX-License-Identifier: LGPL-2.1-or-later
"""A torch with a camera at its side keeps clear of obstacles next to the part by rotations about
the tool. Checked by PyKDL's flange and points on the triangles of the torch, at ten times as many
joint positions as rows."""

import dataclasses
import re

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import box
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics import torch
from freecad_am.core.parameters.cell import CellParameters
from tests.core.kinematics.test_torch import box_at, put, samples
from tests.core.planning.test_arm_clearance import CELL, CLEARANCE, DOWN, dome, planned
from tests.core.planning.test_obstacles import nearest

__all__ = ["dome"]  # a fixture

POST = np.array([30.0, 30.0, 500.0])
NOZZLE = dataclasses.replace(CELL["nozzle"], diameter=20.0)
# in file coordinates: Z out of the nozzle
TORCH = put(
    box_at((12.0, 12.0, 85.0), 0.0, 0.0, -57.5), box_at((160.0, 30.0, 25.0), 74.0, 0.0, -87.5)
)


@pytest.fixture(scope="module")
def beside(dome):
    """A cell with a post that the camera touches in the plan without clearance, and that plan's
    motion."""
    values = {**CELL, "branch": DOWN, "nozzle": NOZZLE}
    cell = cells.resolve(CellParameters(**values), dome.frame)
    cell = dataclasses.replace(cell, shapes=cells.CellShapes(torch=torch.torch(TORCH, NOZZLE)))
    motion, issues = planned(dome, cell)
    assert not has_errors(issues)
    row = int(0.5 * len(motion))
    flange = (
        np.linalg.inv(cell.machine.base)
        @ cell.machine.chain.links(motion.joints[row])[-1]
        @ cell.machine.chain.flange
    )
    camera = flange @ cell.poses.carried @ [140.0, 0.0, -87.5, 1.0]
    pose = frames.pose(np.eye(3), camera[:3])
    return values, cell, pose, motion


def torch_points(cell):
    """Points on the torch above the nozzle, in flange coordinates."""
    points = samples(cell.shapes.torch.body, 3000)
    points = points[points[:, 2] > NOZZLE.length] * [1.0, -1.0, -1.0]
    return points @ cell.poses.carried[:3, :3].T + cell.poses.carried[:3, 3]


def test_a_camera_keeps_clear_of_a_post(dome, beside):
    values, cell, pose, motion = beside
    assert nearest(motion, cell, pose, torch_points(cell), POST).min() < CLEARANCE
    cell_with_clearance = dataclasses.replace(
        cells.resolve(CellParameters(**values, arm_clearance=CLEARANCE), dome.frame),
        shapes=dataclasses.replace(cell.shapes, obstacles=(box(tuple(POST), pose, "post"),)),
    )
    motion, issues = planned(dome, cell_with_clearance)
    assert not has_errors(issues), [issue for issue in issues if issue.level == "error"]
    assert (
        nearest(motion, cell_with_clearance, pose, torch_points(cell_with_clearance), POST).min()
        > CLEARANCE - 1.0
    )  # points of the box of the capsules, not all of it


def test_what_the_torch_cannot_get_past_is_named(dome, beside):
    """A ring of posts around the part, closer than the camera is long."""
    values, cell, _, _ = beside
    x, y, z, *_ = CELL["deposition_point"]
    turn = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    middles = np.stack(
        [x + 150.0 * np.cos(turn), y + 150.0 * np.sin(turn), np.full(12, z - 100.0)], axis=1
    )
    ring = tuple(
        box((60.0, 60.0, 420.0), frames.pose(np.eye(3), position), f"post {k}")
        for k, position in enumerate(middles)
    )
    cell_with_clearance = dataclasses.replace(
        cells.resolve(CellParameters(**values, arm_clearance=CLEARANCE), dome.frame),
        shapes=dataclasses.replace(cell.shapes, obstacles=ring),
    )
    _, issues = planned(dome, cell_with_clearance)
    errors = [issue for issue in issues if issue.code == "ARM_CLEARANCE"]
    assert any(
        re.match(r"the torch comes closer than 10 mm to post \d+", issue.message)
        for issue in errors
    )
