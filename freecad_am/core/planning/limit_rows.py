# SPDX-License-Identifier: LGPL-2.1-or-later
"""The limits of a cell as rows, and how near joints come to them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from ..kinematics.limits import Limits
from ..types import Array

UNREACHABLE = -np.inf


@dataclass(frozen=True, eq=False)
class LimitRows:
    """The limits as m rows lower <= matrix q <= upper, endless axes left out. Angles in rad."""

    matrix: Array
    lower: Array
    upper: Array
    labels: tuple[str, ...]

    @cached_property
    def mean(self) -> Array:
        """(m,) middle of each range."""
        return 0.5 * (self.lower + self.upper)

    @cached_property
    def half(self) -> Array:
        """(m,) half of each range."""
        return 0.5 * (self.upper - self.lower)

    @cached_property
    def plain(self) -> bool:
        """True when every row is one axis alone."""
        return bool((np.count_nonzero(self.matrix, axis=1) == 1).all())

    def offset(self, joints: Array) -> Array:
        """(..., m) distance from the middle as a share of half the range; the limit is at +-1."""
        share: Array = (joints @ self.matrix.T - self.mean) / self.half
        return share

    def margin(self, joints: Array) -> Array:
        """(...) the smallest margin of all rows, 1 in the middle and 0 at a limit; -inf where joints are NaN."""
        worst: Array = reduce(
            np.maximum, map(np.abs, self._offsets(joints))
        )  # sooner than max(axis=-1)
        return np.where(np.isnan(worst), UNREACHABLE, 1.0 - worst)

    def _offsets(self, joints: Array) -> Iterator[Array]:
        """(...) of each row in turn what `offset` tells: rows of one axis alone take nothing but that axis."""
        if not self.plain:
            yield from np.moveaxis(self.offset(joints), -1, 0)
            return
        for row, mean, half in zip(self.matrix, self.mean, self.half):
            axis = int(np.flatnonzero(row)[0])
            share = joints[..., axis] * row[axis]
            share -= mean
            share /= half
            yield share


def limit_rows(limits: Limits, reserve: float = 0.0) -> LimitRows:
    """The rows of a limit set, single axes first, then what couples several; `reserve` (rad) narrower on both sides."""
    axes = len(limits.lower)
    finite = np.isfinite(limits.lower) & np.isfinite(limits.upper)
    return LimitRows(
        matrix=np.vstack([np.eye(axes)[finite], limits.coefficients.reshape(-1, axes)]),
        lower=np.concatenate([limits.lower[finite], limits.coupled_lower]) + reserve,
        upper=np.concatenate([limits.upper[finite], limits.coupled_upper]) - reserve,
        labels=tuple(
            np.array(limits.labels)[
                np.concatenate([finite, np.ones(len(limits.coupled_lower), bool)])
            ]
        ),
    )
