# SPDX-License-Identifier: LGPL-2.1-or-later
"""Guides, starts and scans behind links, Draft arrays, and values of sheets are at their shown
location, and stale when they change."""

import FreeCAD as App
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.objects.shapes.bodies import global_shape

OK, STALE = "up to date", "stale"
HIGH = App.Placement(App.Vector(300, 20, 50), App.Rotation(App.Vector(0, 0, 1), 90))


def points(stage):
    """Return all points of the beads of a toolpath."""
    beads = [bead for layer in api.result(stage).layers for bead in layer.beads]
    return np.vstack([bead.points for bead in beads])


def link_in_part(doc, target, placement):
    """Return a link to an object, in a part with that placement."""
    link, container = doc.addObject("App::Link", "Link"), doc.addObject("App::Part", "Part")
    link.LinkedObject = target
    link.LinkTransform = True
    container.addObject(link)
    container.Placement = placement
    doc.recompute()
    return link, container


def block(doc, name, *size):
    box = doc.addObject("Part::Box", name)
    box.Length, box.Width, box.Height = size
    return box


def check_change(doc, toolpath, change, tmp_path):
    """Assert that nothing is exported after a change until the document is recomputed once."""
    api.export_wires(toolpath, str(tmp_path / "before.dxf"))
    change()
    with pytest.raises(InputError, match="recompute"):
        api.export_wires(toolpath, str(tmp_path / "stale.dxf"))
    doc.recompute()
    assert toolpath.Status == OK, toolpath.Message
    api.export_wires(toolpath, str(tmp_path / "after.dxf"))


def edge_at(shape, position):
    """Return the name of the edge whose middle is there."""
    distances = [edge.CenterOfMass.distanceToPoint(position) for edge in shape.Edges]
    return f"Edge{int(np.argmin(distances)) + 1}"


def face_at(shape, position):
    distances = [face.CenterOfMass.distanceToPoint(position) for face in shape.Faces]
    return f"Face{int(np.argmin(distances)) + 1}"


def test_a_guide_behind_a_link(doc, tmp_path):
    """Layers follow an upright edge that the part of its link rotates onto the X axis."""
    bar, rail = block(doc, "Bar", 40, 10, 10), block(doc, "Rail", 5, 5, 40)
    lying = App.Placement(App.Vector(0, 0, 0), App.Rotation(App.Vector(0, 1, 0), 90))
    link, container = link_in_part(doc, rail, lying)
    edge = edge_at(rail.Shape, App.Vector(0, 0, 20))
    feature = api.make_solid_feature(doc, bar, guide=(link, [edge]), layers="along", layer_height=4)
    toolpath = api.make_toolpath(doc, feature)
    for layer in api.result(toolpath).layers:
        for bead in layer.beads:
            assert np.ptp(bead.points[:, 0]) < 1e-6
    assert len(api.result(toolpath).layers) == 10

    def tilt():
        container.Placement.Rotation = App.Rotation(App.Vector(0, 1, 0), 80)

    check_change(doc, toolpath, tilt, tmp_path)
    bead = api.result(toolpath).layers[3].beads[0]
    assert np.ptp(bead.points[:, 0]) > 0.5


def test_start_faces_behind_a_link(doc, tmp_path):
    """Layers keep their distance from a face of a block that a part moves."""
    top_block, base = block(doc, "Top", 30, 20, 8), block(doc, "Base", 30, 20, 8)
    link, holder = link_in_part(doc, base, App.Placement(App.Vector(0, 0, -8), App.Rotation()))
    top = face_at(base.Shape, App.Vector(15, 10, 8))
    feature = api.make_solid_feature(
        doc,
        top_block,
        start_faces=(link, [top]),
        layers="geodesic",
        layer_height=4,
        chord_error=0.5,
    )
    toolpath = api.make_toolpath(doc, feature)
    assert len(api.result(toolpath).layers) == 2

    holder.Placement.Base.z = -9
    assert toolpath.Status == STALE
    doc.recompute()
    assert "which are 1 mm away" in toolpath.Message
    with pytest.raises(InputError, match=r"recompute|away"):
        api.export_wires(toolpath, str(tmp_path / "apart.dxf"))
    holder.Placement.Base.z = -8
    doc.recompute()
    assert toolpath.Status == OK


