# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall on a substrate in a document: created, renewed when either shape changes, and rejected
where necessary."""

import FreeCAD as App
import Mesh
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.issues import InputError
from freecad_am.core.strategies import estimated_size
from freecad_am.core.strategies.walls import fronts


@pytest.fixture
def tube(doc):
    """Return a branch on a pipe; the branch's side is Face1."""
    pipe = doc.addObject("Part::Cylinder", "Pipe")
    pipe.Radius, pipe.Height = 32, 120
    pipe.Placement = App.Placement(App.Vector(0, -60, 0), App.Rotation(App.Vector(1, 0, 0), -90))
    branch = doc.addObject("Part::Cylinder", "Branch")
    branch.Radius, branch.Height = 12, 60
    doc.recompute()
    return branch, pipe


def make_wall(doc, tube, **values):
    branch, pipe = tube
    return api.make_surface_feature(
        doc, branch, ["Face1"], pipe, **{"layer_height": 5, "clearance": "none", **values}
    )


@pytest.mark.any_version
def test_feature_and_toolpath(doc, tube):
    feature = make_wall(doc, tube)
    wall = api.result(feature)
    assert feature.WallKind == "cone" and list(feature.WallFaces) == ["Face1"]
    assert np.hypot(wall.first[:, 0], wall.first[:, 2]) == pytest.approx(32.0, abs=1e-9)
    assert [issue.message for issue in wall.issues] == [
        "the first layer follows the intersection of the wall and Pipe within 0.001 mm"
    ]
    toolpath = api.make_toolpath(doc, feature)
    value = api.result(toolpath)
    assert value.family == "surface" and toolpath.Layers == len(value.layers)
    assert max(bead.points[:, 2].max() for _, _, bead in value) == pytest.approx(60.0, abs=1e-6)


@pytest.mark.any_version
def test_a_tube_is_planned_by_fronts_where_that_is_chosen(doc, tube):
    """A cylinder on a pipe of another size: the test compares the points of a layer of fronts with
    the axes of both."""
    feature = make_wall(doc, tube, method="fronts", layer_height=6)
    toolpath = api.make_toolpath(doc, feature)
    assert feature.WallKind == "patches" and feature.Method == "fronts"
    layers = api.result(toolpath).layers
    rings = [bead.points for layer in layers for bead in layer.beads if bead.closed]
    points = np.vstack(rings)
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - 12.0).max() < 1e-6
    assert np.abs(np.hypot(rings[0][:, 0], rings[0][:, 2]) - 32.0).max() < 2e-5
    for below, above in zip(rings, rings[1:]):
        start, segments = below[:-1], np.diff(below, axis=0)
        share = np.clip(
            ((above[:, None] - start) * segments).sum(axis=2) / (segments * segments).sum(axis=1),
            0.0,
            1.0,
        )
        distances = np.linalg.norm(
            above[:, None] - start - share[..., None] * segments, axis=2
        ).min(axis=1)
        assert np.abs(distances - 6.0).max() < 0.011  # chords of both are up to 0.01 mm off
    api.change(feature, method="auto")
    assert feature.WallKind == "cone"
    with pytest.raises(InputError, match=r"remove strategy\.method"):
        make_wall(doc, tube, method="fronts", spacing="iso-parameter")


@pytest.mark.any_version
def test_renewed_when_the_substrate_changes(doc, tube):
    feature = make_wall(doc, tube)
    toolpath = api.make_toolpath(doc, feature)
    tube[1].Radius = 25
    assert feature.Status == toolpath.Status == "stale"
    api.recompute(doc)
    first_curves = api.result(feature).first
    assert np.hypot(first_curves[:, 0], first_curves[:, 2]) == pytest.approx(25.0, abs=1e-9)
    start = api.result(toolpath).layers[0].beads[0].points
    assert np.hypot(start[:, 0], start[:, 2]) == pytest.approx(25.0, abs=1e-4)


@pytest.mark.any_version
def test_a_wall_that_reaches_below_the_platform_is_refused_with_its_depth(doc, tube):
    """The wall begins on the pipe 16 mm above its middle or, next to it, where the pipe is 29.66 mm
    high."""
    for obj in tube:
        obj.Placement.Base = obj.Placement.Base - App.Vector(0, 0, 40)
    feature = make_wall(doc, tube)
    with pytest.raises(InputError, match=r"extends 10\.34 mm below the platform") as error_info:
        api.make_toolpath(doc, feature, api.make_cell(doc))
    assert error_info.value.code == "OFF_PLATFORM"
    assert api.make_toolpath(doc, feature, api.make_cell(doc, platform_diameter=0))


def test_a_wall_that_begins_below_the_platform_is_refused_before_its_layers_are_looked_for(
    doc, tube, monkeypatch
):
    """Layers of walls with several faces, and of meshes, may take minutes."""
    for obj in tube:
        obj.Placement.Base = obj.Placement.Base - App.Vector(0, 0, 40)
    feature = make_wall(doc, tube, method="fronts")
    monkeypatch.setattr(
        fronts, "plan", lambda *args, **options: pytest.fail("its layers are looked for")
    )
    with pytest.raises(InputError, match=r"extends 10\.34 mm below the platform"):
        api.make_toolpath(doc, feature, api.make_cell(doc, mount="part"))


