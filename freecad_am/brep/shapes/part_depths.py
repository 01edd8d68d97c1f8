# SPDX-License-Identifier: LGPL-2.1-or-later
"""The depth of a part around the surface of its beads, from its shape."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import Part

from ...core.collision.depths import grain, measured
from ...core.geometry.curves.profile import RevolvedWall
from ...core.geometry.mesh.collapsed import doubled_areas
from ...core.geometry.mesh.solid import SolidMesh, divide_triangles
from ...core.geometry.obstacles import Body
from ...core.geometry.walls.part_depths import PartDepths, Surface
from ...core.types import Array
from ..kernel.limits import FAULTS
from ..kernel.process import in_kernel_process
from ..sections_agree import sections_agree
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
