# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sample beads and points of a toolpath for a plan that represents the whole toolpath."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..geometry.frames import TURN
from ..parameters.joints import GivenPolynomial
from ..toolpath import Bead, Toolpath
from ..types import Index

PER_TURN = 16  # target number of points kept per turn
# minimum number of points kept per turn where no more beads can be omitted; enough to see all
# sides and to unwrap axes
FEWEST_PER_TURN = 5
MIN_SEGMENTS = 8  # minimum number of segments kept in a bead, if the bead has as many

Place = tuple[int, int]


@dataclass(frozen=True)
class Sampled:
    """A sample of the beads and points of a toolpath.

    beads, points: strides; every n-th bead or point is kept. places: (layer, bead) of each sampled
    bead in the full toolpath, in print order.
    """

    toolpath: Toolpath
    beads: int
    points: int
    places: tuple[Place, ...]

    @property
    def is_complete(self) -> bool:
        """Whether the sample is the complete toolpath."""
        return self.beads == self.points == 1

    def select_given(self, polynomials: Sequence[GivenPolynomial]) -> tuple[GivenPolynomial, ...]:
        """Return the given polynomials of the sampled beads.

        Parameters
        ----------
        polynomials : sequence of GivenPolynomial
            Polynomials of `joints.given`, for the full toolpath.

        Returns
        -------
        tuple of GivenPolynomial
            The polynomials with the bead numbers of the sample.
        """
        sample_ids = {
            bead_id: (layer, bead) for bead_id, (layer, bead, _) in zip(self.places, self.toolpath)
        }
        return tuple(
            polynomial
            if polynomial.bead is None
            else replace(polynomial, bead=sample_ids[polynomial.bead])
            for polynomial in polynomials
            if polynomial.bead is None or polynomial.bead in sample_ids
        )


def sample_toolpath(toolpath: Toolpath, max_points: int, together: int = 1) -> Sampled:
    """Sample beads and points of a toolpath.

    The first and last bead are kept, and the ends of every bead. Layers keep their numbers; beads
    are renumbered. The chord error grows with the point spacing. A few beads with very many turns
    keep more points than requested.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    max_points : int
        Target number of points; a smaller toolpath is kept complete.
    together : int, optional
        Number of consecutive beads kept as a group.

    Returns
    -------
    Sampled
        The sample.
    """
    all_beads = list(toolpath)
    total = toolpath.point_count
    if total <= max_points:
        return Sampled(toolpath, 1, 1, tuple((layer, index) for layer, index, _ in all_beads))
    points = _one_in([bead for _, _, bead in all_beads], max_points, PER_TURN)
    stride_needed = math.ceil(
        sum(len(_select_points(bead, points)) for _, _, bead in all_beads) / max_points
    )
    beads = min(stride_needed, max(1, len(all_beads) - 1))
    kept_beads = [
        entry for k, entry in enumerate(all_beads[:-1]) if k % (together * beads) < together
    ] + all_beads[-1:]
    if beads < stride_needed:  # no more beads can be omitted
        points = max(
            points, _one_in([bead for _, _, bead in kept_beads], max_points, FEWEST_PER_TURN)
        )
    thinned_beads: list[list[Bead]] = [[] for _ in toolpath.layers]
    for bead_layer, _, bead in kept_beads:
        thinned_beads[bead_layer].append(bead.thinned(_select_points(bead, points)))
    layers = tuple(
        replace(layer, beads=tuple(layer_beads))
        for layer, layer_beads in zip(toolpath.layers, thinned_beads)
    )
    return Sampled(
        replace(toolpath, layers=layers, chord_error=toolpath.chord_error * points**2),
        beads,
        points,
        tuple((layer, index) for layer, index, _ in kept_beads),
    )


def _one_in(beads: Sequence[Bead], max_points: int, per_turn: int) -> int:
    """Return the point stride for about `max_points` points, with at least `per_turn` a turn."""
    total = sum(map(len, beads))
    turns = sum(abs(float(bead.parameter[-1] - bead.parameter[0])) for bead in beads) / TURN
    return max(1, min(math.ceil(total / max_points), int(total / (per_turn * max(turns, 1.0)))))


def _select_points(bead: Bead, points: int) -> Index:
    """Return the indices of the kept points of a bead.

    The stride is `points`, or smaller in a short bead and in turns with few points.
    """
    last_index = len(bead) - 1
    step = max(1, min(points, last_index // MIN_SEGMENTS))
    share = np.abs(np.diff(bead.parameter)) * (FEWEST_PER_TURN / TURN)
    passed = np.floor(np.cumsum(np.maximum(1.0, step * share)) / step)
    return np.asarray(
        np.unique(np.r_[0, np.flatnonzero(np.diff(passed, prepend=0.0) >= 1.0) + 1, last_index])
    )
