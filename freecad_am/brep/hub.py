# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids on a hub and their bases: the cylinders and cones on which the solids grow.

Bases are selected faces, a surface given by numbers, or detected surfaces.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import least_squares

from ..core.geometry.columns import lengths
from ..core.geometry.developable import Developable
from ..core.geometry.frames import TURN
from ..core.geometry.mesh.manifold import find_holes, separate_vertices
from ..core.geometry.mesh.repair import Repaired, crossing_messages, mended_issues, repair_mesh
from ..core.geometry.mesh.solid import SolidMesh
from ..core.geometry.obstacles import Body
from ..core.geometry.on_hub import Base, Seat, Stretch, downwards, sector, upright
from ..core.issues import NOTE, WARNING, InputError, Issue, Text
from ..core.types import Array
from .kernel.limits import refuse_bare
from .kernel.process import in_kernel_process
from .revolution.axis import from_normals
from .shapes.no_solid import no_solid
from .shapes.part_depths import sections_agree
from .shapes.tessellate import WELDED, Tessellation, fine

FINER = (1.0, 0.8, 1.2, 0.5)  # factors on the requested deflection, in the order of attempts
MAX_DEFLECTIONS = (
    1.5  # maximum mean deviation of triangles from the shape over its area, in deflections
)


def complete_mesh(solid: Any, chord: float, label: str) -> tuple[Tessellation, tuple[Issue, ...]]:
    """Tessellate a Part.Solid within about `chord` mm, and check the enclosed volume.

    The volume may differ by about the solid's area times `chord`. If every attempt differs more,
    and the sections differ from the solid's sections too, return a warning MESH_VOLUME.
    """
    exact, area = abs(float(solid.Volume)), float(solid.Area)
    attempts: list[tuple[float, Tessellation]] = []
    for share in FINER:
        tessellation = in_kernel_process(fine, solid.copy(), share * chord)
        volume = abs(SolidMesh(tessellation.vertices, tessellation.triangles).volume)
        if abs(volume - exact) <= MAX_DEFLECTIONS * max(share, 1.0) * chord * area:
            return tessellation, ()
        attempts.append((volume, tessellation))
    volume, tessellation = attempts[0]
    if sections_agree(
        solid, tessellation.vertices, tessellation.triangles, chord, abs(volume - exact)
    ):
        return tessellation, ()  # the kernel's volume integral is wrong, not the mesh
    volume, tessellation = min(attempts, key=lambda attempt: abs(attempt[0] - exact))
    message = Text(
        "{}: the triangles enclose {:.4g} cm3, but the faces {:.4g} cm3; check the part and "
        "export it again, or deposit it from a mesh",
        label,
        1e-3 * volume,
        1e-3 * exact,
    )
    return tessellation, (Issue(WARNING, "MESH_VOLUME", message),)


SHARE = 0.4  # fraction of the chord error allowed between solids and their triangles
CROSSED = (
    5.0  # chord errors; allowed overlap of crossing triangles, which thin valid solids can have
)
TOLERANCE = 1e-6  # relative; surfaces that differ by less count as the same surface
FITTED = 1e-3  # mm; maximum deviation of a spline surface from a cylinder or cone
EDGE_SAMPLES = 361  # sample points per edge, sufficient for a full circle
MIN_GAP_RAD = math.radians(
    3.0
)  # minimum angular gap of a face; narrower gaps (keyways, sample spacing) are ignored
KNOWN = ("Part::GeomPlane", "Part::GeomSphere", "Part::GeomToroid")


class Bodies(NamedTuple):
    """Solids as triangles, and issues about repairs."""

    bodies: tuple[Body, ...]
    issues: tuple[Issue, ...]


