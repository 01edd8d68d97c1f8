# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job with its part at one pose: what planning some of its points makes of it.

Nothing is estimated that can be planned: the beads that are looked at are planned as the whole job is, rapids between those
that follow each other too. What they tell of the whole is coarse: beads that are left out may be worse.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..collision.bead_ends import LINK_GRAIN, Beads
from ..geometry.cylinders import Cylinder
from ..issues import ERROR, AmError, Issue
from ..kinematics.cell import Cell
from ..kinematics.inverse import opw
from ..kinematics.links.contact import ArmContact
from ..kinematics.links.distance import min_distance
from ..motion import Motion
from ..parameters.cell import CellParameters
from ..parameters.joints import OF_CELL, JointParameters
from ..parameters.process import ProcessParameters
from ..planning.external.level import levelled
from ..planning.joint_path import JointPath
from ..planning.motion import assemble
from ..planning.plan import Progress, plan_joints
from ..planning.sampled import Sampled, sampled
from ..toolpath import Bead, Toolpath
from .screen import alone, screened

Cylinders = tuple[tuple[Cylinder, ...], ...]

TOGETHER = 2  # beads that follow each other, so that rapids are among what is planned
REACH = 200.0  # mm, beyond which it is not told how far the arm is from everything
UNREACHED = "NO_ROTATION"


@dataclass(frozen=True)
class Job:
    """What is placed. cell: resolves the parameters of a cell for it, with what stands there, or raises AmError.
    cylinders: of the links of the robot in a cell."""

    toolpath: Toolpath
    cell: Callable[[CellParameters], Cell]
    cylinders: Callable[[Cell], Cylinders]
    process: ProcessParameters
    joints: JointParameters


@dataclass(frozen=True)
class Judged:
    """A pose. share: of the points looked at that the machine serves. code: of the first error, '' of a feasible pose.
    margin: the least share of a range that is left to a limit, 1 in its middle; time: of the whole job, s; clearance: mm
    between the arm and everything else, REACH at most, at the points of beads; all NaN where nothing was planned, clearance
    of machines with rotary axes too. branch: the configuration it was planned in. message: of the first error."""

    share: float
    code: str
    margin: float = np.nan
    time: float = np.nan
    clearance: float = np.nan
    branch: tuple[str, ...] = ()
    message: str = ""

    @property
    def feasible(self) -> bool:
        """Whether what was looked at can be carried out."""
        return not self.code


