# SPDX-License-Identifier: LGPL-2.1-or-later
"""Placement of part, positioner or deposition point: rate a box of poses and find the best pose.

`screen_points` checks each pose, then `Judge` plans a sample of the job there. The best poses are
planned with all points until one is feasible, so a proposed pose is known to work.
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
    """Return the movable frames of a cell (POINT, PLATFORM, POSITIONER), the default first."""
    arrangement = arrangement_of(settings.setup)
    if arrangement.holds_part:
        return (POINT, PLATFORM)
    if arrangement.carries_part:
        return (PLATFORM,)
    if any(mechanism.carries == PART for mechanism in settings.external):
        return (POSITIONER, PLATFORM)
    return (POINT,) if arrangement.planned else ()


def select_movable(settings: CellParameters, moves: str) -> str:
    """Return the frame to move. Raises InputError NOT_FOR_SETUP if the cell does not have it."""
    available = movable(settings)
    if moves == AUTO and available:
        return available[0]
    if moves not in available:
        raise InputError(
            "NOT_FOR_SETUP",
            "place.moves",
            "with {} the part is not placed by {}; use {}",
            settings.setup,
            moves,
            Text.joined(" or ", available) or "another set-up",
        )
    return moves


def pose_of(settings: CellParameters, moves: str) -> Pose:
    """Return the current pose of the movable frame, mm and rad."""
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
    """Return the cell with a new pose of the movable frame.

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
        The cell with that pose.
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
    """Return a pose in mm and deg, without the rounding residues of summed steps."""
    return [
        round(value, 7) + 0.0 for value in (*pose[:3], *(math.degrees(angle) for angle in pose[3:]))
    ]


JUDGING = 0.8  # fraction of the progress bar for rating all poses; the rest is for full plans


@dataclass(frozen=True, eq=False)
class Placed:
    """P rated poses (P, 6) of the movable frame of a cell, mm and rad.

    settings: the cell. about: the current pose of the frame. points: number of sampled toolpath
    points. of: number of all toolpath points. proven: results with all points by pose index, in
    the order of planning. The last of them is the best pose if it is feasible.
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
        """Index of the best pose; None if no planned pose is feasible."""
        last_proven = next(reversed(self.proven), None)
        return (
            last_proven if last_proven is not None and self.proven[last_proven].feasible else None
        )

    def pose(self, number: int) -> Pose:
        """Return a pose, rounded like its text output."""
        x, y, z, a, b, c = np.round(self.poses[number], 9).tolist()
        return (x, y, z, a, b, c)

    def result_of(self, number: int) -> Judged:
        """Return the result of a pose, with all points if available."""
        return self.proven.get(number, self.judged[number])

    def entries(self, number: int) -> dict[str, object]:
        """Return the cell parameters that set a pose, in the units of macros: mm and deg."""
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
    """Rate all poses of a box and find the best pose.

    Parameters
    ----------
    job : Job
        The job.
    settings : CellParameters
        The cell.
    parameters : PlaceParameters
        The box, the criterion and the number of points.
    progress : callable
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Placed
        All poses and their results.

    Raises
    ------
    InputError
        NOT_FOR_SETUP if the cell does not have the requested frame.
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
    """Plan the best poses with all points until one is feasible."""
    judge, proofs = Judge(job, None), dict[int, Judged]()
    for number in ranked(placed, parameters.best)[: parameters.proven]:
        share = JUDGING + (1.0 - JUDGING) * len(proofs) / parameters.proven
        progress(share, Text("planning the whole job, best pose number {}", len(proofs) + 1))
        proofs[number] = judge.evaluate(replace_pose(settings, placed.moves, placed.pose(number)))
        if proofs[number].feasible:
            break
    return proofs


def ranked(placed: Placed, best: str) -> list[int]:
    """Return the feasible poses, the best first.

    The other criteria resolve ties, then the distance from the current pose. Poses where the arm
    touches an obstacle come last; only `cell.arm_clearance` makes such a contact an error.
    """
    change = np.abs(placed.poses - np.array(placed.about))
    distances = np.linalg.norm(change[:, :3], axis=1) + 1000.0 * change[:, 3:].sum(
        axis=1
    )  # mm; 1 rad counts as 1 m

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


# ---- Poses and results as a table, and the best pose as a line of a job file

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
    """Yield the lines of place.csv, the header first.

    A pose that was planned with all points has the values of that plan.
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
    """Return the line of section `cell` of a job file that sets a pose."""
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
