# SPDX-License-Identifier: LGPL-2.1-or-later
"""Axes of a positioner that have no room for a turn: beads begin elsewhere, wait at the limit or are cut. What is written is
driven in the world by PyKDL chains built here of the numbers of the files."""

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
    driven,
    file_of_built_in,
    kdl_chain,
    kdl_pose,
    levelled_to,
)
from tests.programs import build

TURNED = math.radians(
    70.0
)  # of the part on the table: its seam is not where the table is in its middle
OVERLAP, MOST = 4.0, 10.0  # mm, deg
ROBOT = "abb-irb4600-20-250"


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return levelled_to(sliced("sphere", 15.0, chord_error=0.2), MOST)


@pytest.fixture(scope="module")
def cell_with(tmp_path_factory):
    """cell_with(toolpath, tilt, turn) -> Cell whose positioner has axes from - to + so many degrees."""
    folder = tmp_path_factory.mktemp("positioners")

    def make(toolpath, tilt, turn):
        told = json.loads(file_of_built_in().read_text(encoding="utf-8"))
        told["limits"]["maker"]["axes"] = [[-tilt, tilt], [-turn, turn]]
        path = folder / f"{tilt}-{turn}.json"
        path.write_text(json.dumps({**told, "id": f"short-{tilt}-{turn}"}), encoding="utf-8")
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
    """Tip (n, 3) in part coordinates and the tool's angle to the vertical (n,), deg, of joints (n, 8)."""
    robot, robot_base = kdl_chain(machines.file_of(ROBOT))
    table, table_base = kdl_chain(file_of_built_in())
    tips, upward = [], []
    for row in joints:
        tip = robot_base * driven(robot, row[:6]) * bryant(TORCH)
        part = bryant(STANDS) * table_base * driven(table, row[6:]) * kdl_pose((0.0, 0.0, PLATFORM))
        seen = (part * PyKDL.Frame(PyKDL.Rotation.RotZ(TURNED))).Inverse() * tip
        tips.append(list(seen.p))
        upward.append([-x for x in tip.M.UnitZ()])
    leans = np.degrees(np.arccos(np.clip(np.array(upward) @ UP, -1.0, 1.0)))
    return np.array(tips) @ toolpath.frame[:3, :3].T + toolpath.frame[:3, 3], leans


def off_beads(points, beads):
    """mm from points (n, 3) to the nearest of the beads' polylines."""
    nearest = np.full(len(points), np.inf)
    for bead in beads:
        start, along = bead.points[:-1], np.diff(bead.points, axis=0)
        gap = points[:, None] - start
        share = np.clip((gap * along).sum(-1) / (along * along).sum(-1), 0.0, 1.0)
        nearest = np.minimum(
            nearest, np.linalg.norm(gap - share[..., None] * along, axis=-1).min(axis=1)
        )
    return nearest


def of_text(cell, toolpath, planned):
    """Joints (n, 8) of the deposit in a text written for ABB, by its numbers, and those of all its moves."""
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
    cell = cell_with(hemisphere, tilt, turn)
    planned = plan_joints(hemisphere, cell, JointParameters())
    assert planned.feasible, [issue.message for issue in planned.issues]
    assert codes(planned) & {"SEAM_MOVED", "BEAD_SPLIT"} == {said}
    deposit, moves = of_text(cell, hemisphere, planned)
    most = np.r_[cell.robot.limits("maker").upper, np.radians([tilt, turn])]
    least = np.r_[cell.robot.limits("maker").lower, -np.radians([tilt, turn])]
    assert ((moves >= least - 1e-9) & (moves <= most + 1e-9)).all()
    tips, leans = in_the_world(hemisphere, deposit)
    beads = [bead for _, _, bead in hemisphere]
    assert (
        off_beads(tips, beads).max() < hemisphere.chord_error + 0.01
    )  # the last digits of the text
    assert leans.max() < MOST + 0.01
    # and every point of every bead is met, by bead or piece
    for layer, bead in enumerate(bead for _, _, bead in hemisphere):
        mine = [path.bead for path in planned.beads if path.layer == layer]
        assert off_beads(bead.points, mine).max() < 1e-9
        assert sum(piece.length for piece in mine) == pytest.approx(bead.length, rel=2e-3)
        for piece, after in zip(mine, mine[1:]):
            assert np.abs(piece.points[-1] - after.points[0]).max() < 1e-9
        assert [path.index for path in planned.beads if path.layer == layer] == list(
            range(len(mine))
        )


@pytest.mark.parametrize("turn", [170.0, 200.0])
@pytest.mark.long
def test_beads_that_begin_elsewhere_and_the_last_pieces_run_on_as_asked(sliced, cell_with, turn):
    levelled = levelled_to(sliced("sphere", 10.0, chord_error=0.1), MOST)
    toolpath = dataclasses.replace(
        levelled, rules=dataclasses.replace(levelled.rules, overlap=OVERLAP)
    )
    planned = plan_joints(toolpath, cell_with(toolpath, 134.0, turn), JointParameters())
    assert planned.feasible and "BEAD_SPLIT" in codes(
        planned
    )  # small rings have no room for the overlap too
    moved = 0
    for layer, bead in enumerate(bead for _, _, bead in toolpath):
        mine = [path for path in planned.beads if path.layer == layer]
        assert sum(path.bead.length for path in mine) == pytest.approx(
            bead.length + min(OVERLAP, bead.length), rel=3e-3
        )
        if len(mine) == 1 and np.ptp(mine[0].joints[:, 7]) > math.radians(330.0):
            moved += 1
            assert np.abs(mine[0].joints[:, 7]).max() <= math.radians(turn)
            if turn < 180.0:
                assert np.linalg.norm(mine[0].bead.points[0] - bead.points[0]) > 10.0
                assert (
                    np.abs(np.diff(mine[0].joints[-3:, 7])).max() < 1e-12
                )  # it waits at its limit
    assert moved > 2
    tips, leans = in_the_world(toolpath, planned.joints)
    assert off_beads(tips, [bead for _, _, bead in toolpath]).max() < 2.0 * toolpath.chord_error
    assert leans.max() < MOST + 1e-6


def test_a_wide_axis_is_left_alone(hemisphere, cell_with, monkeypatch):
    """What fits, or fits from another seam after the planning, is never looked at anew."""
    monkeypatch.setattr(stroke, "find_room", None)
    for turn in (185.0, 400.0):
        beads, places, issues = level.levelled(cell_with(hemisphere, 134.0, turn), hemisphere)
        assert (len(beads), issues) == (len(hemisphere.layers), [])
        assert places == [(layer, index) for layer, index, _ in hemisphere]


@pytest.mark.parametrize(("tilt", "turn", "axis"), [(134.0, 30.0, "e2"), (35.0, 200.0, "e1")])
@pytest.mark.long
def test_what_no_cut_helps_is_refused_by_name(sliced, cell_with, tilt, turn, axis):
    toolpath = levelled_to(sliced("sphere", 10.0, chord_error=0.1), MOST)
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
    assert stroke.find_room(cell, bead, math.radians(MOST), np.zeros(2), 0.0) == []
    assert len(stroke.find_room(cell, bead, math.radians(60.0), np.zeros(2), 0.0)) > 0


def test_pieces_are_as_few_and_as_equal_as_may_be():
    """Held against every way to cut a dozen points, of random reaches."""
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


def _ways(last, count, first=0):
    """All ways to get from the first point to the last one in so many pieces."""
    if count == 1:
        yield [first, last]
        return
    for end in range(first + 1, last):
        for rest in _ways(last, count - 1, end):
            yield [first, *rest]
