# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert meshes to solids: repair and report safe defects, reject other defects with a position.

Safe repairs: points equal except for rounding, degenerate or duplicate triangles, a single missing
triangle, triangles reversed against their neighbours, an inside-out solid. On request: small holes,
edges of more than two triangles, loose flat components, and crossing triangles, which sections
unite.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...issues import NOTE, WARNING, InputError, Issue, Text, Word
from ...types import Array, Index
from ..formatting import place
from .manifold import fill_holes, find_holes, separate_vertices
from .near_triangles import find_crossings
from .refine import Edges
from .solid import SolidMesh, connected_pieces, orient_across, orient_triangles, split_solids

WELDS_MM = (1e-5, 1e-4, 1e-3, 1e-2)  # mm; merge distances to try until the mesh is closed
MAX_MESSAGES = 8
ROUNDS = 4
MIN_SINGLE_SHARE = 0.5  # of the distinct triangles; below it the mesh is two-sided
MAX_HOLE_SHARE = (
    0.5  # of the largest opening of a surface; a larger opening is an end of the surface
)


class Repaired(NamedTuple):
    """The closed solids of a mesh, with triangles counter-clockwise seen from outside."""

    solids: tuple[SolidMesh, ...]
    issues: tuple[Issue, ...]


def repair_mesh(
    points: Array, triangles: Index, label: str, hole: float = 0.0, crossing: bool = False
) -> Repaired:
    """Convert a mesh to solids.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm; equal points are merged.
    triangles : (m, 3) int array
        Triangles.
    label : str
        Name of the part, for messages.
    hole : float, optional
        Maximum size of a hole to close, mm.
    crossing : bool, optional
        Whether to accept and report self-intersections.

    Returns
    -------
    Repaired
        Solids, and issues about repairs.

    Raises
    ------
    InputError
        BAD_FILE, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE, NO_SOLID, SELF_CROSSING.
    """
    if not len(triangles) or not np.isfinite(points).all():
        raise InputError(
            "BAD_FILE",
            label,
            "the mesh has no triangles, or points with invalid coordinates; export it again",
        )
    messages: list[str] = []
    mended: list[str] = []
    vertices, corners = _weld_closed(points, triangles, messages)
    if not len(corners):
        raise InputError("NO_SOLID", label, "the mesh encloses no volume; export the solid again")
    edges = Edges(corners)
    if (edges.count != 2).any():
        vertices, corners = _close_holes(vertices, corners, label, hole, messages, mended)
        edges = Edges(corners)
    corners = orient_triangles(vertices, corners, edges, label, messages)
    solids = split_solids(vertices, corners, messages)
    if not solids:
        raise InputError("NO_SOLID", label, "the mesh encloses no volume; export the solid again")
    for solid in solids:
        if crossing:
            mended += crossing_messages(solid, WELDS_MM[-1])
        else:
            solid.refuse_crossing(label, WELDS_MM[-1])
    issues = []
    if messages:
        issues.append(
            Issue(
                NOTE,
                "MESH_REPAIRED",
                Text("{}: {}", label, Text.joined("; ", messages[:MAX_MESSAGES])),
            )
        )
    return Repaired(solids, (*issues, *mended_issues(label, mended)))


def mended_issues(label: str, mended: list[str]) -> tuple[Issue, ...]:
    """Return an issue that reports repairs with their positions; empty without repairs."""
    if not mended:
        return ()
    return (
        Issue(WARNING, "MENDED", Text("{}: {}", label, Text.joined("; ", mended[:MAX_MESSAGES]))),
    )


class Connected(NamedTuple):
    """A mesh with at most two consistently oriented triangles per edge, and its repairs."""

    vertices: Array
    triangles: Index
    issues: tuple[Issue, ...]
    mended: tuple[str, ...]


