# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fill Coin nodes from arrays: polylines, points, triangles and surfaces between two circles."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Any

import numpy as np
from pivy import coin

from ...core.geometry.curves.profile import RevolvedWall
from ...core.strategies.revolution.plan import Slices
from ...core.types import NDArray

Array = NDArray[Any]

DASHED = 0xF0F0


class Lines:
    """Unshaded polylines in one node, with a colour per vertex or a common colour."""

    def __init__(
        self, width: float = 2.0, colour: Sequence[float] = (0.2, 0.2, 0.2), pattern: int = 0xFFFF
    ) -> None:
        self.style = coin.SoDrawStyle()
        self.style.lineWidth = width
        self.style.linePattern = pattern
        self.colour = coin.SoMaterial()
        self.colour.diffuseColor.setValue(*colour)
        self.binding = coin.SoMaterialBinding()
        self.coordinates = coin.SoCoordinate3()
        self.lines = coin.SoLineSet()
        self.switch = coin.SoSwitch()
        node = coin.SoSeparator()
        for child in (
            unshaded(),
            self.style,
            self.colour,
            self.binding,
            self.coordinates,
            self.lines,
        ):
            node.addChild(child)
        self.switch.addChild(node)
        self.show(True)

    @property
    def node(self) -> Any:
        """The node to add to a scene."""
        return self.switch

    def show(self, visible: bool) -> None:
        """Show or hide the lines."""
        self.switch.whichChild = coin.SO_SWITCH_ALL if visible else coin.SO_SWITCH_NONE

    def set(self, points: Any, counts: Any) -> None:
        """Set the polylines: points (n, 3), and counts (m,) of points per polyline."""
        fill(self.coordinates.point, np.asarray(points, dtype=np.float32).reshape(-1, 3))
        fill(self.lines.numVertices, np.asarray(counts, dtype=np.int32))

    def paint(self, colours: Any) -> None:
        """Colour each point: colours (n, 3) in 0..1."""
        fill(self.colour.diffuseColor, np.asarray(colours, dtype=np.float32))
        self.binding.value = coin.SoMaterialBinding.PER_VERTEX


class Points:
    """Unshaded points of one colour."""

    def __init__(self, size: float, colour: Sequence[float]) -> None:
        style, material = coin.SoDrawStyle(), coin.SoMaterial()
        style.pointSize = size
        material.diffuseColor.setValue(*colour)
        self.coordinates = coin.SoCoordinate3()
        self.set_node = coin.SoPointSet()
        self.node = coin.SoSeparator()
        for child in (unshaded(), style, material, self.coordinates, self.set_node):
            self.node.addChild(child)
        self.set([])  # Coin starts with a point at the origin

    def set(self, points: Any) -> None:
        """Set the points (n, 3)."""
        values = np.asarray(points, dtype=np.float32).reshape(-1, 3)
        fill(self.coordinates.point, values)
        self.set_node.numPoints = len(values)


class Faces:
    """Translucent triangles of one colour, slightly in front of the same faces of a body."""

    def __init__(self, colour: Sequence[float], transparency: float) -> None:
        self.node = coin.SoSwitch()
        material, hints, offset = coin.SoMaterial(), coin.SoShapeHints(), coin.SoPolygonOffset()
        material.diffuseColor.setValue(*colour)
        material.transparency = transparency
        hints.vertexOrdering = coin.SoShapeHints.UNKNOWN_ORDERING  # both sides are visible
        # FreeCAD uses 1 for its faces and no offset for lines
        offset.factor, offset.units = 0.5, 0.5
        self.coordinates = coin.SoCoordinate3()
        self.triangles = coin.SoIndexedFaceSet()
        group = coin.SoSeparator()
        for child in (unshaded(), material, hints, offset, self.coordinates, self.triangles):
            group.addChild(child)
        self.node.addChild(group)
        self.show(True)

    def show(self, visible: bool) -> None:
        """Show or hide the triangles."""
        self.node.whichChild = coin.SO_SWITCH_ALL if visible else coin.SO_SWITCH_NONE

    def set(self, points: Any, corners: Any) -> None:
        """Set points (n, 3) and triangles (m, 3) of point indices."""
        corners = np.asarray(corners, dtype=np.int32).reshape(-1, 3)
        fill(self.coordinates.point, np.asarray(points, dtype=np.float32).reshape(-1, 3))
        fill(
            self.triangles.coordIndex,
            np.column_stack([corners, np.full(len(corners), -1, dtype=np.int32)]).ravel(),
        )


_KINDS = {
    coin.SoMFVec3f: np.float32,
    coin.SoMFColor: np.float32,
    coin.SoMFInt32: np.int32,
    coin.SoMFUInt32: np.uint32,
}


