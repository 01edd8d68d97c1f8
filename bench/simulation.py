# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames of a simulation at 10,000, 100,000 and 300,000 points, in FreeCAD's window under Xvfb.

A frame of ours moves machine, part and nozzle, grows the deposit, tells all figures, and is drawn. Peer: the picture
alone, the same scene drawn again because the camera was turned a little. Medians of the processor's time in the same
window, a frame of each in turns; every one is seen to be drawn. The longest of ours is by the clock.
"""

from __future__ import annotations

from pathlib import Path

import in_window
from rows import Row

SCRIPT = Path(__file__).resolve().parent / "simulation_frames.py"
LONGEST = 300  # s
REQUIRED = 0.7  # of a frame is the picture


def run() -> list[Row]:
    """A comparison for every number of points."""
    return [
        Row(
            f"frame of a simulation, {one['points']:,} points (longest {one['longest']:.0f} ms by the clock); the same "
            "scene drawn again, the camera turned",
            one["ours"],
            one["peer"],
            "ms",
            REQUIRED,
        )
        for one in in_window.found_by(SCRIPT, LONGEST)
    ]
