# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several features in the panel of a toolpath: the panel takes the selected ones, and clicks change
their order."""

import FreeCAD as App
import FreeCADGui
import pytest

from freecad_am import api

pytestmark = pytest.mark.usefixtures("person")


def feature(doc, name, *position):
    box = doc.addObject("Part::Box", name)
    box.Length, box.Width, box.Height = 20, 20, 10
    box.Placement.Base = App.Vector(*position)
    doc.recompute()
    return api.make_solid_feature(
        doc, box, label=f"{name} feature", layer_height=5, chord_error=0.2
    )


def labels(toolpath):
    return [feature_.Source[0].Name for feature_ in (toolpath.Feature, *toolpath.Further)]


def listed(panel, person):
    order = person.field(panel, "FeatureOrder")
    return [order.item(row).text() for row in range(order.count())]


def press(person, panel, name):
    person.field(panel, name).click()
    person.idle()


def test_selected_features_are_deposited_in_an_order_that_clicks_change(person):
    doc = App.newDocument("Order")
    first_feature, second_feature, third_feature = (
        feature(doc, "A", 0, 0, 0),
        feature(doc, "B", 40, 0, 0),
        feature(doc, "C", 80, 0, 0),
    )
    person.select(first_feature)
    FreeCADGui.Selection.addSelection(third_feature)
    person.click("RoboticAM_Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    assert listed(panel, person) == ["C feature"]
    widget = panel
    while widget.objectName() != "qt_scrollarea_viewport":
        widget = widget.parentWidget()
    # four buttons in a row would make the panel wider
    person.until(
        lambda: panel.mapTo(widget, panel.rect().topRight()).x() < widget.width(),
        "a panel that is not cut off",
    )
    press(person, panel, "AddFeature")  # only the selected ones are listed
    FreeCADGui.Selection.clearSelection()
    press(person, panel, "AddFeature")
    assert listed(panel, person) == ["C feature", "B feature"]
    order = person.field(panel, "FeatureOrder")
    order.setCurrentRow(1)
    press(person, panel, "FeatureUp")
    assert listed(panel, person) == ["B feature", "C feature"]
    press(person, panel, "FeatureUp")  # before the first
    assert listed(panel, person) == ["A feature", "C feature"]
    person.screenshot("feature_order")
    steps = doc.UndoCount
    person.press("Ok")
    person.panel_closed()
    (toolpath,) = api.stages_of(doc, "toolpath")
    assert (
        toolpath.Status == "up to date"
        and labels(toolpath) == ["B", "A", "C"]
        and doc.UndoCount == steps + 1
    )
    person.double_click(toolpath)
    panel = person.panel("RoboticAM_Toolpath")
    assert listed(panel, person) == ["A feature", "C feature"]
    person.field(panel, "FeatureOrder").setCurrentRow(0)
    press(person, panel, "FeatureDown")
    person.choose(panel, "Sequence", "lowest layer first")
    person.press("Ok")
    person.panel_closed()
    assert (
        labels(toolpath) == ["B", "C", "A"]
        and toolpath.Sequence == "height"
        and toolpath.Layers == 6
    )
    doc.undo()
    assert labels(toolpath) == ["B", "A", "C"] and toolpath.Sequence == "feature"
    assert not any(box.ViewObject.Visibility for box in (doc.A, doc.B, doc.C))
    assert second_feature.Status == "up to date"
