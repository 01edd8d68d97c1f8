# SPDX-License-Identifier: LGPL-2.1-or-later
"""What ends slicing that would go on and on, should a job have passed for smaller than it is."""

from __future__ import annotations

from ..issues import InputError
from ..parameters.strategy import MOST_LAYERS


def refuse_too_many(layers: int, height: float, label: str) -> None:
    """InputError LAYER_HEIGHT once there are as many layers as may be."""
    if layers >= MOST_LAYERS:
        raise InputError(
            "LAYER_HEIGHT",
            label,
            "more than {} layers of {:g} mm: use a larger layer height",
            MOST_LAYERS,
            height,
        )
