# SPDX-License-Identifier: LGPL-2.1-or-later
"""Obstacles around a wall during deposition, as triangles: the supporting part, and fixtures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..types import Array, Index, Integers

DISC_SIDES = 72


@dataclass(frozen=True, eq=False)
class Body:
    """A solid or mesh that the nozzle must not touch, in part coordinates.

    name: name in messages. vertices: (n, 3) mm. triangles: (m, 3) vertex indices.
    """

    name: str
    vertices: Array
    triangles: Integers

    def corners(self) -> Array:
        """Return the corners of each triangle.

        Returns
        -------
        (m, 3, 3) array
            mm.
        """
        corners: Array = self.vertices[self.triangles]
        return corners

    def move(self, pose: Array) -> Body:
        """Return the body transformed by a pose (4, 4), mm."""
        return Body(self.name, self.vertices @ pose[:3, :3].T + pose[:3, 3], self.triangles)


def box(size: tuple[float, float, float], pose: Array, name: str) -> Body:
    """Return a box centred on the origin of a pose.

    Parameters
    ----------
    size : tuple[float, float, float]
        Edge lengths, mm.
    pose : (4, 4) array
        Pose of the box; the edges are parallel to its axes.
    name : str
        Name for messages.

    Returns
    -------
    Body
        The box as triangles.
    """
    corners = (
        np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    )
    faces = np.array(
        [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    )
    return Body(name, corners, np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])).move(
        pose
    )


def disc(diameter: float, frame: Array, name: str = "platform") -> Body:
    """Return a flat disc as a circumscribed polygon.

    Parameters
    ----------
    diameter : float
        Diameter, mm.
    frame : (4, 4) array
        Pose of the disc, which is in the plane z = 0.
    name : str, optional
        Name for messages.

    Returns
    -------
    Body
        The disc as triangles.
    """
    angle = np.linspace(0.0, 2.0 * np.pi, DISC_SIDES, endpoint=False)
    radius = 0.5 * diameter / np.cos(np.pi / DISC_SIDES)
    flat = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(DISC_SIDES)], axis=1)
    vertices = np.vstack([np.zeros((1, 3)), flat]) @ frame[:3, :3].T + frame[:3, 3]
    rim = np.arange(1, DISC_SIDES + 1)
    return Body(
        name,
        vertices,
        np.stack([np.zeros_like(rim), rim, np.roll(rim, -1)], axis=1).astype(np.int64),
    )


def enclosed_volume(around: Sequence[Body]) -> tuple[float, Array]:
    """Return the total volume of closed bodies, and their centroid.

    Parameters
    ----------
    around : sequence of Body
        The bodies; open bodies do not count.

    Returns
    -------
    volume : float
        Total volume, mm3.
    centroid : (3,) array
        Common centroid, mm; zero without volume.
    """
    volume, weighted = 0.0, np.zeros(3)
    for body in around:
        edges = np.concatenate(
            [body.triangles[:, [0, 1]], body.triangles[:, [1, 2]], body.triangles[:, [2, 0]]]
        )
        count = len(body.vertices)
        if not np.array_equal(np.sort(edges @ (count, 1)), np.sort(edges @ (1, count))):
            continue
        corners = body.corners()
        tetrahedra = (
            np.einsum("ni,ni->n", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6.0
        )
        volume += abs(float(tetrahedra.sum()))
        weighted += np.sign(tetrahedra.sum()) * (
            tetrahedra[:, None] * corners.sum(axis=1) / 4.0
        ).sum(axis=0)
    return volume, weighted / volume if volume > 0.0 else weighted


def meeting_boxes(low: Array, high: Array) -> list[Index]:
    """Find boxes that overlap or touch, without comparing all pairs.

    Parameters
    ----------
    low, high : (n, 3) array
        Lowest and highest corners, mm.

    Returns
    -------
    list of (k,) int array
        For each box, the indices of the boxes that it meets, rising.
    """
    spread = np.ptp(low, axis=0) / np.maximum((high - low).mean(axis=0), 1e-300)
    axis = int(np.argmax(spread))
    order = np.argsort(low[:, axis], kind="stable")
    low, high = low[order], high[order]
    ends = np.searchsorted(low[:, axis], high[:, axis], side="right")
    pairs = [np.zeros((0, 2), dtype=np.intp)]
    for number, end in enumerate(ends.tolist()):
        later = slice(number + 1, end)
        meets = ((low[later] <= high[number]) & (low[number] <= high[later])).all(axis=1)
        others = number + 1 + np.flatnonzero(meets)
        pairs.append(np.stack([np.full(len(others), number), others], axis=1))
    met = order[np.concatenate(pairs)]
    met = np.concatenate([met, met[:, ::-1]])
    met = met[np.lexsort(met.T[::-1])]
    return np.split(met[:, 1], np.searchsorted(met[:, 0], np.arange(1, len(low))))
