# SPDX-License-Identifier: LGPL-2.1-or-later
"""Guides of bent solids: chains of edges, or the centre line through the centroids of sections."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import coo_matrix, diags, identity
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from ..geometry.curves.guide import fit_guide
from ..geometry.formatting import place
from ..geometry.frames import TURN
from ..geometry.mesh.coarsen import doubled_areas
from ..geometry.mesh.refine import Edges
from ..geometry.mesh.solid import SolidMesh
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, Group, SolidsOnHub, upright
from ..issues import NOTE, InputError, Issue, Text
from ..parameters.filled import SolidParameters
from ..types import Array, Index
from .stacking import prepare_stack

TOUCHING = 1e-3  # mm; maximum gap between edges that meet
CORNER_RAD = np.radians(1.0)  # minimum angle of a corner
MIN_LENGTH_MM = 1e-3  # mm; shorter edges are ignored
MAX_TURN_RAD = np.radians(120.0)  # maximum angle of a corner that does not double back
WHERE = "strategy.guide"


class Nodes(NamedTuple):
    """Points (n, 3), mm, of a curve and unit tangents (n, 3)."""

    points: Array
    tangents: Array

    def reversed(self) -> Nodes:
        """Return the curve in the opposite direction."""
        return Nodes(self.points[::-1], -self.tangents[::-1])


def chain_edges(edges: Sequence[Nodes]) -> Nodes:
    """Chain edges in any order and direction to one curve in the direction of the first edge.

    Raises InputError GUIDE_OPEN, GUIDE_CLOSED, GUIDE_CORNER, GUIDE_DOUBLES_BACK.
    """
    remaining = [
        edge
        for edge in edges
        if np.linalg.norm(np.diff(edge.points, axis=0), axis=1).sum() > MIN_LENGTH_MM
    ]
    if not remaining:
        raise InputError(
            "GUIDE_OPEN",
            WHERE,
            "all edges of the guide have zero length; choose edges, a wire or a sketch",
        )
    chain = [remaining.pop(0)]
    while remaining:
        ends = chain[0].points[0], chain[-1].points[-1]
        match = next(
            (
                (k, behind, edge if straight else edge.reversed())
                for k, edge in enumerate(remaining)
                for behind, end in ((True, ends[1]), (False, ends[0]))
                for straight in (True, False)
                if np.linalg.norm(edge.points[0 if straight == behind else -1] - end) < TOUCHING
            ),
            None,
        )
        if match is None:
            gap = min(
                float(np.linalg.norm(edge.points[k] - end))
                for edge in remaining
                for k in (0, -1)
                for end in ends
            )
            raise InputError(
                "GUIDE_OPEN",
                WHERE,
                "the edges of the guide do not form one curve: {} of {} are disconnected, at {} "
                "and {}, and the smallest gap is {:.3g} mm; choose edges that meet end to end",
                len(remaining),
                len(edges),
                place(ends[0]),
                place(ends[1]),
                gap,
            )
        k, behind, edge = match
        remaining.pop(k)
        chain = [*chain, edge] if behind else [edge, *chain]
    _refuse_corners(chain)
    if np.linalg.norm(chain[0].points[0] - chain[-1].points[-1]) < TOUCHING:
        raise InputError(
            "GUIDE_CLOSED",
            WHERE,
            "the guide returns to its start, at {}, so the last layer would overlap the first; "
            "remove one edge",
            place(chain[0].points[0]),
        )
    return Nodes(
        np.vstack([chain[0].points[:1], *(edge.points[1:] for edge in chain)]),
        np.vstack([chain[0].tangents[:1], *(edge.tangents[1:] for edge in chain)]),
    )


def _refuse_corners(chain: Sequence[Nodes]) -> None:
    for edge, next_edge in zip(chain, chain[1:]):
        turn = float(np.arccos(np.clip(edge.tangents[-1] @ next_edge.tangents[0], -1.0, 1.0)))
        position = place(next_edge.points[0])
        if turn > MAX_TURN_RAD:
            raise InputError(
                "GUIDE_DOUBLES_BACK",
                WHERE,
                "the guide turns back by {:.4g} deg at {}, so layers would cut through the "
                "deposit; choose edges that lead forward",
                np.degrees(turn),
                position,
            )
        if turn > CORNER_RAD:
            raise InputError(
                "GUIDE_CORNER",
                WHERE,
                "the guide has a corner of {:.3g} deg at {}, where layers would have zero height "
                "on the inside; round the corner with a radius, or choose guide: auto",
                np.degrees(turn),
                position,
            )


STEP_SHARE = 0.25  # in section sizes; distance between sections
REACH = 1.5  # in sizes of the last section; loops that extend farther belong to another part
ENDED = 0.6  # fraction of the area of the last section; a smaller section is beyond the end
MAX_SECTIONS = 2000  # maximum number of sections
ROUNDS = 6  # iterations that set the section planes normal to the line through the centroids
SMOOTH = 2.0  # in section sizes; wavelength below which the line is smoothed
MIRRORED = 16  # number of sections mirrored at the start and at the end of the line
FACING = 0.98  # minimum cosine between the line and the normal of the end face
NODES = 8  # nodes of the line per section
LED = 0.9  # minimum fraction of the volume that the line covers


class Section(NamedTuple):
    """Section of a solid by a plane near a point.

    middle: (3,) centroid, mm. area: mm2. reach: maximum distance from the centroid, mm. normal:
    (3,) unit normal of the plane.
    """

    middle: Array
    area: float
    reach: float
    normal: Array


class _Plane(NamedTuple):
    """Point (3,) and unit normal (3,) of a plane."""

    point: Array
    normal: Array

    def above(self, points: Array) -> Array:
        """Return the heights (...,), mm, of points (..., 3) above the plane."""
        heights: Array = (points - self.point) @ self.normal
        return heights

    def mirrored(self, points: Array) -> Array:
        """Mirror points (n, 3) at the plane."""
        mirror_images: Array = points - 2.0 * self.above(points)[:, None] * self.normal
        return mirror_images


class _Solid:
    """Mesh prepared for sections by planes."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        counts = np.cumsum([0, *(len(body.vertices) for body in bodies)])
        self.vertices = np.vstack([body.vertices for body in bodies])
        self.triangles: Index = np.vstack(
            [body.triangles + k for body, k in zip(bodies, counts)]
        ).astype(np.intp)
        self.edges = Edges(self.triangles)

    def section(self, point: Array, normal: Array, reach: float | None) -> Section | None:
        """Return the section by a plane through a point, or None if there is no section.

        Only loops within `reach` mm of the point count; None: all loops.
        """
        above = (self.vertices - point) @ normal
        side = above[self.triangles] >= 0.0
        cut = np.flatnonzero(side.any(axis=1) & ~side.all(axis=1))
        if not len(cut):
            return None
        ends = self.edges.ends
        edge_numbers, edge_index = np.unique(
            self.edges.of_triangle[cut].ravel(), return_inverse=True
        )
        low, high = above[ends[edge_numbers, 0]], above[ends[edge_numbers, 1]]
        crossed = (low >= 0.0) != (high >= 0.0)
        share = np.where(crossed, low / np.where(crossed, low - high, 1.0), 0.0)
        crossings = self.vertices[ends[edge_numbers, 0]] + share[:, None] * (
            self.vertices[ends[edge_numbers, 1]] - self.vertices[ends[edge_numbers, 0]]
        )
        row = np.ravel(edge_index).reshape(-1, 3)
        side = side[cut]
        following = np.roll(side, -1, axis=1)
        start = np.take_along_axis(row, np.argmax(side & ~following, axis=1)[:, None], axis=1)[:, 0]
        end = np.take_along_axis(row, np.argmax(~side & following, axis=1)[:, None], axis=1)[:, 0]
        is_kept = np.ones(len(start), dtype=bool)
        if reach is not None:
            size = len(edge_numbers)
            label = connected_components(
                coo_matrix((np.ones(len(start)), (start, end)), (size, size)), directed=False
            )[1]
            max_distance = np.zeros(label.max() + 1)
            np.maximum.at(
                max_distance, label[start], np.linalg.norm(crossings[start] - point, axis=1)
            )
            is_kept = max_distance[label[start]] < reach
        if not is_kept.any():
            return None
        a, b = crossings[start[is_kept]] - point, crossings[end[is_kept]] - point
        area = 0.5 * (np.cross(a, b) @ normal)
        total = float(area.sum())
        if abs(total) < 1e-9:
            return None
        middle = point + (area[:, None] * (a + b)).sum(axis=0) / (3.0 * total)
        return Section(
            middle,
            abs(total),
            float(np.linalg.norm(crossings[start[is_kept]] - middle, axis=1).max()),
            normal,
        )

    def end(self, last_section: Section) -> _Plane | None:
        """Return the plane of the flat end face after a section; None if there is none."""
        corner = self.vertices[self.triangles]
        doubled = doubled_areas(corner)
        size = np.linalg.norm(doubled, axis=1)
        is_near = (
            np.linalg.norm(corner - last_section.middle, axis=2).max(axis=1)
            < 2.0 * last_section.reach
        )
        ahead = (
            (((corner.mean(axis=1) - last_section.middle) * last_section.normal).sum(axis=1) > 0.0)
            & is_near
            & (size > 0.0)
        )
        facing = ahead & (doubled @ last_section.normal > FACING * size)
        if not facing.any():
            return None
        total: Array = doubled[facing].sum(axis=0)
        area = float(np.linalg.norm(total))
        return (
            _Plane(corner[facing][0, 0], total / area)
            if area > ENDED * 2.0 * last_section.area
            else None
        )


