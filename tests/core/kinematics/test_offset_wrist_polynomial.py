# SPDX-License-Identifier: LGPL-2.1-or-later
"""Zeros of the polynomial of arms with an offset wrist agree with a search along loops that shares
no code."""

import numpy as np
import pytest

from freecad_am.core.kinematics.inverse import (
    offset_wrist_polynomial,
    offset_wrist_search,
    recognition,
)
from freecad_am.core.kinematics.inverse import trigonometric_zeros as trigonometric
from tests.core.kinematics.arms import (
    CROOKED_CRX,
    CRX_10IA,
    GOFA_5,
    GOFA_10,
    HC10,
    M710IC_50E,
    chain,
    joint_difference,
    second_opinion,
)

pytest.importorskip("PyKDL")


TWINS = 1e-4  # rad
ARMS = {
    "CRX-10iA": CRX_10IA,
    "HC10": HC10,
    "GoFa 5": GOFA_5,
    "GoFa 10": GOFA_10,
    "M-710iC/50E": M710IC_50E,
    "crooked": CROOKED_CRX,
}


@pytest.fixture(params=ARMS.values(), ids=ARMS.keys(), scope="module")
def arm(request):
    arm_chain = chain(request.param)
    return arm_chain, recognition.arm_of(arm_chain)


@pytest.fixture
def most(request, arm):
    """Maximum number of 1,000 poses that fall back to the search: solutions of an arm with oblique
    axes are closer together."""
    return 100 if request.node.callspec.params["arm"] is CROOKED_CRX else 20


def _curves(arm, q):
    return arm[1]._curves(arm[0].forward(q))


def _rows(zeros):
    """Pose, side, elbow, angle in [0, 2 pi), sine of the elbow, sign of the slope; sorted."""
    rows = np.stack(
        [
            zeros.pose,
            zeros.side,
            zeros.elbow,
            zeros.angle % (2 * np.pi),
            zeros.bent[0],
            zeros.slope > 0,
        ],
        axis=1,
    )
    return rows[np.lexsort(rows.T[3::-1])]


def test_only_arms_of_its_kind_have_the_same_zeros_on_both_sides():
    for figures, expected in (
        (CRX_10IA, True),
        (HC10, True),
        (GOFA_5, False),
        (GOFA_10, False),
        (M710IC_50E, False),
        (CROOKED_CRX, False),
    ):
        arm_chain = chain(figures)
        assert (
            offset_wrist_polynomial.is_even(
                recognition.arm_of(arm_chain)._curves(arm_chain.forward(np.zeros((1, 6))))
            )
            == expected
        )


def test_zeros_are_those_of_the_search(arm, most, monkeypatch):
    curves = _curves(arm, np.random.default_rng(11).uniform(-np.pi, np.pi, (1000, 6)))
    expected = _rows(offset_wrist_search.zeros(curves))
    pose_counts = []
    real = offset_wrist_search.zeros
    monkeypatch.setattr(
        offset_wrist_search,
        "zeros",
        lambda curves_of_poses: (
            pose_counts.append(curves_of_poses.point.shape[2]) or real(curves_of_poses)
        ),
    )
    rows = _rows(offset_wrist_polynomial.zeros(curves))
    assert rows.shape == expected.shape and np.array_equal(
        rows[:, [0, 1, 2, 5]], expected[:, [0, 1, 2, 5]]
    )
    assert np.abs(rows[:, 3:5] - expected[:, 3:5]).max() < 1e-9
    assert sum(pose_counts) < most


