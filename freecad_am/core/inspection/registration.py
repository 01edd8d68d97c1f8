# SPDX-License-Identifier: LGPL-2.1-or-later
"""Registration of measured points on a surface: the rigid motion with the least sum of squared distances.

Gauss-Newton iterations minimise the distances along the surface normals (Chen and Medioni 1992), with
Levenberg-Marquardt damping. Motions without influence on the distances, such as rotating a round part about its axis,
are not made but reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np
from scipy.linalg import expm

from ..geometry.formatting import place
from ..geometry.frames import pose, rotation_about
from ..issues import InfeasibleError, InputError
from ..types import Array, Mask

# ---- Descriptions of small rigid motions

NO_TURN = 1e-6  # rad per mm of shift; below it a motion is a pure shift


def motion_text(turn: Array, shift: Array, middle: Array) -> str:
    """Describe a motion as a rotation about an axis or as a shift.

    Parameters
    ----------
    turn : (3,) array
        Rotation vector, rad.
    shift : (3,) array
        Shift of the point `middle`, mm.
    middle : (3,) array
        Reference point, mm.

    Returns
    -------
    str
        The description.
    """
    angle, distance = float(np.linalg.norm(turn)), float(np.linalg.norm(shift))
    if angle <= NO_TURN * distance:
        return f"a shift along {place(_upward(shift / distance))}"
    axis = turn / angle
    return f"a turn about the axis through {place(middle + np.cross(axis, shift) / angle)} along {place(_upward(axis))}"


def _upward(direction: Array) -> Array:
    """Return the direction or its opposite, so that the largest component is positive."""
    return np.asarray(direction * np.sign(direction[np.argmax(np.abs(direction))]))


# signed distances (n,) of points (n, 3), positive outside, and unit vectors (n, 3) along which they increase
Surface = Callable[[Array], tuple[Array, Array]]

TRIAL_POINTS = 400  # points used to compare the starts
FIRST_ROUNDS, TRIAL_ROUNDS, ROUNDS = 4, 10, 100
HOPE = 30.0  # times the best mean square after the first rounds; worse starts are dropped
EQUAL_RATIO = 1.02  # maximum ratio of equivalent mean squares
CONVERGED = 1e-9  # mm; the iteration ends at a displacement of all points below this
STILL = 1e-6  # mm; maximum displacement of a point in the last iteration of a valid fit
MIN_INFLUENCE = 1e-5  # relative singular value; motions below it have no influence on the distances
LEAST_POINTS = 6


@dataclass(frozen=True, eq=False)
class Registration:
    """Fit of n measured points.

    motion: (4, 4) from measuring to part coordinates. points: (n, 3) in part coordinates. distance: (n,) mm from the
    surface, positive outside. used: (n,) bool, points that count. free: motions without influence on the distances.
    """

    motion: Array
    points: Array
    distance: Array
    used: Mask
    free: tuple[str, ...]

    @property
    def rms(self) -> float:
        """Root mean square distance of the points that count, mm."""
        return float(np.sqrt((self.distance[self.used] ** 2).mean()))


def refuse_too_few(points: Array, where: str) -> None:
    """Reject a set of points that is too small to locate a part.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    where : str
        Name for messages.

    Raises
    ------
    InputError
        TOO_FEW_POINTS for fewer than LEAST_POINTS.
    """
    if len(points) < LEAST_POINTS:
        raise InputError(
            "TOO_FEW_POINTS",
            where,
            "{} points cannot locate a part; measure at least {} points, spread over the part",
            len(points),
            LEAST_POINTS,
        )


def register(
    points: Array,
    surface: Surface,
    starts: Iterable[Array],
    where: str,
    trim: float = 0.0,
    radius: float = 0.0,
    allowed: Array | None = None,
    free: float = MIN_INFLUENCE,
    still: float = STILL,
) -> Registration:
    """Fit points to a surface from the best of several starts.

    A sample of the points selects the start. The final fit uses all points.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    surface : Surface
        Returns signed distances (n,) and normals (n, 3) at points.
    starts : iterable of Array
        Initial motions (4, 4).
    where : str
        Name of the points, for messages.
    trim : float, optional
        Fraction of the points, those with the largest distances, that do not count (outliers,
        supports, a clamp); from 0 to less than 0.5.
    radius : float, optional
        Radius of the probe ball whose centre was measured, mm. Distances are measured from the
        ball's surface.
    allowed : (6, k) array or None, optional
        Allowed motions as columns: three rotations about the part origin above three shifts;
        None for all motions. The set must be closed under composition, like rotations about and
        shifts along one axis.
    free : float, optional
        Minimum influence of a motion on the distances, relative to the maximum influence. The fit
        makes no motions below it.
    still : float, optional
        Maximum displacement of a point in the last iteration of a converged fit, mm.

    Returns
    -------
    Registration
        The fit.

    Raises
    ------
    InputError
        TOO_FEW_POINTS; OUT_OF_RANGE for an invalid `trim`.
    InfeasibleError
        NOT_SETTLED if the fit does not converge.
    """
    refuse_too_few(points, where)
    if not 0.0 <= trim < 0.5:
        raise InputError(
            "OUT_OF_RANGE",
            where,
            "the excluded share {:g} is out of range; use 0 or more and less than 0.5",
            trim,
        )
    best = roughly(points, surface, starts, trim, radius, allowed, free)
    motion, _, moved = _converged(points, surface, best, trim, radius, ROUNDS, allowed, free)
    if moved > still:
        raise InfeasibleError(
            "NOT_SETTLED",
            where,
            "the registration does not converge; give initial pairs of points",
        )
    aligned = _transform(points, motion)
    distance, normal = surface(aligned)
    distance = distance - radius
    used = _counting(distance, trim)
    return Registration(
        motion, aligned, distance, used, _free(aligned[used], normal[used], allowed, free)
    )


def roughly(
    points: Array,
    surface: Surface,
    starts: Iterable[Array],
    trim: float = 0.0,
    radius: float = 0.0,
    allowed: Array | None = None,
    free: float = MIN_INFLUENCE,
) -> Array:
    """Return an approximate motion from a sample of the points.

    Among starts with equivalent results, the first is chosen, so that the motion has no component
    without influence on the distances.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    surface : Surface
        Returns signed distances (n,) and normals (n, 3) at points.
    starts : iterable of Array
        Initial motions (4, 4).
    trim, radius, allowed, free : float, optional
        As in `register`.

    Returns
    -------
    (4, 4) array
        The motion.
    """
    sample = points[np.unique(np.linspace(0, len(points) - 1, TRIAL_POINTS).astype(np.intp))]
    first_fits = [
        _converged(sample, surface, start, trim, radius, FIRST_ROUNDS, allowed, free)
        for start in starts
    ]
    hopeful = HOPE * min(square for _, square, _ in first_fits) + 1e-18
    fits = [
        _converged(sample, surface, motion, trim, radius, TRIAL_ROUNDS, allowed, free)
        for motion, square, _ in first_fits
        if square <= hopeful
    ]
    least_square = min(square for _, square, _ in fits)
    return next(
        motion for motion, square, _ in fits if square <= EQUAL_RATIO * least_square + 1e-18
    )


def mean_square(
    points: Array, surface: Surface, motion: Array, trim: float = 0.0, radius: float = 0.0
) -> float:
    """Return the mean square distance from a surface after a motion.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    surface : Surface
        Returns signed distances (n,) and normals (n, 3) at points.
    motion : (4, 4) array
        The motion.
    trim : float, optional
        Fraction of the points that do not count.
    radius : float, optional
        Radius of the probe ball, mm.

    Returns
    -------
    float
        Mean square distance, mm2.
    """
    return _square(surface(_transform(points, motion))[0] - radius, trim)


def as_measured() -> Array:
    """Return the start for points measured in part coordinates.

    Returns
    -------
    (1, 4, 4) array
        The identity.
    """
    return np.eye(4)[None]


def by_extents(points: Array, of_surface: Array) -> Array:
    """Return starts that match the extents of points and surface.

    The first start is the identity. The other 24 starts align the centres and the principal axes of
    points and surface in all orientations.

    Parameters
    ----------
    points : (n, 3) array
        Measured points, mm.
    of_surface : (m, 3) array
        Points distributed over the surface, mm.

    Returns
    -------
    (25, 4, 4) array
        Initial motions.
    """
    centre, surface_centre = points.mean(axis=0), of_surface.mean(axis=0)
    axes_of_points = np.linalg.svd(points - centre, full_matrices=False)[2]
    its = np.linalg.svd(of_surface - surface_centre, full_matrices=False)[2]
    axes_of_points[2] *= np.linalg.det(axes_of_points)
    its[2] *= np.linalg.det(its)
    starts = [np.eye(4)]
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        axes = np.array(signs)[:, None] * np.eye(3)[list(order)]
        if np.linalg.det(axes) > 0.0:
            turn = its.T @ axes @ axes_of_points
            starts.append(pose(turn, surface_centre - turn @ centre))
    return np.array(starts)


def by_pairs(measured: Array, planned: Array, where: str) -> Array:
    """Return the start that aligns measured points with corresponding points of the part.

    Parameters
    ----------
    measured : (k, 3) array
        Three or more measured points, mm.
    planned : (k, 3) array
        The corresponding points of the part, mm.
    where : str
        Name of the points, for messages.

    Returns
    -------
    (1, 4, 4) array
        The motion with the least sum of squared distances.

    Raises
    ------
    InputError
        TOO_FEW_PAIRS; PAIRS_IN_LINE for collinear points.

    References
    ----------
    Kabsch 1976.
    """
    if measured.shape != planned.shape or len(measured) < 3:
        raise InputError(
            "TOO_FEW_PAIRS",
            where,
            "{} pairs of points are too few; give at least three pairs",
            min(len(measured), len(planned)),
        )
    measured_centre, planned_centre = measured.mean(axis=0), planned.mean(axis=0)
    u_matrix, stretch, right = np.linalg.svd(
        (planned - planned_centre).T @ (measured - measured_centre)
    )
    if stretch[1] <= 1e-9 * max(stretch[0], 1e-300):
        raise InputError(
            "PAIRS_IN_LINE",
            where,
            "the pairs of points are collinear, so the part could rotate about their line; "
            "choose pairs off this line",
        )
    turn = u_matrix @ np.diag([1.0, 1.0, np.linalg.det(u_matrix @ right)]) @ right
    return np.asarray(pose(turn, planned_centre - turn @ measured_centre))[None]


def _converged(
    points: Array,
    surface: Surface,
    start: Array,
    trim: float,
    radius: float,
    rounds: int,
    allowed: Array | None,
    free: float,
) -> tuple[Array, float, float]:
    """Iterate from a start.

    Returns the motion, the mean square distance of the points that count, mm2, and the maximum displacement of a point
    in the last iteration, mm.
    """
    motion, damping, moved = start, 0.0, np.inf
    aligned = _transform(points, motion)
    distance, normal = surface(aligned)
    square = _square(distance - radius, trim)
    for _ in range(rounds):
        used = _counting(distance - radius, trim)
        change = _step(aligned[used], normal[used], distance[used] - radius, damping, allowed, free)
        trial = change @ motion
        moving = _transform(points, trial)
        next_distance, next_normal = surface(moving)
        next_square = _square(next_distance - radius, trim)
        if next_square > square * (1.0 + 1e-12):
            damping = max(10.0 * damping, 1e-3)
            if damping > 1e9:  # no step reduces the distances; this happens on facets
                moved = 0.0
                break
            continue
        moved = float(np.linalg.norm(moving - aligned, axis=1).max())
        motion = trial
        aligned = moving
        distance = next_distance
        normal = next_normal
        square = next_square
        damping *= 0.1 if damping > 1e-9 else 0.0
        if moved < CONVERGED:
            break
    return motion, square, moved if np.isfinite(moved) else 0.0


def _step(
    points: Array,
    normal: Array,
    distance: Array,
    damping: float,
    allowed: Array | None,
    free: float,
) -> Array:
    """Return the damped least-squares step (4, 4), of minimum norm if several steps are equivalent."""
    system, middle, size = _felt(points, normal)
    basis = _basis(allowed, middle, size)
    u_matrix, stretch, right = np.linalg.svd(system @ basis, full_matrices=False)
    firm = stretch > free * stretch[0]
    share = np.zeros(len(stretch))
    share[firm] = stretch[firm] / (stretch[firm] ** 2 + damping * stretch[0] ** 2)
    solved = -(basis @ right.T @ (share * (u_matrix.T @ distance)))
    turn, shift = solved[:3] / size, solved[3:]
    if allowed is not None:  # only a screw motion stays within the allowed motions
        twist = np.zeros((4, 4))
        twist[:3, :3] = np.cross(np.eye(3), turn)  # twist[:3, :3] @ v = turn x v
        twist[:3, 3] = shift - np.cross(turn, middle)
        return np.asarray(expm(twist))
    angle = float(np.linalg.norm(turn))
    rotation = rotation_about(turn / angle, angle) if angle > 0.0 else np.eye(3)
    return np.asarray(pose(rotation, middle + shift - rotation @ middle))


def _basis(allowed: Array | None, middle: Array, size: float) -> Array:
    """Return an orthonormal basis (6, k) of the allowed motions, in the coordinates of `_felt`."""
    if allowed is None:
        return np.eye(6)
    turn, shift = allowed[:3], allowed[3:]
    moved = np.vstack([turn * size, shift + np.cross(turn.T, middle).T])
    return np.asarray(np.linalg.qr(moved)[0])


def _felt(points: Array, normal: Array) -> tuple[Array, Array, float]:
    """Return the derivatives (n, 6) of the distances by three rotations and three shifts.

    Rotations are about the points' centroid and in mm at the root mean square radius. Also returns the centroid and
    this radius.
    """
    middle = points.mean(axis=0)
    arm = points - middle
    size = float(np.sqrt((arm**2).sum(axis=1).mean())) or 1.0
    return np.hstack([np.cross(arm, normal) / size, normal]), middle, size


def _free(
    points: Array, normal: Array, allowed: Array | None, min_influence: float
) -> tuple[str, ...]:
    system, middle, size = _felt(points, normal)
    basis = _basis(allowed, middle, size)
    _, stretch, right = np.linalg.svd(system @ basis, full_matrices=False)
    free = right[stretch <= max(1e-3, min_influence) * stretch[0]] @ basis.T
    return tuple(motion_text(motion_[:3] / size, motion_[3:], middle) for motion_ in free)


def _counting(distance: Array, trim: float) -> Mask:
    """Return which points count: all but the fraction `trim` with the largest distances."""
    count = len(distance) - int(trim * len(distance))
    used = np.zeros(len(distance), dtype=np.bool_)
    used[np.argsort(np.abs(distance), kind="stable")[:count]] = True
    return used


def _square(distance: Array, trim: float) -> float:
    return float((distance[_counting(distance, trim)] ** 2).mean())


def _transform(points: Array, motion: Array) -> Array:
    moved: Array = points @ motion[:3, :3].T + motion[:3, 3]
    return moved
