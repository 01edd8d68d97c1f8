# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tube-like walls from shape faces: torus, cylinder, cone, or a tabulated closed surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.geometry.frames import TURN
from ...core.geometry.walls.surface_wall import CONE, TABLE, TORUS, Placed, own_surface
from ...core.issues import InputError, Word
from ...core.types import Array

AGREEMENT_MM = 1e-6  # mm; faces of one surface agree within this
TABLE_ERROR = 5e-5  # mm; maximum interpolation error between the samples of a table
SMALLEST_TABLE, LARGEST_TABLE = (24, 48), (384, 768)
SMOOTH = 1e-6  # maximum difference of the unit tangents at the seam of a closed surface
_ANALYTIC = {"Part::GeomToroid": TORUS, "Part::GeomCylinder": CONE, "Part::GeomCone": CONE}


@dataclass(frozen=True, eq=False)
class Tube:
    """A tube-like surface in part coordinates. u runs from 0 at the lower end to `end`.

    `SurfaceWall` describes the other fields.
    """

    kind: str
    sizes: tuple[float, ...]
    frame: Array
    end: float
    faces: tuple[str, ...]
    u: Array | None = None
    v: Array | None = None
    table: Array | None = None
    period: float = TURN

    def surface(self) -> Placed:
        """Return the surface in part coordinates."""
        return Placed(
            own_surface(self.kind, self.sizes, self.u, self.v, self.table, self.period), self.frame
        )


def tubes(
    shape: Any, names: Sequence[str], label: str
) -> tuple[list[tuple[str, Any]], tuple[Tube, Tube]]:
    """Return the named wall faces, and their surface as two tubes, one starting from each end.

    names: names of the wall faces; empty for the only curved face. Raises InputError NO_WALL,
    UNKNOWN_FACE; NOT_ONE_SURFACE for faces of different surfaces; NOT_CLOSED for a wall without a
    closed direction.
    """
    named = _chosen(shape, names, label)
    first_name, first_face = named[0]
    kind = _ANALYTIC.get(first_face.Surface.TypeId, TABLE)
    if kind == TABLE and len(named) > 1:
        raise InputError(
            "NOT_ONE_SURFACE",
            label,
            "{} is not a torus, cylinder or cone, as a wall of several faces requires; choose a "
            "single face",
            first_name,
        )
    for name, face in named[1:]:
        _refuse_other(first_face, face, f"{label} {name}", first_name)
    face_names = tuple(name for name, _ in named)
    if kind == TABLE:
        return named, _tables(first_face, face_names, label)
    low, high = _ranges([face for _, face in named], kind, label)
    make_tube = _torus if kind == TORUS else _cone
    return named, (
        make_tube(first_face.Surface, low, high, face_names),
        make_tube(first_face.Surface, high, low, face_names),
    )


def faces_by_name(shape: Any, names: Sequence[str], label: str) -> dict[str, Any]:
    """Return all faces of a shape by name (Face1 and so on).

    Raises InputError NO_WALL for a shape without faces, UNKNOWN_FACE for an unknown name.
    """
    if shape is None or shape.isNull() or not shape.Faces:
        raise InputError("NO_WALL", label, "the object has no faces; choose a part with wall faces")
    faces = {f"Face{index}": face for index, face in enumerate(shape.Faces, start=1)}
    for name in names:
        if name not in faces:
            raise InputError(
                "UNKNOWN_FACE",
                label,
                "the shape has no {}; choose a face from Face1 to Face{}",
                name,
                len(faces),
            )
    return faces


def _chosen(shape: Any, names: Sequence[str], label: str) -> list[tuple[str, Any]]:
    faces = faces_by_name(shape, names, label)
    if names:
        return [(name, faces[name]) for name in dict.fromkeys(names)]
    curved = [
        (name, face) for name, face in faces.items() if face.Surface.TypeId != "Part::GeomPlane"
    ]
    if len(curved) != 1:
        raise InputError(
            "NO_WALL",
            label,
            "the object has {} curved faces; name the wall faces in part.faces",
            len(curved),
        )
    return curved


