# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes as solids: what is safe to repair is repaired and told, what is not is refused with its place.

Safe are: points that are one but for rounding, triangles without an area or there twice, a missing triangle, triangles
turned against their neighbours, a solid turned inside out. Within what is asked for: small holes, edges of more than two
triangles, loose flat pieces, and triangles that cross, which sections take as one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components
from scipy.spatial import cKDTree

from ...issues import NOTE, WARNING, InputError, Issue
from ..told import place
from ..walls.surface import dot
from .crossing import crossings
from .manifold import filled, holes, told_apart
from .refined import Edges
from .solid import Array, SolidMesh
from .triangle_mesh import Index, Mask

WELDS = (1e-5, 1e-4, 1e-3, 1e-2)  # mm; the first that closes the mesh
MOST_TOLD = 8
ROUNDS = 4
MOSTLY = 0.5  # of the triangles
END = 0.5  # of the largest opening of a surface; what is larger is an end of it too
FLAT = 1e-9  # of the cube of its size; a closed piece of less volume encloses nothing


class Repaired(NamedTuple):
    """The separate solids of a mesh, each closed and with its triangles counter-clockwise from outside."""

    solids: tuple[SolidMesh, ...]
    issues: tuple[Issue, ...]


def repaired(points: Array, triangles: Index, label: str, hole: float = 0.0, crossing: bool = False) -> Repaired:
    """Points (n, 3) and triangles (m, 3) as solids. hole: the largest hole that is closed, mm. crossing: a solid may cut
    itself, which is told.

    InputError BAD_FILE, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE, NO_SOLID, SELF_CROSSING.
    """
    if not len(triangles) or not np.isfinite(points).all():
        raise InputError("BAD_FILE", label, "the mesh has no triangles, or points that are no numbers; export it again")
    told: list[str] = []
    mended: list[str] = []
    vertices, corners = _closed(points, triangles, told)
    if not len(corners):
        raise InputError("NO_SOLID", label, "the mesh encloses nothing; export the solid again")
    edges = Edges(corners)
    if (edges.count != 2).any():
        vertices, corners = _mended(vertices, corners, label, hole, told, mended)
        edges = Edges(corners)
    corners = _turned_alike(vertices, corners, edges, label, told)
    solids = _apart(vertices, corners, told)
    if not solids:
        raise InputError("NO_SOLID", label, "the mesh encloses nothing; export the solid again")
    for solid in solids:
        if crossing:
            mended += crossing_told(solid, WELDS[-1])
        else:
            solid.refuse_crossing(label, WELDS[-1])
    issues = []
    if told:
        issues.append(Issue(NOTE, "MESH_REPAIRED", f"{label}: {'; '.join(told[:MOST_TOLD])}"))
    return Repaired(solids, (*issues, *mended_issues(label, mended)))


def mended_issues(label: str, mended: list[str]) -> tuple[Issue, ...]:
    """What was mended, and where, as an issue; none for nothing."""
    if not mended:
        return ()
    return (Issue(WARNING, "MENDED", f"{label}: {'; '.join(mended[:MOST_TOLD])}"),)


class Connected(NamedTuple):
    """A mesh whose triangles have at most one neighbour at each edge, and agree with it; what was mended."""

    vertices: Array
    triangles: Index
    issues: tuple[Issue, ...]
    mended: tuple[str, ...]


def connected_triangles(points: Array, triangles: Index, label: str, hole: float) -> Connected:
    """Points (n, 3) and triangles (m, 3) as a surface that may be open. hole: holes up to so many mm across are closed,
    where they are smaller than END of the largest opening of their piece. InputError NO_SOLID."""
    told: list[str] = []
    mended: list[str] = []
    vertices, corners = _closed(points, triangles, told)
    if not len(corners):
        raise InputError("NO_SOLID", label, "all triangles of the mesh cancel one another; export it again")
    edges = Edges(corners)
    corners = _alike_across(corners, edges, np.flatnonzero(edges.count == 2), told)
    found = told_apart(vertices, corners)
    if found.split:
        at = place(vertices[edges.ends[np.argmax(edges.count > 2)]].mean(axis=0))
        mended.append(f"{found.split} edges of more than two triangles were divided, as at {at}")
    piece = _pieces(found.triangles)
    owner = np.zeros(len(found.vertices), dtype=np.intp)
    owner[found.triangles] = piece[:, None]
    largest: dict[int, float] = {}
    small = [
        one for one in holes(found)
        if one.size <= min(hole, END * largest.setdefault(int(owner[one.loop[0]]), one.size))
    ]
    if small:
        widest = small[0]
        mended.append(
            f"{len(small)} holes were closed, the largest {widest.size:.3g} mm across at {place(widest.middle)}"
        )
    vertices, corners = filled(found.vertices, found.triangles, small)
    issues = (Issue(NOTE, "MESH_REPAIRED", f"{label}: {'; '.join(told[:MOST_TOLD])}"),) if told else ()
    return Connected(vertices, corners, issues, tuple(mended))


