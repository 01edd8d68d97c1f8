# SPDX-License-Identifier: LGPL-2.1-or-later
"""Zeros of the polynomial of arms with an offset wrist are those of the search along loops, which shares none of it."""

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
    apart,
    chain,
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
    of = chain(request.param)
    return of, recognition.arm_of(of)


@pytest.fixture
def most(request, arm):
    """Of 1,000 poses that the search is asked about: solutions of an arm that is out of square are nearer to each other."""
    return 100 if request.node.callspec.params["arm"] is CROOKED_CRX else 20


def _curves(arm, q):
    return arm[1]._curves(arm[0].forward(q))


def _rows(zeros):
    """Pose, side, elbow, angle in [0, 2 pi), sine of the elbow, whether the slope is positive; in order."""
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
    for figures, wanted in (
        (CRX_10IA, True),
        (HC10, True),
        (GOFA_5, False),
        (GOFA_10, False),
        (M710IC_50E, False),
        (CROOKED_CRX, False),
    ):
        of = chain(figures)
        assert (
            offset_wrist_polynomial.is_even(
                recognition.arm_of(of)._curves(of.forward(np.zeros((1, 6))))
            )
            == wanted
        )


def test_zeros_are_those_of_the_search(arm, most, monkeypatch):
    curves = _curves(arm, np.random.default_rng(11).uniform(-np.pi, np.pi, (1000, 6)))
    expected = _rows(offset_wrist_search.zeros(curves))
    asked = []
    real = offset_wrist_search.zeros
    monkeypatch.setattr(
        offset_wrist_search, "zeros", lambda some: asked.append(some.point.shape[2]) or real(some)
    )
    found = _rows(offset_wrist_polynomial.zeros(curves))
    assert found.shape == expected.shape and np.array_equal(
        found[:, [0, 1, 2, 5]], expected[:, [0, 1, 2, 5]]
    )
    assert np.abs(found[:, 3:5] - expected[:, 3:5]).max() < 1e-9
    assert sum(asked) < most


@pytest.mark.always("CRX-10iA", "crooked")
def test_zeros_that_meet_are_found(arm):
    """Where two solutions meet, the determinant of PyKDL's Jacobian being zero, and about there: all that the search has."""
    of, _ = arm
    kdl = second_opinion(of)
    met = []
    for row in np.random.default_rng(12).uniform(-np.pi, np.pi, (150, 6)):
        around = np.tile(row, (181, 1))
        around[:, 4] = np.linspace(-np.pi, np.pi, 181)
        size = np.linalg.det(kdl.jacobian(around))
        where = np.flatnonzero(size[1:] * size[:-1] < 0.0)
        if len(where):
            at = where[0]
            row[4] = around[at, 4] + (around[1, 4] - around[0, 4]) * size[at] / (
                size[at] - size[at + 1]
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
        found = _rows(zeros)
        same = (found[:, None, :3] == expected[:, :3]).all(axis=2)
        away = np.where(
            same, np.abs(np.exp(1j * found[:, 3, None]) - np.exp(1j * expected[:, 3])), 9.0
        )
        assert away.min(axis=0).max() < 1e-6
        # what the search has not is a solution too, and rare
        assert (
            np.abs(
                offset_wrist_search.values(curves, zeros.pose, zeros.angle, zeros.side, zeros.elbow)
            ).max()
            < 1e-7
        )
        extra = away.min(axis=1)
        assert (extra > TWINS).sum() <= 8
        # where two meet they are known to the root of the last digit: a zero may be told as two, next to each other
        assert (extra > 1e-6).sum() <= (24 if off < TWINS else 0)
        if off:  # where they meet exactly the condition is flat: test_offset_wrist says how near to it is found
            assert np.nanmin(apart(arm[1].inverse(of.forward(q)), q), axis=0).max() < 1e-5


def test_the_polynomial_is_the_condition_on_axis_5_of_both_elbows(arm):
    """At angles of axis 6 within reach: the product of both elbows' conditions; in halves of degree 4 and 3, whose product
    for both sides is of degree 8."""
    rng = np.random.default_rng(13)
    curves = _curves(arm, rng.uniform(-np.pi, np.pi, (300, 6)))
    length = 1.0 / (curves.upper + curves.fore)
    of = offset_wrist_polynomial._Lengths(
        curves.upper * length,
        curves.fore * length,
        curves.ahead * length,
        *curves.lean,
        curves.square,
    )
    parts = np.stack([curves.point * length, curves.five])
    each, one = np.arange(300), np.ones(300)
    angles = 2.0 * np.pi / 64 * np.arange(64)
    terms = {
        side: [
            offset_wrist_polynomial._terms(of, parts, angle * one, side * one) for angle in angles
        ]
        for side in (1.0, -1.0)
    }
    front, back = (np.stack([at.value for at in terms[side]]) for side in (1.0, -1.0))
    radius = np.stack([at.radius for at in terms[1.0]])
    for value, degree in ((front + back, 4), ((front - back) / radius, 3), (front * back, 8)):
        assert np.abs(np.fft.rfft(value, axis=0)[degree + 1 :]).max() < 1e-11 * np.abs(front).max()
    even = offset_wrist_polynomial.is_even(curves)
    product = offset_wrist_polynomial._coefficients(of, parts, even)
    rows = trigonometric.harmonics(len(product) // 2, angles).T
    np.testing.assert_allclose(rows @ product, front if even else front * back, atol=1e-13)
    seen = 0
    for index, angle in enumerate(angles):
        for side in (1.0, -1.0):
            at = terms[side][index]
            inside = at.squared - at.common**2 > 1e-3
            both = np.prod(
                [
                    offset_wrist_search.values(curves, each, angle * one, side * one, elbow * one)
                    for elbow in (1.0, -1.0)
                ],
                axis=0,
            )
            np.testing.assert_allclose(
                (both * (at.radius**2 * at.squared))[inside], at.value[inside], atol=1e-12
            )
            assert (at.value[at.squared < at.common**2] > 0.0).all()
            step = 1e-5
            ahead, behind = (
                offset_wrist_polynomial._terms(of, parts, (angle + way) * one, side * one).value
                for way in (step, -step)
            )
            smooth = np.abs(at.radius) > 0.05
            np.testing.assert_allclose(
                ((ahead - behind) / (2.0 * step))[smooth], at.slope[smooth], atol=1e-7
            )
            seen += inside.sum()
    assert seen > 10000


def test_a_pair_that_the_search_passes_over_is_found():
    """HC10, its elbow nearly stretched: between both zeros, 0.01 rad apart, the condition stays below 1e-5."""
    of = chain(HC10)
    q = np.array([[2.04783863, 1.06449714, 0.01974395, -2.99700261, 0.04945112, 1.16245284]])
    found = recognition.arm_of(of).inverse(second_opinion(of).forward(q))[:, 0]
    assert np.isfinite(found).all(axis=1).sum() == 12
    assert np.nanmin(apart(found, q)) < 1e-9
