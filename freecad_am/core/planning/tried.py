# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job planned with a change: what of it is planned, in which cell, and what is wrong with it then."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..geometry.obstacles import Body
from ..issues import Issue, has_errors
from ..kinematics import cell as cells
from ..kinematics.links.external_links import ExternalLink, external_links
from ..kinematics.torch import Torch
from ..parameters.cell import CellParameters
from ..parameters.joints import JointParameters
from ..parameters.process import ProcessParameters
from ..toolpath import Toolpath
from .arm.kept import Cylinders
from .joint_path import JointPath
from .motion import assemble
from .plan import Progress, plan_joints

LAYERS = 3  # of a job, planned anew with each change
POINTS = 12_000  # planned so in all


# the findings about a joint path, maybe of some layers alone, in a cell, with all layers of its toolpath there
Look = Callable[[JointPath, cells.Cell, Toolpath], Sequence[Issue]]


class Fixed(NamedTuple):
    """A toolpath with fixed build directions where they were not: the keys that say so, and what makes it."""

    remedy: str
    make: Callable[[], Toolpath]


@dataclass(frozen=True)
class Tried:
    """A job to plan: that which is infeasible, or it with a change, told as keys of a job file. fixed: the toolpath with the
    build direction of the part's axis; None where it has it, or cannot. own_speed: of several features, whether each has a
    travel speed of its own. external_links: links of its positioner and track as they were read. look: what finds the collisions of
    arm and platform; None where nobody looks."""

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
    look: Look | None = None

    def cell(self, toolpath: Toolpath) -> cells.Cell:
        """The cell of a toolpath of it."""
        found = cells.resolve(self.settings, toolpath.frame, toolpath.family, self.folders)
        adjacent = external_links(found.external, known_links=self.external_links)
        return dataclasses.replace(
            found, obstacles=self.obstacles, torch=self.torch, external_links=adjacent
        )

    def issues(self, toolpath: Toolpath, whole: bool, progress: Progress) -> tuple[Issue, ...]:
        """What is wrong with it; rapids only of a whole one."""
        cell = self.cell(toolpath)
        joints = dataclasses.replace(self.joints, compare=())
        path = plan_joints(toolpath, cell, joints, progress, self.cylinders)
        found = (*toolpath.issues, *path.issues)
        if whole and not has_errors(found):
            height = toolpath.layer_height
            _, rapids = assemble(
                path, cell, self.process, toolpath.surroundings, joints, height, self.cylinders
            )
            found += rapids
        if self.look is not None and not has_errors(found):
            found += tuple(self.look(path, cell, self.toolpath()))
        return found


def some_of(toolpath: Toolpath, failed: Sequence[int]) -> Toolpath:
    """The toolpath with LAYERS of its layers at most, of those that failed, or of all."""
    known = [k for k in failed if k < len(toolpath.layers)] or list(range(len(toolpath.layers)))
    chosen = sorted({known[round(at)] for at in np.linspace(0, len(known) - 1, LAYERS)})
    return dataclasses.replace(toolpath, layers=tuple(toolpath.layers[k] for k in chosen))
