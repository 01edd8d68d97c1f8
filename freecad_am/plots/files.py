# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures as files: images of a figure, the same bytes for the same figure, and the values that are drawn."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from html import escape

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from freecad_am.core.types import Array, Integers

from .chart import DOTS, Picture
from .look import VARIABLES

KINDS = ("png", "svg", "pdf")
# what must be left out of a file for it not to tell when or with what it was made
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
SHARP = 150  # dots per inch of PNG
_ROWS_AT_ONCE = 20_000


def image(figure: Figure, kind: str) -> bytes:
    """A file of one of KINDS."""
    stream = io.BytesIO()
    with matplotlib.rc_context(_SETTINGS):
        figure.savefig(
            stream, format=kind, dpi=SHARP if kind == "png" else figure.dpi, metadata=_UNDATED[kind]
        )
    return stream.getvalue()


def pixels(figure: Figure, ratio: float = 1.0) -> tuple[bytes, int, int]:
    """The figure as width times height pixels of four bytes, red, green, blue and opacity; ratio: of them to one of the
    figure."""
    figure.set_dpi(ratio * figure.dpi)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    width, height = canvas.get_width_height()
    return bytes(canvas.buffer_rgba()), int(width), int(height)


def inline(figure: Figure, title: str) -> str:
    """An SVG element to stand in a page that has the variables of `look.VARIABLES`; drawn in the look PAGE."""
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
    text = re.sub(r"(\d\.\d)\d+", r"\1", text)
    for colour, variable in VARIABLES.items():
        text = text.replace(colour, f"var({variable})")
    box = re.search(r'viewBox="[^"]*"', text)
    assert box is not None
    start = text.index(">") + 1
    head = f'<svg class="plot" {box[0]} role="img" aria-label="{escape(title)}" xmlns:xlink="http://www.w3.org/1999/xlink">'
    return head + re.sub(r"\n\s*", "\n", text[start:]).rstrip()


def values(picture: Picture) -> Iterator[str]:
    """The values that are drawn, in pieces of a file of comma separated values; a point is the decimal sign.

    Where all curves share their places across: a column of these, that of layers, a column per curve. Otherwise, and of
    histograms, a row per value with the name of its chart and curve. Empty where there is no value.
    """
    curves = [(chart, curve) for chart in picture.charts for curve in chart.curves]
    if curves and all(curve.x is curves[0][1].x for _, curve in curves):
        chart, first = curves[0]
        alone = len({curve.name for _, curve in curves}) == len(curves)
        named = [] if first.layer is None else ["layer"]
        yield (
            ",".join(
                [
                    _header(chart.x.name, chart.x.unit),
                    *named,
                    *(
                        _header(curve.name if alone else f"{one.title} {curve.name}", one.y.unit)
                        for one, curve in curves
                    ),
                ]
            )
            + "\n"
        )
        layers = [] if first.layer is None else [first.layer]
        yield from _table([first.x, *(curve.y for _, curve in curves)], layers)
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


def _table(columns: list[Array], whole: list[Integers]) -> Iterator[str]:
    for start in range(0, len(columns[0]), _ROWS_AT_ONCE):
        part = slice(start, start + _ROWS_AT_ONCE)
        texts = [[_text(value) for value in column[part].tolist()] for column in columns]
        texts[1:1] = [[str(value) for value in column[part].tolist()] for column in whole]
        yield "".join(",".join(row) + "\n" for row in zip(*texts, strict=True))


def _rows(name: str, columns: list[Array]) -> Iterator[str]:
    for piece in _table(columns, []):
        yield "".join(name + line + "\n" for line in piece.splitlines())


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
    """A text as one cell."""
    return '"' + text.replace('"', '""') + '"' if "," in text or '"' in text else text
