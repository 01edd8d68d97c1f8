# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plan a small dome on the RX60B L, write it as VAL 3, read it back and verify it; errors are
caught."""

import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from freecad_am import verify as verification
from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, sample_curve
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning.beads import steps
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.kdl import KdlArm
from freecad_am.posts.staubli import post as staubli
from tests.programs import build

CHORD_ERROR = 0.01


@pytest.fixture(scope="module")
def planned():
    def curve(t):
        return np.c_[30.0 * np.cos(t), 30.0 * np.sin(t)], np.c_[-np.sin(t), np.cos(t)]

    wall = RevolvedWall(Meridian.chained([sample_curve(curve, [0, 1.2])]), np.eye(4))
    strategy = RevolutionParameters(layer_height=6.0, chord_error=CHORD_ERROR)
    toolpath = revolution.plan(
        wall, strategy, BuildDirectionParameters(), ProcessParameters(), NozzleParameters(), 60.0
    )
    cell = cells.resolve(
        CellParameters(
            machine="staubli-rx60bl",
            deposition_point=(300.0, 0.0, 300.0, np.pi, 0.0, 0.0),
            platform_diameter=60.0,
        ),
        toolpath.frame,
    )
    path = plan_joints(toolpath, cell, JointParameters())
    assert not has_errors(path.issues)
    motion, issues = assemble(path, cell, ProcessParameters())
    assert not has_errors(issues)
    return cell, motion, [bead.bead for bead in path.beads]


@pytest.fixture(scope="module", params=["joint", "cartesian"])
def written(planned, request):
    cell, motion, beads = planned
    if request.param == "cartesian":
        motion = steps.refined_to_chord_error(motion, cell, CHORD_ERROR, beads)
    parameters = ProgramParameters(post="staubli", motion=request.param, max_points=500)
    program = build(motion, cell, ProcessParameters(), parameters, "dome")
    return cell, motion, program, staubli.write(program)


def verify(cell, motion, program, files):
    return verification.verify(cell, motion, program, files, staubli, CHORD_ERROR)


def test_both_variants_pass_with_both_solvers(written):
    result = verify(*written)
    assert result.issues == () and result.solvers == ("chain", "pykdl")
    assert 0.0 < result.at_points_mm <= result.bound_mm < 0.001
    assert 0.0 < result.between_mm <= CHORD_ERROR + result.bound_mm
    assert len(written[3]) > 4


def test_without_the_added_points_the_moving_tool_leaves_the_bead(planned):
    cell, motion, _ = planned
    parameters = ProgramParameters(post="staubli", motion="cartesian")
    program = build(motion, cell, ProcessParameters(), parameters, "dome")
    result = verify(cell, motion, program, staubli.write(program))
    assert {issue.code for issue in result.issues} == {
        "VERIFY_BETWEEN"
    } and result.between_mm > 1.5 * CHORD_ERROR


def test_added_points_lie_on_the_circles_and_the_arm_reaches_them(planned):
    cell, motion, beads = planned
    finer = steps.refined_to_chord_error(motion, cell, CHORD_ERROR, beads)
    assert len(finer) > 1.5 * len(motion) and finer.total_time == pytest.approx(motion.total_time)
    for layer, bead in {(0, 0), (int(motion.layer.max()), 0)}:
        rows, added_rows = (
            (m.deposit & (m.layer == layer) & (m.bead == bead)) for m in (motion, finer)
        )
        assert finer.point[added_rows].tolist() == list(range(int(added_rows.sum())))
        radius, height = (
            np.hypot(finer.position[added_rows, 0], finer.position[added_rows, 1]),
            finer.position[added_rows, 2],
        )
        assert np.abs(radius - radius[0]).max() < 1e-6 < CHORD_ERROR / 100 and np.ptp(height) < 1e-9
        assert int(rows.sum()) <= int(added_rows.sum())
    tip, tool = cell.tip_in_part(KdlArm(cell.machine).forward(finer.joints))
    assert np.abs(tip - finer.position).max() < 1e-6 and np.abs(tool - finer.tool).max() < 1e-6


@pytest.mark.parametrize(("array", "attribute", "change", "code"), [
    ("tPath", "x", 0.002, "VERIFY_POINT"), ("tPath", "rx", 0.02, "VERIFY_ROTATION"),
    ("pTarget", "z", 0.05, "VERIFY_POINT"), ("mPath", "tmax", 0.01, "VERIFY_SPEED"), ("mPath", "vel", 0.01, "VERIFY_TIME"),
    ("jPath", "j3", 0.001, "VERIFY_JOINT"),
])  # fmt: skip
def test_a_value_that_is_off_is_caught(written, array, attribute, change, code):
    cell, motion, program, files = written
    name = "dome/dome01/dome01.dtx"
    text = files[name].decode()
    start = text.find(f'name="{array}"')
    if start < 0 or (attribute == "tmax" and program.motion == "joint"):
        return
    value = re.compile(rf'(?<= {attribute}=")(?!99999|100")[^"]+')
    # skip the very first move, whose speed the check ignores
    row = text.index('key="0"' if array == "pTarget" else 'key="2"', start)
    match = value.search(text, row)
    moved = text[: match.start()] + f"{float(match[0]) + change:.5f}" + text[match.end() :]
    result = verify(cell, motion, program, {**files, name: moved.encode()})
    assert code in {issue.code for issue in result.issues}


def test_another_deposition_point_than_the_planned_one_is_caught(written):
    cell, motion, program, files = written
    if program.motion == "joint":
        return  # joint values do not depend on the poses
    moved = {
        name: content.replace(b'x="300.0000"', b'x="300.0500"') for name, content in files.items()
    }
    assert moved != files
    assert "VERIFY_POINT" in {issue.code for issue in verify(cell, motion, program, moved).issues}


ORIGIN = (12.5, -7.25, 31.0, 0.3, -0.2, 1.1)


def test_the_program_origin_changes_the_text_and_not_the_motion(planned):
    """Two origins give different gauges and the same flange poses in space, computed here from the
    text by multiplying frames."""
    cell, motion, beads = planned
    motion = steps.refined_to_chord_error(motion, cell, CHORD_ERROR, beads)
    texts, flanges = [], []
    for origin in ("auto", ORIGIN):
        parameters = ProgramParameters(post="staubli", motion="cartesian", origin=origin)
        program = build(motion, cell, ProcessParameters(), parameters, "dome")
        files = staubli.write(program)
        result = verify(cell, motion, program, files)
        assert result.issues == () and 0.0 < result.at_points_mm <= result.bound_mm < 0.001
        readback = staubli.read(files)
        linear = readback.deposit
        texts.append(files)
        flanges.append(readback.frame @ np.linalg.inv(readback.tool[linear]))
        assert (
            np.abs(
                flanges[-1] - cell.machine.chain.forward(motion.joints[motion.moves])[linear]
            ).max()
            < 1e-3
        )
        # a gauge is the point of the part relative to the origin
        moves = np.concatenate([run.position for run in program.moves if run.kind == "deposit"])
        from_origin = motion.position[motion.moves][linear] - (
            np.array(origin[:3]) if origin != "auto" else cell.poses.mount[:3, 3]
        )
        assert (
            np.abs(np.linalg.norm(moves, axis=1) - np.linalg.norm(from_origin, axis=1)).max() < 1e-9
        )
    assert texts[0]["dome/dome.dtx"] != texts[1]["dome/dome.dtx"]
    assert np.abs(flanges[0] - flanges[1]).max() < 5e-4


def test_an_origin_of_zero_gauge_comes_to_the_deposition_point(planned):
    """The point of the part at the origin has the gauge 0 0 0, and its axes are those of the
    target."""
    cell, motion, _ = planned
    row = int(np.flatnonzero(motion.deposit)[5])
    flange = cell.machine.chain.forward(motion.joints[row : row + 1])
    target = cell.poses.mount @ np.linalg.inv(flange @ cell.poses.carried) @ cell.poses.station
    origin = (*target[0, :3, 3], *Rotation.from_matrix(target[0, :3, :3]).as_euler("XYZ"))
    parameters = ProgramParameters(post="staubli", motion="cartesian", origin=origin)
    program = build(motion, cell, ProcessParameters(), parameters, "dome")
    run = next(block for block in program.moves if block.kind == "deposit")
    assert np.abs(run.position[4]).max() < 1e-9 and np.abs(run.rotation[4] - np.eye(3)).max() < 1e-9
