# SPDX-License-Identifier: LGPL-2.1-or-later
"""Cylinders that are nearer than they may be: against projections onto one and the other in turns, which share nothing."""

import numpy as np

from freecad_am.core.collision.separation import PlacedCylinders, nearer

FIRST, SECOND = (220.0, 35.0), (60.0, 90.0)  # length and radius, mm


def unit(rows):
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


def projected(rods, points):
    """The points of cylinders nearest to points."""
    along = np.einsum("ij,ij->i", points - rods.start, rods.axis)
    across = points - rods.start - along[:, None] * rods.axis
    size = np.linalg.norm(across, axis=1)
    across *= np.minimum(1.0, rods.radius / np.maximum(size, 1e-12))[:, None]
    return rods.start + np.clip(along, 0.0, rods.length)[:, None] * rods.axis + across


def distance(one, other):
    """(k,) mm: projections onto two convex bodies in turns come to their distance, from above."""
    there = other.start.copy()
    for _ in range(4000):
        here = projected(one, there)
        there = projected(other, here)
    return np.linalg.norm(here - there, axis=1)


def test_rods_are_nearer_than_a_gap_where_projections_say_so():
    chance = np.random.default_rng(15)
    count = 1200
    one = PlacedCylinders(
        chance.uniform(-150, 150, (count, 3)), unit(chance.normal(size=(count, 3))), *FIRST
    )
    axis = unit(chance.normal(size=(count, 3)))
    axis[:200] = one.axis[:200]  # side by side
    axis[200:300] = -one.axis[200:300]
    axis[300:400] = unit(np.cross(one.axis[300:400], axis[300:400]))  # upright on each other
    other = PlacedCylinders(chance.uniform(-250, 250, (count, 3)), axis, *SECOND)
    apart = distance(one, other)
    assert (apart < 0.4).sum() > 100 and (apart > 10.0).sum() > 400
    for gap in (0.4, 10.0, 60.0):
        clear = np.abs(apart - gap) > 0.05  # projections in turns end slowly
        assert clear.sum() > 1150
        assert (nearer(one, other, gap) == (apart < gap))[clear].all()
        assert (nearer(other, one, gap) == nearer(one, other, gap))[clear].all()


def test_faces_and_sides_are_where_analysis_says():
    """Side by side, end to end, and one's end above the other's side."""
    up, ahead = np.array([[0.0, 0.0, 1.0]]), np.array([[1.0, 0.0, 0.0]])
    post = PlacedCylinders(np.zeros((1, 3)), up, 100.0, 20.0)
    beside, above, across = (
        ([50.0, 0.0, 30.0], up, 20.0),
        ([5.0, 5.0, 112.0], up, 12.0),
        ([-10.0, 3.0, 128.0], ahead, 18.0),
    )
    for start, axis, gap in (beside, above, across):
        other = PlacedCylinders(np.array([start]), axis, 40.0, 10.0)
        assert nearer(post, other, gap + 1e-3)[0] and not nearer(post, other, gap - 1e-3)[0], start
