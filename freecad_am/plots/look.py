# SPDX-License-Identifier: LGPL-2.1-or-later
"""Colours of pictures: on light and on dark grounds, in the colours of a page, and scales."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# of axes and other curves, legible on light and dark
PALETTE = ("#3b6fd4", "#d9633b", "#2f9e6e", "#9a5bd0", "#c79a1e", "#cf3f74", "#3aa5b8", "#7a7f87")
BAR = PALETTE[0]

# anchors of a perceptually even scale from dark blue over green to yellow
_SCALE = np.array(
    [
        (68, 1, 84),
        (72, 40, 120),
        (62, 74, 137),
        (49, 104, 142),
        (38, 130, 142),
        (31, 158, 137),
        (53, 183, 121),
        (109, 205, 89),
        (180, 222, 44),
        (253, 231, 37),
    ],
    dtype=float,
)


@dataclass(frozen=True)
class Words:
    """Texts of a frame in addition to those in its chart, filled in by `format`."""

    layer: str = "layer {}"
    beyond: str = "{}: {} points beyond the limit"
    limits: str = "limits {} to {} {}"
    limit: str = "limits up to {} {}"


@dataclass(frozen=True)
class Look:
    """ink: titles; soft: all other text; grid; bad: limits and violations; good: target bands;
    paper: the background, "none" for the background of a page. All as #rrggbb."""

    ink: str
    soft: str
    grid: str
    bad: str
    good: str
    paper: str
    words: Words = Words()

    def colour(self, colour: int | str) -> str:
        """The colour of a curve."""
        if isinstance(colour, int):
            return PALETTE[colour % len(PALETTE)]
        return colour if colour.startswith("#") else str(getattr(self, colour))


LIGHT = Look("#1d2430", "#667085", "#dfe3ea", "#b8322a", "#1a7f4b", "#ffffff")
DARK = Look("#e6e9ef", "#98a2b3", "#323a47", "#ff7a70", "#4cc38a", "#1a202b")
# for a page that sets the colours: each is a variable of its style
PAGE = Look("#010203", "#010204", "#010205", "#010206", "#010207", "none")
VARIABLES = {
    PAGE.ink: "--ink",
    PAGE.soft: "--soft",
    PAGE.grid: "--line",
    PAGE.bad: "--bad",
    PAGE.good: "--good",
}


def shade(share: float) -> str:
    """A colour of the scale at 0 to 1, as #rrggbb."""
    level = min(max(share, 0.0), 1.0) * (len(_SCALE) - 1)
    low = min(int(level), len(_SCALE) - 2)
    red, green, blue = (
        (_SCALE[low] + (level - low) * (_SCALE[low + 1] - _SCALE[low])).round().astype(int)
    )
    return f"#{red:02x}{green:02x}{blue:02x}"
