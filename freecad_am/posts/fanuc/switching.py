# SPDX-License-Identifier: LGPL-2.1-or-later
"""Switching of the deposit by the last move of a run, a time before its end (TB, TIME BEFORE)."""

from __future__ import annotations

import dataclasses

import numpy as np

from ...core import digits
from ...core.program import DepositOn, Program
from ..parts import switching
from ..refusals import Ahead, switched_ahead

DECIMALS = 2  # of the seconds before the end


def at_ends(program: Program) -> dict[int, str]:
    """The options of the last moves of runs, with the space before, by the identity of the run."""
    if program.dry_run:
        return {}
    output = program.deposit_output
    return {
        id(
            moves
        ): f" {_ahead(block.ahead)},DO[{output}]={'ON' if isinstance(block, DepositOn) else 'OFF'}"
        for moves, block in switching(program)
        if block.ahead is not None
    }


def as_written(program: Program) -> list[Ahead]:
    """Every switching ahead, with the lead in the listing: up to 5 ms longer than requested."""
    steps = 10**DECIMALS
    return [
        dataclasses.replace(ahead, lead=round(ahead.lead, DECIMALS), steps=steps)
        for ahead in switched_ahead(program)
    ]


def _ahead(seconds: float) -> str:
    """How long before, to 0.01 s, as wide as controllers write it: TB    .05sec."""
    return f"TB{digits.joined([digits.right_aligned(np.array([round(seconds, DECIMALS)]), DECIMALS, 7)], 1)}sec"
