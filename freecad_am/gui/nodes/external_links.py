# SPDX-License-Identifier: LGPL-2.1-or-later
"""Positioner and track in the 3D view: a node for each of their links that is known, red where something is wrong."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from pivy import coin

from freecad_am.core.types import Array, Mask

from ...core.kinematics.links.external_links import ExternalLink
from .machine_links import BAD, move, of_mesh

STANDING, CARRYING, MOVING = (0.36, 0.39, 0.43), (0.66, 0.68, 0.71), (0.5, 0.53, 0.57)


class ExternalLinkNodes:
    """The links, in the frame of what they are posed in."""

    def __init__(self, links: Sequence[ExternalLink]) -> None:
        self.node = coin.SoSeparator()
        self.links = tuple(links)
        self.matrices: list[Any] = []
        self.materials: list[Any] = []
        self.bad = np.zeros(len(links), dtype=bool)
        for link in links:
            group, transform, material = (
                coin.SoSeparator(),
                coin.SoMatrixTransform(),
                coin.SoMaterial(),
            )
            material.diffuseColor.setValue(*_colour(link))
            for child in (transform, material, of_mesh((link.body.vertices, link.body.triangles))):
                group.addChild(child)
            self.node.addChild(group)
            self.matrices.append(transform.matrix)
            self.materials.append(material)

    def pose(self, frames: Array) -> None:
        """Move the links to their poses (links, 4, 4)."""
        for matrix, frame in zip(self.matrices, frames):
            move(matrix, frame)

    def paint(self, bad: Mask) -> None:
        """bad: (k,) of the external axes, those whose links are to be red; the others get their own colours back."""
        red = np.array([link.link > 0 and bool(bad[link.axis]) for link in self.links], dtype=bool)
        for index in np.flatnonzero(red != self.bad):
            self.materials[index].diffuseColor.setValue(
                *(BAD if red[index] else _colour(self.links[index]))
            )
        self.bad = red


def _colour(link: ExternalLink) -> tuple[float, float, float]:
    return STANDING if link.link == 0 else CARRYING if link.axes_after == 0 else MOVING
