# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges, and faces of other links than a feature's Source, that are numbered anew when a part changes."""

import json
import random

import FreeCAD as App
import Part
import pytest
import Sketcher

from freecad_am import api
from freecad_am.core.issues import InputError
from tests.objects.test_chosen import block, numbered, put, put_quietly

CODES = ("FACES_CHANGED", "EDGES_CHANGED")
CURVES = {"chord_error": 0.1}


def warnings(feature):
    return [
        (one["code"], one["message"]) for one in json.loads(feature.Issues) if one["code"] in CODES
    ]


def name_at(shape, kind, place):
    """The name of the face or edge of a shape whose box has its middle there."""
    every = shape.Faces if kind == "Face" else shape.Edges
    return f"{kind}{1 + min(range(len(every)), key=lambda k: (every[k].BoundBox.Center - place).Length)}"


def in_another_order(shape, name, draw):
    """The same solid, with another edge or face, of the same kind and way, under a name; and the new name of the one that
    had it."""
    kind, count = name.rstrip("0123456789"), len(shape.Faces)
    one = shape.getElement(name)

    def way(of):
        form = of.Surface if kind == "Face" else of.Curve
        return form.TypeId, [
            round(abs(part), 9) for part in getattr(form, "Axis", getattr(form, "Direction", None))
        ]

    for _ in range(5000):
        other = numbered(shape, draw.sample(range(count), count))
        new = name_at(other, kind, one.BoundBox.Center)
        if new != name and way(other.getElement(name)) == way(one):
            return other, new
    raise AssertionError("no such order")


@pytest.mark.parametrize("seed", range(4))
def test_another_number_of_an_edge_that_is_laid_is_told(doc, seed):
    draw = random.Random(seed)
    shape = Part.makeBox(40, 30, 20).cut(Part.makeCylinder(5, 20, App.Vector(20, 15, 0)))
    straight = [
        k
        for k, edge in enumerate(shape.Edges, 1)
        if edge.Curve.TypeId == "Part::GeomLine" and edge.Length > 25
    ]
    name = f"Edge{draw.choice(straight)}"
    part = block(doc, shape)
    feature = api.make_curves_feature(doc, part, [name], **CURVES)
    assert feature.Status == "up to date" and warnings(feature) == []
    other, new = in_another_order(shape, name, draw)
    put(part, other)
    if feature.Source[1] != [name]:  # FreeCAD 1.0 and later may have followed the edge
        assert warnings(feature) == [] and feature.Source[1] == [new]
        return
    ((code, said),) = warnings(feature)
    assert (
        code == "EDGES_CHANGED"
        and f"{name} of Block is not the selected edge: that edge is {new} now" in said
    )
    part.Placement = App.Placement()
    api.recompute(doc)
    assert len(warnings(feature)) == 1  # until they are chosen again
    feature.Source = (part, [new])
    api.recompute(doc)
    assert warnings(feature) == []


def of_axis(doc, draw):
    wire = doc.addObject("Part::Feature", "Wire")
    wire.Shape = Part.makePolygon([App.Vector(80, 0, 0), App.Vector(90, 0, 40)])
    box = Part.makeBox(20, 15, 20, App.Vector(-10, 0, 0))
    name = name_at(box, "Edge", App.Vector(10, 0, 10))
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = box
    doc.recompute()
    return (
        part,
        api.make_feature(doc, wire, axis=(part, name), layer_height=10),
        "Axis",
        name,
        {"axis": (part, name)},
    )


def of_start_edges(doc, draw):
    tube = Part.makeCylinder(20, 15)
    caps = sorted(range(3), key=lambda k: (tube.Faces[k].Surface.TypeId != "Part::GeomPlane", k))
    tube = numbered(tube, caps)
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = tube
    doc.recompute()
    name = name_at(tube, "Edge", App.Vector(0, 0, 0))
    feature = api.make_surface_feature(doc, part, ["Face3"], start_edges=[name], layer_height=5)
    return part, feature, "StartEdges", name, {"start_edges": [name]}


