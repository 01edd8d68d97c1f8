# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tools of toolbar and menu. Each opens a panel, whose OK is one call of the macro interface."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...core.issues import AmError
from ...objects.shapes.part_file import PART_FILES
from ...objects.work.progress import Cancelled
from .. import recorded
from ..families.registry import feature_windows
from ..in_language import error_line, marked, tr, translated_error
from . import whats_this
from .freecad_am import add_command
from .tool import PREFIX, Tool

# ---- Actions of the tools. Panels and docks are imported when first opened, so that the workbench starts
# faster

ENDINGS = PART_FILES


def ask() -> None:
    """Ask for a file and open it."""
    document = App.ActiveDocument
    folder = (
        os.path.dirname(document.FileName) if document is not None and document.FileName else ""
    )
    endings = " ".join(f"*{ending} *{ending.upper()}" for ending in ENDINGS)
    kinds = tr("Parts, meshes and tables of points ({})").format(endings)
    path, _ = QtGui.QFileDialog.getOpenFileName(Gui.getMainWindow(), tr("Open part"), folder, kinds)
    if path:
        opened(path)


def opened(path: str) -> Any:
    """Open a part in the active or a new document, select and show it.

    Return None if the part is rejected, which is reported, or the user cancels.
    """
    is_new = App.ActiveDocument is None
    if is_new:
        Gui.doCommand("App.newDocument()")
    document = App.ActiveDocument
    old_names = {obj.Name for obj in document.Objects}
    try:
        recorded.make(document, "open_part", {"path": repr(path)})
    except (AmError, Cancelled) as error:
        if is_new:
            App.closeDocument(document.Name)
        if isinstance(error, AmError):
            App.Console.PrintError(error_line(error))
            QtGui.QMessageBox.warning(Gui.getMainWindow(), tr("Open part"), translated_error(error))
        return None
    opened_part = next(obj for obj in document.Objects if obj.Name not in old_names)
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(document.Name, opened_part.Name)
    view = Gui.activeDocument().activeView()
    if is_new and hasattr(view, "viewIsometric"):
        view.viewIsometric()
    Gui.SendMsgToActiveView("ViewFit")
    return opened_part


def open_part() -> None:
    """Ask for a part file."""

    ask()


def new_job() -> None:
    """Open the panel of a new job."""
    from ..panels.new_job import JobPanel
    from ..panels.stage import show

    show(JobPanel())


def export_path() -> None:
    """Open the panel that exports a path."""
    from ..panels.stage import show
    from .export_path import ExportPanel

    show(ExportPanel())


def cell() -> None:
    """Open the panel of a new cell."""
    from ..panels.cell import CellPanel
    from ..panels.stage import show

    show(CellPanel())


def toolpath() -> None:
    """Open the panel of a new toolpath."""
    from ..panels.stage import show
    from ..panels.toolpath import ToolpathPanel

    show(ToolpathPanel())


def joint_path() -> None:
    """Open the panel of a new joint path."""
    from ..panels.joint_path import JointPathPanel
    from ..panels.stage import show

    show(JointPathPanel())


def redundancy_map() -> None:
    """Open the map of a joint path."""
    from ..redundancy_map import dock

    dock.redundancy_map()


def placement() -> None:
    """Open the placement dock."""
    from ..placement import dock

    dock.placement()


def path() -> None:
    """Open the path dock."""
    from ..path import dock

    dock.show()


def infill() -> None:
    """Open the infill dock."""
    from ..path import infill_dock

    infill_dock.show()


def simulate() -> None:
    """Open the simulation dock."""
    from ..simulation import dock

    dock.simulate()


def program() -> None:
    """Open the panel of a new program."""
    from ..panels.program import ProgramPanel
    from ..panels.stage import show

    show(ProgramPanel())


def new_machine() -> None:
    """Open the wizard for a new machine."""
    from ..machine_wizard import wizard

    wizard.show()


def inspect() -> None:
    """Open the panel of an inspection."""
    from ..inspection import panel

    panel.inspect()


def plots() -> None:
    """Open the plots dock."""
    from ..plots import dock

    dock.show()


# ---- All tools

