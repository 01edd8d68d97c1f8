# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies made ready to be cut by planes: which way these are stacked, and the plane that the bodies stand on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...collision.inside import inside_of
from ...geometry.columns import columns
from ...geometry.mesh.facets import doubled_areas
from ...geometry.obstacles import Body
from ...geometry.on_hub import Base, Group, SolidsOnHub, upright
from ...geometry.plane import Plane
from ...issues import NOTE, Issue, Text, Word
from ...parameters.filled import SolidParameters
from ...types import Array, Index

AXES = np.array(
    [[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], dtype=np.float64
)
LARGEST = 12  # flat faces that the part may be laid on, beside the axes
PARALLEL = np.cos(np.radians(2.0))
STANDING = 0.5  # layer heights above the lowest place; what is no higher stands there
STABLE = float(np.radians(5.0))  # by which a part may lean without falling over
LEANS = 72  # directions in which it may
CLOSE = 0.01  # of the area of the part; areas nearer together are the same
LEVEL = 1e-3  # of a height; heights nearer together are the same, whatever chords a mesh has
PLACES = 20_000  # on all facets of a part of several bodies, at which it is looked whether others cover them, about
MAX_PIECES = 64  # parts of an edge of a facet between such places


class Stacked(NamedTuple):
    """What a direction is judged by: unit vector (3,), area over nothing, mm2, height, mm, and by how many rad the part may
    lean before it falls over, 0 or less where it falls over as it stands."""

    way: Array
    area: float
    height: float
    stable: float = np.inf


def stacked(
    bodies: Sequence[Body], strategy: SolidParameters, label: str, issues: tuple[Issue, ...] = ()
) -> SolidsOnHub:
    """The bodies standing on the plane through their lowest place, with a frame whose Z is the stacking direction, in the
    middle under them. With the direction `auto` a note says which it is and why."""
    asked = strategy.stacking()
    if asked is None:
        found = best(bodies, strategy)
        way, issues = (
            found[0].way,
            (*issues, _note(found, label, np.degrees(strategy.max_overhang))),
        )
    else:
        way = np.array(asked) / np.linalg.norm(asked)
    turned = upright(np.zeros(3), way)
    local = np.vstack([body.vertices for body in bodies]) @ turned[:3, :3]
    low, high = local.min(axis=0), local.max(axis=0)
    turned[:3, 3] = turned[:3, :3] @ np.array(
        [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]]
    )
    base = Base("the first layer", Plane(), turned)
    return SolidsOnHub(label, (Group(base, tuple(bodies)),), strategy.chord_error, (), issues)


def best(bodies: Sequence[Body], strategy: SolidParameters) -> list[Stacked]:
    """The axes and the directions out of large flat faces, the best first: of those in which the part stands by STABLE, or of
    all where it does in none, those with the least area over nothing, but for CLOSE, of these the one with the least height,
    but for LEVEL, and of these the first; then of the others likewise. Any mesh of the same part has the same order."""
    vertices, normals, areas = facets(
        bodies, strategy.chord_error if strategy.fuse == "auto" else None
    )
    ways = _candidates(normals, areas)
    steep, standing = float(np.sin(strategy.max_overhang)), STANDING * strategy.layer_height
    middle = _centre_of_mass(bodies)
    found = [
        judged(way, vertices, normals, areas, steep, standing)._replace(
            stable=_stability(vertices, way, standing, middle)
        )
        for way in ways
    ]
    return _ranked([one for one in found if one.stable >= STABLE], areas) + _ranked(
        [one for one in found if one.stable < STABLE], areas
    )


def _ranked(found: list[Stacked], areas: Array) -> list[Stacked]:
    """Directions, the best first, whatever the part stands on."""
    ranked: list[Stacked] = []
    while found:
        least = min(one.area for one in found) + CLOSE * float(areas.sum())
        few = [one for one in found if one.area <= least]
        low = min(one.height for one in few)
        ranked.append(next(one for one in few if one.height <= low * (1.0 + LEVEL)))
        found = [one for one in found if one is not ranked[-1]]
    return ranked


def _centre_of_mass(bodies: Sequence[Body]) -> Array:
    """(3,) of closed bodies; of their surfaces where these enclose nothing."""
    corners = np.concatenate([body.corners() for body in bodies])
    origin = corners.reshape(-1, 3).mean(axis=0)
    seen = corners - origin
    weights = np.einsum("mk,mk->m", seen[:, 0], np.cross(seen[:, 1], seen[:, 2]))
    centres = seen.sum(axis=1) / 4.0
    if abs(weights.sum()) <= 1e-9 * float(np.ptp(seen.reshape(-1, 3), axis=0).max()) ** 3:
        weights, centres = np.linalg.norm(doubled_areas(corners), axis=1), seen.mean(axis=1)
    whole = float(weights.sum())
    middle: Array = origin + weights @ centres / (whole or 1e-300)
    return middle


