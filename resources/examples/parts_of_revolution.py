# SPDX-License-Identifier: LGPL-2.1-or-later
"""The parts of Chalvin 2020, eqs. 20 to 22. Curves are exact: circles and parabolas."""

from __future__ import annotations

import math
from typing import Any

import step_files  # noqa: F401  (finds FreeCAD)
from FreeCAD import Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

R0 = 45.0  # mm


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
    return _turned(
        [
            _between(below, x(-10.0, 100.0, 0.0), throat),
            Part.makeLine(throat, step),
            _between(above, step, x(3.0, 85.0, 128.0)),
        ]
    )


def intake_funnel() -> Any:
    """Eq. 22: x = 2 R0 - sqrt(R0^2 - z^2), z in [0, R0]."""
    circle = Part.Circle(Vector(2.0 * R0, 0, 0), Vector(0, -1, 0), R0)
    return _turned([_between(circle, Vector(R0, 0, 0), Vector(2.0 * R0, 0, R0))])


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
