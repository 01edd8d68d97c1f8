# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where the arcs of a curve must be halved so that they follow the curve they stand for."""

from __future__ import annotations

from ..geometry.curves.space_curve import SpaceCurve
from ..types import Array

WITHIN = (
    1e-5  # mm; a tenth of the tolerance at the points, see interpolation_error for what it bounds
)
SHORTEST = 1e-5  # of the period; no arc is halved below this
ROUNDS = 14


def finer_grid(curve: SpaceCurve, within: float = WITHIN) -> Array:
    """Parameters in the middle of the arcs that are off by more than `within` mm."""
    coarse = (curve.interpolation_error() > within) & (curve.span > SHORTEST * curve.period)
    middle: Array = curve.w[:-1][coarse] + 0.5 * curve.span[coarse]
    return middle
