# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cladding by clicks: faces are picked, previewed and covered."""

import FreeCAD as App
import Part
import pytest

from freecad_am import api

pytestmark = pytest.mark.usefixtures("person")


def test_the_panel_previews_and_covers_a_face(person):
    doc = App.newDocument("Cladding")
    block = doc.addObject("Part::Feature", "Block")
    block.Shape = Part.makeBox(40, 30, 20)
    doc.recompute()
    person.select(block, "Face6")
    person.click("RoboticAM_Cladding")
    panel = person.panel("RoboticAM_CladdingFeature")
    told = person.field(panel, "preview")
    person.until(lambda: "1 faces in 1 sheets, 12 cm²" in told.text(), "the preview", 30)
    person.type(panel, "Layers", "2")
    person.screenshot("cladding_panel")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Source, feature.Layers) == ("up to date", (block, ["Face6"]), 2)
    assert feature.ViewObject.Proxy.icon == "cladding"
    assert len(api.result(api.make_toolpath(doc, feature)).layers) == 2
