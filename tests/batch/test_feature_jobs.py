# SPDX-License-Identifier: LGPL-2.1-or-later
"""Jobs of several features: keys and refusals. Waypoints and text, checked with OpenCASCADE, show
that each feature is on its part, that later ones keep clear of earlier ones, and that layers have
consecutive numbers."""

import csv
import json
import math
import shutil

import numpy as np
import Part
import pytest
from FreeCAD import Vector

from freecad_am.batch.job import job as jobs
from freecad_am.core.issues import InputError

START = """\
strategy: {kind: solid, layer_height: 5 mm, chord_error: 0.1 mm}
process: {travel_speed: 6 mm/s}
features:
  - {name: plate, part: {file: plate.step}}
"""
POST = "  - {name: post, part: {file: post.step}}\n"


@pytest.fixture
def read(tmp_path):
    for name in ("plate.step", "post.step", "wall.stl"):
        (tmp_path / name).write_text("")

    def read_text(text):
        path = tmp_path / "job.yaml"
        path.write_text(text, encoding="utf-8")
        return jobs.read_job(str(path))

    return read_text


def test_what_stands_at_the_top_is_the_default_of_all(read):
    job = read(
        START
        + """\
  - {name: post, part: {file: post.step}, strategy: {layer_height: 2 mm}, process: {seam: {angle: 90 deg}}}
  - {part: {file: post.step}, strategy: {kind: revolution}, process: {travel_speed: 9 mm/s}}
sequence: height
"""
    )
    assert [feature.name for feature in job.features] == [
        "plate",
        "post",
        "feature 3",
    ] and job.sequence == "height"
    assert [feature.strategy.layer_height for feature in job.features] == [5.0, 2.0, 5.0]
    assert [feature.process.travel_speed for feature in job.features] == [6.0, 6.0, 9.0]
    assert (
        job.features[1].process.seam.angle == pytest.approx(math.pi / 2)
        and job.process.seam.angle == 0.0
    )
    assert job.part.file.endswith("plate.step") and read(START).features[0].name == "plate"


def test_defaults_that_a_family_does_not_have_are_left_out(read):
    job = read(
        "part: {file: plate.step, solids: [Solid1]}\nsubstrate: {file: post.step}\nprocess: {bead_model: csw}\n"
        "strategy: {kind: solid, fill: zigzag, layer_height: 2 mm}\nbuild_direction: {mode: fixed}\nfeatures:\n"
        "  - {name: a}\n  - {name: b, part: {solids: [Solid2]}, strategy: {kind: revolution}}\n"
        "  - {name: c, strategy: {kind: developable}}\n  - {name: d, part: {file: wall.stl}}\n"
    )
    revolution, solid, surface_, curves_ = job.features
    assert (revolution.part.solids, solid.part.solids, curves_.part.solids) == (
        ("Solid1",),
        ("Solid2",),
        (),
    )
    assert revolution.substrate.file.endswith("post.step") and solid.substrate is None
    assert (solid.strategy.layer_height, solid.process.bead_model, surface_.process.bead_model) == (
        2.0,
        "none",
        "csw",
    )
    assert (solid.build_direction.mode, surface_.build_direction.mode) == ("fixed", "local")


@pytest.mark.parametrize(
    ("more", "code", "told"),
    [
        (
            "  - {name: post, part: {file: missing.step}}\n",
            "NO_FILE",
            ["features[1].part.file", "feature post", "line 5"],
        ),
        (
            "  - {name: post, part: {file: post.step}, strategy: {layer_height: 0 mm}}\n",
            "BAD_VALUE",
            ["features[1].strategy.layer_height", "feature post"],
        ),
        (
            "  - {name: post, part: {file: post.step}, strategy: {wall: inner}}\n",
            "UNKNOWN_KEY",
            ["features[1].strategy.wall"],
        ),
        (
            "  - {name: post, part: {file: post.step}, cell: {}}\n",
            "UNKNOWN_KEY",
            ["features[1].cell"],
        ),
        (
            "  - {name: plate, part: {file: post.step}}\n",
            "BAD_VALUE",
            ["features[1].name", "'plate' is the name of another"],
        ),
        ("  - {name: post}\n", "NO_PART", ["features[1].part", "feature post"]),
        ("  - post.step\n", "BAD_VALUE", ["features[1]", "not a section"]),
        (
            "  - {name: post, part: {file: post.step, solids: [Face1]}}\n",
            "BAD_VALUE",
            ["features[1].part.solids"],
        ),
        (
            "  - {name: post, part: {file: wall.stl, solids: [Solid1]}}\n",
            "BAD_VALUE",
            ["features[1].part.solids", "mesh"],
        ),
        (POST + "sequence: random\n", "BAD_VALUE", ["sequence", "feature, height"]),
    ],
)
def test_what_is_refused_names_feature_and_key(read, more, code, told):
    with pytest.raises(InputError) as caught:
        read(START + more)
    line = caught.value.line()
    assert caught.value.code == code and all(text in line for text in told), line


