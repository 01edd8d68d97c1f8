# SPDX-License-Identifier: LGPL-2.1-or-later
"""Overlapping beads in one layer, against areas that follow from their positions."""

import math

import numpy as np
import pytest

from freecad_am.core.process.deposit.pieces import deposited_twice
from tests.core.process.test_support import HEIGHT, WIDTH, bead, rod, toolpath


def circle(radius, count=400, turns=1.0):
    angle = np.linspace(0.0, 2.0 * math.pi * turns, count + 1)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * angle], axis=1)


def rotated_bead(angle, length=60.0, centre=(0.0, 0.0)):
    half = 0.5 * length * np.array([math.cos(angle), math.sin(angle)])
    return bead([[*(centre - half), 0.0], [*(centre + half), 0.0]])


def area(*beads, other_layers=()):
    return deposited_twice(toolpath(list(beads), *other_layers)) / HEIGHT


def test_beads_apart_or_end_to_end_or_above_each_other_share_nothing():
    assert area(rod(0, 60), rod(0, 60, WIDTH)) == pytest.approx(0.0, abs=1e-6)
    assert area(rod(0, 60), rod(60, 100)) == area(rod(0, 60)) == 0.0
    assert area(rod(0, 60), rod(0, 60, z=HEIGHT)) == 0.0
    assert area(rod(0, 60), other_layers=([rod(0, 60)], [rod(0, 60)])) == 0.0  # of another layer


@pytest.mark.parametrize("apart", [0.0, 1.0, 3.0, 7.0])
def test_beads_side_by_side_share_what_their_widths_are_more(apart):
    """Parallel beads overlap by the excess of their width over their distance."""
    assert area(rod(0, 60), rod(0, 60, apart)) == pytest.approx(60.0 * (WIDTH - apart), rel=1e-9)
    assert area(rod(0, 60), rod(20, 40, -apart)) == pytest.approx(20.0 * (WIDTH - apart), rel=0.04)


@pytest.mark.parametrize("angle", [30.0, 60.0, 90.0, 120.0])
def test_beads_that_cross_share_a_rhombus(angle):
    overlap = area(rotated_bead(0.2), rotated_bead(0.2 + math.radians(angle)))
    assert overlap == pytest.approx(WIDTH**2 / math.sin(math.radians(angle)), rel=0.05)


def test_rings_bends_and_turns_share_nothing_with_themselves():
    corner = bead([[0, 0, 0], [60, 0, 0], [60, 60, 0]])
    assert (
        area(bead(circle(30.0), True)) == area(bead(circle(5.0, 60), True)) == area(corner) == 0.0
    )
    spiral = circle(30.0, 1200, 3.0)
    spiral[:, 2] = np.linspace(0.0, 3.0 * HEIGHT, len(spiral))
    assert area(bead(spiral)) == 0.0


def test_a_bead_that_comes_back_beside_itself_shares_that():
    """A bead that returns next to itself overlaps itself."""
    there_and_back = bead([[0, 0, 0], [60, 0, 0], [60, 20, 0], [20, 20, 0], [20, 5, 0], [50, 5, 0]])
    # 30 mm next to the first 5 mm away, less the bends
    assert area(there_and_back) == pytest.approx(30.0 * (WIDTH - 5.0), rel=0.15)
    assert area(bead(circle(30.0, 800, 2.0))) == pytest.approx(
        WIDTH * 2.0 * math.pi * 30.0, rel=0.002
    )  # around twice
    assert area(bead(circle(30.0, 8000, 2.0))) == pytest.approx(
        WIDTH * 2.0 * math.pi * 30.0, rel=0.002
    )  # dense points
