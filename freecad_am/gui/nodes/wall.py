# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw a wall on a substrate: its tinted faces, and the curves in which its first layer leaves the
substrate.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from pivy import coin

from ...core.issues import InputError
from ...core.types import Array
from ...objects.shapes.bodies import Taken, snapshot_of
from .lines import DASHED, Faces, Lines

COLOUR = (0.96, 0.47, 0.0)
TINT = (1.0, 0.62, 0.2)
_COARSE = 0.004  # chord error of the tinted faces as a fraction of the shape's size; FreeCAD's display is finer
_NOTHING = np.zeros((0, 3))
NONE = (_NOTHING, np.zeros((0, 3), dtype=np.int32))  # points and triangles


class WallNodes:
    """Draws a wall. Clicks pass through the faces, and also through the lines unless `pickable`."""

    tint, transparency = TINT, 0.72

    def __init__(self, pickable: bool) -> None:
        self.root = coin.SoSeparator()
        self.faces = Faces(self.tint, self.transparency)
        self.first = Lines(4.0, COLOUR)
        self.hidden = Lines(1.5, COLOUR, DASHED)
        behind = coin.SoSeparator()
        depth = coin.SoDepthBuffer()
        depth.test = False
        lines = coin.SoSeparator()
        for parent, child in (
            (self.root, lines),
            (lines, self.first.node),
            (self.root, unpickable()),
            (behind, depth),
            (behind, self.hidden.node),
            (self.root, self.faces.node),
            (self.root, behind),
        ):
            parent.addChild(child)
        if not pickable:
            lines.insertChild(unpickable(), 0)
        self.switch = coin.SoSwitch()
        self.switch.addChild(self.root)
        self.show(True)

    def show(self, visible: bool) -> None:
        """Show or hide the nodes."""
        self.switch.whichChild = coin.SO_SWITCH_ALL if visible else coin.SO_SWITCH_NONE

    def set_first(self, curves: Sequence[Array]) -> None:
        """Draw the first layers, each (k, 3); closed curves repeat the first point."""
        points = np.concatenate([_NOTHING, *curves])
        for lines in (self.first, self.hidden):
            lines.set(points, [len(curve) for curve in curves])

    def set_faces(self, source: Any, names: Sequence[str]) -> None:
        """Tint faces of an object, all faces without names; nothing if a name is unknown."""
        try:
            mesh = face_mesh(snapshot_of(source), names)
        except InputError:  # the shape is not read yet
            mesh = NONE
        self.faces.set(*mesh)


def unpickable() -> Any:
    """Create a node that passes clicks to objects behind."""
    style = coin.SoPickStyle()
    style.style = coin.SoPickStyle.UNPICKABLE
    return style


def first_curves(wall: Any) -> list[Array]:
    """Return the curves (k, 3) in which a wall leaves its substrate; closed curves repeat the first
    point.
    """
    curves = wall.first
    if isinstance(curves, np.ndarray):
        return [np.concatenate([curves, curves[:1]])]
    return [
        np.concatenate([curve.points, curve.points[:1]]) if curve.closed else curve.points
        for curve in curves
    ]


def face_mesh(snapshot: Taken, names: Sequence[str]) -> tuple[Array, Array]:
    """Return points (n, 3) and triangles (m, 3) of a mesh or of named faces, all faces without
    names; NONE if a name is unknown.

    Raises InputError NO_FACES.
    """
    if snapshot.shape is not None:
        return triangles_of(snapshot.shape.copy(False, True), names)
    body = snapshot.body()
    return body.vertices, body.triangles.astype(np.int32)


def triangles_of(shape: Any, names: Sequence[str]) -> tuple[Array, Array]:
    """Return points (n, 3) and triangles (m, 3) of named faces, all faces without names; NONE if a
    name is unknown.

    Uses the shape's own display triangles, because other triangles would intersect them.
    """
    try:
        faces = [
            shape.getElement(name.rsplit(".", maxsplit=1)[-1]) for name in names
        ] or shape.Faces
    except (ValueError, IndexError, RuntimeError):  # the shape has changed
        return NONE
    points, corners, count = [_NOTHING], [NONE[1]], 0
    for face in faces:
        vertices, triangles = face.tessellate(max(1e-3, _COARSE * shape.BoundBox.DiagonalLength))
        points.append(np.array([tuple(vertex) for vertex in vertices]).reshape(-1, 3))
        corners.append(np.array(triangles, dtype=np.int32).reshape(-1, 3) + count)
        count += len(vertices)
    return np.concatenate(points), np.concatenate(corners)
