# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pieces of loops that a cut has taken apart, put together again."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...types import Array

MEETING = 1e-7  # of the period; cuts meet there


def chained(
    pieces: Sequence[Sequence[Array]], cuts: Array
) -> tuple[list[tuple[Array, int]], list[Array]]:
    """Rings of windows put together where cuts went through: those that go round with their sense, and closed ones."""
    turn = float(cuts[-1] - cuts[0])
    near, count = MEETING * turn, len(cuts) - 1
    runs: list[Array] = []
    closed: list[Array] = []
    starts: list[tuple[int, float, int]] = []
    ends: list[tuple[int, float, int]] = []
    for window, rings in enumerate(pieces):
        for ring in rings:
            side = np.where(np.abs(ring[:, 0] - cuts[window]) < near, 1, 0)
            side = np.where(np.abs(ring[:, 0] - cuts[window + 1]) < near, 2, side)
            on_cut = (side > 0) & (side == np.roll(side, -1))
            if not on_cut.any():
                closed.append(ring)
                continue
            first = int(np.flatnonzero(on_cut)[0]) + 1
            ring, side, on_cut = (np.roll(part, -first, axis=0) for part in (ring, side, on_cut))
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
    after = {}
    for (_, _, run), (_, _, following) in zip(sorted(ends), sorted(starts)):
        after[run] = following
    rounds = []
    left = set(range(len(runs)))
    while left:
        run = min(left)
        points: list[Array] = []
        while run in left:
            left.remove(run)
            piece = runs[run]
            if points:
                shift = round((points[-1][-1, 0] - piece[0, 0]) / turn) * turn
                piece = piece + np.array([shift, 0.0])
                points[-1] = points[-1][:-1]
            points.append(piece)
            run = after[run]
        loop = np.vstack(points)
        turns = round(float(loop[-1, 0] - loop[0, 0]) / turn)
        loop = loop[:-1]
        if turns:
            rounds.append((loop, turns))
        else:
            closed.append(loop)
    return rounds, closed
