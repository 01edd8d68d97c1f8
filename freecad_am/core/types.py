# SPDX-License-Identifier: LGPL-2.1-or-later
"""The names of array types that all of the package uses."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Index = NDArray[np.intp]
