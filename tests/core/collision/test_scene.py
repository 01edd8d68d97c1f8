# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contacts and distances against points sampled in both solids and against a minimisation by
scipy."""

import tracemalloc

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial import cKDTree

from freecad_am.core.collision import deposit, frustum, obstacles, separation
from freecad_am.core.collision.frustum import Frustum
from freecad_am.core.collision.scene import depositing, exempt_height, scene, travelling
from freecad_am.core.geometry.obstacles import Body

SLOPE = np.tan(np.radians(20.0))
NOZZLE = Frustum(0.5, SLOPE, 1.0, 60.0)


def units(rng, count):
    vectors = rng.normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def skin(solid, tip, axis, count=45):
    """Points (n, 3) of the surface of a frustum."""
    first_axis = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    first_axis /= np.linalg.norm(first_axis)
    second_axis = np.cross(axis, first_axis)
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    around = np.cos(turn)[:, None] * first_axis + np.sin(turn)[:, None] * second_axis
    height = np.linspace(solid.low, solid.high, count)
    side = (
        height[:, None, None] * axis + (solid.radius + solid.slope * height)[:, None, None] * around
    )
    discs = [
        end * axis + share * (solid.radius + solid.slope * end) * around
        for end in (solid.low, solid.high)
        for share in np.linspace(0.0, 1.0, 16)
    ]
    return tip + np.concatenate([side.reshape(-1, 3), *discs])


def in_frustum(solid, tip, axis, points, deep):
    """Return whether points (n, 3) are inside, `deep` mm below the surface."""
    offset = points - tip
    up = offset @ axis
    side = np.linalg.norm(offset - up[:, None] * axis, axis=1)
    lean = np.hypot(1.0, solid.slope)
    return (
        (up > solid.low + deep)
        & (up < solid.high - deep)
        & ((solid.radius + solid.slope * up - side) / lean > deep)
    )


def stadium(points, build, width, height, count=7):
    """Points (n, 3) throughout beads with a stadium section and balls at their ends, by sweeping
    the section."""
    swept = []
    for a, b in zip(points[:-1], points[1:]):
        along = (b - a) / np.linalg.norm(b - a)
        side = np.cross(build, along)
        side /= np.linalg.norm(side)
        shares = np.linspace(0.0, 1.0, 2 + int(np.linalg.norm(b - a) / 0.6))
        u, v = np.meshgrid(
            np.linspace(-0.5, 0.5, 2 * count) * width, np.linspace(0.0, 1.0, count) * height
        )
        u, v = u.ravel(), v.ravel()
        round_ = 0.5 * height
        is_inside = (
            np.hypot(np.maximum(np.abs(u) - (0.5 * width - round_), 0.0), v - round_) <= round_
        )
        section = u[is_inside, None] * side + v[is_inside, None] * build
        swept.append((a + shares[:, None, None] * (b - a) + section).reshape(-1, 3))
    return np.concatenate(swept)


@pytest.mark.parametrize("corners", [1, 2, 3, 4])
def test_distances_are_those_that_a_minimisation_finds(corners):
    """Distances agree with a constrained minimisation over nozzle point and corner weights."""
    rng = np.random.default_rng(corners)
    axis, points = (
        units(rng, 40),
        rng.uniform(-50, 50, (40, 1, 3)) + rng.uniform(-6, 6, (40, corners, 3)),
    )
    low, high = separation.bounds(NOZZLE, axis, points)
    assert (high - low).max() < 1e-4

    def up(values, k):
        return values[:3] @ axis[k]

    def across(values, k):
        return np.sqrt(np.sum((values[:3] - up(values, k) * axis[k]) ** 2) + 1e-12)

    for k in range(40):  # a point of the nozzle, and the weights of the corners in the hull
        limits = [
            {
                "type": "ineq",
                "fun": lambda v, k=k: NOZZLE.radius + NOZZLE.slope * up(v, k) - across(v, k),
            },
            {"type": "ineq", "fun": lambda v, k=k: up(v, k) - NOZZLE.low},
            {"type": "ineq", "fun": lambda v, k=k: NOZZLE.high - up(v, k)},
            {"type": "eq", "fun": lambda v: v[3:].sum() - 1.0},
        ]
        start = np.r_[20.0 * axis[k], np.full(corners, 1.0 / corners)]
        minimum = minimize(
            lambda v, k=k: np.sum((v[:3] - v[3:] @ points[k]) ** 2),
            start,
            method="SLSQP",
            constraints=limits,
            bounds=[(None, None)] * 3 + [(0.0, 1.0)] * corners,
            options={"maxiter": 300, "ftol": 1e-12},
        )
        assert abs(np.sqrt(max(minimum.fun, 0.0)) - high[k]) < 2e-3 + 1e-3 * (high[k] == 0.0), k


def test_what_touches_is_what_points_of_beads_inside_of_the_nozzle_say():
    """A nozzle touches a bead exactly where sampled points of the bead are inside the nozzle."""
    rng = np.random.default_rng(7)
    points = np.stack(
        [np.linspace(-30, 30, 13), 6 * np.sin(np.linspace(0, 5, 13)), np.linspace(0, 4, 13)], axis=1
    )
    up, width, height = np.array([0.0, 0.0, 1.0]), 8.0, 2.0
    deposited = deposit.build_deposit(points, np.tile(up, (13, 1)), width, height, [0])
    obstacles = scene([], points, 100.0, deposited)
    axis, tip = units(rng, 400), rng.uniform(-45, 45, (400, 3))
    contacts, distances = (
        obstacles.find_touching(NOZZLE, tip, axis),
        obstacles.distance(NOZZLE, tip, axis),
    )
    solid = stadium(points, up, width, height)
    tree = cKDTree(solid)
    assert 60 < contacts.sum() < 340 and ((distances == 0.0) == contacts).all()
    for k in range(70):
        if in_frustum(NOZZLE, tip[k], axis[k], solid, 1e-3).any():
            assert contacts[k], k
        elif contacts[k]:  # within the spacing of the sample
            assert in_frustum(NOZZLE, tip[k], axis[k], solid, -0.5).any(), k
        else:
            sampled = tree.query(skin(NOZZLE, tip[k], axis[k]))[0].min()
            assert distances[k] - 1e-6 <= sampled <= distances[k] + 1.0, k
    limited = obstacles.distance(NOZZLE, tip, axis, reach=5.0)
    assert np.abs(limited - np.minimum(distances, 5.0)).max() < 1e-4


def test_distances_from_bodies_are_those_of_their_sampled_faces_and_none_inside():
    """Distances from a body agree with its sampled faces, and are zero inside."""
    rng = np.random.default_rng(3)
    size = 30.0
    x = np.array([[a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)]) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    box = Body("box", x, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))
    short = Frustum(0.5, SLOPE, 0.2, 12.0)
    tip, axis = rng.uniform(-70, 70, (500, 3)), units(rng, 500)
    tip[0], axis[0] = 0.0, [0.0, 0.0, 1.0]
    obstacles = scene([box], tip, short.reach)
    distances, contacts = (
        obstacles.distance(short, tip, axis),
        obstacles.find_touching(short, tip, axis),
    )
    assert (
        contacts[0]
        and distances[0] == 0.0
        and contacts.sum() > 30
        and ((distances == 0.0) == contacts).all()
    )
    for k in np.flatnonzero(~contacts):
        surface = skin(short, tip[k], axis[k])
        sampled = np.linalg.norm(np.maximum(np.abs(surface) - size, 0.0), axis=1).min()
        assert distances[k] - 1e-6 <= sampled <= distances[k] + 0.15, k


def test_a_piece_is_there_from_its_moment_on_and_a_corner_has_its_outer_side():
    """A solid exists from its moment on, and a corner of a bead is filled on its outer side."""
    points = np.array([[0.0, 0, 0], [20, 0, 0], [20, 20, 0], [20, 40, 0]])
    deposited = deposit.build_deposit(
        points, np.tile([0.0, 0.0, 1.0], (4, 1)), 8.0, 2.0, [0], np.array([10, 11, 12, 13])
    )
    obstacles = scene([], points, 100.0, deposited)
    probe = Frustum(0.05, 0.0, 0.0, 0.5)
    tip = np.array([[10.0, 3, 0.5], [20, 30, 0.5], [22.2, -2.2, 0.8]])
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    for moment, expected in ((11, [0, 0, 0]), (12, [1, 0, 0]), (13, [1, 0, 1]), (14, [1, 1, 1])):
        assert obstacles.find_touching(probe, tip, up, np.full(3, moment)).tolist() == [
            bool(flag) for flag in expected
        ], moment


def test_the_bead_being_laid_and_its_neighbours_are_not_touched_but_a_finished_one_is():
    """Neighbours in the current layer overlap by a quarter and do not count; a bead of an earlier
    layer does."""
    line = np.stack([np.linspace(0, 40, 41), np.zeros(41), np.zeros(41)], axis=1)
    points = np.concatenate([line, line + [0, 6.0, 0]])
    deposited = deposit.build_deposit(points, np.tile([0.0, 0.0, 1.0], (82, 1)), 8.0, 2.0, [0, 41])
    obstacles = scene([], points, 100.0, deposited)
    nozzle = depositing(0.5, SLOPE, 60.0, 2.0)
    lean = np.array([[np.sin(0.6), 0.0, np.cos(0.6)], [0.0, -np.sin(0.6), np.cos(0.6)]])
    tip, moment = points[[60, 60]], np.array([61, 61])
    assert obstacles.find_touching(nozzle, tip, lean, moment).tolist() == [False, True]
    assert not obstacles.find_touching(
        nozzle, tip, lean, moment, layer_start=np.array([0, 0])
    ).any()
    assert exempt_height(0.5, SLOPE, 2.0) == 2.0 and exempt_height(2.0, SLOPE, 0.5) > 0.5


def test_what_is_exempt_may_differ_from_look_to_look():
    """The exempt height may differ between queries of one call."""
    points = np.array([[-20.0, 0, 0], [20, 0, 0]])
    obstacles = scene(
        [],
        points,
        100.0,
        deposit.build_deposit(points, np.tile([0.0, 0.0, 1.0], (2, 1)), 8.0, 2.0, [0]),
    )
    tip, up = np.zeros((3, 3)), np.tile([0.0, 0.0, 1.0], (3, 1))
    tip[:, 2] = [0.0, 1.0, 1.0]
    solid = travelling(0.5, SLOPE, 60.0, np.array([2.0, 1.0, 0.0]))
    assert obstacles.find_touching(solid, tip, up).tolist() == [False, False, True]
    assert obstacles.distance(solid, tip, up)[2] == 0.0


def test_memory_is_linear():
    def peak(count):
        s = np.linspace(0, 400, count)
        points = np.stack([s, np.zeros(count), np.zeros(count)], axis=1)
        obstacles = scene(
            [],
            points,
            0.0,
            deposit.build_deposit(points, np.tile([0.0, 0, 1.0], (count, 1)), 8.0, 1.0, [0]),
        )
        tip = points + [0.0, 9.0, 0.0]
        tracemalloc.start()
        obstacles.find_touching(NOZZLE, tip, np.tile([0.0, 0, 1.0], (count, 1)))
        peak_memory = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak_memory

    assert peak(12_000) < 200e6


def test_deposit_made_part_by_part_is_touched_as_all_of_it(monkeypatch):
    """A deposit built in batches gives the same contacts as one built at once."""
    rng = np.random.default_rng(23)
    turn = np.linspace(0.0, 40.0, 700)
    points = np.stack([20.0 * np.cos(turn), 20.0 * np.sin(turn), 0.15 * turn], axis=1)
    points[:, :2] += 4.0 * np.sign(np.sin(5.0 * turn))[:, None]  # corners
    build, width, height = (
        units(rng, 700) * 0.1 + [0.0, 0.0, 1.0],
        rng.uniform(2.0, 5.0, 700),
        rng.uniform(0.5, 1.5, 700),
    )
    build /= np.linalg.norm(build, axis=1, keepdims=True)
    starts = np.array([0, 90, 91, 400])
    deposited = deposit.build_deposit(points, build, width, height, starts, foot=3.0)
    tip, axis = rng.uniform(-26.0, 26.0, (4000, 3)) + [0.0, 0.0, 2.0], units(rng, 4000)
    moment, layer_start = rng.integers(0, 720, 4000), rng.integers(0, 700, 4000)
    late = np.full(4000, 700)
    expected = [
        deposited.find_touching(NOZZLE, tip, axis, late),
        deposited.find_touching(NOZZLE, tip, axis, moment, layer_start),
    ]
    assert 0.2 < expected[1].mean() < expected[0].mean() < 0.95
    for batch in (7, 64, 1000):
        monkeypatch.setattr(deposit, "PART", batch)
        batched = deposit.in_parts(points, build, width, height, starts, foot=3.0)
        np.testing.assert_array_equal(batched.find_touching(NOZZLE, tip, axis, late), expected[0])
        np.testing.assert_array_equal(
            batched.find_touching(NOZZLE, tip, axis, moment, layer_start), expected[1]
        )


def meander(count, turns=6.0):
    """A bead (n, 3) that runs to and fro next to itself."""
    s = np.linspace(0.0, 1.0, count)
    return np.stack([40.0 * np.sin(turns * np.pi * s), 40.0 * s, 0.3 * np.sin(9.0 * s)], axis=1)


def test_the_layer_being_laid_is_told_the_same_with_and_without_looking_at_each_of_its_pieces(
    monkeypatch,
):
    """Contacts with the current layer are the same whether or not candidate pairs are selected
    first."""
    rng = np.random.default_rng(20)
    below, current_layer = meander(600), meander(1500) + [0.0, 2.0, 1.5]
    points = np.concatenate([below, current_layer])
    deposited = deposit.build_deposit(
        points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), 4.0, 1.5, [0, len(below)], foot=3.0
    )
    indices = rng.integers(len(below) + 50, len(points), 6000)
    tip = points[indices] + rng.normal(size=(6000, 3)) * [0.5, 0.5, 0.1]
    axis = units(rng, 6000)
    axis[:, 2] = np.abs(axis[:, 2]) + 0.4
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    query_args = NOZZLE, tip, axis, indices + 1, np.full(6000, len(below))
    contacts = deposited.find_touching(*query_args)
    assert 0.2 < contacts.mean() < 0.8
    monkeypatch.setattr(
        frustum,
        "select_pairs",
        lambda lines, since, solid, query, *arguments: np.arange(len(query)),
    )
    assert (deposited.find_touching(*query_args) == contacts).all()


def test_pieces_next_to_the_tip_are_not_looked_at_one_by_one(monkeypatch):
    """Solids next to the tip are rejected in groups, so that the work does not grow with their
    number."""
    pair_count = [0]
    meets = obstacles.Obstacles._meets

    def count_pairs(self, query, *arguments):
        pair_count[0] += len(query)
        return meets(self, query, *arguments)

    monkeypatch.setattr(obstacles.Obstacles, "_meets", count_pairs)
    work = []
    for count in (2000, 8000, 32000):
        points = meander(count)
        deposited = deposit.build_deposit(
            points, np.tile([0.0, 0.0, 1.0], (count, 1)), 4.0, 1.5, [0], foot=3.0
        )
        indices = np.linspace(count // 2, count - 1, 200).astype(int)
        pair_count[0] = 0
        axis = np.tile([np.sin(0.3), 0.0, np.cos(0.3)], (200, 1))
        deposited.find_touching(
            NOZZLE, points[indices], axis, indices + 1, np.zeros(200, dtype=int)
        )
        work.append(pair_count[0])
    # sixteen times the solids within reach of the nozzle; single tests took 400 per query
    assert work[2] < 200 * 20, work
