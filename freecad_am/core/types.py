# SPDX-License-Identifier: LGPL-2.1-or-later
"""Array types used throughout the package.

numpy.typing is imported only for type checking, because it takes as long to import as thirty of our
modules.
"""

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