def centre_line(bodies: Sequence[Body], start: Array, direction: Array, depth: float) -> Nodes:
    """Find the centre line of a solid, through the centroids of the sections normal to the line.

    The line begins on the base plane.

    Parameters
    ----------
    bodies : sequence of Body
        The solid; several solids have no centre line.
    start : (3,) array
        A point of the base plane, mm.
    direction : (3,) array
        Unit normal of the base plane.
    depth : float
        Height of the first section above the plane, mm.

    Returns
    -------
    Nodes
        Points and directions.

    Raises
    ------
    InputError
        GUIDE_NOT_FOUND if the sections do not form such a line.
    """
    solid = _Solid(bodies)
    name = bodies[0].name if len(bodies) == 1 else f"{len(bodies)} solids"
    first_section = solid.section(start + depth * direction, direction, None)
    if first_section is None or len(bodies) > 1:
        raise _not_found(
            name,
            "the part is several solids"
            if len(bodies) > 1
            else "the solid has no cross-section at its base",
        )
    sections = _trace_sections(solid, first_section, direction)
    if len(sections) < 3:
        raise _not_found(name, "the solid ends after one section")
    nodes, areas = _smooth_line(solid, sections, _Plane(start, direction))
    length = np.linalg.norm(np.diff(nodes.points, axis=0), axis=1).sum()
    volume_share = (
        float(length * np.mean(areas)) / SolidMesh(bodies[0].vertices, bodies[0].triangles).volume
    )
    if not LED < volume_share < 2.0 - LED:
        raise _not_found(
            name,
            Text(
                "the line of {:.4g} mm covers only {:.3g} % of the volume",
                length,
                100.0 * volume_share,
            ),
        )
    return nodes


