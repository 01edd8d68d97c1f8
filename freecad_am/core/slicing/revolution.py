# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of revolution: levels of layers, build directions and tool axes (Chalvin 2020, section 2.1)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry.columns import columns
from ..geometry.curves.profile import Meridian
from ..issues import InputError
from ..types import Array, Index, Mask

# ---- Levels of layers on a meridian, equally spaced along the wall or along the axis


def arc_length_levels(meridian: Meridian, layer_height: float) -> tuple[list[Array], float]:
    """Return the arc lengths of the beads of each layer, equally spaced along the wall.

    If the wall length is a multiple of the layer height, the last layer is at the end of the wall.
    A top that closes on the axis gets no additional bead.

    Parameters
    ----------
    meridian : Meridian
        The meridian of the wall.
    layer_height : float
        Layer height along the wall, mm.

    Returns
    -------
    levels : list of (1,) array
        Arc length of the bead of each layer, the first at the base, mm.
    rest : float
        Length left over at the top, mm.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the layer height exceeds the wall length.

    References
    ----------
    Chalvin 2020, section 2.1.
    """
    if layer_height > meridian.length:
        raise InputError(
            "LAYER_HEIGHT",
            "strategy.layer_height",
            "{:g} mm exceeds the length of the wall ({:.4g} mm); use a smaller layer height",
            layer_height,
            meridian.length,
        )
    steps = int(np.floor(meridian.length / layer_height + 1e-6))
    s = np.minimum(np.arange(steps + 1) * layer_height, meridian.length)
    return [s[i : i + 1] for i in range(steps + 1)], max(
        0.0, meridian.length - steps * layer_height
    )


# ---- Layers equally spaced along the axis (Chalvin 2020, section 2.1, Z-level planes)


def iso_height_levels(meridian: Meridian, layer_height: float) -> tuple[list[Array], float]:
    """Return the arc lengths of the beads of each layer, equally spaced along the axis.

    A plane that intersects the wall several times has one bead per intersection, in the order of
    the wall from the platform up.

    Parameters
    ----------
    meridian : Meridian
        The meridian of the wall.
    layer_height : float
        Layer height along the axis, mm.

    Returns
    -------
    levels : list of array
        Arc lengths of the beads of each layer, from the lowest plane up, mm.
    rest : float
        Height left over at the top, mm.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the layer height exceeds the wall height.

    References
    ----------
    Chalvin 2020, section 2.1.
    """
    low, high = float(meridian.points[:, 1].min()), float(meridian.points[:, 1].max())
    if layer_height > high - low:
        raise InputError(
            "LAYER_HEIGHT",
            "strategy.layer_height",
            "{:g} mm exceeds the height of the wall ({:.4g} mm); use a smaller layer height, or "
            "layers along the wall (spacing: arc-length)",
            layer_height,
            high - low,
        )
    steps = int(np.floor((high - low) / layer_height + 1e-6))
    heights = np.minimum(low + np.arange(steps + 1) * layer_height, high)
    return meridian.s_at_height(heights), max(0.0, high - low - steps * layer_height)


def spacing(meridian: Meridian, below: Array, layer: Array) -> Array:
    """Return the distances of the beads of a layer from the layer below.

    Parameters
    ----------
    meridian : Meridian
        The meridian of the wall.
    below : (m,) array
        Arc lengths of the beads below, mm.
    layer : (k,) array
        Arc lengths of the beads of the layer, mm.

    Returns
    -------
    (k,) array
        Distance from the nearest bead below, in the plane of the meridian, mm.
    """
    r, h, _ = meridian.at(np.r_[below, layer])
    n = len(below)
    distances: Array = np.hypot(r[n:, None] - r[None, :n], h[n:, None] - h[None, :n]).min(axis=1)
    return distances


# ---- Build directions and tool axes. A part of revolution is the same at every azimuth. Directions
# (..., 3) are therefore components in the moving frame (radial, tangential with ascending azimuth,
# axial), and one row represents a complete circle.

SCAN = 48  # number of coarse tilt steps in the search for the first valid angle
# number of angles tested together, and number of sub-intervals per refinement step
BLOCK_SIZE, PARTS = 8, 4


def local(tangents: Array) -> Array:
    """Return the directions tangent to the wall.

    Parameters
    ----------
    tangents : (n, 2) array
        Meridian tangents, components along radius and axis.

    Returns
    -------
    (n, 3) array
        Components along radius, azimuth and axis.
    """
    return np.stack([tangents[:, 0], np.zeros(len(tangents)), tangents[:, 1]], axis=1)


def fixed(count: int) -> Array:
    """Return the axis as the build direction.

    Parameters
    ----------
    count : int
        Number n of directions.

    Returns
    -------
    (n, 3) array
        Components along radius, azimuth and axis.
    """
    return np.tile([0.0, 0.0, 1.0], (count, 1))


def layer_mean(tangent: Array, azimuth: Array, start: float, end: float) -> Array:
    """Return the mean of the local directions of an open bead, one direction for the complete bead.

    Over a full turn the mean is along the axis.

    Parameters
    ----------
    tangent : (2,) array
        Meridian tangent, components along radius and axis.
    azimuth : (n,) array
        Azimuths of the points, rad.
    start, end : float
        Azimuths of the ends of the bead, rad.

    Returns
    -------
    (n, 3) array
        Components along radius, azimuth and axis at each point.
    """
    half = 0.5 * (end - start)
    radial = tangent[0] * np.sin(half) / half
    mean = np.array([radial, tangent[1]])
    norm = np.linalg.norm(mean)
    if norm < 1e-9:
        return fixed(len(azimuth))
    from_middle = azimuth - 0.5 * (start + end)
    r, z = mean / norm
    return np.stack(
        [r * np.cos(from_middle), -r * np.sin(from_middle), np.full(len(azimuth), z)], axis=1
    )


