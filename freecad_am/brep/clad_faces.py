# SPDX-License-Identifier: LGPL-2.1-or-later
"""Faces for cladding: exact surfaces, and one mesh per smooth region."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..core.geometry.formatting import place
from ..core.geometry.mesh.refine import Edges
from ..core.geometry.walls.patch_wall import CladFaces, PatchWall
from ..core.geometry.walls.surface import dot
from ..core.issues import WARNING, InputError, Issue, Text, Word
from ..core.types import Array, Index, Mask
from .kernel.limits import reported
from .walls.checks import CREASE, smallest_radii
from .walls.patch_wall import sound
from .walls.sheet import sheet
from .walls.wall import faces_by_name

OF_RADIUS, OF_SPACING, FINEST_TRIANGLE = (
    0.25,
    0.5,
    0.1,
)  # edge length as a fraction of minimum radius, and its upper and lower fraction of bead spacing
MOST_NAMED = 8  # maximum number of face names in a message


def clad_faces(
    shape: Any, names: Sequence[str], spacing: float, back: bool, height: float, label: str
) -> CladFaces:
    """Return the named faces of a Part.Shape, prepared for cladding.

    Without names, use all faces of a shape that has no solids. spacing: bead spacing, mm. back:
    whether to clad the back of the faces. height: height of the last layer above the faces, mm.

    Raises InputError NO_FACES, UNKNOWN_FACE, SEVERAL_BODIES, BACK_OF_SOLID, BRANCHING_FACES, and
    the errors of `sheet`.
    """
    with reported(label, shape):
        faces_of_names = faces_by_name(shape, names, label)
        if not names and shape.Solids:
            raise InputError(
                "NO_FACES",
                label,
                "the object is a solid with {} face(s), but no face is selected; select the "
                "faces to cover, or name them in part.faces of a job",
                len(faces_of_names),
            )
        named = [(name, faces_of_names[name]) for name in dict.fromkeys(names or faces_of_names)]
        _refuse_several(shape, named, back, label)
        radius = float(smallest_radii(sound(named, label))[0].min())
        edge = float(np.clip(OF_RADIUS * radius, FINEST_TRIANGLE * spacing, OF_SPACING * spacing))
        wall = sheet(named, edge, label)
        if back:
            wall = _flip(wall)
        sheets, issues = _smooth(wall, height, label)
    return CladFaces(label, tuple(name for name, _ in named), sheets, (), issues)


def _refuse_several(shape: Any, named: Sequence[tuple[str, Any]], back: bool, label: str) -> None:
    """Raise InputError SEVERAL_BODIES for faces of several solids, BACK_OF_SOLID for the inside."""
    owners = {}
    for number, solid in enumerate(shape.Solids):
        codes = {face.hashCode() for face in solid.Faces}
        owners.update({name: number for name, face in named if face.hashCode() in codes})
    if len(set(owners.values())) > 1:
        face_name = next(iter(owners))
        other_name = next(name for name, number in owners.items() if number != owners[face_name])
        raise InputError(
            "SEVERAL_BODIES",
            label,
            "{} and {} are faces of different solids; cover each solid as a separate feature, or "
            "fuse them first",
            face_name,
            other_name,
        )
    if back and owners:
        raise InputError(
            "BACK_OF_SOLID",
            "strategy.side",
            "the back of {} is inside {}; use front",
            next(iter(owners)),
            label,
        )


def _flip(wall: PatchWall) -> PatchWall:
    return replace(
        wall,
        triangles=wall.triangles[:, ::-1].copy(),
        uv=wall.uv[:, ::-1].copy(),
        patches=tuple(replace(patch, sign=-patch.sign) for patch in wall.patches),
    )


def _smooth(
    wall: PatchWall, height: float, label: str
) -> tuple[tuple[PatchWall, ...], tuple[Issue, ...]]:
    """Split the wall at its creases. Return the smooth regions and crease warnings.

    Layers separate or overlap at creases.
    """
    edges = Edges(wall.triangles)
    if (edges.count > 2).any():
        point = wall.vertices[edges.ends[int(np.argmax(edges.count > 2))]].mean(axis=0)
        raise InputError(
            "BRANCHING_FACES",
            label,
            "more than two faces meet in one edge at {}; remove one of the faces, or cover it as "
            "a separate feature",
            place(point),
        )
    two = np.flatnonzero(edges.count == 2)
    pair = edges.faces[two]
    turn, inward = _turns(wall, edges.ends[two], wall.patch[pair])
    crease = turn > CREASE
    n = len(wall.triangles)
    links = coo_matrix((np.ones((~crease).sum()), pair[~crease].T), shape=(n, n))
    count, component = connected_components(links, directed=False)
    sheets = tuple(_part(wall, component == k) for k in range(count))
    return sheets, _crease_issues(
        wall, edges.ends[two], pair, turn, inward, height
    ) if height > 0.0 and crease.any() else ()


def _turns(wall: PatchWall, ends: Index, pair: Index) -> tuple[Array, Mask]:
    """Return the crease angles (k,) rad at edges, and whether the faces form a hollow there (k,).

    The crease angle is the angle between the normals of two patches, 0 inside a patch.
    """
    turn, inward = np.zeros(len(ends)), np.zeros(len(ends), dtype=bool)
    for patch, other_patch in np.unique(pair[pair[:, 0] != pair[:, 1]], axis=0):
        members = np.flatnonzero((pair == (patch, other_patch)).all(axis=1))
        points = wall.vertices[ends[members]].reshape(-1, 3)
        normals, other_normals = (
            wall.patches[k].at(wall.patches[k].inverse(points))[1] for k in (patch, other_patch)
        )
        angle = np.arctan2(
            np.linalg.norm(np.cross(normals, other_normals), axis=1), dot(normals, other_normals)
        )
        turn[members] = angle.reshape(-1, 2).max(axis=1)
        offset = _middle(wall, other_patch) - _middle(wall, patch)
        inward[members] = dot((normals - other_normals).reshape(-1, 2, 3).sum(axis=1), offset) > 0.0
    return turn, inward


def _middle(wall: PatchWall, patch: int) -> Array:
    middle: Array = wall.vertices[wall.triangles[wall.patch == patch]].mean(axis=(0, 1))
    return middle


def _part(wall: PatchWall, mask: Mask) -> PatchWall:
    """Return the part of the wall with the triangles in `mask` (m,)."""
    used, index = np.unique(wall.triangles[mask], return_inverse=True)
    patches, patch = np.unique(wall.patch[mask], return_inverse=True)
    return PatchWall(
        wall.vertices[used],
        np.ravel(index).reshape(-1, 3).astype(np.intp),
        np.ravel(patch).astype(np.intp),
        wall.uv[mask],
        tuple(wall.patches[k] for k in patches),
        (),
        np.zeros(len(used), dtype=bool),
        (),
        wall.label,
        tuple(wall.faces[k] for k in patches),
    )


def _crease_issues(
    wall: PatchWall, ends: Index, pair: Index, turn: Array, inward: Mask, height: float
) -> tuple[Issue, ...]:
    issues = []
    for hollow in (False, True):
        angles = np.where((inward == hollow) & (turn > CREASE), turn, 0.0)
        sharpest = int(np.argmax(angles))
        if angles[sharpest] == 0.0:
            continue
        face, other_face = (wall.faces[k] for k in wall.patch[pair[sharpest]])
        what = "into one another" if hollow else "apart, with a wedge left open between them"
        issues.append(
            Issue(
                WARNING,
                "CREASE",
                Text(
                    "{} and {} meet at an angle of {:.3g} deg at {}: layers above the first grow "
                    "{}, up to {:.3g} mm above the faces; round the edge, or cover the faces one "
                    "after the other",
                    face,
                    other_face,
                    np.degrees(angles[sharpest]),
                    place(wall.vertices[ends[sharpest]].mean(axis=0)),
                    Word(what),
                    height,
                ),
            )
        )
    return tuple(issues)
