# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tutorial 7, step by step: a dome on a table that tilts and turns, under a torch on a robot, to a
KRL program."""

import json
import math
import re

import numpy as np
import PyKDL
import pytest

from freecad_am import api
from freecad_am.core.kinematics import external
from freecad_am.gui.redundancy_map import dock as docks

PAGE = "positioner"
ROBOT, TABLE, AWAY, FACE = "kuka-kr8-r2100-2-arc-hw", "motoman-motopos-d500", 1400.0, 20.0
TORCH, LEANS = 300.0, 10.0  # mm from the flange to the tip; deg


@pytest.mark.long
def test_the_dome_on_a_positioner(person, hand, lesson):
    lesson.step("1. Open the part")
    document, dome = lesson.parts("hemisphere.step")

    lesson.step("2. Say how far the torch may lean")
    hand.click_face(dome, "Face1")
    lesson.tool("Feature")
    panel = person.panel("RoboticAM_RevolutionFeature")
    lesson.hand.enter(panel, "LayerHeight", "10 mm")
    lesson.unfold_in(panel, "Build direction: advanced")
    lesson.hand.enter(panel, "MaxFromVertical", f"{LEANS:g} deg")
    lesson.picture("positioner-feature")
    lesson.ok()
    assert document.Feature.Status == "up to date"

    lesson.step("3. Put robot and positioner together")
    lesson.tool("Cell")
    panel = person.panel("RoboticAM_Cell")
    lesson.hand.enter(panel, "Machine", ROBOT)
    lesson.choose(panel, "Setup", "tool on robot")
    lesson.unfold_in(panel, "Nozzle")
    for axis, value in zip(
        ("X", "Y", "Z", "RX", "RY", "RZ"), (0.0, 0.0, TORCH, 0.0, 0.0, 0.0), strict=True
    ):
        lesson.hand.enter(
            panel, f"NozzleTool{axis}", f"{value:g} {'mm' if len(axis) == 1 else 'deg'}"
        )
    lesson.unfold_in(panel, "Cell: advanced")
    lesson.hand.enter(panel, "External", f"{TABLE} at {AWAY:g} 0 0 0 0 0 carries part")
    lesson.hand.enter(panel, "Platform", f"{FACE:g} mm")
    lesson.hand.enter(panel, "Branch", "auto")
    person.idle(1.0)
    lesson.see_all()
    lesson.picture("positioner-cell", machine=True)
    lesson.ok()
    assert document.Cell.Status == "up to date" and document.Cell.Setup == "tool-on-robot"
    lesson.step("4. Lay the beads")
    lesson.tool("Toolpath")
    person.panel("RoboticAM_Toolpath")
    lesson.ok()
    assert document.Toolpath.Status == "up to date"

    lesson.step("5. Plan robot and positioner together")
    lesson.tool("JointPath")
    person.panel("RoboticAM_JointPath")
    lesson.ok()
    assert document.JointPath.Status == "up to date", api.issues(document.JointPath)
    lesson.see_all()
    lesson.picture("positioner-joints", path=True, legend=True)

    lesson.step("6. Watch them")
    lesson.play("100 ×", 2)
    lesson.picture("positioner-simulation", machine=True)
    lesson.close("RoboticAM_Simulation")

    lesson.step("7. Map the table's axes")
    _map(person, hand, lesson)
    lesson.picture("positioner-map", path=True)
    lesson.close("RoboticAM_SpinMap")

    lesson.step("8. Write the program")
    lesson.tool("Program")
    panel = person.panel("RoboticAM_Program")
    lesson.hand.enter(panel, "Post", "kuka")
    lesson.hand.enter(panel, "ProgramName", "DOME")
    lesson.choose(panel, "Motion", "cartesian")
    lesson.ok()
    assert document.Program.Status == "up to date", api.issues(document.Program)
    lesson.double_click("Program")
    window = person.panel("RoboticAM_ProgramText")
    text = person.field(window, "text").toPlainText()
    lesson.picture("positioner-program")
    hand.click(person.field(window, "close"))
    _upright(text)
    lesson.finish()


def _map(person, hand, lesson):
    """Check the map of both table axes at a clicked point: the plan is where the lines cross."""
    lesson.tool("SpinMap")
    dock = person.panel("RoboticAM_SpinMap")
    map_dock = docks._open[0]
    person.until(lambda: map_dock.canvas.painted is not None, "the map", 60)
    position = map_dock.canvas.mapToGlobal(map_dock.canvas.area().center().toPoint())
    hand.at((position.x(), position.y()))
    person.until(lambda: map_dock.clicked, "the click", 10)
    ((bead, point),) = map_dock.clicked.items()
    lesson.choose(dock, "across", "e2")
    person.until(
        lambda: map_dock.board.across == 1 and map_dock.canvas.painted is not None, "e2 across", 60
    )
    lesson.choose(dock, "axis", "e1")
    person.until(
        lambda: map_dock.board.up == 0 and map_dock.canvas.painted is not None, "e1 upwards", 60
    )
    planned = map_dock.source.planned.beads[bead].joints[point, 6:]
    assert abs(map_dock.board.offsets[map_dock.board.marks[1]] - planned[1]) < 2.0 * math.pi / 100.0
    assert map_dock.board.pair.values[0] <= planned[0] <= map_dock.board.pair.values[-1]


def _upright(text):
    """Check the program with PyKDL on the table's own file: at each point the wall has the lean of
    a dome, and the table brings the torch nearly upright."""
    words = ",".join(f"{name} ([-.\\d]+)" for name in ("X", "Y", "Z", "A", "B", "C", "E1", "E2"))
    rows = np.array(re.findall(rf"LIN \{{{words}\}}", text), dtype=float)
    assert len(rows) > 200 and np.ptp(rows[:, 7]) > 300.0
    chain = PyKDL.Chain()
    for joint in json.loads((external.MECHANISMS / f"{TABLE}.json").read_text(encoding="utf-8"))[
        "joints"
    ]:
        chain.addSegment(PyKDL.Segment(PyKDL.Joint(), PyKDL.Frame(PyKDL.Vector(*joint["origin"]))))
        axis = PyKDL.Joint("", PyKDL.Vector(), PyKDL.Vector(*joint["axis"]), PyKDL.Joint.RotAxis)
        chain.addSegment(PyKDL.Segment(axis, PyKDL.Frame()))
    solver, angles, leaning = PyKDL.ChainFkSolverPos_recursive(chain), PyKDL.JntArray(2), []
    for row in rows:
        for k in (0, 1):
            angles[k] = math.radians(row[6 + k])
        table = PyKDL.Frame()
        solver.JntToCart(angles, table)
        a, b, c = np.radians(row[3:6])
        torch = table.M * PyKDL.Rotation.RPY(c, b, a)
        leaning.append(math.degrees(math.acos(max(-1.0, min(1.0, -torch.UnitZ()[2])))))
    assert max(leaning) <= LEANS + 0.01
    in_part = [
        math.degrees(math.acos(-PyKDL.Rotation.RPY(c, b, a).UnitZ()[2]))
        for c, b, a in np.radians(rows[:, 5:2:-1])
    ]
    assert max(in_part) > 40.0  # in the first file, so the table does turn
