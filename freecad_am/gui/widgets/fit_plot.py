# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fit of a bead model: drawn, and in words."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide import QtCore

from ...core.process.model.bead_model import MINUTE, BeadModel
from ...core.process.model.wire import Measured
from ...objects.fields.preferences import in_user_units
from ...plots.chart import Picture, fit
from ..plots.canvas import Canvas, in_words
from ..plots.dock import in_units
from ..texts.in_language import tr

HEIGHT = 210


class FitPlot(Canvas):
    """Width over travel speed: a curve per radius and the measured points."""

    def __init__(self) -> None:
        super().__init__(interactive=False)
        self.setObjectName("BeadModelPlot")
        self.setMinimumHeight(HEIGHT)

    def set(self, measured: Measured, model: BeadModel, target_width: float | None) -> None:
        """Show another fit; `target_width`, mm, is drawn as a horizontal line."""
        self.show_picture(
            in_words(in_units(Picture("fit", "", (fit(measured, model, target_width),))))
        )

    def sizeHint(self) -> Any:
        """Called by Qt."""
        return QtCore.QSize(240, HEIGHT)


def fits_text(measured: Measured, model: BeadModel) -> str:
    """The fits in words."""
    lines = []
    for name, curve in ((tr("Width"), model.width), (tr("Height"), model.height)):
        lines.append(
            f"{name} = {curve.m:.4g} v^(-1/3) {_signed(curve.p)}/r {_signed(curve.t)} mm, "
            + tr("v in mm/min; R² {:.4f}, RMSE {:.3f} mm").format(curve.r_squared, curve.rmse)
        )
    slow, fast = (MINUTE * speed for speed in model.speeds)
    lines.append(
        in_user_units(
            tr("{} beads, {:g} to {:g} mm/min, r {:g} to {:g} mm, wire {:g} m/min").format(
                len(measured.width),
                slow,
                fast,
                model.radii[0],
                model.radii[1],
                MINUTE * model.wire_feed / 1000.0,
            )
        )
    )
    return "\n".join(lines)


def speeds_text(model: BeadModel, width: float) -> str:
    """Return the speeds for a width, and whether they are within the table."""
    solution = model.speed_for(width, np.array([model.radii[0], np.inf]))
    ends = np.select(
        [solution.too_slow, solution.too_fast],
        [tr("{} mm/min (the slowest of the table)"), tr("{} mm/min (the fastest of the table)")],
        "{} mm/min",
    )
    tight, straight = (
        str(end).format(f"{MINUTE * speed:.0f}")
        for speed, end in zip(solution.speed, ends, strict=True)
    )
    return in_user_units(
        tr("{:g} mm wide: {} where straight, {} where r is {:g} mm").format(
            width, straight, tight, model.radii[0]
        )
    )


def _signed(number: float) -> str:
    return f"{'+' if number >= 0.0 else '−'} {abs(number):.4g}"
