# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tilts of the tool axis along beads that keep the nozzle clear at every point, and are small and even along the bead.

Each point has candidate axes on cones about the original axis, in growing angle until every point has a clear one, or a few of
the points without have none on any cone. Among the sequences of clear candidates the search takes the one with the least
integral of tilt^2 + (SPREAD d tilt / ds)^2 along the bead. Finer candidates about it follow, level by level.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ...geometry import frames
from ...geometry.obstacles import Body
from ...geometry.tie_breaking import index_of_minimum, is_tied
from ...issues import Text
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.cell import NozzleParameters
from ...toolpath import Toolpath
from ...types import Array, Index, Mask
from ..progress import Watch
from .nozzle_check import CAP, Space, space_of

BARRED = 1e9  # cost of a state that is not allowed; finite, so that a chain without a way through has a least bad one
AT_ONCE = 1_000_000  # pairs of states worked on at once


def least_cost_states(states: Array, allowed: Mask, weight: Array, change: Array) -> Index:
    """The number (b, n) of the state of each point of b chains for which the sum of two costs is least.

    Parameters
    ----------
    states
        (b, n, s, d), or (1, 1, s, d) if every point has the same.
    allowed
        (b, n, s).
    weight
        (b, n), of the square of a state.
    change
        (b, n - 1), of the square of the difference of neighbouring states; 0 behind the end of a shorter chain.
    """
    b, n, s = allowed.shape
    step = max(1, AT_ONCE // (s * s))
    if b > step:
        chunks = (slice(k, k + step) for k in range(0, b, step))
        return np.concatenate(
            [
                least_cost_states(
                    states if len(states) == 1 else states[chunk],
                    allowed[chunk],
                    weight[chunk],
                    change[chunk],
                )
                for chunk in chunks
            ]
        )
    same = states.shape[1] == 1
    size = np.broadcast_to((states**2).sum(axis=3), (b, n, s))
    state_cost = np.where(allowed, weight[:, :, None] * size, BARRED)
    fixed = _between(states[:, 0], states[:, 0]) if same else None
    total, came = state_cost[:, 0], np.zeros((b, n, s), dtype=np.int32)
    for k in range(1, n):
        between = fixed if fixed is not None else _between(states[:, k - 1], states[:, k])
        costs = total[:, :, None] + change[:, k - 1, None, None] * between
        best = costs.min(axis=1)
        came[:, k] = is_tied(costs, best[:, None]).argmax(
            axis=1
        )  # what first_least finds, of numbers that are all finite
        total = best + state_cost[:, k]
    states_ = np.zeros((b, n), dtype=np.intp)
    states_[:, -1] = index_of_minimum(total, axis=1)
    for k in range(n - 1, 0, -1):
        states_[:, k - 1] = came[np.arange(b), k, states_[:, k]]
    return states_


def _between(a: Array, b: Array) -> Array:
    """Squares (b, s, t) of the differences of states (b, s, d) and (b, t, d), component by component, which is quicker."""
    total: Array = np.square(a[:, :, None, 0] - b[:, None, :, 0])
    for component in range(1, a.shape[2]):
        total += np.square(a[:, :, None, component] - b[:, None, :, component])
    return total


RING, AZIMUTHS = np.radians(5.0), 16  # angle between cones of candidates, and candidates per cone
MAX_TILT_RAD = np.radians(90.0)  # largest tilt tried
# before cone PROBED all larger cones are tried at PROBES points of a bead
PROBED, PROBES = 7, 16
LEVELS = 4  # refinements of the candidates, each at half the distance
COARSE = 0.6  # share of the progress before the refinements
SPREAD = 5.0  # mm along the bead over which a tilt comes and goes
RELEASED = 4.0  # times SPREAD, beyond which nothing is left of a tilt


class TiltSearch:
    """The blocked beads side by side: their points one after the other (m,), and padded to chains (b, n).

    A tilt is a turn from the original axis, given by two components (rad) along directions that are carried along the bead
    without twist; one of the two is 0 where the tool must stay in a plane.
    """

    def __init__(
        self,
        space: Space,
        rows: list[Index],
        closed: Mask,
        tool: Array,
        plane: Array | None,
        free: Mask,
        spread: float,
    ) -> None:
        self.space, self.closed, self.plane, self.spread = space, closed, plane, spread
        self.flat = np.concatenate(rows)
        self.asked = tool
        self.counts = np.array([len(row) for row in rows])
        self.begin = np.r_[0, np.cumsum(self.counts)][:-1]
        self.lost = np.zeros(len(rows), dtype=bool)  # beads that no tilt clears
        self.sides = np.concatenate([_sides(tool[row], plane) for row in rows])
        points = space.points[self.flat]
        self.step = np.r_[np.linalg.norm(np.diff(points, axis=0), axis=1), 0.0]
        self.step[self.begin + self.counts - 1] = 0.0
        self.near = np.concatenate(
            [
                _near(points[b : b + n], ~free[row], loop, RELEASED * spread)
                for b, n, row, loop in zip(self.begin, self.counts, rows, closed, strict=True)
            ]
        )

    def axes(self, points: Index, offset: Array) -> Array:
        """Return the tool axes for tilts at points.

        Parameters
        ----------
        points : (k,) int array
            Numbers of points of the blocked beads.
        offset : (k, 2) array
            Tilts, rad.

        Returns
        -------
        (k, 3) array
            Unit vectors.
        """
        return self._tilted(np.searchsorted(self.flat, points), offset)

    def _tilted(self, row: Index, offset: Array) -> Array:
        angle = np.linalg.norm(offset, axis=1)
        towards = offset / np.where(angle > 0.0, angle, 1.0)[:, None]
        lean = np.einsum("ki,kij->kj", towards, self.sides[row])
        axis = np.cos(angle)[:, None] * self.asked[self.flat[row]] + np.sin(angle)[:, None] * lean
        unit: Array = axis / np.linalg.norm(axis, axis=1, keepdims=True)
        return np.where((angle > 0.0)[:, None], unit, self.asked[self.flat[row]])

    def _clear(self, row: Index, offsets: Array) -> Mask:
        """(k, s) whether the tilts (s, 2) or (k, s, 2) are clear at the places (k,)."""
        offsets = np.broadcast_to(offsets, (len(row), *offsets.shape[-2:]))
        s = offsets.shape[1]
        spread = np.repeat(row, s)
        return self.space.clear(
            self.flat[spread], self._tilted(spread, offsets.reshape(-1, 2))
        ).reshape(-1, s)

    def search(self, watch: Watch) -> tuple[Array, Mask]:
        """Search small and even tilts that keep the nozzle clear.

        Parameters
        ----------
        watch : Watch
            Progress of the search.

        Returns
        -------
        offset : (m, 2) array
            Tilts of all points, rad.
        stuck : (m,) bool array
            Points without a clear tilt.
        """
        offset, stuck = self.coarse(watch.section(0.0, COARSE))
        for level in range(1, LEVELS + 1):
            watch.share(COARSE + (1.0 - COARSE) * (level - 1) / LEVELS)
            offset = self.finer(offset, RING / 2.0**level, level)
        return offset, stuck

    def coarse(self, watch: Watch) -> tuple[Array, Mask]:
        """Search tilts on cones about the requested axes.

        Parameters
        ----------
        watch : Watch
            Progress of the search.

        Returns
        -------
        offset : (m, 2) array
            Tilts, rad.
        stuck : (m,) bool array
            Points without a clear tilt; they do not hinder the others.
        """
        states = np.zeros((1, 2))
        allowed = self._clear(np.arange(len(self.flat)), states) | ~self.near[:, None]
        bead = np.repeat(np.arange(len(self.counts)), self.counts)
        pending = np.ones(len(self.counts), dtype=bool)
        last_ring = round(MAX_TILT_RAD / RING)
        for number in range(1, last_ring + 1):
            watch.share(number / (last_ring + 1))
            if number == PROBED:
                # where nothing frees some of a bead's points there is no way, however many candidates the others have
                self.lost[self._hopeless(allowed, pending, range(number, last_ring + 1))] = True
                pending &= ~self.lost
                if not pending.any():
                    break
            ring = self._ring(number)
            states = np.concatenate([states, ring])
            ring_clear = np.zeros((len(self.flat), len(ring)), dtype=bool)
            rows = np.flatnonzero(pending[bead] & self.near)
            ring_clear[rows] = self._clear(rows, ring)
            # one ring more than the first that frees every point, so that there is a way round
            had = np.logical_and.reduceat(self._both_ends(allowed).any(axis=1), self.begin)
            allowed = np.hstack([allowed, ring_clear])
            pending &= ~had
            if not pending.any():
                break
        allowed = self._both_ends(allowed)
        stuck = np.logical_not(allowed.any(axis=1))
        self.lost |= np.logical_or.reduceat(stuck, self.begin)
        allowed[stuck] = True
        # a closed bead starts where least tilt is needed, and with it
        size = np.where(allowed, np.linalg.norm(states, axis=1), np.inf)
        anchor = self._anchors(np.where(stuck, np.inf, size.min(axis=1)))
        return states[self._least(states[None], allowed, anchor, index_of_minimum(size))], stuck

    def _hopeless(self, allowed: Mask, pending: Mask, numbers: range) -> Index:
        """The pending beads with a sampled point that is not free on any cone, from points (m, s) and further cones."""
        barred = ~self._both_ends(allowed).any(axis=1) & self.near
        samples = [np.zeros(0, dtype=np.intp)]
        for bead in np.flatnonzero(pending):
            rows = self.begin[bead] + np.flatnonzero(
                barred[self.begin[bead] : self.begin[bead] + self.counts[bead]]
            )
            samples.append(
                rows[np.unique(np.linspace(0, len(rows) - 1, PROBES).astype(int))]
                if len(rows)
                else rows
            )
        rows_ = np.concatenate(samples)
        free = self._clear(rows_, np.concatenate([self._ring(number) for number in numbers])).any(
            axis=1
        )
        beads: Index = np.unique(np.searchsorted(self.begin, rows_[~free], side="right") - 1)
        return beads

    def finer(self, offset: Array, step: float, turn: int) -> Array:
        """Improve tilts on a finer grid near them.

        Parameters
        ----------
        offset : (m, 2) array
            The tilts, rad.
        step : float
            Step of the grid, rad; at most two steps away in each component.
        turn : int
            Number of the refinement; each time another point of a closed bead stays
            unchanged.

        Returns
        -------
        (m, 2) array
            Better tilts, rad.
        """
        around = step * np.arange(-2.0, 3.0)
        grid = np.stack(
            np.meshgrid(around, around if self.plane is None else [0.0], indexing="ij"), axis=-1
        ).reshape(-1, 2)
        offsets = offset[:, None] + grid
        centre_state = len(grid) // 2
        offsets[:, centre_state] = offset
        allowed = np.zeros(offsets.shape[:2], dtype=bool)
        rows = np.flatnonzero(self.near & ~np.repeat(self.lost, self.counts))
        allowed[rows] = self._clear(rows, offsets[rows])
        allowed = self._both_ends(allowed)
        allowed[:, centre_state] = True
        # each time another point of a closed bead stays as it is
        anchor = (self.counts - 1) * (turn % 3) // 3
        states_ = self._least(offsets, allowed, anchor, np.full(len(offset), centre_state))
        better: Array = offsets[np.arange(len(offset)), states_]
        return better

    def _ring(self, number: int) -> Array:
        azimuth = (
            2.0 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS
            if self.plane is None
            else np.array([0.0, np.pi])
        )
        ring: Array = number * RING * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=1)
        if self.plane is not None:
            ring[:, 1] = 0.0
        return ring

    def _both_ends(self, allowed: Mask) -> Mask:
        """The states allowed at both ends of a closed bead, which are one point."""
        allowed = allowed.copy()
        start = self.begin[self.closed]
        end = start + self.counts[self.closed] - 1
        allowed[start] &= allowed[end]
        allowed[end] = allowed[start]
        return allowed

    def _anchors(self, size: Array) -> Index:
        """For each bead the point that needs least tilt; of several, the one farthest from points that need more."""
        anchors = []
        for start, count in zip(self.begin, self.counts, strict=True):
            need = size[start : start + count - 1]
            least_of_all = np.flatnonzero(need <= need.min() + CAP)
            larger = np.flatnonzero(need > need.min() + CAP)
            distance = nearest(larger.astype(float), least_of_all.astype(float), float(count - 1))
            anchors.append(int(least_of_all[np.argmax(distance)]))
        return np.array(anchors)

    def _least(self, states: Array, allowed: Mask, anchor: Index, fixed: Index) -> Index:
        """(m,) the states of least cost; a closed bead is run from the anchor all around, its state there `fixed`."""
        states_ = np.zeros(len(self.flat), dtype=np.intp)
        # chains of similar lengths together, because padding to the longest takes memory
        length = np.ceil(np.log2(self.counts)).astype(int)
        for beads in (np.flatnonzero(length == size) for size in np.unique(length)):
            self._least_of(beads, states, allowed, anchor, fixed, states_)
        return states_

    def _least_of(
        self,
        beads: Index,
        states: Array,
        allowed: Mask,
        anchor: Index,
        fixed: Index,
        states_: Index,
    ) -> None:
        """Put the states of least cost of some beads where they belong among those chosen (m,)."""
        n, s = int(self.counts[beads].max()), allowed.shape[1]
        position = np.zeros(
            (len(beads), n), dtype=np.intp
        )  # of the chains' points in the list, the pads at any
        weight, change = np.zeros(position.shape), np.zeros((len(position), n - 1))
        free = np.ones((*position.shape, s), dtype=bool)
        for k, bead in enumerate(beads):
            start, count = self.begin[bead], self.counts[bead]
            around = np.arange(count)
            if self.closed[bead]:
                around = np.r_[
                    np.arange(anchor[bead], count - 1), np.arange(anchor[bead]), anchor[bead]
                ]
            position[k, :count] = start + around
            step = self.step[position[k, : count - 1]]
            weight[k, :count] = 0.5 * (np.r_[0.0, step] + np.r_[step, 0.0])
            change[k, : count - 1] = self.spread**2 / np.maximum(step, 1e-6)
            free[k, :count] = allowed[position[k, :count]]
            if self.closed[bead]:
                ends = np.arange(s) == fixed[start + anchor[bead]]
                free[k, 0], free[k, count - 1] = ends, ends
        best = least_cost_states(
            states[None] if states.shape[0] == 1 else states[position], free, weight, change
        )
        for k, bead in enumerate(beads):
            count = self.counts[bead]
            states_[position[k, :count]] = best[k, :count]
            if self.closed[bead]:
                states_[self.begin[bead] + count - 1] = states_[self.begin[bead]]


