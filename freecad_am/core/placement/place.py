# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placement of part, positioner or deposition point: rates a box of poses and finds the best one.

`screen` checks each pose, then `judge` plans it at some of its points. The best poses are planned
at every point until one is feasible, so that a proposed pose is known to work.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..issues import InputError, Text
from ..kinematics.arrangement import arrangement_of
from ..parameters.cell import CellParameters
from ..parameters.cell_records import EXTERNAL, PART
from ..parameters.place import (
    AUTO,
    CLEARANCE,
    MARGIN,
    PLATFORM,
    POINT,
    POSITIONER,
    TIME,
    PlaceParameters,
)
from ..parameters.records import Pose
from ..planning.plan import Progress
from ..types import Array
from .judge import Job, Judge, Judged


def movable(settings: CellParameters) -> tuple[str, ...]:
    """Return the movable poses of a cell among POINT, PLATFORM and POSITIONER, the usual one first."""
    arrangement = arrangement_of(settings.setup)
    if arrangement.holds_part:
        return (POINT, PLATFORM)
    if arrangement.carries_part:
        return (PLATFORM,)
    if any(mechanism.carries == PART for mechanism in settings.external):
        return (POSITIONER, PLATFORM)
    return (POINT,) if arrangement.planned else ()


def select_movable(settings: CellParameters, moves: str) -> str:
    """Return the pose to move. Raises InputError NOT_FOR_SETUP if the cell does not have it."""
    available = movable(settings)
    if moves == AUTO and available:
        return available[0]
    if moves not in available:
        raise InputError(
            "NOT_FOR_SETUP",
            "place.moves",
            "a cell with {} has no {} that places the part; use {}",
            settings.setup,
            moves,
            Text.joined(" or ", available) or "another set-up",
        )
    return moves


def pose_of(settings: CellParameters, moves: str) -> Pose:
    """The current pose of the movable, mm and rad."""
    if moves == POINT:
        return settings.deposition_point
    if moves == POSITIONER:
        return next(mechanism.pose for mechanism in settings.external if mechanism.carries == PART)
    platform = settings.platform
    return (
        (0.0, 0.0, float(platform), 0.0, 0.0, 0.0)
        if isinstance(platform, (int, float))
        else platform
    )


def replace_pose(settings: CellParameters, moves: str, pose: Sequence[float]) -> CellParameters:
    """Return the cell with another pose of the movable.

    Parameters
    ----------
    settings : CellParameters
        The cell.
    moves : str
        POINT, PLATFORM or POSITIONER.
    pose : sequence of float
        x y z in mm and three angles in rad.

    Returns
    -------
    CellParameters
        The cell.
    """
    x, y, z, rx, ry, rz = (float(number) for number in pose)
    new_pose = (x, y, z, rx, ry, rz)
    if moves == POINT:
        return dataclasses.replace(settings, deposition_point=new_pose)
    if moves == PLATFORM:
        return dataclasses.replace(settings, platform=new_pose)
    mechanisms, is_replaced = [], False
    for mechanism in settings.external:
        turns = mechanism.carries == PART and not is_replaced
        is_replaced |= turns
        mechanisms.append(dataclasses.replace(mechanism, pose=new_pose) if turns else mechanism)
    return dataclasses.replace(settings, external=tuple(mechanisms))


def outer(pose: Pose) -> list[float]:
    """A pose in mm and deg, digits that a sum of steps leaves behind rounded away."""
    return [
        round(value, 7) + 0.0 for value in (*pose[:3], *(math.degrees(angle) for angle in pose[3:]))
    ]


JUDGING = 0.8  # of the time goes into all poses, the rest into planning the best ones whole


