# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces of loops that a cut has taken apart, put together again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...types import Array

TOLERANCE_SHARE = 1e-7  # of the period; cuts meet there


def chain_windows(
    window_rings: Sequence[Sequence[Array]], cuts: Array
) -> tuple[list[tuple[Array, int]], list[Array]]:
    """Chain the rings of windows across the cuts between them.

    Returns the rings that go around the hub, each with its sense, and the closed rings.
    """
    turn = float(cuts[-1] - cuts[0])
    tolerance, count = TOLERANCE_SHARE * turn, len(cuts) - 1
    runs: list[Array] = []
    closed: list[Array] = []
    starts: list[tuple[int, float, int]] = []
    ends: list[tuple[int, float, int]] = []
    for window, rings in enumerate(window_rings):
        for ring in rings:
            side = np.where(np.abs(ring[:, 0] - cuts[window]) < tolerance, 1, 0)
            side = np.where(np.abs(ring[:, 0] - cuts[window + 1]) < tolerance, 2, side)
            on_cut = (side > 0) & (side == np.roll(side, -1))
            if not on_cut.any():
                closed.append(ring)
                continue
            first_cut = int(np.flatnonzero(on_cut)[0]) + 1
            ring, side, on_cut = (
                np.roll(column, -first_cut, axis=0) for column in (ring, side, on_cut)
            )
            borders = np.r_[-1, np.flatnonzero(on_cut)]
            for a, b in zip(borders + 1, borders[1:]):
                if b > a:
                    starts.append(
                        ((window + int(side[a] == 2)) % count, float(ring[a, 1]), len(runs))
                    )
                    ends.append(
                        ((window + int(side[b] == 2)) % count, float(ring[b, 1]), len(runs))
                    )
                    runs.append(ring[a : b + 1])
    successor = {}
    for (_, _, run), (_, _, following) in zip(sorted(ends), sorted(starts)):
        successor[run] = following
    rounds = []
    unused = set(range(len(runs)))
    while unused:
        run = min(unused)
        points: list[Array] = []
        while run in unused:
            unused.remove(run)
            run_points = runs[run]
            if points:
                shift = round((points[-1][-1, 0] - run_points[0, 0]) / turn) * turn
                run_points = run_points + np.array([shift, 0.0])
                points[-1] = points[-1][:-1]
            points.append(run_points)
            run = successor[run]
        loop = np.vstack(points)
        turns = round(float(loop[-1, 0] - loop[0, 0]) / turn)
        loop = loop[:-1]
        if turns:
            rounds.append((loop, turns))
        else:
            closed.append(loop)
    return rounds, closed
