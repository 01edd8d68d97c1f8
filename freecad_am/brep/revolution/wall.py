# SPDX-License-Identifier: LGPL-2.1-or-later
"""Detect the wall of a part of revolution: its faces, axis and meridian."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import Part

from ...core.geometry.curves import contour
from ...core.geometry.curves.contour import Chain, Piece
from ...core.geometry.curves.profile import Meridian, RevolvedWall
from ...core.issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...core.types import Array, Index, Mask
from .axis import candidates
from .cylindrical import AxisFrame, as_array, axis_frame, edge_points, has_lost_pole, pieces_of
from .patch import Patch, common_turn, merged, patch_of, planar

# ---- Quick test by a few normals: faces that are certainly not of revolution about an axis

SAMPLES_ACROSS = 5  # number of samples along each parameter of a curved face
SLOPE = 0.2  # maximum circumferential component of a normal; far above rounding in files
NARROW = 0.1  # mm; narrower faces may be of revolution within tolerance despite their normals
ON_AXIS = 1e-3  # mm


class Normals(NamedTuple):
    """Points (n, 3) on faces, unit normals (n, 3), and face indices (n,).

    flat: (faces,) bool. wide: (faces,) bool, whether a face is wide enough for the normal test.
    """

    points: Array
    normals: Array
    face: Index
    flat: Mask
    wide: Mask


def normals_of(faces: Sequence[Any]) -> Normals:
    """Return a few normals of each face, at points inside the trimmed face."""
    flat = np.array([planar(face) for face in faces], dtype=bool)
    points: list[Any] = []
    directions: list[Any] = []
    counts = []
    for face, is_flat in zip(faces, flat.tolist(), strict=True):
        samples = _flat(face) if is_flat else _curved(face)
        points += [point for point, _ in samples]
        directions += [normal for _, normal in samples]
        counts.append(len(samples))
    wide = np.array([2.0 * face.Area > NARROW * face.Length for face in faces], dtype=bool)
    return Normals(
        as_array(points), as_array(directions), np.repeat(np.arange(len(faces)), counts), flat, wide
    )


def surely_off(samples: Normals, frame: AxisFrame) -> Mask:
    """Return a mask (faces,) of faces that are certainly not of revolution about the axis.

    Such faces have a normal with a circumferential component. Planes along the axis, which only
    bound a partial revolution, are excluded.
    """
    points, normals = frame.local(samples.points), samples.normals @ frame.rotation
    radius = np.hypot(points[:, 0], points[:, 1])
    around = np.abs(points[:, 0] * normals[:, 1] - points[:, 1] * normals[:, 0]) / np.maximum(
        radius, ON_AXIS
    )
    through = np.abs((points[:, :2] * normals[:, :2]).sum(axis=1)) < NARROW
    ends = samples.flat[samples.face] & through & (np.abs(normals[:, 2]) < SLOPE)
    leans = (around > SLOPE) & (radius > NARROW) & ~ends
    return np.bincount(samples.face[leans], minlength=len(samples.flat)).astype(bool) & samples.wide


def _flat(face: Any) -> list[tuple[Any, Any]]:
    """Return the start points of the first edges of a flat face, with the constant normal."""
    u, v = (0.5 * (low + high) for low, high in (face.ParameterRange[:2], face.ParameterRange[2:]))
    return [
        (edge.valueAt(edge.FirstParameter), face.Surface.normal(u, v)) for edge in face.Edges[:4]
    ]


def _curved(face: Any) -> list[tuple[Any, Any]]:
    u0, u1, v0, v1 = face.ParameterRange
    inner = (np.arange(SAMPLES_ACROSS) + 0.5) / SAMPLES_ACROSS
    samples = []
    for u in (u0 + inner * (u1 - u0)).tolist():
        for v in (v0 + inner * (v1 - v0)).tolist():
            if face.isPartOfDomain(u, v):
                try:
                    samples.append((face.Surface.value(u, v), face.Surface.normal(u, v)))
                except (RuntimeError, Part.OCCError):
                    continue  # degenerate point of the surface
    return samples


ACROSS = 1e-3  # mm; maximum distance of an edge from the half plane of the wire


def pieces_of_edges(shape: Any, frame: AxisFrame, label: str) -> list[Piece]:
    """Return the edges as meridian pieces of a full revolution, without edges on the axis.

    Raises InputError NOT_REVOLUTION if the edges cross the axis or are not coplanar with the axis,
    NO_WALL if no edge remains.
    """
    edges = [
        (f"Edge{i}", edge) for i, edge in enumerate(shape.Edges, start=1) if not edge.Degenerated
    ]
    points = {name: frame.local(edge_points(edge, 17)) for name, edge in edges}
    off_axis = [
        (name, edge) for name, edge in edges if np.hypot(*points[name][:, :2].T).max() > ACROSS
    ]
    if not off_axis:
        raise InputError("NO_WALL", label, "all edges are on the axis; choose another axis")
    everything = np.vstack([points[name] for name, _ in off_axis])
    outward = everything[np.argmax(np.hypot(everything[:, 0], everything[:, 1])), :2]
    outward = outward / np.linalg.norm(outward)
    for name, _ in off_axis:
        across = np.abs(points[name][:, 0] * outward[1] - points[name][:, 1] * outward[0]).max()
        if across > ACROSS:
            raise InputError(
                "NOT_REVOLUTION",
                f"{label} {name}",
                "the edge is {:.4g} mm off the plane of the wire and the axis; draw the wire in "
                "a plane through the axis",
                across,
            )
        behind = float((points[name][:, :2] @ outward).min())
        if behind < -ACROSS:
            raise InputError(
                "NOT_REVOLUTION",
                f"{label} {name}",
                "the edge crosses the axis by {:.4g} mm; keep the wire on one side of the axis",
                -behind,
            )
    return [
        Piece(name, samples, tangents)
        for name, edge in off_axis
        for samples, tangents in pieces_of(edge.Curve, frame, *edge.ParameterRange)
    ]


SLIVER = 1e-3  # mm; narrower faces are ignored
MOSTLY = 0.5  # minimum fraction of the total surface for the only solid with a wall
JUDGED = 24  # maximum number of deviating faces that are evaluated for the message

Named = tuple[str, Any]


def find_wall(
    shape: Any,
    faces: Sequence[str] = (),
    wall: str = "outer",
    axis: tuple[Any, Any] | None = None,
    label: str = "part",
) -> RevolvedWall:
    """Detect the wall of a Part.Shape as a meridian revolved about an axis, in shape coordinates.

    faces: names of the wall faces, such as 'Face3'; empty for all. wall: for a solid or closed
    shell without face names, the outer or inner wall without flat end faces, or the middle surface.
    axis: point and direction; required for wires and sketches, detected on surfaces.

    Raises InputError NO_WALL, NOT_REVOLUTION (naming face and deviation in mm), NO_AXIS,
    UNKNOWN_FACE, SEVERAL_SOLIDS; NOT_OF_REVOLUTION if most of several solids are not of revolution.
    """
    if shape is None or shape.isNull():
        raise InputError("NO_WALL", label, "the shape is empty; choose an object with a shape")
    if not shape.Faces:
        return _from_edges(shape, wall, axis, label)
    named = [(f"Face{index}", face) for index, face in enumerate(shape.Faces, start=1)]
    if faces:
        return _from_faces(_chosen(named, faces, label), wall, axis, label, selected=True)
    if len(shape.Solids) > 1:
        return _only_solid(shape, named, wall, axis, label)
    is_closed = bool(shape.Shells) and all(shell.isClosed() for shell in shape.Shells)
    return _from_faces(named, wall, axis, label, selected=False, is_closed=is_closed)


def _chosen(named: list[Named], faces: Sequence[str], label: str) -> list[Named]:
    faces_by_name = dict(named)
    for name in faces:
        if name not in faces_by_name:
            raise InputError(
                "UNKNOWN_FACE",
                label,
                "the shape has no {}; choose a face from Face1 to Face{}",
                name,
                len(named),
            )
    return [(name, faces_by_name[name]) for name in dict.fromkeys(faces)]


def _only_solid(
    shape: Any, named: list[Named], wall: str, axis: tuple[Any, Any] | None, label: str
) -> RevolvedWall:
    """Return the wall of the only solid of revolution, if it has most of the shape's surface."""
    walls: list[tuple[str, RevolvedWall, float]] = []
    area = sum(solid.Area for solid in shape.Solids)
    for index, solid in enumerate(shape.Solids, start=1):
        solid_faces = [
            (name, face)
            for name, face in named
            if any(face.isSame(solid_face) for solid_face in solid.Faces)
        ]
        try:
            wall_of_solid = _from_faces(solid_faces, wall, axis, label, False, is_closed=True)
            walls.append(
                (
                    Text("Solid{} ({} to {})", index, solid_faces[0][0], solid_faces[-1][0]),
                    wall_of_solid,
                    solid.Area / area,
                )
            )
        except InputError:
            continue
    if len(walls) == 1:
        name, wall_of_solid, share = walls[0]
        if share < MOSTLY:
            raise InputError(
                "NOT_OF_REVOLUTION",
                label,
                "of {} solids only {} is a solid of revolution, with {:.0%} of the surface; "
                "select the faces of this solid to deposit it, and deposit the other solids as "
                "walls on a part or solids on a hub",
                len(shape.Solids),
                name,
                share,
            )
        return wall_of_solid
    if not walls:
        raise InputError(
            "NO_WALL",
            label,
            "none of the {} solids is a solid of revolution; select the faces of the wall",
            len(shape.Solids),
        )
    names = Text.joined(", ", (name for name, *_ in walls))
    raise InputError(
        "SEVERAL_SOLIDS", label, "{} all have a wall; select the faces of one wall", names
    )


