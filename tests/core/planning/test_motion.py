# SPDX-License-Identifier: LGPL-2.1-or-later
"""Motion and program: rows, times, rapids, overlap, resuming; the result is read back."""

import dataclasses

import numpy as np
import pytest

from freecad_am import kdl, verify
from freecad_am.core.collision.bead_ends import Beads
from freecad_am.core.issues import InputError, has_errors
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters, StartParameters
from freecad_am.core.planning.beads.chord_error import refined_to_chord_error
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.rapids.clearance import Moves as Driven
from freecad_am.core.planning.rapids.clearance import RapidObstacles
from freecad_am.core.planning.task import Task
from freecad_am.core.program import (
    FIRST_TIME,
    Call,
    DepositOff,
    DepositOn,
    LayerStart,
    Moves,
    Wait,
    WaitInput,
)
from freecad_am.core.simulation import rapid_contacts
from freecad_am.objects.checks.controllers import check_controller
from freecad_am.posts import catalogue
from tests.programs import build


@pytest.fixture(scope="module")
def planned(sliced, cell_of):
    def make(process=None, layer_height=10.0, **cell):
        toolpath = sliced("sphere", layer_height, process=process)
        resolved = cell_of(toolpath, **cell)
        joint_path = plan_joints(toolpath, resolved, JointParameters())
        assert joint_path.feasible, joint_path.issues
        motion, issues = assemble(joint_path, resolved, process or ProcessParameters())
        assert not issues
        return toolpath, resolved, joint_path, motion

    return make


def test_rows_follow_the_beads(planned):
    toolpath, _, _, motion = planned()
    for layer, index, bead in toolpath:
        rows = (motion.layer == layer) & (motion.bead == index)
        deposit = rows & motion.deposit
        assert np.abs(motion.position[deposit] - bead.points).max() < 1e-9
        assert (motion.point[deposit] == np.arange(len(bead))).all()
        assert (motion.speed[deposit] == 6.0).all()
        lifted = rows & ~motion.deposit
        assert lifted.sum() == (2 if layer == 0 else 3) + (layer == len(toolpath.layers) - 1)
    length = sum(bead.length for _, _, bead in toolpath)
    assert motion.duration[motion.deposit].sum() == pytest.approx(length / 6.0)
    assert not motion.deposit[-1] and not motion.deposit[0]


def test_every_row_is_where_its_joints_put_the_nozzle(planned):
    _, cell, _, motion = planned()
    tip, axis = cell.tip_in_part(kdl.KdlArm(cell.machine).forward(motion.joints))
    assert np.abs(tip - motion.position).max() < 1e-6
    assert np.abs(axis - motion.tool).max() < 1e-9


def test_rapids_withdraw_along_the_tool_axis_and_keep_the_axes_within_their_speed(planned):
    """Rapids retract along the tool axis and keep the axes within their speeds."""
    process = ProcessParameters(between_layers=BetweenLayersParameters(lift=12.5), rapid_speed=80.0)
    _, cell, joint_path, motion = planned(process)
    moved = np.linalg.norm(np.diff(motion.position, axis=0), axis=1)
    turned = np.abs(np.diff(motion.joints, axis=0)) / cell.machine.max_speed
    rapid = ~motion.deposit[1:]
    assert (moved[rapid] / motion.duration[1:][rapid] <= 80.0 + 1e-9).all()
    assert (turned[rapid].max(axis=1) <= motion.duration[1:][rapid]).all()
    for path in joint_path.beads[1:]:
        rapid_rows = np.flatnonzero((motion.layer == path.layer) & ~motion.deposit)[:3]
        above = motion.position[rapid_rows[1]] - path.bead.points[0]
        assert np.abs(above - 12.5 * path.bead.tool[0]).max() < 1e-6


