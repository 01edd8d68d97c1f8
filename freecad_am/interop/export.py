# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the macro interface offers of this package: files of wires, and paths of other workbenches."""

from __future__ import annotations

import dataclasses
import json
import math
import os
import tempfile
from collections.abc import Callable, Sequence
from typing import Any

import FreeCAD as App
import numpy as np

from ..core.geometry.frames import pose
from ..core.issues import InputError
from ..core.kinematics.arrangement import arrangement_of
from ..core.kinematics.machines import calibration, machine
from ..core.kinematics.urdf import reference as urdf_reference
from ..core.motion import Motion
from ..core.parameters import field as f
from ..core.parameters.cell import CellParameters
from ..core.simulation import timeline, waypoints
from ..objects import user_machines
from ..objects.current import check_current, check_recomputed
from ..objects.stage import stage_of
from ..objects.work import hooks
from .lines import (
    Line,
    attitudes,
    dxf_text,
    lines_of_motion,
    lines_of_toolpath,
    thinned,
    write_step,
)

# ---- A cell as a file of its own, which jobs name: `cell: my-cell.yaml`

SHOWN_APART = ("machine", "nozzle", "external", "world_up", "obstacles", "touched")
PROPOSED = ("deposition_point", "branch")  # where a job file leaves them out


def cell_text(cell: CellParameters, folder: str) -> str:
    """The YAML of a cell, of what is not at its default alone, and of where a robot deposits, each key on a line; lengths in
    mm, angles in degrees. Files within `folder`, where the cell file will be, are named from there."""
    lines = [f"machine: {_machine(cell.machine, folder)}"]
    usual = CellParameters()
    for field in dataclasses.fields(cell):
        value = getattr(cell, field.name)
        is_proposed = field.name in PROPOSED and arrangement_of(cell.setup).free > 0
        if field.name in SHOWN_APART or (value == getattr(usual, field.name) and not is_proposed):
            continue
        lines.append(f"{field.name}: {_format(value, f.spec_of(field).kind)}")
    if cell.nozzle != usual.nozzle:
        entries = [
            f"{field.name}: "
            + (
                _file(str(cell.nozzle.shape), folder)
                if field.name == "shape"
                else _format(getattr(cell.nozzle, field.name), f.spec_of(field).kind)
            )
            for field in dataclasses.fields(cell.nozzle)
            if getattr(cell.nozzle, field.name) != getattr(usual.nozzle, field.name)
        ]
        lines.append(f"nozzle: {{{', '.join(entries)}}}")
    if cell.external:
        lines.append("external:")
        lines += [
            f"- {{machine: {_machine(mechanism.machine, folder)}, pose: {_format(mechanism.pose, f.POSE)}, carries: {mechanism.carries}}}"
            for mechanism in cell.external
        ]
    lines += ["obstacles:"] if cell.obstacles else []
    for body in cell.obstacles:
        what = (
            f"file: {_file(body.file, folder)}"
            if body.box is None
            else f"box: {_format(body.box, f.LENGTH)}"
        )
        name = json.dumps(body.name, ensure_ascii=False)
        lines.append(f"- {{name: {name}, {what}, pose: {_format(body.pose, f.POSE)}}}")
    lines += ["touched:"] if cell.touched else []
    lines += [
        f"- {{part: {_format(point.part, f.LENGTH)}, robot: {_format(point.robot, f.LENGTH)}}}"
        for point in cell.touched
    ]
    if cell.world_up != usual.world_up:
        lines.append(f"world_up: {_format(cell.world_up, f.NUMBER)}")
    return "\n".join(lines) + "\n"


def _format(value: Any, kind: str) -> str:
    """A value in the units of a job file; numbers to what a float holds of them in degrees."""
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, (tuple, list)):
        if value and isinstance(value[0], str):
            return f"[{', '.join(value)}]"
        kinds = [kind] * len(value) if len(value) != 6 else [f.LENGTH] * 3 + [f.ANGLE] * 3
        return f"[{', '.join(_format(number, number_kind) for number, number_kind in zip(value, kinds, strict=True))}]"
    return f"{math.degrees(value) if kind == f.ANGLE else value:.15g}"


