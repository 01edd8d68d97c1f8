# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the poses of a placement came to, as colours and as rows of a table."""

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
    """numbers: (m,) numbers of the drawn poses, the best of each position. colours: (m, 3). lowest,
    highest: range of the coloured figures, NaN without any."""

    numbers: Integers
    colours: Array
    lowest: float
    highest: float


def heading(name: str) -> str:
    """Return the label of a figure with its unit."""
    text = translated(NAMES[name])
    return f"{text}, {_length_unit()[1]}" if name == CLEARANCE else text


def _length_unit() -> tuple[float, str]:
    """Return the factor from mm to the length unit of the table, and the name of the unit."""
    return scale_of(ORDINARY["mm"], "mm")


def figure(placed: Placed, number: int, name: str) -> float:
    """Return one figure of a pose in its displayed unit."""
    result = placed.result_of(number)
    return {
        SHARE: 100.0 * result.share,
        MARGIN: 100.0 * result.margin,
        TIME: result.time,
        CLEARANCE: _length_unit()[0] * result.clearance,
    }[name]


def coloured(placed: Placed, name: str) -> Coloured:
    """Colour the poses by a figure: feasible poses from lowest to highest, others grey; by their
    share, all poses. At each position the best pose is shown, or the pose with the largest
    share."""
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
    """The poses of the table: the best one, those planned with all points, then the others that serve, the best first."""
    leading = [placed.best] if placed.best is not None else []
    return list(dict.fromkeys([*leading, *placed.proven, *ranked(placed, best)]))[:ROWS]


def texts(placed: Placed, number: int) -> list[str]:
    """The cells of a row: the pose, its figures, and with how many points it was planned or why it fails."""
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
    """How many poses serve, in a sentence."""
    serve = sum(result.feasible for result in placed.judged)
    text = tr("{} of {} poses are feasible at {} of {} points.").format(
        serve, len(placed.poses), placed.points, placed.of
    )
    if placed.best is None and not serve:
        index = max(range(len(placed.poses)), key=lambda k: placed.judged[k].share)
        result = placed.judged[index]
        wrong = (
            tr("no tool rotation reaches the others")
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
