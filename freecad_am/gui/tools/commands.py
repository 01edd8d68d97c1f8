# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tools of the toolbar and the menu: each opens a panel, whose OK is one call of the macro interface."""

from __future__ import annotations

from ..families.registry import feature_windows
from ..in_language import marked
from . import openers, whats_this
from .freecad_am import add_command
from .tool import PREFIX, Tool

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
        marked("Opens a part or mesh from a file in a separate process, even if it is damaged"),
        openers.open_part,
        whats_this.nothing,
    ),
    "NewJob": Tool(
        "new_job",
        marked("New Job…"),
        marked("Creates all stages for the selected shape, from cell to program"),
        openers.new_job,
        whats_this.part,
    ),
    "Cell": Tool(
        "cell",
        marked("Cell…"),
        marked("Adds a cell: machine, setup, platform and nozzle"),
        openers.cell,
    ),
    **{name: tool for window in feature_windows() for name, tool in window.tools().items()},
    "Toolpath": Tool(
        "toolpath",
        marked("Toolpath…"),
        marked("Cuts a feature into layers and beads"),
        openers.toolpath,
        whats_this.feature,
    ),
    "JointPath": Tool(
        "joint_path",
        marked("Joint Path…"),
        marked("Plans the joint values of a toolpath in a cell"),
        openers.joint_path,
        whats_this.toolpath_and_cell,
    ),
    "SpinMap": Tool(
        "spin_map",
        marked("Free Rotation Map…"),
        marked("Shows the path and the tool rotation as a map; the curve can be edited by hand"),
        openers.redundancy_map,
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
        openers.placement,
        whats_this.toolpath_and_cell,
        True,
    ),
    "Path": Tool(
        "path",
        marked("Path"),
        marked("Shows a toolpath or joint path layer by layer and point by point"),
        openers.path,
        whats_this.path,
        True,
    ),
    "Infill": Tool(
        "infill",
        marked("Infill"),
        marked("Shows voids and double deposit of any layer of a solid over its section"),
        openers.infill,
        whats_this.path,
        True,
    ),
    "Simulate": Tool(
        "simulate",
        marked("Simulate…"),
        marked("Plays a joint path or program with its machine"),
        openers.simulate,
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
        openers.export_path,
        whats_this.path,
    ),
    "Program": Tool(
        "program",
        marked("Program…"),
        marked("Writes the controller program for a joint path"),
        openers.program,
        whats_this.feasible,
    ),
    "NewMachine": Tool(
        "new_machine",
        marked("New Machine…"),
        marked(
            "Creates a machine file from a URDF, a Denavit-Hartenberg table or OPW dimensions, "
            "checked against poses"
        ),
        openers.new_machine,
        whats_this.nothing,
        True,
    ),
    "Inspect": Tool(
        "inspect",
        marked("Inspect…"),
        marked("Compares measured points with the plan"),
        openers.inspect,
        whats_this.part,
    ),
    "Plots": Tool(
        "plots",
        marked("Plots…"),
        marked("Plots joints against limits, distances between layers and deposit rates"),
        openers.plots,
        whats_this.path,
        True,
    ),
}


def register() -> list[str]:
    """Add all commands to FreeCAD; their names in the order of the toolbar, with separators."""
    for name, tool in TOOLS.items():
        tool.name = name
        add_command(PREFIX + name, tool)
    return _in_order(list(TOOLS))


def _in_order(names: list[str]) -> list[str]:
    """Commands and separators of a toolbar that has these tools."""
    grouped = {name for group in GROUPS for name in group}
    entries: list[str] = []
    for group in (*GROUPS, tuple(name for name in names if name not in grouped)):
        tools = [PREFIX + name for name in group if name in names]
        entries += ["Separator"] * bool(entries and tools) + tools
    return entries
