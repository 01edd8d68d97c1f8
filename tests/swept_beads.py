# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle in deposit and platform by brute force: beads as points of swept sections, the nozzle as a cone.

Nothing of freecad_am. A bead stands on its points along the build direction; its section is a stadium, as wide as the bead
and as high. What the nozzle rightly touches does not count: what is no higher over the tip than the bead, and of the beads
of the layer being laid (on spirals, of the last turn) all but the middle line where they are within their width of the tip,
or under the lower end of what is looked at.
"""

from dataclasses import dataclass

import numpy as np

ROUND_END_POINTS = 10
FLAT_SIDE_POINTS = 9


@dataclass(frozen=True)
class Cone:
    """A cone with a flat tip of a radius, opening by a half angle (rad) over a length in mm."""

    radius: float = 0.5
    half_angle: float = np.radians(20.0)
    length: float = 60.0

    def depth(self, offset, tool, low):
        """Return how far points (n, 3), relative to the tip, are inside the side of the cone, in
        mm. Points outside have negative values; points below `low` do not count."""
        x = offset @ tool
        side = np.sqrt(np.maximum(np.einsum("ij,ij->i", offset, offset) - x * x, 0.0))
        inside = (self.radius + np.tan(self.half_angle) * x - side) * np.cos(self.half_angle)
        return np.where((x > low) & (x <= self.length), inside, -np.inf)

    def clear_of(self, height, lean):
        """Return the height above the tip of a leaning cone, in mm, from which the whole cone is
        higher than that over the tip and at least one tip diameter away from it."""
        x = np.linspace(0.0, self.length, 600_001)
        lowest = x * np.cos(lean) - (self.radius + np.tan(self.half_angle) * x) * np.sin(lean)
        radius_mm = np.hypot(x, self.radius + np.tan(self.half_angle) * x)
        return float(x[np.argmax((lowest >= height) & (radius_mm >= 2.0 * self.radius))])


class Swept:
    """Beads in the order of deposit, with points and build directions (n, 3), widths and heights
    (n,), the layer number, and `turns` (n,) of a spiral. Section points are `step` mm apart along
    the beads."""

    def __init__(self, beads, step=0.5):
        base, flat, up, size, number, segment, line, self.begin, self.layer = (
            [],
            [],
            [],
            [],
            [],
            [],
            [],
            [0],
            [],
        )
        for points, build, width, height, layer in beads:
            along = np.diff(points, axis=0)
            length = np.linalg.norm(along, axis=1)
            along /= np.where(length > 0.0, length, 1.0)[:, None]
            start = self.begin[-1]
            self.begin.append(start + len(points))
            self.layer.append(layer)
            for k in np.flatnonzero(length > 0.0):
                count = max(2, int(np.ceil(length[k] / step)) + 1)
                t = np.linspace(0.0, 1.0, count)[:, None]
                sides = [np.cross(build[k + i], along[k]) for i in (0, 1)]
                sides = [side / np.linalg.norm(side) for side in sides]
                base.append(points[k] + t * (points[k + 1] - points[k]))
                flat.append((1.0 - t) * sides[0] + t * sides[1])
                up.append((1.0 - t) * build[k] + t * build[k + 1])
                size.append(
                    np.full(
                        (count, 2),
                        [0.5 * (width[k] + width[k + 1]), 0.5 * (height[k] + height[k + 1])],
                    )
                )
                number.append(np.full(count, start + k + 1))
                segment.append(np.full(count, len(line)))
                line.append((points[k], points[k + 1]))
        self.base, self.flat, self.up, self.size = (
            np.concatenate(column) for column in (base, flat, up, size)
        )
        self.number, self.segment = np.concatenate(number), np.concatenate(segment)
        self.line = np.array(line)

    def layer_began(self, bead):
        """Return the number of the first point of the bead's layer."""
        return self.begin[self.layer.index(self.layer[bead])]

    def deepest(self, tip, tool, end, layer_start, cone, low):
        """Return how deep the deposit of the points below number `before` reaches into the nozzle,
        in mm; `layer_start` is where the current layer begins."""
        count = int(np.searchsorted(self.number, end))
        base, size = self.base[:count] - tip, self.size[:count]
        ball = np.hypot(0.5 * size[:, 0], size[:, 1])
        x = base @ tool
        side = np.sqrt(np.maximum(np.einsum("ij,ij->i", base, base) - x * x, 0.0))
        close = (cone.radius + np.tan(cone.half_angle) * x - side) * np.cos(cone.half_angle) > -ball
        rows = np.flatnonzero(close & (x > low - ball) & (x < cone.length + ball))
        if not len(rows):
            return -np.inf
        nearby = self._beside(tip, rows, 2.0 * (cone.radius + np.tan(cone.half_angle) * low)) & (
            self.number[rows] > layer_start
        )
        lines = cone.depth(base[rows[nearby]], tool, low)
        rows = rows[~nearby]
        wide, tall = (size[rows, i, None, None] for i in (0, 1))
        round_ = 0.5 * np.minimum(wide, tall)
        angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, ROUND_END_POINTS)
        share = np.linspace(-1.0, 1.0, FLAT_SIDE_POINTS)
        # points around the section: along the two flats and around the round ends
        u = np.concatenate([share, share, 1.0 + 0.0 * angle, -1.0 + 0.0 * angle, share])
        r = np.concatenate([0.0 * share, 0.0 * share, np.cos(angle), -np.cos(angle), 0.0 * share])
        v = np.concatenate(
            [1.0 + 0.0 * share, -1.0 + 0.0 * share, np.sin(angle), np.sin(angle), 0.0 * share]
        )
        assert (wide >= tall).all()
        across = 0.5 * (wide - tall) * u[None, :, None] + round_ * r[None, :, None]
        points = (
            base[rows, None]
            + across * self.flat[rows, None]
            + (0.5 * tall + round_ * v[None, :, None]) * self.up[rows, None]
        )
        depths = cone.depth(points.reshape(-1, 3), tool, low)
        return float(max(depths.max(initial=-np.inf), lines.max(initial=-np.inf)))

    def _beside(self, tip, rows, min_distance):
        """Return which segments pass the tip within their width or `min_distance` mm."""
        start, end = self.line[self.segment[rows], 0] - tip, self.line[self.segment[rows], 1] - tip
        along = end - start
        share = np.clip(
            -np.einsum("ij,ij->i", start, along) / np.einsum("ij,ij->i", along, along), 0.0, 1.0
        )
        return np.linalg.norm(start + share[:, None] * along, axis=1) < np.maximum(
            self.size[rows, 0], min_distance
        )


def in_platform(tip, tool, cone, low, radius, middle=(0.0, 0.0, 0.0), count=60_000):
    """Return how deep the nozzle reaches into a horizontal disc about a point, in mm, from points
    spread evenly on the disc and on its rim."""
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    radii = radius * np.sqrt((np.arange(count) + 0.5) / count)
    disc = np.stack([radii * np.cos(turn), radii * np.sin(turn), 0.0 * turn], axis=1)
    rim = np.linspace(0.0, 2.0 * np.pi, 2000)
    disc = np.concatenate(
        [disc, np.stack([radius * np.cos(rim), radius * np.sin(rim), 0.0 * rim], axis=1)]
    )
    return float(cone.depth(disc + np.asarray(middle) - tip, tool, low).max())
