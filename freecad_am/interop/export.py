# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the macro interface offers of this package: files of wires, and paths of other workbenches."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Sequence
from typing import Any

from ..core.issues import InputError
from ..core.parameters.cell import CellParameters
from ..core.simulation import waypoints
from ..objects.current import check_recomputed
from ..objects.work import hooks
from . import cam_path, cell_file, dxf, robot_trajectory, step_wires
from .lines import Line
from .source import lines_of, motion_of

STEP, DXF, CELL, PAGE = (".step", ".stp"), (".dxf",), (".yaml", ".yml"), ".html"


def write_wires(obj: Any, path: str, rapids: bool) -> str:
    """Write the lines of a stage as STEP or DXF, whichever the path ends in; the path. The file appears whole or not at all.

    Raises InputError UNSUPPORTED_FILE, NO_FOLDER, NOT_WRITABLE, and what `lines_of` raises.
    """
    ending = os.path.splitext(path)[1].lower()
    if ending not in STEP + DXF:
        raise InputError(
            "UNSUPPORTED_FILE",
            path,
            "wires are written as .step or .dxf; use one of these extensions",
        )
    lines = lines_of(obj, rapids)
    return _whole(path, lambda unfinished: _write(lines, unfinished, ending, obj.Label))


def write_waypoints(obj: Any, path: str) -> str:
    """Write the points of a toolpath, joint path, or a program's joint path as the commands write waypoints.csv; the path.
    The file appears whole or not at all.

    Raises InputError UNSUPPORTED_FILE, NO_FOLDER, NOT_WRITABLE, and what `motion_of` raises.
    """
    if os.path.splitext(path)[1].lower() != ".csv":
        raise InputError(
            "UNSUPPORTED_FILE", path, "waypoints are written as .csv; use this extension"
        )
    motion, columns, units = motion_of(obj)

    def write(unfinished: str) -> None:
        with open(unfinished, "w", encoding="ascii", newline="") as stream:
            stream.writelines(waypoints.text(motion, columns, units))

    return _whole(path, write)


def write_page(path: str, page: Callable[[], str], title: str) -> str:
    """Write a page that takes a while to make, without the document; the path. The file appears whole or not at all.

    Raises InputError UNSUPPORTED_FILE, NO_FOLDER, NOT_WRITABLE; in the window Cancelled.
    """
    if os.path.splitext(path)[1].lower() != PAGE:
        raise InputError(
            "UNSUPPORTED_FILE", path, "reports are written as .html; use the extension .html"
        )

    def write(unfinished: str) -> None:
        text = hooks.carry_out(page, title, "making the report")
        with open(unfinished, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)

    return _whole(path, write)


def write_cell(obj: Any, path: str) -> str:
    """Write a cell as the file that jobs name; the path. The file appears whole or not at all.

    Raises InputError UNSUPPORTED_FILE, NO_FOLDER, NOT_WRITABLE, NO_RESULT where an expression of it waits for a recompute, and
    for what is not a cell.
    """
    if os.path.splitext(path)[1].lower() not in CELL:
        raise InputError(
            "UNSUPPORTED_FILE", path, "cells are written as .yaml; use the extension .yaml"
        )
    if getattr(getattr(obj, "Proxy", None), "kind", "") != "cell":
        raise InputError("WRONG_KIND", obj.Label, "this is not a cell; choose one")
    check_recomputed(obj)
    saved = cell_file.text(
        obj.Proxy.parameters(obj, CellParameters), os.path.dirname(os.path.abspath(path))
    )

    def write(unfinished: str) -> None:
        with open(unfinished, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(saved)

    return _whole(path, write)


def _whole(path: str, write: Callable[[str], None]) -> str:
    """Let a file be written beside, and put it in its place; the path."""
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise InputError(
            "NO_FOLDER", path, "the folder {} does not exist; create it, or choose another", folder
        )
    try:
        with tempfile.TemporaryDirectory(prefix=".unfinished-", dir=folder) as temporary:
            unfinished = os.path.join(temporary, f"file{os.path.splitext(path)[1].lower()}")
            write(unfinished)
            os.replace(unfinished, path)
    except OSError as error:
        raise InputError(
            "NOT_WRITABLE", path, "{}; choose a writable file", error.strerror or error
        ) from None
    return path


def add_cam_path(obj: Any) -> Any:
    """The lines of a stage as a path of the CAM workbench, in its document."""
    return cam_path.add(obj.Document, lines_of(obj), f"{obj.Label} (CAM)")


def add_trajectory(obj: Any, tolerance: float, turn: float) -> Any:
    """The lines of a stage as a trajectory of the Robot workbench, in its document: within `tolerance` mm and `turn` rad."""
    for name, value in (("tolerance", tolerance), ("turn", turn)):
        if not value > 0.0:
            raise InputError(
                "OUT_OF_RANGE", name, "{:g} is not positive; give a larger value", value
            )
    return robot_trajectory.add(
        obj.Document, lines_of(obj), f"{obj.Label} (trajectory)", tolerance, turn
    )


def _write(lines: Sequence[Line], path: str, ending: str, label: str) -> None:
    if ending in STEP:
        step_wires.write(lines, path, label)
        if not os.path.isfile(path):
            raise InputError(
                "NOT_WRITTEN",
                label,
                "FreeCAD wrote no STEP file; see the report view, or use DXF instead",
            )
    else:
        with open(path, "w", encoding="ascii", newline="") as stream:
            stream.writelines(dxf.text(lines))
