# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a toolpath was fitted to: where a scan found the surface that its first layer lies on."""

from __future__ import annotations

from dataclasses import dataclass

from ..types import Array

REMAINS = "SCAN_REMAINS"  # that the last layer is still off the plan


@dataclass(frozen=True)
class Fitted:
    """file: name of the scan. points: how many of its points were looked at, left_out: how many face another way than the
    layers grow. layer: number of the first layer that was fitted; layers: over how many, from that one, the deposit is led
    back to the plan. places: (m, 3) mm in part coordinates, all over that layer as it was planned; off: (m,) mm along the
    build direction from there to the scan. laid: (k, 3) mm, places of that layer as it is laid now, between points too;
    left: (k,) mm from there to the scan. slope: the most that the scan rises along beads against the plan, per mm. remains:
    mm that the last layer is still off the plan. motion: (4, 4) from where the scan was measured to the part.
    """

    file: str
    points: int
    left_out: int
    layer: int
    layers: int
    places: Array
    off: Array
    laid: Array
    left: Array
    slope: float
    remains: float
    motion: Array
