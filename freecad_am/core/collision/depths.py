# SPDX-License-Identifier: LGPL-2.1-or-later
"""Depth of a part under the surface that carries its beads, and its thickness there, at evenly
spread points.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.mesh.coarsen import doubled_areas
from ..geometry.mesh.solid import divide_triangles
from ..geometry.obstacles import Body
from ..geometry.walls.part_depths import Surface
from ..types import Array, Index
from .inside import Inside, inside_of

MAX_PARTS = 40_000  # parts that triangles are divided into, about
PLACES = 800  # within the part
TRIES = 20_000  # maximum samples in the bounding box to find these in a thin part
AT_ONCE = 2000
SHARES = 128  # steps that a distribution is kept in
PROBES = 250  # places of the surface at which the part's thickness is looked for
HALVINGS = 7  # of the step in which a probe leaves the part
STEPS = 14  # of a probe into the part
REACH = 64.0  # mm; no bead is wider
# distances between surface samples; a point farther from the edge is not below the surface
MAX_OFFSET_SHARE = 1.5
# three irrational steps, by which places spread evenly in a box (Roberts 2018, the generalised golden ratio)
EVENLY = 1.0 / 1.22074408460575947536 ** np.arange(1, 4)


def measured(
    part_mesh: Body,
    owner: Index,
    faces: Sequence[str],
    surface: Surface,
    slack: float,
    excluded: Body | None = None,
) -> tuple[Array, Array, Array, float]:
    """Return how deep a part is under a surface and how thick it is there.

    Parameters
    ----------
    part_mesh : Body
        Closed triangles of the part.
    owner : (m,) int array
        Number in `faces` of each triangle.
    faces : sequence of str
        Names of the faces.
    surface : Surface
        Evenly spread points of the surface with normals and areas, mm.
    slack : float
        Distance that the surface may be off the triangles, mm.
    excluded : Body or None, optional
        Body that does not count as part; None without one.

    Returns
    -------
    depths : (k,) array
        Bead width needed for each equal share of the part, mm, sorted; infinite for a share
        under no bead.
    thickness : (n,) array
        Thickness at points of the surface, mm, sorted.
    by_face : (faces,) array
        Median depth of each face, mm.
    share : float
        Share of the part that is not in `excluded`.
    """
    inside = inside_of(part_mesh)
    ground = None if excluded is None else inside_of(excluded)
    spacing = float(np.sqrt(surface.areas.mean()))
    probes = _probes(surface)
    sense, half = _inward(probes, inside, slack)
    inward = sense * surface.normals
    middles, triangle_of = divide_triangles(
        part_mesh.corners(), grain(part_mesh.corners(), 2.0 * spacing)
    )
    deep = _depths(middles, surface, inward, half, spacing)
    weight = (
        _areas(part_mesh)[triangle_of]
        / np.bincount(triangle_of, minlength=len(part_mesh.triangles))[triangle_of]
    )
    if ground is not None:
        weight = np.where(ground.holds(middles), 0.0, weight)
    by_face = np.array(
        [
            _median(deep[owner[triangle_of] == k], weight[owner[triangle_of] == k])
            for k in range(len(faces))
        ]
    )
    if inside is None:
        return np.zeros(0), np.zeros(0), by_face, 1.0
    points = _places(inside)
    free_points = points if ground is None else points[~ground.holds(points)]
    depths = (
        _shares(_depths(free_points, surface, inward, half, spacing))
        if len(free_points)
        else np.zeros(0)
    )
    free = (
        np.ones(len(probes.points), dtype=bool) if ground is None else ~ground.holds(probes.points)
    )
    thickness = _thickness(probes.points[free], sense * probes.normals[free], half, inside, slack)
    return depths, np.sort(thickness), by_face, len(free_points) / max(len(points), 1)


def grain(corners: Array, smallest: float) -> float:
    """Return the longest side that divides triangles into about MAX_PARTS more parts at most.

    A face may be a million times as large as the wall to measure.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Corners of the triangles, mm.
    smallest : float
        Least side to return, mm.

    Returns
    -------
    float
        mm.
    """
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).max(axis=1, initial=0.0)
    across = np.linalg.norm(doubled_areas(corners), axis=1)
    heights = across / np.maximum(sides, 1e-300)
    longest = max(smallest, 1e-9)
    while ((1.0 + 2.0 * sides / longest) * (1.0 + 2.0 * heights / longest) - 1.0).sum() > MAX_PARTS:
        longest *= 1.5
    return longest


def _probes(surface: Surface) -> Surface:
    """Return points of a surface that represent equal areas."""
    ends = np.cumsum(surface.areas)
    point_rows = np.minimum(
        np.searchsorted(ends, (np.arange(PROBES) + 0.5) / PROBES * ends[-1]), len(ends) - 1
    )
    return Surface(
        surface.points[point_rows], surface.normals[point_rows], np.full(PROBES, ends[-1] / PROBES)
    )


def _inward(probes: Surface, inside: Inside | None, slack: float) -> tuple[float, bool]:
    """Return the direction, 1.0 or -1.0, in which normals of a surface point into the part, and
    whether both do.
    """
    if inside is None:
        return 1.0, True
    ahead, behind = (
        float(inside.holds(probes.points + sense * slack * probes.normals).mean())
        for sense in (1.0, -1.0)
    )
    return (1.0 if ahead >= behind else -1.0), min(ahead, behind) > 0.5 * max(ahead, behind)


def _depths(points: Array, surface: Surface, inward: Array, half: bool, spacing: float) -> Array:
    """Return the width (k,) mm that a bead on the nearest point of the surface needs to hold each point
    (k, 3), inf next to the surface.
    """
    _, nearest = cKDTree(surface.points).query(
        points, eps=0.02
    )  # in the middle of a ball all are alike
    offsets = points - surface.points[nearest]
    along = (offsets * inward[nearest]).sum(axis=1)
    across = np.linalg.norm(offsets - along[:, None] * inward[nearest], axis=1)
    deep = (
        2.0 * np.abs(along) if half else np.where(along > -spacing, np.maximum(along, 0.0), np.inf)
    )
    widths: Array = np.where(
        across <= MAX_OFFSET_SHARE * spacing + 0.1 * np.abs(along), deep, np.inf
    )
    return widths


def _places(inside: Inside) -> Array:
    """Points spread evenly inside of a body."""
    batches: list[Array] = []
    for start in range(0, TRIES, AT_ONCE):
        share = np.mod(0.5 + np.arange(start + 1, start + AT_ONCE + 1)[:, None] * EVENLY, 1.0)
        points = inside.low + share * (inside.high - inside.low)
        batches.append(points[inside.holds(points)])
        if sum(map(len, batches)) >= PLACES:
            break
    return np.vstack(batches)


def _thickness(start: Array, directions: Array, half: bool, inside: Inside, slack: float) -> Array:
    """How far (m,) mm the part reaches under places (m, 3) of a surface along unit vectors (m, 3); with `half` twice as far
    as it does where it reaches less far, of both ways."""
    depth = _reach(start, directions, inside, slack)
    if half:
        return 2.0 * np.minimum(depth, _reach(start, -directions, inside, slack))
    return np.maximum(depth - _entry(start, directions, inside, slack), 0.0)


def _entry(start: Array, directions: Array, inside: Inside, slack: float) -> Array:
    """How far (m,) mm from places of a body's surface, along unit vectors, (m, 3) each, its triangles begin, which are up to
    `slack` off that surface to either side; 0 where no such place is."""
    low, high = np.full(len(start), -slack), np.full(len(start), slack)
    begins = ~inside.holds(start - slack * directions) & inside.holds(start + slack * directions)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        within = inside.holds(start + middle[:, None] * directions)
        low, high = np.where(within, low, middle), np.where(within, middle, high)
    return np.where(begins, 0.5 * (low + high), 0.0)


def _reach(start: Array, directions: Array, inside: Inside, slack: float) -> Array:
    """Return the length (m,) of lines within a body, mm, from points along unit vectors, (m, 3)
    each.
    """
    steps = np.geomspace(slack, REACH, STEPS)
    is_inside = inside.holds(
        (start[:, None] + steps[None, :, None] * directions[:, None]).reshape(-1, 3)
    ).reshape(len(start), STEPS)
    through, never = is_inside.all(axis=1), ~is_inside[:, 0]
    out = np.argmin(is_inside, axis=1)
    low, high = steps[np.maximum(out - 1, 0)], steps[out]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        within = inside.holds(start + middle[:, None] * directions)
        low, high = np.where(within, middle, low), np.where(within, high, middle)
    return np.where(through, REACH, np.where(never, 0.0, 0.5 * (low + high)))


def _shares(values: Array) -> Array:
    """Return the values (n,) at the middles of SHARES equal shares, sorted."""
    sorted_values: Array = np.sort(values)[
        ((np.arange(SHARES) + 0.5) / SHARES * len(values)).astype(int)
    ]
    return sorted_values


def _areas(part_mesh: Body) -> Array:
    a, b, c = (part_mesh.corners()[:, k] for k in range(3))
    areas: Array = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return areas


def _median(values: Array, weights: Array) -> float:
    """Return the weighted median of the values; 0 without weight."""
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    if not len(values) or total[-1] <= 0.0:
        return 0.0
    return float(values[order][np.searchsorted(total, 0.5 * total[-1])])
