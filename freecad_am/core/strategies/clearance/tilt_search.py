# SPDX-License-Identifier: LGPL-2.1-or-later
"""Search for tool axis tilts that keep the nozzle clear at every point of a bead and are small and even along the bead.

Each point has candidate axes on cones about the original axis. The cone angle grows until every point has a clear
candidate, or until sampled points have none on any cone. Of all sequences of clear candidates, the search selects the
sequence with the minimum integral of tilt^2 + (SPREAD d tilt / ds)^2 along the bead. It then refines the candidates about
this sequence, level by level.

Testing a candidate takes long. Untested candidates count as clear while a sequence is selected. The candidates of the
sequence are then tested, and the search continues without the candidates that touch. The first sequence of only clear
candidates is optimal, as if every candidate had been tested.
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

BARRED = 1e9  # cost of a barred state; finite, so that a chain without a feasible path has a least bad path
AT_ONCE = 1_000_000  # pairs of states processed at once
MAX_JOINT_STATES = 64  # maximum states per point for joint processing of chains with barred states


def least_cost_states(states: Array, allowed: Mask, weight: Array, change: Array) -> Index:
    """Return the state index (b, n) of each point of b chains that minimises the sum of two costs.

    Parameters
    ----------
    states
        (b, n, s, d), or (1, 1, s, d) if all points have the same states.
    allowed
        (b, n, s).
    weight
        (b, n), weight of the square of a state.
    change
        (b, n - 1), weight of the squared difference of adjacent states; 0 past the end of a shorter chain.
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
    states = np.broadcast_to(states, (b, n, s, states.shape[3]))
    state_cost = np.where(allowed, weight[:, :, None] * (states**2).sum(axis=3), BARRED)
    totals = _totals(states, allowed, change, state_cost)
    states_ = np.zeros((b, n), dtype=np.intp)
    states_[:, -1] = index_of_minimum(totals[:, -1], axis=1)
    chain = np.arange(b)
    for k in range(n - 1, 0, -1):
        target = states[chain, k, states_[:, k]]
        costs = change[:, k - 1, None] * _between(states[:, k - 1], target[:, None])[:, :, 0]
        costs += totals[:, k - 1]
        # same result as index_of_minimum for finite numbers
        states_[:, k - 1] = is_tied(costs, costs.min(axis=1, keepdims=True)).argmax(axis=1)
    return states_


def useful_states(states: Array, allowed: Mask, known: Mask, weight: Array, change: Array) -> Mask:
    """Return the states of one chain that a minimum-cost path may contain.

    Any path through another state costs more than the best path through known states, even if
    more of the allowed states turn out to be barred.

    Parameters
    ----------
    states : (1, 1, s, d) or (1, n, s, d) array
        States as in `least_cost_states`.
    allowed : (1, n, s) bool array
        States that may be free.
    known : (1, n, s) bool array
        States known to be free.
    weight, change : (1, n) and (1, n - 1) array
        Costs as in `least_cost_states`.

    Returns
    -------
    (n, s) bool array
        True for the remaining states.
    """
    states = np.broadcast_to(states, (*allowed.shape, states.shape[3]))
    size = weight[:, :, None] * (states**2).sum(axis=3)
    own, known_own = (np.where(mask, size, BARRED) for mask in (allowed, known))
    before = _totals(states, allowed, change, own)
    after = _totals(states[:, ::-1], allowed[:, ::-1], change[:, ::-1], own[:, ::-1])[:, ::-1]
    most = _totals(states, known, change, known_own)[0, -1].min()
    useful: Mask = (before + after - own)[0] <= most + COST_TOLERANCE
    return useful


def _totals(states: Array, allowed: Mask, change: Array, own: Array) -> Array:
    """Return the minimum path cost from the start to each state, (b, n, s), with state costs `own` (b, n, s)."""
    totals = np.empty(own.shape)
    totals[:, 0] = own[:, 0]
    if len(own) == 1 and own.shape[2] > MAX_JOINT_STATES:
        _add_allowed(states[0], allowed[0], change[0], own[0], totals[0])
        return totals
    costs = np.empty((len(totals), totals.shape[2], totals.shape[2]))
    between = _between(states[:, 0], states[:, 0])
    for k in range(1, totals.shape[1]):
        if states.strides[1]:  # otherwise all points have the same states
            between = _between(states[:, k - 1], states[:, k])
        np.multiply(change[:, k - 1, None, None], between, out=costs)
        costs += totals[:, k - 1, :, None]
        np.add(costs.min(axis=1), own[:, k], out=totals[:, k])
    return totals


