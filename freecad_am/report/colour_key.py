# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the colours of deviations mean, as text of a page."""

from __future__ import annotations

from html import escape

from freecad_am.core.inspection.bands import bands, css


def key_of(tolerance: float) -> str:
    """A coloured square and the range in mm of each band, from the most inside on."""
    return " ".join(
        f'<span style="white-space:nowrap"><span style="color:{css(band.colour)}">&#9632;</span> {escape(band.text)}&ensp;'
        "</span>"
        for band in bands(float(f"{tolerance:.6g}"))
    )
