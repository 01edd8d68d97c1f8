# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 5, step by step: a Y in curved layers without supports, on a robot under a fixed
nozzle."""

import pytest

PAGE = "wye"


@pytest.mark.long
def test_the_wye(person, hand, lesson):
    lesson.step("1. Open the Y")
    document, wye = lesson.parts("wye.step")
    lesson.picture("wye-part")

    lesson.step("2. See the overhangs")
    hand.click_face(wye, "Face1")
    lesson.tool("Solid")
    panel = person.panel("RoboticAM_SolidFeature")
    slider, overhang_text = (
        person.field(panel, "OverhangAngle"),
        person.field(panel, "OverhangArea"),
    )
    person.until(lambda: "45°: " in overhang_text.text(), "the area that leans out", 60)
    hand.click(slider)
    hand.do("key", *["Left"] * 15)
    person.until(
        lambda: "30°: " in overhang_text.text() and not overhang_text.text().endswith("(0 %)"),
        "the arms",
        10,
    )
    lesson.from_below()
    lesson.picture("wye-overhang")
    lesson.see_all()

    lesson.step("3. Choose layers that carry each other")
    lesson.choose(panel, "Layers", "through the part, without support")
    lesson.hand.enter(panel, "LayerHeight", "3 mm")
    lesson.hand.enter(panel, "ChordError", "0.1 mm")
    lesson.hand.enter(panel, "BeadSpacing", "4 mm")
    lesson.ok()
    assert document.Feature.Status == "up to date"
    lesson.tool("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Branch", "auto")
    lesson.ok()
    lesson.tool("Toolpath")
    panel = person.panel("RoboticAM_Toolpath")
    lesson.hand.enter(panel, "BeadWidth", "4.5 mm")
    lesson.ok()
    assert document.Toolpath.Status == "up to date" and document.Toolpath.Layers > 10
    lesson.see_all()
    lesson.picture("wye-layers", path=True, legend=True)

    lesson.step("4. View the layers one by one")
    hand.click_tree("Toolpath")
    lesson.tool("Path")
    dock = person.panel("RoboticAM_PathDock")
    lesson.choose(dock, "look", "tubes")
    lesson.hand.enter(dock, "to_spin", "14")
    hand.click(person.field(dock, "directions"))
    lesson.picture("wye-path", path=True, legend=True)
    hand.click(person.field(dock, "directions"))
    hand.click(person.field(dock, "all"))
    lesson.close("RoboticAM_PathDock")

    lesson.step("5. Let the robot hold it")
    lesson.tool("JointPath")
    person.panel("RoboticAM_JointPath")
    lesson.ok()
    assert document.JointPath.Status == "up to date"
    lesson.play("100 ×", 9)
    lesson.picture("wye-simulation", machine=True)
    lesson.close("RoboticAM_Simulation")

    lesson.step("6. Write the program")
    lesson.tool("Program")
    panel = person.panel("RoboticAM_Program")
    lesson.hand.enter(panel, "ProgramName", "WYE")
    note = person.field(panel, "preview")
    person.until(lambda: "Begins with" in note.text(), "the beginning of the program", 60)
    lesson.picture("wye-program", path=True)
    lesson.ok()
    assert document.Program.Status == "up to date"
    lesson.finish()