def of_start_faces(doc, draw):
    low, high = (
        Part.Face(
            Part.makePolygon(
                [App.Vector(x, y, z) for x, y in ((0, 0), (30, 0), (30, 20), (0, 20), (0, 0))]
            )
        )
        for z in (0.0, 8.0)
    )
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(30, 20, 8)
    doc.recompute()
    name = name_at(part.Shape, "Face", low.BoundBox.Center)
    assert name != name_at(part.Shape, "Face", high.BoundBox.Center)
    values = {"layers": "geodesic", "layer_height": 4, "chord_error": 0.5}
    feature = api.make_solid_feature(doc, part, start_faces=(part, [name]), **values)
    return part, feature, "StartFaces", name, {"start_faces": (part, [name])}


def of_guide(doc, draw):
    bar = doc.addObject("Part::Feature", "Bar")
    bar.Shape = Part.makeBox(10, 10, 30)
    part = doc.addObject("Part::Feature", "Block")
    part.Shape = Part.makeBox(20, 15, 30, App.Vector(5, 5, 0))
    doc.recompute()
    name = name_at(part.Shape, "Edge", App.Vector(5, 5, 15))
    feature = api.make_solid_feature(doc, bar, guide=(part, [name]), layers="along", layer_height=5)
    return part, feature, "Guide", name, {"guide": (part, [name])}


@pytest.mark.parametrize("made", [of_axis, of_start_edges, of_start_faces, of_guide])
def test_what_other_links_name_is_told_until_it_is_confirmed(doc, made, tmp_path):
    part, feature, link, name, again = made(doc, random.Random(1))
    assert feature.Status == "up to date" and warnings(feature) == []
    shape = part.Shape.copy()
    kind = name.rstrip("0123456789")
    other, new = in_another_order(shape, name, random.Random(2))
    put_quietly(part, other)
    if (
        getattr(feature, link)[1] != [name] or feature.Status == "failed"
    ):  # FreeCAD 1.0 may have followed or lost it
        assert warnings(feature) == [] and App.Version()[0] != "0"
        assert getattr(feature, link)[1] == [new] or "no longer exists" in feature.Message
        return
    ((code, said),) = warnings(feature)
    kind = kind.lower()
    assert code == f"{kind.upper()}S_CHANGED"
    assert f"{name} of Block is not the selected {kind}: that {kind} is {new} now" in said
    doc.saveAs(str(tmp_path / "block.FCStd"))
    App.closeDocument(doc.Name)
    opened = App.openDocument(str(tmp_path / "block.FCStd"))
    try:
        part, feature = opened.getObject("Block"), opened.getObject("Feature")
        assert warnings(feature) == [(code, said)]
        api.change(feature, chord_error=0.2)
        api.recompute(opened, force=True)
        assert warnings(feature) == [(code, said)]
        api.change(
            feature,
            **{
                key: (part, value[1]) if isinstance(value, tuple) else value
                for key, value in again.items()
            },
        )
        assert warnings(feature) == []
        put_quietly(part, shape)
        followed = App.Version()[0] != "0" and (
            getattr(feature, link)[1] != [name] or feature.Source[1][0].startswith("?")
        )
        assert [code for code, _ in warnings(feature)] == [
            code
        ] or followed  # what was confirmed is another one now
    finally:
        App.closeDocument(opened.Name)


@pytest.mark.parametrize("seed", range(3))
def test_edges_of_a_part_that_grows_or_moves_are_those_that_were_chosen(doc, seed):
    draw = random.Random(seed)
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 40, 30, 20
    doc.recompute()
    feature = api.make_curves_feature(
        doc, box, [f"Edge{draw.randint(1, 12)}", f"Edge{draw.randint(1, 12)}"], **CURVES
    )
    for _ in range(4):
        box.Length, box.Width, box.Height = (draw.uniform(10, 60) for _ in range(3))
        turned = App.Rotation(App.Vector(1, 2, 3), draw.uniform(0, 90))
        box.Placement = App.Placement(App.Vector(draw.uniform(-9, 9), 1, 2), turned)
        api.recompute(doc)
        assert feature.Status == "up to date" and warnings(feature) == []


