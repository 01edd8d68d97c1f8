# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tool Infill: shares of any layer, its section in red and blue in the 3D view, the worst layers."""

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
LONG = 60  # s


@pytest.fixture
def plate(person):
    """A toolpath of a plate with a bore, whose top is narrower; beads as wide as usual."""
    document = App.newDocument("Plate")
    low = document.addObject("Part::Box", "Low")
    low.Length, low.Width, low.Height = 70, 43, 8
    high = document.addObject("Part::Box", "High")
    high.Length, high.Width, high.Height = 70, 27, 8
    high.Placement.Base = App.Vector(0, 8, 8)
    both = document.addObject("Part::Fuse", "Both")
    both.Base, both.Tool = low, high
    bore = document.addObject("Part::Cylinder", "Bore")
    bore.Radius, bore.Height = 8, 16
    bore.Placement.Base = App.Vector(30, 20, 0)
    part = document.addObject("Part::Cut", "Plate")
    part.Base, part.Tool = both, bore
    document.recompute()
    feature = api.make_solid_feature(document, part, layer_height=4, bead_spacing=5, widths="fixed")
    toolpath = api.make_toolpath(document, feature)
    feature.ViewObject.Visibility = part.ViewObject.Visibility = False
    person.idle()
    return toolpath


def opened(person, toolpath):
    person.select(toolpath)
    person.click("RoboticAM_Infill")
    panel = person.panel(docks.NAME)
    return panel, docks.only.dock


def drawn(person, one, number):
    """Wait until a layer is drawn."""
    person.until(
        lambda: one.drawn[3:4] == (number,) and one.drawing.worker is None, "the section", LONG
    )
    person.idle()


def share(person, panel, name):
    """A share of the panel, %."""
    text = person.field(panel, name).text()
    return float(re.search(r": ([\d.]+) % of the section", text).group(1))


def count(one, name):
    """Area of what is drawn in a colour, mm2."""
    faces = one.nodes.faces[name]
    points = np.array(faces.coordinates.point.getValues()).reshape(-1, 3)
    corners = np.array(faces.triangles.coordIndex.getValues(), dtype=int).reshape(-1, 4)[:, :3]
    a, b, c = (points[corners[:, k]] for k in range(3))
    return 0.5 * float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


def test_the_slider_shows_shares_and_section_of_each_layer(person, hand, plate):
    layers = api.result(plate).layers
    panel, one = opened(person, plate)
    slider = person.field(panel, "layer_slider")
    assert (slider.minimum(), slider.maximum()) == (0, len(layers) - 1) == (0, 3)
    person.look()
    areas = {}
    for number in (0, 3):
        slider.setValue(number)
        drawn(person, one, number)
        coverage = layers[number].coverage
        for name in ("void", "over", "outside"):
            assert share(person, panel, name) == pytest.approx(
                100.0 * getattr(coverage, name), abs=0.006
            )
        areas[number] = {name: count(one, name) for name in one.nodes.faces}
        reached = 70 * (43 if number == 0 else 27) - np.pi * 64
        assert areas[number]["void"] == pytest.approx(coverage.void * reached, rel=0.02)
        assert sum(areas[number].values()) == pytest.approx(reached, rel=0.02)
        top = np.array(one.nodes.faces["single"].coordinates.point.getValues())[:, 2]
        assert np.ptp(top) < 1e-4 and top[0] == pytest.approx(4 * number + 4, abs=0.2)
        assert plate.ViewObject.Proxy.shown == (0, number, None)
    person.screenshot("infill_dock")
    assert person.screen_pixels(GREY) > 1000
    assert person.screen_pixels(RED) > 20 and person.screen_pixels(BLUE) > 20
    text = person.field(panel, "void").text()
    assert re.search(r"the largest place [\d.]+ mm wide at \(", text)


def test_the_worst_layer_and_no_drawing(person, hand, plate):
    layers = api.result(plate).layers
    panel, one = opened(person, plate)
    drawn(person, one, person.field(panel, "layer_slider").value())
    worst = max(range(4), key=lambda number: layers[number].coverage.void)
    hand.click(person.field(panel, "worst_void"))
    drawn(person, one, worst)
    assert layers[person.field(panel, "layer_spin").value()].coverage.void == pytest.approx(
        layers[worst].coverage.void
    )
    hand.click(person.field(panel, "voids"))
    drawn(person, one, worst)
    assert sum(count(one, name) for name in one.nodes.faces) == 0.0
    assert share(person, panel, "void") > 0.0
    hand.click(person.field(panel, "voids"))
    drawn(person, one, worst)
    assert count(one, "single") > 1000.0
    panel.close()
    person.idle()
    assert plate.ViewObject.Proxy.shown is None
    assert plate.ViewObject.RootNode.findChild(one.nodes.node) < 0


def test_a_share_over_the_limit_is_marked_and_warned_of(person, plate):
    api.change(plate.Feature, max_void=0.01)
    plate.Document.recompute()
    codes = {issue.code for issue in api.result(plate).issues}
    assert "VOIDS" in codes
    panel, one = opened(person, plate)
    drawn(person, one, person.field(panel, "layer_slider").value())
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
