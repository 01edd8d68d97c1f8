# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tools of the toolbar and the menu: each opens a panel, whose OK is one call of the macro interface."""

from __future__ import annotations

import html
from collections.abc import Callable

import FreeCAD as App
import FreeCADGui as Gui

from .. import icons
from ..texts.translation import marked, tr
from . import needs, whats_this

_PREFIX = "RoboticAM_"


class Tool:
    """One command. `icon` is also the object it makes; `action` opens what the tool opens; `need` tells what a document
    lacks for it; `beside`: whether it acts beside a task panel that is open."""

    name = ""  # without prefix
    told = ""  # in its tooltip now, below its name

    def __init__(
        self, icon: str, text: str, help: str, action: Callable[[], None], need: needs.Need = needs.document,
        beside: bool = False,
    ) -> None:
        # as written: FreeCAD translates them by the name of the command, and again when the language changes
        self.icon, self.text, self.help, self.action, self.need, self.beside = icon, text, help, action, need, beside

    def GetResources(self) -> dict[str, str]:
        """Texts and icon; the macro interface makes the step of undo, not the command.

        With ForEdit FreeCAD asks `IsActive` even while a task panel is open.
        """
        return {
            "Pixmap": icons.path(self.icon), "MenuText": self.text, "ToolTip": self.help, "StatusTip": self.help,
            "CmdType": "AlterDoc NoTransaction ForEdit", "WhatsThis": whats_this.url(self.name),
        }

    def IsActive(self) -> bool:
        """Whether it can act; the tooltip says what is missing when it cannot."""
        lacking = self.missing()
        help = tr(self.help)
        told = tr("{}. {}").format(help, lacking) if lacking else help
        if told != self.told and self._explain(told):
            self.told = told
        return not lacking

    def missing(self) -> str:
        """What to do first, '' when it can act now."""
        try:
            if App.ActiveDocument is not None and not self.beside and Gui.Control.activeDialog():
                return tr("First close the task panel that is open.")
            return self.need(App.ActiveDocument)
        except (ReferenceError, RuntimeError):  # the document is being closed
            return tr("First open a part, or make a document.")

    def _explain(self, text: str) -> bool:
        """Tell the tool's name in its tooltip, and what is missing, which FreeCAD sets once; False while there is no button
        yet."""
        command = Gui.Command.get(_PREFIX + self.name)
        actions = [] if command is None else command.getAction()
        name, help = html.escape(tr(self.text).rstrip("…")), html.escape(text, quote=False)
        for action in actions:
            action.setToolTip(f"<p><b>{name}</b></p><p>{help}</p>")
            action.setStatusTip(text)
        return bool(actions)

    def Activated(self, index: int = 0) -> None:
        """The tool was clicked, or called by a macro or a shortcut at a moment when it cannot act."""
        lacking = self.missing()
        if lacking:
            App.Console.PrintWarning(tr("{}: {}").format(tr(self.text), lacking) + "\n")
        else:
            self.action()


# In the order of the work; between groups stands a separator. A tool that is in none comes last.
GROUPS = (
    ("OpenPart", "NewJob"),
    ("Cell", "Feature", "WallOnPart", "Solid", "SolidsOnHub", "Curves", "Cladding"),
    ("Toolpath", "JointPath", "SpinMap"),
    ("Path", "Simulate"),
    ("Program", "Plots", "Inspect", "ExportPath"),
    ("NewMachine",),
)


