# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of a nozzle that stands on the end of a bead touches deposit there, whatever way leads off it or onto it."""

from __future__ import annotations

import numpy as np

from .frustum import Array, Index
from .nozzle import exempt_height, travelling
from .obstacles import Obstacles
from .tolerances import CHORD

HALVINGS = 6  # of a nozzle's length: to a hundredth of it


def standing_heights(
    deposit: Obstacles, radius: float, slope: float, length: float, tip: Array, axis: Array, height: Array, moment: Index
) -> Array:
    """(k,) mm over the tips (k, 3) on points of beads, below which nozzles along unit axes (k, 3) are not looked at there.

    The tip stands in the bead of the height (k,) mm whose end it is: up to that height deposit is about it rightly. Where
    more of the nozzle is in the deposit that is there before the moment (k,) - a nozzle that leans over its own bead, or a
    job that asks for no clearance - it is as much as that: no way off the point avoids it, and what it touches while
    depositing is looked at elsewhere. Withdrawn by d along its axis a cone stays within the room it had above that height;
    so on the way it is this height less d. CHORD more is left out, as of all of a nozzle on rapids.
    """
    least = np.array([exempt_height(radius, slope, float(each)) for each in np.unique(height)])
    found = np.minimum(least[np.searchsorted(np.unique(height), height)], length)
    rows = np.flatnonzero(deposit.touched(travelling(radius, slope, length, found).deposit, tip, axis, moment))
    low, high = found[rows], np.full(len(rows), length)
    for _ in range(HALVINGS if len(rows) else 0):
        middle = 0.5 * (low + high)
        nozzle = travelling(radius, slope, length, middle).deposit
        touched = deposit.touched(nozzle, tip[rows], axis[rows], moment[rows])
        low, high = np.where(touched, middle, low), np.where(touched, high, middle)
    found[rows] = high
    return np.minimum(found + CHORD, length)
