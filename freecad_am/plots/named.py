# SPDX-License-Identifier: LGPL-2.1-or-later
"""Places of a picture that have a name."""

from __future__ import annotations

from typing import Any

from matplotlib.lines import Line2D

from .chart import Chart

RING = {"linestyle": "none", "marker": "o", "markersize": 8.0, "fillstyle": "none"}
NAME_OFFSET = (6.0, 4.0)  # points from a place to its name


def named(axes: Any, chart: Chart, colour: str, size: float) -> None:
    """Put a ring about each place of a chart that has a name, and this beside it, of so many points."""
    for x, y, name in chart.names:
        axes.add_line(Line2D([x], [y], color=colour, **RING))
        axes.annotate(
            name,
            (x, y),
            NAME_OFFSET,
            textcoords="offset points",
            color=colour,
            size=size,
            weight="bold",
            parse_math=False,
        )
