# SPDX-License-Identifier: LGPL-2.1-or-later
"""Chaining the segments of a meridian in any order and direction; walls of closed contours."""

from itertools import pairwise

import numpy as np
import pytest

from freecad_am.core.geometry.curves import contour
from freecad_am.core.geometry.curves.contour import Piece
from freecad_am.core.geometry.curves.profile import Meridian, arc, line


def name_stretches(*stretches):
    return [Piece(f"Face{i}", *stretch) for i, stretch in enumerate(stretches, start=1)]


def corners(*points):
    return name_stretches(*(line(a, b) for a, b in pairwise(points)))


def names(chain):
    return [segment.name for segment in chain]


@pytest.mark.parametrize("seed", range(10))
def test_order_and_sense_of_the_pieces_do_not_matter(seed):
    """The order and direction of the segments do not change the meridian."""
    random = np.random.default_rng(seed)
    heights = np.cumsum(random.uniform(1.0, 5.0, 8))
    points = list(zip(random.uniform(5.0, 50.0, 8), heights, strict=True))
    segments = corners(*points)
    shuffled = [
        segments[i].reversed() if random.random() < 0.5 else segments[i]
        for i in random.permutation(len(segments))
    ]
    chains, gap = contour.chains(shuffled)
    assert len(chains) == 1
    assert gap == 0.0
    meridian = contour.meridian_of(contour.upright(chains[0]))
    truth = contour.meridian_of(segments)
    s = np.linspace(0.0, truth.length, 501)
    assert meridian.length == pytest.approx(truth.length)
    for have, want in zip(meridian.at(s), truth.at(s), strict=True):
        assert have == pytest.approx(want, abs=1e-9)


def test_gaps_are_told_and_wide_ones_left():
    """Gaps are reported, and wide ones stay open."""
    chains, gap = contour.chains(
        corners((5, 0), (5, 4)) + corners((5.05, 4), (6, 9)) + corners((8, 9), (8, 12))
    )
    assert sorted(len(chain) for chain in chains) == [1, 2]
    assert gap == pytest.approx(0.05)


def test_a_tube_has_two_walls_and_no_end_faces():
    ring = corners((8, 0), (10, 0), (10, 30), (8, 30), (8, 0))
    outer, inner = contour.walls(contour.chains(ring)[0][0])
    assert (names(outer), names(inner)) == (["Face2"], ["Face4"])
    assert outer[0].points[0] == pytest.approx([10, 0])
    assert inner[0].points[0] == pytest.approx([8, 0])


def test_flat_steps_stay_and_flat_bottoms_go():
    cup = corners((0, 0), (50, 0), (50, 20), (30, 20), (30, 40), (28, 40), (28, 2), (0, 2))
    outer, inner = contour.walls(contour.chains(cup)[0][0])
    assert names(outer) == ["Face2", "Face3", "Face4"]
    assert names(inner) == ["Face6"]


def test_a_full_part_has_one_wall():
    assert [names(wall) for wall in contour.walls(corners((0, 0), (10, 0), (10, 30), (0, 30)))] == [
        ["Face2"]
    ]


def test_round_contours_are_cut_at_their_lowest_and_highest_points():
    # samples that miss both points
    ring = name_stretches(
        arc((50, 0), 10, 0.4, 0.4 + np.pi), arc((50, 0), 10, 0.4 + np.pi, 0.4 + 2 * np.pi)
    )
    outer, inner = (contour.meridian_of(wall) for wall in contour.walls(contour.chains(ring)[0][0]))
    for wall, side in ((outer, 1.0), (inner, -1.0)):
        assert wall.length == pytest.approx(10.0 * np.pi, abs=1e-6)
        assert wall.points[0] == pytest.approx([50.0, -10.0], abs=1e-6)
        assert wall.points[-1] == pytest.approx([50.0, 10.0], abs=1e-6)
        assert wall.at([5.0 * np.pi])[0] == pytest.approx(50.0 + side * 10.0, abs=1e-6)


def test_a_dome_with_a_rounded_rim_is_cut_in_its_rim():
    rim = name_stretches(
        arc((0, 0), 45, np.pi / 2, 0.0),
        arc((44, 0), 1, 0.0, -np.pi),
        arc((0, 0), 43, 0.0, np.pi / 2),
    )
    walls = [contour.meridian_of(wall) for wall in contour.walls(rim)]
    assert [wall.length for wall in walls] == pytest.approx(
        [22.5 * np.pi + np.pi / 2, 21.5 * np.pi + np.pi / 2]
    )
    assert all(wall.points[0] == pytest.approx([44.0, -1.0], abs=1e-6) for wall in walls)


@pytest.mark.parametrize("start", range(4))
@pytest.mark.parametrize("slope", [0.3, 1.0, 3.0])
def test_rims_square_to_slanted_walls_are_no_wall(start, slope):
    along = np.array([-1.0, slope]) / np.hypot(1.0, slope)
    across = 2.0 * np.array([along[1], -along[0]])
    foot = np.array([40.0, 0.0])
    ring = [foot, foot + 25.0 * along, foot + 25.0 * along + across, foot + across]
    ring = corners(*np.roll(ring, start, axis=0), np.roll(ring, start, axis=0)[0])
    outer, inner = (contour.meridian_of(wall) for wall in contour.walls(contour.chains(ring)[0][0]))
    assert (outer.length, inner.length) == pytest.approx((25.0, 25.0))
    assert outer.points[0] == pytest.approx(foot + across)
    assert inner.points[0] == pytest.approx(foot)


def test_sides_of_a_square_on_its_corner_are_walls():
    ring = corners((30, 0), (40, 10), (30, 20), (20, 10), (30, 0))
    assert [names(wall) for wall in contour.walls(ring)] == [["Face1", "Face2"], ["Face4", "Face3"]]


def test_halfway_between_parallel_walls_is_the_parallel_in_the_middle():
    def wall(off):
        return name_stretches(
            line((45 + off, -20), (45 + off, 0)), arc((0, 0), 45 + off, 0.0, np.pi / 2)
        )

    middle = Meridian.chained(contour.halfway(wall(1.0), wall(-1.0)))
    truth = contour.meridian_of(wall(0.0))
    s = np.linspace(0.0, truth.length, 2001)
    for have, want in zip(middle.at(s), truth.at(s), strict=True):
        assert have == pytest.approx(want, abs=1e-7)


@pytest.mark.parametrize("more", [[], [(9, 3)]])
def test_halfway_keeps_kinks_where_they_are(more):
    def wall(off, *more):
        return corners((10 + off, 0), *more, (10 + off, 5), (4 + off, 13))

    middle = Meridian.chained(contour.halfway(wall(1.0), wall(-1.0, *more)))
    assert middle.kinks == pytest.approx([5.0])
    assert middle.at([5.0, 5.1])[2] == pytest.approx(np.array([[0.0, 1.0], [-0.6, 0.8]]), abs=1e-9)


def test_halfway_inside_a_torus_is_a_cylinder():
    outer = name_stretches(arc((50, 0), 10, -np.pi / 2, np.pi / 2))
    inner = name_stretches(arc((50, 0), 10, 1.5 * np.pi, np.pi / 2))
    middle = Meridian.chained(contour.halfway(outer, inner))
    assert middle.length == pytest.approx(20.0, abs=1e-9)
    r, _, t = middle.at(np.linspace(0.0, 20.0, 101))
    assert r == pytest.approx(np.full(101, 50.0), abs=1e-9)
    assert t == pytest.approx(np.tile([0.0, 1.0], (101, 1)), abs=1e-9)
