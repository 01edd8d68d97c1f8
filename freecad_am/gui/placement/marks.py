# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nodes of a placement: a cube at each place that was tried, and the reach of the robot as points."""

from __future__ import annotations

from typing import Any

import numpy as np
from pivy import coin

from freecad_am.core.types import Array

from ..nodes.lines import Lines, fill, unshaded
from ..nodes.wall import unpickable

_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
_SIDES = np.array(
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
)
_EDGES = np.array(
    [(0, 1), (1, 3), (3, 2), (2, 0), (4, 5), (5, 7), (7, 6), (6, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
)
CHOSEN = (0.86, 0.1, 0.12)
DOT = 7.0  # pixels


class Cubes:
    """Cubes of one size, each in its colour; clicks go through them. One may be framed."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        self.colour, binding, hints = (
            coin.SoMaterial(),
            coin.SoMaterialBinding(),
            coin.SoShapeHints(),
        )
        binding.value = coin.SoMaterialBinding.PER_FACE
        hints.vertexOrdering = coin.SoShapeHints.UNKNOWN_ORDERING
        self.coordinates, self.faces = coin.SoCoordinate3(), coin.SoIndexedFaceSet()
        self.frame = Lines(3.0, CHOSEN)
        cubes = coin.SoSeparator()
        for child in (self.colour, binding, hints, self.coordinates, self.faces):
            cubes.addChild(child)
        for child in (unpickable(), cubes, self.frame.node):
            self.node.addChild(child)
        self.set(np.zeros((0, 3)), np.zeros((0, 3)), 1.0)

    def set(self, places: Array, colours: Array, size: float) -> None:
        """places (n, 3) mm, colours (n, 3) 0..1; size: mm, of an edge."""
        corners = places[:, None] + 0.5 * size * _CORNERS
        first = 8 * np.arange(len(places))[:, None, None]
        sides = np.concatenate([first + _SIDES, np.full((len(places), 6, 1), -1)], axis=2)
        fill(self.coordinates.point, corners.reshape(-1, 3))
        fill(self.colour.diffuseColor, np.repeat(colours, 6, axis=0))
        fill(self.faces.coordIndex, sides.ravel())
        self.choose(None, size)

    def choose(self, place: Array | None, size: float) -> None:
        """Frame the cube at a place (3,), or none."""
        if place is None:
            self.frame.set([], [])
            return
        ends = (np.asarray(place) + 0.6 * size * _CORNERS)[_EDGES]
        self.frame.set(ends.reshape(-1, 3), [2] * len(_EDGES))


class Cloud:
    """Points, each in its colour; clicks go through them."""

    def __init__(self) -> None:
        self.node = coin.SoSeparator()
        style, binding = coin.SoDrawStyle(), coin.SoMaterialBinding()
        style.pointSize = DOT
        binding.value = coin.SoMaterialBinding.PER_VERTEX
        self.colour, self.coordinates, self.points = (
            coin.SoMaterial(),
            coin.SoCoordinate3(),
            coin.SoPointSet(),
        )
        for child in (
            unpickable(),
            unshaded(),
            style,
            self.colour,
            binding,
            self.coordinates,
            self.points,
        ):
            self.node.addChild(child)
        self.set(np.zeros((0, 3)), np.zeros((0, 3)))

    def set(self, places: Array, colours: Any) -> None:
        """places (n, 3) mm, colours (n, 3) 0..1."""
        fill(self.coordinates.point, places)
        fill(self.colour.diffuseColor, colours)
        self.points.numPoints = len(places)
