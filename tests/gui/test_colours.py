# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colour ramp is readable: lightness rises evenly, also for colour-blind users."""

import numpy as np

from freecad_am.gui import colours


def lightness(rgb):
    """Return CIE L* of sRGB colours 0..1."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    y = linear @ [0.2126, 0.7152, 0.0722]
    return np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, y * 24389 / 27)


def test_lightness_rises_evenly():
    ramp = colours.ramp(np.linspace(0, 1, 65))
    assert ramp.min() >= 0 and ramp.max() <= 1
    steps = np.diff(lightness(ramp))
    assert steps.min() > 0 and steps.max() < 2.5 * steps.mean()
    assert lightness(ramp)[-1] - lightness(ramp)[0] > 40


def test_shares_outside_are_the_ends():
    ends = colours.ramp([0.0, 1.0])
    assert np.array_equal(colours.ramp([-1.0, 2.0]), ends)


def contrast(foreground, background):
    """Return the contrast of two QColors according to WCAG 2."""
    lights = []
    for colour in (foreground, background):
        rgb = np.array([colour.redF(), colour.greenF(), colour.blueF()])
        linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
        lights.append(float(linear @ [0.2126, 0.7152, 0.0722]))
    return (max(lights) + 0.05) / (min(lights) + 0.05)


def test_texts_follow_the_theme_of_the_window(person):
    """Texts follow the theme in both directions, also in an open panel."""
    application = person.widgets.QApplication.instance()
    label = person.widgets.QLabel("wrong", person.window)
    dark = "QWidget { color: #d2d8e1; background-color: #232932; }"
    try:
        for sheet, ground, is_dark in (("", "#efefef", False), (dark, "#232932", True)) * 2:
            application.setStyleSheet(sheet)
            person.idle(0.2)
            assert colours.is_dark() == is_dark
            for role in (colours.PLAIN, colours.INVALID, colours.GOOD, colours.FAINT):
                assert contrast(colours.of(role), person.widgets.QColor(ground)) >= 4.5, role
            if not label.styleSheet():
                colours.set_role(label, colours.INVALID)
            person.idle(0.1)
            assert colours.of(colours.INVALID).name() in label.styleSheet()
    finally:
        application.setStyleSheet("")
        label.deleteLater()
        person.idle(0.2)
