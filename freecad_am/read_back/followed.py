# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solve for the joints with which a machine follows the positions of a text.

A solution has the configuration named in the text. Without one, it is the solution nearest to the
previous joints.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..core.geometry import frames
from ..core.geometry.frames import TURN
from ..core.issues import InputError
from ..core.kinematics.cell import Cell
from ..core.kinematics.inverse import spherical_wrist
from ..core.kinematics.inverse.five_axis import FiveAxis
from ..core.motion import Motion
from ..core.program import Program
from ..core.read_moves import Event, ReadMoves
from ..core.types import Array, Index, Integers, Mask
from . import text_path
from .text_path import Path, pieces


def by_robot(cell: Cell, text: ReadMoves, flanges: Array) -> Array:
    """Return serial joints (n, axes) of a robot cell for `flanges` (n, 4, 4); NaN out of reach.

    Rows with joint values in the text keep them. Raises InputError NO_CONFIGURATION if the text
    starts with a position without a configuration or nearby joint values, and the cell does not set
    a configuration either.
    """
    machine, robot_axes = cell.machine, cell.robot.chain.axes
    controller_values = (
        np.full((len(flanges), machine.chain.axes), np.nan) if text.joints is None else text.joints
    )
    unknown = np.isnan(controller_values[:, :robot_axes]).any(axis=1)
    serial = np.full_like(controller_values, np.nan)
    serial[~unknown] = machine.from_controller(controller_values[~unknown])
    if cell.external is not None:  # every position has values of the external axes
        external = machine.from_controller(
            np.where(np.isnan(controller_values), 0.0, controller_values)
        )[:, robot_axes:]
        flanges, serial[:, robot_axes:] = (
            frames.inverse(cell.external.base(external)) @ flanges,
            external,
        )
    if text.near is not None:
        near_rows = unknown & np.isfinite(text.near).all(axis=1)
        serial[near_rows, :robot_axes] = _nearest_turns(
            cell, flanges[near_rows], machine.from_controller(text.near[near_rows])[:, :robot_axes]
        )
        unknown &= ~near_rows
    for start, end in _runs(unknown):
        previous = serial[start - 1, :robot_axes] if start else np.full(robot_axes, np.nan)
        serial[start:end, :robot_axes] = _arm(cell, text, flanges, slice(start, end), previous)
    return serial


def by_table(cell: Cell, text: ReadMoves, path: Path) -> Array:
    """Return serial joints (n, 5) of a five-axis machine for a tip path; NaN if unreachable.

    A rotary axis that the direction does not determine stays where it is.
    """
    assert text.joints is not None
    serial = cell.machine.from_controller(text.joints)
    solver, unknown = FiveAxis(cell.machine.chain), np.isnan(text.joints).any(axis=1)
    points, tools = cell.poses.to_flange(path.position, path.tool)
    turning = list(solver.turning)
    for start, end in _runs(unknown):
        rows = slice(start, end)
        previous = serial[start - 1, turning] if start else np.zeros(2)
        turned = serial[rows, turning]
        if np.isnan(turned).any():
            solutions, free = solver.inverse(points[rows], tools[rows], cell.poses.station)
            turned = _nearest(np.moveaxis(solutions[..., turning], 0, 1), free, previous)
        serial[rows] = solver.place_points(turned, points[rows], cell.poses.station)
    return serial


def _runs(mask: Mask) -> list[tuple[int, int]]:
    """Return the first row and the end (exclusive) of each run of rows in a mask."""
    edges = np.flatnonzero(np.diff(mask, prepend=False, append=False)).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def _arm(cell: Cell, text: ReadMoves, flanges: Array, rows: slice, previous: Array) -> Array:
    """Return arm joints (k, 6) at consecutive rows of the text that follow the joints `previous`
    (6,).
    """
    arm = cell.robot.arm
    assert arm is not None
    solutions = [
        arm.solutions(flanges[rows][rows_now])
        for rows_now in pieces(np.arange(rows.stop - rows.start))
    ]
    joint_solutions = np.concatenate([np.moveaxis(joints, 0, 1) for joints, _ in solutions])
    if text.configuration is not None:
        return _as_named(
            cell, text, joint_solutions, np.concatenate([words.T for _, words in solutions]), rows
        )
    if not np.isfinite(previous).all():
        if cell.branch is None:
            raise InputError(
                "NO_CONFIGURATION",
                "program",
                "the program starts with a position without arm configuration; set the "
                "configuration in the cell, such as branch: [front, up, flip]",
            )
        previous = joint_solutions[0, cell.branch]
    return _nearest(
        joint_solutions,
        np.zeros((len(joint_solutions), joint_solutions.shape[2]), dtype=bool),
        previous,
    )


