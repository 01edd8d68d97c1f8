# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces and edges by paths through their containers: the selected edge is printed, or the path is
rejected."""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.objects.shapes.bodies import global_shape
from freecad_am.objects.shapes.part_file import part_shape
from freecad_am.objects.shapes.places import ArrayElement


@pytest.fixture
def nested(doc):
    """Return two boxes in a moved and rotated part, one of them in a group; a link to that part; a
    sketch in it."""
    container, group = (
        doc.addObject("App::Part", "Part"),
        doc.addObject("App::DocumentObjectGroup", "Group"),
    )
    container.addObject(group)
    a, b = doc.addObject("Part::Box", "A"), doc.addObject("Part::Box", "B")
    a.Length, b.Length, b.Label = 20, 30, "Bee"
    b.Placement = App.Placement(App.Vector(100, 0, 0), App.Rotation(App.Vector(1, 0, 0), 20))
    container.addObject(a)
    container.addObject(b)
    container.Placement = App.Placement(App.Vector(0, 7, 50), App.Rotation(App.Vector(0, 0, 1), 30))
    sketch = doc.addObject("Sketcher::SketchObject", "Sketch")
    container.addObject(sketch)
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject, link.Placement.Base = container, App.Vector(0, 500, 0)
    outer = doc.addObject("App::Part", "Outer")
    outer.Placement.Base = App.Vector(0, 0, 1000)
    doc.recompute()
    return doc


def ends(edge):
    return sorted(tuple(np.round(vertex.Point, 6)) for vertex in edge.Vertexes)


def curve_ends(feature):
    """Return the ends of the only curve of a feature."""
    (curve,) = api.result(feature).curves
    return sorted(tuple(point) for point in np.round(curve.points[[0, -1]], 6).tolist())


@pytest.mark.parametrize("edge", [f"Edge{k}" for k in range(1, 13)])
@pytest.mark.parametrize(
    ("top", "path"),
    [("Part", "A."), ("Part", "B."), ("Part", "$Bee."), ("Link", "A."), ("Link", "B.")],
)
def test_the_edge_that_a_path_names_is_laid(nested, top, path, edge):
    holder = nested.getObject(top)
    feature = api.make_curves_feature(nested, holder, [path + edge])
    assert curve_ends(feature) == ends(holder.getSubObject(path + edge))
    assert feature.Source[0].Name == ("Link" if top == "Link" else path.strip("$.")[0])
    assert "." not in feature.Source[1][0]


def test_a_part_within_a_part_is_where_it_is_seen(nested):
    nested.Outer.addObject(nested.Part)
    nested.recompute()
    for top, path in (("Outer", "Part.B.Edge5"), ("Part", "B.Edge5")):
        feature = api.make_curves_feature(nested, nested.getObject(top), [path])
        assert curve_ends(feature) == ends(nested.Outer.getSubObject("Part.B.Edge5"))
    api.change(feature, source=nested.Outer, faces=["Part.A.Edge7"])
    assert (
        curve_ends(feature) == ends(nested.Outer.getSubObject("Part.A.Edge7"))
        and feature.Source[0] == nested.A
    )


def test_faces_and_axes_by_paths(nested):
    clad = api.make_cladding_feature(nested, nested.Part, ["B.Face6"], bead_spacing=3)
    assert clad.Source[0] == nested.B and api.result(clad).area == pytest.approx(
        nested.B.Shape.Face6.Area
    )
    for axis in ("B.Edge5", "Sketch.V_Axis", "Origin.Z_Axis.", "Origin.Z_Axis"):
        with pytest.raises(InputError) as caught:  # a box has no axis of revolution
            api.make_feature(nested, nested.A, axis=(nested.Part, axis))
        assert caught.value.code != "BAD_AXIS" and "Axis" not in caught.value.where, (
            caught.value.line()
        )


@pytest.mark.parametrize(
    "path", ["B.Edge99", "C.Edge5", "A.Group.Edge1", "Edge5.", ".", "B.Foo", ".Edge5", "B..Edge5"]
)
def test_what_a_path_does_not_lead_to_is_refused(nested, path):
    object_names = [obj.Name for obj in nested.Objects]
    with pytest.raises(InputError) as caught:
        api.make_curves_feature(nested, nested.Part, [path])
    assert (
        caught.value.code in ("BAD_EDGES", "BAD_FACES", "BAD_AXIS")
        and caught.value.where == "source"
    )
    assert path in caught.value.message and [obj.Name for obj in nested.Objects] == object_names


def test_edges_of_two_objects_are_refused(nested):
    with pytest.raises(InputError, match="several objects") as caught:
        api.make_curves_feature(nested, nested.Part, ["A.Edge5", "B.Edge5"])
    assert caught.value.code == "BAD_EDGES"


def test_a_path_that_was_not_given_by_a_macro_is_refused(nested):
    """The property editor writes such a path; the edge of this number in the whole part was once
    used instead."""
    feature = api.make_curves_feature(nested, nested.B, ["Edge5"])
    feature.Source = (nested.Part, ["B.Edge5"])
    with pytest.raises(InputError, match=r"B\.Edge5 of Part is Edge5 of Bee") as caught:
        api.recompute(feature)
    assert caught.value.code == "BAD_EDGES" and feature.Status == "failed"
    feature.Source = (nested.B, ["Edge5"])
    api.recompute(feature)
    assert feature.Status == "up to date"


def test_what_is_in_a_group_of_a_part_is_there_once(nested):
    """FreeCAD includes such an object twice, in the group and in the part; its edges were once
    printed twice."""
    assert len(global_shape(nested.Part).Solids) == 2
    nested.Group.addObject(nested.B)
    nested.recompute()
    assert len(nested.Part.Shape.Solids) == 3
    shape = global_shape(nested.Part)
    assert (
        shape.Volume == pytest.approx(nested.A.Shape.Volume + nested.B.Shape.Volume)
        and len(shape.Edges) == 24
    )
    assert ends(shape.Edges[0]) in [
        ends(global_shape(box).Edges[0]) for box in (nested.A, nested.B)
    ]
    assert api.make_solid_feature(nested, nested.Part, layer_height=5).Solids == 2


@pytest.mark.parametrize("order", ["AGC", "GAC", "ACG"])
def test_names_of_a_part_that_has_something_twice_are_those_of_freecad_or_refused(
    doc, order, tmp_path
):
    """Without the second copy, the faces and edges after it have other numbers than FreeCAD
    shows."""
    boxes = {name: doc.addObject("Part::Box", name) for name in "ABC"}
    for k, box in enumerate(boxes.values()):
        box.Placement.Base.x, box.Length = 20 * k, 5 + k
    container, group = (
        doc.addObject("App::Part", "Part"),
        doc.addObject("App::DocumentObjectGroup", "Group"),
    )
    group.addObject(boxes["B"])
    for name in order:
        container.addObject({**boxes, "G": group}[name])
    doc.recompute()
    freecads, accepted = container.Shape, []
    assert len(freecads.Edges) == 48 and len(global_shape(container).Edges) == 36
    for number in range(1, 49):
        try:
            feature = api.make_curves_feature(doc, container, [f"Edge{number}"])
        except InputError as error:
            assert error.code in ("BAD_EDGES", "UNKNOWN_EDGE"), error.line()
            continue
        accepted.append(number)
        assert curve_ends(feature) == ends(freecads.Edges[number - 1])
    assert accepted == (list(range(1, 37)) if order == "ACG" else [])
    doc.saveAs(str(tmp_path / "part.FCStd"))
    if order == "ACG":
        assert part_shape(doc.FileName, "Part")[0].Edges[35].Length == pytest.approx(
            freecads.Edges[35].Length
        )
        return
    with pytest.raises(InputError, match="twice") as caught:
        part_shape(doc.FileName, "Part")
    assert caught.value.code == "NO_OBJECT"


def test_a_path_to_a_body_by_its_tip_is_the_body(doc):
    body = doc.addObject("PartDesign::Body", "Body")
    for kind, name in (("AdditiveBox", "Pad"), ("SubtractiveCylinder", "Bore")):
        body.addObject(doc.addObject(f"PartDesign::{kind}", name))
    doc.Bore.Radius = 3
    doc.recompute()
    for path, owner in (("Bore.Edge3", body), ("Pad.Edge3", doc.Pad)):
        feature = api.make_curves_feature(doc, body, [path])
        assert feature.Source[0] == owner
        assert (
            curve_ends(feature)
            == ends(global_shape(owner).getElement(feature.Source[1][0]))
            == ends(body.getSubObject(path))
        )
    feature.Source = (body, ["Bore.Edge3"])
    api.recompute(feature)
    assert feature.Status == "up to date"


@pytest.fixture
def linked(doc):
    """Return a rotated assembly with a link to a box and a link array of three, whose elements are
    objects or not."""
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = 20, 30, 10
    asm = doc.addObject("App::Part", "Asm")
    asm.Placement = App.Placement(App.Vector(0, 7, 50), App.Rotation(App.Vector(1, 2, 3), 30))
    link = doc.addObject("App::Link", "L1")
    link.LinkedObject = box
    link.Placement = App.Placement(App.Vector(0, 50, 0), App.Rotation(App.Vector(0, 1, 0), 40))
    for name in ("Shown", "Hidden"):
        array = doc.addObject("App::Link", name)
        array.LinkedObject, array.ElementCount = box, 3
        doc.recompute()
        for k, element in enumerate(array.ElementList):
            element.Placement = App.Placement(
                App.Vector(100 * k, 0, 0), App.Rotation(App.Vector(0, 0, 1), 20 * k)
            )
        array.ShowElement, array.Placement.Base.z = name == "Shown", 200 * len(name)
        asm.addObject(array)
    asm.addObject(link)
    doc.recompute()
    return doc


def shown_ends(doc, path):
    """Return the ends of the edge at a path of the assembly, as FreeCAD shows it."""
    return ends(Part.getShape(doc.Asm, path, needSubElement=True))


@pytest.mark.parametrize("edge", [f"Edge{k}" for k in (1, 5, 12)])
@pytest.mark.parametrize("path", ["L1.", "Shown.Shown_i1.", "Shown.2.", "Hidden.1.", "Hidden.2."])
def test_edges_of_links_and_link_arrays_by_paths(linked, path, edge):
    feature = api.make_curves_feature(linked, linked.Asm, [path + edge])
    assert curve_ends(feature) == shown_ends(linked, path + edge)
    owner = {"L1.": "L1", "Shown.Shown_i1.": "Shown_i1", "Shown.2.": "Shown_i2"}.get(path, "Hidden")
    assert feature.Source[0].Name == owner
    step, _, remaining_path = path.partition(".")
    if remaining_path:  # from the array itself, like a selection outside of the assembly
        feature = api.make_curves_feature(linked, linked.getObject(step), [remaining_path + edge])
        assert curve_ends(feature) == shown_ends(linked, path + edge)


@pytest.mark.parametrize("name", ["Shown", "Hidden"])
def test_an_element_of_a_link_array_in_every_role(linked, name):
    """Only one of three boxes is printed, built on or kept clear of; once the whole array was."""
    array = linked.getObject(name)
    element = api.array_element(array, 1)
    assert element == api.array_element(array, 1), "it is made once"
    expected = Part.getShape(linked.Asm, f"{name}.1.")
    for shape in (global_shape(element), global_shape(ArrayElement(array, 1))):
        assert shape.CenterOfMass.distanceToPoint(expected.CenterOfMass) < 1e-6
        assert len(shape.Solids) == 1 and shape.Volume == pytest.approx(6000)
    assert len(global_shape(linked.Asm).Solids) == 7, (
        "what stands for an element is not there twice"
    )
    top = api.array_element(array, 2)
    feature = api.make_solid_feature(linked, element, substrate=top, fixtures=[linked.L1])
    assert feature.Solids == 1
    assert [body.name for body in api.result(feature).surroundings] == [top.Label, "L1"]
    linked.Asm.Placement.Base.x += 5
    assert global_shape(element).CenterOfMass.x == pytest.approx(expected.CenterOfMass.x + 5)


def test_what_is_no_element_is_rejected(linked):
    for obj, index, message in (
        (linked.Box, 0, "not a link array"),
        (linked.Hidden, 3, "3 elements are numbered from 0"),
        (linked.Hidden, -1, "no element -1"),
        (linked.Hidden, "1", "not a whole number"),
        (None, 1, "not an object"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            api.array_element(obj, index)
        assert caught.value.code == "BAD_INPUT"


def test_all_of_an_element_by_its_path(linked):
    for path, centre in (("Hidden.1.", "Hidden.1."), ("Shown.Shown_i2.", "Shown.2.")):
        feature = api.make_curves_feature(linked, linked.Asm, [path])
        centre_of_mass = Part.getShape(linked.Asm, centre).CenterOfMass
        assert global_shape(feature.Source[0]).CenterOfMass.distanceToPoint(centre_of_mass) < 1e-6
