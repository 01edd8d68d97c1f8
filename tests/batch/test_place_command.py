# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command `place` writes a table of poses, a page, and a line that makes an infeasible job
feasible."""

import csv

import pytest
import yaml

from tests.batch.conftest import JOB

UNREACHABLE_POSE = [
    1045.747,
    -630.155,
    2153.167,
    0,
    0,
    0,
]  # too high: the part is out of reach there
BOX = {"x": 0, "y": 0, "z": "1500 mm", "step": "500 mm", "points": 60}


@pytest.fixture
def job(workshop):
    """Return a function that writes the job with its part at a pose and a box, and returns its
    path."""

    def write(pose, box):
        values = yaml.safe_load(JOB)
        values["strategy"]["layer_height"] = "10 mm"
        values["cell"]["deposition_point"] = pose
        values["place"] = box
        (workshop.folder / "cup.yaml").write_text(yaml.safe_dump(values), encoding="utf-8")

    return write


def test_the_line_makes_a_job_feasible(workshop, job):
    job(UNREACHABLE_POSE, BOX)
    assert workshop.run("plan", "cup.yaml", "-o", "first", "--no-page").status == 3
    command = workshop.run("place", "cup.yaml", "-o", "out")
    assert command.status == 0 and "note[PLACED]" in command.err, command.err
    line = yaml.safe_load(command.out)
    with open(workshop.folder / "out" / "place.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 7 and {row["feasible"] for row in rows} == {"yes", "no"}
    best = next(
        row
        for row in rows
        if float(row["z_mm"]) == pytest.approx(line["deposition_point"][2], abs=1e-6)
    )
    assert (best["feasible"], best["all_points"], best["code"]) == ("yes", "yes", "")
    page = (workshop.folder / "out" / "place.html").read_text(encoding="utf-8")
    assert page.count('title="[') == 7 and page.count('class="best"') == 1
    assert "://" not in page
    job(line["deposition_point"], BOX)
    assert workshop.run("plan", "cup.yaml", "-o", "second", "--no-page").status == 0
    assert {path.name for path in (workshop.folder / "out").iterdir()} == {
        "place.csv",
        "place.html",
    }


def test_no_pose_serves(workshop, job):
    job([6000, 0, 0, 0, 0, 0], BOX)
    command = workshop.run("place", "cup.yaml", "-o", "out")
    assert command.status == 3 and "error[NO_PLACE]" in command.err and command.out == ""
    assert (workshop.folder / "out" / "place.csv").is_file()


@pytest.mark.parametrize(("box", "told"), [
    ({"moves": "positioner"}, "error[NOT_FOR_SETUP] cup.yaml:"), ({"step": "0 mm"}, "error[BAD_VALUE] cup.yaml:"),
    ({"width": 3}, "error[UNKNOWN_KEY] cup.yaml:"), ({"step": "1 mm"}, "larger step"),
])  # fmt: skip
def test_boxes_that_say_nothing_are_refused(workshop, job, box, told):
    job(UNREACHABLE_POSE, box)
    command = workshop.run("place", "cup.yaml", "-o", "out")
    assert command.status == 2 and told in command.err, command.err
    assert not (workshop.folder / "out").exists()