def _refuse_other(first_face: Any, face: Any, where: str, first_name: str) -> None:
    """Raise InputError unless both faces have the same surface."""
    surface = first_face.Surface
    low_u, high_u, low_v, high_v = face.ParameterRange
    points = [
        face.valueAt(a, b)
        for a in np.linspace(low_u, high_u, 4)
        for b in np.linspace(low_v, high_v, 4)
    ]
    off = max((surface.value(*surface.parameter(point)) - point).Length for point in points)
    if surface.TypeId != face.Surface.TypeId or off > AGREEMENT_MM:
        raise InputError(
            "NOT_ONE_SURFACE",
            where,
            "the face is {1:.3g} mm off the surface of {0}; walls of several surfaces cannot be "
            "deposited yet: choose faces of one torus, cylinder or cone",
            first_name,
            off,
        )


def _ranges(faces: list[Any], kind: str, label: str) -> tuple[float, float]:
    """Return the range of the axial parameter of the first face's surface.

    Raises InputError NOT_CLOSED if the faces do not close around the tube.
    """
    surface, rising, around = faces[0].Surface, [], []
    for face in faces:
        low_u, high_u, low_v, high_v = face.ParameterRange
        along, turn = (
            ((low_u, high_u), (low_v, high_v))
            if kind == TORUS
            else ((low_v, high_v), (low_u, high_u))
        )
        middle = face.valueAt(0.5 * (low_u + high_u), 0.5 * (low_v + high_v))
        parameters = surface.parameter(middle)
        rising.append(
            _about(
                parameters[0] if kind == TORUS else parameters[1],
                along,
                TURN if kind == TORUS else 0.0,
            )
        )
        around.append(_about(parameters[1] if kind == TORUS else parameters[0], turn, TURN))
    if not _covered(around):
        raise InputError(
            "NOT_CLOSED",
            label,
            "the wall faces do not form a closed tube; open walls (half shells) cannot be "
            "deposited yet: choose a full tube",
        )
    low, high = min(low for low, _ in rising), max(high for _, high in rising)
    if kind == TORUS and high - low > TURN - 1e-6:
        raise InputError(
            "NO_WALL",
            label,
            "a full ring has no end to start from; cut the ring at the substrate",
        )
    return low, high


def _about(middle: float, own_range: tuple[float, float], period: float) -> tuple[float, float]:
    """Return a range as wide as `own_range`, centred at `middle` on the first surface.

    If `middle` differs from the centre of `own_range` by whole periods, keep `own_range`.
    """
    half, own_middle = 0.5 * (own_range[1] - own_range[0]), 0.5 * (own_range[0] + own_range[1])
    if (
        period
        and abs(np.remainder(middle - own_middle + 0.5 * period, period) - 0.5 * period) < 1e-6
    ):
        middle = own_middle
    return middle - half, middle + half


def _covered(ranges: list[tuple[float, float]]) -> bool:
    """Whether angle ranges cover a full revolution."""
    ends = sorted((float(np.mod(low, TURN)), high - low) for low, high in ranges)
    reached = ends[0][0]
    for low, width in ends:
        if low > reached + 1e-6:
            return False
        reached = max(reached, low + width)
    return bool(reached >= ends[0][0] + TURN - 1e-6)


def _torus(surface: Any, start: float, end: float, faces: tuple[str, ...]) -> Tube:
    centre = _array(surface.Center)
    turn = _array(surface.tangent(start, 0.0)[0]) * np.sign(end - start)
    out = _unit(_array(surface.value(start, 0.0)) - centre)
    up = _unit(turn - (turn @ out) * out)
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([out, np.cross(up, out), up])
    frame[:3, 3] = centre + surface.MajorRadius * out
    return Tube(
        TORUS,
        (float(surface.MajorRadius), float(surface.MinorRadius)),
        frame,
        abs(end - start),
        faces,
    )


