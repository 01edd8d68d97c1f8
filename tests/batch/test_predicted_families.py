# SPDX-License-Identifier: LGPL-2.1-or-later
"""The predicted deposit of several features, of cladding and of a mesh wall, each known by its own geometry: how far it
reaches beyond the faces, layer by layer, and that it holds what is fed."""

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
    done = workshop.run("plan", "cup.yaml", "-o", "out", "--no-page")
    assert done.status == 0, done.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    found = report["predicted_shape"]
    assert abs(found["laid_cm3"] / report["totals"]["fed_cm3"] - 1.0) < 1e-6
    return report, found, {issue["code"]: issue for issue in report["issues"]}


def test_several_features_are_held_against_all_their_faces_but_where_one_stands_on_the_other(
    workshop,
):
    Part.makeBox(60.0, 40.0, 6.0).exportStep(str(workshop.folder / "plate.step"))
    Part.makeBox(16.0, 16.0, 8.0, Vector(10, 12, 6)).exportStep(str(workshop.folder / "post.step"))
    report, found, issues = planned(workshop, TWO)
    layers = found["layers"]
    assert (
        [row["layer"] for row in layers]
        == list(range(7))
        == list(range(report["counts"]["layers"]))
    )
    # beside the plate, and beside the post above it: the margin
    for number in (0, 1, 4, 5):
        assert (
            abs(layers[number]["beyond_mm"]["mean"] - 2.0) < 0.12
            and layers[number]["beyond_mm"]["min"] > 1.4
        )
    # 8 mm of post on the plate's top are no allowance there; 2 mm about its foot, which its own margin covers, are
    spread = found["spread"]
    high = sum(
        share
        for low, share in zip(spread["edges_mm"], spread["area_share"], strict=False)
        if low >= 7.0
    )
    about, whole = 20.0**2 - 16.0**2, 60.0 * 40.0 + 2.0 * 100.0 * 6.0 + 4.0 * 16.0 * 8.0
    assert high == pytest.approx(about / whole, rel=0.25)
    for one in found["worst_places"]:
        x, y, z = one["place"]
        assert not (10.5 < x < 25.5 and 12.5 < y < 27.5 and abs(z - 6.0) < 0.5)
        assert (abs(z - 14.0) < 1e-6) == (
            one["layer"] >= 5
        )  # the post's top is above the last layers
    # the tops of both are not covered by a margin of one layer, and both are told by their worst place
    assert {round(one["place"][2]) for one in found["worst_places"]} == {6, 14}
    assert "strategy.margin" in issues["ALLOWANCE"]["message"]


@pytest.mark.parametrize("layers", [1, 2])
@pytest.mark.always("2")
def test_a_clad_face_is_covered_as_high_as_it_was_fed(workshop, layers):
    Part.makeBox(60.0, 40.0, 10.0).exportStep(str(workshop.folder / "plate.step"))
    high = 2.0 * layers
    _, found, issues = planned(workshop, CLAD % (layers, high + 0.5))
    assert abs(1000.0 * found["laid_cm3"] / (60.0 * 40.0 * high) - 1.0) < 0.001
    # the deposit hangs over its edges and is round there, so that less lies on the face itself
    assert 0.85 * high < found["beyond_mm"]["mean"] < high
    places = found["spread"]
    thick = sum(
        share
        for low, share in zip(places["edges_mm"], places["area_share"], strict=False)
        if low >= 0.85 * high
    )
    assert thick > 0.8
    x, y, z = found["worst"][
        "place"
    ]  # a corner of the face, or, where one layer fills no valley, of a contour
    aside = (min(x, 60.0 - x), min(y, 40.0 - y))
    assert z == pytest.approx(10.0) and (
        max(aside) < 1.0 if layers == 2 else abs(aside[0] - aside[1]) < 0.5
    )
    assert "Add one layer" in issues["ALLOWANCE"]["message"] and found["short"] > 0.5
    again = planned(workshop, CLAD % (layers, 0.5))[1]
    assert again["short"] < 0.25 / layers  # one layer leaves valleys between its beads


def write_tube(path, radius, height, sides=180):
    """An open tube of triangles, without ends."""
    angles = [2.0 * math.pi * k / sides for k in range(sides)]
    ring = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
    lines = ["solid tube"]
    for one, other in zip(ring, ring[1:] + ring[:1], strict=True):
        a, b, c, d = (*one, 0.0), (*other, 0.0), (*other, height), (*one, height)
        for corners in ((a, b, c), (a, c, d)):
            lines += [
                "facet normal 0 0 0",
                "outer loop",
                *("vertex {:.6f} {:.6f} {:.6f}".format(*at) for at in corners),
                "endloop",
                "endfacet",
            ]
    path.write_text("\n".join([*lines, "endsolid tube", ""]))


@pytest.mark.long
def test_a_mesh_wall_has_half_its_width_on_the_side_with_less(workshop):
    write_tube(workshop.folder / "vase.stl", 30.0, 20.0)
    _, found, issues = planned(workshop, VASE % 2)
    assert (
        found["outside"] == found["short"] == 0.0
        and "ALLOWANCE" not in issues
        and "LAYER_DRIFT" not in issues
    )
    assert (
        abs(1000.0 * found["laid_cm3"] / (2.0 * math.pi * 30.0 * 22.0 * 6.0) - 1.0) < 0.002
    )  # 11 layers of 6 by 2 mm
    for row in found["layers"][
        1:-1
    ]:  # straight sides: half a width, seen from places inside of chords
        assert (
            2.8 < row["beyond_mm"]["mean"] < 3.0
            and row["beyond_mm"]["min"] > 3.0 - 0.35 * found["cube_mm"] - 0.1
        )
    _, found, issues = planned(workshop, VASE % "3.5")
    assert found["short"] == pytest.approx(1.0, abs=0.02)
    assert (
        "beads" in issues["ALLOWANCE"]["message"]
        and "process.bead_width" in issues["ALLOWANCE"]["message"]
    )
