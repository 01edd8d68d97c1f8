# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell in which the job of a toolpath in a document can be done."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from ...core.kinematics.arrangement import arrangement_of
from ...core.parameters.cell import CellParameters
from ...core.parameters.joints import JointParameters
from ...core.parameters.process import ProcessParameters
from ...core.planning.suited import suited
from ...core.planning.tried import Tried
from .. import user_machines
from ..checks.collisions import look
from ..checks.links_clear import cylinders_of
from ..shapes import cell_obstacles
from ..work import progress


def suit_to_toolpath(
    toolpath: Any, failed_layers: Collection[int] = ()
) -> Callable[[CellParameters], CellParameters]:
    """A function that finds, without the document, the parameters of a cell that suits the job of a
    toolpath object: the given ones, or ones with another branch, position, or a positioner.
    failed_layers: indices of layers that could not be planned in the cell found before. It raises
    what resolving a cell raises.
    """
    read_toolpath, folders = toolpath.Proxy.reader(toolpath), tuple(user_machines.folders())
    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)

    def of(settings: CellParameters) -> CellParameters:
        planned = read_toolpath()
        if not arrangement_of(settings.setup).planned:
            return settings
        cell = cell_obstacles.resolved(settings, planned, folders)
        job = Tried(
            lambda: planned,
            settings,
            folders,
            process,
            JointParameters(),
            obstacles=cell.obstacles,
            torch=cell.torch,
            external_links=cell.external_links,
            cylinders=cylinders_of(cell),
            look=look,
        )
        return suited(job, progress.report, failed_layers)

    return of