def fill(field: Any, values: Any) -> None:
    """Copy an array into a multiple-value field of vectors, colours or integers, and resize the
    field to it.

    The copy writes into the field's memory, because pivy treats an array as a Python list, number
    by number.
    """
    array = np.ascontiguousarray(values, dtype=_KINDS[type(field)])
    field.setNum(len(array))
    if array.size:
        buffer = field.startEditing()
        ctypes.memmove(int(getattr(buffer, "this", buffer)), array.ctypes.data, array.nbytes)
        field.finishEditing()


def unshaded() -> Any:
    """Return a node that shows colours without shading."""
    model = coin.SoLightModel()
    model.model = coin.SoLightModel.BASE_COLOR
    return model


def revolve(outline: Any, sides: int = 48) -> Any:
    """Revolve an outline (n, 2) of (radius, height) about Z; the outside is to the right of the
    outline.
    """
    outline = np.asarray(outline, dtype=np.float64)
    node, hints = coin.SoSeparator(), coin.SoShapeHints()
    hints.vertexOrdering = coin.SoShapeHints.CLOCKWISE
    hints.shapeType = coin.SoShapeHints.UNKNOWN_SHAPE_TYPE
    node.addChild(hints)
    angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    for start, end in zip(outline, outline[1:], strict=False):
        run, rise = end - start
        node.addChild(_strip(ring, start, end, np.array([rise, -run]) / np.hypot(run, rise)))
    return node


def _strip(ring: Any, start: Any, end: Any, normal: Any) -> Any:
    """Return the cone between two circles given by (radius, height), with its exact normals."""
    points = np.stack([np.column_stack([r * ring, np.full(len(ring), z)]) for r, z in (start, end)])
    normals = np.column_stack([normal[0] * ring, np.full(len(ring), normal[1])])
    node, coordinates, mesh = coin.SoSeparator(), coin.SoCoordinate3(), coin.SoQuadMesh()
    directions, binding = coin.SoNormal(), coin.SoNormalBinding()
    binding.set("value PER_VERTEX")  # as text, which Coin parses faster than pivy finds a field
    fill(coordinates.point, points.reshape(-1, 3).astype(np.float32))
    fill(directions.vector, np.concatenate([normals, normals]).astype(np.float32))
    mesh.set(f"verticesPerRow {len(ring)} verticesPerColumn 2")
    for child in (coordinates, directions, binding, mesh):
        node.addChild(child)
    return node


def transform_node(pose: Any) -> Any:
    """Return a transform node for a pose (4, 4)."""
    node = coin.SoMatrixTransform()
    node.matrix = coin.SbMatrix(*np.asarray(pose, dtype=np.float64).T.ravel().tolist())
    return node


COLOUR = (0.96, 0.47, 0.0)
MOST_LAYERS = 150  # maximum number of drawn layers, evenly spaced
SIDES = 72  # segments of a full turn
_NOTHING = np.zeros((0, 3))


class MeridianNodes:
    """Draws a wall, initially nothing."""

    def __init__(self) -> None:
        self.meridian, self.axis, self.layers = (
            Lines(3.0, COLOUR),
            Lines(2.0, COLOUR, DASHED),
            Lines(1.0, COLOUR),
        )
        self.switch = coin.SoSwitch()
        for lines in (self.meridian, self.axis, self.layers):
            self.switch.addChild(lines.node)
        self.show(True)

    def show(self, visible: bool) -> None:
        """Show or hide the nodes."""
        self.switch.whichChild = coin.SO_SWITCH_ALL if visible else coin.SO_SWITCH_NONE

    def clear(self) -> None:
        """Draw nothing."""
        for lines in (self.meridian, self.axis, self.layers):
            lines.set(_NOTHING, [])

    def set_wall(self, wall: RevolvedWall) -> None:
        """Draw meridian and axis; the axis protrudes at both ends."""
        radius, height = wall.meridian.points.T
        points = wall.points(radius, height, np.full(len(radius), wall.start))
        low, high = float(height.min()), float(height.max())
        over = 0.1 * max(high - low, float(radius.max()))
        ends = np.array([low - over, high + over])
        self.meridian.set(points, [len(points)])
        self.axis.set(wall.points(np.zeros(2), ends, np.zeros(2)), [2])

    def set_layers(self, wall: RevolvedWall, slices: Slices) -> None:
        """Draw the beads of the layers, or of an even selection of many layers."""
        count = len(slices.layer)
        indices = np.unique(np.linspace(0, count - 1, min(count, MOST_LAYERS)).round().astype(int))
        angles = np.linspace(
            wall.start, wall.end, max(2, round(SIDES * (wall.end - wall.start) / (2.0 * np.pi)) + 1)
        )
        radius, height = (
            np.repeat(column[indices], len(angles)) for column in (slices.radius, slices.height)
        )
        self.layers.set(
            wall.points(radius, height, np.tile(angles, len(indices))), [len(angles)] * len(indices)
        )
