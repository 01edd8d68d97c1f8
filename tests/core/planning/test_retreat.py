# SPDX-License-Identifier: LGPL-2.1-or-later
"""`process.retreat`: open beads return over their end, by lengths measured on the path."""

import math

import numpy as np
import pytest

from freecad_am.core.planning.beads.retreat import gone_back
from freecad_am.core.toolpath import Bead

RADIUS = 30.0


def arc(turn, n=61, closed=False, z=10.0, with_tangents=False):
    """A bead on a circle with increasing outward lean."""
    angle = np.linspace(0.0, turn, n)
    points = np.stack([RADIUS * np.cos(angle), RADIUS * np.sin(angle), np.full(n, z)], axis=1)
    if closed:
        points[-1] = points[0]
    lean = np.zeros(n) if closed else np.radians(20.0) * np.linspace(0.0, 1.0, n)
    tool = np.stack(
        [np.sin(lean) * np.cos(angle), np.sin(lean) * np.sin(angle), np.cos(lean)], axis=1
    )
    along = np.stack([-np.sin(angle), np.cos(angle), np.zeros(n)], axis=1)
    tangents = np.stack([along, along], axis=1) if with_tangents else None
    speed = 6.0 + 2.0 * np.sin(angle)
    return Bead(
        points,
        tool,
        tool,
        angle,
        speed,
        closed,
        width=5.0 + angle,
        height=2.0 + 0.1 * angle,
        tangents=tangents,
    )


def steps(points):
    return np.linalg.norm(np.diff(points, axis=0), axis=1)


@pytest.mark.parametrize("told", [False, True])
@pytest.mark.parametrize("turn", [2.0, 5.0])
@pytest.mark.parametrize("length", [0.01, 1.0, 7.3, 41.0, 1000.0])
def test_the_end_is_laid_once_more_backwards(length, turn, told):
    """The end of an open bead is traversed once more backwards."""
    bead = arc(turn, with_tangents=told)
    longer, n = gone_back(bead, length), len(bead)
    back = min(length, bead.length)
    assert longer.length - bead.length == pytest.approx(back, abs=1e-3)
    for name in ("points", "build", "tool", "speed", "width", "height"):
        np.testing.assert_array_equal(getattr(longer, name)[:n], getattr(bead, name))
    # the values of each point depend on its position on the circle only, forwards and backwards
    angle = np.arctan2(longer.points[:, 1], longer.points[:, 0]) % math.tau
    np.testing.assert_allclose(np.hypot(*longer.points[:, :2].T), RADIUS, atol=2e-6)
    np.testing.assert_allclose(longer.width, 5.0 + angle, atol=1e-3)
    np.testing.assert_allclose(
        longer.tool[:, 2], np.cos(np.radians(20.0) * angle / turn), atol=1e-4
    )
    assert (np.diff(angle[n - 1 :]) < 0.0).all() and angle[-1] == pytest.approx(
        turn - back / RADIUS, abs=2e-3
    )
    # the curve between its points is the same circle, except at its corner
    between, tangent = longer.outline.at(np.arange(len(longer) - 1), 0.3)
    np.testing.assert_allclose(np.hypot(*between[:, :2].T), RADIUS, atol=1e-5)
    sense = np.cross(between, tangent)[:, 2]
    assert (sense[: n - 1] > 0.0).all() and (sense[n - 1 :] < 0.0).all()
    # the segments back have the speeds of the way there
    lengths_back = steps(longer.points)[n - 1 : -1]
    np.testing.assert_allclose(longer.speed[n:-1], bead.speed[::-1][: len(lengths_back)])


def test_closed_beads_and_no_length_change_nothing():
    ring, open_ = arc(math.tau, closed=True), arc(3.0)
    assert gone_back(ring, 5.0) is ring and gone_back(open_, 0.0) is open_
