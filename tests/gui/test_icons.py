# SPDX-License-Identifier: LGPL-2.1-or-later
"""Icons in the smallest size of a toolbar are visible on light and on dark ground, and no two look
alike."""

import itertools
from pathlib import Path

import numpy as np
import pytest

ICONS = Path(__file__).resolve().parent.parent.parent / "resources" / "icons"
SIZE_PX = 16  # px
GROUNDS = {"light": (240, 240, 240), "dark": (43, 43, 43)}
# WCAG 2.1, 1.4.11: the essential parts of a picture have a contrast of 3 with their neighbours
CONTRAST, SHARE = 3.0, 1.0 / 6.0
MIN_EXTENT_PX = 10  # px of 16 that the visible parts extend over
MIN_DIFFERENCE = 12.0  # mean difference of two icons, of 255
SHARED_ICONS = {
    "preferences-robotic_am",
    "workbench",
}  # a copy for FreeCAD's preferences, under the name that it needs


def draw_icon(person, icon, ground):
    """Return an icon in the smallest size on a ground, (16, 16, 3) 0..255, drawn as FreeCAD
    does."""
    from PySide import QtSvg

    image = person.widgets.QImage(SIZE_PX, SIZE_PX, person.widgets.QImage.Format_RGB32)
    image.fill(person.widgets.QColor(*ground))
    painter = person.widgets.QPainter(image)
    QtSvg.QSvgRenderer(str(icon)).render(painter)
    painter.end()
    return (
        np.frombuffer(bytes(image.constBits()), dtype=np.uint8)
        .reshape(SIZE_PX, SIZE_PX, 4)[..., 2::-1]
        .astype(float)
    )


def luminance(colours):
    """Return the relative luminance of sRGB colours (..., 3), according to WCAG."""
    shares = np.asarray(colours) / 255.0
    linear = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


def stands_out(picture, ground):
    """Return which pixels (16, 16) contrast with the ground."""
    bright, around = luminance(picture), luminance(ground)
    return (np.maximum(bright, around) + 0.05) / (np.minimum(bright, around) + 0.05) >= CONTRAST


@pytest.mark.parametrize("ground", GROUNDS)
def test_every_icon_stands_out_at_sixteen_pixels(person, ground):
    for icon in sorted(ICONS.glob("*.svg")):
        out = stands_out(draw_icon(person, icon, GROUNDS[ground]), GROUNDS[ground])
        rows, columns = np.flatnonzero(out.any(axis=1)), np.flatnonzero(out.any(axis=0))
        print(
            f"{icon.stem}: {out.mean():.2f} of the pixels, {np.ptp(columns) + 1} x {np.ptp(rows) + 1}"
        )
        assert out.mean() > SHARE, icon.stem
        assert min(np.ptp(columns), np.ptp(rows)) + 1 >= MIN_EXTENT_PX, icon.stem


def test_no_two_icons_look_alike_at_sixteen_pixels(person):
    pictures = {
        icon.stem: draw_icon(person, icon, GROUNDS["light"]) for icon in sorted(ICONS.glob("*.svg"))
    }
    assert len(pictures) > 12
    for (name, picture), (other_name, other_picture) in itertools.combinations(pictures.items(), 2):
        difference = np.abs(picture - other_picture).mean()
        assert (
            (difference < 1e-9)
            if {name, other_name} == SHARED_ICONS
            else (difference > MIN_DIFFERENCE)
        ), (name, other_name, difference)


def test_every_tool_has_an_icon_of_its_own(person):
    from freecad_am.gui.tools.commands import GROUPS

    icons = {}
    for name in itertools.chain(*GROUPS):
        image = person.button(f"RoboticAM_{name}").icon().pixmap(SIZE_PX, SIZE_PX).toImage()
        bits = bytes(image.convertToFormat(person.widgets.QImage.Format_ARGB32).constBits())
        assert len(set(bits)) > 8, name
        assert icons.setdefault(bits, name) == name