def _machine(name: str, folder: str) -> str:
    """What names a machine, as a job file says it."""
    measured = calibration.named(name)
    if measured is not None:
        return f"{{name: {_machine(measured.machine, folder)}, calibration: {_file(measured.file, folder)}}}"
    reference = urdf_reference.reference(name)
    if reference is not None:
        links = [
            f", {key}: {json.dumps(link)}"
            for key, link in (("base", reference.base), ("tip", reference.tip))
            if link
        ]
        return f"{{file: {_file(reference.file, folder)}{''.join(links)}}}"
    return _file(name, folder) if os.sep in name or name.lower().endswith(".json") else name


def _file(path: str, folder: str) -> str:
    inside = os.path.relpath(path, folder)
    return json.dumps(path if inside.startswith(os.pardir) else inside, ensure_ascii=False)


# ---- Objects of other workbenches, which a FreeCAD may be without


def lacking(what: str, workbench: str, otherwise: str) -> InputError:
    """The error that a workbench is not there, and what to do."""
    return InputError(
        "NO_MODULE",
        what,
        "this FreeCAD has no {} workbench; install it or {} instead",
        workbench,
        otherwise,
    )


def added(document: Any, kind: str, name: str, label: str) -> Any:
    """A new object of such a workbench in a document."""
    obj = document.addObject(kind, name)
    obj.Label = label
    return obj


# ---- Lines as a trajectory of the Robot workbench, which plays it with robots of its own.
# Thinned, for it is slow with many


def make_trajectory(
    document: Any, lines: Sequence[Line], label: str, tolerance: float, turn: float
) -> Any:
    """A Robot::TrajectoryObject through so few points that the path keeps within `tolerance` mm and `turn` rad.

    Z of a waypoint points out of the nozzle. Raises InputError NO_MODULE where this FreeCAD has no Robot workbench.
    """
    try:
        import Robot
    except ImportError:
        raise lacking("trajectory", "Robot", "make a CAM path") from None
    obj = added(document, "Robot::TrajectoryObject", "AmTrajectory", label)
    trajectory = Robot.Trajectory()
    trajectory.insertWaypoints(
        [
            Robot.Waypoint(placement, type="LIN", name=name, vel=speed)
            for name, placement, speed in trajectory_waypoints(lines, tolerance, turn)
        ]
    )
    obj.Trajectory = trajectory
    obj.purgeTouched()  # nothing is left to recompute, which the tree would ask for
    return obj


def trajectory_waypoints(
    lines: Sequence[Line], tolerance: float, turn: float
) -> list[tuple[str, Any, float]]:
    """Name, placement and speed in mm/s of each waypoint; the end of one line and the same start of the next are one."""
    named_points: list[tuple[str, Any, float]] = []
    end_point = None
    for line in lines:
        reduced = thinned(line, tolerance, turn)
        skipped = 1 if end_point is not None and np.array_equal(end_point, reduced.points[0]) else 0
        end_point = reduced.points[-1]
        poses = pose(attitudes(reduced.tool), reduced.points)
        speed = np.where(np.arange(len(reduced.speed)) == 0, reduced.speed[1], reduced.speed)
        named_points += [
            (
                f"{line.name} {k}",
                App.Placement(App.Matrix(*poses[k].ravel().tolist())),
                float(speed[k]),
            )
            for k in range(skipped, len(reduced.points))
        ]
    return named_points


DEPOSIT_ON, DEPOSIT_OFF = "(deposit on)", "(deposit off)"


def add(document: Any, lines: Sequence[Line], label: str) -> Any:
    """A Path::Feature of the document; raises InputError NO_MODULE where this FreeCAD has no CAM."""
    try:
        import Path
    except ImportError:
        raise lacking("CAM path", "CAM (Path)", "write STEP or DXF") from None
    obj = added(document, "Path::Feature", "AmPath", label)
    obj.Path = Path.Path([Path.Command(name, words) for name, words in commands(lines)])
    obj.purgeTouched()  # nothing is left to recompute, which the tree would ask for
    return obj


