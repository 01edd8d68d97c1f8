# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is said of tools that are tilted to keep the nozzle clear."""

from __future__ import annotations

import numpy as np

from ...issues import ERROR, NOTE, WARNING, Issue, Text, Word
from ...types import Array, Index, Mask

CLEARANCE = "CLEARANCE"  # the nozzle touches something while it deposits


def place(places: list[tuple[int, int]], begin: Index, row: int) -> tuple[tuple[int, int], int]:
    """Layer and bead of a row of all points, and the point's number in its bead. places: (layer, bead);
    begin: first rows."""
    bead = int(np.searchsorted(begin, row, side="right")) - 1
    return places[bead], row - int(begin[bead])


def tilt_issues(
    places: list[tuple[int, int]], begin: Index, tilt: Array, lost: Mask
) -> list[Issue]:
    """Where tools are tilted, by tilt (n,) rad, and at which points (n,) that does not help."""
    bead = np.repeat(np.arange(len(places)), np.diff(begin))
    layer = np.array([place[0] for place in places])[bead]
    issues = []
    if lost.any():
        at, point = place(places, begin, int(np.argmax(lost)))
        issues.append(
            Issue(
                ERROR,
                CLEARANCE,
                Text(
                    "however the tool is tilted, the nozzle touches substrate, fixture, platform or "
                    "deposit at {} point(s) of layers {} to {}",
                    int(lost.sum()),
                    layer[lost].min(),
                    layer[lost].max(),
                ),
                *at,
                point,
            )
        )
    moved = ~lost & (tilt > 1e-9)
    if moved.any():
        worst = int(np.argmax(np.where(moved, tilt, 0.0)))
        at, point = place(places, begin, worst)
        first, last = int(layer[moved].min()), int(layer[moved].max())
        where = (
            Text("in layer {}", first) if first == last else Text("in layers {} to {}", first, last)
        )
        issues.append(
            Issue(
                NOTE,
                "TILT_BACK",
                Text(
                    "{}, tool axes are tilted back to keep the nozzle clear, by up to {:.2f} deg",
                    Word(where),
                    np.degrees(tilt[worst]),
                ),
                *at,
                point,
            )
        )
    return issues


def turn_issues(fastest: float, most: float) -> list[Issue]:
    """That tilted tools turn by `fastest` rad/mm, where that is not 0; most: what they should."""
    if not fastest:
        return []
    return [
        Issue(
            WARNING,
            "TURN_PASSED",
            Text(
                "to keep the nozzle clear, tool axes turn by up to {:.3g} deg/mm, faster than "
                "build_direction.max_turn ({:.3g} deg/mm); use a slimmer nozzle or allow a faster turn",
                np.degrees(fastest),
                np.degrees(most),
            ),
        )
    ]
