# SPDX-License-Identifier: LGPL-2.1-or-later
"""The patterns by which beads fill a plane region. The one place to register one."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fill:
    """A pattern of beads.

    follows_border: beads run along the border everywhere, so that there are no contours around
    them. can_be_sparse: it can fill a share of the area. all_round: the fill in its place in a
    layer all around a hub, where its beads would have no ends; '' for none. adapts_widths: the
    widths of its contours may follow the thickness of a region.
    """

    follows_border: bool = False
    adapts_widths: bool = False
    can_be_sparse: bool = True
    all_round: str = ""


FILLS = {
    "contours": Fill(follows_border=True, adapts_widths=True),
    "connected": Fill(follows_border=True, can_be_sparse=False, all_round="contours"),
    "lines": Fill(),
    "spiral": Fill(follows_border=True, can_be_sparse=False, all_round="contours"),
    "zigzag": Fill(all_round="lines"),
    "grid": Fill(all_round="lines"),
    "triangles": Fill(all_round="lines"),
    "honeycomb": Fill(all_round="lines"),
    "gyroid": Fill(all_round="lines"),
}