# In workflow order, with a separator between groups. Other tools come last.
GROUPS = (
    ("OpenPart", "NewJob"),
    ("Cell", *(name for window in feature_windows() for name in window.tools())),
    ("Toolpath", "JointPath", "SpinMap", "Placement"),
    ("Path", "Infill", "Simulate"),
    ("Program", "Plots", "Inspect", "ExportPath"),
    ("NewMachine",),
)
TOOLS = {
    "OpenPart": Tool(
        "open_part",
        marked("Open Part…"),
        marked(
            "Opens a part or mesh from a file in a separate process, even if the file is damaged"
        ),
        open_part,
        whats_this.nothing,
    ),
    "NewJob": Tool(
        "new_job",
        marked("New Job…"),
        marked("Creates all stages for the selected shape, from cell to program"),
        new_job,
        whats_this.part,
    ),
    "Cell": Tool(
        "cell",
        marked("Cell…"),
        marked("Adds a cell: machine, setup, platform and nozzle"),
        cell,
    ),
    **{name: tool for window in feature_windows() for name, tool in window.tools().items()},
    "Toolpath": Tool(
        "toolpath",
        marked("Toolpath…"),
        marked("Cuts a feature into layers and beads"),
        toolpath,
        whats_this.feature,
    ),
    "JointPath": Tool(
        "joint_path",
        marked("Joint Path…"),
        marked("Plans the joint values of a toolpath in a cell"),
        joint_path,
        whats_this.toolpath_and_cell,
    ),
    "SpinMap": Tool(
        "spin_map",
        marked("Free Rotation Map…"),
        marked("Shows the path and the tool rotation as a map; the curve can be edited by hand"),
        redundancy_map,
        whats_this.joint_path,
        True,
    ),
    "Placement": Tool(
        "placement",
        marked("Placement…"),
        marked(
            "Searches for positions of the part, its positioner or the deposition point, and "
            "shows the workspace of the robot"
        ),
        placement,
        whats_this.toolpath_and_cell,
        True,
    ),
    "Path": Tool(
        "path",
        marked("Path"),
        marked("Shows a toolpath or joint path layer by layer and point by point"),
        path,
        whats_this.path,
        True,
    ),
    "Infill": Tool(
        "infill",
        marked("Infill"),
        marked("Shows voids and double deposit of any layer of a solid over its section"),
        infill,
        whats_this.path,
        True,
    ),
    "Simulate": Tool(
        "simulate",
        marked("Simulate…"),
        marked("Plays a joint path or program with its machine"),
        simulate,
        whats_this.joint_path,
        True,
    ),
    "ExportPath": Tool(
        "export_path",
        marked("Export Path…"),
        marked(
            "Writes a path as STEP or DXF wires, a table or a report, or converts it to a CAM "
            "path or Robot trajectory"
        ),
        export_path,
        whats_this.path,
    ),
    "Program": Tool(
        "program",
        marked("Program…"),
        marked("Writes the controller program for a joint path"),
        program,
        whats_this.feasible,
    ),
    "NewMachine": Tool(
        "new_machine",
        marked("New Machine…"),
        marked(
            "Creates a machine file from a URDF, a Denavit-Hartenberg table or OPW dimensions, "
            "checked against poses"
        ),
        new_machine,
        whats_this.nothing,
        True,
    ),
    "Inspect": Tool(
        "inspect",
        marked("Inspect…"),
        marked("Compares measured points with the plan"),
        inspect,
        whats_this.part,
    ),
    "Plots": Tool(
        "plots",
        marked("Plots…"),
        marked("Plots joints against limits, distances between layers and deposit rates"),
        plots,
        whats_this.path,
        True,
    ),
}


def register() -> list[str]:
    """Add all commands to FreeCAD; return their names in toolbar order, with separators."""
    for name, tool in TOOLS.items():
        tool.name = name
        add_command(PREFIX + name, tool)
    return _in_order(list(TOOLS))


def _in_order(names: list[str]) -> list[str]:
    """Return commands and separators of a toolbar with these tools."""
    grouped = {name for group in GROUPS for name in group}
    entries: list[str] = []
    for group in (*GROUPS, tuple(name for name in names if name not in grouped)):
        tools = [PREFIX + name for name in group if name in names]
        entries += ["Separator"] * bool(entries and tools) + tools
    return entries
