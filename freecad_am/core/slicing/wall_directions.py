# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes of beads on a wall (Chalvin 2019, section II.D).

Rows (n, 3) are unit vectors in part coordinates, one per point of a bead. At a corner the local
direction jumps. The corner point gets the bisector of both directions, and `limit_turns` spreads
the jump over the bead length that the turn rate limit (rad/mm) requires.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..geometry.columns import columns
from ..geometry.curves.space_curve import SpaceCurve
from ..geometry.frames import unit
from ..geometry.walls.surface import dot
from ..issues import InputError
from ..types import Array, Mask

# ---- Turn rate of a bead within its wall

SHORT_ARC = 1e-3  # fraction of the median arc length; shorter arcs use the turn rate around them


def turns_in_wall(curve: SpaceCurve, normal: Array) -> Array:
    """Return the turn rate of a bead within the wall.

    The angle of an arc includes the corner at its start. The curvature of the wall does not count,
    because the nozzle is normal to the bead within the wall and follows this curvature anyway. A
    very short arc gets the turn rate over a median arc length around it, because rounding errors
    would dominate its own turn rate.

    Parameters
    ----------
    curve : SpaceCurve
        The bead, m nodes.
    normal : (m, 3) array
        Unit normals of the wall at the nodes.

    Returns
    -------
    (m - 1,) array
        Turn rate of each arc, rad/mm.
    """
    # project both tangents of an arc onto the plane of their mean normal
    middle = normal[:-1] + normal[1:]
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    turn = _angles(curve.out[:-1], curve.into[1:], middle)
    corner = _angles(curve.into[:-1], curve.out[:-1], normal[:-1])
    if not curve.closed:
        corner[0] = 0.0
    length = np.linalg.norm(np.diff(curve.points, axis=0), axis=1)
    typical = float(np.median(length))
    short = length < SHORT_ARC * typical
    rate: Array = np.abs(turn + corner) / np.where(short, typical, length)
    if short.any():
        rate[short] = _turn_per_stretch(turn + corner, length, typical)[short]
    return rate


def _turn_per_stretch(turned: Array, length: Array, stretch: float) -> Array:
    """Return the turn rate (n,), rad/mm, over `stretch` mm around the midpoint of each arc.

    turned: (n,) signed angles, rad. length: (n,) arc lengths, mm.
    """
    s, total = np.r_[0.0, np.cumsum(length)], np.r_[0.0, np.cumsum(turned)]
    middle = 0.5 * (s[1:] + s[:-1])
    low, high = np.maximum(middle - 0.5 * stretch, 0.0), np.minimum(middle + 0.5 * stretch, s[-1])
    rate: Array = np.abs(np.interp(high, s, total) - np.interp(low, s, total)) / (high - low)
    return rate


def _angles(a: Array, b: Array, normal: Array) -> Array:
    """Return the angles (n,), rad, from a to b about the normals, in the planes of the normals."""
    a, b = (side - dot(side, normal)[:, None] * normal for side in (a, b))
    angle: Array = np.arctan2(dot(np.cross(a, b), normal), dot(a, b))
    return angle


MIN_IN_PLANE = 1e-6  # minimum length of a projected unit vector; a shorter one has no direction
HALVINGS = 30  # maximum number of bisection steps for the averaging length
ROUNDING = 1e-9  # rad; angles up to this are rounding errors


class Limited(NamedTuple):
    """Directions (n, 3), and their departures (n,), rad, from the requested directions."""

    directions: Array
    departure: Array


def local_directions(normal: Array, into: Array, out: Array, up: Array) -> Array:
    """Return the directions tangent to the wall and normal to the bead.

    Parameters
    ----------
    normal : (n, 3) array
        Normals of the wall, towards either side.
    into, out : (n, 3) array
        Bead directions before and after each point, of any length; they differ only at corners.
    up : (n, 3) array
        Vectors away from the layer below, not parallel to the bead.

    Returns
    -------
    (n, 3) array
        Unit vectors.

    References
    ----------
    Chalvin 2019, section II.D.
    """
    sides = [
        np.cross(normal, side / np.linalg.norm(side, axis=1, keepdims=True)) for side in (into, out)
    ]
    upright = [side * np.where(dot(side, up) < 0.0, -1.0, 1.0)[:, None] for side in sides]
    return unit(unit(upright[0]) + unit(upright[1]))


