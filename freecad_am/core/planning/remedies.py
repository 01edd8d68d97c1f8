# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find a change that makes an infeasible job feasible, or a cell that suits a job, by planning.

Changes are tried in order of cost to the user: first the program (speed, branch, rotation, lift),
then the process (directions), then the cell. Each change is planned for some of the failed layers.
A change that succeeds is then planned for the whole job. A point budget limits the effort, so that
the same job gets the same answer unless the search exceeds LONGEST_SEARCH.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
import time
from collections.abc import Collection, Iterator, Sequence

import numpy as np

from ..issues import ERROR, NOTE, AmError, Issue, Text, has_errors
from ..kinematics import cell as cells
from ..kinematics.arrangement import arrangement_of
from ..parameters.cell import CellParameters
from ..toolpath import Toolpath
from . import other_cells
from .beads.speeds import share_of_speed
from .external import remedies as external_remedies
from .external.remedies import NOT_LEVEL
from .joint_path import JointPath
from .other_cells import LAYERS, POINTS, Tried, some_of
from .plan import Progress

REMEDY, NO_REMEDY = "REMEDY", "NO_REMEDY"
CHANGES = 16  # approximate number of changes to try
MAX_POINTS_REPLANNED = 20_000  # maximum number of points of a job that is planned again completely
MAX_FULL_PLANS = 3  # maximum number of complete plans
LONGEST_SEARCH = 60.0  # s; maximum wall-clock time of a search
RETRACTS = (50.0, 100.0, 5.0)  # mm
FULL_TURN = (-math.pi, math.pi)


def most_points(toolpath: Toolpath, issues: Sequence[Issue]) -> int:
    """Return the maximum number of points that `remedies` may plan; 0 for a feasible job."""
    if not has_errors(list(issues)):
        return 0
    sampled_count = min(POINTS, CHANGES * some_of(toolpath, _failed(issues)).point_count)
    return sampled_count + (
        MAX_FULL_PLANS * toolpath.point_count if toolpath.point_count <= MAX_POINTS_REPLANNED else 0
    )


class _Late(Exception):
    """The search has exceeded its time limit."""


def remedies(
    job: Tried,
    path: JointPath,
    issues: Sequence[Issue],
    progress: Progress,
    longest: float = LONGEST_SEARCH,
) -> list[Issue]:
    """Search for the first change that makes an infeasible job feasible.

    Parameters
    ----------
    job : Tried
        The infeasible job.
    path : JointPath
        Joint path of the job.
    issues : sequence of Issue
        Issues of the job.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.
    longest : float, optional
        Maximum wall-clock time of the search, s.

    Returns
    -------
    list of Issue
        A note with the successful change, or with all failed changes; empty for a feasible job.
    """
    if not has_errors(list(issues)):
        return []
    until = time.monotonic() + longest
    attempts: list[str] = []

    def in_time(share: float, text: str) -> None:
        progress(share, text)
        if time.monotonic() > until:
            raise _Late

    try:
        return _searched(job, path, issues, in_time, attempts)
    except _Late:
        tried_text = Text.joined("; ", attempts[:-1]) if len(attempts) > 1 else Text("none")
        return [
            Issue(
                NOTE,
                NO_REMEDY,
                Text(
                    "the search for a feasible job stopped after {:.0f} s; tried without "
                    "success: {}",
                    longest,
                    tried_text,
                ),
            )
        ]


def _searched(
    job: Tried,
    path: JointPath,
    issues: Sequence[Issue],
    progress: Progress,
    attempts: list[str],
) -> list[Issue]:
    """Return the note on the remedy, and append each attempted change to `attempts`."""
    failed = _failed(issues)
    points, full_plans_left = POINTS, MAX_FULL_PLANS
    for change in _changes(job, path, issues):
        progress(1.0, Text("searching for a feasible change: {}", change.remedy))
        try:
            toolpath = change.toolpath()
            sampled = some_of(toolpath, failed)
            points -= sampled.point_count
            if points < 0:
                break
            attempts.append(change.remedy)
            if has_errors(change.issues(sampled, False, progress)):
                continue
            if toolpath.point_count > MAX_POINTS_REPLANNED:
                count = len(sampled.layers)
                return [
                    Issue(
                        NOTE,
                        REMEDY,
                        Text(
                            "with {} the {} affected layers planned again are feasible; the "
                            "whole job was not tested",
                            change.remedy,
                            count,
                        ),
                    )
                ]
            full_plans_left -= 1
            if not has_errors(change.issues(toolpath, True, progress)):
                return [
                    Issue(
                        NOTE,
                        REMEDY,
                        Text("the job is feasible with {}; tested, not applied", change.remedy),
                    )
                ]
            if not full_plans_left:
                break
        except AmError:  # an invalid job is not a remedy
            continue
    if not attempts:
        return []
    return [
        Issue(
            NOTE,
            NO_REMEDY,
            Text(
                "no tested change makes the job feasible: {}",
                Text.joined("; ", attempts),
            ),
        )
    ]


def _failed(issues: Sequence[Issue]) -> list[int]:
    """Return the layers with errors."""
    return sorted(
        {issue.layer for issue in issues if issue.level == ERROR and issue.layer is not None}
    )