def bodies_of(
    source: Any, label: str, chord_error: float, mend: float, touching: bool = False
) -> Bodies:
    """Return the solids of a Part.Shape or the pieces of a mesh, as triangles in part coordinates.

    source: a Part.Shape, Mesh.Mesh or Body. mend: maximum size of a mesh hole to close, mm.
    touching: whether a solid may touch itself along edges or intersect itself.

    Raises InputError NO_SOLID, SELF_CROSSING, and the errors of `repair_mesh`.
    """
    if isinstance(source, Body) or hasattr(source, "Topology"):
        if isinstance(source, Body):
            points, triangles = source.vertices, source.triangles
        else:
            points, triangles = (np.array([tuple(row) for row in rows]) for rows in source.Topology)
        result = repair_mesh(
            np.asarray(points, dtype=np.float64),
            np.asarray(triangles, dtype=np.intp),
            label,
            mend,
            touching,
        )
        return Bodies(_named(result.solids, label), result.issues)
    if source is None or source.isNull() or not source.Solids:
        raise no_solid(source, label, Text("choose solids or closed meshes to deposit"))
    meshed: list[tuple[Any, tuple[SolidMesh, ...]]] = []
    crossing: list[str] = []
    issues: list[Issue] = []
    for solid in source.Solids:
        twin = next((entry for entry in meshed if entry[0].isPartner(solid)), None)
        if twin is not None:
            meshed.append((solid, tuple(_move_mesh(twin[0], mesh, solid) for mesh in twin[1])))
            continue
        result = _meshed(solid, source, chord_error, label, mend, touching)
        meshed.append((solid, result.solids))
        issues += result.issues
        if touching and not result.issues:
            crossing += crossing_messages(result.solids[0], CROSSED * chord_error)
    return Bodies(
        _named([mesh for _, meshes in meshed for mesh in meshes], label),
        (*issues, *_loose(source, label), *mended_issues(label, crossing)),
    )


def _loose(source: Any, label: str) -> tuple[Issue, ...]:
    """Return a note on the faces and edges of a shape outside its solids, which are ignored."""
    of_solids = {face.hashCode() for solid in source.Solids for face in solid.Faces}
    of_faces = {edge.hashCode() for face in source.Faces for edge in face.Edges}
    faces = sum(face.hashCode() not in of_solids for face in source.Faces)
    edges = sum(edge.hashCode() not in of_faces for edge in source.Edges)
    if not faces and not edges:
        return ()
    text = Text(
        "{}: {} face(s) and {} edge(s) belong to no solid and are ignored",
        label,
        faces,
        edges,
    )
    return (Issue(NOTE, "FILE_CONTENT", text),)


def _meshed(
    solid: Any, source: Any, chord_error: float, label: str, mend: float, touching: bool
) -> Repaired:
    """Mesh a solid; repair the mesh if the faces of the solid do not meet."""
    tessellation, issues = complete_mesh(solid, SHARE * chord_error, label)
    vertices, corners = tessellation.vertices, tessellation.triangles
    if len(np.unique(tessellation.owner)) < len(solid.Faces):
        numbers = {face.hashCode(): number for number, face in enumerate(source.Faces, start=1)}
        named = [(f"Face{numbers[face.hashCode()]}", face) for face in solid.Faces]
        refuse_bare(named, tessellation.owner, label, WELDED)
    mesh = SolidMesh(vertices, corners)
    mesh = dataclasses.replace(mesh, triangles=corners[:, ::-1]) if mesh.volume < 0.0 else mesh
    try:
        mesh.refuse_unsound(label, of_shape=True, touching=touching)
    except InputError as unsound:
        try:
            result = repair_mesh(vertices, mesh.triangles, label, mend, touching)
            return result._replace(issues=(*result.issues, *issues))
        except InputError:
            widest = max(
                (hole.size for hole in find_holes(separate_vertices(vertices, mesh.triangles))),
                default=0.0,
            )
        if widest <= mend:
            raise
        raise InputError(
            unsound.code,
            label,
            "{}; openings up to strategy.mend = {:g} mm are closed automatically, but the widest "
            "is {:.4g} mm across",
            unsound.message,
            mend,
            widest,
        ) from None
    if not touching:
        mesh.refuse_crossing(label, CROSSED * chord_error)
    return Repaired((mesh,), issues)