def _add_allowed(states: Array, allowed: Mask, change: Array, own: Array, totals: Array) -> None:
    """Fill in the costs (n, s) of the allowed states of a single chain, and BARRED for other states."""
    totals[1:] = BARRED
    between = _between(states[None, 0], states[None, 0])[0]
    barred = ~allowed.any(axis=1)
    before = np.flatnonzero(allowed[0] | barred[0])
    for k in range(1, len(totals)):
        now = np.flatnonzero(allowed[k] | barred[k])
        if states.strides[0]:
            costs = _between(states[None, k - 1, before], states[None, k, now])[0]
        else:
            costs = between[before[:, None], now]
        costs *= change[k - 1]
        costs += totals[k - 1, before, None]
        totals[k, now] = costs.min(axis=0) + own[k, now]
        before = now


def _between(a: Array, b: Array) -> Array:
    """Return the squared differences (b, s, t) of states (b, s, d) and (b, t, d); faster by component."""
    total: Array = np.square(a[:, :, None, 0] - b[:, None, :, 0])
    for component in range(1, a.shape[2]):
        total += np.square(a[:, :, None, component] - b[:, None, :, component])
    return total


RING, AZIMUTHS = np.radians(5.0), 16  # angle between candidate cones; candidates per cone
MAX_TILT_RAD = np.radians(90.0)  # maximum tilt
# before cone number PROBED, all larger cones are tried at PROBES points of a bead
PROBED, PROBES = 7, 16
CORRIDOR = 24  # number of candidates near a path that are searched first
COST_TOLERANCE = 1e-5  # tolerance of costs; much larger than ties
NEIGHBOUR_COUNT = 9  # number of candidates tested together about a candidate of the best path
LEVELS = 4  # number of refinements, each at half the distance
REPAIRED = 1  # first refinement of axes that touch between knots
COARSE = 0.6  # fraction of the progress before the refinements
SPREAD = 5.0  # mm; distance along the bead over which a tilt builds up and decays


