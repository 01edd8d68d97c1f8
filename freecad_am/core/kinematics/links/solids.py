# SPDX-License-Identifier: LGPL-2.1-or-later
"""Plain solids as triangles with normals, only for drawing: revolved solids, cylinders, boxes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry import frames
from ...types import Array, ArrayLike, Integers

BODY, DARK, BRIGHT = "body", "dark", "bright"
SIDES = 40


@dataclass(frozen=True, eq=False)
class Solid:
    """A triangulated solid.

    points, normals: (n, 3) mm and outward unit vectors. triangles: (m, 3) indices. tone: surface
    tone.
    """

    points: Array
    normals: Array
    triangles: Integers
    tone: str = BODY

    def move(self, pose: Array) -> Solid:
        """Return the solid moved by a pose.

        Parameters
        ----------
        pose : (4, 4) array
            The pose, mm.

        Returns
        -------
        Solid
            Moved solid with the same tone.
        """
        turn = pose[:3, :3].T
        return Solid(
            self.points @ turn + pose[:3, 3], self.normals @ turn, self.triangles, self.tone
        )


def revolve(
    outline: ArrayLike, start: ArrayLike, end: ArrayLike, tone: str = BODY, sides: int = SIDES
) -> Solid:
    """Return a solid of revolution.

    Each segment of the outline has its own normals, so edges stay sharp.

    Parameters
    ----------
    outline : (k, 2) array
        Radius in mm, and position on the axis from 0 at its start to 1 at its end, along the
        outside.
    start, end : (3,) array
        Ends of the axis, mm.
    tone : str, optional
        Surface tone.
    sides : int, optional
        Number of facets around the axis.

    Returns
    -------
    Solid
        The solid.
    """
    shape = np.asarray(outline, float)
    begin = np.asarray(start, float)
    stop = np.asarray(end, float)
    length = float(np.linalg.norm(stop - begin))
    shape = np.column_stack([shape[:, 0], shape[:, 1] * length])
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    run, rise = np.diff(shape, axis=0).T
    size = np.hypot(run, rise)
    valid = np.flatnonzero(size >= 1e-9)
    run, rise, size = run[valid], rise[valid], size[valid]
    ends = np.stack([shape[valid], shape[valid + 1]], axis=1)
    # for each segment, one ring at its start and one at its end
    count = len(ring)
    points, normals = np.empty((2, len(valid), 2, count, 3))
    points[..., :2], points[..., 2] = ends[:, :, None, :1] * ring, ends[:, :, None, 1]
    normals[..., :2], normals[..., 2] = (
        (rise / size)[:, None, None, None] * ring,
        (-run / size)[:, None, None],
    )
    i = np.arange(count - 1) + 2 * count * np.arange(len(valid))[:, None]
    halves = [(i, i + 1, i + count), (i + 1, i + count + 1, i + count)]
    triangles = np.stack([np.stack(half, axis=2) for half in halves], axis=1)
    pose = frames.pose(frames.smallest_rotation((0.0, 0.0, 1.0), (stop - begin) / length), begin)
    return Solid(
        points.reshape(-1, 3), normals.reshape(-1, 3), triangles.reshape(-1, 3), tone
    ).move(pose)


def cylinder(
    start: ArrayLike, end: ArrayLike, radius: float, tone: str = BODY, bevel: float = 0.12
) -> Solid:
    """Return a cylinder with bevelled edges.

    Parameters
    ----------
    start, end : (3,) array
        Centres of the end discs, mm.
    radius : float
        Radius, mm.
    tone : str, optional
        Surface tone.
    bevel : float, optional
        Bevel width, relative to the radius; at most 0.4 of the length.

    Returns
    -------
    Solid
        The solid.
    """
    length = float(np.linalg.norm(np.asarray(end, float) - np.asarray(start, float)))
    cut = min(bevel * radius, 0.4 * length)
    rise = cut / length
    outline = [
        (0, 0),
        (radius - cut, 0),
        (radius, rise),
        (radius, 1 - rise),
        (radius - cut, 1),
        (0, 1),
    ]
    return revolve(outline, start, end, tone)


def capsule(
    start: ArrayLike, end: ArrayLike, start_radius: float, end_radius: float, tone: str = BODY
) -> Solid:
    """Return a tapered tube with round ends.

    Parameters
    ----------
    start, end : (3,) array
        Centres of the round ends, mm.
    start_radius, end_radius : float
        Radii of the round ends, mm.
    tone : str, optional
        Surface tone.

    Returns
    -------
    Solid
        The solid.
    """
    begin, stop = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(stop - begin))
    quarter = np.linspace(0.0, 0.5 * np.pi, 8)
    low = np.column_stack(
        [start_radius * np.sin(quarter), -start_radius * np.cos(quarter) / length]
    )
    high = np.column_stack(
        [end_radius * np.cos(quarter), 1.0 + end_radius * np.sin(quarter) / length]
    )
    return revolve(np.concatenate([low, high]), begin, stop, tone)


def strut(
    start: ArrayLike,
    end: ArrayLike,
    axis: ArrayLike,
    start_radius: float,
    end_radius: float,
    thick: float,
    tone: str = BODY,
) -> Solid:
    """Return a plate with round ends of the size of two discs.

    Parameters
    ----------
    start, end : (3,) array
        Centres of the discs, mm.
    axis : (3,) array
        Unit normal of the plate.
    start_radius, end_radius : float
        Radii of the discs, mm.
    thick : float
        Thickness along `axis`, mm.
    tone : str, optional
        Surface tone.

    Returns
    -------
    Solid
        The solid.
    """
    begin, stop, normal = (np.asarray(value, float) for value in (start, end, axis))
    chord = stop - begin
    chord = chord - (chord @ normal) * normal
    length = float(np.linalg.norm(chord))
    along = chord / length
    across = np.cross(normal, along)
    # points where the common tangents touch the discs
    lean = float(np.arccos(np.clip((start_radius - end_radius) / length, -1.0, 1.0)))
    low, high = np.linspace(lean, 2.0 * np.pi - lean, 24), np.linspace(-lean, lean, 24)
    outline = np.concatenate(
        [
            begin + start_radius * (np.cos(low)[:, None] * along + np.sin(low)[:, None] * across),
            begin
            + along * length
            + end_radius * (np.cos(high)[:, None] * along + np.sin(high)[:, None] * across),
        ]
    )
    angle = np.concatenate([low, high])
    outward = np.cos(angle)[:, None] * along + np.sin(angle)[:, None] * across
    return _prism(outline, outward, normal, thick, tone)


def _prism(outline: Array, outward: Array, normal: Array, thick: float, tone: str) -> Solid:
    """Extrude a convex outline (n, 3) with outward normals to both sides along `normal`."""
    n, half = len(outline), 0.5 * thick * normal
    rim = np.concatenate([outline - half, outline + half])
    ends = np.concatenate([-np.ones(n), np.ones(n)])[:, None] * normal
    i, following = np.arange(n), np.roll(np.arange(n), -1)
    side = np.concatenate(
        [np.column_stack([i, following, i + n]), np.column_stack([following, following + n, i + n])]
    )
    fan = np.column_stack([np.zeros(n - 2, dtype=np.int64), np.arange(1, n - 1), np.arange(2, n)])
    caps = np.concatenate([fan + 2 * n, fan + 3 * n])
    return Solid(
        np.concatenate([rim, rim]),
        np.concatenate([outward, outward, ends]),
        np.concatenate([side, caps]),
        tone,
    )


def box(
    centre: ArrayLike,
    x: ArrayLike,
    y: ArrayLike,
    size: tuple[float, float, float],
    tone: str = BODY,
) -> Solid:
    """Return a box.

    Parameters
    ----------
    centre : (3,) array
        Centre, mm.
    x, y : (3,) array
        Unit vectors of two edges; their cross product gives the third edge.
    size : tuple[float, float, float]
        Edge lengths, mm.
    tone : str, optional
        Surface tone.

    Returns
    -------
    Solid
        The solid.
    """
    axis_x, axis_y = np.asarray(x, float), np.asarray(y, float)
    axes = np.stack([axis_x, axis_y, np.cross(axis_x, axis_y)])
    points: list[Array] = []
    normals: list[Array] = []
    triangles: list[Integers] = []
    for axis in range(3):
        u = axes[(axis + 1) % 3] * size[(axis + 1) % 3]
        v = axes[(axis + 2) % 3] * size[(axis + 2) % 3]
        for sign in (-1.0, 1.0):
            base = 4 * len(normals)
            middle = np.asarray(centre, float) + 0.5 * sign * size[axis] * axes[axis]
            points.append(
                np.stack(
                    [
                        middle + 0.5 * (a * u + b * v)
                        for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
                    ]
                )
            )
            normals.append(np.tile(sign * axes[axis], (4, 1)))
            triangles.append(np.array([[0, 1, 2], [0, 2, 3]]) + base)
    return Solid(np.concatenate(points), np.concatenate(normals), np.concatenate(triangles), tone)
