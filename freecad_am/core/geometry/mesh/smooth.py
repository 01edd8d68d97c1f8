# SPDX-License-Identifier: LGPL-2.1-or-later
"""A smooth surface through a mesh, for curvature and normals without jumps between facets.

An implicit surface of moving least squares (Shen et al. 2004): near a point, the planes
of the samples around it are weighted. Each plane is turned halfway towards the local mean
normal, which reproduces spheres and cylinders without swelling them.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.spatial import cKDTree

from ...types import Array, Index
from ..walls.surface import dot
from .facets import doubled_areas

NEIGHBOUR_COUNT = 28  # samples that count at a place
REACH = 2.2  # typical distances of samples; farther ones do not count
STEPS = 12
MIN_MOVE_MM = 1e-11  # mm


class SmoothMesh:
    """samples (n, 3) mm, the vertices of triangles (m, 3) about `spacing` mm apart; normals to the side from which these are
    counter-clockwise."""

    def __init__(self, samples: Array, triangles: Index, spacing: float) -> None:
        self.samples, self.triangles, self.reach = samples, triangles, REACH * spacing

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.samples)

    @cached_property
    def _facets(self) -> tuple[Array, Array]:
        """Return the unit normals (n, 3) and areas (n,) of the samples, from their triangles."""
        corner = self.samples[self.triangles]
        normal, area = np.zeros_like(self.samples), np.zeros(len(self.samples))
        double = doubled_areas(corner)
        size = np.linalg.norm(double, axis=1)
        unit = double / np.maximum(size, 1e-300)[:, None]
        for k in range(3):
            edge_a, edge_b = (
                corner[:, (k + 1) % 3] - corner[:, k],
                corner[:, (k + 2) % 3] - corner[:, k],
            )
            angle = np.arctan2(
                np.linalg.norm(np.cross(edge_a, edge_b), axis=1), dot(edge_a, edge_b)
            )
            np.add.at(normal, self.triangles[:, k], angle[:, None] * unit)
            np.add.at(area, self.triangles[:, k], size / 6.0)
        return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300), area

    def project(self, points: Array) -> tuple[Array, Array]:
        """Return the surface points near points (k, 3), and the unit normals there, each (k, 3)."""
        feet = points.astype(np.float64, copy=True)
        normals = np.zeros_like(feet)
        busy = np.arange(len(feet))
        neighbours: Array = np.empty((len(feet), 0))
        for step in range(STEPS):
            if step < 2:  # from far away the first step changes the neighbours
                nearest = np.asarray(
                    self._tree.query(feet[busy], k=min(NEIGHBOUR_COUNT, len(self.samples)))[1]
                )
                neighbours = nearest.reshape(len(busy), min(NEIGHBOUR_COUNT, len(self.samples)))
            value, slope = self._level(feet[busy], neighbours)
            size = np.maximum((slope * slope).sum(axis=1), 0.04)
            move = np.clip(value / size, -4.0 * self.reach, 4.0 * self.reach)[:, None] * slope
            feet[busy] -= move
            normals[busy] = slope
            still = np.abs(move).max(axis=1) < MIN_MOVE_MM
            if step > 0:
                busy, neighbours = busy[~still], neighbours[~still]
            if not len(busy):
                break
        return feet, normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

    def _level(self, points: Array, neighbours: Array) -> tuple[Array, Array]:
        """Return the approximate heights (k,) of points above the surface and their gradients (k,
        3).

        neighbours: (k, l) samples.
        """
        normals, areas = self._facets
        normal, area = normals[neighbours], areas[neighbours]
        offset = points[:, None] - self.samples[neighbours]
        square = np.einsum("klc,klc->kl", offset, offset)
        reach = np.maximum(self.reach**2, 2.0 * square.min(axis=1))[:, None]
        inner = np.maximum(1.0 - square / reach, 0.0)
        weight = area * inner**4
        pull = -8.0 / reach * area * inner**3  # times `offset`: the gradient of the weight
        total = weight.sum(axis=1)
        weight, pull = weight / total[:, None], pull / total[:, None]
        mean = np.einsum("kl,klc->kc", weight, normal)
        length = np.maximum(np.linalg.norm(mean, axis=1), 1e-9)
        unit = mean / length[:, None]
        above = np.einsum("klc,klc->kl", normal, offset)
        middle = np.einsum("kl,klc->kc", weight, offset)
        height = dot(unit, middle)
        value = 0.5 * ((weight * above).sum(axis=1) + height)
        turned = (middle - height[:, None] * unit) / length[:, None]
        change = (
            above
            + np.einsum("klc,kc->kl", normal, turned)
            + np.einsum("klc,kc->kl", offset, unit)
            - 2.0 * value[:, None]
        )
        slope = 0.5 * (np.einsum("kl,klc->kc", pull * change, offset) + mean + unit)
        return value, slope
