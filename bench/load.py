# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a point costs of a long job, from its STEP file to the report: processor time, and memory at the peak.

The hemisphere in fine layers, as a job of a process of its own beside one of few points: what both need, FreeCAD and
imports, drops out. There is no peer; what may be used per point stands in its place, on a quiet machine. A million points
with LOAD_POINTS=1e6.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from pace import Watch
from rows import Row
from sizes import choose

ROOT = Path(__file__).resolve().parent.parent
EXAMPLE = ROOT / "resources" / "examples" / "hemisphere.step"
ALLOWED_US, ALLOWED_KB = 50.0, 1.5
JOB = """version: 1
name: load
part: {{file: {step}}}
strategy: {{kind: revolution, layer_height: {height} mm, chord_error: {chord} mm}}
cell: {{machine: fanuc-arcmate120ic, limits: paper, deposition_point: [1045.747, -630.155, 653.167, 0, 0, 0],
       platform: 5 mm, branch: [front, up, flip]}}
process: {{travel_speed: 1.5 mm/s}}
program: {{post: fanuc}}
"""
ROUNDS = choose(3, 1)  # of both jobs in turns, of which the median counts
# points there are about so many: layer height and chord error in mm
SMALL = choose((1.0, 0.0004), (20.0, 0.5))
SIZES = {1e4: (10.0, 0.2), 1e5: (0.5, 0.00025), 1e6: (0.1, 0.00006)}


def run() -> list[Row]:
    """Two comparisons, of the larger of two jobs."""
    wanted = float(os.environ.get("LOAD_POINTS", choose("1e5", "1e4")))
    with tempfile.TemporaryDirectory() as folder, Watch() as watch:
        done = [
            [_planned(Path(folder), *size) for size in (SMALL, SIZES[wanted])]
            for _ in range(ROUNDS)
        ]
    small, large = ([median(one[k] for one in some) for k in range(3)] for some in zip(*done))
    points, seconds, memory = (after - before for before, after in zip(small, large))
    each, name = (
        1e6 * seconds / points,
        f"a point of {large[0]:.0f}, STEP to program, report and FCStd; what it may take",
    )
    told = f"processor time of {name} ({each:.1f} us used, the fixed piece of work in {watch.pace:.2f} ms)"
    return [
        Row(told, watch.quiet(each), ALLOWED_US, "us", 1.0),
        Row(f"memory at the peak of {name}", 1e-3 * memory / points, ALLOWED_KB, "kB", 1.0),
    ]


def _planned(folder: Path, height: float, chord: float) -> tuple[float, float, float]:
    """Points of a job, processor time in s, memory at the peak in bytes."""
    (folder / "load.yaml").write_text(
        JOB.format(step=EXAMPLE, height=height, chord=chord), encoding="utf-8"
    )
    command = [
        str(ROOT / "freecad-am"),
        "plan",
        str(folder / "load.yaml"),
        "-o",
        str(folder / "out"),
        "--no-page",
    ]
    environment = {
        key: value
        for key, value in os.environ.items()
        if key not in ("BENCH_INSIDE", "VIRTUAL_ENV")
    }
    process = subprocess.Popen(
        command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, env=environment
    )
    _, status, used = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status):
        assert process.stderr is not None
        print(process.stderr.read().decode(errors="replace"), file=sys.stderr)
        raise RuntimeError(f"{' '.join(command)} failed")
    with open(folder / "out" / "waypoints.csv", "rb") as rows:
        points = sum(1 for _ in rows) - 1
    return points, used.ru_utime + used.ru_stime, 1024.0 * used.ru_maxrss
