# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read a written program back and drive it through kinematics that planning did not use.

The check uses only the program text: the moves as the controller would run them, linear in joint or
Cartesian space, with or without a stop. It computes joint values with the joint-frame chain (not
the planner's closed form) and with PyKDL. It compares the result with the planned path at the
points and between them, and checks the events between moves. It cannot reveal assumptions that text
and plan share, such as the pendant's J3 zero or the frame positions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .core.geometry.formatting import format_deviation
from .core.issues import ERROR, Issue, Text
from .core.kinematics.cell import Cell
from .core.motion import Motion
from .core.program import Program
from .core.read_moves import ReadMoves
from .core.types import Array
from .posts.catalogue import Post
from .read_back import points, text_path
from .read_back.events import event_issues
from .read_back.interpolation import time_issues, way_issues
from .read_back.text_path import Planned

STRAYS = "the path between two points deviates from the straight line by {:.3g} mm, more than the chord error"
WANDERS = "the path between two beads deviates from the checked path by up to {} mm and {:.3g} deg"


@dataclass(frozen=True)
class Verification:
    """Read-back result. The program may be delivered if no issue is an error.

    at_points_mm, between_mm: maximum deviation from the plan at the points, and between the points
    of a bead. bound_mm: maximum deviation that the rounding of the text explains. solvers: names of
    the kinematics solvers used.
    """

    issues: tuple[Issue, ...]
    at_points_mm: float
    between_mm: float
    bound_mm: float
    solvers: tuple[str, ...]


def verify(
    cell: Cell,
    motion: Motion,
    program: Program,
    files: dict[str, bytes],
    post: Post,
    chord_error: float,
) -> Verification:
    """Compare program files with the motion that they were written for.

    motion: contains the rows that `program` was built from. chord_error: mm; maximum deviation of
    the path from the straight line between two points of a bead. Raises InputError
    UNREADABLE_PROGRAM if the reader does not understand the files.
    """
    read_moves, rows = post.read(files), np.flatnonzero(motion.moves)
    if len(read_moves.deposit) != len(rows):
        message = Text(
            "the program has {} moves, but {} are planned", len(read_moves.deposit), len(rows)
        )
        return Verification((Issue(ERROR, "VERIFY_COUNT", message),), np.inf, np.inf, np.inf, ())
    planned = Planned(motion, rows)
    issues = event_issues(planned, program, read_moves) + way_issues(
        cell, planned, program, read_moves
    )
    issues += time_issues(cell, planned, read_moves)
    if read_moves.position is None:
        return _verify_joints(cell, planned, program, read_moves, chord_error, issues)
    if not cell.machine.free:
        return _verify_tips(cell, planned, program, read_moves, issues)
    return _verify_poses(cell, planned, program, read_moves, chord_error, issues)


def _verify_joints(
    cell: Cell,
    planned: Planned,
    program: Program,
    read_moves: ReadMoves,
    chord_error: float,
    issues: list[Issue],
) -> Verification:
    assert read_moves.joints is not None
    values = read_moves.joints.copy()
    continuous = text_path.shorter_way(cell, program, read_moves)
    values[:, continuous] = np.unwrap(values[:, continuous], axis=0)
    half = text_path.digits(cell, read_moves)
    path, flange = text_path.joint_path(cell, values, half)
    second = points.second_opinion(cell, planned, values, flange)
    del flange  # frees the largest array of all checks
    issues += points.joint_issues(cell, planned, read_moves, continuous) + points.point_issues(
        planned, path
    )
    strayed, off = points.beads_between(cell, planned, values, path, chord_error)
    issues += planned.issue("VERIFY_BETWEEN", off, Text(STRAYS, strayed))
    text = text_path.text_joints(cell, planned.joints, values, half, path, None)
    return _concluded(cell, planned, read_moves, path, text, strayed, second, issues)


def _verify_poses(
    cell: Cell,
    planned: Planned,
    program: Program,
    read_moves: ReadMoves,
    chord_error: float,
    issues: list[Issue],
) -> Verification:
    """Compare the positions in the text with the planned points, and their flange poses with the
    planned joints.

    A linear move takes the selected tool straight to the target. If the robot holds the part, the
    tool frame differs at every point, so the path between points is checked too.
    """
    joints = np.concatenate([moves.joints for moves in program.moves])
    path, flange = text_path.joint_path(cell, joints, np.zeros(joints.shape[1]))
    issues += points.point_issues(planned, path)
    poses, required, tools = text_path.text_path(cell, program, read_moves)
    if read_moves.joints is not None:
        issues += points.joint_issues(
            cell, planned, read_moves, text_path.shorter_way(cell, program, read_moves)
        )
    issues += points.point_issues(planned, poses)
    issues += points.twice_issues(cell, planned, program, read_moves, flange)
    twisted = points.turned_otherwise(required, flange, poses)
    issues += planned.issue(
        "VERIFY_ROTATION", twisted, "the program turns the tool differently than planned"
    )
    strayed = 0.0
    # a constant tool moves straight from point to point, and so does a fixed tool relative to a
    # held part
    if read_moves.tool is not None and not read_moves.held and len(planned.ends):
        strayed, off = points.tools_between(cell, planned, required, tools, poses, chord_error)
        issues += planned.issue("VERIFY_BETWEEN", off, Text(STRAYS, strayed))
    text = text_path.text_joints(
        cell, planned.joints, read_moves.joints, text_path.digits(cell, read_moves), poses, required
    )
    second = points.second_opinion(cell, planned, joints, flange)
    return _concluded(cell, planned, read_moves, poses, text, strayed, second, issues)


def _verify_tips(
    cell: Cell, planned: Planned, program: Program, read_moves: ReadMoves, issues: list[Issue]
) -> Verification:
    """Check tips and directions in a text for a five-axis machine, and the planned axis values.

    The controller computes the linear axes and moves the tip straight from point to point.
    """
    joints = np.concatenate([moves.joints for moves in program.moves])
    path, flange = text_path.joint_path(cell, joints, np.zeros(joints.shape[1]))
    tips = text_path.text_tips(cell, program, read_moves)
    if read_moves.joints is not None:
        issues += points.joint_issues(
            cell, planned, read_moves, text_path.shorter_way(cell, program, read_moves)
        )
    issues += points.point_issues(planned, path) + points.point_issues(planned, tips)
    values = _in_turns(cell, planned, program, read_moves)
    text = text_path.text_joints(
        cell, planned.joints, values, text_path.digits(cell, read_moves), tips, None
    )
    second = points.second_opinion(cell, planned, joints, flange)
    return _concluded(cell, planned, read_moves, tips, text, 0.0, second, issues)


def _in_turns(
    cell: Cell, planned: Planned, program: Program, read_moves: ReadMoves
) -> Array | None:
    """Return the axis values of the text, with shorter-way axes unwrapped to the planned turns."""
    if read_moves.joints is None:
        return None
    values, shorter = read_moves.joints.copy(), text_path.shorter_way(cell, program, read_moves)
    difference = values[:, shorter] - cell.machine.to_controller(planned.joints)[:, shorter]
    values[:, shorter] -= 2.0 * np.pi * np.rint(difference / (2.0 * np.pi))
    return values


def _concluded(
    cell: Cell,
    planned: Planned,
    read_moves: ReadMoves,
    path: text_path.Path,
    text: text_path.Joints,
    strayed: float,
    second: tuple[list[Issue], tuple[str, ...]],
    issues: list[Issue],
) -> Verification:
    """Add the checks that every text needs (rapids, limits) and the second solver's result."""
    wandered, turned, off = points.rapids_between(cell, planned, text, path, read_moves.linear)
    issues += planned.issue(
        "VERIFY_BETWEEN", off, Text(WANDERS, format_deviation(wandered), turned)
    )
    issues += points.limit_issues(cell, planned, text)
    solver_issues, solvers = second
    at_points = float(np.linalg.norm(path.position - planned.position, axis=1).max())
    return Verification(
        tuple(issues + solver_issues), at_points, strayed, float(path.bound.max()), solvers
    )
