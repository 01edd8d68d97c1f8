# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads a written program back and drives it through kinematics that planning did not use.

From the text alone: the moves as the controller would carry them out, their joint values through the joint-frame
chain (not the closed form that planned them) and through PyKDL, compared with the planned path at the points and
between them. What text and plan assume alike - how the pendant counts J3, where the frames are - cannot show here.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .core.geometry import frames
from .core.issues import ERROR, NOTE, Issue
from .core.kinematics.cell import ROTARY_TABLE, Cell
from .core.motion import Motion
from .core.program import Program, ReadMoves, waits_otherwise
from .kdl import chain as kdl_chain
from .posts.catalogue import Post

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

# what rounding in the computation itself may amount to: mm, and of unit vectors
COMPUTED_MM, COMPUTED_AXIS = 1e-6, 1e-9
# of the way between two points, where the path is looked at
BETWEEN = np.array([1.0, 2.0, 3.0, 4.0, 5.0]) / 6.0
# s: the step of a time in milliseconds and in tenths of a second, and where the second begins
MILLISECOND, TENTH, LONGEST_MSEC = 0.001, 0.05, 32.0
# rad: a rapid that turns no axis farther than this has no time to speak of
STILL = 2e-5
STRAYS = "the path between two points leaves the straight line by {:.3g} mm, more than the chord error"


@dataclass(frozen=True)
class Verification:
    """What reading back showed. No error among the issues: the program may be delivered.

    at_points_mm, between_mm: largest distance from the plan at the points, and between those of a bead. bound_mm:
    largest distance that the digits of the text explain. solvers: who computed the kinematics.
    """

    issues: tuple[Issue, ...]
    at_points_mm: float
    between_mm: float
    bound_mm: float
    solvers: tuple[str, ...]


@dataclass(frozen=True)
class _Path:
    """Where the text takes the tip, in part coordinates, with the error its digits allow. Rows are moves."""

    position: Array
    tool: Array
    bound: Array
    tool_bound: Array


def verify(
    cell: Cell, motion: Motion, program: Program, files: dict[str, bytes], post: Post, chord_error: float
) -> Verification:
    """Compare the files with the motion they were written for.

    motion: the rows that `program` was built of. chord_error: mm, how far the path may leave the straight line
    between two points of a bead. Raises InputError UNREADABLE_PROGRAM when the reader does not understand the files.
    """
    read, rows = post.read(files), np.flatnonzero(motion.moves)
    if len(read.deposit) != len(rows):
        message = f"the text has {len(read.deposit)} moves, planned are {len(rows)}"
        return Verification((Issue(ERROR, "VERIFY_COUNT", message),), np.inf, np.inf, np.inf, ())
    planned = _Planned(motion, rows)
    issues = _deposit_issues(planned, read, program) + _time_issues(cell, planned, read)
    if read.position is not None and cell.setup == ROTARY_TABLE:
        return _verify_tips(cell, planned, program, read, issues)
    if read.position is None:
        return _verify_joints(cell, planned, program, read, chord_error, issues)
    return _verify_poses(cell, planned, program, read, chord_error, issues)


class _Planned:
    """The rows of the motion that a controller moves to, with the finding of a place."""

    def __init__(self, motion: Motion, rows: NDArray[np.intp]) -> None:
        self.rows, self.motion = rows, motion
        self.deposit, self.joints = motion.deposit[rows], motion.joints[rows]
        self.position, self.tool = motion.position[rows], motion.tool[rows]
        self.duration, self.speed = motion.duration[rows], motion.speed[rows]
        self.ends = np.flatnonzero(self.deposit & (np.arange(len(rows)) > 0))

    def issue(self, code: str, wrong: Mask, message: str) -> list[Issue]:
        """An error at the first wrong move, none when there is none; the message says how many there are."""
        if not wrong.any():
            return []
        count, first = int(wrong.sum()), self.rows[int(np.argmax(wrong))]
        place = [int(column[first]) for column in (self.motion.layer, self.motion.bead, self.motion.point)]
        return [Issue(ERROR, code, f"{message}; {count} of {len(wrong)} moves", *place)]


