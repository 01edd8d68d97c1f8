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
    """Those of one or two turning axes that carry a part of a mass, kg, as far as their files tell: first those whose table
    is as wide as the part, `radius` mm about its axis, of these those whose speeds are known, then those of the robot's
    maker, then those rated lowest."""
    some = [
        one for one in _known(folders) if not one.chain.sliding.any() and one.payload.kg >= mass
    ]
    return sorted(some, key=lambda one: (_table(one) < radius, *_rank(robot, one)))


def tracks(robot: Machine, folders: Sequence[str] = ()) -> list[Machine]:
    """Those of one axis that slides, of the robot's maker first."""
    some = [one for one in _known(folders) if one.chain.axes == 1 and one.chain.sliding.all()]
    return sorted(some, key=lambda one: _rank(robot, one))


def _rank(robot: Machine, one: Machine) -> tuple[bool, bool, float, str]:
    unknown = not np.isfinite(one.max_speed).all()
    return unknown, one.title.split()[0] != robot.title.split()[0], one.payload.kg, one.id


def _known(folders: Sequence[str]) -> list[Machine]:
    """All mechanisms of the user's folders and built in; files that are none, or wrong, are left out."""
    found: dict[str, Machine] = {}
    for folder in [MECHANISMS, *map(Path, folders)]:
        for path in sorted(folder.expanduser().glob("*.json")):
            try:
                one = machines.load(str(path))
            except InputError:
                continue
            if is_mechanism(one.chain):
                found[path.stem] = one
    return list(found.values())


def _table(one: Machine) -> float:
    """mm from its last axis to where its last link ends; infinite where that is not known."""
    pieces = [
        piece.points for piece in (one.bodies[-1] if one.bodies else ()) if isinstance(piece, Solid)
    ]
    if not pieces:
        return math.inf
    axis = one.chain.directions[-1]
    return float(np.linalg.norm(np.cross(np.concatenate(pieces), axis), axis=1).max())
