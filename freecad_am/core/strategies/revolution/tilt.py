# SPDX-License-Identifier: LGPL-2.1-or-later
"""Build directions and tool axes of circles about the axis: mode, lead and tilt, cap, nozzle clearance.

A bead is tilted back as a whole, by the angle that its worst point needs. Only for partial turns with one direction per
layer does the required angle differ from point to point.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.scene import Scene
from ...geometry.curves.profile import RevolvedWall
from ...issues import ERROR, NOTE, Issue, Text, Word
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.cell import NozzleParameters
from ...parameters.strategy import RevolutionParameters
from ...slicing import revolution as directions
from ...types import Array, Index, Mask
from .clearance import (
    CHORD,
    CONVERGED,
    Clearance,
    Deposit,
    Platform,
    Tips,
    arc_points,
    nozzle_clearance,
)


@dataclass(frozen=True, eq=False)
class Cases:
    """Cases to check: bead (k,), build direction (k, 3), running sense (k,).

    chained: whether all cases are along one bead, with directions interpolated between cases.
    """

    bead: Index
    build: Array
    rising: Mask
    chained: bool = False

    def before(self, mask: Mask) -> Mask:
        """Return the cases of earlier beads.

        Parameters
        ----------
        mask : (k,) array of bool
            Marked cases, at least one.

        Returns
        -------
        (k,) array of bool
            True for cases of beads deposited before the bead of the first marked case.
        """
        earlier: Mask = self.bead < self.bead[mask.argmax()]
        return earlier

    def together(self, angle: Array) -> Array:
        """Return the common tilt-back of all cases of a bead.

        In a chain, each case takes the maximum of its angle and the adjacent angles, so that
        interpolated angles are never too small.

        Parameters
        ----------
        angle : (k,) array
            Tilt-back of each case, rad.

        Returns
        -------
        (k,) array
            Maximum angles, rad; NaN if a case has no solution.
        """
        if self.chained:
            larger: Array = np.maximum(
                angle, np.maximum(np.r_[angle[1:], 0.0], np.r_[0.0, angle[:-1]])
            )
            return larger
        is_first = np.diff(self.bead, prepend=-1) > 0
        worst: Array = np.maximum.reduceat(angle, np.flatnonzero(is_first))[np.cumsum(is_first) - 1]
        return worst


PLACES_PER_ARC = 12  # points of an arc at which the nozzle is checked before all points are checked
COARSE = 0.01  # rad; accuracy of directions while they still change much
SWEEPS = 40  # maximum number of sweeps over all beads
FREE_SWEEPS = 6  # number of sweeps after which no tilt-back may decrease
MAX_ROUNDS = 8  # maximum number of rounds that tilt directions back further for other beads or points between
STEP_RAD, SLIGHT = np.radians(10.0), np.radians(1.0)  # maximum tilt-back steps of these rounds


@dataclass(frozen=True)
class Tilting:
    """Inputs that determine the tool axes of a wall. bead_width: mm."""

    wall: RevolvedWall
    strategy: RevolutionParameters
    parameters: BuildDirectionParameters
    nozzle: NozzleParameters
    platform: Platform
    bead_width: float

    @property
    def size(self) -> tuple[float, float]:
        """Return the size of the beads.

        Returns
        -------
        width, height : float
            Width and height, mm.
        """
        return self.bead_width, self.strategy.layer_height

    @property
    def chord(self) -> float:
        """Chord error of beads in the clearance check, mm."""
        return max(CHORD, self.strategy.chord_error)

    def resolve(
        self,
        radius: Array,
        height: Array,
        tangent: Array,
        azimuths: Sequence[Array],
        rising: Sequence[bool],
        layer: Index,
    ) -> tuple[list[Array], list[Array], list[Issue]]:
        """Return build directions and tool axes of beads.

        Parameters
        ----------
        radius, height : (m,) array
            Radius and height of the beads in print order, mm.
        tangent : (m, 2) array
            Meridian tangents, radius and axis.
        azimuths : sequence of Array
            Azimuths (n,) of the points of each bead, rad.
        rising : sequence of bool
            Whether each bead runs with rising azimuth.
        layer : (m,) int array
            Layer of each bead, for issues.

        Returns
        -------
        build : list of (n, 3) or (1, 3) array
            Build directions of each bead along radius, azimuth and axis; one row if equal at all
            points.
        tool : list of (n, 3) or (1, 3) array
            Tool axes.
        issues : list of Issue
            Tilts, and contacts that no tilt avoids.
        """
        sense = np.asarray(rising, dtype=bool)
        if self.parameters.mode == "layer" and not self.wall.full:
            return self._resolved_arcs(
                radius, height, self._means(tangent, azimuths), azimuths, sense, layer
            )
        cases = self._circles(tangent, sense)
        # a tool in the plane of the axis has the same obstacles on both sides
        turn = 2.0 * np.pi if self.wall.full else self.wall.end - self.wall.start
        bead, azimuth = arc_points(
            radius, turn, self.chord, self.strategy.min_points, self._upright
        )
        tips = Tips(
            radius, height, np.zeros(len(radius)), cases.bead + 1, np.searchsorted(layer, layer)
        )
        starts = np.diff(bead, prepend=-1) > 0
        deposit = Deposit(
            radius[bead],
            height[bead],
            azimuth,
            cases.build[bead],
            bead,
            starts,
            bead.astype(float),
            self.size,
        )
        clearance = nozzle_clearance(
            self.nozzle, self._lean, self.platform, tips, deposit, self.chord
        )
        angle, issues = self._resolved(cases, clearance, layer)
        build = directions.tilt_back(cases.build, angle)
        bead_numbers = range(1, len(radius))
        return (
            np.split(build, bead_numbers),
            np.split(self._tool(build, cases.rising), bead_numbers),
            issues,
        )

    def _resolved_arcs(
        self,
        radius: Array,
        height: Array,
        build: Array,
        azimuths: Sequence[Array],
        rising: Mask,
        layer: Index,
    ) -> tuple[list[Array], list[Array], list[Issue]]:
        """Resolve beads whose directions (k, 3) differ from point to point.

        The nozzle is checked at PLACES_PER_ARC points of each bead, and then at every point.
        """
        counts = np.array([len(azimuth) for azimuth in azimuths])
        bead, azimuth = np.repeat(np.arange(len(counts)), counts), np.concatenate(azimuths)
        begin = np.cumsum(counts) - counts
        looks = [
            np.unique(np.linspace(0, count - 1, min(count, PLACES_PER_ARC)).astype(np.intp))
            for count in counts
        ]
        rows = np.concatenate([start + sample for start, sample in zip(begin, looks, strict=True)])
        number = (
            np.searchsorted(rows, np.arange(len(bead)), side="right") - 1
        )  # the last checked point before each point
        cases = Cases(bead[rows], build[rows], rising[bead[rows]])
        tips = Tips(
            radius[bead], height[bead], azimuth, bead + 1, np.searchsorted(layer, layer)[bead]
        )
        deposit = Deposit(
            radius[bead],
            height[bead],
            azimuth,
            build,
            bead,
            np.diff(bead, prepend=-1) > 0,
            number.astype(float),
            self.size,
        )
        clearance = nozzle_clearance(
            self.nozzle, self._lean, self.platform, tips.rows(rows), deposit, self.chord, tips
        )
        angle, issues = self._resolved(cases, clearance, layer)
        build = directions.tilt_back(build, angle[number])
        return (
            np.split(build, begin[1:]),
            np.split(self._tool(build, rising[bead]), begin[1:]),
            issues,
        )

    def tilt_back(
        self, tangent: Array, rising: bool, tips: Tips, deposit: Deposit, between: Tips
    ) -> tuple[Array, list[Issue]]:
        """Return the tilt-back of tips along one bead, never less than that of adjacent tips.

        Parameters
        ----------
        tangent : (c, 2) array
            Meridian tangents, radius and axis.
        rising : bool
            Whether the bead runs with rising azimuth.
        tips : Tips
            The c tip positions.
        deposit : Deposit
            The deposit.
        between : Tips
            All points of the bead.

        Returns
        -------
        angle : (c,) array
            Tilt-back, rad.
        issues : list of Issue
            Tilts, and contacts that no tilt avoids.
        """
        cases = dataclasses.replace(
            self._circles(tangent, np.full(len(tangent), rising)), chained=True
        )
        clearance = nozzle_clearance(
            self.nozzle, self._lean, self.platform, tips, deposit, self.chord, between
        )
        return self._resolved(cases, clearance, np.zeros(len(tangent), dtype=np.intp))

    def build(self, tangent: Array) -> Array:
        """Return the requested build directions on full circles.

        Parameters
        ----------
        tangent : (n, 2) array
            Meridian tangents, radius and axis.

        Returns
        -------
        (n, 3) array
            Directions along radius, azimuth and axis.
        """
        return (
            directions.local(tangent)
            if self.parameters.mode == "local"
            else directions.fixed(len(tangent))
        )

    def axes(self, tangent: Array, angle: Array, rising: bool) -> tuple[Array, Array]:
        """Return build directions and tool axes on full circles.

        Parameters
        ----------
        tangent : (n, 2) array
            Meridian tangents, radius and axis.
        angle : (n,) array
            Tilt-back, rad.
        rising : bool
            Whether the bead runs with rising azimuth.

        Returns
        -------
        build, tool : (n, 3) array
            Directions along radius, azimuth and axis.
        """
        build = directions.tilt_back(self.build(tangent), angle)
        return build, self._tool(build, np.full(len(tangent), rising))

    def _resolved(
        self, cases: Cases, clearance: Clearance, layer: Index
    ) -> tuple[Array, list[Issue]]:
        """Return the tilt-back of the cases, (k,) rad, and issues; layer: (m,) layers of the beads, for issues."""
        capped = self._capped(cases)
        if self.parameters.clearance == "nozzle":
            angle = self._cleared(cases, capped, clearance)
        else:
            angle = cases.together(capped)
        stuck = np.isnan(angle)
        angle = np.where(stuck, directions.from_vertical(cases.build), angle)
        return angle, self._issues(cases, angle, capped, stuck, layer)

    def _circles(self, tangent: Array, rising: Mask) -> Cases:
        return Cases(np.arange(len(tangent)), self.build(tangent), rising)

    def _means(self, tangent: Array, azimuths: Sequence[Array]) -> Array:
        return np.vstack(
            [
                directions.layer_mean(t, azimuth, self.wall.start, self.wall.end)
                for t, azimuth in zip(tangent, azimuths, strict=True)
            ]
        )

    @property
    def _lean(self) -> float:
        """Angle between tool axis and build direction, rad."""
        return float(np.arccos(np.cos(self.parameters.lead) * np.cos(self.parameters.tilt)))

    @property
    def _upright(self) -> bool:
        return self.parameters.lead == 0.0 and self.parameters.tilt == 0.0

    def _tool(self, build: Array, rising: Mask) -> Array:
        tool = np.empty_like(build)
        for sense in (True, False):
            rows = rising == sense
            tool[rows] = directions.lean_tool(
                build[rows], self.parameters.lead, self.parameters.tilt, sense
            )
        return tool

    def _capped(self, cases: Cases) -> Array:
        """Return the tilt-back (k,) that brings the tool within the cap; the full angle if even that is insufficient."""
        cap = self.parameters.max_tilt
        if self._upright:
            return np.maximum(directions.from_vertical(cases.build) - cap, 0.0)

        def good(rows: Index, angle: Array) -> Mask:
            tool = self._tool(directions.tilt_back(cases.build[rows], angle), cases.rising[rows])
            return np.asarray(directions.from_vertical(tool) <= cap + 1e-12)

        angle = directions.least_tilt_back(cases.build, np.zeros(len(cases.bead)), good)
        return np.where(np.isnan(angle), directions.from_vertical(cases.build), angle)

    def _cleared(self, cases: Cases, low: Array, clearance: Clearance) -> Array:
        """Return the tilt-back (k,), at least `low`, that clears the nozzle; NaN if none does.

        If it helps a bead without a solution, earlier obstructing beads are tilted back further.
        """
        max_angle = directions.from_vertical(cases.build)
        first_angles = angles = self._resolved_over(cases, low, clearance, low)
        for _ in range(MAX_ROUNDS):
            further = self._further(cases, angles, clearance)
            if not (further > np.maximum(low, np.where(np.isnan(angles), max_angle, angles))).any():
                break
            low = np.maximum(low, further)
            angles = self._resolved_over(cases, low, clearance, angles)
        return angles if not np.isnan(angles).any() else first_angles

    def _further(self, cases: Cases, angle: Array, clearance: Clearance) -> Array:
        """Return the minimum tilt-back of cases, (k,) rad, 0 if the present tilt-back suffices.

        It is raised for cases before a case without a solution, and for cases next to deposit points with contact.
        """
        max_angle = directions.from_vertical(cases.build)
        tips = clearance.tips
        deposit = clearance.deposit
        stuck = np.flatnonzero(np.isnan(angle))
        angle_ = np.where(np.isnan(angle), max_angle, angle)
        if len(stuck):
            distance = np.hypot(
                *(column[:, None] - column[stuck] for column in (tips.radius, tips.height))
            )
            # most for the nearest beads, so that directions change gradually from bead to bead
            share = np.where(
                np.arange(len(angle))[:, None] < stuck, 1.0 - distance / deposit.size[0], 0.0
            ).max(axis=1)
            return np.where(share > 0.0, np.minimum(angle_ + STEP_RAD * share, max_angle), 0.0)
        if clearance.between is None:
            return np.zeros(len(angle))
        build = directions.tilt_back(
            deposit.build, np.interp(deposit.case, np.arange(len(angle), dtype=float), angle)
        )
        tool = self._tool(build, np.full(len(build), cases.rising[0]))
        hit = deposit.case[~clearance.clear_between(clearance.standing(build), tool)]
        further = np.zeros(len(angle))
        for rows_ in (np.floor(hit).astype(np.intp), np.ceil(hit).astype(np.intp)):
            further[rows_] = np.minimum(angle_ + SLIGHT, max_angle)[rows_]
        return further

    def _resolved_over(self, cases: Cases, low: Array, clearance: Clearance, start: Array) -> Array:
        """Return the tilt-back (k,), at least `low`, that clears the nozzle over tilted beads; NaN if none does.

        The search begins at `start`. Beads extend along their directions, so the tilt of a bead depends on earlier beads
        and on its own far side. Every case is therefore solved again with the new tilts of other cases until none
        changes. To end oscillations, tilts may no longer decrease after FREE_SWEEPS sweeps.
        """
        max_angle, deposit = directions.from_vertical(cases.build), clearance.deposit
        number = np.arange(len(low), dtype=float)
        still = CONVERGED / clearance.nozzle.reach
        angle = np.maximum(low, np.where(np.isnan(start), max_angle, start))
        about, change = np.full((len(low), 2), np.nan), np.full(len(low), np.inf)
        free = np.zeros(len(low), dtype=bool)
        among: Scene | None = None
        for sweep in range(SWEEPS):
            back = np.interp(deposit.case, number, angle)
            among = clearance.standing(directions.tilt_back(deposit.build, back), among)

            def good(rows: Index, angle_: Array, among: Scene = among) -> Mask:
                tool = self._tool(
                    directions.tilt_back(cases.build[rows], angle_), cases.rising[rows]
                )
                return clearance.clear(among, rows, tool)

            within = float(np.clip(0.1 * change.max(), 0.1 * still, COARSE))
            needed_angle = directions.least_tilt_back(cases.build, low, good, within, about, free)
            needed = cases.together(needed_angle)
            stuck = np.isnan(needed)
            now = np.where(stuck, max_angle, needed)
            if sweep >= FREE_SWEEPS:
                now = np.maximum(now, angle)
            change = np.abs(now - angle)
            if change.max() <= still:
                break
            angle = now
            # cases without tilt before every changed case keep no tilt
            free = (needed_angle == low) & cases.before(change > 0.0)
            about = needed_angle[:, None] + np.outer(2.0 * change + within, [-1.0, 1.0])
        return np.where(stuck, np.nan, now)

    def _issues(
        self, cases: Cases, angle: Array, capped: Array, stuck: Mask, layer: Index
    ) -> list[Issue]:
        case_layer = layer[cases.bead]
        cap = Text("{:.6g} deg", np.degrees(self.parameters.max_tilt))
        issues = []
        tool = self._tool(directions.tilt_back(cases.build, angle), cases.rising)
        over = directions.from_vertical(tool) > self.parameters.max_tilt + 1e-9
        if over.any():
            issues.append(
                Issue(
                    ERROR,
                    "MAX_TILT",
                    Text(
                        "lead and tilt together exceed max_tilt ({}); reduce lead and tilt, or "
                        "raise the limit",
                        Word(cap),
                    ),
                    int(case_layer[over][0]),
                )
            )
        elif (capped > 1e-9).any():
            first_layer = int(case_layer[np.argmax(capped > 1e-9)])
            text = Text(
                "from layer {} on, max_tilt limits directions to {}", first_layer, Word(cap)
            )
            issues.append(Issue(NOTE, "MAX_TILT", text, first_layer))
        back = angle - capped
        if stuck.any():
            hit = np.unique(case_layer[stuck])
            bead = (
                0
                if cases.chained
                else int(cases.bead[np.argmax(stuck)] - np.searchsorted(layer, hit[0]))
            )
            issues.append(
                Issue(
                    ERROR,
                    "CLEARANCE",
                    Text(
                        "at every possible tilt, the nozzle touches platform or deposit, beads "
                        "of {:g} mm, in {} layer(s), from layer {} on; use a slimmer nozzle, "
                        "another wall, or a smaller process.bead_width if the beads are narrower",
                        self.bead_width,
                        len(hit),
                        hit[0],
                    ),
                    int(hit[0]),
                    bead,
                )
            )
        elif (back > 1e-9).any():
            worst = int(case_layer[np.argmax(back)])
            first_layer = int(case_layer[np.argmax(back > 1e-9)])
            issues.append(
                Issue(
                    NOTE,
                    "TILT_BACK",
                    Text(
                        "from layer {} on, directions are tilted back for clearance, by up to "
                        "{:.2f} deg in layer {}",
                        first_layer,
                        np.degrees(back.max()),
                        worst,
                    ),
                    worst,
                )
            )
        return issues
