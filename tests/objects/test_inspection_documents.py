# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inspections in documents: against features, toolpaths, exact shapes and meshes; stale when their
plan changes."""

import FreeCAD as App
import Mesh
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.inspection import planned as surfaces
from freecad_am.core.issues import InputError

pytestmark = pytest.mark.any_version

SETTINGS = {"probe_radius": 1.5, "tolerance": 0.1, "heights": "15 25 35"}


@pytest.fixture
def points(root, tmp_path):
    lines = (
        (root / "resources" / "examples" / "inspection" / "hemisphere-synthetic.csv")
        .read_text()
        .splitlines()
    )
    path = tmp_path / "cmm.csv"
    path.write_text("\n".join([*lines[:3], *lines[3::4]]))
    return path


@pytest.fixture
def feature(doc, root):
    imported_part = api.open_part(doc, str(root / "resources" / "examples" / "hemisphere.step"))
    return api.make_feature(doc, imported_part, layer_height=2)


def test_feature_toolpath_shape_and_mesh_tell_the_same(doc, feature, points):
    shape = feature.Source[0]
    mesh = doc.addObject("Mesh::Feature", "Facets")
    mesh.Mesh = Mesh.Mesh(shape.Shape.tessellate(0.01))
    results = {
        name: api.result(api.inspect(doc, planned, str(points), **SETTINGS))
        for name, planned in (
            ("feature", feature),
            ("toolpath", api.make_toolpath(doc, feature)),
            ("shape", shape),
            ("mesh", mesh),
        )
    }
    exact = results["feature"]
    assert exact.ball.planned == pytest.approx(45.0, abs=1e-6)
    for name, slack in (("toolpath", 0.02), ("shape", 1e-3), ("mesh", 0.015)):
        result = results[name]
        assert np.abs(result.deviation - exact.deviation).max() < 2.0 * slack, name
        assert result.ball.zone.zone == pytest.approx(exact.ball.zone.zone, abs=slack), name
        assert [c.zone.zone for c in result.circles] == pytest.approx(
            [c.zone.zone for c in exact.circles], abs=0.02
        ), name


def test_a_box_is_measured_past_its_edges_too(doc, tmp_path):
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 60, 40, 20
    doc.recompute()
    rng = np.random.default_rng(1)
    points = rng.uniform(-3.0, 63.0, (400, 3)) * [1.0, 40.0 / 60.0, 20.0 / 60.0]
    out = np.abs(points - [30.0, 20.0, 10.0]) - [30.0, 20.0, 10.0]
    truth = np.linalg.norm(np.maximum(out, 0.0), axis=1) + np.minimum(out.max(axis=1), 0.0)
    path = tmp_path / "box.xyz"
    np.savetxt(path, points, fmt="%.9f")
    inspection = api.inspect(doc, box, str(path), fit="none")
    is_near = np.abs(truth) < 4.0
    assert (
        is_near.sum() > 200
        and np.abs(api.result(inspection).deviation - truth)[is_near].max() < 1e-6
    )
    assert api.result(inspection).counted.all()


def test_it_is_stale_when_what_was_planned_changes_and_keeps_its_points_without_the_file(
    doc, feature, points, tmp_path
):
    inspection = api.inspect(doc, feature, str(points), **SETTINGS)
    assert (inspection.Status, inspection.Points) == ("up to date", 1466)
    assert inspection.Sphericity.endswith("mm") and len(inspection.Circularity) == 3
    points.unlink()
    doc.recompute()
    path = str(tmp_path / "doc.FCStd")
    doc.saveAs(path)
    opened = App.openDocument(path)
    again = opened.Inspection
    assert again.Status == "up to date"
    api.recompute(again)
    assert (api.result(again).deviation == api.result(inspection).deviation).all()
    opened.Feature.LayerHeight = 3
    assert again.Status == "stale"
    with pytest.raises(InputError) as caught:
        api.recompute(again)
    assert (caught.value.code, caught.value.where) == ("NO_FILE", "Inspection.File")
    assert again.Status == "failed" and len(api.result(again).points) == 1466
    App.closeDocument(opened.Name)


def test_changed_by_keywords_and_written_to_files(doc, feature, points, tmp_path):
    inspection = api.inspect(doc, feature, str(points), "Sphere 1", **SETTINGS)
    api.change(inspection, tolerance=0.05)
    assert api.result(inspection).tolerance == 0.05 and inspection.WithinTolerance < 90.0
    other_file = points.with_name("other.csv")
    other_file.write_text("\n".join(points.read_text().splitlines()[:700]))
    api.change(inspection, file=str(other_file))
    assert inspection.Points < 700
    names = [path.rsplit("/", 1)[-1] for path in api.export(inspection, str(tmp_path / "out"))]
    assert names == ["Sphere 1.csv", "Sphere 1-deviations.csv", "Sphere 1.json"]


@pytest.mark.parametrize("undo", [0, 1])
def test_what_fails_leaves_nothing_behind(doc, feature, points, undo):
    doc.UndoMode = undo
    count = len(doc.Objects)
    cell = api.make_cell(doc)
    for planned, file, code in (
        (feature, "nowhere.csv", "NO_FILE"),
        (feature, "", "NO_FILE"),
        (None, str(points), "NO_INPUT"),
        (cell, str(points), "BAD_INPUT"),
    ):
        with pytest.raises(InputError) as caught:
            api.inspect(doc, planned, file)
        assert caught.value.code == code
        assert len(doc.Objects) == count + 1


@pytest.mark.parametrize(
    ("wall", "ground"),
    [("tube-on-pipe.step", "pipe.step"), ("walls/elbow.step", "walls/elbow-block.step")],
)
def test_walls_on_parts_are_exact_and_outside_is_a_plus(doc, root, wall, ground):
    examples = root / "resources" / "examples"
    imported_part = api.open_part(doc, str(examples / wall))
    feature = api.make_surface_feature(
        doc, imported_part, (), api.open_part(doc, str(examples / ground)), layer_height=5
    )
    surface = surfaces.wall_surface(api.result(feature))
    inside, normal = surface.exact(surface.spread)
    feet = surface.spread - inside[:, None] * normal
    off = np.random.default_rng(4).uniform(-1.5, 1.5, len(feet))
    points = feet + off[:, None] * normal
    distance, is_found = surface.exact(points)
    assert np.abs(distance - off).max() < 1e-9 and np.abs(is_found - normal).max() < 1e-9
    assert np.abs(surface.nearest(points)[0] - off).max() < 1.1 * max(surface.chord, 3e-3)
    assert surface.within_edges(points).all()
    # the kernel computes the nearest point of the part's own faces
    for k in range(0, len(feet), 400):
        nearest = imported_part.Shape.distToShape(Part.Vertex(*points[k]))[0]
        assert abs(off[k]) == pytest.approx(nearest, abs=1e-6)
    # chords to the opposite side of a tube are inside of it
    across = feet - 5.0 * normal
    wide, narrow = (
        np.linalg.norm(positions - positions.mean(axis=0), axis=1).mean()
        for positions in (feet, across)
    )
    assert narrow < wide


def test_a_predicted_deposit_is_inspected_as_a_measured_one(doc, root):
    """A tube 3 mm thick from beads 6 mm wide on the middle of its wall leaves 1.5 mm on both sides,
    except at the round top. The inspection is saved with the document, stale when the toolpath
    changes, and rejected for objects without beads."""
    tube = doc.addObject("Part::Feature", "Tube")
    tube.Shape = Part.makeCylinder(31.5, 20.0).cut(Part.makeCylinder(28.5, 20.0))
    feature = api.make_feature(doc, tube, layer_height=2, wall="middle")
    path = api.make_toolpath(doc, feature, bead_width=6, machining_allowance=1)
    inspection = api.inspect(doc, path, "predicted deposit", tolerance=0.5)
    result = api.result(inspection)
    exact = tube.Shape.distToShape
    normal = np.array([1.0 if abs(np.hypot(*p[:2]) - 33.0) < 1.0 else -1.0 for p in result.points])
    sides = (result.points[:, 2] > 2.0) & (result.points[:, 2] < 15.0) & (result.deviation > 0.0)
    radius = np.hypot(*result.points[:, :2].T)
    expected = np.where(normal > 0.0, 33.0, 27.0)
    assert sides.sum() > 3000 and np.abs(radius - expected)[sides].max() < 0.4
    for k in np.flatnonzero(sides)[::400]:
        distance = exact(Part.Vertex(*result.points[k]))[0]
        assert distance == pytest.approx(
            result.deviation[k], abs=0.06
        )  # by the kernel; triangles are within 0.05 mm
    predicted = api.result(path).checks.predicted
    assert abs(predicted.laid / predicted.fed - 1.0) < 1e-6
    assert predicted.fed == pytest.approx(12.0 * api.result(path).length, rel=1e-9)
    assert predicted.allowance == 1.0 and predicted.places == len(result.deviation)
    assert result.laid is not None and result.spread.least == pytest.approx(predicted.least)
    assert inspection.Status == "up to date"
    path.BeadWidth = 5
    assert inspection.Status == "stale"
    doc.recompute()
    narrower = api.result(inspection)
    assert np.median(narrower.deviation) == pytest.approx(1.0, abs=0.15)
    with pytest.raises(InputError, match="choose a toolpath"):
        api.inspect(doc, feature, "predicted deposit")
