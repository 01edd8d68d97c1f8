# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on hubs in documents: the hub found, selected, given, or part of the solid; meshes;
refusals."""

import math

import FreeCAD as App
import Mesh
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.core.strategies import estimated_size

pytestmark = pytest.mark.any_version

UP = App.Vector(0, 0, 1)
HUB, HEIGHT = 30.0, 120.0
CONE = math.atan2(HUB, HEIGHT)
FAST = {"layer_height": 6, "chord_error": 0.1, "bead_spacing": 5}


def hub_shape(direction=1.0):
    """Return a cylinder of 50 mm with the lower part of a cone on it, along Z or against it."""
    low, cone = (
        Part.makeCylinder(HUB, 50.0),
        Part.makeCone(HUB, HUB * 0.5, 0.5 * HEIGHT, App.Vector(0, 0, 50)),
    )
    shape = low.fuse(cone).removeSplitter()
    shape.Placement = App.Placement(
        App.Vector(), App.Rotation(App.Vector(1, 0, 0), 0 if direction > 0 else 180)
    )
    return shape


def blade_shapes(hub, heights=(8.0, 60.0), around=3):
    """Return bars through the hub without their inside: their feet are on the cylinder and on the
    cone."""
    blades = []
    for z in heights:
        for k in range(around):
            bar = Part.makeBox(60.0, 14.0, 30.0, App.Vector(0, -7, z))
            bar.rotate(App.Vector(), UP, 360.0 * k / around)
            bar.Placement = hub.Placement.multiply(bar.Placement)
            blades += [max(bar.cut(hub).Solids, key=lambda solid: solid.Volume)]
    return blades


def add(doc, shape, label):
    obj = doc.addObject("Part::Feature", label)
    obj.Shape = shape
    return obj


@pytest.fixture
def thruster(doc):
    hub = hub_shape()
    return doc, add(doc, hub, "Hub"), add(doc, Part.Compound(blade_shapes(hub)), "Blades")


def faces_of(hub, kind):
    return [
        f"Face{k + 1}"
        for k, face in enumerate(hub.Shape.Faces)
        if face.Surface.TypeId == f"Part::Geom{kind}"
    ]


def layer_distance(points, layer, height=6.0):
    """Return the distance of points from the layer of the cylinder or of the cone, whichever is
    nearer."""
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    cone = (rho - HUB) * math.cos(CONE) + (z - 50.0) * math.sin(CONE)
    return np.minimum(np.abs(rho - HUB - height * layer), np.abs(cone - height * layer))


def test_the_hub_is_found_and_each_blade_lies_on_its_surface(thruster):
    doc, hub, blades = thruster
    feature = api.make_developable_feature(doc, blades, hub, **FAST)
    solids = api.result(feature)
    assert [len(group.bodies) for group in solids.groups] == [3, 3] and feature.Solids == 6
    assert [group.base.surface.is_cylinder for group in solids.groups] == [True, False]
    cone = solids.groups[1].base.surface
    assert (cone.radius, cone.height) == pytest.approx((HUB, HEIGHT), rel=1e-9)
    assert [body.name for body in solids.surroundings] == ["Hub"]
    toolpath = api.make_toolpath(doc, feature)
    path = api.result(toolpath)
    starts = [index for index, layer in enumerate(path.layers) if layer.first]
    assert len(starts) == 2
    for index, layer in enumerate(path.layers):
        level = index - starts[int(index >= starts[1])]
        assert all(layer_distance(bead.points, level).max() < 1e-6 for bead in layer.beads)


def test_tilts_that_take_long_are_told_before_they_are_searched_for(doc, monkeypatch):
    """Blades that grow together, one after the other: the nozzle touches the earlier one."""
    hub = hub_shape()
    blades = add(doc, Part.Compound(blade_shapes(hub, (8.0,), 12)), "Blades")
    feature = api.make_developable_feature(
        doc, blades, add(doc, hub, "Hub"), order="feature", margin=6, **FAST
    )
    monkeypatch.setattr(
        estimated_size, "SECONDS_A_TILT", estimated_size.LARGE_SECONDS
    )  # one point takes that long

    def report(issue):
        assert issue.code == estimated_size.LARGE_CODE
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), api.told_to(lambda *_: None, report):
        api.make_toolpath(doc, feature)


def test_contours_follow_the_exact_solid_not_its_mesh(doc):
    """The beads of a round boss on a cylinder are half a spacing inside of the boss's cylinder, on
    every layer."""
    hub = Part.makeCylinder(40.0, 100.0)
    boss = Part.makeCylinder(18.0, 70.0, App.Vector(0, 0, 50), App.Vector(1, 0, 0)).cut(hub)
    feature = api.make_developable_feature(
        doc,
        add(doc, boss, "Boss"),
        add(doc, hub, "Hub"),
        layer_height=5,
        bead_spacing=4,
        chord_error=0.02,
    )
    path = api.result(api.make_toolpath(doc, feature))
    for index, layer in enumerate(path.layers[:6]):  # the next one runs along the boss's end
        outer = max((bead for bead in layer.beads if bead.closed), key=lambda bead: bead.length)
        x, y, z = outer.points.T
        # the geodesic distance to the boss's rim has no simple formula; across the hub's axis it is
        # a height
        top = outer.points[np.argmax(z)]
        assert top[2] == pytest.approx(50.0 + 18.0 - 2.0, abs=0.03)
        assert np.hypot(x, y) == pytest.approx(np.full(len(x), 40.0 + 5.0 * index), abs=1e-9)
        side = outer.points[np.argmax(y)]
        radius = 40.0 + 5.0 * index
        rim = math.asin(18.0 / radius)
        assert radius * math.atan2(side[1], side[0]) == pytest.approx(radius * rim - 2.0, abs=0.03)


def test_faces_chosen_or_base_given_are_taken(thruster):
    doc, hub, _ = thruster
    upper = add(doc, Part.Compound(blade_shapes(hub.Shape, (60.0,))), "Upper")
    by_faces = api.make_developable_feature(doc, upper, hub, faces_of(hub, "Cone"), **FAST)
    by_base = api.make_developable_feature(
        doc, upper, base_radius=HUB, base_height=HEIGHT, base_axis="0 0 50 0 0 1", **FAST
    )
    for feature in (by_faces, by_base):
        (group,) = api.result(feature).groups
        assert (group.base.surface.radius, group.base.surface.height) == pytest.approx(
            (HUB, HEIGHT)
        )
    from_faces, from_base = (
        api.result(api.make_toolpath(doc, feature)) for feature in (by_faces, by_base)
    )
    assert from_faces.bead_count == from_base.bead_count and from_faces.length == pytest.approx(
        from_base.length, rel=1e-6
    )


def test_a_cone_that_points_down_is_as_good(doc):
    hub = hub_shape(-1.0)
    feature = api.make_developable_feature(
        doc,
        add(doc, Part.Compound(blade_shapes(hub, (60.0,))), "Blades"),
        add(doc, hub, "Hub"),
        **FAST,
    )
    (group,) = api.result(feature).groups
    np.testing.assert_allclose(group.base.frame[:3, 2], [0, 0, -1], atol=1e-12)
    path = api.result(api.make_toolpath(doc, feature))
    for index, _, bead in path:
        assert layer_distance(bead.points * [1.0, 1.0, -1.0], index).max() < 1e-6


@pytest.mark.long
def test_the_hub_may_be_one_of_the_solids_or_fused_with_them(thruster):
    doc, hub, blades = thruster
    upper = blade_shapes(hub.Shape, (60.0,))
    separate = api.make_developable_feature(
        doc, blades, hub, faces_of(hub, "Cone") + faces_of(hub, "Cylinder"), **FAST
    )
    among = api.make_developable_feature(
        doc, add(doc, Part.Compound([hub.Shape, *blades.Shape.Solids]), "All"), **FAST
    )
    paths = [api.result(api.make_toolpath(doc, feature)) for feature in (separate, among)]
    assert paths[0].length == pytest.approx(paths[1].length, rel=1e-6)
    fused = add(doc, hub.Shape.multiFuse(upper), "Fused")
    cones = faces_of(fused, "Cone")
    fused_feature = api.make_developable_feature(doc, fused, faces=cones, **FAST)
    path = api.result(api.make_toolpath(doc, fused_feature))
    for index, _, bead in path:
        assert layer_distance(bead.points, index).max() < 1e-6
    only = api.result(
        api.make_toolpath(
            doc,
            api.make_developable_feature(doc, add(doc, Part.Compound(upper), "Upper"), hub, **FAST),
        )
    )
    assert path.layers[2].beads[0].length == pytest.approx(only.layers[2].beads[0].length, rel=1e-3)


def test_meshes_are_solids_too_and_repairs_are_told(thruster):
    doc, hub, blades = thruster
    mesh = doc.addObject("Mesh::Feature", "Scan")
    mesh.Mesh = Mesh.Mesh(
        [tuple(map(tuple, triangle)) for solid in blades.Shape.Solids for triangle in loose(solid)]
    )
    exact = api.make_developable_feature(doc, blades, hub, **FAST)
    scanned = api.make_developable_feature(doc, mesh, hub, **FAST)
    assert scanned.Solids == 6
    from_solid, from_mesh = (
        api.result(api.make_toolpath(doc, feature)) for feature in (exact, scanned)
    )
    assert from_solid.length == pytest.approx(from_mesh.length, rel=1e-3)
    flipped = [
        triangle[::-1] if k % 5 == 0 else triangle
        for k, triangle in enumerate(loose(blades.Shape.Solids[0]))
    ]
    mesh.Mesh = Mesh.Mesh([tuple(map(tuple, triangle)) for triangle in flipped])
    api.change(scanned, layer_height=7)
    assert [issue.code for issue in api.issues(scanned)] == ["MESH_REPAIRED"]
    mesh.Mesh = Mesh.Mesh(
        [tuple(map(tuple, triangle)) for triangle in loose(blades.Shape.Solids[0])[4:]]
    )
    with pytest.raises(InputError) as caught:
        api.change(scanned, layer_height=6)
    assert caught.value.code == "OPEN_MESH" and "Scan" in caught.value.where


def loose(solid):
    points, facets = solid.tessellate(0.02)
    return [[points[k] for k in facet] for facet in facets]


def test_what_cannot_be_is_refused_where_it_stands(thruster):
    doc, hub, blades = thruster
    distant = add(doc, Part.makeBox(10, 10, 10, App.Vector(80, 0, 10)), "Away")
    bore = add(doc, Part.makeCylinder(60.0, 50.0).cut(Part.makeCylinder(HUB, 50.0)), "Bore")
    sheet = add(doc, blades.Shape.Faces[0], "Sheet")
    inner = [
        f"Face{k + 1}"
        for k, face in enumerate(bore.Shape.Faces)
        if face.Surface.TypeId == "Part::GeomCylinder" and face.Surface.Radius == HUB
    ]
    flat = faces_of(hub, "Plane")
    for arguments, code, where in (
        ((distant, hub), "NOT_ON_HUB", "Away"),
        ((blades, bore, inner), "INNER_FACE", f"Bore {inner[0]}"),
        ((blades, hub, flat[:1]), "NOT_DEVELOPABLE", f"Hub {flat[0]}"),
        ((blades, hub, ["Face99"]), "BAD_FACES", ""),
        ((sheet, hub), "NO_SOLID", "Sheet"),
        ((distant,), "NO_HUB", ""),
        ((blades, distant), "NO_BASE", "Away"),
    ):
        with pytest.raises(InputError) as caught:
            api.make_developable_feature(doc, *arguments, **FAST)
        assert caught.value.code == code and where in caught.value.where, caught.value.line()
    for values in (
        {"base_radius": 0},
        {"base_radius": -5},
        {"base_height": 100},
        {"base_axis": "0 0 0 0 0 0"},
        {"base_axis": "here"},
        {"base_radius": "wide"},
        {"bead_spacing": 0},
        {"layer_height": 0},
    ):
        with pytest.raises(InputError) as caught:
            api.make_developable_feature(doc, blades, hub, **{**FAST, **values})
        assert caught.value.code in ("BAD_VALUE", "BAD_UNIT")


def test_solids_from_exact_shapes_are_told_what_to_do_with_shapes(thruster):
    doc, hub, blades = thruster
    distant = blades.Shape.copy().transformGeometry(
        App.Matrix(*(np.diag([1.0, 1.0, 1.0, 25.4]) / 25.4).ravel())
    )
    small = add(doc, distant, "Small")
    boxes = [Part.makeBox(10, 10, 30, App.Vector(*corner)) for corner in ((40, 0, 5), (50, 10, 5))]
    touching = add(
        doc, Part.makeSolid(Part.makeShell([*boxes[0].Faces, *boxes[1].Faces])), "Touching"
    )
    bracket = add(
        doc, Part.makeBox(50, 5, 40).fuse(Part.makeBox(5, 50, 40)).removeSplitter(), "Bracket"
    )
    for arguments, code, expected, untold in (
        ((small, hub), "NOT_ON_HUB", "not on the hub", "unit"),
        (
            (touching, hub),
            "NOT_ON_HUB",
            "the solid passes Hub",
            "mesh",
        ),  # the contact along its own edge is repaired
        ((bracket,), "NO_HUB", "for a flat base use kind: solid", "mesh"),
    ):
        with pytest.raises(InputError) as caught:
            api.make_developable_feature(doc, *arguments, **FAST)
        assert caught.value.code == code, caught.value.line()
        assert expected in caught.value.message and untold not in caught.value.message


def test_a_bead_width_that_a_macro_gives_is_meant(thruster):
    doc, hub, blades = thruster
    feature = api.make_developable_feature(doc, blades, hub, **FAST)
    plain, explicit = api.make_toolpath(doc, feature), api.make_toolpath(doc, feature, bead_width=8)
    assert (plain.FillWidth, explicit.FillWidth) == (
        "auto",
        "bead_width",
    ) and plain.BeadWidth == explicit.BeadWidth
    assert api.result(plain).length != api.result(explicit).length
    plain.FillWidth = "bead_width"
    assert api.recompute(doc) is None and api.result(plain).length == api.result(explicit).length


def test_a_document_keeps_the_solids_and_knows_when_they_change(thruster, tmp_path):
    doc, hub, blades = thruster
    feature = api.make_developable_feature(doc, blades, hub, **FAST)
    toolpath = api.make_toolpath(
        doc, feature, bead_model="csw", bead_width=9.5, wire_feed="6.5 m/min"
    )
    length = api.result(toolpath).length
    doc.saveAs(str(tmp_path / "thruster.FCStd"))
    App.closeDocument(doc.Name)
    again = App.openDocument(str(tmp_path / "thruster.FCStd"))
    try:
        stage = again.getObject(toolpath_name(again))
        assert api.result(stage).length == length and stage.Status == "up to date"
        api.change(again.Feature, bead_spacing=2.5)
        assert api.result(stage).length > length
        assert stage.Status == "up to date"
        again.Hub.Placement.Base = App.Vector(0, 0, 40)
        assert again.Feature.Status == "stale"
    finally:
        App.closeDocument(again.Name)


def toolpath_name(document):
    return next(obj.Name for obj in document.Objects if obj.Name.startswith("Toolpath"))


def test_what_beads_lay_beside_solids_on_a_hub_is_told(doc):
    """A fin of 3 mm under beads of 6 mm with round ends is reported layer by layer; a block that is
    wide enough gives no message."""
    rod = doc.addObject("Part::Feature", "Rod")
    rod.Shape = Part.makeCylinder(20.0, 100.0)
    toolpaths = {}
    for thick in (3.0, 24.0):  # the block ends on a cylinder, and is ten layers high
        fin = doc.addObject("Part::Feature", "Fin")
        block = Part.makeBox(
            24.0 if thick == 3.0 else 30.0, thick, 40.0, App.Vector(15.0, -0.5 * thick, 30.0)
        )
        fin.Shape = block.common(Part.makeCylinder(40.0, 100.0)).cut(rod.Shape)
        spacing = 6.0 if thick == 3.0 else 4.0
        feature = api.make_developable_feature(
            doc, fin, rod, layer_height=2.0, bead_spacing=spacing, chord_error=0.1
        )
        toolpaths[thick] = api.result(api.make_toolpath(doc, feature))
    narrow, wide = toolpaths[3.0], toolpaths[24.0]
    part_volume, missed, beside = narrow.checks.volumes
    outside = Part.makeBox(24.0, 3.0, 40.0, App.Vector(15.0, -1.5, 30.0)).cut(rod.Shape).Volume
    assert part_volume == pytest.approx(outside, rel=1e-3) and missed == pytest.approx(0.0, abs=1.0)
    laid = 2.0 * sum(6.0 * bead.length + 9.0 * np.pi for _, _, bead in narrow)
    assert beside == pytest.approx(laid - part_volume, rel=0.02)
    (issue,) = [candidate for candidate in narrow.issues if candidate.code == "DEPOSITED_BESIDE"]
    assert issue.level == "warning" and f"{beside / 1000.0:.3g} cm3" in issue.message
    assert not {"DEPOSITED_BESIDE", "NOT_DEPOSITED"} & {candidate.code for candidate in wide.issues}
    part_volume, missed, beside = wide.checks.volumes
    laid = 2.0 * 4.0 * sum(bead.length for _, _, bead in wide)
    assert wide.checks.twice == pytest.approx(laid - (part_volume - missed + beside), rel=1e-6)
    assert ("DEPOSITED_TWICE" in {candidate.code for candidate in wide.issues}) == (
        wide.checks.twice > 0.03 * part_volume
    )
    assert (
        part_volume == pytest.approx(sum(24.0 * 40.0 * 2.0 for _ in wide.layers), rel=0.1)
        and missed + beside < 0.03 * part_volume
    )
