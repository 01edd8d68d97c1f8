# SPDX-License-Identifier: LGPL-2.1-or-later
"""The machine in the 3D view: drawn at PyKDL's pose, hidden and shown by clicks, and drawn from a
user's own files."""

import json
from pathlib import Path

import FreeCAD as App
import Mesh
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.core.geometry import frames
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.simulation.table_links import at_rest
from freecad_am.gui.nodes.cell import resting_point
from freecad_am.kdl import KdlArm


def matrix(transform):
    """Return the pose (4, 4) of a transformation node in the scene."""
    return np.array(transform.matrix.getValue().getValue()).T


def shown_menu(person, vobj):
    menu = person.widgets.QMenu()
    vobj.Proxy.setupContextMenu(vobj, menu)
    return {action.objectName(): action for action in menu.actions()}, menu


MACHINES = {
    "robot": {},
    "tool": {"setup": "tool-on-robot", "deposition_point": (900, 0, -100, 0, 0, 0)},
    "kuka": {"machine": "kuka-kr16-2", "deposition_point": (1100, 0, 600, 0, 0, 0)},
    "trunnion": {"machine": "table-xyzac", "setup": "rotary-table"},
    "head": {"machine": "head-table-xyzbc", "setup": "rotary-table"},
    "two_heads": {"machine": "head-xyzab", "setup": "rotary-table"},
}


@pytest.mark.parametrize("name", MACHINES)
def test_machines_are_drawn_where_pykdl_puts_them(person, hemisphere, name):
    doc = hemisphere.Document
    cell = api.make_cell(doc, **MACHINES[name])
    feature = api.make_feature(doc, hemisphere, layer_height=5)
    toolpath = api.make_toolpath(doc, feature, cell)
    view = cell.ViewObject.Proxy
    assert view.nodes.links.getNumChildren() == 0 and view.nodes.machine is None
    actions, _menu = shown_menu(person, cell.ViewObject)
    assert actions["RoboticAM_ShowMachine"].text() == "Show machine"
    actions["RoboticAM_ShowMachine"].trigger()
    person.look()
    person.screenshot(f"machine_{name}")
    planned, value = api.result(toolpath), api.result(cell)
    resolved = cells.resolve(value, planned.frame)
    q = at_rest(resolved, resting_point(planned, planned.frame))
    flange = KdlArm(resolved.machine).forward([q])[0]
    base, flange_link = (
        matrix(view.nodes.machine.transforms[0]),
        matrix(view.nodes.machine.transforms[-1]),
    )
    drawn = frames.inverse(base) @ flange_link @ resolved.machine.chain.flange
    assert np.abs(drawn - flange).max() < 2e-3  # Coin keeps floats of 24 bits
    if resolved.setup != "tool-on-robot":  # the part is on the flange: it has not moved
        part_frame = base @ flange @ resolved.poses.carried @ frames.inverse(resolved.poses.mount)
        assert np.abs(part_frame - np.eye(4)).max() < 2e-3
    actions, _menu = shown_menu(person, cell.ViewObject)
    assert actions["RoboticAM_ShowMachine"].text() == "Hide machine"
    actions["RoboticAM_ShowMachine"].trigger()
    assert view.nodes.machine is None and view.nodes.links.getNumChildren() == 0


def test_a_machine_that_is_shown_is_there_when_the_document_is_opened_again(person, hemisphere):
    doc = hemisphere.Document
    cell = api.make_cell(doc)
    cell.ViewObject.ShowMachine = True
    poses = [matrix(transform) for transform in cell.ViewObject.Proxy.nodes.machine.transforms]
    path = str(person.folder / "cell.FCStd")
    doc.saveAs(path)
    name = cell.Name
    App.closeDocument(doc.Name)
    person.idle(0.3)
    again = App.openDocument(path).getObject(name)
    person.idle(0.5)
    assert again.ViewObject.ShowMachine
    drawn = [matrix(transform) for transform in again.ViewObject.Proxy.nodes.machine.transforms]
    assert np.abs(np.array(drawn) - np.array(poses)).max() < 1e-3
    assert again.Status == "up to date"


@pytest.fixture
def own_machine(tmp_path):
    """Return a copy of a machine file with a STEP for the base, an STL in m for link 2, and a
    missing file for link 3."""
    content = json.loads(
        (machines.BUILT_IN / "fanuc-arcmate120ic.json").read_text(encoding="utf-8")
    )
    content["id"], folder = "mine", Path(tmp_path)
    Part.makeBox(600, 600, 300, App.Vector(-300, -300, 0)).exportStep(str(folder / "base.step"))
    Mesh.createBox(0.3, 0.3, 0.9).write(str(folder / "arm.stl"))
    content["shapes"] = {
        "base": {"file": "base.step", "colour": [0.1, 0.2, 0.9]},
        "joint_2": {"file": "arm.stl", "scale": 1000, "origin": [0, 0, 400], "rpy": [0, 0, 0]},
        "joint_3": {"file": "not_there.stl"},
    }
    (folder / "mine.json").write_text(json.dumps(content), encoding="utf-8")
    return str(folder / "mine.json")


def test_a_users_files_are_drawn_and_a_missing_one_is_told(person, own_machine):
    doc = App.newDocument("Own")
    cell = api.make_cell(doc, machine=own_machine)
    cell.ViewObject.ShowMachine = True
    person.look()
    person.screenshot("machine_own_files")
    messages = [line for line in person.console().splitlines() if "NO_FILE" in line]
    assert any("shapes.joint_3.file" in line and "plain solid" in line for line in messages)
    materials = cell.ViewObject.Proxy.nodes.machine.materials
    assert [len(link_parts) > 1 for link_parts in materials[:4]] == [False, True, False, True]
    assert np.allclose(materials[0][0][1], (0.1, 0.2, 0.9))
    view = person.gui.activeDocument().activeView()
    path = str(person.folder / "own.png")
    view.saveImage(path, 600, 450, "White")
    image = person.widgets.QImage(path)
    colours = [image.pixelColor(x, y) for x in range(0, 600, 3) for y in range(0, 450, 3)]
    assert sum(colour.blue() > colour.red() + 60 for colour in colours) > 100