class TiltSearch:
    """Tilt search at some points, `rows`, of several blocked beads: concatenated (m,), and padded to chains (b, n).

    Tilts change within `reach` mm along the bead of points that are not free.

    A tilt is a rotation from the original axis. Its two components, rad, are along directions that are carried along the
    bead without twist. One component is 0 if the tool must stay in a plane.
    """

    def __init__(
        self,
        space: Space,
        beads: list[Index],
        rows: list[Index],
        closed: Mask,
        tool: Array,
        plane: Array | None,
        free: Mask,
        spread: float,
        reach: float,
    ) -> None:
        self.space, self.closed, self.plane, self.spread = space, closed, plane, spread
        self.flat = np.concatenate(rows)
        self.asked, self._free = tool, free[self.flat]
        self.counts = np.array([len(row) for row in rows])
        self.begin = np.r_[0, np.cumsum(self.counts)][:-1]
        self._bead = np.repeat(np.arange(len(self.counts)), self.counts)
        # index of the other end of a closed bead, which is the same point
        self._twin = np.arange(len(self.flat))
        start = self.begin[closed]
        end = start + self.counts[closed] - 1
        self._twin[start], self._twin[end] = end, start
        self.lost = np.zeros(len(rows), dtype=bool)  # beads that no tilt clears
        self.sides = np.concatenate(
            [
                _sides(tool[bead], plane)[np.searchsorted(bead, row)]
                for bead, row in zip(beads, rows, strict=True)
            ]
        )
        points = space.points[self.flat]
        self.step = np.r_[np.linalg.norm(np.diff(points, axis=0), axis=1), 0.0]
        self.step[self.begin + self.counts - 1] = 0.0
        self.near = np.concatenate(
            [
                near_marks(space.points[bead], ~free[bead], loop, reach)[np.searchsorted(bead, row)]
                for bead, row, loop in zip(beads, rows, closed, strict=True)
            ]
        )

    def axes(self, points: Index, offset: Array) -> Array:
        """Return the tool axes for tilts at points.

        Parameters
        ----------
        points : (k,) int array
            Indices of points of the blocked beads.
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
        """Return whether the tilts (s, 2) or (k, s, 2) are clear at the points (k,), (k, s)."""
        offsets = np.broadcast_to(offsets, (len(row), *offsets.shape[-2:]))
        s = offsets.shape[1]
        # adjacent points of a bead with the same tilt are consecutive
        places, offsets = np.tile(row, s), offsets.transpose(1, 0, 2).reshape(-1, 2)
        clear = self.space.clear(self.flat[places], self._tilted(places, offsets))
        return clear.reshape(s, len(row)).T

    def search(self, watch: Watch) -> tuple[Array, Mask]:
        """Search for small and even tilts that keep the nozzle clear.

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
            offset, _ = self.finer(offset, RING / 2.0**level, level)
        return offset, stuck

    def repair(self, axes: Array, watch: Watch) -> tuple[Array, Mask]:
        """Search near given axes, which touch at the points that are not free.

        Parameters
        ----------
        axes : (m, 3) array
            Axes at all points, unit vectors.
        watch : Watch
            Progress of the search.

        Returns
        -------
        offset : (m, 2) array
            Tilts of all points, rad.
        stuck : (m,) bool array
            Points without a clear tilt near the given axis.
        """
        offset, stuck = self._offsets(axes), ~self._free
        for level in range(REPAIRED, LEVELS + 1):
            watch.share((level - REPAIRED) / (LEVELS + 1 - REPAIRED))
            offset, stuck = self.finer(offset, RING / 2.0**level, level, ~stuck)
        return offset, stuck

    def _offsets(self, axes: Array) -> Array:
        """Return the tilts (m, 2) of axes (m, 3)."""
        asked = self.asked[self.flat]
        lean = np.einsum("kij,kj->ki", self.sides, axes)
        size = np.linalg.norm(lean, axis=1)
        angle = np.arctan2(size, np.einsum("kj,kj->k", asked, axes))
        offset: Array = lean * (angle / np.where(size > 0.0, size, 1.0))[:, None]
        if self.plane is not None:
            offset[:, 1] = 0.0
        return offset

    def coarse(self, watch: Watch) -> tuple[Array, Mask]:
        """Search for tilts on cones about the requested axes.

        Parameters
        ----------
        watch : Watch
            Progress of the search.

        Returns
        -------
        offset : (m, 2) array
            Tilts, rad.
        stuck : (m,) bool array
            Points without a clear tilt; they do not affect other points.
        """
        m, bead = len(self.flat), self._bead
        states = [np.zeros((1, 2))]
        open_ = [self._clear(np.arange(m), states[0]) | ~self.near[:, None]]
        tested = [np.ones((m, 1), dtype=bool)]
        # closed beads have a path only if both ends are free
        has_way = self._both_ends(open_[0])[:, 0]
        pending = np.ones(len(self.counts), dtype=bool)
        last_ring = round(MAX_TILT_RAD / RING)
        for number in range(1, last_ring + 1):
            watch.share(number / (last_ring + 1))
            if number == PROBED:
                # a bead with points that no tilt clears has no path, regardless of its other points
                self.lost[
                    self._hopeless(~has_way & self.near, pending, range(number, last_ring + 1))
                ] = True
                pending &= ~self.lost
                if not pending.any():
                    break
            ring = self._ring(number)
            # points with a clear candidate are tested later, if a path contains these candidates
            wanted = pending[bead] & self.near
            rows = np.flatnonzero(wanted & ~has_way)
            ring_open = np.repeat(wanted[:, None], len(ring), axis=1)
            ring_open[rows] = self._clear(rows, ring)
            ring_tested = ~ring_open
            ring_tested[rows] = True
            # one more ring after every point is free, to allow a detour
            had = np.logical_and.reduceat(has_way, self.begin)
            has_way |= (self._both_ends(ring_open) & ring_tested).any(axis=1)
            states.append(ring)
            open_.append(ring_open)
            tested.append(ring_tested)
            pending &= ~had
            if not pending.any():
                break
        return self._through(np.concatenate(states), np.hstack(open_), np.hstack(tested))

    def _through(self, states: Array, open_: Mask, tested: Mask) -> tuple[Array, Mask]:
        """Return tilts (m, 2) and stuck points (m,) by states (s, 2) that may be open (m, s)."""
        open_ = self._both_ends(open_)
        stuck = np.logical_not(open_.any(axis=1))
        self.lost |= np.logical_or.reduceat(stuck, self.begin)
        open_[stuck] = True
        tested[stuck] = True
        # a closed bead starts at the point of minimum tilt, with this tilt, as all smaller tilts are tested
        size = np.where(open_, np.linalg.norm(states, axis=1), np.inf)
        anchor = self._anchors(np.where(stuck, np.inf, size.min(axis=1)))
        fixed = index_of_minimum(size)
        if len(states) > MAX_JOINT_STATES:
            self._near_best(states, open_, tested, anchor, fixed)
            open_ = self._useful(states[None, None], open_, tested, anchor, fixed)
        # keep the few remaining states of each point in their order
        number = np.argsort(~open_, axis=1, kind="stable")[:, : open_.sum(axis=1).max()]
        return self._least_clear_of(number, states, open_, tested, anchor, fixed), stuck

    def _near_best(
        self, states: Array, open_: Mask, tested: Mask, anchor: Index, fixed: Index
    ) -> None:
        """Update open_ and tested near the paths that would be best if all open states were clear.

        The paths through clear states are then almost optimal, which leaves few useful states.
        """
        chosen = np.zeros(len(self.flat), dtype=np.intp)
        for bead in range(len(self.counts)):
            self._least(np.array([bead]), states[None], open_, anchor, fixed, chosen)
        apart = _between(states[None], states[None])[0][chosen]
        known = np.where(open_ & tested, apart, np.inf).argmin(axis=1)
        apart[~open_] = np.inf
        apart[np.arange(len(apart)), known] = -1.0  # so that a path exists
        number = np.argsort(apart, axis=1, kind="stable")[:, :CORRIDOR]
        self._least_clear_of(number, states, open_, tested, anchor, fixed)

    def _least_clear_of(
        self,
        number: Index,
        states: Array,
        open_: Mask,
        tested: Mask,
        anchor: Index,
        fixed: Index,
    ) -> Array:
        """Return `_least_clear` (m, 2) among the states (s, 2) with indices (m, w); update open_ and tested (m, s)."""
        some_open, some_tested = (
            np.take_along_axis(mask, number, axis=1) for mask in (open_, tested)
        )
        offsets = states[number]
        fixed = np.argmax(number == fixed[:, None], axis=1)
        chosen = self._least_clear(offsets, some_open, some_tested, anchor, fixed)
        np.put_along_axis(open_, number, some_open, axis=1)
        np.put_along_axis(tested, number, some_tested, axis=1)
        best: Array = offsets[np.arange(len(offsets)), chosen]
        return best

    def _useful(
        self, states: Array, open_: Mask, tested: Mask, anchor: Index, fixed: Index
    ) -> Mask:
        """Return the open states (m, s) that the best paths may contain."""
        useful = open_.copy()
        for bead in range(len(self.counts)):
            at, ends = (
                slice(self.begin[bead], self.begin[bead] + self.counts[bead]),
                np.array([bead]),
            )
            count = int(np.flatnonzero(open_[at].any(axis=0))[-1]) + 1
            chains = self._chains(ends, open_[:, :count], anchor, fixed)
            known = self._chains(ends, (open_ & tested)[at, :count], anchor, fixed, at.start)
            row = chains.position[0]
            useful[row, :count] &= useful_states(
                states[:, :, :count], chains.free, known.free, chains.weight, chains.change
            )
        return self._both_ends(useful)

    def _hopeless(self, barred: Mask, pending: Mask, numbers: range) -> Index:
        """Return the pending beads with a sampled barred point (m,) that is not free on any larger cone."""
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
        for number in numbers:
            rows_ = rows_[~self._clear(rows_, self._ring(number)).any(axis=1)]
        beads: Index = np.unique(self._bead[rows_])
        return beads

    def finer(
        self, offset: Array, step: float, turn: int, clear: Mask | None = None
    ) -> tuple[Array, Mask]:
        """Improve tilts on a finer grid about the present tilts.

        Parameters
        ----------
        offset : (m, 2) array
            The tilts, rad.
        step : float
            Grid step, rad; the grid extends two steps in each component.
        turn : int
            Index of the refinement. Each refinement keeps another point of a closed bead
            unchanged.
        clear : (m,) bool array or None, optional
            Points whose present tilt is clear; None for all.

        Returns
        -------
        offset : (m, 2) array
            Improved tilts, rad.
        stuck : (m,) bool array
            Points without a clear tilt on the grid.
        """
        around = step * np.arange(-2.0, 3.0)
        grid = np.stack(
            np.meshgrid(around, around if self.plane is None else [0.0], indexing="ij"), axis=-1
        ).reshape(-1, 2)
        # the corners of the square would take most of the time
        grid = grid[np.abs(grid).sum(axis=1) < 2.5 * step]
        offsets = offset[:, None] + grid
        centre_state = len(grid) // 2
        offsets[:, centre_state] = offset
        searched = self.near & ~self.lost[self._bead]
        open_ = self._both_ends(np.repeat(searched[:, None], offsets.shape[1], axis=1))
        tested = ~open_
        tested[:, centre_state] = True
        open_[:, centre_state] = True if clear is None else clear
        open_ = self._both_ends(open_)
        anchor = (self.counts - 1) * (turn % 3) // 3
        if clear is not None:
            anchor = self._nearest_clear(anchor, open_[:, centre_state])
        fixed = np.full(len(offset), centre_state)
        chosen = self._least_clear(offsets, open_, tested, anchor, fixed)
        point = np.arange(len(offset))
        return offsets[point, chosen], ~open_[point, chosen]

    def _nearest_clear(self, anchor: Index, clear: Mask) -> Index:
        """Return for each bead the point nearest to `anchor` (b,) among the clear points (m,), if any."""
        nearest_ = anchor.copy()
        for bead, (start, count) in enumerate(zip(self.begin, self.counts, strict=True)):
            points = np.flatnonzero(clear[start : start + count - 1])
            if len(points):
                nearest_[bead] = points[np.abs(points - anchor[bead]).argmin()]
        return nearest_

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
        """Restrict both ends of closed beads, which are the same point, to the states allowed at both."""
        allowed = allowed.copy()
        start = self.begin[self.closed]
        end = start + self.counts[self.closed] - 1
        allowed[start] &= allowed[end]
        allowed[end] = allowed[start]
        return allowed

    def _anchors(self, size: Array) -> Index:
        """Return the point of minimum required tilt of each bead; in a tie, farthest from points of larger tilt."""
        anchors = []
        for start, count in zip(self.begin, self.counts, strict=True):
            need = size[start : start + count - 1]
            least_of_all = np.flatnonzero(need <= need.min() + CAP)
            larger = np.flatnonzero(need > need.min() + CAP)
            distance = nearest(larger.astype(float), least_of_all.astype(float), float(count - 1))
            anchors.append(int(least_of_all[np.argmax(distance)]))
        return np.array(anchors)

    def _least_clear(
        self, offsets: Array, open_: Mask, tested: Mask, anchor: Index, fixed: Index
    ) -> Index:
        """Return the minimum-cost clear tilts (m,) among tilts (m, s, 2), and update open_ and tested (m, s).

        Only the tilts of the best path and adjacent tilts are tested, until the whole path is
        clear. Barring more tilts could not give a better path.
        """
        chosen = np.zeros(len(self.flat), dtype=np.intp)
        todo = np.ones(len(self.counts), dtype=bool)
        point = np.arange(len(self.flat))
        while todo.any():
            self._least(np.flatnonzero(todo), offsets, open_, anchor, fixed, chosen)
            rows = np.flatnonzero(todo[self._bead] & ~tested[point, chosen])
            self._test(rows, chosen[rows], offsets, open_, tested)
            todo[:] = False
            todo[self._bead[rows[~open_[rows, chosen[rows]]]]] = True
        return chosen

    def _test(self, rows: Index, picked: Index, offsets: Array, open_: Mask, tested: Mask) -> None:
        """Test the tilts picked at rows (k,), and adjacent tilts that are not tested yet."""
        apart = np.square(offsets[rows] - offsets[rows, picked][:, None]).sum(axis=2)
        apart[~open_[rows]] = np.inf
        apart[np.arange(len(rows)), picked] = -1.0
        candidates = np.argsort(apart, axis=1, kind="stable")[:, :NEIGHBOUR_COUNT]
        unknown = ~tested[rows[:, None], candidates]
        row, candidate = np.repeat(rows, unknown.sum(axis=1)), candidates[unknown]
        barred = ~self._clear(row, offsets[row, candidate][:, None])[:, 0]
        tested[row, candidate] = True
        row, candidate = row[barred], candidate[barred]
        open_[row, candidate] = open_[self._twin[row], candidate] = False

    def _least(
        self,
        beads: Index,
        offsets: Array,
        allowed: Mask,
        anchor: Index,
        fixed: Index,
        chosen: Index,
    ) -> None:
        """Choose the minimum-cost tilts (m,) of some beads.

        A closed bead runs from the anchor around to the anchor, where its tilt is `fixed`.
        """
        # group chains of similar size, because padding to the longest chain takes memory
        last = allowed.shape[1] - np.argmax(allowed[:, ::-1], axis=1)
        width = np.maximum.reduceat(last, self.begin)[beads]
        sizes = np.ceil(np.log2(np.stack([self.counts[beads], width]))).astype(int)
        kind = sizes[0] + 64 * sizes[1]
        for group in (beads[kind == size] for size in np.unique(kind)):
            states = slice(0, int(width[kind == kind[beads == group[0]]].max()))
            chains = self._chains(group, allowed[:, states], anchor, fixed)
            best = least_cost_states(
                offsets[chains.position, states] if len(offsets) > 1 else offsets[None, :, states],
                chains.free,
                chains.weight,
                chains.change,
            )
            for k, bead in enumerate(group):
                start, count = self.begin[bead], self.counts[bead]
                chosen[chains.position[k, :count]] = best[k, :count]
                if self.closed[bead]:
                    chosen[start + count - 1] = chosen[start]

    def _chains(
        self, beads: Index, allowed: Mask, anchor: Index, fixed: Index, first: int = 0
    ) -> _Chains:
        """Arrange beads as chains; allowed: states (m - first, s) from point `first` on."""
        n, s = int(self.counts[beads].max()), allowed.shape[1]
        position = np.zeros((len(beads), n), dtype=np.intp)
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
            free[k, :count] = allowed[position[k, :count] - first]
            if self.closed[bead]:
                ends = np.arange(s) == fixed[start + anchor[bead]]
                free[k, 0], free[k, count - 1] = ends, ends
        return _Chains(position, free, weight, change)


