# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes of a positioner with less than a turn: beads start elsewhere, wait at the limit or are
split. The program is driven in the world by PyKDL chains built from the files."""

import dataclasses
import json
import math
import re

import numpy as np
import PyKDL
import pytest

from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.external import level, stroke
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.posts.abb import post as abb
from tests.core.planning.test_external_axes import (
    PLATFORM,
    STANDS,
    TORCH,
    UP,
    bryant,
    drive_chain,
    file_of_built_in,
    kdl_chain,
    kdl_pose,
    levelled_to,
)
from tests.programs import build

TURNED = math.radians(
    70.0
)  # of the part on the table: its seam is not at the middle of the table's range
OVERLAP, MAX_TILT_DEG = 4.0, 10.0  # mm, deg
ROBOT = "abb-irb4600-20-250"


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return levelled_to(sliced("sphere", 15.0, chord_error=0.2), MAX_TILT_DEG)


@pytest.fixture(scope="module")
def cell_with(tmp_path_factory):
    """cell_with(toolpath, tilt, turn) -> Cell whose positioner has axis limits of +- so many
    degrees."""
    folder = tmp_path_factory.mktemp("positioners")

    def make(toolpath, tilt, turn):
        description = json.loads(file_of_built_in().read_text(encoding="utf-8"))
        description["limits"]["maker"]["axes"] = [[-tilt, tilt], [-turn, turn]]
        path = folder / f"{tilt}-{turn}.json"
        path.write_text(json.dumps({**description, "id": f"short-{tilt}-{turn}"}), encoding="utf-8")
        return cells.resolve(
            CellParameters(
                machine=ROBOT,
                setup="tool-on-robot",
                branch="auto",
                platform=(0.0, 0.0, PLATFORM, 0.0, 0.0, TURNED),
                external=f"{path} at {' '.join(map(str, STANDS))} carries part",
                nozzle=NozzleParameters(tool=(*TORCH[:3], *np.radians(TORCH[3:]))),
            ),
            toolpath.frame,
        )

    return make


def in_the_world(toolpath, joints):
    """Tip (n, 3) in part coordinates and the tool's angle to the vertical (n,) in deg for joints
    (n, 8)."""
    robot, robot_base = kdl_chain(machines.file_of(ROBOT))
    table, table_base = kdl_chain(file_of_built_in())
    tips, upward = [], []
    for row in joints:
        tip = robot_base * drive_chain(robot, row[:6]) * bryant(TORCH)
        part_frame = (
            bryant(STANDS)
            * table_base
            * drive_chain(table, row[6:])
            * kdl_pose((0.0, 0.0, PLATFORM))
        )
        tip_in_part = (part_frame * PyKDL.Frame(PyKDL.Rotation.RotZ(TURNED))).Inverse() * tip
        tips.append(list(tip_in_part.p))
        upward.append([-x for x in tip.M.UnitZ()])
    leans = np.degrees(np.arccos(np.clip(np.array(upward) @ UP, -1.0, 1.0)))
    return np.array(tips) @ toolpath.frame[:3, :3].T + toolpath.frame[:3, 3], leans


def off_beads(points, beads):
    """Distance (mm) from points (n, 3) to the nearest of the beads' polylines."""
    nearest = np.full(len(points), np.inf)
    for bead in beads:
        start, along = bead.points[:-1], np.diff(bead.points, axis=0)
        gap = points[:, None] - start
        share = np.clip((gap * along).sum(-1) / (along * along).sum(-1), 0.0, 1.0)
        nearest = np.minimum(
            nearest, np.linalg.norm(gap - share[..., None] * along, axis=-1).min(axis=1)
        )
    return nearest


