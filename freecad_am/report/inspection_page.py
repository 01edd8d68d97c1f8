# SPDX-License-Identifier: LGPL-2.1-or-later
"""inspection.html: statistics, histograms and deviation maps of measured points.

The page is one self-contained file without scripts.
"""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from ..core.inspection import table
from ..plots.chart import Bars, Chart, Quantity
from ..plots.deviation import UP, X, dots_by_band
from .pictures import HALF, MAP, MISSING, draw_charts, plotting_modules
from .scan_figures import key_of
from .tables import grid_of
from .template import fill_page

_MAX_POINTS = 6000  # maximum number of points in a map
_TILT = np.radians(30.0)  # elevation of the map's viewing direction


def render(planned: str, results: list[Any], labels: list[str]) -> str:
    """Return the page of all inspections of one object as HTML."""
    title = f"{planned}: measured against planned"
    html_parts = [
        f'<header><h1>{escape(title)}</h1></header><p class="sub">Defects are widths of the narrowest zone (ISO 1101); '
        "deviations are positive where there is more than planned.</p>",
        _table(results, labels),
    ]
    for result, label in zip(results, labels, strict=True):
        pictures = draw_charts([_map(result), _histogram(result)], HALF, MAP)
        html_parts.append(
            f"<h2>{escape(label)}</h2>{grid_of(pictures)}{_key(result.tolerance)}{_notes(result)}"
        )
    if plotting_modules() is None:
        html_parts.append(f'<p class="sub">{MISSING}</p>')
    return fill_page(title, html_parts)


def _table(results: list[Any], labels: list[str]) -> str:
    several = len(results) > 1
    heads = [*labels, *(("mean", "standard deviation") if several else ())]
    rows = ["<tr><th></th>" + "".join(f"<th>{escape(head)}</th>" for head in heads) + "</tr>"]
    for name, unit, values, mean, deviation in table.compared(results):
        cells = [*values, *((mean, deviation) if several else ())]
        texts = "".join(
            f"<td>{'–' if cell is None else _number(cell, unit)}</td>" for cell in cells
        )
        rows.append(f"<tr><th>{escape(f'{name}, {unit}' if unit else name)}</th>{texts}</tr>")
    return f'<div class="table"><table>{"".join(rows)}</table></div>'


def _number(value: float, unit: str) -> str:
    return table.Row("", value, unit).text if unit or float(value).is_integer() else f"{value:.1f}"


def _map(result: Any) -> Chart:
    """Chart the points seen from the front and slightly above, the nearer half on top."""
    selected = np.unique(np.linspace(0, len(result.points) - 1, _MAX_POINTS).astype(np.intp))
    selected = selected[result.counted[selected]]
    x, y, z = result.points[selected].T
    up = z * np.cos(_TILT) + y * np.sin(_TILT)
    is_near = y <= np.median(y)
    dots = [
        dot
        for half in (~is_near, is_near)
        for dot in dots_by_band(
            x[half], up[half], result.deviation[selected][half], result.tolerance
        )
    ]
    return Chart("Deviation map, seen from the front", X, UP, tuple(dots), plane=True)


def _histogram(result: Any) -> Chart:
    """Chart the histogram of deviations, with a range that includes both limits."""
    edges, counts = result.spread.edges, result.spread.counts
    limit = result.tolerance
    low, high = min(edges[0], -1.05 * limit), max(edges[-1], 1.05 * limit)
    return Chart(
        "Points by deviation",
        Quantity("deviation", "mm"),
        Quantity("points"),
        bars=Bars("points", np.r_[low, edges, high], np.r_[0, counts, 0].astype(float)),
        upright=((-limit, ""), (limit, "tolerance")),
    )


def _key(tolerance: float) -> str:
    return f'<p class="sub">deviation, mm: {key_of(tolerance)}</p>'


def _notes(result: Any) -> str:
    lines = "".join(f"<li>{escape(issue.message)}</li>" for issue in result.issues)
    return f"<ul>{lines}</ul>" if lines else ""
