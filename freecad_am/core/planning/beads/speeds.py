# SPDX-License-Identifier: LGPL-2.1-or-later
"""Travel speeds above axis limits: slow down short sections, and report longer ones to the user."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...geometry.columns import lengths
from ...geometry.ramps import limit_growth
from ...issues import ERROR, WARNING, Issue, Text, Word
from ...kinematics.cell import Cell
from ...toolpath import Bead, SpeedLaw
from ...types import Array, Mask
from ..joint_path import BeadPath

SLOWED = "SLOWED"
JUST = 1.0 - 1e-9  # fraction of the maximum axis speed that slowed segments use
PILE = 1.0  # maximum excess deposit in a slowed section, relative to the bead width
DEFAULT_WIDTH_RATIO = 2.0  # bead width in layer heights, without a bead model


def rings_slowed(
    cell: Cell, paths: Sequence[BeadPath], layer_height: float
) -> tuple[list[BeadPath], list[Issue]]:
    """Slow the smallest rings of a wall to the speed that the axes allow.

    Where a wall closes, the last rings may be so small that the axis that rotates the part would
    have to rotate without bound. Segments within one layer height of the part axis are slowed.
    Other segments are left for the user to decide.

    Parameters
    ----------
    cell : Cell
        The cell, including the maximum axis speeds.
    paths : sequence of BeadPath
        The paths.
    layer_height : float
        Layer height, mm.

    Returns
    -------
    paths : list of BeadPath
        The paths, some with lower speeds.
    issues : list of Issue
        A warning if a path was slowed.
    """
    result, slowed = [], []
    for path in paths:
        bead, ratio = path.bead, (_axis_speeds(path) / cell.machine.max_speed).max(axis=1)
        radius = lengths(np.diff(bead.points, axis=0)) / np.abs(np.diff(bead.parameter))
        tight = (ratio > 1.0) & (radius < layer_height)
        if tight.any():
            path = _scale_speeds(path, np.where(tight, JUST / ratio, 1.0))
            slowed.append(path)
        result.append(path)
    if not slowed:
        return result, []
    slowest = min(float(path.bead.speed.min()) for path in slowed)
    return result, [
        Issue(
            WARNING,
            SLOWED,
            Text(
                "{} bead(s) where the wall closes are slowed down to {:.3g} mm/s, the limit of "
                "the axes",
                len(slowed),
                slowest,
            ),
            slowed[0].layer,
            slowed[0].index,
        )
    ]


class _Place(NamedTuple):
    """A slowed section of a bead.

    point: its slowest point. length: mm. speed: minimum, mm/s. pile: excess deposit, mm of bead
    length. wider, higher: predicted increase of bead width and height, mm; NaN without a bead
    model.
    """

    path: BeadPath
    point: int
    length: float
    speed: float
    pile: float
    wider: float
    higher: float


def corners_slowed(
    cell: Cell, paths: Sequence[BeadPath], layer_height: float, law: SpeedLaw | None
) -> tuple[list[BeadPath], list[Issue]]:
    """Slow short sections of filled layers to the speed that the axes allow.

    Near corners and poles, controllers of five-axis machines and robots slow down anyway. The
    deposit then piles up. A section is short if its excess deposit is at most PILE bead widths.
    Longer sections are left unchanged.

    Parameters
    ----------
    cell : Cell
        The cell, including the maximum axis speeds.
    paths : sequence of BeadPath
        The paths.
    layer_height : float
        Layer height, mm; defines the width of beads without a width.
    law : SpeedLaw or None
        Relation between bead width, height and speed; None without a bead model.

    Returns
    -------
    paths : list of BeadPath
        The paths, some with lower speeds.
    issues : list of Issue
        A warning with the slowest section if a path was slowed.
    """
    result: list[BeadPath] = []
    slow_sections: list[_Place] = []
    for path in paths:
        ratio = (_axis_speeds(path) / cell.machine.max_speed).max(axis=1)
        if (ratio > 1.0).any():
            path, sections = _slowed(path, ratio, layer_height, law)
            slow_sections += sections
        result.append(path)
    if not slow_sections:
        return result, []
    worst = min(slow_sections, key=lambda section: section.speed)
    return result, [
        Issue(
            WARNING,
            SLOWED,
            Text(
                "the deposit is slowed at {} short places, {:.3g} mm in total, here to {:.3g} "
                "mm/s, the limit of the axes; over-deposition is up to {:.2g} mm of bead{}",
                len(slow_sections),
                sum(section.length for section in slow_sections),
                worst.speed,
                max(section.pile for section in slow_sections),
                _growth(slow_sections, worst, law),
            ),
            worst.path.layer,
            worst.path.index,
            worst.point,
        )
    ]


def _slowed(
    path: BeadPath, ratio: Array, layer_height: float, law: SpeedLaw | None
) -> tuple[BeadPath, list[_Place]]:
    """Slow a path whose axes would exceed their limits; return the path and its slowed sections.

    ratio: (n - 1,) axis speed relative to the maximum.
    """
    bead = path.bead
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    middle = np.cumsum(length) - 0.5 * length
    share = np.where(ratio > 1.0, JUST / ratio, 1.0)
    while True:
        speed = _approached(middle, bead.speed[1:], share, law)
        slow = speed < JUST * bead.speed[1:]
        runs = [slice(*ends) for ends in _runs(slow)]
        extra_length = length * (bead.speed[1:] / speed - 1.0)
        long = [
            run for run in runs if extra_length[run].sum() > PILE * _width(bead, run, layer_height)
        ]
        if not long:
            break
        for run in long:
            share[run] = 1.0
    if not runs:
        return path, []
    speeds = np.r_[bead.speed[:1], speed]
    slower = dataclasses.replace(bead, speed=speeds) if law is None else law.applied(bead, speeds)
    path = dataclasses.replace(path, bead=slower)
    wider, higher = _gains(bead, slower)
    return path, [
        _Place(
            path,
            run.start + 1 + int(np.argmin(speed[run])),
            float(length[run].sum()),
            float(speed[run].min()),
            float(extra_length[run].sum()),
            float(wider[run.start : run.stop + 1].max()),
            float(higher[run.start : run.stop + 1].max()),
        )
        for run in runs
    ]


def _approached(middle: Array, speed: Array, share: Array, law: SpeedLaw | None) -> Array:
    """Return the segment speeds (n - 1,), mm/s, with ramps to and from slowed segments.

    middle: (n - 1,) midpoints of the segments along the bead, mm. speed: planned speeds, mm/s.
    share: maximum fraction of these speeds for each segment.
    """
    if law is None or (share == 1.0).all():
        return np.asarray(speed * share)
    square = np.where(share < 1.0, speed * share, np.inf) ** 2
    return np.minimum(
        np.sqrt(limit_growth(np.asarray(square, float), 2.0 * law.acceleration * middle)),
        speed * share,
    )


def _runs(mask: Mask) -> list[list[int]]:
    """Return start and stop of each run of true values."""
    ends: list[list[int]] = (
        np.flatnonzero(np.diff(np.r_[False, mask, False].astype(int))).reshape(-1, 2).tolist()
    )
    return ends


def _gains(planned: Bead, slowed: Bead) -> tuple[Array, Array]:
    """Return the predicted increase of bead width and height (n,), mm; NaN without a bead model."""
    none = np.full(len(planned), np.nan)
    if (
        planned.width is None
        or slowed.width is None
        or planned.height is None
        or slowed.height is None
    ):
        return none, none
    return slowed.width - planned.width, slowed.height - planned.height


def _growth(sections: Sequence[_Place], worst: _Place, law: SpeedLaw | None) -> str:
    """Return the message part about bead growth in slowed sections; '' without a bead model."""
    wider = max(section.wider for section in sections)
    if law is None or not wider > 0.0:
        return ""
    higher = max(section.higher for section in sections)
    beyond = (
        Text("; below {:.3g} mm/s there are no measurements", law.slowest)
        if worst.speed < law.slowest * JUST
        else ""
    )
    return Text(
        ": the bead model predicts up to {:.2g} mm more width{}{}",
        wider,
        Word(Text(" and {:.2g} mm more height", higher) if higher > 0.0 else ""),
        Word(beyond),
    )


def _width(bead: Bead, segments: slice, layer_height: float) -> float:
    return (
        DEFAULT_WIDTH_RATIO * layer_height
        if bead.width is None
        else float(bead.width[1:][segments].min())
    )


def _scale_speeds(path: BeadPath, share: Array) -> BeadPath:
    """Scale the segment speeds of a path by fractions (n - 1,)."""
    speed = np.r_[path.bead.speed[:1], path.bead.speed[1:] * share]
    return dataclasses.replace(path, bead=dataclasses.replace(path.bead, speed=speed))


def _axis_speeds(path: BeadPath) -> Array:
    """Return the axis speeds (n - 1, axes) along a bead, rad/s or mm/s."""
    length = lengths(np.diff(path.bead.points, axis=0))
    speed: Array = np.abs(np.diff(path.joints, axis=0)) * (path.bead.speed[1:] / length)[:, None]
    return speed


def share_of_speed(cell: Cell, paths: Sequence[BeadPath]) -> float:
    """Return the fraction of the travel speed that the axes can follow on all paths, at most 1."""
    return float(
        min(
            (
                1.0
                / max(float((_axis_speeds(path) / cell.machine.max_speed).max(initial=0.0)), 1.0)
                for path in paths
                if path.reachable
            ),
            default=1.0,
        )
    )


def too_fast(cell: Cell, paths: Sequence[BeadPath]) -> list[Issue]:
    """Report each bead on which an axis would exceed its maximum speed."""
    issues = []
    for path in paths:
        speed = _axis_speeds(path)
        ratio = speed / cell.machine.max_speed
        point, axis = np.unravel_index(int(ratio.argmax()), ratio.shape)
        if ratio[point, axis] > 1.0:
            value, unit = cell.machine.unit_values[axis], cell.machine.units[axis]
            able = path.bead.speed[point + 1] / ratio[point, axis]
            issues.append(
                Issue(
                    ERROR,
                    "SPEED",
                    Text(
                        "axis {} would move at {:.0f} {}/s, above its limit of {:.0f}; {}",
                        cell.machine.axes[axis],
                        speed[point, axis] / value,
                        unit,
                        cell.machine.max_speed[axis] / value,
                        _advice(path.bead, int(point) + 1, float(able)),
                    ),
                    path.layer,
                    path.index,
                    int(point) + 1,
                )
            )
    return issues


def _advice(bead: Bead, point: int, able: float) -> str:
    if bead.scarf is not None:
        return Text(
            "{:.2f} mm/s would work, but a scarf seam needs {:.3g} mm/s; lower the travel speed, "
            "or remove process.seam.scarf",
            able,
            bead.speed[point],
        )
    if bead.height is None:
        return Text("lower the travel speed to {:.2f} mm/s", able)
    return Text(
        "{:.2f} mm/s would work, but the bead model needs {:.3g} mm/s, and too much material "
        "would pile up; turn the torch more slowly (build_direction.max_turn), tilt the torch "
        "less, mount the part differently, or use a wider bead (process.bead_width), which is "
        "slower",
        able,
        bead.speed[point],
    )