@pytest.mark.parametrize("overlap", [0.3, 5.3, 40.0])
def test_overlap_runs_on_over_the_beginning_and_survives_the_read_back(planned, overlap):
    process = ProcessParameters(overlap=overlap)
    toolpath, cell, _, motion = planned(process)
    for layer, _, bead in toolpath:
        rows = (motion.layer == layer) & motion.deposit
        run = np.linalg.norm(np.diff(motion.position[rows], axis=0), axis=1).sum()
        assert run == pytest.approx(bead.length + min(overlap, bead.length), abs=0.02)
    program = build(motion, cell, process, ProgramParameters(), "overlap")
    files = catalogue.load("fanuc").write(program)
    checked = verify.verify(
        cell, motion, program, files, catalogue.load("fanuc"), toolpath.chord_error
    )
    assert not has_errors(checked.issues), checked.issues


def test_a_rapid_through_the_part_is_refused(planned):
    """The same rapids with the deposit raised in front of the nozzle: every travel of the upper
    layers touches it."""
    _, cell, path, motion = planned()
    beads = [bead_path.bead for bead_path in path.beads]

    def check_rapids(up):
        moved = [dataclasses.replace(bead, points=bead.points + [0.0, 0.0, up]) for bead in beads]
        return rapid_contacts.looked_at(motion, moved, cell, (), 8.0, 1.0, 20_000)

    assert (
        not len(check_rapids(0.0).rows)
        and check_rapids(0.0).place is None
        and check_rapids(0.0).moves == (~motion.deposit[1:]).sum()
    )
    assert not len(check_rapids(-500.0).rows)
    raised = check_rapids(25.0)
    assert (
        raised.place is not None and not motion.deposit[raised.rows].any() and len(raised.rows) > 5
    )


@pytest.mark.parametrize(
    ("tip", "axis", "met"),
    [
        ((0.0, 0.0, 30.0), (0.0, 0.0, 1.0), False),
        ((0.0, 0.0, -5.0), (0.0, 0.0, 1.0), True),
        ((90.0, 0.0, -5.0), (0.0, 0.0, 1.0), False),
        ((0.0, 0.0, 15.0), (np.sin(1.4), 0.0, np.cos(1.4)), False),
        ((0.0, 0.0, 15.0), (np.sin(1.9), 0.0, np.cos(1.9)), True),
        ((0.0, 0.0, 60.0), (np.sin(1.9), 0.0, np.cos(1.9)), False),
    ],
)
def test_the_platform_is_in_the_way_of_what_comes_near_it(planned, tip, axis, met):
    """Tips above, below and next to the platform, upright and tilted: a nozzle of 60 mm with a half
    angle of 20 deg."""
    _, cell, path, motion = planned()
    is_deposit = motion.deposit
    flat = np.zeros(int(is_deposit.sum()))
    deposit = Beads(
        motion.position[is_deposit],
        motion.build[is_deposit],
        motion.tool[is_deposit],
        flat,
        flat,
        motion.point[is_deposit] == 0,
    )
    surroundings = RapidObstacles(cell, deposit, ())
    poses = cell.machine.opw.inverse(
        cell.flange_poses(np.array([tip]), np.array([axis]), np.zeros(1))
    )[:, 0]
    joints = poses[np.isfinite(poses).all(axis=1)][:1]
    moves = Driven(joints, joints, np.zeros(1, dtype=int))
    assert surroundings.find_collisions(moves)[0] == met
    assert surroundings.names(moves) == ["the platform"] * met
    with_unreachable = Driven(
        np.r_[joints, np.nan * joints], np.r_[joints, joints], np.zeros(2, dtype=int)
    )  # the first cannot be reached
    assert surroundings.names(with_unreachable) == ["the platform"] * met
    assert surroundings.names(with_unreachable.of(np.array([1]))) == []
    # the check of rapids finds it too, in its own row, and only if there is a platform
    row, led = 1, motion.joints.copy()  # before any bead
    assert not motion.deposit[:2].any()
    led[: row + 1] = joints[0]
    raised_motion = dataclasses.replace(motion, joints=led)
    for checked_cell, expected in (
        (cell, met),
        (dataclasses.replace(cell, platform_diameter=0.0), False),
    ):
        contacts = rapid_contacts.looked_at(
            raised_motion, [bead.bead for bead in path.beads], checked_cell, (), 0.0, 0.0, 20_000
        )
        assert (row in contacts.rows) == expected


