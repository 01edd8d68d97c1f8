# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draw charts with matplotlib: return a Figure and the position of each frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator, ScalarFormatter

from ..core.types import Array, Index
from .chart import BAR, DOTS, MARKED, OUTLINE, STEP, Chart, Curve, Look

POINTS_KEPT = 4  # maximum mean number of points per pixel column without thinning


def envelope(x: Array, y: Array, columns: int, low: float, high: float) -> Index:
    """Thin a curve without visible change; return the increasing indices of the remaining points.

    x, y: (n,), where x never decreases. Visible gaps (NaN in y) remain. One point beyond each of
    `low` and `high` remains, for lines that leave the frame.
    """
    start = max(int(np.searchsorted(x, low, side="left")) - 1, 0)
    end = min(int(np.searchsorted(x, high, side="right")) + 1, len(x))
    rows = np.arange(start, end)
    if len(rows) <= POINTS_KEPT * columns:
        return rows
    column = np.clip(np.floor((x[start:end] - low) / (high - low) * columns), -1, columns).astype(
        np.intp
    )
    begins = np.concatenate([[0], np.flatnonzero(np.diff(column)) + 1])
    ends = np.concatenate([begins[1:], [len(rows)]]) - 1
    finite = np.flatnonzero(np.isfinite(y[start:end]))
    rising = finite[np.lexsort((y[start:end][finite], column[finite]))]
    cuts = np.flatnonzero(np.diff(column[rising])) + 1
    smallest = rising[np.concatenate([[0], cuts])] if len(rising) else rising
    largest = rising[np.concatenate([cuts, [len(rising)]]) - 1] if len(rising) else rising
    points: Index = rows[np.unique(np.concatenate([begins, ends, smallest, largest]))]
    return points


RING = {"linestyle": "none", "marker": "o", "markersize": 8.0, "fillstyle": "none"}
NAME_OFFSET = (6.0, 4.0)  # typographic points; offset of a name from its ring


def named(axes: Any, chart: Chart, colour: str, size: float) -> None:
    """Draw a ring and a name at each named point of a chart. size: font size, points."""
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


DPI = 100.0
# px; margins of a frame: at the sides, above for the title, below for the axis labels
LEFT_MARGIN, RIGHT_MARGIN, TOP_MARGIN, BOTTOM_MARGIN, BARE_MARGIN = 66.0, 14.0, 24.0, 37.0, 6.0
NUMBERS = 12.0  # px; height above a frame for layer numbers
KEYS = 12.0  # px; height of a legend row that does not fit next to the title
TEXT, TITLE, SMALL_TEXT = 7.6, 8.6, 6.4  # font sizes, points
CHARACTER = 6.0  # px; approximate width of a character
TITLE_SCALE = 1.2  # title size relative to other text
MOST_BORDERS, FEW_WRONG = 80, 40
MIN_LABEL_GAP = 26.0  # px; minimum distance between layer numbers
BORDER, FRAME, FORBIDDEN, WANTED, BEAD = 0.35, 0.5, 0.13, 0.14, 0.35  # opacities
Range = tuple[float, float]


@dataclass(frozen=True)
class Window:
    """Visible ranges by chart index. A missing key means the full range.

    across: x ranges; key 0 applies to all charts that share x. up: y ranges.
    """

    across: Mapping[int, Range] = field(default_factory=dict)
    up: Mapping[int, Range] = field(default_factory=dict)


@dataclass(frozen=True)
class Place:
    """Position of a chart frame in its picture, px from left and top, and its x and y ranges."""

    left: float
    top: float
    width: float
    height: float
    across: Range
    up: Range


def figure(
    charts: Sequence[Chart], look: Look, width: int, height: int, window: Window | None = None
) -> tuple[Figure, tuple[Place, ...]]:
    """Draw charts in a figure of width x height pixels; return the figure and the frame positions.

    The resolution is 100 dpi. Equal charts give equal figures.
    """
    drawing = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, edgecolor="none")
    return drawing, fill(drawing, charts, look, window or Window())


