# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws hemisphere.png of the README from the waypoints of the demo.

    ./freecad-am demo
    python3 docs/images/make_images.py out/hemisphere/waypoints.csv

Needs matplotlib. Beads on the side towards the eye are drawn over those behind; a stroke at every few points is the
build direction there.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent
AZIMUTH, ELEVATION = np.radians(-58.0), np.radians(24.0)
DIRECTION_LENGTH = 8.0  # mm
EVERY_LAYER, APART = 10, 13.0  # layers with directions, and how far apart those are, mm
INK, GROUND = "#1d2430", "#ffffff"


def deposit_rows(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Layer (n,), position (n, 3) in mm and build direction (n, 3) of the deposit points."""
    with path.open(newline="") as stream:
        rows = [row for row in csv.DictReader(stream) if row["kind"] == "deposit"]
    layer = np.array([int(row["layer"]) for row in rows])
    position = np.array([[float(row[key]) for key in ("x_mm", "y_mm", "z_mm")] for row in rows])
    direction = np.array([[float(row[key]) for key in ("bx", "by", "bz")] for row in rows])
    return layer, position, direction


def screen() -> np.ndarray:
    """(3, 3) rows: right, up and towards the eye."""
    right = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0.0])
    eye = np.array(
        [
            np.cos(ELEVATION) * np.cos(AZIMUTH),
            np.cos(ELEVATION) * np.sin(AZIMUTH),
            np.sin(ELEVATION),
        ]
    )
    return np.array([right, np.cross(eye, right), eye])


def draw(layer: np.ndarray, position: np.ndarray, direction: np.ndarray) -> Figure:
    """The picture of a part of revolution about Z."""
    view = screen()
    figure = Figure(figsize=(10.24, 6.4), dpi=100, facecolor=GROUND)
    axes = figure.add_axes((0.02, 0.02, 0.84, 0.96))
    axes.set_aspect("equal")
    axes.axis("off")
    platform(
        axes,
        view,
        float(np.hypot(position[:, 0], position[:, 1]).max()),
        float(position[:, 2].min()),
    )
    share = (layer - layer.min()) / max(1, np.ptp(layer))
    inside = layer[1:] == layer[:-1]
    start, end = position[:-1][inside] @ view.T, position[1:][inside] @ view.T
    colours = colormaps["viridis"](share[1:][inside])
    along = position[1:] - position[:-1]
    outward = np.cross(along, direction[1:])[inside]
    towards = outward @ view[2]
    for near, width, opacity, order in ((False, 1.2, 0.35, 1), (True, 2.9, 1.0, 3)):
        chosen = (towards > 0.0) == near
        pairs = np.stack([start[chosen, :2], end[chosen, :2]], axis=1)
        axes.add_collection(
            LineCollection(
                pairs,
                colors=colours[chosen],
                linewidths=width,
                alpha=opacity,
                zorder=order,
                capstyle="round",
            )
        )
    strokes(axes, view, layer, position, direction)
    axes.autoscale_view()
    axes.margins(0.03)
    scale(figure, int(layer.max()))
    return figure


def platform(axes, view: np.ndarray, radius: float, height: float) -> None:
    """The round platform under the part."""
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    disc = (
        np.stack(
            [1.25 * radius * np.cos(angle), 1.25 * radius * np.sin(angle), np.full(181, height)],
            axis=1,
        )
        @ view.T
    )
    below = disc[:, :2] - [0.0, 5.0 * np.cos(ELEVATION)]
    axes.fill(below[:, 0], below[:, 1], color="#c3c9d4", zorder=-2)
    axes.fill(disc[:, 0], disc[:, 1], color="#e6e9ef", ec="#c3c9d4", lw=0.8, zorder=-1)


def strokes(
    axes, view: np.ndarray, layer: np.ndarray, position: np.ndarray, direction: np.ndarray
) -> None:
    """Build directions on the near side of every few layers."""
    pairs = []
    for number in range(0, int(layer.max()) + 1, EVERY_LAYER):
        rows = np.flatnonzero(layer == number)
        around = 2.0 * np.pi * np.hypot(*position[rows[0], :2])
        count = max(3, round(around / APART))
        for row in rows[np.linspace(0, len(rows) - 1, count, endpoint=False).astype(int)]:
            radial = position[row] * [1.0, 1.0, 0.0]
            if np.cross(np.cross([0.0, 0.0, 1.0], radial), direction[row]) @ view[2] > 0.0:
                tip = position[row] + DIRECTION_LENGTH * direction[row]
                pairs.append([(position[row] @ view.T)[:2], (tip @ view.T)[:2]])
    feet = np.array([pair[0] for pair in pairs])
    for colour, width, order in ((GROUND, 3.4, 4), (INK, 1.5, 5)):
        axes.add_collection(
            LineCollection(pairs, colors=colour, linewidths=width, zorder=order, capstyle="round")
        )
    axes.scatter(
        feet[:, 0], feet[:, 1], s=16, color=INK, zorder=6, linewidths=0.6, edgecolors=GROUND
    )


def scale(figure: Figure, last: int) -> None:
    """The colours of the layers."""
    axes = figure.add_axes((0.905, 0.18, 0.018, 0.64))
    axes.imshow(
        np.linspace(1.0, 0.0, 256)[:, None],
        cmap="viridis",
        aspect="auto",
        extent=(0.0, 1.0, 0.0, float(last)),
    )
    axes.set_xticks([])
    axes.yaxis.tick_right()
    axes.tick_params(labelsize=11, colors=INK, length=3)
    axes.set_title("layer", fontsize=12, color=INK, pad=10)
    for spine in axes.spines.values():
        spine.set_visible(False)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: make_images.py WAYPOINTS.csv")
    draw(*deposit_rows(Path(sys.argv[1]))).savefig(
        HERE / "hemisphere.png", metadata={"Software": None}
    )
