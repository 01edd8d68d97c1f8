# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.obstacles` in a job file: a table and a post, from files, which links would hit in a plan
without them. PyKDL's frames of the links check the written rows. Invalid obstacles are rejected
with a message."""

import csv
import json
import shutil

import numpy as np
import Part
import pytest
import yaml

from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.machines import machine
from tests.core.planning.test_arm_clearance import on_rods
from tests.kdl_links import KdlLinks

ROBOT, CLEARANCE = "fanuc-arcmate120ic", 10.0
POST, TABLE = (60.0, 60.0, 400.0), (1000.0, 800.0, 30.0)
POST_AT, TABLE_AT = (
    (1080.0, 138.564, 95.0),
    (1000.0, 0.0, -116.0),
)  # their centres, mm in the robot's base


@pytest.fixture
def job(workshop, root):
    """Return a function that plans a dome next to a post from a file, with changes, and returns its
    end and its output folder."""
    shutil.copy(root / "resources" / "examples" / "hemisphere.step", workshop.folder)
    solid = Part.makeBox(*POST)
    solid.exportStep(str(workshop.folder / "a post.step"))

    def plan(**cell):
        corner = [middle - 0.5 * edge for middle, edge in zip(POST_AT, POST)]
        values = {
            "machine": ROBOT,
            "limits": "paper",
            "setup": "tool-on-robot",
            "deposition_point": [1000, 0, -100, 0, 0, 0],
            "nozzle": {"length": "60 mm", "tool": [120, 0, 200, 0, 45, 0]},
            "branch": ["front", "down", "noflip"],
            "obstacles": [{"name": "post", "file": "a post.step", "pose": [*corner, 0, 0, 0]}],
            **cell,
        }
        text = {
            "version": 1,
            "name": "dome",
            "part": {"file": "hemisphere.step"},
            "strategy": {"kind": "revolution", "layer_height": "15 mm", "chord_error": "0.2 mm"},
            "build_direction": {"mode": "fixed"},
            "cell": values,
            "program": {"post": "fanuc"},
        }
        (workshop.folder / "dome.yaml").write_text(yaml.safe_dump(text), encoding="utf-8")
        return workshop.run("plan", "dome.yaml", "-o", "out", "--no-page"), workshop.folder / "out"

    return plan


def nearest(folder, middle, size):
    """Return the distance in mm between links and a box along the written rows, at ten positions of
    each."""
    with open(folder / "waypoints.csv", encoding="utf-8", newline="") as file:
        rows = np.radians(
            [[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in csv.DictReader(file)]
        )
    robot = machine.load(ROBOT)
    arm, best = KdlLinks(robot), np.inf
    links = [
        (k, on_rods(rods))
        for k, rods in enumerate(external_links.robot_cylinders(robot.chain))
        if k and rods
    ]
    dense = np.concatenate(
        [rows[:-1] + share * np.diff(rows, axis=0) for share in np.linspace(0.1, 1.0, 10)]
    )[::17]
    centre = robot.base[:3, :3] @ np.array(middle) + robot.base[:3, 3]
    for q in dense:
        for number, points in links:
            pose = arm.frame(q, number)
            relative_points = points @ pose[:3, :3].T + pose[:3, 3] - centre
            best = min(
                best,
                np.linalg.norm(
                    np.maximum(np.abs(relative_points) - 0.5 * np.array(size), 0.0), axis=1
                ).min(),
            )
    return best


def notes(folder):
    report_data = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return {issue["code"]: issue["message"] for issue in report_data["issues"]}


def test_links_of_a_written_path_keep_clear_of_a_post_that_is_a_file(job):
    command, folder = job()
    assert command.status == 3 and not (folder / "program").exists(), command.err
    assert nearest(folder, POST_AT, POST) == 0.0
    assert "inside post" in notes(folder)["ARM_COLLISION"]
    assert notes(folder)["REMEDY"].startswith("the job is feasible with `cell.arm_clearance: 5 mm`")
    assert notes(folder)["OBSTACLES_NOT_KEPT"].startswith("post: ")
    command, folder = job(arm_clearance="10 mm")
    assert command.status == 0, command.err
    assert nearest(folder, POST_AT, POST) >= CLEARANCE
    assert "OBSTACLES_NOT_KEPT" not in notes(folder)


@pytest.mark.parametrize(("obstacle", "told"), [
    ({"box": [200, 200, 400], "pose": [1045, 0, 0, 0, 0, 0]}, "cell.obstacles box 1: the obstacle touches the nozzle"),
    ({"file": "none.step"}, "error[NO_FILE] dome.yaml: cell.obstacles[0].file"),
    ({"file": "dome.yaml"}, "error[UNSUPPORTED_FILE] dome.yaml: cell.obstacles dome"),
    ({"box": [1, 2], "pose": [0, 0, 0, 0, 0, 0]}, "error[BAD_VALUE] dome.yaml: cell.obstacles[0].box"),
    ({"box": [1, 2, 0]}, "1 2 0 mm is not a box"),
    ({"box": [1, 2, 3], "pose": [0, 0, 0]}, "error[BAD_VALUE] dome.yaml: cell.obstacles[0].pose"),
    ({"pose": [0, 0, 0, 0, 0, 0]}, "either a file or a box"),
    ({"box": [1, 2, 3], "at": 3}, "error[UNKNOWN_KEY] dome.yaml: cell.obstacles[0].at"),
    ("post.step", "error[BAD_VALUE] dome.yaml: cell.obstacles[0]"),
])  # fmt: skip
def test_what_says_nothing_is_refused(job, obstacle, told):
    command, folder = job(obstacles=[obstacle])
    assert command.status == 2 and told in command.err, command.err
    assert not (folder / "program").exists()
