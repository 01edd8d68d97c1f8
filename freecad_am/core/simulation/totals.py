# SPDX-License-Identifier: LGPL-2.1-or-later
"""Totals of a job before export: time, deposit and material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from .timeline import Timeline, fed_volume, volumes

# ---- Figures of a motion by bead class: lengths, times, speeds, schedules


def figures_by_class(motion: Motion, process: ProcessParameters) -> list[dict[str, Any]]:
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


MM3_PER_CM3 = 1000.0


@dataclass(frozen=True)
class Totals:
    """Totals of a job: times, s; length, mm; bead volume, mm^3, and its mass, g.

    fed: mm^3 of wire, None if its speed is unknown. Waits are the intended standstills of the
    machine, lead times included.
    """

    time: float
    deposit_time: float
    rapid_time: float
    wait_time: float
    length: float
    rapid_length: float
    volume: float
    mass: float
    fed: float | None


def totals(
    motion: Motion, times: Timeline, process: ProcessParameters, toolpath: Toolpath
) -> Totals:
    """The totals of a motion: the volume by `deposit.volumes`, the mass by `process.density`."""
    length = np.concatenate([[0.0], np.linalg.norm(np.diff(motion.position, axis=0), axis=1)])[
        : len(motion)
    ]
    deposits = motion.deposit & motion.moves
    volume = float(volumes(motion, process, toolpath).sum())
    steps = np.nan_to_num(motion.duration)
    return Totals(
        time=times.total,
        deposit_time=float(steps[deposits].sum()),
        rapid_time=float(steps[~deposits].sum()),
        wait_time=float(times.waits.sum()),
        length=float(length[deposits].sum()),
        rapid_length=float(np.nan_to_num(length)[~deposits].sum()),
        volume=volume,
        mass=volume / MM3_PER_CM3 * process.density,
        fed=fed_volume(motion, process, toolpath),
    )


def as_dict(sums: Totals) -> dict[str, float | None]:
    """The totals in the form of report.json."""
    return {
        "time_s": sums.time,
        "deposit_s": sums.deposit_time,
        "rapid_s": sums.rapid_time,
        "wait_s": sums.wait_time,
        "deposit_mm": sums.length,
        "rapid_mm": sums.rapid_length,
        "volume_cm3": sums.volume / MM3_PER_CM3,
        "mass_g": sums.mass,
        "fed_cm3": None if sums.fed is None else sums.fed / MM3_PER_CM3,
    }
