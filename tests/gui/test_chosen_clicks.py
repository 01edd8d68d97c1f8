# SPDX-License-Identifier: LGPL-2.1-or-later
"""The panel of a feature reports faces and edges that FreeCAD has renumbered, and OK confirms
them."""

import random

import FreeCAD as App
import Part
import pytest

from freecad_am import api
from tests.objects.test_chosen import numbered
from tests.objects.test_chosen_edges import axis_case, in_another_order

pytestmark = pytest.mark.usefixtures("person")


def cladding(doc):
    block = doc.addObject("Part::Feature", "Block")
    shape = block.Shape = Part.makeBox(40, 30, 20)
    doc.recompute()
    feature = api.make_cladding_feature(
        doc, block, ["Face6"], layers=1, layer_height=2.0, bead_spacing=6.0
    )
    block.Shape = numbered(shape, (5, 0, 1, 2, 3, 4))
    return feature, "Layers", "2"


def curves(doc):
    block = doc.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(40, 30, 20)
    doc.recompute()
    feature = api.make_curves_feature(doc, block, ["Edge3"], chord_error=0.1)
    block.Shape = in_another_order(block.Shape, "Edge3", random.Random(1))[0]
    return feature, "Repeat", "2"


def make_revolution(doc):
    block, feature, _, name, _ = axis_case(doc, None)
    block.Shape = in_another_order(block.Shape, name, random.Random(2))[0]
    return feature, "LayerHeight", "8 mm"


@pytest.mark.parametrize(
    ("made", "panel", "what"),
    [
        (cladding, "CladdingFeature", "face"),
        (curves, "CurvesFeature", "edge"),
        (make_revolution, "RevolutionFeature", "edge"),
    ],
)
def test_what_is_numbered_anew_is_confirmed_by_ok(person, made, panel, what):
    doc = App.newDocument("Chosen")
    doc.UndoMode = 1
    feature, name, value = made(doc)
    api.recompute(doc)

    def warned():
        return f"{what.upper()}S_CHANGED" in feature.Issues

    assert warned() and feature.Status == "up to date"
    person.double_click(feature)
    panel_shown = person.panel(f"RoboticAM_{panel}")
    person.until(
        lambda: f"is not the selected {what}" in person.field(panel_shown, "findings").text(),
        "the warning",
    )
    person.screenshot(f"{panel}_changed")
    person.type(panel_shown, name, value)
    person.press("Ok")
    person.panel_closed()
    assert (
        getattr(feature, name) == App.Units.Quantity(value) and warned()
    )  # the user changed another value
    person.double_click(feature)
    person.panel(f"RoboticAM_{panel}")
    person.press("Ok")
    person.panel_closed()
    assert not warned()
    person.gui.runCommand("Std_Undo")
    person.idle()
    assert warned()
