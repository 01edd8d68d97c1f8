# SPDX-License-Identifier: LGPL-2.1-or-later
"""Orient triangles consistently and separate closed components: solids and their cavities."""

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

MIN_VOLUME_SHARE = 1e-9  # of the cube of its size; a closed piece of less volume encloses nothing


def connected_pieces(corners: Index) -> Index:
    """Return the connected component (m,) of each triangle."""
    edges = Edges(corners)
    a, b = edges.faces[edges.count == 2].T
    links = coo_matrix((np.ones(len(a)), (a, b)), shape=(len(corners), len(corners)))
    components: Index = connected_components(links, directed=False)[1].astype(np.intp)
    return components


def orient_triangles(
    vertices: Array, corners: Index, edges: Edges, label: str, messages: list[str]
) -> Index:
    """Return the triangles oriented so that neighbours agree.

    Raises InputError NOT_ORIENTABLE.
    """
    turned = orient_across(corners, edges, np.arange(len(edges.ends)), messages)
    forward = turned < np.roll(turned, -1, axis=1)
    face_a, face_b = edges.faces.T
    number = Edges(turned)
    senses = [
        forward[
            face, np.argmax(number.of_triangle[face] == np.arange(len(face_a))[:, None], axis=1)
        ]
        for face in (face_a, face_b)
    ]
    wrong = senses[0] == senses[1]
    if wrong.any():
        where = place(vertices[edges.ends[np.argmax(wrong)]].mean(axis=0))
        raise InputError(
            "NOT_ORIENTABLE",
            label,
            "the mesh has no consistent inside, as at {}; model the solid again",
            where,
        )
    return turned


def orient_across(corners: Index, edges: Edges, two: Index, messages: list[str]) -> Index:
    """Return the triangles oriented so that neighbours across the two-sided edges (k,) agree, as
    far as possible.
    """
    forward = corners < np.roll(corners, -1, axis=1)
    face_a, face_b = edges.faces[two].T
    senses = [
        forward[face, np.argmax(edges.of_triangle[face] == two[:, None], axis=1)]
        for face in (face_a, face_b)
    ]
    against = senses[0] == senses[1]
    if not against.any():
        return corners
    flip = _flips(len(corners), face_a, face_b, against)
    messages.append(
        Text(
            "{} triangles were flipped to match their neighbours",
            int(min(flip.sum(), (~flip).sum())),
        )
    )
    return np.where(flip[:, None], corners[:, ::-1], corners)


def _flips(count: int, face_a: Index, face_b: Index, against: Mask) -> Mask:
    """Return which triangles to flip, propagated from neighbour to neighbour."""
    links = coo_matrix((np.ones(len(face_a)), (face_a, face_b)), shape=(count, count)).tocsr()
    crossed = {(int(a), int(b)) for a, b in zip(face_a[against], face_b[against])}
    crossed |= {(b, a) for a, b in crossed}
    _, component = connected_components(links, directed=False)
    flip = np.zeros(count, dtype=bool)
    for start in np.unique(component, return_index=True)[1]:
        order, predecessor = breadth_first_order(links, start, directed=False)
        for face in order[1:].tolist():
            parent = int(predecessor[face])
            flip[face] = flip[parent] ^ ((parent, face) in crossed)
    is_minority = np.bincount(component, weights=flip) > 0.5 * np.bincount(
        component
    )  # the minority is wrong
    turned: Mask = flip ^ is_minority[component]
    return turned


def split_solids(vertices: Array, corners: Index, messages: list[str]) -> tuple[SolidMesh, ...]:
    """Return the connected components as solids.

    Outer components are turned outside out; cavities belong to the solid around them.
    """
    component = connected_pieces(corners)
    components = np.split(
        corners[np.argsort(component, kind="stable")], np.cumsum(np.bincount(component))[:-1]
    )
    low = np.array([vertices[shell].min(axis=(0, 1)) for shell in components])
    high = np.array([vertices[shell].max(axis=(0, 1)) for shell in components])
    volume = np.array([SolidMesh(vertices, shell).volume for shell in components])
    bulky = np.abs(volume) > MIN_VOLUME_SHARE * np.linalg.norm(high - low, axis=1) ** 3
    if not bulky.all():
        messages.append(Text("{} pieces that enclose no volume were removed", int((~bulky).sum())))
    about = {}
    for k in np.flatnonzero(bulky & (volume < 0.0)).tolist():
        wider = np.flatnonzero(
            (low < low[k]).all(axis=1) & (high > high[k]).all(axis=1) & bulky & (volume > 0.0)
        )
        inside = [
            j
            for j in wider.tolist()
            if _winding(vertices[components[j]], vertices[components[k][0, 0]]) > 0.5
        ]
        if inside:
            about[k] = min(inside, key=lambda j: volume[j])
    outer = [k for k in np.flatnonzero(bulky).tolist() if k not in about]
    turned = [k for k in outer if volume[k] < 0.0]
    if turned:
        message = Text("{} inside-out solids were reversed", len(turned))
        messages.append("a solid was inside out and was turned" if len(turned) == 1 else message)
    solids = []
    for k in outer:
        shells = [components[k][:, ::-1] if volume[k] < 0.0 else components[k]]
        shells += [components[j] for j, around in about.items() if around == k]
        used, index = np.unique(np.vstack(shells), return_inverse=True)
        solids.append(SolidMesh(vertices[used], np.ravel(index).reshape(-1, 3).astype(np.intp)))
    return tuple(solids)


def _winding(corners: Array, point: Array) -> float:
    """How often triangles (m, 3, 3) go round a point (Van Oosterom and Strackee 1983)."""
    a, b, c = ((corners - point)[:, k] for k in range(3))
    u, v, w = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    below = u * v * w + dot(a, b) * w + dot(b, c) * u + dot(c, a) * v
    return float(np.arctan2(dot(a, np.cross(b, c)), below).sum() / (2.0 * np.pi))