def test_a_straight_edge_that_became_a_circle_and_one_that_turned_are_told(doc):
    part = doc.addObject("Part::Feature", "Block")
    ends = App.Vector(0, 0, 5), App.Vector(40, 0, 5)
    part.Shape = Part.makePolygon(ends)
    doc.recompute()
    feature = api.make_curves_feature(doc, part, ["Edge1"], **CURVES)
    put(part, Part.Wire([Part.makeCircle(20, App.Vector(0, 0, 5))]))
    ((code, said),) = warnings(feature)
    assert (
        code == "EDGES_CHANGED"
        and "Edge1 of Block was a straight line when selected and is a circle now" in said
    )
    put(part, Part.makePolygon(ends[::-1]))
    assert warnings(feature) == []  # it has no sense
    put(part, Part.makePolygon((App.Vector(0, 9, 5), App.Vector(40, 11, 5))))
    assert warnings(feature) == []  # there is no other
    put(part, Part.makePolygon((App.Vector(0, 9, 5), App.Vector(40, 19, 5), App.Vector(40, 30, 5))))
    ((code, said),) = warnings(feature)
    assert (
        code == "EDGES_CHANGED"
        and "Edge1 of Block has changed its position since its selection" in said
    )


def test_a_line_of_a_sketch_that_is_drawn_by_an_end_is_the_one_that_was_chosen(doc):
    sketch = doc.addObject("Sketcher::SketchObject", "Sketch")
    sketch.Placement = App.Placement(App.Vector(3, 0, 10), App.Rotation(App.Vector(1, 0, 0), 90))
    corners = [App.Vector(*at, 0) for at in ((0, 0), (40, 0), (60, 20), (60, 50))]
    for start, end in zip(corners, corners[1:]):
        sketch.addGeometry(Part.LineSegment(start, end), False)
    for k in range(2):
        sketch.addConstraint(Sketcher.Constraint("Coincident", k, 2, k + 1, 1))
    doc.recompute()
    feature = api.make_curves_feature(doc, sketch, ["Edge2"], **CURVES)
    for line, end, to in ((1, 2, (70, 33)), (0, 2, (30, -9)), (0, 1, (-10, 0)), (2, 2, (60, 70))):
        sketch.movePoint(line, end, App.Vector(*to, 0), 0)
        api.recompute(doc)
        assert feature.Status == "up to date" and warnings(feature) == [], (line, end, to)
    sketch.delGeometry(0)
    sketch.addGeometry(Part.LineSegment(App.Vector(90, 0, 0), App.Vector(90, 40, 0)), False)
    api.recompute(doc)
    assert len(warnings(feature)) == 1 or feature.Source[1] == [
        "Edge1"
    ]  # the next one has its number


def test_an_edge_that_a_fillet_beside_it_makes_shorter_and_gives_another_number_is_told(doc):
    box = Part.makeBox(40, 30, 20)
    part = block(doc, box)
    told = 0
    for k in range(1, 13):
        put_quietly(part, box)
        feature = api.make_curves_feature(doc, part, [f"Edge{k}"], **CURVES)
        chosen = box.Edges[k - 1]
        middle, way = chosen.CenterOfMass, chosen.Curve.Direction
        for n in range(1, 13):
            if n == k:
                continue
            put_quietly(part, box.makeFillet(3, [box.Edges[n - 1]]))
            shape = part.Shape.copy()
            shape.Placement = App.Placement()
            lies = [
                one
                for one, edge in enumerate(shape.Edges, 1)
                if edge.Curve.TypeId == "Part::GeomLine"
                and ((edge.CenterOfMass - middle).cross(way)).Length < 1e-6
            ]
            named = int(feature.Source[1][0].lstrip("?")[4:])
            right = named in lies or feature.Source[1][0].startswith("?")
            assert len(warnings(feature)) == (not right), (k, n, lies)
            told += not right
            put_quietly(part, box)
            feature.Source = (part, [f"Edge{k}"])
            api.recompute(doc)
        doc.removeObject(feature.Name)
    assert told > 0 or App.Version()[0] != "0"


