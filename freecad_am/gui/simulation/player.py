# SPDX-License-Identifier: LGPL-2.1-or-later
"""Position of a simulation and its data at that time. Uses neither window nor view."""

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
    """Data of a simulation without its pictures. title: of the played object. objects: names of the
    objects it was made from. stale: whether they have changed since. deposit: predicted by an
    inspection of the toolpath; None without a current one."""

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
    """Return the run of a joint path or of a program. Raises InputError with the remedy if it has
    nothing to play."""
    return prepared(obj)()


def prepared(obj: Any) -> Callable[[], Run]:
    """What makes the run of a joint path or of a program, without the document, from which all is read now. Raises
    InputError as `run_of`."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in ("joint path", "program"):
        raise InputError(
            "NOT_TO_PLAY", obj.Label, "it is neither a joint path nor a program; select one"
        )
    path = obj if stage.kind == "joint path" else obj.JointPath
    planned, toolpath, looks = planned_of(path, obj.Label)
    folders = user_machines.folders()
    process = path.Toolpath.Proxy.parameters(path.Toolpath, ProcessParameters)
    if not len(planned.motion):
        raise InputError("NO_RESULT", path.Label, "it has no points to play; choose another path")
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
    """The deposit that the last inspection of a toolpath has predicted, where it fits that."""
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
    """One moment. state: of the timeline. row: of the motion. values, margins, ratios, bad: (axes,)
    joints and margins in display units, shares of the speed limits, violations. links: (axes + 1,)
    links to be marked. asked, achieved: mm/s. condition, threshold: NaN where not known. singular:
    whether condition is below threshold."""

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
        """Go to the start of the next layer; backwards: of this layer, or of the previous one if
        already at the start."""
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
        """Go to the next issue: after the current one, else the first from here on; None without
        issues."""
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
