# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lines of a stage of a document."""

from __future__ import annotations

from typing import Any

from ..core.issues import InputError
from ..core.kinematics.machines import machine
from ..core.motion import Motion
from ..core.simulation import deposit
from ..objects import user_machines
from ..objects.current import check_current
from ..objects.stage import stage_of
from .lines import Line, of_motion, of_toolpath

KINDS = ("toolpath", "joint path", "program")


def lines_of(obj: Any, rapids: bool = True) -> tuple[Line, ...]:
    """Beads, and where the stage knows them the rapid moves, of a toolpath, a joint path, or a program's joint path.

    Raises InputError for any other object, for one without a result, and for one whose result does not fit the document.
    """
    obj = _path_of(obj)
    value = obj.Proxy.value(obj)
    lines = of_toolpath(value) if obj.Proxy.kind == "toolpath" else of_motion(value.motion)
    return lines if rapids else tuple(line for line in lines if line.deposit)


def motion_of(obj: Any) -> tuple[Motion, tuple[str, ...], tuple[str, ...]]:
    """The motion of the same, of a toolpath its beads alone; what tables call the axes, and their units, none of a toolpath.

    Raises InputError as `lines_of`, and where the machine's file is gone.
    """
    obj = _path_of(obj)
    value = obj.Proxy.value(obj)
    if obj.Proxy.kind == "toolpath":
        return deposit.deposit_motion(value), (), ()
    arm = machine.load(obj.Cell.Machine, user_machines.folders())
    return value.motion, arm.columns, arm.units


def _path_of(obj: Any) -> Any:
    """The toolpath or joint path that is meant, whose result fits the document as it is now."""
    stage = stage_of(obj)
    if stage is None or stage.kind not in KINDS:
        label = getattr(obj, "Label", repr(obj))
        raise InputError(
            "BAD_INPUT", label, "it has no path; choose a toolpath, joint path or program"
        )
    path = obj if stage.kind != "program" else obj.JointPath
    if path is None:
        raise InputError("NO_INPUT", obj.Label, "its joint path was deleted; choose a joint path")
    if path.Key:
        check_current(path)
    return path