def read_joints(cell, toolpath, planned):
    """Joints (n, 8) of the deposit in a program for ABB, from its numbers, and those of all its
    moves."""
    motion, issues = assemble(planned, cell, ProcessParameters())
    assert not [issue for issue in issues if issue.level == "error"]
    program = build(motion, cell, ProcessParameters(), ProgramParameters(post="abb"), "job")
    text = "".join(
        content.decode("ascii")
        for name, content in abb.write(program).items()
        if name.endswith(".mod")
    )
    targets = re.findall(r"MoveAbsJ \[\[([^\]]*)\],\[([^\]]*)\]\]", text)
    values = np.array(
        [[float(x) for x in (robot + "," + beside).split(",")[:8]] for robot, beside in targets]
    )
    joints = np.array([cell.machine.from_controller(row) for row in np.radians(values)])
    assert len(joints) == motion.moves.sum()
    return joints[motion.deposit[motion.moves]], joints


def codes(planned):
    return {issue.code for issue in planned.issues}


@pytest.mark.parametrize(
    ("tilt", "turn", "said"),
    [
        (134.0, 185.0, "SEAM_MOVED"),
        (134.0, 170.0, "SEAM_MOVED"),
        (48.0, 172.0, "SEAM_MOVED"),
        (134.0, 120.0, "BEAD_SPLIT"),
        (134.0, 80.0, "BEAD_SPLIT"),
    ],
)
@pytest.mark.always("134.0-170.0-SEAM_MOVED", "134.0-80.0-BEAD_SPLIT")
def test_the_text_keeps_the_limits_and_lies_on_the_beads(hemisphere, cell_with, tilt, turn, said):
    """The program keeps the limits and follows the beads."""
    cell = cell_with(hemisphere, tilt, turn)
    planned = plan_joints(hemisphere, cell, JointParameters())
    assert planned.feasible, [issue.message for issue in planned.issues]
    assert codes(planned) & {"SEAM_MOVED", "BEAD_SPLIT"} == {said}
    deposit, moves = read_joints(cell, hemisphere, planned)
    upper = np.r_[cell.robot.limits("maker").upper, np.radians([tilt, turn])]
    lower = np.r_[cell.robot.limits("maker").lower, -np.radians([tilt, turn])]
    assert ((moves >= lower - 1e-9) & (moves <= upper + 1e-9)).all()
    tips, leans = in_the_world(hemisphere, deposit)
    beads = [bead for _, _, bead in hemisphere]
    assert (
        off_beads(tips, beads).max() < hemisphere.chord_error + 0.01
    )  # the last digits of the text
    assert leans.max() < MAX_TILT_DEG + 0.01
    # and every point of every bead is reached, by a whole or a split bead
    for layer, bead in enumerate(bead for _, _, bead in hemisphere):
        beads_of_layer = [path.bead for path in planned.beads if path.layer == layer]
        assert off_beads(bead.points, beads_of_layer).max() < 1e-9
        assert sum(current.length for current in beads_of_layer) == pytest.approx(
            bead.length, rel=2e-3
        )
        for current, following in zip(beads_of_layer, beads_of_layer[1:]):
            assert np.abs(current.points[-1] - following.points[0]).max() < 1e-9
        assert [path.index for path in planned.beads if path.layer == layer] == list(
            range(len(beads_of_layer))
        )