def _changes(job: Tried, path: JointPath, issues: Sequence[Issue]) -> Iterator[Tried]:
    codes = {issue.code for issue in issues if issue.level == ERROR}
    free = arrangement_of(job.settings.setup).free > 0
    if free:
        yield from other_cells.clear_of_arm(job, codes)
    usual = CellParameters()
    left_out = (
        job.settings.deposition_point == usual.deposition_point
        and job.settings.machine != usual.machine
    )
    if left_out and free:
        yield from other_cells.points(job)
    if "SPEED" in codes and job.process.bead_model == "none":
        yield from _slower(job, path)
    if all(code.startswith("RAPID") for code in codes):
        yield from _retracts(job)
    if free and codes != {external_remedies.NOT_LEVEL}:  # tool rotation does not affect this error
        yield from other_cells.branches(job)
        yield from _rotations(job)
    if job.fixed is not None:
        fixed = dataclasses.replace(job, toolpath=job.fixed.make, remedy=job.fixed.remedy)
        yield fixed
        if free and job.settings.branch != "auto":
            yield other_cells.change_cell(
                fixed, Text("{} and `cell.branch: auto`", fixed.remedy), branch="auto"
            )
    if not left_out and free:
        yield from other_cells.points(job)
    yield from other_cells.external_axes(job, codes)


def _slower(job: Tried, path: JointPath) -> Iterator[Tried]:
    """Yield the job at the maximum speed that all axes allow.

    Features with their own travel speed keep it.
    """
    toolpath = job.toolpath()
    cell = cells.resolve(job.settings, toolpath.frame, toolpath.family, job.folders)
    speed = job.process.travel_speed * share_of_speed(cell, path.beads)
    if not 0.0 < speed < job.process.travel_speed:
        return
    step = 10.0 ** (math.floor(math.log10(0.99 * speed)) - 1)
    speed = math.floor(0.99 * speed / step) * step  # two significant digits
    share = speed / job.process.travel_speed
    layers = []
    for layer in toolpath.layers:
        if job.own_speed and job.own_speed[layer.feature]:
            layers.append(layer)
            continue
        beads = [dataclasses.replace(bead, speed=share * bead.speed) for bead in layer.beads]
        layers.append(dataclasses.replace(layer, beads=tuple(beads)))
    slower = dataclasses.replace(toolpath, layers=tuple(layers))
    process = dataclasses.replace(job.process, travel_speed=speed)
    yield dataclasses.replace(
        job,
        toolpath=lambda: slower,
        process=process,
        remedy=f"`process.travel_speed: {speed:g} mm/s`",
    )


def _retracts(job: Tried) -> Iterator[Tried]:
    for retract in RETRACTS:
        between = dataclasses.replace(job.process.between_layers, lift=retract)
        if between != job.process.between_layers:
            process = dataclasses.replace(job.process, between_layers=between)
            yield dataclasses.replace(
                job, process=process, remedy=f"`process.between_layers.lift: {retract:g} mm`"
            )


def _rotations(job: Tried) -> Iterator[Tried]:
    """Yield the job with a larger range of tool rotation, or with a rotation per layer."""
    low, high = job.joints.rotation_range
    if high - low < FULL_TURN[1] - FULL_TURN[0] - 1e-9:
        free = dataclasses.replace(job.joints, rotation_range=FULL_TURN)
        yield dataclasses.replace(
            job, joints=free, remedy="`joints.rotation_range: [-180 deg, 180 deg]`"
        )
    if job.joints.method == "constant":
        layers = dataclasses.replace(job.joints, method="layer-by-layer")
        yield dataclasses.replace(job, joints=layers, remedy="`joints.method: layer-by-layer`")


# ---- A cell that suits a job: the current cell if it is feasible; otherwise another branch or
# another position, or a positioner if the torch would tilt too far


def suited(job: Tried, progress: Progress, failed_layers: Collection[int] = ()) -> CellParameters:
    """Return the first cell in which sampled layers of a job are feasible.

    These are the first, middle and last layer, the layer with the maximum tilt, and
    `failed_layers`.

    Parameters
    ----------
    job : Tried
        The job.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.
    failed_layers : iterable of int, optional
        Layers that failed in the plan of the whole job.

    Returns
    -------
    CellParameters
        The current cell if it is feasible or if no other cell is.

    Raises
    ------
    AmError
        If reading the toolpath or resolving the cell fails.
    """
    toolpath = job.toolpath()
    sample = _layers(toolpath, failed_layers)
    points_left, until = POINTS, time.monotonic() + LONGEST_SEARCH
    errors = _errors(job, sample, progress)
    if not errors or not arrangement_of(job.settings.setup).free:
        return job.settings
    for change in _cell_changes(job, errors):
        points_left -= sample.point_count
        if points_left < 0 or time.monotonic() > until:
            break
        progress(1.0, Text("searching for a suitable cell: {}", change.remedy))
        try:
            if not _errors(change, sample, progress):
                return change.settings
        except AmError:  # skip an invalid cell
            continue
    return job.settings


def _cell_changes(job: Tried, errors: set[str]) -> Iterator[Tried]:
    if NOT_LEVEL in errors:  # neither a tool rotation nor another fixed position helps
        return other_cells.external_axes(job, {NOT_LEVEL})
    return itertools.chain(
        other_cells.clear_of_arm(job, errors),
        other_cells.branches(job),
        other_cells.points(job),
        other_cells.external_axes(job, errors),
    )


def _errors(job: Tried, toolpath: Toolpath, progress: Progress) -> set[str]:
    return {issue.code for issue in job.issues(toolpath, False, progress) if issue.level == ERROR}


def _layers(toolpath: Toolpath, failed: Collection[int]) -> Toolpath:
    """Return the toolpath with sampled layers, including the layer with the maximum tilt from the
    part axis and the failed layers.
    """
    upright = [
        min((float((bead.tool @ toolpath.frame[:3, 2]).min()) for bead in layer.beads), default=1.0)
        for layer in toolpath.layers
    ]
    layer_ids = {round(index) for index in np.linspace(0, len(upright) - 1, LAYERS)}
    layer_ids |= {int(np.argmin(upright)), *(k for k in failed if 0 <= k < len(upright))}
    return dataclasses.replace(
        toolpath, layers=tuple(toolpath.layers[k] for k in sorted(layer_ids))
    )