@dataclass(frozen=True)
class Judge:
    """Judges poses of a job by some of its points, about `most`, or by all with None."""

    job: Job
    most: int | None
    _some: Sampled = field(init=False, repr=False)
    _deposit: Beads = field(init=False, repr=False)

    def __post_init__(self) -> None:
        whole = self.job.toolpath
        joints = dataclasses.replace(self.job.joints, compare=(), certificate=False)
        object.__setattr__(self, "job", dataclasses.replace(self.job, joints=joints))
        most = whole.point_count if self.most is None else self.most
        object.__setattr__(self, "_some", sampled(whole, most, TOGETHER))
        width = whole.bead_width or whole.layer_height
        object.__setattr__(
            self, "_deposit", Beads.of([bead for _, _, bead in whole], width, whole.layer_height)
        )

    @property
    def points(self) -> int:
        """How many points are looked at."""
        return self._some.toolpath.point_count

    def judged(
        self, settings: CellParameters, progress: Progress = lambda share, text: None
    ) -> Judged:
        """The job in a cell. progress may raise to cancel."""
        job, some = self.job, self._some.toolpath
        try:
            cell = job.cell(settings)
            share = self._share(cell) if cell.machine.free else 1.0
            if share is not None and share < 1.0 and not _several_alike(cell):
                return Judged(
                    share, UNREACHED, message="some points no rotation about the tool serves"
                )
            cylinders = job.cylinders(cell)
            path = plan_joints(
                some,
                cell,
                dataclasses.replace(job.joints, given=self._some.given(job.joints.given)),
                progress,
                () if cell.arm_clearance is None else cylinders,
            )
            motion, rapids = assemble(
                path,
                cell,
                job.process,
                some.surroundings,
                job.joints,
                some.layer_height,
                () if cell.arm_clearance is None else cylinders,
            )
        except AmError as error:
            return Judged(0.0, error.code, message=error.message)
        return self._figures(cell, path, motion, [*path.issues, *rapids], cylinders)

    def _share(self, cell: Cell) -> float | None:
        """The share of points that are served; None where a track decides where the robot stands."""
        some, job = self._some.toolpath, self.job
        if cell.external is not None and cell.external.slides is not None:
            return None
        beads = levelled(cell, some)[0] if cell.external else [bead for _, _, bead in some]
        own = job.joints.own_branch
        wanted = cell.branch if own == OF_CELL else opw.branch_index(own.split("-"))
        return screened(cell, alone(beads, cell), job.joints, wanted).share

    def _figures(
        self, cell: Cell, path: JointPath, motion: Motion, issues: list[Issue], cylinders: Cylinders
    ) -> Judged:
        wrong = next((issue for issue in issues if issue.level == ERROR), None)
        joints = path.joints
        left = cell.limits.smallest_share(joints)
        served = float(np.mean(np.nan_to_num(left, nan=-1.0) >= 0.0))
        if (
            wrong is not None
            and wrong.code in ("UNREACHABLE", "LIMIT")
            and not np.isfinite(joints).all()
        ):
            return Judged(served, wrong.code, branch=path.branch, message=wrong.message)
        return Judged(
            served,
            "" if wrong is None else wrong.code,
            float(np.nanmin(left)),
            self._time(path, motion),
            self._clearance(cell, path, cylinders),
            path.branch,
            "" if wrong is None else wrong.message,
        )

    def _clearance(self, cell: Cell, path: JointPath, cylinders: Cylinders) -> float:
        """mm between the arm and everything at the points of the beads, all of what is deposited by then among it."""
        if not cylinders:
            return np.nan
        whole = self.job.toolpath
        contact = ArmContact(cell, cylinders, whole.surroundings, self._deposit.solid(LINK_GRAIN))
        counts = np.cumsum([0, *(len(bead) for _, _, bead in whole)])
        before = {
            (layer, index): int(n) for (layer, index, _), n in zip(whole, counts, strict=False)
        }
        here = {
            (layer, index): place
            for (layer, index, _), place in zip(self._some.toolpath, self._some.places, strict=True)
        }
        moment = [
            before.get(here.get((one.layer, one.index), (one.layer, 0)), before[one.layer, 0])
            for one in path.beads
        ]
        when = np.repeat(moment, [len(one.joints) for one in path.beads])
        return min_distance(contact, path.joints, when, REACH)

    def _time(self, path: JointPath, motion: Motion) -> float:
        """s of the whole job: its deposit as it was slowed here, its rapids as those between beads that follow each other
        here, lead times and waits."""
        whole, process = [bead for _, _, bead in self.job.toolpath], self.job.process
        asked = sum(_lasts(bead) for _, _, bead in self._some.toolpath)
        run = sum(_lasts(one.bead) for one in path.beads)
        deposit = sum(_lasts(bead) for bead in whole) * run / max(asked, 1e-9)
        waits = len(whole) * (process.lead_on + process.lead_off)
        waits += sum(
            max(layer.wait, process.between_layers.wait) for layer in self.job.toolpath.layers[1:]
        )
        return float(deposit + waits + self._rapids(motion, len(whole)))

    def _rapids(self, motion: Motion, beads: int) -> float:
        """s of all rapids between so many beads, and of the way onto the first and off the last."""
        steps, starts = np.nan_to_num(motion.duration), motion.deposit & (motion.point == 0)
        number = np.cumsum(
            np.append(False, starts[:-1])
        )  # of the bead that a row leads to, or belongs to
        of_bead = np.bincount(
            number[~motion.deposit], steps[~motion.deposit], int(starts.sum()) + 1
        )
        first, last, between = (
            of_bead[0],
            of_bead[int(starts.sum())],
            of_bead[1 : int(starts.sum())],
        )
        if not len(between):
            return float(first + last)
        place = {
            place: k
            for k, place in enumerate((layer, index) for layer, index, _ in self.job.toolpath)
        }
        at = np.array([place[one] for one in self._some.places])
        follows = np.diff(at) == 1
        some = between[follows] if len(follows) == len(between) and follows.any() else between
        return float(first + last + (beads - 1) * some.mean())


def _several_alike(cell: Cell) -> bool:
    """Whether several solutions bear the same words, of which the screen knows one."""
    arm = cell.machine.arm if cell.external is None else cell.robot.arm
    return arm is not None and arm.followed


def _lasts(bead: Bead) -> float:
    """s of a bead at its speeds."""
    return float((np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum())
