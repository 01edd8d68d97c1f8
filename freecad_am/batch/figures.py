# SPDX-License-Identifier: LGPL-2.1-or-later
"""The figures of the report: joints against their limits, speeds, condition, spacing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from freecad_am.core.kinematics.limits import Limits
from freecad_am.core.motion import Motion
from freecad_am.core.toolpath import Array

from . import svg

AXIS_COLOURS = ("#3b6fd4", "#d9633b", "#2f9e6e", "#9a5bd0", "#c79a1e", "#cf3f74", "#3aa5b8", "#7a7f87")

_MOST_SPEED = 250.0  # per cent of the limit; what is faster is cut off, or the rest would not be seen


def time_axis(motion: Motion) -> tuple[Array, str, tuple[float, float]]:
    """When each row is reached, in a unit that reads well, with the label and range of the axis."""
    seconds = np.cumsum(motion.duration)
    unit, name = next((u, n) for u, n in ((3600.0, "h"), (60.0, "min"), (1.0, "s")) if seconds[-1] >= 3 * u or u == 1.0)
    time = seconds / unit
    return time, f"time, {name}", (0.0, float(time[-1]) or 1.0)


def joint_plots(motion: Motion, limits: Limits, units: Sequence[str]) -> list[str]:
    """One plot per axis: its angle or, where its unit is mm, its place over time, the forbidden ranges shaded."""
    time, label, span = time_axis(motion)
    plots = []
    for axis, name in enumerate(limits.labels[: limits.axes]):
        unit, value = units[axis], 1.0 if units[axis] == "mm" else np.radians(1.0)
        angle = motion.joints[:, axis] / value
        low, high = float(limits.lower[axis] / value), float(limits.upper[axis] / value)
        plot = svg.Plot(name, span, _range(angle, low, high), label, unit)
        if np.isfinite(low):
            plot.band(plot.y[0], low, f"below the limit of {low:.6g} {unit}")
            plot.rule(low, f"{low:.6g}")
        if np.isfinite(high):
            plot.band(high, plot.y[1], f"above the limit of {high:.6g} {unit}")
            plot.rule(high, f"{high:.6g}")
        if not np.isfinite(low) and not np.isfinite(high):
            plot.title = f"{name} (endless)"
        plot.curve(time, angle, AXIS_COLOURS[axis % len(AXIS_COLOURS)], name)
        plots.append(plot.text())
    return plots


def speed_plot(motion: Motion, speed_ratio: Array, names: tuple[str, ...]) -> str:
    """Joint speeds as a share of the largest allowed, all axes in one plot, while depositing."""
    time, label, span = time_axis(motion)
    shown = np.where(motion.deposit[:, None] & (motion.point > 0)[:, None], speed_ratio * 100.0, np.nan)
    largest = float(np.nanmax(shown, initial=0.0))
    top = max(_nice(largest), 125.0) if largest > 40.0 else _nice(largest)  # the limit is shown where it is near
    top = min(top, _MOST_SPEED)
    shown = np.minimum(shown, top)
    plot = svg.Plot("Joint speeds while depositing", span, (0.0, top), label, "% of the limit", width=940)
    order = np.argsort(-np.nan_to_num(np.nanmax(np.nan_to_num(shown), axis=0)))
    for axis in order:
        plot.curve(time, shown[:, axis], AXIS_COLOURS[axis % len(AXIS_COLOURS)], names[axis], 1.2)
    plot.legend([(name, AXIS_COLOURS[i % len(AXIS_COLOURS)]) for i, name in enumerate(names)])
    plot.rule(100.0, "limit")
    return plot.text()


def condition_plot(motion: Motion, condition: Array, threshold: Array) -> str:
    """The condition at each deposit point and the least one asked for."""
    time, label, span = time_axis(motion)
    at = time[motion.deposit]
    top = float(np.nanmax(condition, initial=0.05)) * 1.15
    plot = svg.Plot("Condition of the Jacobian (0 is singular)", span, (0.0, top), label, "\u03c3min / \u03c3max", width=940)
    plot.curve(at, threshold, "#b8443a", "least allowed", 1.2)
    plot.curve(at, condition, AXIS_COLOURS[0], "condition")
    plot.legend([("condition", AXIS_COLOURS[0]), ("least allowed", "#b8443a")])
    return plot.text()


def travel_plot(motion: Motion) -> str:
    """The speed of the deposition point."""
    time, label, span = time_axis(motion)
    plot = svg.Plot("Speed along the path", span, (0.0, _nice(float(motion.speed.max()))), label, "mm/s")
    speed = np.where(motion.deposit, motion.speed, np.nan)
    rapid = np.where(~motion.deposit, motion.speed, np.nan)
    again = np.repeat(np.arange(len(time)), 2)[1:]  # a step at each row: the speed is that of the segment before
    for values, stroke, name in ((rapid, "#9aa1ab", "rapid"), (speed, AXIS_COLOURS[2], "deposit")):
        plot.curve(time[again[:-1]], values[again[1:]], stroke, name, 1.3)
    plot.legend([("deposit", AXIS_COLOURS[2]), ("rapid", "#9aa1ab")])
    return plot.text()


def spacing_plot(spacing: tuple[Array, ...], asked: float) -> str:
    """Histogram of the distance of each point to the layer before."""
    values = np.concatenate(spacing)
    low, high = float(values.min()), float(values.max())
    pad = max(0.15 * (high - low), 0.002 * asked)
    edges = np.linspace(low - pad, high + pad, 41)
    share = np.histogram(values, edges)[0] * (100.0 / len(values))
    plot = svg.Plot(
        f"Distance to the layer before (asked: {asked:g} mm)", (float(edges[0]), float(edges[-1])),
        (0.0, _nice(float(share.max()))), "mm", "% of points",
    )
    plot.bars(edges, share)
    return plot.text()


def _range(angle: Array, low: float, high: float) -> tuple[float, float]:
    finite = angle[np.isfinite(angle)]
    ends = np.concatenate((finite, [v for v in (low, high) if np.isfinite(v)]))
    if len(ends) == 0:
        return -180.0, 180.0
    bottom, top = float(ends.min()), float(ends.max())
    pad = 0.08 * (top - bottom) or 1.0
    return bottom - pad, top + pad


def _nice(value: float) -> float:
    return value * 1.12 if value > 0.0 else 1.0