@pytest.mark.parametrize(
    "features",
    [
        "features: []",
        "features: {}",
        "features: hub",
        "part: {file: plate.step}\nsequence: height",
    ],
)
def test_a_list_that_is_none(read, features):
    with pytest.raises(InputError) as caught:
        read(features + "\n")
    assert caught.value.code == "BAD_VALUE"


def planned(workshop, text, **shapes):
    """Return end, report and rows of waypoints of a job with parts of these names."""
    for name, shape in shapes.items():
        shape.exportStep(str(workshop.folder / f"{name}.step"))
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    report = workshop.folder / "out" / "report.json"
    rows = waypoints(workshop.folder) if report.is_file() else []
    return (
        command,
        json.loads(report.read_text(encoding="utf-8")) if report.is_file() else None,
        rows,
    )


def waypoints(folder):
    with open(folder / "out" / "waypoints.csv", encoding="utf-8", newline="") as stream:
        return [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]


def of(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


PLATE = Part.makeBox(40, 40, 20)
JOB = START + POST


def test_a_feature_that_floats_or_overlaps_is_refused(workshop):
    command, report, _ = planned(
        workshop, JOB, plate=PLATE, post=Part.makeBox(10, 10, 10, Vector(100, 0, 30))
    )
    assert command.status == 2 and report is None and "error[FLOATS] post:" in command.err
    command, report, _ = planned(
        workshop, JOB, plate=PLATE, post=Part.makeCylinder(12, 30, Vector(20, 20, 15))
    )
    assert (
        command.status == 2
        and report is None
        and "error[OVERLAP] post:" in command.err
        and "overlap plate" in command.err
    )
    assert f"{math.pi * 12**2 * 5 / 1000:.4g} cm3" in command.err
    upside = START.replace("plate", "post") + POST.replace(
        "post", "plate"
    )  # its support comes later
    command, report, _ = planned(
        workshop, upside, plate=PLATE, post=Part.makeCylinder(12, 30, Vector(20, 20, 20))
    )
    assert command.status == 2 and "error[FLOATS] post:" in command.err


def test_what_holds_for_the_whole_program_is_no_features_own(workshop):
    text = JOB.replace("post.step}}", "post.step}, process: {rapid_speed: 5 mm/s}}")
    command, _, _ = planned(
        workshop, text, plate=PLATE, post=Part.makeBox(9, 9, 9, Vector(0, 0, 20))
    )
    assert (
        command.status == 2
        and "NOT_FOR_FEATURE" in command.err
        and "process.rapid_speed" in command.err
    )


def test_a_list_of_one_is_the_job_without_it(workshop):
    command, report, listed = planned(workshop, START, plate=PLATE)
    assert command.status == 0 and "features" not in report
    plain = "part: {file: plate.step}\n" + START[: START.index("features")]
    assert planned(workshop, plain, plate=PLATE)[2] == listed


TOWERS = """\
strategy: {kind: solid, layer_height: 4 mm, chord_error: 0.2 mm, bead_spacing: 4 mm}
features:
  - {name: plate, part: {file: plate.step}}
  - {name: left, part: {file: left.step}}
  - {name: right, part: {file: right.step}, strategy: {layer_height: 3 mm}, process: {travel_speed: 9 mm/s}}
"""
GAP, TALL = 4.0, 36.0
LEFT_TOWER = Part.makeBox(16, 20, TALL, Vector(0, 0, 8))
TOWER_PARTS = {
    "plate": Part.makeBox(36, 20, 8),
    "left": LEFT_TOWER,
    "right": Part.makeBox(16, 20, TALL, Vector(16 + GAP, 0, 8)),
}


LEFT_TOWER_CORE = Part.makeBox(
    15.5, 20, TALL - 4.0, Vector(0, 0, 8)
)  # the safe core, because beads are round
SLOPE, LENGTH = math.tan(math.radians(20.0)), 60.0


def nozzle(point, tool, clear=4.5):
    """Return the default nozzle from a little above the tip as a solid."""
    foot = Vector(*(point + clear * tool))
    return Part.makeCone(
        0.5 + clear * SLOPE, 0.5 + LENGTH * SLOPE, LENGTH - clear, foot, Vector(*tool)
    )


def test_later_features_keep_clear_of_earlier_ones(workshop):
    """A tower next to an earlier one: a vertical nozzle would cut it, the tilted one does not."""
    command, report, rows = planned(workshop, TOWERS, **TOWER_PARTS)
    assert command.status == 0, command.err
    layer, speed = of(rows, "layer").ravel(), of(rows, "speed_mm_s").ravel()
    assert sorted(set(layer)) == list(range(2 + 9 + 12)) and (np.diff(layer) >= 0).all()
    assert [feature["layers"] for feature in report["features"]] == [
        [0, 1],
        list(range(2, 11)),
        list(range(11, 23)),
    ]
    points, build, tool = (
        of(rows, "x_mm", "y_mm", "z_mm"),
        of(rows, "bx", "by", "bz"),
        of(rows, "tx", "ty", "tz"),
    )
    # layers have consecutive numbers and are in their planes
    np.testing.assert_allclose(
        points[:, 2], np.where(layer < 11, 4.0 * layer, 8.0 + 3.0 * (layer - 11)), atol=1e-6
    )
    assert set(np.round(speed[layer >= 11], 6)) == {9.0} and set(
        np.round(speed[layer < 11], 6)
    ) == {6.0}
    np.testing.assert_allclose(tool[layer < 11], build[layer < 11], atol=1e-9)
    near_points = np.flatnonzero((layer == 13) & (points[:, 0] < 16 + GAP + 5.0))
    assert len(near_points) and any(
        nozzle(points[k], build[k]).common(LEFT_TOWER_CORE).Volume > 1.0 for k in near_points
    )
    for k in near_points:
        assert nozzle(points[k], tool[k]).common(LEFT_TOWER_CORE).Volume < 1e-6
    volume = sum(tower.Volume for tower in TOWER_PARTS.values()) / 1000.0
    assert report["deposit"]["part_cm3"] == pytest.approx(volume, rel=1e-3)
    laid = sum(
        feature["length_mm"] * 4.0 * feature["layer_height_mm"] for feature in report["features"]
    )
    assert report["totals"]["volume_cm3"] == pytest.approx(laid / 1000.0, rel=1e-6)


RINGS = """\
strategy: {kind: revolution, layer_height: 4 mm, chord_error: 0.2 mm}
features:
  - {name: outer, part: {file: outer.step, faces: [Face1]}, process: {bead_width: 16 mm}}
  - {name: inner, part: {file: inner.step, faces: [Face1]}}
"""


def test_a_part_of_revolution_keeps_clear_of_the_flank_of_a_wider_bead_that_stands(workshop):
    """A ring of 16 mm beads is around one of 8 mm: a vertical nozzle passes the centre line of the
    wide beads but cuts their flank, half of their width nearer."""
    command, report, rows = planned(
        workshop, RINGS, outer=Part.makeCylinder(40, 32), inner=Part.makeCylinder(25, 32)
    )
    assert command.status == 0, command.err
    assert [len(feature["layers"]) for feature in report["features"]] == [9, 9]
    layer = of(rows, "layer").ravel()
    points, build, tool = (
        of(rows, "x_mm", "y_mm", "z_mm"),
        of(rows, "bx", "by", "bz"),
        of(rows, "tx", "ty", "tz"),
    )
    radius = np.hypot(points[:, 0], points[:, 1])
    np.testing.assert_allclose(radius, np.where(layer < 9, 40.0, 25.0), atol=1e-6)
    np.testing.assert_allclose(tool[layer < 9], build[layer < 9], atol=1e-9)
    # beads are round at their sides: keep half of each, where it is as wide
    line, ring = (
        Part.makeCylinder(outer, 32).cut(Part.makeCylinder(inner, 32))
        for outer, inner in ((40.1, 39.9), (46.0, 34.0))
    )
    first_rows = np.flatnonzero(layer == 9)
    for k in first_rows[:: len(first_rows) // 8]:
        upright = nozzle(points[k], build[k])
        assert upright.common(line).Volume == 0.0 and upright.common(ring).Volume > 1.0
    for k in np.flatnonzero(layer >= 9)[::11]:
        assert nozzle(points[k], tool[k]).common(ring).Volume < 1e-6


def test_by_height_the_lowest_layer_comes_first(workshop):
    """No higher deposit is next to the nozzle, and no tool tilts."""
    command, report, rows = planned(workshop, TOWERS + "sequence: height\n", **TOWER_PARTS)
    assert command.status == 0, command.err
    points, layer = of(rows, "x_mm", "y_mm", "z_mm"), of(rows, "layer").ravel()
    assert (np.diff(points[:, 2]) >= -1e-9).all() and sorted(set(layer)) == list(range(23))
    left_layers, right_layers = (feature["layers"] for feature in report["features"][1:])
    assert (
        sorted([0, 1, *left_layers, *right_layers]) == list(range(23))
        and left_layers[1] > right_layers[0]
    )
    for numbers, low, high in ((left_layers, 0.0, 16.0), (right_layers, 16.0 + GAP, 36.0)):
        own_x = points[np.isin(layer, numbers), 0]
        assert low < own_x.min() and own_x.max() < high
    np.testing.assert_allclose(of(rows, "tx", "ty", "tz"), of(rows, "bx", "by", "bz"), atol=1e-9)
    assert report["unsupported_mm"] == 0.0


def test_the_shipped_hub_with_fins_and_branch(workshop, root):
    """Three families in one program: each feature is on its own solid or face of the file, and the
    text has all points."""
    for name in ("finned-hub.step", "finned-hub.yaml"):
        shutil.copy(root / "resources" / "examples" / name, workshop.folder)
    text = (workshop.folder / "finned-hub.yaml").read_text(encoding="utf-8")
    text = text.replace("layer_height: 2 mm", "layer_height: 5 mm").replace(
        "chord_error: 0.02 mm", "chord_error: 0.1 mm"
    )
    (workshop.folder / "job.yaml").write_text(text, encoding="utf-8")
    command = workshop.run("plan", "job.yaml", "-o", "out", "--no-page")
    assert command.status == 0, command.err
    report = json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))
    rows = waypoints(workshop.folder)
    assert [feature["name"] for feature in report["features"]] == [
        "hub",
        "fins",
        "branch",
    ] and report["status"] == "ok"
    layer, points = of(rows, "layer").ravel(), of(rows, "x_mm", "y_mm", "z_mm")
    build, tool = of(rows, "bx", "by", "bz"), of(rows, "tx", "ty", "tz")
    assert (np.diff(layer) >= 0).all() and sorted(set(layer)) == list(
        range(report["counts"]["layers"])
    )
    shape = Part.Shape()
    shape.read(str(workshop.folder / "finned-hub.step"))
    hub, *fins = shape.Solids
    expected_shapes = {"hub": hub, "fins": Part.makeCompound(fins), "branch": shape.Faces[17]}
    for feature in report["features"]:
        own_rows = np.flatnonzero(np.isin(layer, feature["layers"]))
        sample = own_rows[:: max(1, len(own_rows) // 60)]
        # a line of fill may be in the middle of the first layer's bead, on the surface of the hub
        expected_shape = expected_shapes[feature["name"]]
        off = max(
            0.0
            if expected_shape.Solids
            and any(
                solid.isInside(Vector(*points[k]), 1e-6, True) for solid in expected_shape.Solids
            )
            else Part.Vertex(*points[k]).distToShape(expected_shape)[0]
            for k in sample
        )
        assert len(sample) > 20 and off < 0.1 + 0.02, (feature["name"], off)
        if feature["name"] != "hub":
            assert all(nozzle(points[k], tool[k], 7.0).common(hub).Volume < 1e-6 for k in sample)
    radial = points[np.isin(layer, report["features"][1]["layers"])]
    assert set(np.sign(radial[:, 0])) == {-1.0, 1.0}
    assert report["unsupported_mm"] == 0.0 and (np.einsum("ij,ij->i", build, tool) > 0.5).all()
    (program,) = (workshop.folder / "out" / "program").iterdir()
    assert (
        program.read_text(encoding="ascii").count("\nP[") >= len(rows) - report["counts"]["beads"]
    )


def test_a_wall_in_the_middle_lies_on_its_part(workshop):
    """It was once rejected as off the part, because its distance was measured from the faces on
    both sides."""
    tube = Part.makeCylinder(30, 20).cut(Part.makeCylinder(24, 20))
    command, report, rows = planned(
        workshop,
        "part: {file: tube.step}\nstrategy: {wall: middle, layer_height: 5 mm, chord_error: 0.1 mm}\n"
        "process: {bead_width: 6 mm}\n",
        tube=tube,
    )
    assert command.status == 0, command.err
    assert (
        np.abs(np.hypot(*of(rows, "x_mm", "y_mm").T) - 27.0).max() < 1e-6
        and report["on_part"]["worst_mm"] < 1e-6
    )


FIGURES = """\
strategy: {layer_height: 8 mm, chord_error: 0.3 mm}
build_direction: {clearance: none}
features:
"""
BLOCK = """\
  - name: block
    part: {file: block.step}
    strategy: {kind: solid, bead_spacing: 8 mm}
    process: {bead_model: csw, bead_width: 9.5 mm}
"""
ELBOW = "  - {name: elbow, part: {file: elbow.step}, strategy: {kind: surface}MORE}\n"


def test_each_feature_has_the_figures_of_a_job_of_its_own(workshop):
    """Predictions of a bead model and alternatives for cutting a wall were once reported only for
    jobs of one feature."""
    Part.makeBox(50, 40, 24, Vector(0, -20, -24)).exportStep(str(workshop.folder / "block.step"))
    shell = Part.makeTorus(30.0, 8.0, Vector(-5, 0, 0), Vector(0, -1, 0), -180, 180, 50)
    shell.rotate(Vector(), Vector(0, 1, 0), -90)
    (face,) = (face for face in shell.Faces if isinstance(face.Surface, Part.Toroid))
    face.exportStep(str(workshop.folder / "elbow.step"))

    def report(*features, page="--no-page"):
        (workshop.folder / "job.yaml").write_text(FIGURES + "".join(features), encoding="utf-8")
        command = workshop.run("plan", "job.yaml", "-o", "out", *([page] if page else []))
        assert command.status == 0, command.err
        return json.loads((workshop.folder / "out" / "report.json").read_text(encoding="utf-8"))

    block = report(BLOCK)
    elbow = report(ELBOW.replace("MORE", ", substrate: {file: block.step}"))
    both_features = report(BLOCK, ELBOW.replace("MORE", ""), page="")
    first_feature, second_feature = both_features["features"]
    assert (
        first_feature["beads"] == block["beads"]
        and len(first_feature["beads"]["layers"]) == 3
        and first_feature["spacing_comparison"] == []
    )
    assert (
        second_feature["spacing_comparison"] == elbow["spacing_comparison"]
        and second_feature["beads"] is None
    )
    assert sum(row["layers"] is not None for row in second_feature["spacing_comparison"]) > 2
    assert both_features["spacing_comparison"] == [] and both_features["beads"] is None
    page = (workshop.folder / "out" / "report.html").read_text(encoding="utf-8")
    for title in (
        "Distances between layers: elbow",
        "block: distance to the previous layer",
        "elbow: distance to the previous layer",
    ):
        assert title in page
