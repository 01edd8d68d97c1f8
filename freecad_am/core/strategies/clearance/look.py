# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nozzle contacts during deposition, checked without tilting anything."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.bodies import build_bodies
from ...geometry.obstacles import Body
from ...issues import ERROR, Issue, Text
from ...parameters.cell import NozzleParameters
from ...toolpath import Toolpath
from .notes import CLEARANCE, locate_row
from .places import beads_of, halfway, nozzle_of, space_of


@dataclass(frozen=True)
class Looked:
    """The number of points checked, the number at which the nozzle touches, and the first of the latter: layer, bead and point, None
    without any.
    """

    count: int
    touched: int
    first_touch: tuple[int, int, int] | None


def check_nozzle(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    max_points: int,
    feature: int | None = None,
) -> Looked:
    """Check at up to `max_points` evenly spread points whether the nozzle touches bodies or earlier deposit.

    The platform is one of the bodies; beads have their width and height. feature: number of the feature to check, if several.
    """
    space = space_of(toolpath, bodies, nozzle, np.pi, often=False, feature=feature or 0)
    beads = list(toolpath)
    starts = np.cumsum([0, *(len(bead) for _, _, bead in beads)])
    feature_rows = np.flatnonzero(np.repeat(beads_of(toolpath, feature), np.diff(starts)))
    rows = feature_rows[
        np.unique(
            np.round(
                np.linspace(0, len(feature_rows) - 1, min(max_points, len(feature_rows)))
            ).astype(np.intp)
        )
    ]
    tool = np.concatenate([bead.tool for _, _, bead in beads])
    hit = rows[~space.clear(rows, tool[rows])]
    if not len(hit):
        return Looked(len(rows), 0, None)
    bead = int(np.searchsorted(starts, hit[0], side="right")) - 1
    return Looked(len(rows), len(hit), (*beads[bead][:2], int(hit[0] - starts[bead])))


def join_checks(looks: Sequence[Looked]) -> Looked | None:
    """Several checks as one; None without any."""
    if not looks:
        return None
    first_touch = next(
        (check.first_touch for check in looks if check.first_touch is not None), None
    )
    return Looked(
        sum(check.count for check in looks), sum(check.touched for check in looks), first_touch
    )


def nozzle_issues(
    toolpath: Toolpath, bodies: Sequence[Body], nozzle: NozzleParameters
) -> list[Issue]:
    """An error where the nozzle would touch bodies while depositing, for toolpaths that are not tilted away from them."""
    if not bodies:
        return []
    beads = [bead for _, _, bead in toolpath]
    points, tool = (
        np.concatenate([bead.points for bead in beads]),
        np.concatenate([bead.tool for bead in beads]),
    )
    around = nozzle_of(nozzle).bodies
    scene_ = build_bodies(bodies, points, around.reach)
    hit = scene_.find_touching(around, points, tool) | scene_.find_touching(
        around, *halfway(beads, tool)
    )
    if not hit.any():
        return []
    begin = np.r_[0, np.cumsum([len(bead) for bead in beads])]
    bead_keys = [(i, j) for i, j, _ in toolpath]
    bead_key, point = locate_row(bead_keys, begin, int(np.argmax(hit)))
    names = Text.joined(" or ", (body.name for body in bodies))
    return [
        Issue(
            ERROR,
            CLEARANCE,
            Text(
                "the nozzle touches {} at {} of {} points; on parts of revolution it does not "
                "tilt away from fixtures: move them, or use a slimmer nozzle",
                names,
                int(hit.sum()),
                len(points),
            ),
            *bead_key,
            point,
        )
    ]
