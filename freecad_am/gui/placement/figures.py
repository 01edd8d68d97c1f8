# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the poses of a placement came to, as colours and as rows of a table."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.placement.judge import UNREACHED
from ...core.placement.place import Placed, outer, ranked
from ...core.quantities import significant
from ...core.types import Array, Integers
from ...objects.fields.preferences import ORDINARY, scale_of
from ..colours import ramp
from ..texts.in_language import marked, tr, translated

SHARE, MARGIN, TIME, CLEARANCE = "share", "margin", "time", "clearance"
NAMES = {
    MARGIN: marked("Least margin, %"),
    SHARE: marked("Points served, %"),
    TIME: marked("Time, s"),
    CLEARANCE: marked("Arm clearance"),
}
GREY = (0.62, 0.64, 0.68)
ROWS = 200


@dataclass(frozen=True, eq=False)
class Coloured:
    """shown: (m,) numbers of the poses that are drawn, the best of each place. colours: (m, 3). least, most: of the figures
    that colours tell, NaN where there is none."""

    shown: Integers
    colours: Array
    least: float
    most: float


def heading(name: str) -> str:
    """What a figure is called, with its unit."""
    text = translated(NAMES[name])
    return f"{text}, {_length_unit()[1]}" if name == CLEARANCE else text


def _length_unit() -> tuple[float, str]:
    """How many of the unit of lengths in the table make 1 mm, and its name."""
    return scale_of(ORDINARY["mm"], "mm")


def figure(found: Placed, number: int, name: str) -> float:
    """One of the figures of a pose as it is shown."""
    one = found.result_of(number)
    return {
        SHARE: 100.0 * one.share,
        MARGIN: 100.0 * one.margin,
        TIME: one.time,
        CLEARANCE: _length_unit()[0] * one.clearance,
    }[name]


def coloured(found: Placed, name: str) -> Coloured:
    """The poses coloured by a figure: those that serve from the least to the most, others grey; by their share all of them.
    Of poses at the same place the best one is shown, or the one that serves most."""
    rank = {number: k for k, number in enumerate(ranked(found, MARGIN))}
    order = sorted(
        range(len(found.poses)), key=lambda k: (rank.get(k, len(rank)), -found.judged[k].share, k)
    )
    places = np.round(found.poses[order, :3], 6)
    _, first = np.unique(places, axis=0, return_index=True)
    shown = np.array(order)[np.sort(first)]
    values = np.array([figure(found, int(number), name) for number in shown])
    known = np.isfinite(values) & (
        np.array([found.result_of(int(k)).feasible for k in shown]) | (name == SHARE)
    )
    colours = np.tile(GREY, (len(shown), 1))
    least, most = (
        (float(values[known].min()), float(values[known].max()))
        if known.any()
        else (np.nan, np.nan)
    )
    if known.any():
        colours[known] = ramp(
            (values[known] - least) / (most - least) if most > least else np.ones(int(known.sum()))
        )
    return Coloured(shown, colours, least, most)


def rows(found: Placed, best: str) -> list[int]:
    """The poses of the table: the best one, those planned with all points, then the others that serve, the best first."""
    first = [found.best] if found.best is not None else []
    return list(dict.fromkeys([*first, *found.proven, *ranked(found, best)]))[:ROWS]


def texts(found: Placed, number: int) -> list[str]:
    """The cells of a row: the pose, its figures, and with how many points it was planned or why it fails."""
    factors = [_length_unit()[0]] * 3 + [1.0] * 3
    pose = [
        significant(factor * float(value), 6)
        for factor, value in zip(factors, outer(found.pose(number)), strict=True)
    ]
    values = [figure(found, number, name) for name in (MARGIN, TIME, CLEARANCE)]
    cells = [
        format(value, form) if np.isfinite(value) else "–"
        for value, form in zip(values, (".3g", ".0f", ".3g"))
    ]
    one = found.result_of(number)
    points = tr("all") if number in found.proven else f"{found.points}"
    return [*pose, *cells, points if one.feasible else f"{points}: {one.code}"]


def heads() -> list[str]:
    """The heads of the columns."""
    return [
        *(f"{axis}, {_length_unit()[1]}" for axis in "xyz"),
        "RX",
        "RY",
        "RZ",
        *(heading(name) for name in (MARGIN, TIME, CLEARANCE)),
        tr("Points"),
    ]


def summed(found: Placed) -> str:
    """How many poses serve, in a sentence."""
    serve = sum(one.feasible for one in found.judged)
    text = tr("{} of {} poses are feasible at {} of {} points.").format(
        serve, len(found.poses), found.points, found.of
    )
    if found.best is None and not serve:
        most = max(range(len(found.poses)), key=lambda k: found.judged[k].share)
        one = found.judged[most]
        wrong = (
            tr("no tool rotation reaches the others")
            if one.code == UNREACHED
            else translated(one.message)
        )
        more = tr("At most {:.0f} % of the points are feasible: {}.").format(
            100.0 * one.share, wrong
        )
        return f"{text} {more}"
    if found.best is None:
        return f"{text} {tr('None of the best is with all points.')}"
    return f"{text} {tr('The best one was planned with all points.')}"
