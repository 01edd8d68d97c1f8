# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cells that may make an infeasible job feasible: a moved positioner, or added external axes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ...geometry import frames
from ...geometry.obstacles import enclosed_volume
from ...issues import Text
from ...kinematics import external
from ...kinematics.arrangement import arrangement_of
from ...kinematics.machines import machine as machines
from ...kinematics.machines.machine import Machine
from ...parameters.cell import CellParameters
from ...parameters.cell_records import EXTERNAL_KEY, PART, ROBOT, ExternalMechanism
from ...parameters.process import ProcessParameters
from ...parameters.records import Pose
from ...toolpath import Toolpath
from ...types import Array

Cells = Iterator[tuple[str, CellParameters]]

# distance of the face ahead of the shoulder, as a fraction of the arm reach, and its offset from
# the given height, mm
AHEAD = ((0.75, 0.0), (0.6, 0.0), (0.9, 0.0), (0.75, 300.0), (0.6, -300.0))
MAX_POSITIONERS = 2  # maximum number of positioners to try, the most likely first
TRACK_SHARE = 0.6  # minimum part length for a track, fraction of the reach
NOT_LEVEL, AUTO = "NOT_LEVEL", "{} and `cell.branch: auto`"


def move_positioner(settings: CellParameters, folders: Sequence[str]) -> Cells:
    """Yield cells with the positioner, and everything that carries the part, moved towards or away
    from the robot.

    Yield nothing without a positioner.
    """
    named = settings.external
    carriers = [k for k, mechanism in enumerate(named) if mechanism.carries == PART]
    robot = machines.load(settings.machine, tuple(folders))
    if not carriers or robot.arm is None:
        return
    last_carrier = named[carriers[-1]]
    face = _face(external.load(last_carrier.machine, tuple(folders)), last_carrier.pose)
    for position in _before(robot, face[:2], float(face[2])):
        changed = list(named)
        for k in carriers:
            x, y, z, a, b, c = named[k].pose
            moved = np.round((x, y, z) + (position - face))
            changed[k] = dataclasses.replace(
                named[k], pose=(float(moved[0]), float(moved[1]), float(moved[2]), a, b, c)
            )
        remedy = Text.joined(
            " and ",
            (
                Text("`{}[{}].pose: {}`", EXTERNAL_KEY, k, _format_pose(changed[k].pose))
                for k in carriers
            ),
        )
        yield remedy, dataclasses.replace(settings, external=tuple(changed))


def added(
    settings: CellParameters,
    folders: Sequence[str],
    toolpath: Toolpath,
    codes: set[str],
    mass: float = 0.0,
) -> Cells:
    """Yield cells with a positioner or a track added.

    A positioner helps if the tool axes must not tilt. A track helps with a long part. Mechanisms of
    the robot's manufacturer are preferred.

    Parameters
    ----------
    settings : CellParameters
        The cell of the infeasible job.
    folders : sequence of str
        Folders with user machines.
    toolpath : Toolpath
        The toolpath in part coordinates.
    codes : set[str]
        Error codes; NOT_LEVEL calls for a positioner.
    mass : float, optional
        Load of the positioner, kg.

    Yields
    ------
    (Text, CellParameters)
        The change as a remedy, and the cell. Nothing if the cell has external axes already or
        the robot holds the part.
    """
    robot = machines.load(settings.machine, tuple(folders))
    if settings.external or arrangement_of(settings.setup).carries_part or robot.arm is None:
        return
    platform = np.array(settings.deposition_point[:3])
    points = np.concatenate([bead.points for _, _, bead in toolpath])
    if NOT_LEVEL in codes:
        to_part = frames.inverse(toolpath.frame)
        radius = float(
            np.linalg.norm((points @ to_part[:3, :3].T + to_part[:3, 3])[:, :2], axis=1).max()
        )
        for suited in external.positioners(robot, mass, radius, folders)[:MAX_POSITIONERS]:
            face = _face(suited, (0.0,) * 6)
            for position in _before(robot, platform[:2], float(face[2]))[:3]:
                x, y, _ = position - face
                mechanism = ExternalMechanism(
                    suited.id, (float(round(x)), float(round(y)), 0.0, 0.0, 0.0, 0.0), PART
                )
                yield (
                    Text(AUTO, _key_text(mechanism)),
                    dataclasses.replace(settings, external=(mechanism,), branch="auto"),
                )
        return
    spans = np.ptp(points, axis=0)
    longest = int(spans.argmax())
    if spans[longest] < TRACK_SHARE * robot.arm.reach:
        return
    along = frames.bryant(settings.deposition_point)[:3, :3][:, longest]
    turn = math.atan2(along[1], along[0]) if math.hypot(along[0], along[1]) > 0.5 else 0.5 * math.pi
    for track in external.tracks(robot, folders)[:1]:
        height = float(track.chain.forward(np.zeros(1))[2, 3])
        mechanism = ExternalMechanism(track.id, (0.0, 0.0, -height, 0.0, 0.0, turn), ROBOT)
        yield (
            Text(AUTO, _key_text(mechanism)),
            dataclasses.replace(settings, external=(mechanism,), branch="auto"),
        )


def weight(toolpath: Toolpath, process: ProcessParameters) -> float:
    """Return the mass of the beads and of the closed bodies below them, kg."""
    volume = enclosed_volume(toolpath.surroundings)[0]
    usual = toolpath.bead_width or process.bead_width
    for _, _, bead in toolpath:
        width = usual if bead.width is None else float(np.mean(bead.width))
        volume += (
            width
            * toolpath.layer_height
            * float(np.linalg.norm(np.diff(bead.points, axis=0), axis=1).sum())
        )
    return 1e-6 * process.density * volume  # g/cm3 times mm3


def _face(mechanism: Machine, pose: Pose) -> Array:
    """Return the position (3,) of the face in the world with the axes at zero, mm."""
    face_pose = (
        frames.bryant(pose)
        @ frames.inverse(mechanism.base)
        @ mechanism.chain.forward(np.zeros(mechanism.chain.axes))
    )
    return np.asarray(face_pose[:3, 3])


def _before(robot: Machine, towards: Array, height: float) -> list[Array]:
    """Return world positions (3,) in front of a robot, towards a point (2,), near `height`."""
    assert robot.arm is not None  # the caller has checked this
    shoulder, _ = robot.arm.shoulder
    turn = math.atan2(towards[1], towards[0]) if math.hypot(*towards) > 1.0 else 0.0
    out = np.array([math.cos(turn), math.sin(turn)])
    return [
        np.array([*((shoulder + share * robot.arm.reach) * out), height + up])
        for share, up in AHEAD
    ]


def _key_text(mechanism: ExternalMechanism) -> str:
    return f"`{EXTERNAL_KEY}: [{{machine: {mechanism.machine}, pose: {_format_pose(mechanism.pose)}, carries: {mechanism.carries}}}]`"


def _format_pose(pose: Any) -> str:
    values = (*pose[:3], *(math.degrees(angle) for angle in pose[3:]))
    return f"[{', '.join(f'{value + 0.0:.10g}' for value in values)}]"
