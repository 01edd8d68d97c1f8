# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall on a substrate in the window: it is visible, its panel opens, and the user can choose the
substrate."""

from types import SimpleNamespace

import FreeCAD as App
import numpy as np

from freecad_am import api
from freecad_am.core.geometry.walls.patch_wall import FirstCurve
from freecad_am.gui import registry
from freecad_am.gui.nodes.wall import WallNodes, first_curves


def make_branch(hemisphere):
    """Return a document with a branch on a pipe, and its feature."""
    document = hemisphere.Document
    pipe = document.addObject("Part::Cylinder", "Pipe")
    pipe.Radius, pipe.Height = 32, 120
    pipe.Placement = App.Placement(App.Vector(0, -60, 0), App.Rotation(App.Vector(1, 0, 0), -90))
    branch = document.addObject("Part::Cylinder", "Branch")
    branch.Radius, branch.Height = 12, 60
    document.recompute()
    feature = api.make_surface_feature(
        document, branch, ["Face1"], pipe, layer_height=5, clearance="none"
    )
    return document, feature


def test_a_wall_on_a_substrate_is_shown_and_its_panel_opens(person, hemisphere):
    document, feature = make_branch(hemisphere)
    toolpath = api.make_toolpath(document, feature)
    assert feature.Status == toolpath.Status == "up to date"
    view = feature.ViewObject.Proxy.wall
    assert (
        view.first.coordinates.point.getNum() > 100
        and view.faces.triangles.coordIndex.getNum() > 20
    )
    original_key = feature.Key
    registry.edit(feature)
    panel = person.panel("RoboticAM_SurfaceFeature")
    assert person.field(panel, "Substrate").text() == "Pipe"
    person.press("Ok")
    person.panel_closed()
    assert feature.Key == original_key


def test_another_substrate_is_chosen_in_the_panel(person, hemisphere):
    document, feature = make_branch(hemisphere)
    block = document.addObject("Part::Box", "Block")
    block.Length = block.Width = 100
    block.Height = 20
    block.Placement.Base = App.Vector(-50, -50, 0)
    document.recompute()
    registry.edit(feature)
    panel = person.panel("RoboticAM_SurfaceFeature")
    person.field(panel, "PickSubstrate").click()
    person.gui.Selection.clearSelection()
    person.gui.Selection.addSelection(block)
    person.idle()
    assert person.field(panel, "Substrate").text() == "Block"
    person.press("Ok")
    person.panel_closed()
    assert feature.Substrate == block and feature.Status == "up to date"
    assert abs(api.result(feature).first[:, 2] - 20.0).max() < 1e-9


def test_the_first_layers_of_any_wall_are_drawn(person):
    """Closed first layers join up, open ones do not, and each is a separate line."""
    turn = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(12)], axis=1)
    curves = (
        FirstCurve(ring, ring, ring, True),
        FirstCurve(ring[:5] + 3.0, ring[:5], ring[:5], False),
    )
    drawn = first_curves(SimpleNamespace(first=curves))
    assert [len(curve) for curve in drawn] == [13, 5]
    assert np.array_equal(drawn[0][-1], ring[0]) and np.array_equal(drawn[1], ring[:5] + 3.0)
    nodes = WallNodes(pickable=True)
    nodes.set_first(drawn)
    for lines in (nodes.first, nodes.hidden):
        assert (
            list(lines.lines.numVertices.getValues()) == [13, 5]
            and lines.coordinates.point.getNum() == 18
        )