def _nearest_turns(cell: Cell, flanges: Array, reference: Array) -> Array:
    """Return the joints (k, 6) of flange poses (k, 4, 4) nearest to `reference` (k, 6), unwrapped
    to it.
    """
    arm = cell.robot.arm
    assert arm is not None
    solutions = np.moveaxis(arm.inverse(flanges), 0, 1)
    nearest = solutions[
        np.arange(len(solutions)), _joint_distance(reference[:, None], solutions).argmin(axis=1)
    ]
    unwrapped: Array = nearest + TURN * np.rint((reference - nearest) / TURN)
    return unwrapped


def _as_named(cell: Cell, text: ReadMoves, solutions: Array, words: Index, rows: slice) -> Array:
    """Select the solutions with the configuration and turns named in the text.

    solutions: (k, configurations, 6). words: (k, configurations), the configuration index of each
    solution.
    """
    configuration = text.configuration
    assert configuration is not None
    names = np.array([spherical_wrist.branch_name(index) for index in range(8)])[words]
    # controllers call the sign of axis 5, in their own counting direction, flip
    controller_values = cell.robot.to_controller(solutions)
    named = (names[..., 0] == "front") == configuration.front[rows, None]
    named &= (names[..., 1] == "up") == configuration.up[rows, None]
    named &= (
        ((controller_values[..., 4] > 0.0) == configuration.flip[rows, None])
        & np.isfinite(solutions).all(axis=2)
        & (words >= 0)
    )
    if configuration.turns[rows, :-1].any():
        raise InputError(
            "NOT_YET",
            "program",
            "the program gives turn numbers for axes other than the last axis, which cannot be "
            "simulated; use joint values for these positions",
        )
    named_values = controller_values[np.arange(len(solutions)), named.argmax(axis=1)]
    named_values -= TURN * np.rint(named_values / TURN)
    named_values[:, -1] += TURN * configuration.turns[rows, -1]
    joints: Array = np.where(
        named.any(axis=1)[:, None], cell.robot.from_controller(named_values), np.nan
    )
    return joints


def _nearest(solutions: Array, free: Mask, previous: Array) -> Array:
    """Return the solutions (k, axes) nearest to the previous row, unwrapped; the first row follows
    `previous`.

    solutions: (k, configurations, axes). free: (k, axes) values that do not matter, so they repeat
    the previous value.
    """
    first_choice = int(_joint_distance(solutions[0], previous).argmin())
    choices = [first_choice]
    for rows in pieces(np.arange(len(solutions) - 1)):
        distances = _joint_distance(solutions[rows, :, None], solutions[rows + 1, None])
        nearest = np.where(
            np.isfinite(distances).any(axis=2),
            distances.argmin(axis=2),
            np.arange(solutions.shape[1]),
        )
        for successors in nearest.tolist():
            choices.append(successors[choices[-1]])
    joints = np.vstack([previous, solutions[np.arange(len(solutions)), choices]])
    # a free value repeats the last value that the direction determined
    bound = np.vstack([np.ones(len(previous), dtype=bool), ~free])
    last_bound = np.maximum.accumulate(np.where(bound, np.arange(len(joints))[:, None], 0), axis=0)
    joints = np.take_along_axis(joints, last_bound, axis=0)
    reached = np.isfinite(joints).all(axis=1)
    joints[reached] = np.unwrap(joints[reached], axis=0)
    return joints[1:]


def _joint_distance(joints: Array, reference: Array) -> Array:
    """Return the distance (...) of joints (..., axes) from reference joints modulo whole turns.

    Missing joints give infinity.
    """
    turned = joints - reference
    distances = np.abs(turned - TURN * np.rint(turned / TURN)).max(axis=-1)
    return np.where(np.isnan(distances), np.inf, distances)


@dataclass(frozen=True, eq=False)
class DrivenBead:
    """A bead in the form that collision checks need, without width and height."""

    points: Array
    build: Array
    tool: Array
    width: None = None
    height: None = None


def drive(cell: Cell, program: Program, text: ReadMoves) -> Motion:
    """Return the motion along a text in part coordinates; joints are NaN at unreachable positions.

    program: provides the cell data; its moves are not used. Build directions are tool axes. Widths
    are unknown. Raises InputError NO_CONFIGURATION if the text does not give the arm configuration
    at its start.
    """
    path, serial = _drive(cell, program, text)
    seconds = _durations(cell, text, path.position, serial)
    starts = _starts(text)
    # the first row of a bead repeats the current position
    inserted = np.maximum(starts - 1, 0)
    rows = np.insert(np.arange(len(text.deposit)), starts, inserted)
    fresh = np.insert(np.zeros(len(text.deposit), dtype=bool), starts, True)
    deposit = text.deposit[rows] | fresh
    layer, bead, point = _places(deposit, fresh, _layers(text.events, starts))
    duration = np.where(fresh, 0.0, seconds[rows])
    position, tool = path.position[rows], path.tool[rows]
    step_lengths = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    speed = np.divide(step_lengths, duration, out=np.zeros(len(step_lengths)), where=duration > 0.0)
    return Motion(
        deposit=deposit,
        layer=layer,
        bead=bead,
        point=point,
        position=position,
        build=tool,
        tool=tool,
        speed=speed,
        width=np.full(len(rows), np.nan),
        joints=serial[rows],
        duration=duration,
    )


