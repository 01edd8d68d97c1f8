# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a scan lies on the body it is of: the best fit of the points that are not spatter, over all attitudes."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ..geometry.obstacles import Body
from ..issues import AmError, InputError
from ..types import Array
from .planned import of_triangles
from .registration import Surface, by_extents, mean_square, register, roughly

NEIGHBOURS = 8
ALONE = (
    3.0  # times farther from its neighbours than points are as a rule: it is none of the surface
)
FITTED = 3000  # points
TRIAL_POINTS, HOPEFUL = (
    300,
    12,
)  # points by which attitudes are told apart, and attitudes that are tried
OUTLYING = 5.0  # standard deviations, by the median, that a point may be off once it is laid
EQUAL_RATIO = 1.1  # times the least mean square: attitudes that points do not tell apart
LOOSE = 0.1  # of the most: motions that distances feel by less are those along a flat face, which its rims hardly tell
STILL = (
    0.01  # mm: of a bent body's flat faces the least distances are hardly less than those around
)
OTHER = np.radians(10.0)  # between attitudes that are not the same
PLAIN = np.radians(
    45.0
)  # from as it was measured: an attitude that is taken though others are alike


def aligned(points: Array, body: Body, label: str) -> Array:
    """The motion (4, 4) that lays measured points (n, 3) onto a body. InputError SCAN_OTHER, SCAN_AMBIGUOUS."""
    planned = of_triangles(body.name, body.vertices, body.triangles)
    far = np.asarray(cKDTree(points).query(points, k=min(NEIGHBOURS + 1, len(points)))[0])[:, -1]
    together = points[far <= ALONE * np.median(far)]
    few = together[np.unique(np.linspace(0, len(together) - 1, FITTED).astype(np.intp))]
    start = _attitude(few, planned.nearest, by_extents(few, planned.spread), label)
    try:
        for _ in range(2):
            found = register(few, planned.nearest, start[None], label, free=LOOSE, still=STILL)
            start = found.motion
            off = np.abs(found.distance)
            few = few[off <= max(OUTLYING * 1.4826 * float(np.median(off)), 1e-6)]
    except AmError as error:
        raise InputError(
            "SCAN_OTHER", label, "it cannot be laid onto {}: {}", body.name, error.message
        ) from None
    return start


def _attitude(points: Array, surface: Surface, starts: Array, label: str) -> Array:
    """Of the attitudes that fit the points about best the one nearest to as they were measured. InputError SCAN_AMBIGUOUS
    where several are alike and none of them is near to that."""
    few = points[:: max(1, len(points) // TRIAL_POINTS)]
    order = np.argsort([mean_square(few, surface, start) for start in starts], kind="stable")
    tried = [roughly(few, surface, start[None], free=LOOSE) for start in starts[order[:HOPEFUL]]]
    squares = np.array([mean_square(few, surface, motion) for motion in tried])
    alike = [
        motion
        for motion, square in zip(tried, squares, strict=True)
        if square <= EQUAL_RATIO * squares.min() + 1e-12
    ]
    turns = np.array([_turn(motion[:3, :3]) for motion in alike])
    best = alike[int(turns.argmin())]
    others = [motion for motion in alike if _turn(motion[:3, :3] @ best[:3, :3].T) > OTHER]
    if others and turns.min() > PLAIN:
        angle = np.degrees(_turn(others[0][:3, :3] @ best[:3, :3].T))
        raise InputError(
            "SCAN_AMBIGUOUS",
            label,
            "it lies as well on the part turned by {:.0f} deg: the scan does not show which; give "
            "three points of it and where they are on the part as substrate.scan_pairs, or measure it in the part's "
            "coordinates",
            angle,
        )
    return best


def _turn(rotation: Array) -> float:
    """Angle of a rotation (3, 3), rad."""
    return float(np.arccos(np.clip(0.5 * (np.trace(rotation) - 1.0), -1.0, 1.0)))


def as_pairs(motion: Array, size: float) -> str:
    """A motion (4, 4) as the pairs of points by which an inspection begins, about `size` mm apart."""
    points = size * np.vstack([np.zeros(3), np.eye(3)])
    there = points @ motion[:3, :3].T + motion[:3, 3]
    return "; ".join(
        " ".join(repr(float(x)) for x in one) + " > " + " ".join(repr(float(x)) for x in other)
        for one, other in zip(points, there, strict=True)
    )
