# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deposit of a motion: what each segment leaves, and the motion of a toolpath that no machine runs."""

from __future__ import annotations

import numpy as np

from ..motion import Motion
from ..parameters.bead_classes import number_of
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from ..types import Array


def volumes(motion: Motion, process: ProcessParameters, toolpath: Toolpath) -> Array:
    """(n,) mm^3 that the segment ending at each row leaves, 0 in rapid moves.

    A bead's section is its width, predicted or else as beads of the toolpath count, times the layer height: what is
    deposited once it has solidified, not what the wire holds. Layers that were fitted to a scan are as high as that made
    them in the mean. Toolpaths of older documents do not tell how wide beads count;
    there it is `process.bead_width`.
    """
    length = np.concatenate([[0.0], np.linalg.norm(np.diff(motion.position, axis=0), axis=1)])[
        : len(motion)
    ]
    nominal = process.bead_width if toolpath.bead_width is None else toolpath.bead_width
    width = np.where(np.isfinite(motion.width), motion.width, nominal)
    # the width of a segment is the mean of the widths at its ends
    mean_width = 0.5 * (width + np.concatenate([width[:1], width[:-1]]))
    height: Array | float = toolpath.layer_height
    if toolpath.features or toolpath.fitted is not None:
        height = (
            _mean_heights(toolpath) if toolpath.fitted is not None else toolpath.layer_heights
        )[motion.layer]
    return np.where(motion.deposit & motion.moves, mean_width * length, 0.0) * height


def _mean_heights(toolpath: Toolpath) -> Array:
    """(layers,) mm, the mean height of each layer's beads: layers fitted to a scan are uneven."""
    layer_heights = toolpath.layer_heights
    for number, layer in enumerate(toolpath.layers):
        if any(bead.height is not None for bead in layer.beads):
            sums = np.zeros(2)
            for bead in layer.beads:
                length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
                high = (
                    np.full(len(bead), layer_heights[number])
                    if bead.height is None
                    else bead.height
                )
                sums += (0.5 * length @ (high[1:] + high[:-1]), length.sum())
            layer_heights[number] = sums[0] / sums[1]
    return layer_heights


def fed_volume(motion: Motion, process: ProcessParameters, toolpath: Toolpath) -> float | None:
    """mm^3 of wire fed while depositing, without lead times; None if the wire speed is not known or
    there is no wire.
    """
    nominal = toolpath.wire_feed or np.nan
    feed = np.where(np.isfinite(motion.wire), motion.wire, nominal)
    seconds = np.where(motion.deposit & motion.moves, np.nan_to_num(motion.duration), 0.0)
    total = process.wire.section * float((feed * seconds).sum())
    return total if np.isfinite(total) else None


def deposit_motion(toolpath: Toolpath, axes: int = 0) -> Motion:
    """The deposit only, for a job without a joint path: no rapid rows, durations from length and speed.
    `axes` columns of NaN joints.
    """
    beads = list(toolpath)
    sizes = [len(bead) for _, _, bead in beads]
    position = np.concatenate([bead.points for _, _, bead in beads])
    speed = np.concatenate([bead.speed for _, _, bead in beads])
    point = np.concatenate([np.arange(size) for size in sizes])
    step = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    return Motion(
        deposit=np.ones(len(position), dtype=bool),
        layer=np.repeat([layer for layer, _, _ in beads], sizes),
        bead=np.repeat([number for _, number, _ in beads], sizes),
        point=point,
        position=position,
        build=np.concatenate([bead.build for _, _, bead in beads]),
        tool=np.concatenate([bead.tool for _, _, bead in beads]),
        speed=speed,
        width=np.concatenate(
            [np.full(len(b), np.nan) if b.width is None else b.width for _, _, b in beads]
        ),
        joints=np.full((len(position), axes), np.nan),
        duration=np.where(point > 0, step / speed, 0.0),
        wire=np.concatenate(
            [
                np.full(len(b), np.nan) if b.wire_share is None else b.wire_share * b.speed
                for _, _, b in beads
            ]
        ),
        bead_class=np.repeat([number_of(bead.bead_class) for _, _, bead in beads], sizes),
    )
