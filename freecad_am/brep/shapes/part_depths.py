# SPDX-License-Identifier: LGPL-2.1-or-later
"""The depth of a part around the surface of its beads, from its shape; whether its sections
agree."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part

from ...core.collision.depths import grain, measured
from ...core.geometry.curves.profile import RevolvedWall
from ...core.geometry.mesh.coarsen import doubled_areas
from ...core.geometry.mesh.solid import SolidMesh, divide_triangles
from ...core.geometry.obstacles import Body
from ...core.geometry.walls.part_depths import PartDepths, Surface
from ...core.types import Array, Index
from ..kernel import process
from ..kernel.limits import FAULTS
from ..kernel.process import in_kernel_process
from .tessellate import tessellated

CHORD_SHARE = 1e-3  # share of the part's size: chord error of its triangles
MIN_CHORD_MM, MAX_CHORD_MM = 0.02, 0.5  # bounds of the chord error, mm
PLACES = 4000  # of the surface


def revolved_depths(shape: Any, wall: RevolvedWall, label: str) -> PartDepths | None:
    """Depths of the part of a wall of revolution, or None if the part has no faces."""
    return _of(shape, wall.faces, label, revolved_places(wall), None)


def face_depths(
    shape: Any, faces: Sequence[str], label: str, substrate: Body | None
) -> PartDepths | None:
    """Depths of the part whose wall is `faces`; material in the substrate does not count."""
    return _of(shape, faces, label, None, substrate)


def revolved_places(wall: RevolvedWall) -> Surface:
    """Places spread over a wall of revolution."""
    s = (np.arange(400) + 0.5) / 400 * wall.meridian.length
    radius = wall.meridian.at(s)[0]
    turn = wall.end - wall.start
    area = float((radius * turn).mean() * wall.meridian.length)
    step = max(np.sqrt(max(area, 1e-9) / PLACES), 1e-3)
    rows = min(max(2, round(wall.meridian.length / step)), PLACES)
    s = (np.arange(rows) + 0.5) / rows * wall.meridian.length
    radius, height, tangent = wall.meridian.at(s)
    counts = np.clip(np.round(radius * turn / step).astype(int), 3, PLACES)
    row = np.repeat(np.arange(rows), counts)
    number = np.arange(len(row)) - np.repeat(np.cumsum(counts) - counts, counts)
    azimuth = wall.start + (number + 0.5) / counts[row] * turn
    across = np.stack([tangent[row, 1], np.zeros(len(row)), -tangent[row, 0]], axis=1)
    areas = (radius * turn * wall.meridian.length / rows / counts)[row]
    return Surface(
        wall.points(radius[row], height[row], azimuth), wall.directions(across, azimuth), areas
    )


def _of(
    shape: Any, faces: Sequence[str], label: str, surface: Surface | None, substrate: Body | None
) -> PartDepths | None:
    if not shape.Faces:
        return None
    solids = _solids(shape)
    size = shape.BoundBox.DiagonalLength
    chord = float(
        np.clip(CHORD_SHARE * size, min(MIN_CHORD_MM, 10.0 * CHORD_SHARE * size), MAX_CHORD_MM)
    )
    try:
        tessellation = in_kernel_process(tessellated, shape.copy(), chord)
    except FAULTS:
        return None  # the code that needs the triangles reports it
    names = [f"Face{number + 1}" for number in range(len(shape.Faces))]
    body = Body(label, tessellation.vertices, tessellation.triangles.astype(np.int64))
    on = np.isin(tessellation.owner, [k for k, name in enumerate(names) if name in set(faces)])
    surface = _places(body, on) if surface is None else surface
    if not len(surface.points):
        return None
    depths, thickness, by_face, share = measured(
        body, tessellation.owner, names, surface, 3.0 * chord, substrate
    )
    codes = {face.hashCode(): name for name, face in zip(names, shape.Faces, strict=True)}
    owned = [[codes.get(face.hashCode(), "") for face in solid.Faces] for solid in solids]
    unused = (
        [k for k, names_of_solid in enumerate(owned) if not set(names_of_solid) & set(faces)]
        if len(solids) > 1
        else []
    )
    accounted = {name for k in unused for name in owned[k]} | set(faces)
    remaining = [k for k, name in enumerate(names) if name not in accounted]
    volumes = [abs(float(solid.Volume)) for solid in solids]
    if len(solids) == 1:
        volumes = [_volume(solids[0], volumes[0], body, chord)]
    return PartDepths(
        label,
        share * sum(volumes),
        float(surface.areas.sum()),
        depths,
        thickness,
        tuple(names[k] for k in remaining),
        tuple(float(by_face[k]) for k in remaining),
        tuple(float(shape.Faces[k].Area) for k in remaining),
        tuple((f"Solid{k + 1}", volumes[k]) for k in unused),
    )


def _volume(solid: Any, volume: float, body: Body, chord: float) -> float:
    """The kernel's volume of a solid, or the volume of triangles within `chord` mm if the kernel's
    integral is off.
    """
    mesh = abs(SolidMesh(body.vertices, body.triangles).volume)
    doubt = abs(mesh - volume)
    if doubt <= 2.0 * chord * float(solid.Area):
        return volume
    agree = sections_agree(solid, body.vertices, body.triangles, chord, doubt)
    return mesh if agree else volume


def _solids(shape: Any) -> list[Any]:
    """Its solids, or what its closed shells enclose."""
    if shape.Solids:
        return list(shape.Solids)
    return [Part.Solid(shell) for shell in shape.Shells if shell.isClosed()]


def _places(body: Body, on: Any) -> Surface:
    """Points spread over the triangles of a wall."""
    corners = body.corners()[on]
    if not len(corners):
        return Surface(*(np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0)))
    across = doubled_areas(corners)
    twice: Array = np.linalg.norm(across, axis=1)
    points, face = divide_triangles(
        corners, grain(corners, float(2.0 * np.sqrt(0.5 * twice.sum() / PLACES)))
    )
    areas = (0.5 * twice / np.maximum(np.bincount(face, minlength=len(corners)), 1))[face]
    return Surface(points, (across / np.maximum(twice, 1e-300)[:, None])[face], areas)


# ---- Whether triangles enclose what a solid does, by their plane sections
#
# The kernel integrates the volume of rational faces with too few points: for a cylinder stretched
# to an ellipse it is 0.86 % too large. Plane sections of the same faces, cut into short chords,
# do not depend on that integral.

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
