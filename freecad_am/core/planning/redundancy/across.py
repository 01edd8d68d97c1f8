# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map of the free rotation against an external axis at one point, or of two external axes against each other, all others
as they are planned there."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

from ...kinematics.cell import Cell
from ...toolpath import Bead
from ...types import Array
from ..task import Task
from .map import Columns, Picture, planned_external, single_points


def across(
    beads: Sequence[Bead], cell: Cell, bead_point: tuple[int, int], axis: int, values: Array
) -> Columns:
    """One point of the beads, at (bead, point), with values (C,) rad or mm of one of the external axes, the others as they
    are planned there: a column of each."""
    return _columns_with_external(beads, cell, bead_point, (axis,), (values,))


def across_two_axes(
    beads: Sequence[Bead],
    cell: Cell,
    bead_point: tuple[int, int],
    axes: tuple[int, int],
    values: tuple[Array, Array],
) -> Columns:
    """One point of the beads, at (bead, point), with all pairs of values (C,) and (R,), rad or mm, of two external axes, the
    others as they are planned there: R rows of C columns, one row after the other."""
    across, up = np.meshgrid(*values)
    return _columns_with_external(beads, cell, bead_point, axes, (across.ravel(), up.ravel()))


def in_rows(picture: Picture, rows: int) -> Picture:
    """A picture (1, R C) of pairs as one (R, C)."""
    return dataclasses.replace(
        picture,
        margin=picture.margin.reshape(rows, -1),
        condition=picture.condition.reshape(rows, -1),
        threshold=picture.threshold.reshape(rows, -1),
        outside=picture.outside.reshape(rows, -1),
        forbidden=picture.forbidden.reshape(rows, -1),
        arm=None if picture.arm is None else picture.arm.reshape(rows, -1),
    )


def _columns_with_external(
    beads: Sequence[Bead],
    cell: Cell,
    bead_point: tuple[int, int],
    axes: tuple[int, ...],
    values: tuple[Array, ...],
) -> Columns:
    """One point with external axes elsewhere: each at values (n,)."""
    bead, point = bead_point
    count = len(values[0])
    external = np.tile(planned_external(beads[bead])[point], (count, 1))
    for axis, value in zip(axes, values, strict=True):
        external[:, axis] = value
    position, tool, parameter = (
        np.repeat(getattr(beads[bead], name)[point : point + 1], count, axis=0)
        for name in ("points", "tool", "parameter")
    )
    return Columns(
        np.full(count, bead),
        np.full(count, point),
        single_points(cell, position, tool, parameter, external),
    )


def span(task: Task, bead: Bead, point: int, axis: int, count: int) -> Array:
    """(count,) values of an external axis over its range, or over a turn about where it is planned at a point, if that is
    less."""
    machine_axis = task.cell.robot.chain.axes + axis
    planned_value = float(planned_external(bead)[point, axis])
    low, high = (
        float(task.cell.limits.lower[machine_axis]),
        float(task.cell.limits.upper[machine_axis]),
    )
    if not task.cell.machine.chain.sliding[machine_axis]:
        low, high = max(low, planned_value - np.pi), min(high, planned_value + np.pi)
    return np.linspace(low, high, count)
