# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 3, step by step: three blades on a cone, on a table that tilts and turns, to a program
for an 840D."""

import re

import pytest

PAGE = "rotor"


@pytest.mark.long
def test_the_rotor(person, hand, lesson, tmp_path):
    lesson.step("1. Open the hub and its blades")
    document, hub, _ = lesson.parts("rotor/hub.step", "rotor/blades.brep")
    lesson.picture("rotor-parts")

    lesson.step("2. Choose blades and hub")
    hand.click_tree("blades")
    hand.click_face(hub, "Face1", "ctrl")
    lesson.tool("SolidsOnHub")
    panel = person.panel("RoboticAM_DevelopableFeature")
    lesson.hand.enter(panel, "LayerHeight", "4 mm")
    lesson.hand.enter(panel, "BeadSpacing", "6.5 mm")
    note = person.field(panel, "preview")
    person.until(lambda: note.isVisible() and "first layer: " in note.text(), "the preview", 60)
    lesson.picture("rotor-feature", path=True)
    lesson.ok()
    assert document.Feature.Status == "up to date"

    lesson.step("3. Choose a table that tilts and turns")
    lesson.tool("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Machine", "table-xyzac")
    person.idle(0.5)
    lesson.picture("rotor-cell")
    lesson.ok()
    assert document.Cell.Setup == "rotary-table"

    lesson.step("4. Fill the layers with a bead model")
    lesson.tool("Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    lesson.hand.enter(panel, "BeadWidth", "9.5 mm")
    lesson.hand.enter(panel, "BeadModel", "csw")
    person.idle(0.5)
    lesson.picture("rotor-toolpath")
    lesson.ok()
    assert document.Toolpath.Status == "up to date"

    lesson.step("5. See speeds and beads")
    hand.click_tree("Toolpath")
    lesson.tool("Path")
    dock = person.panel("RoboticAM_PathDock")
    lesson.choose(dock, "colouring", "speed")
    lesson.choose(dock, "look", "tubes")
    lesson.hand.enter(dock, "to_spin", "3")
    lesson.picture("rotor-speeds", path=True, legend=True)
    hand.click(person.field(dock, "all"))
    lesson.close("RoboticAM_PathDock")

    lesson.step("6. Plan the axes")
    lesson.tool("JointPath")
    person.panel("RoboticAM_JointPath")
    lesson.ok()
    assert document.JointPath.Status == "up to date"
    lesson.play("100 ×", 3)
    lesson.picture("rotor-axes", machine=True)
    lesson.close("RoboticAM_Simulation")

    lesson.step("7. Write the program for the SINUMERIK")
    lesson.tool("Program")
    panel = person.panel("RoboticAM_Program")
    lesson.hand.enter(panel, "Post", "siemens")
    lesson.hand.enter(panel, "ProgramName", "ROTOR")
    lesson.ok()
    assert document.Program.Status == "up to date"
    lesson.double_click("Program")
    window = person.panel("RoboticAM_ProgramText")
    # the main program calls the layers
    assert "ROTOR01" in person.field(window, "text").toPlainText()
    lesson.choose(window, "file", "ROTOR01.SPF")
    assert re.search(r"^N\d+ G1 .*A=?.*C", person.field(window, "text").toPlainText(), re.MULTILINE)
    lesson.picture("rotor-program")
    hand.click(person.field(window, "close"))

    lesson.step("8. Save, and open it again")
    lesson.save_and_open_again(tmp_path / "rotor.FCStd")
    lesson.see_all()
    lesson.picture("rotor-again", path=True, legend=True)
    lesson.finish()
