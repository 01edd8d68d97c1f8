# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parts of long sections of a panel: fields that few jobs change are folded away under a heading of their own."""

from __future__ import annotations

from collections.abc import Sequence

from ...objects.fields.rows import Row
from ..texts.translation import marked

LONG = 12  # fields of a section that are not advanced, from which on it is divided
PARTS = {
    marked("Filling in detail"): (
        "spacing_range_low",
        "spacing_range_high",
        "fill_density",
        "solid_layers",
        "fill_angle",
        "fill_angle_step",
        "contour",
        "walls",
        "margin",
        "thin",
    ),
    marked("Order and waits"): ("starts", "order", "wait", "min_layer_time", "deflection"),
    marked("Starts and ends of beads"): ("lead_on", "lead_off", "overlap", "retreat"),
}
_TITLES = {key: title for title, keys in PARTS.items() for key in keys}


def titles(rows: Sequence[Row]) -> dict[str, str]:
    """The heading of each field of a section that is put under one, by its key; none of short sections."""
    own = [row for row in rows if len(row.path) == 1 or not isinstance(row.path[-1], str)]
    if len([row for row in own if not row.spec.advanced]) < LONG:
        return {}
    return {
        row.key: _TITLES[row.key] for row in own if row.key in _TITLES and not row.spec.advanced
    }
