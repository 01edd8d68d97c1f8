# SPDX-License-Identifier: LGPL-2.1-or-later
"""Several features in one toolpath, feature by feature or lowest layer first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..geometry.obstacles import Body
from ..issues import InputError, Issue
from ..toolpath import Bead, Layer, SequencedFeature, Toolpath
from ..types import Array, Index

BY_FEATURE, BY_HEIGHT = "feature", "height"
FLOATS = 0.9  # minimum unsupported fraction of the first layer's length of a floating feature


def join_toolpaths(
    toolpaths: Sequence[Toolpath],
    labels: Sequence[str],
    sequence: str,
    up: Array,
    bodies: Sequence[Body],
) -> Toolpath:
    """Join the toolpaths of several features in print order.

    The frame is the frame of the first feature. Layers are numbered consecutively, also in issues.

    Parameters
    ----------
    toolpaths : sequence of Toolpath
        Toolpath of each feature.
    labels : sequence of str
        Label of each feature.
    sequence : str
        BY_FEATURE, feature by feature, or BY_HEIGHT. By height, the next layer is the layer with
        the lowest point; in a tie, the layer of the first feature. The layers of a feature keep
        their order.
    up : (3,) array
        Direction of the height.
    bodies : sequence of Body
        Obstacles for all features from the beginning.

    Returns
    -------
    Toolpath
        The toolpath of all features.
    """
    order = [(k, i) for k, toolpath in enumerate(toolpaths) for i in range(len(toolpath.layers))]
    if sequence == BY_HEIGHT:
        order = _lowest_first([_lowest(toolpath.layers, up) for toolpath in toolpaths])
    numbers = [np.zeros(len(toolpath.layers), dtype=np.intp) for toolpath in toolpaths]
    for number, (k, i) in enumerate(order):
        numbers[k][i] = number
    first_path = toolpaths[0]
    sized = [_add_bead_sizes(toolpath, first_path) for toolpath in toolpaths]
    feeds = {toolpath.wire_feed for toolpath in toolpaths}
    return replace(
        first_path,
        layers=tuple(
            replace(sized[k].layers[i], feature=k, first=i == 0 or sized[k].layers[i].first)
            for k, i in order
        ),
        chord_error=min(toolpath.chord_error for toolpath in toolpaths),
        issues=tuple(
            issue
            for toolpath, layer_numbers in zip(toolpaths, numbers)
            for issue in renumbered(toolpath.issues, layer_numbers)
        ),
        surroundings=tuple(bodies),
        law=None,
        wire_feed=first_path.wire_feed if len(feeds) == 1 else None,
        features=tuple(
            SequencedFeature(label, _without_layers(toolpath))
            for label, toolpath in zip(labels, toolpaths, strict=True)
        ),
        checks=replace(
            first_path.checks,
            unsupported=None,
            on_part=None,
            volumes=None,
            twice=None,
            uneven=_uneven(toolpaths, numbers),
        ),
    )


def _without_layers(toolpath: Toolpath) -> Toolpath:
    return replace(toolpath, layers=(), issues=(), surroundings=())


def _uneven(toolpaths: Sequence[Toolpath], numbers: Sequence[Index]) -> Array | None:
    """Return index, minimum and maximum height (k, 3) of the features' layers of uneven height."""
    rows = [
        np.column_stack(
            [
                layer_numbers[toolpath.checks.uneven[:, 0].astype(np.intp)],
                toolpath.checks.uneven[:, 1:],
            ]
        )
        for toolpath, layer_numbers in zip(toolpaths, numbers)
        if toolpath.checks.uneven is not None
    ]
    return np.vstack(rows) if rows else None


def renumbered(issues: Sequence[Issue], numbers: Index) -> tuple[Issue, ...]:
    """Return the issues of a feature with layer indices of the job.

    Parameters
    ----------
    issues : sequence of Issue
        Issues with layers of the feature.
    numbers : (n,) int array
        Index in the job of each layer of the feature.

    Returns
    -------
    tuple of Issue
        The issues.
    """
    return tuple(
        issue if issue.layer is None else replace(issue, layer=int(numbers[issue.layer]))
        for issue in issues
    )


def update_feature(
    toolpath: Toolpath, number: int, feature: Toolpath, issues: Sequence[Issue]
) -> Toolpath:
    """Return the toolpath with an updated feature and additional issues.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath of all features.
    number : int
        Index of the feature.
    feature : Toolpath
        Toolpath of the feature.
    issues : sequence of Issue
        Issues with layers of the job.

    Returns
    -------
    Toolpath
        The toolpath.
    """
    features = list(toolpath.features)
    features[number] = replace(features[number], values=_without_layers(feature))
    return replace(toolpath, features=tuple(features), issues=(*toolpath.issues, *issues))


def refuse_floating(toolpath: Toolpath, number: int, lengths: dict[int, float]) -> None:
    """Reject a feature whose first layer is almost entirely unsupported.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath of all features.
    number : int
        Index of the feature.
    lengths : dict[int, float]
        Unsupported bead length by layer, mm.

    Raises
    ------
    InputError
        FLOATS if nothing supports the feature.
    """
    feature, numbers = toolpath.parts[number]
    length = sum(bead.length for bead in feature.layers[0].beads)
    open_ = lengths.get(int(numbers[0]), 0.0)
    if open_ < FLOATS * length:
        return
    raise InputError(
        "FLOATS",
        toolpath.features[number].label,
        "the feature has no support: {:.4g} of {:.4g} mm of its first layer are unsupported when "
        "deposited; move the feature onto the existing part, set its substrate, or deposit its "
        "support first",
        open_,
        length,
    )


def _lowest_first(heights: Sequence[Sequence[float]]) -> list[tuple[int, int]]:
    order: list[tuple[int, int]] = []
    next_index = [0] * len(heights)
    while any(next_index[k] < len(layer_heights) for k, layer_heights in enumerate(heights)):
        k = min(
            (k for k, layer_heights in enumerate(heights) if next_index[k] < len(layer_heights)),
            key=lambda k: (heights[k][next_index[k]], k),
        )
        order.append((k, next_index[k]))
        next_index[k] += 1
    return order


def _lowest(layers: Sequence[Layer], up: Array) -> list[float]:
    """Return the lowest point of each layer along up (3,).

    Heights are rounded, so that layers of equal height stay in feature order. An empty layer has the height of the
    feature's next layer.
    """
    lowest: list[float] = []
    above = np.inf
    for layer in reversed(layers):
        if layer.beads:
            above = round(min(float((bead.points @ up).min()) for bead in layer.beads), 6)
        lowest.append(above)
    return lowest[::-1]


def _add_bead_sizes(toolpath: Toolpath, first_path: Toolpath) -> Toolpath:
    """Return the toolpath with bead width and height stored in each bead, if they differ from the first feature."""
    if toolpath.bead_width is None or (
        (toolpath.bead_width, toolpath.layer_height)
        == (first_path.bead_width, first_path.layer_height)
    ):
        return toolpath
    wide, high = toolpath.bead_width, toolpath.layer_height

    def sized(bead: Bead) -> Bead:
        width = np.full(len(bead), wide) if bead.width is None else bead.width
        height = np.full(len(bead), high) if bead.height is None else bead.height
        return replace(bead, width=width, height=height)

    layers = [replace(layer, beads=tuple(map(sized, layer.beads))) for layer in toolpath.layers]
    return replace(toolpath, layers=tuple(layers))
