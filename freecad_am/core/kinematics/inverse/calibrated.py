# SPDX-License-Identifier: LGPL-2.1-or-later
"""The inverse of an arm that is nearly one with a closed form: by its solutions, and Newton's method from there.

A calibration takes axes that are parallel or meet a few hundredths of a degree and millimetres apart. The closed form of the
machine file is that near, so that three or four steps are enough.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry.angles import shortest
from ...types import Array, ArrayLike, Index
from ..chain import Chain
from ..jacobian import jacobian
from .serial_arm import SerialArm

CHUNK = 2048
WORDS = 8  # configurations
STEPS, AGAIN = 16, 4  # steps at most, and after how many the Jacobian is found again
START_SHIFT_MM = 5.0  # mm
TINY = 1e-9
LENGTH = 500.0  # mm that count as one rad
CONVERGED = 1e-11  # of the error as an angle, 5e-9 mm; one more step is not worth its time
SINGULAR = 2e-10  # rounding error near a singularity
DAMPING = 1e-14


@dataclass(frozen=True, eq=False)
class CalibratedArm:
    """The inverse of an arm off its nominal geometry.

    `chain` is the real arm, `nominal` the closed form of its nominal geometry. Configurations
    are those of the closed form for the same angles. Within some millimetres of the stretched
    arm and some tenths of a degree of the wrist's singularity, solutions that only one of the
    two has are left out.
    """

    nominal: SerialArm
    chain: Chain

    @property
    def followed(self) -> bool:
        """Whether several solutions may bear the same words; as of the closed form."""
        return self.nominal.followed

    @property
    def shoulder(self) -> tuple[float, float]:
        """Distances of axis 2 ahead of axis 1 and above base_link, mm, from the closed form."""
        return self.nominal.shoulder

    @property
    def reach(self) -> float:
        """Distance from axis 2 to the wrist of the stretched arm, mm, from the closed form."""
        return self.nominal.reach

    def inverse(self, poses: ArrayLike) -> Array:
        """Return joint angles (8, n, 6) in all configurations for flange poses (n, 4, 4), in [-pi,
        pi]; NaN if out of reach.

        Arms with ambiguous words have as many solutions as the closed form.
        """
        return self.solutions(poses)[0]

    def inverse_branch(self, poses: ArrayLike, branch: int) -> Array:
        """Joint angles (n, 6) of one configuration; else as `inverse`."""
        targets = np.ascontiguousarray(poses, float)
        return self._solve_words(targets, branch)

    def solutions(self, poses: ArrayLike) -> tuple[Array, Index]:
        """All of `inverse`, and the configuration (8, n) of each, -1 where it does not reach."""
        targets = np.ascontiguousarray(poses, float)
        if not self.nominal.followed:
            solved = np.stack([self._solve_words(targets, words) for words in range(WORDS)])
            return solved, np.where(np.isnan(solved[..., 0]), -1, np.arange(WORDS)[:, None])
        starts, words = self.nominal.solutions(targets)
        solved = np.stack([self._from(start, targets, word) for start, word in zip(starts, words)])
        return solved, np.where(np.isnan(solved[..., 0]), -1, words)

    def branch_of(self, q: ArrayLike) -> Index:
        """The configuration (...) that joint angles `q` (..., 6) are in."""
        return self.nominal.branch_of(q)

    def bend(self, q: ArrayLike) -> Array:
        """(...) how far angles `q` (..., 6) are from where wrist or elbow is stretched: 0 there, 1 square to it."""
        return self.nominal.bend(q)

    def _solve_words(self, poses: Array, words: int) -> Array:
        """Return the angles (n, 6) with these words for the poses (n, 4, 4); NaN where there is no
        solution.
        """
        result = self._from(self.nominal.inverse_branch(poses, words), poses, words)
        # where the closed form just fails to reach: start from its solution slightly nearer to the shoulder, or farther from axis 1
        for inwards, outwards in ((START_SHIFT_MM, 0.0), (0.0, START_SHIFT_MM)):
            unsolved = np.flatnonzero(np.isnan(result[:, 0]))
            if not len(unsolved):
                break
            moved = poses[unsolved].copy()
            position = moved[:, :3, 3]
            ahead = position * (1.0, 1.0, 0.0)
            position += outwards * ahead / np.linalg.norm(ahead + TINY, axis=1, keepdims=True)
            towards = position - (0.0, 0.0, self.shoulder[1])
            position -= inwards * towards / np.linalg.norm(towards + TINY, axis=1, keepdims=True)
            result[unsolved] = self._from(
                self.nominal.inverse_branch(moved, words), poses[unsolved], words
            )
        return result

    def _from(self, start: Array, poses: Array, words: int | Index) -> Array:
        """Return the angles (n, 6) near `start` (n, 6) for the poses, NaN where none has these
        words, or words (n,).
        """
        result = np.full(start.shape, np.nan)
        reached = np.flatnonzero(np.isfinite(start[:, 0]))
        for begin in range(0, len(reached), CHUNK):
            rows = reached[begin : begin + CHUNK]
            result[rows] = self._newton(start[rows].copy(), poses[rows])
        result = shortest(result)
        result[self.nominal.branch_of(np.nan_to_num(result)) != words] = np.nan
        return result

    def _newton(self, q: Array, poses: Array) -> Array:
        off = np.full(len(q), np.inf)
        open_ = np.arange(len(q))
        back = np.empty((len(q), 6, 6))
        for step in range(STEPS):
            flange, targets = self.chain.forward(q[open_]), poses[open_]
            error = np.empty((len(open_), 6))
            error[:, :3] = (targets[:, :3, 3] - flange[:, :3, 3]) / LENGTH
            turned = targets[:, :3, :3] @ np.swapaxes(flange[:, :3, :3], 1, 2)
            for row, (following, column) in enumerate(((1, 2), (2, 0), (0, 1))):
                error[:, 3 + row] = 0.5 * (
                    turned[:, column, following] - turned[:, following, column]
                )
            off[open_] = np.sqrt(np.einsum("ni,ni->n", error, error))
            unconverged = off[open_] > CONVERGED
            if not unconverged.any():
                break
            open_, error = open_[unconverged], error[unconverged]
            if step % AGAIN == 0:
                back[open_] = self._inverse_rates(q[open_], flange[unconverged, :3, 3])
            rates = np.einsum("nij,nj->ni", back[open_], error)
            q[open_] += rates / np.maximum(
                1.0, np.abs(rates).max(axis=1, keepdims=True)
            )  # no more than 1 rad at a time
        q[~(off < SINGULAR)] = np.nan
        return q

    def _inverse_rates(self, q: Array, points: Array) -> Array:
        """Return matrices (n, 6, 6) from an error of the flange, at (n, 3), to angles, slightly
        damped to stay finite near singularities.
        """
        rates = np.array(jacobian(self.chain, q, points))
        rates[:, :3] /= LENGTH
        across = np.swapaxes(rates, 1, 2)
        product = across @ rates
        product[:, range(6), range(6)] += DAMPING
        inverse: Array = np.linalg.solve(product, across)
        return inverse
