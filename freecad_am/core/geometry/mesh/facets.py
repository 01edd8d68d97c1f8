# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which way triangles face, and how large they are."""

from __future__ import annotations

import numpy as np

from ...types import Array


def doubled_areas(corners: Array) -> Array:
    """Vectors (n, 3) normal to triangles with these corners (n, 3, 3), counter-clockwise as seen from outside, and twice as
    long as their areas are large."""
    one, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    found: Array = np.cross(one, other)
    return found
