# SPDX-License-Identifier: LGPL-2.1-or-later
"""What would make an infeasible job feasible, found by planning it so.

Changes are tried in order, what costs the user least first: the program's own (speed, branch, rotation, lift), then the
process (directions), then the cell. Each is planned for some of the layers that failed, and only one that serves there for
the whole job. How much is tried is bounded by points, not by time, so that the same job says the same.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..geometry.obstacles import Body
from ..issues import ERROR, NOTE, AmError, Issue, Text, has_errors
from ..kinematics import cell as cells
from ..kinematics import proposed_cell
from ..kinematics.arrangement import of_setup
from ..kinematics.inverse import opw
from ..kinematics.links.external_links import ExternalLink, external_links
from ..kinematics.torch import Torch
from ..parameters.cell import CellParameters, Pose
from ..parameters.external import externals
from ..parameters.joints import OF_CELL, JointParameters
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from .arm.kept import Cylinders
from .beads.speeds import share_of_speed
from .external import remedies as external_remedies
from .external.level import levelled
from .joint_path import JointPath
from .motion import assemble
from .plan import Progress, best_branches, plan_joints

REMEDY, NO_REMEDY = "REMEDY", "NO_REMEDY"
LAYERS = 3  # that failed, planned anew with each change
POINTS = 12_000  # planned so in all
CHANGES = 16  # that are tried, about
LONGEST = 20_000  # points of a job that is planned anew as a whole
WHOLE = 3  # times that it is
RETRACTS = (50.0, 100.0, 5.0)  # mm
SHIFTS = ((0.0, -150.0), (0.0, 150.0), (-150.0, 0.0), (150.0, 0.0))  # of the deposition point, ahead of the robot and up, mm
FULL_TURN = (-math.pi, math.pi)


class Fixed(NamedTuple):
    """A toolpath with fixed build directions where they were not: the keys that say so, and what makes it."""

    remedy: str
    make: Callable[[], Toolpath]


@dataclass(frozen=True)
class Tried:
    """A job to plan: that which is infeasible, or it with a change, told as keys of a job file. fixed: the toolpath with the
    build direction of the part's axis; None where it has it, or cannot. own_speed: of several features, whether each has a
    travel speed of its own. beside: links of its positioner and track as they were read."""

    toolpath: Callable[[], Toolpath]
    settings: CellParameters
    folders: tuple[str, ...]
    process: ProcessParameters
    joints: JointParameters
    fixed: Fixed | None = None
    remedy: str = field(default="")
    own_speed: tuple[bool, ...] = ()
    cylinders: Cylinders = ()
    obstacles: tuple[Body, ...] = ()
    torch: Torch | None = None
    external_links: tuple[ExternalLink, ...] = ()

    def cell(self, toolpath: Toolpath) -> cells.Cell:
        """The cell of a toolpath of it."""
        found = cells.resolve(self.settings, toolpath.frame, toolpath.family, self.folders)
        adjacent = external_links(found.external, known=self.external_links)
        return dataclasses.replace(found, obstacles=self.obstacles, torch=self.torch, external_links=adjacent)

    def issues(self, toolpath: Toolpath, whole: bool, progress: Progress) -> tuple[Issue, ...]:
        """What is wrong with it; rapids only of a whole one."""
        cell = self.cell(toolpath)
        joints = dataclasses.replace(self.joints, compare=())
        path = plan_joints(toolpath, cell, joints, progress, self.cylinders)
        found = (*toolpath.issues, *path.issues)
        if whole and not has_errors(found):
            height = toolpath.layer_height
            _, rapids = assemble(path, cell, self.process, toolpath.surroundings, joints, height, self.cylinders)
            found += rapids
        return found


def most_points(toolpath: Toolpath, issues: Sequence[Issue]) -> int:
    """How many points are planned anew at most to find what makes a job with these issues feasible, 0 of a feasible one."""
    if not has_errors(list(issues)):
        return 0
    some = min(POINTS, CHANGES * _some(toolpath, _failed(issues)).point_count)
    return some + (WHOLE * toolpath.point_count if toolpath.point_count <= LONGEST else 0)


def remedies(job: Tried, path: JointPath, issues: Sequence[Issue], progress: Progress) -> list[Issue]:
    """A note with the first change found that makes an infeasible job feasible, or with all that were tried; none of a
    feasible one. path: its joint path. progress may raise to cancel."""
    if not has_errors(list(issues)):
        return []
    failed = _failed(issues)
    points, whole, tried = POINTS, WHOLE, []
    for change in _changes(job, path, issues):
        progress(1.0, Text("looking for what would make it feasible: {}", change.remedy))
        try:
            toolpath = change.toolpath()
            some = _some(toolpath, failed)
            points -= some.point_count
            if points < 0:
                break
            tried.append(change.remedy)
            if has_errors(change.issues(some, False, progress)):
                continue
            if toolpath.point_count > LONGEST:
                count = len(some.layers)
                return [Issue(NOTE, REMEDY, Text("with {} the {} of the layers in question that were planned anew are "
                                                 "feasible; the whole job was not tried", change.remedy, count))]
            whole -= 1
            if not has_errors(change.issues(toolpath, True, progress)):
                return [Issue(NOTE, REMEDY, Text("with {} this job is feasible; tried, not applied", change.remedy))]
            if not whole:
                break
        except AmError:  # what cannot be asked for is not a remedy
            continue
    if not tried:
        return []
    return [Issue(NOTE, NO_REMEDY, Text("none of these makes the job feasible, each was tried: {}",
                                        Text.joined("; ", tried)))]


def _failed(issues: Sequence[Issue]) -> list[int]:
    """The layers that errors are in."""
    return sorted({issue.layer for issue in issues if issue.level == ERROR and issue.layer is not None})


def _some(toolpath: Toolpath, failed: Sequence[int]) -> Toolpath:
    """The toolpath with LAYERS of its layers at most, those that failed."""
    known = [k for k in failed if k < len(toolpath.layers)] or list(range(len(toolpath.layers)))
    chosen = sorted({known[round(at)] for at in np.linspace(0, len(known) - 1, LAYERS)})
    return dataclasses.replace(toolpath, layers=tuple(toolpath.layers[k] for k in chosen))


def _changes(job: Tried, path: JointPath, issues: Sequence[Issue]) -> Iterator[Tried]:
    codes, free = {issue.code for issue in issues if issue.level == ERROR}, of_setup(job.settings.setup).free > 0
    usual = CellParameters()
    left_out = job.settings.deposition_point == usual.deposition_point and job.settings.machine != usual.machine
    if left_out and free:
        yield from _points(job)
    if "SPEED" in codes and job.process.bead_model == "none":
        yield from _slower(job, path)
    if all(code.startswith("RAPID") for code in codes):
        yield from _retracts(job)
    if free and codes != {external_remedies.NOT_LEVEL}:  # which no turn about the tool mends
        yield from _branches(job)
        yield from _rotations(job)
    if job.fixed is not None:
        fixed = dataclasses.replace(job, toolpath=job.fixed.make, remedy=job.fixed.remedy)
        yield fixed
        if free and job.settings.branch != "auto":
            yield _with_cell(fixed, Text("{} and `cell.branch: auto`", fixed.remedy), branch="auto")
    if not left_out and free:
        yield from _points(job)
    yield from _external_axes(job, codes)


def _with_cell(job: Tried, remedy: str, **values: object) -> Tried:
    return dataclasses.replace(job, settings=dataclasses.replace(job.settings, **values), remedy=remedy)  # type: ignore[arg-type]


def _slower(job: Tried, path: JointPath) -> Iterator[Tried]:
    """As fast as the axes can where they have most to do; features with a speed of their own keep that."""
    toolpath = job.toolpath()
    cell = cells.resolve(job.settings, toolpath.frame, toolpath.family, job.folders)
    speed = job.process.travel_speed * share_of_speed(cell, path.beads)
    if not 0.0 < speed < job.process.travel_speed:
        return
    step = 10.0 ** (math.floor(math.log10(0.99 * speed)) - 1)
    speed = math.floor(0.99 * speed / step) * step  # two digits
    share = speed / job.process.travel_speed
    layers = tuple(
        layer if job.own_speed and job.own_speed[layer.feature] else
        dataclasses.replace(layer, beads=tuple(dataclasses.replace(bead, speed=share * bead.speed) for bead in layer.beads))
        for layer in toolpath.layers
    )
    slower = dataclasses.replace(toolpath, layers=layers)
    process = dataclasses.replace(job.process, travel_speed=speed)
    yield dataclasses.replace(
        job, toolpath=lambda: slower, process=process, remedy=f"`process.travel_speed: {speed:g} mm/s`"
    )


def _retracts(job: Tried) -> Iterator[Tried]:
    for retract in RETRACTS:
        between = dataclasses.replace(job.process.between_layers, lift=retract)
        if between != job.process.between_layers:
            process = dataclasses.replace(job.process, between_layers=between)
            yield dataclasses.replace(job, process=process, remedy=f"`process.between_layers.lift: {retract:g} mm`")


def _branches(job: Tried) -> Iterator[Tried]:
    """The other branches that promise most."""
    if job.settings.branch == "auto" or job.joints.own_branch != OF_CELL:
        return
    toolpath = job.toolpath()
    cell = cells.resolve(dataclasses.replace(job.settings, branch="auto"), toolpath.frame, toolpath.family, job.folders)
    beads = levelled(cell, toolpath)[0] if cell.external else [bead for _, _, bead in toolpath]
    for branch in best_branches(beads, cell, job.joints, toolpath.family != "revolution"):
        words = opw.branch_name(branch)
        if words != job.settings.branch:
            yield _with_cell(job, f"`cell.branch: [{', '.join(words)}]`", branch=words)


def _rotations(job: Tried) -> Iterator[Tried]:
    """More freedom about the tool."""
    low, high = job.joints.rotation_range
    if high - low < FULL_TURN[1] - FULL_TURN[0] - 1e-9:
        free = dataclasses.replace(job.joints, rotation_range=FULL_TURN)
        yield dataclasses.replace(job, joints=free, remedy="`joints.rotation_range: [-180 deg, 180 deg]`")
    if job.joints.method == "constant":
        layers = dataclasses.replace(job.joints, method="layer-by-layer")
        yield dataclasses.replace(job, joints=layers, remedy="`joints.method: layer-by-layer`")


def _points(job: Tried) -> Iterator[Tried]:
    """Where the deposition point, or the fixed platform, may well be: where the machine has most room, then beside where it
    is."""
    if externals(job.settings.external):  # the platform stands on the positioner
        return
    best = proposed_cell.proposed(job.settings, job.folders)
    if best.deposition_point != job.settings.deposition_point:
        words = best.branch if isinstance(best.branch, str) else f"[{', '.join(best.branch)}]"
        yield _with_cell(job, Text("{} and `cell.branch: {}`", _shown(best.deposition_point), words),
                         deposition_point=best.deposition_point, branch=best.branch)
    for point in _before(job) if not of_setup(job.settings.setup).carries_part else _adjacent(job.settings.deposition_point):
        yield _with_cell(job, Text("{} and `cell.branch: auto`", _shown(point)), deposition_point=point, branch="auto")


def _external_axes(job: Tried, codes: set[str]) -> Iterator[Tried]:
    """A positioner elsewhere, or axes beside a robot that has none."""
    for remedy, settings in external_remedies.moved(job.settings, job.folders):
        yield dataclasses.replace(job, settings=settings, remedy=remedy)
    toolpath = job.toolpath()
    mass = external_remedies.weight(toolpath, job.process)
    for remedy, settings in external_remedies.added(job.settings, job.folders, toolpath, codes, mass):
        yield dataclasses.replace(job, settings=settings, remedy=remedy)


def _adjacent(point: Pose) -> list[Pose]:
    x, y, *rest = point
    ahead = math.hypot(x, y) or 1.0
    return [
        (round(x + out * x / ahead, 3), round(y + out * y / ahead, 3), round(rest[0] + up, 3), rest[1], rest[2], rest[3])
        for out, up in SHIFTS
    ]


def _before(job: Tried) -> list[Pose]:
    """Places of a platform before a robot that carries the tool, level."""
    cell = cells.resolve(job.settings, np.eye(4), folders=job.folders)
    arm = cell.machine.arm
    if arm is None:
        return []
    shoulder, height = arm.shoulder
    return [
        (float(round(shoulder + ahead * arm.reach)), 0.0, float(round(height + above * arm.reach)), 0.0, 0.0, 0.0)
        for ahead, above in ((0.6, -0.3), (0.6, -0.5), (0.75, -0.3), (0.5, -0.2))
    ]


def _shown(point: Pose) -> str:
    angles = [math.degrees(angle) for angle in point[3:]]
    return Text("`cell.deposition_point: [{}]`", ", ".join(f"{value + 0.0:.10g}" for value in (*point[:3], *angles)))