def lean_tool(build: Array, lead: float, tilt: float, rising: bool) -> Array:
    """Rotate tool axes away from the build directions.

    A tool axis is rotated by `lead` forward along the bead, then by `tilt` outwards.

    Parameters
    ----------
    build : (n, 3) array
        Build directions, components along radius, azimuth and axis.
    lead, tilt : float
        Angles, rad.
    rising : bool
        Whether the azimuth rises along the bead.

    Returns
    -------
    (n, 3) array
        Unit vectors.
    """
    if lead == 0.0 and tilt == 0.0:
        return build
    out = np.stack([build[:, 2], np.zeros(len(build)), -build[:, 0]], axis=1)
    out = out / np.linalg.norm(out, axis=1, keepdims=True)
    forward = np.cross(build, out) * (1.0 if rising else -1.0)
    leaning = np.cos(lead) * build + np.sin(lead) * forward
    return np.asarray(np.cos(tilt) * leaning + np.sin(tilt) * out)


def from_vertical(directions: Array) -> Array:
    """Return the angles between directions and the axis.

    Parameters
    ----------
    directions : (n, 3) array
        Directions; the axis is the third component.

    Returns
    -------
    (n,) array
        Angles, rad.
    """
    x, y, z = columns(directions)
    angle: Array = np.arctan2(np.hypot(x, y), z)
    return angle


def tilt_back(build: Array, angle: Array) -> Array:
    """Rotate build directions towards the axis, at most onto the axis.

    Parameters
    ----------
    build : (n, 3) array
        Build directions, unit vectors.
    angle : (n,) array
        Angles, rad.

    Returns
    -------
    (n, 3) array
        Unit vectors.
    """
    x, y, z = columns(build)
    level = np.hypot(x, y)
    remaining = np.maximum(np.arctan2(level, z) - angle, 0.0)
    along = build[:, :2] / np.where(level > 0.0, level, 1.0)[:, None]
    turned = np.column_stack([np.sin(remaining)[:, None] * along, np.cos(remaining)])
    return np.where((angle > 0.0)[:, None] & (level > 0.0)[:, None], turned, build)


def least_tilt_back(
    build: Array,
    low: Array,
    good: Callable[[Index, Array], Mask],
    within: float = 1e-14,
    about: Array | None = None,
    free: Mask | None = None,
) -> Array:
    """Find the minimum tilt-back at which each direction is valid.

    Parameters
    ----------
    build : (n, 3) array
        Build directions, unit vectors.
    low : (n,) array
        Minimum angles, rad.
    good : callable
        Returns whether rows (k,) are valid when tilted back by angles (k,).
    within : float, optional
        Tolerance, rad.
    about : (n, 2) array or None, optional
        Interval in which the search starts, rad; NaN for none.
    free : (n,) bool array or None, optional
        Rows known to be valid at `low`.

    Returns
    -------
    (n,) array
        Angles, rad; NaN if no angle up to the axis is valid.
    """
    angle = low.copy()
    rows = np.arange(len(build)) if free is None else np.flatnonzero(~free)
    top = np.maximum(from_vertical(build[rows]), low[rows])
    bad, fine = low[rows].copy(), np.full(len(rows), np.nan)
    angles = low[rows, None]
    if about is not None:
        likely = np.where(
            np.isfinite(about[rows]), np.clip(about[rows], angles, top[:, None]), angles
        )
        angles = np.concatenate([angles, likely], axis=1)
    _narrow(rows, np.arange(len(rows)), angles, good, bad, fine)
    bad[np.isnan(fine)] = low[rows[np.isnan(fine)]]
    for block_start in range(0, SCAN, BLOCK_SIZE):
        open_ = np.flatnonzero(np.isnan(fine))
        if len(open_) == 0:
            break
        step = np.arange(block_start + 1, block_start + BLOCK_SIZE + 1) / SCAN
        start = low[rows[open_], None]
        _narrow(rows, open_, start + (top[open_, None] - start) * step, good, bad, fine)
    share = np.arange(1, PARTS) / PARTS
    while True:
        wide = np.flatnonzero(fine - bad > within)
        if not len(wide):
            break
        _narrow(
            rows, wide, bad[wide, None] + (fine[wide] - bad[wide])[:, None] * share, good, bad, fine
        )
    angle[rows] = fine
    return angle


def _narrow(
    rows: Index,
    selected: Index,
    angles: Array,
    good: Callable[[Index, Array], Mask],
    bad: Array,
    fine: Array,
) -> None:
    """Update the bounds `bad` and `fine` of selected rows in place.

    `fine` becomes the first valid angle of the ascending angles (k, s), `bad` the angle before.
    """
    ok = good(np.repeat(rows[selected], angles.shape[1]), angles.ravel()).reshape(angles.shape)
    has_good = ok.any(axis=1)
    first_good = np.where(has_good, ok.argmax(axis=1), angles.shape[1])
    fine[selected[has_good]] = angles[has_good, first_good[has_good]]
    later = np.flatnonzero(first_good > 0)
    bad[selected[later]] = angles[later, first_good[later] - 1]
