# SPDX-License-Identifier: LGPL-2.1-or-later
"""A toolpath or a motion as polylines, one per bead and per rapid move, and their DXF and STEP files."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from ..core.geometry.frames import smallest_rotation
from ..core.issues import InputError
from ..core.motion import Motion
from ..core.toolpath import Toolpath
from ..core.types import Array, Index


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
        """Such as L003 B01 or L003 rapid, from 0 as everywhere."""
        return f"L{self.layer:03d} B{self.bead:02d}" if self.deposit else f"L{self.layer:03d} rapid"

    def chosen(self, rows: Index) -> Line:
        """The line through some of its points, the speed towards each kept."""
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
_RED, _COLOURS = 1, (3, 4, 5, 6, 30, 140)  # AutoCAD's numbers of colours; layers take turns
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
    # closed beads end where they begin: FreeCAD 1.0 leaves out the last side of a polyline that says it is closed
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
            "NO_MODULE", "STEP", "this FreeCAD lacks the module Import; use DXF instead"
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
