# SPDX-License-Identifier: LGPL-2.1-or-later
"""The colour ramp can be read: lightness rises evenly, also for eyes that see no hue."""

import numpy as np

from freecad_am.gui import colours


def lightness(rgb):
    """CIE L* of sRGB colours 0..1."""
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
