# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a wall of several faces must not be: apart, creased, bent too tightly, or cut by itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import FreeCAD
import numpy as np
import Part
from scipy.spatial import cKDTree

from ..core.geometry.mesh import Index, Mask
from ..core.geometry.patch import SPLINE, Array
from ..core.geometry.patch_wall import PatchWall
from ..core.geometry.refined import Edges, boundary
from ..core.geometry.surface import dot, normals
from ..core.geometry.surface_wall import SurfaceWall
from ..core.geometry.told import place
from ..core.geometry.triangles import closest
from ..core.geometry.wall_rims import parts
from ..core.issues import InputError
from .sheet import SEWN

CREASE = np.radians(1.0)  # of the normals of two faces along their common edge
SLIT = 0.2  # mm; boundaries of two faces nearer than this are a gap between them, not a design
BENT, FOLDED = 0.3, -0.7  # cosines between the normals at the ends of an edge, and of a small part of it
ASKED, CLOSING = 12, 20  # cuts of triangles that are followed up, and steps to the place where the faces meet
CROSSING = 0.05  # rad; faces that touch at less run into each other, or are the same one
STEP = 1e-5  # of the size of a parameter's step, for curvatures
PLACES = 96  # up and around a tube at which its radii are taken


def refuse_gaps(wall: PatchWall, label: str) -> None:
    """InputError GAP where faces that should join do not, or are nowhere near each other."""
    ends, _ = boundary(wall.triangles)
    if not len(ends):
        return
    owner = _owners(wall, ends)
    corner = wall.vertices[ends]
    middle = corner.mean(axis=1)
    tree = cKDTree(middle)
    count, part = parts(wall, np.ones(len(wall.vertices), dtype=bool))
    near = np.asarray(tree.query(middle, k=min(16, len(middle)))[1]).reshape(len(middle), -1)
    other = (owner[near] != owner[:, None]) | (part[ends[near, 0]] != part[ends[:, 0]][:, None])
    apart = ~(ends[near][:, :, :, None] == ends[:, None, None, :]).any(axis=(2, 3))
    gap = _to_segments(middle, corner[near])
    gap[~(other & apart)] = np.inf
    best = gap.min(axis=1)
    if best.min() < SLIT:
        row = int(np.argmax(np.where(best < SLIT, best, -1.0)))
        k = near[row, int(np.argmin(gap[row]))]
        raise InputError(
            "GAP", label, f"{wall.faces[owner[row]]} and {wall.faces[owner[k]]} are {best[row]:.3g} mm apart at "
            f"{place(middle[row])}; close the gap: edges must meet within {SEWN:g} mm",
        )
    if count > 1:
        one, other = (np.flatnonzero(part == k) for k in (0, 1))
        distance, index = cKDTree(wall.vertices[one]).query(wall.vertices[other])
        k = int(np.argmin(distance))
        names = [wall.faces[wall.patch[np.flatnonzero((wall.triangles == v).any(axis=1))[0]]]
                 for v in (one[index[k]], other[k])]
        raise InputError(
            "GAP", label, f"the faces form {count} separate pieces: {names[0]} and {names[1]} are {distance[k]:.4g} "
            f"mm apart at {place(wall.vertices[other[k]])}; choose connected faces, edges meeting within {SEWN:g} mm",
        )


def _owners(wall: PatchWall, ends: Index) -> Index:
    edges = Edges(wall.triangles)
    face = edges.faces[edges.count == 1, 0]
    keys = edges.ends[edges.count == 1]
    base = len(wall.vertices)
    order = np.argsort(keys[:, 0] * base + keys[:, 1])
    pair = np.sort(ends, axis=1)
    at = np.searchsorted((keys[:, 0] * base + keys[:, 1])[order], pair[:, 0] * base + pair[:, 1])
    owner: Index = wall.patch[face[order[at]]]
    return owner


def _to_segments(points: Array, segments: Array) -> Array:
    """Distances (n, k) of points (n, 3) to segments (n, k, 2, 3)."""
    start, chord = segments[:, :, 0], segments[:, :, 1] - segments[:, :, 0]
    t = np.clip(dot(points[:, None] - start, chord) / np.maximum(dot(chord, chord), 1e-300), 0.0, 1.0)
    distance: Array = np.linalg.norm(points[:, None] - start - t[..., None] * chord, axis=-1)
    return distance


