# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes of circles about the axis: mode, lead and tilt, cap, clearance of the nozzle.

All beads of a layer turn as one: a bead is tilted back as a whole, by what its worst point needs. Only the bead of
a part of a turn with one direction per layer differs from point to point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..geometry.profile import Array, RevolvedWall
from ..issues import ERROR, NOTE, Issue
from ..parameters.build_direction import BuildDirectionParameters
from ..parameters.cell import NozzleParameters
from ..slicing import build_direction as directions
from .clearance import Deposit
from .platform import Platform


@dataclass(frozen=True)
class Rows:
    """One row per case to be judged: bead (k,), build direction (k, 3), running sense (k,), view of the arc (k, 2)."""

    bead: NDArray[np.intp]
    build: Array
    rising: NDArray[np.bool_]
    reach: Array


@dataclass(frozen=True)
class Tilting:
    """Everything that decides the tool axes of a wall."""

    wall: RevolvedWall
    parameters: BuildDirectionParameters
    nozzle: NozzleParameters
    platform: Platform

    def settle(
        self, radius: Array, height: Array, tangent: Array, azimuths: Sequence[Array], rising: Sequence[bool],
        layer: NDArray[np.intp],
    ) -> tuple[list[Array], list[Array], list[Issue]]:
        """Build directions and tool axes per bead, (n, 3) or (1, 3) for all points alike, and what was found.

        radius, height (m,), tangent (m, 2): the beads in the order of deposit. azimuths, rising: of each bead.
        layer: (m,) the layer that issues name.
        """
        rows = self._rows(tangent, azimuths, rising)
        angle, issues = self._settled(rows, radius, height, layer)
        build = directions.tilted_back(rows.build, angle)
        tool = self._tool(build, rows.rising)
        splits = np.searchsorted(rows.bead, np.arange(1, len(radius)))
        return np.split(build, splits), np.split(tool, splits), issues

    def tilt_back(
        self, radius: Array, height: Array, tangent: Array, rising: bool, layer: NDArray[np.intp]
    ) -> tuple[Array, list[Issue]]:
        """Tilt-back (m,) rad of full circles in the order of deposit, all run the same way, and what was found."""
        return self._settled(self._circles(tangent, np.full(len(tangent), rising)), radius, height, layer)

    def axes(self, tangent: Array, angle: Array, rising: bool) -> tuple[Array, Array]:
        """Build directions and tool axes (n, 3) on full circles from meridian tangents (n, 2) and tilt-backs (n,)."""
        rows = self._circles(tangent, np.full(len(tangent), rising))
        build = directions.tilted_back(rows.build, angle)
        return build, self._tool(build, rows.rising)

    def _settled(self, rows: Rows, radius: Array, height: Array, layer: NDArray[np.intp]) -> tuple[Array, list[Issue]]:
        capped = self._capped(rows)
        angle = capped.copy()
        if self.parameters.clearance == "nozzle":
            angle = self._cleared(rows, capped, Deposit(radius, height, self.nozzle, self.platform))
        angle = _worst_of_bead(rows.bead, angle)
        stuck = np.isnan(angle)
        angle = np.where(stuck, directions.from_vertical(rows.build), angle)
        return angle, self._issues(rows, angle, capped, stuck, layer)

    def _circles(self, tangent: Array, rising: NDArray[np.bool_]) -> Rows:
        wall, m = self.wall, len(tangent)
        span = np.pi if wall.full else min(wall.end - wall.start, np.pi)
        build = directions.local(tangent) if self.parameters.mode == "local" else directions.fixed(m)
        # seen from all its points, an arc reaches as far to one side as to the other
        return Rows(np.arange(m), build, rising, np.tile([-span, span], (m, 1)))

    def _rows(self, tangent: Array, azimuths: Sequence[Array], rising: Sequence[bool]) -> Rows:
        wall = self.wall
        sense = np.asarray(rising, dtype=bool)
        if self.parameters.mode != "layer" or wall.full:
            return self._circles(tangent, sense)
        bead = np.repeat(np.arange(len(tangent)), [len(azimuth) for azimuth in azimuths])
        at = np.concatenate(azimuths)
        build = np.vstack([
            directions.layer_mean(t, azimuth, wall.start, wall.end)
            for t, azimuth in zip(tangent, azimuths, strict=True)
        ])
        return Rows(bead, build, sense[bead], np.stack([wall.start - at, wall.end - at], axis=1))

    def _tool(self, build: Array, rising: NDArray[np.bool_]) -> Array:
        tool = np.empty_like(build)
        for sense in (True, False):
            rows = rising == sense
            tool[rows] = directions.held(build[rows], self.parameters.lead, self.parameters.tilt, sense)
        return tool

    def _capped(self, rows: Rows) -> Array:
        """Tilt-back (k,) that brings the tool within the cap; the whole way where even that is not enough."""
        cap = self.parameters.max_tilt
        if self.parameters.lead == 0.0 and self.parameters.tilt == 0.0:
            return np.maximum(directions.from_vertical(rows.build) - cap, 0.0)

        def good(some: NDArray[np.intp], angle: Array) -> NDArray[np.bool_]:
            tool = self._tool(directions.tilted_back(rows.build[some], angle), rows.rising[some])
            return np.asarray(directions.from_vertical(tool) <= cap + 1e-12)

        angle = directions.least_tilt_back(rows.build, np.zeros(len(rows.bead)), good)
        return np.where(np.isnan(angle), directions.from_vertical(rows.build), angle)

    def _cleared(self, rows: Rows, low: Array, deposit: Deposit) -> Array:
        def good(some: NDArray[np.intp], angle: Array) -> NDArray[np.bool_]:
            tool = self._tool(directions.tilted_back(rows.build[some], angle), rows.rising[some])
            return deposit.clear(rows.bead[some], tool, rows.reach[some])

        return directions.least_tilt_back(rows.build, low, good)

    def _issues(
        self, rows: Rows, angle: Array, capped: Array, stuck: NDArray[np.bool_], layer: NDArray[np.intp]
    ) -> list[Issue]:
        at = layer[rows.bead]
        cap = f"{np.degrees(self.parameters.max_tilt):.6g} deg"
        issues = []
        tool = self._tool(directions.tilted_back(rows.build, angle), rows.rising)
        over = directions.from_vertical(tool) > self.parameters.max_tilt + 1e-9
        if over.any():
            issues.append(Issue(
                ERROR, "MAX_TILT", f"lead and tilt alone lean the tool by more than max_tilt ({cap}); "
                "make them smaller or the cap larger", int(at[over][0]),
            ))
        elif (capped > 1e-9).any():
            first = int(at[np.argmax(capped > 1e-9)])
            text = f"from layer {first} on, max_tilt holds directions within {cap}"
            issues.append(Issue(NOTE, "MAX_TILT", text, first))
        back = angle - capped
        if stuck.any():
            hit = np.unique(at[stuck])
            issues.append(Issue(
                ERROR, "CLEARANCE",
                f"however far it is tilted back, the nozzle touches deposit or platform in {len(hit)} layer(s), from "
                f"layer {hit[0]} on; use a slimmer nozzle or another wall", int(hit[0]),
            ))
        elif (back > 1e-9).any():
            worst, first = int(at[np.argmax(back)]), int(at[np.argmax(back > 1e-9)])
            issues.append(Issue(
                NOTE, "TILT_BACK", f"from layer {first} on, directions are tilted back to keep the nozzle "
                f"clear, by up to {np.degrees(back.max()):.2f} deg in layer {worst}", worst,
            ))
        return issues


def _worst_of_bead(bead: NDArray[np.intp], angle: Array) -> Array:
    """The largest angle of each bead's rows, for every row; NaN where one row of the bead has none."""
    starts = np.flatnonzero(np.r_[True, np.diff(bead) > 0])
    worst: Array = np.maximum.reduceat(angle, starts)[np.cumsum(np.r_[False, np.diff(bead) > 0])]
    return worst
