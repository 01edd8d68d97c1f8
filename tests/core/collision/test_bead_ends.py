# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ends of beads are computed once for the same beads and nozzle, and again for any others."""

import numpy as np

from freecad_am.core.collision import bead_ends
from freecad_am.core.collision.bead_ends import BeadEnds, Beads, Size

SIZE = Size(0.5, 0.3, 40.0)


def _beads(count: int = 30, rise: float = 0.0) -> Beads:
    along = np.linspace(0.0, 20.0, count)
    points = np.stack([along, np.zeros(count), rise * along], axis=1)
    up = np.tile([0.0, 0.0, 1.0], (count, 1))
    return Beads(points, up, up, np.full(count, 3.0), np.ones(count), np.arange(count) == 0)


def test_same_numbers_are_worked_out_once():
    assert BeadEnds.of(_beads(), SIZE) is BeadEnds.of(_beads(), SIZE)


def test_other_beads_or_another_nozzle_are_not():
    """A cached result of other beads or another nozzle must not be reused."""
    ends = BeadEnds.of(_beads(), SIZE)
    assert BeadEnds.of(_beads(rise=0.1), SIZE) is not ends
    assert BeadEnds.of(_beads(), SIZE._replace(slope=0.4)) is not ends


def test_long_ones_are_not_kept(monkeypatch):
    """Long beads are not cached, so that the cache stays small."""
    monkeypatch.setattr(bead_ends, "REMEMBERED", 29)
    assert BeadEnds.of(_beads(), SIZE) is not BeadEnds.of(_beads(), SIZE)
