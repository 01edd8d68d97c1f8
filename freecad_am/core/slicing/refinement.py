# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters at which the arcs of a curve must be halved to follow the exact curve."""

from __future__ import annotations

from ..geometry.curves.space_curve import SpaceCurve
from ..types import Array

TOLERANCE_MM = 1e-5  # mm; a tenth of the tolerance at the points; it bounds interpolation_error
MIN_ARC_SHARE = 1e-5  # of the period; no arc is halved below this
ROUNDS = 14


def finer_grid(curve: SpaceCurve, within: float = TOLERANCE_MM) -> Array:
    """Parameters in the middle of the arcs that are off by more than `within` mm."""
    coarse = (curve.interpolation_error() > within) & (curve.span > MIN_ARC_SHARE * curve.period)
    middle: Array = curve.w[:-1][coarse] + 0.5 * curve.span[coarse]
    return middle
