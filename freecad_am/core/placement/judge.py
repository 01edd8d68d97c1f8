# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rate a job with its part at one pose by planning a sample of its beads.

Results come from plans, not from estimates. The sampled beads are planned like the whole job,
including rapids between consecutive beads. Beads outside the sample may be worse.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..collision.bead_ends import LINK_GRAIN, Beads
from ..geometry.cylinders import Cylinder
from ..geometry.frames import TURN
from ..issues import ERROR, AmError, Issue
from ..kinematics.cell import Cell
from ..kinematics.inverse import spherical_wrist
from ..kinematics.links.contact import ArmContact, min_distance
from ..motion import Motion
from ..parameters.cell import CellParameters
from ..parameters.joints import OF_CELL, JointParameters
from ..parameters.process import ProcessParameters
from ..planning.external.level import levelled
from ..planning.joint_path import JointPath
from ..planning.motion import assemble
from ..planning.plan import Progress, plan_joints
from ..planning.points import Points
from ..planning.sample_of_beads import Sampled, sample_toolpath
from ..planning.task import MIN_MARGIN, Task
from ..toolpath import Bead, Toolpath
from ..types import Array, Mask

TURNS = 72  # tested rotations about the tool axis
FINER = 9  # refinement of that step near the best rotation of a point that no rotation serves
BRANCHES = 8


class Screened(NamedTuple):
    """Result of a screening.

    share: maximum fraction of points over the tested configurations. A point counts if some tool
    rotation keeps it within limits and away from singularities. branch: that configuration.
    """

    share: float
    branch: int


def single_points(beads: Sequence[Bead], cell: Cell) -> Points:
    """Return the points of beads, each point as a separate bead."""
    position, tool, parameter = (
        np.concatenate([getattr(bead, name) for bead in beads])
        for name in ("points", "tool", "parameter")
    )
    external = None
    if cell.external is not None:
        external = np.concatenate([bead.external for bead in beads if bead.external is not None])
    numbers, sliding = np.arange(len(position)), cell.machine.chain.sliding
    return Points(
        position,
        tool,
        parameter,
        numbers,
        numbers,
        np.zeros(len(numbers), dtype=bool),
        cell.pose_frames(position, tool, external),
        external,
        sliding if sliding.any() else None,
    )


def screen_points(
    cell: Cell, points: Points, parameters: JointParameters, only_branch: int | None
) -> Screened:
    """Return the fraction of points that a robot can serve.

    Parameters
    ----------
    cell : Cell
        The cell with a robot.
    points : Points
        Independent points.
    parameters : JointParameters
        Thresholds and rotation range.
    only_branch : int or None
        Configuration to test; None to test all and return the best.

    Returns
    -------
    Screened
        Fraction and configuration.
    """
    results = [
        Screened(float(_find_served(Task(cell, branch, parameters), points).mean()), branch)
        for branch in (range(BRANCHES) if only_branch is None else (only_branch,))
    ]
    return max(results, key=lambda result: result.share)


def _find_served(task: Task, points: Points) -> Mask:
    """Return which points (C,) at least one tool rotation serves."""
    low, high = task.parameters.rotation_range
    is_full_turn = high - low >= TURN - 1e-9
    values = np.linspace(low, high, TURNS, endpoint=not is_full_turn)
    phi = np.broadcast_to(values[:, None], (TURNS, len(points)))
    served, margin = _serves(task, points, phi)
    remaining = np.flatnonzero(~served & np.isfinite(margin).any(axis=0))
    if len(remaining):
        step = values[1] - values[0]
        best = (
            values[margin[:, remaining].argmax(axis=0)]
            + step * np.linspace(-1.0, 1.0, 2 * FINER + 1)[:, None]
        )
        served[remaining] = _serves(
            task,
            points.select_points(remaining),
            best if is_full_turn else np.clip(best, low, high),
        )[0]
    return served


def _serves(task: Task, points: Points, phi: Array) -> tuple[Mask, Array]:
    """Return which points (C,) a rotation of `phi` (R, C) serves, and the limit margins (R, C)."""
    joints = task.joints(points, phi)
    margin = task.rows.margin(joints)
    threshold = task.thresholds(points)
    served = np.zeros(len(points), dtype=bool)
    # try the rotation with the maximum margin first: it serves most points, and the condition
    # number is the slowest check
    is_best = np.zeros(phi.shape, dtype=bool)
    is_best[margin.argmax(axis=0), np.arange(len(points))] = True
    for selected in (is_best, ~is_best):
        row, column = np.nonzero(selected & (margin >= MIN_MARGIN) & ~served)
        if len(row):
            flange = points.frames.of(column).flange_poses(phi[row, column])
            sufficient = task.condition_at(flange, joints[row, column]) >= threshold[column]
            served[column[sufficient]] = True
    return served, margin


