# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 6, step by step: the curved top of a die gets two layers along its normals, on a table
that tilts and turns."""

import pytest

PAGE = "die"
TOP = "Face3"


@pytest.mark.long
def test_the_die(person, hand, lesson):
    lesson.step("1. Open the die")
    document, die = lesson.parts("die.step")
    lesson.picture("die-part")

    lesson.step("2. Choose the face")
    hand.click_face(die, TOP)
    lesson.tool("Cladding")
    panel = person.panel("RoboticAM_CladdingFeature")
    preview_text = person.field(panel, "preview")
    person.until(lambda: "1 face, 84" in preview_text.text(), "the face and its area", 60)
    lesson.hand.enter(panel, "Layers", "2")
    lesson.hand.enter(panel, "LayerHeight", "2 mm")
    lesson.hand.enter(panel, "ChordError", "0.1 mm")
    lesson.hand.enter(panel, "BeadSpacing", "5 mm")
    lesson.choose(panel, "Fill", "zigzag")
    lesson.picture("die-face")
    lesson.ok()
    assert document.Feature.Status == "up to date" and list(document.Feature.Source[1]) == [TOP]

    lesson.step("3. Choose a table that tilts and turns")
    lesson.tool("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Machine", "table-xyzac")
    lesson.hand.enter(panel, "Platform", "60 mm")
    lesson.hand.enter(panel, "PlatformDiameter", "0 mm")
    lesson.ok()
    assert document.Cell.Setup == "rotary-table"

    lesson.step("4. Lay the beads")
    lesson.tool("Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    lesson.hand.enter(panel, "BeadWidth", "6 mm")
    lesson.ok()
    assert document.Toolpath.Status == "up to date" and document.Toolpath.Layers == 2
    lesson.see_all()
    lesson.picture("die-toolpath", path=True, legend=True)

    lesson.step("5. Check the torch directions")
    hand.click_tree("Toolpath")
    lesson.tool("Path")
    dock = person.panel("RoboticAM_PathDock")
    hand.click(person.field(dock, "directions"))
    lesson.picture("die-directions", path=True, legend=True)
    hand.click(person.field(dock, "directions"))
    lesson.close("RoboticAM_PathDock")

    lesson.step("6. Plan the axes, and write the program")
    lesson.tool("JointPath")
    person.panel("RoboticAM_JointPath")
    lesson.ok()
    assert document.JointPath.Status == "up to date"
    lesson.tool("Program")
    panel = person.panel("RoboticAM_Program")
    lesson.hand.enter(panel, "ProgramName", "DIE")
    lesson.choose(panel, "Motion", "cartesian")
    note = person.field(panel, "preview")
    person.until(lambda: "Begins with" in note.text(), "the beginning of the program", 60)
    lesson.picture("die-program", path=True)
    lesson.ok()
    assert document.Program.Status == "up to date"
    lesson.finish()
