# SPDX-License-Identifier: LGPL-2.1-or-later
"""The predicted deposit of several features, of cladding and of a mesh wall, whose geometry gives
expected values: how far it extends beyond the faces, layer by layer, and that its volume equals the
fed wire."""

import json
import math

import Part
import pytest
from FreeCAD import Vector

TWO = """\
version: 1
name: two
strategy: {kind: solid, layer_height: 2 mm, bead_spacing: 4 mm, margin: 2 mm, chord_error: 0.1 mm}
process: {travel_speed: 8 mm/s, machining_allowance: 1 mm}
features:
  - {name: plate, part: {file: plate.step}}
  - {name: post, part: {file: post.step}}
"""
CLAD = """\
version: 1
name: clad
part: {file: plate.step, faces: [Face6]}
strategy: {kind: cladding, layer_height: 2 mm, chord_error: 0.1 mm, bead_spacing: 5 mm, layers: %d}
process: {travel_speed: 8 mm/s, bead_width: 5 mm, machining_allowance: %s mm}
"""
VASE = """\
version: 1
name: vase
part: {file: vase.stl}
strategy: {kind: surface, layer_height: 2 mm, chord_error: 0.1 mm}
process: {bead_width: 6 mm, machining_allowance: %s mm}
"""


def planned(workshop, job):
    workshop.write_job(job)
    command = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    shape_report = report["predicted_shape"]
    assert abs(shape_report["laid_cm3"] / report["totals"]["fed_cm3"] - 1.0) < 1e-6
    return report, shape_report, {issue["code"]: issue for issue in report["issues"]}


def test_several_features_are_held_against_all_their_faces_but_where_one_stands_on_the_other(
    workshop,
):
    Part.makeBox(60.0, 40.0, 6.0).exportStep(str(workshop.folder / "plate.step"))
    Part.makeBox(16.0, 16.0, 8.0, Vector(10, 12, 6)).exportStep(str(workshop.folder / "post.step"))
    report, shape_report, issues = planned(workshop, TWO)
    layers = shape_report["layers"]
    assert (
        [row["layer"] for row in layers]
        == list(range(7))
        == list(range(report["counts"]["layers"]))
    )
    # next to the plate, and next to the post above it: the margin
    for number in (0, 1, 4, 5):
        assert (
            abs(layers[number]["beyond_mm"]["mean"] - 2.0) < 0.12
            and layers[number]["beyond_mm"]["min"] > 1.4
        )
    # the 8 mm of post on the plate's top are not counted as an allowance there; the 2 mm about its
    # foot, within its own margin, are
    spread = shape_report["spread"]
    high = sum(
        share
        for low, share in zip(spread["edges_mm"], spread["area_share"], strict=False)
        if low >= 7.0
    )
    section, volume = 20.0**2 - 16.0**2, 60.0 * 40.0 + 2.0 * 100.0 * 6.0 + 4.0 * 16.0 * 8.0
    assert high == pytest.approx(section / volume, rel=0.25)
    for worst_place in shape_report["worst_places"]:
        x, y, z = worst_place["place"]
        assert not (10.5 < x < 25.5 and 12.5 < y < 27.5 and abs(z - 6.0) < 0.5)
        assert (abs(z - 14.0) < 1e-6) == (
            worst_place["layer"] >= 5
        )  # the post's top is above the last layers
    # a margin of one layer does not cover the tops, and the worst positions name both
    assert {round(worst_place["place"][2]) for worst_place in shape_report["worst_places"]} == {
        6,
        14,
    }
    assert "strategy.margin" in issues["ALLOWANCE"]["message"]


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.always("2")
def test_a_clad_face_is_covered_as_high_as_it_was_fed(workshop, layers):
    Part.makeBox(60.0, 40.0, 10.0).exportStep(str(workshop.folder / "plate.step"))
    high = 2.0 * layers
    _, shape_report, issues = planned(workshop, CLAD % (layers, high + 0.5))
    assert abs(1000.0 * shape_report["laid_cm3"] / (60.0 * 40.0 * high) - 1.0) < 0.001
    # the deposit hangs over the edges and is round there, so less is on the face itself
    assert 0.85 * high < shape_report["beyond_mm"]["mean"] < high
    spread = shape_report["spread"]
    thick = sum(
        share
        for low, share in zip(spread["edges_mm"], spread["area_share"], strict=False)
        if low >= 0.85 * high
    )
    assert thick > 0.8
    x, y, z = shape_report["worst"][
        "place"
    ]  # a corner of the face or, where one layer fills no valley, of a contour
    aside = (min(x, 60.0 - x), min(y, 40.0 - y))
    assert z == pytest.approx(10.0) and (
        max(aside) < 1.0 if layers == 2 else abs(aside[0] - aside[1]) < 0.5
    )
    assert "Add one layer" in issues["ALLOWANCE"]["message"] and shape_report["short"] > 0.5
    again = planned(workshop, CLAD % (layers, 0.5))[1]
    assert again["short"] < 0.25 / layers  # one layer leaves valleys between its beads


def write_tube(path, radius, height, sides=180):
    """Write an open tube of triangles without ends."""
    angles = [2.0 * math.pi * k / sides for k in range(sides)]
    ring = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
    lines = ["solid tube"]
    for point, following in zip(ring, ring[1:] + ring[:1], strict=True):
        a, b, c, d = (*point, 0.0), (*following, 0.0), (*following, height), (*point, height)
        for corners in ((a, b, c), (a, c, d)):
            lines += [
                "facet normal 0 0 0",
                "outer loop",
                *("vertex {:.6f} {:.6f} {:.6f}".format(*corner) for corner in corners),
                "endloop",
                "endfacet",
            ]
    path.write_text("\n".join([*lines, "endsolid tube", ""]))


@pytest.mark.long
def test_a_mesh_wall_has_half_its_width_on_the_side_with_less(workshop):
    write_tube(workshop.folder / "vase.stl", 30.0, 20.0)
    _, shape_report, issues = planned(workshop, VASE % 2)
    assert (
        shape_report["outside"] == shape_report["short"] == 0.0
        and "ALLOWANCE" not in issues
        and "LAYER_DRIFT" not in issues
    )
    assert (
        abs(1000.0 * shape_report["laid_cm3"] / (2.0 * math.pi * 30.0 * 22.0 * 6.0) - 1.0) < 0.002
    )  # 11 layers of 6 by 2 mm
    for row in shape_report["layers"][
        1:-1
    ]:  # straight sides: half a width, measured from positions inside of chords
        assert (
            2.8 < row["beyond_mm"]["mean"] < 3.0
            and row["beyond_mm"]["min"] > 3.0 - 0.35 * shape_report["cube_mm"] - 0.1
        )
    _, shape_report, issues = planned(workshop, VASE % "3.5")
    assert shape_report["short"] == pytest.approx(1.0, abs=0.02)
    assert (
        "beads" in issues["ALLOWANCE"]["message"]
        and "process.bead_width" in issues["ALLOWANCE"]["message"]
    )