def _move_mesh(source_solid: Any, mesh: SolidMesh, solid: Any) -> SolidMesh:
    """Return the mesh of `solid`, which differs from `source_solid` only in placement."""
    transform = np.array(
        solid.Placement.multiply(source_solid.Placement.inverse()).toMatrix().A
    ).reshape(4, 4)
    return dataclasses.replace(
        mesh, vertices=mesh.vertices @ transform[:3, :3].T + transform[:3, 3]
    )


def _named(solids: Sequence[SolidMesh], label: str) -> tuple[Body, ...]:
    names = (
        [label]
        if len(solids) == 1
        else [f"{label} solid {number + 1}" for number in range(len(solids))]
    )
    return tuple(
        Body(name, solid.vertices, solid.triangles.astype(np.int64))
        for name, solid in zip(names, solids, strict=True)
    )


def seat_of_numbers(
    radius: float, height: float, point: Sequence[float], direction: Sequence[float]
) -> Seat:
    """Return the base given by numbers, in part coordinates.

    point: centre of the base circle, mm. direction: axis direction, towards the apex.
    """
    z = np.array(direction, dtype=np.float64)
    base = Base(
        "the base",
        Developable(radius, height),
        upright(np.array(point, dtype=np.float64), z / np.linalg.norm(z)),
    )
    return Seat(base, (Stretch(-math.inf, math.inf),))


def seats(faces: Sequence[tuple[str, Any]], selected: bool) -> list[Seat]:
    """Return the cylinders and cones of faces (name, Part.Face), merging faces of one surface.

    With `selected`, raise InputError NOT_DEVELOPABLE or INNER_FACE for other faces. Otherwise
    ignore other faces.
    """
    seats_found: list[Seat] = []
    for name, face in faces:
        seat = _seat(name, face, selected)
        if seat is None:
            continue
        for k, known_seat in enumerate(seats_found):
            shift = _shift(known_seat.base, seat.base)
            if shift is not None:
                base = dataclasses.replace(known_seat.base, name=f"{known_seat.base.name}, {name}")
                new_faces = [
                    face._replace(low=face.low + shift, high=face.high + shift)
                    for face in seat.faces
                ]
                seats_found[k] = Seat(base, (*known_seat.faces, *new_faces), selected)
                break
        else:
            seats_found.append(seat)
    return seats_found


def _seat(name: str, face: Any, selected: bool) -> Seat | None:
    round_one = _round(face)
    if round_one is None:
        if selected:
            raise InputError(
                "NOT_DEVELOPABLE",
                name,
                "the face is neither a cylinder nor a cone; choose another face, or set "
                "strategy.base",
            )
        return None
    origin, z, radius, taper = round_one
    points = np.array(
        [tuple(point) for edge in face.Edges for point in edge.discretize(EDGE_SAMPLES)]
    )
    along = (points - origin) @ z
    if along.mean() > 0.0 if taper else downwards(z):
        z, along = -z, -along
    if _faces_inwards(face, origin, z):
        if selected:
            raise InputError(
                "INNER_FACE",
                name,
                "the face is the inside of a bore; choose the outer face of a hub",
            )
        return None
    low, high = float(along.min()), float(along.max())
    shape = Developable(-low * math.tan(taper), -low) if taper else Developable(radius)
    base = Base(name, shape, upright(origin + low * z, z))
    x, y = base.inside(points)[:, :2].T
    start, span = sector(np.arctan2(y, x)[np.hypot(x, y) > TOLERANCE * shape.radius])
    full_turn = span > TURN - MIN_GAP_RAD
    return Seat(
        base,
        (Stretch(0.0, high - low) if full_turn else Stretch(0.0, high - low, start, span),),
        selected,
    )


