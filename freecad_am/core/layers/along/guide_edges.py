# SPDX-License-Identifier: LGPL-2.1-or-later
"""Edges joined to a guide curve: end to end, without gaps, forks and corners."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...geometry.formatting import place
from ...issues import InputError
from ...types import Array

TOUCHING = 1e-3  # mm between the ends of edges that meet
CORNER_RAD = np.radians(1.0)
MIN_LENGTH_MM = 1e-3  # mm; shorter edges, and guides, are none
MAX_TURN_RAD = np.radians(120.0)  # a corner that turns by more leads back
WHERE = "strategy.guide"


class Nodes(NamedTuple):
    """Points (n, 3) mm of a curve and unit vectors (n, 3) along it."""

    points: Array
    tangents: Array

    def reversed(self) -> Nodes:
        """The same the other way."""
        return Nodes(self.points[::-1], -self.tangents[::-1])


def chain_edges(edges: Sequence[Nodes]) -> Nodes:
    """Return one curve of edges in any order and direction; it runs as the first given edge
    does.

    Raises InputError GUIDE_OPEN, GUIDE_CLOSED, GUIDE_CORNER, GUIDE_DOUBLES_BACK.
    """
    remaining = [
        edge
        for edge in edges
        if np.linalg.norm(np.diff(edge.points, axis=0), axis=1).sum() > MIN_LENGTH_MM
    ]
    if not remaining:
        raise InputError(
            "GUIDE_OPEN",
            WHERE,
            "the guide has no edge with any length; choose edges, a wire or a sketch",
        )
    chain = [remaining.pop(0)]
    while remaining:
        ends = chain[0].points[0], chain[-1].points[-1]
        match = next(
            (
                (k, behind, edge if straight else edge.reversed())
                for k, edge in enumerate(remaining)
                for behind, end in ((True, ends[1]), (False, ends[0]))
                for straight in (True, False)
                if np.linalg.norm(edge.points[0 if straight == behind else -1] - end) < TOUCHING
            ),
            None,
        )
        if match is None:
            gap = min(
                float(np.linalg.norm(edge.points[k] - end))
                for edge in remaining
                for k in (0, -1)
                for end in ends
            )
            raise InputError(
                "GUIDE_OPEN",
                WHERE,
                "its edges do not form one curve: {} of {} are disconnected, at {} and {}, and "
                "the smallest gap is {:.3g} mm; choose edges that meet end to end",
                len(remaining),
                len(edges),
                place(ends[0]),
                place(ends[1]),
                gap,
            )
        k, behind, edge = match
        remaining.pop(k)
        chain = [*chain, edge] if behind else [edge, *chain]
    _refuse_corners(chain)
    if np.linalg.norm(chain[0].points[0] - chain[-1].points[-1]) < TOUCHING:
        raise InputError(
            "GUIDE_CLOSED",
            WHERE,
            "it returns to its start, at {}, so the last layer would overlap the first; remove "
            "one edge",
            place(chain[0].points[0]),
        )
    return Nodes(
        np.vstack([chain[0].points[:1], *(edge.points[1:] for edge in chain)]),
        np.vstack([chain[0].tangents[:1], *(edge.tangents[1:] for edge in chain)]),
    )


def _refuse_corners(chain: Sequence[Nodes]) -> None:
    for edge, next_edge in zip(chain, chain[1:]):
        turn = float(np.arccos(np.clip(edge.tangents[-1] @ next_edge.tangents[0], -1.0, 1.0)))
        position = place(next_edge.points[0])
        if turn > MAX_TURN_RAD:
            raise InputError(
                "GUIDE_DOUBLES_BACK",
                WHERE,
                "it turns back by {:.4g} deg at {}: layers would cut through the deposit; choose "
                "edges that lead forward",
                np.degrees(turn),
                position,
            )
        if turn > CORNER_RAD:
            raise InputError(
                "GUIDE_CORNER",
                WHERE,
                "it has a corner of {:.3g} deg at {}, where layers would have zero height on the "
                "inside; round it with a radius, or choose guide: auto",
                np.degrees(turn),
                position,
            )
