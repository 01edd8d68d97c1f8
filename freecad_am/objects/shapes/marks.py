# SPDX-License-Identifier: LGPL-2.1-or-later
"""Marks that identify faces and edges of a part independently of their numbers, which FreeCAD
reassigns when a part changes.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple

import FreeCAD as App
import numpy as np
import Part

FACE, EDGE = "Face", "Edge"  # prefixes of their names
WHOLE_PART = "Shape"  # the name of the mark of a whole part
PLANE, LINE = "Part::GeomPlane", "Part::GeomLine"
AXIAL_SURFACES = (
    "Part::GeomCylinder",
    "Part::GeomCone",
    "Part::GeomToroid",
    "Part::GeomCircle",
    "Part::GeomEllipse",
)  # an axis
LEANS = np.radians(1.0)  # by which a face or an edge may turn and be the same
TOLERANCE = 1e-6  # of the part's size, squared of an area: by how much one may have moved, or grown, and be the same


class Mark(NamedTuple):
    """The mark of a face, an edge or a whole part in the part's own coordinates: its surface or
    curve (for a whole part the number of its faces, edges or both); the direction of a plane's
    normal, a line or an axis (0 for others); area (mm2) or length (mm), and middle (mm).
    """

    name: str
    form: str
    direction: tuple[float, float, float]
    extent: float
    middle: tuple[float, float, float]

    def text(self) -> str:
        """As it is stored."""
        return " ".join(
            (
                self.name,
                self.form,
                *(repr(value) for value in (*self.direction, self.extent, *self.middle)),
            )
        )

    def is_same(self, other_mark: Mark, size: float, flat: bool = True) -> bool:
        """Whether nothing changed, of a part of a size (mm). flat: the extents are areas."""
        is_near = (
            float(np.abs(np.subtract(self.middle, other_mark.middle)).max()) <= TOLERANCE * size
        )
        return (
            self.is_alike(other_mark)
            and is_near
            and abs(self.extent - other_mark.extent) <= TOLERANCE * size ** (2 if flat else 1)
        )

    def is_alike(self, other_mark: Mark) -> bool:
        """Whether it has the same kind of surface or curve and the same direction, which a growing
        part keeps.
        """
        along = float(np.dot(self.direction, other_mark.direction))
        lies = not any(self.direction) or (along if self.form == PLANE else abs(along)) > np.cos(
            LEANS
        )
        return self.form == other_mark.form and lies

    def is_along(self, other_mark: Mark, size: float) -> bool:
        """Whether two straight edges are collinear and overlap, or two plane faces are coplanar
        with near middles. size: of the part, mm.
        """
        if self.form not in (LINE, PLANE) or not self.is_alike(other_mark):
            return False
        offset, extents = (
            np.subtract(other_mark.middle, self.middle),
            (self.extent, other_mark.extent),
        )
        along, across = (
            float(abs(offset @ self.direction)),
            float(np.linalg.norm(np.cross(offset, self.direction))),
        )
        if self.form == LINE:
            return across <= TOLERANCE * size and along < 0.5 * sum(extents)
        return along <= TOLERANCE * size and across < 0.5 * max(extents) ** 0.5

    def is_turned_about(self, other_mark: Mark, size: float) -> bool:
        """Whether two straight edges share an end or the middle, as after dragging an end."""
        if self.form != LINE or other_mark.form != LINE:
            return False
        own_points, other_points = self._places(), other_mark._places()
        distances = [
            np.abs(own_points[1] - other_points[1]),
            *(
                np.abs(own_point - other_point)
                for own_point in own_points[::2]
                for other_point in other_points[::2]
            ),
        ]
        return bool(min(map(np.max, distances)) <= TOLERANCE * size)

    def _places(self) -> tuple[Any, Any, Any]:
        """Start, middle and end of a straight edge."""
        middle, half = np.array(self.middle), 0.5 * self.extent * np.array(self.direction)
        return middle - half, middle, middle + half


def read(text: str) -> Mark | None:
    """The stored mark, or None if damaged."""
    try:
        name, form, *values = text.split(" ")
        i, j, k, extent, x, y, z = map(float, values)
    except ValueError:
        return None
    return Mark(name, form, (i, j, k), extent, (x, y, z))


def marks_of(shape: Any, kind: str, names: Collection[str] = ()) -> list[Mark]:
    """The marks of the faces or edges of a shape, or only of the named ones."""
    inverse_placement = shape.Placement.inverse()
    all_ = enumerate(shape.Faces if kind == FACE else shape.Edges, start=1)
    return [
        _mark(f"{kind}{k}", element, inverse_placement)
        for k, element in all_
        if not names or f"{kind}{k}" in names
    ]


def whole_of(shape: Any, kinds: Collection[str]) -> Mark:
    """The mark of a whole shape, by its faces, its edges or both."""
    count = (len(shape.Faces) if FACE in kinds else 0) + (len(shape.Edges) if EDGE in kinds else 0)
    middle = shape.Placement.inverse().multVec(shape.BoundBox.Center)
    return Mark(
        WHOLE_PART,
        str(count),
        (0.0, 0.0, 0.0),
        shape.Area if FACE in kinds else shape.Length,
        tuple(middle),
    )


def _mark(name: str, element: Any, inverse_placement: Any) -> Mark:
    face = element.ShapeType == FACE
    try:
        geometry = element.Surface if face else element.Curve
        form, direction = geometry.TypeId, App.Vector()
        if form == PLANE:
            direction = inverse_placement.Rotation.multVec(element.normalAt(0.0, 0.0))
        elif form == LINE:
            direction = inverse_placement.Rotation.multVec(geometry.Direction)
        elif form in AXIAL_SURFACES:
            direction = inverse_placement.Rotation.multVec(geometry.Axis)
    except (
        AttributeError,
        TypeError,
        RuntimeError,
        Part.OCCError,
    ):  # a kind that FreeCAD has no name for, or without length
        form, direction = "other", App.Vector()
    return Mark(
        name,
        form,
        tuple(direction),
        element.Area if face else element.Length,
        tuple(inverse_placement.multVec(element.CenterOfMass)),
    )
