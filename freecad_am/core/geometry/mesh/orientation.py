# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles turned alike, and closed pieces told apart: solids and the hollows in them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import breadth_first_order, connected_components

from ...issues import InputError, Text
from ...types import Array, Index, Mask
from ..formatting import place
from ..walls.surface import dot
from .refined import Edges
from .solid import SolidMesh

FLAT = 1e-9  # of the cube of its size; a closed piece of less volume encloses nothing


def connected_pieces(corners: Index) -> Index:
    """The piece (m,) that each triangle hangs together with."""
    edges = Edges(corners)
    one, other = edges.faces[edges.count == 2].T
    links = coo_matrix((np.ones(len(one)), (one, other)), shape=(len(corners), len(corners)))
    found: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return found


def turned_alike(
    vertices: Array, corners: Index, edges: Edges, label: str, messages: list[str]
) -> Index:
    """Triangles turned so that neighbours agree."""
    turned = alike_across(corners, edges, np.arange(len(edges.ends)), messages)
    forward = turned < np.roll(turned, -1, axis=1)
    one, other = edges.faces.T
    number = Edges(turned)
    ways = [
        forward[face, np.argmax(number.of[face] == np.arange(len(one))[:, None], axis=1)]
        for face in (one, other)
    ]
    wrong = ways[0] == ways[1]
    if wrong.any():
        where = place(vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
        raise InputError(
            "NOT_ORIENTABLE",
            label,
            "the mesh has no inside, as at {}; model the solid again",
            where,
        )
    return turned


def alike_across(corners: Index, edges: Edges, two: Index, messages: list[str]) -> Index:
    """Triangles turned so that neighbours across edges (k,) of two agree, as far as they can."""
    forward = corners < np.roll(corners, -1, axis=1)
    one, other = edges.faces[two].T
    ways = [
        forward[face, np.argmax(edges.of[face] == two[:, None], axis=1)] for face in (one, other)
    ]
    against = ways[0] == ways[1]
    if not against.any():
        return corners
    flip = _flips(len(corners), one, other, against)
    messages.append(
        Text(
            "{} triangles were turned to agree with their neighbours",
            int(min(flip.sum(), (~flip).sum())),
        )
    )
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
    most = np.bincount(piece, weights=flip) > 0.5 * np.bincount(
        piece
    )  # the fewer are the wrong ones
    turned: Mask = flip ^ most[piece]
    return turned


def solids_of(vertices: Array, corners: Index, messages: list[str]) -> tuple[SolidMesh, ...]:
    """Pieces that hang together, outermost ones turned outside out and cavities with the solid about them."""
    piece = connected_pieces(corners)
    pieces = np.split(corners[np.argsort(piece, kind="stable")], np.cumsum(np.bincount(piece))[:-1])
    low = np.array([vertices[some].min(axis=(0, 1)) for some in pieces])
    high = np.array([vertices[some].max(axis=(0, 1)) for some in pieces])
    volume = np.array([SolidMesh(vertices, some).volume for some in pieces])
    bulky = np.abs(volume) > FLAT * np.linalg.norm(high - low, axis=1) ** 3
    if not bulky.all():
        messages.append(Text("{} pieces that enclose nothing were dropped", int((~bulky).sum())))
    about = {}
    for k in np.flatnonzero(bulky & (volume < 0.0)).tolist():
        wider = np.flatnonzero(
            (low < low[k]).all(axis=1) & (high > high[k]).all(axis=1) & bulky & (volume > 0.0)
        )
        inside = [
            j
            for j in wider.tolist()
            if _winding(vertices[pieces[j]], vertices[pieces[k][0, 0]]) > 0.5
        ]
        if inside:
            about[k] = min(inside, key=lambda j: volume[j])
    outer = [k for k in np.flatnonzero(bulky).tolist() if k not in about]
    turned = [k for k in outer if volume[k] < 0.0]
    if turned:
        many = Text("{} solids were inside out and were turned", len(turned))
        messages.append("a solid was inside out and was turned" if len(turned) == 1 else many)
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
