# SPDX-License-Identifier: LGPL-2.1-or-later
"""Is the nozzle clear of what is deposited already, and of the platform? Exact for parts of revolution.

The paper tilts the build directions near a closing top back by the nozzle's angle (Chalvin 2020, section 6.1).
Here the nozzle is a frustum: a flat tip of radius a at the deposit point, opening by the half angle over its
length along the tool axis t. With x the height of a point Q over the tip plane along t and k = tan(half angle), Q
is inside when 0 < x <= length and |Q - P|^2 < x^2 + (a + k x)^2. Points at or behind the tip plane are free, and so
is the bead being laid: everything within one nozzle diameter of the deposit point P.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.profile import Array
from ..parameters.cell import NozzleParameters
from .platform import Platform

ROUNDING = 1e-9  # mm^2 of depth that is rounding
AZIMUTHS = 24  # samples of the general case before its minima are refined
CHUNK = 1_000_000  # values worked on at once, so that large parts need no more memory than small ones


@dataclass(frozen=True)
class Deposit:
    """Beads in the order of deposit as arcs about the axis: radius and height (m,) mm in the feature frame."""

    radius: Array
    height: Array
    nozzle: NozzleParameters
    platform: Platform

    def clear(self, bead: NDArray[np.intp], tool: Array, reach: Array) -> NDArray[np.bool_]:
        """Whether the nozzle is clear, (k,).

        The tip is on bead[i]; tool (k, 3) in components along radius, azimuth and axis there; reach (k, 2) rad are the
        azimuths from the tip to the two ends of the beads.
        """
        symmetric = (np.abs(tool[:, 1]) < 1e-15) & (np.abs(reach.sum(axis=1)) < 1e-12)
        result = self._over_platform(bead, tool)
        for kind, depth, width in ((symmetric, self._depth_symmetric, 1), (~symmetric, self._depth_general, AZIMUTHS)):
            rows = np.flatnonzero(kind & result)
            step = max(1, CHUNK // (width * len(self.radius)))
            for some in (rows[i : i + step] for i in range(0, len(rows), step)):
                earlier = np.arange(bead[some].max() + 1)
                free = depth(bead[some], tool[some], reach[some], len(earlier)) >= -ROUNDING
                result[some] = (free | (earlier[None, :] > bead[some, None])).all(axis=1)
        return result

    def _depth_symmetric(self, bead: NDArray[np.intp], tool: Array, reach: Array, count: int) -> Array:
        """Least value of |Q - P|^2 - x^2 - (a + k x)^2 over each of the first `count` arcs, (k, count); positive
        where no point can touch.

        It is a concave quadratic in the cosine of the azimuth, x being linear in it, so the least is at an end of the
        cosines that matter: those of the arc, over the tip plane, below the nozzle's end, outside the bead being laid.
        """
        r0, z0 = self.radius[bead][:, None], self.height[bead][:, None]
        across, rise = self.radius[None, :count], self.height[None, :count] - z0
        slope = tool[:, :1] * across
        level = tool[:, 2:] * rise - tool[:, :1] * r0
        apart, swing = across**2 + r0**2 + rise**2, 2.0 * r0 * across
        low = np.broadcast_to(np.cos(np.minimum(reach[:, 1:], np.pi)), slope.shape)
        high = np.ones_like(slope)
        with np.errstate(divide="ignore", invalid="ignore"):
            at_tip, at_end = -level / slope, (self.nozzle.length - level) / slope
            outside = (apart - self.nozzle.diameter**2) / swing
        up, down = slope > 1e-15, slope < -1e-15
        low = np.where(up, np.maximum(low, at_tip), np.where(down, np.maximum(low, at_end), low))
        high = np.where(up, np.minimum(high, at_end), np.where(down, np.minimum(high, at_tip), high))
        high = np.where(swing > 1e-15, np.minimum(high, outside), high)
        inert = ~up & ~down & ((level <= 0.0) | (level > self.nozzle.length))
        inert |= (swing <= 1e-15) & (apart < self.nozzle.diameter**2)

        def value(cosine: Array) -> Array:
            x = slope * cosine + level
            return self._depth(apart - swing * cosine, x)

        least = np.minimum(value(low), value(high))
        return np.where(inert | (low > high), np.inf, least)

    def _depth(self, square: Array, x: Array) -> Array:
        a, k = 0.5 * self.nozzle.diameter, np.tan(self.nozzle.half_angle)
        return np.asarray(square - x * x - (a + k * x) ** 2)

    def _depth_general(self, bead: NDArray[np.intp], tool: Array, reach: Array, count: int) -> Array:
        """The same with a tool axis out of the plane of the axis, or an arc seen from within.

        A trigonometric polynomial of second order in the azimuth: it has at most two local minima, found among samples and
        refined by Newton's method; the least is at one of them or at an end of the stretches that matter.
        """
        result = np.full((len(bead), count), np.inf)
        rise = self.height[None, :count] - self.height[bead][:, None]
        lateral = np.hypot(tool[:, :1], tool[:, 1:2]) * self.radius[None, :count]
        highest = tool[:, 2:] * rise - tool[:, :1] * self.radius[bead][:, None] + lateral
        # an arc wholly behind the tip plane cannot be touched, nor one not yet laid
        case, ring = np.nonzero((highest > 0.0) & (np.arange(count)[None, :] <= bead[:, None]))
        if len(case):
            result[case, ring] = self._depth_pairs(bead[case], ring, tool[case], reach[case])
        return result

    def _depth_pairs(self, bead: NDArray[np.intp], ring: NDArray[np.intp], tool: Array, reach: Array) -> Array:
        r0, across = self.radius[bead][:, None], self.radius[ring][:, None]
        rise = (self.height[ring] - self.height[bead])[:, None]
        slope_c, slope_s = tool[:, :1] * across, tool[:, 1:2] * across
        level = tool[:, 2:] * rise - tool[:, :1] * r0
        apart, swing = across**2 + r0**2 + rise**2, 2.0 * r0 * across
        first, last = reach[:, :1], reach[:, 1:]

        def depth(azimuth: Array) -> tuple[Array, Array, Array]:
            c, s = np.cos(azimuth), np.sin(azimuth)
            x, square = slope_c * c + slope_s * s + level, apart - swing * c
            return self._depth(square, x), x, square

        def newton(azimuth: Array) -> Array:
            c, s = np.cos(azimuth), np.sin(azimuth)
            a, k = 0.5 * self.nozzle.diameter, np.tan(self.nozzle.half_angle)
            x, dx, ddx = slope_c * c + slope_s * s + level, slope_s * c - slope_c * s, -slope_c * c - slope_s * s
            steep = 2.0 * ((1.0 + k * k) * x + a * k)
            d = swing * s - steep * dx
            dd = swing * c - steep * ddx - 2.0 * (1.0 + k * k) * dx * dx
            return azimuth - np.where(dd > 1e-12, np.clip(d / np.where(dd > 1e-12, dd, 1.0), -0.2, 0.2), 0.0)

        around = np.linspace(-np.pi, np.pi, AZIMUTHS, endpoint=False)
        sampled = depth(around[None, :])[0]
        lowest = (sampled <= np.roll(sampled, 1, axis=1)) & (sampled <= np.roll(sampled, -1, axis=1))
        minima = around[np.argsort(np.where(lowest, sampled, np.inf), axis=1)[:, :2]]
        for _ in range(6):
            minima = newton(minima)
        with np.errstate(divide="ignore", invalid="ignore"):
            ball = np.arccos((apart - self.nozzle.diameter**2) / swing)
            middle, over = np.arctan2(slope_s, slope_c), np.hypot(slope_c, slope_s)
            end = np.arccos((self.nozzle.length - level) / over)
        places = np.hstack([minima, ball, -ball, middle + end, middle - end])
        places = np.hstack([places - 2.0 * np.pi, places, places + 2.0 * np.pi, first, last])
        known = np.isfinite(places) & (places >= first - 1e-12) & (places <= last + 1e-12)
        found, x, square = depth(np.where(known, places, 0.0))
        # an end of a stretch meets its own condition up to rounding only
        counts = known & (x > 0.0) & (x <= self.nozzle.length + 1e-10 * (1.0 + over))
        counts &= square >= self.nozzle.diameter**2 - 1e-12 * apart
        least: Array = np.where(counts, found, np.inf).min(axis=1)
        return least

    def _over_platform(self, bead: NDArray[np.intp], tool: Array) -> NDArray[np.bool_]:
        """Whether the nozzle stays clear of the platform's disc, (k,).

        In the plane of the disc the depth is least on the line under the tool axis, and concave along it: only the ends
        of the stretches that matter need be looked at.
        """
        if self.platform.radius <= 0.0:
            return np.ones(len(bead), dtype=bool)
        r0, z0 = self.radius[bead], self.height[bead] - self.platform.height
        level = np.hypot(tool[:, 0], tool[:, 1])
        leaning = level > 1e-12
        along = tool[:, :2] / np.where(leaning, level, 1.0)[:, None]
        # p runs from the foot of the deposit point along the tool's lean; x = level p - tool_z z0
        offset, side = r0 * along[:, 0], r0 * along[:, 1]
        half = np.sqrt(np.maximum(self.platform.radius**2 - side**2, 0.0))
        drop = tool[:, 2] * z0
        safe = np.where(leaning, level, 1.0)
        low = np.maximum(-offset - half, drop / safe)
        high = np.minimum(-offset + half, (self.nozzle.length + drop) / safe)
        ball = np.sqrt(np.maximum(self.nozzle.diameter**2 - z0**2, 0.0))
        clear = leaning | (tool[:, 2] > 0.0)
        for a, b in ((low, np.minimum(high, -ball)), (np.maximum(low, ball), high)):
            for p in (a, b):
                depth = self._depth(p * p + z0 * z0, level * p - drop)
                clear &= ~leaning | (a > b) | (depth >= -ROUNDING)
        return clear
