# SPDX-License-Identifier: LGPL-2.1-or-later
"""The solids on a hub and the cylinders and cones that they stand on: chosen faces, a given surface, or found."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..core.geometry.developable import Developable
from ..core.geometry.mesh_repair import repaired
from ..core.geometry.on_hub import Base, Seat, downwards, upright
from ..core.geometry.solid_mesh import Array, SolidMesh
from ..core.geometry.surroundings import Body
from ..core.issues import InputError, Issue
from .sheet import tessellated

SHARE = 0.4  # of the chord error, between solids and their triangles
SAME = 1e-6  # relative; surfaces of faces that differ less are one


class Bodies(NamedTuple):
    """Solids as triangles, and what was repaired."""

    bodies: tuple[Body, ...]
    issues: tuple[Issue, ...]


def bodies_of(source: Any, label: str, chord_error: float) -> Bodies:
    """The solids of a Part.Shape, or the pieces of a mesh (a Mesh.Mesh, or a Body), in part coordinates.

    InputError NO_SOLID, and those of `mesh_repair.repaired`.
    """
    if isinstance(source, Body) or hasattr(source, "Topology"):
        if isinstance(source, Body):
            points, triangles = source.vertices, source.triangles
        else:
            points, triangles = (np.array([tuple(row) for row in rows]) for rows in source.Topology)
        found = repaired(np.asarray(points, dtype=np.float64), np.asarray(triangles, dtype=np.intp), label)
        return Bodies(_named(found.solids, label), found.issues)
    if source is None or source.isNull() or not source.Solids:
        raise InputError("NO_SOLID", label, "it has no solid; choose solids or closed meshes to deposit")
    made: list[tuple[Any, SolidMesh]] = []
    for solid in source.Solids:
        first = next((entry for entry in made if entry[0].isPartner(solid)), None)
        made.append((solid, _meshed(solid, chord_error, label) if first is None else _placed(*first, solid)))
    return Bodies(_named([mesh for _, mesh in made], label), ())


def _meshed(solid: Any, chord_error: float, label: str) -> SolidMesh:
    vertices, corners = tessellated(solid.copy(), SHARE * chord_error)[:2]
    mesh = SolidMesh(vertices, corners)
    mesh = dataclasses.replace(mesh, triangles=corners[:, ::-1]) if mesh.volume < 0.0 else mesh
    mesh.refuse_unsound(label)
    return mesh


def _placed(first: Any, mesh: SolidMesh, solid: Any) -> SolidMesh:
    """The mesh of a solid that differs from another by its place alone."""
    way = np.array(solid.Placement.multiply(first.Placement.inverse()).toMatrix().A).reshape(4, 4)
    return dataclasses.replace(mesh, vertices=mesh.vertices @ way[:3, :3].T + way[:3, 3])


def _named(solids: Sequence[SolidMesh], label: str) -> tuple[Body, ...]:
    names = [label] if len(solids) == 1 else [f"{label} solid {number + 1}" for number in range(len(solids))]
    return tuple(
        Body(name, solid.vertices, solid.triangles.astype(np.int64)) for name, solid in zip(names, solids, strict=True)
    )


def given(radius: float, height: float, point: Sequence[float], way: Sequence[float]) -> Seat:
    """A base by its numbers: middle of its base circle and direction of its axis, towards the apex, in the part."""
    z = np.array(way, dtype=np.float64)
    base = Base("the base", Developable(radius, height), upright(np.array(point, dtype=np.float64), z / np.linalg.norm(z)))
    return Seat(base, -math.inf, math.inf)


def seats(faces: Sequence[tuple[str, Any]], chosen: bool) -> list[Seat]:
    """The cylinders and cones of faces (name, Part.Face), one for faces of the same surface. With `chosen` other faces are
    refused, else left out: InputError NOT_DEVELOPABLE, INNER_FACE."""
    found: list[Seat] = []
    for name, face in faces:
        seat = _seat(name, face, chosen)
        if seat is None:
            continue
        for k, other in enumerate(found):
            shift = _shift(other.base, seat.base)
            if shift is not None:
                name = f"{other.base.name}, {name}"
                found[k] = Seat(
                    dataclasses.replace(other.base, name=name), min(other.low, seat.low + shift),
                    max(other.high, seat.high + shift),
                )
                break
        else:
            found.append(seat)
    return found


def _seat(name: str, face: Any, chosen: bool) -> Seat | None:
    kind = face.Surface.TypeId
    if kind not in ("Part::GeomCylinder", "Part::GeomCone"):
        if chosen:
            raise InputError(
                "NOT_DEVELOPABLE", name, "it is no cylinder and no cone; choose another face, or give strategy.base"
            )
        return None
    surface = face.Surface
    z = np.array(tuple(surface.Axis))
    if kind == "Part::GeomCone":
        origin = np.array(tuple(surface.Apex))
    else:
        origin = np.array(tuple(surface.Center))
    points = np.array([tuple(point) for edge in face.Edges for point in edge.discretize(16)])
    along = (points - origin) @ z
    if along.mean() > 0.0 if kind == "Part::GeomCone" else downwards(z):
        z, along = -z, -along
    if _faces_inwards(face, origin, z):
        if chosen:
            raise InputError("INNER_FACE", name, "it is the inside of a bore; solids grow on the outside of a hub")
        return None
    low, high = float(along.min()), float(along.max())
    if kind == "Part::GeomCylinder":
        shape = Developable(float(surface.Radius))
    else:
        taper = abs(float(surface.SemiAngle))
        shape = Developable(-low * math.tan(taper), -low)
    return Seat(Base(name, shape, upright(origin + low * z, z)), 0.0, high - low)


def _faces_inwards(face: Any, origin: Array, z: Array) -> bool:
    low, high, left, right = face.ParameterRange
    u, v = 0.5 * (low + high), 0.5 * (left + right)
    away = np.array(tuple(face.valueAt(u, v))) - origin
    away -= (away @ z) * z
    return bool(np.array(tuple(face.normalAt(u, v))) @ away < 0.0)


def _shift(one: Base, other: Base) -> float | None:
    """How far the frame of another base is up the axis of this one, where they are the same surface."""
    away = one.inside(other.frame[:3, 3])
    size = one.surface.radius
    alike = other.frame[:3, 2] @ one.frame[:3, 2] > 1.0 - SAME and math.hypot(away[0], away[1]) < SAME * size
    if not alike or abs(one.surface.taper - other.surface.taper) > SAME:
        return None
    rest = other.surface.radius - (one.surface.radius - away[2] * math.tan(one.surface.taper))
    return float(away[2]) if abs(rest) < SAME * size else None
