# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert a face to a meridian piece revolved about an axis, and measure the deviation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import FreeCAD
import numpy as np
import Part

from ...core.geometry.curves.contour import Chain, Piece
from ...core.geometry.curves.profile import Curve, arc, line
from ...core.issues import InputError, Text
from ...core.types import Array
from .cylindrical import (
    AxisFrame,
    as_array,
    edge_points,
    edges_of,
    flattened,
    has_lost_pole,
    pieces_of,
    restore_meridian,
    smooth_pieces,
)

MERIDIAN_MM = 1e-3  # mm; maximum distance of coincident meridians
SAME_AZIMUTH = 1e-4  # rad

Turn = tuple[float, float]


def merged(segments: Sequence[Piece], label: str) -> list[Piece]:
    """Merge segments with the same meridian into one segment over their joint azimuth range.

    Raises InputError NOT_REVOLUTION if merged segments leave more than one opening around the axis.
    """
    groups: list[list[Piece]] = []
    ends = np.array([segment.points[[0, -1]] for segment in segments]).reshape(-1, 2, 2)
    firsts: list[int] = []
    for number, segment in enumerate(segments):
        first_ends = ends[firsts]
        end_gaps = [
            np.abs(first_ends - end_order).max(axis=(1, 2), initial=0.0)
            for end_order in (ends[number], ends[number, ::-1])
        ]
        for k in np.flatnonzero(np.minimum(*end_gaps) <= MERIDIAN_MM).tolist():
            if _same_meridian(groups[k][0], segment):
                groups[k].append(segment)
                break
        else:
            groups.append([segment])
            firsts.append(number)
    return [
        replace(group[0], turn=_union([segment.turn for segment in group], group, label))
        for group in groups
    ]


