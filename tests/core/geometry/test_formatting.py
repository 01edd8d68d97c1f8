# SPDX-License-Identifier: LGPL-2.1-or-later
"""Figures in messages have a useful number of digits."""

import pytest

from freecad_am.core.geometry.formatting import at_least, count, format_deviation, place


def test_places_are_told_to_a_thousandth_without_negative_zeros():
    """Positions are formatted to a thousandth, without negative zeros."""
    assert place([1.00049, -0.0001, 250.0]) == "(1, 0, 250)"


@pytest.mark.parametrize(
    ("distance", "text"), [(0.0, "0.001"), (2e-14, "0.001"), (0.0123, "0.012"), (0.5, "0.5")]
)
def test_deviations_are_told_no_finer_than_a_thousandth(distance, text):
    """Deviations are formatted no finer than a thousandth."""
    assert format_deviation(distance) == text


@pytest.mark.parametrize(
    ("number", "text"),
    [(3.0, "3"), (46_789_123.0, "47,000,000"), (4.7e14, "4.7e+14"), (1e400, "inf")],
)
def test_counts_are_told_to_two_digits(number, text):
    """Counts are formatted with two digits."""
    assert count(number) == text


@pytest.mark.parametrize(
    ("number", "rounded"),
    [
        (0.00451, 0.0046),
        (0.0045, 0.0045),
        (1.0, 1.0),
        (99.2, 100.0),
        (1234.0, 1300.0),
        (float("inf"), float("inf")),
    ],
)
def test_what_is_enough_is_rounded_up(number, rounded):
    """Sufficient values are rounded up."""
    assert at_least(number) == pytest.approx(rounded, rel=1e-12) and at_least(number) >= number * (
        1.0 - 1e-9
    )
