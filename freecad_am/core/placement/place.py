# SPDX-License-Identifier: LGPL-2.1-or-later
"""Where part, positioner or deposition point may stand: a box of poses, each judged, and the best of them.

Each pose is screened (`screen`), then planned at some of its points (`judge`); the best are planned with all of them until
one is feasible, so that what is proposed is known to be carried out.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ..issues import Text
from ..parameters.cell import CellParameters, Pose
from ..parameters.place import CLEARANCE, MARGIN, POINT, POSITIONER, TIME, PlaceParameters
from ..planning.plan import Progress
from ..types import Array
from . import moved
from .judge import Job, Judge, Judged

JUDGING = 0.8  # of the time goes into all poses, the rest into planning the best ones whole


@dataclass(frozen=True, eq=False)
class Placed:
    """P poses of what is moved in the cell of these settings, poses (P, 6) in mm and rad, and what each came to.

    about: where it stands in the cell. points: how many of the toolpath's, all of them `of`, poses were judged by. proven:
    by number of a pose, what it came to with all of them, in the order in which they were planned; the best is the last of
    these where it is feasible.
    """

    settings: CellParameters
    moves: str
    about: Pose
    poses: Array
    judged: tuple[Judged, ...]
    points: int
    of: int
    proven: dict[int, Judged] = dataclasses.field(default_factory=dict)

    @property
    def best(self) -> int | None:
        """The number of the best pose, None where none was found."""
        last = next(reversed(self.proven), None)
        return last if last is not None and self.proven[last].feasible else None

    def pose(self, number: int) -> Pose:
        """One of the poses, rounded to what a text of it has."""
        x, y, z, a, b, c = np.round(self.poses[number], 9).tolist()
        return (x, y, z, a, b, c)

    def of_pose(self, number: int) -> Judged:
        """What a pose came to, with all points where it was planned so."""
        return self.proven.get(number, self.judged[number])

    def entries(self, number: int) -> dict[str, object]:
        """What gives the cell a pose, by parameter, in the units of macros: mm and deg."""
        if self.moves == POSITIONER:
            return {"external": moved.moved(self.settings, self.moves, self.pose(number)).external}
        return {
            "deposition_point" if self.moves == POINT else "platform": tuple(
                moved.outer(self.pose(number))
            )
        }


def placed(
    job: Job, settings: CellParameters, parameters: PlaceParameters, progress: Progress
) -> Placed:
    """What the poses of a box come to, and which is best. progress may raise to cancel.

    Raises InputError NOT_FOR_SETUP for what the cell has not to be moved.
    """
    moves = moved.chosen(settings, parameters.moves)
    about = moved.pose_of(settings, moves)
    poses = parameters.poses(about)
    some = Judge(job, parameters.points)
    found = []
    for number, pose in enumerate(poses):
        progress(JUDGING * number / len(poses), Text("pose {} of {}", number + 1, len(poses)))
        found.append(some.judged(moved.moved(settings, moves, np.round(pose, 9))))
    result = Placed(
        settings, moves, about, poses, tuple(found), some.points, job.toolpath.point_count
    )
    return dataclasses.replace(result, proven=_proven(job, settings, parameters, result, progress))


def _proven(
    job: Job,
    settings: CellParameters,
    parameters: PlaceParameters,
    found: Placed,
    progress: Progress,
) -> dict[int, Judged]:
    """The best poses planned with all points, until one is feasible."""
    whole, done = Judge(job, None), dict[int, Judged]()
    for number in ranked(found, parameters.best)[: parameters.proven]:
        share = JUDGING + (1.0 - JUDGING) * len(done) / parameters.proven
        progress(
            share, Text("planning the whole job at one of the best poses, the {}.", len(done) + 1)
        )
        done[number] = whole.judged(moved.moved(settings, found.moves, found.pose(number)))
        if done[number].feasible:
            break
    return done


def ranked(found: Placed, best: str) -> list[int]:
    """The feasible poses, the best first; of those alike the ones that are better by the other figures, then those nearest
    to where it stands. Where the arm touches something, which only `cell.arm_clearance` forbids, come last."""
    change = np.abs(found.poses - np.array(found.about))
    away = np.linalg.norm(change[:, :3], axis=1) + 1000.0 * change[:, 3:].sum(
        axis=1
    )  # mm; a rad counts as a metre

    def order(number: int) -> tuple[float, ...]:
        one = found.judged[number]
        figures = {
            MARGIN: -round(one.margin, 4),
            CLEARANCE: -round(float(np.nan_to_num(one.clearance)), 1),
            TIME: round(one.time, 1),
        }
        return (
            float(one.clearance == 0.0),
            figures.pop(best),
            *figures.values(),
            round(float(away[number]), 6),
            number,
        )

    return sorted((number for number, one in enumerate(found.judged) if one.feasible), key=order)