def test_start_edges_of_a_wall_behind_a_link(doc, tmp_path):
    wall = doc.addObject("Part::Feature", "Wall")
    wall.Shape = Part.makeCylinder(20, 30)
    link, holder = link_in_part(doc, wall, HIGH)
    side = face_at(wall.Shape, App.Vector(0, 0, 15))
    low = edge_at(wall.Shape, App.Vector(0, 0, 0))
    feature = api.make_surface_feature(doc, link, [side], start_edges=[low], layer_height=5)
    toolpath = api.make_toolpath(doc, feature)
    bead_points = points(toolpath)
    assert bead_points[:, 2].min() == pytest.approx(50, abs=5.1)
    assert bead_points[:, 2].max() <= 80.0 + 1e-6
    assert np.hypot(bead_points[:, 0] - 300, bead_points[:, 1] - 20) == pytest.approx(20, abs=0.2)

    def move():
        holder.Placement.Base.x = 0

    check_change(doc, toolpath, move, tmp_path)
    assert np.hypot(points(toolpath)[:, 0], points(toolpath)[:, 1] - 20) == pytest.approx(
        20, abs=0.2
    )


def test_a_scan_of_a_plate_behind_a_link(doc, tmp_path):
    """The points are measured on the plate at the location of its link."""
    plate = block(doc, "Plate", 200, 120, 10)
    link, holder = link_in_part(doc, plate, HIGH)
    top = block(doc, "Block", 20, 60, 12)
    top.Placement.Base = App.Vector(230, 90, 60)
    doc.recompute()
    x, y = np.meshgrid(np.linspace(181, 299, 60), np.linspace(21, 219, 100))
    z = 60.0 + 0.002 * (y - 120.0)
    path = tmp_path / "scan.xyz"
    np.savetxt(path, np.column_stack([x.ravel(), y.ravel(), z.ravel()]))
    scan = api.make_scan(doc, link, str(path))
    feature = api.make_solid_feature(doc, top, substrate=link, layer_height=4, bead_spacing=10)
    toolpath = api.make_toolpath(doc, feature, scan=scan, scan_band=10)
    first_layer = np.vstack([bead.points for bead in api.result(toolpath).layers[0].beads])
    assert first_layer[:, 2] == pytest.approx(60.0 + 0.002 * (first_layer[:, 1] - 120.0), abs=0.02)

    api.export_wires(toolpath, str(tmp_path / "before.dxf"))
    holder.Placement.Base.z = 50.5
    assert STALE in (toolpath.Status, scan.Status)
    with pytest.raises(InputError, match="recompute"):
        api.export_wires(toolpath, str(tmp_path / "w.dxf"))