Cylinders = tuple[tuple[Cylinder, ...], ...]

BEADS_IN_SEQUENCE = 2  # consecutive beads per sample, so that the plan includes rapids
REACH = 200.0  # mm; maximum arm clearance that is measured
UNREACHED = "NO_ROTATION"


@dataclass(frozen=True)
class Job:
    """The job to place.

    cell: resolves cell parameters to a cell with its obstacles, or raises AmError. cylinders:
    returns the cylinders around the robot links of a cell.
    """

    toolpath: Toolpath
    cell: Callable[[CellParameters], Cell]
    cylinders: Callable[[Cell], Cylinders]
    process: ProcessParameters
    joints: JointParameters


@dataclass(frozen=True)
class Judged:
    """The rating of a pose.

    share: fraction of the sampled points that the machine serves. code: of the first error, '' if
    the pose is feasible. margin: minimum distance from a joint limit, 0 at a limit and 1 at
    mid-range. time: of the whole job, s. clearance: minimum distance at bead points between the arm
    and all other bodies, mm, at most REACH. These three are NaN without a plan; five-axis machines
    also have no clearance. branch: the planned configuration. message: of the first error.
    """

    share: float
    code: str
    margin: float = np.nan
    time: float = np.nan
    clearance: float = np.nan
    branch: tuple[str, ...] = ()
    message: str = ""

    @property
    def feasible(self) -> bool:
        """Whether the sampled points have a plan without errors."""
        return not self.code


