# SPDX-License-Identifier: LGPL-2.1-or-later
"""inspection.html: figures, histograms and deviation maps, one file without scripts or links."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from ...core.inspection import table
from ...core.inspection.bands import band_of, bands, css
from ...core.types import Array
from ...report.scan_figures import key_of
from ...report.style import STYLE
from ...report.svg import Plot

_MAX_POINTS = 6000  # points of a map
_TILT = np.radians(30.0)  # viewing angle of the map, from above
_DOT = 1.7


def render(planned: str, results: list[Any], labels: list[str]) -> str:
    """The page of inspections of the same object."""
    title = f"{escape(planned)}: measured against planned"
    html_parts = [
        f'<header><h1>{title}</h1></header><p class="sub">Defects are widths of the narrowest zone (ISO 1101); '
        "deviations are positive where there is more than planned.</p>",
        _table(results, labels),
    ]
    for result, label in zip(results, labels, strict=True):
        html_parts.append(
            f'<h2>{escape(label)}</h2><div class="grid"><figure>{_map(result)}{_key(result.tolerance)}</figure>'
            f"<figure>{_histogram(result)}</figure></div>{_notes(result)}"
        )
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{title}</title>'
        f'<meta name="viewport" content="width=device-width,initial-scale=1"><style>{STYLE}</style></head>'
        f"<body><main>{''.join(html_parts)}</main></body></html>\n"
    )


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


def _map(result: Any) -> str:
    """The points as they are seen from the front, a little from above."""
    selected = np.unique(np.linspace(0, len(result.points) - 1, _MAX_POINTS).astype(np.intp))
    selected = selected[result.counted[selected]]
    x, y, z = result.points[selected].T
    up = z * np.cos(_TILT) + y * np.sin(_TILT)
    order = np.argsort(-y)  # the nearer ones last
    plot = _framed("Deviation map, seen from the front", x, up)
    shades, number = (
        [css(band.colour) for band in bands(result.tolerance)],
        band_of(result.deviation[selected], result.tolerance),
    )
    px, py = plot.to_x(x), plot.to_y(up)
    plot.elements += [
        f'<circle cx="{px[k]:.1f}" cy="{py[k]:.1f}" r="{_DOT}" fill="{shades[number[k]]}"/>'
        for k in order
    ]
    return plot.text()


def _framed(title: str, x: Array, y: Array) -> Plot:
    """A plot in which lengths across and up are the same."""
    plot = Plot(title, (0.0, 1.0), (0.0, 1.0), "mm", "mm", height=330)
    wide, high = plot.width - plot.left - plot.right, plot.height - plot.top - plot.bottom
    scale = 1.08 * max(float(np.ptp(x)) / wide, float(np.ptp(y)) / high, 1e-6)
    plot.x, plot.y = (
        (
            0.5 * (values.min() + values.max()) - 0.5 * scale * size,
            0.5 * (values.min() + values.max()) + 0.5 * scale * size,
        )
        for values, size in ((x, wide), (y, high))
    )
    return plot


def _histogram(result: Any) -> str:
    edges, counts = result.spread.edges, result.spread.counts
    low, high = min(float(edges[0]), -result.tolerance), max(float(edges[-1]), result.tolerance)
    plot = Plot(
        "Points by deviation",
        (low, high),
        (0.0, 1.05 * float(counts.max())),
        "deviation, mm",
        "points",
        height=330,
    )
    shades = [css(band.colour) for band in bands(result.tolerance)]
    number = band_of(0.5 * (edges[:-1] + edges[1:]), result.tolerance)
    lefts, top, ground = plot.to_x(edges), plot.to_y(counts), float(plot.to_y(np.zeros(1))[0])
    plot.elements += [
        f'<rect x="{lefts[k]:.1f}" y="{top[k]:.1f}" width="{max(lefts[k + 1] - lefts[k] - 0.5, 0.5):.1f}" '
        f'height="{ground - top[k]:.1f}" fill="{shades[number[k]]}"/>'
        for k in range(len(counts))
    ]
    for limit in plot.to_x(np.array([-result.tolerance, result.tolerance])):
        plot.elements.append(
            f'<line class="asked" x1="{limit:.1f}" x2="{limit:.1f}" y1="{plot.top}" y2="{ground:.1f}"/>'
        )
    return plot.text()


def _key(tolerance: float) -> str:
    return f"<figcaption>deviation, mm: {key_of(tolerance)}</figcaption>"


def _notes(result: Any) -> str:
    lines = "".join(f"<li>{escape(issue.message)}</li>" for issue in result.issues)
    return f"<ul>{lines}</ul>" if lines else ""
