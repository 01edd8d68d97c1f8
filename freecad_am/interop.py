# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths for other programs and workbenches: polylines as DXF and STEP files, and paths of other
workbenches."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import math
import os
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from .core.geometry.frames import pose, smallest_rotation
from .core.issues import InfeasibleError, InputError
from .core.kinematics import cell as cells
from .core.kinematics.arrangement import arrangement_of
from .core.kinematics.machines import calibration
from .core.kinematics.machines.machine import Machine
from .core.kinematics.urdf import reference as urdf_reference
from .core.motion import Motion
from .core.parameters import field as f
from .core.parameters.cell import CellParameters
from .core.parameters.process import ProcessParameters
from .core.simulation import timeline, waypoints
from .core.simulation.joint_trajectory import JointTrajectory, joint_trajectory, trajectory_text
from .core.toolpath import Toolpath
from .core.types import Array, Index
from .objects import user_machines
from .objects.current import check_current, check_recomputed
from .objects.joint_path import Planned, planned_of
from .objects.results.findings import issues_of, reason_of
from .objects.stage import stage_of
from .objects.staleness import INFEASIBLE
from .objects.work import hooks

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
    """Return the name of a machine as a job file gives it."""
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
        "the {} workbench is not installed in this FreeCAD; install the workbench, or {}",
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
    if obj.Proxy.kind == "toolpath":
        return timeline.deposit_motion(obj.Proxy.value(obj)), (), ()
    planned, machine = _planned_and_machine(obj)
    return planned.motion, machine.columns, machine.units


def _planned_and_machine(path: Any) -> tuple[Planned, Machine]:
    """Return the result of a joint path, and its machine with the external axes."""
    planned, toolpath, settings = planned_of(path, path.Label)
    cell = cells.resolve(settings, toolpath.frame, toolpath.family, user_machines.folders())
    return planned, cell.machine


def joint_trajectory_of(obj: Any) -> JointTrajectory:
    """Return the joint path of a joint path or program as a trajectory, with all waits.

    Raises InputError as `lines_of`, and BAD_INPUT for a toolpath; InfeasibleError INPUT_INFEASIBLE.
    """
    path = _path_of(obj)
    if path.Proxy.kind == "toolpath":
        raise InputError(
            "BAD_INPUT", obj.Label, "a toolpath has no joint values; choose a joint path or program"
        )
    if path.Status == INFEASIBLE:
        raise InfeasibleError(
            "INPUT_INFEASIBLE",
            obj.Label,
            "{} is infeasible: {}",
            path.Label,
            reason_of(path),
            issues=issues_of(path),
        )
    planned, machine = _planned_and_machine(path)
    process = path.Toolpath.Proxy.parameters(path.Toolpath, ProcessParameters)
    waits = [layer.wait for layer in path.Toolpath.Proxy.value(path.Toolpath).layers]
    times = timeline.timeline(planned.motion, process, waits)
    return joint_trajectory(times, machine.axes, machine.chain.sliding)


