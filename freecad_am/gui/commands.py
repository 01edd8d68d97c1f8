# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tools of the toolbar and the menu: each opens a panel, whose OK is one call of the macro interface."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from . import icons

_PREFIX = "RoboticAM_"


class Tool:
    """One command. `icon` is also the object it makes; `action` opens what the tool opens."""

    name = ""  # without prefix
    lacking = ""

    def __init__(self, icon: str, text: str, help: str, action: Callable[[], None]) -> None:
        self.icon, self.text, self.help, self.action = icon, text, help, action

    def GetResources(self) -> dict[str, str]:
        """Texts and icon; the macro interface makes the step of undo, not the command.

        With ForEdit FreeCAD asks `IsActive` even while a task panel is open.
        """
        return {
            "Pixmap": icons.path(self.icon), "MenuText": self.text, "ToolTip": self.help, "StatusTip": self.help,
            "CmdType": "AlterDoc NoTransaction ForEdit",
        }

    def IsActive(self) -> bool:
        """There is a document, and no task panel is open; the tooltip says which of them is missing."""
        lacking = ""
        if App.ActiveDocument is None:
            lacking = "First open a part, or make a document."
        elif Gui.Control.activeDialog():
            lacking = "First close the task panel that is open."
        if lacking != self.lacking and self._explain(f"{self.help}. {lacking}" if lacking else self.help):
            self.lacking = lacking
        return not lacking

    def _explain(self, text: str) -> bool:
        """Tell in the tooltip what is missing, which FreeCAD sets once; False while there is no button yet."""
        name = _PREFIX + self.name
        actions = [
            action for action in Gui.getMainWindow().findChildren(QtGui.QAction)
            if name in (action.objectName(), action.data())  # where it stands differs between versions
        ]
        for action in actions:
            action.setToolTip(text)
            action.setStatusTip(text)
        return bool(actions)

    def Activated(self, index: int = 0) -> None:
        """The tool was clicked."""
        self.action()


def register() -> list[str]:
    """Add all commands to FreeCAD; their names in the order of the toolbar."""
    tools = {
        "NewJob": Tool("new_job", "New Job", "Makes all stages for the selected shape, from cell to program", _new_job),
        "Cell": Tool("cell", "Cell…", "Adds a cell: machine, set-up, platform and nozzle", _cell),
        "Feature": Tool("feature", "Feature…", "Takes the selected shape of revolution to be deposited", _feature),
        "WallOnPart": Tool(
            "wall_on_part", "Wall on Part…",
            "Takes the selected faces as a wall to be deposited on the other object that is selected", _wall,
        ),
        "SolidsOnHub": Tool(
            "solids_on_hub", "Solids on Hub…",
            "Takes the selected solids to be deposited on the cylinder or cone that is selected last", _hub,
        ),
        "Toolpath": Tool("toolpath", "Toolpath…", "Cuts a feature into layers and beads", _toolpath),
        "JointPath": Tool("joint_path", "Joint Path…", "Plans the joint values of a toolpath in a cell", _joint_path),
        "Program": Tool("program", "Program…", "Writes the controller's program of a joint path", _program),
    }
    for name, tool in tools.items():
        tool.name = name
        Gui.addCommand(_PREFIX + name, tool)
    return [_PREFIX + name for name in tools]


def _new_job() -> None:
    from . import job_panel, stage_panel

    stage_panel.show(job_panel.JobPanel())


def _open(proxy: Any, title: str) -> None:
    from . import inputs, stage_panel

    stage_panel.show(stage_panel.StagePanel(proxy, title, inputs.of(proxy)))


def _cell() -> None:
    from . import cell_panel, stage_panel

    stage_panel.show(cell_panel.CellPanel())


def _feature() -> None:
    from ..objects.feature import RevolutionFeature

    _open(RevolutionFeature, "Feature")


def _wall() -> None:
    from . import stage_panel, wall_panel

    stage_panel.show(wall_panel.WallPanel())


def _hub() -> None:
    from . import hub_panel, stage_panel

    stage_panel.show(hub_panel.HubPanel())


def _toolpath() -> None:
    from . import stage_panel, toolpath_panel

    stage_panel.show(toolpath_panel.ToolpathPanel())


def _joint_path() -> None:
    from ..objects.joint_path import JointPath

    _open(JointPath, "Joint path")


def _program() -> None:
    from ..objects.program import Program
    from . import inputs, stage_panel, suggestions

    choices = [*inputs.of(Program), inputs.NameChoice(_part_name())]
    panel = stage_panel.StagePanel(Program, "Program", choices)
    post = suggestions.post_for(App.ActiveDocument)
    if post:
        panel.places["program_post"][0].widget.setEditText(post)
    stage_panel.show(panel)


def _part_name() -> str:
    """A first proposal for the program's name, from the part that is deposited."""
    from .. import api

    for obj in App.ActiveDocument.Objects:
        if getattr(getattr(obj, "Proxy", None), "kind", "") == "feature" and obj.Source:
            return api.proposed_name(obj.Source[0].Label)
    return api.proposed_name(App.ActiveDocument.Label)
