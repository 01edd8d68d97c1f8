# SPDX-License-Identifier: LGPL-2.1-or-later
"""Frames of a simulation at 10,000, 100,000 and 300,000 points, in FreeCAD's window under Xvfb.

A frame of ours moves machine, part and nozzle, grows the deposit, tells all figures, and is drawn. Peer: the same
scene at rest, drawn again. Means over frames in the same window, one kind after the other.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import Row

ROOT = Path(__file__).resolve().parent.parent
SCRIPT = Path(__file__).resolve().parent / "simulation_frames.py"
LONGEST = 300  # s
# a frame draws the deposit from another side than the one before, which the peer does not
REQUIRED = 0.4


def run() -> list[Row]:
    """A comparison for every number of points."""
    sys.path.insert(0, str(ROOT))
    from tests.run import SCREEN, private_home

    freecad = shutil.which("freecad") or shutil.which("FreeCAD")
    if not freecad or not shutil.which("xvfb-run"):
        print("bench: no freecad or no xvfb-run: frames are not measured", file=sys.stderr)
        return []
    with tempfile.TemporaryDirectory() as folder:
        told = Path(folder) / "frames.json"
        env = {**private_home(Path(folder)), "FRAMES_TO": str(told), "FRAMES_OF": str(ROOT)}
        for name in ("VIRTUAL_ENV", "BENCH_INSIDE"):
            env.pop(name, None)
        window = ["xvfb-run", "-a", "-s", SCREEN, "timeout", "-k", "5", str(LONGEST)]
        done = subprocess.run([*window, freecad, str(SCRIPT)], env=env, stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, check=False)
        if not told.is_file():
            print(done.stderr[-2000:], file=sys.stderr)
            raise AssertionError("no frames were measured")
        measured = json.loads(told.read_text(encoding="utf-8"))
    return [
        Row(f"frame of a simulation, {one['points']:,} points (longest {one['longest']:.1f}); the scene drawn again",
            one["ours"], one["peer"], "ms", REQUIRED)
        for one in measured
    ]
