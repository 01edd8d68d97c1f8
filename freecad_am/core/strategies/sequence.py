# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several features in one toolpath: their layers one feature after the other, or the lowest layer first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.obstacles import Body
from ..issues import InputError, Issue
from ..toolpath import Layer, Toolpath
from ..types import Array, Index

BY_FEATURE, BY_HEIGHT = "feature", "height"
FLOATS = 0.9  # of the length of a first layer; with so much of it over nothing a feature floats


def joined(
    toolpaths: Sequence[Toolpath], sequence: str, up: Array, bodies: Sequence[Body]
) -> Toolpath:
    """One toolpath of those of several features, each with its label, in the order of deposit.

    sequence: BY_FEATURE, one after the other, or BY_HEIGHT: of the next layers of all features the one whose lowest point is
    lowest along up (3,), of equal ones that of the feature named first; layers of one feature keep their order. bodies: what
    stands around all of them from the beginning. The frame is that of the first feature. Layers are numbered through, in
    issues too.
    """
    order = [(k, i) for k, one in enumerate(toolpaths) for i in range(len(one.layers))]
    if sequence == BY_HEIGHT:
        order = _lowest_first([_lowest(one.layers, up) for one in toolpaths])
    numbers = [np.zeros(len(one.layers), dtype=np.intp) for one in toolpaths]
    for number, (k, i) in enumerate(order):
        numbers[k][i] = number
    first = toolpaths[0]
    parts = [_telling_widths(one, first) for one in toolpaths]
    feeds = {one.wire_feed for one in toolpaths}
    return replace(
        first,
        layers=tuple(
            replace(parts[k].layers[i], feature=k, first=i == 0 or parts[k].layers[i].first)
            for k, i in order
        ),
        chord_error=min(one.chord_error for one in toolpaths),
        issues=tuple(
            issue for one, some in zip(toolpaths, numbers) for issue in renumbered(one.issues, some)
        ),
        surroundings=tuple(bodies),
        law=None,
        unsupported=None,
        on_part=None,
        volumes=None,
        twice=None,
        feature_label="",
        wire_feed=first.wire_feed if len(feeds) == 1 else None,
        features=tuple(replace(one, layers=(), issues=(), surroundings=()) for one in toolpaths),
        uneven=_uneven(toolpaths, numbers),
    )


def _uneven(toolpaths: Sequence[Toolpath], numbers: Sequence[Index]) -> Array | None:
    """Numbers, least and largest heights (k, 3) of the layers of all features that are not as high everywhere."""
    found = [
        np.column_stack([some[one.uneven[:, 0].astype(np.intp)], one.uneven[:, 1:]])
        for one, some in zip(toolpaths, numbers)
        if one.uneven is not None
    ]
    return np.vstack(found) if found else None


def renumbered(issues: Sequence[Issue], numbers: Index) -> tuple[Issue, ...]:
    """Issues of a feature as ones of a job with several, of which its layers have those numbers (n,)."""
    return tuple(
        issue if issue.layer is None else replace(issue, layer=int(numbers[issue.layer]))
        for issue in issues
    )


def with_feature(
    toolpath: Toolpath, number: int, feature: Toolpath, issues: Sequence[Issue]
) -> Toolpath:
    """The toolpath with what is now known of one of its features, and issues more, numbered through."""
    features = list(toolpath.features)
    features[number] = replace(feature, layers=(), issues=(), surroundings=())
    return replace(toolpath, features=tuple(features), issues=(*toolpath.issues, *issues))


def refuse_floating(toolpath: Toolpath, number: int, lengths: dict[int, float]) -> None:
    """Raise InputError FLOATS where nothing carries a feature: nearly all of its first layer lies over nothing. lengths: mm
    of beads over nothing, by layer."""
    part, numbers = toolpath.parts[number]
    length = sum(bead.length for bead in part.layers[0].beads)
    open_ = lengths.get(int(numbers[0]), 0.0)
    if open_ < FLOATS * length:
        return
    raise InputError(
        "FLOATS",
        part.feature_label,
        "nothing carries it: {:.4g} of {:.4g} mm of its first layer lie over nothing when "
        "they are deposited; move it onto what is there, give its substrate, or deposit first what it stands on",
        open_,
        length,
    )


def _lowest_first(heights: Sequence[Sequence[float]]) -> list[tuple[int, int]]:
    order: list[tuple[int, int]] = []
    at = [0] * len(heights)
    while any(at[k] < len(one) for k, one in enumerate(heights)):
        k = min(
            (k for k, one in enumerate(heights) if at[k] < len(one)),
            key=lambda k: (heights[k][at[k]], k),
        )
        order.append((k, at[k]))
        at[k] += 1
    return order


def _lowest(layers: Sequence[Layer], up: Array) -> list[float]:
    """The lowest point of each layer along up (3,), rounded, so that layers of equal height stay in the order of the
    features. A layer without beads comes right before the next of its feature."""
    lowest: list[float] = []
    above = np.inf
    for layer in reversed(layers):
        if layer.beads:
            above = round(min(float((bead.points @ up).min()) for bead in layer.beads), 6)
        lowest.append(above)
    return lowest[::-1]


def _telling_widths(toolpath: Toolpath, first: Toolpath) -> Toolpath:
    """The toolpath with beads that tell their width and height, where they are not those of the first feature."""
    if toolpath.bead_width is None or (
        (toolpath.bead_width, toolpath.layer_height) == (first.bead_width, first.layer_height)
    ):
        return toolpath
    wide, high = toolpath.bead_width, toolpath.layer_height
    return replace(
        toolpath,
        layers=tuple(
            replace(
                layer,
                beads=tuple(
                    replace(
                        bead,
                        width=np.full(len(bead), wide) if bead.width is None else bead.width,
                        height=np.full(len(bead), high) if bead.height is None else bead.height,
                    )
                    for bead in layer.beads
                ),
            )
            for layer in toolpath.layers
        ),
    )
