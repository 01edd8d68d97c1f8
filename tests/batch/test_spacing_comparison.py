# SPDX-License-Identifier: LGPL-2.1-or-later
"""What spacing costs, in report.json and on the page: a bent tube on a block, planned, and walls of several faces."""

import json
import re
import xml.etree.ElementTree as ElementTree
from types import SimpleNamespace

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.core.parameters.strategy import RevolutionParameters, SurfaceParameters
from freecad_am.core.toolpath import Bead, Layer, Toolpath
from freecad_am.report import made, spacing_comparison

JOB = """\
version: 1
name: elbow
part: {file: elbow.step, faces: [Face1]}
substrate: {file: block.step}
strategy: {kind: surface, layer_height: 5 mm, chord_error: 0.1 mm, spacing: smooth, compare: [constant-distance]}
build_direction: {clearance: none}
cell: {limits: paper, platform: [0, 0, 30, 0, 0, 0]}
joints: {method: constant}
"""
METHODS = ("smooth", "iso-parameter", "centreline-normal", "constant-distance")
SEVERAL_FACES = SimpleNamespace(closes_around=False)  # what is asked of such a wall


@pytest.fixture
def elbow(workshop):
    """A bend (R = 30, r = 8) that grows out of the flat top of a block and leans over by 40 degrees."""
    shell = Part.makeTorus(
        30.0, 8.0, FreeCAD.Vector(-5, 0, 0), FreeCAD.Vector(0, -1, 0), -180, 180, 50
    )
    shell.rotate(FreeCAD.Vector(), FreeCAD.Vector(0, 1, 0), -90)
    face = next(face for face in shell.Faces if isinstance(face.Surface, Part.Toroid))
    face.exportStep(str(workshop.folder / "elbow.step"))
    Part.makeBox(60, 60, 20, FreeCAD.Vector(0, -30, -20)).exportStep(
        str(workshop.folder / "block.step")
    )
    (workshop.folder / "elbow.yaml").write_text(JOB, encoding="utf-8")
    return workshop


def test_a_job_tells_what_its_spacing_costs_and_gains(elbow):
    done = elbow.run("plan", "elbow.yaml")
    assert done.status in (0, 3), done.err
    files = elbow.files("out/elbow")
    report = json.loads(files["report.json"])
    rows = {row["method"]: row for row in report["spacing_comparison"]}
    assert tuple(sorted(rows)) == tuple(sorted(METHODS))
    assert report["spacing_comparison"][0]["method"] == "smooth"
    assert [row["method"] for row in rows.values() if row["planned"]] == ["smooth"]
    assert rows["constant-distance"]["min_mm"] == pytest.approx(5.0, abs=1e-3)
    assert rows["smooth"]["min_mm"] >= 4.0 and rows["smooth"]["max_mm"] <= 6.0
    assert rows["centreline-normal"]["max_mm"] == pytest.approx(
        2.0 * 38.0 * np.sin(5.0 / 60.0), abs=1e-3
    )
    assert rows["iso-parameter"]["max_mm"] == pytest.approx(5.0, abs=1e-3)
    with_motion = [method for method in METHODS if rows[method]["motion"]]
    assert with_motion == ["smooth", "constant-distance"]
    assert rows["smooth"]["motion"]["duration_s"] == pytest.approx(report["duration_s"], abs=10.0)
    for method in with_motion:
        motion = rows[method]["motion"]
        assert len(motion["speed_ratio_max"]) == 6
        assert motion["axis_limited_s"] >= motion["deposit_s"] > 0.0
    page = files["report.html"].decode()
    for text in (
        "Distances between layers",
        "Joint motion by spacing",
        "Normal to the centreline: ",
        "Both paths",
    ):
        assert text in page
    pictures = [
        ElementTree.fromstring(text) for text in re.findall(r"<svg.*?</svg>", page, re.DOTALL)
    ]
    plots = {picture.get("aria-label"): picture for picture in pictures}
    facts = json.loads(re.search(r'id="path-facts">(.*?)</script>', page, re.DOTALL)[1])
    assert facts["bodies"]  # the block is there
    for title in (
        "Iso-parameter",
        "Constant distance",
        "Smooth",
        "\u0394 up the lines",
        "As deposited",
    ):
        (plot,) = [plot for label, plot in plots.items() if label.startswith(title)]
        curves = [node.get("d") for node in plot.iter("path")]
        assert len(curves) >= 3 and all("L" in curve and "nan" not in curve for curve in curves)