def _near(points: Array, blocked: Mask, closed: bool, reach: float) -> Mask:
    """Which points of a bead are within `reach` mm, along it, of the blocked ones."""
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    is_near: Mask = nearest(length[blocked], length, float(length[-1]) if closed else None) <= reach
    return is_near


def nearest(marks: Array, positions: Array, length: float | None) -> Array:
    """Return the distances of positions on a line from the nearest mark.

    Parameters
    ----------
    marks : (k,) array
        Rising positions of the marks, mm.
    positions : (n,) array
        The positions, mm.
    length : float or None
        Length of a closed line, mm; None for an open one.

    Returns
    -------
    (n,) array
        Distances, mm; infinite without marks.
    """
    if not len(marks):
        return np.full(len(positions), np.inf)
    right = np.searchsorted(marks, positions)
    distance: Array = np.minimum(
        np.abs(positions - marks[np.maximum(right - 1, 0)]),
        np.abs(marks[np.minimum(right, len(marks) - 1)] - positions),
    )
    if length is None:
        return distance
    # the other way round the one that is farthest this way is nearest
    around: Array = np.minimum(
        distance, length - np.maximum(np.abs(positions - marks[0]), np.abs(positions - marks[-1]))
    )
    return around


def _sides(tool: Array, plane: Array | None) -> Array:
    """(n, 2, 3) unit vectors normal to the asked axes and to each other, carried along a bead; the first in the plane."""
    if plane is not None:
        side = np.cross(plane, tool)
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        return np.stack([side, np.broadcast_to(plane, side.shape)], axis=1)
    middle = tool.mean(axis=0)
    size = np.linalg.norm(middle)
    middle = middle / size if size > 1e-6 else tool[0]
    level = frames.smallest_rotation(middle, np.array([0.0, 0.0, 1.0]))[:2]
    sides: Array = np.einsum("nij,kj->nki", frames.smallest_rotation(middle, tool), level)
    return sides


