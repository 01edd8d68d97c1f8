# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small dome on the RX60B L, planned, written as VAL 3, read back and verified; what goes wrong is caught."""

import re

import numpy as np
import pytest

from freecad_am import verify as verification
from freecad_am.core.geometry.profile import Meridian, RevolvedWall
from freecad_am.core.geometry.sampling import sampled
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning import moving_tool
from freecad_am.core.planning import program as programs
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.strategies import revolution
from freecad_am.kdl.chain import KdlArm
from freecad_am.posts import staubli

CHORD_ERROR = 0.01


@pytest.fixture(scope="module")
def planned():
    def curve(t):
        return np.c_[30.0 * np.cos(t), 30.0 * np.sin(t)], np.c_[-np.sin(t), np.cos(t)]

    wall = RevolvedWall(Meridian.chained([sampled(curve, [0, 1.2])]), np.eye(4))
    strategy = RevolutionParameters(layer_height=6.0, chord_error=CHORD_ERROR)
    toolpath = revolution.plan(wall, strategy, BuildDirectionParameters(), ProcessParameters(), NozzleParameters(), 60.0)
    cell = cells.resolve(
        CellParameters(
            machine="staubli-rx60bl", deposition_point=(300.0, 0.0, 300.0, np.pi, 0.0, 0.0), platform_diameter=60.0
        ),
        toolpath.frame,
    )
    path = plan_joints(toolpath, cell, JointParameters())
    assert not has_errors(path.issues)
    motion, issues = assemble(path, cell, ProcessParameters())
    assert not has_errors(issues)
    return cell, motion


@pytest.fixture(scope="module", params=["joint", "cartesian"])
def written(planned, request):
    cell, motion = planned
    if request.param == "cartesian":
        motion = moving_tool.kept_straight(motion, cell, CHORD_ERROR)
    parameters = ProgramParameters(post="staubli", motion=request.param, max_points=500)
    program = programs.build(motion, cell, ProcessParameters(), parameters, "dome")
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
    cell, motion = planned
    parameters = ProgramParameters(post="staubli", motion="cartesian")
    program = programs.build(motion, cell, ProcessParameters(), parameters, "dome")
    result = verify(cell, motion, program, staubli.write(program))
    assert {issue.code for issue in result.issues} == {"VERIFY_BETWEEN"} and result.between_mm > 1.5 * CHORD_ERROR


def test_added_points_lie_on_the_segments_and_the_arm_reaches_them(planned):
    cell, motion = planned
    finer = moving_tool.kept_straight(motion, cell, CHORD_ERROR)
    assert len(finer) > 1.5 * len(motion) and finer.total_time == pytest.approx(motion.total_time)
    for layer, bead in {(0, 0), (int(motion.layer.max()), 0)}:
        rows, more = ((m.deposit & (m.layer == layer) & (m.bead == bead)) for m in (motion, finer))
        assert finer.point[more].tolist() == list(range(int(more.sum())))
        steps = (np.diff(motion.position[rows], axis=0), np.diff(finer.position[more], axis=0))
        length, other = (np.linalg.norm(step, axis=1).sum() for step in steps)
        assert other == pytest.approx(length, abs=1e-9)
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
    # past the first move of all, whose speed is not judged
    row = text.index('key="0"' if array == "pTarget" else 'key="2"', start)
    found = value.search(text, row)
    moved = text[: found.start()] + f"{float(found[0]) + change:.5f}" + text[found.end() :]
    result = verify(cell, motion, program, {**files, name: moved.encode()})
    assert code in {issue.code for issue in result.issues}


def test_another_deposition_point_than_the_planned_one_is_caught(written):
    cell, motion, program, files = written
    if program.motion == "joint":
        return  # joint values stand on their own
    moved = {name: content.replace(b'x="300.0000"', b'x="300.0500"') for name, content in files.items()}
    assert moved != files
    assert "VERIFY_POINT" in {issue.code for issue in verify(cell, motion, program, moved).issues}
