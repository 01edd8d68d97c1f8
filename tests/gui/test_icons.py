# SPDX-License-Identifier: LGPL-2.1-or-later
"""Icons in the smallest size of a toolbar, on light and on dark ground: something is seen, and no two look alike."""

import itertools
from pathlib import Path

import numpy as np
import pytest

ICONS = Path(__file__).resolve().parent.parent.parent / "resources" / "icons"
SIZE = 16  # px
GROUNDS = {"light": (240, 240, 240), "dark": (43, 43, 43)}
# WCAG 2.1, 1.4.11: what makes out a picture has a contrast of 3 to what is beside it
CONTRAST, SHARE = 3.0, 1.0 / 6.0
ACROSS = 10  # px that what stands out reaches over, of 16
APART = 12.0  # mean difference of two icons, of 255
SAME = {
    "preferences-robotic_am",
    "workbench",
}  # one for FreeCAD's preferences, under the name it asks for


def on(person, icon, ground):
    """An icon in the smallest size on a ground, (16, 16, 3) 0..255, drawn as FreeCAD does."""
    from PySide import QtSvg

    image = person.widgets.QImage(SIZE, SIZE, person.widgets.QImage.Format_RGB32)
    image.fill(person.widgets.QColor(*ground))
    painter = person.widgets.QPainter(image)
    QtSvg.QSvgRenderer(str(icon)).render(painter)
    painter.end()
    return (
        np.frombuffer(bytes(image.constBits()), dtype=np.uint8)
        .reshape(SIZE, SIZE, 4)[..., 2::-1]
        .astype(float)
    )


def luminance(colours):
    """Relative luminance of sRGB colours (..., 3), as WCAG has it."""
    shares = np.asarray(colours) / 255.0
    linear = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)
    return linear @ [0.2126, 0.7152, 0.0722]


def seen(picture, ground):
    """(16, 16) whether a pixel stands out from the ground."""
    bright, around = luminance(picture), luminance(ground)
    return (np.maximum(bright, around) + 0.05) / (np.minimum(bright, around) + 0.05) >= CONTRAST


@pytest.mark.parametrize("ground", GROUNDS)
def test_every_icon_stands_out_at_sixteen_pixels(person, ground):
    for icon in sorted(ICONS.glob("*.svg")):
        out = seen(on(person, icon, GROUNDS[ground]), GROUNDS[ground])
        rows, columns = np.flatnonzero(out.any(axis=1)), np.flatnonzero(out.any(axis=0))
        print(
            f"{icon.stem}: {out.mean():.2f} of the pixels, {np.ptp(columns) + 1} x {np.ptp(rows) + 1}"
        )
        assert out.mean() > SHARE, icon.stem
        assert min(np.ptp(columns), np.ptp(rows)) + 1 >= ACROSS, icon.stem


def test_no_two_icons_look_alike_at_sixteen_pixels(person):
    pictures = {
        icon.stem: on(person, icon, GROUNDS["light"]) for icon in sorted(ICONS.glob("*.svg"))
    }
    assert len(pictures) > 12
    for (one, first), (other, second) in itertools.combinations(pictures.items(), 2):
        apart = np.abs(first - second).mean()
        assert (apart < 1e-9) if {one, other} == SAME else (apart > APART), (one, other, apart)


def test_every_tool_has_an_icon_of_its_own(person):
    from freecad_am.gui.tools.commands import GROUPS

    found = {}
    for name in itertools.chain(*GROUPS):
        image = person.button(f"RoboticAM_{name}").icon().pixmap(SIZE, SIZE).toImage()
        bits = bytes(image.convertToFormat(person.widgets.QImage.Format_ARGB32).constBits())
        assert len(set(bits)) > 8, name
        assert found.setdefault(bits, name) == name
