# SPDX-License-Identifier: LGPL-2.1-or-later
"""What no post can write, whatever the controller."""

from __future__ import annotations

import numpy as np

from ..core.issues import InputError
from ..core.program import Program

# names that files cannot have on the computers programs pass through
DEVICES = frozenset(("CON", "PRN", "AUX", "NUL", *(f"{port}{n}" for port in ("COM", "LPT") for n in range(1, 10))))


def refuse_incomplete(program: Program, post: str, axes: int) -> None:
    """Raises InputError NOTHING_TO_WRITE, UNSUPPORTED_AXES (other than `axes` of them) or UNREACHABLE."""
    moves = program.moves
    if not sum(len(run) for run in moves):
        raise InputError("NOTHING_TO_WRITE", "program", "the program holds no moves; check where it starts")
    if any(run.joints.shape[1] != axes for run in moves) or len(program.endless) != axes:
        raise InputError("UNSUPPORTED_AXES", "program.post", f"the post {post} writes {axes} axes; use another post")
    if not all(np.isfinite(run.joints).all() for run in moves):
        raise InputError("UNREACHABLE", "program", "some points have no joint values; a program needs all of them")
