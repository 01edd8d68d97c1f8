# SPDX-License-Identifier: LGPL-2.1-or-later
"""Writes the parts of the papers as STEP files beside this script (Chalvin 2020, eqs. 20 to 22; Chalvin 2019, eq. 1).

Each wall is a surface, so that the wall deposited has exactly the radius of the equation. Curves are exact: circles and
parabolas. Run it in any Python that finds FreeCAD: python3 resources/examples/make_examples.py
"""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent))

from freecad_am.batch import host  # noqa: E402

host.find_freecad()

from FreeCAD import Vector  # noqa: E402  (before Part, which crashes without)

import Part  # isort: skip  # noqa: E402

R0 = 45.0  # mm
BEND, TUBE, PIPE = 60.0, 15.0, 32.0  # mm; bend radius and radius of the tube, radius of the pipe below


def hemisphere() -> Any:
    """Eq. 20: x = sqrt(R0^2 - z^2), z in [0, R0]."""
    circle = Part.Circle(Vector(0, 0, 0), Vector(0, -1, 0), R0)
    return _turned([_between(circle, Vector(R0, 0, 0), Vector(0, 0, R0))])


def laval_nozzle() -> Any:
    """Eq. 21: x = sqrt(2 rho (z - theta)), with rho, theta = -10, 100 up to z = 96.5 and 3, 85 from there to 128.

    At 96.5 the two differ by 0.06 mm; a flat ring closes the step.
    """
    below, above = _parabola(-10.0, 100.0), _parabola(3.0, 85.0)

    def x(rho: float, theta: float, z: float) -> Any:
        return Vector(math.sqrt(2.0 * rho * (z - theta)), 0, z)

    throat, step = x(-10.0, 100.0, 96.5), x(3.0, 85.0, 96.5)
    return _turned([
        _between(below, x(-10.0, 100.0, 0.0), throat), Part.makeLine(throat, step),
        _between(above, step, x(3.0, 85.0, 128.0)),
    ])


def intake_funnel() -> Any:
    """Eq. 22: x = 2 R0 - sqrt(R0^2 - z^2), z in [0, R0]."""
    circle = Part.Circle(Vector(2.0 * R0, 0, 0), Vector(0, -1, 0), R0)
    return _turned([_between(circle, Vector(R0, 0, 0), Vector(2.0 * R0, 0, R0))])


def tube_on_pipe() -> Any:
    """Chalvin 2019, eq. 1: a quarter of a torus that starts on the axis of the pipe and bends towards -X."""
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius = BEND, TUBE
    torus.Center, torus.Axis = Vector(-BEND, 0, 0), Vector(0, -1, 0)
    return torus.toShape(0.0, math.pi / 2.0, 0.0, 2.0 * math.pi)


def pipe() -> Any:
    """The pipe it grows on, about Y, with a wall of 3 mm."""
    outer, inner = (Part.makeCylinder(radius, 120.0, Vector(0, -60, 0), Vector(0, 1, 0)) for radius in (PIPE, PIPE - 3.0))
    return outer.cut(inner)


def _parabola(rho: float, theta: float) -> Any:
    """x^2 = 2 rho (z - theta) in the plane of X and Z."""
    curve = Part.Parabola()
    curve.Center = Vector(0, 0, theta)
    curve.Axis = Vector(0, -1 if rho > 0 else 1, 0)
    curve.XAxis = Vector(0, 0, math.copysign(1.0, rho))
    curve.Focal = abs(rho) / 2.0
    return curve


def _between(curve: Any, start: Any, end: Any) -> Any:
    """The shorter stretch of a curve between two of its points, as an edge."""
    a, b = curve.parameter(start), curve.parameter(end)
    if isinstance(curve, Part.Circle) and abs(b - a) > math.pi:
        a, b = (a + 2.0 * math.pi, b) if a < b else (a, b + 2.0 * math.pi)
    return curve.toShape(min(a, b), max(a, b))


def _turned(edges: list[Any]) -> Any:
    return Part.Wire(edges).revolve(Vector(0, 0, 0), Vector(0, 0, 1), 360)


def write(name: str, shape: Any) -> None:
    """Write one part: under its own name, which FreeCAD shows, and without the exporter's date and path."""
    path = HERE / f"{name}.step"
    shape.exportStep(str(path))
    text = re.sub(r"FILE_NAME\('[^']*','[^']*'", f"FILE_NAME('{name}','2020-01-01T00:00:00'", path.read_text())
    text = re.sub(r"PRODUCT\('[^']*',\s*'[^']*'", f"PRODUCT('{name}','{name}'", text)
    path.write_text(text)


for part in (hemisphere, laval_nozzle, intake_funnel, tube_on_pipe, pipe):
    write(part.__name__.replace("_", "-"), part())