def test_the_same_names_of_another_part_are_chosen_anew(doc):
    shape = Part.makeBox(40, 30, 20)
    again = numbered(shape, [3, 5, 1, 0, 2, 4])
    pairs = enumerate(zip(shape.Edges, again.Edges), 1)
    name = next(
        f"Edge{k}"
        for k, (one, another) in pairs
        if one.Curve.Direction.cross(another.Curve.Direction).Length > 0.1
    )
    part, other = block(doc, shape), block(doc, again)
    feature = api.make_curves_feature(doc, part, [name], **CURVES)
    feature.Source = (other, [name])
    api.recompute(doc)
    assert feature.Status == "up to date" and warnings(feature) == []
    feature.Source = None
    with pytest.raises(InputError):
        api.recompute(doc)
    feature.Source = (part, [name])
    api.recompute(doc)
    assert feature.Status == "up to date" and warnings(feature) == []


def test_a_copy_knows_what_was_chosen(doc):
    shape = Part.makeBox(40, 30, 20)
    part = block(doc, shape)
    feature = api.make_curves_feature(doc, part, ["Edge1"], **CURVES)
    put(part, numbered(shape, [3, 5, 1, 0, 2, 4]))
    if feature.Source[1] != ["Edge1"]:
        return  # FreeCAD 1.0 and later may have followed it
    assert len(warnings(feature)) == 1
    copies = App.newDocument("Copies")
    try:
        copies.copyObject(feature, True)
        api.recompute(copies, force=True)
        assert [warnings(one) for one in api.stages_of(copies, "feature")] == [warnings(feature)]
    finally:
        App.closeDocument(copies.Name)


def test_documents_from_before_know_their_edges_once_they_are_opened(doc, tmp_path):
    part, feature, link, name, _ = of_axis(doc, None)
    shape = part.Shape.copy()
    feature.ChosenFaces = []
    doc.saveAs(str(tmp_path / "before.FCStd"))
    App.closeDocument(doc.Name)
    opened = App.openDocument(str(tmp_path / "before.FCStd"))
    try:
        assert opened.Feature.Status == "up to date" and warnings(opened.Feature) == []
        put(opened.Block, in_another_order(shape, name, random.Random(3))[0])
        assert len(warnings(opened.Feature)) == 1 or getattr(opened.Feature, link)[1] != [name]
    finally:
        App.closeDocument(opened.Name)


def test_an_edge_without_a_length_and_a_sphere_have_marks(doc):
    ball = doc.addObject("Part::Sphere", "Ball")
    doc.recompute()
    whole = [f"Edge{k + 1}" for k in range(len(ball.Shape.Edges))]
    feature = api.make_curves_feature(doc, ball, [whole[1]], **CURVES)
    assert len(feature.ChosenFaces) == 2
    feature.Source = (ball, whole)
    try:
        api.recompute(doc)
    except Exception as error:
        assert type(error).__module__ == "freecad_am.core.issues", error


def test_an_edge_that_freecad_knows_to_be_lost_is_told(doc):
    part, feature, _, name, _ = of_axis(doc, None)
    feature.Axis = (part, [f"?{name}"])
    with pytest.raises(
        InputError,
        match=f"{name} no longer exists after a change of the part; choose the edges again",
    ):
        api.recompute(doc)
    assert feature.Status == "failed"
    feature.Axis = (part, [name])
    api.recompute(doc)
    assert feature.Status == "up to date" and warnings(feature) == []
