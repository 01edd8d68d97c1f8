# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report pictures drawn by matplotlib, as page elements; empty without matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache, cached_property
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from ..plots import deviation, pictures
from ..plots.chart import PAGE, Chart, convert_chart, fit, together
from ..plots.pictures import Rows, rows
from ..plots.source import Source
from . import units

if TYPE_CHECKING:  # figures import pictures where a job has them
    from .figures import OfFeature

HALF, FULL_WIDTH, TALL, MAP, TALLEST = 460, 940, 230, 330, 620  # pixels
MISSING = "The plots are missing, because matplotlib is not installed; install python3-matplotlib and plan again."


@cache
def plotting_modules() -> tuple[ModuleType, ModuleType] | None:
    """Import the drawing modules, None without matplotlib. The import is slower than drawing."""
    try:
        from freecad_am.plots import draw, files
    except ImportError:
        return None
    return draw, files


def draw_charts(
    charts: Sequence[Chart], width: int, height: int = TALL, travel: bool = False
) -> list[str]:
    """Draw charts as page elements, in the units of the page.

    Parameters
    ----------
    charts : sequence of Chart
        Charts in the units of report.json.
    width, height : int
        Size of each picture, pixels.
    travel : bool
        Whether speeds are deposition point speeds.

    Returns
    -------
    list of str
        One SVG element per chart; empty without matplotlib.
    """
    modules = plotting_modules()
    if modules is None:
        return []
    draw, files = modules
    converted = [convert_chart(_convert_texts(chart), units.scale, travel) for chart in charts]
    return [
        files.inline(draw.figure([chart], PAGE, width, height)[0], chart.title)
        for chart in converted
    ]


def _convert_texts(chart: Chart) -> Chart:
    """Return the chart with its texts in the units of the page."""
    return replace(
        chart,
        title=units.message(chart.title),
        marks=tuple((value, units.message(name)) for value, name in chart.marks),
        curves=tuple(replace(curve, name=units.message(curve.name)) for curve in chart.curves),
    )


class Pictures:
    """Pictures of one job. Each list is empty without data or without matplotlib."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.layers = (0, len(source.toolpath.layers) - 1)

    @cached_property
    def rows(self) -> Rows:
        """Return the samples of the job over time."""
        return rows(self.source)

    def angles(self) -> list[str]:
        """Draw each axis position against its limits."""
        return self._half(pictures.angles(self.source, self.rows), travel=False)

    def rates(self) -> list[str]:
        """Draw joint speeds relative to limits, accelerations, jerks and Jacobian condition."""
        accelerations = together(
            "Joint accelerations while depositing", pictures.accelerations(self.source, self.rows)
        )
        jerks = together("Joint jerks while depositing", pictures.jerks(self.source, self.rows))
        charts = (
            *pictures.shares(self.source, self.rows),
            accelerations,
            jerks,
            *pictures.condition(self.source, self.rows),
        )
        return draw_charts(charts, FULL_WIDTH)

    def process(self, features: Sequence[OfFeature]) -> list[str]:
        """Draw layer distances, void and double deposit, path speed, deposit rate and mass."""
        source = self.source
        distances = [
            pictures.distances(
                np.concatenate(feature.spacing),
                feature.toolpath.layer_height,
                feature.band,
                feature.name,
            )
            for feature in features
            if feature.spacing
        ]
        return self._half(
            (
                *distances,
                *pictures.infill(source, self.layers),
                *pictures.travel(source, self.rows),
                *pictures.deposit(source, self.rows),
            )
        )

    def beads(self) -> list[str]:
        """Draw the predictions of the bead model, and its fit."""
        source = self.source
        charts = (
            *pictures.distributions(source, self.layers),
            *pictures.heights(source, self.layers),
        )
        if charts and source.model is not None:
            charts = (*charts, fit(*source.model, source.process.bead_width))
        return self._half(charts)

    def predicted(self) -> list[str]:
        """Draw the predicted deposit against the part."""
        shape = self.source.toolpath.checks.predicted
        if shape is None or shape.deviation is None:
            return []
        charts = deviation.charts(shape.deviation, shape.allowance)
        tall = sum(chart.plane for chart in charts)
        return [*draw_charts(charts[:tall], HALF, MAP), *self._half(charts[tall:])]

    def _half(self, charts: Sequence[Chart], travel: bool = True) -> list[str]:
        return draw_charts(charts, HALF, travel=travel)
