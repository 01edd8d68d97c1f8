# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads against the travel speeds of their material."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...issues import WARNING, InputError, Issue, Text, Word
from ...parameters.process import ProcessParameters
from ...toolpath import Toolpath

CODE = "MATERIAL_SPEED"
ROUNDING = 1e-6  # of a speed


def check_speeds(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """The toolpath with a warning at the worst bead whose travel speed is outside the range of its material.

    InputError BAD_VALUE for a slowest speed above the fastest.
    """
    slowest, fastest = process.material.slowest or 0.0, process.material.fastest
    if fastest is not None and slowest > fastest:
        raise InputError(
            "BAD_VALUE",
            "process.material.slowest",
            "{:g} mm/s is more than the fastest, {:g} mm/s; give the slower speed here",
            slowest,
            fastest,
        )
    if not slowest and fastest is None:
        return toolpath
    worst, where, speed_range = 1.0 + ROUNDING, (0, 0), [float("inf"), 0.0]
    for layer, number, bead in toolpath:
        at_ends = [speed for speed in bead.ends[1:4:2] if speed]
        low, high = (
            float(min(bead.speed[1:].min(), *at_ends, np.inf)),
            float(max(bead.speed[1:].max(), *at_ends, 0.0)),
        )
        speed_range = [min(speed_range[0], low), max(speed_range[1], high)]
        off = max(slowest / low, 0.0 if fastest is None else high / fastest)
        if off > worst:
            worst, where = off, (layer, number)
    if worst <= 1.0 + ROUNDING:
        return toolpath
    bounds = (
        Text("at {:.4g} mm/s or more", slowest)
        if fastest is None
        else Text("at {:.4g} to {:.4g} mm/s", slowest, fastest)
    )
    return replace(
        toolpath,
        issues=(
            *toolpath.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the travel speed of beads is {:.4g} to {:.4g} mm/s, but {} {}; change "
                    "process.travel_speed, process.bead_width or process.classes, or measure "
                    "beads at these speeds",
                    speed_range[0],
                    speed_range[1],
                    process.material.name or "the material",
                    Word(bounds),
                ),
                *where,
            ),
        ),
    )
