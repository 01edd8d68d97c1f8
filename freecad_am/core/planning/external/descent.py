# SPDX-License-Identifier: LGPL-2.1-or-later
"""Local optima of a bead with all that is free at its points: of the objective, and of the least margin."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...types import Array, Index
from .freedom import Bound, Freedom

ROUNDS = 4  # each with the constraints added that the one before came close to
ACTIVE = 0.1  # rows with this much more margin than requested are at first no constraint of the optimiser
ITERATIONS, TOLERANCE = 80, 1e-7
# Largest changes of a variable in further attempts, after one without bounds ended outside its constraints. SLSQP may
# step across a singularity, from which it does not return; whether it does depends on the last bits of the processor.
CLOSER = (0.5, 0.1)
VIOLATION = 1e-5  # of a constraint, no more than the start's own violation, that still counts as an end within
UNREACHABLE_OBJECTIVE = 1e3  # the objective out of reach, in those of the start


class Seen:
    """The bound at the last changes, so that value and slope cost one evaluation."""

    def __init__(self, freedom: Freedom) -> None:
        self.freedom, self.key = freedom, b""
        self.found: Bound | None = None

    def bound_at(self, x: Array) -> Bound | None:
        """What holds with changes x (v,)."""
        if x.tobytes() != self.key:
            self.key, self.found = x.tobytes(), self.freedom.look(x)
        return self.found


def least_objective(freedom: Freedom, start: Array, margin: float) -> tuple[Array, int]:
    """The changes (v,) with the least objective of all with a margin, and after how many iterations."""
    cache = Seen(freedom)
    initial = cache.bound_at(start)
    scale = 1.0 if initial is None else max(initial.objective, 1e-12)

    def value(z: Array) -> tuple[float, Array]:
        state = cache.bound_at(z)
        return (
            (UNREACHABLE_OBJECTIVE, np.zeros(len(z)))
            if state is None
            else (state.objective / scale, np.nan_to_num(state.slope) / scale)
        )

    def constraint_values(state: Bound, z: Array) -> tuple[Array, Array]:
        return np.concatenate([state.margins - margin, state.hard]), np.concatenate(
            [state.margin_slopes, state.hard_slopes]
        )

    return _solved(cache, start, start, value, constraint_values)


def largest_margin(
    freedom: Freedom, start: Array, objective: float, enough: float
) -> tuple[Array, int]:
    """The changes (v,) with the largest margin, `enough` at most, of all with no more than an objective, and after how many
    iterations."""
    cache, v = Seen(freedom), len(start)
    initial = cache.bound_at(start)
    if initial is None or initial.margins.min() >= enough:
        return start, 0
    scale = max(objective, 1e-12)

    def value(z: Array) -> tuple[float, Array]:
        return float(-z[-1]), np.concatenate([np.zeros(v), [-1.0]])

    def constraint_values(state: Bound, z: Array) -> tuple[Array, Array]:
        values = np.concatenate(
            [
                state.margins - z[-1],
                state.hard,
                [(objective - state.objective) / scale, enough - z[-1]],
            ]
        )
        slopes = np.zeros((len(values), v + 1))
        count = len(state.margins)
        slopes[:count, :v], slopes[:count, v] = state.margin_slopes, -1.0
        slopes[count : count + len(state.hard), :v] = state.hard_slopes
        slopes[-2, :v], slopes[-1, v] = -np.nan_to_num(state.slope) / scale, -1.0
        return values, slopes

    z, count = _solved(
        cache, start, np.append(start, initial.margins.min()), value, constraint_values
    )
    return z[:v], count


def _solved(
    cache: Seen,
    start: Array,
    z: Array,
    value: Callable[[Array], tuple[float, Array]],
    constraint_values: Callable[[Bound, Array], tuple[Array, Array]],
) -> tuple[Array, int]:
    """The best z that SLSQP finds; run again if it violates constraints that it was not given."""
    from scipy.optimize import minimize  # slow to import, and most jobs never need it

    v, count, rows = len(start), 0, np.zeros(0, dtype=np.int64)
    for _ in range(ROUNDS):
        current = cache.bound_at(z[:v])
        if current is None:
            break
        previous_count, values = len(rows), constraint_values(current, z)[0]
        rows = np.union1d(
            rows, np.flatnonzero(values < ACTIVE if not previous_count else values < 0.1 * ACTIVE)
        )
        if len(rows) == previous_count and previous_count:
            break
        reported = rows

        def constraints(z: Array, reported: Index = reported) -> tuple[Array, Array]:
            state = cache.bound_at(z[:v])
            if state is None:
                return np.full(len(reported), -1.0), np.zeros((len(reported), len(z)))
            values, slopes = constraint_values(state, z)
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
        if cache.bound_at(result.x[:v]) is None:
            break
        z = result.x
    return z, count
