# SPDX-License-Identifier: LGPL-2.1-or-later
"""The fit of a bead model: width over travel speed for each radius of its table, beside the beads measured."""

from __future__ import annotations

import numpy as np

from ..core.issues import Text
from ..core.process.model.bead_model import MINUTE, BeadModel
from ..core.process.model.bead_table import Measured
from .chart import DOTS, Chart, Curve, Quantity

STEPS = 60


def fit(measured: Measured, model: BeadModel, wanted: float | None = None) -> Chart:
    """Curves and dots coloured by radius; `wanted` is a width drawn across, mm."""
    speed = np.linspace(*model.speeds, STEPS)
    radii = np.unique(measured.radius)
    curves = []
    for number, radius in enumerate(radii.tolist()):
        rows = measured.radius == radius
        widths = model.widths(speed, np.full(STEPS, radius))
        curves.append(Curve(f"r {radius:g} mm", MINUTE * speed, widths, number))
        curves.append(
            Curve(
                Text("r {:g} mm, measured", radius),
                MINUTE * measured.speed[rows],
                measured.width[rows],
                number,
                DOTS,
            )
        )
    marks = () if wanted is None else ((wanted, f"asked: {wanted:g}"),)
    return Chart(
        "Width of beads",
        Quantity("travel speed", "mm/min"),
        Quantity("width", "mm"),
        tuple(curves),
        marks=marks,
    )
