# SPDX-License-Identifier: LGPL-2.1-or-later
"""From a selected hemisphere to a program by clicks."""

import FreeCAD as App
import numpy as np

from freecad_am import api


def hemisphere(doc):
    part = doc.addObject("Part::Sphere", "Hémisphère")
    part.Label = "Hémisphère n° 1"
    part.Radius, part.Angle1, part.Angle2, part.Angle3 = 45, 0, 90, 360
    doc.recompute()
    return part


def coloured(pixels):
    """How many pixels are of the hues of the colour ramp's ends: blue at the platform, yellow at the top."""
    red, green, blue = pixels.T
    return int(((blue > red + 60) & (blue > green + 30)).sum()), int(((red > blue + 60) & (green > blue + 60)).sum())


def test_from_a_selected_shape_to_a_program_by_clicks(person):
    doc = App.newDocument("Clicks")
    part = hemisphere(doc)

    person.click("RoboticAM_Cell")
    panel = person.panel("RoboticAM_Cell")
    person.type(panel, "Limits", "paper")
    person.screenshot("panel_cell")
    person.press("Ok")
    person.panel_closed()
    assert [(obj.Label, obj.Limits, obj.Status) for obj in api.stages_of(doc)] == [("Cell", "paper", "up to date")]

    person.select(part)
    person.click("RoboticAM_Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    assert person.field(panel, "Source").text() == part.Label
    person.type(panel, "LayerHeight", "0.5 cm")
    person.screenshot("panel_feature")
    person.press("Ok")
    person.panel_closed()
    assert doc.Feature.LayerHeight.Value == 5.0

    person.click("RoboticAM_Toolpath")
    person.screenshot("panel_toolpath")
    person.press("Ok")
    person.panel_closed()
    assert doc.Toolpath.Layers == 15
    part.ViewObject.Visibility = False
    blue, yellow = coloured(person.picture())
    assert blue > 200 and yellow > 100, (blue, yellow)
    person.screenshot("toolpath")

    person.click("RoboticAM_JointPath")
    person.screenshot("panel_joint_path")
    person.press("Ok")
    person.panel_closed()
    assert doc.JointPath.Status == "up to date"

    person.click("RoboticAM_Program")
    panel = person.panel("RoboticAM_Program")
    person.type(panel, "ProgramName", "CUP")
    person.press("Ok")
    person.panel_closed()
    assert doc.Program.Status == "up to date"
    assert "CUP.LS" in doc.Program.Files
    person.look()
    person.screenshot("program_made")

    person.double_click(doc.Program)
    panel = person.panel("RoboticAM_ProgramText")
    text = person.field(panel, "text").toPlainText()
    assert text.startswith("/PROG") and text.encode("latin-1") in api.result(doc.Program).files["CUP.LS"].replace(b"\r", b"")
    person.screenshot("program_text")
    person.press("Close")
    person.panel_closed()
    assert np.isfinite(api.result(doc.JointPath).motion.joints).all()
