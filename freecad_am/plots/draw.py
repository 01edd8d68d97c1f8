# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures drawn by matplotlib: charts in, a Figure out, and where in it each frame lies."""

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
from .chart import DOTS, MARKED, OUTLINE, STEP, Chart, Curve
from .look import BAR, Look

POINTS_KEPT = 4  # points to a column that are drawn as they are


def envelope(x: Array, y: Array, columns: int, low: float, high: float) -> Index:
    """The points, rising numbers into x and y (n,), that look like all of them between x = low and high.

    x never falls. NaN in y is kept where it is to be seen as a gap. One point beyond either end is kept, for the lines that
    lead there.
    """
    first = max(int(np.searchsorted(x, low, side="left")) - 1, 0)
    end = min(int(np.searchsorted(x, high, side="right")) + 1, len(x))
    rows = np.arange(first, end)
    if len(rows) <= POINTS_KEPT * columns:
        return rows
    column = np.clip(np.floor((x[first:end] - low) / (high - low) * columns), -1, columns).astype(
        np.intp
    )
    begins = np.concatenate([[0], np.flatnonzero(np.diff(column)) + 1])
    ends = np.concatenate([begins[1:], [len(rows)]]) - 1
    known = np.flatnonzero(np.isfinite(y[first:end]))
    rising = known[np.lexsort((y[first:end][known], column[known]))]
    cuts = np.flatnonzero(np.diff(column[rising])) + 1
    least = rising[np.concatenate([[0], cuts])] if len(rising) else rising
    largest = rising[np.concatenate([cuts, [len(rising)]]) - 1] if len(rising) else rising
    kept: Index = rows[np.unique(np.concatenate([begins, ends, least, largest]))]
    return kept


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


DPI = 100.0
# of a frame, in pixels: what is left free at its sides, above for its title, below for its scale
LEFT, RIGHT, ABOVE, BELOW, BARE = 66.0, 14.0, 24.0, 37.0, 6.0
NUMBERS = 12.0  # above a frame that has the numbers of layers
KEYS = 12.0  # of a row of names of curves, where they have no room beside the title
TEXT, TITLE, SMALL_TEXT = 7.6, 8.6, 6.4  # points
CHARACTER = 6.0  # pixels, about, of a text
TITLE_SCALE = 1.2  # of a title, which is larger
MOST_BORDERS, FEW_WRONG = 80, 40
APART = 26.0  # pixels between the numbers of layers, at least
BORDER, FRAME, FORBIDDEN, WANTED, BEAD = 0.35, 0.5, 0.13, 0.14, 0.35  # opacities
Range = tuple[float, float]


@dataclass(frozen=True)
class Window:
    """The part that is shown, by the number of a chart: across, the range of x, by 0 for all charts that share it; up, that
    of y. All there is, where left out."""

    across: Mapping[int, Range] = field(default_factory=dict)
    up: Mapping[int, Range] = field(default_factory=dict)


@dataclass(frozen=True)
class Place:
    """Where the frame of a chart lies in its picture: pixels from the left and from the top, and the ranges it shows."""

    left: float
    top: float
    width: float
    height: float
    across: Range
    up: Range


