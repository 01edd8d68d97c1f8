# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rates of the axes of a motion, and the motion as a JointTrajectory of ROS."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ..motion import Motion
from ..types import Array, Integers
from .timeline import Timeline

NANOSECONDS = 1_000_000_000  # in a second
_MM_PER_M = 1000.0
_DECIMALS = 9  # of positions and velocities: nanometres and nanoradians


@dataclass(frozen=True, eq=False)
class Rates:
    """Axis rates (n, axes) at the n rows of a motion, rad or mm per s, s^2 and s^3.

    NaN in rapids and where unreachable. speed: mean on the segment that ends at the row. acceleration: change of speed
    between the segments before and after the row, NaN at both ends of a bead. jerk: from the previous row to the row.
    """

    speed: Array
    acceleration: Array
    jerk: Array


def rates(motion: Motion) -> Rates:
    """Return the axis rates of a motion at the requested speed."""
    within = motion.deposit & (motion.point > 0) & (motion.duration > 0.0)
    time = np.where(within, motion.duration, np.nan)[:, None]
    speed = np.diff(motion.joints, axis=0, prepend=motion.joints[:1]) / time
    # rows of a bead are consecutive and the first is NaN, so differences across bead ends are NaN
    between = 0.5 * (time[:-1] + time[1:])
    acceleration, jerk = np.full_like(speed, np.nan), np.full_like(speed, np.nan)
    acceleration[:-1] = np.diff(speed, axis=0) / between
    jerk[1:-1] = np.diff(acceleration[:-1], axis=0) / (0.5 * (between[:-1] + between[1:]))
    return Rates(speed, acceleration, jerk)


@dataclass(frozen=True, eq=False)
class JointTrajectory:
    """The m points of a trajectory that a controller interpolates, in the units of ROS.

    names: axis names. time: (m,) ns after the start, ascending without equal values. position,
    velocity: (m, axes) rad and rad/s, of prismatic axes m and m/s.
    """

    names: tuple[str, ...]
    time: Integers
    position: Array
    velocity: Array


def joint_trajectory(
    times: Timeline, names: Sequence[str], is_prismatic: Sequence[bool]
) -> JointTrajectory:
    """Return a motion as points with velocities.

    A wait is two points with equal positions. Velocities are zero where the machine stops. Elsewhere
    a velocity is the derivative of the parabola through a point and its neighbours.

    Parameters
    ----------
    times : Timeline
        The motion with its times, every row reachable.
    names : sequence of str
        Axis names.
    is_prismatic : sequence of bool
        Whether each axis moves along a line, mm in the motion.

    Returns
    -------
    JointTrajectory
        Points from the first row on.

    Raises
    ------
    ValueError
        If a row has no joint values, or the numbers of names and axes differ.
    """
    motion = times.motion
    if not motion.reachable.all() or len(names) != motion.joints.shape[1]:
        raise ValueError("a trajectory needs joint values in all rows, and a name for each axis")
    row = np.repeat(np.arange(len(motion)), 2)
    time = np.round(np.column_stack([times.arrive, times.leave]).ravel() * NANOSECONDS)
    keep = np.diff(time, prepend=-1.0) > 0.0
    row, time = row[keep], time[keep]
    scale = np.where(np.asarray(is_prismatic, dtype=bool), 1.0 / _MM_PER_M, 1.0)
    position = motion.joints[row] * scale
    velocity = np.zeros_like(position)
    step = np.diff(time)[:, None] / NANOSECONDS
    speed = np.diff(position, axis=0) / step
    arriving, leaving = step[:-1], step[1:]  # s
    weighted = leaving * speed[:-1] + arriving * speed[1:]
    velocity[1:-1] = weighted / (arriving + leaving)
    stops = motion.stops | (times.waits > 0.0)
    velocity[stops[row]] = 0.0
    velocity[[0, -1]] = 0.0
    return JointTrajectory(tuple(names), time.astype(np.int64), position, velocity)


def trajectory_text(trajectory: JointTrajectory) -> Iterator[str]:
    """Yield trajectory_msgs/JointTrajectory of ROS 2 as JSON, one point on a line.

    JSON is YAML too, which the tools of ROS read. Accelerations and efforts are empty.

    Yields
    ------
    str
        Pieces of the file.
    """
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    yield f'{{"header": {json.dumps(header)},\n'
    yield f'"joint_names": {json.dumps(trajectory.names)},\n"points": [\n'
    positions = np.round(trajectory.position, _DECIMALS) + 0.0  # without negative zeros
    velocities = np.round(trajectory.velocity, _DECIMALS) + 0.0
    last = len(trajectory.time) - 1
    for number, time in enumerate(trajectory.time.tolist()):
        sec, nanosec = divmod(time, NANOSECONDS)
        point = {
            "positions": positions[number].tolist(),
            "velocities": velocities[number].tolist(),
            "accelerations": [],
            "effort": [],
            "time_from_start": {"sec": sec, "nanosec": nanosec},
        }
        yield json.dumps(point) + (",\n" if number < last else "\n")
    yield "]}\n"
