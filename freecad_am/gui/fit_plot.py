# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fit of a bead model: drawn, and in words."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide import QtCore

from ..core.process.bead_model import MINUTE, BeadModel
from ..core.process.bead_table import Measured
from ..plots.chart import Picture
from ..plots.fit import fit
from .plots.canvas import Canvas
from .plots.words import in_words

HEIGHT = 210


class FitPlot(Canvas):
    """Width over travel speed, a curve per radius beside what was measured."""

    def __init__(self) -> None:
        super().__init__(interactive=False)
        self.setObjectName("BeadModelPlot")
        self.setMinimumHeight(HEIGHT)

    def set(self, measured: Measured, model: BeadModel, wanted: float | None) -> None:
        """Show another fit; `wanted` is a width drawn across, mm."""
        self.show_picture(in_words(Picture("fit", "", (fit(measured, model, wanted),))))

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(240, HEIGHT)


def told(measured: Measured, model: BeadModel) -> str:
    """The fits in words."""
    lines = []
    for name, found in (("Width", model.width), ("Height", model.height)):
        lines.append(
            f"{name} = {found.m:.4g} v^(-1/3) {_signed(found.p)}/r {_signed(found.t)} mm, v in mm/min; "
            f"R² {found.r_squared:.4f}, RMSE {found.rmse:.3f} mm"
        )
    slow, fast = (MINUTE * speed for speed in model.speeds)
    lines.append(
        f"{len(measured.width)} beads, {slow:g} to {fast:g} mm/min, r {model.radii[0]:g} to {model.radii[1]:g} mm, wire "
        f"{MINUTE * model.wire_feed / 1000.0:g} m/min"
    )
    return "\n".join(lines)


def speeds_told(model: BeadModel, width: float) -> str:
    """What speeds a width asks for, and whether the table has such."""
    asked = model.speed_for(width, np.array([model.radii[0], np.inf]))
    ends = np.select([asked.too_slow, asked.too_fast], [" (the slowest of the table)", " (the fastest of the table)"], "")
    tight, straight = (f"{MINUTE * speed:.0f} mm/min{end}" for speed, end in zip(asked.speed, ends, strict=True))
    return f"{width:g} mm wide: {straight} where straight, {tight} where r is {model.radii[0]:g} mm"


def _signed(number: float) -> str:
    return f"{'+' if number >= 0.0 else '−'} {abs(number):.4g}"
