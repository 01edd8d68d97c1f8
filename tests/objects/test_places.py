# SPDX-License-Identifier: LGPL-2.1-or-later
"""Shapes are where FreeCAD shows them: in containers, behind links, in link arrays and link groups.
Matrices give the expected positions from the numbers of the document."""

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
    """Return a placement of x y z and an angle in degrees about the axis (1, 2, 3)."""
    *base, angle = numbers
    return App.Placement(App.Vector(*base), App.Rotation(App.Vector(1, 2, 3), angle))


def transformed(points, *placements, scale=(1.0, 1.0, 1.0)):
    """Return points scaled and then moved by placements, the innermost first, by Rodrigues' formula
    instead of FreeCAD."""
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
    """Return whether the corners of a shape equal those of boxes."""
    points = {tuple(point) for points in point_sets for point in np.round(points, 6) + 0.0}
    expected = np.array(sorted(points))
    shape_corners = corners(shape)
    return shape_corners.shape == expected.shape and np.abs(shape_corners - expected).max() < 1e-5


BOX_POSE = (3, -2, 1, 20)  # the box itself
LINK = (0, 30, 2, -40)
INNER_POSE, OUTER_POSE = (0, 0, 50, 30), (7, 8, 100, 75)


@pytest.fixture
def box(doc):
    box = doc.addObject("Part::Box", "Box")
    box.Length, box.Width, box.Height = SIZE
    box.Placement = placement(*BOX_POSE)
    return box


def link_to(doc, target, name="Link", transform=False):
    link = doc.addObject("App::Link", name)
    link.LinkedObject, link.LinkTransform = target, transform
    link.Placement = placement(*LINK)
    return link


def inside(doc, *objects):
    """Put objects into a part in a part, both rotated."""
    inner, outer = doc.addObject("App::Part", "Inner"), doc.addObject("App::Part", "Outer")
    inner.Placement, outer.Placement = placement(*INNER_POSE), placement(*OUTER_POSE)
    for obj in objects:
        inner.addObject(obj)
    outer.addObject(inner)
    doc.recompute()
    return inner, outer


def test_a_link_in_a_turned_part(doc, box):
    """FreeCAD has no `getGlobalPlacement` for links, which once were planned unrotated at z 0."""
    container = doc.addObject("App::Part", "Part")
    container.Placement = App.Placement(App.Vector(0, 0, 50), App.Rotation(App.Vector(0, 0, 1), 30))
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = box
    box.Placement = App.Placement()
    container.addObject(link)
    doc.recompute()
    shape = global_shape(link)
    assert (shape.BoundBox.ZMin, shape.BoundBox.ZMax) == pytest.approx((50, 55))
    turned = 10 * np.sin(np.radians(30)) + 6 * np.cos(np.radians(30))
    assert shape.BoundBox.YLength == pytest.approx(turned)
    # the reason why the package walks up the containers
    assert not hasattr(link, "getGlobalPlacement")


@pytest.mark.parametrize("transform", [False, True])
def test_links_in_nested_parts(doc, box, transform):
    link = link_to(doc, box, transform=transform)
    second = link_to(doc, link, "Second", transform=True)
    inside(doc, link, second)
    link_poses = [BOX_POSE] if transform else []
    assert is_at(
        global_shape(link), transformed(CORNERS, *link_poses, LINK, INNER_POSE, OUTER_POSE)
    )
    assert is_at(
        global_shape(second), transformed(CORNERS, *link_poses, LINK, LINK, INNER_POSE, OUTER_POSE)
    )
    assert [container.Name for container in containers_of(link)] == ["Inner", "Outer"]


def test_links_to_parts_and_bodies(doc, box):
    """A link to a part shows the part's content once, without the containers of the part."""
    container, group = (
        doc.addObject("App::Part", "Part"),
        doc.addObject("App::DocumentObjectGroup", "Group"),
    )
    container.Placement = placement(*INNER_POSE)
    container.addObject(group)
    group.addObject(box)
    body = doc.addObject("PartDesign::Body", "Body")
    body.Placement = placement(*BOX_POSE)
    pad = doc.addObject("PartDesign::AdditiveBox", "Pad")
    body.addObject(pad)
    pad.Length, pad.Width, pad.Height = SIZE
    container.addObject(body)
    doc.recompute()
    link, of_body = link_to(doc, container, "OfPart", True), link_to(doc, body, "OfBody")
    outer = doc.addObject("App::Part", "Outer")
    outer.Placement = placement(*OUTER_POSE)
    outer.addObject(link)
    outer.addObject(of_body)
    doc.recompute()
    assert is_at(global_shape(of_body), transformed(CORNERS, LINK, OUTER_POSE))
    assert is_at(global_shape(pad), transformed(CORNERS, BOX_POSE, INNER_POSE))
    assert is_at(global_shape(link), transformed(CORNERS, BOX_POSE, INNER_POSE, LINK, OUTER_POSE))
    assert len(container.Shape.Solids) == 3  # FreeCAD has the box of the group twice
    assert global_shape(link).Volume == pytest.approx(2 * SIZE.prod())