def beads(motion: Motion) -> list[DrivenBead]:
    """Return the beads of a motion, in order."""
    deposited = np.flatnonzero(motion.deposit)
    row_groups = (
        np.split(deposited, np.flatnonzero(motion.point[deposited] == 0)[1:])
        if len(deposited)
        else []
    )
    return [
        DrivenBead(motion.position[rows], motion.build[rows], motion.tool[rows])
        for rows in row_groups
    ]


def _drive(cell: Cell, program: Program, text: ReadMoves) -> tuple[Path, Array]:
    """Return the tip path of the text and its serial joints (n, axes)."""
    machine, continuous = cell.machine, text_path.shorter_way(cell, program, text)
    if text.position is None:
        assert text.joints is not None
        controller_values = _in_turns(text.joints, continuous)
        return text_path.joint_path(cell, controller_values, text_path.digits(cell, text))[
            0
        ], machine.from_controller(controller_values)
    if not cell.machine.free:
        path = text_path.text_tips(cell, program, text)
        serial = by_table(cell, text, path)
    else:
        path, flanges, _ = text_path.text_path(cell, program, text)
        serial = by_robot(cell, text, flanges)
    return path, machine.from_controller(_in_turns(machine.to_controller(serial), continuous))


def _in_turns(controller_values: Array, continuous: Mask) -> Array:
    """Return controller values (n, axes) with the shorter-way axes unwrapped from row to row."""
    unwrapped, reached = np.array(controller_values), np.isfinite(controller_values).all(axis=1)
    unwrapped[np.ix_(reached, continuous)] = np.unwrap(
        unwrapped[np.ix_(reached, continuous)], axis=0
    )
    return unwrapped


def _durations(cell: Cell, text: ReadMoves, position: Array, serial: Array) -> Array:
    """Return the duration (n,) of each move, s.

    The text gives a time, a tip speed, or a fraction of the maximum axis speeds. The first move has
    0 s because its start is unknown.
    """
    step_lengths = np.linalg.norm(np.diff(position, axis=0, prepend=position[:1]), axis=1)
    turned = np.abs(np.diff(cell.machine.to_controller(serial), axis=0, prepend=np.nan))
    with np.errstate(invalid="ignore"):
        quickest = np.nan_to_num((turned / cell.machine.max_speed).max(axis=1))
    seconds = text.duration
    if text.speed is not None:
        by_speed = np.divide(
            step_lengths, text.speed, out=np.full(len(step_lengths), np.nan), where=text.speed > 0.0
        )
        # a tip speed has no meaning if the tip does not move
        seconds = np.where(
            np.isnan(seconds),
            np.maximum(by_speed, np.where(step_lengths > 0.0, 0.0, quickest)),
            seconds,
        )
    if text.share is not None:
        seconds = np.where(np.isnan(seconds), quickest / text.share, seconds)
    seconds = np.where(np.isnan(seconds), quickest, seconds)
    seconds[:1] = 0.0
    return seconds


def _starts(text: ReadMoves) -> Index:
    """Return the first moves of beads, where the deposit starts or restarts."""
    begins = np.diff(text.deposit, prepend=False) & text.deposit
    on = [event.row for event in text.events if event.kind == "on" and event.row < len(begins)]
    begins[on] |= text.deposit[on]
    return np.flatnonzero(begins)


def _layers(events: tuple[Event, ...], starts: Index) -> Integers:
    """Return the layers (beads,) at the moves `starts` from the layer remarks; 0 without remarks."""
    layers = [(event.row, int(float(event.value[0]))) for event in events if event.kind == "layer"]
    if not layers:
        return np.zeros(len(starts), dtype=np.int64)
    rows, numbers = np.array(layers, dtype=np.int64).T
    return np.asarray(
        numbers[np.maximum(np.searchsorted(rows, starts, side="right") - 1, 0)], dtype=np.int64
    )


def _places(deposit: Mask, fresh: Mask, layers: Integers) -> tuple[Integers, ...]:
    """Return layer, bead and point (n,) of the rows. Rapids have the bead that follows.

    fresh: (n,) the first rows of beads.
    """
    if not len(layers):
        nowhere = np.zeros(len(deposit), dtype=np.int64)
        return nowhere, nowhere, np.arange(len(deposit))
    # bead numbers restart in each layer
    numbers = np.zeros(len(layers), dtype=np.int64)
    for layer in np.unique(layers):
        same = layers == layer
        numbers[same] = np.arange(same.sum())
    bead_counts = np.cumsum(fresh)
    bead_numbers = np.minimum(np.where(deposit, bead_counts - 1, bead_counts), len(layers) - 1)
    changed = np.flatnonzero(fresh | np.append(True, deposit[1:] != deposit[:-1]))
    point = np.arange(len(deposit)) - np.repeat(changed, np.diff(np.append(changed, len(deposit))))
    return layers[bead_numbers], numbers[bead_numbers], point
