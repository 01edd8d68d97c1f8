# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bends on pipes: the tube of Chalvin 2019, eq. 1, the same wider, one askew, and the pipe as a mesh."""

from __future__ import annotations

import math
from typing import Any

import step_files
from FreeCAD import Placement, Rotation, Vector

import Part  # isort: skip  (after FreeCAD, it crashes before)

BEND, TUBE, WIDE_TUBE, PIPE = (
    60.0,
    15.0,
    25.0,
    32.0,
)  # mm; bend radius, radii of the tubes, radius of the pipe below
PIPE_LENGTH, PIPE_WALL = 120.0, 3.0  # mm
SIDES = 240  # of the pipe as a mesh: its flats are 3 um inside of the cylinder
SKEWED_AT = Vector(200, -120, 75)


def tube_on_pipe(tube: float = TUBE) -> Any:
    """Eq. 1: a quarter of a torus that starts on the axis of the pipe and bends towards -X."""
    return bend(BEND, tube, 90.0)


def wide_tube_on_pipe() -> Any:
    """The same with the larger of the two radii."""
    return tube_on_pipe(WIDE_TUBE)


def pipe() -> Any:
    """The pipe it grows on, about Y."""
    outer, inner = (
        Part.makeCylinder(radius, PIPE_LENGTH, Vector(0, -0.5 * PIPE_LENGTH, 0), Vector(0, 1, 0))
        for radius in (PIPE, PIPE - PIPE_WALL)
    )
    return outer.cut(inner)


def pipe_mesh() -> list[step_files.Triangle]:
    """The pipe as a poor export has it: closed, long thin triangles, and some that have no area."""

    def ring(radius: float, y: float) -> list[tuple[float, float, float]]:
        angles = [2.0 * math.pi * k / SIDES for k in range(SIDES)]
        return [(radius * math.sin(angle), y, radius * math.cos(angle)) for angle in angles]

    low, high = -0.5 * PIPE_LENGTH, 0.5 * PIPE_LENGTH
    corners = [
        ring(PIPE, low),
        ring(PIPE, high),
        ring(PIPE - PIPE_WALL, high),
        ring(PIPE - PIPE_WALL, low),
    ]
    triangles = []
    for here, there in zip(corners, [*corners[1:], corners[0]], strict=True):
        for k in range(SIDES):
            a, b, c, d = here[k], here[(k + 1) % SIDES], there[(k + 1) % SIDES], there[k]
            triangles += [(a, b, c), (a, c, d)]
            if k % 24 == 0:
                triangles += [(a, a, b), (c, c, c)]
    return triangles


def skewed_bend() -> Any:
    """A bend whose first tangent leans by 12 deg, turned by 25 deg about the vertical and 7 mm beside the pipe's axis."""
    shape = bend(50.0, 12.0, 70.0)
    lean = Placement(Vector(0, 0, 0), Rotation(Vector(1, 0, 0), 12.0))
    turn = Placement(SKEWED_AT + Vector(7, 4, 0), Rotation(Vector(0, 0, 1), 25.0))
    return _placed(shape, turn * lean)


def skewed_bend_pipe() -> Any:
    """The solid rod it grows on, about Y."""
    return Part.makeCylinder(30.0, 100.0, SKEWED_AT - Vector(0, 50, 0), Vector(0, 1, 0))


def bend(radius: float, tube: float, angle: float, start: Any = None) -> Any:
    """A bend that starts upwards at `start` (or the origin) and turns towards -X by `angle` (deg)."""
    torus = Part.Toroid()
    torus.MajorRadius, torus.MinorRadius = radius, tube
    torus.Center, torus.Axis = (start or Vector()) - Vector(radius, 0, 0), Vector(0, -1, 0)
    return torus.toShape(0.0, math.radians(angle), 0.0, 2.0 * math.pi)


def _placed(shape: Any, placement: Any) -> Any:
    shape.Placement = placement
    return shape