def test_saved_and_read_back(doc, tube, tmp_path):
    spline = doc.addObject("Part::Feature", "Spline")
    spline.Shape = tube[0].Shape.Faces[0].toNurbs()
    feature = api.make_surface_feature(doc, spline, (), tube[1], clearance="none")
    original = api.result(feature)
    doc.saveAs(str(tmp_path / "wall.FCStd"))
    again = App.openDocument(str(tmp_path / "wall.FCStd"))
    try:
        reopened = api.result(again.getObject(feature.Name))
        assert reopened.kind == original.kind == "table"
        assert (reopened.table == original.table).all() and (reopened.first == original.first).all()
    finally:
        App.closeDocument(again.Name)


def post(doc, as_mesh):
    """Return a post next to the branch, 18 mm from its axis, moved by its own placement and that of
    a group."""
    shape = Part.makeBox(6, 6, 100, App.Vector(-3, -3, -50))
    if as_mesh:
        post_object = doc.addObject("Mesh::Feature", "Post")
        post_object.Mesh = Mesh.Mesh(shape.tessellate(0.1))
    else:
        post_object = doc.addObject("Part::Feature", "Post")
        post_object.Shape = shape
    post_object.Placement = App.Placement(App.Vector(18, 0, 0), App.Rotation())
    group = doc.addObject("App::Part", "Group")
    group.addObject(post_object)
    group.Placement = App.Placement(App.Vector(0, 0, 80), App.Rotation())
    return post_object


@pytest.mark.any_version
@pytest.mark.parametrize(
    "as_mesh", [False, pytest.param(True, marks=pytest.mark.long)], ids=["solid", "mesh"]
)
def test_fixtures_count_and_renew_the_toolpath(doc, tube, as_mesh):
    fixture = post(doc, as_mesh)
    feature = make_wall(doc, tube, clearance="nozzle", chord_error=0.1, fixtures=[fixture])
    substrate, clamp = api.result(feature).surroundings
    assert (substrate.name, clamp.name) == ("Pipe", "Post")
    assert clamp.vertices.min(axis=0) == pytest.approx([15, -3, 30]) and clamp.vertices[
        :, 2
    ].max() == pytest.approx(130)
    toolpath = api.make_toolpath(doc, feature)
    assert [issue.code for issue in api.issues(toolpath)].count("TILT_BACK") == 1
    assert api.result(toolpath).surroundings == api.result(feature).surroundings
    fixture.Placement = App.Placement(App.Vector(200, 0, 0), App.Rotation())
    assert feature.Status == toolpath.Status == "stale"
    api.recompute(doc)
    assert not [issue for issue in api.issues(toolpath) if issue.code == "TILT_BACK"]
    api.change(feature, fixtures=[])
    assert len(api.result(feature).surroundings) == 1


@pytest.mark.any_version
def test_tilts_that_take_long_are_told_before_they_are_searched_for(doc, tube, monkeypatch):
    feature = make_wall(doc, tube, clearance="nozzle", chord_error=0.1, fixtures=[post(doc, False)])
    monkeypatch.setattr(
        estimated_size, "SECONDS_A_TILT", estimated_size.LARGE_SECONDS
    )  # one point takes that long

    def report(issue):
        assert issue.code == estimated_size.LARGE_CODE
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), api.told_to(lambda *_: None, report):
        api.make_toolpath(doc, feature)


@pytest.mark.any_version
def test_fixtures_of_a_part_of_revolution_are_looked_at(doc, tube):
    fixture = post(doc, False)
    feature = api.make_feature(doc, tube[0], ["Face1"], layer_height=5, fixtures=[fixture])
    issues = [
        issue for issue in api.issues(api.make_toolpath(doc, feature)) if issue.level == "error"
    ]
    assert (
        [issue.code for issue in issues] == ["CLEARANCE"]
        and "Post" in issues[0].message
        and issues[0].layer is not None
    )
    api.change(feature, fixtures=[])
    assert not [issue for issue in api.issues(doc.Toolpath) if issue.level == "error"]


@pytest.mark.any_version
def test_needs_a_solid_substrate(doc, tube):
    tube[0].Placement = App.Placement(
        App.Vector(), App.Rotation(App.Vector(1, 0, 0), 20)
    )  # no edge is below it
    with pytest.raises(InputError) as caught:
        api.make_surface_feature(doc, tube[0], ["Face1"])
    assert caught.value.code == "NO_SUBSTRATE" and "start edges" in caught.value.message
    plane = doc.addObject("Part::Plane", "Plane")
    doc.recompute()
    with pytest.raises(InputError) as caught:
        api.make_surface_feature(doc, tube[0], ["Face1"], plane)
    assert caught.value.code == "NO_SOLID" and caught.value.where == "Plane"


def test_a_wall_that_is_its_own_substrate_is_refused_where_that_is_said(doc, tube):
    """Such a wall was once reported as inside its substrate, 0 mm deep everywhere; as a mesh it was
    an internal error."""
    branch, _ = tube
    with pytest.raises(InputError, match="are the same object, Branch") as caught:
        api.make_surface_feature(doc, branch, ["Face1"], branch, layer_height=5)
    assert caught.value.code == "OWN_SUBSTRATE" and caught.value.where.endswith(".Substrate")
    other_object = doc.addObject("Part::Feature", "Other")
    other_object.Shape = branch.Shape
    scan = doc.addObject("Mesh::Feature", "Scan")
    scan.Mesh = Mesh.Mesh(branch.Shape.tessellate(0.05))
    further = doc.addObject("Mesh::Feature", "Further")
    further.Mesh = scan.Mesh
    for wall, faces, ground in ((branch, ["Face1"], other_object), (scan, [], further)):
        with pytest.raises(
            InputError, match=f"coincides with the surface of {ground.Label}"
        ) as caught:
            api.make_surface_feature(doc, wall, faces, ground, layer_height=5)
        assert caught.value.code == "OWN_SUBSTRATE"
