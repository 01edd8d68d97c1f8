# SPDX-License-Identifier: LGPL-2.1-or-later
"""The pictures of the report that matplotlib draws, as elements of its page; empty without
matplotlib."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from types import ModuleType

import numpy as np

from ..plots import deviation, joints
from ..plots.chart import Chart, convert_chart, fit, together
from ..plots.joints import Rows, rows
from ..plots.look import PAGE
from ..plots.source import Source
from . import units
from .of_feature import OfFeature

HALF, FULL_WIDTH, TALL, MAP = 460, 940, 230, 330  # pixels
MISSING = "The plots are left out, because matplotlib is not installed here; install python3-matplotlib and plan again."


class Pictures:
    """The pictures of one job; a list is empty without data or without matplotlib."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.layers = (0, len(source.toolpath.layers) - 1)

    @cached_property
    def modules(self) -> tuple[ModuleType, ModuleType] | None:
        """What draws; None without matplotlib, whose import takes longer than the drawing of a picture."""
        try:
            from freecad_am.plots import draw, files
        except ImportError:
            return None
        return draw, files

    @cached_property
    def rows(self) -> Rows:
        """The rows of the job over time."""
        return rows(self.source)

    def angles(self) -> list[str]:
        """Each axis against its limits."""
        return self._half(joints.angles(self.source, self.rows), travel=False)

    def rates(self) -> list[str]:
        """Joint speeds as shares of the limits; accelerations and jerks, all axes in one; the condition."""
        accelerations = together(
            "Joint accelerations while depositing", joints.accelerations(self.source, self.rows)
        )
        jerks = together("Joint jerks while depositing", joints.jerks(self.source, self.rows))
        charts = (
            *joints.shares(self.source, self.rows),
            accelerations,
            jerks,
            *joints.condition(self.source, self.rows),
        )
        return self._draw(charts, FULL_WIDTH)

    def process(self, features: Sequence[OfFeature]) -> list[str]:
        """Distances between the layers of each feature, speed along the path, deposit rate and mass."""
        source = self.source
        distances = [
            joints.distances(
                np.concatenate(feature.spacing),
                feature.toolpath.layer_height,
                feature.band,
                feature.name,
            )
            for feature in features
            if feature.spacing
        ]
        return self._half(
            (*distances, *joints.travel(source, self.rows), *joints.deposit(source, self.rows))
        )

    def beads(self) -> list[str]:
        """What a bead model predicts, and its fit."""
        source = self.source
        charts = (*joints.distributions(source, self.layers), *joints.heights(source, self.layers))
        if charts and source.model is not None:
            charts = (*charts, fit(*source.model, source.process.bead_width))
        return self._half(charts)

    def predicted(self) -> list[str]:
        """The predicted deposit against the part."""
        shape = self.source.toolpath.predicted
        if shape is None or shape.deviation is None:
            return []
        charts = deviation.charts(shape.deviation, shape.allowance)
        tall = sum(chart.plane for chart in charts)
        return [*self._draw(charts[:tall], HALF, MAP), *self._half(charts[tall:])]

    def _half(self, charts: Sequence[Chart], travel: bool = True) -> list[str]:
        return self._draw(charts, HALF, travel=travel)

    def _draw(
        self, charts: Sequence[Chart], width: int, height: int = TALL, travel: bool = False
    ) -> list[str]:
        if self.modules is None:
            return []
        draw, files = self.modules
        converted = [
            replace(convert_chart(chart, units.scale, travel), title=units.message(chart.title))
            for chart in charts
        ]
        return [
            files.inline(draw.figure([chart], PAGE, width, height)[0], chart.title)
            for chart in converted
        ]
