# SPDX-License-Identifier: LGPL-2.1-or-later
"""The chord error of a feature that names none: finer than anyone sees, and no finer than its size and bead need."""

from __future__ import annotations

import math

LEAST = 0.01  # mm, of parts up to SMALL and of those whose size is not known
SMALL = 250.0  # mm
GROWTH = 2e-4  # mm to a mm of size beyond SMALL
SHARE = 0.01  # of the width of a bead
BEAD_TO_LAYER = 2.5  # how much wider than high a bead usually is


class DefaultLength(float):
    """A length in mm that nobody has given: the default of a parameter that depends on the part."""


def scaled(extent: float, bead: float) -> float:
    """The chord error, mm, of a part that is `extent` mm long, laid in beads `bead` mm wide.

    It is `LEAST` up to `SMALL`, grows with the part beyond, stays below `SHARE` of the bead, and has one digit.
    """
    wanted = min(LEAST + GROWTH * (extent - SMALL), SHARE * bead)
    if not LEAST < wanted < math.inf:
        return LEAST
    return max(float(f"{wanted:.0e}"), LEAST)
