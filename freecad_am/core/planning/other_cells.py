# SPDX-License-Identifier: LGPL-2.1-or-later
"""Propose other cells for a job: another branch, another part position, external axes.

The most likely change comes first. Each change is given as keys of a job file.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..geometry import frames
from ..issues import Issue, Text, has_errors
from ..kinematics import cell as cells
from ..kinematics import proposed_cell
from ..kinematics.arrangement import arrangement_of
from ..kinematics.inverse import spherical_wrist
from ..kinematics.links.external_links import external_links
from ..parameters.cell import CellParameters
from ..parameters.joints import OF_CELL, JointParameters
from ..parameters.process import ProcessParameters
from ..parameters.records import Pose
from ..toolpath import Toolpath
from .arm_clearance import Cylinders
from .external import remedies as external_remedies
from .external.level import levelled
from .joint_path import JointPath
from .motion import assemble
from .plan import Progress, best_branches, plan_joints

LAYERS = 3  # number of layers to plan with each change
POINTS = 12_000  # maximum total number of points in the plans of all changes


# returns the issues of a joint path in a cell; the path may cover only some layers
Look = Callable[[JointPath, cells.Cell, Toolpath], Sequence[Issue]]


class Fixed(NamedTuple):
    """A change to fixed build directions: its job keys and a function that returns its toolpath."""

    remedy: str
    make: Callable[[], Toolpath]


@dataclass(frozen=True)
class Tried:
    """A job to plan: the infeasible job, or this job with a change.

    remedy: the change as keys of a job file. fixed: change to the part axis as build direction;
    None if the toolpath already has this direction or cannot have it. own_speed: for several
    features, whether each one has its own travel speed. shapes: shapes of the cell, as loaded.
    look: finds collisions of arm and platform; None to skip this check.
    """

    toolpath: Callable[[], Toolpath]
    settings: CellParameters
    folders: tuple[str, ...]
    process: ProcessParameters
    joints: JointParameters
    fixed: Fixed | None = None
    remedy: str = field(default="")
    own_speed: tuple[bool, ...] = ()
    cylinders: Cylinders = ()
    shapes: cells.CellShapes = cells.CellShapes()
    look: Look | None = None

    def cell(self, toolpath: Toolpath) -> cells.Cell:
        """Return the cell for a toolpath of this job."""
        found = cells.resolve(self.settings, toolpath.frame, toolpath.family, self.folders)
        links = external_links(found.external, known_links=self.shapes.external_links)
        shapes = dataclasses.replace(self.shapes, external_links=links)
        return dataclasses.replace(found, shapes=shapes)

    def issues(self, toolpath: Toolpath, whole: bool, progress: Progress) -> tuple[Issue, ...]:
        """Plan the job and return its issues.

        Parameters
        ----------
        toolpath : Toolpath
            The toolpath to plan; may have only some layers.
        whole : bool
            Whether to check rapids; set for a complete toolpath.
        progress : callable
            Called with the completed fraction and a text; may raise to cancel.

        Returns
        -------
        tuple of Issue
            Issues of toolpath and joint path. If these have no errors, also issues of rapids
            and collisions.
        """
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
    """Return the toolpath with at most LAYERS layers, chosen from the failed layers or from all."""
    known = [k for k in failed if k < len(toolpath.layers)] or list(range(len(toolpath.layers)))
    chosen = sorted({known[round(at)] for at in np.linspace(0, len(known) - 1, LAYERS)})
    return dataclasses.replace(toolpath, layers=tuple(toolpath.layers[k] for k in chosen))


COLLISIONS = frozenset({"ARM_COLLISION", "PLATFORM_COLLISION", "ARM_CLEARANCE"})
CLEARANCE = 5.0  # mm; arm clearance to try
BELOW = 0.5  # mm; bodies that extend further below the platform plane collide with the platform
SHIFTS = (
    (0.0, -150.0),
    (0.0, 150.0),
    (-150.0, 0.0),
    (150.0, 0.0),
)  # shifts of the deposition point: away from the robot, and up, mm


def change_cell(job: Tried, remedy: str, **values: object) -> Tried:
    """Return the job with changed cell parameters."""
    settings = dataclasses.replace(job.settings, **values)  # type: ignore[arg-type]
    return dataclasses.replace(job, settings=settings, remedy=remedy)


def clear_of_arm(job: Tried, codes: set[str]) -> Iterator[Tried]:
    """Yield changes that may clear arm and platform of part and substrate.

    These are a clamp below part and substrate, a plan with arm clearance, and both.
    """
    if codes.isdisjoint(COLLISIONS):
        return
    clamped = held_by_clamp(job)
    if clamped is not None:
        yield clamped
    for candidate in (job, clamped):
        if candidate is not None and candidate.settings.arm_clearance is None:
            remedy = Text("`cell.arm_clearance: {:g} mm`", CLEARANCE)
            if candidate is clamped:
                remedy = Text("{} and `cell.arm_clearance: {:g} mm`", candidate.remedy, CLEARANCE)
            yield change_cell(candidate, remedy, arm_clearance=CLEARANCE)
    if clamped is not None and job.settings.branch != "auto":
        yield change_cell(
            clamped, Text("{} and `cell.branch: auto`", clamped.remedy), branch="auto"
        )


def held_by_clamp(job: Tried) -> Tried | None:
    """Return the job without a platform plate, with part and substrate centred above the platform.

    This corresponds to a clamped pipe. None if nothing extends below the platform.
    """
    toolpath, settings = job.toolpath(), job.settings
    cell = job.cell(toolpath)
    if cell.poses.offset is not None:
        return None
    to_platform = frames.inverse(cell.poses.mount)
    points = [bead.points for _, _, bead in toolpath]
    points += [body.vertices for body in toolpath.surroundings]
    local = np.vstack(points) @ to_platform[:3, :3].T + to_platform[:3, 3]
    low, high = local.min(axis=0), local.max(axis=0)
    if low[2] > -BELOW:
        return None
    shift = [*np.round(-0.5 * (low[:2] + high[:2]), 1), math.ceil(-low[2])]
    on_point = not (arrangement_of(settings.setup).carries_part or settings.external)
    pose = settings.deposition_point if on_point else settings.platform
    old_pose = (0.0, 0.0, pose, 0.0, 0.0, 0.0) if isinstance(pose, (int, float)) else pose
    x, y, z = (frames.bryant(old_pose) @ np.array([*shift, 1.0]))[:3].round(3).tolist()
    new_pose = (x + 0.0, y + 0.0, z, *old_pose[3:])
    values = {"deposition_point" if on_point else "platform": new_pose, "platform_diameter": 0.0}
    remedy = Text(
        "{} and `cell.platform_diameter: 0`",
        _format_pose(new_pose, "cell.deposition_point" if on_point else "cell.platform"),
    )
    return change_cell(job, remedy, **values)


def branches(job: Tried) -> Iterator[Tried]:
    """Yield the other branches that `best_branches` proposes."""
    if job.settings.branch == "auto" or job.joints.own_branch != OF_CELL:
        return
    toolpath = job.toolpath()
    cell = cells.resolve(
        dataclasses.replace(job.settings, branch="auto"),
        toolpath.frame,
        toolpath.family,
        job.folders,
    )
    beads = levelled(cell, toolpath)[0] if cell.external else [bead for _, _, bead in toolpath]
    for branch in best_branches(beads, cell, job.joints, not toolpath.traits.has_axis):
        words = spherical_wrist.branch_name(branch)
        if words != job.settings.branch:
            yield change_cell(job, f"`cell.branch: [{', '.join(words)}]`", branch=words)


def points(job: Tried) -> Iterator[Tried]:
    """Yield other positions of the deposition point or the fixed platform.

    The first one leaves the machine the most range. Positions near the current one follow.
    """
    if job.settings.external:  # the platform is on the positioner
        return
    best = proposed_cell.proposed(job.settings, job.folders)
    if best.deposition_point != job.settings.deposition_point:
        words = best.branch if isinstance(best.branch, str) else f"[{', '.join(best.branch)}]"
        yield change_cell(
            job,
            Text("{} and `cell.branch: {}`", _format_pose(best.deposition_point), words),
            deposition_point=best.deposition_point,
            branch=best.branch,
        )
    for point in (
        _before(job)
        if not arrangement_of(job.settings.setup).carries_part
        else _adjacent(job.settings.deposition_point)
    ):
        yield change_cell(
            job,
            Text("{} and `cell.branch: auto`", _format_pose(point)),
            deposition_point=point,
            branch="auto",
        )


def external_axes(job: Tried, codes: set[str]) -> Iterator[Tried]:
    """Yield other positioner positions, or external axes for a robot without external axes."""
    for remedy, settings in external_remedies.move_positioner(job.settings, job.folders):
        yield dataclasses.replace(job, settings=settings, remedy=remedy)
    toolpath = job.toolpath()
    mass = external_remedies.weight(toolpath, job.process)
    for remedy, settings in external_remedies.added(
        job.settings, job.folders, toolpath, codes, mass
    ):
        yield dataclasses.replace(job, settings=settings, remedy=remedy)


def _adjacent(point: Pose) -> list[Pose]:
    x, y, *height_and_angles = point
    ahead = math.hypot(x, y) or 1.0
    return [
        (
            round(x + out * x / ahead, 3),
            round(y + out * y / ahead, 3),
            round(height_and_angles[0] + up, 3),
            height_and_angles[1],
            height_and_angles[2],
            height_and_angles[3],
        )
        for out, up in SHIFTS
    ]


def _before(job: Tried) -> list[Pose]:
    """Return level platform positions in front of a robot that holds the tool."""
    cell = cells.resolve(job.settings, np.eye(4), folders=job.folders)
    arm = cell.machine.arm
    if arm is None:
        return []
    shoulder, height = arm.shoulder
    return [
        (
            float(round(shoulder + ahead * arm.reach)),
            0.0,
            float(round(height + above * arm.reach)),
            0.0,
            0.0,
            0.0,
        )
        for ahead, above in ((0.6, -0.3), (0.6, -0.5), (0.75, -0.3), (0.5, -0.2))
    ]


def _format_pose(point: Pose, key: str = "cell.deposition_point") -> str:
    angles = [math.degrees(angle) for angle in point[3:]]
    numbers = ", ".join(f"{value + 0.0:.10g}" for value in (*point[:3], *angles))
    return f"`{key}: [{numbers}]`"
