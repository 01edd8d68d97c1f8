# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance against a plain bisection of every point against every segment
below, and the cost of twice the points. The part is the torus with 1 mm layers of Chalvin 2019 (R =
60, r = 15 on a pipe of 32 mm). The bisection is timed on a few layers and a subset of their points
and scaled up; its polyline below is refined four times, because its chord error would otherwise
exceed the required 1e-4 mm. Both results are compared before timing."""

from __future__ import annotations

from time import process_time

import numpy as np

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.slicing.tubes import constant_distance
from freecad_am.core.slicing.tubes.smooth_spacing import WallLayer, even_grid
from tests.core.patch_walls import bend

from rows import Row
from sizes import choose

HEIGHT, POINTS, TOLERANCE, ROUNDS = choose((1.0, 360, 1e-4, 3), (5.0, 360, 1e-4, 1))
SAMPLED_LAYERS, POINT_STEP = choose(((10, 40, 70), 6), ((3,), 60))
DOUBLED_POINTS = choose(
    (720, 1440, 2880), (720,)
)  # points of a layer; the time per point is compared with the size before
FRONT_HEIGHTS_MM = choose((5.0, 2.5), (20.0, 10.0))  # mm, layer heights
MIN_LINEAR_RATIO = 0.7  # allows for noise of a shared machine; quadratic time would show as 0.5
REFINEMENT = 4


def run() -> list[Row]:
    """Return all comparisons."""
    torus = Torus(60.0, 15.0)
    base_layer = intersect_implicit(
        torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, POINTS)
    )
    times, peers = [], []
    for _ in range(ROUNDS):
        start = process_time()
        layers = constant_distance.layers(torus, base_layer, HEIGHT, 0.5 * np.pi, POINTS)
        times.append(process_time() - start)
        peers.append(
            np.mean([time_bisection(torus, layers[i - 1], layers[i]) for i in SAMPLED_LAYERS])
            * (len(layers) - 1)
        )
    name = f"constant distance, {len(layers)} layers of {POINTS} points, {TOLERANCE:g} mm, against bisection"
    return [
        Row(name, float(np.median(times)), float(np.median(peers)), "s", 50.0),
        *compare_doublings(torus),
        compare_fronts(),
    ]


def compare_doublings(torus: Torus) -> list[Row]:
    """Time per point of layers 5 mm apart with twice as many points each time; the peer is the row
    before."""
    grids = (POINTS, *DOUBLED_POINTS)
    base_layers = [
        intersect_implicit(
            torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, points)
        )
        for points in grids
    ]
    times: list[list[float]] = [[] for _ in grids]
    for _ in range(ROUNDS):  # in turns, so that other load affects all sizes equally
        for i, (points, base_layer) in enumerate(zip(grids, base_layers)):
            start = process_time()
            layers = constant_distance.layers(torus, base_layer, 5.0 * HEIGHT, 0.5 * np.pi, points)
            times[i].append((process_time() - start) / sum(len(layer.v) for layer in layers))
    middle = [float(np.median(values)) for values in times]
    return [
        Row(
            f"constant distance, time per point of {points} points around against {grids[i]}",
            1e6 * middle[i + 1],
            1e6 * middle[i],
            "us",
            MIN_LINEAR_RATIO,
        )
        for i, points in enumerate(DOUBLED_POINTS)
    ]


def compare_fronts() -> Row:
    """Time per point of fronts on the mesh of the same bend, with layers half as far apart on edges
    half as long."""
    pipe = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
    walls = [bend(pipe, 0.3, 0.5 * np.pi, 0.25 * height) for height in FRONT_HEIGHTS_MM]
    times: list[list[float]] = [[] for _ in FRONT_HEIGHTS_MM]
    for _ in range(ROUNDS):
        for wall_times, wall, height in zip(times, walls, FRONT_HEIGHTS_MM):
            start = process_time()
            layers = fronts.slice_layers(wall, height).fronts
            wall_times.append(
                (process_time() - start) / sum(len(front.w) for layer in layers for front in layer)
            )
    coarse, fine = (float(np.median(wall_times)) for wall_times in times)
    name = f"fronts, time per point of layers {FRONT_HEIGHTS_MM[1]:g} mm apart against {FRONT_HEIGHTS_MM[0]:g} mm (4 times the points)"
    return Row(name, 1e6 * fine, 1e6 * coarse, "us", MIN_LINEAR_RATIO)


def time_bisection(torus: Torus, below: WallLayer, above: WallLayer) -> float:
    """Seconds that bisection takes for one layer."""
    line = below.curve.at(below.curve.refined(REFINEMENT))[0]
    a, along = line[:-1], np.diff(line, axis=0)
    square = (along * along).sum(axis=1)
    v = above.v[:-1:POINT_STEP]
    base = np.interp(v, below.v, below.u)
    solutions = np.empty(len(v))
    start = process_time()
    for i, (station, low) in enumerate(zip(v, base)):
        high = low + 3.0 * HEIGHT / (torus.bend - torus.tube)
        while (high - low) * (torus.bend + torus.tube) > 0.1 * TOLERANCE:
            middle = 0.5 * (low + high)
            gap = torus.point(middle, station) - a
            t = np.clip((gap * along).sum(axis=1) / square, 0.0, 1.0)
            offsets = gap - t[:, None] * along
            if (offsets * offsets).sum(axis=1).min() < HEIGHT * HEIGHT:
                low = middle
            else:
                high = middle
        solutions[i] = 0.5 * (low + high)
    seconds = process_time() - start
    difference = np.abs(solutions - above.u[:-1:POINT_STEP]).max() * (torus.bend + torus.tube)
    if difference > TOLERANCE:
        raise RuntimeError(f"bisection differs by {difference:.2g} mm")
    return seconds * (len(above.v) - 1) / len(v)
