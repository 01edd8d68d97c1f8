# SPDX-License-Identifier: LGPL-2.1-or-later
"""Phases at bead ends: insert points at their ends, and set the travel speed there.

Points are inserted once seams, overlaps and joints are known. They lie on the actual path, which
is linear in the joints between points.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from ...geometry.columns import dots, lengths
from ...geometry.ramps import MIN_STEP, ramp
from ...issues import ERROR, Issue, Text
from ...kinematics.cell import Cell
from ...motion import AT_END, AT_START, MIDDLE
from ...toolpath import Bead, BeadEnds
from ...types import Array, Index
from ..joint_path import BeadPath

STEPS = 4  # iterations; each one leaves a small fraction of the error
END_MM = 1e-3  # mm; a point this close to the end of a phase counts as its end
STEP_MM = 0.2 * MIN_STEP  # mm; a point this close to the end of a ramp step counts as its end
CODE = "PHASE_LENGTH"
_UNIT = ("build", "tool", "tangents")
Condition = Callable[[Array, Array], Array]


class Stretch(NamedTuple):
    """A section of a bead.

    begin, end: positions along the bead, mm. phase: one of PHASES. speed: mm/s; 0 for the speed of
    the rest of the bead.
    """

    begin: float
    end: float
    phase: int
    speed: float


def phased(cell: Cell, path: BeadPath, condition_at: Condition) -> tuple[BeadPath, list[Issue]]:
    """Insert points at the ends of the phases of a bead, and set the phase speeds.

    Parameters
    ----------
    cell : Cell
        The cell.
    path : BeadPath
        The path; unchanged if its bead has no phases or is unreachable.
    condition_at : Condition
        Returns the condition (n,) for flange poses (n, 4, 4) and joints (n, axes).

    Returns
    -------
    path : BeadPath
        The path, with points at the ends of phases and ramp steps.
    issues : list of Issue
        An error if the phases are longer than the bead, which may be a piece of a split bead.
    """
    if path.bead.ends is None or not path.reachable:
        return path, []
    used = path.bead.ends.length
    along = np.r_[0.0, np.cumsum(lengths(np.diff(path.bead.points, axis=0)))]
    if used > along[-1] + END_MM:
        return path, [
            Issue(
                ERROR,
                CODE,
                Text(
                    "start and end take {:.4g} mm of a bead of {:.4g} mm; shorten process.start "
                    "and process.end, or the start and end of the bead class",
                    used,
                    along[-1],
                ),
                path.layer,
                path.index,
            )
        ]
    stretches = _stretches(path.bead, path.bead.ends, float(along[-1]))
    borders = _borders(stretches, along)
    if len(borders):
        path = _insert_points(cell, path, along, borders, condition_at)
        along = np.r_[0.0, np.cumsum(lengths(np.diff(path.bead.points, axis=0)))]
    return dataclasses.replace(path, bead=_timed(path.bead, along, stretches)), []


def _borders(stretches: Sequence[Stretch], along: Array) -> Array:
    """Return the positions (k,) along the bead at which to insert points, mm.

    These are the ends of phases, and the ends of ramp steps without a point nearby. along: (n,)
    positions of the bead points, mm.
    """
    existing = along
    for of_phase, min_distance in ((True, END_MM), (False, STEP_MM)):
        positions = np.unique(
            [
                position
                for stretch in stretches
                if (stretch.phase != MIDDLE) == of_phase
                for position in (stretch.begin, stretch.end)
            ]
        )
        positions = (
            positions[np.abs(existing[:, None] - positions).min(axis=0) > min_distance]
            if len(positions)
            else positions
        )
        existing = np.r_[
            existing,
            positions[np.r_[True, np.diff(positions) > min_distance]]
            if len(positions)
            else positions,
        ]
    return np.sort(existing[len(along) :])


def _stretches(bead: Bead, ends: BeadEnds, length: float) -> list[Stretch]:
    """Return the sections of a bead with their own speed.

    Ramp steps have no phase, because the other settings of bead ends do not apply there.
    """
    rising = ramp(ends.start_ramp, ends.start_speed, float(bead.speed[1]))
    falling = ramp(ends.end_ramp, float(bead.speed[-1]), ends.end_speed)
    end_begin = length - ends.end_length
    stretches = [
        Stretch(0.0, ends.start_length, AT_START, ends.start_speed),
        Stretch(end_begin, length, AT_END, ends.end_speed),
    ]
    for begin, size, speeds in (
        (ends.start_length, ends.start_ramp, rising),
        (end_begin - ends.end_ramp, ends.end_ramp, falling),
    ):
        borders = begin + np.linspace(0.0, size, len(speeds) + 1)
        stretches += [
            Stretch(float(a), float(b), MIDDLE, float(speed))
            for a, b, speed in zip(borders, borders[1:], speeds)
        ]
    return [stretch for stretch in stretches if stretch.end > stretch.begin]


def _timed(bead: Bead, along: Array, stretches: Sequence[Stretch]) -> Bead:
    """Set the speeds of the phases and the phase of each segment of a bead.

    along: (n,) positions of the points along the bead, mm.
    """
    phase, speed = np.full(len(along), float(MIDDLE)), np.array(bead.speed)
    middle = 0.5 * (along + np.r_[0.0, along[:-1]])  # of the segment that ends at each point
    for stretch in stretches:
        in_stretch = (middle > stretch.begin) & (middle < stretch.end)
        phase[in_stretch] = stretch.phase
        speed[in_stretch] = stretch.speed or speed[in_stretch]
    return dataclasses.replace(bead, speed=speed, phase=phase)


def _shares(cell: Cell, path: BeadPath, segment: Index, lengths_in: Array) -> Array:
    """Return the fractions (k,) of the joint motion that place the tip `lengths_in` (k,) mm into
    segments (k,).

    An iteration is needed because the tip does not move at constant speed over a segment.
    """
    start = path.bead.points[segment]
    offset = path.bead.points[segment + 1] - path.bead.points[segment]
    size = lengths(offset)
    share = lengths_in / size
    turned = path.joints[segment + 1] - path.joints[segment]
    for _ in range(STEPS):
        tip = cell.tip_in_part(
            cell.machine.chain.forward(path.joints[segment] + share[:, None] * turned)
        )[0]
        share = np.clip(share + (lengths_in - dots(tip - start, offset) / size) / size, 0.0, 1.0)
    return np.asarray(share)


def _insert_points(
    cell: Cell, path: BeadPath, along: Array, borders: Array, condition_at: Condition
) -> BeadPath:
    """Insert points into a path at `borders` (k,), in mm along it and ascending.

    No point may exist there yet.
    """
    segment = np.searchsorted(along, borders) - 1
    share = _shares(cell, path, segment, borders - along[segment])
    insert_rows = segment + 1

    def between(column: Array) -> Array:
        weight = share.reshape(-1, *(1,) * (column.ndim - 1))
        return np.asarray(
            np.insert(
                column,
                insert_rows,
                column[segment] + weight * (column[insert_rows] - column[segment]),
                axis=0,
            )
        )

    bead, new = path.bead, insert_rows + np.arange(len(insert_rows))
    joints = between(path.joints)
    columns: dict[str, Any] = {
        field.name: between(getattr(bead, field.name))
        for field in dataclasses.fields(bead)
        if isinstance(getattr(bead, field.name), np.ndarray)
    }
    flange, condition = cell.machine.chain.forward(joints[new]), between(path.condition)
    columns["points"][new], columns["tool"][new] = cell.tip_in_part(flange)
    condition[new] = condition_at(flange, joints[new])
    columns["speed"][new] = bead.speed[insert_rows]
    if bead.settings is not None:
        columns["settings"][new] = bead.settings[insert_rows]
    if bead.tangents is not None:  # a point within a segment is not a corner
        columns["tangents"][new] = (bead.tangents[segment, 1] + bead.tangents[insert_rows, 0])[
            :, None
        ]
    for name in _UNIT:
        if name in columns:
            columns[name] /= np.linalg.norm(columns[name], axis=-1, keepdims=True)
    return dataclasses.replace(
        path,
        bead=dataclasses.replace(bead, **columns),
        phi=between(path.phi),
        joints=joints,
        condition=condition,
        threshold=between(path.threshold),
    )
