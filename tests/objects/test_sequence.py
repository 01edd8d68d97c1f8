# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several features in a document: their order, stale stages, saving, undo, and all stages at
once."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError

pytestmark = pytest.mark.any_version

COARSE = {"layer_height": 5, "chord_error": 0.2, "bead_spacing": 5}


def box(doc, name, *size_and_place):
    obj = doc.addObject("Part::Box", name)
    obj.Length, obj.Width, obj.Height, *corner = size_and_place
    obj.Placement.Base = App.Vector(*corner)
    doc.recompute()
    return obj


@pytest.fixture
def doc():
    document = App.newDocument("Sequence")
    document.UndoMode = 1
    yield document
    for name in App.listDocuments():
        App.closeDocument(name)


@pytest.fixture
def features(doc):
    sizes = {
        "Plate": (60, 20, 10, 0, 0, 0),
        "Low": (20, 20, 10, 0, 0, 10),
        "High": (20, 20, 20, 40, 0, 10),
    }
    boxes = [box(doc, name, *size) for name, size in sizes.items()]
    return [api.make_solid_feature(doc, box_, label=box_.Name.lower(), **COARSE) for box_ in boxes]


def middles(toolpath):
    """Return x and z of each layer's middle."""
    rows = [
        np.vstack([bead.points for bead in layer.beads]) for layer in api.result(toolpath).layers
    ]
    return [
        (round(0.5 * (points[:, 0].min() + points[:, 0].max())), round(points[0, 2]))
        for points in rows
    ]


PLATE, LOW_POST, HIGH_POST = (
    [(30, 0), (30, 5)],
    [(10, 10), (10, 15)],
    [(50, 10), (50, 15), (50, 20), (50, 25)],
)


def test_the_order_is_that_of_the_list(doc, features):
    toolpath = api.make_toolpath(doc, features)
    assert toolpath.Layers == 8 and middles(toolpath) == PLATE + LOW_POST + HIGH_POST
    api.change(toolpath, further=[features[2], features[1]])
    assert middles(toolpath) == PLATE + HIGH_POST + LOW_POST
    api.change(toolpath, sequence="height")
    assert middles(toolpath) == [
        *PLATE,
        HIGH_POST[0],
        LOW_POST[0],
        HIGH_POST[1],
        LOW_POST[1],
        *HIGH_POST[2:],
    ]
    doc.undo()
    assert toolpath.Sequence == "feature" and middles(toolpath) == PLATE + HIGH_POST + LOW_POST
    api.change(toolpath, further=[])
    assert middles(toolpath) == PLATE and api.result(toolpath).features == ()
    with pytest.raises(InputError, match="the feature has no support"):
        api.change(toolpath, feature=features[1], further=[features[0]])
    assert toolpath.Feature == features[0]


def test_a_change_of_any_feature_makes_the_toolpath_stale(doc, features):
    toolpath = api.make_toolpath(doc, features)
    doc.High.Height = 10
    assert toolpath.Status == "stale" and features[1].Status == "up to date"
    api.recompute(doc)
    assert toolpath.Status == "up to date" and middles(toolpath) == PLATE + LOW_POST + HIGH_POST[:2]
    doc.removeObject(features[1].Name)
    api.recompute(doc)
    assert middles(toolpath) == PLATE + HIGH_POST[:2]


def test_what_is_saved_is_there_again(doc, features, tmp_path):
    toolpath = api.make_toolpath(doc, features)
    api.change(toolpath, sequence="height")
    original = api.result(toolpath)
    doc.saveAs(str(tmp_path / "sequence.FCStd"))
    App.closeDocument(doc.Name)
    opened = App.openDocument(str(tmp_path / "sequence.FCStd")).Toolpath
    assert [feature.Source[0].Name for feature in (opened.Feature, *opened.Further)] == [
        "Plate",
        "Low",
        "High",
    ]
    assert opened.Status == "up to date" and opened.Sequence == "height"
    reopened = api.result(opened)
    assert [layer.feature for layer in reopened.layers] == [
        layer.feature for layer in original.layers
    ]
    for (_, _, old), (_, _, new) in zip(original, reopened, strict=True):
        np.testing.assert_array_equal(old.points, new.points)
    assert [feature_result.label for feature_result in reopened.features] == [
        feature_result.label for feature_result in original.features
    ]


