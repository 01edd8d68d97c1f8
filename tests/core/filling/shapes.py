# SPDX-License-Identifier: LGPL-2.1-or-later
"""Regions to fill, and checks of fills that use distances from a tree of dense points instead of
the code under test."""

import numpy as np
from scipy.spatial import cKDTree


def circle(radius, count=240, middle=(0.0, 0.0)):
    a = 2.0 * np.pi * np.arange(count) / count
    return np.stack([np.cos(a), np.sin(a)], axis=1) * np.reshape(radius, (-1, 1)) + middle


def blade(length=200.0, width=40.0, bend=15.0):
    x = np.linspace(0.0, 1.0, 120)
    half, middle = 2.0 * width * x * (1.0 - x), bend * np.sin(np.pi * x)
    lower, upper = np.c_[length * x, middle - half], np.c_[length * x, middle + half]
    return [np.vstack([lower, upper[-2:0:-1]])]


def wavy(seed):
    rng = np.random.default_rng(seed)
    a = 2.0 * np.pi * np.arange(300) / 300
    radius = 50.0 + sum(
        rng.uniform(-4.0, 4.0) * np.cos(k * a + rng.uniform(0, 6)) for k in range(2, 6)
    )
    holes = [circle(rng.uniform(5, 9), 60, (18.0, 6.0)), circle(7.0, 60, rng.uniform(-20, -8, 2))]
    return [circle(radius, 300), *(hole[::-1] for hole in holes)]


def polygon(*points):
    return [np.array(points, dtype=float)]


SHAPES = {
    "circle": [circle(37.0)],
    "annulus": [circle(50.0), circle(27.6)[::-1]],
    "blade": blade(),
    "L": polygon((0, 0), (100, 0), (100, 33), (31, 33), (31, 80), (0, 80)),
    "U": polygon((0, 0), (90, 0), (90, 70), (60, 70), (60, 28), (28, 28), (28, 70), (0, 70)),
    "comb": polygon(
        (0, 0),
        (110, 0),
        (110, 60),
        (88, 60),
        (88, 22),
        (66, 22),
        (66, 60),
        (44, 60),
        (44, 22),
        (22, 22),
        (22, 60),
        (0, 60),
    ),
    "wavy 1": wavy(1),
    "wavy 2": wavy(2),
}


def trim_round_ends(points, shares, width):
    """Shorten an open line (n, 2) and its width shares at both ends by the area that round ends
    add."""
    arc = np.r_[0.0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    cut = np.minimum(0.125 * np.pi * width * shares[[0, -1]], 0.49 * arc[-1])
    low, high = cut[0], arc[-1] - cut[1]
    stations = np.r_[low, arc[(arc > low) & (arc < high)], high]
    line = np.stack([np.interp(stations, arc, points[:, k]) for k in (0, 1)], axis=1)
    return line, np.interp(stations, arc, shares)


def densify(points, closed, step):
    """Insert points into a polyline until they are at most `step` apart."""
    ends = np.vstack([points, points[:1]]) if closed else points
    edges = np.diff(ends, axis=0)
    count = np.maximum(np.ceil(np.hypot(*edges.T) / step).astype(int), 1)
    edge_index = np.repeat(np.arange(len(edges)), count)
    share = (np.arange(len(edge_index)) - np.repeat(np.cumsum(count) - count, count)) / count[
        edge_index
    ]
    return np.vstack([ends[edge_index] + share[:, None] * edges[edge_index], ends[-1:]])


def build_tree(curves, step):
    return cKDTree(np.vstack([densify(points, closed, step) for points, closed in curves]))


def nearest_distance(tree, points, limit):
    """Return the distance of points to the tree; infinite beyond `limit`, which saves time."""
    return tree.query(points, distance_upper_bound=limit)[0]


def are_inside(loops, points):
    """Apply the even-odd rule."""
    odd = np.zeros(len(points), dtype=bool)
    x, y = points.T
    for loop in loops:
        for (ax, ay), (bx, by) in zip(loop, np.roll(loop, -1, axis=0)):
            if ay != by:
                odd ^= ((ay <= y) != (by <= y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    return odd


def make_grid(loops, pitch):
    """Return the points of a grid over the loops, and a mask of the points inside."""
    low, high = np.vstack(loops).min(axis=0) - 8.0, np.vstack(loops).max(axis=0) + 8.0
    grid = np.stack(
        np.meshgrid(*(np.arange(a, b, pitch) for a, b in zip(low, high))), axis=-1
    ).reshape(-1, 2)
    return grid, are_inside(loops, grid)
