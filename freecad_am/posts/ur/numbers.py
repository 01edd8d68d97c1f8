# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a URScript program says in numbers: metres, radians, rotation vectors, blend radii, times."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array

from ...core.issues import InputError
from ...core.orientation import ROTATION_VECTOR
from ...core.program import LINEAR_MOVE, RAPID, Moves, Program
from ..parts import place

DECIMALS = 7  # of rad and m
# of the shorter one of the ways before and after a point, at most: blends that overlap make the controller leave points out
LARGEST_SHARE = 0.4
MICRON = 1e-6  # m, the step of a blend radius
# s: the controller's own step, and the shortest time that is written
CYCLE, MIN_TIME_S = 0.002, 0.001
# mm/s: a path speed is written to 0.001 mm/s
SLOWEST, FASTEST = 0.01, 1000.0
# mm on the flange: places for the point whose way the blends of joint moves count on, the part being carried
TOOL_POINTS = np.array(
    [[0, 0, 0], [200, 0, 0], [-200, 0, 0], [0, 200, 0], [0, -200, 0], [0, 0, 200]], dtype=np.float64
)


class Words:
    """The words of each move about time or speed and blend, asked for block by block; and the tool point of the blends.

    tool_point: mm on the flange, if the robot carries the part; None if the tip itself is the tool.
    Raises InputError MOVE_TIME, MOVE_SPEED, BLEND_RADIUS.
    """

    def __init__(self, program: Program) -> None:
        self.tool_point, tip_steps = _ways(program)
        radii = _radii(program, tip_steps)
        counts = np.cumsum([0] + [len(run) for run in program.moves])
        self.radii = {
            id(run): radii[start : start + len(run)]
            for run, start in zip(program.moves, counts.tolist())
        }

    def __call__(self, moves: Moves) -> list[str]:
        """`t=..., r=...` of joint moves, `v=..., r=...` of straight ones."""
        if moves.interpolation == LINEAR_MOVE:
            texts = [f"v={speed:.6f}" for speed in (_speeds(moves) * 0.001).tolist()]
        else:
            texts = [f"t={seconds:.6f}" for seconds in _times(moves).tolist()]
        return [
            f"{word}, r={radius:.6f}" for word, radius in zip(texts, self.radii[id(moves)].tolist())
        ]


def _ways(program: Program) -> tuple[Array | None, Array]:
    """The tool point, and (n,) mm that it goes on each move of a bead."""
    moves = program.moves
    if not program.holds_part:  # the tip is the tool
        return None, np.concatenate([run.speed * run.duration for run in moves])
    flange = np.concatenate([run.flange for run in moves if run.flange is not None])
    tool_positions = flange[:, :3, :3] @ TOOL_POINTS.T + flange[:, :3, 3:]
    tip_steps = np.linalg.norm(np.diff(tool_positions, axis=0, prepend=tool_positions[:1]), axis=1)
    through = ~np.concatenate([run.stops for run in moves])
    shortest = np.minimum(tip_steps, np.vstack([tip_steps[1:], tip_steps[-1:]]))[through].min(
        axis=0, initial=np.inf
    )
    best = int(np.argmax(np.round(shortest, 6)))
    return TOOL_POINTS[best], tip_steps[:, best]


def _radii(program: Program, tip_steps: Array) -> Array:
    """(n,) m: the blend at the end of each move, 0 where it stops. A share of the shorter of the
    two adjacent moves.
    """
    moves = program.moves
    stops = np.concatenate([run.stops for run in moves])
    adjacent = np.minimum(tip_steps, np.append(tip_steps[1:], 0.0))
    microns = np.floor(LARGEST_SHARE * 0.01 * program.blend * adjacent * 0.001 / MICRON + 1e-6)
    radii: Array = np.where(stops, 0.0, microns * MICRON)
    short = ~stops & (radii < MICRON)
    if program.blend and short.any():
        shortest_row = int(np.argmax(short))
        run = moves[
            int(np.searchsorted(np.cumsum([len(run) for run in moves]), shortest_row, side="right"))
        ]
        raise InputError(
            "BLEND_RADIUS",
            place(run),
            "the tool passes a point by {:.3g} mm without a stop, too little for a blend radius, "
            "so the robot would stop there with the deposit on; use a larger "
            "strategy.chord_error, or `program.blend: 0` to stop at every point",
            adjacent[shortest_row],
        )
    return radii


def _times(moves: Moves) -> Array:
    """(n,) s. Raises InputError MOVE_TIME."""
    seconds = np.where(np.isfinite(moves.duration), moves.duration, 0.0)
    if moves.kind != RAPID and seconds.min() < CYCLE:
        raise InputError(
            "MOVE_TIME",
            place(moves),
            "a move takes {:.3g} ms, less than the {:.0f} ms cycle of the controller; use a "
            "larger strategy.chord_error or a lower process.travel_speed",
            1000.0 * seconds.min(),
            1000.0 * CYCLE,
        )
    times: Array = np.maximum(seconds, MIN_TIME_S)
    return times


def _speeds(moves: Moves) -> Array:
    fits = (moves.speed >= SLOWEST) & (moves.speed <= FASTEST)
    if not fits.all():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written; use {} to {:.0f} mm/s",
            moves.speed[~fits][0],
            SLOWEST,
            FASTEST,
        )
    return moves.speed


def poses(position: Array, rotation: Array) -> Array:
    """x y z in m and the rotation vector in rad, (n, 6), as the text has them, of mm (n, 3) and (n, 3, 3)."""
    values: Array = (
        np.round(np.hstack([0.001 * position, ROTATION_VECTOR.numbers(rotation)]), DECIMALS) + 0.0
    )
    return values
