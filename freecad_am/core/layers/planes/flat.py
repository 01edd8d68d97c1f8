# SPDX-License-Identifier: LGPL-2.1-or-later
"""The common base of planes as layers, whatever their orientation."""

from __future__ import annotations

import numpy as np

from ...types import Array, Index


class Flat:
    """The part of `LayerSurface` that is the same for every plane."""

    @property
    def period(self) -> None:
        """Nothing goes round it."""
        return None

    @property
    def bends_freely(self) -> bool:
        """It does not bend."""
        return False

    def plane_rotation(self, azimuth: float) -> float:
        """Return 0: the plane has only one orientation."""
        return 0.0

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Chords are where they were."""
        return np.ones(len(flat) - 1, dtype=np.intp)
