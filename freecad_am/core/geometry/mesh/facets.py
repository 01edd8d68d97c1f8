# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which way triangles face, and how large they are."""

from __future__ import annotations

import numpy as np

from ...types import Array


def doubled_areas(corners: Array) -> Array:
    """Return outward vectors (n, 3) normal to triangles (n, 3, 3), each as long as twice the
    area of its triangle.

    Corners are counter-clockwise seen from outside.
    """
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normals: Array = np.cross(a, b)
    return normals
