# SPDX-License-Identifier: LGPL-2.1-or-later
"""Numbers in FANUC listings have the form of controllers: no 0 before the point, except for 0
itself."""

import pytest

from freecad_am.posts.fanuc.post import right_aligned


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.25, "      .250"),
        (-0.25, "     -.250"),
        (0.0, "     0.000"),
        (0.0004, "     0.000"),
        (-0.0, "     -.000"),
        (12.5, "    12.500"),
        (-1203.0614, " -1203.061"),
        (1234567.5, "1234567.500"),
    ],
)
def test_numbers_keep_their_field_or_widen_it(value, text):
    assert right_aligned(value, 3, 10) == text
