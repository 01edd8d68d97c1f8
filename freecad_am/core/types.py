# SPDX-License-Identifier: LGPL-2.1-or-later
"""The names of array types that all of the package uses. numpy.typing is for those who check types: to load it takes a
process as long as thirty modules of ours."""

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike as ArrayLike
    from numpy.typing import NDArray as NDArray
else:
    ArrayLike, NDArray = Any, np.ndarray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.intp]
Integers = NDArray[np.int64]