def refuse_creases(wall: PatchWall, shape: Any, label: str) -> None:
    """InputError CREASE where two faces meet at an angle, BRANCHING_FACES where three meet."""
    edges = Edges(wall.triangles)
    middle = wall.vertices[edges.ends].mean(axis=1)
    if (edges.count > 2).any():
        at = middle[np.argmax(edges.count > 2)]
        raise InputError(
            "BRANCHING_FACES", label, f"more than two faces meet in one edge at {place(at)}; a wall branches by smooth "
            "faces with openings: leave one of them out",
        )
    two = edges.count == 2
    pair = wall.patch[edges.faces]
    joint = np.flatnonzero(two & (pair[:, 0] != pair[:, 1]))
    if not len(joint):
        return
    ends = wall.vertices[edges.ends[joint, 0]]
    normals = np.empty((2, len(joint), 3))
    for side in (0, 1):
        for k in np.unique(pair[joint, side]):
            mine = pair[joint, side] == k
            normals[side, mine] = wall.patches[k].at(wall.patches[k].inverse(ends[mine]))[1]
    angle = np.arctan2(np.linalg.norm(np.cross(normals[0], normals[1]), axis=1), dot(normals[0], normals[1]))
    worst = int(np.argmax(angle))
    if angle[worst] > CREASE:
        names = [wall.faces[k] for k in pair[joint[worst]]]
        raise InputError(
            "CREASE", f"{label} {_edge_at(shape, ends[worst])}".strip(), f"{names[0]} and {names[1]} meet at an angle of "
            f"{np.degrees(angle[worst]):.3g} deg at {place(ends[worst])}; a wall's faces must run on smoothly, within "
            f"{np.degrees(CREASE):g} deg: round the edge, or deposit the faces one after the other",
        )


def _edge_at(shape: Any, point: Array) -> str:
    vertex = Part.Vertex(FreeCAD.Vector(*point))
    found = min(enumerate(shape.Edges, start=1), key=lambda one: one[1].distToShape(vertex)[0], default=(0, None))
    return f"Edge{found[0]}" if found[0] else ""


def refuse_tight(wall: PatchWall, chosen: Mask, height: float, label: str) -> None:
    """InputError LAYER_HEIGHT where the smaller principal radius of the vertices `chosen` (n,) is below the layer height."""
    radius, patch = smallest_radii(wall)
    radius = np.where(chosen, radius, np.inf)
    at = int(np.argmin(radius))
    _refuse_below(height, float(radius[at]), wall.vertices[at], f"{label} {wall.faces[patch[at]]}")