@pytest.mark.parametrize("turn", [170.0, 200.0])
@pytest.mark.long
def test_beads_that_begin_elsewhere_and_the_last_pieces_run_on_as_asked(sliced, cell_with, turn):
    """Beads with moved starts and the last of split beads have the requested overlap."""
    levelled = levelled_to(sliced("sphere", 10.0, chord_error=0.1), MAX_TILT_DEG)
    toolpath = dataclasses.replace(
        levelled, rules=dataclasses.replace(levelled.rules, overlap=OVERLAP)
    )
    planned = plan_joints(toolpath, cell_with(toolpath, 134.0, turn), JointParameters())
    assert planned.feasible and "BEAD_SPLIT" in codes(
        planned
    )  # small rings have no range for the overlap as well
    moved = 0
    for layer, bead in enumerate(bead for _, _, bead in toolpath):
        paths_of_layer = [path for path in planned.beads if path.layer == layer]
        assert sum(path.bead.length for path in paths_of_layer) == pytest.approx(
            bead.length + min(OVERLAP, bead.length), rel=3e-3
        )
        if len(paths_of_layer) == 1 and np.ptp(paths_of_layer[0].joints[:, 7]) > math.radians(
            330.0
        ):
            moved += 1
            assert np.abs(paths_of_layer[0].joints[:, 7]).max() <= math.radians(turn)
            if turn < 180.0:
                assert np.linalg.norm(paths_of_layer[0].bead.points[0] - bead.points[0]) > 10.0
                assert (
                    np.abs(np.diff(paths_of_layer[0].joints[-3:, 7])).max() < 1e-12
                )  # it waits at its limit
    assert moved > 2
    tips, leans = in_the_world(toolpath, planned.joints)
    assert off_beads(tips, [bead for _, _, bead in toolpath]).max() < 2.0 * toolpath.chord_error
    assert leans.max() < MAX_TILT_DEG + 1e-6


def test_a_wide_axis_is_left_alone(hemisphere, cell_with, monkeypatch):
    """Beads that fit, possibly with a later seam, are not searched again."""
    monkeypatch.setattr(stroke, "find_room", None)
    for turn in (185.0, 400.0):
        beads, bead_places, issues = level.levelled(cell_with(hemisphere, 134.0, turn), hemisphere)
        assert (len(beads), issues) == (len(hemisphere.layers), [])
        assert bead_places == [(layer, index) for layer, index, _ in hemisphere]


@pytest.mark.parametrize(("tilt", "turn", "axis"), [(134.0, 30.0, "e2"), (35.0, 200.0, "e1")])
@pytest.mark.long
def test_what_no_cut_helps_is_refused_by_name(sliced, cell_with, tilt, turn, axis):
    toolpath = levelled_to(sliced("sphere", 10.0, chord_error=0.1), MAX_TILT_DEG)
    planned = plan_joints(
        toolpath, cell_with(toolpath, tilt, turn), JointParameters(method="constant")
    )
    assert not planned.feasible
    assert any(
        issue.code == "LIMIT" and issue.message.startswith(f"{axis} would be at")
        for issue in planned.issues
    )


def test_no_pieces_where_no_way_leads_on(hemisphere, cell_with):
    cell, bead = cell_with(hemisphere, 134.0, 30.0), hemisphere.layers[2].beads[0]
    assert stroke.find_room(cell, bead, math.radians(MAX_TILT_DEG), np.zeros(2), 0.0) == []
    assert len(stroke.find_room(cell, bead, math.radians(60.0), np.zeros(2), 0.0)) > 0


def test_pieces_are_as_few_and_as_equal_as_may_be():
    """Compared with every way to split a dozen points of random reach."""
    random = np.random.default_rng(3)
    for _ in range(200):
        reach = np.minimum(np.maximum.accumulate(np.arange(12) + random.integers(1, 6, 12)), 11)
        cuts = stroke._cuts(reach, 0, 11)
        fewest = next(
            count
            for count in range(1, 12)
            for ends in _ways(11, count)
            if all(reach[a] >= b for a, b in zip(ends, ends[1:]))
        )
        assert len(cuts) - 1 == fewest
        even = stroke._balanced(reach, cuts)
        assert len(even) == len(cuts) and (even[0], even[-1]) == (0, 11)
        assert all(a < b <= reach[a] for a, b in zip(even, even[1:]))


def _ways(end_point, count, start_point=0):
    """All ways to get from the first point to the last one in a number of steps."""
    if count == 1:
        yield [start_point, end_point]
        return
    for end in range(start_point + 1, end_point):
        for remainder in _ways(end_point, count - 1, end):
            yield [start_point, *remainder]