def test_rapids_are_raised_until_the_nozzle_is_clear(sliced, cell_of):
    """Seams moved for a limited axis send the nozzle across the part, and beads reach its limits:
    brute force finds every rapid clear at every degree, and every row within limits."""
    toolpath = sliced("sphere", 5.0)
    cell = cell_of(toolpath, limits="maker")
    joint_path = plan_joints(toolpath, cell, JointParameters())
    motion, issues = assemble(joint_path, cell, ProcessParameters())
    assert [issue.code for issue in issues] == ["RAPID_LIFTED", "RAPID_ASIDE", "RAPID_OTHER"]
    assert (cell.limits.margin(motion.joints) > 0.0).all()
    nozzle = cell.nozzle
    for row in np.flatnonzero(~motion.deposit[1:]) + 1:
        looks = 2 + int(np.degrees(np.abs(motion.joints[row] - motion.joints[row - 1]).max()))
        share = np.linspace(0.0, 1.0, looks)[:, None]
        joints = motion.joints[row - 1] + share * (motion.joints[row] - motion.joints[row - 1])
        tips, axes = cell.tip_in_part(cell.machine.chain.forward(joints))
        laid = motion.position[:row][motion.deposit[:row]]
        for tip, axis in zip(tips, axes):
            height = (laid - tip) @ axis
            across = np.linalg.norm(laid - tip - height[:, None] * axis, axis=1)
            deep = nozzle.diameter / 2 + height * np.tan(nozzle.half_angle) - across
            assert deep[(height > 0.1) & (height < nozzle.length)].max(initial=0.0) < 0.2


def test_what_happens_between_layers(planned):
    between = BetweenLayersParameters(lift=20.0, wait=3.0, input=7, call="CLEAN")
    process = ProcessParameters(between_layers=between, lead_on=0.5, lead_off=0.25)
    toolpath, cell, _, motion = planned(process)
    blocks = build(motion, cell, process, ProgramParameters(), "between").blocks
    words = [type(block).__name__ for block in blocks]
    layer = ["DepositOn", "Moves", "DepositOff"]
    between_words = ["Moves", "Wait", "WaitInput", "Call", "LayerStart", "Moves"]
    expected = ["LayerStart", "Moves", *layer]
    for _ in toolpath.layers[1:]:
        expected += [*between_words, *layer]
    assert words == [*expected, "Moves"]
    assert Wait(3.0) in blocks and WaitInput(7) in blocks and Call("CLEAN") in blocks
    assert DepositOn(0.5) in blocks and DepositOff(0.25) in blocks
    assert blocks[1].duration[0] == FIRST_TIME


def test_resuming_runs_the_same_motion_from_there(planned):
    """A resumed program has the same motion from its start layer on."""
    process = ProcessParameters()
    toolpath, cell, _, motion = planned(process)
    full_program = build(motion, cell, process, ProgramParameters(), "job")
    later = build(
        motion, cell, process, ProgramParameters(start_at=StartParameters(layer=2)), "job"
    )
    starts = [block.layer for block in later.blocks if isinstance(block, LayerStart)]
    assert starts == list(range(2, len(toolpath.layers)))
    deposit = [m for m in full_program.moves if m.kind == "deposit" and m.layer >= 2]
    again = [m for m in later.moves if m.kind == "deposit"]
    assert all(np.array_equal(a.joints, b.joints) for a, b in zip(deposit, again))
    assert isinstance(later.blocks[1], Moves) and len(later.blocks[1]) == 2
    with pytest.raises(InputError) as error:
        build(motion, cell, process, ProgramParameters(start_at=StartParameters(layer=99)), "job")
    assert error.value.code == "START_AT"


