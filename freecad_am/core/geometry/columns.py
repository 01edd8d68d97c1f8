# SPDX-License-Identifier: LGPL-2.1-or-later
"""Components of vectors as arrays of their own.

A column of an (n, 3) array ends past that array. Where the next thing in memory is the result, numpy takes the two to
overlap, and goes on with a sine or an arc tangent that is another in the last bit. So what is given to such a function
must lie in one piece: the same job then has the same bytes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def columns(vectors: Array) -> Array:
    """(k, ...) the components of vectors (..., k), each in one piece."""
    return np.ascontiguousarray(np.moveaxis(vectors, -1, 0))