@pytest.mark.parametrize("shown", [True, False])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (2, 1, 1)])
def test_link_arrays_and_their_elements(doc, box, shown, scale):
    """Three boxes have their own placements, whether FreeCAD shows the elements as objects or
    not."""
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
        transformed(
            CORNERS, step, LINK, INNER_POSE, OUTER_POSE, scale=scale if k == 2 else (1, 1, 1)
        )
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
    expected = transformed(
        CORNERS + np.array([20.0, 0, 0]), INNER_POSE, OUTER_POSE, scale=(2, 1, 1)
    )
    assert is_at(global_shape(array.ElementList[1]), expected)
    assert is_at(global_shape(array, "1."), expected)


def test_link_groups_place_what_they_hold(doc, box):
    group = doc.addObject("App::LinkGroup", "LinkGroup")
    group.ElementList = [box]
    group.Placement = placement(*LINK)
    inside(doc, group)
    expected = transformed(CORNERS, BOX_POSE, LINK, INNER_POSE, OUTER_POSE)
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
    """A link in a rotated part points to a box in a part of another document."""
    doc.saveAs(str(tmp_path / "linking.FCStd"))
    other_document = App.newDocument("Other")
    try:
        linked_box = other_document.addObject("Part::Box", "Far")
        linked_box.Length, linked_box.Width, linked_box.Height = SIZE
        linked_box.Placement = placement(*BOX_POSE)
        holder = other_document.addObject("App::Part", "Holder")
        holder.Placement = placement(*OUTER_POSE)
        holder.addObject(linked_box)
        other_document.recompute()
        other_document.saveAs(str(tmp_path / "linked.FCStd"))
        link = link_to(doc, holder, transform=True)
        inner, _ = inside(doc, link)
        assert is_at(
            global_shape(link),
            transformed(CORNERS, BOX_POSE, OUTER_POSE, LINK, INNER_POSE, OUTER_POSE),
        )
        needs = dependencies_of(link)
        assert needs.documents == (doc, other_document)
        assert {linked_box, holder, link} <= set(needs.objects) and needs.containers[0] == inner
    finally:
        doc.removeObject("Link")
        App.closeDocument(other_document.Name)


def test_what_determines_shape_and_place(doc, box):
    """The result depends on links, their targets, containers, and the names in expressions of
    containers, and on nothing else."""
    sheet, beside = doc.addObject("Spreadsheet::Sheet", "Sheet"), doc.addObject("Part::Box", "Not")
    sheet.set("A1", "3")
    link = link_to(doc, box)
    inner, outer = inside(doc, link, beside)
    outer.setExpression("Placement.Base.x", "Sheet.A1")
    doc.recompute()
    needs = dependencies_of(link)
    assert set(needs.objects) == {link, box, sheet}
    assert needs.containers == (inner, outer) and needs.documents == (doc,)
    original = outer_matrix(link)
    sheet.set("A1", "4")
    doc.recompute()
    assert np.allclose(outer_matrix(link)[:3, 3] - original[:3, 3], (1, 0, 0))


def test_bodies_that_the_nozzle_is_kept_clear_of(doc, box):
    link = link_to(doc, box)
    inside(doc, link)
    vertices = np.unique(np.round(body_of(link).vertices, 5), axis=0)
    expected = np.unique(np.round(transformed(CORNERS, LINK, INNER_POSE, OUTER_POSE), 5), axis=0)
    assert np.abs(vertices - expected).max() < 1e-4