def test_walls_of_several_faces_say_what_does_not_apply():
    circle = np.linspace(0.0, 2.0 * np.pi, 73)
    points = [
        np.c_[10 * np.cos(circle), 10 * np.sin(circle), np.full(73, height)]
        for height in (0.0, 2.0, 4.0)
    ]
    up = np.tile([0.0, 0.0, 1.0], (73, 1))
    for ring in points:
        ring[-1] = ring[0]
    layers = tuple(Layer((Bead(ring, up, up, circle, np.ones(73), True),)) for ring in points)
    toolpath = Toolpath(layers, np.eye(4), 2.0, 0.1, family="surface")
    strategy = SurfaceParameters(layer_height=2.0)
    found = spacing_comparison.compare(SEVERAL_FACES, strategy)
    first, *others = spacing_comparison.rows(found, strategy, toolpath, [np.full(73, 2.0)] * 2)
    assert (first["method"], first["planned"], first["layers"]) == ("constant-distance", True, 3)
    assert [first["min_mm"], first["max_mm"], first["reason"]] == [2.0, 2.0, None]
    assert first["cornered_layers"] is None  # nobody told the tangents
    assert {row["method"] for row in others} == set(METHODS) - {"constant-distance"}
    assert all(row["reason"] and row["layers"] is None and not row["planned"] for row in others)

    others = spacing_comparison.compare(
        SEVERAL_FACES, SurfaceParameters(layer_height=2.0, method="fronts")
    )
    told = {one.method: one.reason for one in others}
    assert (
        "strategy.method" in told["iso-parameter"]
        and "strategy.method" in told["centreline-normal"]
    )


def test_corners_of_walls_of_several_faces_are_those_of_their_beads():
    bent = np.radians(40.0)
    points = np.array(
        [[-5.0, 0.0, 0.0], [0.0, 0.0, 0.0], [5.0 * np.cos(bent), 5.0 * np.sin(bent), 0.0]]
    )
    up, path = np.tile([0.0, 0.0, 1.0], (3, 1)), np.arange(3.0)
    before, after = np.array([1.0, 0.0, 0.0]), np.array([np.cos(bent), np.sin(bent), 0.0])
    tangents = np.array([[before, before], [before, after], [after, after]])
    layers = tuple(
        Layer(
            (
                Bead(
                    points + [0.0, 0.0, 2.0 * k], up, up, path, np.ones(3), False, tangents=tangents
                ),
            )
        )
        for k in range(3)
    )
    toolpath = Toolpath(layers, np.eye(4), 2.0, 0.1, family="surface")
    strategy = SurfaceParameters(layer_height=2.0)
    found = spacing_comparison.compare(SEVERAL_FACES, strategy)
    first = spacing_comparison.rows(found, strategy, toolpath, [np.full(3, 2.0)] * 2)[0]
    assert first["cornered_layers"] == 2 and first["corner_max_deg"] == pytest.approx(40.0)


def test_parts_of_revolution_are_not_compared():
    one = SimpleNamespace(strategy=RevolutionParameters(), name="cup")
    job, planned = SimpleNamespace(features=(one,)), SimpleNamespace(planned=object())
    toolpath = Toolpath((), np.eye(4), 2.0, 0.1, family="revolution")
    (shown,) = made.compared_walls(job, toolpath, ())
    assert (shown.name, shown.compared, shown.rows, shown.band) == ("", (), (), None)
    assert made.add_motion(job, shown, planned, object(), None) == []
    assert spacing_comparison.rows((), one.strategy, None, []) == []
