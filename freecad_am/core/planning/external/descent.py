# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local optima of a bead with all that is free at its points: of the objective, and of the least margin."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...types import Array, Index
from .freedom import Bound, Freedom

ROUNDS = 4  # each with the constraints added that the one before came close to
ACTIVE = 0.1  # rows with so much more margin than asked for are not told to the optimiser at first
ITERATIONS, TOLERANCE = 80, 1e-7
# Largest changes of a variable in further attempts, after one without bounds ended outside its constraints. SLSQP may
# step across a singularity, from which it does not return; whether it does depends on the last bits of the processor.
CLOSER = (0.5, 0.1)
VIOLATION = 1e-5  # of a constraint, no more than the start's own violation, that still counts as an end within
LOST = 1e3  # the objective out of reach, in those of the start


class Seen:
    """What holds at changes that were looked at last, so that value and slope cost one look."""

    def __init__(self, freedom: Freedom) -> None:
        self.freedom, self.key = freedom, b""
        self.found: Bound | None = None

    def at(self, x: Array) -> Bound | None:
        """What holds with changes x (v,)."""
        if x.tobytes() != self.key:
            self.key, self.found = x.tobytes(), self.freedom.look(x)
        return self.found


def least_objective(freedom: Freedom, start: Array, margin: float) -> tuple[Array, int]:
    """The changes (v,) with the least objective of all with a margin, and after how many iterations."""
    seen = Seen(freedom)
    first = seen.at(start)
    scale = 1.0 if first is None else max(first.objective, 1e-12)

    def value(z: Array) -> tuple[float, Array]:
        found = seen.at(z)
        return (
            (LOST, np.zeros(len(z)))
            if found is None
            else (found.objective / scale, np.nan_to_num(found.slope) / scale)
        )

    def kept(found: Bound, z: Array) -> tuple[Array, Array]:
        return np.concatenate([found.margins - margin, found.hard]), np.concatenate(
            [found.margin_slopes, found.hard_slopes]
        )

    return _solved(seen, start, start, value, kept)


def largest_margin(
    freedom: Freedom, start: Array, objective: float, enough: float
) -> tuple[Array, int]:
    """The changes (v,) with the largest margin, `enough` at most, of all with no more than an objective, and after how many
    iterations."""
    seen, v = Seen(freedom), len(start)
    first = seen.at(start)
    if first is None or first.margins.min() >= enough:
        return start, 0
    scale = max(objective, 1e-12)

    def value(z: Array) -> tuple[float, Array]:
        return float(-z[-1]), np.concatenate([np.zeros(v), [-1.0]])

    def kept(found: Bound, z: Array) -> tuple[Array, Array]:
        values = np.concatenate(
            [
                found.margins - z[-1],
                found.hard,
                [(objective - found.objective) / scale, enough - z[-1]],
            ]
        )
        slopes = np.zeros((len(values), v + 1))
        count = len(found.margins)
        slopes[:count, :v], slopes[:count, v] = found.margin_slopes, -1.0
        slopes[count : count + len(found.hard), :v] = found.hard_slopes
        slopes[-2, :v], slopes[-1, v] = -np.nan_to_num(found.slope) / scale, -1.0
        return values, slopes

    z, count = _solved(seen, start, np.append(start, first.margins.min()), value, kept)
    return z[:v], count


def _solved(
    seen: Seen,
    start: Array,
    z: Array,
    value: Callable[[Array], tuple[float, Array]],
    kept: Callable[[Bound, Array], tuple[Array, Array]],
) -> tuple[Array, int]:
    """The best z that SLSQP finds; run again where it came upon constraints that it had not been told of."""
    from scipy.optimize import minimize  # slow to import, and most jobs never need it

    v, count, rows = len(start), 0, np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        here = seen.at(z[:v])
        if here is None:
            break
        before, values = len(rows), kept(here, z)[0]
        rows = np.union1d(
            rows, np.flatnonzero(values < ACTIVE if not before else values < 0.1 * ACTIVE)
        )
        if len(rows) == before and before:
            break
        reported = rows

        def constraints(z: Array, reported: Index = reported) -> tuple[Array, Array]:
            found = seen.at(z[:v])
            if found is None:
                return np.full(len(reported), -1.0), np.zeros((len(reported), len(z)))
            values, slopes = kept(found, z)
            return values[reported], np.nan_to_num(slopes[reported])

        for reach in (np.inf, *CLOSER):
            result: Any = minimize(
                lambda z: value(z)[0],
                z,
                jac=lambda z: value(z)[1],
                method="SLSQP",
                bounds=None if np.isinf(reach) else list(zip(z - reach, z + reach)),
                constraints=[
                    {
                        "type": "ineq",
                        "fun": lambda z: constraints(z)[0],
                        "jac": lambda z: constraints(z)[1],
                    }
                ]
                if len(reported)
                else [],
                options={"ftol": TOLERANCE, "maxiter": ITERATIONS},
            )
            count += int(result.nit)
            if constraints(result.x)[0].min(initial=0.0) >= min(
                -VIOLATION, constraints(z)[0].min(initial=0.0)
            ):
                break
        if seen.at(result.x[:v]) is None:
            break
        z = result.x
    return z, count
