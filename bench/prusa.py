# SPDX-License-Identifier: LGPL-2.1-or-later
"""PrusaSlicer, the peer of `bench infill`: Debian's package, its settings, and a reader of its G-code.

The settings give it the job that we get, and the form of beads that the judge draws:

- PrusaSlicer counts a bead as a rectangle with half circles at its sides, so that neighbours lie `width - (1 - pi / 4) height`
  apart, which is also volume / length / height. The extrusion width is chosen to make that the nominal width.
- It leaves half the difference bare at a border, for the bulge of its half circles. `xy_size_compensation` takes that back.
- `infill_overlap` is 10 % of the bead: with 0 it omits infill as narrow as one bead, and the usual 25 % deposits more twice.
- Every layer is an inner one: no skirt, brim, support, top, bottom or bridge, and one width everywhere.
"""

from __future__ import annotations

import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from statistics import median
from typing import NamedTuple

import numpy as np

from infill_judge import Stroke

COMMAND, PACKAGE = "prusa-slicer", "prusa-slicer"
BED = 500.0  # mm from the middle of the bed, its origin, to its sides
CONTOURS_ONLY = 99  # perimeters
ROUNDS = 3  # of slicing and start-up in turns; the median counts
WALLS = 2  # perimeters around zigzags
WIDTHS = (
    "",
    "external_perimeter_",
    "perimeter_",
    "infill_",
    "solid_infill_",
    "top_infill_",
    "first_layer_",
)
MOVE = re.compile(r"G[01] ")
WORD = re.compile(r"([XYZE])(-?[0-9.]+)")


class Sliced(NamedTuple):
    """Strokes of each layer by number from 0, the number of points, and the processor time (s)
    without start-up."""

    layers: dict[int, list[Stroke]]
    points: int
    seconds: float


def is_there() -> bool:
    """Return whether PrusaSlicer can be called; installs it if the machine allows that."""
    if shutil.which(COMMAND) is None and shutil.which("apt-get") and os.geteuid() == 0:
        print(f"bench: installing {PACKAGE}", file=sys.stderr)
        subprocess.run(
            ["apt-get", "install", "-y", "--no-install-recommends", PACKAGE],
            check=False,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
    if shutil.which(COMMAND) is None:
        print("bench: PrusaSlicer could not be installed; its figures go without", file=sys.stderr)
        return False
    return True


def slice_mesh(
    mesh: Path,
    fill: str,
    width: float,
    height: float,
    chord_error: float,
    narrowest: float,
) -> Sliced:
    """Slice an STL file.

    Parameters
    ----------
    fill
        'contours', or 'zigzag' within two of them.
    width, height, chord_error
        mm, of beads, of layers and of the points in the file.
    narrowest
        Share of the width that beads have at least.
    """
    settings, program = mesh.with_suffix(".ini"), mesh.with_suffix(".gcode")
    lines = prusa_settings(fill, width, height, chord_error, narrowest).items()
    settings.write_text("".join(f"{key} = {value}\n" for key, value in lines), encoding="utf-8")
    options = ["--load", settings, "--dont-arrange", "-o", program]
    seconds = median(
        _processor_time([COMMAND, "--export-gcode", mesh, *options])
        - _processor_time([COMMAND, "--help"])
        for _ in range(ROUNDS)
    )
    layers, points = read_program(program.read_text(encoding="utf-8"), height)
    return Sliced(layers, points, seconds)


def prusa_settings(
    fill: str, width: float, height: float, chord_error: float, narrowest: float
) -> dict[str, object]:
    """Return the settings for beads with an effective width (mm); see the head of this file."""
    bulge = (1.0 - 0.25 * math.pi) * height
    return {
        "printer_technology": "FFF",
        "bed_shape": f"-{BED:g}x-{BED:g},{BED:g}x-{BED:g},{BED:g}x{BED:g},-{BED:g}x{BED:g}",
        "nozzle_diameter": width,
        "layer_height": height,
        "first_layer_height": height,
        "max_layer_height": width,
        **{f"{key}extrusion_width": width + bulge for key in WIDTHS},
        "xy_size_compensation": 0.5 * bulge,
        "elefant_foot_compensation": 0,
        "perimeter_generator": "arachne",
        "perimeters": CONTOURS_ONLY if fill == "contours" else WALLS,
        "min_bead_width": f"{100.0 * narrowest:g}%",
        "min_feature_size": f"{100.0 * narrowest:g}%",
        "fill_density": "100%",
        "fill_pattern": "rectilinear",
        "top_fill_pattern": "rectilinear",
        "bottom_fill_pattern": "rectilinear",
        "fill_angle": 0,
        "infill_overlap": "10%",
        "top_solid_layers": 0,
        "bottom_solid_layers": 0,
        "overhangs": 0,
        "skirts": 0,
        "brim_width": 0,
        "brim_type": "no_brim",
        "retract_length": 0,
        "cooling": 0,
        "gcode_resolution": chord_error,
        "use_volumetric_e": 1,
        "start_gcode": "",
        "end_gcode": "",
    }


def read_program(text: str, height: float) -> tuple[dict[int, list[Stroke]], int]:
    """Read strokes and the number of their points from G-code with absolute coordinates and volumetric E.

    Parameters
    ----------
    height
        mm of a layer; the nozzle is that far above the base of the first one.
    """
    layers: dict[int, list[Stroke]] = {}
    position = {"X": 0.0, "Y": 0.0, "Z": 0.0, "E": 0.0}
    points: list[tuple[float, float]] = []
    volumes: list[float] = []

    def end_stroke() -> None:
        if volumes:
            vertices = np.array(points)
            lengths = np.hypot(*np.diff(vertices, axis=0).T)
            stroke = Stroke(vertices, np.array(volumes) / (height * lengths))
            layers.setdefault(round(position["Z"] / height) - 1, []).append(stroke)
        points.clear()
        volumes.clear()

    count = 0
    for line in text.splitlines():
        if line.startswith("G92"):
            position.update({key: float(value) for key, value in WORD.findall(line)})
        if not MOVE.match(line):
            continue
        words = {key: float(value) for key, value in WORD.findall(line.partition(";")[0])}
        goal = {**position, **words}
        moves = (goal["X"], goal["Y"]) != (position["X"], position["Y"])
        deposit = goal["E"] - position["E"]
        if deposit > 0.0 and moves:
            if not points:
                points.append((position["X"], position["Y"]))
                count += 1
            points.append((goal["X"], goal["Y"]))
            volumes.append(deposit)
            count += 1
        elif moves or goal["Z"] != position["Z"]:
            end_stroke()
        position = goal
    end_stroke()
    return layers, count


def _processor_time(command: list[str | Path]) -> float:
    """Processor seconds of a command in all of its threads. RuntimeError if it fails."""
    process = subprocess.Popen(
        list(map(str, command)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))} ended with status {process.returncode}")
    return used.ru_utime + used.ru_stime