@dataclass(frozen=True, eq=False)
class Placed:
    """P rated poses (P, 6) of the movable frame in a cell with these settings, mm and rad.

    about: its present pose in the cell. points: number of toolpath points for the rating; of: their
    total. proven: by pose number, the rating with all points, in the order of planning; the best
    pose is the last entry if it is feasible.
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
        """The number of the best pose, None without one."""
        last_proven = next(reversed(self.proven), None)
        return (
            last_proven if last_proven is not None and self.proven[last_proven].feasible else None
        )

    def pose(self, number: int) -> Pose:
        """Return one of the poses, rounded as its text."""
        x, y, z, a, b, c = np.round(self.poses[number], 9).tolist()
        return (x, y, z, a, b, c)

    def result_of(self, number: int) -> Judged:
        """Return the result of a pose, with all points if it was planned so."""
        return self.proven.get(number, self.judged[number])

    def entries(self, number: int) -> dict[str, object]:
        """Return the parameters that set a pose of the cell, in the units of macros: mm and deg."""
        if self.moves == POSITIONER:
            moved = replace_pose(self.settings, self.moves, self.pose(number))
            return {"external": EXTERNAL.text(moved.external)}
        return {
            "deposition_point" if self.moves == POINT else "platform": tuple(
                outer(self.pose(number))
            )
        }


def place_part(
    job: Job, settings: CellParameters, parameters: PlaceParameters, progress: Progress
) -> Placed:
    """Judge the poses of a box and find the best.

    Parameters
    ----------
    job : Job
        The job.
    settings : CellParameters
        The cell.
    parameters : PlaceParameters
        The box, the criterion and the number of points.
    progress : callable
        Called with the completed share and a text; may raise to cancel.

    Returns
    -------
    Placed
        All poses with their results.

    Raises
    ------
    InputError
        NOT_FOR_SETUP if the cell does not have the movable.
    """
    moves = select_movable(settings, parameters.moves)
    about = pose_of(settings, moves)
    poses = parameters.poses(about)
    judge = Judge(job, parameters.points)
    results = []
    for number, pose in enumerate(poses):
        progress(JUDGING * number / len(poses), Text("pose {} of {}", number + 1, len(poses)))
        results.append(judge.evaluate(replace_pose(settings, moves, np.round(pose, 9))))
    result = Placed(
        settings, moves, about, poses, tuple(results), judge.points, job.toolpath.point_count
    )
    return dataclasses.replace(result, proven=_proven(job, settings, parameters, result, progress))


def _proven(
    job: Job,
    settings: CellParameters,
    parameters: PlaceParameters,
    placed: Placed,
    progress: Progress,
) -> dict[int, Judged]:
    """Plan the best poses with all points, until one is feasible."""
    judge, proofs = Judge(job, None), dict[int, Judged]()
    for number in ranked(placed, parameters.best)[: parameters.proven]:
        share = JUDGING + (1.0 - JUDGING) * len(proofs) / parameters.proven
        progress(share, Text("planning the whole job, best pose number {}", len(proofs) + 1))
        proofs[number] = judge.evaluate(replace_pose(settings, placed.moves, placed.pose(number)))
        if proofs[number].feasible:
            break
    return proofs


def ranked(placed: Placed, best: str) -> list[int]:
    """Return the feasible poses, the best first; ties are resolved by the other figures, then by the
    distance to the current pose.

    Poses where the arm touches an obstacle, which only `cell.arm_clearance` forbids, come last.
    """
    change = np.abs(placed.poses - np.array(placed.about))
    distances = np.linalg.norm(change[:, :3], axis=1) + 1000.0 * change[:, 3:].sum(
        axis=1
    )  # mm; a rad counts as a metre

    def order(number: int) -> tuple[float, ...]:
        result = placed.judged[number]
        figures = {
            MARGIN: -round(result.margin, 4),
            CLEARANCE: -round(float(np.nan_to_num(result.clearance)), 1),
            TIME: round(result.time, 1),
        }
        return (
            float(result.clearance == 0.0),
            figures.pop(best),
            *figures.values(),
            round(float(distances[number]), 6),
            number,
        )

    return sorted(
        (number for number, result in enumerate(placed.judged) if result.feasible), key=order
    )


# ---- Poses and their results as a table, and the best one as a line of a job file

HEAD = (
    "x_mm",
    "y_mm",
    "z_mm",
    "rx_deg",
    "ry_deg",
    "rz_deg",
    "feasible",
    "share",
    "margin",
    "time_s",
    "clearance_mm",
    "configuration",
    "code",
    "all_points",
)


def rows(placed: Placed) -> Iterator[str]:
    """Return the lines of place.csv, the header first.

    A pose that was planned with all points has the figures of that plan.
    """
    yield ",".join(HEAD) + "\n"
    for number in range(len(placed.poses)):
        result, pose = placed.result_of(number), outer(placed.pose(number))
        yield (
            ",".join(
                [
                    *(f"{value:.6f}" for value in pose),
                    "yes" if result.feasible else "no",
                    f"{result.share:.6f}",
                    *(
                        f"{value:.6f}" if np.isfinite(value) else ""
                        for value in (result.margin, result.time, result.clearance)
                    ),
                    "-".join(result.branch),
                    result.code,
                    "yes" if number in placed.proven else "no",
                ]
            )
            + "\n"
        )


def key(placed: Placed, number: int) -> str:
    """The line of the section `cell` of a job file that gives the cell a pose."""
    if placed.moves == POINT:
        return f"deposition_point: {_list(placed.pose(number))}"
    if placed.moves == PLATFORM:
        return f"platform: {_list(placed.pose(number))}"
    mechanisms, is_replaced = [], False
    for mechanism in placed.settings.external:
        turns = mechanism.carries == PART and not is_replaced
        is_replaced |= turns
        pose = placed.pose(number) if turns else mechanism.pose
        mechanisms.append(
            f"{{machine: {mechanism.machine}, pose: {_list(pose)}, carries: {mechanism.carries}}}"
        )
    return f"external: [{', '.join(mechanisms)}]"


def _list(pose: Pose) -> str:
    return f"[{', '.join(f'{value:.10g}' for value in outer(pose))}]"
