# SPDX-License-Identifier: LGPL-2.1-or-later
"""Similar issues in several layers become one with count, layers and the worst position."""

import pytest

from freecad_am.core.issues import NOTE, WARNING, Issue, Text, ranges, summarised

HANGING = "{:.4g} mm of beads lie over nothing"


def hanging(layer, length, level=WARNING, code="UNSUPPORTED"):
    return Issue(level, code, Text(HANGING, length), layer, 0, 3)


def test_the_worst_place_stands_for_all_layers():
    issues = [hanging(layer, length) for layer, length in ((3, 2.0), (1, 30.0), (2, 7.0), (9, 4.0))]
    (line,) = summarised(issues)
    assert (line.level, line.code, line.layer, line.bead, line.point) == (
        WARNING,
        "UNSUPPORTED",
        1,
        0,
        3,
    )
    expected = (
        "4 findings in layers 1 to 3, 9, of which the worst is: 30 mm of beads lie over nothing"
    )
    assert line.message == expected
    assert line.message.values[2].values == (
        "30",
    )  # the inner message keeps its parts for translation


def test_figures_are_compared_as_numbers():
    (line,) = summarised([hanging(0, 9.0), hanging(1, 10.0)])
    assert line.layer == 1


def test_other_levels_codes_and_messages_stay_apart():
    single = Issue(NOTE, "REMAINDER", "a rest is left")
    issues = [
        hanging(0, 1.0),
        hanging(1, 1.0, level=NOTE),
        hanging(1, 1.0, code="OVERHANG"),
        single,
    ]
    assert summarised(issues) == issues


def test_several_in_one_layer_keep_their_place():
    (line,) = summarised([hanging(4, 1.0), hanging(4, 3.0), hanging(4, 2.0)])
    assert line.layer == 4
    assert line.message == "3 mm of beads lie over nothing (and 2 similar findings)"


@pytest.mark.parametrize(
    ("numbers", "text"),
    [
        ([], ""),
        ([5], "5"),
        ([0, 1, 2, 4], "0 to 2, 4"),
        ([0, 2, 4, 6, 8, 10, 12, 13, 14, 20], "0, 2, 4, 6, 8, 10, 4 more"),
    ],
)
def test_layers_are_written_as_ranges(numbers, text):
    assert ranges(numbers) == text
