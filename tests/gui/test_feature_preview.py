# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a part of revolution previews meridian, axis and layers, and removes them when it
closes."""

import numpy as np

from freecad_am import api
from freecad_am.gui.views.preview import NAME

PANEL = "RoboticAM_RevolutionFeature"
ORANGE = (245, 120, 0)


def previewed(person):
    """Return the nodes of previews in the 3D view."""
    from pivy import coin

    search = coin.SoSearchAction()
    search.setName(NAME)
    search.setInterest(coin.SoSearchAction.ALL)
    search.setSearchingAll(True)
    search.apply(person.gui.activeDocument().activeView().getSceneGraph())
    return search.getPaths().getLength()


def wait_for_message(person, panel, words, seconds=10):
    state = person.field(panel, "preview")
    person.until(
        lambda: state.isVisible() and words in state.text(),
        f"{words}, not {state.text()!r}",
        seconds,
    )


def test_layers_are_seen_before_they_are_made_and_go_with_the_panel(person, hand, hemisphere):
    document, steps = hemisphere.Document, hemisphere.Document.UndoCount
    person.look()
    hemisphere.ViewObject.Visibility = False
    bare = person.screen_pixels(ORANGE)
    person.select(hemisphere)
    person.click("RoboticAM_Feature")
    panel = person.panel(PANEL)
    length = 45.0 * np.pi / 2.0
    wait_for_message(person, panel, f"Layers: 71, along {length:.4g} mm")
    assert previewed(person) == 1
    preview_pixels = person.screen_pixels(ORANGE)
    assert preview_pixels > bare + 1000
    hand.enter(panel, "LayerHeight", "10 mm")
    wait_for_message(person, panel, "Layers: 8, along")
    person.screenshot("feature_preview")
    fewer_pixels = person.screen_pixels(ORANGE)
    assert bare + 200 < fewer_pixels < preview_pixels
    hand.enter(panel, "LayerHeight", "100 mm")
    note = person.field(panel, "LayerHeightNote")
    person.until(
        lambda: note.isVisible() and "exceeds the length of the wall" in note.text(),
        "what is wrong",
        10,
    )
    wait_for_message(person, panel, "see the marked field")
    assert person.screen_pixels(ORANGE) <= bare + 20
    person.choose(panel, "Path", "spiral")
    hand.enter(panel, "LayerHeight", "5 mm")
    wait_for_message(person, panel, "About 1")
    person.press("Cancel")
    person.panel_closed()
    person.idle(0.3)
    assert previewed(person) == 0 and person.screen_pixels(ORANGE) == bare
    assert (document.UndoCount, document.Objects) == (steps, [hemisphere])


def test_what_a_feature_draws_itself_stands_back_while_it_is_changed(person, hemisphere):
    feature = api.make_feature(hemisphere.Document, hemisphere, layer_height=15)
    person.double_click(feature)
    panel = person.panel(PANEL)
    own_drawing = feature.ViewObject.Proxy.revolved
    wait_for_message(person, panel, "Layers: 5, along")
    assert own_drawing.switch.whichChild.getValue() == -1 and previewed(person) == 1
    person.type(panel, "LayerHeight", "9 mm")
    wait_for_message(person, panel, "Layers: 8, along")
    assert feature.LayerHeight.Value == 15
    person.press("Apply")
    assert feature.LayerHeight.Value == 9 and own_drawing.switch.whichChild.getValue() == -1
    person.press("Ok")
    person.panel_closed()
    assert own_drawing.switch.whichChild.getValue() == -3 and previewed(person) == 0


def test_without_a_shape_the_panel_says_so_and_waits(person, hand, hemisphere):
    block = hemisphere.Document.addObject("Part::Box", "Block")
    hemisphere.Document.recompute()
    person.gui.Selection.clearSelection()
    person.click("RoboticAM_Feature")
    panel = person.panel(PANEL)
    wait_for_message(person, panel, "Select the shape to deposit")
    assert not person.field(panel, "error").isVisible()
    person.select(block)
    hand.click(person.field(panel, "UseSource"))
    wait_for_message(person, panel, "see the marked field")
    assert "Block" in person.panel_error(panel) or "revolution" in person.panel_error(panel), (
        person.panel_error(panel)
    )
    person.select(hemisphere)
    hand.click(person.field(panel, "UseSource"))
    wait_for_message(person, panel, "Layers: 71")
    assert person.panel_error(panel) == ""
    person.press("Ok")
    person.panel_closed()
    assert hemisphere.Document.Feature.Status == "up to date"