class _Chains(NamedTuple):
    """Chains padded to the longest.

    position: (b, n) indices of the searched points, arbitrary for padding. free: (b, n, s) free states. weight, change:
    as in `least_cost_states`.
    """

    position: Index
    free: Mask
    weight: Array
    change: Array


def near_marks(points: Array, marked: Mask, closed: bool, reach: float) -> Mask:
    """Return which points of a bead are near marked points.

    Parameters
    ----------
    points : (n, 3) array
        Points of the bead, mm.
    marked : (n,) bool array
        The marked points.
    closed : bool
        Whether the bead is closed.
    reach : float
        Maximum distance along the bead, mm.

    Returns
    -------
    (n,) bool array
        True near a marked point.
    """
    length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    is_near: Mask = nearest(length[marked], length, float(length[-1]) if closed else None) <= reach
    return is_near


def nearest(marks: Array, positions: Array, length: float | None) -> Array:
    """Return the distances of positions on a line from the nearest mark.

    Parameters
    ----------
    marks : (k,) array
        Ascending positions of the marks, mm.
    positions : (n,) array
        The positions, mm.
    length : float or None
        Length of a closed line, mm; None for an open line.

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
    # in the other direction, the farthest mark is the nearest
    around: Array = np.minimum(
        distance, length - np.maximum(np.abs(positions - marks[0]), np.abs(positions - marks[-1]))
    )
    return around


def _sides(tool: Array, plane: Array | None) -> Array:
    """Return pairs of unit vectors (n, 2, 3) normal to the requested axes, carried along a bead; the first in the plane."""
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


LOOKED_AT = 240  # maximum number of checked points
BATCH_POINTS = (
    3  # points in the first batch; if a point has no clear tilt, later batches are skipped
)
GROWING_BATCHES = 6  # number of batches, each of twice as many points, before the last one
BUILT_POINTS = 200_000  # maximum number of points whose deposit is built as a whole, 0.1 GB
SHARES = (0.75, 0.5, 0.25)  # fractions of the nozzle's half angle that are tried
FARTHER = np.radians(15.0)  # step by which the maximum tilt is raised
MAX_TRIALS = 4  # maximum number of changes for which every bead is tilted again
MAX_TRIAL_POINTS = 20_000  # maximum number of points of a toolpath that is tilted again


class Change(NamedTuple):
    """Alternative bodies, nozzle and build directions, with a description."""

    bodies: Sequence[Body]
    nozzle: NozzleParameters
    build: BuildDirectionParameters
    words: Text


class Touching(NamedTuple):
    """A toolpath with the requested axes, and the points (k,) that no tilt clears.

    plane, feature: as in `clear_by_tilt.keep_clear`.
    """

    toolpath: Toolpath
    rows: Index
    plane: Array | None
    feature: int | None

    def clear_at(self, change: Change) -> bool:
        """Whether each point has a clear tilt of up to MAX_TILT_RAD after a change; many points are sampled."""
        space = space_of(
            self.toolpath,
            change.bodies,
            change.nozzle,
            change.build.max_tilt,
            self.toolpath.point_count <= BUILT_POINTS,
            self.feature or 0,
        )
        sample = self.rows[
            np.unique(
                np.linspace(0, len(self.rows) - 1, min(LOOKED_AT, len(self.rows))).astype(np.intp)
            )
        ]
        tool = np.concatenate([bead.tool for _, _, bead in self.toolpath])
        # one point without a clear tilt decides: the batches grow
        batches = np.split(sample, np.cumsum(BATCH_POINTS * 2 ** np.arange(GROWING_BATCHES)))
        return all(self._clear_at(space, tool, batch) for batch in batches)

    def _clear_at(self, space: Space, tool: Array, rows: Index) -> bool:
        last_ring = round(MAX_TILT_RAD / RING)
        # several cones together, because a test of few axes takes as long as one of hundreds
        for first, end in ((0, 1), (1, 3), (3, 7), (7, last_ring + 1)):
            if not len(rows):
                break
            angles = RING * np.arange(first, end)
            axes = np.concatenate([self._cone(tool[rows], angle) for angle in angles], axis=1)
            free = (
                space.clear(np.repeat(rows, axes.shape[1]), axes.reshape(-1, 3))
                .reshape(len(rows), -1)
                .any(axis=1)
            )
            rows = rows[~free]
        return not len(rows)

    def _cone(self, tool: Array, angle: float) -> Array:
        """Return axes (k, s, 3) at an angle, rad, from the requested axes (k, 3)."""
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
                    "the nozzle would be clear at these points with {}; the other points were "
                    "not tested",
                    change.words,
                )
            trials_left -= 1
            if trials_left >= 0 and clears(change):
                return Text("with {} the nozzle is clear (tested)", change.words)
        trials += [change.words for change in changes[-1:] if trials_left >= 0]
    fallback = Text("use other layers or another direction, or exclude this region")
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
    """Return the smallest change that clears every point, and the largest; empty if the largest does not."""
    if not changes or not touching.clear_at(changes[-1]):
        return []
    smallest = next((change for change in changes[:-1] if touching.clear_at(change)), changes[-1])
    return [smallest] if smallest is changes[-1] else [smallest, changes[-1]]


def _tilts(now: Change) -> list[Change]:
    """Return changes to larger maximum tilts, ascending."""
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
    """Return the change that removes all bodies, so that only the deposit is an obstacle."""
    names = Text.joined(", ", (body.name for body in now.bodies))
    return [now._replace(bodies=(), words=Text("{} out of the way", names))] if now.bodies else []


def _half_angles(now: Change) -> list[Change]:
    """Return changes to slimmer nozzles, with half angles in whole degrees, slimmest last."""
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