def test_an_axis_in_a_link_in_a_part(doc):
    """The edge of a linked line rotates with the part that holds the link."""
    from types import SimpleNamespace

    from freecad_am.objects.feature import axis_of

    line = doc.addObject("Part::Feature", "Line")
    line.Shape = Part.makeLine(App.Vector(1, 0, 0), App.Vector(1, 0, 9))
    link = link_to(doc, line)
    inside(doc, link)
    feature = SimpleNamespace(Axis=(link, ["Edge1"]), Source=None, Label="Feature")
    point, direction = (np.array(vector) for vector in axis_of(feature))
    start, end = transformed(np.array([[1.0, 0, 0], [1.0, 0, 9]]), LINK, INNER_POSE, OUTER_POSE)
    assert point == pytest.approx(start) and direction == pytest.approx((end - start) / 9)


def extents(body):
    return np.concatenate([body.vertices.min(axis=0), body.vertices.max(axis=0)])


def box_extents(*point_sets):
    points = np.concatenate(point_sets)
    return np.concatenate([points.min(axis=0), points.max(axis=0)])


MESH_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * SIZE / 2


@pytest.mark.parametrize("transform", [False, True])
@pytest.mark.parametrize("scale", [(1, 1, 1), (-1, 1, 1), (2, 1, 1)])
def test_links_to_meshes_stand_where_the_link_does(doc, transform, scale):
    """FreeCAD returns the mesh of the linked object at its own location."""
    import Mesh

    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(*SIZE)
    mesh.Placement = placement(*BOX_POSE)
    link = link_to(doc, mesh, transform=transform)
    link.ScaleVector = App.Vector(*scale)
    inside(doc, link)
    mesh_corners = transformed(MESH_CORNERS, BOX_POSE) if transform else MESH_CORNERS
    body = body_of(link)
    assert extents(body) == pytest.approx(
        box_extents(transformed(mesh_corners, LINK, INNER_POSE, OUTER_POSE, scale=scale)), abs=1e-4
    )
    a, b, c = body.vertices[body.triangles].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->", np.cross(a, b), c) / 6
    assert volume == pytest.approx(SIZE.prod() * abs(np.prod(scale)), rel=1e-4)  # outwards


@pytest.mark.parametrize("shown", [True, False])
def test_link_arrays_of_meshes(doc, shown):
    import Mesh

    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(*SIZE)
    mesh.Placement = placement(*BOX_POSE)
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
        transformed(
            transformed(MESH_CORNERS, BOX_POSE, step), LINK, INNER_POSE, OUTER_POSE, scale=(2, 1, 1)
        )
        for step in steps
    ]
    assert extents(body_of(array)) == pytest.approx(box_extents(*boxes), abs=1e-4)
    array.setElementVisible("Array_i2" if shown else "2", False)
    assert extents(body_of(array)) == pytest.approx(box_extents(*boxes[:2]), abs=1e-4)


def test_a_container_of_shapes_and_meshes_is_rejected(doc, box):
    """Its mesh was once dropped without a message."""
    import Mesh

    mesh = doc.addObject("Mesh::Feature", "Mesh")
    mesh.Mesh = Mesh.createBox(*SIZE)
    container = doc.addObject("App::Part", "Part")
    container.Placement = placement(*INNER_POSE)
    container.addObject(mesh)
    doc.recompute()
    assert extents(body_of(container)) == pytest.approx(
        box_extents(transformed(MESH_CORNERS, INNER_POSE)), abs=1e-4
    )
    container.addObject(box)
    doc.recompute()
    with pytest.raises(InputError) as caught:
        body_of(container)
    assert caught.value.code == "MIXED" and caught.value.where == "Part"
    mesh.Visibility = False
    assert is_at(global_shape(container), transformed(CORNERS, BOX_POSE, INNER_POSE))
    body_of(container)


def test_an_assembly_of_freecad_1(doc, box):
    """Components of assemblies are links, and sub-assemblies are rotated too."""
    if int(App.Version()[0]) < 1:
        pytest.skip("assemblies came with FreeCAD 1.0")
    assembly = doc.addObject("Assembly::AssemblyObject", "Assembly")
    link, inner = link_to(doc, box), doc.addObject("Assembly::AssemblyObject", "Inner")
    inner.Placement, assembly.Placement = placement(*INNER_POSE), placement(*OUTER_POSE)
    inner.addObject(link)
    assembly.addObject(inner)
    doc.recompute()
    assert is_at(global_shape(link), transformed(CORNERS, LINK, INNER_POSE, OUTER_POSE))
    assert is_at(global_shape(assembly), transformed(CORNERS, LINK, INNER_POSE, OUTER_POSE))
    assert [container.Name for container in containers_of(link)] == ["Inner", "Assembly"]
