# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell that suits a job before it is planned: as it is where the job can be done in it, else another branch, another
place, or a positioner under a part on which the torch would lean more than it may."""

from __future__ import annotations

import dataclasses
import itertools
import time
from collections.abc import Collection, Iterator

import numpy as np

from ..issues import ERROR, AmError, Text
from ..kinematics.arrangement import arrangement_of
from ..parameters.cell import CellParameters
from ..toolpath import Toolpath
from . import other_cells
from .external.remedies import NOT_LEVEL
from .other_cells import LAYERS, POINTS, Tried
from .plan import Progress
from .remedies import LONGEST_SEARCH


def suited(job: Tried, progress: Progress, failed_layers: Collection[int] = ()) -> CellParameters:
    """Return the parameters of the first cell in which some layers of a job can be done, the current ones
    first; the current ones without such a cell.

    The layers are the first, the middle and the last one, the one that leans most, and
    `failed_layers`, which failed in the plan of the complete job. progress may raise to cancel.
    Raises the errors of reading the toolpath and resolving the cell.
    """
    toolpath = job.toolpath()
    sample = _layers(toolpath, failed_layers)
    points_left, until = POINTS, time.monotonic() + LONGEST_SEARCH
    errors = _errors(job, sample, progress)
    if not errors or not arrangement_of(job.settings.setup).free:
        return job.settings
    for change in _changes(job, errors):
        points_left -= sample.point_count
        if points_left < 0 or time.monotonic() > until:
            break
        progress(1.0, Text("searching for a suitable cell: {}", change.remedy))
        try:
            if not _errors(change, sample, progress):
                return change.settings
        except AmError:  # what cannot be asked for is no cell
            continue
    return job.settings


def _changes(job: Tried, errors: set[str]) -> Iterator[Tried]:
    if (
        NOT_LEVEL in errors
    ):  # which neither a rotation about the tool nor another fixed position remedies
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
    """Return some of its layers, including the one that leans most from the part's axis and the failed
    ones.
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
