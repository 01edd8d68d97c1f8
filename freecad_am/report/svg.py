# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drawing for the report: axes and curves as inline SVG; numbers in, text out."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from html import escape

import numpy as np

from ..core.geometry.formatting import round_step
from ..core.types import Array
from . import units

_MOST_COLUMNS = 700


def path_data(x: Array, y: Array, decimals: int = 1) -> str:
    """The `d` of a path through points; a NaN lifts the pen."""
    commands, pen = [], "M"
    for px, py in zip(np.round(x, decimals).tolist(), np.round(y, decimals).tolist()):
        if math.isnan(px) or math.isnan(py):
            pen = "M"
            continue
        commands.append(f"{pen}{px:g} {py:g}")
        pen = "L"
    return "".join(commands)


def thinned(x: Array, y: Array, columns: int = _MOST_COLUMNS) -> tuple[Array, Array]:
    """A curve with fewer points that looks the same: least and largest value of each column of the picture."""
    if len(x) <= 4 * columns:
        return x, y
    keep: list[int] = []
    for column in np.array_split(np.arange(len(x)), columns):
        finite = column[np.isfinite(y[column])]
        if len(finite) == 0:
            keep.append(int(column[0]))
            continue
        keep += sorted(
            {int(column[0]), int(finite[y[finite].argmin()]), int(finite[y[finite].argmax()])}
        )
    return x[keep], y[keep]


def ticks(low: float, high: float, count: int = 6) -> list[float]:
    """Round numbers inside low..high, at most about `count`."""
    if not high > low:
        return [low]
    step = round_step(0.999 * (high - low) / count, (1, 2, 2.5, 5, 10))
    return [k * step + 0.0 for k in range(math.ceil(low / step), math.floor(high / step) + 1)]


@dataclass
class Plot:
    """A frame with scales; draw into it in its own units, then take `text()`."""

    title: str
    x: tuple[float, float]
    y: tuple[float, float]
    x_label: str = ""
    y_label: str = ""
    width: int = 460
    height: int = 230
    elements: list[str] = field(default_factory=list)

    left, right, top, bottom = 58, 14, 30, 38

    def to_x(self, values: Array) -> Array:
        """Picture coordinates of values on the x axis."""
        low, high = self.x
        share: Array = (np.asarray(values, dtype=float) - low) / ((high - low) or 1.0)
        return self.left + share * (self.width - self.left - self.right)

    def to_y(self, values: Array) -> Array:
        """Picture coordinates of values on the y axis."""
        low, high = self.y
        share: Array = (np.asarray(values, dtype=float) - low) / ((high - low) or 1.0)
        return self.height - self.bottom - share * (self.height - self.top - self.bottom)

    def curve(self, x: Array, y: Array, stroke: str, name: str = "", wide: float = 1.6) -> None:
        """A line through points."""
        px, py = thinned(np.asarray(x, float), np.asarray(y, float))
        title = f"<title>{escape(name)}</title>" if name else ""
        self.elements.append(
            f'<path class="curve" stroke="{stroke}" stroke-width="{wide}" d="{path_data(self.to_x(px), self.to_y(py))}">'
            f"{title}</path>"
        )

    def rule(self, y: float, name: str) -> None:
        """A horizontal line with a name at its right end."""
        if self.y[0] <= y <= self.y[1]:
            y_pixel = float(self.to_y(np.array([y]))[0])
            right = self.width - self.right
            self.elements.append(
                f'<line class="asked" x1="{self.left}" x2="{right}" y1="{y_pixel:.1f}" y2="{y_pixel:.1f}"/>'
            )
            self.elements.append(
                f'<text class="rule" x="{right - 4}" y="{y_pixel - 4:.1f}" text-anchor="end">{escape(units.text(name))}</text>'
            )

    def legend(self, names: list[tuple[str, str]]) -> None:
        """Names of curves with their colours, in the top right corner."""
        x_pixel = float(self.width - self.right)
        for name, stroke in reversed([(units.text(name), stroke) for name, stroke in names]):
            x_pixel -= 9 + 6.2 * len(name)
            self.elements.append(
                f'<text class="key" x="{x_pixel + 8:.1f}" y="19">{escape(name)}</text>'
            )
            self.elements.append(
                f'<circle cx="{x_pixel + 2:.1f}" cy="15" r="3.5" fill="{stroke}"/>'
            )
            x_pixel -= 8

    def text(self) -> str:
        """The picture."""
        return (
            f'<svg class="plot" viewBox="0 0 {self.width} {self.height}" role="img" aria-label="{escape(units.text(self.title))}">'
            f'<text class="title" x="{self.left}" y="19">{escape(units.text(self.title))}</text>{self._grid()}{"".join(self.elements)}'
            f'<rect class="frame" x="{self.left}" y="{self.top}" width="{self.width - self.left - self.right}" '
            f'height="{self.height - self.top - self.bottom}"/></svg>'
        )

    def _grid(self) -> str:
        elements = []
        x_label, x_factor = units.label(self.x_label, max(map(abs, self.x)))
        y_label, y_factor = units.label(self.y_label, max(map(abs, self.y)))
        down, up = self.height - self.bottom, self.top
        right, middle = self.width - self.right, (self.left + self.width - self.right) / 2
        for value in ticks(*(x_factor * end for end in self.x)):
            pixel = float(self.to_x(np.array([value / x_factor]))[0])
            elements.append(
                f'<line class="grid" x1="{pixel:.1f}" x2="{pixel:.1f}" y1="{up}" y2="{down}"/>'
            )
            elements.append(
                f'<text class="tick" x="{pixel:.1f}" y="{down + 14}" text-anchor="middle">{value:g}</text>'
            )
        for value in ticks(*(y_factor * end for end in self.y), count=5):
            pixel = float(self.to_y(np.array([value / y_factor]))[0])
            elements.append(
                f'<line class="grid" x1="{self.left}" x2="{right}" y1="{pixel:.1f}" y2="{pixel:.1f}"/>'
            )
            elements.append(
                f'<text class="tick" x="{self.left - 6}" y="{pixel + 3.5:.1f}" text-anchor="end">{value:g}</text>'
            )
        elements.append(
            f'<text class="label" x="{middle}" y="{self.height - 6}" text-anchor="middle">{escape(x_label)}</text>'
            f'<text class="label" transform="translate(13 {(up + down) / 2}) rotate(-90)" text-anchor="middle">'
            f"{escape(y_label)}</text>"
        )
        return "".join(elements)
