# SPDX-License-Identifier: LGPL-2.1-or-later
"""One of several states at each point of chains, so that they are small and change little: exact, by dynamic programming."""

from __future__ import annotations

import numpy as np

from ...geometry.ties import index_of_minimum, is_tied
from ...types import Array, Index, Mask

BARRED = 1e9  # cost of a state that is not allowed; finite, so that a chain without a way through has a least bad one
AT_ONCE = 1_000_000  # pairs of states worked on at once


def least_cost_states(states: Array, allowed: Mask, weight: Array, change: Array) -> Index:
    """The number (b, n) of the state of each point of b chains for which the sum of two costs is least.

    Parameters
    ----------
    states
        (b, n, s, d), or (1, 1, s, d) if every point has the same.
    allowed
        (b, n, s).
    weight
        (b, n), of the square of a state.
    change
        (b, n - 1), of the square of the difference of neighbouring states; 0 behind the end of a shorter chain.
    """
    b, n, s = allowed.shape
    step = max(1, AT_ONCE // (s * s))
    if b > step:
        chunks = (slice(k, k + step) for k in range(0, b, step))
        return np.concatenate(
            [
                least_cost_states(
                    states if len(states) == 1 else states[chunk],
                    allowed[chunk],
                    weight[chunk],
                    change[chunk],
                )
                for chunk in chunks
            ]
        )
    same = states.shape[1] == 1
    size = np.broadcast_to((states**2).sum(axis=3), (b, n, s))
    state_cost = np.where(allowed, weight[:, :, None] * size, BARRED)
    fixed = _between(states[:, 0], states[:, 0]) if same else None
    total, came = state_cost[:, 0], np.zeros((b, n, s), dtype=np.int32)
    for k in range(1, n):
        between = fixed if fixed is not None else _between(states[:, k - 1], states[:, k])
        costs = total[:, :, None] + change[:, k - 1, None, None] * between
        best = costs.min(axis=1)
        came[:, k] = is_tied(costs, best[:, None]).argmax(
            axis=1
        )  # what first_least finds, of numbers that are all finite
        total = best + state_cost[:, k]
    states_ = np.zeros((b, n), dtype=np.intp)
    states_[:, -1] = index_of_minimum(total, axis=1)
    for k in range(n - 1, 0, -1):
        states_[:, k - 1] = came[np.arange(b), k, states_[:, k]]
    return states_


def _between(a: Array, b: Array) -> Array:
    """Squares (b, s, t) of the differences of states (b, s, d) and (b, t, d), component by component, which is quicker."""
    total: Array = np.square(a[:, :, None, 0] - b[:, None, :, 0])
    for component in range(1, a.shape[2]):
        total += np.square(a[:, :, None, component] - b[:, None, :, component])
    return total
