# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where a simulation stands, and what is to be told there. Knows neither window nor view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from freecad_am.core.types import Array, Mask

from ...core.simulation.margins import speed_ratios
from ...core.simulation.timeline import State
from ...core.simulation.watch import Finding, bad_links, shown_margins
from .run import Run

_TOLERANCE_S = 1e-9  # s


@dataclass(frozen=True, eq=False)
class Moment:
    """One moment. state: of the timeline. row: the row told of. values, margins, ratios, bad: (axes,) joints and margins in
    the units shown, shares of the largest speeds, which are wrong. links: (axes + 1,) links to be marked. asked, achieved:
    mm/s. condition, threshold: NaN where not known. singular: whether it is below."""

    state: State
    row: int
    values: Array
    margins: Array
    ratios: Array
    bad: Mask
    links: Mask
    asked: float
    achieved: float
    condition: float
    threshold: float
    singular: bool


class Player:
    """The time of a simulation, s, and ways to move it."""

    def __init__(self, run: Run) -> None:
        self.run, self.time, self.playing, self.factor = run, 0.0, False, 10.0
        self.row: int | None = None  # where it was put on a row
        self.finding: int | None = None  # which one it was put on

    def advance(self, seconds: float) -> None:
        """Let the simulated time pass that goes with some seconds of the clock."""
        if self.playing:
            self.go(self.time + seconds * self.factor)
            self.playing = self.time < self.run.times.total

    def go(self, time: float) -> None:
        """To a time."""
        self.time, self.row, self.finding = (
            float(np.clip(time, 0.0, self.run.times.total)),
            None,
            None,
        )

    def go_to_row(self, row: int) -> None:
        """To where a row is reached."""
        self.time, self.row, self.finding = float(self.run.times.arrive[row]), row, None

    def step(self, by: int) -> None:
        """To the next point, or to the one before."""
        arrive = self.run.times.arrive
        if by > 0:
            row = int(np.searchsorted(arrive, self.time + _TOLERANCE_S, side="right"))
        else:
            row = int(np.searchsorted(arrive, self.time - _TOLERANCE_S, side="left")) - 1
        self.go_to_row(int(np.clip(row, 0, len(arrive) - 1)))

    def step_layer(self, by: int) -> None:
        """To the start of the next layer, or of this one, or of the one before when it is there."""
        starts = self.run.times.arrive[self.run.times.layer_rows]
        if by > 0:
            index = int(np.searchsorted(starts, self.time + _TOLERANCE_S, side="right"))
            if index == len(starts):
                self.go(self.run.times.total)
                return
        else:
            index = max(int(np.searchsorted(starts, self.time - _TOLERANCE_S, side="left")) - 1, 0)
        self.go_to_row(int(self.run.times.layer_rows[index]))

    def next_finding(self) -> Finding | None:
        """To the next finding: after the one it was put on, else the first from here on; None when there are none."""
        findings = self.run.watch.findings
        if not findings:
            return None
        if self.finding is not None:
            index = (self.finding + 1) % len(findings)
        else:
            now = int(self.run.times.state_at(self.time).row) if self.row is None else self.row
            later = [number for number, finding in enumerate(findings) if finding.row >= now]
            index = later[0] if later else 0
        self.go_to_row(findings[index].row)
        self.finding = index
        return findings[index]

    def moment(self) -> Moment:
        """What there is to tell now."""
        run = self.run
        state = run.times.state_at(self.time)
        row = int(state.row) if self.row is None else self.row
        motion, machine = run.motion, run.cell.machine
        before = slice(max(row - 1, 0), row + 1)
        ratios = speed_ratios(
            motion.joints[before], np.nan_to_num(motion.duration[before]), machine.max_speed
        )[-1]
        ratios = np.nan_to_num(ratios, posinf=0.0)
        margins = shown_margins(run.cell, state.joints)
        condition, threshold = float(run.watch.condition[row]), float(run.watch.threshold[row])
        singular, reachable = bool(run.watch.singular[row]), bool(np.isfinite(state.joints).all())
        links = bad_links(
            run.cell, margins, ratios, singular, reachable, int(run.watch.touching[row])
        )
        alone = bad_links(run.cell, margins, ratios, False, True)
        axes = len(machine.axes)
        return Moment(
            state=state,
            row=row,
            values=state.joints / machine.unit_values,
            margins=margins[:axes],
            ratios=ratios,
            bad=alone[1:],
            links=links,
            asked=float(run.feed.asked[row]),
            achieved=float(run.feed.achieved[row]),
            condition=condition,
            threshold=threshold,
            singular=singular,
        )
