# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ways through states: as good as the best of all ways there are."""

from itertools import product

import numpy as np
import pytest

from freecad_am.core.strategies.clearance.tilt_search import BARRED, least_cost_states


def cost(states, allowed, weight, change, way):
    n = len(way)
    own = sum(
        weight[k] * (states[k, way[k]] ** 2).sum() if allowed[k, way[k]] else BARRED
        for k in range(n)
    )
    return own + sum(
        change[k] * ((states[k, way[k]] - states[k + 1, way[k + 1]]) ** 2).sum()
        for k in range(n - 1)
    )


@pytest.mark.parametrize("same", [False, True], ids=["own states", "the same states"])
@pytest.mark.parametrize("seed", range(5))
def test_no_way_is_better(seed, same):
    rng = np.random.default_rng(seed)
    b, n, s = 3, 5, 4
    states = rng.normal(size=(1, 1, s, 2) if same else (b, n, s, 2))
    allowed = rng.random((b, n, s)) > 0.4
    weight, change = rng.uniform(0.1, 1, (b, n)), rng.uniform(0, 2, (b, n - 1))
    found = least_cost_states(states, allowed, weight, change)
    for k in range(b):
        own = np.broadcast_to(states[0] if same else states[k], (n, s, 2))
        best = min(
            cost(own, allowed[k], weight[k], change[k], way) for way in product(range(s), repeat=n)
        )
        assert cost(own, allowed[k], weight[k], change[k], found[k]) == pytest.approx(
            best, rel=1e-12
        )
