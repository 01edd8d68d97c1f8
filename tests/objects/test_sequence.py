# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several features in a document: their order, what becomes stale, saving, undo, and all stages at once."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError

pytestmark = pytest.mark.any_version

COARSE = {"layer_height": 5, "chord_error": 0.2, "bead_spacing": 5}


def box(doc, name, *size_and_place):
    obj = doc.addObject("Part::Box", name)
    obj.Length, obj.Width, obj.Height, *place = size_and_place
    obj.Placement.Base = App.Vector(*place)
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
    parts = [box(doc, name, *size) for name, size in sizes.items()]
    return [api.make_solid_feature(doc, part, label=part.Name.lower(), **COARSE) for part in parts]


def middles(toolpath):
    """x and z of each layer's middle."""
    rows = [
        np.vstack([bead.points for bead in layer.beads]) for layer in api.result(toolpath).layers
    ]
    return [
        (round(0.5 * (points[:, 0].min() + points[:, 0].max())), round(points[0, 2]))
        for points in rows
    ]


PLATE, LOW, HIGH = (
    [(30, 0), (30, 5)],
    [(10, 10), (10, 15)],
    [(50, 10), (50, 15), (50, 20), (50, 25)],
)


def test_the_order_is_that_of_the_list(doc, features):
    toolpath = api.make_toolpath(doc, features)
    assert toolpath.Layers == 8 and middles(toolpath) == PLATE + LOW + HIGH
    api.change(toolpath, further=[features[2], features[1]])
    assert middles(toolpath) == PLATE + HIGH + LOW
    api.change(toolpath, sequence="height")
    assert middles(toolpath) == [*PLATE, HIGH[0], LOW[0], HIGH[1], LOW[1], *HIGH[2:]]
    doc.undo()
    assert toolpath.Sequence == "feature" and middles(toolpath) == PLATE + HIGH + LOW
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
    assert toolpath.Status == "up to date" and middles(toolpath) == PLATE + LOW + HIGH[:2]
    doc.removeObject(features[1].Name)
    api.recompute(doc)
    assert middles(toolpath) == PLATE + HIGH[:2]


def test_what_is_saved_is_there_again(doc, features, tmp_path):
    toolpath = api.make_toolpath(doc, features)
    api.change(toolpath, sequence="height")
    before = api.result(toolpath)
    doc.saveAs(str(tmp_path / "sequence.FCStd"))
    App.closeDocument(doc.Name)
    opened = App.openDocument(str(tmp_path / "sequence.FCStd")).Toolpath
    assert [one.Source[0].Name for one in (opened.Feature, *opened.Further)] == [
        "Plate",
        "Low",
        "High",
    ]
    assert opened.Status == "up to date" and opened.Sequence == "height"
    after = api.result(opened)
    assert [layer.feature for layer in after.layers] == [layer.feature for layer in before.layers]
    for (_, _, old), (_, _, new) in zip(before, after, strict=True):
        np.testing.assert_array_equal(old.points, new.points)
    assert [one.label for one in after.features] == [one.label for one in before.features]


def test_own_speeds(doc, features):
    from freecad_am.core.parameters.process import ProcessParameters

    own = [ProcessParameters(), ProcessParameters(travel_speed=9.0), ProcessParameters()]
    toolpath = api.make_toolpath(doc, features, processes=own)
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
    )  # slowing the job down leaves that one
    with pytest.raises(InputError, match="whole program"):
        api.make_toolpath(
            doc,
            features,
            processes=[ProcessParameters(), ProcessParameters(rapid_speed=1.0), own[2]],
        )
    toolpath.FeatureProcess = ["", "nonsense", ""]
    with pytest.raises(InputError, match="JSON"):
        api.recompute(toolpath)


def test_with_fixed_build_directions_parts_of_revolution_alone_change(doc):
    """What is tried where a job of several features is infeasible, and told by the keys that make it so."""
    plate = box(doc, "Plate", 40, 40, 10, -20, -20, -10)
    cone = doc.addObject("Part::Cone", "Cone")
    cone.Radius1, cone.Radius2, cone.Height = 15, 8, 20
    doc.recompute()
    features = [
        api.make_solid_feature(doc, plate, **COARSE),
        api.make_feature(doc, cone, layer_height=5, chord_error=0.2, wall="outer"),
    ]
    toolpath = api.make_toolpath(doc, features)
    told, make = toolpath.Proxy.fixed(toolpath)
    assert told == "`features[1].build_direction.mode: fixed`"
    tried = make()
    as_was = api.result(toolpath)
    features[1].Mode = "fixed"
    api.recompute(toolpath)
    asked = api.result(toolpath)
    for one, other in zip(tried, asked, strict=True):
        assert one[:2] == other[:2]
        for name in ("points", "build", "tool", "speed"):
            assert np.array_equal(getattr(one[2], name), getattr(other[2], name))
    assert any(
        not np.array_equal(one[2].build, other[2].build)
        for one, other in zip(as_was, asked, strict=True)
    )
    assert toolpath.Proxy.fixed(toolpath) is None


def test_all_stages_of_several_at_once(doc):
    plate, post = box(doc, "Plate", 30, 30, 3, 0, 0, 0), box(doc, "Post", 12, 12, 3, 9, 9, 3)
    steps = doc.UndoCount
    made = api.make_all(doc, plate, kind="solid", then=[{"source": post, "kind": "solid"}])
    assert [one.Proxy.kind for one in made[:5]] == [
        "cell",
        "feature",
        "feature",
        "toolpath",
        "joint path",
    ]
    assert doc.UndoCount == steps + 1 and made[3].Further == [made[2]]
    (group,) = [one for one in doc.Objects if one.Name.startswith("Job")]
    assert [one.Name for one in group.Group] == [one.Name for one in made]
    doc.undo()
    assert api.stages_of(doc) == []
    with pytest.raises(InputError, match="give source"):
        api.make_all(doc, plate, kind="solid", then=[{"kind": "solid"}])
    assert api.stages_of(doc) == []


def test_what_one_feature_leaves_out_and_what_of_another_is_over_nothing_are_told(doc):
    """A cylinder laid as a skin, and on a block of 40 mm one of 60: a third of each bead of its first layer hangs out."""
    rod = doc.addObject("Part::Cylinder", "Rod")
    rod.Radius, rod.Height, rod.Placement.Base = 30, 20, App.Vector(0, 100, 0)
    low, high = box(doc, "Low", 40, 20, 10, 0, 0, 0), box(doc, "High", 60, 20, 10, 0, 0, 10)
    features = [
        api.make_feature(doc, rod, label="skin", layer_height=5, chord_error=0.2),
        api.make_solid_feature(doc, low, label="low", **COARSE),
        api.make_solid_feature(doc, high, label="high", **COARSE),
    ]
    toolpath = api.make_toolpath(doc, features)
    (left,) = [issue for issue in api.issues(toolpath) if issue.code == "NOT_DEPOSITED"]
    assert "of the 56.5 cm3 of Rod are not deposited" in left.message and left.level == "warning"
    (over,) = [issue for issue in api.issues(toolpath) if issue.code == "UNSUPPORTED"]
    made = api.result(toolpath)
    first = next(k for k, layer in enumerate(made.layers) if layer.feature == 2)
    assert over.layer == first and over.level == "warning"
    laid = sum(bead.length for bead in made.layers[first].beads)
    assert made.checks.unsupported == pytest.approx(laid / 3.0, rel=0.25)
