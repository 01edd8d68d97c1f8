# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether triangles enclose what a solid does, by their plane sections.

The kernel integrates the volume of rational faces with too few points: for a cylinder stretched to
an ellipse it is 0.86 % too large. Plane sections of the same faces, cut into short chords, do not
depend on that integral.
"""

from __future__ import annotations

from typing import Any

import FreeCAD
import numpy as np

from ..core.types import Array, Index
from .kernel import process

PLANES = 12  # across each axis
SHARE = 0.4  # of the volume in doubt that the sections may differ by
# offset of the planes between equal steps, so that flat faces are unlikely to coincide with one
OFF_MIDDLE = 0.4142135
FEWEST_POINTS = 24  # on a loop of a section


def sections_agree(
    solid: Any, vertices: Array, triangles: Index, chord: float, missing: float
) -> bool:
    """Whether triangles and solid have equal sections, so that no volume of about `missing` mm3
    lacks.

    The difference of the areas in PLANES planes across an axis, times their distance, is about the volume that the
    triangles lack. Along none of the three axes may it be more than SHARE of `missing`.
    """
    corners = vertices[triangles]
    for axis in range(3):
        low, high = vertices[:, axis].min(), vertices[:, axis].max()
        step = (high - low) / PLANES
        heights = low + step * (np.arange(PLANES) + OFF_MIDDLE)
        exact = process.in_kernel_process(section_areas, solid.copy(), axis, heights, chord)
        if exact is None:
            return False
        difference = exact - np.array([_mesh_area(corners, axis, height) for height in heights])
        if np.abs(difference).sum() * step > SHARE * missing:
            return False
    return True


def section_areas(solid: Any, axis: int, heights: Array, chord: float) -> Array | None:
    """Areas (k,) of the sections of a solid across an axis; or None if a section has open loops."""
    normal = FreeCAD.Vector(*np.eye(3)[axis].tolist())
    areas = []
    for height in heights.tolist():
        loops = []
        for wire in solid.slice(normal, height):
            if not wire.isClosed():
                return None
            points = [tuple(point) for point in wire.discretize(Deflection=0.25 * chord)]
            if len(points) < FEWEST_POINTS:
                points = [tuple(p) for edge in wire.OrderedEdges for p in _wire_points(edge)]
            loops.append(_across(np.array(points), axis))
        areas.append(_enclosed(loops))
    return np.array(areas)


def _wire_points(edge: Any) -> list[Any]:
    """Points of an edge in the order of its wire, without the last."""
    points = edge.discretize(FEWEST_POINTS)
    start_point = edge.firstVertex(True).Point
    if (points[0] - start_point).Length > (points[-1] - start_point).Length:
        points.reverse()
    return list(points[:-1])


def _across(points: Array, axis: int) -> Array:
    """The two coordinates (n, 2) across an axis; the sense of rotation about the axis is kept."""
    flat: Array = points[:, [(axis + 1) % 3, (axis + 2) % 3]]
    return flat


def _enclosed(loops: list[Array]) -> float:
    """The area within loops (n, 2); a loop within an odd number of other loops is a hole."""
    areas = [abs(_area(loop)) for loop in loops]
    total = 0.0
    for k, loop in enumerate(loops):
        depth = sum(
            areas[j] > areas[k] and _is_inside(loop[0], outer_loop)
            for j, outer_loop in enumerate(loops)
            if j != k
        )
        total += areas[k] if depth % 2 == 0 else -areas[k]
    return total


def _area(loop: Array) -> float:
    x, y = loop.T
    return 0.5 * float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum())


def _is_inside(point: Array, loop: Array) -> bool:
    """Whether a point is in a loop, by the sides that a ray from it along x crosses."""
    start, end = loop, np.roll(loop, -1, axis=0)
    rise = end[:, 1] - start[:, 1]
    crosses = (start[:, 1] > point[1]) != (end[:, 1] > point[1])
    share = (point[1] - start[crosses, 1]) / rise[crosses]
    crossings = start[crosses, 0] + share * (end[crosses, 0] - start[crosses, 0])
    return bool((crossings > point[0]).sum() % 2)


def _mesh_area(corners: Array, axis: int, height: float) -> float:
    """Area of the section of closed triangles (m, 3, 3) across an axis."""
    level = corners[:, :, axis] - height
    above = level > 0.0
    cut = above.any(axis=1) & ~above.all(axis=1)
    corners, level, above = corners[cut], level[cut], above[cut]
    ends = []
    for upward in (True, False):  # each cut triangle has one side that rises and one that falls
        side = np.argmax(
            (above != np.roll(above, -1, axis=1)) & (np.roll(above, -1, axis=1) == upward), axis=1
        )
        row, next_corner = np.arange(len(side)), (side + 1) % 3
        share = level[row, side] / (level[row, side] - level[row, next_corner])
        start, end = corners[row, side], corners[row, next_corner]
        ends.append(_across(start + share[:, None] * (end - start), axis))
    start, end = ends
    return abs(0.5 * float((start[:, 0] * end[:, 1] - end[:, 0] * start[:, 1]).sum()))