def _not_found(name: str, why: str) -> InputError:
    return InputError(
        "GUIDE_NOT_FOUND",
        "strategy.guide",
        "auto finds no centre line of {} from its support: {}; choose an edge, a wire or a "
        "sketch as guide, or set strategy.direction along the part from one of its ends",
        name,
        why,
    )


def _trace_sections(solid: _Solid, first_section: Section, direction: Array) -> list[Section]:
    """Trace the sections from the first section to the end of the solid."""
    sections, normal = [first_section], direction
    stride = STEP_SHARE * first_section.reach
    while len(sections) < MAX_SECTIONS:
        last_section = sections[-1]
        section: Section | None = solid.section(
            last_section.middle + stride * normal, normal, REACH * last_section.reach
        )
        for _ in range(2):
            if section is None:
                break
            chord = (section.middle - last_section.middle) / max(
                float(np.linalg.norm(section.middle - last_section.middle)), 1e-9
            )
            turned = 2.0 * (chord @ normal) * chord - normal  # end tangent of an arc over the chord
            ahead = chord + 0.5 * (turned - chord)
            ahead /= np.linalg.norm(ahead)
            section = solid.section(section.middle, ahead, REACH * last_section.reach)
        if (
            section is None
            or section.area < ENDED * last_section.area
            or (section.middle - last_section.middle) @ normal < 0.3 * stride
        ):
            break
        sections.append(section)
        normal = ahead
    return sections


def _smooth_line(solid: _Solid, sections: Sequence[Section], start: _Plane) -> tuple[Nodes, Array]:
    """Return the smooth line from the base plane through section centroids, and the section areas.

    The sections are iteratively set normal to the line.
    """
    middles = np.array([section.middle for section in sections])
    size = float(np.mean([section.reach for section in sections]))
    areas = np.array([section.area for section in sections])
    end = solid.end(sections[-1])
    for _ in range(ROUNDS):
        line, positions = _fit_line(middles, start, end)
        points, along = _evaluate(line, positions)
        cuts = [solid.section(point, normal, REACH * size) for point, normal in zip(points, along)]
        valid_cuts = [
            section
            for section in cuts
            if section is not None and section.area > ENDED * float(np.median(areas))
        ]
        if len(valid_cuts) < 3:
            break
        middles = np.array([section.middle for section in valid_cuts])
        areas = np.array([section.area for section in valid_cuts])
    line, positions = _fit_line(middles, start, end)
    length_before, length_after = (
        0.0 if plane is None else float(plane.above(middle))
        for plane, middle in ((start, middles[0]), (end, middles[-1]))
    )
    dense = np.linspace(
        positions[0] - length_before,
        positions[-1] + max(-length_after, 0.0),
        NODES * (len(positions) - 1) + 1,
    )
    return Nodes(*_evaluate(line, dense)), areas


