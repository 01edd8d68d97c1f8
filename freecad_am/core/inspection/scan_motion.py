# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pose of a scan on its body: the best fit of the points without spatter, over all attitudes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.obstacles import Body
from ..issues import AmError, InputError
from ..types import Array
from .planned import triangle_surface
from .registration import Surface, by_extents, mean_square, register, roughly

NEIGHBOURS = 8
ALONE = (
    3.0  # times farther from its neighbours than points are as a rule: it is none of the surface
)
FITTED = 3000  # points
TRIAL_POINTS, HOPEFUL = (
    300,
    12,
)  # points that distinguish attitudes, and attitudes that are tried
OUTLYING = 5.0  # standard deviations, by the median, that an aligned point may be off
EQUAL_RATIO = 1.1  # times the least mean square: attitudes that points do not distinguish
LOOSE = 0.1  # of the largest influence: motions with less are along a flat face, whose rims hardly show them
STILL = 0.01  # mm: on a bent body's flat faces the minimum of distances is flat
MIN_DIFFERENCE_RAD = np.radians(10.0)  # between attitudes that are not the same
PLAIN = np.radians(
    45.0
)  # from as it was measured: an attitude that is taken though others are alike


def align_scan(points: Array, body: Body, label: str) -> Array:
    """The motion (4, 4) that moves measured points (n, 3) onto a body. InputError SCAN_OTHER, SCAN_AMBIGUOUS."""
    planned = triangle_surface(body.name, body.vertices, body.triangles)
    neighbour_distance = np.asarray(
        cKDTree(points).query(points, k=min(NEIGHBOURS + 1, len(points)))[0]
    )[:, -1]
    together = points[neighbour_distance <= ALONE * np.median(neighbour_distance)]
    sample = together[np.unique(np.linspace(0, len(together) - 1, FITTED).astype(np.intp))]
    start = _attitude(sample, planned.nearest, by_extents(sample, planned.spread), label)
    try:
        for _ in range(2):
            registration = register(
                sample, planned.nearest, start[None], label, free=LOOSE, still=STILL
            )
            start = registration.motion
            off = np.abs(registration.distance)
            sample = sample[off <= max(OUTLYING * 1.4826 * float(np.median(off)), 1e-6)]
    except AmError as error:
        raise InputError(
            "SCAN_OTHER", label, "it cannot be aligned with {}: {}", body.name, error.message
        ) from None
    return start


def _attitude(points: Array, surface: Surface, starts: Array, label: str) -> Array:
    """The attitude nearest to the measured one among those that fit the points about best. InputError SCAN_AMBIGUOUS if several
    are equivalent and none is near the measured one.
    """
    sample = points[:: max(1, len(points) // TRIAL_POINTS)]
    order = np.argsort([mean_square(sample, surface, start) for start in starts], kind="stable")
    motions = [
        roughly(sample, surface, start[None], free=LOOSE) for start in starts[order[:HOPEFUL]]
    ]
    squares = np.array([mean_square(sample, surface, motion) for motion in motions])
    alike = [
        motion
        for motion, square in zip(motions, squares, strict=True)
        if square <= EQUAL_RATIO * squares.min() + 1e-12
    ]
    turns = np.array([_turn(motion[:3, :3]) for motion in alike])
    best = alike[int(turns.argmin())]
    different = [
        motion for motion in alike if _turn(motion[:3, :3] @ best[:3, :3].T) > MIN_DIFFERENCE_RAD
    ]
    if different and turns.min() > PLAIN:
        angle = np.degrees(_turn(different[0][:3, :3] @ best[:3, :3].T))
        raise InputError(
            "SCAN_AMBIGUOUS",
            label,
            "it fits equally well on the part rotated by {:.0f} deg, so its orientation is "
            "ambiguous; give three pairs of points as substrate.scan_pairs, or measure in part "
            "coordinates",
            angle,
        )
    return best


def _turn(rotation: Array) -> float:
    """Angle of a rotation (3, 3), rad."""
    return float(np.arccos(np.clip(0.5 * (np.trace(rotation) - 1.0), -1.0, 1.0)))


def as_pairs(motion: Array, size: float) -> str:
    """A motion (4, 4) as the pairs of points that start an inspection, about `size` mm apart."""
    points = size * np.vstack([np.zeros(3), np.eye(3)])
    moved_points = points @ motion[:3, :3].T + motion[:3, 3]
    return "; ".join(
        " ".join(repr(float(x)) for x in measured_point)
        + " > "
        + " ".join(repr(float(x)) for x in part_point)
        for measured_point, part_point in zip(points, moved_points, strict=True)
    )