@pytest.mark.always("CRX-10iA", "crooked")
def test_zeros_that_meet_are_found(arm):
    """Near poses where two solutions coincide (the determinant of PyKDL's Jacobian is zero) all
    zeros of the search are found."""
    arm_chain, _ = arm
    kdl = second_opinion(arm_chain)
    met = []
    for row in np.random.default_rng(12).uniform(-np.pi, np.pi, (150, 6)):
        around = np.tile(row, (181, 1))
        around[:, 4] = np.linspace(-np.pi, np.pi, 181)
        size = np.linalg.det(kdl.jacobian(around))
        where = np.flatnonzero(size[1:] * size[:-1] < 0.0)
        if len(where):
            index = where[0]
            row[4] = around[index, 4] + (around[1, 4] - around[0, 4]) * size[index] / (
                size[index] - size[index + 1]
            )
            met.append(row)
    assert len(met) > 100
    for off in (0.0, 1e-5, 1e-3, 1e-2):
        q = np.array(met) + np.array([0, 0, 0, 0, off, 0])
        curves = _curves(arm, q)
        zeros, expected = (
            offset_wrist_polynomial.zeros(curves),
            _rows(offset_wrist_search.zeros(curves)),
        )
        rows = _rows(zeros)
        same = (rows[:, None, :3] == expected[:, :3]).all(axis=2)
        differences = np.where(
            same, np.abs(np.exp(1j * rows[:, 3, None]) - np.exp(1j * expected[:, 3])), 9.0
        )
        assert differences.min(axis=0).max() < 1e-6
        # zeros that the search misses are solutions too, and rare
        assert (
            np.abs(
                offset_wrist_search.values(curves, zeros.pose, zeros.angle, zeros.side, zeros.elbow)
            ).max()
            < 1e-7
        )
        extra = differences.min(axis=1)
        assert (extra > TWINS).sum() <= 8
        # coinciding zeros are known to the root of the last digit: one may appear as two close ones
        assert (extra > 1e-6).sum() <= (24 if off < TWINS else 0)
        if off:  # where they coincide exactly the condition is flat; test_offset_wrist checks the accuracy
            assert (
                np.nanmin(joint_difference(arm[1].inverse(arm_chain.forward(q)), q), axis=0).max()
                < 1e-5
            )


def test_the_polynomial_is_the_condition_on_axis_5_of_both_elbows(arm):
    """At angles of axis 6 within reach: the product of both elbows' conditions, in factors of
    degree 4 and 3, whose product for both sides has degree 8."""
    rng = np.random.default_rng(13)
    curves = _curves(arm, rng.uniform(-np.pi, np.pi, (300, 6)))
    length = 1.0 / (curves.upper + curves.fore)
    lengths = offset_wrist_polynomial._Lengths(
        curves.upper * length,
        curves.fore * length,
        curves.ahead * length,
        *curves.lean,
        curves.square,
    )
    curve_points = np.stack([curves.point * length, curves.five])
    indices, ones = np.arange(300), np.ones(300)
    angles = 2.0 * np.pi / 64 * np.arange(64)
    terms = {
        side: [
            offset_wrist_polynomial._terms(lengths, curve_points, angle * ones, side * ones)
            for angle in angles
        ]
        for side in (1.0, -1.0)
    }
    front, back = (np.stack([term.value for term in terms[side]]) for side in (1.0, -1.0))
    radius = np.stack([term.radius for term in terms[1.0]])
    for value, degree in ((front + back, 4), ((front - back) / radius, 3), (front * back, 8)):
        assert np.abs(np.fft.rfft(value, axis=0)[degree + 1 :]).max() < 1e-11 * np.abs(front).max()
    even = offset_wrist_polynomial.is_even(curves)
    product = offset_wrist_polynomial._coefficients(lengths, curve_points, even)
    rows = trigonometric.harmonics(len(product) // 2, angles).T
    np.testing.assert_allclose(rows @ product, front if even else front * back, atol=1e-13)
    checked_count = 0
    for index, angle in enumerate(angles):
        for side in (1.0, -1.0):
            term = terms[side][index]
            inside = term.squared - term.common**2 > 1e-3
            elbow_product = np.prod(
                [
                    offset_wrist_search.values(
                        curves, indices, angle * ones, side * ones, elbow * ones
                    )
                    for elbow in (1.0, -1.0)
                ],
                axis=0,
            )
            np.testing.assert_allclose(
                (elbow_product * (term.radius**2 * term.squared))[inside],
                term.value[inside],
                atol=1e-12,
            )
            assert (term.value[term.squared < term.common**2] > 0.0).all()
            step = 1e-5
            ahead, behind = (
                offset_wrist_polynomial._terms(
                    lengths, curve_points, (angle + shift) * ones, side * ones
                ).value
                for shift in (step, -step)
            )
            smooth = np.abs(term.radius) > 0.05
            np.testing.assert_allclose(
                ((ahead - behind) / (2.0 * step))[smooth], term.slope[smooth], atol=1e-7
            )
            checked_count += inside.sum()
    assert checked_count > 10000


def test_a_pair_that_the_search_passes_over_is_found():
    """HC10 with its elbow nearly stretched: between both zeros, 0.01 rad apart, the condition stays
    below 1e-5."""
    arm_chain = chain(HC10)
    q = np.array([[2.04783863, 1.06449714, 0.01974395, -2.99700261, 0.04945112, 1.16245284]])
    solutions = recognition.arm_of(arm_chain).inverse(second_opinion(arm_chain).forward(q))[:, 0]
    assert np.isfinite(solutions).all(axis=1).sum() == 12
    assert np.nanmin(joint_difference(solutions, q)) < 1e-9
