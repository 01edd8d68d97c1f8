# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids in plane layers by clicks: the panel and its preview, New Job of a bracket and of a mesh."""

import FreeCAD as App
import MeshPart
import Part
import pytest

from freecad_am import api

pytestmark = pytest.mark.usefixtures("person")


def bracket(doc):
    shape = Part.makeBox(60, 40, 10).fuse(Part.makeBox(10, 40, 40)).removeSplitter()
    obj = doc.addObject("Part::Feature", "Bracket")
    obj.Shape = shape
    doc.recompute()
    return obj


def test_the_panel_previews_and_makes_a_feature(person):
    doc = App.newDocument("Solid")
    part = bracket(doc)
    person.select(part)
    person.click("RoboticAM_Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    told = person.field(panel, "preview")
    person.until(lambda: "1 solids, 40 mm high" in told.text(), "the preview", 30)
    person.type(panel, "Direction", "1 0 0")
    person.until(lambda: "60 mm high" in told.text(), "the preview along X", 30)
    person.screenshot("solid_panel")
    person.press("Ok")
    person.panel_closed()
    (feature,) = api.stages_of(doc, "feature")
    assert (feature.Status, feature.Height.Value, feature.Source[0]) == ("up to date", pytest.approx(60.0), part)


def test_new_job_fills_what_is_no_wall(person, coarse):
    doc = App.newDocument("Job")
    part = bracket(doc)
    person.select(part)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    reason = person.field(panel, "reason")
    person.until(lambda: "filled in plane layers" in reason.text(), "the proposal", 30)
    assert person.field(panel, "Kind").currentText() == "Solids in plane layers"
    person.press("Cancel")
    person.panel_closed()


def test_a_mesh_is_proposed_to_be_filled(person):
    doc = App.newDocument("Mesh")
    scan = doc.addObject("Mesh::Feature", "Scan")
    scan.Mesh = MeshPart.meshFromShape(Shape=Part.makeBox(20, 20, 20), LinearDeflection=1, AngularDeflection=1)
    doc.recompute()
    person.select(scan)
    person.click("RoboticAM_NewJob")
    panel = person.panel("RoboticAM_NewJob")
    person.until(lambda: "is a mesh, which is filled" in person.field(panel, "reason").text(), "the proposal", 20)
    person.press("Cancel")
    person.panel_closed()
