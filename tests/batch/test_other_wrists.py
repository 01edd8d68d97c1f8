# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs on arms without a spherical wrist, planned completely; PyKDL checks the nozzle position."""

import json

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.machines import machine
from freecad_am.kdl import KdlArm
from tests.batch.test_plan_command import deposit
from tests.core.kinematics.test_calibration import FILE

pytest.importorskip("PyKDL")

JOB = """\
part: {{file: cup.step}}
strategy: {{layer_height: 10 mm, chord_error: 0.1 mm}}
cell: {{machine: {machine}, platform_diameter: 100 mm, {cell}}}
joints: {{method: layer-by-layer}}
program: {{post: {post}}}
"""
CALIBRATED = "ur-ur10e calibration=robot.yaml"
POINTS = {
    "ur-ur10e": (700.0, 0.0, 300.0),
    CALIBRATED: (700.0, 0.0, 300.0),
    "fanuc-crx10ia": (710.0, 0.0, 839.0),
}
CELLS = [
    ("ur-ur10e", "auto"),
    ("ur-ur10e", "[front, up, flip]"),
    (CALIBRATED, "[front, up, flip]"),
    ("fanuc-crx10ia", "[front, up, noflip]"),
]


@pytest.mark.parametrize(
    ("name", "branch"), CELLS, ids=[f"{name} {branch.split(',')[0]}" for name, branch in CELLS]
)
def test_a_cup_is_planned_within_limits_and_without_a_jump(workshop, name, branch, monkeypatch):
    monkeypatch.chdir(workshop.folder)
    (workshop.folder / "robot.yaml").write_text(FILE, encoding="utf-8")
    point = POINTS[name]
    cell = f"deposition_point: [{', '.join(map(str, point))}, 0, 0, 0], branch: {branch}"
    workshop.write_job(
        JOB.format(machine=name, cell=cell, post="fanuc" if name.startswith("fanuc") else "ur")
    )
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert command.status == 0, command.err
    assert ("note[FOLLOWED]" in command.err) == (name == "fanuc-crx10ia")
    files = workshop.files()
    rows, points = deposit(files["waypoints.csv"].decode())
    report = json.loads(files["report.json"])
    assert report["status"] == "ok" and report["joints"]["feasible"] is True
    assert len(report["joints"]["branch"]) == 3
    assert branch == "auto" or f"[{', '.join(report['joints']['branch'])}]" == branch
    q = np.radians([[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in rows])
    arm = machine.load(name)
    limits = arm.limits("maker")
    assert (q >= limits.lower).all() and (q <= limits.upper).all()
    platform = KdlArm(arm).forward(q) @ frames.pose(np.eye(3), (0.0, 0.0, 5.0))
    station = arm.base @ frames.pose(np.eye(3), point)
    nozzle_poses = frames.inverse(platform) @ station
    # the hemisphere's rim is its first layer, on the platform
    np.testing.assert_allclose(nozzle_poses[:, :3, 3], points, atol=1e-4)
    # a program is written only if its read-back equals the plan
    assert ("program/CUP.LS" if name.startswith("fanuc") else "program/cup.script") in files
    layers = np.array([int(row["layer"]) for row in rows])
    for layer in range(layers.max() + 1):
        step = np.abs(np.diff(q[layers == layer], axis=0))
        assert step.max() < np.radians(15.0)


def test_programs_that_nobody_can_check_are_refused(workshop):
    cell = "deposition_point: [700, 0, 300, 0, 0, 0], branch: auto"
    without = json.loads((machine.BUILT_IN / "ur-ur10e.json").read_text())
    without["controller"]["posts"] = []
    (workshop.job.parent / "mine.json").write_text(json.dumps(without))
    workshop.write_job(JOB.format(machine="mine.json", cell=cell, post="fanuc"))
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert (
        command.status == 2
        and "error[WRONG_CONTROLLER]" in command.err
        and "no post supports the controller yet" in command.err
    )
    workshop.write_job(JOB.format(machine="motoman-ma2010", cell=cell, post="yaskawa"))
    command = workshop.run("plan", "cup.yaml")
    assert (
        command.status == 2
        and "error[NO_PULSES]" in command.err
        and "controller.pulses_per_degree" in command.err
    )
    cell = "deposition_point: [710, 0, 839, 0, 0, 0], branch: [front, up, noflip]"
    workshop.write_job(
        JOB.format(machine="fanuc-crx10ia", cell=cell, post="fanuc, motion: cartesian")
    )
    command = workshop.run("plan", "cup.yaml", "--no-page")
    assert (
        command.status == 2 and "error[NOT_FOR_WRIST]" in command.err and "use joint" in command.err
    )
