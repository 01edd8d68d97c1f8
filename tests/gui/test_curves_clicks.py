# SPDX-License-Identifier: LGPL-2.1-or-later
"""Curves as beads by clicks: a wire, and an opened table of points."""

import FreeCAD as App
import Part
import pytest

from freecad_am import api

pytestmark = pytest.mark.usefixtures("person")


def test_the_panel_previews_and_makes_a_feature_of_a_wire(person):
    doc = App.newDocument("Curves")
    wire = doc.addObject("Part::Feature", "Wire")
    wire.Shape = Part.makePolygon(
        [App.Vector(0, 0, 0), App.Vector(30, 0, 0), App.Vector(30, 20, 0)]
    )
    doc.recompute()
    person.select(wire)
    person.click("RoboticAM_Curves")
    panel = person.panel("RoboticAM_CurvesFeature")
    preview_text = person.field(panel, "preview")
    person.until(lambda: "1 curves, 50 mm in all" in preview_text.text(), "the preview", 30)
    person.type(panel, "Repeat", "3")
    person.screenshot("curves_panel")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Source[0], feature.Repeat) == ("up to date", wire, 3)
    path = api.result(api.make_toolpath(doc, feature))
    assert len(path.layers) == 3 and path.length == pytest.approx(150.0)
    person.double_click(feature)
    panel = person.panel("RoboticAM_CurvesFeature")
    person.until(lambda: "50 mm" in person.field(panel, "preview").text(), "the preview again", 30)
    person.press("Cancel")
    person.panel_closed()


def test_a_table_that_was_opened_is_laid(person, tmp_path):
    (tmp_path / "beads.csv").write_text(
        "x,y,z,bead\n0,0,0,1\n30,0,0,1\n0,5,0,2\n30,5,0,2\n", encoding="utf-8"
    )
    doc = App.newDocument("Table")
    table = api.open_part(doc, str(tmp_path / "beads.csv"))
    person.select(table)
    person.click("RoboticAM_Curves")
    panel = person.panel("RoboticAM_CurvesFeature")
    person.until(
        lambda: "2 curves, 60 mm" in person.field(panel, "preview").text(), "the preview", 30
    )
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Curves) == ("up to date", 2)
