# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shipped examples are the parts of the paper and reproduce its results."""

import csv
import json
import os
import shutil
import subprocess
from pathlib import Path

import FreeCAD  # noqa: F401  Part crashes without it
import numpy as np
import Part
import pytest

from freecad_am.batch.job.job import read_job
from tests.batch import row_limits

EXAMPLES = Path(__file__).parents[2] / "resources" / "examples"
WITH_A_CELL = [
    path
    for path in sorted(EXAMPLES.glob("**/*.yaml"))
    if "cell:" in path.read_text(encoding="utf-8")
]
ON_SUBSTRATES = [
    path
    for path in WITH_A_CELL
    if "substrate:" in (text := path.read_text(encoding="utf-8")) and "kind: surface" in text
]


@pytest.fixture(
    params=[
        ("hemisphere", 71),
        *(
            pytest.param(example_layers, marks=pytest.mark.long)
            for example_layers in (("laval-nozzle", 137), ("intake-funnel", 71))
        ),
    ],
    ids=lambda p: p[0],
)
def example(request, workshop, root):
    """Return report, rows and number of layers of an example, run in a folder of its own."""
    name, layers = request.param
    for ending in ("yaml", "step"):
        shutil.copy(root / "resources" / "examples" / f"{name}.{ending}", workshop.folder)
    command = workshop.run("plan", f"{name}.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    cell = read_job(str(workshop.folder / f"{name}.yaml")).cell
    assert row_limits.over_all(workshop.folder / "out", cell.machine, cell.limits) <= 0.0
    return name, layers, report, rows


def test_shows_what_the_paper_shows(example):
    name, layers, report, rows = example
    assert report["counts"]["layers"] == layers
    assert report["joints"]["feasible"] is True
    compared = {entry["method"]: entry for entry in report["comparison"]}
    assert set(compared) == {"constant", "point-by-point"}
    assert compared["constant"]["feasible"] is False
    layer = np.array([int(row["layer"]) for row in rows])
    angles = np.array([[float(row[f"q{axis}_deg"]) for axis in range(1, 7)] for row in rows])
    ranges = np.array([np.ptp(angles[layer == index], axis=0) for index in range(layers)])
    assert ranges[:, :5].max() < 0.01
    np.testing.assert_allclose(ranges[:, 5], 360.0, atol=1e-3)
    assert report["programs"]
    issues = [json.dumps(issue) for issue in report["issues"]]
    assert len(issues) == len(set(issues)), (
        issues
    )  # both the feature and the toolpath report the step of the nozzle
    if name == "hemisphere":
        points = np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows])
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), 45.0, atol=1e-3)
        chord = 90.0 * np.sin(0.5 / 45.0)
        assert (
            abs(report["spacing_mm"]["min"] - chord) < 1e-3
            and abs(report["spacing_mm"]["max"] - chord) < 1e-3
        )


@pytest.mark.long
@pytest.mark.parametrize("path", WITH_A_CELL, ids=lambda path: path.stem)
def test_no_row_of_a_shipped_example_is_beyond_a_limit(path, root, tmp_path):
    """No waypoint and no program of an example exceeds a limit, at its shipped settings; examples
    that another test plans coarser are checked there."""
    process = subprocess.run(
        [str(root / "freecad-am"), "plan", str(path), "-o", str(tmp_path / "out"), "--no-page"],
        cwd=tmp_path,
        capture_output=True,
        env={**os.environ, "FREECAD_USER_HOME": str(tmp_path)},
        text=True,
        check=False,
        timeout=3600,
    )
    assert process.returncode == 0, process.stderr
    cell = read_job(str(path)).cell
    assert row_limits.over_all(tmp_path / "out", cell.machine, cell.limits) <= 0.0


BEND, TUBE = 60.0, 15.0


def test_layers_of_the_bend_are_evenly_spaced(workshop, root):
    """Without a cell the planner adds no points, so the spacing is that of the fronts."""
    folder = root / "resources" / "examples"
    for name in ("tube-on-pipe.step", "pipe.step"):
        shutil.copy(folder / name, workshop.folder)
    text = (folder / "tube-on-pipe.yaml").read_text(encoding="utf-8").split("cell:")[0]
    (workshop.folder / "bend.yaml").write_text(
        text.replace("end: trim", "end: whole"), encoding="utf-8"
    )
    command = workshop.run("plan", "bend.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["counts"]["layers"] == report["counts"]["beads"] == 10
    assert (
        abs(report["spacing_mm"]["min"] - 5.0) < 1e-3
        and abs(report["spacing_mm"]["max"] - 5.0) < 1e-3
    )
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    x, y, z = np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows]).T
    assert np.abs(np.hypot(np.hypot(x + BEND, z) - BEND, y) - TUBE).max() < 1e-4


def test_a_bend_cannot_grow_on_a_surface(workshop, root):
    import Part

    folder = root / "resources" / "examples"
    shutil.copy(folder / "tube-on-pipe.step", workshop.folder)
    Part.read(str(folder / "pipe.step")).Faces[0].exportStep(str(workshop.folder / "surface.step"))
    text = (folder / "tube-on-pipe.yaml").read_text(encoding="utf-8")
    for substrate, code in (("surface", "NO_SOLID"), ("tube-on-pipe", "OWN_SUBSTRATE")):
        (workshop.folder / "bend.yaml").write_text(
            text.replace(" pipe.step", f" {substrate}.step"), encoding="utf-8"
        )
        command = workshop.run("plan", "bend.yaml")
        assert (command.status, command.err.count(f"error[{code}]")) == (2, 1), command.err


@pytest.mark.parametrize("path", ON_SUBSTRATES, ids=lambda path: path.stem)
def test_no_platform_goes_through_what_stands_on_it(path):
    job = read_job(str(path))
    if job.cell.platform_diameter == 0.0:
        return
    plate = Part.Face(
        Part.Wire(Part.makeCircle(0.5 * job.cell.platform_diameter))
    )  # in the plane of the part's frame
    solid = Part.Shape()
    solid.read(str(path.parent / job.substrate.file))
    assert plate.common(solid).Area == 0.0
