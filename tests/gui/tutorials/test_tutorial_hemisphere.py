# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 1, step by step: a part of revolution from a STEP file to a program, with the tool
rotation set by hand."""

from freecad_am import api
from freecad_am.gui.redundancy_map import dock as docks

PAGE = "hemisphere"


def test_the_hemisphere(person, hand, lesson, tmp_path):
    lesson.step("1. Open the part")
    document, hemisphere = lesson.parts("hemisphere.step")
    lesson.picture("hemisphere-part")

    lesson.step("2. Make the job")
    hand.click_face(hemisphere, "Face1")
    lesson.tool("NewJob")
    panel = person.panel("RoboticAM_NewJob")
    assert "share one axis of revolution" in panel_text(person, panel)
    lesson.picture("hemisphere-new-job")
    steps = document.UndoCount
    lesson.ok()
    assert [stage.Status for stage in api.stages_of(document)] == ["up to date"] * 5
    lesson.picture("hemisphere-job", path=True, legend=True)
    lesson.keys("ctrl+z")
    assert api.stages_of(document) == [] and document.UndoCount == steps
    lesson.keys("ctrl+shift+z")
    assert [stage.Status for stage in api.stages_of(document)] == ["up to date"] * 5

    lesson.step("3. Set the robot's limits, and choose thicker layers")
    lesson.unfold("Job hemisphere")
    lesson.double_click("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Limits", "paper")
    lesson.picture("hemisphere-cell", path=True)
    lesson.ok()
    lesson.double_click("Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    lesson.hand.enter(panel, "LayerHeight", "5 mm")
    lesson.ok()
    assert document.Toolpath.Layers == 15
    assert [stage.Status for stage in api.stages_of(document)] == ["up to date"] * 5

    lesson.step("4. View the path")
    hand.click_tree("Joint path")
    lesson.tool("Path")
    dock = person.panel("RoboticAM_PathDock")
    lesson.hand.enter(dock, "to_spin", "8")
    hand.click(person.field(dock, "directions"))
    assert document.JointPath.ViewObject.ShowDirections
    assert "joint margin" in person.field(dock, "facts").text()
    lesson.picture("hemisphere-path", path=True, legend=True)
    hand.click(person.field(dock, "directions"))
    hand.click(person.field(dock, "all"))
    lesson.close("RoboticAM_PathDock")

    lesson.step("5. Play it with the robot")
    lesson.play("100 ×", 5)
    lesson.picture("hemisphere-simulation", machine=True)
    lesson.close("RoboticAM_Simulation")

    lesson.step("6. Turn the part about the nozzle")
    lesson.tool("SpinMap")
    dock = person.panel("RoboticAM_SpinMap")
    map_dock = docks._open[0]
    person.until(lambda: map_dock.canvas.painted is not None, "the map", 30)
    assert person.field(dock, "together").isChecked()
    planned = map_dock.board.draft_values(map_dock.draft)
    column = len(planned) // 2
    start, end = (
        screen_position(map_dock.canvas, column, planned[column] + turn) for turn in (0.0, -0.5)
    )
    lesson.drag(start, end)
    assert (
        abs(map_dock.board.draft_values(map_dock.draft) - planned).min() > 0.2
    )  # the whole curve has moved
    assert person.field(dock, "use").isEnabled()
    lesson.picture("hemisphere-map")
    hand.click(person.field(dock, "use"))
    person.until(lambda: document.JointPath.Given, "the joint path to follow the curve", 30)
    assert document.JointPath.Status == "up to date" and document.Program.Status == "up to date"
    hand.click(person.field(dock, "free"))
    person.until(lambda: not document.JointPath.Given, "the planner to choose again", 30)
    lesson.close("RoboticAM_SpinMap")

    lesson.step("7. Read the program")
    lesson.double_click("Program")
    window = person.panel("RoboticAM_ProgramText")
    assert person.field(window, "text").toPlainText().startswith("/PROG")
    lesson.picture("hemisphere-program")
    hand.click(person.field(window, "close"))

    lesson.step("8. Save, and open it again")
    lesson.save_and_open_again(tmp_path / "hemisphere.FCStd")
    lesson.see_all()
    lesson.picture("hemisphere-again", path=True, legend=True)
    lesson.finish()


def screen_position(canvas, column, value):
    """Return the position of a column of the map and a rotation on the screen."""
    from PySide import QtCore

    position = canvas.mapToGlobal(
        QtCore.QPoint(round(float(canvas.x_of(column))), round(float(canvas.y_of(value))))
    )
    return position.x(), position.y()


def panel_text(person, panel):
    """Return all texts of a panel."""
    return "\n".join(
        label.text() for label in panel.findChildren(person.widgets.QLabel) if label.isVisible()
    )
