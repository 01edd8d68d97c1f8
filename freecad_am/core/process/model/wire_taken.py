# SPDX-License-Identifier: LGPL-2.1-or-later
"""Wire rate that beads take, by class, start and end, and the beads fed by a schedule of their own."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...motion import AT_END, AT_START, MIDDLE
from ...parameters.process import ProcessParameters
from ...parameters.ramp import ramp
from ...toolpath import Bead, Toolpath
from ...types import Array

_KEYS = {MIDDLE: "", AT_START: ".start", AT_END: ".end"}


class Taken(NamedTuple):
    """Wire rate, mm3/s, that beads of a class take in one of PHASES, with layer and bead of the first occurrence. section: mean mm2."""

    bead_class: str
    phase: int
    rate: float
    layer: int
    bead: int
    section: float

    @property
    def name(self) -> str:
        """By the keys of a job: contour, contour.start, contour.end."""
        return f"{self.bead_class or 'all'}{_KEYS[self.phase]}"


def by_wire(taken: Taken, process: ProcessParameters) -> bool:
    """Whether process.wire feeds beads of a class in this phase: no other schedule does."""
    class_process = process.for_class(taken.bead_class)
    phase = {AT_START: class_process.start, AT_END: class_process.end}.get(taken.phase)
    schedule = class_process.schedule if phase is None or phase.schedule is None else phase.schedule
    return schedule == process.schedule


def by_schedules(toolpath: Toolpath, process: ProcessParameters) -> list[str]:
    """The keys of the beads fed by a schedule of their own, whose feed is not known here."""
    return [taken.name for taken in taken_of(toolpath) if not by_wire(taken, process)]


def off_most(toolpath: Toolpath, process: ProcessParameters) -> tuple[float, int, int] | None:
    """The largest relative deviation of wire feed from bead volume over classes and phases, with its layer and bead.

    None if nothing is known. Beads fed by a schedule of their own do not count.
    """
    wire_rate = (toolpath.wire_feed or 0.0) * process.wire.section
    by_wire_ = [taken for taken in taken_of(toolpath) if by_wire(taken, process)]
    if not by_wire_ or wire_rate == 0.0:
        return None
    follows = follows_speed(toolpath)  # mm3 per mm
    return max(
        (
            (
                abs(
                    (
                        wire_rate / process.travel_speed / taken.section
                        if follows
                        else wire_rate / taken.rate
                    )
                    - 1.0
                ),
                taken.layer,
                taken.bead,
            )
            for taken in by_wire_
        ),
        key=lambda deviation: deviation[0],
    )


def follows_speed(toolpath: Toolpath) -> bool:
    """Whether the wire follows the travel speed along a bead."""
    return any(bead.wire_share is not None for _, _, bead in toolpath)


def taken_of(toolpath: Toolpath) -> list[Taken]:
    """The rates that beads take, by class and phase, from their width, height and speed, in the order of deposit; empty if the width is not known."""
    if toolpath.bead_width is None:
        return []
    sums: dict[tuple[str, int], Array] = {}
    first_bead: dict[tuple[str, int], tuple[int, int]] = {}
    for layer, number, bead in toolpath:
        for phase, sum_ in _sums(
            bead, toolpath.bead_width * toolpath.layer_height, toolpath
        ).items():
            key = bead.bead_class, phase
            sums[key] = sums.get(key, np.zeros(3)) + sum_
            first_bead.setdefault(key, (layer, number))
    return [
        Taken(*key, float(volume / time), *first_bead[key], float(volume / length))
        for key, (volume, time, length) in sums.items()
        if time > 0.0
    ]


def _sums(bead: Bead, usual: float, toolpath: Toolpath) -> dict[int, Array]:
    """mm3, s and mm (3,) of a bead, by phase; before joints are planned from the lengths of its phases."""
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    section: Array | float = usual
    if bead.width is not None or bead.height is not None:
        high = toolpath.layer_height if bead.height is None else bead.height
        area = high * (
            np.full(len(bead), toolpath.bead_width) if bead.width is None else bead.width
        )
        section = 0.5 * (area[1:] + area[:-1])
    amounts = np.stack([section * length, length / bead.speed[1:], length])
    if bead.phase is not None:
        return {
            phase: amounts[:, bead.phase[1:] == phase].sum(axis=1)
            for phase in sorted(set(bead.phase[1:].astype(int)))
        }
    total = amounts.sum(axis=1)
    if not bead.ends:
        return {MIDDLE: total}
    start_length, slow, end_length, late = bead.ends[:4]
    sums, size = {MIDDLE: total * (1.0 - (start_length + end_length) / length.sum())}, length.sum()
    for long, (from_speed, to_speed) in zip(
        bead.ends[4:], ((slow, float(bead.speed[1])), (float(bead.speed[-1]), late))
    ):
        steps = ramp(long, from_speed, to_speed)
        if len(steps):
            sums[MIDDLE] = sums[MIDDLE] + [
                0.0,
                float((long / len(steps) / steps).sum()) - total[1] * long / size,
                0.0,
            ]
    for phase, long, speed in ((AT_START, start_length, slow), (AT_END, end_length, late)):
        if long:
            sums[phase] = np.array(
                [total[0] * long / size, long / speed if speed else total[1] * long / size, long]
            )
    return sums
