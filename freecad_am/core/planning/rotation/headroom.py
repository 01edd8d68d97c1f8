# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margins of planned beads to limits, condition and joint speeds, and their worst values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...kinematics.limits import Limits
from ...types import Array, Integers
from ..joint_path import BeadPath
from ..redundancy_curve import durations


@dataclass(frozen=True)
class Worst:
    """A worst value, its layer, and the label of its limit or axis ('' for none)."""

    value: float
    layer: int
    label: str = ""


@dataclass(frozen=True, eq=False)
class Judgement:
    """The margins of T bead points, NaN out of reach.

    margin: (T,) limit margin, 1 at mid-range, negative beyond a limit. condition: (T,). ratio: (T,)
    maximum joint speed on the segment that ends at the point, as a fraction of the axis limit; the
    first point of a bead has the value of the second. The worst values are None if no point is
    reachable.
    """

    margin: Array
    condition: Array
    ratio: Array
    worst_margin: Worst | None
    worst_condition: Worst | None
    worst_ratio: Worst | None


def judge_paths(paths: Sequence[BeadPath], limits: Limits, max_speed: Array) -> Judgement:
    """Return the margins of planned beads to limits, condition and joint speeds.

    Parameters
    ----------
    paths : sequence of BeadPath
        The paths, without rapids.
    limits : Limits
        The limits.
    max_speed : (axes,) array
        Maximum axis speeds, rad/s or mm/s.

    Returns
    -------
    Judgement
        Margins at all points, and worst values.
    """
    joints = np.concatenate([path.joints for path in paths])
    layer = np.repeat([path.layer for path in paths], [len(path.joints) for path in paths])
    reached = np.isfinite(joints).all(axis=1)
    shares = limits.shares(joints)
    speeds = np.concatenate([_speeds(path) for path in paths]) / max_speed
    condition = np.where(reached, np.concatenate([path.condition for path in paths]), np.nan)
    margin, ratio = shares.min(axis=1), speeds.max(axis=1)
    return Judgement(
        margin,
        condition,
        ratio,
        _worst(shares, layer, limits.labels),
        _worst(condition[:, None], layer, ("",)),
        _worst(speeds, layer, limits.labels, largest=True),
    )


def _speeds(path: BeadPath) -> Array:
    """Return the axis speeds (n, axes), rad/s or mm/s."""
    lasts = durations([path.bead])[1:, None]
    speed = np.abs(np.diff(path.joints, axis=0)) / np.maximum(lasts, 1e-12)
    return np.concatenate([speed[:1], speed])


def _worst(
    values: Array, layer: Integers, labels: Sequence[str], largest: bool = False
) -> Worst | None:
    """Return the worst entry of values (T, k) with k labels."""
    if not np.isfinite(values).any():
        return None
    row, what = np.unravel_index(
        np.nanargmax(values) if largest else np.nanargmin(values), values.shape
    )
    return Worst(float(values[row, what]), int(layer[row]), labels[int(what)])