def _deposit_issues(planned: _Planned, read: ReadMoves, program: Program) -> list[Issue]:
    """Whether the deposit is on in each move, how fast its wire runs, and what is waited for, where the text has to tell."""
    wanted = planned.deposit & (not program.dry_run)
    wire = np.where(wanted, planned.motion.wire[planned.rows] * (0.06 * program.nc.wire_gain), np.nan)
    told = np.where(read.deposit, np.nan if read.wire is None else read.wire, np.nan)
    wrong = (np.abs(told - wire) > read.wire_digits + COMPUTED_AXIS * wire) | (np.isnan(told) != np.isnan(wire))
    switched = planned.issue("VERIFY_DEPOSIT", read.deposit != wanted, "the deposit is switched otherwise than planned")
    switched += planned.issue("VERIFY_COOLING", waits_otherwise(program, read), "a temperature is waited for otherwise")
    return switched + planned.issue("VERIFY_WIRE", wrong, "the speed of the wire in the text is not the planned one")


def _time_issues(cell: Cell, planned: _Planned, read: ReadMoves) -> list[Issue]:
    """Times against the planned speed: each move to what its digits allow, and each bead as a whole.

    The first move of all starts from a place the program does not know; it has no time.
    """
    timed = np.arange(len(read.duration)) > 0
    step = np.linalg.norm(np.diff(planned.position, axis=0, prepend=planned.position[:1]), axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        wanted = np.where(planned.deposit, step / planned.speed, planned.duration)
    given = np.full(len(timed), np.nan) if read.speed is None else read.speed
    by_speed = np.isfinite(given)
    off = by_speed & ~(np.abs(given - planned.speed) <= read.speed_digits + 1e-9)
    issues = planned.issue("VERIFY_SPEED", off, "the speed in the text is not the planned one")
    timed &= ~by_speed
    allowed = np.where(wanted < LONGEST_MSEC, MILLISECOND, TENTH) + 1e-9
    taken, coarse = read.duration, allowed > TENTH
    if read.duration_digits is not None:
        allowed, coarse = read.duration_digits + 1e-9 * wanted + 1e-12, np.ones(len(timed), dtype=bool)
    if cell.setup == ROTARY_TABLE:  # rapids at the machine's own speed: the text says no more
        timed &= planned.deposit | np.isfinite(taken)
    short = timed & ~planned.deposit & (wanted < MILLISECOND)  # written as 1 ms, the shortest there is
    if read.share is not None:
        times, times_allowed, turned = _share_times(cell, planned, read, read.share)
        by_share = np.isfinite(read.share)
        taken, allowed = np.where(by_share, times, taken), np.where(by_share, times_allowed, allowed)
        coarse |= by_share
        short |= timed & ~planned.deposit & by_share & (turned < STILL)
    least = allowed + np.where(coarse, 0.0, _owed(wanted))
    wrong = timed & ~short & ~((taken - wanted <= allowed) & (wanted - taken <= least))
    issues += planned.issue("VERIFY_TIME", wrong, "the time in the text does not give the planned speed")
    beads = np.flatnonzero(np.diff(planned.deposit, prepend=False) & planned.deposit)
    if len(beads) and not issues:
        off = np.where(planned.deposit & timed, taken - wanted, 0.0)
        rounded = np.where(planned.deposit & coarse, allowed, 0.0)
        excess = np.abs(np.add.reduceat(off, beads)) > MILLISECOND + np.add.reduceat(rounded, beads)
        first = np.isin(np.arange(len(timed)), beads[excess])
        issues += planned.issue("VERIFY_TIME", first, "the times of a bead do not add up to the planned one")
    return issues


def _owed(wanted: Array) -> Array:
    """(n,) s that moves of `wanted` (n,) s may be shorter because others beside them want less than a millisecond."""
    debt = np.zeros((2, len(wanted) + 1))
    for row, way in zip(debt, (wanted, wanted[::-1])):
        row[1:] = np.cumsum(MILLISECOND - np.minimum(np.nan_to_num(way), TENTH))
        row -= np.minimum.accumulate(row)
    return np.asarray(debt[0, :-1] + debt[1, -2::-1])


def _share_times(cell: Cell, planned: _Planned, read: ReadMoves, share: Array) -> tuple[Array, Array, Array]:
    """(n,) s of moves in which the fastest axis runs at a share of its largest speed, what the digits allow, and the
    largest angle of an axis; from the joint values of the text, where it has them."""
    shown = cell.machine.to_controller(planned.joints)
    if read.joints is not None:
        shown = np.where(np.isnan(read.joints), shown, read.joints)
    turned = np.abs(np.diff(shown, axis=0, prepend=shown[:1]))
    times = (turned / cell.machine.max_speed).max(axis=1) / share
    # a move that begins where the text has no joint values is off by the digits of both its ends
    ends = 2.0 * read.digits / cell.machine.max_speed.min() / share
    return times, times * read.share_digits / share + ends + COMPUTED_AXIS, turned.max(axis=1)


def _verify_joints(
    cell: Cell, planned: _Planned, program: Program, read: ReadMoves, chord_error: float, issues: list[Issue]
) -> Verification:
    assert read.joints is not None
    shown = read.joints.copy()
    endless = _shorter_way(cell, program, read)
    shown[:, endless] = np.unwrap(shown[:, endless], axis=0)
    path, flange = _joint_path(cell, shown, _digits(cell, read))
    issues += _joint_issues(cell, planned, read, endless) + _point_issues(planned, path)
    between, off = _between(cell, planned, shown, path, chord_error)
    issues += planned.issue("VERIFY_BETWEEN", off, STRAYS.format(between))
    solver_issues, solvers = _second_opinion(cell, planned, shown, flange)
    at_points = float(np.linalg.norm(path.position - planned.position, axis=1).max())
    return Verification(tuple(issues + solver_issues), at_points, between, float(path.bound.max()), solvers)


def _joint_issues(cell: Cell, planned: _Planned, read: ReadMoves, endless: Mask) -> list[Issue]:
    """Joint values against the planned ones: the tip does not show where the rotation about the tool is."""
    assert read.joints is not None
    apart = read.joints - cell.machine.to_controller(planned.joints)
    apart[:, endless] -= 2.0 * np.pi * np.rint(apart[:, endless] / (2.0 * np.pi))
    told = ~np.isnan(read.joints) | ~_told_by_position(cell, read.joints)
    apart[~told] = 0.0
    computed = np.where(cell.machine.chain.sliding, COMPUTED_MM, COMPUTED_AXIS)
    wrong = ~(np.abs(apart) <= _digits(cell, read) + computed)
    found = []
    for axis in np.flatnonzero(wrong.any(axis=0)):
        most = np.abs(apart[:, axis]).max() / cell.machine.unit_values[axis]
        message = f"axis {cell.machine.axes[axis]} is up to {most:.3g} {cell.machine.units[axis]} from the planned value"
        found += planned.issue("VERIFY_JOINT", wrong[:, axis], message)
    return found


def _told_by_position(cell: Cell, joints: Array) -> Mask:
    """(n, axes) the axis values that a text may leave to the controller to find from a Cartesian position: all in a row,
    and those that slide of a machine with rotary axes. The rotary ones show in the direction of its tool."""
    slides = cell.machine.chain.sliding & (cell.setup == ROTARY_TABLE)
    return np.asarray(slides | np.isnan(joints).all(axis=1, keepdims=True), dtype=np.bool_)


def _shorter_way(cell: Cell, program: Program, read: ReadMoves) -> Mask:
    """(axes,) the axes that the controller takes the shorter way: those of robots that turn without end. Rotary axes of
    machine tools count their turns, unless the text says otherwise."""
    if cell.setup != ROTARY_TABLE:
        return np.array(program.endless)
    return np.array(program.endless) & (False if read.shorter_way is None else read.shorter_way)


def _digits(cell: Cell, read: ReadMoves) -> Array:
    """(axes,) half of the last digit of each axis, rad and mm."""
    return np.where(cell.machine.chain.sliding, read.linear_digits, read.digits)


def _joint_path(cell: Cell, shown: Array, digits: Array) -> tuple[_Path, Array]:
    """The path of controller joint values (n, axes) and the flange poses (n, 4, 4).

    Bounds to first order: every joint value may be off by half a digit (axes,), so the tip is within the sum of the
    lengths of the Jacobian's columns; what the second order adds is at most that times the sum of the angles.
    """
    machine = cell.machine
    at = machine.chain.frames(machine.from_controller(shown))
    position, tool = cell.tip_in_part(at.flange)
    point = cell.deposition_point(at.flange)
    to_serial = np.linalg.inv(machine.controller_matrix)
    slides = machine.chain.sliding[:, None]
    linear = np.where(slides, at.directions, np.cross(at.directions, point[:, None, :] - at.origins))
    linear, angular = (
        np.einsum("nki,kj->nji", rows, to_serial) for rows in (linear, np.where(slides, 0.0, at.directions))
    )
    more = 1.0 + (np.abs(to_serial) @ digits)[~machine.chain.sliding].sum()
    bound = more * np.linalg.norm(linear, axis=2) @ digits + COMPUTED_MM
    tool_bound = more * np.linalg.norm(angular, axis=2) @ digits + COMPUTED_AXIS
    return _Path(position, tool, bound, tool_bound), at.flange


def _point_issues(planned: _Planned, path: _Path) -> list[Issue]:
    off = np.linalg.norm(path.position - planned.position, axis=1)
    tilted = np.linalg.norm(path.tool - planned.tool, axis=1)
    message = f"the text leads up to {off.max():.3g} mm away from the planned point, more than its digits explain"
    found = planned.issue("VERIFY_POINT", ~(off <= path.bound), message)
    message = f"the tool is tilted by up to {np.degrees(tilted.max()):.3g} deg, more than the digits explain"
    return found + planned.issue("VERIFY_TOOL", ~(tilted <= path.tool_bound), message)


def _between(cell: Cell, planned: _Planned, shown: Array, path: _Path, chord_error: float) -> tuple[float, Mask]:
    """Largest distance of the tip from the planned segments while joints run straight, and the moves too far off."""
    ends = planned.ends
    if not len(ends):
        return 0.0, np.zeros(len(shown), dtype=bool)
    joints = shown[ends - 1, None] + BETWEEN[:, None] * (shown[ends] - shown[ends - 1])[:, None]
    flange = cell.machine.chain.forward(cell.machine.from_controller(joints.reshape(-1, shown.shape[1])))
    return _off_segments(planned, ends, cell.tip_in_part(flange)[0], path, chord_error)


def _off_segments(
    planned: _Planned, ends: NDArray[np.intp], tips: Array, path: _Path, chord_error: float
) -> tuple[float, Mask]:
    """Largest distance of tips (len(ends) * len(BETWEEN), 3) from the planned segments that end at the rows `ends`,
    and the moves (n,) that leave theirs by more than the chord error and the digits of their two points."""
    off = np.zeros(len(planned.deposit), dtype=bool)
    tips = tips.reshape(len(ends), len(BETWEEN), 3)
    start, step = planned.position[ends - 1], planned.position[ends] - planned.position[ends - 1]
    away = tips - start[:, None]
    squared = np.maximum(np.einsum("ni,ni->n", step, step), 1e-300)
    share = np.clip(np.einsum("nki,ni->nk", away, step) / squared[:, None], 0.0, 1.0)
    distance = np.linalg.norm(away - share[..., None] * step[:, None], axis=2).max(axis=1)
    off[ends] = ~(distance <= chord_error + np.maximum(path.bound[ends - 1], path.bound[ends]))
    return float(distance.max()), off


def _second_opinion(cell: Cell, planned: _Planned, shown: Array, flange: Array) -> tuple[list[Issue], tuple[str, ...]]:
    """The same joint values through PyKDL, where it is installed."""
    if not kdl_chain.available():
        message = "PyKDL is not installed; the program was checked by one solver alone"
        return [Issue(NOTE, "VERIFY_ONE_SOLVER", message)], ("chain",)
    other = kdl_chain.KdlArm(cell.machine).forward(cell.machine.from_controller(shown))
    apart = np.linalg.norm(other[:, :3, 3] - flange[:, :3, 3], axis=1) > COMPUTED_MM
    turned = np.abs(other[:, :3, :3] - flange[:, :3, :3]).max(axis=(1, 2)) > COMPUTED_AXIS
    issues = planned.issue("VERIFY_SOLVERS", apart | turned, "PyKDL and the joint-frame chain disagree")
    return issues, ("chain", "pykdl")


def _verify_poses(
    cell: Cell, planned: _Planned, program: Program, read: ReadMoves, chord_error: float, issues: list[Issue]
) -> Verification:
    """Positions of the text against the planned points, and the flange they ask for against the planned joint values.

    A linear move takes the tool it names straight to its target; with the part on the robot that tool is another one
    at every point, so the way between two of them is looked at too.
    """
    joints = np.concatenate([moves.joints for moves in program.moves])
    path, flange = _joint_path(cell, joints, np.zeros(joints.shape[1]))
    issues += _point_issues(planned, path)
    told, asked, tools = _text_path(cell, program, read)
    if read.joints is not None:
        issues += _joint_issues(cell, planned, read, _shorter_way(cell, program, read))
    issues += _point_issues(planned, told)
    # an angle of a shows as sqrt(2) a in the sum of squares of the nine entries
    twisted = np.linalg.norm(asked[:, :3, :3] - flange[:, :3, :3], axis=(1, 2)) > np.sqrt(2.0) * told.tool_bound
    issues += planned.issue("VERIFY_ROTATION", twisted, "the tool is turned otherwise than planned")
    between = 0.0
    if read.tool is not None and len(planned.ends):  # a tool that stays the same goes straight from point to point
        start, end = asked[planned.ends - 1] @ tools[planned.ends], asked[planned.ends] @ tools[planned.ends]
        ways = _straight(start, end) @ frames.inverse(tools[planned.ends])[:, None]
        tips = cell.tip_in_part(ways.reshape(-1, 4, 4))[0]
        between, off = _off_segments(planned, planned.ends, tips, told, chord_error)
        issues += planned.issue("VERIFY_BETWEEN", off, STRAYS.format(between))
    solver_issues, solvers = _second_opinion(cell, planned, joints, flange)
    at_points = float(np.linalg.norm(told.position - planned.position, axis=1).max())
    return Verification(tuple(issues + solver_issues), at_points, between, float(told.bound.max()), solvers)


def _verify_tips(cell: Cell, planned: _Planned, program: Program, read: ReadMoves, issues: list[Issue]) -> Verification:
    """Tips and directions of a text for a machine with rotary axes, which finds its linear axes itself, and the planned
    axis values against the same points. Such a controller takes the tip straight from point to point."""
    joints = np.concatenate([moves.joints for moves in program.moves])
    path, flange = _joint_path(cell, joints, np.zeros(joints.shape[1]))
    told = _text_tips(cell, program, read)
    if read.joints is not None:
        issues += _joint_issues(cell, planned, read, _shorter_way(cell, program, read))
    issues += _point_issues(planned, path) + _point_issues(planned, told)
    solver_issues, solvers = _second_opinion(cell, planned, joints, flange)
    at_points = float(np.linalg.norm(told.position - planned.position, axis=1).max())
    return Verification(tuple(issues + solver_issues), at_points, 0.0, float(told.bound.max()), solvers)


def _text_tips(cell: Cell, program: Program, read: ReadMoves) -> _Path:
    """Tips and tool axes of a text in part coordinates, by its positions and its directions, or else its rotary axes; of
    the rows it tells in axes, by these."""
    assert read.position is not None and program.carried is not None
    in_part = cell.mount @ frames.inverse(cell.carried) @ frames.bryant(program.carried)
    position = read.position @ in_part[:3, :3].T + in_part[:3, 3]
    bound = np.full(len(position), np.sqrt(3.0) * read.position_digits + COMPUTED_MM)
    tool, tool_bound = np.full_like(position, np.nan), np.zeros(len(position))
    if read.direction is not None:
        length = np.linalg.norm(read.direction, axis=1)
        tool = (read.direction / np.maximum(length, 1e-300)[:, None]) @ in_part[:3, :3].T
        tool_bound = np.sqrt(3.0) * read.direction_digits / np.maximum(length, 1e-300) + COMPUTED_AXIS
    elif read.joints is not None:  # where the linear axes stand does not turn the tool
        told, _ = _joint_path(cell, np.where(cell.machine.chain.sliding, 0.0, read.joints), _digits(cell, read))
        tool, tool_bound = told.tool, told.tool_bound
    if read.joints is not None:
        rows = np.isfinite(read.joints).all(axis=1)  # told in axes
        path, _ = _joint_path(cell, read.joints[rows], _digits(cell, read))
        position[rows], tool[rows], bound[rows], tool_bound[rows] = path.position, path.tool, path.bound, path.tool_bound
    return _Path(position, tool, bound, tool_bound)


def _text_path(cell: Cell, program: Program, read: ReadMoves) -> tuple[_Path, Array, Array]:
    """The path of a text with positions, the flange poses and the tools (n, 4, 4) on the flange it asks for.

    Texts without frames of their own count on the user frame that the program tells of. Every frame is off by half a
    digit: its origin by at most sqrt(3) of it, its rotation by three angles; a frame that does not turn the target about
    itself has no lever.
    """
    assert read.position is not None and read.rotation is not None
    count, lever = 1, np.zeros(len(read.position))
    user = cell.station if program.station is None else cell.machine.base @ frames.bryant(program.station)
    seen, tools = user @ frames.pose(read.rotation, read.position), np.broadcast_to(cell.carried, (len(lever), 4, 4))
    if read.frame is not None and read.tool is not None:
        count, tools = 3, read.tool
        seen = cell.machine.base @ read.frame @ frames.pose(read.rotation, read.position)
        lever = np.linalg.norm(read.position, axis=1)
        if read.lever is not None and read.lever.any():
            count, lever = 4, lever + read.lever
    asked = seen @ frames.inverse(tools)
    bound = count * np.sqrt(3.0) * read.position_digits + 3.0 * read.rotation_digits * lever + COMPUTED_MM
    tool_bound = np.full(len(bound), 3.0 * count * read.rotation_digits + COMPUTED_AXIS)
    position, tool = cell.tip_in_part(asked)
    if read.joints is not None:
        rows = np.isfinite(read.joints).all(axis=1)
        path, asked[rows] = _joint_path(cell, read.joints[rows], _digits(cell, read))
        position[rows], tool[rows], bound[rows], tool_bound[rows] = path.position, path.tool, path.bound, path.tool_bound
    return _Path(position, tool, bound, tool_bound), asked, tools


def _straight(start: Array, end: Array) -> Array:
    """(n, len(BETWEEN), 4, 4) poses on the way from start to end (n, 4, 4): straight, turning about one axis."""
    turn = np.swapaxes(start[:, :3, :3], 1, 2) @ end[:, :3, :3]
    axis = 0.5 * np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], 1)
    sine = np.linalg.norm(axis, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0))
    axis = np.where(sine[:, None] > 1e-12, axis / np.maximum(sine, 1e-12)[:, None], [0.0, 0.0, 1.0])
    spun = start[:, None, :3, :3] @ frames.rotation_about(axis[:, None], BETWEEN * angle[:, None])
    return frames.pose(spun, start[:, None, :3, 3] + BETWEEN[:, None] * (end - start)[:, None, :3, 3])
