# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shipped examples are the paper's parts and show what the paper shows."""

import csv
import json
import shutil

import numpy as np
import pytest


@pytest.fixture(params=[("hemisphere", 71), ("laval-nozzle", 137), ("intake-funnel", 71)], ids=lambda p: p[0])
def example(request, workshop, root):
    """Report, rows and number of layers of an example, run in a folder of its own."""
    name, layers = request.param
    for ending in ("yaml", "step"):
        shutil.copy(root / "resources" / "examples" / f"{name}.{ending}", workshop.folder)
    done = workshop.run("plan", f"{name}.yaml", "-o", "out")
    assert done.status == 0, done.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    with open(workshop.folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
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
    if name == "hemisphere":
        points = np.array([[float(row[f"{axis}_mm"]) for axis in "xyz"] for row in rows])
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), 45.0, atol=1e-3)
        chord = 90.0 * np.sin(0.5 / 45.0)
        assert abs(report["spacing_mm"]["min"] - chord) < 1e-3 and abs(report["spacing_mm"]["max"] - chord) < 1e-3
