# SPDX-License-Identifier: LGPL-2.1-or-later
"""Compute tip path and joints of a text, with the error bounds due to its rounding.

The joint-frame chain computes the path from joint values, independent of the planner's closed form.
For texts with positions, a Newton step from the planned joints with the chain's Jacobian gives the
joint values.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.geometry import frames
from ..core.issues import ERROR, Issue, Text
from ..core.kinematics.cell import Cell
from ..core.kinematics.chain import JointFrames
from ..core.motion import Motion
from ..core.program import Program
from ..core.read_moves import ReadMoves
from ..core.types import Array, Index, Mask

# rounding error of the computation itself: mm, and of unit vectors
COMPUTED_MM, COMPUTED_AXIS = 1e-6, 1e-9
PIECE = 4096  # moves in one batch; the poses of a whole program would take too much memory


class Planned:
    """The motion rows that a controller moves to. Also builds issues with their position in the
    job.
    """

    def __init__(self, motion: Motion, rows: Index) -> None:
        self.rows, self.motion = rows, motion
        self.deposit, self.joints = motion.deposit[rows], motion.joints[rows]
        self.position, self.tool = motion.position[rows], motion.tool[rows]
        self.duration, self.speed = motion.duration[rows], motion.speed[rows]
        self.stops, self.halt = motion.stops[rows], motion.halt[rows]
        # moves that start at the end of another move: in beads, and as rapids
        moved = np.arange(len(rows)) > 0
        self.ends, self.rapids = (
            np.flatnonzero(self.deposit & moved),
            np.flatnonzero(~self.deposit & moved),
        )

    def issue(self, code: str, wrong: Mask, message: str) -> list[Issue]:
        """Return an error at the first wrong move, with the number of wrong moves; empty without
        one.
        """
        if not wrong.any():
            return []
        count, first_row = int(wrong.sum()), int(np.argmax(wrong))
        return [
            Issue(
                ERROR,
                code,
                Text("{}; {} of {} moves", message, count, len(wrong)),
                *self.place(first_row),
            )
        ]

    def place(self, move: int) -> tuple[int, int, int]:
        """Return layer, bead and point of a move. An event after the last move uses that move."""
        row = self.rows[min(move, len(self.rows) - 1)]
        layer, bead, point = (
            int(column[row]) for column in (self.motion.layer, self.motion.bead, self.motion.point)
        )
        return layer, bead, point


def pieces(rows: Index) -> list[Index]:
    """Split the rows (n,) into batches."""
    return [rows[start : start + PIECE] for start in range(0, len(rows), PIECE)]


@dataclass(frozen=True, eq=False)
class Path:
    """The tip path of a text in part coordinates, with error bounds due to rounding. Rows are
    moves.
    """

    position: Array
    tool: Array
    bound: Array
    tool_bound: Array


@dataclass(frozen=True, eq=False)
class Joints:
    """Serial joints (n, axes) of a text, rad and mm, and the error bound (n, axes) of each joint."""

    serial: Array
    reach: Array


def given_by_position(cell: Cell, joints: Array) -> Mask:
    """Return the axis values (n, axes) that the controller may derive from a Cartesian position.

    These are the robot's own axes, and the prismatic axes of a five-axis machine. The rotary axes
    of a five-axis machine follow from the tool direction.
    """
    robot_axes = (
        np.arange(joints.shape[1]) < cell.robot.chain.axes
    )  # a position does not determine external axes
    untold = np.isnan(joints[:, robot_axes]).all(axis=1, keepdims=True)
    return np.asarray((cell.machine.chain.sliding | untold) & robot_axes, dtype=np.bool_)


def shorter_way(cell: Cell, program: Program, text: ReadMoves) -> Mask:
    """Return the axes (axes,) that the controller rotates the shorter way: continuous axes of
    robots.

    Rotary axes of machine tools count turns, unless the text states otherwise.
    """
    shorter = not cell.arrangement.named_axes if text.shorter_way is None else text.shorter_way
    return np.array(program.continuous) & shorter


def digits(cell: Cell, text: ReadMoves) -> Array:
    """Return the rounding error of each axis (axes,): half a unit of the last digit, rad and mm."""
    return np.where(cell.machine.chain.sliding, text.linear_digits, text.digits)


def joint_path(cell: Cell, controller_values: Array, half: Array) -> tuple[Path, Array]:
    """Return the path of controller joint values (n, axes) and their flange poses (n, 4, 4).

    half: (axes,) rounding error of the joint values.
    """
    machine, count = cell.machine, len(controller_values)
    path = Path(np.empty((count, 3)), np.empty((count, 3)), np.empty(count), np.empty(count))
    flange = np.empty((count, 4, 4))
    for rows in pieces(np.arange(count)):
        serial = machine.from_controller(controller_values[rows])
        joint_frames = machine.chain.frames(serial)
        flange[rows] = joint_frames.flange
        path.position[rows], path.tool[rows] = cell.tip_in_part(joint_frames.flange)
        path.bound[rows], path.tool_bound[rows] = _bounds(
            cell, joint_frames, machine.controller_matrix, half[None]
        )
    return path, flange


def tip_bounds(cell: Cell, serial: Array, reach: Array) -> tuple[Array, Array]:
    """Return how far tip, (n,) mm, and tool axis, (n,), move at most if joints (n, axes) are off by
    `reach` (n, axes).
    """
    return _bounds(cell, cell.machine.chain.frames(serial), np.eye(serial.shape[1]), reach)


def _bounds(
    cell: Cell, joint_frames: JointFrames, matrix: Array, half: Array
) -> tuple[Array, Array]:
    """Return first-order bounds of tip and tool if matrix @ joints is off by `half`, (n, axes) or
    (1, axes).

    The bound sums the column norms of the Jacobian, weighted by `half`. The second-order term adds
    at most this sum times the sum of the angles.
    """
    slides = cell.machine.chain.sliding
    to_serial = np.linalg.inv(matrix)
    # one row per joint and component, each for all poses
    direction, origin = (
        joint_frames.directions.transpose(1, 2, 0),
        joint_frames.origins.transpose(1, 2, 0),
    )
    lever = cell.deposition_point(joint_frames.flange).T - origin
    linear, angular = np.empty_like(lever), np.array(direction)
    for row, (following, column_2) in enumerate(((1, 2), (2, 0), (0, 1))):
        np.multiply(direction[:, following], lever[:, column_2], out=linear[:, row])
        linear[:, row] -= direction[:, column_2] * lever[:, following]
    linear[slides], angular[slides] = direction[slides], 0.0
    growth = 1.0 + (np.abs(to_serial) @ half.T)[~slides].sum(axis=0)
    columns = [
        (to_serial.T @ rows.reshape(len(rows), -1)).reshape(rows.shape)
        for rows in (linear, angular)
    ]
    moved, turned = (
        (np.sqrt(np.square(rows).sum(axis=1)) * half.T).sum(axis=0) for rows in columns
    )
    return growth * moved + COMPUTED_MM, growth * turned + COMPUTED_AXIS


def text_joints(
    cell: Cell,
    reference: Array,
    controller_values: Array | None,
    half: Array,
    path: Path,
    flanges: Array | None,
) -> Joints:
    """Return the joints of a text from `controller_values` (n, axes) with rounding errors `half`
    (axes,).

    Where a value is missing (NaN), one Newton step from the serial joints `reference` (n, axes)
    moves flange or tip to the position in the text.

    flanges: (n, 4, 4) flange poses of the text; None if the text has only tips and directions.
    """
    machine = cell.machine
    reference_values = machine.to_controller(reference)
    controller_values = (
        np.full_like(reference_values, np.nan) if controller_values is None else controller_values
    )
    unknown = np.isnan(controller_values)
    serial = machine.from_controller(np.where(unknown, reference_values, controller_values))
    reach = np.broadcast_to(np.abs(np.linalg.inv(machine.controller_matrix)) @ half, serial.shape)
    rows = np.flatnonzero(unknown.any(axis=1))
    if len(rows):
        reach = reach.copy()
        columns, errors, about = (
            _to_tip(cell, serial[rows], path, rows)
            if flanges is None
            else _to_flange(cell, serial[rows], path, flanges[rows], rows)
        )
        inverse = np.linalg.pinv(columns * unknown[rows, None, :], rcond=1e-9)
        serial[rows] += np.einsum("nij,nj->ni", inverse, errors)
        solved = np.einsum("nij,nj->ni", np.abs(inverse), about)
        reach[rows] = np.where(unknown[rows], solved, reach[rows])
    return Joints(serial, reach)


# mm per radian; weights directions against positions in one residual
_LEVER = 300.0


def _to_flange(
    cell: Cell, serial: Array, path: Path, flanges: Array, rows: Index
) -> tuple[Array, Array, Array]:
    """Return the flange Jacobian (n, 6, axes), the residual to the target (n, 6) and its bound (n,
    6).

    Units are mm, and radians times `_LEVER`.
    """
    joint_frames = cell.machine.chain.frames(serial)
    slides = cell.machine.chain.sliding[:, None]
    position = joint_frames.flange[:, :3, 3]
    moved = np.where(
        slides,
        joint_frames.directions,
        np.cross(joint_frames.directions, position[:, None, :] - joint_frames.origins),
    )
    turned = np.where(slides, 0.0, joint_frames.directions) * _LEVER
    turn = flanges[:, :3, :3] @ np.swapaxes(joint_frames.flange[:, :3, :3], 1, 2)
    # the angles are as small as the rounding, so their sines are accurate enough
    about = 0.5 * np.stack(
        [
            turn[:, 2, 1] - turn[:, 1, 2],
            turn[:, 0, 2] - turn[:, 2, 0],
            turn[:, 1, 0] - turn[:, 0, 1],
        ],
        1,
    )
    errors = np.hstack([flanges[:, :3, 3] - position, about * _LEVER])
    arm = np.linalg.norm(cell.deposition_point(joint_frames.flange) - position, axis=1)
    off = np.stack(
        [path.bound[rows] + arm * path.tool_bound[rows]] * 3 + [path.tool_bound[rows] * _LEVER] * 3,
        axis=1,
    )
    return np.swapaxes(np.concatenate([moved, turned], axis=2), 1, 2), errors, off


def _to_tip(cell: Cell, serial: Array, path: Path, rows: Index) -> tuple[Array, Array, Array]:
    """Return the Jacobian of the tip and its direction in part coordinates, the residual and its bound.

    The chain moves the part. Shapes and units are as in `_to_flange`.
    """
    joint_frames = cell.machine.chain.frames(serial)
    slides = cell.machine.chain.sliding[:, None]
    tip, tool = cell.tip_in_part(joint_frames.flange)
    lever = cell.deposition_point(joint_frames.flange)[:, None, :] - joint_frames.origins
    moved = np.where(slides, joint_frames.directions, np.cross(joint_frames.directions, lever))
    turned = (
        np.cross(np.where(slides, 0.0, joint_frames.directions), cell.poses.station[:3, 2]) * _LEVER
    )
    into = cell.poses.mount[:3, :3] @ np.swapaxes(
        (joint_frames.flange @ cell.poses.carried)[:, :3, :3], 1, 2
    )
    columns = -np.concatenate(
        [moved @ np.swapaxes(into, 1, 2), turned @ np.swapaxes(into, 1, 2)], axis=2
    )
    errors = np.hstack([path.position[rows] - tip, (path.tool[rows] - tool) * _LEVER])
    off = np.stack([path.bound[rows]] * 3 + [path.tool_bound[rows] * _LEVER] * 3, axis=1)
    return np.swapaxes(columns, 1, 2), errors, off


def text_tips(cell: Cell, program: Program, text: ReadMoves) -> Path:
    """Return tips and tool axes of a text in part coordinates.

    Tips come from the positions. Tool axes come from the directions or the rotary axes. Rows with
    all axis values use the axis values instead.
    """
    assert text.position is not None and program.carried is not None
    in_part = cell.poses.mount @ frames.inverse(cell.poses.carried) @ frames.bryant(program.carried)
    position = text.position @ in_part[:3, :3].T + in_part[:3, 3]
    bound = np.full(len(position), np.sqrt(3.0) * text.position_digits + COMPUTED_MM)
    tool, tool_bound = np.full_like(position, np.nan), np.zeros(len(position))
    if text.direction is not None:
        length = np.linalg.norm(text.direction, axis=1)
        tool = (text.direction / np.maximum(length, 1e-300)[:, None]) @ in_part[:3, :3].T
        tool_bound = (
            np.sqrt(3.0) * text.direction_digits / np.maximum(length, 1e-300) + COMPUTED_AXIS
        )
    elif text.joints is not None:  # the linear axes do not rotate the tool
        path_in_axes, _ = joint_path(
            cell, np.where(cell.machine.chain.sliding, 0.0, text.joints), digits(cell, text)
        )
        tool, tool_bound = path_in_axes.tool, path_in_axes.tool_bound
    if text.joints is not None:
        rows = np.isfinite(text.joints).all(axis=1)  # rows with axis values
        path, _ = joint_path(cell, text.joints[rows], digits(cell, text))
        position[rows], tool[rows], bound[rows], tool_bound[rows] = (
            path.position,
            path.tool,
            path.bound,
            path.tool_bound,
        )
    return Path(position, tool, bound, tool_bound)


def text_path(cell: Cell, program: Program, text: ReadMoves) -> tuple[Path, Array, Array]:
    """Return the path of a text with positions, its flange poses and the tools (n, 4, 4) on the
    flange.

    Rows with joint values use the joint values.
    """
    path, flanges, tools = positions_path(cell, program, text)
    if text.joints is not None:
        rows = np.isfinite(text.joints).all(axis=1)
        joint_rows_path, flanges[rows] = joint_path(cell, text.joints[rows], digits(cell, text))
        path.position[rows], path.tool[rows], path.bound[rows], path.tool_bound[rows] = (
            joint_rows_path.position,
            joint_rows_path.tool,
            joint_rows_path.bound,
            joint_rows_path.tool_bound,
        )
    return path, flanges, tools


def positions_path(cell: Cell, program: Program, text: ReadMoves) -> tuple[Path, Array, Array]:
    """Return path, flange poses and tools from positions only; NaN in rows without a position.

    Texts without frames use the user frame of the program. Rounding displaces each frame by half a
    digit: the origin by at most sqrt(3) times half a digit, the rotation by three angles. A frame
    that does not rotate the target about itself has no lever.
    """
    assert text.position is not None and text.rotation is not None
    count, lever = 1, np.zeros(len(text.position))
    user = (
        cell.poses.station
        if program.station is None
        else cell.machine.base @ frames.bryant(program.station)
    )
    tips, tools = (
        user @ frames.pose(text.rotation, text.position),
        np.broadcast_to(cell.poses.carried, (len(lever), 4, 4)),
    )
    if text.frame is not None and text.tool is not None:
        count, tools = 3, text.tool
        tips = cell.machine.base @ text.frame @ frames.pose(text.rotation, text.position)
        lever = np.linalg.norm(text.position, axis=1)
        if text.lever is not None and text.lever.any():
            count, lever = 4, lever + text.lever
    flanges = tips @ frames.inverse(tools)
    bound = (
        count * np.sqrt(3.0) * text.position_digits
        + 3.0 * text.rotation_digits * lever
        + COMPUTED_MM
    )
    tool_bound = np.full(len(bound), 3.0 * count * text.rotation_digits + COMPUTED_AXIS)
    position, tool = cell.tip_in_part(flanges)
    return Path(position, tool, bound, tool_bound), flanges, tools