def _from_faces(
    named: list[Named],
    wall: str,
    axis: tuple[Any, Any] | None,
    label: str,
    selected: bool,
    is_closed: bool = False,
) -> RevolvedWall:
    """Detect the wall of faces. is_closed: whether the faces form a closed surface."""
    wide = [
        (name, face)
        for name, face in named
        if 2.0 * face.Area > SLIVER * face.Length or has_lost_pole(face)
    ]
    if not wide:
        raise InputError(
            "NO_WALL", label, "the shape has no face of measurable width; choose another object"
        )
    lines = [axis] if axis is not None else list(candidates([face for _, face in wide]))
    if not lines:
        raise InputError(
            "NO_WALL",
            label,
            "the faces share no axis of revolution; choose an axis, or select the faces",
        )
    frame, patches = _about_best(wide, lines)
    if not all(patch.sound for patch in patches) and all(planar(face) for _, face in wide):
        raise InputError(
            "NO_WALL", label, "all faces are flat; choose a part or faces of revolution"
        )
    worst = max(patches, key=lambda patch: patch.deviation)
    if not worst.sound:
        hint = (
            "choose other faces"
            if selected
            else "select the wall faces if the face does not belong to the wall"
        )
        raise InputError(
            "NOT_REVOLUTION",
            f"{label} {worst.name}",
            "{}: {:.4g} mm off; {}",
            worst.what,
            worst.deviation,
            Word(hint),
        )
    segments = merged([segment for patch in patches for segment in patch.segments], label)
    if not segments:
        raise InputError(
            "NO_WALL",
            label,
            "no face is a surface of revolution about the axis; select the faces of the wall",
        )
    return _assembled(segments, frame, wall, label, selected, is_closed)


