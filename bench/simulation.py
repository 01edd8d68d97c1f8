# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames of a simulation at 10,000, 100,000 and 300,000 points, in FreeCAD's window under Xvfb. Our
frame moves machine, part and nozzle, grows the deposit, updates all figures and is drawn. Peer: the
drawing only, the same scene after a small turn of the camera. Figures are medians of processor time
in the same window, a frame of each in turns; the benchmark checks that every frame is drawn. The
longest frame of ours is by the clock."""

from __future__ import annotations

from pathlib import Path

import in_window
from rows import Row

SCRIPT = Path(__file__).resolve().parent / "simulation_frames.py"
TIME_LIMIT_S = 300  # s
REQUIRED = 0.7  # share of a frame that the drawing takes


def run() -> list[Row]:
    """Return a comparison for every number of points."""
    return [
        Row(
            f"frame of a simulation, {result['points']:,} points (longest {result['longest']:.0f} ms by the clock); the same "
            "scene drawn again, the camera turned",
            result["ours"],
            result["peer"],
            "ms",
            REQUIRED,
        )
        for result in in_window.run_script(SCRIPT, TIME_LIMIT_S)
    ]
