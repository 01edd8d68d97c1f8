# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where beads about an axis start and which way they run."""

from __future__ import annotations

import numpy as np

from ..parameters.process import ProcessParameters
from ..types import Array


def rising(process: ProcessParameters, index: int, closed: bool) -> bool:
    """Whether bead number `index` runs with rising azimuth, counter-clockwise as seen from the tool.

    Open beads run as found, with rising azimuth, unless the direction is alternate.
    """
    if process.direction == "alternate":
        return index % 2 == 0
    return not closed or process.direction != "clockwise"


def closed_azimuths(process: ProcessParameters, layer: int, segments: int, rising: bool) -> Array:
    """Unwrapped azimuths (segments + 1,) rad of a full turn from the layer's seam; the last is one turn on."""
    start = process.seam.angle + layer * process.seam.step
    turn = 2.0 * np.pi if rising else -2.0 * np.pi
    return np.asarray(start + turn * np.arange(segments + 1) / segments)


def open_azimuths(start: float, end: float, segments: int, rising: bool) -> Array:
    """Azimuths (segments + 1,) rad of a part of a turn, from whichever end the bead starts at."""
    azimuths = np.linspace(start, end, segments + 1)
    return azimuths if rising else azimuths[::-1]