def _same_meridian(segment: Piece, other_segment: Piece) -> bool:
    """Whether segments with the same ends also coincide between them."""
    middle = other_segment.points[len(other_segment.points) // 2]
    start, steps = segment.points[:-1], np.diff(segment.points, axis=0)
    share = np.clip(
        ((middle - start) * steps).sum(1) / np.maximum((steps * steps).sum(1), 1e-30), 0.0, 1.0
    )
    return bool(np.linalg.norm(middle - start - share[:, None] * steps, axis=1).min() < MERIDIAN_MM)


def _union(turns: Sequence[Turn | None], group: Sequence[Piece], label: str) -> Turn | None:
    if any(turn is None for turn in turns):
        return None
    sorted_turns = sorted(
        (turn[0] % (2.0 * np.pi), turn[1] - turn[0]) for turn in turns if turn is not None
    )
    joined: list[Turn] = []
    for start, span in [
        *sorted_turns,
        *((start + 2.0 * np.pi, span) for start, span in sorted_turns),
    ]:
        if joined and start <= joined[-1][1] + SAME_AZIMUTH:
            joined[-1] = joined[-1][0], max(joined[-1][1], start + span)
        else:
            joined.append((start, start + span))
    if any(end - start >= 2.0 * np.pi - SAME_AZIMUTH for start, end in joined):
        return None
    # ranges are listed twice, one revolution apart, so that each joined range is complete once
    distinct = {round((start % (2.0 * np.pi)) / SAME_AZIMUTH) for start, _ in joined[1:]}
    if len(distinct) > 1:
        names = ", ".join(segment.name for segment in group)
        text = Text("{} leave more than one opening around the axis; choose a single face", names)
        raise InputError("NOT_REVOLUTION", label, text)
    start, end = max(joined, key=lambda turn: turn[1] - turn[0])
    start_in_turn = start % (2.0 * np.pi)
    return start_in_turn, start_in_turn + end - start


def common_turn(chain: Chain, label: str) -> Turn | None:
    """Return the common azimuth range (start, end), rad, of all pieces; None for a full revolution.

    Raises InputError NOT_REVOLUTION, naming the faces whose ranges differ.
    """
    first_segment = chain[0]
    for segment in chain[1:]:
        same = (segment.turn is None) == (first_segment.turn is None)
        if same and segment.turn is not None and first_segment.turn is not None:
            off = abs(np.angle(np.exp(1j * (segment.turn[0] - first_segment.turn[0]))))
            same = (
                max(
                    off,
                    abs(
                        (segment.turn[1] - segment.turn[0])
                        - (first_segment.turn[1] - first_segment.turn[0])
                    ),
                )
                < 1e-3
            )
        if not same:
            raise InputError(
                "NOT_REVOLUTION",
                label,
                "{} covers {} and {} {}; choose faces with the same angular range",
                first_segment.name,
                _degrees(first_segment.turn),
                segment.name,
                _degrees(segment.turn),
            )
    return first_segment.turn


def _degrees(turn: Turn | None) -> str:
    return (
        "all around"
        if turn is None
        else Text("from {:.4g} to {:.4g} deg", np.degrees(turn[0]), np.degrees(turn[1]))
    )


TOLERANCE = 1e-3  # mm; maximum deviation of a face from its surface of revolution
EDGE_TOLERANCE = 1e-2  # mm; maximum deviation of an edge from a parallel or a meridian
FULL_TURN_RAD = 2.0 * np.pi - 1e-5
# surface types whose first parameter is the azimuth about their axis
NATURAL = (
    "Part::GeomCylinder",
    "Part::GeomCone",
    "Part::GeomToroid",
    "Part::GeomSurfaceOfRevolution",
)


@dataclass(frozen=True)
class Patch:
    """A face in relation to an axis.

    segments: the meridian; empty for a plane along the axis that only bounds a partial revolution.
    deviation: distance from a surface of revolution, mm; inf without a meridian. what: description
    of the deviation.
    """

    name: str
    segments: tuple[Piece, ...]
    deviation: float
    what: str = ""

    @property
    def sound(self) -> bool:
        """Whether the face is a surface of revolution within TOLERANCE."""
        return self.deviation <= TOLERANCE


def patch_of(face: Any, name: str, frame: AxisFrame) -> Patch:
    """Return the patch of a face about the axis of the frame."""
    if has_lost_pole(face):
        return _closed_on_axis(face, name, frame)
    if _ends_a_turn(face, frame):
        return Patch(name, (), 0.0)
    try:
        curves = _meridian(face, frame)
    except (ValueError, RuntimeError, Part.OCCError):
        curves = None  # a zero-length line is not a meridian, and the kernel fails on some surfaces
    if curves is None:
        return Patch(name, (), _radial_spread(face, frame), "the face does not turn about the axis")
    deviation = _deviation(face, frame, curves)
    if deviation > TOLERANCE:
        return Patch(name, (), deviation, "the face is not a surface of revolution")
    edge = _edge_deviation(face.Edges, frame)
    if edge > EDGE_TOLERANCE:
        return Patch(
            name,
            (),
            edge,
            "the face is cut out or slanted, with an edge that runs neither around nor along the "
            "axis",
        )
    turn = _turn(face, frame)
    return Patch(
        name, tuple(Piece(name, points, tangents, turn) for points, tangents in curves), deviation
    )


def _closed_on_axis(face: Any, name: str, frame: AxisFrame) -> Patch:
    """Return the patch of a face whose pole is lost in the file."""
    curves, edges = restore_meridian(face, frame), edges_of(face)
    edge = _edge_deviation(edges, frame)
    if curves is None or edge > EDGE_TOLERANCE:
        what = "the face has an edge but no area, so the file is damaged or the face does not turn about the axis"
        return Patch(name, (), max(edge, 2.0 * TOLERANCE), what)
    points = np.vstack([edge_points(rim, 181) for rim in edges])
    turn, off = _reach(frame, points), _distance(frame, points, curves)
    return Patch(
        name,
        tuple(Piece(name, samples, tangents, turn) for samples, tangents in curves),
        off,
        "the face is not a surface of revolution",
    )


def _ends_a_turn(face: Any, frame: AxisFrame) -> bool:
    if not planar(face):
        return False
    points = np.vstack([frame.local(edge_points(edge, 5)) for edge in face.Edges])
    farthest = points[np.argmax(np.hypot(points[:, 0], points[:, 1]))]
    off = np.abs(points[:, 0] * farthest[1] - points[:, 1] * farthest[0]) / max(
        np.hypot(farthest[0], farthest[1]), 1e-12
    )
    return bool(off.max() < EDGE_TOLERANCE)


def planar(face: Any) -> bool:
    """Whether a face is flat, for any surface type."""
    surface = face.Surface
    if surface.TypeId in ("Part::GeomBSplineSurface", "Part::GeomBezierSurface"):
        return bool(surface.isPlanar(1e-6))
    return bool(surface.TypeId == "Part::GeomPlane")


def _meridian(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    kind = face.Surface.TypeId
    if planar(face):
        return _flat(face, frame)
    if kind == "Part::GeomSphere":
        sphere_meridian = _sphere(face, frame)
        if sphere_meridian is not None:
            return sphere_meridian
    return _along_parameter(face, frame) or _section(face, frame)


def _boundary(face: Any, frame: AxisFrame, count: int = 9) -> tuple[Array, Array, Array]:
    return frame.cylindrical(np.vstack([edge_points(edge, count) for edge in face.Edges]))


def _flat(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """Return the meridian of a plane normal to the axis: a line from inner to outer radius."""
    radius, height, _ = _boundary(face, frame)
    if np.ptp(height) > TOLERANCE:
        return None
    h = float(height.mean())
    inner = 0.0 if len(face.Wires) == 1 and _turn(face, frame) is None else float(radius.min())
    return [line((inner, h), (float(radius.max()), h))]


def _sphere(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """Return the meridian of a sphere centred on the axis, for any direction of its poles."""
    centre = frame.local([face.Surface.Center])[0]
    if np.hypot(centre[0], centre[1]) > TOLERANCE:
        return None
    radius, height, _ = _boundary(face, frame)
    latitude = np.arctan2(height - centre[2], radius)
    low, high = float(latitude.min()), float(latitude.max())
    for sign in (-1.0, 1.0):
        pole = frame.origin + frame.rotation @ [0.0, 0.0, centre[2] + sign * face.Surface.Radius]
        if face.distToShape(Part.Vertex(*pole.tolist()))[0] < 1e-6:
            low, high = (-0.5 * np.pi, high) if sign < 0.0 else (low, 0.5 * np.pi)
    low, high = (_snapped(angle) for angle in (low, high))
    return [arc((0.0, centre[2]), face.Surface.Radius, low, high)] if high > low else None


def _snapped(angle: float) -> float:
    """Snap a latitude to a pole within rounding: a file may store a pole with ten digits."""
    return float(np.copysign(0.5 * np.pi, angle)) if abs(abs(angle) - 0.5 * np.pi) < 1e-9 else angle


def _along_parameter(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """Return the meridian as a surface parameter line that crosses all parallels, or None."""
    u0, u1, v0, v1 = face.ParameterRange
    surface = face.Surface
    middle_u, middle_v = 0.5 * (u0 + u1), 0.5 * (v0 + v1)
    best, span = None, TOLERANCE
    for along_v, t_start, t_end in ((True, v0, v1), (False, u0, u1)):
        t = np.linspace(t_start, t_end, 17)
        r, h, _ = frame.cylindrical(
            [
                surface.value(middle_u, value) if along_v else surface.value(value, middle_v)
                for value in t.tolist()
            ]
        )
        steps = np.hypot(np.diff(r), np.diff(h))
        if steps.sum() > span:
            best, span = (along_v, t_start, t_end, steps.min()), float(steps.sum())
    if best is None or best[3] < 1e-6 * span:
        return None
    along_v, t_start, t_end, _ = best
    if surface.TypeId == "Part::GeomOffsetSurface":
        return smooth_pieces(
            _offset_line(face, frame, along_v, t_start, t_end), [t_start, t_end], []
        )
    return pieces_of(
        surface.uIso(middle_u) if along_v else surface.vIso(middle_v), frame, t_start, t_end
    )


def _offset_line(face: Any, frame: AxisFrame, along_v: bool, t_start: float, t_end: float) -> Curve:
    """Evaluate a parameter line exactly, for surfaces whose curves the kernel approximates."""
    u0, u1, v0, v1 = face.ParameterRange
    surface, order = face.Surface, (0, 1) if along_v else (1, 0)

    def evaluate(t: Array) -> tuple[Array, Array]:
        parameters = [
            (0.5 * (u0 + u1), value) if along_v else (value, 0.5 * (v0 + v1))
            for value in t.tolist()
        ]
        d = as_array([surface.getDN(u, v, *order) for u, v in parameters]) @ frame.rotation
        return flattened(
            frame.local([surface.value(u, v) for u, v in parameters]),
            d,
            t > 0.5 * (t_start + t_end),
        )

    return evaluate


def _section(face: Any, frame: AxisFrame) -> list[tuple[Array, Array]] | None:
    """Return the meridian from a section with the half plane through the centre of the face.

    Points are projected back onto the exact surface. Tangents are normal to the surface normal.
    """
    radius, _, azimuth = frame.cylindrical(_grid(face, True) or _grid(face, False))
    middle_azimuth = float(azimuth[np.argmax(radius)])
    across = frame.rotation @ [-np.sin(middle_azimuth), np.cos(middle_azimuth), 0.0]
    outward = frame.rotation @ [np.cos(middle_azimuth), np.sin(middle_azimuth), 0.0]
    wires = face.slice(FreeCAD.Vector(*across.tolist()), float(across @ frame.origin))
    edges = [edge for wire in wires for edge in wire.Edges if not edge.Degenerated]
    surface = face.Surface

    def edge_samples(edge: Any) -> list[tuple[Array, Array]]:
        t_start, t_end = edge.ParameterRange

        def evaluate(t: Array) -> tuple[Array, Array]:
            parameters = [surface.parameter(edge.valueAt(value)) for value in t.tolist()]
            p = frame.local([surface.value(u, v) for u, v in parameters])
            n = as_array([surface.normal(u, v) for u, v in parameters]) @ frame.rotation
            forward = as_array([edge.tangentAt(value) for value in t.tolist()]) @ frame.rotation
            d = np.cross(np.cross(n, forward), n)
            return flattened(p, d, t > 0.5 * (t_start + t_end))

        return smooth_pieces(evaluate, [t_start, t_end], [])

    section_edges = [
        edge
        for edge in edges
        if float(
            np.mean(
                (as_array([edge.valueAt(0.5 * sum(edge.ParameterRange))]) - frame.origin) @ outward
            )
        )
        > 0.0
    ]
    return [samples for edge in section_edges for samples in edge_samples(edge)] or None


def _grid(face: Any, inside_only: bool) -> list[Any]:
    u0, u1, v0, v1 = face.ParameterRange
    return [
        face.Surface.value(u, v)
        for u in np.linspace(u0, u1, 13).tolist()
        for v in np.linspace(v0, v1, 13).tolist()
        if not inside_only or face.isPartOfDomain(u, v)
    ]


def _deviation(face: Any, frame: AxisFrame, curves: list[tuple[Array, Array]]) -> float:
    """Return the maximum distance, mm, between the face and the revolved meridian."""
    if planar(face):
        return 0.0
    off = _distance(frame, _grid(face, False), curves)
    if off > TOLERANCE:
        # the surface extends beyond the edges of the face, so sample only the face
        off = _distance(frame, _grid(face, True) or _grid(face, False), curves)
    return max(
        off, _distance(frame, np.vstack([edge_points(edge, 9) for edge in face.Edges]), curves)
    )


def _distance(frame: AxisFrame, points: Any, curves: list[tuple[Array, Array]]) -> float:
    radius, height, _ = frame.cylindrical(points)
    p = np.stack([radius, height], axis=1)[:, None, :]
    nearest = np.full(len(radius), np.inf)
    for samples, _ in curves:
        a, ab = samples[None, :-1], np.diff(samples, axis=0)[None]
        share = np.clip(((p - a) * ab).sum(-1) / np.maximum((ab * ab).sum(-1), 1e-30), 0.0, 1.0)
        nearest = np.minimum(
            nearest, np.linalg.norm(p - a - share[..., None] * ab, axis=-1).min(axis=1)
        )
    return float(nearest.max())


def _radial_spread(face: Any, frame: AxisFrame) -> float:
    """Return the deviation, mm, of a face without a meridian: the range of its radius or height."""
    radius, height, _ = frame.cylindrical(_grid(face, True) or _grid(face, False))
    return float(max(min(np.ptp(radius), np.ptp(height)), 2.0 * TOLERANCE))


def _edge_deviation(edges: list[Any], frame: AxisFrame) -> float:
    """Return the maximum deviation, mm, of edges from the nearer of a parallel and a meridian."""
    worst = 0.0
    for edge in edges:
        if edge.Degenerated:
            continue
        p = frame.local(edge_points(edge, 9))
        radius = np.hypot(p[:, 0], p[:, 1])
        farthest = p[np.argmax(radius)] / max(radius.max(), 1e-12)
        off_meridian = np.abs(p[:, 0] * farthest[1] - p[:, 1] * farthest[0]).max()
        off_parallel = np.hypot(np.ptp(radius), np.ptp(p[:, 2]))
        worst = max(worst, float(min(off_meridian, off_parallel)))
    return worst


def _turn(face: Any, frame: AxisFrame) -> tuple[float, float] | None:
    """Return the azimuth range (start, end), rad, of a face; None for a full revolution."""
    u0, u1, v0, v1 = face.ParameterRange
    if face.Surface.TypeId in NATURAL and u1 - u0 > FULL_TURN_RAD:
        return None
    flat = planar(face)
    samples = [edge_points(edge, 181) for edge in face.Edges]
    for t in np.linspace(0.0, 1.0, 181)[1:-1].tolist():
        for u, v in ((u0 + t * (u1 - u0), 0.5 * (v0 + v1)), (0.5 * (u0 + u1), v0 + t * (v1 - v0))):
            if not flat:
                samples.append(as_array([face.Surface.value(u, v)]))
    return _reach(frame, np.vstack(samples))


def _reach(frame: AxisFrame, points: Array) -> tuple[float, float] | None:
    """Return the smallest azimuth range (start, end), rad, that contains all points."""
    radius, _, azimuth = frame.cylindrical(points)
    azimuth = np.sort(np.mod(azimuth[radius > 1e-3 * max(radius.max(), 1e-9)], 2.0 * np.pi))
    gaps = np.diff(np.r_[azimuth, azimuth[0] + 2.0 * np.pi])
    widest = int(np.argmax(gaps))
    if gaps[widest] < np.radians(2.5):
        return None
    start = float(azimuth[(widest + 1) % len(azimuth)])
    end = start + 2.0 * np.pi - float(gaps[widest])
    return start, end
