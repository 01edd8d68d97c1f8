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
from .wire import with_model

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
    """Of the beads that a bead model set the speed of."""
    known = [
        (bead, bead.width, bead.height)
        for bead in beads
        if bead.width is not None and bead.height is not None
    ]
    if not known:
        return Segments(*(np.empty(0) for _ in range(5)))
    speed = [bead.speed[1:] for bead, _, _ in known]
    return Segments(
        np.concatenate(
            [np.linalg.norm(np.diff(bead.points, axis=0), axis=1) for bead, _, _ in known]
        ),
        MINUTE * np.concatenate(speed),
        np.concatenate([0.5 * (width[1:] + width[:-1]) for _, width, _ in known]),
        np.concatenate([0.5 * (height[1:] + height[:-1]) for _, _, height in known]),
        np.concatenate(
            [
                (np.nan if bead.wire_share is None else bead.wire_share) * some
                for (bead, _, _), some in zip(known, speed)
            ]
        ),
    )


def beads(
    toolpath: Toolpath, numbers: Sequence[int] | Index | None = None
) -> dict[str, Any] | None:
    """The key `beads` of a report; None without a bead model, and for several features. numbers: of the layers of one of
    several, in the whole.

    Of each layer `drift_mm` is by how much the layers of its solid up to it, as high in the mean as predicted, are off the
    layer heights.
    """
    whole = segments([] if toolpath.features else [bead for _, _, bead in toolpath])
    if not len(whole.length):
        return None
    rows: list[dict[str, Any]] = []
    drift = 0.0
    for number, layer in enumerate(toolpath.layers):
        some = segments(layer.beads)
        if not len(some.length):
            continue
        height = _spread(some.height, some.length)
        drift = (0.0 if layer.first else drift) + height["mean"] - toolpath.layer_height
        rows.append(
            {
                "layer": number if numbers is None else int(numbers[number]),
                "height_mm": height,
                "drift_mm": drift,
            }
        )
    return {
        "travel_speed_mm_min": _spread(whole.speed, whole.length),
        "width_mm": _spread(whole.width, whole.length),
        "height_mm": _spread(whole.height, whole.length),
        "layer_height_mm": toolpath.layer_height,
        "wire_feed_mm_s": _spread(whole.wire, whole.length)
        if np.isfinite(whole.wire).all()
        else None,
        "layers": rows,
    }


def with_heights(
    beads: Sequence[Bead],
    layer_height: float,
    process: ProcessParameters,
    model: BeadModel,
    as_run: bool = False,
) -> Issue:
    """How high beads of the model are predicted at their speeds, against the layers. as_run: axes can follow these."""
    some = segments(beads)
    height = _spread(some.height, some.length)
    drift = abs(height["mean"] - layer_height) / layer_height
    return Issue(
        WARNING if drift > DRIFT else NOTE,
        HEIGHTS,
        Text(
            "{}beads are predicted {:.3g} to {:.3g} mm high, {:.3g} mm in the mean, at layers of {:g} mm{}{}",
            Word("run as fast as the axes can follow, " if as_run else ""),
            height["min"],
            height["max"],
            height["mean"],
            layer_height,
            Word("; set strategy.layer_height to what the beads make" if drift > DRIFT else ""),
            _sections(some, process, model),
        ),
    )


def _sections(some: Segments, process: ProcessParameters, model: BeadModel) -> str:
    """What a wire feed in proportion to the speed is, or would be, where speeds vary."""
    if np.isfinite(some.wire).all():
        low, high = float(some.wire.min()), float(some.wire.max())
        return Text(
            ". The wire runs in proportion to the speed, at {:.3g} to {:.3g} mm/s, and keeps their section",
            low,
            high,
        )
    per_mm = with_model(process, model) / model.straight_speed(process.bead_width)
    slowest, fastest = (
        per_mm * float(value) / MINUTE for value in (some.speed.min(), some.speed.max())
    )
    if fastest < 1.05 * slowest:
        return ""
    return Text(
        ". At one wire feed faster stretches are lower; process.wire.feed_mode: proportional would keep the "
        "section, at {:.3g} to {:.3g} mm/s of wire",
        slowest,
        fastest,
    )


def _spread(values: Array, length: Array) -> dict[str, float]:
    """Least, largest, and the mean over the length."""
    mean = float((values * length).sum() / length.sum())
    return {"min": float(values.min()), "mean": mean, "max": float(values.max())}
