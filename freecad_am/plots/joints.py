# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the axes: places, speeds, accelerations and jerks against their limits, and the condition."""

from __future__ import annotations

import numpy as np

from freecad_am.core.types import Array

from ..core.kinematics.cell import Cell
from .chart import INF, LINE, STEP, Chart, Curve, Quantity
from .rows import Rows
from .source import Source

CONTINUOUS = " (endless)"
# what is told where a machine file has no limit, and where none can have one
NO_SPEED = "no limit known: the machine file has no max_speed"
NO_ACCELERATION = "no limit known: the machine file has no max_acceleration"
NO_JERK = "no limit known: the machine file has no max_jerk"
MOST_SHARE = 250.0  # % of the limit; what is faster is cut off, or the rest would not be seen


def angles(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """A chart per axis, and per sum of axes that has limits of its own."""
    cell = _cell(source)
    limits, units, values = cell.limits, cell.machine.units, cell.machine.unit_values
    joints = rows.at(source.motion.joints)
    charts = [
        _of_axis(
            rows,
            axis,
            limits.labels[axis] + ("" if np.isfinite(low) or np.isfinite(high) else CONTINUOUS),
            Quantity("place" if units[axis] == "mm" else "angle", units[axis]),
            joints[:, axis] / values[axis],
            (low, high),
            LINE,
        )
        for axis, (low, high) in enumerate(
            zip((limits.lower / values).tolist(), (limits.upper / values).tolist())
        )
    ]
    for number, coefficients in enumerate(limits.coefficients):
        ends = (np.degrees(limits.coupled_lower[number]), np.degrees(limits.coupled_upper[number]))
        label = limits.labels[limits.axes + number]
        sums = np.degrees(joints @ coefficients)
        charts.append(
            _of_axis(rows, limits.axes + number, label, Quantity("angle", "deg"), sums, ends, LINE)
        )
    return tuple(charts)


def speeds(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """A chart per axis, while depositing: the mean of each segment."""
    return _rates(
        source,
        rows,
        rows.along(source.rates.speed),
        "speed",
        "/s",
        _cell(source).machine.max_speed,
        STEP,
        NO_SPEED,
    )


def accelerations(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """A chart per axis, while depositing, at the points within beads."""
    most = _cell(source).machine.max_acceleration
    return _rates(
        source,
        rows,
        rows.at(source.rates.acceleration),
        "acceleration",
        "/s²",
        most,
        LINE,
        NO_ACCELERATION,
    )


def jerks(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """A chart per axis, while depositing."""
    most = _cell(source).machine.max_jerk
    return _rates(source, rows, rows.along(source.rates.jerk), "jerk", "/s³", most, STEP, NO_JERK)


def shares(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """The speeds of all axes while depositing, as shares of the largest they can do, in one chart."""
    machine = _cell(source).machine
    values = 100.0 * np.abs(rows.along(source.rates.speed)) / machine.max_speed
    largest = float(np.nanmax(values, initial=0.0))
    top = (
        max(1.12 * largest, 125.0) if largest > 40.0 else 1.12 * largest or 1.0
    )  # the limit is shown where it is near
    curves = tuple(
        _curve(rows, name, values[:, axis], axis, STEP) for axis, name in enumerate(machine.axes)
    )
    chart = Chart(
        "Joint speeds while depositing",
        rows.quantity,
        Quantity("share of the limit", "%"),
        curves,
        limits=(-INF, 100.0),
        borders=rows.borders,
        layers=rows.layers,
        span=(0.0, min(top, MOST_SHARE)),
    )
    return (chart,)


def condition(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """sigma_min / sigma_max of the scaled Jacobian while depositing, and the least allowed; none of tables."""
    if (
        source.condition is None
        or source.threshold is None
        or not np.isfinite(source.condition).any()
    ):
        return ()
    values, least = rows.at(source.condition), rows.at(source.threshold)
    curves = (
        _curve(rows, "least allowed", least, "bad", LINE),
        _curve(rows, "condition", values, 0, LINE),
    )
    top = 1.15 * float(np.nanmax(values, initial=0.05))
    chart = Chart(
        "Condition of the Jacobian (0 is singular)",
        rows.quantity,
        Quantity("σmin / σmax"),
        curves,
        borders=rows.borders,
        layers=rows.layers,
        span=(0.0, top),
    )
    return (chart,)


def _rates(
    source: Source,
    rows: Rows,
    values: Array,
    name: str,
    per: str,
    most: Array,
    kind: str,
    unlimited: str,
) -> tuple[Chart, ...]:
    machine = _cell(source).machine
    shown, ends = values / machine.unit_values, most / machine.unit_values
    return tuple(
        _of_axis(
            rows,
            axis,
            label,
            Quantity(name, machine.units[axis] + per),
            shown[:, axis],
            (-end, end),
            kind,
            unlimited if np.isinf(end) else "",
        )
        for axis, (label, end) in enumerate(zip(machine.axes, ends.tolist(), strict=True))
    )


def _of_axis(
    rows: Rows,
    axis: int,
    title: str,
    y: Quantity,
    values: Array,
    limits: tuple[float, float],
    kind: str,
    unlimited: str = "",
) -> Chart:
    curve = _curve(rows, title.removesuffix(CONTINUOUS), values, axis, kind)
    return Chart(
        title,
        rows.quantity,
        y,
        (curve,),
        limits=(float(limits[0]), float(limits[1])),
        borders=rows.borders,
        layers=rows.layers,
        unlimited=unlimited,
    )


def _curve(rows: Rows, name: str, values: Array, colour: int | str, kind: str) -> Curve:
    return Curve(name, rows.x, values, colour, kind, rows.layer)


def _cell(source: Source) -> Cell:
    if source.cell is None:
        raise ValueError("a picture of axes needs a cell")
    return source.cell