LOOKED_AT = 240  # points, at most
BATCH_POINTS = 24  # points in a batch; if one has no room, later batches are skipped
SHARES = (0.75, 0.5, 0.25)  # half angles of the nozzle that are tried
FARTHER = np.radians(15.0)  # by which the largest tilt is raised
MAX_TRIALS = 4  # changes with which every bead is tilted again, at most
MAX_TRIAL_POINTS = 20_000  # points of a toolpath that is


class Change(NamedTuple):
    """Bodies, nozzle and build directions in place of others, and the words for it."""

    bodies: Sequence[Body]
    nozzle: NozzleParameters
    build: BuildDirectionParameters
    words: Text


class Touching(NamedTuple):
    """A toolpath with the axes asked for, and the points (k,) that no tilt clears. plane, feature: as of
    `clear_by_tilt.keep_clear`."""

    toolpath: Toolpath
    rows: Index
    plane: Array | None
    feature: int | None

    def clear_at(self, change: Change) -> bool:
        """Whether each of the points has a clear tilt, by up to LARGEST, after a change; of many points, a regular sample is checked."""
        space = space_of(
            self.toolpath,
            change.bodies,
            change.nozzle,
            change.build.max_tilt,
            False,
            self.feature or 0,
        )
        sample = self.rows[
            np.unique(
                np.linspace(0, len(self.rows) - 1, min(LOOKED_AT, len(self.rows))).astype(np.intp)
            )
        ]
        tool = np.concatenate([bead.tool for _, _, bead in self.toolpath])
        return all(
            self._clear_at(space, tool, sample[start : start + BATCH_POINTS])
            for start in range(0, len(sample), BATCH_POINTS)
        )

    def _clear_at(self, space: Space, tool: Array, rows: Index) -> bool:
        for number in range(round(MAX_TILT_RAD / RING) + 1):
            axes = self._cone(tool[rows], number * RING)
            free = (
                space.clear(np.repeat(rows, axes.shape[1]), axes.reshape(-1, 3))
                .reshape(len(rows), -1)
                .any(axis=1)
            )
            rows = rows[~free]
            if not len(rows):
                return True
        return False

    def _cone(self, tool: Array, angle: float) -> Array:
        """Axes (k, s, 3) at an angle, rad, from those asked for (k, 3)."""
        if self.plane is not None:
            sides = np.cross(self.plane, tool)[:, None] * np.array([1.0, -1.0])[:, None]
        else:
            turn = 2.0 * np.pi * np.arange(AZIMUTHS) / AZIMUTHS
            level = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(AZIMUTHS)])
            sides = np.einsum(
                "sj,kij->ksi", level, frames.smallest_rotation(np.array([0.0, 0.0, 1.0]), tool)
            )
        axes: Array = np.cos(angle) * tool[:, None] + np.sin(angle) * sides
        return axes


