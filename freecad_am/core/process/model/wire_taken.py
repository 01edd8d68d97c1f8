# SPDX-License-Identifier: LGPL-2.1-or-later
"""What beads take of the wire, by their class, their starts and ends, and which of them a schedule of their own feeds."""

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
    """What beads of a class take of the wire, mm3/s, in one of PHASES of them, and layer and bead of the first of these.
    section: mm2 that they count in the mean."""

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


def by_wire(of: Taken, process: ProcessParameters) -> bool:
    """Whether beads of a class are fed as process.wire says there: by no other schedule than the others."""
    own = process.for_class(of.bead_class)
    phase = {AT_START: own.start, AT_END: own.end}.get(of.phase)
    schedule = own.schedule if phase is None or phase.schedule is None else phase.schedule
    return schedule == process.schedule


def by_schedules(toolpath: Toolpath, process: ProcessParameters) -> list[str]:
    """The beads that are fed as a schedule of their own says, which nobody knows here, by their keys."""
    return [one.name for one in taken_of(toolpath) if not by_wire(one, process)]


def off_most(toolpath: Toolpath, process: ProcessParameters) -> tuple[float, int, int] | None:
    """By what share the wire feeds more or less than beads take where it is farthest off, of each class and phase as a
    whole, and layer and bead there; None where nothing tells. Beads that a schedule of their own feeds do not count."""
    given = (toolpath.wire_feed or 0.0) * process.wire.section
    known = [one for one in taken_of(toolpath) if by_wire(one, process)]
    if not known or given == 0.0:
        return None
    follows = follows_speed(toolpath)  # so many mm3 to a mm
    return max(
        (
            (
                abs(
                    (given / process.travel_speed / one.section if follows else given / one.rate)
                    - 1.0
                ),
                one.layer,
                one.bead,
            )
            for one in known
        ),
        key=lambda found: found[0],
    )


def follows_speed(toolpath: Toolpath) -> bool:
    """Whether the wire follows the travel speed along a bead."""
    return any(bead.wire_share is not None for _, _, bead in toolpath)


def taken_of(toolpath: Toolpath) -> list[Taken]:
    """What beads take, by class and phase, as wide, high and fast as they are, in the order of deposit; nothing where it is
    not known how wide they count."""
    if toolpath.bead_width is None:
        return []
    sums: dict[tuple[str, int], Array] = {}
    first: dict[tuple[str, int], tuple[int, int]] = {}
    for layer, number, bead in toolpath:
        for phase, sum_ in _sums(
            bead, toolpath.bead_width * toolpath.layer_height, toolpath
        ).items():
            key = bead.bead_class, phase
            sums[key] = sums.get(key, np.zeros(3)) + sum_
            first.setdefault(key, (layer, number))
    return [
        Taken(*key, float(volume / time), *first[key], float(volume / length))
        for key, (volume, time, length) in sums.items()
        if time > 0.0
    ]


def _sums(bead: Bead, usual: float, toolpath: Toolpath) -> dict[int, Array]:
    """mm3, s and mm (3,) of a bead, by phase; before joints are planned by the lengths of its phases alone."""
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    section: Array | float = usual
    if bead.width is not None or bead.height is not None:
        high = toolpath.layer_height if bead.height is None else bead.height
        at = high * (np.full(len(bead), toolpath.bead_width) if bead.width is None else bead.width)
        section = 0.5 * (at[1:] + at[:-1])
    both = np.stack([section * length, length / bead.speed[1:], length])
    if bead.phase is not None:
        return {
            phase: both[:, bead.phase[1:] == phase].sum(axis=1)
            for phase in sorted(set(bead.phase[1:].astype(int)))
        }
    whole = both.sum(axis=1)
    if not bead.ends:
        return {MIDDLE: whole}
    first, slow, last, late = bead.ends[:4]
    found, size = {MIDDLE: whole * (1.0 - (first + last) / length.sum())}, length.sum()
    for long, (one, other) in zip(
        bead.ends[4:], ((slow, float(bead.speed[1])), (float(bead.speed[-1]), late))
    ):
        steps = ramp(long, one, other)
        if len(steps):
            found[MIDDLE] = found[MIDDLE] + [
                0.0,
                float((long / len(steps) / steps).sum()) - whole[1] * long / size,
                0.0,
            ]
    for phase, long, speed in ((AT_START, first, slow), (AT_END, last, late)):
        if long:
            found[phase] = np.array(
                [whole[0] * long / size, long / speed if speed else whole[1] * long / size, long]
            )
    return found
