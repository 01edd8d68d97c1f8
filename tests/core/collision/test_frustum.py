# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle against segments and triangles agrees with a convex minimisation by refined dense
samples."""

import numpy as np
import pytest

from freecad_am.core.collision.frustum import Frustum
from freecad_am.core.collision.obstacles import Obstacles
from freecad_am.core.collision.scene import build_bodies
from freecad_am.core.geometry.obstacles import Body


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def depth(frustum, points, axis):
    """Signed distance of points (k, 3) from the solid, a convex function of the point and negative
    inside."""
    x = (points * axis).sum(axis=-1)
    side = np.linalg.norm(points - x[..., None] * axis, axis=-1)
    return np.maximum(
        side - frustum.radius - frustum.slope * x, np.maximum(frustum.low - x, x - frustum.high)
    )


def least(function, count):
    """Minimise convex functions on [0, 1] by trisection."""
    low, high = np.zeros(count), np.ones(count)
    for _ in range(70):
        lower_third, upper_third = (2 * low + high) / 3, (low + 2 * high) / 3
        is_lower = function(lower_third) <= function(upper_third)
        low, high = np.where(is_lower, low, lower_third), np.where(is_lower, upper_third, high)
    return function(0.5 * (low + high))


def least_depth(frustum, corners, axis):
    """Least depth (k,) over segments (k, 2, 3) or triangles (k, 3, 3); the minimum along a side is
    convex across it."""

    def least_along(start, end):
        return least(lambda s: depth(frustum, start + s[:, None] * (end - start), axis), len(axis))

    if corners.shape[1] == 2:
        return least_along(corners[:, 0], corners[:, 1])
    a, b, c = corners.transpose(1, 0, 2)
    return least(
        lambda s: least_along(a + s[:, None] * (b - a), a + s[:, None] * (c - a)), len(axis)
    )


@pytest.mark.parametrize("kind", [2, 3], ids=["segments", "triangles"])
@pytest.mark.parametrize("seed", range(3))
def test_as_by_convex_minimisation(kind, seed):
    """Intersection of the nozzle with segments and triangles agrees with the minimised depth."""
    rng = np.random.default_rng(seed)
    frustum = Frustum(rng.uniform(0, 2), rng.uniform(0, 1.5), rng.uniform(0, 3), rng.uniform(4, 20))
    axis = unit(rng.normal(size=(200, 3)))
    centres = axis * rng.uniform(0, frustum.high, (200, 1)) + 0.4 * frustum.reach * rng.normal(
        size=(200, 3)
    )
    corners = centres[:, None] + rng.normal(size=(200, kind, 3)) * frustum.reach * rng.choice(
        [0.1, 0.7, 4], (200, 1, 1)
    )
    meets = (
        frustum.meets_segments(corners[:, 0], corners[:, 1], axis)
        if kind == 2
        else frustum.meets_triangles(corners, axis)
    )
    truth = least_depth(frustum, corners, axis)
    clear_cut = np.abs(truth) > 1e-6
    assert (meets == (truth < 0))[clear_cut].all()
    assert clear_cut.sum() > 195 and 15 < meets.sum() < 185


@pytest.mark.parametrize("lean", [0.0, 1e-8, 1e-6, 1e-4, 1e-2, 0.3, 2.0])
def test_the_farthest_point_along_a_direction_that_leans_as_little_as_may_be(lean):
    """The support point of two discs follows from their heights along the axis and radii across it,
    even for the smallest lean."""
    rng = np.random.default_rng(7)
    frustum = Frustum(0.5, 0.36, 0.67, 60.0)
    axis = unit(rng.normal(size=(50, 3)))
    across = unit(np.cross(axis, rng.normal(size=(50, 3))))
    direction = np.cos(lean) * axis + np.sin(lean) * across
    support_point = frustum.farthest(direction, axis)
    radii = np.array([0.5 + 0.36 * height for height in (0.67, 60.0)])
    support = (np.cos(lean) * np.array([0.67, 60.0]) + abs(np.sin(lean)) * radii).max()
    assert (support_point * direction).sum(axis=1) == pytest.approx(np.full(50, support), abs=2e-6)
    assert frustum.gap(support_point, axis) == pytest.approx(np.zeros(50), abs=2e-6)


def test_a_large_face_through_the_nozzle_and_one_beside_it():
    frustum = Frustum(0.5, 0.36, 0.67, 60.0)
    big = 1e3 * np.array([[1, 0, 0], [-0.5, 0.9, 0], [-0.5, -0.9, 0]])
    axis = np.array([[0.0, 0.0, 1.0]])
    for height, meets in ((0.6, False), (0.7, True), (59.9, True), (60.1, False)):
        assert frustum.meets_triangles(big[None] + [0, 0, height], axis)[0] == meets
    upright = big[:, [2, 0, 1]]  # the plane x = 0
    for offset, meets in ((22.0, True), (22.2, False)):
        assert frustum.meets_triangles(upright[None] + [offset, 0, 0], axis)[0] == meets


@pytest.mark.parametrize("seed", range(3))
def test_the_tree_finds_what_a_look_at_every_one_finds(seed):
    """The tree finds the contacts that a test of every obstacle finds."""
    rng = np.random.default_rng(seed)
    frustum = Frustum(0.5, 0.36, 0.7, 15.0)
    tip, axis = rng.uniform(-30, 30, (300, 3)), unit(rng.normal(size=(300, 3)))
    centre = rng.uniform(-40, 40, (900, 1, 3))
    for kind in (1, 2, 3):
        corners = centre + rng.normal(size=(900, kind, 3)) * 1.5
        since, moment = rng.integers(0, 900, 900), rng.integers(0, 1000, 300)
        contacts = Obstacles(corners, since).find_touching(frustum, tip, axis, moment)
        expected = np.zeros(300, dtype=bool)
        for k in range(300):
            offset, axes = (
                corners[since < moment[k]] - tip[k],
                np.tile(axis[k], ((since < moment[k]).sum(), 1)),
            )
            if kind == 3:
                expected[k] = frustum.meets_triangles(offset, axes).any()
            else:
                meets = frustum.holds if kind == 1 else frustum.meets_segments
                expected[k] = meets(*offset.transpose(1, 0, 2), axes).any()
        assert (contacts == expected).all() and 0 < expected.sum() < 300


def test_cutting_up_large_faces_changes_nothing():
    """Subdividing large faces does not change the contacts."""
    rng = np.random.default_rng(7)
    frustum = Frustum(0.5, 0.36, 0.7, 40.0)
    tip, axis = rng.uniform(-30, 30, (2000, 3)), unit(rng.normal(size=(2000, 3)))
    vertices = rng.uniform(-200, 200, (30, 3))
    body = Body("slabs", vertices, np.arange(30).reshape(-1, 3))
    contacts = build_bodies([body], tip, frustum.reach).find_touching(frustum, tip, axis)
    expected = np.zeros(2000, dtype=bool)
    for corners in body.corners():
        expected |= frustum.meets_triangles(corners - tip[:, None], axis)
    assert (contacts == expected).all() and 0 < expected.sum() < 2000


def test_nothing_there_touches_nothing():
    tip, axis = np.zeros((3, 3)), np.tile([0.0, 0.0, 1.0], (3, 1))
    assert (
        not build_bodies([], tip, 10.0)
        .find_touching(Frustum(0.5, 0.36, 0.7, 60.0), tip, axis)
        .any()
    )
