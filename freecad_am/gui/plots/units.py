# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures in the user's units."""

from __future__ import annotations

from ...objects.fields.shown_units import scale_of
from ...plots import units
from ...plots.chart import Picture


def in_units(picture: Picture) -> Picture:
    """A picture in those units; axes of machines keep the units of their controllers."""
    return units.in_units(picture, scale_of)
