# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deposit of a motion: what each segment leaves, and the motion of a toolpath that no machine runs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath

Array = NDArray[np.float64]


def volumes(motion: Motion, process: ProcessParameters, layer_height: float) -> Array:
    """(n,) mm^3 that the segment ending at each row leaves, 0 in rapid moves.

    A bead's section is its width, predicted or else `process.bead_width`, times the layer height: what is deposited
    once it has solidified, not what the wire holds.
    """
    length = np.concatenate([[0.0], np.linalg.norm(np.diff(motion.position, axis=0), axis=1)])[: len(motion)]
    width = np.where(np.isfinite(motion.width), motion.width, process.bead_width)
    # the width of a segment is the mean of those at its ends
    mean_width = 0.5 * (width + np.concatenate([width[:1], width[:-1]]))
    return np.where(motion.deposit & motion.moves, mean_width * length, 0.0) * layer_height


def alone(toolpath: Toolpath, axes: int = 0) -> Motion:
    """The deposit alone, for a job that has no joint path: no rapid rows, durations from length and speed.

    `axes` columns of joints that no point has.
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
        width=np.concatenate([np.full(len(b), np.nan) if b.width is None else b.width for _, _, b in beads]),
        joints=np.full((len(position), axes), np.nan),
        duration=np.where(point > 0, step / speed, 0.0),
        wire=np.concatenate([
            np.full(len(b), np.nan) if b.wire_share is None else b.wire_share * b.speed for _, _, b in beads
        ]),
    )
