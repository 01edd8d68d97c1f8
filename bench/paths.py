# SPDX-License-Identifier: LGPL-2.1-or-later
"""The view of a path at 10,000, 100,000 and 300,000 points, and opening a saved job of 100,000
points. It runs in FreeCAD's window under Xvfb, drawn by the processor (llvmpipe). Peer of the
frames: a plain Coin SoLineSet of the same points and colours in the same window, in turns; a frame
lasts from turning the camera or moving the slider until it is drawn. Peer of opening until the path
is drawn: the same document without results, in turns. The shapes are a cylinder with identical
layers and a dome without repetition."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import in_window
from rows import Row
from sizes import choose

ROOT = Path(__file__).resolve().parent.parent
SCRIPT = Path(__file__).resolve().parent / "path_frames.py"
TIME_LIMIT_S = 600  # s
OPENING_RATIO = 0.5  # time to open without results, as a share of the time with results
# our frame includes the legend; tubes have some hundred thousand triangles
REQUIRED = {"lines": 0.6, "slider": 0.5, "tubes": 0.12, "slider, tubes": 0.12}
JOB = """import sys
sys.path.insert(0, {root!r})
from freecad_am.batch import host
host.find_freecad()
import FreeCAD as App, Part
from freecad_am import api
document = App.newDocument("Job")
part = document.addObject("Part::Feature", "Part")
part.Shape = {shape}
cell = api.make_cell(document)
toolpath = api.make_toolpath(document, api.make_feature(document, part, layer_height={layer_height}, min_points={points}), cell)
joint_path = api.make_joint_path(document, toolpath, cell, method="constant")
if joint_path.Status == "up to date":
    api.make_program(document, joint_path)
document.saveAs({saved!r})
"""
LAYER_HEIGHT, POINTS_OF_A_TURN = choose((1.0, 1420), (15.0, 60))
# the dome exceeds a limit at some points but still has a joint path
SHAPES = {
    "cylinder": "Part.makeCylinder(45, 70)",
    "dome": "Part.makeSphere(45, App.Vector(), App.Vector(0, 0, 1), 0, 90)",
}


def run() -> list[Row]:
    """Return frames for every number of points, then openings."""
    freecad = in_window.find_freecad()
    if freecad is None:
        return []
    with tempfile.TemporaryDirectory() as folder:
        plain = {
            key: value
            for key, value in os.environ.items()
            if key not in ("BENCH_INSIDE", "VIRTUAL_ENV")
        }
        jobs = {name: str(Path(folder) / f"{name}.FCStd") for name in SHAPES}
        for name, saved in jobs.items():
            subprocess.run(
                [
                    sys.executable,
                    "-c",
                    JOB.format(
                        root=str(ROOT),
                        saved=saved,
                        shape=SHAPES[name],
                        layer_height=LAYER_HEIGHT,
                        points=POINTS_OF_A_TURN,
                    ),
                ],
                check=True,
                env=plain,
                stdin=subprocess.DEVNULL,
            )
        results = in_window.measure_in_window(
            freecad, SCRIPT, Path(folder), TIME_LIMIT_S, FRAMES_JOBS=json.dumps(jobs)
        )
    rows = [
        Row(
            f"frame of {frame['points']:,} points, {frame['what']}; one SoLineSet",
            frame["ours"],
            frame["peer"],
            "ms",
            REQUIRED[frame["what"]],
        )
        for frame in results["frames"]
    ]
    for name, took in results["openings"].items():
        what = f"opening a {name} of {took['points']:,} points until its path is drawn; the same without results"
        rows.append(Row(what, took["with"], took["without"], "s", OPENING_RATIO))
    return rows
