# SPDX-License-Identifier: LGPL-2.1-or-later
"""The lines of a stage of a document."""

from __future__ import annotations

from typing import Any

from ..core.issues import InputError
from ..objects.stage import stage_of
from .lines import Line, of_motion, of_toolpath

KINDS = ("toolpath", "joint path", "program")


def lines_of(obj: Any, rapids: bool = True) -> tuple[Line, ...]:
    """Beads, and where the stage knows them the rapid moves, of a toolpath, a joint path, or a program's joint path.

    Raises InputError for any other object, and for one without a result.
    """
    stage = stage_of(obj)
    if stage is None or stage.kind not in KINDS:
        label = getattr(obj, "Label", repr(obj))
        raise InputError("BAD_INPUT", label, "it has no path; choose a toolpath, joint path or program")
    if stage.kind == "program":
        if obj.JointPath is None:
            raise InputError("NO_INPUT", obj.Label, "its joint path is gone; choose a joint path")
        obj, stage = obj.JointPath, obj.JointPath.Proxy
    value = stage.value(obj)
    lines = of_toolpath(value) if stage.kind == "toolpath" else of_motion(value.motion)
    return lines if rapids else tuple(line for line in lines if line.deposit)
