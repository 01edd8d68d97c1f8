# SPDX-License-Identifier: LGPL-2.1-or-later
"""A macro that plans a vase on a KUKA with optimised joints: linear algebra with one thread per
processor against one thread. The figures are processor times of separate processes in turns,
because waking threads costs time too."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from statistics import median

from rows import Row
from sizes import choose

ROOT = Path(__file__).resolve().parent.parent
ROUNDS, LAYER_HEIGHT, CHORD_ERROR = choose((5, 10, 0.01), (1, 60, 0.5))
MACRO = f"""import os, sys, time
sys.path.insert(0, {str(ROOT)!r})
from freecad_am.batch import host
host.find_freecad()
import numpy
import FreeCAD, Part
import freecad_am.api as am
from freecad_am.core.kinematics.proposed_cell import cell_of
curve = Part.BSplineCurve()
curve.interpolate([FreeCAD.Vector(x, 0, z) for x, z in ((40, 0), (62, 40), (66, 80), (38, 130), (34, 155), (55, 180))])
doc = FreeCAD.newDocument()
part = doc.addObject("Part::Feature", "Vase")
part.Shape = curve.toShape().revolve(FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(0, 0, 1), 360)
cell = am.make_cell(doc, parameters=cell_of("kuka-kr16-2"))
toolpath = am.make_toolpath(doc, am.make_feature(doc, part, layer_height={LAYER_HEIGHT}, chord_error={CHORD_ERROR}), cell)
started = time.process_time()
am.make_joint_path(doc, toolpath, cell)
print(time.process_time() - started)
sys.stdout.flush()
os._exit(0)
"""


def run() -> list[Row]:
    """Compare both numbers of threads."""
    rounds = [(time_macro({}), time_macro({"OPENBLAS_NUM_THREADS": "1"})) for _ in range(ROUNDS)]
    all_threads, one_thread = (median(times) for times in zip(*rounds))
    name = f"joints of a vase in {os.cpu_count()} threads of the linear algebra, against one"
    return [Row(name, all_threads, one_thread, "s", 0.9)]


def time_macro(extra_environment: dict[str, str]) -> float:
    """Processor time (s) of the joint path; only `more` sets a number of threads."""
    environment = {
        key: value for key, value in os.environ.items() if not key.endswith("_NUM_THREADS")
    }
    process = subprocess.run(
        [sys.executable, "-c", MACRO],
        capture_output=True,
        text=True,
        check=True,
        env={**environment, **extra_environment},
    )
    return float(process.stdout.split()[-1])
