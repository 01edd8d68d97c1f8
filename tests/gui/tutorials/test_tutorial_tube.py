# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 2, step by step: a bend on a pipe, stage by stage, with equal layer distances
everywhere."""

import pytest

from freecad_am.gui.plots import dock as plots

PAGE = "tube-on-pipe"


@pytest.mark.long
def test_the_tube(person, hand, lesson, tmp_path):
    lesson.step("1. Open the tube and the pipe")
    document, tube, _ = lesson.parts("tube-on-pipe.step", "pipe.step")
    lesson.picture("tube-parts")

    lesson.step("2. Choose wall and pipe")
    hand.click_face(tube, "Face1")
    hand.click_tree("pipe", "ctrl")
    lesson.tool("WallOnPart")
    panel = person.panel("RoboticAM_SurfaceFeature")
    lesson.hand.enter(panel, "LayerHeight", "5 mm")
    first_layer(person, panel)
    lesson.choose(panel, "Mode", "plane of symmetry")
    lesson.hand.enter(panel, "MaxTilt", "85 deg")
    first_layer(person, panel)
    lesson.picture("tube-wall", path=True)

    lesson.step("3. Correct an invalid entry")
    lesson.hand.enter(panel, "LayerHeight", "0 mm")
    note = person.field(panel, "LayerHeightNote")
    person.until(lambda: note.isVisible() and "more than 0 mm" in note.text(), "the note", 10)
    lesson.picture("tube-error")
    lesson.hand.enter(panel, "LayerHeight", "5 mm")
    first_layer(person, panel)
    lesson.ok()
    assert document.Feature.Status == "up to date"
    lesson.keys("ctrl+z")
    assert document.getObject("Feature") is None
    lesson.keys("ctrl+shift+z")
    assert document.Feature.Status == "up to date"

    lesson.step("4. Cut it into layers")
    hand.click_tree("Feature")
    lesson.tool("Toolpath")
    person.panel("RoboticAM_Toolpath")
    lesson.ok()
    assert document.Toolpath.Layers == 15
    hand.click_tree("Toolpath")
    lesson.tool("Path")
    dock = person.panel("RoboticAM_PathDock")
    lesson.choose(dock, "colouring", "local distance")
    lesson.choose(dock, "look", "tubes")
    lesson.picture("tube-layers", path=True, legend=True)
    lesson.close("RoboticAM_PathDock")

    lesson.step("5. Set the robot up")
    lesson.tool("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Limits", "paper")
    lesson.hand.enter(panel, "Platform", "40 mm")
    lesson.hand.enter(panel, "PlatformDiameter", "0 mm")
    lesson.picture("tube-cell")
    lesson.ok()
    assert document.Cell.Status == "up to date"

    lesson.step("6. Plan the joints")
    lesson.tool("JointPath")
    person.panel("RoboticAM_JointPath")
    lesson.ok()
    assert document.JointPath.Status == "up to date"
    lesson.see_all()
    lesson.picture("tube-joints", path=True, legend=True)

    lesson.step("7. View joints and speeds")
    hand.click_tree("Joint path")
    lesson.tool("Plots")
    dock = person.panel("RoboticAM_Plots")
    if person.field(
        dock, "picture"
    ).currentIndex():  # an earlier test left it there: a session starts with the angles
        lesson.choose(dock, "picture", person.field(dock, "picture").itemText(0))
    person.until(lambda: chart_count(plots.only.dock) > 1, "the angles", 20)
    lesson.choose(dock, "picture", "Joint speeds in %")
    person.until(
        lambda: chart_count(plots.only.dock) == 1, "all speeds in one picture", 20
    )  # angles have one for each axis
    lesson.picture("tube-plots")
    lesson.close("RoboticAM_Plots")

    lesson.step("8. Play it")
    lesson.play("50 ×", 5)
    lesson.picture("tube-simulation", machine=True)
    lesson.close("RoboticAM_Simulation")

    lesson.step("9. Write the program, save, and open it again")
    lesson.tool("Program")
    panel = person.panel("RoboticAM_Program")
    lesson.hand.enter(panel, "ProgramName", "BRANCH")
    lesson.ok()
    assert document.Program.Status == "up to date"
    lesson.double_click("Program")
    window = person.panel("RoboticAM_ProgramText")
    assert person.field(window, "text").toPlainText().startswith("/PROG")
    lesson.picture("tube-program")
    hand.click(person.field(window, "close"))
    lesson.save_and_open_again(tmp_path / "tube-on-pipe.FCStd")
    lesson.finish()


def chart_count(dock):
    """Return how many charts the canvas of the plots shows, 0 while they are drawn."""
    return len(dock.canvas.view.places) if dock.building.worker is None and dock.canvas.ready else 0


def first_layer(person, panel):
    """Wait until the preview describes the first layer."""
    note = person.field(panel, "preview")
    person.until(
        lambda: note.isVisible() and note.text().startswith("First layer: "), "the preview", 60
    )