def figure(
    charts: Sequence[Chart], look: Look, width: int, height: int, window: Window | None = None
) -> tuple[Figure, tuple[Place, ...]]:
    """Charts one below the other, width times height pixels at 100 to the inch; where they count the same across, only the
    last one has the numbers. The same charts make the same figure."""
    window = window or Window()
    made = Figure(
        figsize=(width / DPI, height / DPI), dpi=DPI, facecolor=look.paper, edgecolor="none"
    )
    shared = share(charts)
    across = (
        (min(chart.across()[0] for chart in charts), max(chart.across()[1] for chart in charts))
        if shared
        else None
    )
    places, top = [], 0.0
    across_pixels = max(width - LEFT - RIGHT, 20.0)
    numbers = [
        chart.borders is not None and (number == 0 or not shared)
        for number, chart in enumerate(charts)
    ]
    above = [
        ABOVE + NUMBERS * there + KEYS * len(_rows_of_keys(chart, look, across_pixels))
        for chart, there in zip(charts, numbers, strict=True)
    ]
    fixed = sum(above) + sum(
        BELOW if _numbered(shared, number, charts) else BARE for number in range(len(charts))
    )
    tall = max((height - fixed) / len(charts), 12.0)
    for number, chart in enumerate(charts):
        numbered = _numbered(shared, number, charts)
        place = _to_scale(
            chart,
            Place(
                LEFT,
                top + above[number],
                across_pixels,
                tall,
                window.across.get(0 if shared else number) or across or chart.across(),
                window.up.get(number) or chart.up(),
            ),
        )
        _Frame(made, chart, look, place, width, height, numbered, numbers[number]).draw()
        places.append(place)
        top += above[number] + tall + (BELOW if numbered else BARE)
    return made, tuple(places)


def share(charts: Sequence[Chart]) -> bool:
    """Whether several charts count the same across, so that they are looked at together."""
    return len(charts) > 1 and len({chart.x for chart in charts}) == 1


def _numbered(shared: bool, number: int, charts: Sequence[Chart]) -> bool:
    return not shared or number == len(charts) - 1


def _to_scale(chart: Chart, place: Place) -> Place:
    """A place that shows more of one side where x and y are drawn to the same scale."""
    if not chart.plane:
        return place
    (left, right), (low, high) = place.across, place.up
    scale = max((right - left) / place.width, (high - low) / place.height)
    more = 0.5 * (scale * place.width - right + left), 0.5 * (scale * place.height - high + low)
    return replace(
        place, across=(left - more[0], right + more[0]), up=(low - more[1], high + more[1])
    )


def _named(chart: Chart) -> list[Curve]:
    """The curves whose names are told."""
    return [curve for curve in chart.curves if curve.kind != DOTS and curve.name]


def _titled(chart: Chart, look: Look) -> str:
    """The title of a chart, with how many values lie beyond its limits."""
    count = chart.wrong_count
    return look.words.beyond.format(chart.title, f"{count:,}") if count else chart.title


def _rows_of_keys(chart: Chart, look: Look, width: float) -> list[list[Curve]]:
    """The names of curves in rows between title and frame, none where they have room beside the title."""
    named = _named(chart)
    widths = [CHARACTER * (len(curve.name) + 3.0) for curve in named]
    if len(named) < 2 or CHARACTER * TITLE_SCALE * len(_titled(chart, look)) + sum(widths) <= width:
        return []
    rows: list[list[Curve]] = []
    left = 0.0
    for curve, needed in zip(named, widths, strict=True):
        if not rows or needed > left:
            rows.append([])
            left = width
        rows[-1].append(curve)
        left -= needed
    return rows


