# SPDX-License-Identifier: LGPL-2.1-or-later
"""Equal lengths have equal numbers of steps, whatever their last bits."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.plane_curve import divided_by_step
from freecad_am.core.geometry.step_count import round_down, round_up, step_count, step_counts


@pytest.mark.parametrize("step", [0.1, 0.8, 1.0 / 3.0, 2.5])
@pytest.mark.parametrize("parts", [1, 5, 6, 1000])
def test_last_bits_add_no_part(step, parts):
    length = parts * step
    lengths = [length * (1.0 + k * 2.0**-50) for k in range(-8, 9)]
    assert {step_count(value, step) for value in lengths} == {parts}
    assert set(step_counts(np.array(lengths), step).tolist()) == {parts}
    assert {round_up(value / step) for value in lengths} == {parts}
    assert {round_down(value / step) for value in lengths} == {parts}


def test_a_part_more_where_the_length_asks_for_it():
    assert (
        step_count(5.001, 1.0) == 6 and step_count(0.0, 1.0) == 1 and step_count(0.0, 1.0, 0) == 0
    )
    assert step_counts(np.array([0.2, 5.001]), 1.0, 2).tolist() == [2, 6]
    assert round_up(-0.5) == 0 and round_down(-0.5) == -1


def test_a_side_of_five_steps_has_five_parts():
    side = 4.0
    for end in (np.nextafter(side, 0.0), side, np.nextafter(side, 9.0)):
        points, corners = divided_by_step(np.array([[0.0, 0.0], [end, 0.0]]), 0.8)
        assert len(points) == 6 and np.flatnonzero(corners).tolist() == [0, 5]