def fill(drawing: Figure, charts: Sequence[Chart], look: Look, window: Window) -> tuple[Place, ...]:
    """Redraw a figure with charts stacked vertically, reusing the figure's axes.

    If the charts share x, only the last chart has tick labels on x. Animated artists, such as
    matplotlib cursors, stay.
    """
    width, height = (round(float(size) * DPI, 6) for size in drawing.get_size_inches())
    drawing.set_facecolor(look.paper)
    for owner in (drawing, *drawing.axes):
        for artist in [*owner.lines, *owner.patches, *owner.texts]:
            if not artist.get_animated():
                artist.remove()
    shared = share(charts)
    across = (
        (min(chart.across()[0] for chart in charts), max(chart.across()[1] for chart in charts))
        if shared
        else None
    )
    panels, top = [], 0.0
    across_pixels = max(width - LEFT_MARGIN - RIGHT_MARGIN, 20.0)
    numbers = [
        chart.borders is not None and (number == 0 or not shared)
        for number, chart in enumerate(charts)
    ]
    above = [
        TOP_MARGIN + NUMBERS * has_numbers + KEYS * len(_rows_of_keys(chart, look, across_pixels))
        for chart, has_numbers in zip(charts, numbers, strict=True)
    ]
    fixed = sum(above) + sum(
        BOTTOM_MARGIN if _numbered(shared, number, charts) else BARE_MARGIN
        for number in range(len(charts))
    )
    tall = max((height - fixed) / len(charts), 12.0)
    for number, chart in enumerate(charts):
        numbered = _numbered(shared, number, charts)
        panel = _to_scale(
            chart,
            Place(
                LEFT_MARGIN,
                top + above[number],
                across_pixels,
                tall,
                window.across.get(0 if shared else number) or across or chart.across(),
                window.up.get(number) or chart.up(),
            ),
        )
        frame = _Frame(drawing, chart, look, panel, width, height, numbered, numbers[number])
        frame.draw(drawing.axes[number] if number < len(drawing.axes) else None)
        panels.append(panel)
        top += above[number] + tall + (BOTTOM_MARGIN if numbered else BARE_MARGIN)
    return tuple(panels)


def share(charts: Sequence[Chart]) -> bool:
    """Whether several charts share the x axis."""
    return len(charts) > 1 and len({chart.x for chart in charts}) == 1


def _numbered(shared: bool, number: int, charts: Sequence[Chart]) -> bool:
    return not shared or number == len(charts) - 1


def _to_scale(chart: Chart, panel: Place) -> Place:
    """Return the frame with one range extended so that x and y have the same scale."""
    if not chart.plane:
        return panel
    (left, right), (low, high) = panel.across, panel.up
    scale = max((right - left) / panel.width, (high - low) / panel.height)
    margin = 0.5 * (scale * panel.width - right + left), 0.5 * (scale * panel.height - high + low)
    return replace(
        panel, across=(left - margin[0], right + margin[0]), up=(low - margin[1], high + margin[1])
    )


def _named(chart: Chart) -> list[Curve]:
    """Return the curves that appear in the legend."""
    return [curve for curve in chart.curves if curve.kind != DOTS and curve.name]


def _titled(chart: Chart, look: Look) -> str:
    """Return the chart title, with the number of values beyond the limits if there are any."""
    count = chart.wrong_count
    return look.words.beyond.format(chart.title, f"{count:,}") if count else chart.title


def _rows_of_keys(chart: Chart, look: Look, width: float) -> list[list[Curve]]:
    """Return the legend rows above the frame; empty if the legend fits next to the title."""
    named = _named(chart)
    widths = [CHARACTER * (len(curve.name) + 3.0) for curve in named]
    if len(named) < 2 or CHARACTER * TITLE_SCALE * len(_titled(chart, look)) + sum(widths) <= width:
        return []
    rows: list[list[Curve]] = []
    room = 0.0
    for curve, needed in zip(named, widths, strict=True):
        if not rows or needed > room:
            rows.append([])
            room = width
        rows[-1].append(curve)
        room -= needed
    return rows


