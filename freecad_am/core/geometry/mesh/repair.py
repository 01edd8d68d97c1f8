# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes as solids: what is safe to repair is repaired and told, what is not is refused with its place.

Safe are: points that are one but for rounding, triangles without an area or there twice, a missing triangle, triangles
turned against their neighbours, a solid turned inside out. Within what is asked for: small holes, edges of more than two
triangles, loose flat pieces, and triangles that cross, which sections take as one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...types import Array, Index
from ..formatting import place
from .crossing import crossings
from .manifold import filled, holes, separated
from .orientation import alike_across, connected_pieces, solids_of, turned_alike
from .refined import Edges
from .solid import SolidMesh

WELDS = (1e-5, 1e-4, 1e-3, 1e-2)  # mm; the first that closes the mesh
MOST_NAMED = 8
ROUNDS = 4
MOSTLY = 0.5  # of the triangles
END = 0.5  # of the largest opening of a surface; what is larger is an end of it too


class Repaired(NamedTuple):
    """The separate solids of a mesh, each closed and with its triangles counter-clockwise from outside."""

    solids: tuple[SolidMesh, ...]
    issues: tuple[Issue, ...]


def repaired(
    points: Array, triangles: Index, label: str, hole: float = 0.0, crossing: bool = False
) -> Repaired:
    """Points (n, 3) and triangles (m, 3) as solids. hole: the largest hole that is closed, mm. crossing: a solid may cut
    itself, which is told.

    InputError BAD_FILE, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE, NO_SOLID, SELF_CROSSING.
    """
    if not len(triangles) or not np.isfinite(points).all():
        raise InputError(
            "BAD_FILE",
            label,
            "the mesh has no triangles, or points that are not numbers; export it again",
        )
    messages: list[str] = []
    mended: list[str] = []
    vertices, corners = _closed(points, triangles, messages)
    if not len(corners):
        raise InputError("NO_SOLID", label, "the mesh encloses nothing; export the solid again")
    edges = Edges(corners)
    if (edges.count != 2).any():
        vertices, corners = _mended(vertices, corners, label, hole, messages, mended)
        edges = Edges(corners)
    corners = turned_alike(vertices, corners, edges, label, messages)
    solids = solids_of(vertices, corners, messages)
    if not solids:
        raise InputError("NO_SOLID", label, "the mesh encloses nothing; export the solid again")
    for solid in solids:
        if crossing:
            mended += crossing_messages(solid, WELDS[-1])
        else:
            solid.refuse_crossing(label, WELDS[-1])
    issues = []
    if messages:
        issues.append(
            Issue(
                NOTE,
                "MESH_REPAIRED",
                Text("{}: {}", label, Text.joined("; ", messages[:MOST_NAMED])),
            )
        )
    return Repaired(solids, (*issues, *mended_issues(label, mended)))


def mended_issues(label: str, mended: list[str]) -> tuple[Issue, ...]:
    """What was mended, and where, as an issue; none for nothing."""
    if not mended:
        return ()
    return (
        Issue(WARNING, "MENDED", Text("{}: {}", label, Text.joined("; ", mended[:MOST_NAMED]))),
    )


class Connected(NamedTuple):
    """A mesh whose triangles have at most one neighbour at each edge, and agree with it; what was mended."""

    vertices: Array
    triangles: Index
    issues: tuple[Issue, ...]
    mended: tuple[str, ...]


def connected_triangles(points: Array, triangles: Index, label: str, hole: float) -> Connected:
    """Points (n, 3) and triangles (m, 3) as a surface that may be open. hole: holes up to so many mm across are closed,
    where they are smaller than END of the largest opening of their piece. InputError NO_SOLID."""
    messages: list[str] = []
    mended: list[str] = []
    vertices, corners = _closed(points, triangles, messages)
    if not len(corners):
        raise InputError(
            "NO_SOLID", label, "all triangles of the mesh cancel one another; export it again"
        )
    edges = Edges(corners)
    corners = alike_across(corners, edges, np.flatnonzero(edges.count == 2), messages)
    found = separated(vertices, corners)
    if found.split:
        at = place(vertices[edges.ends[np.argmax(edges.count > 2)]].mean(axis=0))
        mended.append(f"{found.split} edges of more than two triangles were divided, as at {at}")
    piece = connected_pieces(found.triangles)
    owner = np.zeros(len(found.vertices), dtype=np.intp)
    owner[found.triangles] = piece[:, None]
    largest: dict[int, float] = {}
    small = [
        one
        for one in holes(found)
        if one.size <= min(hole, END * largest.setdefault(int(owner[one.loop[0]]), one.size))
    ]
    if small:
        widest = small[0]
        mended.append(
            f"{len(small)} holes were closed, the largest {widest.size:.3g} mm across at {place(widest.middle)}"
        )
    vertices, corners = filled(found.vertices, found.triangles, small)
    issues = (
        (
            Issue(
                NOTE,
                "MESH_REPAIRED",
                Text("{}: {}", label, Text.joined("; ", messages[:MOST_NAMED])),
            ),
        )
        if messages
        else ()
    )
    return Connected(vertices, corners, issues, tuple(mended))


def crossing_messages(solid: SolidMesh, least: float) -> list[str]:
    """Where a solid cuts itself by more than `least` mm, in words; nothing where it does not."""
    found = crossings(solid.vertices, solid.triangles, least)
    if not len(found.pairs):
        return []
    return [
        Text(
            "{} pairs of triangles cross, as at {}, and what any of them enclose counts as inside",
            len(found.pairs),
            place(found.places[found.length.argmax()]),
        )
    ]


