# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges that get new numbers when a part changes are reported, and so are faces of links other than
a feature's Source."""

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
        (issue["code"], issue["message"])
        for issue in json.loads(feature.Issues)
        if issue["code"] in CODES
    ]


def name_at(shape, kind, position):
    """Return the name of the face or edge of a shape whose bounding box has its centre at the
    position."""
    elements = shape.Faces if kind == "Face" else shape.Edges
    return f"{kind}{1 + min(range(len(elements)), key=lambda k: (elements[k].BoundBox.Center - position).Length)}"


def in_another_order(shape, name, draw):
    """Return the same solid with another edge or face, of the same kind and direction, under a
    name; and the new name of the original one."""
    kind, count = name.rstrip("0123456789"), len(shape.Faces)
    element = shape.getElement(name)

    def way(element_):
        form = element_.Surface if kind == "Face" else element_.Curve
        return form.TypeId, [
            round(abs(component), 9)
            for component in getattr(form, "Axis", getattr(form, "Direction", None))
        ]

    for _ in range(5000):
        renumbered = numbered(shape, draw.sample(range(count), count))
        new = name_at(renumbered, kind, element.BoundBox.Center)
        if new != name and way(renumbered.getElement(name)) == way(element):
            return renumbered, new
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
    block_object = block(doc, shape)
    feature = api.make_curves_feature(doc, block_object, [name], **CURVES)
    assert feature.Status == "up to date" and warnings(feature) == []
    renumbered, new = in_another_order(shape, name, draw)
    put(block_object, renumbered)
    if feature.Source[1] != [name]:  # FreeCAD 1.0 and later may have followed the edge
        assert warnings(feature) == [] and feature.Source[1] == [new]
        return
    ((code, message),) = warnings(feature)
    assert (
        code == "EDGES_CHANGED"
        and f"{name} of Block is not the selected edge: that edge is {new} now" in message
    )
    block_object.Placement = App.Placement()
    api.recompute(doc)
    assert len(warnings(feature)) == 1  # until the user selects them again
    feature.Source = (block_object, [new])
    api.recompute(doc)
    assert warnings(feature) == []


def axis_case(doc, draw):
    wire = doc.addObject("Part::Feature", "Wire")
    wire.Shape = Part.makePolygon([App.Vector(80, 0, 0), App.Vector(90, 0, 40)])
    box = Part.makeBox(20, 15, 20, App.Vector(-10, 0, 0))
    name = name_at(box, "Edge", App.Vector(10, 0, 10))
    block_object = doc.addObject("Part::Feature", "Block")
    block_object.Shape = box
    doc.recompute()
    return (
        block_object,
        api.make_feature(doc, wire, axis=(block_object, name), layer_height=10),
        "Axis",
        name,
        {"axis": (block_object, name)},
    )


def start_edge_case(doc, draw):
    tube = Part.makeCylinder(20, 15)
    caps = sorted(range(3), key=lambda k: (tube.Faces[k].Surface.TypeId != "Part::GeomPlane", k))
    tube = numbered(tube, caps)
    block_object = doc.addObject("Part::Feature", "Block")
    block_object.Shape = tube
    doc.recompute()
    name = name_at(tube, "Edge", App.Vector(0, 0, 0))
    feature = api.make_surface_feature(
        doc, block_object, ["Face3"], start_edges=[name], layer_height=5
    )
    return block_object, feature, "StartEdges", name, {"start_edges": [name]}


def start_face_case(doc, draw):
    low, high = (
        Part.Face(
            Part.makePolygon(
                [App.Vector(x, y, z) for x, y in ((0, 0), (30, 0), (30, 20), (0, 20), (0, 0))]
            )
        )
        for z in (0.0, 8.0)
    )
    block_object = doc.addObject("Part::Feature", "Block")
    block_object.Shape = Part.makeBox(30, 20, 8)
    doc.recompute()
    name = name_at(block_object.Shape, "Face", low.BoundBox.Center)
    assert name != name_at(block_object.Shape, "Face", high.BoundBox.Center)
    values = {"layers": "geodesic", "layer_height": 4, "chord_error": 0.5}
    feature = api.make_solid_feature(
        doc, block_object, start_faces=(block_object, [name]), **values
    )
    return block_object, feature, "StartFaces", name, {"start_faces": (block_object, [name])}