def _pieces(corners: Index) -> Index:
    """The piece (m,) that each triangle hangs together with."""
    edges = Edges(corners)
    one, other = edges.faces[edges.count == 2].T
    links = coo_matrix((np.ones(len(one)), (one, other)), shape=(len(corners), len(corners)))
    found: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return found


def crossing_told(solid: SolidMesh, least: float) -> list[str]:
    """Where a solid cuts itself by more than `least` mm, in words; nothing where it does not."""
    found = crossings(solid.vertices, solid.triangles, least)
    if not len(found.pairs):
        return []
    return [
        f"{len(found.pairs)} pairs of triangles cross, as at {place(found.places[found.length.argmax()])}, and what any of "
        "them enclose counts as inside"
    ]


def _mended(
    vertices: Array, corners: Index, label: str, size: float, told: list[str], mended: list[str]
) -> tuple[Array, Index]:
    """A mesh that is not closed as one that is. InputError OPEN_MESH, NON_MANIFOLD where a hole is larger than `size`."""
    before = Edges(corners)
    two = before.count == 2
    corners = _alike_across(corners, before, np.flatnonzero(two), told)
    found = told_apart(vertices, corners)
    open_ = holes(found)
    large = [hole for hole in open_ if hole.size > size]
    if large and not (before.count == 1).any():
        where = place(vertices[before.ends[np.argmax(before.count > 2)]].mean(axis=0))
        raise InputError(
            "NON_MANIFOLD", label, f"three or more triangles share an edge: {int((before.count > 2).sum())} edges, the "
            f"first at {where}; repair the mesh (Mesh, Analyze)",
        )
    if large:
        raise InputError(
            "OPEN_MESH", label, f"the mesh has a hole: {len(large[0].loop)} edges, {large[0].size:.4g} mm across, at "
            f"{place(large[0].middle)}" + (f", and {len(large) - 1} more" if len(large) > 1 else "") + (
                f"; up to strategy.mend, {size:g} mm, holes are closed" if size else ""
            ) + "; fill holes (Mesh, Close holes) or export it again, or deposit it as a wall if it is one",
        )
    if found.split:
        at = place(vertices[before.ends[np.argmax(before.count > 2)]].mean(axis=0))
        mended.append(f"{found.split} edges of more than two triangles were divided, as at {at}")
    if open_:
        widest = open_[0]
        mended.append(
            f"{len(open_)} holes were closed, the largest {widest.size:.3g} mm across at {place(widest.middle)}"
        )
    vertices, corners = filled(found.vertices, found.triangles, open_)
    for _ in range(ROUNDS):
        if (Edges(corners).count == 2).all():
            break
        again = told_apart(vertices, corners)  # what was closed may lie on what was there, as a fin's other side does
        vertices, corners = filled(again.vertices, again.triangles, holes(again))
    return vertices, corners


def _closed(points: Array, triangles: Index, told: list[str]) -> tuple[Array, Index]:
    """Vertices and triangles without doubles, by the narrowest weld that closes the mesh, else by the one that leaves the
    fewest edges open."""
    best: tuple[int, Array, Index, list[str]] | None = None
    for weld in WELDS:
        notes: list[str] = []
        vertices, corners = _welded(points, triangles, weld, notes)
        corners = _patched(corners, notes)
        if weld > WELDS[0]:
            notes.insert(0, f"points up to {weld:g} mm apart were made one")
        left = int((Edges(corners).count != 2).sum()) if len(corners) else len(triangles)
        if best is None or left < best[0]:
            best = (left, vertices, corners, notes)
        if not left:
            break
    assert best is not None
    told += best[3]
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
        notes.append(f"{int((~whole).sum())} triangles without an area were dropped")
    corners = corners[whole]
    # triangles of the same three points: what is left when opposite ones cancel
    ranked = np.sort(corners, axis=1)
    number = np.ravel(np.unique(ranked, axis=0, return_inverse=True)[1])
    turn = np.argmin(corners, axis=1)
    rolled = corners[np.arange(len(corners))[:, None], (turn[:, None] + np.arange(3)) % 3]
    sense = np.where(rolled[:, 1] < rolled[:, 2], 1, -1)
    good = np.flatnonzero(np.bincount(number, weights=sense)[number] * sense > 0.0)
    kept = good[np.unique(number[good], return_index=True)[1]]
    if len(kept) < MOSTLY * (number.max(initial=-1) + 1):  # every triangle from both sides, as for display
        kept = np.unique(number, return_index=True)[1]
    if len(kept) < len(corners):
        notes.append(f"{len(corners) - len(kept)} triangles that were there twice were dropped")
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
    known = {tuple(sorted(corner)) for corner in corners[np.isin(corners, start).all(axis=1)].tolist()}
    if any(tuple(sorted(corner)) in known for corner in missing):
        return corners  # the border of a loose triangle
    notes.append(f"{len(missing)} missing triangles were put in")
    return np.vstack([corners, np.array(missing, dtype=np.intp)])


