# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tree of a wall's fronts: splits, merges, and cuts by an end of the wall."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...issues import NOTE, Issue, Text
from ...slicing.fronts.rims import Rims, nearest_feet

SAMPLES = 100  # sample points along a front for its parents
LEAST_COMMON = 2  # of the samples; fewer are a touch at an end


@dataclass(eq=False)
class Piece:
    """A front. parents: the fronts of the layer below that support it, the largest share first. cut: ends at an upper edge of the
    wall. closing: not a front but a bead that closes a gap between fronts.
    """

    curve: SpaceCurve
    parents: list[Piece]
    cut: bool
    children: list[Piece] = field(default_factory=list)
    closing: bool = False


def tree(fronts: list[list[SpaceCurve]], rims: Rims) -> list[list[Piece]]:
    """The pieces of each layer."""
    layers: list[list[Piece]] = []
    for layer in fronts:
        below = layers[-1] if layers else []
        pieces = [Piece(front, _parents(front, below), rims.ends_of(front)) for front in layer]
        for piece in pieces:
            for parent in piece.parents:
                parent.children.append(piece)
        layers.append(pieces)
    return layers


def _parents(front: SpaceCurve, below: list[Piece]) -> list[Piece]:
    if len(below) < 2:
        return list(below)
    points = front.at(
        np.linspace(front.w[0], front.w[-1], SAMPLES + 1)[:-1] + 0.5 * front.period / SAMPLES
    )[0]
    count = np.bincount(
        nearest_feet([piece.curve for piece in below], points).front, minlength=len(below)
    )
    order = np.argsort(-count, kind="stable")
    return [below[k] for k in order if count[k] >= LEAST_COMMON]


def events(layers: list[list[Piece]]) -> list[Issue]:
    """Where fronts split and merge, a note for each layer in which they do."""
    issues = []
    for index, layer in enumerate(layers[1:], 1):
        splits = Counter(
            len(piece.children) for piece in layers[index - 1] if len(piece.children) > 1
        )
        merges = Counter(len(piece.parents) for piece in layer if len(piece.parents) > 1)
        for code, counts, singular, plural in (
            (
                "SPLIT",
                splits,
                "a front splits in {} at layer {}",
                "{2} fronts split in {0} each at layer {1}",
            ),
            (
                "MERGE",
                merges,
                "{} fronts merge at layer {}",
                "{0} fronts merge, in {2} places, at layer {1}",
            ),
        ):
            issues += [
                Issue(
                    NOTE, code, Text(singular if count == 1 else plural, size, index, count), index
                )
                for size, count in sorted(counts.items())
            ]
    return issues


def uncut_pieces(layers: list[list[Piece]]) -> list[list[Piece]]:
    """The pieces that no end cuts off, on others of their kind."""
    kept_layers: list[list[Piece]] = []
    for layer in layers:
        below = set(kept_layers[-1]) if kept_layers else set()
        uncut = [piece for piece in layer if not piece.cut and below.issuperset(piece.parents)]
        if not uncut:
            break
        kept_layers.append(uncut)
    return _pruned(kept_layers)


def drop_short_pieces(layers: list[list[Piece]], shortest: float) -> tuple[list[list[Piece]], int]:
    """Remove the pieces shorter than `shortest` mm without a piece above, and count them."""
    dropped: set[Piece] = set()
    for layer in reversed(layers):
        dropped.update(
            piece
            for piece in layer
            if piece.curve.length < shortest and dropped.issuperset(piece.children)
        )
    kept_layers = [[piece for piece in layer if piece not in dropped] for layer in layers]
    return _pruned([layer for layer in kept_layers if layer]), len(dropped)


def _pruned(layers: list[list[Piece]]) -> list[list[Piece]]:
    """The same pieces, with links only among themselves."""
    remaining = {piece for layer in layers for piece in layer}
    for piece in remaining:
        piece.children = [child for child in piece.children if child in remaining]
    return layers
