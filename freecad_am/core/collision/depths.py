# SPDX-License-Identifier: LGPL-2.1-or-later
"""Depth of a part below the surface that carries its beads, and part thickness at that surface."""

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

MAX_PARTS = 40_000  # approximate maximum number of parts of divided triangles
PLACES = 800  # samples in the part after which sampling stops
TRIES = 20_000  # maximum number of samples in the bounding box, reached by thin parts
AT_ONCE = 2000  # samples per batch
SHARES = 128  # quantiles that represent a distribution
PROBES = 250  # surface points at which the part thickness is measured
HALVINGS = 7  # bisections of the step in which a probe leaves the part
STEPS = 14  # samples along a probe
REACH = 64.0  # mm; maximum length of a probe; no bead is wider
# in surface sample spacings; maximum lateral offset of a point that is below the surface
MAX_OFFSET_SHARE = 1.5
# steps along three axes that spread points evenly in a box (Roberts 2018, generalised golden ratio)
EVENLY = 1.0 / 1.22074408460575947536 ** np.arange(1, 4)


def measured(
    part_mesh: Body,
    owner: Index,
    faces: Sequence[str],
    surface: Surface,
    slack: float,
    excluded: Body | None = None,
) -> tuple[Array, Array, Array, float]:
    """Return the depth of a part below a surface and the part thickness at the surface.

    Parameters
    ----------
    part_mesh : Body
        Closed triangles of the part.
    owner : (m,) int array
        Index into `faces` for each triangle.
    faces : sequence of str
        Names of the faces.
    surface : Surface
        Evenly spread points of the surface with normals and areas, mm.
    slack : float
        Maximum distance between surface and triangles, mm.
    excluded : Body or None, optional
        Body that does not count as part, if any.

    Returns
    -------
    depths : (k,) array
        Required bead width at quantiles of the part's volume, mm, sorted; infinite under no
        bead.
    thickness : (n,) array
        Thickness at surface points, mm, sorted.
    by_face : (faces,) array
        Median depth of each face, mm.
    share : float
        Fraction of the part's volume outside `excluded`.
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
    """Return the maximum side that divides triangles into at most about MAX_PARTS more parts.

    A face may be a million times as large as the wall to measure.

    Parameters
    ----------
    corners : (m, 3, 3) array
        Corners of the triangles, mm.
    smallest : float
        Minimum result, mm.

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
    """Return PROBES points of a surface that represent equal areas."""
    ends = np.cumsum(surface.areas)
    point_rows = np.minimum(
        np.searchsorted(ends, (np.arange(PROBES) + 0.5) / PROBES * ends[-1]), len(ends) - 1
    )
    return Surface(
        surface.points[point_rows], surface.normals[point_rows], np.full(PROBES, ends[-1] / PROBES)
    )


def _inward(probes: Surface, inside: Inside | None, slack: float) -> tuple[float, bool]:
    """Return the sign, 1.0 or -1.0, that makes surface normals point into the part.

    Also return whether the part is on both sides of the surface.
    """
    if inside is None:
        return 1.0, True
    ahead, behind = (
        float(inside.holds(probes.points + sense * slack * probes.normals).mean())
        for sense in (1.0, -1.0)
    )
    return (1.0 if ahead >= behind else -1.0), min(ahead, behind) > 0.5 * max(ahead, behind)


def _depths(points: Array, surface: Surface, inward: Array, half: bool, spacing: float) -> Array:
    """Return the bead width (k,), mm, at the nearest surface point that encloses each point (k, 3).

    The width is infinite for points that are not below the surface.
    """
    _, nearest = cKDTree(surface.points).query(
        points, eps=0.02
    )  # tolerance, as all surface points are equally near to the centre of a ball
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
    """Return points spread evenly inside a body."""
    batches: list[Array] = []
    for start in range(0, TRIES, AT_ONCE):
        share = np.mod(0.5 + np.arange(start + 1, start + AT_ONCE + 1)[:, None] * EVENLY, 1.0)
        points = inside.low + share * (inside.high - inside.low)
        batches.append(points[inside.holds(points)])
        if sum(map(len, batches)) >= PLACES:
            break
    return np.vstack(batches)


def _thickness(start: Array, directions: Array, half: bool, inside: Inside, slack: float) -> Array:
    """Return the part thickness (m,), mm, at surface points (m, 3) along unit vectors (m, 3).

    With `half`, return twice the smaller of the reaches in both directions.
    """
    depth = _reach(start, directions, inside, slack)
    if half:
        return 2.0 * np.minimum(depth, _reach(start, -directions, inside, slack))
    return np.maximum(depth - _entry(start, directions, inside, slack), 0.0)


def _entry(start: Array, directions: Array, inside: Inside, slack: float) -> Array:
    """Return the offset (m,), mm, along unit vectors from surface points to the body's triangles.

    Points and vectors are (m, 3). The triangles deviate from the surface by up to `slack` to either
    side. The offset is 0 where no entry is found.
    """
    low, high = np.full(len(start), -slack), np.full(len(start), slack)
    begins = ~inside.holds(start - slack * directions) & inside.holds(start + slack * directions)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        within = inside.holds(start + middle[:, None] * directions)
        low, high = np.where(within, low, middle), np.where(within, middle, high)
    return np.where(begins, 0.5 * (low + high), 0.0)


def _reach(start: Array, directions: Array, inside: Inside, slack: float) -> Array:
    """Return the lengths (m,), mm, of lines from points along unit vectors until they leave a body.

    Points and vectors are (m, 3). Lengths are at most REACH.
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
    """Return SHARES quantiles of values (n,), at the midpoints of equal fractions, sorted."""
    sorted_values: Array = np.sort(values)[
        ((np.arange(SHARES) + 0.5) / SHARES * len(values)).astype(int)
    ]
    return sorted_values


def _areas(part_mesh: Body) -> Array:
    a, b, c = (part_mesh.corners()[:, k] for k in range(3))
    areas: Array = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return areas


def _median(values: Array, weights: Array) -> float:
    """Return the weighted median of values; 0 without weight."""
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    if not len(values) or total[-1] <= 0.0:
        return 0.0
    return float(values[order][np.searchsorted(total, 0.5 * total[-1])])
