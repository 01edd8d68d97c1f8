# SPDX-License-Identifier: LGPL-2.1-or-later
"""A joint path in the 3D view: beads coloured by the margin to the machine's limits, rapids and
infeasible points.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np

from ...core.issues import ERROR, InputError
from ...core.kinematics.external import coupled
from ...core.kinematics.machines import machine as machines
from ...core.parameters.cell import CellParameters
from ...core.parameters.strategy import RevolutionParameters
from ...core.simulation.achievable_feed import from_next, speed_ratios
from ...core.types import Array, Integers, Mask
from ...objects import user_machines
from ...objects.results.findings import issues_of
from ..nodes.lines import DASHED, Lines, Points
from ..path.colouring import (
    CONDITION,
    JOINT_KINDS,
    MARGIN,
    RATIO,
    UNREACHABLE,
    Scale,
    by_machine,
    coloured,
    unknown,
)
from ..path.path_view import OPTIONS, TUBES, PathView
from ..path.pieces import Rows
from .toolpath import band_of, width_of


@dataclass(frozen=True, eq=False)
class Course:
    """The columns of a motion of n rows that are drawn; opening a document reads only these
    columns.
    """

    deposit: Mask
    layer: Integers
    bead: Integers
    point: Integers
    position: Array
    width: Array
    joints: Array

    def __len__(self) -> int:
        return len(self.deposit)


@dataclass(frozen=True)
class Seen:
    """The drawn part of a joint path.

    limits: name of the limit set. read: returns the full result, or parts by location.
    """

    course: Course
    limits: str
    read: Callable[..., Any]


class JointPathView(PathView):
    """Draws beads in their order of execution, rapids as thin dashed lines, and a red point at
    every point that the machine does not reach or that has an error.
    """

    icon = "joint_path"
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {
        "Colouring": (
            "App::PropertyEnumeration",
            JOINT_KINDS,
            "Quantity shown by the colours of the beads.",
        ),
        **OPTIONS,
        "ShowRapids": ("App::PropertyBool", True, "Show the rapid moves as thin dashed lines."),
    }
    source_hidden = True

    def __init__(self, vobj: Any) -> None:
        super().__init__(vobj)
        self.source_hidden = False

    def scene(self, root: Any) -> None:
        super().scene(root)
        self.rapids = Lines(1.0, (0.45, 0.45, 0.5), DASHED)
        self.wrong = Points(7.0, UNREACHABLE)
        root.addChild(self.rapids.node)
        root.addChild(self.wrong.node)

    def read(self, obj: Any) -> Seen:
        """Return the drawn part of the result."""
        columns = [("motion", column.name) for column in fields(Course)]
        reader = obj.Proxy.reader(obj)
        limits, *arrays = reader(("joint_path", "limits"), *columns)
        return Seen(Course(*arrays), limits, reader)

    def rows_of(self, obj: Any, value: Seen) -> Rows:
        course, width = value.course, width_of(_linked(obj))
        height = (
            _layer_height(obj) if obj.ViewObject.Look == TUBES else None
        )  # lines do not need the toolpath
        starts = np.flatnonzero(course.point[self.at] == 0)
        bead_widths = course.width[self.at]
        return Rows(
            course.position[self.at],
            np.append(starts, len(self.at)),
            course.layer[self.at[starts]],
            np.where(np.isfinite(bead_widths), bead_widths, width),
            lambda: [path.bead for path in value.read().joint_path.beads],
            lambda: _known_layer_height(obj) if height is None else height,
            lambda index: value.read(("joint_path", "beads", index, "bead"))[0],
        )

    def draw(self, obj: Any, value: Seen) -> None:
        self.seen, motion = value, value.course
        self.motion, self.at = (
            motion,
            np.flatnonzero(motion.deposit),
        )  # the motion row of each point
        self.reachable = np.logical_and.reduce([np.isfinite(column) for column in motion.joints.T])
        self.rapid = np.flatnonzero(~motion.deposit[1:]) + 1
        self.find_wrong(obj)
        super().draw(obj, value)
        if not self.source_hidden:  # the beads coincide with those of the toolpath
            self.source_hidden = True
            obj.Toolpath.ViewObject.Visibility = False

    def find_wrong(self, obj: Any) -> None:
        """Find the motion rows that the machine does not reach, or that have an error."""
        motion, layers = self.motion, self.motion.layer[self.at]  # ascending
        wrong = motion.deposit & ~self.reachable
        for issue in issues_of(obj):
            if issue.level == ERROR and issue.layer is not None:
                rows = self.at[slice(*np.searchsorted(layers, [issue.layer, issue.layer + 1]))]
                for column, index in ((motion.bead, issue.bead), (motion.point, issue.point)):
                    rows = rows if index is None else rows[column[rows] == index]
                wrong[rows] = True
        self.bad = np.flatnonzero(wrong)

    def updateData(self, obj: Any, name: str) -> None:
        """Handle a changed property of the object. Undo and redo may restore issues after their
        result.
        """
        super().updateData(obj, name)
        if name == "Issues" and self.rows is not None and not obj.Document.Restoring:
            self.find_wrong(obj)
            self.limited(*self.stretch())

    def limited(self, start: int, end: int) -> None:
        # including the rapids before the first bead
        low = 0 if start == 0 else int(self.at[start - 1]) + 1
        high = len(self.motion) if end >= len(self.at) else int(self.at[max(end - 1, 0)]) + 1
        rapid = self.rapid[(self.rapid >= low) & (self.rapid < high)]
        self.rapids.set(
            np.stack([self.motion.position[rapid - 1], self.motion.position[rapid]], axis=1),
            np.full(len(rapid), 2),
        )
        self.wrong.set(self.motion.position[self.bad[(self.bad >= low) & (self.bad < high)]])

    def style(self, vobj: Any) -> None:
        super().style(vobj)
        self.rapids.show(vobj.ShowRapids)

    def coloured(self, obj: Any, kind: str) -> tuple[Array, Scale]:
        if kind == CONDITION:
            condition = np.concatenate(
                [path.condition for path in self.seen.read().joint_path.beads]
            )
            return by_machine(np.where(self.reachable[self.at], condition, np.nan), kind)
        if kind in (MARGIN, RATIO):
            try:
                return by_machine(_limit_shares(obj, self.seen, kind)[self.at], kind)
            except InputError as error:
                return unknown(len(self.at), kind, error.message)
        planned = self.seen.read().joint_path
        return coloured(planned.toolpath(_toolpath_of(obj)), kind, band_of(obj.Toolpath))

    def colours_depend_on(self, obj: Any) -> tuple[Any, ...]:
        return () if obj.Toolpath is None else (band_of(obj.Toolpath),)


def _linked(obj: Any) -> Any:
    """Return the toolpath object of a joint path. Raises InputError if it was deleted."""
    if obj.Toolpath is None:
        raise InputError(
            "NO_INPUT",
            obj.Label,
            "the toolpath was deleted; choose another toolpath, or delete the joint path too",
        )
    return obj.Toolpath


def _toolpath_of(obj: Any) -> Any:
    """Return the toolpath of a joint path.

    Raises InputError if the toolpath was deleted, or if undo has not yet restored it.
    """
    return _linked(obj).Proxy.value(obj.Toolpath)


def _layer_height(obj: Any) -> float:
    """Return the toolpath's layer height without reading the toolpath. Raises InputError as
    `_toolpath_of`.
    """
    return float(_linked(obj).Proxy.parts(obj.Toolpath, ("layer_height",))[0])


def _known_layer_height(obj: Any) -> float:
    """Return the toolpath's layer height, or the default layer height without a toolpath."""
    try:
        return _layer_height(obj)
    except InputError:
        return RevolutionParameters().layer_height


def _limit_shares(obj: Any, value: Seen, kind: str) -> Array:
    """Return the minimum relative margin to a joint limit, or the maximum relative joint speed,
    (n,) per row.

    Raises InputError of the machine.
    """
    if obj.Cell is None:
        raise InputError("NO_INPUT", obj.Label, "the cell was deleted; choose another cell")
    folders, settings = (
        tuple(user_machines.folders()),
        obj.Cell.Proxy.parameters(obj.Cell, CellParameters),
    )
    machine = machines.load(settings.machine, folders)
    joints, limits, mechanisms = (
        value.course.joints,
        machine.limits(value.limits),
        settings.external,
    )
    if mechanisms:
        machine, limits, _ = coupled(machine, limits, mechanisms, settings.world_up, folders)
    if joints.shape[1] != limits.axes:
        raise InputError(
            "BAD_INPUT",
            obj.Label,
            "{} and the joint path have different axes; recompute the joint path",
            machine.title,
        )
    if kind == MARGIN:
        return limits.smallest_share(joints)
    motion = value.read().motion
    return from_next(
        motion.deposit,
        motion.point,
        speed_ratios(joints, motion.duration, machine.max_speed).max(axis=1),
    )
