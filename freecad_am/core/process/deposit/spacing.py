# SPDX-License-Identifier: LGPL-2.1-or-later
"""Actual layer spacing: the distance from each deposit point to the nearest point of the layer before."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

import numpy as np

from ...toolpath import Bead, Layer, Toolpath
from ...types import Array, Index, Mask
from .layer_curve import Curve, columns_of, distance, distances

PLANE_TOLERANCE_MM = 1e-6  # mm; a layer whose points differ no more in height is a plane


def between_layers(toolpath: Toolpath) -> tuple[Array, ...]:
    """Per layer after the first, (n,) mm: the distance of each of its points to the layer before, in order of deposit.

    A spiral is one layer; there it is the distance of each point to the turn before. For plane filled layers it is the distance
    of the planes, because the nearest bead below gives the spacing within a layer. Beads that close gaps, and layers with nothing
    of the feature below, are left out. Several features follow each other.
    """
    if toolpath.features:
        return tuple(
            chain.from_iterable(
                between_layers(feature) for feature, _ in toolpath.parts if feature.layers
            )
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

    NaN if nothing of the feature is below: in first layers, and in the first turn of a spiral.
    """
    if toolpath.features:
        by_layer: list[list[Array]] = [[] for _ in toolpath.layers]
        for feature, numbers in toolpath.parts:
            bead_layers = (
                number
                for number, layer in zip(numbers.tolist(), feature.layers, strict=True)
                for _ in layer.beads
            )
            for number, values in zip(
                bead_layers, local_distances(feature) if feature.layers else (), strict=True
            ):
                by_layer[number].append(values)
        return tuple(chain.from_iterable(by_layer))
    toolpath = toolpath.deposited
    if is_spiral(toolpath):
        bead = toolpath.layers[0].beads[0]
        values_ = np.full(len(bead), np.nan)
        for quarter, stretch in _quarters(bead):
            values_[quarter] = distance(bead.points[quarter], stretch)
        return (values_,)
    heights = _planes(toolpath)
    if heights is not None:
        gap = np.where(
            [layer.first for layer in toolpath.layers], np.nan, np.diff(heights, prepend=np.nan)
        )
        return tuple(np.full(len(bead), gap[layer]) for layer, _, bead in toolpath)
    distances_ = [np.full(len(bead), np.nan) for bead in toolpath.layers[0].beads]
    for below, layer in zip(toolpath.layers, toolpath.layers[1:], strict=False):
        if layer.first:
            distances_ += [np.full(len(bead), np.nan) for bead in layer.beads]
            continue
        gap = distance(np.concatenate([bead.points for bead in layer.beads]), curve_of(below))
        distances_ += np.split(gap, np.cumsum([len(bead) for bead in layer.beads])[:-1])
    return tuple(distances_)


def between_turns(bead: Bead) -> tuple[Array, ...]:
    """Per quarter turn after the first turn, (n,) mm: the distance of its points to the stretch one turn before.

    The stretch is three quarters of a turn long, so that it holds the nearest point but not the points' own neighbours.
    """
    return tuple(distance(bead.points[quarter], stretch) for quarter, stretch in _quarters(bead))


def is_spiral(toolpath: Toolpath) -> bool:
    """Whether a toolpath is a part of revolution deposited as one rising bead."""
    beads = toolpath.layers[0].beads
    return (
        len(toolpath.layers) == 1
        and len(beads) == 1
        and not beads[0].closed
        and toolpath.traits.has_axis
    )


def is_plane(toolpath: Toolpath) -> bool:
    """Whether every feature has plane filled layers, whose distance is reported."""
    return all(_planes(feature) is not None for feature, _ in toolpath.parts)


def _planes(toolpath: Toolpath) -> Array | None:
    """(layers,) mm along the Z of the frame, where layers are filled planes square to it; else None."""
    toolpath = toolpath.deposited
    if not toolpath.traits.stacks_layers:
        return None
    up = toolpath.frame[:3, 2]
    ends = np.array(
        [
            [
                (heights := np.concatenate([bead.points for bead in layer.beads]) @ up).min(),
                heights.max(),
            ]
            for layer in toolpath.layers
        ]
    )
    return ends.mean(axis=1) if (np.ptp(ends, axis=1) <= PLANE_TOLERANCE_MM).all() else None


def turns_of(bead: Bead) -> Index:
    """The number (n,) of the turn that each point of a spiral is in, from 0."""
    turned = np.abs(bead.parameter - bead.parameter[0]) / (2.0 * np.pi)
    last_turn = max(int(np.ceil(turned[-1] - 1e-6)) - 1, 0)
    turns: Index = np.minimum((turned + 1e-9).astype(np.intp), last_turn)
    return turns


def _quarters(bead: Bead) -> Iterator[tuple[Mask, Curve]]:
    """Per quarter turn after the first turn: which points (n,) are its, and the stretch one turn before."""
    angle = np.abs(bead.parameter - bead.parameter[0])
    quarter = 0.5 * np.pi
    for start in np.arange(4.0 * quarter, np.nextafter(angle[-1], np.inf), quarter):
        in_quarter = (angle >= start) & (angle < start + quarter)
        start_row, end_row = np.searchsorted(angle, (start - 5.0 * quarter, start - 2.0 * quarter))
        start_row = max(int(start_row) - 1, 0)
        if in_quarter.any() and end_row - start_row > 1:
            yield (
                in_quarter,
                Curve(*columns_of(bead.points[start_row : int(end_row) + 1], closed=False)),
            )


def curve_of(layer: Layer) -> Curve:
    """The smooth curve through the points of a layer's beads."""
    segments = [columns_of(bead.points, bead.closed, bead.tangents) for bead in layer.beads]
    return Curve(*(np.concatenate(columns) for columns in zip(*segments, strict=True)))