def _path_of(obj: Any) -> Any:
    """The toolpath or joint path that is meant, whose result fits the document as it is now."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in KINDS:
        label = getattr(obj, "Label", repr(obj))
        raise InputError(
            "BAD_INPUT", label, "the object has no path; choose a toolpath, joint path or program"
        )
    path = obj if stage.kind != "program" else obj.JointPath
    if path is None:
        raise InputError(
            "NO_INPUT", obj.Label, "the joint path of the program was deleted; choose a joint path"
        )
    if path.Key:
        check_current(path)
    return path


STEP, DXF, CELL = (".step", ".stp"), (".dxf",), (".yaml", ".yml")
PAGE, TRAJECTORY = ".html", ".json"


def write_wires(obj: Any, path: str, rapids: bool) -> str:
    """Write the lines of a stage as STEP or DXF, whichever the path ends in; the path. The file appears whole or not at all.

    Raises InputError UNSUPPORTED_FILE, NO_FOLDER, NOT_WRITABLE, and what `lines_of` raises.
    """
    ending = os.path.splitext(path)[1].lower()
    if ending not in STEP + DXF:
        raise InputError(
            "UNSUPPORTED_FILE",
            path,
            "wires are written as .step or .dxf; use the extension .step or .dxf",
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
            "UNSUPPORTED_FILE", path, "waypoints are written as .csv; use the extension .csv"
        )
    motion, columns, units = motion_of(obj)

    def write(unfinished: str) -> None:
        with open(unfinished, "w", encoding="ascii", newline="") as stream:
            stream.writelines(waypoints.text(motion, columns, units, bool(motion.settings.any())))

    return _write_whole(path, write)


def write_joint_trajectory(obj: Any, path: str) -> str:
    """Write a joint path, or a program's joint path, as JointTrajectory of ROS in JSON; return the path.

    The file appears whole or not at all. Raises InputError UNSUPPORTED_FILE, NO_FOLDER, NOT_WRITABLE,
    and what `joint_trajectory_of` raises.
    """
    if os.path.splitext(path)[1].lower() != TRAJECTORY:
        raise InputError(
            "UNSUPPORTED_FILE",
            path,
            "joint trajectories are written as .json; use the extension .json",
        )
    trajectory = joint_trajectory_of(obj)

    def write(unfinished: str) -> None:
        with open(unfinished, "w", encoding="utf-8", newline="\n") as stream:
            stream.writelines(trajectory_text(trajectory))

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
        raise InputError("WRONG_KIND", obj.Label, "the object is not a cell; choose a cell")
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
            "NO_FOLDER",
            path,
            "the folder {} does not exist; create the folder, or choose another",
            folder,
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


# ---- A toolpath or a motion as polylines, one per bead and per rapid move, and their DXF and
# STEP files


@dataclass(frozen=True, eq=False)
class Line:
    """Points (n, 3) mm in part coordinates, n >= 2, with the tool axis (n, 3) and the speed (n,) mm/s towards each of them.

    layer, bead: from 0; a rapid carries those of the bead it leads to, the last one those of the last bead.
    closed: the last point repeats the first.
    """

    layer: int
    bead: int
    deposit: bool
    points: Array
    tool: Array
    speed: Array
    closed: bool = False

    @property
    def name(self) -> str:
        """Return a name such as L003 B01 or L003 rapid; numbers start at 0."""
        return f"L{self.layer:03d} B{self.bead:02d}" if self.deposit else f"L{self.layer:03d} rapid"

    def chosen(self, rows: Index) -> Line:
        """Return the line through some of its points, with the speed towards each."""
        return Line(
            self.layer,
            self.bead,
            self.deposit,
            self.points[rows],
            self.tool[rows],
            self.speed[rows],
            self.closed,
        )


def lines_of_toolpath(toolpath: Toolpath) -> tuple[Line, ...]:
    """Its beads, in the order of deposit."""
    return tuple(
        Line(layer, index, True, bead.points, bead.tool, bead.speed, bead.closed)
        for layer, index, bead in toolpath
    )


def lines_of_motion(motion: Motion) -> tuple[Line, ...]:
    """Its beads and, from the second on, the rapid moves to them, in the order of motion; the last lifts off."""
    is_new_bead = (np.diff(motion.bead) != 0) | (np.diff(motion.layer) != 0)
    change = (
        np.flatnonzero(
            (motion.deposit[1:] != motion.deposit[:-1]) | (motion.deposit[1:] & is_new_bead)
        )
        + 1
    )
    starts, ends = np.r_[0, change], np.r_[change, len(motion)]
    lines = []
    for start, end in zip(starts, ends, strict=True):
        deposit = bool(motion.deposit[start])
        begin = start if deposit or start == 0 else start - 1
        points = motion.position[begin:end]
        if len(points) < 2 or not (np.isfinite(points).all() and np.ptp(points, axis=0).any()):
            continue
        closed = deposit and len(points) > 3 and bool(np.abs(points[0] - points[-1]).max() < 1e-9)
        lines.append(
            Line(
                int(motion.layer[start]),
                int(motion.bead[start]),
                deposit,
                points,
                motion.tool[begin:end],
                motion.speed[begin:end],
                closed,
            )
        )
    return tuple(lines)


def thinned(line: Line, tolerance: float, turn: float) -> Line:
    """The line through so few of its points that none of the others is farther than `tolerance` mm from it, nor turned
    farther than `turn` rad from the tool axis at the nearest of them (Douglas and Peucker 1973)."""
    keep = np.zeros(len(line.points), dtype=np.bool_)
    keep[[0, -1]] = True
    stack = [(0, len(line.points) - 1)]
    while stack:
        begin, end = stack.pop()
        if end - begin < 2:
            continue
        inner = np.arange(begin + 1, end)
        off = _distance(line.points[inner], line.points[begin], line.points[end]) / tolerance
        turned = (
            np.minimum(
                _angle(line.tool[inner], line.tool[begin]),
                _angle(line.tool[inner], line.tool[end]),
            )
            / turn
        )
        worst = np.maximum(off, turned)
        k = int(np.argmax(worst))
        if worst[k] > 1.0:
            keep[inner[k]] = True
            stack += [(begin, int(inner[k])), (int(inner[k]), end)]
    return line.chosen(np.flatnonzero(keep))


def attitudes(tool: Array) -> Array:
    """Rotations (n, 3, 3) whose Z points out of the nozzle, against the tool axes (n, 3), with no needless turn about it."""
    return np.asarray(smallest_rotation((0.0, 0.0, 1.0), tool) * np.array([1.0, -1.0, -1.0]))


def _distance(points: Array, start: Array, end: Array) -> Array:
    """Distance (n,) of points from the segment from start to end."""
    along = end - start
    length = float(along @ along)
    share = (
        np.clip((points - start) @ along / length, 0.0, 1.0)
        if length > 0.0
        else np.zeros(len(points))
    )
    return np.asarray(np.linalg.norm(points - start - share[:, None] * along, axis=1))


def _angle(directions: Array, reference: Array) -> Array:
    return np.asarray(
        2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(directions - reference, axis=1), 0.0, 1.0))
    )


# ---- Lines as a DXF file of AutoCAD release 12, which all read: a 3D POLYLINE each, on a layer
# per layer of the deposit

DECIMALS = 6
RAPID = "RAPID"
_RED, _COLOURS = 1, (3, 4, 5, 6, 30, 140)  # AutoCAD colour numbers, assigned to layers in turn
_POLYLINE_3D, _VERTEX_3D = 8, 32


def dxf_text(lines: Sequence[Line]) -> Iterator[str]:
    """The file in pieces; millimetres, part coordinates, line ends as Windows has them."""
    names = {
        _layer(line): _RED if not line.deposit else _COLOURS[line.layer % len(_COLOURS)]
        for line in lines
    }
    points = np.concatenate([line.points for line in lines])
    corners = [
        _point(name, point)
        for name, point in (("$EXTMIN", points.min(axis=0)), ("$EXTMAX", points.max(axis=0)))
    ]
    yield _pairs([(0, "SECTION"), (2, "HEADER"), (9, "$ACADVER"), (1, "AC1009")]) + "".join(corners)
    yield _pairs(
        [(0, "ENDSEC"), (0, "SECTION"), (2, "TABLES"), (0, "TABLE"), (2, "LAYER"), (70, len(names))]
    )
    for name, colour in names.items():
        yield _pairs([(0, "LAYER"), (2, name), (70, 0), (62, colour), (6, "CONTINUOUS")])
    yield _pairs([(0, "ENDTAB"), (0, "ENDSEC"), (0, "SECTION"), (2, "ENTITIES")])
    for line in lines:
        yield _polyline(line)
    yield _pairs([(0, "ENDSEC"), (0, "EOF")])


def _polyline(line: Line) -> str:
    # closed beads end where they begin: FreeCAD 1.0 drops the last side of a polyline marked as
    # closed
    layer = _layer(line)
    head = _pairs(
        [
            (0, "POLYLINE"),
            (8, layer),
            (66, 1),
            (10, "0.0"),
            (20, "0.0"),
            (30, "0.0"),
            (70, _POLYLINE_3D),
        ]
    )
    points = np.round(line.points, DECIMALS) + 0.0
    row = _pairs([(0, "VERTEX"), (8, layer)]) + "".join(
        f"{code:3d}\r\n%.{DECIMALS}f\r\n" for code in (10, 20, 30)
    )
    row += _pairs([(70, _VERTEX_3D)])
    return (
        head
        + "".join(row % tuple(point) for point in points.tolist())
        + _pairs([(0, "SEQEND"), (8, layer)])
    )


def _layer(line: Line) -> str:
    return f"LAYER_{line.layer:03d}" if line.deposit else RAPID


def _point(name: str, point: object) -> str:
    x, y, z = np.asarray(point).tolist()
    return _pairs(
        [(9, name), (10, f"{x:.{DECIMALS}f}"), (20, f"{y:.{DECIMALS}f}"), (30, f"{z:.{DECIMALS}f}")]
    )


def _pairs(pairs: list[tuple[int, object]]) -> str:
    return "".join(f"{code:3d}\r\n{value}\r\n" for code, value in pairs)


# ---- Lines as wires in a STEP file: one named component per layer, one for the rapid moves

RAPID_COMPONENT = "Rapid"
UNITS = ("MM", "M", "INCH")  # by the number that FreeCAD's preference has
SCHEMA = "AP214IS"
_PREFERENCES = "User parameter:BaseApp/Preferences/Mod/Part/STEP"
_UNIT_OF_FILES, _SCHEMA_OF_FILES = "write.step.unit", "write.step.schema"


def write_step(lines: Sequence[Line], path: str, label: str) -> None:
    """Write the file; raises InputError NO_MODULE where this FreeCAD cannot."""
    try:
        import Import
    except ImportError:
        raise InputError(
            "NO_MODULE", "STEP", "this FreeCAD lacks the module Import; use DXF instead of STEP"
        ) from None
    active = App.ActiveDocument
    document = App.newDocument("RoboticAM_Export", label, True, True)
    try:
        components = [
            _component(document, name, component_lines)
            for name, component_lines in _components(lines).items()
        ]
        with _millimetres():
            Import.export(components, path)
    finally:
        App.closeDocument(document.Name)
        if active is not None:
            App.setActiveDocument(active.Name)


@contextlib.contextmanager
def _millimetres() -> Iterator[None]:
    """Write STEP files in millimetres and the schema that all read, whatever the user prefers for files of his own.

    The kernel keeps the unit for the whole process. FreeCAD 1.0 writes numbers in mm under the name of the preferred unit.
    """
    preferred = App.ParamGet(_PREFERENCES)
    unit, schema = preferred.GetInt("Unit", 0), preferred.GetString("Scheme", SCHEMA)
    Part.setStaticValue(_UNIT_OF_FILES, UNITS[0])
    Part.setStaticValue(_SCHEMA_OF_FILES, SCHEMA)
    try:
        yield
    finally:
        Part.setStaticValue(_UNIT_OF_FILES, UNITS[unit] if 0 <= unit < len(UNITS) else UNITS[0])
        Part.setStaticValue(_SCHEMA_OF_FILES, schema or SCHEMA)


def step_edge(line: Line) -> Any:
    """The edge through all points of a line."""
    gaps = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    points = line.points[np.r_[True, gaps > 0.0]]
    knots = np.r_[0.0, np.cumsum(gaps[gaps > 0.0])].tolist()
    curve = Part.BSplineCurve()
    curve.buildFromPolesMultsKnots(
        [App.Vector(*point) for point in points.tolist()],
        [2, *[1] * (len(points) - 2), 2],
        knots,
        False,
        1,
    )
    return curve.toShape()


def _components(lines: Sequence[Line]) -> dict[str, list[Line]]:
    components: dict[str, list[Line]] = {}
    for line in lines:
        components.setdefault(
            f"Layer {line.layer:03d}" if line.deposit else RAPID_COMPONENT, []
        ).append(line)
    return components


def _component(document: Any, name: str, lines: list[Line]) -> Any:
    obj = document.addObject("Part::Feature", "Wires")
    obj.Label = name
    obj.Shape = Part.Compound([Part.Wire([step_edge(line)]) for line in lines])
    return obj
