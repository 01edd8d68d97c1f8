# SPDX-License-Identifier: LGPL-2.1-or-later
"""Totals of a job before export: time, deposit and material."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..motion import Motion
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from .timeline import Timeline, fed_volume, volumes

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