def _about_best(
    wide: Sequence[Named], lines: Sequence[tuple[Any, Any]]
) -> tuple[AxisFrame, list[Patch]]:
    """Return the axis about which all faces are of revolution, and their patches.

    Without such an axis, return the axis with the smallest deviating area, and the patches of the
    largest deviating faces.
    """
    normals = normals_of([face for _, face in wide])
    area = np.array([face.Area + SLIVER for _, face in wide])
    large = np.argsort(-area, kind="stable").tolist()
    least_area, frame, off = np.inf, None, []
    for point, direction in lines:
        about = axis_frame(point, direction)
        leaning = surely_off(normals, about)
        patches: list[Patch] = []
        if not leaning.any():
            for name, face in wide:
                patches.append(patch_of(face, name, about))
                if not patches[-1].sound:
                    break
            else:
                return about, patches
            leaning[len(patches) - 1] = True
        if area[leaning].sum() < least_area:
            least_area, frame, off = (
                float(area[leaning].sum()),
                about,
                [k for k in large if leaning[k]],
            )
    assert frame is not None
    return frame, [patch_of(wide[k][1], wide[k][0], frame) for k in off[:JUDGED]]


def _from_edges(shape: Any, wall: str, axis: tuple[Any, Any] | None, label: str) -> RevolvedWall:
    if not shape.Edges:
        raise InputError(
            "NO_WALL", label, "the object has neither faces nor edges; choose another object"
        )
    if axis is None:
        raise InputError(
            "NO_AXIS", label, "a wire or sketch needs an axis of revolution; choose an axis"
        )
    frame = axis_frame(*axis)
    return _assembled(pieces_of_edges(shape, frame, label), frame, wall, label, selected=False)


