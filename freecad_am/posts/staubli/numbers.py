# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format the numbers of a VAL 3 application: joint values, frames, motion descriptors."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...core.issues import InputError
from ...core.orientation import MOVING_XYZ
from ...core.program import DEPOSIT, FIRST_SHARE, LINEAR_MOVE, Moves, Program
from ...core.types import Array
from ..parts import place

ANGLE_DECIMALS, LENGTH_DECIMALS = 5, 4
# mm/s and deg/s; limit above any arm's speed, for descriptors without a limit
UNLIMITED = "99999"
# mm/s, and percent of the nominal joint speed: minimum values that are written
SLOWEST, LEAST_PERCENT = 0.01, 0.001


def degrees(joints: Array) -> Array:
    """Convert joint values to rounded degrees.

    Parameters
    ----------
    joints : (n, axes) array
        rad.

    Returns
    -------
    (n, axes) array
        Degrees, rounded.
    """
    rounded: Array = np.asarray(
        np.round(np.degrees(joints), ANGLE_DECIMALS) + 0.0, dtype=np.float64
    )
    return rounded


def frames(position: Array, rotation: Array) -> Array:
    """Convert poses to rounded VAL 3 values; the rotation is Rx Ry Rz.

    Parameters
    ----------
    position : (n, 3) array
        mm.
    rotation : (n, 3, 3) array
        Rotations.

    Returns
    -------
    (n, 6) array
        X Y Z in mm and RX RY RZ in degrees, rounded.
    """
    angles = MOVING_XYZ.numbers(rotation)
    values: Array = (
        np.hstack(
            (np.round(position, LENGTH_DECIMALS), np.round(np.degrees(angles), ANGLE_DECIMALS))
        )
        + 0.0
    )
    return values


class Descriptors:
    """Build motion descriptors of a program's moves, block by block in the order of motion."""

    def __init__(self, program: Program) -> None:
        self.cartesian, self.blend = program.motion == "cartesian", program.blend
        self.nominal: Array = np.degrees(np.array(program.max_speed))
        self.before: Array | None = None

    def __call__(self, moves: Moves) -> Sequence[str]:
        """Return the attributes of one descriptor per move. Raises InputError MOVE_SPEED or
        JOINT_SPEED.
        """
        displayed = degrees(moves.joints)
        blends = self._blends(moves)
        if moves.interpolation == LINEAR_MOVE:
            speeds = _speeds(moves).tolist()
            words = [
                _descriptor("100", f"{speed:.3f}", blend)
                for speed, blend in zip(speeds, blends, strict=True)
            ]
        else:
            start = displayed[:1] if self.before is None else self.before
            percent = self._percent(moves, np.diff(displayed, axis=0, prepend=start))
            if self.before is None:
                percent[0] = 100.0 * FIRST_SHARE
            shares = percent.tolist()
            words = [
                _descriptor(f"{share:.5f}", UNLIMITED, blend)
                for share, blend in zip(shares, blends, strict=True)
            ]
        self.before = displayed[-1:]
        return words

    def _percent(self, moves: Moves, steps: Array) -> Array:
        """Return the percent (n,) of the nominal joint speeds that give the moves their planned
        times.
        """
        share = (np.abs(steps) / self.nominal).max(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            percent = 100.0 * share / moves.duration
        wrong = (share > 0.0) & ~(percent <= 100.0 + LEAST_PERCENT)
        if moves.kind == DEPOSIT:
            wrong |= percent < LEAST_PERCENT
        if self.before is None:
            wrong[0] = False
        if wrong.any():
            raise InputError(
                "JOINT_SPEED",
                place(moves),
                "a move would need {:.4g} % of the largest joint speed, which cannot be written; "
                "use a speed that gives {} to 100 %",
                percent[wrong][0],
                LEAST_PERCENT,
            )
        return np.where(share > 0.0, np.clip(percent, LEAST_PERCENT, 100.0), 100.0)

    def _blends(self, moves: Moves) -> list[str]:
        """Return the blend attributes of each move.

        Corners within a bead are rounded by at most half its shortest move, except at halts. The
        program waits at the end of a bead.
        """
        distance = 0.0
        if moves.kind == DEPOSIT:
            shortest = float(np.nan_to_num(moves.speed * moves.duration).min())
            distance = math.floor(1000.0 * min(0.005 * self.blend * shortest, 100.0)) / 1000.0
        kind = ("Cartesian" if self.cartesian else "joint") if distance > 0.0 else "off"
        through, exact = (
            f'blend="{word}" leave="{size:.3f}" reach="{size:.3f}"'
            for word, size in ((kind, distance), ("off", 0.0))
        )
        return [exact if stops else through for stops in moves.halt.tolist()]


def _speeds(moves: Moves) -> Array:
    fits = (moves.speed >= SLOWEST) & (moves.speed < float(UNLIMITED))
    if not fits.all():
        raise InputError(
            "MOVE_SPEED",
            place(moves),
            "{:.4g} mm/s cannot be written; use at least {} mm/s",
            moves.speed[~fits][0],
            SLOWEST,
        )
    return moves.speed


def _descriptor(percent: str, speed: str, blend: str) -> str:
    return f'accel="100" vel="{percent}" decel="100" tmax="{speed}" rmax="{UNLIMITED}" {blend}'
