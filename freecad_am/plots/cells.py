# SPDX-License-Identifier: LGPL-2.1-or-later
"""A map of cells as a figure: colours, what is hatched, curves over it, a ramp that tells the colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure

from freecad_am.core.types import Array, Mask, NDArray

INCH = 100.0  # pixels
LEAST = 700, 450  # pixels that words beside the map have room in
FONT_SIZE = 8.0  # points


@dataclass(frozen=True, eq=False)
class Cells:
    """colours (R, C, 3) 0..255, lowest row first; hatched (R, C). columns, rows: places, counted in cells, with the texts
    beside them. lines: columns and rows along which a line is drawn. curves: rows (C,) over the columns, NaN lifts the pen,
    with a colour. ramp (n, 3) from `low` to `high`, what it counts in `scale`; classes: names with their colours."""

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
    """The map as a figure of so many pixels, LEAST at least."""
    size = max(width, LEAST[0]) / INCH, max(height, LEAST[1]) / INCH
    made = Figure(figsize=size, dpi=INCH, layout="constrained")
    axes = made.add_subplot()
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
    axes.set_xticks([place for place, _ in cells.columns], [text for _, text in cells.columns])
    axes.set_yticks([place for place, _ in cells.rows], [text for _, text in cells.rows])
    axes.tick_params(labelsize=FONT_SIZE)
    axes.set_xlabel(cells.title)
    axes.set_ylabel(cells.up)
    made.colorbar(
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
    return made
