# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a bead model predicts of a toolpath: speeds, widths and heights, over all and layer by layer, and in words."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...issues import NOTE, WARNING, Issue, Text, Word
from ...parameters.process import ProcessParameters
from ...toolpath import Bead, Toolpath
from ...types import Array, Index
from .bead_model import MINUTE, BeadModel
from .wire import model_wire_feed

HEIGHTS = "BEAD_HEIGHT"
DRIFT = 0.2  # of the layer height; layers that drift by more deserve a warning


@dataclass(frozen=True, eq=False)
class Segments:
    """The segments (n,) of some beads: length mm, travel speed mm/min, width and height mm halfway, wire mm/s or NaN."""

    length: Array
    speed: Array
    width: Array
    height: Array
    wire: Array


def segments(beads: Sequence[Bead]) -> Segments:
    """The segments of the beads whose speed a bead model sets."""
    modelled = [
        (bead, bead.width, bead.height)
        for bead in beads
        if bead.width is not None and bead.height is not None
    ]
    if not modelled:
        return Segments(*(np.empty(0) for _ in range(5)))
    speed = [bead.speed[1:] for bead, _, _ in modelled]
    return Segments(
        np.concatenate(
            [np.linalg.norm(np.diff(bead.points, axis=0), axis=1) for bead, _, _ in modelled]
        ),
        MINUTE * np.concatenate(speed),
        np.concatenate([0.5 * (width[1:] + width[:-1]) for _, width, _ in modelled]),
        np.concatenate([0.5 * (height[1:] + height[:-1]) for _, _, height in modelled]),
        np.concatenate(
            [
                (np.nan if bead.wire_share is None else bead.wire_share) * speeds
                for (bead, _, _), speeds in zip(modelled, speed)
            ]
        ),
    )


def beads(
    toolpath: Toolpath, numbers: Sequence[int] | Index | None = None
) -> dict[str, Any] | None:
    """The key `beads` of a report; None without a bead model, and for several features.

    numbers: of the layers of one feature among the layers of several. `drift_mm` of a layer is the sum of the differences of
    predicted mean heights from layer heights, up to it within its solid.
    """
    total = segments([] if toolpath.features else [bead for _, _, bead in toolpath])
    if not len(total.length):
        return None
    rows: list[dict[str, Any]] = []
    drift = 0.0
    for number, layer in enumerate(toolpath.layers):
        layer_segments = segments(layer.beads)
        if not len(layer_segments.length):
            continue
        height = _summarise(layer_segments.height, layer_segments.length)
        drift = (0.0 if layer.first else drift) + height["mean"] - toolpath.layer_height
        rows.append(
            {
                "layer": number if numbers is None else int(numbers[number]),
                "height_mm": height,
                "drift_mm": drift,
            }
        )
    return {
        "travel_speed_mm_min": _summarise(total.speed, total.length),
        "width_mm": _summarise(total.width, total.length),
        "height_mm": _summarise(total.height, total.length),
        "layer_height_mm": toolpath.layer_height,
        "wire_feed_mm_s": _summarise(total.wire, total.length)
        if np.isfinite(total.wire).all()
        else None,
        "layers": rows,
    }


def height_issue(
    beads: Sequence[Bead],
    layer_height: float,
    process: ProcessParameters,
    model: BeadModel,
    as_run: bool = False,
) -> Issue:
    """The issue that compares predicted bead heights with the layers. as_run: axes can follow the speeds."""
    sized = segments(beads)
    height = _summarise(sized.height, sized.length)
    drift = abs(height["mean"] - layer_height) / layer_height
    return Issue(
        WARNING if drift > DRIFT else NOTE,
        HEIGHTS,
        Text(
            "{}beads are predicted {:.3g} to {:.3g} mm high, {:.3g} mm on average, for layers of "
            "{:g} mm{}{}",
            Word("limited to the speed of the axes, " if as_run else ""),
            height["min"],
            height["max"],
            height["mean"],
            layer_height,
            Word("; set strategy.layer_height to the predicted height" if drift > DRIFT else ""),
            _sections(sized, process, model),
        ),
    )


def _sections(sized: Segments, process: ProcessParameters, model: BeadModel) -> str:
    """The wire feed in proportion to the speed, actual or possible, as text where speeds vary."""
    if np.isfinite(sized.wire).all():
        low, high = float(sized.wire.min()), float(sized.wire.max())
        return Text(
            ". The wire feed follows the speed, at {:.3g} to {:.3g} mm/s, and keeps the "
            "cross-section",
            low,
            high,
        )
    per_mm = model_wire_feed(process, model) / model.straight_speed(process.bead_width)
    slowest, fastest = (
        per_mm * float(value) / MINUTE for value in (sized.speed.min(), sized.speed.max())
    )
    if fastest < 1.05 * slowest:
        return ""
    return Text(
        ". At a constant wire feed faster stretches are lower; process.wire.feed_mode: "
        "proportional would keep the cross-section, at {:.3g} to {:.3g} mm/s of wire",
        slowest,
        fastest,
    )


def _summarise(values: Array, length: Array) -> dict[str, float]:
    """Least, largest, and the mean over the length."""
    mean = float((values * length).sum() / length.sum())
    return {"min": float(values.min()), "mean": mean, "max": float(values.max())}