def _cone(surface: Any, start: float, end: float, faces: tuple[str, ...]) -> Tube:
    centre, axis = _array(surface.Center), _unit(_array(surface.Axis))
    low, high = _array(surface.value(0.0, start)), _array(surface.value(0.0, end))
    axis = axis if (high - low) @ axis > 0.0 else -axis
    heights = [(point - centre) @ axis for point in (low, high)]
    feet = [centre + height * axis for height in heights]
    radius, upper = (
        float(np.linalg.norm(point - foot)) for point, foot in zip((low, high), feet, strict=True)
    )
    slope = float(np.arctan2(upper - radius, heights[1] - heights[0]))
    out = _unit((low - feet[0]) if radius > upper else (high - feet[1]))
    frame = np.eye(4)
    frame[:3, :3] = np.column_stack([out, np.cross(axis, out), axis])
    frame[:3, 3] = feet[0]
    return Tube(CONE, (radius, slope), frame, abs(end - start), faces)


def _tables(face: Any, faces: tuple[str, ...], label: str) -> tuple[Tube, Tube]:
    surface = face.Surface
    low_u, high_u, low_v, high_v = face.ParameterRange
    closed_u = surface.isUClosed() and _spans(surface.bounds()[:2], low_u, high_u)
    closed_v = surface.isVClosed() and _spans(surface.bounds()[2:], low_v, high_v)
    if closed_u == closed_v:
        what = "closes on itself both ways" if closed_u else "has no closed direction"
        raise InputError(
            "NOT_CLOSED",
            f"{label} {faces[0]}",
            "the face {}; choose a tube that is closed around",
            Word(what),
        )
    along, around = (
        ((low_v, high_v), (low_u, high_u)) if closed_u else ((low_u, high_u), (low_v, high_v))
    )

    def value(a: float, b: float) -> Any:
        return surface.value(b, a) if closed_u else surface.value(a, b)

    def sampled(rows: Array, columns: Array) -> Array:
        return np.array([[tuple(value(a, b)) for b in columns] for a in rows])

    _refuse_seam(surface, closed_u, along, around, f"{label} {faces[0]}")
    n, m = SMALLEST_TABLE
    span, period = along[1] - along[0], around[1] - around[0]
    while True:
        u, v = np.linspace(0.0, span, n + 1), period * np.arange(m) / m
        points = sampled(along[0] + u, around[0] + v)
        rows, columns = (
            (u[:-1] + 0.5 * u[1])[:: max(1, n // 16)],
            (v + 0.5 * v[1])[:: max(1, m // 16)],
        )
        table = own_surface(TABLE, (), u, v, points, period)
        evaluated = table.point(*np.meshgrid(rows, columns, indexing="ij"))
        error = float(
            np.linalg.norm(evaluated - sampled(along[0] + rows, around[0] + columns), axis=-1).max()
        )
        if error <= TABLE_ERROR:
            break
        if n >= LARGEST_TABLE[0]:
            raise InputError(
                "ROUGH_WALL",
                f"{label} {faces[0]}",
                "the wall bends too sharply: the error is {:.3g} mm between {} x {} samples; "
                "smooth the wall, or cut it at the crease",
                error,
                n,
                m,
            )
        n, m = 2 * n, 2 * m
    turned = points[::-1, ::-1]  # reverse both directions, so that the outside stays outside
    return (
        Tube(TABLE, (), np.eye(4), span, faces, u, v, points, period),
        Tube(TABLE, (), np.eye(4), span, faces, u, v, np.ascontiguousarray(turned), period),
    )


def _spans(bounds: Any, low: float, high: float) -> bool:
    return bool(abs(abs(bounds[1] - bounds[0]) - (high - low)) < 1e-9 * max(1.0, high - low))


def _refuse_seam(
    surface: Any,
    closed_u: bool,
    along: tuple[float, float],
    around: tuple[float, float],
    where: str,
) -> None:
    """Raise InputError ROUGH_WALL if a closed surface has a crease along its seam."""
    for a in np.linspace(*along, 5)[1:-1]:
        ends = [surface.tangent(b, a)[0] if closed_u else surface.tangent(a, b)[1] for b in around]
        tangent, other_tangent = (_unit(_array(end)) for end in ends)
        if np.linalg.norm(tangent - other_tangent) > SMOOTH:
            raise InputError(
                "ROUGH_WALL",
                where,
                "the face has a crease along its seam, which cannot be deposited yet; smooth the "
                "crease",
            )


def _array(vector: Any) -> Array:
    return np.array([vector.x, vector.y, vector.z])


def _unit(vector: Array) -> Array:
    unit: Array = vector / np.linalg.norm(vector)
    return unit