def connected_triangles(points: Array, triangles: Index, label: str, hole: float) -> Connected:
    """Convert a mesh to a surface that may be open.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm; equal points are merged.
    triangles : (m, 3) int array
        Triangles.
    label : str
        Name of the part, for messages.
    hole : float
        Maximum size of a hole to close, mm. Holes larger than MAX_HOLE_SHARE of the largest
        opening of their component stay open.

    Returns
    -------
    Connected
        Surface and repairs.

    Raises
    ------
    InputError
        NO_SOLID if all triangles cancel each other.
    """
    messages: list[str] = []
    mended: list[str] = []
    vertices, corners = _weld_closed(points, triangles, messages)
    if not len(corners):
        raise InputError(
            "NO_SOLID", label, "all triangles of the mesh cancel each other; export it again"
        )
    edges = Edges(corners)
    corners = orient_across(corners, edges, np.flatnonzero(edges.count == 2), messages)
    manifold = separate_vertices(vertices, corners)
    if manifold.split:
        position = place(vertices[edges.ends[np.argmax(edges.count > 2)]].mean(axis=0))
        mended.append(
            f"{manifold.split} edges of more than two triangles were divided, as at {position}"
        )
    component = connected_pieces(manifold.triangles)
    owner = np.zeros(len(manifold.vertices), dtype=np.intp)
    owner[manifold.triangles] = component[:, None]
    largest: dict[int, float] = {}
    small = [
        opening
        for opening in find_holes(manifold)
        if opening.size
        <= min(hole, MAX_HOLE_SHARE * largest.setdefault(int(owner[opening.loop[0]]), opening.size))
    ]
    if small:
        widest = small[0]
        mended.append(
            f"{len(small)} holes were closed, the largest {widest.size:.3g} mm across at {place(widest.middle)}"
        )
    vertices, corners = fill_holes(manifold.vertices, manifold.triangles, small)
    issues = (
        (
            Issue(
                NOTE,
                "MESH_REPAIRED",
                Text("{}: {}", label, Text.joined("; ", messages[:MAX_MESSAGES])),
            ),
        )
        if messages
        else ()
    )
    return Connected(vertices, corners, issues, tuple(mended))


def crossing_messages(solid: SolidMesh, min_length: float) -> list[str]:
    """Describe self-intersections of a solid longer than `min_length` mm; empty without any."""
    pairs = find_crossings(solid.vertices, solid.triangles, min_length)
    if not len(pairs.pairs):
        return []
    return [
        Text(
            "{} pairs of triangles intersect, as at {}; the union of the enclosed volumes counts "
            "as inside",
            len(pairs.pairs),
            place(pairs.positions[pairs.length.argmax()]),
        )
    ]


