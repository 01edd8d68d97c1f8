# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of a motion by bead class: lengths, times, speeds, schedules."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..parameters.process import ProcessParameters


def figures(motion: Motion, process: ProcessParameters) -> list[dict[str, Any]]:
    """For each bead class of the motion, in the usual order: number of beads, mm and s of deposit
    without lead times, minimum and maximum mm/s, its schedule, and its weave if any class has one.
    Empty for motions from before bead classes.
    """
    class_rows: list[dict[str, Any]] = []
    step_lengths = np.linalg.norm(
        np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1
    )
    for number, name in enumerate(CLASSES):
        in_class = motion.deposit & (motion.bead_class == number)
        rows = in_class & motion.moves
        if not rows.any():
            continue
        beads = motion.layer[in_class] * (1 + motion.bead[in_class].max()) + motion.bead[in_class]
        class_rows.append(
            {
                "class": name,
                "beads": len(np.unique(beads)),
                "length_mm": float(step_lengths[rows].sum()),
                "deposit_s": float(np.nan_to_num(motion.duration)[rows].sum()),
                "travel_speed_mm_s": {
                    "min": float(motion.speed[rows].min()),
                    "max": float(motion.speed[rows].max()),
                },
                "schedule": process.for_class(name).schedule,
                **({"weave": process.for_class(name).weave or None} if process.weaves else {}),
            }
        )
    return class_rows
