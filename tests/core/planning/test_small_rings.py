# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a wall closes, and where open beads end half a turn before the next start: both must give
programs."""

import numpy as np
import pytest

from freecad_am import verify
from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, sample_curve
from freecad_am.core.issues import has_errors
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.posts import catalogue
from tests.programs import build


def toolpath_of(radius, layer_height, top=np.pi / 2, end=2 * np.pi, process=None):
    process = process or ProcessParameters()
    meridian = Meridian.chained(
        [
            sample_curve(
                lambda t: (radius * np.c_[np.cos(t), np.sin(t)], np.c_[-np.sin(t), np.cos(t)]),
                [0, top],
            )
        ]
    )
    wall = RevolvedWall(meridian, np.eye(4), 0.0, end, end > 6.28)
    return revolution.plan(
        wall,
        RevolutionParameters(layer_height=layer_height),
        BuildDirectionParameters(),
        process,
        NozzleParameters(),
        113.0,
    )


def axis_speeds(motion):
    moves = motion.deposit & (motion.point > 0)
    turned = np.abs(np.diff(motion.joints, axis=0, prepend=motion.joints[:1]))
    return turned[moves] / motion.duration[moves, None]


def test_the_last_ring_of_a_dome_is_run_at_the_speed_the_axes_allow(cell_of):
    """A hemisphere of 30 mm leaves a ring of 0.12 mm radius: at 6 mm/s axis 6 would rotate 8 times
    a second."""
    toolpath = toolpath_of(30.0, 1.0)
    cell = cell_of(toolpath)
    planned = plan_joints(toolpath, cell, JointParameters())
    motion, _ = assemble(planned, cell, ProcessParameters())
    assert planned.feasible
    slowed = [issue for issue in planned.issues if issue.code == "SLOWED"]
    assert [(issue.level, issue.layer) for issue in slowed] == [("warning", 47)]
    assert (axis_speeds(motion) <= cell.machine.max_speed * (1.0 + 1e-12)).all()
    assert (axis_speeds(motion) / cell.machine.max_speed).max() > 0.999999
    speed = motion.speed[motion.deposit]
    ring = motion.layer[motion.deposit] == 47
    assert (speed[~ring] == 6.0).all()
    speed = speed[ring][1:]
    assert np.ptp(speed) < 1e-6 and 1.0 < speed.min() < 1.3
    length = sum(bead.length for layer, _, bead in toolpath if layer == 47)
    assert motion.duration[motion.deposit & (motion.layer == 47)].sum() == pytest.approx(
        length / speed[0]
    )


def test_a_ring_wider_than_a_layer_is_not_slowed_but_refused(cell_of):
    toolpath = toolpath_of(30.0, 1.0, top=1.0, process=ProcessParameters(travel_speed=600.0))
    planned = plan_joints(toolpath, cell_of(toolpath), JointParameters())
    assert {issue.code for issue in planned.issues if issue.level == "error"} == {"SPEED"}
    assert "SLOWED" not in {issue.code for issue in planned.issues}


@pytest.mark.parametrize("lift", [0.0, 20.0])
def test_half_a_turn_back_to_the_next_start_is_made_in_several_moves(cell_of, lift):
    """A continuous axis takes the shorter direction, which is ambiguous for half a turn."""
    process = ProcessParameters(between_layers=BetweenLayersParameters(lift=lift))
    toolpath = toolpath_of(45.0, 10.0, top=1.2, end=np.pi, process=process)
    cell = cell_of(toolpath)
    planned = plan_joints(toolpath, cell, JointParameters())
    assert planned.feasible
    motion, issues = assemble(planned, cell, process)
    assert lift == 0.0 or not has_errors(issues)
    turn = np.abs(np.diff(motion.joints, axis=0))
    assert turn[:, 5].max() < np.radians(170.001)
    ends = [
        (current.joints[-1, 5], following.joints[0, 5])
        for current, following in zip(planned.beads, planned.beads[1:])
    ]
    assert max(abs(end - start) for end, start in ends) > np.radians(175.0)
    tip, axis = cell.tip_in_part(cell.machine.chain.forward(motion.joints))
    assert np.abs(tip - motion.position).max() < 1e-6 and np.abs(axis - motion.tool).max() < 1e-9
    post = catalogue.load("fanuc")
    program = build(motion, cell, process, ProgramParameters(), "half")
    result = verify.verify(cell, motion, program, post.write(program), post, 0.01)
    assert not has_errors(result.issues), result.issues


def test_the_tip_of_a_spiral_is_slowed_and_the_rest_is_not(cell_of):
    meridian = Meridian.chained(
        [
            sample_curve(
                lambda t: (45.0 * np.c_[np.cos(t), np.sin(t)], np.c_[-np.sin(t), np.cos(t)]),
                [0, np.pi / 2],
            )
        ]
    )
    toolpath = revolution.plan(
        RevolvedWall(meridian, np.eye(4)),
        RevolutionParameters(layer_height=1.0, path="spiral"),
        BuildDirectionParameters(),
        ProcessParameters(),
        NozzleParameters(),
        113.0,
    )
    cell = cell_of(toolpath)
    planned = plan_joints(toolpath, cell, JointParameters())
    assert planned.feasible, planned.issues
    motion, _ = assemble(planned, cell, ProcessParameters())
    assert (axis_speeds(motion) <= cell.machine.max_speed * (1.0 + 1e-12)).all()
    wide = motion.deposit & (np.hypot(motion.position[:, 0], motion.position[:, 1]) > 1.05)
    assert (motion.speed[wide] == 6.0).all() and motion.speed[motion.deposit].min() < 6.0
