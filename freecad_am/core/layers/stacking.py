# SPDX-License-Identifier: LGPL-2.1-or-later
"""Prepare bodies for planar layers: choose the stacking direction and the base plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..collision.inside import inside_of
from ..geometry.columns import columns
from ..geometry.curves.guide import Guide
from ..geometry.developable import Plane
from ..geometry.mesh.coarsen import doubled_areas
from ..geometry.obstacles import Body
from ..geometry.on_hub import Base, Group, SolidsOnHub, upright
from ..issues import NOTE, Issue, Text, Word
from ..parameters.filled import SolidParameters
from ..types import Array, Index

AXES = np.array(
    [[0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], dtype=np.float64
)
MAX_FACES = 12  # maximum number of flat faces on which the part may stand, in addition to the axes
PARALLEL = np.cos(np.radians(2.0))  # cosine of the angle below which directions count as equal
CONTACT_HEIGHTS = 0.5  # in layer heights; facets this close to the lowest point are on the platform
MIN_STABILITY_RAD = float(np.radians(5.0))  # minimum lean without falling over of a stable part
LEAN_DIRECTIONS = 72  # number of directions in which the lean is tested
AREA_TOLERANCE = 0.01  # fraction of the part's surface area; tolerance of equal areas
HEIGHT_TOLERANCE = 1e-3  # relative tolerance of equal heights, regardless of the chords of a mesh
# approximate number of points on the facets of several bodies at which mutual cover is checked
SAMPLES = 20_000
MAX_PIECES = 64  # maximum number of divisions of a facet edge for these points


class Stacked(NamedTuple):
    """Evaluation of a stacking direction.

    direction: (3,) unit vector. area: unsupported area, mm2. height: height of the part, mm.
    stable: lean at which the part falls over, rad; 0 or less if the part does not stand.
    """

    direction: Array
    area: float
    height: float
    stable: float = np.inf


def prepare_stack(
    bodies: Sequence[Body], strategy: SolidParameters, label: str, issues: tuple[Issue, ...] = ()
) -> SolidsOnHub:
    """Place bodies on the plane through their lowest point.

    Z of the frame is the stacking direction. The origin is centred below the bodies. With the
    direction `auto` a note reports the chosen direction and the reason.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    strategy : SolidParameters
        Direction and chord error.
    label : str
        Name of the part, for messages.
    issues : tuple of Issue, optional
        Issues to attach.

    Returns
    -------
    SolidsOnHub
        The bodies on one base.
    """
    if strategy.direction is None:
        ranking = rank_directions(bodies, strategy)
        direction = ranking[0].direction
        issues = (*issues, _note(ranking, label, np.degrees(strategy.max_overhang)))
    else:
        direction = np.array(strategy.direction) / np.linalg.norm(strategy.direction)
    turned = upright(np.zeros(3), direction)
    local = np.vstack([body.vertices for body in bodies]) @ turned[:3, :3]
    low, high = local.min(axis=0), local.max(axis=0)
    turned[:3, 3] = turned[:3, :3] @ np.array(
        [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2]]
    )
    base = Base("the first layer", Plane(), turned)
    return SolidsOnHub(label, (Group(base, tuple(bodies)),), strategy.chord_error, (), issues)


def rank_directions(bodies: Sequence[Body], strategy: SolidParameters) -> list[Stacked]:
    """Rank the axes and the directions normal to large flat faces, best first.

    Directions with a stability of at least MIN_STABILITY_RAD come first. Both groups are ordered by
    unsupported area within AREA_TOLERANCE, then by height within HEIGHT_TOLERANCE, then by
    candidate order. The ranking does not depend on the mesh of the part.
    """
    vertices, normals, areas = facets(
        bodies, strategy.chord_error if strategy.fuse == "auto" else None
    )
    directions = _candidates(normals, areas)
    steep, standing = float(np.sin(strategy.max_overhang)), CONTACT_HEIGHTS * strategy.layer_height
    middle = _centre_of_mass(bodies)
    candidates = [
        evaluate_direction(direction, vertices, normals, areas, steep, standing)._replace(
            stable=_stability(vertices, direction, standing, middle)
        )
        for direction in directions
    ]
    return _ranked(
        [candidate for candidate in candidates if candidate.stable >= MIN_STABILITY_RAD], areas
    ) + _ranked(
        [candidate for candidate in candidates if candidate.stable < MIN_STABILITY_RAD], areas
    )


def _ranked(candidates: list[Stacked], areas: Array) -> list[Stacked]:
    """Rank directions, best first, regardless of stability."""
    ranked: list[Stacked] = []
    while candidates:
        max_area = min(candidate.area for candidate in candidates) + AREA_TOLERANCE * float(
            areas.sum()
        )
        finalists = [candidate for candidate in candidates if candidate.area <= max_area]
        low = min(candidate.height for candidate in finalists)
        ranked.append(
            next(
                candidate
                for candidate in finalists
                if candidate.height <= low * (1.0 + HEIGHT_TOLERANCE)
            )
        )
        candidates = [candidate for candidate in candidates if candidate is not ranked[-1]]
    return ranked


def _centre_of_mass(bodies: Sequence[Body]) -> Array:
    """Return the centre of mass (3,) of closed bodies, or of their surfaces if the volume is zero."""
    corners = np.concatenate([body.corners() for body in bodies])
    origin = corners.reshape(-1, 3).mean(axis=0)
    local = corners - origin
    weights = np.einsum("mk,mk->m", local[:, 0], np.cross(local[:, 1], local[:, 2]))
    centres = local.sum(axis=1) / 4.0
    if abs(weights.sum()) <= 1e-9 * float(np.ptp(local.reshape(-1, 3), axis=0).max()) ** 3:
        weights, centres = np.linalg.norm(doubled_areas(corners), axis=1), local.mean(axis=1)
    total_weight = float(weights.sum())
    middle: Array = origin + weights @ centres / (total_weight or 1e-300)
    return middle


def _stability(corners: Array, direction: Array, standing: float, middle: Array) -> float:
    """Return the minimum lean, rad, at which the centre of mass leaves the contact area.

    corners: (m, 3, 3) triangles, mm. direction: (3,) stacking direction. middle: (3,) centre of
    mass, mm. The contact area is the part of the surface at most `standing` mm above the lowest
    point.
    """
    frame = upright(np.zeros(3), direction)[:3, :3]
    local = corners @ frame
    foot = float(local[..., 2].min())
    level = foot + standing
    points = [local[local[..., 2] <= level][:, :2]]
    for k in range(3):  # where edges cross the contact height
        start, end = local[:, k], local[:, k - 1]
        crosses_level = (start[:, 2] <= level) != (end[:, 2] <= level)
        share = (level - start[crosses_level, 2]) / (
            end[crosses_level, 2] - start[crosses_level, 2]
        )
        points.append(start[crosses_level, :2] + share[:, None] * (end - start)[crosses_level, :2])
    flat, centre = np.concatenate(points), middle @ frame
    angle = np.linspace(0.0, 2.0 * np.pi, LEAN_DIRECTIONS, endpoint=False)
    towards = np.stack([np.cos(angle), np.sin(angle)])
    reach = ((flat - centre[:2]) @ towards).max(axis=0)
    return float(np.arctan2(reach.min(), max(float(centre[2]) - foot, 1e-9)))


def facets(bodies: Sequence[Body], slit: float | None) -> tuple[Array, Array, Array]:
    """Return all triangles with non-zero area.

    Area that another body covers within the slit width does not count, because touching bodies form
    one part.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    slit : float or None
        Width of slits that count as closed, mm; None if each body counts separately.

    Returns
    -------
    corners : (m, 3, 3) array
        Corners in part coordinates, mm.
    normals : (m, 3) array
        Unit normals.
    areas : (m,) array
        Free areas, mm2.
    """
    corners = np.concatenate([body.corners() for body in bodies])
    normal = doubled_areas(corners)
    doubled = np.linalg.norm(normal, axis=1)
    has_area = doubled > 1e-12
    corners = corners[has_area]
    normal = normal[has_area] / doubled[has_area, None]
    area = 0.5 * doubled[has_area]
    if len(bodies) > 1 and slit is not None:
        body_number = np.repeat(np.arange(len(bodies)), [len(body.triangles) for body in bodies])[
            has_area
        ]
        area = area * _free_share(bodies, body_number, corners, normal, area, slit)
    return corners, normal, area


def _free_share(
    bodies: Sequence[Body],
    body_number: Index,
    corners: Array,
    normals: Array,
    areas: Array,
    slit: float,
) -> Array:
    """Return the fraction (m,) of each triangle that no other body covers, tested `slit` mm outside.

    body_number: (m,) body index of each triangle.
    """
    divisions = np.clip(np.ceil(np.sqrt(SAMPLES * areas / areas.sum())), 1, MAX_PIECES).astype(
        np.intp
    )
    covered = np.zeros(len(areas))
    insides = [inside_of(body) for body in bodies]
    for count in np.unique(divisions):
        group_rows = np.flatnonzero(divisions == count)
        shares = _middles(int(count))
        samples = (
            np.einsum("pk,mkc->mpc", shares, corners[group_rows]) + slit * normals[group_rows, None]
        )
        is_covered = np.zeros(samples.shape[:2], dtype=bool)
        for number, inside in enumerate(insides):
            foreign = np.flatnonzero(body_number[group_rows] != number)
            if inside is not None and len(foreign):
                is_covered[foreign] |= inside.holds(samples[foreign].reshape(-1, 3)).reshape(
                    len(foreign), -1
                )
        covered[group_rows] = is_covered.mean(axis=1)
    return 1.0 - covered


def _middles(count: int) -> Array:
    """Return barycentric coordinates (count^2, 3) of the centroids of a subdivided triangle.

    count: number of divisions of each edge.
    """
    i, j = (grid.ravel() for grid in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    up = i + j < count
    share_a = np.where(up, i + 1.0 / 3.0, count - 1 - i + 2.0 / 3.0)
    share_b = np.where(up, j + 1.0 / 3.0, count - 1 - j + 2.0 / 3.0)
    shares: Array = np.stack([share_a, share_b, count - share_a - share_b], axis=1) / count
    return shares


def _candidates(normals: Array, areas: Array) -> list[Array]:
    """Return candidate unit directions: the axes, then the reversed normals of large flat faces.

    The order does not depend on the triangulation.
    """
    keys = np.round(normals, 4) + 0.0
    faces, number = np.unique(keys, axis=0, return_inverse=True)
    size = np.bincount(np.ravel(number), weights=areas)
    directions = list(AXES)
    shares = np.round(size / max(float(areas.sum()), 1e-300), 3)
    # equal faces are ordered by direction, rounded to the accuracy of a mesh
    for k in np.lexsort(np.vstack([columns(faces.round(2)), -shares]))[: 4 * MAX_FACES]:
        direction = -faces[k] / np.linalg.norm(faces[k])
        if (
            size[k] > AREA_TOLERANCE * areas.sum()
            and max(float(direction @ accepted) for accepted in directions) < PARALLEL
        ):
            directions.append(direction)
        if len(directions) >= len(AXES) + MAX_FACES:
            break
    return directions


def evaluate_direction(
    direction: Array, corners: Array, normals: Array, areas: Array, steep: float, standing: float
) -> Stacked:
    """Evaluate a stacking direction.

    Parameters
    ----------
    direction : (3,) array
        Unit vector.
    corners : (m, 3, 3) array
        Corners of the facets, mm.
    normals : (m, 3) array
        Unit normals of the facets.
    areas : (m,) array
        Areas of the facets, mm2.
    steep : float
        Sine of the overhang above which a facet is unsupported.
    standing : float
        Height above the lowest point up to which facets are supported, mm.

    Returns
    -------
    Stacked
        Unsupported area and height.
    """
    heights = corners @ direction
    low, high = float(heights.min()), float(heights.max())
    over = (normals @ direction < -steep - 1e-9) & (heights.max(axis=1) > low + standing)
    return Stacked(direction, float(areas[over].sum()), high - low)


def _note(ranking: Sequence[Stacked], label: str, lean: float) -> Issue:
    best_direction = ranking[0]
    upright_one = next(
        candidate
        for candidate in ranking
        if candidate.direction is AXES[0] or np.array_equal(candidate.direction, AXES[0])
    )
    comparison = (
        ""
        if best_direction is upright_one
        else (
            Text(
                "; along (0, 0, 1) the overhang would be {:.4g} mm^2 and the height {:.4g} mm",
                upright_one.area,
                upright_one.height,
            )
        )
    )
    x, y, z = (round(float(value), 6) + 0.0 for value in best_direction.direction)
    return Issue(
        NOTE,
        "DIRECTION",
        Text(
            "{} is stacked along ({:g}, {:g}, {:g}): {:.4g} mm^2 overhang by more than {:.4g} "
            "deg, and the height is {:.4g} mm{}",
            label,
            x,
            y,
            z,
            best_direction.area,
            lean,
            best_direction.height,
            Word(comparison),
        ),
    )


# ---- Overhang of the facets of a part, before slicing

MIN_LEAN_RAD = 1e-9  # rad; facets with less overhang are vertical walls


class Leaning(NamedTuple):
    """Overhanging facets.

    corners: (m, 3, 3), mm. lean: (m,) overhang, rad, ascending. area: (m,) areas, mm2. total_area:
    surface area of the part, mm2.
    """

    corners: Array
    lean: Array
    area: Array
    total_area: float

    def steeper_than(self, angle: float) -> tuple[Array, float]:
        """Return the facets that overhang by more than an angle.

        Parameters
        ----------
        angle : float
            The angle, rad.

        Returns
        -------
        corners : (k, 3, 3) array
            Corners of these facets, mm.
        area : float
            Total area of these facets, mm2.
        """
        first_steeper = int(np.searchsorted(self.lean, angle + MIN_LEAN_RAD, side="right"))
        return self.corners[first_steeper:], float(self.area[first_steeper:].sum())


def find_leaning(
    bodies: Sequence[Body], base: Base, standing: float, slit: float | None = None
) -> Leaning:
    """Find the overhanging facets of bodies.

    The overhang of a vertical wall is 0, the overhang of a ceiling is a right angle.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    base : Base
        The base; along a guide the stacking direction follows it.
    standing : float
        Height above the lowest point up to which the surface below the part supports facets, mm.
    slit : float or None, optional
        As in `facets`.

    Returns
    -------
    Leaning
        The facets, ordered by ascending overhang.
    """
    corners, normals, areas = facets(bodies, slit)
    inside = base.inside(corners)
    heights = np.asarray(base.surface.distance(inside))
    directions = base.frame[:3, 2]
    if isinstance(base.surface, Guide):
        middles = base.surface.distance(inside.mean(axis=1))
        directions = base.rotate_to_part(base.surface.at(middles)[1])
    lean = np.arcsin(np.clip(-(normals * directions).sum(axis=1), -1.0, 1.0))
    out = np.flatnonzero(
        (lean > MIN_LEAN_RAD) & (areas > 0.0) & (heights.max(axis=1) > heights.min() + standing)
    )
    order = out[np.argsort(lean[out], kind="stable")]
    return Leaning(corners[order], lean[order], areas[order], float(areas.sum()))
