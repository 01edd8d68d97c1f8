# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scarf seams from the job file to the programs of all controllers, judged by the waypoints."""

import csv
import json

import numpy as np
import Part
import pytest

from freecad_am.core.kinematics.machines import machine

SIDE, LAYER, SCARF, SPEED = 40.0, 2.0, 12.0, 6.0
JOB = """\
version: 1
name: bar
part: {file: bar.step}
strategy: {kind: solid, layer_height: 2 mm, bead_spacing: 4 mm, fill: contours, chord_error: 0.1 mm,
  widths: fixed}
build_direction: {clearance: none}
process:
  bead_width: 4 mm
  travel_speed: 6 mm/s
  seam: {SEAM}
"""
ROBOT = """\
cell: {machine: MACHINE, setup: tool-on-robot, nozzle: {tool: [0, 0, 150, 0, 0, 0]},
  platform_diameter: 200 mm}
joints: {method: constant}
"""
TABLE = "cell: {machine: table-xyzac, setup: rotary-table, platform: 60 mm, platform_diameter: 200 mm}\n"
POSTS = {
    "fanuc": "fanuc-arcmate120ic",
    "staubli": "staubli-rx60bl",
    "abb": "abb-irb2600-12-165",
    "kuka": "kuka-kr8-r2100-2-arc-hw",
    "yaskawa": "gp12.json",
    "ur": "ur-ur10e",
    "siemens": "",
    "linuxcnc": "",
}


def planned(workshop, seam, more_sections=""):
    if not (workshop.folder / "bar.step").exists():
        Part.makeBox(SIDE, SIDE, 2.0 * LAYER).exportStep(str(workshop.folder / "bar.step"))
    (workshop.folder / "bar.yaml").write_text(JOB.replace("{SEAM}", seam) + more_sections)
    command = workshop.run("plan", "bar.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        return [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]


def beads_of(rows):
    """Return points and speeds by layer and bead."""
    beads = {}
    for row in rows:
        beads.setdefault((int(row["layer"]), int(row["bead"])), []).append(
            [float(row[name]) for name in ("x_mm", "y_mm", "z_mm", "speed_mm_s")]
        )
    return {key: np.array(bead) for key, bead in beads.items()}


def check_scarfs(rows, usual):
    """Each bead overlaps its seam, rises there, and takes the time of the bead without a scarf."""
    count = 0
    for key, bead in beads_of(rows).items():
        step = np.linalg.norm(np.diff(bead[:, :3], axis=0), axis=1)
        plain_bead = usual[key]
        ring = np.linalg.norm(np.diff(plain_bead[:, :3], axis=0), axis=1)
        if ring.sum() < 2.0 * SCARF or np.abs(plain_bead[0, :3] - plain_bead[-1, :3]).max() > 1e-6:
            continue
        count += 1
        time = (step / bead[1:, 3]).sum()
        assert time == pytest.approx((ring / plain_bead[1:, 3]).sum(), rel=2e-4)
        flat = np.linalg.norm(np.diff(bead[:, :2], axis=0), axis=1).sum()
        assert flat == pytest.approx(ring.sum() + 0.75 * SCARF, abs=0.15)
        rise = bead[:, 2] - key[0] * LAYER
        assert rise.min() > -1e-6 and rise[-1] == rise.max() == pytest.approx(
            0.75 * LAYER, abs=0.02
        )
        assert bead[1:, 3].max() == pytest.approx(SPEED / (0.25 + 0.75 / 48.0), rel=0.05)
    return count


@pytest.mark.parametrize("post", POSTS)
def test_programs_of_all_controllers_have_the_scarf(workshop, post):
    cell = ROBOT.replace("MACHINE", POSTS[post]) if POSTS[post] else TABLE
    if post == "yaskawa":  # the pulses are known on site only
        entries = json.loads((machine.BUILT_IN / "motoman-gp12.json").read_text())
        entries["controller"]["pulses_per_degree"] = [1435.3, 1308.25, 1313.5, 980.0, 876.8, 454.75]
        (workshop.folder / "gp12.json").write_text(json.dumps(entries))
    usual = planned(workshop, "{angle: 0 deg}")
    plan = planned(workshop, "{scarf: 12 mm}", f"{cell}program: {{post: {post}}}\n")
    assert any((workshop.folder / "out" / "program").iterdir())
    assert check_scarfs(plan, beads_of(usual)) == 8