@dataclass(frozen=True)
class _Frame:
    made: Figure
    chart: Chart
    look: Look
    place: Place
    width: int
    height: int
    numbered: bool
    layers: bool

    def draw(self) -> None:
        place = self.place
        bottom = 1.0 - (place.top + place.height) / self.height
        axes = self.made.add_axes(
            (place.left / self.width, bottom, place.width / self.width, place.height / self.height),
            facecolor="none",
        )
        axes.set_xlim(*place.across)
        axes.set_ylim(*place.up)
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
        across = max(3, min(10, int(self.place.width / 75.0)))
        up = max(2, min(6, int(self.place.height / 26.0)))
        for axis, most in ((axes.xaxis, across), (axes.yaxis, up)):
            axis.set_major_locator(MaxNLocator(most, steps=[1, 2, 2.5, 5, 10]))
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
                self.place.left + 0.5 * self.place.width,
                self.place.top + self.place.height + 30.0,
                self.chart.x.label,
                ha="center",
            )
        label = (
            self.chart.y.unit
            if self.place.height < CHARACTER * len(self.chart.y.label)
            else self.chart.y.label
        )
        self._text(
            12.0,
            self.place.top + 0.5 * self.place.height,
            label,
            rotation=90.0,
            ha="center",
            va="center",
        )

    def _grounds(self, axes: Any) -> None:
        """What limits forbid, and the band that is wanted."""
        (low, high), (least, most) = self.place.up, self.chart.limits
        for start, end in ((low, min(least, high)), (max(most, low), high)):
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
        """Where layers begin; some of them where there are many."""
        chart = self.chart
        if chart.borders is None or chart.layers is None:
            return
        low, high = self.place.across
        seen = np.flatnonzero((chart.borders >= low) & (chart.borders <= high))
        seen = seen[:: -(-len(seen) // MOST_BORDERS) or 1]
        x = np.repeat(chart.borders[seen], 3)
        y = np.tile([0.0, 1.0, np.nan], len(seen))
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
        last = -np.inf
        for number in seen:
            share = (float(chart.borders[number]) - low) / (high - low)
            text = ("{}" if last >= 0.0 else self.look.words.layer).format(chart.layers[number])
            if share * self.place.width >= last + APART:
                self._text(
                    self.place.left + share * self.place.width,
                    self.place.top - 4.0,
                    text,
                    size=SMALL_TEXT,
                )
                last = share * self.place.width + CHARACTER * len(text)

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
                72.0 / DPI * self.place.width / (self.place.across[1] - self.place.across[0])
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
        rows = envelope(curve.x, curve.y, int(self.place.width), *self.place.across)
        x, y = curve.x[rows], curve.y[rows]
        dots = (
            {"marker": "o", "markersize": 2.6}
            if curve.kind == MARKED and len(x) < 0.2 * self.place.width
            else {}
        )
        axes.add_line(Line2D(x, y, color=colour, linewidth=1.1, **dots, **style))
        wrong = self.chart.wrong(y)
        if wrong.any():  # with dots where they are few: one alone makes no line
            few = {"marker": "o", "markersize": 2.6} if wrong.sum() <= FEW_WRONG else {}
            axes.add_line(
                Line2D(
                    x,
                    np.where(wrong, y, np.nan),
                    color=self.look.bad,
                    linewidth=2.2,
                    **few,
                    **style,
                )
            )

    def _marks(self, axes: Any) -> None:
        low, high = self.place.up
        for value, name in self.chart.marks:
            if low <= value <= high:
                self._across(axes, value, self.look.soft, name, left=True)
        for value, name in self.chart.upright:
            start, end = self.place.across
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
                    self.place.left + share * self.place.width + 4.0,
                    self.place.top + 10.0,
                    name,
                    size=SMALL_TEXT,
                )

    def _across(self, axes: Any, value: float, colour: str, name: str, left: bool = False) -> None:
        """A dashed line with its name at its right or left end, below it where there is no room above."""
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
        low, high = self.place.up
        down = self.place.top + (high - value) / (high - low) * self.place.height
        above = down - self.place.top > 11.0
        self._text(
            self.place.left + (4.0 if left else self.place.width - 4.0),
            down - 3.0 if above else down + 10.0,
            name,
            color=colour,
            ha="left" if left else "right",
            size=SMALL_TEXT,
        )

    def _title(self) -> None:
        words = self.look.words
        down = self.place.top - (7.0 + NUMBERS if self.layers else 7.0)
        rows = _rows_of_keys(self.chart, self.look, self.place.width)
        self._text(
            self.place.left,
            down - KEYS * len(rows),
            _titled(self.chart, self.look),
            size=TITLE,
            weight="bold",
            color=self.look.bad if self.chart.wrong_count else self.look.ink,
        )
        named = _named(self.chart)
        right = self.place.left + self.place.width
        least, most = self.chart.limits
        if len(named) < 2:
            ends = [f"{end:.6g}" for end in (least, most) if np.isfinite(end)]
            if np.isfinite(most):
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
        """Names of curves in one row that ends at the right."""
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
        self.made.text(left / self.width, 1.0 - down / self.height, text, **style)
