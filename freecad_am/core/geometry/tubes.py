# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads as bodies for display: tubes along polylines, above the path points.

The section is a rounded rectangle of exactly the bead's width and height. Corners are mitred, and
ends are closed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..types import Array, Index, Mask, NDArray
from .frames import unit

TURN = np.radians(20.0)  # rad; direction change of the path after which another section is kept
_SHARPEST = 0.5  # minimum cosine of half the turn angle: mitres are at most twice the width
# corners of the section in half widths and half heights, by number of sides; first the side
SECTIONS = {
    4: ((1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0)),
    6: ((1.0, 0.0), (0.62, 1.0), (-0.62, 1.0), (-1.0, 0.0), (-0.62, -1.0), (0.62, -1.0)),
    8: (
        (1.0, -0.45),
        (1.0, 0.45),
        (0.66, 1.0),
        (-0.66, 1.0),
        (-1.0, 0.45),
        (-1.0, -0.45),
        (-0.66, -1.0),
        (0.66, -1.0),
    ),
}


class Frames(NamedTuple):
    """Frames at the path points.

    side, up: (n, 3) unit vectors across the path. mitre: (n,) elongation of the mitres. turn: (n,)
    direction change of the path, rad.
    """

    side: Array
    up: Array
    mitre: Array
    turn: Array


class Mesh(NamedTuple):
    """points, normals: (k * sides, 3). triangles: (t, 3) point indices."""

    points: Array
    normals: Array
    triangles: NDArray[np.int32]


def frames(points: Array, build: Array, starts: Index, closed: Mask) -> Frames:
    """Return the frames of consecutive beads.

    Parameters
    ----------
    points : (n, 3) array
        Points of all beads, mm.
    build : (n, 3) array
        Build directions, unit vectors.
    starts : (m + 1,) int array
        Index of the first point of each bead, and n.
    closed : (m,) bool array
        Whether a bead ends at its first point.

    Returns
    -------
    Frames
        Vectors across the path, mitres and direction changes.
    """
    step = np.diff(points, axis=0)
    length = np.linalg.norm(step, axis=1, keepdims=True)
    step = np.divide(step, length, out=np.zeros_like(step), where=length > 0.0)
    start_rows, end_rows = starts[:-1], starts[1:] - 1
    direction_after = np.concatenate([step, step[-1:]])
    direction_before = np.concatenate([step[:1], step])
    direction_after[end_rows], direction_before[start_rows] = (
        direction_before[end_rows],
        direction_after[start_rows],
    )
    round_ = np.flatnonzero(closed)
    direction_after[end_rows[round_]], direction_before[start_rows[round_]] = (
        direction_after[start_rows[round_]],
        direction_before[end_rows[round_]],
    )
    along = direction_before + direction_after
    cosine = np.linalg.norm(along, axis=1)
    along = np.where(cosine[:, None] > 1e-6, along, direction_before)  # the path reverses
    side = unit(np.cross(build, along))
    up = unit(np.cross(along, side))
    turn = np.arccos(np.clip(np.einsum("ij,ij->i", direction_before, direction_after), -1.0, 1.0))
    return Frames(side, up, 1.0 / np.maximum(0.5 * cosine, _SHARPEST), turn)


def select_sections(turn: Array, starts: Index, stride: int) -> Mask:
    """Return which points get a section.

    Sections are at every `stride`-th point, at the ends of beads, and where the path turns.

    Parameters
    ----------
    turn : (n,) array
        Direction changes of the path, rad.
    starts : (m + 1,) int array
        Index of the first point of each bead, and n.
    stride : int
        Spacing of sections, in points.

    Returns
    -------
    (n,) bool array
        True for a section.
    """
    keep: Mask = np.arange(len(turn)) % stride == 0
    turned = np.floor(np.cumsum(turn) / TURN)
    keep[1:] |= np.diff(turned) > 0.0
    keep[np.concatenate([starts[:-1], starts[1:] - 1])] = True
    return keep


def mesh(
    points: Array, across: Frames, width: Array, height: Array, ends: Mask, sides: int
) -> Mesh:
    """Build tubes over points, which are the centres of the tube bottoms.

    Parameters
    ----------
    points : (k, 3) array
        Points, mm.
    across : Frames
        Frames at these points.
    width, height : (k,) array
        Size of the tubes, mm.
    ends : (k,) bool array
        True at the last point of a tube.
    sides : int
        Number of sides, a key of SECTIONS.

    Returns
    -------
    Mesh
        Points, normals and triangles.
    """
    section = np.array(SECTIONS[sides])
    half_width, half_height = 0.5 * width * across.mitre, 0.5 * height
    sideways = section[None, :, :1] * across.side[:, None]
    above = section[None, :, 1:] * across.up[:, None]
    centre = points + half_height[:, None] * across.up
    corners = (
        centre[:, None] + sideways * half_width[:, None, None] + above * half_height[:, None, None]
    )
    normals = (
        sideways / np.maximum(half_width, 1e-9)[:, None, None]
        + above / np.maximum(half_height, 1e-9)[:, None, None]
    )
    return Mesh(corners.reshape(-1, 3), unit(normals).reshape(-1, 3), _triangles(ends, sides))


def _triangles(ends: Mask, sides: int) -> NDArray[np.int32]:
    """Return the triangles.

    They are counter-clockwise seen from outside if `side`, `up` and the path are right-handed.
    """
    number, turn = np.arange(sides), np.roll(np.arange(sides), -1)
    rows = np.flatnonzero(~ends[:-1])[:, None] * sides
    low, next_low = rows + number, rows + turn
    skin = np.stack(
        [low, next_low, next_low + sides, low, next_low + sides, low + sides], axis=-1
    ).reshape(-1, 3)
    end_rows = np.flatnonzero(ends)
    start_rows = np.concatenate([[0], end_rows[:-1] + 1])
    fan = np.stack([np.zeros(sides - 2, dtype=np.intp), number[1:-1], number[2:]], axis=-1)
    front = (start_rows[:, None, None] * sides + fan[:, ::-1]).reshape(-1, 3)
    back = (end_rows[:, None, None] * sides + fan).reshape(-1, 3)
    triangles: NDArray[np.int32] = np.concatenate([skin, front, back]).astype(np.int32)
    return triangles