def _mended(
    vertices: Array, corners: Index, label: str, size: float, messages: list[str], mended: list[str]
) -> tuple[Array, Index]:
    """A mesh that is not closed as one that is. InputError OPEN_MESH, NON_MANIFOLD where a hole is larger than `size`."""
    before = Edges(corners)
    two = before.count == 2
    corners = alike_across(corners, before, np.flatnonzero(two), messages)
    found = separated(vertices, corners)
    open_ = holes(found)
    large = [hole for hole in open_ if hole.size > size]
    if large and not (before.count == 1).any():
        where = place(vertices[before.ends[np.argmax(before.count > 2)]].mean(axis=0))
        raise InputError(
            "NON_MANIFOLD",
            label,
            "three or more triangles share an edge: {} edges, the first at {}; repair the mesh "
            "(Mesh, Analyze)",
            int((before.count > 2).sum()),
            where,
        )
    if large:
        raise InputError(
            "OPEN_MESH",
            label,
            "the mesh has a hole: {} edges, {:.4g} mm across, at {}{}{}; fill holes (Mesh, Close holes) "
            "or export it again, or deposit it as a wall if it is one",
            len(large[0].loop),
            large[0].size,
            place(large[0].middle),
            Word(Text(", and {} more", len(large) - 1) if len(large) > 1 else ""),
            Word(Text("; up to strategy.mend, {:g} mm, holes are closed", size) if size else ""),
        )
    if found.split:
        at = place(vertices[before.ends[np.argmax(before.count > 2)]].mean(axis=0))
        mended.append(
            Text("{} edges of more than two triangles were divided, as at {}", found.split, at)
        )
    if open_:
        widest = open_[0]
        mended.append(
            Text(
                "{} holes were closed, the largest {:.3g} mm across at {}",
                len(open_),
                widest.size,
                place(widest.middle),
            )
        )
    vertices, corners = filled(found.vertices, found.triangles, open_)
    for _ in range(ROUNDS):
        if (Edges(corners).count == 2).all():
            break
        again = separated(
            vertices, corners
        )  # what was closed may lie on what was there, as a fin's other side does
        vertices, corners = filled(again.vertices, again.triangles, holes(again))
    return vertices, corners


def _closed(points: Array, triangles: Index, messages: list[str]) -> tuple[Array, Index]:
    """Vertices and triangles without doubles, by the narrowest weld that closes the mesh, else by the one that leaves the
    fewest edges open."""
    best: tuple[int, Array, Index, list[str]] | None = None
    for weld in WELDS:
        notes: list[str] = []
        vertices, corners = _welded(points, triangles, weld, notes)
        corners = _patched(corners, notes)
        if weld > WELDS[0]:
            notes.insert(0, Text("points up to {:g} mm apart were made one", weld))
        left = int((Edges(corners).count != 2).sum()) if len(corners) else len(triangles)
        if best is None or left < best[0]:
            best = (left, vertices, corners, notes)
        if not left:
            break
    assert best is not None
    messages += best[3]
    return best[1], best[2]


def _welded(points: Array, triangles: Index, weld: float, notes: list[str]) -> tuple[Array, Index]:
    same = np.arange(len(points))
    pairs = cKDTree(points).query_pairs(weld, output_type="ndarray")
    np.minimum.at(same, pairs.max(axis=1), pairs.min(axis=1))
    while (same[same] != same).any():
        same = same[same]
    corners = same[triangles]
    whole = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    if not whole.all():
        notes.append(Text("{} triangles without an area were dropped", int((~whole).sum())))
    corners = corners[whole]
    # triangles of the same three points: what is left when opposite ones cancel
    ranked = np.sort(corners, axis=1)
    number = np.ravel(np.unique(ranked, axis=0, return_inverse=True)[1])
    turn = np.argmin(corners, axis=1)
    rotated = corners[np.arange(len(corners))[:, None], (turn[:, None] + np.arange(3)) % 3]
    sense = np.where(rotated[:, 1] < rotated[:, 2], 1, -1)
    good = np.flatnonzero(np.bincount(number, weights=sense)[number] * sense > 0.0)
    kept = good[np.unique(number[good], return_index=True)[1]]
    if len(kept) < MOSTLY * (
        number.max(initial=-1) + 1
    ):  # every triangle from both sides, as for display
        kept = np.unique(number, return_index=True)[1]
    if len(kept) < len(corners):
        notes.append(
            Text("{} triangles that were there twice were dropped", len(corners) - len(kept))
        )
    corners = corners[np.sort(kept)]
    used, index = np.unique(corners, return_inverse=True)
    return points[used], np.ravel(index).reshape(-1, 3).astype(np.intp)


def _patched(corners: Index, notes: list[str]) -> Index:
    """Holes of a single missing triangle closed."""
    edges = Edges(corners)
    border = np.flatnonzero(edges.count == 1)
    if not len(border) or len(border) % 3:
        return corners
    face = edges.faces[border, 0]
    row = np.argmax(edges.of[face] == border[:, None], axis=1)
    start, end = corners[face, (row + 1) % 3], corners[face, row]  # against the neighbour
    after = dict(zip(start.tolist(), end.tolist()))
    if len(after) != len(border):
        return corners
    missing = []
    for a in sorted(after):
        b = after[a]
        c = after.get(b, -1)
        if after.get(c, -1) != a:
            return corners
        if a < b and a < c:
            missing.append((a, b, c))
    known = {
        tuple(sorted(corner)) for corner in corners[np.isin(corners, start).all(axis=1)].tolist()
    }
    if any(tuple(sorted(corner)) in known for corner in missing):
        return corners  # the border of a loose triangle
    notes.append(Text("{} missing triangles were put in", len(missing)))
    return np.vstack([corners, np.array(missing, dtype=np.intp)])
