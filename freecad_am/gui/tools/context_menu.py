# SPDX-License-Identifier: LGPL-2.1-or-later
"""Context menu entries in the tree for a stage or a whole job."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ... import api
from ...core.issues import AmError
from ...objects.fields import saved_cells
from ...objects.job_group import stages_in
from ...objects.stage import stage_of
from ...objects.staleness import UP_TO_DATE
from ...objects.work.progress import Cancelled
from .. import recorded, registry
from ..in_language import error_line, escape_mnemonic, tr

Act = Callable[[], Any]
_NAME = "RoboticAM_Menu"
# tools that create the next stage from a suitable stage
_MAKE_NEXT = ("Toolpath", "JointPath", "Program")


def add_stage_entries(menu: Any, obj: Any) -> None:
    """Add the entries of a stage: edit, renew, go to its inputs, and more by kind."""
    from .. import program_window

    kind = obj.Proxy.kind
    if kind == "program":
        _add(
            menu,
            "ReadProgram",
            tr("Read the program…"),
            lambda: program_window.show(obj),
            bool(obj.Key),
        )
        _add(menu, "EditProgram", tr("Edit parameters…"), lambda: registry.edit(obj))
        _add(menu, "ExportProgram", tr("Export files…"), lambda: _export(obj), bool(obj.Key))
    else:
        _add(menu, "Edit", tr("Edit…"), lambda: registry.edit(obj))
    fits = obj.Status == UP_TO_DATE
    _add(menu, "Renew", tr("Compute again") if fits else tr("Renew"), lambda: renew(obj, fits))
    if kind == "cell":
        _add(menu, "SaveCell", tr("Save cell…"), lambda: _save_cell(obj))
    if kind in ("joint path", "program"):
        _add(menu, "Simulate", tr("Simulate…"), lambda: _simulate(obj), bool(obj.Key))
    for tool, text in _next_tools(kind):
        _add_tool_entry(menu, tool, text, obj, fits if tool in _MAKE_NEXT else bool(obj.Key))
    if kind in ("toolpath", "joint path", "program"):
        _add(menu, "ExportReport", tr("Export report…"), lambda: _report(obj), bool(obj.Key))
    _add_inputs(menu, obj)
    path = (
        obj.JointPath if kind == "program" else obj if kind in ("toolpath", "joint path") else None
    )
    if path is not None:
        _add(menu, "ShowPath", tr("Show path layer by layer"), lambda: _show_path(path))


def _next_tools(kind: str) -> list[tuple[str, str]]:
    """Return toolbar tools for a stage of this kind, in toolbar order."""
    return {
        "feature": [
            ("Toolpath", tr("Cut into layers…")),
            ("Inspect", tr("Compare with measured points…")),
        ],
        "toolpath": [
            ("JointPath", tr("Plan joint path…")),
            ("Placement", tr("Placement…")),
            ("Plots", tr("Plots…")),
            ("Inspect", tr("Compare with measured points…")),
            ("ExportPath", tr("Export path…")),
        ],
        "joint path": [
            ("SpinMap", tr("Map of the free rotation…")),
            ("Placement", tr("Placement…")),
            ("Program", tr("Write program…")),
            ("Plots", tr("Plots…")),
            ("ExportPath", tr("Export path…")),
        ],
        "program": [("Plots", tr("Plots…"))],
    }.get(kind, [])


def add_job_entries(menu: Any, group: Any) -> None:
    """Add the entries of a whole job."""
    stages = stages_in(group)
    _add(
        menu,
        "RenewJob",
        tr("Renew"),
        lambda: _renew_all(stages),
        any(obj.Status != UP_TO_DATE for obj in stages),
    )
    paths = [obj for obj in stages if obj.Proxy.kind == "joint path" and obj.Key]
    _add(menu, "Simulate", tr("Simulate…"), lambda: _simulate(paths[-1]), bool(paths))
    if paths:
        _add_tool_entry(menu, "Plots", tr("Plots…"), paths[-1], True)
    _add(menu, "Shown", tr("Show this job only"), lambda: show_alone(group))


def renew(obj: Any, force: bool = False) -> None:
    """Renew a stage and its inputs; the report view and the status show problems."""
    text = ", force=True" if force else ""
    Gui.doCommand(recorded.IMPORT)
    try:
        Gui.doCommand(f"am.recompute({recorded.reference(obj)}{text})")
    except AmError as error:
        App.Console.PrintError(error_line(error))
    except Cancelled:
        App.Console.PrintWarning(tr("{}: cancelled").format(obj.Label) + "\n")


def show_alone(group: Any) -> None:
    """Show the last path and the cell of a job, hide all other stages, and fit the view."""
    stages = stages_in(group)
    paths = [obj for obj in stages if obj.Proxy.kind in ("toolpath", "joint path") and obj.Key]
    visible_names = {obj.Name for obj in stages if obj.Proxy.kind == "cell"} | {
        obj.Name for obj in paths[-1:]
    }
    for obj in api.stages_of(group.Document):
        obj.ViewObject.Visibility = obj.Name in visible_names
    Gui.SendMsgToActiveView("ViewFit")


def _renew_all(stages: list[Any]) -> None:
    for obj in sorted(stages, key=lambda obj: len(obj.OutListRecursive)):
        renew(obj)


def _add(menu: Any, name: str, text: str, act: Act, on: bool = True) -> None:
    action = menu.addAction(escape_mnemonic(text))
    action.setObjectName(f"{_NAME}{name}")
    action.setEnabled(on)
    action.triggered.connect(lambda *_: act())


def _add_inputs(menu: Any, obj: Any) -> None:
    """Add an entry for each input, which selects the input and shows it in the tree."""
    inputs: dict[str, Any] = {}
    for link in obj.Proxy.links:
        value = getattr(obj, link.name)
        for source in (
            value if isinstance(value, list) else [value[0] if isinstance(value, tuple) else value]
        ):
            if source is not None:
                inputs[source.Name] = source
    if inputs:
        menu.addSeparator()
    for source in inputs.values():
        _add(
            menu,
            f"Input_{source.Name}",
            tr("Go to {}").format(source.Label),
            lambda source=source: go_to(source),
        )


def go_to(obj: Any) -> None:
    """Select and show an object, and scroll the tree to it."""
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(obj.Document.Name, obj.Name)
    Gui.runCommand("Std_TreeSelection")
    if stage_of(obj) is None:
        obj.ViewObject.Visibility = True


def _add_tool_entry(menu: Any, name: str, text: str, obj: Any, on: bool) -> None:
    """Add an entry that applies a toolbar tool to an object; `on` enables it."""
    command = Gui.Command.get(f"RoboticAM_{name}")
    _add(
        menu,
        name,
        text,
        lambda: _tool(name, obj),
        on and command is not None and command.isActive(),
    )


def _tool(name: str, obj: Any) -> None:
    """Run a toolbar tool on an object."""
    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(obj.Document.Name, obj.Name)
    Gui.runCommand(f"RoboticAM_{name}")


def _show_path(path: Any) -> None:
    from ..path import dock

    dock.show(path)


def _simulate(obj: Any) -> None:
    from ..simulation.dock import simulate_object

    simulate_object(obj)


def _export(obj: Any) -> None:
    from .. import program_window

    program_window.export(obj)


def _save_cell(obj: Any) -> None:
    """Ask for a file and write the cell into it. The default folder is the one that New Job
    searches for cells.
    """
    default_path = saved_cells.path_of(os.path.join(saved_cells.own_folder(), obj.Label))
    with contextlib.suppress(OSError):  # writing the file reports the error
        os.makedirs(os.path.dirname(default_path), exist_ok=True)
    path, _ = QtGui.QFileDialog.getSaveFileName(
        Gui.getMainWindow(), tr("Save cell"), default_path, f"{tr('Cells')} {saved_cells.PATTERN}"
    )
    if not path:
        return
    path = saved_cells.path_of(path)
    Gui.doCommand(recorded.IMPORT)
    try:
        Gui.doCommand(f"am.export_cell({recorded.reference(obj)}, {path!r})")
    except AmError as error:
        App.Console.PrintError(error_line(error))


def _report(obj: Any) -> None:
    from ..panels.stage import show
    from .export_path import REPORT, ExportPanel

    Gui.Selection.clearSelection()
    Gui.Selection.addSelection(obj.Document.Name, obj.Name)
    show(ExportPanel(REPORT))
