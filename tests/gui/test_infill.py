# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool Infill shows void and overlap shares of any layer, its section in red and blue in the 3D
view, and the worst layers."""

import re

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui.path import infill_dock as docks

RED, BLUE, GREY = (
    [int(docks.COLOURS[name][k : k + 2], 16) for k in (1, 3, 5)]
    for name in (docks.VOID, docks.OVER, docks.SINGLE)
)
TIMEOUT_S = 60  # s


@pytest.fixture
def plate(person):
    """Return a toolpath of a plate with a bore and a narrower top, with the usual bead width."""
    document = App.newDocument("Plate")
    low = document.addObject("Part::Box", "Low")
    low.Length, low.Width, low.Height = 70, 43, 8
    high = document.addObject("Part::Box", "High")
    high.Length, high.Width, high.Height = 70, 27, 8
    high.Placement.Base = App.Vector(0, 8, 8)
    fused = document.addObject("Part::Fuse", "Both")
    fused.Base, fused.Tool = low, high
    bore = document.addObject("Part::Cylinder", "Bore")
    bore.Radius, bore.Height = 8, 16
    bore.Placement.Base = App.Vector(30, 20, 0)
    cut_plate = document.addObject("Part::Cut", "Plate")
    cut_plate.Base, cut_plate.Tool = fused, bore
    document.recompute()
    feature = api.make_solid_feature(
        document, cut_plate, layer_height=4, bead_spacing=5, widths="fixed"
    )
    toolpath = api.make_toolpath(document, feature)
    feature.ViewObject.Visibility = cut_plate.ViewObject.Visibility = False
    person.idle()
    return toolpath


def opened(person, toolpath):
    person.select(toolpath)
    person.click("RoboticAM_Infill")
    panel = person.panel(docks.NAME)
    return panel, docks.only.dock


def wait_until_drawn(person, tool, number):
    """Wait until a layer is drawn."""
    person.until(
        lambda: tool.drawn[3:4] == (number,) and tool.drawing.worker is None,
        "the section",
        TIMEOUT_S,
    )
    person.idle()


def share(person, panel, name):
    """Return a share in the panel, in %."""
    text = person.field(panel, name).text()
    return float(re.search(r": ([\d.]+) % of the section", text).group(1))


def count(tool, name):
    """Return the area drawn in a colour, in mm2."""
    faces = tool.nodes.faces[name]
    points = np.array(faces.coordinates.point.getValues()).reshape(-1, 3)
    corners = np.array(faces.triangles.coordIndex.getValues(), dtype=int).reshape(-1, 4)[:, :3]
    a, b, c = (points[corners[:, k]] for k in range(3))
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def test_the_slider_shows_shares_and_section_of_each_layer(person, hand, plate):
    layers = api.result(plate).layers
    panel, tool = opened(person, plate)
    slider = person.field(panel, "layer_slider")
    assert (slider.minimum(), slider.maximum()) == (0, len(layers) - 1) == (0, 3)
    person.look()
    areas = {}
    for number in (0, 3):
        slider.setValue(number)
        wait_until_drawn(person, tool, number)
        coverage = layers[number].coverage
        for name in ("void", "over", "outside"):
            assert share(person, panel, name) == pytest.approx(
                100.0 * getattr(coverage, name), abs=0.006
            )
        areas[number] = {name: count(tool, name) for name in tool.nodes.faces}
        reached = 70 * (43 if number == 0 else 27) - np.pi * 64
        assert areas[number]["void"] == pytest.approx(coverage.void * reached, rel=0.02)
        assert sum(areas[number].values()) == pytest.approx(reached, rel=0.02)
        top = np.array(tool.nodes.faces["single"].coordinates.point.getValues())[:, 2]
        assert np.ptp(top) < 1e-4 and top[0] == pytest.approx(4 * number + 4, abs=0.2)
        assert plate.ViewObject.Proxy.shown == (0, number, None)
    person.screenshot("infill_dock")
    assert person.screen_pixels(GREY) > 1000
    assert person.screen_pixels(RED) > 20 and person.screen_pixels(BLUE) > 20
    text = person.field(panel, "void").text()
    assert re.search(r"the largest place [\d.]+ mm wide at \(", text)


def test_the_worst_layer_and_no_drawing(person, hand, plate):
    layers = api.result(plate).layers
    panel, tool = opened(person, plate)
    wait_until_drawn(person, tool, person.field(panel, "layer_slider").value())
    worst = max(range(4), key=lambda number: layers[number].coverage.void)
    hand.click(person.field(panel, "worst_void"))
    wait_until_drawn(person, tool, worst)
    assert layers[person.field(panel, "layer_spin").value()].coverage.void == pytest.approx(
        layers[worst].coverage.void
    )
    hand.click(person.field(panel, "voids"))
    wait_until_drawn(person, tool, worst)
    assert sum(count(tool, name) for name in tool.nodes.faces) == 0.0
    assert share(person, panel, "void") > 0.0
    hand.click(person.field(panel, "voids"))
    wait_until_drawn(person, tool, worst)
    assert count(tool, "single") > 1000.0
    panel.close()
    person.idle()
    assert plate.ViewObject.Proxy.shown is None
    assert plate.ViewObject.RootNode.findChild(tool.nodes.node) < 0


def test_a_share_over_the_limit_is_marked_and_warned_of(person, plate):
    api.change(plate.Feature, max_void=0.01)
    plate.Document.recompute()
    codes = {issue.code for issue in api.result(plate).issues}
    assert "VOIDS" in codes
    panel, tool = opened(person, plate)
    wait_until_drawn(person, tool, person.field(panel, "layer_slider").value())
    assert "color" in person.field(panel, "void").styleSheet()


def test_other_toolpaths_and_none(person, hemisphere):
    document = hemisphere.Document
    wall = api.make_toolpath(document, api.make_feature(document, hemisphere, layer_height=5))
    panel, _ = opened(person, wall)
    assert "no measured layers" in person.field(panel, "note").text()
    assert not person.field(panel, "layer_slider").isEnabled()
    document.removeObject(wall.Name)
    person.idle(0.3)
    assert "There is no toolpath yet" in person.field(panel, "note").text()
    App.closeDocument(document.Name)
    person.idle(0.3)
    panel.close()