def project_onto_plane(directions: Array, plane: Array, label: str = "build_direction") -> Array:
    """Project directions onto a plane of symmetry, so that they rotate only about the plane normal.

    Parameters
    ----------
    directions : (n, 3) array
        Build directions.
    plane : (3,) array
        Unit normal of the plane.
    label : str, optional
        Name for messages.

    Returns
    -------
    (n, 3) array
        Unit vectors.

    Raises
    ------
    InputError
        NO_DIRECTION if a direction is normal to the plane.
    """
    flat = directions - (directions @ plane)[:, None] * plane
    if np.linalg.norm(flat, axis=1).min() < MIN_IN_PLANE:
        raise InputError(
            "NO_DIRECTION",
            "build_direction.mode",
            "a build direction of {} is normal to its plane of symmetry; use local",
            label,
        )
    return unit(flat)


def lean_tool(build: Array, forward: Array, normal: Array, lead: float, tilt: float) -> Array:
    """Rotate tool axes away from the build directions.

    A tool axis is rotated by `lead` forward along the bead, then by `tilt` towards the outside.

    Parameters
    ----------
    build : (n, 3) array
        Build directions, unit vectors.
    forward : (n, 3) array
        Unit vectors along the bead.
    normal : (n, 3) array
        Outward normals of the wall.
    lead, tilt : float
        Angles, rad.

    Returns
    -------
    (n, 3) array
        Unit vectors.
    """
    if lead == 0.0 and tilt == 0.0:
        return build
    forward = unit(forward - dot(forward, build)[:, None] * build)
    outward = np.cross(build, forward)
    outward *= np.sign(dot(outward, normal))[:, None]
    leaning = np.cos(lead) * build + np.sin(lead) * forward
    return unit(np.cos(tilt) * leaning + np.sin(tilt) * outward)


def cap_lean(directions: Array, max_lean: float) -> tuple[Array, float]:
    """Limit the angle between directions and the vertical.

    Parameters
    ----------
    directions : (n, 3) array
        Unit vectors.
    max_lean : float
        Maximum angle to the vertical, rad.

    Returns
    -------
    directions : (n, 3) array
        Unit vectors.
    excess : float
        Maximum angle by which a direction was rotated back, rad.
    """
    x, y, z = columns(directions)
    level = np.hypot(x, y)
    angle = np.arctan2(level, z)
    over = angle > max_lean + 1e-12
    if not over.any():
        return directions, 0.0
    level, east = level[:, None], np.tile([1.0, 0.0], (len(directions), 1))
    horizontal = np.divide(directions[:, :2], level, out=east, where=level > 0.0)
    turned = np.column_stack(
        [np.sin(max_lean) * horizontal, np.full(len(directions), np.cos(max_lean))]
    )
    return np.where(over[:, None], turned, directions), float((angle - max_lean).max())


def turn_rates(points: Array, directions: Array) -> Array:
    """Return the turn rate of directions from point to point.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm.
    directions : (n, 3) array
        Unit vectors.

    Returns
    -------
    (n - 1,) array
        Turn rates, rad/mm.
    """
    cross = np.linalg.norm(np.cross(directions[:-1], directions[1:]), axis=1)
    angle = np.arctan2(cross, dot(directions[:-1], directions[1:]))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    rate: Array = np.maximum(angle - ROUNDING, 0.0) / np.maximum(steps, 1e-12)
    return rate