def _assembled(
    segments: list[Piece],
    frame: AxisFrame,
    wall: str,
    label: str,
    selected: bool,
    closed_source: bool = False,
) -> RevolvedWall:
    """Assemble the wall from meridian segments about the axis of the frame."""
    chains, gap = contour.chains(segments)
    if len(chains) > 1:
        names = Text.joined(
            " and ", ("-".join(dict.fromkeys((chain[0].name, chain[-1].name))) for chain in chains)
        )
        raise InputError(
            "NO_WALL",
            label,
            "{} do not form one wall; select the faces of the wall, or deposit the faces in turn",
            names,
        )
    chain, issues = chains[0], []
    closed = contour.is_closed(chain, closed_source) and (not selected or _loops(chain))
    gap = contour.opening(chain) if closed and not contour.is_closed(chain) else gap
    if gap > contour.JOIN_MM:
        issues.append(
            Issue(
                NOTE, "GAP", Text("a gap of {:.3g} mm between faces of {} is bridged", gap, label)
            )
        )
    if closed:
        chain, meridian = _wall_of_contour(chain, wall, label)
    else:
        if wall != "outer":
            text = Text("{} is a surface without an {} wall; the surface is deposited", label, wall)
            issues.append(Issue(WARNING, "OPEN_WALL", text))
        chain = contour.upright(chain)
        meridian = contour.meridian_of(chain)
    issues += _step_notes(chain, label)
    turn = common_turn(chain, label)
    base = float(meridian.points[0, 1])
    lowered = Meridian(meridian.s, meridian.points - [0.0, base], meridian.tangents)
    start, end = turn if turn is not None else (0.0, 2.0 * np.pi)
    return RevolvedWall(
        lowered,
        _pose(frame, base),
        start,
        end,
        turn is None,
        tuple(issues),
        label,
        tuple(dict.fromkeys(segment.name for segment in chain)),
    )


def _loops(chain: Chain) -> bool:
    return contour.opening(chain) < contour.JOIN_MM


def _wall_of_contour(chain: Chain, wall: str, label: str) -> tuple[Chain, Meridian]:
    """Return the pieces and the meridian of the requested wall of a closed contour."""
    walls = contour.walls(chain)
    if not walls:
        raise InputError(
            "NO_WALL",
            label,
            "all faces are flat and across the axis; select the faces of the wall",
        )
    if wall == "outer":
        return walls[0], contour.meridian_of(walls[0])
    if len(walls) == 1:
        raise InputError("NO_WALL", label, "the solid has no {} wall; use wall: outer", wall)
    if wall == "inner":
        return walls[-1], contour.meridian_of(walls[-1])
    return walls[0] + walls[-1], Meridian.chained(contour.halfway(walls[0], walls[-1]))


def _step_notes(chain: Chain, label: str) -> list[Issue]:
    """Return notes on tiny steps inside the wall, such as between two formulas of a curve."""
    return [
        Issue(
            NOTE,
            "STEP",
            Text(
                "{} of {} is a step of {:.3g} mm in the wall; the step is kept",
                segment.name,
                label,
                span,
            ),
        )
        for segment in chain
        if (span := float(np.hypot(*(segment.points[-1] - segment.points[0])))) < contour.BRIDGE_MM
        and len(chain) > 1
    ]


def _pose(frame: AxisFrame, base: float) -> Array:
    pose = np.eye(4)
    pose[:3, :3] = frame.rotation
    origin = frame.origin + base * frame.rotation[:, 2]
    pose[:3, 3] = np.where(np.abs(origin) < 1e-11, 0.0, origin)
    return pose
