# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cost of spacing in report.json and on the page: a planned bent tube on a block, and walls of
several faces."""

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
SEVERAL_FACES = SimpleNamespace(closes_around=False)  # the attributes that the comparison reads


@pytest.fixture
def elbow(workshop):
    """Return a job of a bend (R = 30, r = 8) that grows from the flat top of a block and leans by
    40 degrees."""
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
    command = elbow.run("plan", "elbow.yaml")
    assert command.status in (0, 3), command.err
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
    assert facts["bodies"]  # the view contains the block
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
    comparison = spacing_comparison.compare(SEVERAL_FACES, strategy)
    first_row, *methods = spacing_comparison.rows(
        comparison, strategy, toolpath, [np.full(73, 2.0)] * 2
    )
    assert (first_row["method"], first_row["planned"], first_row["layers"]) == (
        "constant-distance",
        True,
        3,
    )
    assert [first_row["min_mm"], first_row["max_mm"], first_row["reason"]] == [2.0, 2.0, None]
    assert first_row["cornered_layers"] is None  # the tangents are unknown
    assert {row["method"] for row in methods} == set(METHODS) - {"constant-distance"}
    assert all(row["reason"] and row["layers"] is None and not row["planned"] for row in methods)

    methods = spacing_comparison.compare(
        SEVERAL_FACES, SurfaceParameters(layer_height=2.0, method="fronts")
    )
    reasons = {method_result.method: method_result.reason for method_result in methods}
    assert (
        "strategy.method" in reasons["iso-parameter"]
        and "strategy.method" in reasons["centreline-normal"]
    )


def test_corners_of_walls_of_several_faces_are_those_of_their_beads():
    bent = np.radians(40.0)
    points = np.array(
        [[-5.0, 0.0, 0.0], [0.0, 0.0, 0.0], [5.0 * np.cos(bent), 5.0 * np.sin(bent), 0.0]]
    )
    up, path = np.tile([0.0, 0.0, 1.0], (3, 1)), np.arange(3.0)
    incoming, outgoing = np.array([1.0, 0.0, 0.0]), np.array([np.cos(bent), np.sin(bent), 0.0])
    tangents = np.array([[incoming, incoming], [incoming, outgoing], [outgoing, outgoing]])
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
    comparison = spacing_comparison.compare(SEVERAL_FACES, strategy)
    first_row = spacing_comparison.rows(comparison, strategy, toolpath, [np.full(3, 2.0)] * 2)[0]
    assert first_row["cornered_layers"] == 2 and first_row["corner_max_deg"] == pytest.approx(40.0)


def test_parts_of_revolution_are_not_compared():
    cup_feature = SimpleNamespace(strategy=RevolutionParameters(), name="cup")
    job, planned = SimpleNamespace(features=(cup_feature,)), SimpleNamespace(planned=object())
    toolpath = Toolpath((), np.eye(4), 2.0, 0.1, family="revolution")
    (compared,) = made.compared_walls(job, toolpath, ())
    assert (compared.name, compared.compared, compared.rows, compared.band) == ("", (), (), None)
    assert made.add_motion(job, compared, planned, object(), None) == []
    assert spacing_comparison.rows((), cup_feature.strategy, None, []) == []
