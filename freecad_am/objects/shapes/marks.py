# SPDX-License-Identifier: LGPL-2.1-or-later
"""What faces and edges of a part are known by, whatever their numbers are: FreeCAD gives these anew when a part changes."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, NamedTuple

import FreeCAD as App
import numpy as np
import Part

FACE, EDGE = "Face", "Edge"  # what names of them begin with
WHOLE = "Shape"  # the name of what is stored of a whole part
PLANE, LINE = "Part::GeomPlane", "Part::GeomLine"
ABOUT = (
    "Part::GeomCylinder",
    "Part::GeomCone",
    "Part::GeomToroid",
    "Part::GeomCircle",
    "Part::GeomEllipse",
)  # an axis
LEANS = np.radians(1.0)  # by which a face or an edge may turn and be the same
TOLERANCE = 1e-6  # of the part's size, squared of an area: by how much one may have moved, or grown, and be the same


class Mark(NamedTuple):
    """What a face, an edge or a whole part is known by where the part places itself: its surface or curve, of a whole the
    number of its faces, edges or both; the way that a plane faces, a line runs or the axis of another one runs (0 for
    others); area (mm2) or length (mm), and middle (mm)."""

    name: str
    form: str
    way: tuple[float, float, float]
    extent: float
    middle: tuple[float, float, float]

    def text(self) -> str:
        """As it is stored."""
        return " ".join(
            (
                self.name,
                self.form,
                *(repr(value) for value in (*self.way, self.extent, *self.middle)),
            )
        )

    def is_same(self, other: Mark, size: float, flat: bool = True) -> bool:
        """Whether nothing changed, of a part of a size (mm). flat: the extents are areas."""
        near = float(np.abs(np.subtract(self.middle, other.middle)).max()) <= TOLERANCE * size
        return (
            self.is_alike(other)
            and near
            and abs(self.extent - other.extent) <= TOLERANCE * size ** (2 if flat else 1)
        )

    def is_alike(self, other: Mark) -> bool:
        """Whether it is of the same kind of surface or curve and lies the same way, as a part that grows leaves it."""
        along = float(np.dot(self.way, other.way))
        lies = not any(self.way) or (along if self.form == PLANE else abs(along)) > np.cos(LEANS)
        return self.form == other.form and lies

    def is_along(self, other: Mark, size: float) -> bool:
        """Of straight edges, whether they lie on one line and share some of it; of plane faces, whether they lie in one
        plane, with middles so near that they do; of a part of a size (mm)."""
        if self.form not in (LINE, PLANE) or not self.is_alike(other):
            return False
        apart, extents = np.subtract(other.middle, self.middle), (self.extent, other.extent)
        along, across = (
            float(abs(apart @ self.way)),
            float(np.linalg.norm(np.cross(apart, self.way))),
        )
        if self.form == LINE:
            return across <= TOLERANCE * size and along < 0.5 * sum(extents)
        return along <= TOLERANCE * size and across < 0.5 * max(extents) ** 0.5

    def is_turned_about(self, other: Mark, size: float) -> bool:
        """Of straight edges, whether they share an end or the middle, as one does that is drawn by an end of it."""
        if self.form != LINE or other.form != LINE:
            return False
        mine, others = self._places(), other._places()
        found = [
            np.abs(mine[1] - others[1]),
            *(np.abs(one - another) for one in mine[::2] for another in others[::2]),
        ]
        return bool(min(map(np.max, found)) <= TOLERANCE * size)

    def _places(self) -> tuple[Any, Any, Any]:
        """Start, middle and end of a straight edge."""
        middle, half = np.array(self.middle), 0.5 * self.extent * np.array(self.way)
        return middle - half, middle, middle + half


def read(text: str) -> Mark | None:
    """What was stored; None of what is damaged."""
    try:
        name, form, *values = text.split(" ")
        i, j, k, extent, x, y, z = map(float, values)
    except ValueError:
        return None
    return Mark(name, form, (i, j, k), extent, (x, y, z))


def marks_of(shape: Any, kind: str, names: Collection[str] = ()) -> list[Mark]:
    """Of the faces or the edges of a shape; of those of these names, where there are some."""
    place = shape.Placement.inverse()
    all_ = enumerate(shape.Faces if kind == FACE else shape.Edges, start=1)
    return [
        _mark(f"{kind}{k}", one, place) for k, one in all_ if not names or f"{kind}{k}" in names
    ]


def whole_of(shape: Any, kinds: Collection[str]) -> Mark:
    """Of all of a shape, by its faces, its edges or both."""
    count = (len(shape.Faces) if FACE in kinds else 0) + (len(shape.Edges) if EDGE in kinds else 0)
    middle = shape.Placement.inverse().multVec(shape.BoundBox.Center)
    return Mark(
        WHOLE,
        str(count),
        (0.0, 0.0, 0.0),
        shape.Area if FACE in kinds else shape.Length,
        tuple(middle),
    )


def _mark(name: str, one: Any, place: Any) -> Mark:
    face = one.ShapeType == FACE
    try:
        found = one.Surface if face else one.Curve
        form, way = found.TypeId, App.Vector()
        if form == PLANE:
            way = place.Rotation.multVec(one.normalAt(0.0, 0.0))
        elif form == LINE:
            way = place.Rotation.multVec(found.Direction)
        elif form in ABOUT:
            way = place.Rotation.multVec(found.Axis)
    except (
        AttributeError,
        TypeError,
        RuntimeError,
        Part.OCCError,
    ):  # one that FreeCAD has no name for, or of no length
        form, way = "other", App.Vector()
    return Mark(
        name,
        form,
        tuple(way),
        one.Area if face else one.Length,
        tuple(place.multVec(one.CenterOfMass)),
    )
