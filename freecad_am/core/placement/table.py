# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses and what they came to as a table, and the best one as a line of a job file."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..parameters.cell import Pose
from ..parameters.external import PART, externals
from ..parameters.place import PLATFORM, POINT
from .moved import outer
from .place import Placed

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


def rows(found: Placed) -> Iterator[str]:
    """The lines of place.csv, the head first. Figures of poses that were planned with all points are those of that plan."""
    yield ",".join(HEAD) + "\n"
    for number in range(len(found.poses)):
        one, pose = found.of_pose(number), outer(found.pose(number))
        yield (
            ",".join(
                [
                    *(f"{value:.6f}" for value in pose),
                    "yes" if one.feasible else "no",
                    f"{one.share:.6f}",
                    *(
                        f"{value:.6f}" if np.isfinite(value) else ""
                        for value in (one.margin, one.time, one.clearance)
                    ),
                    "-".join(one.branch),
                    one.code,
                    "yes" if number in found.proven else "no",
                ]
            )
            + "\n"
        )


def key(found: Placed, number: int) -> str:
    """The line of the section `cell` of a job file that gives the cell a pose."""
    if found.moves == POINT:
        return f"deposition_point: {_list(found.pose(number))}"
    if found.moves == PLATFORM:
        return f"platform: {_list(found.pose(number))}"
    mechanisms, done = [], False
    for one in externals(found.settings.external):
        turns = one.carries == PART and not done
        done |= turns
        pose = found.pose(number) if turns else one.pose
        mechanisms.append(
            f"{{machine: {one.machine}, pose: {_list(pose)}, carries: {one.carries}}}"
        )
    return f"external: [{', '.join(mechanisms)}]"


def _list(pose: Pose) -> str:
    return f"[{', '.join(f'{value:.10g}' for value in outer(pose))}]"
