# SPDX-License-Identifier: LGPL-2.1-or-later
"""A toolpath that is planned at once: of many beads some, and of these some points."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry.angles import TURN
from ..parameters.joints import given_polynomials
from ..toolpath import Bead, Toolpath
from ..types import Index

PER_TURN = 16  # points of a turn that are kept, about
FEWEST_PER_TURN = 5  # where beads of many turns are too few to leave some out: all sides are seen, axes still counted on
LEAST = 8  # segments of a bead that are kept where it has so many

Place = tuple[int, int]


@dataclass(frozen=True)
class Sampled:
    """Some beads and points of a toolpath. beads, points: of how many one is among them, 1 where all are. places: (layer,
    bead) that each of the beads has in the whole, in the order of deposit."""

    toolpath: Toolpath
    beads: int
    points: int
    places: tuple[Place, ...]

    @property
    def whole(self) -> bool:
        """Whether it is all of the toolpath."""
        return self.beads == self.points == 1

    def given(self, given: Sequence[str]) -> tuple[str, ...]:
        """Entries of `joints.given` for the whole, told of the beads as they are numbered here; without those of beads that
        are left out."""
        here = {place: (layer, bead) for place, (layer, bead, _) in zip(self.places, self.toolpath)}
        issues = []
        for entry, place in zip(given, given_polynomials(tuple(given))):
            if place is None:
                issues.append(entry)
            elif place in here:
                layer, bead = here[place]
                issues.append(f"{layer}/{bead}:{entry.partition(':')[2]}")
        return tuple(issues)


def sampled(toolpath: Toolpath, most: int, together: int = 1) -> Sampled:
    """About `most` points of a toolpath, all of it where it has no more. The first and last bead are among those that are
    kept, and the ends of each; layers keep their numbers, beads not. The chord error grows as that of the points does.
    More are kept of a few beads that have very many turns. together: so many beads that follow each other are kept of so
    many times as many, where some are left out."""
    every = list(toolpath)
    total = toolpath.point_count
    if total <= most:
        return Sampled(toolpath, 1, 1, tuple((layer, index) for layer, index, _ in every))
    points = _one_in([bead for _, _, bead in every], most, PER_TURN)
    wanted = math.ceil(sum(len(_kept(bead, points)) for _, _, bead in every) / most)
    beads = min(wanted, max(1, len(every) - 1))
    chosen = [one for k, one in enumerate(every[:-1]) if k % (together * beads) < together] + every[
        -1:
    ]
    if beads < wanted:  # there are no more beads to leave out
        points = max(points, _one_in([bead for _, _, bead in chosen], most, FEWEST_PER_TURN))
    layers = tuple(
        replace(
            layer,
            beads=tuple(
                bead.thinned(_kept(bead, points)) for place, _, bead in chosen if place == number
            ),
        )
        for number, layer in enumerate(toolpath.layers)
    )
    return Sampled(
        replace(toolpath, layers=layers, chord_error=toolpath.chord_error * points**2),
        beads,
        points,
        tuple((layer, index) for layer, index, _ in chosen),
    )


def _one_in(beads: Sequence[Bead], most: int, per_turn: int) -> int:
    """Of how many points of beads one is kept for about `most`, but `per_turn` of each turn."""
    total = sum(map(len, beads))
    turns = sum(abs(float(bead.parameter[-1] - bead.parameter[0])) for bead in beads) / TURN
    return max(1, min(math.ceil(total / most), int(total / (per_turn * max(turns, 1.0)))))


def _kept(bead: Bead, points: int) -> Index:
    """The numbers of the points of a bead that are kept: one of so many, more of a short one and of turns with few."""
    last = len(bead) - 1
    step = max(1, min(points, last // LEAST))
    share = np.abs(np.diff(bead.parameter)) * (FEWEST_PER_TURN / TURN)
    passed = np.floor(np.cumsum(np.maximum(1.0, step * share)) / step)
    return np.asarray(
        np.unique(np.r_[0, np.flatnonzero(np.diff(passed, prepend=0.0) >= 1.0) + 1, last])
    )
