# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall on a substrate in a document: made, renewed when either shape changes, refused where it must be."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError


@pytest.fixture
def tube(doc):
    """A branch on a pipe: the branch's side is Face1."""
    pipe = doc.addObject("Part::Cylinder", "Pipe")
    pipe.Radius, pipe.Height = 32, 120
    pipe.Placement = App.Placement(App.Vector(0, -60, 0), App.Rotation(App.Vector(1, 0, 0), -90))
    branch = doc.addObject("Part::Cylinder", "Branch")
    branch.Radius, branch.Height = 12, 60
    doc.recompute()
    return branch, pipe


def made(doc, tube, **values):
    branch, pipe = tube
    return api.make_surface_feature(doc, branch, ["Face1"], pipe, **{"layer_height": 5, "clearance": "none", **values})


def test_feature_and_toolpath(doc, tube):
    feature = made(doc, tube)
    wall = api.result(feature)
    assert feature.WallKind == "cone" and list(feature.WallFaces) == ["Face1"]
    assert np.hypot(wall.first[:, 0], wall.first[:, 2]) == pytest.approx(32.0, abs=1e-9)
    toolpath = api.make_toolpath(doc, feature)
    value = api.result(toolpath)
    assert value.family == "surface" and toolpath.Layers == len(value.layers)
    assert max(bead.points[:, 2].max() for _, _, bead in value) == pytest.approx(60.0, abs=1e-6)


def test_renewed_when_the_substrate_changes(doc, tube):
    feature = made(doc, tube)
    toolpath = api.make_toolpath(doc, feature)
    tube[1].Radius = 25
    assert feature.Status == toolpath.Status == "stale"
    api.recompute(doc)
    first = api.result(feature).first
    assert np.hypot(first[:, 0], first[:, 2]) == pytest.approx(25.0, abs=1e-9)
    start = api.result(toolpath).layers[0].beads[0].points
    assert np.hypot(start[:, 0], start[:, 2]) == pytest.approx(25.0, abs=1e-4)


def test_saved_and_read_back(doc, tube, tmp_path):
    spline = doc.addObject("Part::Feature", "Spline")
    spline.Shape = tube[0].Shape.Faces[0].toNurbs()
    feature = api.make_surface_feature(doc, spline, (), tube[1], clearance="none")
    before = api.result(feature)
    doc.saveAs(str(tmp_path / "wall.FCStd"))
    again = App.openDocument(str(tmp_path / "wall.FCStd"))
    try:
        found = api.result(again.getObject(feature.Name))
        assert found.kind == before.kind == "table"
        assert (found.table == before.table).all() and (found.first == before.first).all()
    finally:
        App.closeDocument(again.Name)


def test_what_is_not_there_yet_is_refused(doc, tube):
    feature = made(doc, tube, clearance="nozzle")
    with pytest.raises(InputError) as caught:
        api.make_toolpath(doc, feature)
    assert caught.value.code == "NOT_YET"


def test_needs_a_solid_substrate(doc, tube):
    with pytest.raises(InputError) as caught:
        api.make_surface_feature(doc, tube[0], ["Face1"])
    assert caught.value.code == "NO_INPUT"
    plane = doc.addObject("Part::Plane", "Plane")
    doc.recompute()
    with pytest.raises(InputError) as caught:
        api.make_surface_feature(doc, tube[0], ["Face1"], plane)
    assert caught.value.code == "NO_SOLID" and caught.value.where == "Plane"
