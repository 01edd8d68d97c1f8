# SPDX-License-Identifier: LGPL-2.1-or-later
"""Whether what is deposited lies on the part: which places are looked at, how far off they may be, what is said."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...geometry.formatting import place
from ...issues import ERROR, Issue, Text
from ...toolpath import Toolpath
from ...types import Array, Index

CODE = "OFF_PART"
MAX_PLACES = 20_000  # places looked at, where beads are not more
ROUNDED = 0.02  # mm that a wall may be off its faces beside the chord error: tables, fits, imported surfaces


class Places(NamedTuple):
    """points (n, 3) mm, unit build directions (n, 3), and where they are: layer, bead, point (n,)."""

    points: Array
    build: Array
    layer: Index
    bead: Index
    point: Index


def places(toolpath: Toolpath) -> Places:
    """Both ends and the middle of every bead, and as many more, evenly, as MOST allows."""
    beads = list(toolpath)
    size = np.array([len(bead) for _, _, bead in beads])
    start = np.cumsum(size) - size
    step = max(1, int(np.ceil(size.sum() / MAX_PLACES)))
    chosen = np.unique(
        np.concatenate([start, start + size // 2, start + size - 1, np.arange(0, size.sum(), step)])
    )
    of = np.searchsorted(start, chosen, side="right") - 1
    points, build = (
        np.concatenate(every)[chosen]
        for every in zip(*((bead.points, bead.build) for _, _, bead in beads))
    )
    layer, bead = (np.array([entry[k] for entry in beads])[of] for k in (0, 1))
    return Places(points, build, layer, bead, chosen - start[of])


def allowed(toolpath: Toolpath, margin: float = 0.0) -> float:
    """How far off the part, mm, places may be: on walls the chord error and what rounding leaves; solids on hubs are filled,
    and beads in what is narrower than they are, or in a margin, stand out of it by no more than half of their width."""
    if not toolpath.filled:
        return toolpath.chord_error + ROUNDED
    return 0.5 * (toolpath.bead_width or 0.0) + abs(margin) + toolpath.chord_error


def judged(toolpath: Toolpath, looked: Places, off: Array, limit: float) -> Toolpath:
    """The toolpath with how many places were looked at, the largest distance of one and what is allowed, mm; an error where
    that is more. off: (n,) mm, NaN where nobody knows."""
    known = np.flatnonzero(np.isfinite(off))
    if not len(known):
        return toolpath
    worst = int(known[off[known].argmax()])
    made = replace(toolpath, on_part=(float(len(known)), float(off[worst]), limit))
    if off[worst] <= limit:
        return made
    where = tuple(int(column[worst]) for column in (looked.layer, looked.bead, looked.point))
    return replace(
        made,
        issues=(
            *made.issues,
            Issue(
                ERROR,
                CODE,
                Text(
                    "{} of {} places checked are off the part, this one at {} by {:.4g} mm, and {:.3g} mm are "
                    "allowed: this toolpath deposits something else; choose another strategy, or other faces, and report the part",
                    int((off[known] > limit).sum()),
                    len(known),
                    place(looked.points[worst]),
                    off[worst],
                    limit,
                ),
                *where,
            ),
        ),
    )
