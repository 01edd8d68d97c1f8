# SPDX-License-Identifier: LGPL-2.1-or-later
"""What is told of a bead in words."""

from __future__ import annotations

import numpy as np

from ...core.toolpath import Bead
from ...objects.fields.shown_units import in_user_units, quantity_text
from ..texts.translation import tr
from .rows import Rows


def facts(rows: Rows, row: int) -> str:
    """The bead that a row belongs to: its layer, number, kind, speed, width, length and time; and the row's place.

    Numbers count from 0, as in messages, programs and `waypoints.csv`; of layers of several beads the number in the layer
    is told too, by which the dock counts.
    """
    index = rows.bead_of(row)
    bead, layer = rows.bead(index), int(rows.layers[index])
    first, end = np.searchsorted(rows.layers, [layer, layer + 1])
    at = row - int(rows.starts[index])
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    time = float((length / bead.speed[1:]).sum())
    x, y, z = bead.points[at]
    low, high = rows.of_layers(layer, layer)
    place = in_user_units(
        tr("point {} (0 to {}) at {:.2f}, {:.2f}, {:.2f} mm").format(at, len(bead) - 1, x, y, z)
    )
    if end - first > 1:
        place = tr("point {} (0 to {}) of the layer, of the bead {}").format(
            row - low, high - low - 1, place
        )
    return " · ".join(
        (
            tr("Layer {} (0 to {})").format(layer, rows.layer_count - 1),
            tr("bead {} (0 to {}), {}").format(
                index - int(first), int(end - first) - 1, _kind(bead)
            ),
            quantity_text(float(bead.speed[max(at, 1)]), "mm/s"),
            in_user_units(tr("{:.4g} mm wide").format(float(rows.width[row]))),
            in_user_units(tr("{:.1f} mm long in {:.1f} s").format(float(length.sum()), time)),
            place,
        )
    )


def _kind(bead: Bead) -> str:
    if bead.closing:
        return tr("closes a gap")
    names = {
        "contour": tr("contour"),
        "line": tr("line"),
        "zigzag": tr("zigzag"),
        "spiral": tr("spiral"),
        "centre": tr("in the middle"),
        "closing": tr("closes a gap"),
    }
    return names.get(bead.kind, tr("closed") if bead.closed else tr("open"))
