# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the macro interface writes into files, and gives other workbenches."""

from __future__ import annotations

import math
from typing import Any

from ..core.issues import InputError, Text
from ..core.one_thread import one_thread
from ..posts import written
from .arguments import checked_number, checked_target
from .steps import checked_stage, one_step


@one_thread()
def export(program: Any, folder: str) -> list[str]:
    """Write the files of a program, or the figures of an inspection, into a folder, which is made; the paths.

    Parts that an earlier, longer program of this name has left there are removed. `am.export(doc.Program, "out")`
    """
    folder = checked_target(folder, "folder")
    kind = checked_stage(program).kind
    if kind == "inspection":
        from ..objects.inspection import files_of_figures as files_of
    elif kind == "program":
        from ..objects.program import files_of
    else:
        raise InputError(
            "WRONG_KIND", program.Label, "it is neither a program nor an inspection; choose one"
        )
    files = files_of(program)
    try:
        return written.write(folder, files)
    except OSError as error:
        message = Text("{}; choose a writable folder", error.strerror or error)
        raise InputError("NOT_WRITABLE", error.filename or folder, message) from None


@one_thread()
def export_wires(obj: Any, path: str, *, rapids: bool = False) -> str:
    """Write beads, and the rapid moves if wanted, of a toolpath, joint path or program as wires into a STEP or DXF file.

    `am.export_wires(doc.JointPath, "path.step", rapids=True)`
    """
    from ..interop import export as interop

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_wires(obj, path, rapids)


def export_cell(cell: Any, path: str) -> str:
    """Write a cell into a file of its own, which jobs name: `cell: my-cell.yaml`.

    `am.export_cell(doc.Cell, "my-cell.yaml")`
    """
    from ..interop import export as interop

    path = checked_target(path, "path")
    checked_stage(cell)
    return interop.write_cell(cell, path)


def export_waypoints(obj: Any, path: str) -> str:
    """Write the points of a toolpath, joint path or program as a table, as the commands write waypoints.csv.

    `am.export_waypoints(doc.JointPath, "waypoints.csv")`
    """
    from ..interop import export as interop

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_waypoints(obj, path)


@one_thread()
def export_report(obj: Any, path: str) -> str:
    """Write the report of a toolpath, joint path or program as a page, as the commands write report.html; the path.

    `am.export_report(doc.Program, "report.html")`
    """
    from ..interop import export as interop
    from ..report.of_document import reported

    path = checked_target(path, "path")
    checked_stage(obj)
    return interop.write_page(path, reported(obj), obj.Label)


@one_thread()
def make_cam_path(obj: Any) -> Any:
    """The path of a toolpath, joint path or program as an object of the CAM workbench, to be inspected there; it does not
    follow changes. `am.make_cam_path(doc.JointPath)`"""
    from ..interop import export as interop

    checked_stage(obj)
    with one_step(obj.Document, "CAM path"):
        return interop.add_cam_path(obj)


@one_thread()
def make_trajectory(obj: Any, *, tolerance: float = 0.1, turn: float = 2.0) -> Any:
    """The same as a trajectory of the Robot workbench, thinned: within `tolerance` mm and, for the tool axis, `turn` deg.

    `am.make_trajectory(doc.JointPath, tolerance=0.5)`
    """
    from ..interop import export as interop

    checked_stage(obj)
    tolerance, turn = checked_number(tolerance, "tolerance"), checked_number(turn, "turn")
    with one_step(obj.Document, "Trajectory"):
        return interop.add_trajectory(obj, tolerance, math.radians(turn))