def test_controller_values_are_those_of_the_pendant(planned):
    _, cell, _, motion = planned()
    program = build(motion, cell, ProcessParameters(), ProgramParameters(), "pendant")
    joints = np.concatenate([moves.joints for moves in program.moves])
    serial = motion.joints[motion.moves]
    assert np.abs(joints[:, 2] - (serial[:, 2] - serial[:, 1])).max() < 1e-12
    assert np.abs(joints[:, [0, 1, 3, 4, 5]] - serial[:, [0, 1, 3, 4, 5]]).max() < 1e-12


def test_cartesian_positions_with_the_part_on_the_robot_are_those_of_the_deposition_point_on_the_platform(
    planned,
):
    _, cell, _, motion = planned()
    program = build(
        motion, cell, ProcessParameters(), ProgramParameters(motion="cartesian"), "gauge"
    )
    rows = motion.moves
    platform = cell.machine.chain.forward(motion.joints[rows]) @ cell.poses.carried
    position = np.concatenate([moves.position for moves in program.moves])
    rotation = np.concatenate([moves.rotation for moves in program.moves])
    # the platform carries each position to the deposition point, Z towards the nozzle
    positions_in_cell = platform[:, :3, :3] @ position[:, :, None] + platform[:, :3, 3:]
    np.testing.assert_allclose(
        positions_in_cell[:, :, 0],
        np.tile(cell.poses.station[:3, 3], (len(positions_in_cell), 1)),
        atol=1e-9,
    )
    np.testing.assert_allclose(
        platform[:, :3, :3] @ rotation,
        np.tile(cell.poses.station[:3, :3], (len(positions_in_cell), 1, 1)),
        atol=1e-12,
    )
    # and in part coordinates they are the points of the part
    in_part = position @ cell.poses.mount[:3, :3].T + cell.poses.mount[:3, 3]
    np.testing.assert_allclose(in_part, motion.position[rows], atol=1e-6)


def test_a_post_of_another_maker_is_refused(planned):
    _, cell, _, motion = planned()
    kuka = dataclasses.replace(cell, machine=machine.load("kuka-kr16-2"))
    with pytest.raises(InputError) as error:
        build(motion, kuka, ProcessParameters(), ProgramParameters(), "kuka")
    assert error.value.code == "WRONG_CONTROLLER"
    check_controller(dataclasses.replace(kuka.machine, posts=None), "fanuc")


def test_points_are_added_where_joint_motion_leaves_the_bead(sliced, cell_of):
    """With a bent torch on the robot the arm moves much, and linear joint motion does not follow a
    coarse bead."""
    from freecad_am.core.parameters.cell import NozzleParameters

    toolpath = sliced("sphere", 15.0)
    cell = cell_of(
        toolpath,
        setup="tool-on-robot",
        deposition_point=(1100.0, 0.0, 100.0, 0, 0, 0),
        nozzle=NozzleParameters(tool=(0.0, 0.0, 300.0, 0.0, np.radians(45.0), 0.0)),
        branch="auto",
    )
    joint_path = plan_joints(toolpath, cell, JointParameters())
    assert joint_path.feasible, joint_path.issues
    assert sum(len(path.bead) for path in joint_path.beads) > toolpath.point_count
    task = Task(cell, spherical_wrist.branch_index(joint_path.branch), JointParameters())
    arm = kdl.KdlArm(cell.machine)
    for path in joint_path.beads:
        share = np.linspace(0.0, 1.0, 21)[None, :, None]
        between = path.joints[:-1, None] + share * np.diff(path.joints, axis=0)[:, None]
        tip, _ = cell.tip_in_part(arm.forward(between.reshape(-1, 6)))
        origin, along = path.bead.points[:-1, None], np.diff(path.bead.points, axis=0)[:, None]
        offset = tip.reshape(len(origin), -1, 3) - origin
        where = np.clip((offset * along).sum(-1) / (along * along).sum(-1), 0.0, 1.0)
        assert (
            np.linalg.norm(offset - where[..., None] * along, axis=-1).max()
            < toolpath.chord_error * 1.05
        )
        again, issues = refined_to_chord_error(task, path, toolpath.chord_error)
        assert len(again.bead) == len(path.bead) and not issues
