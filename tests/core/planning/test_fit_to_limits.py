# SPDX-License-Identifier: LGPL-2.1-or-later
"""Limited axes: turns unwrapped, seams moved, beads split, spirals rejected."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.task import Task
from freecad_am.core.planning.turns import unwrap as turns
from freecad_am.core.toolpath import Layer


def codes(joint_path):
    return {issue.code for issue in joint_path.issues}


@pytest.mark.parametrize("part", ["sphere", "laval nozzle", "intake funnel"])
@pytest.mark.parametrize("half", [270.0, 200.0])
@pytest.mark.always
def test_a_limited_axis_6_is_solved(sliced, cell_of, with_axis_6, part, half):
    """A job with a limited axis 6 is solved."""
    toolpath = sliced(part, 5.0)
    cell = with_axis_6(cell_of(toolpath), half)
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert joint_path.feasible, joint_path.issues
    assert not cell.limits.exceeded(joint_path.joints).any()
    # every point of every bead is still deposited, wherever the bead now starts
    for layer, planned in enumerate(toolpath.layers):
        points = np.concatenate(
            [path.bead.points for path in joint_path.beads if path.layer == layer]
        )
        distance = np.linalg.norm(planned.beads[0].points[:, None] - points[None], axis=2).min(
            axis=1
        )
        assert distance.max() < 1e-9


def test_a_bead_with_points_out_of_reach_is_left_whole(sliced, cell_of, with_axis_6):
    """All robots except the papers' have an axis 1 with less than a turn, whose stroke then splits
    the bead."""
    toolpath = sliced("sphere", 20.0)
    bead = toolpath.layers[0].beads[0]
    joints = np.linspace(0.0, 1.0, len(bead))[:, None] * np.ones(6)
    joints[3] = np.nan
    cell = with_axis_6(cell_of(toolpath), 165.0)
    limits = dataclasses.replace(cell.limits, lower=np.full(6, -2.0), upper=np.full(6, 2.0))
    task = Task(dataclasses.replace(cell, limits=limits), 0, JointParameters())
    assert turns.pieces(task, bead, joints, 1) == [slice(0, len(bead))]


def test_beads_are_split_only_where_the_stroke_is_less_than_a_turn(sliced, cell_of, with_axis_6):
    """Beads are split only where the stroke is less than a turn."""
    toolpath = sliced("sphere", 5.0)
    cell = with_axis_6(cell_of(toolpath), 165.0)
    joint_path = plan_joints(toolpath, cell, JointParameters(min_condition=0.15))
    assert joint_path.feasible, joint_path.issues
    assert "BEAD_SPLIT" in codes(joint_path)
    for path in joint_path.beads:
        assert np.degrees(np.ptp(path.joints[:, 5])) <= 330.0
    for layer, planned in enumerate(toolpath.layers):
        beads_of_layer = [path.bead for path in joint_path.beads if path.layer == layer]
        radius = np.hypot(planned.beads[0].points[:, 0], planned.beads[0].points[:, 1]).max()
        # points may have been added on the circle between the planned ones
        assert (
            planned.beads[0].length - 1e-6
            < sum(bead.length for bead in beads_of_layer)
            < 2 * np.pi * radius
        )
        for current, following in zip(beads_of_layer, beads_of_layer[1:]):
            assert np.abs(current.points[-1] - following.points[0]).max() < 1e-9


@pytest.mark.parametrize("half", [2.0, 8.0, 20.0, 60.0])
@pytest.mark.parametrize("kept", [2, 4, 8, 17])
@pytest.mark.always("2-2.0", "4-8.0", "17-60.0")
def test_beads_of_few_points_are_cut_no_finer_than_that(sliced, cell_of, with_axis_6, kept, half):
    """An axis with almost no stroke would need more splits of a coarse bead than it has
    segments."""
    toolpath_of_part = sliced("sphere", 15.0)
    beads = [layer.beads[0] for layer in toolpath_of_part.layers[:3]]
    coarse = [
        bead.thinned(np.round(np.linspace(0, len(bead) - 1, kept + 1)).astype(int))
        for bead in beads
    ]
    toolpath = dataclasses.replace(
        toolpath_of_part, layers=tuple(Layer((bead,)) for bead in coarse)
    )
    cell = with_axis_6(cell_of(toolpath), half)
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert min(len(path.bead) for path in joint_path.beads) >= 2
    assert joint_path.feasible == (
        not cell.limits.exceeded(joint_path.joints).any()
        and not {"error"} & {issue.level for issue in joint_path.issues}
    )
    length = sum(bead.length for bead in coarse)
    assert length - 1e-6 < sum(path.bead.length for path in joint_path.beads) < 1.3 * length


def test_an_endless_axis_accumulates(sliced, cell_of):
    """A continuous axis accumulates turns."""
    toolpath = sliced("sphere", 5.0)
    joint_path = plan_joints(toolpath, cell_of(toolpath), JointParameters())
    turned = np.abs(joint_path.beads[-1].joints[-1, 5] - joint_path.beads[0].joints[0, 5])
    assert turned == pytest.approx(2 * np.pi * len(toolpath.layers), abs=2 * np.pi)
    jumps = [
        np.abs(following.joints[0] - current.joints[-1])[5]
        for current, following in zip(joint_path.beads, joint_path.beads[1:])
    ]
    assert max(jumps) <= np.pi + 1e-9


def test_turns_never_cost_margin(sliced, cell_of):
    """Counting turns never reduces the margin."""
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="maker")
    joint_path = plan_joints(toolpath, cell, JointParameters())
    half = 0.5 * (cell.limits.upper - cell.limits.lower)
    for path in joint_path.beads:
        margin = (
            np.minimum(path.joints - cell.limits.lower, cell.limits.upper - path.joints) / half
        ).min()
        assert margin >= path.margin - 1e-6


def test_a_spiral_runs_on_an_endless_axis_and_is_refused_on_a_limited_one(sliced, cell_of):
    """A spiral runs on a continuous axis, and a limited one rejects it."""
    toolpath = sliced("sphere", 5.0, path="spiral")
    joint_path = plan_joints(toolpath, cell_of(toolpath), JointParameters())
    assert joint_path.feasible, joint_path.issues
    assert np.abs(np.ptp(joint_path.beads[0].joints[:, 5])) > 2 * np.pi * 10
    refused = plan_joints(toolpath, cell_of(toolpath, limits="maker"), JointParameters())
    assert not refused.feasible
    assert "SPIRAL_LIMITED" in codes(refused)