def _stability(corners: Array, way: Array, standing: float, middle: Array) -> float:
    """By how many rad a part of triangles (m, 3, 3) may lean, in any direction, before its centre of mass (3,) is no longer over
    what lies no higher than `standing` mm above its lowest place along a direction (3,)."""
    frame = upright(np.zeros(3), way)[:3, :3]
    local = corners @ frame
    foot = float(local[..., 2].min())
    level = foot + standing
    points = [local[local[..., 2] <= level][:, :2]]
    for k in range(3):  # where edges cross that height
        start, end = local[:, k], local[:, k - 1]
        some = (start[:, 2] <= level) != (end[:, 2] <= level)
        share = (level - start[some, 2]) / (end[some, 2] - start[some, 2])
        points.append(start[some, :2] + share[:, None] * (end - start)[some, :2])
    flat, centre = np.concatenate(points), middle @ frame
    angle = np.linspace(0.0, 2.0 * np.pi, LEANS, endpoint=False)
    towards = np.stack([np.cos(angle), np.sin(angle)])
    reach = ((flat - centre[:2]) @ towards).max(axis=0)
    return float(np.arctan2(reach.min(), max(float(centre[2]) - foot, 1e-9)))


def facets(bodies: Sequence[Body], slit: float | None) -> tuple[Array, Array, Array]:
    """Corners (m, 3, 3), unit normals (m, 3) and areas (m,) of all triangles with an area; what of them another body covers,
    within a slit of so many mm, does not count: touching bodies are one. None: each body is one by itself."""
    corners = np.concatenate([body.corners() for body in bodies])
    normal = doubled_areas(corners)
    doubled = np.linalg.norm(normal, axis=1)
    some = doubled > 1e-12
    corners, normal, area = corners[some], normal[some] / doubled[some, None], 0.5 * doubled[some]
    if len(bodies) > 1 and slit is not None:
        own = np.repeat(np.arange(len(bodies)), [len(body.triangles) for body in bodies])[some]
        area = area * _free(bodies, own, corners, normal, area, slit)
    return corners, normal, area


def _free(
    bodies: Sequence[Body], own: Index, corners: Array, normals: Array, areas: Array, slit: float
) -> Array:
    """The share (m,) of each triangle, of the body `own` (m,), a slit (mm) outside of which no other body is."""
    parts = np.clip(np.ceil(np.sqrt(PLACES * areas / areas.sum())), 1, MAX_PIECES).astype(np.intp)
    covered = np.zeros(len(areas))
    insides = [inside_of(body) for body in bodies]
    for count in np.unique(parts):
        some = np.flatnonzero(parts == count)
        shares = _middles(int(count))
        places = np.einsum("pk,mkc->mpc", shares, corners[some]) + slit * normals[some, None]
        held = np.zeros(places.shape[:2], dtype=bool)
        for number, inside in enumerate(insides):
            others = np.flatnonzero(own[some] != number)
            if inside is not None and len(others):
                held[others] |= inside.holds(places[others].reshape(-1, 3)).reshape(len(others), -1)
        covered[some] = held.mean(axis=1)
    return 1.0 - covered


def _middles(count: int) -> Array:
    """Shares (count^2, 3) of the corners at the middles of the parts of a triangle whose edges are cut in so many."""
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    up = i + j < count
    first = np.where(up, i + 1.0 / 3.0, count - 1 - i + 2.0 / 3.0)
    other = np.where(up, j + 1.0 / 3.0, count - 1 - j + 2.0 / 3.0)
    found: Array = np.stack([first, other, count - first - other], axis=1) / count
    return found


def _candidates(normals: Array, areas: Array) -> list[Array]:
    """Unit directions to look at: the axes first, then against the normals of the largest flat faces, in the same order
    whatever triangles these are made of."""
    keys = np.round(normals, 4) + 0.0
    faces, number = np.unique(keys, axis=0, return_inverse=True)
    size = np.bincount(np.ravel(number), weights=areas)
    ways = list(AXES)
    shares = np.round(size / max(float(areas.sum()), 1e-300), 3)
    # of faces as large as one another the first comes by its direction, of which a mesh has no more than some digits
    for k in np.lexsort(np.vstack([columns(faces.round(2)), -shares]))[: 4 * LARGEST]:
        way = -faces[k] / np.linalg.norm(faces[k])
        if size[k] > CLOSE * areas.sum() and max(float(way @ other) for other in ways) < PARALLEL:
            ways.append(way)
        if len(ways) >= len(AXES) + LARGEST:
            break
    return ways


def judged(
    way: Array, corners: Array, normals: Array, areas: Array, steep: float, standing: float
) -> Stacked:
    """A unit direction (3,) by the facets of a part: what of them leans out by more than `steep`, the sine of an angle from
    the direction, and reaches more than `standing` mm above the lowest place."""
    heights = corners @ way
    low, high = float(heights.min()), float(heights.max())
    over = (normals @ way < -steep - 1e-9) & (heights.max(axis=1) > low + standing)
    return Stacked(way, float(areas[over].sum()), high - low)


def _note(found: Sequence[Stacked], label: str, lean: float) -> Issue:
    chosen = found[0]
    upright_one = next(
        one for one in found if one.way is AXES[0] or np.array_equal(one.way, AXES[0])
    )
    other = (
        ""
        if chosen is upright_one
        else (
            Text(
                "; along (0, 0, 1) it would be {:.4g} mm^2 and {:.4g} mm",
                upright_one.area,
                upright_one.height,
            )
        )
    )
    x, y, z = (round(float(value), 6) + 0.0 for value in chosen.way)
    return Issue(
        NOTE,
        "DIRECTION",
        Text(
            "{} is stacked along ({:g}, {:g}, {:g}): {:.4g} mm^2 of it lean over nothing by more than "
            "{:.4g} deg, and it is {:.4g} mm high{}",
            label,
            x,
            y,
            z,
            chosen.area,
            lean,
            chosen.height,
            Word(other),
        ),
    )
