# SPDX-License-Identifier: LGPL-2.1-or-later
"""Export pictures: image files, reproducible byte by byte, and CSV files of the drawn values."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from ..core.types import Array, Integers, Mask, NDArray
from .chart import DOTS, VARIABLES, Picture

INCH = 100.0  # px per inch
MIN_SIZE = 700, 450  # px; minimum map size that leaves space for the texts
FONT_SIZE = 8.0  # points


@dataclass(frozen=True, eq=False)
class Cells:
    """A map of coloured cells.

    colours: (R, C, 3), 0 to 255, lowest row first. hatched: (R, C) mask. columns, rows: tick
    positions in cells, with labels. lines: columns and rows of drawn lines. curves: row positions
    (C,) over the columns, with a colour; NaN interrupts a curve. ramp: (n, 3) colours from `low` to
    `high`. scale: label of the ramp. classes: names with their colours.
    """

    title: str
    up: str
    colours: NDArray[np.uint8]
    hatched: Mask
    columns: list[tuple[float, str]]
    rows: list[tuple[float, str]]
    lines: tuple[list[float], list[float]]
    curves: list[tuple[Array, tuple[float, float, float]]]
    ramp: Array
    low: float
    high: float
    scale: str
    classes: list[tuple[str, tuple[float, float, float]]]
    hatching: str


def figure(cells: Cells, width: int, height: int) -> Figure:
    """Return the map as a figure of the given size in pixels, at least MIN_SIZE."""
    size = max(width, MIN_SIZE[0]) / INCH, max(height, MIN_SIZE[1]) / INCH
    drawing = Figure(figsize=size, dpi=INCH, layout="constrained")
    axes = drawing.add_subplot()
    axes.imshow(cells.colours, origin="lower", aspect="auto", interpolation="nearest")
    if cells.hatched.any():
        axes.contourf(
            cells.hatched.astype(float), levels=[0.5, 1.5], colors="none", hatches=["////"]
        )
    for column in cells.lines[0]:
        axes.axvline(column, color="white", linewidth=0.8, alpha=0.7)
    for row in cells.lines[1]:
        axes.axhline(row, color="white", linewidth=0.8, alpha=0.7)
    for rows, colour in cells.curves:
        axes.plot(np.arange(len(rows)), rows, color=colour, linewidth=1.6)
    count, wide = cells.hatched.shape
    axes.set_xlim(-0.5, wide - 0.5)
    axes.set_ylim(-0.5, count - 0.5)
    axes.set_xticks(
        [position for position, _ in cells.columns], [text for _, text in cells.columns]
    )
    axes.set_yticks([position for position, _ in cells.rows], [text for _, text in cells.rows])
    axes.tick_params(labelsize=FONT_SIZE)
    axes.set_xlabel(cells.title)
    axes.set_ylabel(cells.up)
    drawing.colorbar(
        ScalarMappable(Normalize(cells.low, cells.high), ListedColormap(cells.ramp)),
        ax=axes,
        label=cells.scale,
    )
    swatches = [
        axes.bar([0.0], [0.0], color=[colour], label=name) for name, colour in cells.classes
    ]
    if cells.hatched.any():
        swatches.append(axes.bar([0.0], [0.0], color="none", hatch="////", label=cells.hatching))
    if swatches:
        above = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.0)}
        axes.legend(handles=swatches, ncols=2, frameon=False, fontsize=FONT_SIZE, **above)
    return drawing


KINDS = ("png", "svg", "pdf")
# metadata to omit, so that files do not depend on date or version
_UNDATED = {
    "png": {"Software": None},
    "svg": {"Date": None, "Creator": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
_SETTINGS = {
    "svg.fonttype": "none",
    "svg.hashsalt": "robotic-am",
    "text.usetex": False,
    "path.simplify": True,
}
PNG_DPI = 150  # dpi; resolution of PNG files
_ROWS_AT_ONCE = 20_000
_TAG, _LONG_NUMBER = re.compile(r"<[^>]*>"), re.compile(r"(\d\.\d)\d+")


def image(figure: Figure, kind: str) -> bytes:
    """Return the figure as file content of one of KINDS."""
    stream = io.BytesIO()
    with matplotlib.rc_context(_SETTINGS):
        figure.savefig(
            stream,
            format=kind,
            dpi=PNG_DPI if kind == "png" else figure.dpi,
            metadata=_UNDATED[kind],
        )
    return stream.getvalue()


def inline(figure: Figure, title: str) -> str:
    """Return the figure, drawn with the look PAGE, as an SVG element for a page.

    The page must define the style variables in VARIABLES.
    """
    text = image(figure, "svg").decode()
    text = text[text.index("<svg") :]
    text = re.sub(
        r"\s*<metadata>.*?</metadata>|\s*<style.*?</style>|<!--.*?-->", "", text, flags=re.DOTALL
    )
    text = re.sub(r'<g id="[^"]*"/>\s*', "", text)
    text = re.sub(r'<g id="[^"]*">', "<g>", text)
    text = re.sub(
        r"font: ([0-9.]+px|[0-9]+ [0-9.]+px|bold [0-9.]+px)[^;\"]*",
        r"font: \1 system-ui, sans-serif",
        text,
    )
    text = _TAG.sub(lambda tag: _LONG_NUMBER.sub(r"\1", tag[0]), text)  # label texts stay unchanged
    for colour, variable in VARIABLES.items():
        text = text.replace(colour, f"var({variable})")
    box = re.search(r'viewBox="[^"]*"', text)
    assert box is not None
    start = text.index(">") + 1
    head = f'<svg class="plot" {box[0]} role="img" aria-label="{escape(title)}" xmlns:xlink="http://www.w3.org/1999/xlink">'
    return head + re.sub(r"\n\s*", "\n", text[start:]).rstrip()


def values(picture: Picture) -> Iterator[str]:
    """Yield the drawn values as chunks of a CSV file with decimal points.

    If all curves share their x values, the columns are x, the layer, and one column per curve.
    Otherwise, and for histograms, each row has one value with its chart and curve names. Missing
    values are empty.
    """
    curves = [(chart, curve) for chart in picture.charts for curve in chart.curves]
    if curves and all(curve.x is curves[0][1].x for _, curve in curves):
        chart, common = curves[0]
        alone = len({curve.name for _, curve in curves}) == len(curves)
        named = [] if common.layer is None else ["layer"]
        yield (
            ",".join(
                [
                    _header(chart.x.name, chart.x.unit),
                    *named,
                    *(
                        _header(
                            curve.name if alone else f"{owner.title} {curve.name}", owner.y.unit
                        )
                        for owner, curve in curves
                    ),
                ]
            )
            + "\n"
        )
        layers = [] if common.layer is None else [common.layer]
        yield from _table([common.x, *(curve.y for _, curve in curves)], layers)
        return
    yield "chart,curve,from,to,value\n"
    for chart, curve in curves:
        name = f"{_plain(chart.title)},{_plain(curve.name + (' (dots)' if curve.kind == DOTS else ''))},"
        yield from _rows(name, [curve.x, curve.x, curve.y])
    for chart in picture.charts:
        if chart.bars is not None:
            name = f"{_plain(chart.title)},{_plain(chart.y.label)},"
            yield from _rows(
                name, [chart.bars.edges[:-1], chart.bars.edges[1:], chart.bars.heights]
            )


def _table(columns: list[Array], integers: list[Integers]) -> Iterator[str]:
    for start in range(0, len(columns[0]), _ROWS_AT_ONCE):
        rows = slice(start, start + _ROWS_AT_ONCE)
        texts = [[_text(value) for value in column[rows].tolist()] for column in columns]
        texts[1:1] = [[str(value) for value in column[rows].tolist()] for column in integers]
        yield "".join(",".join(row) + "\n" for row in zip(*texts, strict=True))


def _rows(name: str, columns: list[Array]) -> Iterator[str]:
    for chunk in _table(columns, []):
        yield "".join(name + line + "\n" for line in chunk.splitlines())


def _text(value: float) -> str:
    return "" if value != value else f"{value + 0.0:.10g}"


def _header(name: str, unit: str) -> str:
    unit = (
        unit.replace("/", "_")
        .replace("²", "2")
        .replace("³", "3")
        .replace("%", "percent")
        .replace(" or ", "_or_")
    )
    return _plain(name.replace(" ", "_") + (f"_{unit}" if unit else ""))


def _plain(text: str) -> str:
    """Return a text as one CSV cell, quoted if necessary."""
    return '"' + text.replace('"', '""') + '"' if "," in text or '"' in text else text
