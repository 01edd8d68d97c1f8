# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which of the mechanisms known suits a robot and a part: positioners and tracks, the likeliest first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ..issues import InputError
from .external import MECHANISMS
from .links.solids import Solid
from .machines import machine as machines
from .machines.machine import Machine
from .urdf.machine import is_mechanism


def positioners(
    robot: Machine, mass: float, radius: float, folders: Sequence[str] = ()
) -> list[Machine]:
    """Return positioners with one or two revolute axes that carry a part of a mass, kg, as far
    as their files say.

    The order: those with a table as wide as the part, `radius` mm about its axis; those with
    known speeds; those of the robot's manufacturer; those with the lowest rating.
    """
    candidates = [
        machine
        for machine in _known(folders)
        if not machine.chain.sliding.any() and machine.payload.kg >= mass
    ]
    return sorted(
        candidates, key=lambda machine: (_table(machine) < radius, *_rank(robot, machine))
    )


def tracks(robot: Machine, folders: Sequence[str] = ()) -> list[Machine]:
    """Return tracks with one prismatic axis, those of the robot's manufacturer first."""
    candidates = [
        machine
        for machine in _known(folders)
        if machine.chain.axes == 1 and machine.chain.sliding.all()
    ]
    return sorted(candidates, key=lambda machine: _rank(robot, machine))


def _rank(robot: Machine, machine: Machine) -> tuple[bool, bool, float, str]:
    unknown = not np.isfinite(machine.max_speed).all()
    return (
        unknown,
        machine.title.split()[0] != robot.title.split()[0],
        machine.payload.kg,
        machine.id,
    )


def _known(folders: Sequence[str]) -> list[Machine]:
    """Return all mechanisms in the user's folders and built in; files that are wrong or hold no
    mechanism are left out.
    """
    mechanisms: dict[str, Machine] = {}
    for folder in [MECHANISMS, *map(Path, folders)]:
        for path in sorted(folder.expanduser().glob("*.json")):
            try:
                machine = machines.load(str(path))
            except InputError:
                continue
            if is_mechanism(machine.chain):
                mechanisms[path.stem] = machine
    return list(mechanisms.values())


def _table(machine: Machine) -> float:
    """Return the extent of the last link from its axis, mm; infinite if unknown."""
    point_sets = [
        solid.points
        for solid in (machine.bodies[-1] if machine.bodies else ())
        if isinstance(solid, Solid)
    ]
    if not point_sets:
        return math.inf
    axis = machine.chain.directions[-1]
    return float(np.linalg.norm(np.cross(np.concatenate(point_sets), axis), axis=1).max())
