# SPDX-License-Identifier: LGPL-2.1-or-later
"""The centre line of a bent solid: from where it stands, from the middle of one section to that of the next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.sparse import coo_matrix, diags, identity
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from ...geometry.angles import TURN
from ...geometry.mesh.facets import doubled_areas
from ...geometry.mesh.refined import Edges
from ...geometry.mesh.solid import SolidMesh
from ...geometry.obstacles import Body
from ...issues import InputError, Text
from ...types import Array, Index
from .guide_edges import Nodes

STEP_SHARE = 0.25  # of the size of a section, from one to the next
REACH = 1.5  # of the size of the last section; what reaches farther from the middle belongs to another part of the solid
ENDED = 0.6  # of the area of the last section; less is where the solid ends
MAX_SECTIONS = 2000  # sections
ROUNDS = 6  # in which planes are set normal to the line through their middles
SMOOTH = 2.0  # sizes of a section; the line does not swing within less
MIRRORED = 16  # sections before the first and after the last one, as it were
FACING = 0.98  # cosine between the direction of the line and the face in which a solid ends
NODES = 8  # of the line from one section to the next
LED = 0.9  # of the volume that the line has to lead through


class Section(NamedTuple):
    """What a plane cuts near a point: its middle (3,), its area, mm2, how far it reaches from the middle, mm, and the unit
    normal (3,) of the plane."""

    middle: Array
    area: float
    reach: float
    normal: Array


class _Plane(NamedTuple):
    """A point and the unit normal (3,)."""

    point: Array
    normal: Array

    def above(self, points: Array) -> Array:
        """How far (...,) mm points (..., 3) are above it."""
        found: Array = (points - self.point) @ self.normal
        return found

    def mirrored(self, points: Array) -> Array:
        """Points (n, 3) on its other side."""
        found: Array = points - 2.0 * self.above(points)[:, None] * self.normal
        return found


class _Solid:
    """A mesh to be cut by one plane after the other."""

    def __init__(self, bodies: Sequence[Body]) -> None:
        counts = np.cumsum([0, *(len(body.vertices) for body in bodies)])
        self.vertices = np.vstack([body.vertices for body in bodies])
        self.triangles: Index = np.vstack(
            [body.triangles + k for body, k in zip(bodies, counts)]
        ).astype(np.intp)
        self.edges = Edges(self.triangles)

    def section(self, point: Array, normal: Array, reach: float | None) -> Section | None:
        """What the plane through a point cuts within `reach` mm of it, all there is for None."""
        above = (self.vertices - point) @ normal
        side = above[self.triangles] >= 0.0
        cut = np.flatnonzero(side.any(axis=1) & ~side.all(axis=1))
        if not len(cut):
            return None
        ends = self.edges.ends
        known, of = np.unique(self.edges.of_triangle[cut].ravel(), return_inverse=True)
        low, high = above[ends[known, 0]], above[ends[known, 1]]
        crossed = (low >= 0.0) != (high >= 0.0)
        share = np.where(crossed, low / np.where(crossed, low - high, 1.0), 0.0)
        at = self.vertices[ends[known, 0]] + share[:, None] * (
            self.vertices[ends[known, 1]] - self.vertices[ends[known, 0]]
        )
        row = np.ravel(of).reshape(-1, 3)
        side = side[cut]
        following = np.roll(side, -1, axis=1)
        start = np.take_along_axis(row, np.argmax(side & ~following, axis=1)[:, None], axis=1)[:, 0]
        end = np.take_along_axis(row, np.argmax(~side & following, axis=1)[:, None], axis=1)[:, 0]
        kept = np.ones(len(start), dtype=bool)
        if reach is not None:
            size = len(known)
            label = connected_components(
                coo_matrix((np.ones(len(start)), (start, end)), (size, size)), directed=False
            )[1]
            away = np.zeros(label.max() + 1)
            np.maximum.at(away, label[start], np.linalg.norm(at[start] - point, axis=1))
            kept = away[label[start]] < reach
        if not kept.any():
            return None
        a, b = at[start[kept]] - point, at[end[kept]] - point
        area = 0.5 * (np.cross(a, b) @ normal)
        total = float(area.sum())
        if abs(total) < 1e-9:
            return None
        middle = point + (area[:, None] * (a + b)).sum(axis=0) / (3.0 * total)
        return Section(
            middle,
            abs(total),
            float(np.linalg.norm(at[start[kept]] - middle, axis=1).max()),
            normal,
        )

    def end(self, last: Section) -> _Plane | None:
        """The flat face in which the solid ends after a section; None where there is none."""
        corner = self.vertices[self.triangles]
        doubled = doubled_areas(corner)
        size = np.linalg.norm(doubled, axis=1)
        near = np.linalg.norm(corner - last.middle, axis=2).max(axis=1) < 2.0 * last.reach
        ahead = (
            (((corner.mean(axis=1) - last.middle) * last.normal).sum(axis=1) > 0.0)
            & near
            & (size > 0.0)
        )
        facing = ahead & (doubled @ last.normal > FACING * size)
        if not facing.any():
            return None
        total: Array = doubled[facing].sum(axis=0)
        area = float(np.linalg.norm(total))
        return (
            _Plane(corner[facing][0, 0], total / area) if area > ENDED * 2.0 * last.area else None
        )


def centre_line(bodies: Sequence[Body], start: Array, way: Array, depth: float) -> Nodes:
    """Points and directions of the line through the middles of a solid's sections by planes normal to it. It begins where
    the solid stands on the plane through a point `start` (3,) with the unit normal `way`; depth: mm above that of the first
    section. InputError GUIDE_NOT_FOUND."""
    solid = _Solid(bodies)
    name = bodies[0].name if len(bodies) == 1 else f"{len(bodies)} solids"
    first = solid.section(start + depth * way, way, None)
    if first is None or len(bodies) > 1:
        raise _not_found(
            name, "it is several solids" if len(bodies) > 1 else "no section lies where it stands"
        )
    found = _followed(solid, first, way)
    if len(found) < 3:
        raise _not_found(name, "the solid ends after one section")
    nodes, areas = _smoothed(solid, found, _Plane(start, way))
    length = np.linalg.norm(np.diff(nodes.points, axis=0), axis=1).sum()
    led = float(length * np.mean(areas)) / SolidMesh(bodies[0].vertices, bodies[0].triangles).volume
    if not LED < led < 2.0 - LED:
        raise _not_found(
            name,
            Text("the line of {:.4g} mm leads through {:.3g} % of the volume", length, 100.0 * led),
        )
    return nodes


def _not_found(name: str, why: str) -> InputError:
    return InputError(
        "GUIDE_NOT_FOUND",
        "strategy.guide",
        "auto finds no centre line of {} from where it stands: {}; choose an edge, a "
        "wire or a sketch as guide, or set strategy.direction so that the part stands on one of its ends",
        name,
        why,
    )


def _followed(solid: _Solid, first: Section, way: Array) -> list[Section]:
    """Sections from the first one on to where the solid ends."""
    found, normal = [first], way
    stride = STEP_SHARE * first.reach
    while len(found) < MAX_SECTIONS:
        last = found[-1]
        here: Section | None = solid.section(
            last.middle + stride * normal, normal, REACH * last.reach
        )
        for _ in range(2):
            if here is None:
                break
            chord = (here.middle - last.middle) / max(
                float(np.linalg.norm(here.middle - last.middle)), 1e-9
            )
            turned = 2.0 * (chord @ normal) * chord - normal  # as along an arc
            ahead = chord + 0.5 * (turned - chord)
            ahead /= np.linalg.norm(ahead)
            here = solid.section(here.middle, ahead, REACH * last.reach)
        if (
            here is None
            or here.area < ENDED * last.area
            or (here.middle - last.middle) @ normal < 0.3 * stride
        ):
            break
        found.append(here)
        normal = ahead
    return found


def _smoothed(solid: _Solid, found: Sequence[Section], start: _Plane) -> tuple[Nodes, Array]:
    """The smooth line through the middles of sections by planes normal to it, from the plane where the solid stands; and the
    areas of these sections."""
    middles = np.array([one.middle for one in found])
    size = float(np.mean([one.reach for one in found]))
    areas = np.array([one.area for one in found])
    end = solid.end(found[-1])
    for _ in range(ROUNDS):
        line, places = _line(middles, start, end)
        points, along = _at(line, places)
        cuts = [solid.section(point, normal, REACH * size) for point, normal in zip(points, along)]
        kept = [
            one for one in cuts if one is not None and one.area > ENDED * float(np.median(areas))
        ]
        if len(kept) < 3:
            break
        middles, areas = (
            np.array([one.middle for one in kept]),
            np.array([one.area for one in kept]),
        )
    line, places = _line(middles, start, end)
    before, after = (
        0.0 if plane is None else float(plane.above(middle))
        for plane, middle in ((start, middles[0]), (end, middles[-1]))
    )
    dense = np.linspace(
        places[0] - before, places[-1] + max(-after, 0.0), NODES * (len(places) - 1) + 1
    )
    return Nodes(*_at(line, dense)), areas


def _line(middles: Array, start: _Plane, end: _Plane | None) -> tuple[CubicSpline, Array]:
    """A smooth line past points (n, 3), and their places along it. It is as near to them as its third differences allow
    (Whittaker 1923), so that its curvature goes from one value to the next without swinging; planes in which the solid ends
    are its mirrors, so that it is normal to them."""
    count = min(MIRRORED, len(middles))
    after = np.zeros((0, 3)) if end is None else end.mirrored(middles[-count:][::-1])
    whole = np.vstack([start.mirrored(middles[:count][::-1]), middles, after])
    third = diags([-1.0, 3.0, -3.0, 1.0], [0, 1, 2, 3], shape=(len(whole) - 3, len(whole)))
    stiff = (SMOOTH / STEP_SHARE / TURN) ** 6
    smooth = spsolve((identity(len(whole)) + stiff * third.T @ third).tocsc(), whole)
    places = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(smooth, axis=0), axis=1))]
    return CubicSpline(places, smooth), places[count : count + len(middles)]


def _at(line: CubicSpline, places: Array) -> tuple[Array, Array]:
    points, along = line(places), line(places, 1)
    return points, along / np.linalg.norm(along, axis=1, keepdims=True)