def refuse_tight_tube(tube: SurfaceWall, height: float, label: str) -> None:
    """InputError LAYER_HEIGHT where the smaller principal radius of a tube, from its first layer to its end, is below the
    layer height."""
    surface = tube.surface()
    low, around = surface.inverse(tube.first[:: max(1, len(tube.first) // PLACES)])
    rise = np.linspace(0.0, 1.0, PLACES)[1:-1, None]  # steps stay inside
    u = low + rise * (tube.end - low)
    v = np.broadcast_to(around, u.shape)
    slopes = surface.derivatives(u, v)[1:]
    turns = []
    for step_u, step_v in ((STEP * tube.end, 0.0), (0.0, STEP * tube.period)):
        ahead, back = normals(surface, u + step_u, v + step_v), normals(surface, u - step_u, v - step_v)
        turns.append((ahead - back) / (2.0 * (step_u + step_v)))
    radius = principal_radii(slopes, turns)
    at = np.unravel_index(int(np.argmin(radius)), radius.shape)
    named = f"{label} {tube.faces[0]}" if len(tube.faces) == 1 else label
    _refuse_below(height, float(radius[at]), surface.point(u[at], v[at]), named)


def _refuse_below(height: float, radius: float, point: Array, where: str) -> None:
    if radius < height * (1.0 - 1e-6):
        raise InputError(
            "LAYER_HEIGHT", where, f"layers of {height:g} mm are higher than the wall's smallest radius of curvature, "
            f"{radius:.3g} mm at {place(point)}; use lower layers, or a larger radius there",
        )


def smallest_radii(wall: PatchWall) -> tuple[Array, Index]:
    """Smallest principal radius (n,) mm at each vertex, and the patch (n,) it was taken from."""
    first = np.zeros(len(wall.vertices), dtype=np.intp)
    first[wall.triangles.ravel()] = np.arange(wall.triangles.size)
    patch = wall.patch[first // 3]
    uv = wall.uv.reshape(-1, 2)[first]
    radius = np.full(len(wall.vertices), np.inf)
    for k in np.unique(patch):
        mine = np.flatnonzero(patch == k)
        one, at = wall.patches[k], uv[mine]
        reach = np.maximum(np.ptp(wall.uv[wall.patch == k].reshape(-1, 2), axis=0), 1e-9)
        middle = wall.uv[wall.patch == k].reshape(-1, 2).mean(axis=0)
        at = middle + (1.0 - 4.0 * STEP) * (at - middle)  # steps stay inside
        slopes, turns = [], []
        for axis in (0, 1):
            step = STEP * reach[axis] * np.eye(2)[axis]
            (ahead, up), (back, down) = one.at(at + step), one.at(at - step)
            slopes.append((ahead - back) / (2.0 * STEP * reach[axis]))
            turns.append((up - down) / (2.0 * STEP * reach[axis]))
        radius[mine] = principal_radii(slopes, turns)
    return radius, patch


def principal_radii(slopes: Sequence[Array], turns: Sequence[Array]) -> Array:
    """Smaller principal radius (...,) mm, given the derivatives (..., 3) of point and unit normal along both parameters;
    infinite at poles."""
    a, b, c = dot(slopes[0], slopes[0]), dot(slopes[0], slopes[1]), dot(slopes[1], slopes[1])
    e, g = dot(slopes[0], turns[0]), dot(slopes[1], turns[1])
    f = 0.5 * (dot(slopes[0], turns[1]) + dot(slopes[1], turns[0]))
    area = a * c - b * b
    plain = area > 1e-10 * np.median(area)
    safe = np.where(plain, area, 1.0)
    mean, gauss = 0.5 * (e * c - 2.0 * f * b + g * a) / safe, (e * g - f * f) / safe
    bend = np.abs(mean) + np.sqrt(np.maximum(mean * mean - gauss, 0.0))
    radius: Array = np.where(plain, 1.0 / np.maximum(bend, 1e-12), np.inf)
    return radius


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
        t = np.linspace(0.0, 1.0, 33)[None, :, None]
        line = start[bent][:, None] + t * (end - start)[bent][:, None]
        normal = patch.at(line.reshape(-1, 2))[1].reshape(line.shape[:2] + (3,))
        plain = (patch.area(line.reshape(-1, 2)) > 1e-6).reshape(line.shape[:2])
        turn = np.where(plain[:, 1:] & plain[:, :-1], dot(normal[:, 1:], normal[:, :-1]), 1.0)
        if turn.min() < FOLDED:
            row, at = np.unravel_index(int(np.argmin(turn)), turn.shape)
            raise InputError(
                "SELF_INTERSECTION", f"{label} {wall.faces[k]}", f"the face folds back and cuts itself at "
                f"{place(patch.at(line[row, at : at + 1])[0][0])}; a bend must have a larger radius than the tube",
            )


def refuse_crossing(wall: PatchWall, label: str) -> None:
    """InputError SELF_INTERSECTION where triangles of the wall that are no neighbours cut each other, and the exact faces
    do so too."""
    corner = wall.vertices[wall.triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    middle = corner.mean(axis=1)
    pairs = cKDTree(middle).query_pairs(1.2 * wall.mesh.longest_edge, output_type="ndarray")
    chord = middle[pairs[:, 1]] - middle[pairs[:, 0]]
    length = np.maximum(np.linalg.norm(chord, axis=1), 1e-300)
    # neighbours on a smooth wall are about level with each other
    odd = (np.abs(dot(chord, normal[pairs[:, 0]])) > 0.3 * length) | (dot(normal[pairs[:, 0]], normal[pairs[:, 1]]) < 0.7)
    pairs = pairs[odd]
    shared = (wall.triangles[pairs[:, 0]][:, :, None] == wall.triangles[pairs[:, 1]][:, None, :]).any(axis=(1, 2))
    pairs = pairs[~shared]
    for one, other in (pairs.T, pairs.T[::-1]):
        for k in range(3):
            start, end = corner[one, k], corner[one, (k + 1) % 3]
            a, b, c = (corner[other, j] for j in range(3))
            low, high = dot(start - a, normal[other]), dot(end - a, normal[other])
            across = np.flatnonzero(low * high < 0.0)
            t = (low[across] / (low[across] - high[across]))[:, None]
            point = start[across] + t * (end[across] - start[across])
            cut = closest(a[across], b[across], c[across], point)[0] < 1e-9 + 1e-9 * wall.mesh.longest_edge
            for at in np.flatnonzero(cut)[:: max(1, int(cut.sum()) // ASKED)]:
                faces = one[across[at]], other[across[at]]
                found = _crossing(wall, faces, point[at])
                if found is None:
                    continue
                names = sorted({wall.faces[wall.patch[face]] for face in faces})
                raise InputError(
                    "SELF_INTERSECTION", label, f"the wall cuts itself at {place(found)} ({' and '.join(names)}); a bend "
                    "must have a larger radius than the tube, and faces must not cross",
                )


def _crossing(wall: PatchWall, triangles: tuple[int, int], point: Array) -> Array | None:
    """Where the exact faces cut each other near two triangles that do so at a point; None where they do not."""
    near = point[None]
    patches = [wall.patches[wall.patch[k]] for k in triangles]
    uv = [wall.uv[k].mean(axis=0)[None] for k in triangles]
    for _ in range(CLOSING):
        uv = [patch.inverse(near, start) for patch, start in zip(patches, uv)]
        (one, one_up), (other, other_up) = (patch.at(at) for patch, at in zip(patches, uv))
        apart = float(np.linalg.norm(one - other))
        if apart < 1e-6 or np.linalg.norm(one[0] - point) > 2.0 * wall.mesh.longest_edge:
            break
        # where the two tangent planes meet, nearest to the middle between the feet
        planes = np.stack([one_up[0], other_up[0]])
        gap = np.array([one_up[0] @ (one[0] - near[0]), other_up[0] @ (other[0] - near[0])])
        near = near + (np.linalg.pinv(planes, rcond=1e-3) @ gap)[None]
    steep = float(np.linalg.norm(np.cross(one_up[0], other_up[0]))) > CROSSING
    return one[0] if apart < 1e-6 and steep else None