def _close_holes(
    vertices: Array, corners: Index, label: str, size: float, messages: list[str], mended: list[str]
) -> tuple[Array, Index]:
    """Close an open mesh.

    Raises InputError OPEN_MESH or NON_MANIFOLD if a hole is larger than `size`.
    """
    edges = Edges(corners)
    two = edges.count == 2
    corners = orient_across(corners, edges, np.flatnonzero(two), messages)
    manifold = separate_vertices(vertices, corners)
    open_ = find_holes(manifold)
    large = [hole for hole in open_ if hole.size > size]
    if large and not (edges.count == 1).any():
        where = place(vertices[edges.ends[np.argmax(edges.count > 2)]].mean(axis=0))
        raise InputError(
            "NON_MANIFOLD",
            label,
            "three or more triangles share an edge: {} edges, the first at {}; repair the mesh "
            "(Mesh, Analyze)",
            int((edges.count > 2).sum()),
            where,
        )
    if large:
        raise InputError(
            "OPEN_MESH",
            label,
            "the mesh has a hole: {} edges, {:.4g} mm across, at {}{}{}; close the holes (Mesh, "
            "Close holes), export the mesh again, or deposit it as a wall",
            len(large[0].loop),
            large[0].size,
            place(large[0].middle),
            Word(Text(", and {} more", len(large) - 1) if len(large) > 1 else ""),
            Word(Text("; holes up to strategy.mend = {:g} mm are closed", size) if size else ""),
        )
    if manifold.split:
        position = place(vertices[edges.ends[np.argmax(edges.count > 2)]].mean(axis=0))
        mended.append(
            Text(
                "{} edges of more than two triangles were split, as at {}",
                manifold.split,
                position,
            )
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
    vertices, corners = fill_holes(manifold.vertices, manifold.triangles, open_)
    for _ in range(ROUNDS):
        if (Edges(corners).count == 2).all():
            break
        again = separate_vertices(
            vertices, corners
        )  # new triangles may coincide with existing triangles, as on the other side of a fin
        vertices, corners = fill_holes(again.vertices, again.triangles, find_holes(again))
    return vertices, corners


def _weld_closed(points: Array, triangles: Index, messages: list[str]) -> tuple[Array, Index]:
    """Merge points with the smallest distance that closes the mesh; drop duplicate triangles.

    If no distance closes the mesh, use the distance that leaves the fewest open edges.
    """
    best: tuple[int, Array, Index, list[str]] | None = None
    for weld in WELDS_MM:
        notes: list[str] = []
        vertices, corners = _weld_points(points, triangles, weld, notes)
        corners = _fill_single_triangles(corners, notes)
        if weld > WELDS_MM[0]:
            notes.insert(0, Text("points up to {:g} mm apart were merged", weld))
        open_count = int((Edges(corners).count != 2).sum()) if len(corners) else len(triangles)
        if best is None or open_count < best[0]:
            best = (open_count, vertices, corners, notes)
        if not open_count:
            break
    assert best is not None
    messages += best[3]
    return best[1], best[2]


def _weld_points(
    points: Array, triangles: Index, weld: float, notes: list[str]
) -> tuple[Array, Index]:
    same = np.arange(len(points))
    pairs = cKDTree(points).query_pairs(weld, output_type="ndarray")
    np.minimum.at(same, pairs.max(axis=1), pairs.min(axis=1))
    while (same[same] != same).any():
        same = same[same]
    corners = same[triangles]
    has_area = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    if not has_area.all():
        notes.append(Text("{} degenerate triangles were removed", int((~has_area).sum())))
    corners = corners[has_area]
    # triangles with the same three points: opposite orientations cancel
    ranked = np.sort(corners, axis=1)
    number = np.ravel(np.unique(ranked, axis=0, return_inverse=True)[1])
    turn = np.argmin(corners, axis=1)
    rotated = corners[np.arange(len(corners))[:, None], (turn[:, None] + np.arange(3)) % 3]
    sense = np.where(rotated[:, 1] < rotated[:, 2], 1, -1)
    good = np.flatnonzero(np.bincount(number, weights=sense)[number] * sense > 0.0)
    unique_triangles = good[np.unique(number[good], return_index=True)[1]]
    if len(unique_triangles) < MIN_SINGLE_SHARE * (
        number.max(initial=-1) + 1
    ):  # the mesh has all triangles in both orientations, as for display
        unique_triangles = np.unique(number, return_index=True)[1]
    if len(unique_triangles) < len(corners):
        notes.append(
            Text(
                "{} duplicate triangles were removed",
                len(corners) - len(unique_triangles),
            )
        )
    corners = corners[np.sort(unique_triangles)]
    used, index = np.unique(corners, return_inverse=True)
    return points[used], np.ravel(index).reshape(-1, 3).astype(np.intp)


def _fill_single_triangles(corners: Index, notes: list[str]) -> Index:
    """Close holes that consist of a single missing triangle."""
    edges = Edges(corners)
    border = np.flatnonzero(edges.count == 1)
    if not len(border) or len(border) % 3:
        return corners
    face = edges.faces[border, 0]
    row = np.argmax(edges.of_triangle[face] == border[:, None], axis=1)
    start, end = corners[face, (row + 1) % 3], corners[face, row]  # opposite to the neighbour
    successor = dict(zip(start.tolist(), end.tolist()))
    if len(successor) != len(border):
        return corners
    missing = []
    for a in sorted(successor):
        b = successor[a]
        c = successor.get(b, -1)
        if successor.get(c, -1) != a:
            return corners
        if a < b and a < c:
            missing.append((a, b, c))
    loose_triangles = {
        tuple(sorted(corner)) for corner in corners[np.isin(corners, start).all(axis=1)].tolist()
    }
    if any(tuple(sorted(corner)) in loose_triangles for corner in missing):
        return corners  # this is the border of a loose triangle
    notes.append(Text("{} missing triangles were added", len(missing)))
    return np.vstack([corners, np.array(missing, dtype=np.intp)])
