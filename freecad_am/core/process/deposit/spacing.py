# SPDX-License-Identifier: LGPL-2.1-or-later
"""How far layers really are apart: from each deposit point to the nearest point of the layer before."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

import numpy as np

from ...toolpath import Bead, Layer, Toolpath
from ...types import Array, Index, Mask
from .layer_curve import Curve, columns_of, distance, distances

LEVEL = 1e-6  # mm; a layer whose points differ no more in height is a plane


def between_layers(toolpath: Toolpath) -> tuple[Array, ...]:
    """Per layer but the first, (n,) mm: the distance of each of its points to the layer before, in order of deposit.

    A spiral is one layer; there it is the distance of each point to the turn before. Of plane layers that are filled it is
    the distance of the planes: how far the nearest bead below is says how beads lie beside each other, not above. Beads that
    close gaps are left out, and layers that nothing of the feature lies below. Of several features those of one come after
    those of the other.
    """
    if toolpath.features:
        return tuple(
            chain.from_iterable(between_layers(part) for part, _ in toolpath.parts if part.layers)
        )
    toolpath = toolpath.deposited
    if is_spiral(toolpath):
        return between_turns(toolpath.layers[0].beads[0])
    heights = _planes(toolpath)
    if heights is not None:
        return tuple(
            np.full(count, above - below)
            for below, above, layer in zip(heights, heights[1:], toolpath.layers[1:])
            if not layer.first
            and (count := sum(len(bead) for bead in layer.beads if not bead.closing))
        )
    above = [
        [] if layer.first else [bead.points for bead in layer.beads if not bead.closing]
        for layer in toolpath.layers[1:]
    ]
    return tuple(
        distances(
            (np.concatenate(points), curve_of(below))
            for below, points in zip(toolpath.layers, above, strict=False)
            if points
        )
    )


def local_distances(toolpath: Toolpath) -> tuple[Array, ...]:
    """Per bead in the order of deposit, (n,) mm: the distance of each of its points to the layer before.

    NaN where nothing of the feature lies below: in first layers, and in the first turn of a spiral.
    """
    if toolpath.features:
        each: list[list[Array]] = [[] for _ in toolpath.layers]
        for part, numbers in toolpath.parts:
            places = (
                number
                for number, layer in zip(numbers.tolist(), part.layers, strict=True)
                for _ in layer.beads
            )
            for number, values in zip(
                places, local_distances(part) if part.layers else (), strict=True
            ):
                each[number].append(values)
        return tuple(chain.from_iterable(each))
    toolpath = toolpath.deposited
    if is_spiral(toolpath):
        bead = toolpath.layers[0].beads[0]
        found = np.full(len(bead), np.nan)
        for mine, before in _quarters(bead):
            found[mine] = distance(bead.points[mine], before)
        return (found,)
    heights = _planes(toolpath)
    if heights is not None:
        apart = np.where(
            [layer.first for layer in toolpath.layers], np.nan, np.diff(heights, prepend=np.nan)
        )
        return tuple(np.full(len(bead), apart[layer]) for layer, _, bead in toolpath)
    done = [np.full(len(bead), np.nan) for bead in toolpath.layers[0].beads]
    for below, layer in zip(toolpath.layers, toolpath.layers[1:], strict=False):
        if layer.first:
            done += [np.full(len(bead), np.nan) for bead in layer.beads]
            continue
        apart = distance(np.concatenate([bead.points for bead in layer.beads]), curve_of(below))
        done += np.split(apart, np.cumsum([len(bead) for bead in layer.beads])[:-1])
    return tuple(done)


def between_turns(bead: Bead) -> tuple[Array, ...]:
    """Per quarter turn after the first turn, (n,) mm: the distance of its points to the stretch one turn before.

    The stretch is three quarters of a turn long, so that it holds the nearest point but not the points' own neighbours.
    """
    return tuple(distance(bead.points[mine], before) for mine, before in _quarters(bead))


def is_spiral(toolpath: Toolpath) -> bool:
    """Whether a toolpath is a part of revolution laid as one rising bead."""
    beads = toolpath.layers[0].beads
    return (
        len(toolpath.layers) == 1
        and len(beads) == 1
        and not beads[0].closed
        and toolpath.family == "revolution"
    )


def is_plane(toolpath: Toolpath) -> bool:
    """Whether the layers are planes that are filled, whose distance is told; of several features, all."""
    return all(_planes(part) is not None for part, _ in toolpath.parts)


def _planes(toolpath: Toolpath) -> Array | None:
    """(layers,) mm along the Z of the frame, where layers are filled planes square to it; else None."""
    toolpath = toolpath.deposited
    if toolpath.family != "solid":
        return None
    up = toolpath.frame[:3, 2]
    ends = np.array(
        [
            [(near := np.concatenate([bead.points for bead in layer.beads]) @ up).min(), near.max()]
            for layer in toolpath.layers
        ]
    )
    return ends.mean(axis=1) if (np.ptp(ends, axis=1) <= LEVEL).all() else None


def turns_of(bead: Bead) -> Index:
    """The number (n,) of the turn that each point of a spiral is in, from 0."""
    turned = np.abs(bead.parameter - bead.parameter[0]) / (2.0 * np.pi)
    last = max(int(np.ceil(turned[-1] - 1e-6)) - 1, 0)
    turns: Index = np.minimum((turned + 1e-9).astype(np.intp), last)
    return turns


def _quarters(bead: Bead) -> Iterator[tuple[Mask, Curve]]:
    """Per quarter turn after the first turn: which points (n,) are its, and the stretch one turn before."""
    angle = np.abs(bead.parameter - bead.parameter[0])
    quarter = 0.5 * np.pi
    for start in np.arange(4.0 * quarter, np.nextafter(angle[-1], np.inf), quarter):
        mine = (angle >= start) & (angle < start + quarter)
        first, last = np.searchsorted(angle, (start - 5.0 * quarter, start - 2.0 * quarter))
        first = max(int(first) - 1, 0)
        if mine.any() and last - first > 1:
            yield mine, Curve(*columns_of(bead.points[first : int(last) + 1], closed=False))


def curve_of(layer: Layer) -> Curve:
    """The smooth curve through the points of a layer's beads."""
    pieces = [columns_of(bead.points, bead.closed, bead.tangents) for bead in layer.beads]
    return Curve(*(np.concatenate(columns) for columns in zip(*pieces, strict=True)))
