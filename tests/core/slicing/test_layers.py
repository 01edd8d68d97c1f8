# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layer rules compared with closed forms."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, arc, line
from freecad_am.core.issues import InputError
from freecad_am.core.slicing import revolution

SPHERE = Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)])
CYLINDER = Meridian.chained([line((10.0, 0.0), (10.0, 30.0))])


def test_arc_length_layers_start_at_the_base_and_end_below_the_top():
    layers, remainder = revolution.arc_length_levels(SPHERE, 1.0)
    assert np.concatenate(layers) == pytest.approx(np.arange(71.0))
    assert remainder == pytest.approx(22.5 * np.pi - 70.0)
    assert len(revolution.arc_length_levels(SPHERE, 5.0)[0]) == 15


@pytest.mark.parametrize("height", [0.1, 0.3, 1.0, 7.5, 30.0])
def test_a_whole_number_of_layers_ends_on_the_top(height):
    for rule in (revolution.arc_length_levels, revolution.iso_height_levels):
        layers, remainder = rule(CYLINDER, height)
        assert len(layers) == round(30.0 / height) + 1
        assert layers[-1] == pytest.approx([30.0], abs=1e-9)
        assert remainder == pytest.approx(0.0, abs=1e-9)


def test_iso_height_layers_are_planar():
    layers, remainder = revolution.iso_height_levels(SPHERE, 2.0)
    heights = SPHERE.at(np.concatenate(layers))[1]
    assert heights == pytest.approx(np.arange(0.0, 45.0, 2.0), abs=1e-8)
    assert remainder == pytest.approx(1.0)


def test_iso_height_cuts_a_vault_twice():
    vault = Meridian.chained([arc((50.0, 0.0), 10.0, 0.0, np.pi)])
    layers, _ = revolution.iso_height_levels(vault, 3.0)
    assert [len(layer) for layer in layers] == [2, 2, 2, 2]
    distances = revolution.spacing(vault, layers[0], layers[1])
    assert distances == pytest.approx(np.full(2, np.hypot(3.0, 10.0 - np.sqrt(91.0))), abs=1e-7)


@pytest.mark.parametrize("rule", [revolution.arc_length_levels, revolution.iso_height_levels])
def test_layers_higher_than_the_wall_are_rejected(rule):
    with pytest.raises(InputError, match=r"strategy\.layer_height.*30\.1 mm.*30 mm") as caught:
        rule(CYLINDER, 30.1)
    assert caught.value.code == "LAYER_HEIGHT"
