# SPDX-License-Identifier: LGPL-2.1-or-later
"""Meshes as solids: what is safe to repair is repaired and told, what is not is refused with its place.

Safe are: points that are one but for rounding, triangles without an area or there twice, a missing triangle, triangles
turned against their neighbours, a solid turned inside out.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components
from scipy.spatial import cKDTree

from ..issues import NOTE, InputError, Issue
from .mesh import Index, Mask
from .refined import Edges
from .solid_mesh import Array, SolidMesh
from .told import place

WELDS = (1e-5, 1e-4, 1e-3, 1e-2)  # mm; the first that closes the mesh
MOST_TOLD = 8


class Repaired(NamedTuple):
    """The separate solids of a mesh, each closed and with its triangles counter-clockwise from outside."""

    solids: tuple[SolidMesh, ...]
    issues: tuple[Issue, ...]


def repaired(points: Array, triangles: Index, label: str) -> Repaired:
    """Points (n, 3) and triangles (m, 3) as solids.

    InputError BAD_FILE, OPEN_MESH, NON_MANIFOLD, NOT_ORIENTABLE, NO_SOLID, SELF_CROSSING.
    """
    if not len(triangles) or not np.isfinite(points).all():
        raise InputError("BAD_FILE", label, "the mesh has no triangles, or points that are no numbers; export it again")
    told: list[str] = []
    vertices, corners = _closed(points, triangles, told)
    edges = Edges(corners)
    for wrong, code, what, cure in (
        (edges.count == 1, "OPEN_MESH", "the mesh has a hole", "fill holes (Mesh, Close holes) or export it again"),
        (edges.count > 2, "NON_MANIFOLD", "three or more triangles share an edge", "repair the mesh (Mesh, Analyze)"),
    ):
        if wrong.any():
            where = place(vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
            raise InputError(code, label, f"{what}: {int(wrong.sum())} edges, the first at {where}; {cure}")
    corners = _turned_alike(vertices, corners, edges, label, told)
    solids = _apart(vertices, corners, edges, told)
    if not solids:
        raise InputError("NO_SOLID", label, "the mesh encloses nothing; export the solid again")
    for solid in solids:
        solid.refuse_crossing(label, WELDS[-1])
    if not told:
        return Repaired(solids, ())
    return Repaired(solids, (Issue(NOTE, "MESH_REPAIRED", f"{label}: {'; '.join(told[:MOST_TOLD])}"),))


def _closed(points: Array, triangles: Index, told: list[str]) -> tuple[Array, Index]:
    """Vertices and triangles without doubles, by the narrowest weld that closes the mesh, else by the first."""
    first: tuple[Array, Index, list[str]] | None = None
    for weld in WELDS:
        notes: list[str] = []
        vertices, corners = _welded(points, triangles, weld, notes)
        corners = _patched(corners, notes)
        if len(corners) and (Edges(corners).count == 2).all():
            if weld > WELDS[0]:
                notes.insert(0, f"points up to {weld:g} mm apart were made one")
            told += notes
            return vertices, corners
        first = first or (vertices, corners, notes)
    assert first is not None
    told += first[2]
    return first[0], first[1]


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
    forward = corners < np.roll(corners, -1, axis=1)
    one, other = edges.faces.T
    number = np.arange(len(edges.ends))
    ways = [forward[face, np.argmax(edges.of[face] == number[:, None], axis=1)] for face in (one, other)]
    against = ways[0] == ways[1]
    if not against.any():
        return corners
    flip = _flips(len(corners), one, other, against)
    wrong = (flip[one] ^ flip[other]) != against
    if wrong.any():
        where = place(vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
        raise InputError("NOT_ORIENTABLE", label, f"the mesh has no inside, as at {where}; model the solid again")
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
    return flip


def _apart(vertices: Array, corners: Index, edges: Edges, told: list[str]) -> tuple[SolidMesh, ...]:
    """Pieces that hang together, outermost ones turned outside out and cavities with the solid about them."""
    count = len(corners)
    links = coo_matrix((np.ones(len(edges.faces)), tuple(edges.faces.T)), shape=(count, count))
    number, piece = connected_components(links, directed=False)
    pieces = [corners[piece == k] for k in range(number)]
    boxes = [(vertices[some].min(axis=(0, 1)), vertices[some].max(axis=(0, 1))) for some in pieces]
    volume = [SolidMesh(vertices, some).volume for some in pieces]
    about = [
        [j for j in range(number) if j != k and (boxes[j][0] < boxes[k][0]).all() and (boxes[j][1] > boxes[k][1]).all()
         and volume[k] < 0.0 < volume[j]]
        for k in range(number)
    ]
    outer = [k for k in range(number) if not about[k] and abs(volume[k]) > 0.0]
    turned = [k for k in outer if volume[k] < 0.0]
    if turned:
        told.append(f"{len(turned)} solids were inside out and were turned")
    found = []
    for k in outer:
        own = [pieces[k][:, ::-1] if k in turned else pieces[k]]
        own += [pieces[j] for j in range(number) if about[j] and k == min(about[j], key=lambda one: volume[one])]
        used, index = np.unique(np.vstack(own), return_inverse=True)
        found.append(SolidMesh(vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)))
    return tuple(found)
