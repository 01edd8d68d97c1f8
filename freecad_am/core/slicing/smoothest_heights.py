# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find the smoothest layer within a band: heights along a line, smoothed until they meet a limit."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol, TypeVar

import numpy as np
from scipy.sparse import csc_matrix, diags, identity
from scipy.sparse.linalg import splu

from ..issues import InputError
from ..parameters.strategy import MOST_LAYERS
from ..types import Array


def refuse_too_many(layers: int, height: float, label: str) -> None:
    """Reject a part with too many layers.

    Parameters
    ----------
    layers : int
        Number of layers before the next layer.
    height : float
        Layer height, mm.
    label : str
        Name of the part, for the message.

    Raises
    ------
    InputError
        LAYER_HEIGHT if MOST_LAYERS is reached.
    """
    if layers >= MOST_LAYERS:
        raise InputError(
            "LAYER_HEIGHT",
            label,
            "more than {} layers of {:g} mm: use a larger layer height",
            MOST_LAYERS,
            height,
        )


WEIGHTS = 10.0 ** np.arange(-2, 10)  # weights of smoothness relative to the exact distance
# index of WEIGHTS; above it the turn rate is already much lower, or the band limits it, and the
# search ends after IDLE weights that each improve by less than the fraction GAIN
HEAVY = 7
GAIN, IDLE = 0.02, 2
AIM = 0.8  # fraction of the limit; reserve for higher layers, in which round corners get sharper
MARGIN = 0.02  # fraction of the band; reserve for the curve between its points
# alternating iteration: maximum steps, steps between convergence checks, over-relaxation, and
# tolerance between both solutions as a fraction of the band
ROUNDS, CHECK_INTERVAL, RELAXED, TOLERANCE_SHARE = 2000, 5, 1.6, 1e-3


class Weighed(Protocol):
    """Layer with its maximum turn rate within the wall, rad/mm, and the index of its weight."""

    @property
    def turn(self) -> float: ...

    @property
    def weight(self) -> int: ...


Layer = TypeVar("Layer", bound=Weighed)


def smooth_between(
    target: Array,
    low: Array,
    high: Array,
    weight: float,
    bend: Array | None = None,
    closed: bool = True,
) -> Array:
    """Smooth values between bounds.

    Minimises norm(x - target)^2 + weight norm(second differences + bend)^2 subject to low <= x <=
    high.

    Parameters
    ----------
    target : (n,) array
        Target values.
    low, high : (n,) array
        Bounds.
    weight : float
        Weight of the second differences.
    bend : (n,) or (n - 2,) array or None, optional
        Second differences of the datum from which x is measured, with or without the ends; None for
        a straight datum.
    closed : bool, optional
        Whether x is periodic.

    Returns
    -------
    (n,) array
        The smooth values, within the bounds to TOLERANCE_SHARE.

    Notes
    -----
    Alternating direction method of multipliers: a smooth solution and a bounded solution converge.
    The smooth solution is returned.
    """
    n = len(target)
    if closed:
        second = diags([1.0, 1.0, -2.0, 1.0, 1.0], [-(n - 1), -1, 0, 1, n - 1], shape=(n, n))
    else:
        second = diags([1.0, -2.0, 1.0], [0, 1, 2], shape=(n - 2, n))
    matrix = csc_matrix(identity(n) + weight * (second.T @ second))
    pull = 1.0 + np.sqrt(weight)
    solve = splu(csc_matrix(matrix + pull * identity(n))).solve
    goal = target if bend is None else target - weight * (second.T @ bend)
    bounded, debt = np.minimum(np.maximum(target, low), high), np.zeros(n)
    x = target
    for count in range(ROUNDS):
        x = solve(goal + pull * (bounded - debt))
        leaning = RELAXED * x + (1.0 - RELAXED) * bounded
        bounded = np.minimum(np.maximum(leaning + debt, low), high)
        debt = debt + leaning - bounded
        if (
            count % CHECK_INTERVAL == 0
            and np.abs(x - bounded).max() < TOLERANCE_SHARE * (high - low).max()
        ):
            break
    return x


def lightest(trial: Callable[[int], Layer | None], start: int, limit: float) -> Layer | None:
    """Find the layer with the lowest weight that keeps the limit of the turn rate.

    A higher weight lowers the turn rate until the band limits it. If the weight is too high, the
    layer leaves the band.

    Parameters
    ----------
    trial : callable
        Returns the layer for an index of WEIGHTS, or None if the layer leaves the band.
    start : int
        Index of WEIGHTS at which the search begins.
    limit : float
        Maximum turn rate within the wall, rad/mm.

    Returns
    -------
    Layer or None
        The layer; the layer with the lowest turn rate if none keeps the limit; None if all tested
        layers leave the band.
    """
    best = trial(start)
    for index in range(start - 1, -1, -1):
        if best is not None and best.turn > limit:
            break
        lighter = trial(index)
        if best is not None and (lighter is None or lighter.turn > limit):
            return best
        best = lighter
    if best is None or best.turn <= limit or best.weight < start:
        return best
    idle = 0
    for index in range(start + 1, len(WEIGHTS)):
        heavier = trial(index)
        if heavier is None:
            break
        idle = 0 if index <= HEAVY or heavier.turn < (1.0 - GAIN) * best.turn else idle + 1
        best = min(best, heavier, key=lambda layer: layer.turn)
        if best.turn <= limit or idle == IDLE:
            break
    return best
