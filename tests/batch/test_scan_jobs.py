# SPDX-License-Identifier: LGPL-2.1-or-later
"""`substrate.scan` in a job file: the equations of the scanned surfaces check the written rows of a
block on a curved plate and a bend on an oval pipe; invalid scans are rejected."""

import csv
import json

import numpy as np
import Part
import pytest
import yaml

from tests.core.inspection.test_scan import bent, points_on

BLOCK = {"kind": "solid", "layer_height": "4 mm", "bead_spacing": "10 mm", "chord_error": "0.1 mm"}


@pytest.fixture(scope="module")
def parts(tmp_path_factory):
    folder = tmp_path_factory.mktemp("parts")
    plate, block = Part.makeBox(200, 120, 10), Part.makeBox(80, 30, 24)
    plate.translate((-100, -60, -10))
    block.translate((-40, -15, 0))
    plate.exportStep(str(folder / "plate.step"))
    block.exportStep(str(folder / "block.step"))
    np.savetxt(
        folder / "scan.csv",
        points_on(bent, count=8_000),
        delimiter=",",
        header="x,y,z",
        comments="",
    )
    return folder


@pytest.fixture
def job(workshop, parts):
    """Return a function that plans the block on the plate with keys of its substrate, and returns
    its end and its output folder."""

    def plan(more=None, **substrate):
        values = {
            "version": 1,
            "name": "block",
            "part": {"file": str(parts / "block.step")},
            "strategy": BLOCK,
            "substrate": {
                "file": str(parts / "plate.step"),
                "scan": str(parts / "scan.csv"),
                **substrate,
            },
            **(more or {}),
        }
        (workshop.folder / "block.yaml").write_text(yaml.safe_dump(values), encoding="utf-8")
        return workshop.run(
            "plan", "block.yaml", "-o", "out", *(() if more else ("--no-page",))
        ), workshop.folder / "out"

    return plan


def deposit(folder, layer):
    with open(folder / "waypoints.csv", encoding="utf-8", newline="") as file:
        rows = [
            row
            for row in csv.DictReader(file)
            if row["kind"] == "deposit" and int(row["layer"]) == layer
        ]
    return np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows])


def test_a_block_stands_on_the_plate_as_it_was_scanned(job, parts):
    """One percent of the points are far off the plate."""
    points = np.loadtxt(parts / "scan.csv", delimiter=",", skiprows=1)
    astray = np.abs(points[:, 2] - bent(points[:, 0], points[:, 1])) > 1.0
    assert 0.009 < astray.mean() <= 0.01
    command, folder = job(
        {
            "cell": {"machine": "fanuc-arcmate120ic", "platform": "20 mm"},
            "program": {"post": "fanuc"},
        }
    )
    assert (command.status, command.err.count("error")) == (0, 0)
    x, y, z = deposit(folder, 0).T
    assert np.abs(z - bent(x, y)).max() < 0.06 and np.ptp(bent(x, y)) > 1.0
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert report["status"] == "ok" and report["programs"]
    scan = report["scan"]
    assert (
        scan["left_mm"] < 0.06
        and scan["remains_mm"] == 0.0
        and scan["motion"] == np.eye(4).tolist()
    )
    assert scan["off_mm"]["max"] == pytest.approx(bent(x, y).max(), abs=0.06)
    assert deposit(folder, scan["layers"])[:, 2] == pytest.approx(4.0 * scan["layers"])
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert (
        page.count("Layer 0 as planned") == 2 and page.count("Layer 0 as deposited") == 2
    )  # a picture for each, and its name


@pytest.mark.long
def test_a_wall_leaves_a_pipe_where_it_was_scanned(workshop, root):
    def radius(azimuth, along):
        return 32.0 + 0.6 * np.cos(2.0 * azimuth) + 0.01 * along

    def sag(along):
        return 0.8 * (along / 60.0) ** 2

    rng = np.random.default_rng(5)
    azimuth, along = rng.uniform(-np.pi, np.pi, 8000), rng.uniform(-60.0, 60.0, 8000)
    radii = radius(azimuth, along) + rng.normal(0.0, 0.02, 8000)
    points = np.column_stack([radii * np.sin(azimuth), along, radii * np.cos(azimuth) + sag(along)])
    points[:80] += rng.uniform(-20.0, 40.0, (80, 3))
    np.savetxt(workshop.folder / "pipe.xyz", points)
    examples = root / "resources" / "examples"
    values = {
        "version": 1,
        "name": "bend",
        "part": {"file": str(examples / "tube-on-pipe.step")},
        "substrate": {"file": str(examples / "pipe.step"), "scan": "pipe.xyz"},
        "strategy": {
            "kind": "surface",
            "layer_height": "12 mm",
            "end": "trim",
            "chord_error": "0.1 mm",
        },
    }
    (workshop.folder / "bend.yaml").write_text(yaml.safe_dump(values), encoding="utf-8")
    command = workshop.run("plan", "bend.yaml", "-o", "out", "--no-page")
    assert (command.status, "SCAN_FITTED" in command.err) == (0, True)
    x, y, z = deposit(workshop.folder / "out", 0).T
    high = z - sag(y)
    assert np.abs(np.hypot(x, high) - radius(np.arctan2(x, high), y)).max() < 0.06
    assert np.abs(np.hypot(x, z) - 32.0).max() > 0.4


def test_a_job_after_a_layer_begins_above_it(job, workshop):
    points = points_on(lambda x, y: 8.0 - 0.5 + 0.003 * x, (40.0, 15.0), 6000)
    np.savetxt(workshop.folder / "grown.xyz", points)
    command, folder = job(
        {
            "cell": {"machine": "fanuc-arcmate120ic", "platform": "20 mm"},
            "program": {"post": "fanuc"},
        },
        scan="grown.xyz",
        after_layer=1,
    )
    assert command.status == 0
    x, _, z = deposit(folder, 2).T
    assert np.abs(z - (7.5 + 0.003 * x)).max() < 0.06
    text = "".join(path.read_text(encoding="ascii") for path in (folder / "program").iterdir())
    assert "!layer 2 ;" in text and "!layer 1 ;" not in text and "!layer 0 ;" not in text


@pytest.mark.parametrize(
    ("code", "substrate"),
    [
        ("SCAN_UNIT", {"scan": "metres.csv"}),
        ("SCAN_OTHER", {"scan": "ball.csv"}),
        ("NO_FILE", {"scan": "none.csv"}),
        ("BAD_VALUE", {"scan_fit": "tight"}),
        ("BAD_VALUE", {"scan": None, "after_layer": 2}),
        ("BAD_VALUE", {"scan_fit": "best", "after_layer": 2}),
        ("BAD_VALUE", {"scan_pairs": "1 2 > 3"}),
    ],
)
def test_scans_of_something_else_are_refused(job, parts, workshop, code, substrate):
    points = np.loadtxt(parts / "scan.csv", delimiter=",", skiprows=1)
    np.savetxt(workshop.folder / "metres.csv", 1e-3 * points, delimiter=",")
    ball = np.random.default_rng(2).normal(size=(3000, 3))
    np.savetxt(
        workshop.folder / "ball.csv",
        90.0 * ball / np.linalg.norm(ball, axis=1, keepdims=True),
        delimiter=",",
    )
    command, folder = job(**substrate)
    assert command.status == 2 and f"error[{code}]" in command.err and not folder.exists()
