# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 4, step by step: a bracket in plane layers, its overhangs and its deposit, on a tilting
table."""

import pytest

PAGE = "bracket"


@pytest.mark.long
def test_the_bracket(person, hand, lesson):
    lesson.step("1. Open the bracket")
    document, bracket = lesson.parts("bracket.step")
    lesson.picture("bracket-part")

    lesson.step("2. See the overhangs")
    hand.click_face(bracket, "Face1")
    lesson.tool("Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    slider, overhang_text = (
        person.field(panel, "OverhangAngle"),
        person.field(panel, "OverhangArea"),
    )
    person.until(lambda: "45°: " in overhang_text.text(), "the area that leans out", 60)
    hand.click(slider)
    hand.do("key", *["Left"] * 25)
    person.until(lambda: "20°: " in overhang_text.text(), "another angle", 10)
    lesson.from_below()
    lesson.picture("bracket-overhang")
    lesson.see_all()
    lesson.hand.enter(panel, "LayerHeight", "4 mm")
    lesson.hand.enter(panel, "ChordError", "0.05 mm")
    lesson.choose(panel, "Fill", "zigzag")
    lesson.ok()
    assert document.Feature.Status == "up to date"

    lesson.step("3. Choose a table that tilts and turns")
    lesson.tool("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Machine", "table-xyzac")
    lesson.hand.enter(panel, "Platform", "60 mm")
    lesson.hand.enter(panel, "PlatformDiameter", "250 mm")
    lesson.choose(panel, "Mount", "feature")
    lesson.ok()
    assert document.Cell.Setup == "rotary-table"

    lesson.step("4. Fill the layers")
    lesson.tool("Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    lesson.hand.enter(panel, "BeadWidth", "5 mm")
    lesson.ok()
    assert document.Toolpath.Status == "up to date"
    lesson.see_all()
    lesson.picture("bracket-toolpath", path=True, legend=True)

    lesson.step("5. Compare with the part")
    lesson.tool("Plots")
    dock = person.panel("RoboticAM_Plots")
    lesson.choose(dock, "picture", "Section of the last layer")
    lesson.hand.enter(dock, "to", "6")
    lesson.plotted()
    lesson.picture("bracket-section", path=True)
    lesson.choose(dock, "picture", "Volume by layer")
    lesson.hand.enter(dock, "to", "24")
    lesson.plotted()
    lesson.picture("bracket-volumes", path=True)
    lesson.close("RoboticAM_Plots")

    lesson.step("6. Plan the axes, and write the program")
    lesson.tool("JointPath")
    person.panel("RoboticAM_JointPath")
    lesson.ok()
    assert document.JointPath.Status == "up to date"
    lesson.tool("Program")
    panel = person.panel("RoboticAM_Program")
    assert person.field(panel, "Post").currentText() == "siemens"
    lesson.hand.enter(panel, "ProgramName", "BRACKET")
    note = person.field(panel, "preview")
    person.until(lambda: "Begins with" in note.text(), "the beginning of the program", 60)
    lesson.picture("bracket-program", path=True)
    lesson.ok()
    assert document.Program.Status == "up to date"
    lesson.finish()
