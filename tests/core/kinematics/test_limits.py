# SPDX-License-Identifier: LGPL-2.1-or-later
"""Margins to limits of axes and of coupled axes."""

import numpy as np
import pytest

from freecad_am.core.kinematics.machines import machine


@pytest.fixture
def arm():
    return machine.load("fanuc-arcmate120ic")


def test_margin_is_the_way_to_the_nearer_end(arm):
    limits = arm.limits("maker")
    q = np.radians((-160.0, 150.0, 0.0, 10.0, 141.0, 0.0))
    # axis 3 of the pendant is -150 there, of -185 .. 273
    assert np.degrees(limits.margin(q)) == pytest.approx((10, 10, 90, 190, -1, 270, 35))
    assert limits.exceeded(q).tolist() == [False, False, False, False, True, False, False]
    assert limits.labels == ("q1", "q2", "q3", "q4", "q5", "q6", "J3_TP (q3 - q2)")
    smallest = limits.smallest(q)
    assert (np.degrees(smallest.margin), limits.labels[smallest.label]) == (
        pytest.approx(-1.0),
        "q5",
    )


def test_coupled_limit_counts(arm):
    """Each axis within its own limits, but J3 of the pendant at -200, beyond the coupled limit."""
    limits = arm.limits("maker")
    q = np.radians((0.0, 140.0, -60.0, 0.0, 90.0, 0.0))
    assert (limits.margin(q)[:6] > 0).all()
    assert limits.exceeded(q).tolist() == [False] * 6 + [True]
    assert limits.labels[limits.smallest(q).label] == "J3_TP (q3 - q2)"
    assert np.degrees(limits.smallest(q).margin) == pytest.approx(-15.0)
    assert np.degrees(arm.to_controller(q))[2] == pytest.approx(-200.0)


def test_arrays_and_unreachable_points(arm):
    limits = arm.limits("maker")
    q = np.random.default_rng(1).uniform(-3, 3, (4, 50, 6))
    q[1, 2] = np.nan
    margins = limits.margin(q)
    assert margins.shape == (4, 50, 7)
    for axis in range(6):
        nearer = np.minimum(q[..., axis] - limits.lower[axis], limits.upper[axis] - q[..., axis])
        assert np.array_equal(margins[..., axis], nearer, equal_nan=True)
    smallest = limits.smallest(q)
    assert np.array_equal(smallest.margin, margins.min(axis=-1), equal_nan=True)
    assert np.isnan(smallest.margin[1, 2])
    assert not limits.exceeded(q)[1, 2].any()


@pytest.mark.parametrize("name", ["maker", "paper"])
def test_the_smallest_share_is_that_of_all(arm, name):
    limits = arm.limits(name)
    q = np.random.default_rng(2).uniform(-4, 4, (500, 6))
    q[7], q[8, 3] = np.nan, np.nan
    shares = limits.shares(q)
    assert shares.shape == (500, len(limits.labels)) and (
        name == "paper" or (shares.argmin(axis=1) == 6).any()
    )
    assert np.allclose(
        limits.smallest_share(q), shares.min(axis=1), rtol=0.0, atol=1e-14, equal_nan=True
    )


def test_endless_axis(arm):
    paper = arm.limits("paper")
    assert paper.continuous.tolist() == [False] * 5 + [True]
    assert np.degrees(paper.upper - paper.lower) == pytest.approx((370, 320, 546, 400, 270, np.inf))
    assert np.isposinf(paper.margin(np.radians((0.0, 0, 0, 0, 0, 1e6)))[5])


def test_tolerance(arm):
    q = np.zeros(6)
    q[4] = np.radians(140.0) + 1e-9
    assert arm.limits("maker").exceeded(q)[4]
    assert not arm.limits("maker").exceeded(q, 1e-8).any()