def register() -> list[str]:
    """Add all commands to FreeCAD; their names in the order of the toolbar, with separators."""
    tools = {
        "OpenPart": Tool(
            "open_part", marked("Open Part…"),
            marked("Opens a part or mesh from a file, which may be damaged: it is read in a process of its own"), _open_part,
            needs.nothing,
        ),
        "NewJob": Tool(
            "new_job", marked("New Job…"), marked("Makes all stages for the selected shape, from cell to program"), _new_job,
            needs.part,
        ),
        "Cell": Tool("cell", marked("Cell…"), marked("Adds a cell: machine, set-up, platform and nozzle"), _cell),
        "Feature": Tool(
            "feature", marked("Feature…"), marked("Takes the selected shape of revolution to be deposited"), _feature,
            needs.faces,
        ),
        "WallOnPart": Tool(
            "wall_on_part", marked("Wall on Part…"),
            marked("Takes the selected faces as a wall to be deposited on the other object that is selected"), _wall,
            needs.faces,
        ),
        "Solid": Tool(
            "solid", marked("Solid…"), marked("Takes the selected solids to be deposited in plane layers"), _solid,
            needs.part,
        ),
        "SolidsOnHub": Tool(
            "solids_on_hub", marked("Solids on Hub…"),
            marked("Takes the selected solids to be deposited on the cylinder or cone that is selected last"), _hub,
            needs.part,
        ),
        "Curves": Tool(
            "curves", marked("Curves…"), marked("Takes the selected edges, wires, sketches or tables to be laid as beads"),
            _curves, needs.document,
        ),
        "Cladding": Tool(
            "cladding", marked("Cladding…"), marked("Takes the selected faces to be covered with layers of beads"),
            _cladding, needs.faces,
        ),
        "Toolpath": Tool(
            "toolpath", marked("Toolpath…"), marked("Cuts a feature into layers and beads"), _toolpath, needs.feature
        ),
        "JointPath": Tool(
            "joint_path", marked("Joint Path…"), marked("Plans the joint values of a toolpath in a cell"), _joint_path,
            needs.toolpath_and_cell,
        ),
        "SpinMap": Tool(
            "spin_map", marked("Free Rotation Map…"),
            marked("Shows the path against the rotation about the tool; the curve can be drawn by hand"), _spin_map,
            needs.joint_path, True,
        ),
        "Path": Tool(
            "path", marked("Path"), marked("Shows a toolpath or joint path layer by layer and point by point"), _path,
            needs.path, True,
        ),
        "Simulate": Tool(
            "simulate", marked("Simulate…"), marked("Plays a joint path or program with its machine"), _simulate,
            needs.joint_path, True,
        ),
        "ExportPath": Tool(
            "export_path", marked("Export Path…"),
            marked("Writes a path as STEP or DXF wires, a table or a report, or makes a CAM path or Robot trajectory of it"),
            _export_path, needs.path,
        ),
        "Program": Tool(
            "program", marked("Program…"), marked("Writes the controller's program of a joint path"), _program,
            needs.feasible,
        ),
        "NewMachine": Tool(
            "new_machine", marked("New Machine…"),
            marked("Makes a machine file from a URDF, a Denavit-Hartenberg table or OPW figures, checked against poses"),
            _new_machine, needs.nothing, True,
        ),
        "Inspect": Tool(
            "inspect", marked("Inspect…"), marked("Compares measured points with what was planned"), _inspect, needs.part
        ),
        "Plots": Tool(
            "plots", marked("Plots…"), marked("Plots joints against limits, distances between layers and deposit rates"),
            _plots, needs.path, True,
        ),
    }
    for name, tool in tools.items():
        tool.name = name
        Gui.addCommand(_PREFIX + name, tool)
    return _in_order(list(tools))


def _in_order(names: list[str]) -> list[str]:
    """Commands and separators of a toolbar that has these tools."""
    known = {name for group in GROUPS for name in group}
    found: list[str] = []
    for group in (*GROUPS, tuple(name for name in names if name not in known)):
        there = [_PREFIX + name for name in group if name in names]
        found += ["Separator"] * bool(found and there) + there
    return found


def _open_part() -> None:
    from . import open_part

    open_part.ask()


def _new_job() -> None:
    from ..new_job.panel import JobPanel
    from ..panels.stage import show

    show(JobPanel())


def _export_path() -> None:
    from ..panels.stage import show
    from .export_path import ExportPanel

    show(ExportPanel())


def _cell() -> None:
    from ..panels.cell import CellPanel
    from ..panels.stage import show

    show(CellPanel())


def _feature() -> None:
    from ..panels.feature import FeaturePanel
    from ..panels.stage import show

    show(FeaturePanel())


def _wall() -> None:
    from ..panels.stage import show
    from ..panels.wall import WallPanel

    show(WallPanel())


def _solid() -> None:
    from ..panels.solid import SolidPanel
    from ..panels.stage import show

    show(SolidPanel())


def _curves() -> None:
    from ..panels.curves import CurvesPanel
    from ..panels.stage import show

    show(CurvesPanel())


def _cladding() -> None:
    from ..panels.cladding import CladdingPanel
    from ..panels.stage import show

    show(CladdingPanel())


def _hub() -> None:
    from ..panels.hub import HubPanel
    from ..panels.stage import show

    show(HubPanel())


def _toolpath() -> None:
    from ..panels.stage import show
    from ..panels.toolpath import ToolpathPanel

    show(ToolpathPanel())


def _joint_path() -> None:
    from ..panels.joint_path import JointPathPanel
    from ..panels.stage import show

    show(JointPathPanel())


def _spin_map() -> None:
    from ..spin_map import tool

    tool.spin_map()


def _path() -> None:
    from ..path import dock

    dock.show()


def _simulate() -> None:
    from ..simulation import tool

    tool.simulate()


def _program() -> None:
    from ..panels.program import ProgramPanel
    from ..panels.stage import show

    show(ProgramPanel())


def _new_machine() -> None:
    from ..machine_wizard import wizard

    wizard.show()


def _inspect() -> None:
    from ..inspection import panel

    panel.inspect()


def _plots() -> None:
    from ..plots import dock

    dock.show()
