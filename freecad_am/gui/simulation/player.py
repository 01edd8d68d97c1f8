# SPDX-License-Identifier: LGPL-2.1-or-later
"""The current time of a simulation and the data at that time. Independent of window and view."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.issues import InputError
from ...core.kinematics.cell import Cell
from ...core.motion import Motion
from ...core.parameters.cell import CellParameters
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.simulation.achievable_feed import AchievableFeed, achievable_feed, speed_ratios
from ...core.simulation.timeline import State, Timeline, Totals, timeline, totals
from ...core.simulation.watch import Finding, Watch, bad_links, shown_margins, watch
from ...core.toolpath import Toolpath
from ...core.types import Array, Mask
from ...objects import user_machines
from ...objects.checks.placed import arm_of
from ...objects.joint_path import planned_of
from ...objects.results.as_run import as_run
from ...objects.results.findings import issues_of
from ...objects.shapes.cell_obstacles import meshes_of, resolved
from ...objects.stage import stage_of
from ...objects.staleness import STALE, UP_TO_DATE


@dataclass(frozen=True, eq=False)
class Run:
    """Data of a simulation.

    title: title of the played object. objects: names of its source objects. stale: whether they
    have changed since. deposit: deposit that an inspection of the toolpath predicted; None without
    a current inspection.
    """

    document: str
    title: str
    objects: tuple[str, ...]
    cell: Cell
    looks: CellParameters
    toolpath: Toolpath
    width: float
    motion: Motion
    times: Timeline
    feed: AchievableFeed
    watch: Watch
    totals: Totals
    stale: bool = False
    deposit: Array | None = None


def run_of(obj: Any) -> Run:
    """Return the run of a joint path or program. Raises InputError with the remedy if there is
    nothing to play.
    """
    return prepared(obj)()


def prepared(obj: Any) -> Callable[[], Run]:
    """Read a joint path or program, and return a function that builds its run without the document.

    Raises InputError as `run_of`.
    """
    stage = stage_of(obj)
    if stage is None or stage.kind not in ("joint path", "program"):
        raise InputError(
            "NOT_TO_PLAY",
            obj.Label,
            "the object is neither a joint path nor a program; select a joint path or a program",
        )
    path = obj if stage.kind == "joint path" else obj.JointPath
    planned, toolpath, looks = planned_of(path, obj.Label)
    folders = user_machines.folders()
    process = path.Toolpath.Proxy.parameters(path.Toolpath, ProcessParameters)
    if not len(planned.motion):
        raise InputError(
            "NO_RESULT", path.Label, "the path has no points to play; choose another path"
        )
    issues, stale, label = issues_of(path), path.Status == STALE, obj.Label
    deposited = _predicted(path.Toolpath)
    names = tuple(dict.fromkeys((obj.Name, path.Name, path.Toolpath.Name, path.Cell.Name)))
    document = obj.Document.Name
    settings = obj.Proxy.parameters(obj, ProgramParameters) if stage.kind == "program" else None
    cell = resolved(looks, toolpath, folders)
    shapes = meshes_of(cell.machine)

    def work() -> Run:
        run = as_run(planned, cell, toolpath.chord_error, settings, issues)
        motion = run.motion
        times = timeline(motion, process, [layer.wait for layer in toolpath.layers])
        feed = achievable_feed(motion, cell.machine.max_speed, cell.machine.max_acceleration)
        return Run(
            document=document,
            title=label,
            objects=names,
            cell=cell,
            looks=looks,
            toolpath=toolpath,
            width=process.bead_width,
            motion=motion,
            times=times,
            feed=feed,
            watch=watch(
                motion,
                cell,
                feed,
                run.condition,
                run.threshold,
                run.issues,
                arm_of(motion, cell, toolpath, process, shapes),
            ),
            totals=totals(motion, times, process, toolpath),
            stale=stale,
            deposit=deposited,
        )

    return work


def _predicted(toolpath: Any) -> Array | None:
    """Return the deposit that the last current inspection of a toolpath predicted; None without
    one.
    """
    for obj in reversed(toolpath.InList):
        stage = stage_of(obj)
        if (
            stage is not None
            and stage.kind == "inspection"
            and obj.Key
            and obj.Status == UP_TO_DATE
        ):
            deposit: Array | None = stage.value(obj).laid
            if deposit is not None:
                return deposit
    return None


_TOLERANCE_S = 1e-9  # s


@dataclass(frozen=True, eq=False)
class Moment:
    """The data of a moment.

    state: state of the timeline. row: motion row. values, margins, ratios, bad: (axes,) joints and
    margins in display units, fractions of the speed limits, violations. links: (axes + 1,) links to
    mark. asked, achieved: mm/s. condition, threshold: NaN if unknown. singular: whether condition
    is below threshold.
    """

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
    """The current time of a simulation, s, and functions to change it."""

    def __init__(self, run: Run) -> None:
        self.run, self.time, self.playing, self.factor = run, 0.0, False, 10.0
        self.row: int | None = None  # row of the last jump
        self.finding: int | None = None  # index of the issue of the last jump

    def advance(self, seconds: float) -> None:
        """Advance the simulated time for some seconds of real time."""
        if self.playing:
            self.go(self.time + seconds * self.factor)
            self.playing = self.time < self.run.times.total

    def go(self, time: float) -> None:
        """Go to a time."""
        self.time, self.row, self.finding = (
            float(np.clip(time, 0.0, self.run.times.total)),
            None,
            None,
        )

    def go_to_row(self, row: int) -> None:
        """Go to the time at which a row is reached."""
        self.time, self.row, self.finding = float(self.run.times.arrive[row]), row, None

    def step(self, by: int) -> None:
        """Go to the next or previous point."""
        arrive = self.run.times.arrive
        if by > 0:
            row = int(np.searchsorted(arrive, self.time + _TOLERANCE_S, side="right"))
        else:
            row = int(np.searchsorted(arrive, self.time - _TOLERANCE_S, side="left")) - 1
        self.go_to_row(int(np.clip(row, 0, len(arrive) - 1)))

    def step_layer(self, by: int) -> None:
        """Go to the start of the next layer.

        Backwards, go to the start of this layer, or of the previous layer if already at the start.
        """
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
        """Go to the issue after the current issue, or to the first issue from here on; None without
        issues.
        """
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
        """Return the data of the current moment."""
        run = self.run
        state = run.times.state_at(self.time)
        row = int(state.row) if self.row is None else self.row
        motion, machine = run.motion, run.cell.machine
        rows = slice(max(row - 1, 0), row + 1)
        ratios = speed_ratios(
            motion.joints[rows], np.nan_to_num(motion.duration[rows]), machine.max_speed
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