def _turned_alike(vertices: Array, corners: Index, edges: Edges, label: str, told: list[str]) -> Index:
    """Triangles turned so that neighbours agree."""
    turned = _alike_across(corners, edges, np.arange(len(edges.ends)), told)
    forward = turned < np.roll(turned, -1, axis=1)
    one, other = edges.faces.T
    number = Edges(turned)
    ways = [forward[face, np.argmax(number.of[face] == np.arange(len(one))[:, None], axis=1)] for face in (one, other)]
    wrong = ways[0] == ways[1]
    if wrong.any():
        where = place(vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
        raise InputError("NOT_ORIENTABLE", label, f"the mesh has no inside, as at {where}; model the solid again")
    return turned


def _alike_across(corners: Index, edges: Edges, two: Index, told: list[str]) -> Index:
    """Triangles turned so that neighbours across edges (k,) of two agree, as far as they can."""
    forward = corners < np.roll(corners, -1, axis=1)
    one, other = edges.faces[two].T
    ways = [forward[face, np.argmax(edges.of[face] == two[:, None], axis=1)] for face in (one, other)]
    against = ways[0] == ways[1]
    if not against.any():
        return corners
    flip = _flips(len(corners), one, other, against)
    told.append(f"{int(min(flip.sum(), (~flip).sum()))} triangles were turned to agree with their neighbours")
    return np.where(flip[:, None], corners[:, ::-1], corners)


def _flips(count: int, one: Index, other: Index, against: Mask) -> Mask:
    """Which triangles to turn, told from neighbour to neighbour."""
    links = coo_matrix((np.ones(len(one)), (one, other)), shape=(count, count)).tocsr()
    crossed = {(int(a), int(b)) for a, b in zip(one[against], other[against])}
    crossed |= {(b, a) for a, b in crossed}
    _, piece = connected_components(links, directed=False)
    flip = np.zeros(count, dtype=bool)
    for start in np.unique(piece, return_index=True)[1]:
        order, before = breadth_first_order(links, start, directed=False)
        for face in order[1:].tolist():
            near = int(before[face])
            flip[face] = flip[near] ^ ((near, face) in crossed)
    most = np.bincount(piece, weights=flip) > 0.5 * np.bincount(piece)  # the fewer are the wrong ones
    turned: Mask = flip ^ most[piece]
    return turned


def _apart(vertices: Array, corners: Index, told: list[str]) -> tuple[SolidMesh, ...]:
    """Pieces that hang together, outermost ones turned outside out and cavities with the solid about them."""
    piece = _pieces(corners)
    pieces = np.split(corners[np.argsort(piece, kind="stable")], np.cumsum(np.bincount(piece))[:-1])
    low = np.array([vertices[some].min(axis=(0, 1)) for some in pieces])
    high = np.array([vertices[some].max(axis=(0, 1)) for some in pieces])
    volume = np.array([SolidMesh(vertices, some).volume for some in pieces])
    bulky = np.abs(volume) > FLAT * np.linalg.norm(high - low, axis=1) ** 3
    if not bulky.all():
        told.append(f"{int((~bulky).sum())} pieces that enclose nothing were dropped")
    about = {}
    for k in np.flatnonzero(bulky & (volume < 0.0)).tolist():
        wider = np.flatnonzero((low < low[k]).all(axis=1) & (high > high[k]).all(axis=1) & bulky & (volume > 0.0))
        inside = [j for j in wider.tolist() if _winding(vertices[pieces[j]], vertices[pieces[k][0, 0]]) > 0.5]
        if inside:
            about[k] = min(inside, key=lambda j: volume[j])
    outer = [k for k in np.flatnonzero(bulky).tolist() if k not in about]
    turned = [k for k in outer if volume[k] < 0.0]
    if turned:
        told.append(f"{len(turned)} solids were inside out and were turned")
    found = []
    for k in outer:
        own = [pieces[k][:, ::-1] if volume[k] < 0.0 else pieces[k]]
        own += [pieces[j] for j, around in about.items() if around == k]
        used, index = np.unique(np.vstack(own), return_inverse=True)
        found.append(SolidMesh(vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)))
    return tuple(found)


def _winding(corners: Array, point: Array) -> float:
    """How often triangles (m, 3, 3) go round a point (Van Oosterom and Strackee 1983)."""
    a, b, c = ((corners - point)[:, k] for k in range(3))
    u, v, w = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    below = u * v * w + dot(a, b) * w + dot(b, c) * u + dot(c, a) * v
    return float(np.arctan2(dot(a, np.cross(b, c)), below).sum() / (2.0 * np.pi))
