# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.touched` in a job file moves the planned part to the touched points, a saved cell keeps
them, and points that determine nothing are rejected."""

import csv
import json

import numpy as np
import pytest

from freecad_am import interop
from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.machines import machine
from freecad_am.sections import cell as job_cell
from tests.kdl_links import KdlLinks

PART = np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 0.0], [0.0, 40.0, 0.0], [0.0, 0.0, 40.0]])
MOVED = frames.bryant((905.0, 12.0, -96.0, *np.radians([1.0, -2.0, 15.0])))
TOOL = (120.0, 0.0, 200.0, 0.0, 45.0, 0.0)


@pytest.fixture
def shop(workshop):
    def write_points(points, tolerance="1 mm"):
        cell = {
            "setup": "tool-on-robot",
            "deposition_point": [900, 0, -100, 0, 0, 0],
            "platform_diameter": "100 mm",
            "nozzle": {"tool": list(TOOL)},
            "branch": ["front", "up", "flip"],
            "mount": "part",
            "touched": points,
            "touched_tolerance": tolerance,
        }
        text = workshop.text.replace(
            "cell:\n  limits: paper\n  platform_diameter: 100 mm\n", f"cell: {json.dumps(cell)}\n"
        )
        workshop.write_job(
            text.replace("layer_height: 4 mm", "layer_height: 20 mm").replace(
                "cell:", "build_direction: {mode: fixed}\ncell:"
            )
        )
        return workshop

    return write_points


def test_what_is_written_stands_where_it_was_touched(shop):
    """PyKDL puts the tip of the written joints at the moved point of the part in every row."""
    robot = (
        PART @ MOVED[:3, :3].T
        + MOVED[:3, 3]
        + np.array([[0.0, 0.0, 0.2], [0.0, 0.0, -0.2], [0.0, 0.0, 0.0], [0.0] * 3])
    )
    touched = [
        {"part": part_point, "robot": robot_point}
        for part_point, robot_point in zip(PART.tolist(), robot.tolist(), strict=True)
    ]
    command = shop(touched).run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    out = shop(touched).folder / "out"
    issues = {
        issue["code"]: issue["message"]
        for issue in json.loads((out / "report.json").read_text())["issues"]
    }
    assert issues["WORK_OFFSET"].startswith("4 touched points put the part at [9")
    with open(out / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    robot_machine = machine.load("fanuc-arcmate120ic")
    arm, worst = KdlLinks(robot_machine), 0.0
    tool = frames.bryant((*TOOL[:3], *np.radians(TOOL[3:])))
    for row in rows[:: max(1, len(rows) // 60)]:
        flange = arm.frame(np.radians([float(row[f"q{k}_deg"]) for k in range(1, 7)]))
        tip = (np.linalg.inv(robot_machine.base) @ flange @ tool)[:3, 3]
        point = np.array([float(row[f"{axis}_mm"]) for axis in "xyz"])
        worst = max(worst, float(np.linalg.norm(tip - (MOVED[:3, :3] @ point + MOVED[:3, 3]))))
    assert 0.001 < worst < 0.6  # two touched points are off by 0.2 mm


@pytest.mark.parametrize(
    ("told", "says"),
    [
        (
            [{"part": [0, 0, 0], "robot": [1, 2, 3]}],
            "error[TOUCHED] cup.yaml: cell.touched: 1 point",
        ),
        ([{"part": [0, 0, 0]}], "error[BAD_VALUE] cup.yaml: cell.touched[0].robot"),
        ([{"part": [0, 0], "robot": [1, 2, 3]}], "error[BAD_VALUE] cup.yaml: cell.touched[0].part"),
        (
            [{"parts": [0, 0, 0], "robot": [1, 2, 3]}],
            "error[UNKNOWN_KEY] cup.yaml: cell.touched[0].parts",
        ),
        ("0 0 = 1 2 3", "error[BAD_VALUE] cup.yaml: cell.touched: "),
        (3, "error[BAD_VALUE] cup.yaml: cell.touched"),
    ],
)
def test_what_says_nothing_is_refused(shop, told, says):
    command = shop(told).run("plan", "cup.yaml", "-o", "out")
    assert command.status == 2 and command.err.startswith(says), command.err


def test_a_saved_cell_keeps_them(shop, tmp_path):
    workshop_ = shop(
        [
            {"part": point, "robot": [x + 900.25, y, z]}
            for point in PART.tolist()
            for x, y, z in [point]
        ],
        "0.5 mm",
    )
    section = json.loads(workshop_.job.read_text().split("cell: ")[1].split("\n")[0])
    cell = job_cell.read(section, str(workshop_.job.parent))
    (tmp_path / "hall.yaml").write_text(interop.cell_text(cell, str(tmp_path)), encoding="utf-8")
    assert job_cell.read("hall.yaml", str(tmp_path)) == cell and len(cell.touched) == 4
