# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers as text for many at once, against Python's own formatting of one."""

import numpy as np
import pytest

from freecad_am.core import digits

SIZES = ((3, 1e-3), (7, 1.0), (400, 50.0), (400, 4e3), (100, 9e4), (50, 1e6), (20, 3e9))


def numbers(count, size, decimals, seed):
    values = np.round(np.random.default_rng(seed).normal(size=count) * size, decimals)
    values[::7], values[1::5] = 0.0, np.round(values[1::5])
    values[2::11] *= 1e-2
    return np.round(values, decimals)


def listed(value, decimals, width):
    """As controllers list it: no 0 before the point, but that of 0."""
    text = f"{abs(value):.{decimals}f}"
    if text.startswith("0.") and (float(text) or np.signbit(value)):
        text = text[1:]
    return (("-" if np.signbit(value) else "") + text).rjust(width)


@pytest.mark.parametrize(
    "count, size, decimals",
    [
        (*sizes, decimals)
        for sizes in SIZES
        for decimals in (0, 3, 7)
        if sizes[1] * 10**decimals < 1e14  # floats have so many
    ],
)
def test_plain_numbers_are_as_python_writes_them(count, size, decimals):
    values = numbers(count, size, decimals, 5)
    text = digits.joined([digits.plain(digits.whole(values, decimals), decimals), b";"], count)
    assert text.split(";")[:-1] == [f"{value + 0.0:.{decimals}f}" for value in values]


@pytest.mark.parametrize("count, size", SIZES)
def test_right_aligned_numbers_keep_their_field_or_widen_it(count, size):
    values = numbers(count, size, 3, 6)
    text = digits.joined([b"<", digits.right_aligned(values, 3, 10), b">"], count)
    assert text == "".join(f"<{listed(value, 3, 10)}>" for value in values)


def test_a_negative_nought_shows_its_sign_only_where_it_is_listed():
    noughts = np.array([0.0, -0.0])
    assert digits.joined([digits.right_aligned(noughts, 3, 6), b"|"], 2) == " 0.000| -.000|"
    assert digits.joined([digits.plain(digits.whole(noughts, 3), 3), b"|"], 2) == "0.000|0.000|"


def test_no_numbers_are_no_text():
    none = np.zeros(0)
    assert (
        digits.joined(
            [digits.plain(digits.whole(none, 3), 3), digits.right_aligned(none, 3, 10), b","], 0
        )
        == ""
    )
