# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures of messages are as fine as anybody can use them."""

import pytest

from freecad_am.core.geometry.told import deviation, place


def test_places_are_told_to_a_thousandth_without_negative_zeros():
    assert place([1.00049, -0.0001, 250.0]) == "(1, 0, 250)"


@pytest.mark.parametrize(("distance", "text"), [(0.0, "0.001"), (2e-14, "0.001"), (0.0123, "0.012"), (0.5, "0.5")])
def test_deviations_are_told_no_finer_than_a_thousandth(distance, text):
    assert deviation(distance) == text
