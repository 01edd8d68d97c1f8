# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the nozzle touches while it deposits, looked at alone: nothing is tilted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...collision.bodies import build_bodies
from ...geometry.obstacles import Body
from ...issues import ERROR, Issue, Text
from ...parameters.cell import NozzleParameters
from ...toolpath import Toolpath
from .notes import CLEARANCE, place
from .places import beads_of, halfway, nozzle_of, space_of


@dataclass(frozen=True)
class Looked:
    """At how many points of a toolpath it was looked, at how many of them the nozzle touches, and the first of these: layer,
    bead and point, None without any."""

    count: int
    touched: int
    place: tuple[int, int, int] | None


def looked_at(
    toolpath: Toolpath,
    bodies: Sequence[Body],
    nozzle: NozzleParameters,
    most: int,
    feature: int | None = None,
) -> Looked:
    """Whether the nozzle touches bodies, the platform one of them, or what is deposited by then, beads as wide and high as
    they are, at so many points at most, evenly spread. feature: of several features, the one whose points are looked at."""
    space = space_of(toolpath, bodies, nozzle, np.pi, often=False, feature=feature or 0)
    beads = list(toolpath)
    starts = np.cumsum([0, *(len(bead) for _, _, bead in beads)])
    mine = np.flatnonzero(np.repeat(beads_of(toolpath, feature), np.diff(starts)))
    rows = mine[
        np.unique(np.round(np.linspace(0, len(mine) - 1, min(most, len(mine)))).astype(np.intp))
    ]
    tool = np.concatenate([bead.tool for _, _, bead in beads])
    hit = rows[~space.clear(rows, tool[rows])]
    if not len(hit):
        return Looked(len(rows), 0, None)
    bead = int(np.searchsorted(starts, hit[0], side="right")) - 1
    return Looked(len(rows), len(hit), (*beads[bead][:2], int(hit[0] - starts[bead])))


def together(looks: Sequence[Looked]) -> Looked | None:
    """Several looks as one; None without any."""
    if not looks:
        return None
    first = next((one.place for one in looks if one.place is not None), None)
    return Looked(sum(one.count for one in looks), sum(one.touched for one in looks), first)


def touched_at(toolpath: Toolpath, bodies: Sequence[Body], nozzle: NozzleParameters) -> list[Issue]:
    """An error where the nozzle would touch bodies while depositing, for toolpaths that are not tilted away from them."""
    if not bodies:
        return []
    beads = [bead for _, _, bead in toolpath]
    points, tool = (
        np.concatenate([bead.points for bead in beads]),
        np.concatenate([bead.tool for bead in beads]),
    )
    around = nozzle_of(nozzle).bodies
    near = build_bodies(bodies, points, around.reach)
    hit = near.touched(around, points, tool) | near.touched(around, *halfway(beads, tool))
    if not hit.any():
        return []
    begin = np.r_[0, np.cumsum([len(bead) for bead in beads])]
    places = [(i, j) for i, j, _ in toolpath]
    at, point = place(places, begin, int(np.argmax(hit)))
    names = Text.joined(" or ", (body.name for body in bodies))
    return [
        Issue(
            ERROR,
            CLEARANCE,
            Text(
                "the nozzle touches {} at {} of {} points; on parts of revolution it is not tilted away "
                "from fixtures: move them, or use a slimmer nozzle",
                names,
                int(hit.sum()),
                len(points),
            ),
            *at,
            point,
        )
    ]