def what_helps(touching: Touching, now: Change, clears: Callable[[Change], bool]) -> Text:
    """Return the remedy for contacts as the end of a message.

    Parameters
    ----------
    touching : Touching
        The toolpath and the points that no tilt clears.
    now : Change
        The current bodies, nozzle and build directions.
    clears : callable
        Tilts every bead again after a change and returns whether the nozzle is clear.

    Returns
    -------
    Text
        The first change with which the nozzle is clear, or a text that none is known.
    """
    trials: list[Text] = []
    trials_left = MAX_TRIALS
    for changes in (_tilts(now), _half_angles(now), _cleared_away(now)):
        for change in _useful_changes(touching, changes):
            if touching.toolpath.point_count > MAX_TRIAL_POINTS:
                return Text(
                    "the nozzle would be clear at these points with {}; the other points were not tested",
                    change.words,
                )
            trials_left -= 1
            if trials_left >= 0 and clears(change):
                return Text("with {} the nozzle is clear (tested)", change.words)
        trials += [change.words for change in changes[-1:] if trials_left >= 0]
    fallback = Text("use other layers or another direction, or exclude the region of these points")
    return (
        Text(
            "the nozzle still touches with {} (all tested); {}",
            Text.joined(", ", trials),
            fallback,
        )
        if trials
        else fallback
    )


