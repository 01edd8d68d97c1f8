# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws wall-spacing.png: the bend of Chalvin 2019 cut in four ways, coloured by the local distance between layers.

    python3 docs/images/make_wall_spacing.py

Needs matplotlib. A quarter torus (R = 60, r = 15 mm) on a pipe of radius 32 mm, layers 5 mm apart; below each, the
local distance of every layer around the tube, v = 0 being the outside of the bend.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, TwoSlopeNorm
from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from freecad_am.core.geometry.columns import Round  # noqa: E402
from freecad_am.core.geometry.walls.surface import Torus  # noqa: E402
from freecad_am.core.geometry.walls.surface_wall import SurfaceWall  # noqa: E402
from freecad_am.core.parameters.strategy import SurfaceParameters  # noqa: E402
from freecad_am.core.slicing.first_layer import intersect_implicit  # noqa: E402
from freecad_am.core.slicing.tubes import normal_layers  # noqa: E402
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid, local_distances  # noqa: E402
from freecad_am.core.strategies.walls.plan import sliced  # noqa: E402

BEND, TUBE, PIPE, HEIGHT, END = 60.0, 15.0, 32.0, 5.0, 0.5 * np.pi
AZIMUTH, ELEVATION = np.radians(-52.0), np.radians(22.0)
INK, SOFT = "#1d2430", "#667085"
SHADES = (
    "#2a3fb0",
    "#3f8fd4",
    "#3fa66f",
    "#e08a2c",
    "#b8272a",
)  # closer than asked, as asked, farther
NAMES = {
    "iso-parameter": "along the lines up the wall",
    "normal": "normal to the centreline",
    "constant-distance": "constant distance",
    "smooth": "smooth, within 20 %",
}


def layers(wall: SurfaceWall, method: str) -> list:
    """The layers of one method, up to the first one wholly past the end."""
    surface = wall.surface()
    if method == "normal":
        first = sliced(
            wall, surface, SurfaceParameters(layer_height=HEIGHT, spacing="iso-parameter")
        )[0]
        return normal_layers.layers(surface, first, HEIGHT, wall.end)
    return sliced(wall, surface, SurfaceParameters(layer_height=HEIGHT, spacing=method))


def drawn(fronts: list) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Points (n, 3), v (n,) and local distance (n,) of each layer but the first, NaN inside the pipe."""
    found = []
    for below, above in zip(fronts, fronts[1:]):
        v, distance = local_distances(above, below, 4)
        points = above.curve.at(v)[0]
        outside = np.hypot(points[:, 0], points[:, 2]) >= PIPE - 1e-3
        found.append(
            (np.where(outside[:, None], points, np.nan), v, np.where(outside, distance, np.nan))
        )
    return found


def screen() -> np.ndarray:
    """(2, 3) rows: right and up."""
    right = np.array([-np.sin(AZIMUTH), np.cos(AZIMUTH), 0.0])
    eye = np.array(
        [
            np.cos(ELEVATION) * np.cos(AZIMUTH),
            np.cos(ELEVATION) * np.sin(AZIMUTH),
            np.sin(ELEVATION),
        ]
    )
    return np.array([right, np.cross(eye, right)])


def draw() -> Figure:
    """The picture."""
    torus = Torus(BEND, TUBE)
    first = intersect_implicit(
        torus, Round.cylinder(PIPE, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, 360)
    )
    wall = SurfaceWall("torus", (BEND, TUBE), np.eye(4), END, first.curve.points[:-1])
    norm, view = TwoSlopeNorm(HEIGHT, 2.4, 6.4), screen()
    colours = LinearSegmentedColormap.from_list("local distance", SHADES)
    figure = Figure(figsize=(12.8, 5.2), dpi=100, facecolor="white")
    corners = []
    pictures = []
    for column, (method, name) in enumerate(NAMES.items()):
        fronts = layers(wall, method)
        found = drawn(fronts)
        left = 0.05 + 0.222 * column
        top, plot = (
            figure.add_axes((left - 0.012, 0.37, 0.22, 0.52)),
            figure.add_axes((left, 0.105, 0.195, 0.25)),
        )
        top.set_aspect("equal")
        top.axis("off")
        top.plot(*(view @ first.curve.points.T), color=SOFT, lw=1.6)
        for points, v, distance in found:
            seen = points @ view.T
            pairs = np.stack([seen[:-1], seen[1:]], axis=1)
            top.add_collection(
                LineCollection(
                    pairs, colors=colours(norm(distance[1:])), linewidths=2.0, capstyle="round"
                )
            )
            place = np.degrees(v - 2.0 * np.pi * np.round(v / (2.0 * np.pi)))
            order = np.argsort(place, kind="stable")
            plot.plot(place[order], distance[order], color=INK, lw=0.7, alpha=0.75)
        values = np.concatenate([distance for _, _, distance in found])
        corners.append(np.concatenate([points for points, _, _ in found]) @ view.T)
        pictures.append(top)
        told = (
            f"{name}\n{len(fronts)} layers, {np.nanmin(values):.2f} to {np.nanmax(values):.2f} mm"
        )
        figure.text(left + 0.0975, 0.9, told, fontsize=11, color=INK, ha="center")
        plot.set(xlim=(-180, 180), ylim=(2.2, 6.6), xticks=(-180, -90, 0, 90, 180))
        plot.grid(color="#dfe3ea", lw=0.8)
        plot.axhline(HEIGHT, color=SOFT, lw=0.9, ls="--")
        plot.tick_params(labelsize=9, colors=SOFT, length=2, labelleft=column == 0)
        plot.set_xlabel("v around the tube, deg", fontsize=9, color=SOFT)
        for spine in plot.spines.values():
            spine.set_color("#c3c9d4")
        if column == 0:
            plot.set_ylabel("local distance, mm", fontsize=9, color=SOFT)
    low, high = (f(np.concatenate(corners), axis=0) for f in (np.nanmin, np.nanmax))
    for top in pictures:  # all to one scale
        top.set(xlim=(low[0] - 2, high[0] + 2), ylim=(low[1] - 6, high[1] + 2))
    scale(figure, norm, colours)
    return figure


def scale(figure: Figure, norm: TwoSlopeNorm, colours) -> None:
    """The colours of the local distance."""
    axes = figure.add_axes((0.945, 0.42, 0.012, 0.40))
    values = np.linspace(norm.vmax, norm.vmin, 256)
    axes.imshow(
        colours(norm(values))[:, None], aspect="auto", extent=(0.0, 1.0, norm.vmin, norm.vmax)
    )
    axes.set_xticks([])
    axes.yaxis.tick_right()
    axes.tick_params(labelsize=9, colors=INK, length=3)
    axes.set_title("mm", fontsize=9, color=INK)
    for spine in axes.spines.values():
        spine.set_visible(False)


if __name__ == "__main__":
    draw().savefig(HERE / "wall-spacing.png", metadata={"Software": None})
