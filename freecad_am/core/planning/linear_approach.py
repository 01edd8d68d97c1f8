# SPDX-License-Identifier: LGPL-2.1-or-later
"""Linear approaches to beads, for controllers whose deposit instruction needs a linear move.

An arc instruction may be a linear move that strikes the arc at its end. Other controllers switch
the deposit ahead of a position only on linear moves. Rapids are joint moves, and clearance was
checked on their joint path. A linear approach therefore covers only the end of the rapid, where it
stays close to this path.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from .. import motion as motions
from ..controller import Controller
from ..issues import InputError, Text
from ..kinematics.cell import Cell
from ..motion import Motion
from ..parameters.program import ProgramParameters
from ..program import OFF_WAY_MM, OFF_WAY_RAD
from ..types import Array, Index
from .program_beads import ARC

SHARE = 0.75  # fraction of the allowed deviation from the checked path, target after shortening
_BETWEEN = np.array([1.0, 2.0, 3.0, 4.0, 5.0]) / 6.0


def asked(parameters: ProgramParameters, controller: Controller) -> bool:
    """Whether the last move to each bead must be linear."""
    arc = parameters.schedule.by == ARC and controller.arc_moves
    ahead = parameters.trigger.lead is not None and controller.linear_triggers
    return parameters.motion == "cartesian" and (arc or ahead)


def shorten_approaches(motion: Motion, cell: Cell) -> Motion:
    """Split the last rapid to a bead where a linear move would deviate too far from it.

    The added row lies on the joint path of the rapid, so this path does not change.
    """
    ends = _ends(motion)
    ends = ends[ends > 0]
    off, tilt = linear_deviations(motion, cell, ends)
    with np.errstate(divide="ignore"):  # the deviation grows with the square of the length
        share = np.sqrt(SHARE / np.maximum(off / OFF_WAY_MM, tilt / OFF_WAY_RAD))
    cut = (off > SHARE * OFF_WAY_MM) | (tilt > SHARE * OFF_WAY_RAD)
    ends, share = ends[cut], share[cut]
    if not len(ends):
        return motion
    rows = np.insert(np.arange(len(motion)), ends, ends)
    columns = {
        field.name: getattr(motion, field.name)[rows] for field in dataclasses.fields(motion)
    }
    added = ends + np.arange(len(ends))
    columns["joints"][added] = motion.joints[ends] + share[:, None] * (
        motion.joints[ends - 1] - motion.joints[ends]
    )
    flange = cell.machine.chain.forward(columns["joints"][added])
    columns["position"][added], columns["tool"][added] = cell.tip_in_part(flange)
    columns["duration"][added] = (1.0 - share) * motion.duration[ends]
    columns["duration"][added + 1] = share * motion.duration[ends]
    for row in (added, added + 1):
        distance = np.linalg.norm(columns["position"][row] - columns["position"][row - 1], axis=1)
        columns["speed"][row] = distance / columns["duration"][row]
    columns["role"][added + 1] = motions.APPROACH
    return Motion(**columns)


def linear_deviations(motion: Motion, cell: Cell, ends: Index) -> tuple[Array, Array]:
    """Return the deviation of linear moves from the joint moves that were checked.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell.
    ends : (k,) int array
        Rows at which the moves end.

    Returns
    -------
    distance : (k,) array
        Maximum deviation of the tip, mm.
    angle : (k,) array
        Norm of the maximum difference between the tool axes; rad for small angles.
    """
    joints, position, tool = (
        (
            column[ends - 1, None] + _BETWEEN[:, None] * (column[ends] - column[ends - 1])[:, None]
        ).reshape(-1, width)
        for column, width in (
            (motion.joints, motion.joints.shape[1]),
            (motion.position, 3),
            (motion.tool, 3),
        )
    )
    tip, axis = cell.tip_in_part(cell.machine.chain.forward(joints))
    shape = len(ends), len(_BETWEEN)
    off, tilt = (
        np.linalg.norm(actual - expected, axis=1).reshape(shape).max(axis=1, initial=0.0)
        for actual, expected in ((tip, position), (axis, tool))
    )
    return off, tilt


def check(motion: Motion, cell: Cell, rows: Index, arriving: bool, arc: bool = True) -> None:
    """Reject a linear approach that deviates from the checked path.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell.
    rows : (k,) int array
        Rows of the rapid; the last row is at the bead.
    arriving : bool
        Whether the position before the first row is unknown.
    arc : bool, optional
        Whether an arc instruction needs the move; otherwise a switch ahead of a position does.

    Raises
    ------
    InputError
        SCHEDULE, or TRIGGER for a program without the `arc` instruction.
    """
    last_row = rows[-1:]
    bead_name = Text(
        "layer {} bead {}", int(motion.layer[last_row[0]]), int(motion.bead[last_row[0]])
    )
    code, key = ("SCHEDULE", "program.schedule.by") if arc else ("TRIGGER", "program.trigger.lead")
    if arriving and len(rows) == 1:
        raise InputError(
            code,
            bead_name,
            "the deposit needs a linear approach to the bead, but the program begins at the "
            "bead; set a retract distance, or another {}",
            key,
        )
    off, tilt = linear_deviations(motion, cell, last_row)
    if not (off[0] <= OFF_WAY_MM and tilt[0] <= OFF_WAY_RAD):
        raise InputError(
            code,
            bead_name,
            "the linear approach to the bead would leave the checked path by {:.2g} mm; use a "
            "shorter retract distance, or another {}",
            off[0],
            key,
        )


def _ends(motion: Motion) -> Index:
    """Return the rows of the last rapid before each bead."""
    return np.flatnonzero(~motion.deposit[:-1] & motion.deposit[1:])