@pytest.mark.parametrize("use_link", [True, False])
@pytest.mark.parametrize("kind", ["polar", "path"])
@pytest.mark.parametrize("role", ["part", "substrate"])
def test_arrays_of_draft(doc, tmp_path, kind, role, use_link):
    Draft = pytest.importorskip("Draft")
    base = block(doc, "Base", 20, 10, 8)
    base.Placement.Base = App.Vector(40, 0, 0)
    doc.recompute()
    if kind == "polar":
        array = Draft.make_polar_array(base, 4, 360.0, App.Vector(0, 0, 0), use_link=use_link)
    else:
        rail = doc.addObject("Part::Feature", "Rail")
        rail.Shape = Part.makePolygon([App.Vector(0, 0, 0), App.Vector(0, 300, 0)])
        array = Draft.make_path_array(base, rail, 4, use_link=use_link)
    doc.recompute()
    holder = doc.addObject("App::Part", "Holder")
    holder.addObject(array)
    holder.Placement.Base.z = 100
    doc.recompute()
    shape = global_shape(array)
    assert len(shape.Solids) == 4 and shape.BoundBox.ZMin == pytest.approx(100)
    if role == "part":
        feature = api.make_solid_feature(doc, array, layer_height=4)
    else:
        top = block(doc, "Cube", 8, 8, 8)
        middle = shape.Solids[1].CenterOfMass
        top.Placement.Base = App.Vector(middle.x - 4, middle.y - 4, 108)
        doc.recompute()
        feature = api.make_solid_feature(doc, top, substrate=array, layer_height=4)
    toolpath = api.make_toolpath(doc, feature)
    low = 100.0 if role == "part" else 108.0
    assert points(toolpath)[:, 2].min() == pytest.approx(low, abs=4.1)
    if role == "part":
        box = shape.BoundBox
        spread = np.ptp(points(toolpath)[:, :2], axis=0)
        assert spread == pytest.approx([box.XLength, box.YLength], abs=9.0)

    def change():
        if kind == "polar":
            array.NumberPolar = 3
        else:
            array.Count = 3

    check_change(doc, toolpath, change, tmp_path)
    assert len(global_shape(array).Solids) == 3

    def resize():
        base.Width = 12

    check_change(doc, toolpath, resize, tmp_path)


def test_values_of_a_variable_set(doc, tmp_path):
    if int(App.Version()[0]) < 1:
        pytest.skip("FreeCAD has variable sets since 1.0")
    values, box = doc.addObject("App::VarSet", "Values"), block(doc, "Box", 40, 20, 8)
    values.addProperty("App::PropertyLength", "Long", "Base").Long = 40
    values.addProperty("App::PropertyLength", "Layer", "Base").Layer = 4
    box.setExpression("Length", "Values.Long")
    doc.recompute()
    feature = api.make_solid_feature(doc, box, layer_height=4)
    feature.setExpression("LayerHeight", "Values.Layer")
    doc.recompute()
    toolpath = api.make_toolpath(doc, feature)
    original_width = np.ptp(points(toolpath)[:, 0])

    def lengthen():
        values.Long = 60

    check_change(doc, toolpath, lengthen, tmp_path)
    assert np.ptp(points(toolpath)[:, 0]) == pytest.approx(original_width + 20, abs=1e-6)

    def halve():
        values.Layer = 2

    check_change(doc, toolpath, halve, tmp_path)
    assert len(api.result(toolpath).layers) == 4


def test_links_that_copy_on_change(doc, tmp_path):
    """Such a link shows a copy of its own after a change of its property."""
    box = block(doc, "Box", 40, 20, 8)
    box.addProperty("App::PropertyLength", "Long", "Base", "", 0)
    box.setPropertyStatus("Long", "CopyOnChange")
    box.Long = 40
    box.setExpression("Length", "Long")
    doc.recompute()
    link = doc.addObject("App::Link", "Link")
    link.LinkedObject = box
    link.LinkCopyOnChange = "Enabled"
    link.Placement.Base.z = 30
    doc.recompute()
    feature = api.make_solid_feature(doc, link, layer_height=4)
    toolpath = api.make_toolpath(doc, feature)
    original_width = np.ptp(points(toolpath)[:, 0])
    assert points(toolpath)[:, 2].min() == pytest.approx(30, abs=4.1)

    def lengthen():
        link.Long = 60

    check_change(doc, toolpath, lengthen, tmp_path)
    assert link.LinkedObject != box and box.Shape.BoundBox.XLength == pytest.approx(40)
    assert np.ptp(points(toolpath)[:, 0]) == pytest.approx(original_width + 20, abs=1e-6)

    box.Long = 50
    doc.recompute()
    assert toolpath.Status == OK
    assert np.ptp(points(toolpath)[:, 0]) == pytest.approx(original_width + 20, abs=1e-6)
