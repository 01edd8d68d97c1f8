# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames of a simulation at 10,000, 100,000 and 300,000 points, in FreeCAD's window under Xvfb.

A frame of ours moves machine, part and nozzle, grows the deposit, tells all figures, and is drawn. Peer: the same
scene at rest, drawn again. Means over frames in the same window, one kind after the other.
"""

from __future__ import annotations

from pathlib import Path

import in_window
from rows import Row

SCRIPT = Path(__file__).resolve().parent / "simulation_frames.py"
LONGEST = 300  # s
# a frame draws the deposit from another side than the one before, which the peer does not
REQUIRED = 0.4


def run() -> list[Row]:
    """A comparison for every number of points."""
    return [
        Row(f"frame of a simulation, {one['points']:,} points (longest {one['longest']:.1f}); the scene drawn again",
            one["ours"], one["peer"], "ms", REQUIRED)
        for one in in_window.found_by(SCRIPT, LONGEST)
    ]