def _fit_line(middles: Array, start: _Plane, end: _Plane | None) -> tuple[CubicSpline, Array]:
    """Fit a smooth line to points (n, 3); return the line and the positions of the points along it.

    The fit penalises third differences (Whittaker 1923), so that the curvature does not oscillate.
    The line is mirrored at the planes in which the solid ends, so that it is normal to these
    planes.
    """
    count = min(MIRRORED, len(middles))
    mirrored_end = np.zeros((0, 3)) if end is None else end.mirrored(middles[-count:][::-1])
    extended = np.vstack([start.mirrored(middles[:count][::-1]), middles, mirrored_end])
    third = diags([-1.0, 3.0, -3.0, 1.0], [0, 1, 2, 3], shape=(len(extended) - 3, len(extended)))
    stiff = (SMOOTH / STEP_SHARE / TURN) ** 6
    smooth = spsolve((identity(len(extended)) + stiff * third.T @ third).tocsc(), extended)
    positions = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(smooth, axis=0), axis=1))]
    return CubicSpline(positions, smooth), positions[count : count + len(middles)]


def _evaluate(line: CubicSpline, positions: Array) -> tuple[Array, Array]:
    points, along = line(positions), line(positions, 1)
    return points, along / np.linalg.norm(along, axis=1, keepdims=True)


# fraction of the chord between the ends; a guide that descends by no more keeps its given direction
MIN_RISE_SHARE = 1e-6


def prepare_guided(
    bodies: Sequence[Body],
    edges: Sequence[tuple[Array, Array]] | None,
    strategy: SolidParameters,
    label: str,
    issues: tuple[Issue, ...] = (),
) -> SolidsOnHub:
    """Place bodies on a guide of edges, by default their centre line.

    The guide begins at the lower end along `strategy.direction`. Z of the frame is along the guide
    at the first layer. A note reports a centre line.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    edges : Sequence[tuple[Array, Array]] or None
        Points and unit tangents (n, 3) of each edge; None for the centre line.
    strategy : SolidParameters
        Layer height, direction and chord error.
    label : str
        Name of the part, for messages.
    issues : tuple of Issue, optional
        Issues to attach.

    Returns
    -------
    SolidsOnHub
        The bodies on the guide.

    Raises
    ------
    InputError
        As `chain_edges` and `centre_line`.
    """
    standing = prepare_stack(bodies, strategy, label, issues)
    direction = standing.groups[0].base.frame[:3, 2]
    all_issues = standing.issues
    nodes = None if edges is None else chain_edges([Nodes(*edge) for edge in edges])
    if nodes is None:
        nodes = centre_line(
            bodies, standing.groups[0].base.frame[:3, 3], direction, 0.5 * strategy.layer_height
        )
        all_issues = (*all_issues, _note(nodes, label))
    elif (nodes.points[-1] - nodes.points[0]) @ direction < -MIN_RISE_SHARE * np.linalg.norm(
        nodes.points[-1] - nodes.points[0]
    ):
        nodes = nodes.reversed()
    full_guide = fit_guide(*nodes)
    start = float(min(full_guide.distance(body.vertices).min() for body in bodies))
    origin, z = (rows[0] for rows in full_guide.at(np.array([start])))
    frame = upright(origin, z)
    local = fit_guide(
        (nodes.points - origin) @ frame[:3, :3],
        nodes.tangents @ frame[:3, :3],
        np.array([1.0, 0.0, 0.0]),
        start,
    )
    base = Base("the guide", local, frame)
    return SolidsOnHub(label, (Group(base, tuple(bodies)),), strategy.chord_error, (), all_issues)


def _note(nodes: Nodes, label: str) -> Issue:
    length = float(np.linalg.norm(np.diff(nodes.points, axis=0), axis=1).sum())
    turn = np.degrees(
        np.arccos(np.clip((nodes.tangents[1:] * nodes.tangents[:-1]).sum(axis=1), -1.0, 1.0)).sum()
    )
    return Issue(
        NOTE,
        "GUIDE",
        Text(
            "layers of {} are normal to its centre line, {:.4g} mm from {} to {}, turning by "
            "{:.3g} deg in total",
            label,
            length,
            place(nodes.points[0]),
            place(nodes.points[-1]),
            turn,
        ),
    )
