# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colours of a toolpath match its legend, which is visible exactly when its toolpath is."""

import dataclasses

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.process.deposit.spacing import local_distances
from freecad_am.gui.colours import ramp
from freecad_am.gui.path import colouring, legend


@pytest.fixture
def toolpath(person, hemisphere):
    feature = api.make_feature(hemisphere.Document, hemisphere, layer_height=5)
    toolpath_object = api.make_toolpath(hemisphere.Document, feature)
    person.idle()
    return toolpath_object


def visible_legends(person):
    """Return the visible legends, each as title and unit."""
    document = App.ActiveDocument
    return (
        []
        if document is None
        else [(scale.title, scale.unit) for scale in legend.visible_scales(document)]
    )


def test_each_colouring_has_its_legend(person, toolpath):
    vobj = toolpath.ViewObject
    assert vobj.getEnumerationsOfProperty("Colouring") == list(colouring.KINDS)
    for kind, unit in zip(colouring.KINDS, ("", "mm", "deg", "mm/s", "", ""), strict=True):
        vobj.Colouring = kind
        person.idle()
        assert visible_legends(person) == [(kind, unit)]
        person.screenshot(f"colouring_{kind.replace(' ', '_')}")
    vobj.ShowLegend = False
    person.idle()
    assert visible_legends(person) == []
    vobj.ShowLegend = True
    vobj.Visibility = False
    person.idle()
    assert visible_legends(person) == []
    vobj.Visibility = True
    person.idle()
    assert visible_legends(person) == [("kind of bead", "")]


def test_the_legend_is_on_the_screen_and_stays_where_it_is(person, toolpath):
    colours = [tuple(np.rint(255 * ramp([share])[0])) for share in (0.0, 0.25, 0.75, 1.0)]
    toolpath.ViewObject.LineWidth = 1.0
    toolpath.ViewObject.Colouring = "speed"  # one speed: a bar with one colour
    middle = np.rint(255 * ramp([0.5])[0])
    person.look()
    bar_pixels = person.screen_pixels(middle, 4)
    assert bar_pixels >= 16 * 150  # the bar
    toolpath.ViewObject.Colouring = "layer"
    for colour in colours:
        assert person.screen_pixels(colour, 4) >= 16
    # tubes are shaded, so only the bar has the colours of the ramp
    toolpath.ViewObject.Look = "tubes"
    original_bar = find_bar(person)
    assert original_bar.sum() > 1000
    view = person.gui.activeDocument().activeView()
    view.viewTop()
    person.gui.SendMsgToActiveView("ViewFit")
    person.idle()
    assert np.array_equal(find_bar(person), original_bar)
    view.setCameraType("Perspective")
    person.idle()
    assert np.array_equal(find_bar(person), original_bar)


def find_bar(person):
    """Return where the upper left corner of a saved picture has the colours of the ramp."""
    path = str(person.folder / "corner.png")
    person.gui.activeDocument().activeView().saveImage(path, 800, 600, "White")
    image = person.widgets.QImage(path).convertToFormat(person.widgets.QImage.Format_RGB32)
    rows = (
        np.frombuffer(bytes(image.constBits()), dtype=np.uint8)
        .reshape(600, -1, 4)[:230, :40, 2::-1]
        .astype(int)
    )
    colours = np.rint(255 * ramp(np.linspace(0, 1, 256))).astype(int)
    return (np.abs(rows[:, :, None] - colours).max(axis=-1) < 3).any(axis=-1)


def test_the_legend_follows_undo_deletion_and_views(person, toolpath):
    document = toolpath.Document
    assert visible_legends(person) == [("layer", "")]
    person.gui.runCommand("Std_Undo")
    person.idle()
    assert document.getObject("Toolpath") is None and visible_legends(person) == []
    person.gui.runCommand("Std_Redo")
    person.idle()
    assert visible_legends(person) == [("layer", "")]
    person.gui.runCommand("Std_ViewCreate")
    person.idle(0.4)
    assert find_bar(person).sum() > 1000  # in the new view too
    document.removeObject("Toolpath")
    person.idle()
    assert visible_legends(person) == [] and find_bar(person).sum() == 0


