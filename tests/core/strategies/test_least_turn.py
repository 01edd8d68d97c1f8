# SPDX-License-Identifier: LGPL-2.1-or-later
"""Paths through states are as good as the best of all possible paths."""

from itertools import product

import numpy as np
import pytest

from freecad_am.core.strategies.clearance.tilt_search import (
    BARRED,
    MAX_JOINT_STATES,
    least_cost_states,
    useful_states,
)


def cost(states, allowed, weight, change, path):
    n = len(path)
    state_cost = sum(
        weight[k] * (states[k, path[k]] ** 2).sum() if allowed[k, path[k]] else BARRED
        for k in range(n)
    )
    return state_cost + sum(
        change[k] * ((states[k, path[k]] - states[k + 1, path[k + 1]]) ** 2).sum()
        for k in range(n - 1)
    )


@pytest.mark.parametrize("same", [False, True], ids=["own states", "the same states"])
@pytest.mark.parametrize("seed", range(5))
def test_no_way_is_better(seed, same):
    """No other path is cheaper."""
    rng = np.random.default_rng(seed)
    b, n, s = 3, 5, 4
    states = rng.normal(size=(1, 1, s, 2) if same else (b, n, s, 2))
    allowed = rng.random((b, n, s)) > 0.4
    weight, change = rng.uniform(0.1, 1, (b, n)), rng.uniform(0, 2, (b, n - 1))
    paths = least_cost_states(states, allowed, weight, change)
    for k in range(b):
        chain_states = np.broadcast_to(states[0] if same else states[k], (n, s, 2))
        best = min(
            cost(chain_states, allowed[k], weight[k], change[k], path)
            for path in product(range(s), repeat=n)
        )
        assert cost(chain_states, allowed[k], weight[k], change[k], paths[k]) == pytest.approx(
            best, rel=1e-12
        )


def test_states_of_many_are_chosen_as_one_by_one():
    """A chain with more states than are processed together gives the same path."""
    rng = np.random.default_rng(4)
    n, s = 12, MAX_JOINT_STATES + 9
    states, allowed = rng.normal(size=(1, 1, s, 2)), rng.random((1, n, s)) > 0.5
    weight, change = rng.uniform(0.1, 1, (1, n)), rng.uniform(0, 2, (1, n - 1))
    alone = least_cost_states(states, allowed, weight, change)
    together = least_cost_states(
        states, *(np.repeat(v, 2, axis=0) for v in (allowed, weight, change))
    )
    assert (together == alone).all()
    repeated = least_cost_states(np.repeat(states, n, axis=1), allowed, weight, change)
    assert (repeated == alone).all()


@pytest.mark.parametrize("seed", range(20))
def test_the_best_way_leads_through_useful_states_whatever_else_is_barred(seed):
    """The best path uses only useful states, whatever else is barred."""
    rng = np.random.default_rng(seed)
    n, s = 9, 12
    states, is_known = rng.normal(size=(1, 1, s, 2)), rng.random((1, n, s)) > 0.6
    is_known[..., 0] = True
    allowed = is_known | (rng.random((1, n, s)) > 0.5)
    weight, change = rng.uniform(0.1, 1, (1, n)), rng.uniform(0, 2, (1, n - 1))
    useful = useful_states(states, allowed, is_known, weight, change)
    assert useful.sum() < allowed.sum()
    for share in (0.0, 0.3, 0.6, 1.0):
        true = is_known | (allowed & (rng.random((1, n, s)) > share))
        (path,) = least_cost_states(states, true, weight, change)
        assert useful[np.arange(n), path].all()
        (again,) = least_cost_states(states, true & useful, weight, change)
        assert (again == path).all()