def commands(lines: Sequence[Line]) -> list[tuple[str, dict[str, float]]]:
    """Names and words: G0 to the first point and along rapid moves, G1 along beads; F in mm/s as FreeCAD keeps it."""
    entries: list[tuple[str, dict[str, float]]] = []
    position: list[float] | None = None
    for line in lines:
        points = line.points.tolist()
        if points[0] != position:
            entries.append(("G0", _xyz(points[0])))
        position = points[-1]
        if line.deposit:
            entries.append((f"({line.name})", {}))
            entries.append((DEPOSIT_ON, {}))
            speeds = line.speed[1:].tolist()
            entries += [
                ("G1", {**_xyz(point), "F": speed})
                for point, speed in zip(points[1:], speeds, strict=True)
            ]
            entries.append((DEPOSIT_OFF, {}))
        else:
            entries += [("G0", _xyz(point)) for point in points[1:]]
    return entries


def _xyz(point: list[float]) -> dict[str, float]:
    return {"X": point[0], "Y": point[1], "Z": point[2]}


KINDS = ("toolpath", "joint path", "program")


def lines_of(obj: Any, rapids: bool = True) -> tuple[Line, ...]:
    """Beads, and where the stage knows them the rapid moves, of a toolpath, a joint path, or a program's joint path.

    Raises InputError for any other object, for one without a result, and for one whose result does not fit the document.
    """
    obj = _path_of(obj)
    value = obj.Proxy.value(obj)
    lines = (
        lines_of_toolpath(value) if obj.Proxy.kind == "toolpath" else lines_of_motion(value.motion)
    )
    return lines if rapids else tuple(line for line in lines if line.deposit)


def motion_of(obj: Any) -> tuple[Motion, tuple[str, ...], tuple[str, ...]]:
    """The motion of the same, of a toolpath its beads alone; what tables call the axes, and their units, none of a toolpath.

    Raises InputError as `lines_of`, and where the machine's file is gone.
    """
    obj = _path_of(obj)
    value = obj.Proxy.value(obj)
    if obj.Proxy.kind == "toolpath":
        return timeline.deposit_motion(value), (), ()
    arm = machine.load(obj.Cell.Machine, user_machines.folders())
    return value.motion, arm.columns, arm.units


def _path_of(obj: Any) -> Any:
    """The toolpath or joint path that is meant, whose result fits the document as it is now."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in KINDS:
        label = getattr(obj, "Label", repr(obj))
        raise InputError(
            "BAD_INPUT", label, "it has no path; choose a toolpath, joint path or program"
        )
    path = obj if stage.kind != "program" else obj.JointPath
    if path is None:
        raise InputError("NO_INPUT", obj.Label, "its joint path was deleted; choose a joint path")
    if path.Key:
        check_current(path)
    return path


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
    return _write_whole(path, lambda unfinished: _write(lines, unfinished, ending, obj.Label))


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

    return _write_whole(path, write)


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

    return _write_whole(path, write)


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
    saved = cell_text(
        obj.Proxy.parameters(obj, CellParameters), os.path.dirname(os.path.abspath(path))
    )

    def write(unfinished: str) -> None:
        with open(unfinished, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(saved)

    return _write_whole(path, write)


def _write_whole(path: str, write: Callable[[str], None]) -> str:
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
    return add(obj.Document, lines_of(obj), f"{obj.Label} (CAM)")


def add_trajectory(obj: Any, tolerance: float, turn: float) -> Any:
    """The lines of a stage as a trajectory of the Robot workbench, in its document: within `tolerance` mm and `turn` rad."""
    for name, value in (("tolerance", tolerance), ("turn", turn)):
        if not value > 0.0:
            raise InputError(
                "OUT_OF_RANGE", name, "{:g} is not positive; give a larger value", value
            )
    return make_trajectory(
        obj.Document, lines_of(obj), f"{obj.Label} (trajectory)", tolerance, turn
    )


def _write(lines: Sequence[Line], path: str, ending: str, label: str) -> None:
    if ending in STEP:
        write_step(lines, path, label)
        if not os.path.isfile(path):
            raise InputError(
                "NOT_WRITTEN",
                label,
                "FreeCAD wrote no STEP file; see the report view, or use DXF instead",
            )
    else:
        with open(path, "w", encoding="ascii", newline="") as stream:
            stream.writelines(dxf_text(lines))
