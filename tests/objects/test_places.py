# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes stand where FreeCAD shows them: in containers, behind links, in link arrays and link groups.

The right places are computed here by matrices, from the numbers that the document was made with.
"""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am.core.issues import InputError
from freecad_am.objects.shapes.bodies import body_of, global_shape
from freecad_am.objects.shapes.places import containers_of, dependencies_of, outer_matrix

SIZE = np.array([10.0, 6.0, 5.0])
CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * SIZE


def placement(*numbers):
    """Of x y z, and an angle in degrees about the axis (1, 2, 3)."""
    *base, angle = numbers
    return App.Placement(App.Vector(*base), App.Rotation(App.Vector(1, 2, 3), angle))


def moved(points, *placements, scale=(1.0, 1.0, 1.0)):
    """Points scaled and then moved by placements, the innermost first. Rodrigues, not FreeCAD."""
    points = points * np.array(scale)
    axis = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    cross = np.cross(np.eye(3), axis)
    for *base, angle in placements:
        angle = np.radians(angle)
        turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
        points = points @ turn.T + np.array(base, float)
    return points


def corners(shape):
    points = {tuple(np.round(vertex.Point, 6) + 0.0) for vertex in shape.Vertexes}
    return np.array(sorted(points))


def is_at(shape, *point_sets):
    """Whether the corners of a shape are those of boxes."""
    points = {tuple(point) for points in point_sets for point in np.round(points, 6) + 0.0}
    expected = np.array(sorted(points))
    found = corners(shape)
    return found.shape == expected.shape and np.abs(found - expected).max() < 1e-5


IN = (3, -2, 1, 20)  # of the box itself
LINK = (0, 30, 2, -40)
INNER, OUTER = (0, 0, 50, 30), (7, 8, 100, 75)


@pytest.fixture
def box(doc):
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = SIZE
    box.Placement = placement(*IN)
    return box


def link_to(doc, target, name="Link", transform=False):
    link = doc.addObject("App::Link", name)
    link.LinkedObject, link.LinkTransform = target, transform
    link.Placement = placement(*LINK)
    return link


def inside(doc, *held):
    """Objects in a part in a part, both turned."""
    inner, outer = doc.addObject("App::Part", "Inner"), doc.addObject("App::Part", "Outer")
    inner.Placement, outer.Placement = placement(*INNER), placement(*OUTER)
    for one in held:
        inner.addObject(one)
    outer.addObject(inner)
    doc.recompute()
    return inner, outer


def test_a_link_in_a_turned_part(doc, box):
    """FreeCAD has no `getGlobalPlacement` for links: they were planned at z 0, not turned."""
    part = doc.addObject("App::Part", "Part")
    part.Placement = App.Placement(App.Vector(0, 0, 50), App.Rotation(App.Vector(0, 0, 1), 30))
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = box
    box.Placement = App.Placement()
    part.addObject(link)
    doc.recompute()
    shape = global_shape(link)
    assert (shape.BoundBox.ZMin, shape.BoundBox.ZMax) == pytest.approx((50, 55))
    turned = 10 * np.sin(np.radians(30)) + 6 * np.cos(np.radians(30))
    assert shape.BoundBox.YLength == pytest.approx(turned)
    assert not hasattr(link, "getGlobalPlacement")  # why we walk up the containers


@pytest.mark.parametrize("transform", [False, True])
def test_links_in_nested_parts(doc, box, transform):
    link = link_to(doc, box, transform=transform)
    second = link_to(doc, link, "Second", transform=True)
    inside(doc, link, second)
    own = [IN] if transform else []
    assert is_at(global_shape(link), moved(CORNERS, *own, LINK, INNER, OUTER))
    assert is_at(global_shape(second), moved(CORNERS, *own, LINK, LINK, INNER, OUTER))
    assert [one.Name for one in containers_of(link)] == ["Inner", "Outer"]


def test_links_to_parts_and_bodies(doc, box):
    """A link to a part shows what is in the part, once each, without the containers of the part."""
    part, group = (
        doc.addObject("App::Part", "Part"),
        doc.addObject("App::DocumentObjectGroup", "Group"),
    )
    part.Placement = placement(*INNER)
    part.addObject(group)
    group.addObject(box)
    body = doc.addObject("PartDesign::Body", "Body")
    body.Placement = placement(*IN)
    pad = doc.addObject("PartDesign::AdditiveBox", "Pad")
    body.addObject(pad)
    pad.Length, pad.Width, pad.Height = SIZE
    part.addObject(body)
    doc.recompute()
    link, of_body = link_to(doc, part, "OfPart", True), link_to(doc, body, "OfBody")
    outer = doc.addObject("App::Part", "Outer")
    outer.Placement = placement(*OUTER)
    outer.addObject(link)
    outer.addObject(of_body)
    doc.recompute()
    assert is_at(global_shape(of_body), moved(CORNERS, LINK, OUTER))
    assert is_at(global_shape(pad), moved(CORNERS, IN, INNER))
    assert is_at(global_shape(link), moved(CORNERS, IN, INNER, LINK, OUTER))
    assert len(part.Shape.Solids) == 3  # FreeCAD has the box of the group twice
    assert global_shape(link).Volume == pytest.approx(2 * SIZE.prod())


@pytest.mark.parametrize("shown", [True, False])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (2, 1, 1)])
def test_link_arrays_and_their_elements(doc, box, shown, scale):
    """Three boxes, each with a placement of its own, whether FreeCAD shows the elements as objects or not."""
    array = doc.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount = box, 3
    array.Placement = placement(*LINK)
    doc.recompute()
    steps = [(20 * k, 0, k, 15 * k) for k in range(3)]
    for element, step in zip(array.ElementList, steps):
        element.Placement = placement(*step)
    array.ElementList[2].ScaleVector = App.Vector(*scale)
    array.ShowElement = shown
    inside(doc, array)
    boxes = [
        moved(CORNERS, step, LINK, INNER, OUTER, scale=scale if k == 2 else (1, 1, 1))
        for k, step in enumerate(steps)
    ]
    assert is_at(global_shape(array), *boxes)
    for k, expected in enumerate(boxes):
        assert is_at(global_shape(array, f"{k}."), expected)
        face = global_shape(array, f"{k}.Face6")
        assert face.ShapeType == "Face"
        assert np.abs(corners(face)[:, None] - expected[None]).max(axis=2).min(axis=1).max() < 1e-5
        if shown:
            assert is_at(global_shape(array.ElementList[k]), expected)


def test_a_scaled_array_scales_its_elements(doc, box):
    array = doc.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount = box, 2
    doc.recompute()
    array.ElementList[1].Placement.Base = App.Vector(20, 0, 0)
    array.ScaleVector = App.Vector(2, 1, 1)
    inside(doc, array)
    expected = moved(CORNERS + np.array([20.0, 0, 0]), INNER, OUTER, scale=(2, 1, 1))
    assert is_at(global_shape(array.ElementList[1]), expected)
    assert is_at(global_shape(array, "1."), expected)


def test_link_groups_place_what_they_hold(doc, box):
    group = doc.addObject("App::LinkGroup", "LinkGroup")
    group.ElementList = [box]
    group.Placement = placement(*LINK)
    inside(doc, group)
    expected = moved(CORNERS, IN, LINK, INNER, OUTER)
    assert is_at(global_shape(group), expected)
    assert is_at(global_shape(box), expected)
    second = doc.addObject("App::LinkGroup", "Second")
    second.ElementList = [box]
    doc.recompute()
    with pytest.raises(InputError, match="LinkGroup, Second") as caught:
        global_shape(box)
    assert caught.value.code == "SEVERAL_PLACES"
    assert is_at(global_shape(group), expected)


def test_links_across_documents(doc, box, tmp_path):
    """A link in a turned part to a box of another document, which stands in a part there."""
    doc.saveAs(str(tmp_path / "linking.FCStd"))
    other = App.newDocument("Other")
    try:
        far = other.addObject("Part::Box", "Far")
        far.Length, far.Width, far.Height = SIZE
        far.Placement = placement(*IN)
        holder = other.addObject("App::Part", "Holder")
        holder.Placement = placement(*OUTER)
        holder.addObject(far)
        other.recompute()
        other.saveAs(str(tmp_path / "linked.FCStd"))
        link = link_to(doc, holder, transform=True)
        inner, _ = inside(doc, link)
        assert is_at(global_shape(link), moved(CORNERS, IN, OUTER, LINK, INNER, OUTER))
        needs = dependencies_of(link)
        assert needs.documents == (doc, other)
        assert {far, holder, link} <= set(needs.objects) and needs.containers[0] == inner
    finally:
        doc.removeObject("Link")
        App.closeDocument(other.Name)


def test_what_determines_shape_and_place(doc, box):
    """All that decides: links, what they show, containers, and what expressions of containers name; nothing beside."""
    sheet, beside = doc.addObject("Spreadsheet::Sheet", "Sheet"), doc.addObject("Part::Box", "Not")
    sheet.set("A1", "3")
    link = link_to(doc, box)
    inner, outer = inside(doc, link, beside)
    outer.setExpression("Placement.Base.x", "Sheet.A1")
    doc.recompute()
    needs = dependencies_of(link)
    assert set(needs.objects) == {link, box, sheet}
    assert needs.containers == (inner, outer) and needs.documents == (doc,)
    before = outer_matrix(link)
    sheet.set("A1", "4")
    doc.recompute()
    assert np.allclose(outer_matrix(link)[:3, 3] - before[:3, 3], (1, 0, 0))


def test_bodies_that_the_nozzle_is_kept_clear_of(doc, box):
    link = link_to(doc, box)
    inside(doc, link)
    vertices = np.unique(np.round(body_of(link).vertices, 5), axis=0)
    expected = np.unique(np.round(moved(CORNERS, LINK, INNER, OUTER), 5), axis=0)
    assert np.abs(vertices - expected).max() < 1e-4


def test_an_axis_in_a_link_in_a_part(doc):
    """The edge of a linked line turns with the part that holds the link."""
    from types import SimpleNamespace

    from freecad_am.objects.feature import axis_of

    line = doc.addObject("Part::Feature", "Line")
    line.Shape = Part.makeLine(App.Vector(1, 0, 0), App.Vector(1, 0, 9))
    link = link_to(doc, line)
    inside(doc, link)
    feature = SimpleNamespace(Axis=(link, ["Edge1"]), Source=None, Label="Feature")
    point, way = (np.array(vector) for vector in axis_of(feature))
    start, end = moved(np.array([[1.0, 0, 0], [1.0, 0, 9]]), LINK, INNER, OUTER)
    assert point == pytest.approx(start) and way == pytest.approx((end - start) / 9)


def extents(body):
    return np.concatenate([body.vertices.min(axis=0), body.vertices.max(axis=0)])


def box_extents(*point_sets):
    points = np.concatenate(point_sets)
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


MESH_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * SIZE / 2


@pytest.mark.parametrize("transform", [False, True])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (2, 1, 1)])
def test_links_to_meshes_stand_where_the_link_does(doc, transform, scale):
    """FreeCAD gives the mesh of the linked object, at its own place."""
    import Mesh

    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(*SIZE)
    mesh.Placement = placement(*IN)
    link = link_to(doc, mesh, transform=transform)
    link.ScaleVector = App.Vector(*scale)
    inside(doc, link)
    own = moved(MESH_CORNERS, IN) if transform else MESH_CORNERS
    body = body_of(link)
    assert extents(body) == pytest.approx(
        box_extents(moved(own, LINK, INNER, OUTER, scale=scale)), abs=1e-4
    )
    a, b, c = body.vertices[body.triangles].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->", np.cross(a, b), c) / 6
    assert volume == pytest.approx(SIZE.prod() * abs(np.prod(scale)), rel=1e-4)  # outwards


@pytest.mark.parametrize("shown", [True, False])
def test_link_arrays_of_meshes(doc, shown):
    import Mesh

    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(*SIZE)
    mesh.Placement = placement(*IN)
    array = doc.addObject("App::Link", "Array")
    array.LinkedObject, array.ElementCount, array.LinkTransform = mesh, 3, True
    array.Placement, array.ScaleVector = placement(*LINK), App.Vector(2, 1, 1)
    doc.recompute()
    steps = [(20 * k, 0, k, 15 * k) for k in range(3)]
    for element, step in zip(array.ElementList, steps):
        element.Placement = placement(*step)
    array.ShowElement = shown
    inside(doc, array)
    boxes = [
        moved(moved(MESH_CORNERS, IN, step), LINK, INNER, OUTER, scale=(2, 1, 1)) for step in steps
    ]
    assert extents(body_of(array)) == pytest.approx(box_extents(*boxes), abs=1e-4)
    array.setElementVisible("Array_i2" if shown else "2", False)
    assert extents(body_of(array)) == pytest.approx(box_extents(*boxes[:2]), abs=1e-4)


def test_a_container_of_shapes_and_meshes_is_rejected(doc, box):
    """Its mesh was left out without a message."""
    import Mesh

    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(*SIZE)
    part = doc.addObject("App::Part", "Part")
    part.Placement = placement(*INNER)
    part.addObject(mesh)
    doc.recompute()
    assert extents(body_of(part)) == pytest.approx(
        box_extents(moved(MESH_CORNERS, INNER)), abs=1e-4
    )
    part.addObject(box)
    doc.recompute()
    with pytest.raises(InputError) as caught:
        body_of(part)
    assert caught.value.code == "MIXED" and caught.value.where == "Part"
    mesh.Visibility = False
    assert is_at(global_shape(part), moved(CORNERS, IN, INNER))
    body_of(part)


def test_an_assembly_of_freecad_1(doc, box):
    """Components of assemblies are links; sub-assemblies are turned too."""
    if int(App.Version()[0]) < 1:
        pytest.skip("assemblies came with FreeCAD 1.0")
    assembly = doc.addObject("Assembly::AssemblyObject", "Assembly")
    link, inner = link_to(doc, box), doc.addObject("Assembly::AssemblyObject", "Inner")
    inner.Placement, assembly.Placement = placement(*INNER), placement(*OUTER)
    inner.addObject(link)
    assembly.addObject(inner)
    doc.recompute()
    assert is_at(global_shape(link), moved(CORNERS, LINK, INNER, OUTER))
    assert is_at(global_shape(assembly), moved(CORNERS, LINK, INNER, OUTER))
    assert [one.Name for one in containers_of(link)] == ["Inner", "Assembly"]