def test_two_legends_stand_side_by_side_with_their_names(person, toolpath):
    document = toolpath.Document
    second = api.make_toolpath(document, document.Feature, label="Other")
    person.idle()
    assert [scale.title for scale in legend.visible_scales(document)] == ["layer", "layer"]
    first_legend, second_legend = toolpath.ViewObject.Proxy.legend, second.ViewObject.Proxy.legend
    assert (first_legend.entry[0], second_legend.entry[0]) == (
        ("Toolpath",),
        ("Other",),
    ) and second_legend.left > first_legend.left == 0
    person.screenshot("two_legends")
    second.ViewObject.Visibility = False
    person.idle()
    assert first_legend.entry[0] == () and second_legend.entry is None


def test_local_distances_are_told_by_colour(person, toolpath):
    """Distances within the band have colours of the ramp, others a colour of their own, and the
    first layer is grey."""
    path = api.result(toolpath)
    low = path.layers[3].beads[0]
    nearer = dataclasses.replace(low, points=low.points - [0.0, 0.0, 2.5])
    layers = list(path.layers)
    layers[3] = dataclasses.replace(layers[3], beads=(nearer,))
    moved = dataclasses.replace(path, layers=tuple(layers))
    colours, scale = colouring.coloured(moved, "local distance", 0.2)
    distance = np.concatenate(local_distances(moved))
    first_count = len(path.layers[0].beads[0])
    assert (
        np.isnan(distance[:first_count]).all() and (colours[:first_count] == colouring.NONE).all()
    )
    too_near, too_far = distance < 4.0 - 1e-6, distance > 6.0 + 1e-6
    assert too_near.any() and too_far.any() and scale.below and scale.above and scale.without
    assert (colours[too_near] == colouring.BELOW_COLOUR).all() and (
        colours[too_far] == colouring.ABOVE_COLOUR
    ).all()
    within = (distance > 4.0 + 1e-6) & (distance < 6.0 - 1e-6)
    assert np.array_equal(colours[within], ramp((distance[within] - 4.0) / 2.0))
    assert [number for number, _ in scale.ticks] == pytest.approx([4.0, 4.5, 5.0, 5.5, 6.0])
    assert scale.lowest == np.nanmin(distance) and scale.highest == np.nanmax(distance)
    _, undisturbed = colouring.coloured(path, "local distance", 0.2)
    assert not (undisturbed.below or undisturbed.above)


def test_tilt_is_from_the_vertical_of_the_part(person, toolpath):
    colours, scale = colouring.coloured(api.result(toolpath), "tilt", 0.2)
    tool = np.concatenate([bead.tool for _, _, bead in api.result(toolpath)])
    tilt = np.degrees(np.arccos(np.clip(tool[:, 2], -1, 1)))
    assert (scale.low, scale.high) == pytest.approx((tilt.min(), tilt.max()), abs=1e-9)
    assert np.array_equal(colours, ramp((tilt - scale.low) / (scale.high - scale.low)))


@pytest.mark.parametrize(
    ("low", "high", "texts"),
    [
        (0, 70, ["0", "20", "40", "60"]),
        (11.2, 88.9, ["20", "40", "60", "80"]),
        (0.01, 0.013, ["0.010", "0.011", "0.012", "0.013"]),
        (-3, 2, ["-3", "-2", "-1", "0", "1", "2"]),
        (6, 6, ["6"]),
    ],
)
def test_numbers_beside_the_bar_are_round_and_true(person, low, high, texts):
    scale = colouring.automatic(np.array([low, high], dtype=float), "speed", "mm/s")
    assert [text for _, text in scale.ticks] == texts
    for number, text in scale.ticks:
        assert abs(number - float(text)) < 1e-9 and low - 1e-9 <= number <= high + 1e-9


def test_layers_are_whole_numbers(person):
    assert [text for _, text in colouring.automatic(np.array([0.0, 1.0]), "layer", "").ticks] == [
        "0",
        "1",
    ]
