# SPDX-License-Identifier: LGPL-2.1-or-later
"""Format the results of a placement's poses as colours and table rows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.number_texts import significant
from ...core.placement.judge import UNREACHED
from ...core.placement.place import Placed, outer, ranked
from ...core.types import Array, Integers
from ...objects.fields.preferences import ORDINARY, scale_of
from ..colours import ramp
from ..in_language import marked, tr, translated

SHARE, MARGIN, TIME, CLEARANCE = "share", "margin", "time", "clearance"
NAMES = {
    MARGIN: marked("Smallest margin, %"),
    SHARE: marked("Feasible points, %"),
    TIME: marked("Time, s"),
    CLEARANCE: marked("Arm clearance"),
}
GREY = (0.62, 0.64, 0.68)
ROWS = 200


@dataclass(frozen=True, eq=False)
class Coloured:
    """numbers: (m,) indices of the drawn poses, the best pose at each position. colours: (m, 3).
    lowest, highest: range of the coloured result, NaN without values.
    """

    numbers: Integers
    colours: Array
    lowest: float
    highest: float


def heading(name: str) -> str:
    """Return the label of a result with its unit."""
    text = translated(NAMES[name])
    return f"{text}, {_length_unit()[1]}" if name == CLEARANCE else text


def _length_unit() -> tuple[float, str]:
    """Return the factor from mm to the length unit of the table, and the name of the unit."""
    return scale_of(ORDINARY["mm"], "mm")


def figure(placed: Placed, number: int, name: str) -> float:
    """Return one result of a pose in its displayed unit."""
    result = placed.result_of(number)
    return {
        SHARE: 100.0 * result.share,
        MARGIN: 100.0 * result.margin,
        TIME: result.time,
        CLEARANCE: _length_unit()[0] * result.clearance,
    }[name]


def coloured(placed: Placed, name: str) -> Coloured:
    """Colour the poses by a result.

    Feasible poses are coloured from lowest to highest, infeasible poses are grey. The reachable
    fraction colours all poses. Each position shows its best pose, or the pose with the largest
    fraction.
    """
    rank = {number: k for k, number in enumerate(ranked(placed, MARGIN))}
    order = sorted(
        range(len(placed.poses)), key=lambda k: (rank.get(k, len(rank)), -placed.judged[k].share, k)
    )
    positions = np.round(placed.poses[order, :3], 6)
    _, starts = np.unique(positions, axis=0, return_index=True)
    numbers = np.array(order)[np.sort(starts)]
    values = np.array([figure(placed, int(number), name) for number in numbers])
    is_valid = np.isfinite(values) & (
        np.array([placed.result_of(int(k)).feasible for k in numbers]) | (name == SHARE)
    )
    colours = np.tile(GREY, (len(numbers), 1))
    lowest, highest = (
        (float(values[is_valid].min()), float(values[is_valid].max()))
        if is_valid.any()
        else (np.nan, np.nan)
    )
    if is_valid.any():
        colours[is_valid] = ramp(
            (values[is_valid] - lowest) / (highest - lowest)
            if highest > lowest
            else np.ones(int(is_valid.sum()))
        )
    return Coloured(numbers, colours, lowest, highest)


def rows(placed: Placed, best: str) -> list[int]:
    """Return the poses of the table: the best pose, poses planned with all points, then other
    feasible poses, best first.
    """
    leading = [placed.best] if placed.best is not None else []
    return list(dict.fromkeys([*leading, *placed.proven, *ranked(placed, best)]))[:ROWS]


def texts(placed: Placed, number: int) -> list[str]:
    """Return the cells of a row: pose, results, and the number of planned points or the reason of
    failure.
    """
    factors = [_length_unit()[0]] * 3 + [1.0] * 3
    pose = [
        significant(factor * float(value), 6)
        for factor, value in zip(factors, outer(placed.pose(number)), strict=True)
    ]
    values = [figure(placed, number, name) for name in (MARGIN, TIME, CLEARANCE)]
    cells = [
        format(value, form) if np.isfinite(value) else "–"
        for value, form in zip(values, (".3g", ".0f", ".3g"))
    ]
    result = placed.result_of(number)
    points = tr("all") if number in placed.proven else f"{placed.points}"
    return [*pose, *cells, points if result.feasible else f"{points}: {result.code}"]


def heads() -> list[str]:
    """Return the column headings."""
    return [
        *(f"{axis}, {_length_unit()[1]}" for axis in "xyz"),
        "RX",
        "RY",
        "RZ",
        *(heading(name) for name in (MARGIN, TIME, CLEARANCE)),
        tr("Points"),
    ]


def summed(placed: Placed) -> str:
    """Summarise in a sentence how many poses are feasible."""
    serve = sum(result.feasible for result in placed.judged)
    text = tr("{} of {} poses are feasible at {} of {} points.").format(
        serve, len(placed.poses), placed.points, placed.of
    )
    if placed.best is None and not serve:
        index = max(range(len(placed.poses)), key=lambda k: placed.judged[k].share)
        result = placed.judged[index]
        wrong = (
            tr("no tool rotation makes the other points feasible")
            if result.code == UNREACHED
            else translated(result.message)
        )
        reason = tr("At most {:.0f} % of the points are feasible: {}.").format(
            100.0 * result.share, wrong
        )
        return f"{text} {reason}"
    if placed.best is None:
        return f"{text} {tr('None of the best poses is feasible with all points.')}"
    return f"{text} {tr('The best pose was planned with all points.')}"
