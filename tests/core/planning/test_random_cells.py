# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random cells with retract distances up to 200 mm: every row of an accepted job can be executed,
including rapids, in the motion and, where the robot has a post, in the program. Limits are read
from the machine file here; the arm is PyKDL's."""

import json
from pathlib import Path

import numpy as np
import pytest

from freecad_am import kdl
from freecad_am.core.issues import ERROR, has_errors
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import BetweenLayersParameters, ProcessParameters
from freecad_am.core.parameters.program import ProgramParameters
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.posts import catalogue
from tests.batch import row_limits
from tests.programs import build

MACHINES = {
    "fanuc-arcmate120ic": (1100.0, 600.0),
    "kuka-kr16-2": (1100.0, 800.0),
    "staubli-tx60l": (550.0, 300.0),
}
FILES = Path(__file__).parents[3] / "freecad_am" / "machines"
POSTS = {"fanuc-arcmate120ic": "fanuc", "staubli-tx60l": "staubli"}
FLOOR, LENGTH = 0.02, 1000.0


def random_cell(seed):
    """Parameters of a cell and a retract distance for a seed."""
    rng = np.random.default_rng(seed)
    name = list(MACHINES)[seed % len(MACHINES)]
    ahead, high = MACHINES[name]
    point = np.array([ahead, 0.0, high]) + rng.uniform(-1.0, 1.0, 3) * [
        0.25 * ahead,
        0.3 * ahead,
        0.3 * ahead,
    ]
    leaning = np.radians(rng.uniform(-40.0, 40.0, 3))
    lift = (
        0.0
        if seed % 12 == 5
        else float(rng.uniform(0.0, 200.0) if seed % 2 else rng.uniform(0.0, 40.0))
    )
    return {
        "machine": name,
        "limits": "maker",
        "deposition_point": (*point, *leaning),
        "branch": "auto",
    }, lift


def find_within_limits(machine, joints):
    """Whether joints (n, 6) in rad are within the limits of a machine file."""
    limits = json.loads((FILES / f"{machine}.json").read_text(encoding="utf-8"))["limits"]["maker"]
    degrees = np.degrees(joints)
    fits = np.ones(len(joints), dtype=bool)
    for axis, ends in enumerate(limits["axes"]):
        if ends is not None:
            fits &= (degrees[:, axis] >= ends[0] - 1e-9) & (degrees[:, axis] <= ends[1] + 1e-9)
    for coupled in limits.get("coupled", ()):
        low, high = coupled["range"]
        value = degrees @ np.array(coupled["coefficients"], dtype=float)
        fits &= (value >= low - 1e-9) & (value <= high + 1e-9)
    return fits


def conditions(arm, cell, joints):
    """The ratio (n,) of the singular values of the arm's Jacobian at the deposition point, by
    differences."""
    step = 1e-6
    moved = [
        arm.forward(joints + sign * step * np.eye(6)[axis]) for axis in range(6) for sign in (1, -1)
    ]
    flange = arm.forward(joints)
    ratios = []
    for k in range(len(joints)):
        tip = np.linalg.inv(flange[k]) @ np.append(cell.poses.station[:3, 3], 1.0)
        columns = []
        for axis in range(6):
            up, down = moved[2 * axis][k], moved[2 * axis + 1][k]
            turn = (up[:3, :3] - down[:3, :3]) @ flange[k][:3, :3].T / (2 * step)
            velocity = (up @ tip - down @ tip)[:3] / (2 * step) / LENGTH
            columns.append([*velocity, turn[2, 1], turn[0, 2], turn[1, 0]])
        values = np.linalg.svd(np.array(columns).T, compute_uv=False)
        ratios.append(values[-1] / values[0])
    return np.array(ratios)


def run_cell(seed, sliced, cell_of):
    """Plan and check one cell: 'no plan', 'refused' for its rapids, or 'sound' after all checks."""
    toolpath = sliced("sphere", 15.0, chord_error=0.3)
    parameters, lift = random_cell(seed)
    cell = cell_of(toolpath, **parameters)
    planned = plan_joints(toolpath, cell, JointParameters())
    process = ProcessParameters(between_layers=BetweenLayersParameters(lift=lift))
    motion, issues = assemble(planned, cell, process)
    if not planned.feasible:
        return "no plan", issues
    if has_errors(issues):
        assert all(
            issue.layer is not None and issue.bead is not None
            for issue in issues
            if issue.level == ERROR
        )
        return "refused", issues
    assert np.isfinite(motion.joints).all()
    assert find_within_limits(parameters["machine"], motion.joints).all(), (seed, lift)
    if parameters["machine"] in POSTS:
        settings = ProgramParameters(post=POSTS[parameters["machine"]], motion="joint")
        files = catalogue.load(settings.post).write(build(motion, cell, process, settings, "job"))
        program_joints = row_limits.told_joints(
            {name: text.decode() for name, text in files.items()}, parameters["machine"]
        )
        assert (
            len(program_joints) >= motion.moves.sum()
            and find_within_limits(parameters["machine"], np.radians(program_joints)).all()
        ), (seed, lift)
    arm = kdl.KdlArm(cell.machine)
    flange = arm.forward(motion.joints)
    in_part = cell.poses.mount @ np.linalg.inv(flange @ cell.poses.carried) @ cell.poses.station
    assert np.abs(in_part[:, :3, 3] - motion.position).max() < 1e-5
    turned = np.abs(np.diff(motion.joints, axis=0)).max(axis=1) > 1e-9
    fastest = np.radians(
        [
            joint["max_speed"]
            for joint in json.loads(
                (FILES / f"{parameters['machine']}.json").read_text(encoding="utf-8")
            )["joints"]
        ]
    )
    speed = np.abs(np.diff(motion.joints, axis=0))[turned] / motion.duration[1:][turned, None]
    assert (speed <= fastest * (1.0 + 1e-9)).all()
    rapid = np.flatnonzero(~motion.deposit)
    assert (conditions(arm, cell, motion.joints[rapid]) >= FLOOR - 1e-6).all()
    return "sound", issues


def look_over(seeds, sliced, cell_of):
    """Count the outcomes over all cells."""
    counts = {"no plan": 0, "refused": 0, "sound": 0}
    for seed in seeds:
        counts[run_cell(seed, sliced, cell_of)[0]] += 1
    return counts


def test_no_row_of_a_dozen_random_cells_is_beyond_what_the_robot_can_do(sliced, cell_of):
    counts = look_over(range(12), sliced, cell_of)
    assert counts["sound"] >= 6 and counts["refused"] <= 1


@pytest.mark.long
def test_no_row_of_200_random_cells_is_beyond_what_the_robot_can_do(sliced, cell_of):
    counts = look_over(range(12, 212), sliced, cell_of)
    assert counts["sound"] >= 100 and counts["refused"] <= 10
