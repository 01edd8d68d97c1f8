# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses and their results as a table, and the best one as a line of a job file."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..parameters.cell_records import PART
from ..parameters.place import PLATFORM, POINT
from ..parameters.records import Pose
from .place import Placed, outer

HEAD = (
    "x_mm",
    "y_mm",
    "z_mm",
    "rx_deg",
    "ry_deg",
    "rz_deg",
    "feasible",
    "share",
    "margin",
    "time_s",
    "clearance_mm",
    "configuration",
    "code",
    "all_points",
)


def rows(placed: Placed) -> Iterator[str]:
    """Return the lines of place.csv, the header first.

    A pose that was planned with all points has the figures of that plan.
    """
    yield ",".join(HEAD) + "\n"
    for number in range(len(placed.poses)):
        result, pose = placed.result_of(number), outer(placed.pose(number))
        yield (
            ",".join(
                [
                    *(f"{value:.6f}" for value in pose),
                    "yes" if result.feasible else "no",
                    f"{result.share:.6f}",
                    *(
                        f"{value:.6f}" if np.isfinite(value) else ""
                        for value in (result.margin, result.time, result.clearance)
                    ),
                    "-".join(result.branch),
                    result.code,
                    "yes" if number in placed.proven else "no",
                ]
            )
            + "\n"
        )


def key(placed: Placed, number: int) -> str:
    """The line of the section `cell` of a job file that gives the cell a pose."""
    if placed.moves == POINT:
        return f"deposition_point: {_list(placed.pose(number))}"
    if placed.moves == PLATFORM:
        return f"platform: {_list(placed.pose(number))}"
    mechanisms, is_replaced = [], False
    for mechanism in placed.settings.external:
        turns = mechanism.carries == PART and not is_replaced
        is_replaced |= turns
        pose = placed.pose(number) if turns else mechanism.pose
        mechanisms.append(
            f"{{machine: {mechanism.machine}, pose: {_list(pose)}, carries: {mechanism.carries}}}"
        )
    return f"external: [{', '.join(mechanisms)}]"


def _list(pose: Pose) -> str:
    return f"[{', '.join(f'{value:.10g}' for value in outer(pose))}]"