def _useful_changes(touching: Touching, changes: list[Change]) -> list[Change]:
    """The smallest change that gives every point room, and the largest; empty if the largest does not."""
    if not changes or not touching.clear_at(changes[-1]):
        return []
    smallest = next((change for change in changes[:-1] if touching.clear_at(change)), changes[-1])
    return [smallest] if smallest is changes[-1] else [smallest, changes[-1]]


def _tilts(now: Change) -> list[Change]:
    """Larger tilts, the largest last."""
    max_tilt = now.build.max_tilt
    angles = [
        min(np.pi, max_tilt + FARTHER * (k + 1))
        for k in range(int(np.ceil((np.pi - max_tilt) / FARTHER - CAP)))
    ]
    return [
        now._replace(
            build=dataclasses.replace(now.build, max_tilt=angle),
            words=Text("`build_direction.max_tilt: {:.3g} deg`", np.degrees(angle)),
        )
        for angle in angles
    ]


def _cleared_away(now: Change) -> list[Change]:
    """Nothing but the deposit itself in the way."""
    names = Text.joined(", ", (body.name for body in now.bodies))
    return [now._replace(bodies=(), words=Text("{} out of the way", names))] if now.bodies else []


def _half_angles(now: Change) -> list[Change]:
    """Slimmer nozzles, half angles in whole degrees, the slimmest last."""
    half = float(np.degrees(now.nozzle.half_angle))
    angles = sorted({round(share * half) for share in SHARES} - {0}, reverse=True)
    return [
        now._replace(
            nozzle=dataclasses.replace(now.nozzle, half_angle=float(np.radians(angle))),
            words=Text("`cell.nozzle.half_angle: {:d} deg`", angle),
        )
        for angle in angles
        if angle < half
    ]
