# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lines as wires in a STEP file: one named component per layer, one for the rapid moves.

Each line is one spline of the first degree, which is the polyline itself and a fifth of the size of an edge per segment.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Sequence
from typing import Any

import FreeCAD as App
import numpy as np
import Part

from ..core.issues import InputError
from .lines import Line

RAPID = "Rapid"
UNITS = ("MM", "M", "INCH")  # by the number that FreeCAD's preference has
SCHEMA = "AP214IS"
_PREFERENCES = "User parameter:BaseApp/Preferences/Mod/Part/STEP"
_UNIT_OF_FILES, _SCHEMA_OF_FILES = "write.step.unit", "write.step.schema"


def write(lines: Sequence[Line], path: str, label: str) -> None:
    """Write the file; InputError NO_MODULE where this FreeCAD cannot."""
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


def edge(line: Line) -> Any:
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
        components.setdefault(f"Layer {line.layer:03d}" if line.deposit else RAPID, []).append(line)
    return components


def _component(document: Any, name: str, lines: list[Line]) -> Any:
    obj = document.addObject("Part::Feature", "Wires")
    obj.Label = name
    obj.Shape = Part.Compound([Part.Wire([edge(line)]) for line in lines])
    return obj
