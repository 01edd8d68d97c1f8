# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures saved as images and as comma separated values."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import replace

from ...plots.chart import Picture
from ...plots.draw import Range, Window, figure
from ...plots.files import KINDS, image, values
from ...plots.look import LIGHT
from .reading import frame_words

Ranges = Mapping[int, Range]
CSV = "csv"
ENDINGS = (*KINDS, CSV)


def content(
    picture: Picture, ending: str, size: tuple[int, int], across: Ranges, up: Ranges
) -> bytes:
    """The file for an ending, one of ENDINGS: an image on white of the visible range
    (`draw.Window`), or all values of the picture."""
    if ending == CSV:
        return "".join(values(picture)).encode()
    return image(
        figure(picture.charts, replace(LIGHT, words=frame_words()), *size, Window(across, up))[0],
        ending,
    )


def write(content: bytes, path: str) -> None:
    """Write a file, which appears whole or not at all. OSError where it cannot be written."""
    unfinished = f"{path}.unfinished"
    try:
        with open(unfinished, "wb") as stream:
            stream.write(content)
        os.replace(unfinished, path)
    finally:
        if os.path.exists(unfinished):
            os.remove(unfinished)