def test_own_speeds(doc, features):
    from freecad_am.core.parameters.process import ProcessParameters

    own_parameters = [ProcessParameters(), ProcessParameters(travel_speed=9.0), ProcessParameters()]
    toolpath = api.make_toolpath(doc, features, processes=own_parameters)
    speeds = [
        {float(speed) for bead in layer.beads for speed in bead.speed}
        for layer in api.result(toolpath).layers
    ]
    usual = ProcessParameters().travel_speed
    assert speeds == [{usual}] * 2 + [{9.0}] * 2 + [{usual}] * 4
    assert toolpath.Proxy.own_speeds(toolpath) == (
        False,
        True,
        False,
    )  # a slower job does not change the feature with its own speed
    with pytest.raises(InputError, match="whole program"):
        api.make_toolpath(
            doc,
            features,
            processes=[ProcessParameters(), ProcessParameters(rapid_speed=1.0), own_parameters[2]],
        )
    toolpath.FeatureProcess = ["", "nonsense", ""]
    with pytest.raises(InputError, match="JSON"):
        api.recompute(toolpath)


def test_with_fixed_build_directions_parts_of_revolution_alone_change(doc):
    """An infeasible job of several features tries fixed directions for parts of revolution only,
    and the message names their keys."""
    plate = box(doc, "Plate", 40, 40, 10, -20, -20, -10)
    cone = doc.addObject("Part::Cone", "Cone")
    cone.Radius1, cone.Radius2, cone.Height = 15, 8, 20
    doc.recompute()
    features = [
        api.make_solid_feature(doc, plate, **COARSE),
        api.make_feature(doc, cone, layer_height=5, chord_error=0.2, wall="outer"),
    ]
    toolpath = api.make_toolpath(doc, features)
    message, make = toolpath.Proxy.fixed(toolpath)
    assert message == "`features[1].build_direction.mode: fixed`"
    candidate = make()
    as_was = api.result(toolpath)
    features[1].Mode = "fixed"
    api.recompute(toolpath)
    planned = api.result(toolpath)
    for layer, planned_layer in zip(candidate, planned, strict=True):
        assert layer[:2] == planned_layer[:2]
        for name in ("points", "build", "tool", "speed"):
            assert np.array_equal(getattr(layer[2], name), getattr(planned_layer[2], name))
    assert any(
        not np.array_equal(layer[2].build, planned_layer[2].build)
        for layer, planned_layer in zip(as_was, planned, strict=True)
    )
    assert toolpath.Proxy.fixed(toolpath) is None


def test_all_stages_of_several_at_once(doc):
    plate, post = box(doc, "Plate", 30, 30, 3, 0, 0, 0), box(doc, "Post", 12, 12, 3, 9, 9, 3)
    steps = doc.UndoCount
    stages = api.make_all(doc, plate, kind="solid", then=[{"source": post, "kind": "solid"}])
    assert [obj.Proxy.kind for obj in stages[:5]] == [
        "cell",
        "feature",
        "feature",
        "toolpath",
        "joint path",
    ]
    assert doc.UndoCount == steps + 1 and stages[3].Further == [stages[2]]
    (group,) = [obj for obj in doc.Objects if obj.Name.startswith("Job")]
    assert [obj.Name for obj in group.Group] == [obj.Name for obj in stages]
    doc.undo()
    assert api.stages_of(doc) == []
    with pytest.raises(InputError, match="give source"):
        api.make_all(doc, plate, kind="solid", then=[{"kind": "solid"}])
    assert api.stages_of(doc) == []


def test_what_one_feature_leaves_out_and_what_of_another_is_over_nothing_are_told(doc):
    """A cylinder printed as a skin leaves out its inside, and each first bead of a block of 60 mm
    on one of 40 mm is unsupported for a third of its length."""
    rod = doc.addObject("Part::Cylinder", "Rod")
    rod.Radius, rod.Height, rod.Placement.Base = 30, 20, App.Vector(0, 100, 0)
    low, high = box(doc, "Low", 40, 20, 10, 0, 0, 0), box(doc, "High", 60, 20, 10, 0, 0, 10)
    features = [
        api.make_feature(doc, rod, label="skin", layer_height=5, chord_error=0.2),
        api.make_solid_feature(doc, low, label="low", **COARSE),
        api.make_solid_feature(doc, high, label="high", **COARSE),
    ]
    toolpath = api.make_toolpath(doc, features)
    (missing_issue,) = [issue for issue in api.issues(toolpath) if issue.code == "NOT_DEPOSITED"]
    assert (
        "of the 56.5 cm3 of Rod are not deposited" in missing_issue.message
        and missing_issue.level == "warning"
    )
    (over,) = [issue for issue in api.issues(toolpath) if issue.code == "UNSUPPORTED"]
    toolpath_result = api.result(toolpath)
    first_layer = next(k for k, layer in enumerate(toolpath_result.layers) if layer.feature == 2)
    assert over.layer == first_layer and over.level == "warning"
    laid = sum(bead.length for bead in toolpath_result.layers[first_layer].beads)
    assert toolpath_result.checks.unsupported == pytest.approx(laid / 3.0, rel=0.25)
