# SPDX-License-Identifier: LGPL-2.1-or-later
"""Issues about tools tilted to keep the nozzle clear."""

from __future__ import annotations

import numpy as np

from ...issues import ERROR, NOTE, WARNING, Issue, Text, Word
from ...types import Array, Index, Mask

CLEARANCE = "CLEARANCE"  # the nozzle touches something while it deposits


def locate_row(
    bead_keys: list[tuple[int, int]], begin: Index, row: int
) -> tuple[tuple[int, int], int]:
    """Layer and bead of a row of the joined points, and its number in its bead. bead_keys: (layer, bead) pairs; begin: first rows."""
    bead = int(np.searchsorted(begin, row, side="right")) - 1
    return bead_keys[bead], row - int(begin[bead])


def tilt_issues(
    bead_keys: list[tuple[int, int]], begin: Index, tilt: Array, stuck: Mask
) -> list[Issue]:
    """Where tools are tilted, by tilt (n,) rad, and at which points (n,) that does not help."""
    bead = np.repeat(np.arange(len(bead_keys)), np.diff(begin))
    layer = np.array([key[0] for key in bead_keys])[bead]
    issues = []
    if stuck.any():
        bead_key, point = locate_row(bead_keys, begin, int(np.argmax(stuck)))
        issues.append(
            Issue(
                ERROR,
                CLEARANCE,
                Text(
                    "at every possible tilt, the nozzle touches substrate, fixture, platform or "
                    "deposit at {} point(s) of layers {} to {}",
                    int(stuck.sum()),
                    layer[stuck].min(),
                    layer[stuck].max(),
                ),
                *bead_key,
                point,
            )
        )
    moved = ~stuck & (tilt > 1e-9)
    if moved.any():
        worst = int(np.argmax(np.where(moved, tilt, 0.0)))
        bead_key, point = locate_row(bead_keys, begin, worst)
        first_layer, last_layer = int(layer[moved].min()), int(layer[moved].max())
        where = (
            Text("in layer {}", first_layer)
            if first_layer == last_layer
            else Text("in layers {} to {}", first_layer, last_layer)
        )
        issues.append(
            Issue(
                NOTE,
                "TILT_BACK",
                Text(
                    "{}, tool axes are tilted back for clearance, by up to {:.2f} deg",
                    Word(where),
                    np.degrees(tilt[worst]),
                ),
                *bead_key,
                point,
            )
        )
    return issues


def turn_issues(fastest: float, limit: float) -> list[Issue]:
    """A warning that tilted tools turn by `fastest` rad/mm, if not 0. limit: the maximum turn."""
    if not fastest:
        return []
    return [
        Issue(
            WARNING,
            "TURN_PASSED",
            Text(
                "for clearance, tool axes turn by up to {:.3g} deg/mm, faster than "
                "build_direction.max_turn ({:.3g} deg/mm); use a slimmer nozzle or allow a "
                "faster turn",
                np.degrees(fastest),
                np.degrees(limit),
            ),
        )
    ]