def _round(face: Any) -> tuple[Array, Array, float, float] | None:
    """Return axis point, unit axis, radius (mm) and half angle (rad) of a cylinder or cone.

    The axis point of a cone is the apex; its radius is 0. The half angle of a cylinder is 0. Spline
    and swept surfaces count if they fit a cylinder or cone within FITTED. None for other surfaces.
    """
    surface, kind = face.Surface, face.Surface.TypeId
    if kind == "Part::GeomCone":
        return (
            np.array(tuple(surface.Apex)),
            np.array(tuple(surface.Axis)),
            0.0,
            abs(float(surface.SemiAngle)),
        )
    if kind == "Part::GeomCylinder":
        return (
            np.array(tuple(surface.Center)),
            np.array(tuple(surface.Axis)),
            float(surface.Radius),
            0.0,
        )
    axis = None if kind in KNOWN else from_normals([face])
    if axis is None:
        return None
    origin, z = axis
    u0, u1, v0, v1 = face.ParameterRange
    parameters = [
        (u, v)
        for u in np.linspace(u0, u1, 25)
        for v in np.linspace(v0, v1, 25)
        if face.isPartOfDomain(u, v)
    ]
    points = np.array([tuple(surface.value(u, v)) for u, v in parameters]).reshape(-1, 3)
    if len(points) < 9 or _flat(points):
        return None
    origin, z = _best_axis(points, origin, z)
    along, rho, slope, at_origin = _profile(points, origin, z)
    if (
        np.abs(rho - slope * along - at_origin).max() > FITTED
        or np.ptp(along) <= FITTED
        or rho.max() <= FITTED
    ):
        return None
    if abs(slope) * np.ptp(along) <= FITTED:
        return origin, z, float(rho.mean()), 0.0
    return origin - at_origin / slope * z, z, 0.0, math.atan(abs(float(slope)))


def _flat(points: Array) -> bool:
    """Whether points (n, 3) are coplanar up to rounding; a slow axis fit to them would fail."""
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    return bool(spread[2] <= 1e-9 * spread[0])


def _profile(points: Array, origin: Array, z: Array) -> tuple[Array, Array, float, float]:
    """Return heights and radii (n,) of points about an axis, and a line fitted to them.

    The line is given by its slope and its radius at the origin.
    """
    along = (points - origin) @ z
    rho = lengths(points - origin - along[:, None] * z)
    slope, at_origin = np.linalg.lstsq(np.c_[along, np.ones(len(along))], rho, rcond=None)[0]
    return along, rho, float(slope), float(at_origin)


def _best_axis(points: Array, origin: Array, z: Array) -> tuple[Array, Array]:
    """Refine an axis so that points (n, 3) best fit a cylinder or cone about it."""
    middle = origin + ((points - origin) @ z).mean() * z
    across = np.linalg.svd(z[None])[2][1:]
    size = float(np.abs(points - middle).max())

    def shift_axis(by: Array) -> tuple[Array, Array]:
        turned = z + by[2:] @ across
        return middle + size * by[:2] @ across, turned / np.linalg.norm(turned)

    def residual(by: Array) -> Array:
        along, rho, slope, at_origin = _profile(points, *shift_axis(by))
        return (rho - slope * along - at_origin) / size

    return shift_axis(least_squares(residual, np.zeros(4), xtol=1e-14, ftol=1e-14, gtol=1e-14).x)


def _faces_inwards(face: Any, origin: Array, z: Array) -> bool:
    low, high, v_min, v_max = face.ParameterRange
    u, v = 0.5 * (low + high), 0.5 * (v_min + v_max)
    radial = np.array(tuple(face.valueAt(u, v))) - origin
    radial -= (radial @ z) * z
    return bool(np.array(tuple(face.normalAt(u, v))) @ radial < 0.0)


def _shift(base: Base, other: Base) -> float | None:
    """Return the height of the `other` frame along the axis of `base`, mm.

    None if the bases are different surfaces.
    """
    local_origin = base.inside(other.frame[:3, 3])
    size = base.surface.radius
    alike = (
        other.frame[:3, 2] @ base.frame[:3, 2] > 1.0 - TOLERANCE
        and math.hypot(local_origin[0], local_origin[1]) < TOLERANCE * size
    )
    if not alike or abs(base.surface.taper - other.surface.taper) > TOLERANCE:
        return None
    radius_gap = other.surface.radius - (
        base.surface.radius - local_origin[2] * math.tan(base.surface.taper)
    )
    return float(local_origin[2]) if abs(radius_gap) < TOLERANCE * size else None