@dataclass(frozen=True)
class Judge:
    """Rates poses of a job with a sample of about `most` points; None for all points."""

    job: Job
    most: int | None
    _some: Sampled = field(init=False, repr=False)
    _deposit: Beads = field(init=False, repr=False)

    def __post_init__(self) -> None:
        toolpath = self.job.toolpath
        joints = dataclasses.replace(self.job.joints, compare=(), certificate=False)
        object.__setattr__(self, "job", dataclasses.replace(self.job, joints=joints))
        max_points = toolpath.point_count if self.most is None else self.most
        object.__setattr__(self, "_some", sample_toolpath(toolpath, max_points, BEADS_IN_SEQUENCE))
        width = toolpath.bead_width or toolpath.layer_height
        object.__setattr__(
            self,
            "_deposit",
            Beads.of([bead for _, _, bead in toolpath], width, toolpath.layer_height),
        )

    @property
    def points(self) -> int:
        """Number of sampled points."""
        return self._some.toolpath.point_count

    def evaluate(
        self, settings: CellParameters, progress: Progress = lambda share, text: None
    ) -> Judged:
        """Plan the job in a cell and return its rating. `progress` may raise to cancel."""
        job, sampled_toolpath = self.job, self._some.toolpath
        try:
            cell = job.cell(settings)
            share = self._share(cell) if cell.machine.free else 1.0
            if share is not None and share < 1.0 and not _several_alike(cell):
                return Judged(
                    share,
                    UNREACHED,
                    message="some points are infeasible at every rotation about the tool axis",
                )
            cylinders = job.cylinders(cell)
            path = plan_joints(
                sampled_toolpath,
                cell,
                dataclasses.replace(job.joints, given=self._some.select_given(job.joints.given)),
                progress,
                () if cell.arm_clearance is None else cylinders,
            )
            motion, rapids = assemble(
                path,
                cell,
                job.process,
                sampled_toolpath.surroundings,
                job.joints,
                sampled_toolpath.layer_height,
                () if cell.arm_clearance is None else cylinders,
            )
        except AmError as error:
            return Judged(0.0, error.code, message=error.message)
        return self._figures(cell, path, motion, [*path.issues, *rapids], cylinders)

    def _share(self, cell: Cell) -> float | None:
        """Return the fraction of points that the robot serves; None on a track, which decides where
        the robot stands.
        """
        sampled_toolpath, job = self._some.toolpath, self.job
        if cell.external is not None and cell.external.slides is not None:
            return None
        beads = (
            levelled(cell, sampled_toolpath)[0]
            if cell.external
            else [bead for _, _, bead in sampled_toolpath]
        )
        branch_name = job.joints.own_branch
        branch = (
            cell.branch
            if branch_name == OF_CELL
            else spherical_wrist.branch_index(branch_name.split("-"))
        )
        return screen_points(cell, single_points(beads, cell), job.joints, branch).share

    def _figures(
        self, cell: Cell, path: JointPath, motion: Motion, issues: list[Issue], cylinders: Cylinders
    ) -> Judged:
        wrong = next((issue for issue in issues if issue.level == ERROR), None)
        joints = path.joints
        limit_shares = cell.limits.smallest_share(joints)
        served = float(np.mean(np.nan_to_num(limit_shares, nan=-1.0) >= 0.0))
        if (
            wrong is not None
            and wrong.code in ("UNREACHABLE", "LIMIT")
            and not np.isfinite(joints).all()
        ):
            return Judged(served, wrong.code, branch=path.branch, message=wrong.message)
        return Judged(
            served,
            "" if wrong is None else wrong.code,
            float(np.nanmin(limit_shares)),
            self._time(path, motion),
            self._clearance(cell, path, cylinders),
            path.branch,
            "" if wrong is None else wrong.message,
        )

    def _clearance(self, cell: Cell, path: JointPath, cylinders: Cylinders) -> float:
        """Return the minimum distance of the arm from other bodies at the bead points, mm.

        The deposit counts as far as printed at each point.
        """
        if not cylinders:
            return np.nan
        toolpath = self.job.toolpath
        contact = ArmContact(
            cell, cylinders, toolpath.surroundings, self._deposit.solid(LINK_GRAIN)
        )
        counts = np.cumsum([0, *(len(bead) for _, _, bead in toolpath)])
        deposited_by_bead = {
            (layer, index): int(n) for (layer, index, _), n in zip(toolpath, counts, strict=False)
        }
        original_ids = {
            (layer, index): original
            for (layer, index, _), original in zip(
                self._some.toolpath, self._some.places, strict=True
            )
        }
        moment = [
            deposited_by_bead.get(
                original_ids.get((path_of_bead.layer, path_of_bead.index), (path_of_bead.layer, 0)),
                deposited_by_bead[path_of_bead.layer, 0],
            )
            for path_of_bead in path.beads
        ]
        when = np.repeat(moment, [len(path_of_bead.joints) for path_of_bead in path.beads])
        return min_distance(contact, path.joints, when, REACH)

    def _time(self, path: JointPath, motion: Motion) -> float:
        """Estimate the time of the whole job, s.

        It sums the deposit time at the reduced speeds of this plan, the rapids, lead times and
        waits. Rapids are extrapolated from those between consecutive beads of this plan.
        """
        all_beads, process = [bead for _, _, bead in self.job.toolpath], self.job.process
        requested = sum(_lasts(bead) for _, _, bead in self._some.toolpath)
        run = sum(_lasts(bead_path.bead) for bead_path in path.beads)
        deposit = sum(_lasts(bead) for bead in all_beads) * run / max(requested, 1e-9)
        waits = len(all_beads) * (process.lead_on + process.lead_off)
        waits += sum(
            max(layer.wait, process.between_layers.wait) for layer in self.job.toolpath.layers[1:]
        )
        return float(deposit + waits + self._rapids(motion, len(all_beads)))

    def _rapids(self, motion: Motion, beads: int) -> float:
        """Estimate the time of all rapids between `beads` beads, including the first approach and
        the last retract, s.
        """
        steps, starts = np.nan_to_num(motion.duration), motion.deposit & (motion.point == 0)
        number = np.cumsum(
            np.append(False, starts[:-1])
        )  # index of the bead that a row leads to or belongs to
        of_bead = np.bincount(
            number[~motion.deposit], steps[~motion.deposit], int(starts.sum()) + 1
        )
        arrival = of_bead[0]
        departure = of_bead[int(starts.sum())]
        between = of_bead[1 : int(starts.sum())]
        if not len(between):
            return float(arrival + departure)
        number_of = {
            number_of: k
            for k, number_of in enumerate((layer, index) for layer, index, _ in self.job.toolpath)
        }
        numbers = np.array([number_of[bead_id] for bead_id in self._some.places])
        follows = np.diff(numbers) == 1
        samples = between[follows] if len(follows) == len(between) and follows.any() else between
        return float(arrival + departure + (beads - 1) * samples.mean())


def _several_alike(cell: Cell) -> bool:
    """Whether several solutions share a configuration name; screening finds only one of them."""
    arm = cell.machine.arm if cell.external is None else cell.robot.arm
    return arm is not None and arm.followed


def _lasts(bead: Bead) -> float:
    """Return the deposit time of a bead at its speeds, s."""
    return float((np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum())