def limit_turns(
    points: Array,
    directions: Array,
    closed: bool,
    rate: float,
    label: str = "build_direction",
    max_lean: float = np.pi,
) -> Limited:
    """Limit the turn rate of directions from point to point.

    Near segments above the limit, each direction is averaged over a stretch of the bead. The
    stretches shrink to zero with increasing distance from such segments and are as short as the
    limit allows.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm; closed beads repeat their first point.
    directions : (n, 3) array
        Unit vectors.
    closed : bool
        Whether the bead is closed.
    rate : float
        Maximum turn rate, rad/mm.
    label : str, optional
        Name for messages.
    max_lean : float, optional
        Maximum angle to the vertical, rad.

    Returns
    -------
    Limited
        The directions, and their departures from the requested directions.

    Raises
    ------
    InputError
        TURN_LIMIT if averages over the complete bead exceed the limit or have no direction.
    """
    fast = turn_rates(points, directions) > rate
    if not fast.any():
        return Limited(directions, np.zeros(len(points)))
    s = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    distance = _distance_along(s, fast, closed)

    def average_over(half: float) -> Array | None:
        averaged = _average(s, directions, closed, np.maximum(half - distance, 0.0))
        if averaged is None:
            return None
        # the mean of directions below the horizontal leans more than each of them
        averaged = cap_lean(averaged, max_lean)[0]
        return None if (turn_rates(points, averaged) > rate).any() else averaged

    low, high = 0.0, 1e-3 * s[-1]  # start with short stretches
    while (best := average_over(high)) is None:
        low, high = high, 1.5 * high
        if low > 2.0 * s[-1]:  # all directions are already averages over the complete bead
            raise InputError(
                "TURN_LIMIT",
                label,
                "build directions still turn faster than {:.3g} deg/mm on a bead of {:.4g} mm; "
                "allow a faster turn, or use the mode fixed",
                np.degrees(rate),
                s[-1],
            )
    for _ in range(HALVINGS):
        if high - low < 1e-4 * high:
            break
        middle = 0.5 * (low + high)
        if (averaged := average_over(middle)) is None:
            low = middle
        else:
            high, best = middle, averaged
    cross = np.linalg.norm(np.cross(directions, best), axis=1)
    return Limited(best, np.arctan2(cross, dot(directions, best)))


def _average(s: Array, directions: Array, closed: bool, half: Array) -> Array | None:
    """Average directions over s - half .. s + half (n,); directions with half = 0 stay unchanged.

    Returns None if a mean has no direction.
    """
    if closed:  # repeat the bead on both sides as often as the longest stretch requires
        rounds = int(np.ceil(half.max() / s[-1])) + 1
        turns = np.arange(-rounds, rounds + 1)
        positions = np.r_[(s[:-1] + s[-1] * turns[:, None]).ravel(), s[-1] * (rounds + 1)]
        rows = np.vstack([np.tile(directions[:-1], (len(turns), 1)), directions[:1]])
        low, high = s - half, s + half
    else:
        positions, rows = s, directions
        low, high = np.maximum(s - half, 0.0), np.minimum(s + half, s[-1])
    steps = np.diff(positions)
    total = np.vstack(
        [np.zeros(3), np.cumsum(0.5 * (rows[1:] + rows[:-1]) * steps[:, None], axis=0)]
    )

    def integral(position: Array) -> Array:
        i = np.clip(np.searchsorted(positions, position, side="right") - 1, 0, len(steps) - 1)
        t = (position - positions[i])[:, None]
        slope = (rows[i + 1] - rows[i]) / np.maximum(steps[i], 1e-300)[:, None]
        value: Array = total[i] + t * (rows[i] + 0.5 * t * slope)
        return value

    width = high - low
    wide = width > 1e-9 * s[-1]
    mean = np.where(
        wide[:, None],
        (integral(high) - integral(low)) / np.where(wide, width, 1.0)[:, None],
        directions,
    )
    if np.linalg.norm(mean, axis=1).min() < 1e-6:
        return None
    return unit(mean)


def _distance_along(s: Array, fast: Mask, closed: bool) -> Array:
    """Return the distances (n,) along the bead to the nearest segment above the turn rate limit."""
    ends = np.unique(np.r_[s[:-1][fast], s[1:][fast]])
    if closed:
        ends = np.unique(np.r_[ends - s[-1], ends, ends + s[-1]])
    i = np.clip(np.searchsorted(ends, s), 1, len(ends) - 1)
    distance: Array = np.minimum(np.abs(s - ends[i - 1]), np.abs(s - ends[i]))
    return distance
