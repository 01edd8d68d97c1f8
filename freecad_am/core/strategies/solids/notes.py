# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said about the beads on a hub: speeds, widths, heights against the layer height, waits, what was mended."""

from __future__ import annotations

from collections.abc import Sequence

from ...issues import NOTE, Issue, Text
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.model.bead_model import BeadModel
from ...process.model.notes import of_model
from ...toolpath import Layer
from .beads import MadeBead


def notes(
    made: Sequence[MadeBead], layers: Sequence[Layer], mended: Sequence[Issue], strategy: FilledParameters,
    process: ProcessParameters, model: BeadModel | None,
) -> list[Issue]:
    """All of them."""
    found = _mended(mended)
    if model is not None:
        found += of_model(made, strategy.layer_height, process, model)
    found += _single_layers(layers, strategy)
    waits = [layer.wait for layer in layers if layer.wait > 0.0]
    if waits and strategy.min_layer_time > 0.0:
        found.append(Issue(
            NOTE, "WAITS", Text("the machine waits before {} of {} layers, up to {:.4g} s and {:.5g} s in all, so that no "
                "layer takes less than {:g} s and no solid is returned to sooner than after {:g} s", len(waits), len(layers),
                max(waits), sum(waits), strategy.min_layer_time, strategy.wait),
        ))
    elif waits:
        found.append(Issue(
            NOTE, "WAITS", Text("the machine waits before {} of {} layers, up to {:.4g} s and {:.5g} s in all, so that no "
                "solid is returned to sooner than after {:g} s", len(waits), len(layers), max(waits), sum(waits),
                strategy.wait),
        ))
    return found


def _single_layers(layers: Sequence[Layer], strategy: FilledParameters) -> list[Issue]:
    """Solids, or groups of them laid in turn, that get one layer alone."""
    starts = [*(index for index, layer in enumerate(layers) if layer.first), len(layers)]
    single = [start for start, end in zip(starts, starts[1:]) if end - start == 1]
    if not single:
        return []
    return [Issue(
        NOTE, "SINGLE_LAYER",
        Text("{} of {} solids or groups of solids get one layer alone, on the hub: they are no higher than "
            "strategy.layer_height, {:g} mm", len(single), len(starts) - 1, strategy.layer_height), single[0],
    )]


def _mended(issues: Sequence[Issue]) -> list[Issue]:
    """One of each kind, with how many layers of solids there are like it."""
    found = []
    for code in sorted({issue.code for issue in issues}):
        first, *others = [issue for issue in issues if issue.code == code]
        text = Text("{} (more layers like it: {})", first.message, len(others)) if others else first.message
        found.append(Issue(first.level, code, text, first.layer))
    return found
