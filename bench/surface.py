# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers of constant local distance against a straightforward bisection of every point against every segment below, and
what twice the points cost.

The torus of 1 mm layers of Chalvin 2019 (R = 60, r = 15 on a pipe of 32 mm). The bisection is timed on a few layers and a
part of their points and scaled up; its polyline below is refined four times, or its chord error would exceed the
1e-4 mm asked for. Both are checked against each other first.
"""

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
SAMPLED, EVERY = choose(((10, 40, 70), 6), ((3,), 60))
DOUBLED = choose(
    (720, 1440, 2880), (720,)
)  # points of a layer whose time per point is compared with that before
FRONTS = choose((5.0, 2.5), (20.0, 10.0))  # mm, layer heights
LINEAR = 0.7  # what a shared machine does to a time is forgiven; quadratic time would show as 0.5
REFINED = 4


def run() -> list[Row]:
    """All comparisons of this file."""
    torus = Torus(60.0, 15.0)
    first = intersect_implicit(
        torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, POINTS)
    )
    times, peers = [], []
    for _ in range(ROUNDS):
        start = process_time()
        layers = constant_distance.layers(torus, first, HEIGHT, 0.5 * np.pi, POINTS)
        times.append(process_time() - start)
        peers.append(
            np.mean([_bisected(torus, layers[i - 1], layers[i]) for i in SAMPLED])
            * (len(layers) - 1)
        )
    name = f"constant distance, {len(layers)} layers of {POINTS} points, {TOLERANCE:g} mm, against bisection"
    return [
        Row(name, float(np.median(times)), float(np.median(peers)), "s", 50.0),
        *_doublings(torus),
        _fronts(),
    ]


def _doublings(torus: Torus) -> list[Row]:
    """Time per point of layers 5 mm apart with twice as many points each time; the peer is the row before."""
    grids = (POINTS, *DOUBLED)
    firsts = [
        intersect_implicit(
            torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, points)
        )
        for points in grids
    ]
    times: list[list[float]] = [[] for _ in grids]
    for _ in range(ROUNDS):  # in turn, so that what else the machine does meets all of them
        for i, (points, first) in enumerate(zip(grids, firsts)):
            start = process_time()
            layers = constant_distance.layers(torus, first, 5.0 * HEIGHT, 0.5 * np.pi, points)
            times[i].append((process_time() - start) / sum(len(layer.v) for layer in layers))
    middle = [float(np.median(some)) for some in times]
    return [
        Row(
            f"constant distance, time per point of {points} points around against {grids[i]}",
            1e6 * middle[i + 1],
            1e6 * middle[i],
            "us",
            LINEAR,
        )
        for i, points in enumerate(DOUBLED)
    ]


def _fronts() -> Row:
    """Time per point of fronts over the mesh of the same bend, layers half as far apart on edges half as long."""
    pipe = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
    walls = [bend(pipe, 0.3, 0.5 * np.pi, 0.25 * height) for height in FRONTS]
    times: list[list[float]] = [[] for _ in FRONTS]
    for _ in range(ROUNDS):
        for some, wall, height in zip(times, walls, FRONTS):
            start = process_time()
            layers = fronts.slice_layers(wall, height).fronts
            some.append(
                (process_time() - start) / sum(len(front.w) for layer in layers for front in layer)
            )
    coarse, fine = (float(np.median(some)) for some in times)
    name = f"fronts, time per point of layers {FRONTS[1]:g} mm apart against {FRONTS[0]:g} mm (4 times the points)"
    return Row(name, 1e6 * fine, 1e6 * coarse, "us", LINEAR)


def _bisected(torus: Torus, below: WallLayer, above: WallLayer) -> float:
    """Seconds that one layer takes by bisection."""
    line = below.curve.at(below.curve.refined(REFINED))[0]
    a, along = line[:-1], np.diff(line, axis=0)
    square = (along * along).sum(axis=1)
    v = above.v[:-1:EVERY]
    base = np.interp(v, below.v, below.u)
    found = np.empty(len(v))
    start = process_time()
    for i, (one, low) in enumerate(zip(v, base)):
        high = low + 3.0 * HEIGHT / (torus.bend - torus.tube)
        while (high - low) * (torus.bend + torus.tube) > 0.1 * TOLERANCE:
            middle = 0.5 * (low + high)
            gap = torus.point(middle, one) - a
            t = np.clip((gap * along).sum(axis=1) / square, 0.0, 1.0)
            rest = gap - t[:, None] * along
            if (rest * rest).sum(axis=1).min() < HEIGHT * HEIGHT:
                low = middle
            else:
                high = middle
        found[i] = 0.5 * (low + high)
    seconds = process_time() - start
    apart = np.abs(found - above.u[:-1:EVERY]).max() * (torus.bend + torus.tube)
    if apart > TOLERANCE:
        raise RuntimeError(f"bisection differs by {apart:.2g} mm")
    return seconds * (len(above.v) - 1) / len(v)