def guide_case(doc, draw):
    bar = doc.addObject("Part::Feature", "Bar")
    bar.Shape = Part.makeBox(10, 10, 30)
    block_object = doc.addObject("Part::Feature", "Block")
    block_object.Shape = Part.makeBox(20, 15, 30, App.Vector(5, 5, 0))
    doc.recompute()
    name = name_at(block_object.Shape, "Edge", App.Vector(5, 5, 15))
    feature = api.make_solid_feature(
        doc, bar, guide=(block_object, [name]), layers="along", layer_height=5
    )
    return block_object, feature, "Guide", name, {"guide": (block_object, [name])}


@pytest.mark.parametrize("made", [axis_case, start_edge_case, start_face_case, guide_case])
def test_what_other_links_name_is_told_until_it_is_confirmed(doc, made, tmp_path):
    block_object, feature, link, name, again = made(doc, random.Random(1))
    assert feature.Status == "up to date" and warnings(feature) == []
    shape = block_object.Shape.copy()
    kind = name.rstrip("0123456789")
    renumbered, new = in_another_order(shape, name, random.Random(2))
    put_quietly(block_object, renumbered)
    if (
        getattr(feature, link)[1] != [name] or feature.Status == "failed"
    ):  # FreeCAD 1.0 may have followed or lost it
        assert warnings(feature) == [] and App.Version()[0] != "0"
        assert getattr(feature, link)[1] == [new] or "no longer exists" in feature.Message
        return
    ((code, message),) = warnings(feature)
    kind = kind.lower()
    assert code == f"{kind.upper()}S_CHANGED"
    assert f"{name} of Block is not the selected {kind}: that {kind} is {new} now" in message
    doc.saveAs(str(tmp_path / "block.FCStd"))
    App.closeDocument(doc.Name)
    opened = App.openDocument(str(tmp_path / "block.FCStd"))
    try:
        block_object, feature = opened.getObject("Block"), opened.getObject("Feature")
        assert warnings(feature) == [(code, message)]
        api.change(feature, chord_error=0.2)
        api.recompute(opened, force=True)
        assert warnings(feature) == [(code, message)]
        api.change(
            feature,
            **{
                key: (block_object, value[1]) if isinstance(value, tuple) else value
                for key, value in again.items()
            },
        )
        assert warnings(feature) == []
        put_quietly(block_object, shape)
        followed = App.Version()[0] != "0" and (
            getattr(feature, link)[1] != [name] or feature.Source[1][0].startswith("?")
        )
        assert [code for code, _ in warnings(feature)] == [
            code
        ] or followed  # the confirmed element is a different one now
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
    block_object = doc.addObject("Part::Feature", "Block")
    ends = App.Vector(0, 0, 5), App.Vector(40, 0, 5)
    block_object.Shape = Part.makePolygon(ends)
    doc.recompute()
    feature = api.make_curves_feature(doc, block_object, ["Edge1"], **CURVES)
    put(block_object, Part.Wire([Part.makeCircle(20, App.Vector(0, 0, 5))]))
    ((code, message),) = warnings(feature)
    assert (
        code == "EDGES_CHANGED"
        and "Edge1 of Block was a straight line when selected and is a circle now" in message
    )
    put(block_object, Part.makePolygon(ends[::-1]))
    assert warnings(feature) == []  # its sense does not matter
    put(block_object, Part.makePolygon((App.Vector(0, 9, 5), App.Vector(40, 11, 5))))
    assert warnings(feature) == []  # there is no other edge
    put(
        block_object,
        Part.makePolygon((App.Vector(0, 9, 5), App.Vector(40, 19, 5), App.Vector(40, 30, 5))),
    )
    ((code, message),) = warnings(feature)
    assert (
        code == "EDGES_CHANGED"
        and "Edge1 of Block has changed its position since its selection" in message
    )


def test_a_line_of_a_sketch_that_is_drawn_by_an_end_is_the_one_that_was_chosen(doc):
    sketch = doc.addObject("Sketcher::SketchObject", "Sketch")
    sketch.Placement = App.Placement(App.Vector(3, 0, 10), App.Rotation(App.Vector(1, 0, 0), 90))
    corners = [App.Vector(*corner, 0) for corner in ((0, 0), (40, 0), (60, 20), (60, 50))]
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
    ]  # the next line has its number


