# SPDX-License-Identifier: LGPL-2.1-or-later
"""Smooth branches of a curve on a wall at a constant distance from another curve, before trimming.

Let w be the parameter of the curve C below. The point P(w) of the wall at distance h in the normal
plane of the curve satisfies |P - C|^2 = h^2 and (P - C).C' = 0. Where the front focuses, v of P
falls with rising w: the focusing number 1 - (P - C).C''/|C'|^2 is negative, and the points are
closer to other positions of the curve. The new layer at v = const is determined by the position
C(w) whose sphere reaches the highest u. The layer is therefore the upper envelope of the *runs*,
stretches with a positive focusing number, and of the *fans*, spheres about convex corners.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...geometry.curves.space_curve import SpaceCurve
from ...geometry.walls.surface import Surface, dot
from ...types import Array, Index, Mask

STEPS = 25  # maximum number of Newton steps
CONVERGED = 1e-11  # in layer heights; convergence tolerance
GATHERING = 0.6  # focusing number below which additional samples between nodes are needed
TIE = 1e-9  # mm; between branches of equal height within this tolerance, the first in v is used


class Run(NamedTuple):
    """Stretch of a branch with ascending v.

    v, u, w: samples. fan: whether all points belong to one corner. low, high: bounds of w.
    first_arc, last_arc: arcs of the curve between adjacent corners (last_arc = -1 without corners).
    shift: multiple of the period by which v and w are shifted.
    """

    v: Array
    u: Array
    w: Array
    fan: bool
    low: float
    high: float
    first_arc: int
    last_arc: int
    shift: float


class Places(NamedTuple):
    """Points (n,) of the new curve.

    u: position on the wall. slope: du/dv. w: position on the curve below. run: index of the run, -1
    for none.
    """

    u: Array
    slope: Array
    w: Array
    run: Index


class Offset:
    """Offset curve on `surface`, `height` mm from `curve`, evaluated at values of v."""

    def __init__(self, surface: Surface, curve: SpaceCurve, u: Array, height: float) -> None:
        """Prepare the runs; curve: closed, with parameter v; u: (m,) at the nodes of the curve."""
        corners = curve.corners
        if len(corners):
            u = np.r_[u[corners[0] : -1], u[: corners[0] + 1]]
            curve = curve.started_at(int(corners[0]))
        self.surface, self.curve, self.height = surface, curve, height
        self.breaks: Index = (
            np.r_[curve.corners, len(curve.span)].astype(np.intp) if len(corners) else corners
        )
        self.fan_ends: list[float] = []
        self.runs = self._runs(u)

    def evaluate(self, v: Array) -> Places:
        """Evaluate the uppermost branch of the offset curve.

        Parameters
        ----------
        v : (n,) array
            Values of v, in any order.

        Returns
        -------
        Places
            u, slope, w and run at each v; without a branch u is -inf and run is -1.
        """
        target, run, u, w = self._candidates(v)
        u, w, sound = self._solve(v[target], u, w, run)
        result = Places(
            np.full(len(v), -np.inf),
            np.zeros(len(v)),
            np.zeros(len(v)),
            np.full(len(v), -1, dtype=np.intp),
        )
        target, run, u, w = target[sound], run[sound], u[sound], w[sound]
        scale = TIE / self.height
        order = np.lexsort((run, target))
        for k in np.unique(run):  # runs are sorted by v
            rows = order[run[order] == k]
            better = rows[u[rows] > result.u[target[rows]] + scale]
            for have, value in zip(result, (u, None, w, run)):
                if value is not None:
                    have[target[better]] = value[better]
        has_branch = result.run >= 0
        result.slope[has_branch] = self.slopes(
            v[has_branch], result.u[has_branch], result.w[has_branch], result.run[has_branch]
        )
        return result

    def slopes(self, v: Array, u: Array, w: Array, run: Index) -> Array:
        """Return the slopes of branches, which are normal to the direction to the curve below.

        Parameters
        ----------
        v, u : (n,) array
            Parameters of the points on the wall.
        w : (n,) array
            Positions on the curve below.
        run : (n,) int array
            Run of each point.

        Returns
        -------
        (n,) array
            du/dv.
        """
        point, along, around = self.surface.derivatives(u, v)
        reach = point - self._below(w, run)[0]
        slope: Array = -dot(reach, around) / dot(reach, along)
        return slope

    def crossings(
        self, low: Array, high: Array, u: Array, w: Array, run: Index
    ) -> tuple[Array, Array, Array]:
        """Find the intersections of pairs of branches.

        Parameters
        ----------
        low, high : (k,) array
            Bounds of v.
        u : (k,) array
            Initial values of u.
        w : (k, 2) array
            Initial positions on the curve below, of the left and the right branch.
        run : (k, 2) int array
            Runs of the left and the right branch.

        Returns
        -------
        v : (k,) array
            v of the intersections; NaN if not between low and high.
        u : (k,) array
            u of the intersections.
        w : (k, 2) array
            Positions on the curve below.
        """
        v, w = 0.5 * (low + high), w.copy()
        width = high - low
        fan = np.array([[self.runs[i].fan for i in row] for row in run])
        for _ in range(STEPS):
            point, along, around = self.surface.derivatives(u, v)
            matrix, residual = np.zeros((len(v), 4, 4)), np.empty((len(v), 4))
            for k in range(2):
                base, slope, bend = self._below(w[:, k], run[:, k])
                reach = point - base
                on = 1.0 - fan[:, k]
                residual[:, 2 * k] = dot(reach, reach) - self.height**2
                residual[:, 2 * k + 1] = dot(reach, slope) * on
                matrix[:, 2 * k, 0], matrix[:, 2 * k, 1] = (
                    2.0 * dot(reach, along),
                    2.0 * dot(reach, around),
                )
                matrix[:, 2 * k, 2 + k] = -2.0 * dot(reach, slope) * on
                matrix[:, 2 * k + 1, 0], matrix[:, 2 * k + 1, 1] = (
                    dot(along, slope) * on,
                    dot(around, slope) * on,
                )
                matrix[:, 2 * k + 1, 2 + k] = np.where(
                    fan[:, k], 1.0, dot(reach, bend) - dot(slope, slope)
                )
            try:
                step = np.linalg.solve(matrix, residual[..., None])[..., 0]
            except np.linalg.LinAlgError:
                return np.full(len(v), np.nan), u, w
            over = np.maximum(1.0, np.abs(step[:, 1]) / width)[:, None]
            step = step / over
            u, v, w = u - step[:, 0], v - step[:, 1], w - step[:, 2:]
            if np.abs(step).max(initial=0.0) < 1e-14 * max(1.0, self.curve.period):
                break
        sound = (np.abs(step).max(axis=1) < 1e-9) & (v > low - 1e-9) & (v < high + 1e-9)
        for k in range(2):
            bounds = np.array([(self.runs[i].low, self.runs[i].high) for i in run[:, k]])
            sound &= (w[:, k] >= bounds[:, 0] - 1e-9) & (w[:, k] <= bounds[:, 1] + 1e-9)
        return np.where(sound, v, np.nan), u, w

    def _below(self, w: Array, run: Index) -> tuple[Array, Array, Array]:
        """Evaluate the curve below and its derivatives at w; at corners on the side of the run."""
        runs = self.runs
        shift = np.array([r.shift for r in runs])[run]
        last_arc = np.array([r.last_arc for r in runs])[run]
        base = w - shift
        if len(self.breaks):
            index = np.searchsorted(self.curve.w, base, side="right") - 1
            arc = np.clip(index, np.array([r.first_arc for r in runs])[run], last_arc)
        else:
            base = self.curve.wrap(base)
            arc = self.curve.arcs(base)
        return self.curve.evaluate_arcs(arc, (base - self.curve.w[arc]) / self.curve.span[arc])

    def _candidates(self, v: Array) -> tuple[Index, Index, Array, Array]:
        """Find the runs that may contain each v.

        Returns indices of v, runs, and initial values of u and w, all (k,).
        """
        order = np.argsort(v, kind="stable")
        ordered = v[order]
        blocks: list[tuple[Index, Index, Array, Array]] = []
        for i, run in enumerate(self.runs):
            # a run continues between its last sample and its fold
            margin_before = 1e-12 + (run.v[1] - run.v[0] if run.low < run.w[0] else 0.0)
            margin_after = 1e-12 + (run.v[-1] - run.v[-2] if run.high > run.w[-1] else 0.0)
            start, stop = np.searchsorted(
                ordered, (run.v[0] - margin_before, run.v[-1] + margin_after)
            )
            target = order[start:stop]
            if not len(target):
                continue
            u = np.interp(v[target], run.v, run.u)
            w = np.interp(v[target], run.v, run.w)
            if run.fan:  # start above, from where Newton's method certainly reaches the sphere
                u = np.full(len(target), run.u.max()) + self._rise
            blocks.append((target, np.full(len(target), i, dtype=np.intp), u, w))
        if not blocks:
            return np.empty(0, np.intp), np.empty(0, np.intp), np.empty(0), np.empty(0)
        target, run_of, u, w = (np.concatenate(column) for column in zip(*blocks))
        return target, run_of, u, w

    def _solve(self, v: Array, u: Array, w: Array, run: Index) -> tuple[Array, Array, Mask]:
        """Solve for u and w at fixed v by Newton's method.

        Also returns whether each candidate converged on its own branch.
        """
        fan = np.array([r.fan for r in self.runs], dtype=bool)[run]
        low, high = (np.array([r[k] for r in self.runs])[run] for k in (4, 5))
        for _ in range(STEPS):
            point, along, _ = self.surface.derivatives(u, v)
            base, slope, bend = self._below(w, run)
            reach = point - base
            residual = 0.5 * (dot(reach, reach) - self.height**2)
            skew = np.where(fan, 0.0, dot(reach, slope))
            rise, lean = dot(reach, along), np.where(fan, 0.0, dot(along, slope))
            focus = np.where(fan, 1.0, dot(slope, slope) - dot(reach, bend))
            determinant = -rise * focus + skew * lean
            determinant = np.where(np.abs(determinant) > 1e-300, determinant, np.inf)
            du = (-focus * residual + skew * skew) / determinant
            dw = np.clip((rise * skew - lean * residual) / determinant, -0.2, 0.2)
            u, w = u - du, np.where(fan, w, np.clip(w - dw, low, high))
            if (
                np.abs(residual).max(initial=0.0) < CONVERGED * self.height**2
                and np.abs(dw).max(initial=0.0) < 1e-11
            ):
                break
        sound = (np.abs(residual) < 1e-8 * self.height**2) & (focus > 0.0) & (rise > 0.0)
        return u, w, sound & (np.abs(skew) < 1e-7 * self.height * np.sqrt(dot(slope, slope)))

    def _forward(self, u: Array, arc: Index, t: Array) -> tuple[Array, Array, Array]:
        """Return u, v and the focusing number (k,) of the points in the normal planes at t on arcs.

        u and v are NaN where no point exists.
        """
        curve, h = self.curve, self.height
        base, slope, bend = curve.evaluate_arcs(arc, t)
        v = curve.w[arc] + t * curve.span[arc]
        u = u[arc] + t * (u[arc + 1] - u[arc])
        _, along, around = self.surface.derivatives(u, v)
        rate = dot(slope, slope)
        up = along - (dot(along, slope) / rate)[:, None] * slope
        up *= (h / np.linalg.norm(up, axis=1))[:, None]
        a, b, c = dot(along, along), dot(along, around), dot(around, around)
        p, q = dot(up, along), dot(up, around)
        u, v = u + (c * p - b * q) / (a * c - b * b), v + (a * q - b * p) / (a * c - b * b)
        for _ in range(STEPS):
            point, along, around = self.surface.derivatives(u, v)
            reach = point - base
            residual, skew = 0.5 * (dot(reach, reach) - h * h), dot(reach, slope)
            a = dot(reach, along)
            b = dot(reach, around)
            c = dot(along, slope)
            d = dot(around, slope)
            determinant = a * d - b * c
            du = (d * residual - b * skew) / determinant
            dv = (a * skew - c * residual) / determinant
            u, v = u - du, v - dv
            if np.abs(residual).max() < CONVERGED * h * h and np.abs(dv).max() < 1e-11:
                break
        sound = (np.abs(residual) < 1e-8 * h * h) & (np.abs(skew) < 1e-7 * h * np.sqrt(rate))
        return np.where(sound, u, np.nan), np.where(sound, v, np.nan), 1.0 - dot(reach, bend) / rate

    def _samples(self, u: Array) -> tuple[Index, Array, Array, Array, Array]:
        """Return arc, t, u, v and focusing number of samples along the curve below.

        Samples are the nodes, and additional points where the front focuses.
        """
        ends = self.breaks[1:] - 1
        arc = np.r_[np.arange(len(self.curve.span)), ends]
        t = np.r_[np.zeros(len(self.curve.span)), np.ones(len(ends))]
        sampled = self._forward(u, arc, t)
        number = sampled[2][: len(self.curve.span)]
        min_number = np.fmin(number, np.roll(number, -1))
        min_number[ends] = np.fmin(number[ends], sampled[2][len(number) :])
        close = np.flatnonzero(min_number < GATHERING)
        if len(close):
            extra_arcs, extra_t = np.repeat(close, 3), np.tile([0.25, 0.5, 0.75], len(close))
            extra = self._forward(u, extra_arcs, extra_t)
            arc, t = np.r_[arc, extra_arcs], np.r_[t, extra_t]
            sampled = tuple(
                np.r_[column, extra_column] for column, extra_column in zip(sampled, extra)
            )  # type: ignore[assignment]
        order = np.lexsort((t, arc))
        return arc[order], t[order], sampled[0][order], sampled[1][order], sampled[2][order]

    def _runs(self, u: Array) -> list[Run]:
        arc, t, new, v, number = self._samples(u)
        self._rise = float(np.nanmax(new) - u.min()) if np.isfinite(new).any() else 0.0
        w = self.curve.w[arc] + t * self.curve.span[arc]
        period, piece_count = self.curve.period, max(1, len(self.breaks) - 1)
        piece_number = (
            np.searchsorted(self.breaks, arc, side="right") - 1
            if len(self.breaks)
            else np.zeros(len(arc), np.intp)
        )
        # a curve that is restarted at a corner can begin up to one period later
        copies = np.array([-2, -1, 0, 1])
        turns = np.repeat(copies, len(arc))
        shift = turns * period
        piece_number = np.tile(piece_number, len(copies)) + (
            turns * piece_count if len(self.breaks) else 0
        )
        v, w, new, number = (np.tile(x, len(copies)) for x in (v, w, new, number))
        v, w = v + shift, w + shift
        good = (number > 0.0) & np.isfinite(v)
        joined = good[1:] & good[:-1] & (piece_number[1:] == piece_number[:-1]) & (np.diff(v) > 0.0)
        start = np.flatnonzero(good & np.r_[True, ~joined])
        stop = np.flatnonzero(good & np.r_[~joined, True])
        runs: list[Run] = []
        for a, b in zip(start.tolist(), stop.tolist()):
            if b == a:
                continue
            low = w[max(a - 1, 0)] if a and piece_number[a - 1] == piece_number[a] else w[a]
            high = w[b + 1] if b + 1 < len(w) and piece_number[b + 1] == piece_number[b] else w[b]
            first_arc, last_arc = self._arcs_of(int(piece_number[a]) % piece_count)
            runs.append(
                Run(
                    v[a : b + 1],
                    new[a : b + 1],
                    w[a : b + 1],
                    False,
                    float(low),
                    float(high),
                    first_arc,
                    last_arc,
                    float(shift[a]) if len(self.breaks) else 0.0,
                )
            )
        for k in np.flatnonzero(
            (piece_number[1:] != piece_number[:-1]) & (v[1:] > v[:-1] + 1e-9)
        ):  # convex corners
            first_arc, last_arc = self._arcs_of(int(piece_number[k]) % piece_count)
            runs.append(
                Run(
                    v[k : k + 2],
                    new[k : k + 2],
                    w[[k, k]],
                    True,
                    float(w[k]),
                    float(w[k]),
                    first_arc,
                    last_arc,
                    float(shift[k]),
                )
            )
            self.fan_ends += [float(v[k]), float(v[k + 1])]
        return [
            runs[i] for i in np.lexsort(([run.v[-1] for run in runs], [run.v[0] for run in runs]))
        ]

    def _arcs_of(self, piece_number: int) -> tuple[int, int]:
        return (
            (int(self.breaks[piece_number]), int(self.breaks[piece_number + 1]) - 1)
            if len(self.breaks)
            else (0, -1)
        )
