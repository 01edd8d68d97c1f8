# SPDX-License-Identifier: LGPL-2.1-or-later
"""What planes have in common as layers, whichever way they lie."""

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

    def turned(self, azimuth: float) -> float:
        """It lies one way alone."""
        return 0.0

    def pieces(self, flat: Array, chord_error: float) -> Index:
        """Chords are where they were."""
        return np.ones(len(flat) - 1, dtype=np.intp)
