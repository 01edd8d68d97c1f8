# SPDX-License-Identifier: LGPL-2.1-or-later
"""What no post can write, whatever the controller."""

from __future__ import annotations

import numpy as np

from ..core.issues import InputError
from ..core.program import Program, WaitBelow


def refuse_wire(program: Program, no_wire: str) -> None:
    """Raises InputError NO_WIRE_OUTPUT, for the reason `no_wire`, where the program tells the speed of the wire."""
    if any(run.wire is not None for run in program.moves):
        raise wire_refused(no_wire)


def wire_refused(no_wire: str) -> InputError:
    """The error for a controller that cannot be told the speed of the wire along a bead."""
    return InputError("NO_WIRE_OUTPUT", "process.wire.feed_mode", f"{no_wire}; use constant, or another controller")


def refuse_cooling(program: Program, last: int, why: str = "") -> None:
    """Raises InputError where the program waits for a temperature: NO_ANALOGUE_INPUT for the reason `why`, or ANALOGUE_INPUT
    for an input that is none of 1 to `last`."""
    waits = [block for block in program.blocks if isinstance(block, WaitBelow)]
    if waits and why:
        raise InputError(
            "NO_ANALOGUE_INPUT", "process.cooling.below", f"{why}; use process.between_layers.input, strategy.wait, or "
            "another controller",
        )
    if any(block.number > last for block in waits):
        raise InputError(
            "ANALOGUE_INPUT", "process.cooling.input",
            f"the controller's program reads analogue inputs 1 to {last}, not {waits[0].number}; use one of these",
        )


def refuse_incomplete(program: Program, post: str, axes: int) -> None:
    """Raises InputError NOTHING_TO_WRITE, UNSUPPORTED_AXES (other than `axes` of them) or UNREACHABLE."""
    moves = program.moves
    if not sum(len(run) for run in moves):
        raise InputError("NOTHING_TO_WRITE", "program", "the program holds no moves; check where it starts")
    if any(run.joints.shape[1] != axes for run in moves) or len(program.endless) != axes:
        raise InputError("UNSUPPORTED_AXES", "program.post", f"the post {post} writes {axes} axes; use another post")
    if not all(np.isfinite(run.joints).all() for run in moves):
        raise InputError("UNREACHABLE", "program", "some points have no joint values; a program needs all of them")
