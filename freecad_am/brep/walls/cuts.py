# SPDX-License-Identifier: LGPL-2.1-or-later
"""Self-intersection of a wall of several faces: faces that fold back, and triangles that cross."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array, Index

from ...core.geometry.formatting import place
from ...core.geometry.mesh.facets import doubled_areas
from ...core.geometry.mesh.near_pairs import near_pairs
from ...core.geometry.mesh.triangles import closest
from ...core.geometry.walls.patch import SPLINE
from ...core.geometry.walls.patch_wall import PatchWall
from ...core.geometry.walls.surface import dot
from ...core.issues import InputError, Text

BENT, FOLDED = (
    0.3,
    -0.7,
)  # cosines between the normals at the ends of an edge, and at the ends of a short section
STEPS, CLOSER = (
    np.linspace(0.0, 1.0, 33),
    4,
)  # samples of the normal on an edge, and refinements between two samples
MAX_TESTED_CUTS, CLOSING_STEPS = (
    12,
    20,
)  # cuts of triangles that are followed up, and steps to the place where the faces meet
CROSSING = 0.05  # rad; faces that touch at less run into each other, or are the same one


def refuse_folded(wall: PatchWall, label: str) -> None:
    """InputError SELF_INTERSECTION where the surface of a face folds back: its normal turns over at once."""
    for k, patch in enumerate(wall.patches):
        uv = wall.uv[wall.patch == k]
        if patch.kind != SPLINE or not len(uv):
            continue
        normal = patch.at(uv.reshape(-1, 2))[1].reshape(-1, 3, 3)
        start, end = uv, np.roll(uv, -1, axis=1)
        bent = dot(normal, np.roll(normal, -1, axis=1)) < BENT
        if not bent.any():
            continue
        start, end = start[bent], end[bent]
        # a sharp nose turns over within a part of a step, a fold at once however small the step is
        for _ in range(CLOSER):
            line = start[:, None] + STEPS[None, :, None] * (end - start)[:, None]
            normal = patch.at(line.reshape(-1, 2))[1].reshape(line.shape[:2] + (3,))
            plain = (patch.area(line.reshape(-1, 2)) > 1e-6).reshape(line.shape[:2])
            turn = np.where(plain[:, 1:] & plain[:, :-1], dot(normal[:, 1:], normal[:, :-1]), 1.0)
            sharpest = np.argmin(turn, axis=1)
            row = np.flatnonzero(turn.min(axis=1) < FOLDED)
            start, end = line[row, sharpest[row]], line[row, sharpest[row] + 1]
            if not len(row):
                break
        if len(row):
            raise InputError(
                "SELF_INTERSECTION",
                f"{label} {wall.faces[k]}",
                "the face folds back and intersects itself at {}; {}",
                place(patch.at(start[:1])[0][0]),
                FOLDS_TUBE if any(patch.periods) else FOLDS,
            )


FOLDS_TUBE = Text("use a bend radius larger than the tube radius")
FOLDS = Text("redraw it with a larger radius there, or divide it and deposit its parts in turn")
MIN_BEND_SHARE = (
    0.02  # least distance, as a share of the length of a tube, of places that cross in a bend
)


def _remedy(wall: PatchWall, triangles: tuple[int, int]) -> str:
    """What to do where two triangles of a wall cut each other."""
    patch, other_patch = (int(wall.patch[k]) for k in triangles)
    if patch != other_patch:
        return Text(
            "trim the faces at their intersection, or deposit the intersecting faces as separate "
            "features"
        )
    if _is_bend(wall, patch, triangles):
        return Text("use bend radii larger than the tube radius")
    return Text(
        "redraw the face without self-intersection, or divide it and deposit its parts in turn"
    )


def _is_bend(wall: PatchWall, patch: int, triangles: tuple[int, int]) -> bool:
    """Whether two triangles of a tube, a patch that closes one way, are at different positions
    along the tube.
    """
    closed = np.array(wall.patches[patch].periods) > 0.0
    if closed.sum() != 1:
        return bool(closed.all())
    along = wall.uv[..., int(np.argmin(closed))]
    # the triangles of a skin that crosses itself overlap along it, those of a bend are far apart
    low, high = along[list(triangles)].min(axis=1), along[list(triangles)].max(axis=1)
    gap = low.max() - high.min()
    return bool(gap > MIN_BEND_SHARE * np.ptp(along[wall.patch == patch]))


def refuse_crossing(wall: PatchWall, label: str) -> None:
    """InputError SELF_INTERSECTION where triangles of the wall that are not neighbours cut each other, and the exact faces
    do so too."""
    corner = wall.vertices[wall.triangles]
    normal = doubled_areas(corner)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    middle = corner.mean(axis=1)
    reach = np.linalg.norm(corner - middle[:, None], axis=2).max(axis=1)
    for pairs in near_pairs(middle, reach):
        chord = middle[pairs[:, 1]] - middle[pairs[:, 0]]
        length = np.maximum(np.linalg.norm(chord, axis=1), 1e-300)
        # neighbours on a smooth wall are about level with each other
        odd = np.abs(dot(chord, normal[pairs[:, 0]])) > 0.3 * length
        odd |= dot(normal[pairs[:, 0]], normal[pairs[:, 1]]) < 0.7
        pairs = pairs[odd]
        shared = (
            wall.triangles[pairs[:, 0]][:, :, None] == wall.triangles[pairs[:, 1]][:, None, :]
        ).any(axis=(1, 2))
        pairs = pairs[~shared]
        for edge_triangles, cut_triangles in (pairs.T, pairs.T[::-1]):
            _refuse_cuts(wall, corner, normal, edge_triangles, cut_triangles, label)


def _refuse_cuts(
    wall: PatchWall,
    corner: Array,
    normal: Array,
    edge_triangles: Index,
    cut_triangles: Index,
    label: str,
) -> None:
    """InputError SELF_INTERSECTION where edges of `edge_triangles` (k,) cut `cut_triangles` (k,)
    and the exact faces cut as well.
    """
    for k in range(3):
        start, end = corner[edge_triangles, k], corner[edge_triangles, (k + 1) % 3]
        a, b, c = (corner[cut_triangles, j] for j in range(3))
        low, high = dot(start - a, normal[cut_triangles]), dot(end - a, normal[cut_triangles])
        across = np.flatnonzero(low * high < 0.0)
        t = (low[across] / (low[across] - high[across]))[:, None]
        point = start[across] + t * (end[across] - start[across])
        cut = (
            closest(a[across], b[across], c[across], point)[0]
            < 1e-9 + 1e-9 * wall.mesh.longest_edge
        )
        for candidate in np.flatnonzero(cut)[:: max(1, int(cut.sum()) // MAX_TESTED_CUTS)]:
            faces = edge_triangles[across[candidate]], cut_triangles[across[candidate]]
            crossing = _crossing(wall, faces, point[candidate])
            if crossing is None:
                continue
            names = sorted({wall.faces[wall.patch[face]] for face in faces})
            raise InputError(
                "SELF_INTERSECTION",
                label,
                "the wall intersects itself at {} ({}); {}",
                place(crossing),
                Text.joined(" and ", names),
                _remedy(wall, faces),
            )


def _crossing(wall: PatchWall, triangles: tuple[int, int], point: Array) -> Array | None:
    """The point where the exact faces cut each other near the cut of two triangles at `point`, or
    None.
    """
    estimate = point[None]
    patches = [wall.patches[wall.patch[k]] for k in triangles]
    uv = [wall.uv[k].mean(axis=0)[None] for k in triangles]
    for _ in range(CLOSING_STEPS):
        uv = [patch.inverse(estimate, start) for patch, start in zip(patches, uv)]
        (foot, foot_normal), (other_foot, other_normal) = (
            patch.at(uv_point) for patch, uv_point in zip(patches, uv)
        )
        separation = float(np.linalg.norm(foot - other_foot))
        if separation < 1e-6 or np.linalg.norm(foot[0] - point) > 2.0 * wall.mesh.longest_edge:
            break
        # where the two tangent planes meet, nearest to the middle between the feet
        planes = np.stack([foot_normal[0], other_normal[0]])
        gap = np.array(
            [
                foot_normal[0] @ (foot[0] - estimate[0]),
                other_normal[0] @ (other_foot[0] - estimate[0]),
            ]
        )
        estimate = estimate + (np.linalg.pinv(planes, rcond=1e-3) @ gap)[None]
    steep = float(np.linalg.norm(np.cross(foot_normal[0], other_normal[0]))) > CROSSING
    return foot[0] if separation < 1e-6 and steep else None