@dataclass(frozen=True)
class _Frame:
    figure: Figure
    chart: Chart
    look: Look
    panel: Place
    width: float
    height: float
    numbered: bool
    layers: bool

    def draw(self, axes: Any) -> None:
        """Draw the frame in the given axes, or in new axes if None."""
        panel = self.panel
        bottom = 1.0 - (panel.top + panel.height) / self.height
        box = (
            panel.left / self.width,
            bottom,
            panel.width / self.width,
            panel.height / self.height,
        )
        if axes is None:
            axes = self.figure.add_axes(box, facecolor="none")
        else:
            axes.set_position(box)
        axes.set_xlim(*panel.across)
        axes.set_ylim(*panel.up)
        self._scales(axes)
        self._grounds(axes)
        self._borders(axes)
        if self.chart.bars is not None:
            axes.stairs(
                self.chart.bars.heights, self.chart.bars.edges, fill=True, color=BAR, linewidth=0.0
            )
        for curve in self.chart.curves:
            self._curve(axes, curve)
        self._marks(axes)
        named(axes, self.chart, self.look.ink, TITLE)
        self._title()

    def _scales(self, axes: Any) -> None:
        for spine in axes.spines.values():
            spine.set(color=self.look.soft, linewidth=0.7, alpha=FRAME)
        across = max(3, min(10, int(self.panel.width / 75.0)))
        up = max(2, min(6, int(self.panel.height / 26.0)))
        quantities = self.chart.x, self.chart.y
        for axis, count, quantity in zip((axes.xaxis, axes.yaxis), (across, up), quantities):
            steps = [1, 2, 5, 10] if quantity.is_whole else [1, 2, 2.5, 5, 10]
            axis.set_major_locator(MaxNLocator(count, steps=steps, integer=quantity.is_whole))
            numbers = ScalarFormatter(useOffset=False)
            numbers.set_powerlimits((-4, 6))
            axis.set_major_formatter(numbers)
            axis.get_offset_text().set(color=self.look.soft, size=SMALL_TEXT)
        axes.tick_params(
            length=0.0,
            pad=3.0,
            labelsize=TEXT,
            labelcolor=self.look.soft,
            labelbottom=self.numbered,
            grid_color=self.look.grid,
            grid_linewidth=0.8,
        )
        axes.grid(True)
        axes.set_axisbelow(True)
        if self.numbered:
            self._text(
                self.panel.left + 0.5 * self.panel.width,
                self.panel.top + self.panel.height + 30.0,
                self.chart.x.label,
                ha="center",
            )
        label = (
            self.chart.y.unit
            if self.panel.height < CHARACTER * len(self.chart.y.label)
            else self.chart.y.label
        )
        self._text(
            12.0,
            self.panel.top + 0.5 * self.panel.height,
            label,
            rotation=90.0,
            ha="center",
            va="center",
        )

    def _grounds(self, axes: Any) -> None:
        """Shade the ranges beyond the limits, and the target band."""
        (low, high), (lower, upper) = self.panel.up, self.chart.limits
        for start, end in ((low, min(lower, high)), (max(upper, low), high)):
            if np.isfinite(end - start) and end > start:
                axes.add_patch(
                    Rectangle(
                        (0.0, start),
                        1.0,
                        end - start,
                        transform=axes.get_yaxis_transform(),
                        facecolor=self.look.bad,
                        alpha=FORBIDDEN,
                        linewidth=0.0,
                    )
                )
        for value in self.chart.limits:
            if low <= value <= high:
                self._across(axes, value, self.look.bad, f"{value:.6g}")
        if self.chart.band is not None:
            start, end = self.chart.band
            axes.add_patch(
                Rectangle(
                    (start, 0.0),
                    end - start,
                    1.0,
                    transform=axes.get_xaxis_transform(),
                    facecolor=self.look.good,
                    alpha=WANTED,
                    linewidth=0.0,
                )
            )

    def _borders(self, axes: Any) -> None:
        """Draw layer borders, thinned to at most MOST_BORDERS."""
        chart = self.chart
        if chart.borders is None or chart.layers is None:
            return
        low, high = self.panel.across
        borders = np.flatnonzero((chart.borders >= low) & (chart.borders <= high))
        borders = borders[:: -(-len(borders) // MOST_BORDERS) or 1]
        x = np.repeat(chart.borders[borders], 3)
        y = np.tile([0.0, 1.0, np.nan], len(borders))
        axes.add_line(
            Line2D(
                x,
                y,
                transform=axes.get_xaxis_transform(),
                color=self.look.soft,
                alpha=BORDER,
                linewidth=0.7,
                linestyle=(0, (1, 2)),
            )
        )
        if not self.layers:
            return
        end = -np.inf
        for number in borders:
            share = (float(chart.borders[number]) - low) / (high - low)
            text = ("{}" if end >= 0.0 else self.look.words.layer).format(chart.layers[number])
            if share * self.panel.width >= end + MIN_LABEL_GAP:
                self._text(
                    self.panel.left + share * self.panel.width,
                    self.panel.top - 4.0,
                    text,
                    size=SMALL_TEXT,
                )
                end = share * self.panel.width + CHARACTER * len(text)

    def _curve(self, axes: Any, curve: Curve) -> None:
        colour = self.look.colour(curve.colour)
        style = {"drawstyle": "steps-pre"} if curve.kind == STEP else {}
        if curve.kind == DOTS:
            axes.add_line(
                Line2D(curve.x, curve.y, color=colour, linestyle="none", marker="o", markersize=4.0)
            )
            return
        if curve.kind == OUTLINE:
            to_points = (
                72.0 / DPI * self.panel.width / (self.panel.across[1] - self.panel.across[0])
            )
            style = (
                {"linewidth": to_points * curve.width, "alpha": BEAD}
                if curve.width
                else {"linewidth": 1.3}
            )
            axes.add_line(
                Line2D(
                    curve.x,
                    curve.y,
                    color=colour,
                    solid_joinstyle="round",
                    solid_capstyle="round",
                    **style,
                )
            )
            return
        rows = envelope(curve.x, curve.y, int(self.panel.width), *self.panel.across)
        x, y = curve.x[rows], curve.y[rows]
        dots = (
            {"marker": "o", "markersize": 2.6}
            if curve.kind == MARKED and len(x) < 0.2 * self.panel.width
            else {}
        )
        axes.add_line(Line2D(x, y, color=colour, linewidth=1.1, **dots, **style))
        wrong = self.chart.wrong(y)
        if wrong.any():  # mark a few values with dots, because a single value draws no line
            marker = {"marker": "o", "markersize": 2.6} if wrong.sum() <= FEW_WRONG else {}
            axes.add_line(
                Line2D(
                    x,
                    np.where(wrong, y, np.nan),
                    color=self.look.bad,
                    linewidth=2.2,
                    **marker,
                    **style,
                )
            )

    def _marks(self, axes: Any) -> None:
        low, high = self.panel.up
        for value, name in self.chart.marks:
            if low <= value <= high:
                self._across(axes, value, self.look.soft, name, left=True)
        for value, name in self.chart.upright:
            start, end = self.panel.across
            if start <= value <= end:
                axes.add_line(
                    Line2D(
                        [value, value],
                        [0.0, 1.0],
                        transform=axes.get_xaxis_transform(),
                        color=self.look.ink,
                        linewidth=1.0,
                        linestyle="--",
                    )
                )
                share = (value - start) / (end - start)
                self._text(
                    self.panel.left + share * self.panel.width + 4.0,
                    self.panel.top + 10.0,
                    name,
                    size=SMALL_TEXT,
                )

    def _across(self, axes: Any, value: float, colour: str, name: str, left: bool = False) -> None:
        """Draw a dashed horizontal line, named at its right or left end.

        The name is below the line if there is no space above.
        """
        axes.add_line(
            Line2D(
                [0.0, 1.0],
                [value, value],
                transform=axes.get_yaxis_transform(),
                color=colour,
                linewidth=1.0,
                linestyle="--",
            )
        )
        low, high = self.panel.up
        down = self.panel.top + (high - value) / (high - low) * self.panel.height
        above = down - self.panel.top > 11.0
        self._text(
            self.panel.left + (4.0 if left else self.panel.width - 4.0),
            down - 3.0 if above else down + 10.0,
            name,
            color=colour,
            ha="left" if left else "right",
            size=SMALL_TEXT,
        )

    def _title(self) -> None:
        words = self.look.words
        down = self.panel.top - (7.0 + NUMBERS if self.layers else 7.0)
        rows = _rows_of_keys(self.chart, self.look, self.panel.width)
        self._text(
            self.panel.left,
            down - KEYS * len(rows),
            _titled(self.chart, self.look),
            size=TITLE,
            weight="bold",
            color=self.look.bad if self.chart.wrong_count else self.look.ink,
        )
        named = _named(self.chart)
        right = self.panel.left + self.panel.width
        lower, upper = self.chart.limits
        if len(named) < 2:
            ends = [f"{end:.6g}" for end in (lower, upper) if np.isfinite(end)]
            if np.isfinite(upper):
                word = words.limits if len(ends) == 2 else words.limit
                self._text(
                    right, down, word.format(*ends, self.chart.y.unit), ha="right", size=SMALL_TEXT
                )
            elif self.chart.unlimited:
                self._text(right, down, self.chart.unlimited, ha="right", size=SMALL_TEXT)
            return
        below = down - KEYS * len(rows)
        for number, row in enumerate(rows):
            self._keys(right, below + KEYS * (number + 1), row)
        if not rows:
            self._keys(right, down, named)

    def _keys(self, right: float, down: float, named: Sequence[Curve]) -> None:
        """Draw one right-aligned legend row."""
        for curve in reversed(named):
            right -= CHARACTER * len(curve.name) + 4.0
            self._key(right, down, curve)
            right -= 14.0

    def _key(self, left: float, down: float, curve: Curve) -> None:
        self._text(left, down, curve.name)
        self._text(left - 10.0, down, "●", color=self.look.colour(curve.colour))

    def _text(self, left: float, down: float, text: str, **style: Any) -> None:
        style = {
            "color": self.look.soft,
            "size": TEXT,
            "va": "baseline",
            "parse_math": False,
            **style,
        }
        self.figure.text(left / self.width, 1.0 - down / self.height, text, **style)