def test_an_edge_that_a_fillet_beside_it_makes_shorter_and_gives_another_number_is_told(doc):
    box = Part.makeBox(40, 30, 20)
    block_object = block(doc, box)
    report_count = 0
    for k in range(1, 13):
        put_quietly(block_object, box)
        feature = api.make_curves_feature(doc, block_object, [f"Edge{k}"], **CURVES)
        selected_edge = box.Edges[k - 1]
        middle, direction = selected_edge.CenterOfMass, selected_edge.Curve.Direction
        for n in range(1, 13):
            if n == k:
                continue
            put_quietly(block_object, box.makeFillet(3, [box.Edges[n - 1]]))
            shape = block_object.Shape.copy()
            shape.Placement = App.Placement()
            lies = [
                number
                for number, edge in enumerate(shape.Edges, 1)
                if edge.Curve.TypeId == "Part::GeomLine"
                and ((edge.CenterOfMass - middle).cross(direction)).Length < 1e-6
            ]
            named = int(feature.Source[1][0].lstrip("?")[4:])
            right = named in lies or feature.Source[1][0].startswith("?")
            assert len(warnings(feature)) == (not right), (k, n, lies)
            report_count += not right
            put_quietly(block_object, box)
            feature.Source = (block_object, [f"Edge{k}"])
            api.recompute(doc)
        doc.removeObject(feature.Name)
    assert report_count > 0 or App.Version()[0] != "0"


def test_the_same_names_of_another_part_are_chosen_anew(doc):
    shape = Part.makeBox(40, 30, 20)
    again = numbered(shape, [3, 5, 1, 0, 2, 4])
    pairs = enumerate(zip(shape.Edges, again.Edges), 1)
    name = next(
        f"Edge{k}"
        for k, (name_, another) in pairs
        if name_.Curve.Direction.cross(another.Curve.Direction).Length > 0.1
    )
    block_object, second_block = block(doc, shape), block(doc, again)
    feature = api.make_curves_feature(doc, block_object, [name], **CURVES)
    feature.Source = (second_block, [name])
    api.recompute(doc)
    assert feature.Status == "up to date" and warnings(feature) == []
    feature.Source = None
    with pytest.raises(InputError):
        api.recompute(doc)
    feature.Source = (block_object, [name])
    api.recompute(doc)
    assert feature.Status == "up to date" and warnings(feature) == []


def test_a_copy_knows_what_was_chosen(doc):
    shape = Part.makeBox(40, 30, 20)
    block_object = block(doc, shape)
    feature = api.make_curves_feature(doc, block_object, ["Edge1"], **CURVES)
    put(block_object, numbered(shape, [3, 5, 1, 0, 2, 4]))
    if feature.Source[1] != ["Edge1"]:
        return  # FreeCAD 1.0 and later may have followed it
    assert len(warnings(feature)) == 1
    copies = App.newDocument("Copies")
    try:
        copies.copyObject(feature, True)
        api.recompute(copies, force=True)
        assert [warnings(feature_copy) for feature_copy in api.stages_of(copies, "feature")] == [
            warnings(feature)
        ]
    finally:
        App.closeDocument(copies.Name)


def test_documents_from_before_know_their_edges_once_they_are_opened(doc, tmp_path):
    block_object, feature, link, name, _ = axis_case(doc, None)
    shape = block_object.Shape.copy()
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
    all_edges = [f"Edge{k + 1}" for k in range(len(ball.Shape.Edges))]
    feature = api.make_curves_feature(doc, ball, [all_edges[1]], **CURVES)
    assert len(feature.ChosenFaces) == 2
    feature.Source = (ball, all_edges)
    try:
        api.recompute(doc)
    except Exception as error:
        assert type(error).__module__ == "freecad_am.core.issues", error


def test_an_edge_that_freecad_knows_to_be_lost_is_told(doc):
    block_object, feature, _, name, _ = axis_case(doc, None)
    feature.Axis = (block_object, [f"?{name}"])
    with pytest.raises(
        InputError,
        match=f"{name} no longer exists after a change of the part; choose the edges again",
    ):
        api.recompute(doc)
    assert feature.Status == "failed"
    feature.Axis = (block_object, [name])
    api.recompute(doc)
    assert feature.Status == "up to date" and warnings(feature) == []
