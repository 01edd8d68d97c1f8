# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle on walls: clear by brute force (a sampled nozzle, true solids), tilted by the least angle, smoothly."""

import dataclasses
import re
import tracemalloc

import numpy as np
import pytest
from scipy.optimize import brentq

from freecad_am.core.collision.frustum import side_height
from freecad_am.core.collision.tolerances import ABOVE_FACES
from freecad_am.core.geometry.obstacles import Body, disc
from freecad_am.core.geometry.walls.surface_wall import TORUS, SurfaceWall
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.strategies.clearance import clear_by_tilt as clearance_knots
from freecad_am.core.strategies.clearance import (
    clear_by_tilt as wall_clearance,
)
from freecad_am.core.strategies.clearance import (
    nozzle_check,
    tilt_search,
)
from freecad_am.core.strategies.clearance.clear_by_tilt import keep_clear
from freecad_am.core.strategies.clearance.nozzle_check import nozzle_issues
from freecad_am.core.strategies.progress import Watch
from freecad_am.core.strategies.walls import plan as surface
from freecad_am.core.toolpath import Bead, Layer, Toolpath

BEND, TUBE, PIPE = 60.0, 15.0, 32.0
NOZZLE = NozzleParameters()
FAT = NozzleParameters(half_angle=np.radians(38.0), diameter=3.0, length=40.0)
LOCAL = BuildDirectionParameters()
SAMPLES = 8
FINEST = 0.4  # deg, what the finest candidates leave open


def left_out(nozzle):
    return side_height(0.5 * nozzle.diameter, np.tan(nozzle.half_angle))


def bead(points, tool=(0.0, 0.0, 1.0), closed=False):
    points = np.asarray(points, dtype=float)
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    tool = np.tile(tool, (len(points), 1)) if np.ndim(tool) == 1 else tool
    return Bead(
        points, tool, tool, 2 * np.pi * length / length[-1], np.full(len(points), 6.0), closed
    )


def toolpath(*beads):
    return Toolpath(tuple(Layer((one,)) for one in beads), np.eye(4), 1.0, 0.01, family="surface")


def box(low, high, name="box"):
    x, y, z = np.transpose([low, high])
    vertices = np.array([[a, b, c] for a in x for b in y for c in z], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Body(
        name, vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    )


def pipe(sides=200):
    angle = 2 * np.pi * np.arange(sides) / sides
    rings = [
        np.stack([PIPE * np.cos(angle), np.full(sides, y), PIPE * np.sin(angle)], 1)
        for y in (-100.0, 100.0)
    ]
    one, two = np.arange(sides), np.roll(np.arange(sides), -1)
    side = np.concatenate(
        [np.stack([one, two, one + sides], 1), np.stack([two, two + sides, one + sides], 1)]
    )
    return Body("pipe", np.vstack(rings), side)


def sampled(nozzle, low, tip, tool):
    """Points of the nozzle's surface and inside, (k, n, 3)."""
    height = np.linspace(low, nozzle.length, 50)
    angle, share = np.meshgrid(
        np.linspace(0, 2 * np.pi, 24, endpoint=False), [0.0, 0.4, 0.8, 1.0], indexing="ij"
    )
    radius = (0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * height)[:, None] * share.ravel()
    one = np.cross(tool, np.eye(3)[np.argmin(np.abs(tool), axis=1)])
    one /= np.linalg.norm(one, axis=1)[:, None]
    two = np.cross(tool, one)
    heights = np.repeat(height[:, None], angle.size, axis=1)
    flat = np.stack(
        [radius * np.cos(angle.ravel()), radius * np.sin(angle.ravel()), heights]
    ).reshape(3, -1)
    return tip[:, None] + np.einsum("ckj,cn->knj", np.stack([one, two, tool]), flat)


def touches_deposit(path, nozzle):
    """(layer, bead, point) at which a point of an earlier bead, or of this one behind, is well inside the nozzle."""
    found, count = [], 0
    low, a, k = left_out(nozzle), 0.5 * nozzle.diameter, np.tan(nozzle.half_angle)
    laid = np.concatenate(
        [
            np.linspace(one.points[:-1], one.points[1:], SAMPLES, axis=1).reshape(-1, 3)
            for _, _, one in path
        ]
    )
    for i, j, one in path:
        for point in range(len(one)):
            count += SAMPLES * (point > 0)
            offset = laid[:count] - one.points[point]
            x = offset @ one.tool[point]
            side = np.linalg.norm(offset - x[:, None] * one.tool[point], axis=1)
            if ((x > low + 1e-6) & (x < nozzle.length - 1e-6) & (side < a + k * x - 1e-6)).any():
                found.append((i, j, point))
    return found


def turned(path, other):
    return np.concatenate(
        [
            np.degrees(np.arccos(np.clip((one.tool * two.tool).sum(axis=1), -1, 1)))
            for (_, _, one), (_, _, two) in zip(path, other)
        ]
    )


def codes(path):
    return [issue.code for issue in path.issues]


def bend_on_pipe(mode, **values):
    theta = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    # on the tube about the circle of the bend and on the pipe: by Newton in the height along the tube
    u = np.full(400, 0.5)
    wall = SurfaceWall(TORUS, (BEND, TUBE), np.eye(4), np.pi / 2, np.zeros((400, 3)))
    tube = wall.surface()
    for _ in range(50):
        point, along, _ = tube.derivatives(u, theta)
        gap = point[:, 0] ** 2 + point[:, 2] ** 2 - PIPE**2
        u = u - gap / (2 * (point[:, 0] * along[:, 0] + point[:, 2] * along[:, 2]))
    first = tube.point(u, theta)
    assert np.abs(np.hypot(first[:, 0], first[:, 2]) - PIPE).max() < 1e-9
    wall = dataclasses.replace(wall, first=first)
    build = BuildDirectionParameters(mode=mode, clearance="none")
    made = surface.plan(
        wall, SurfaceParameters(layer_height=8.0, end="whole", **values), build, ProcessParameters()
    )
    return wall, dataclasses.replace(
        made, bead_width=0.0
    )  # lines: what is measured here is the pipe


@pytest.mark.parametrize("mode", ["local", "symmetry-plane"])
def test_a_fat_nozzle_on_the_pipe(mode):
    wall, asked = bend_on_pipe(mode)
    build = BuildDirectionParameters(mode=mode, max_tilt=np.pi)
    plane = wall.symmetry_normal if mode == "symmetry-plane" else None
    found = keep_clear(asked, [pipe()], FAT, build, plane)

    def deepest(path):
        low = left_out(FAT) + ABOVE_FACES
        points = [sampled(FAT, low, one.points, one.tool).reshape(-1, 3) for _, _, one in path]
        return PIPE - min(
            np.hypot(some[:, 0], some[:, 2])[np.abs(some[:, 1]) < 99].min() for some in points
        )

    assert deepest(asked) > 0.3
    assert deepest(found) < PIPE * (1 - np.cos(np.pi / 200)) + 1e-6
    assert touches_deposit(found, FAT) == []
    assert "CLEARANCE" not in codes(found) and "TILT_BACK" in codes(found)
    for (_, _, one), (_, _, two) in zip(asked, found):
        assert (one.points == two.points).all() and (one.build == two.build).all()
        if two.closed:
            assert np.abs(two.tool[0] - two.tool[-1]).max() < 1e-12
        if plane is not None:
            assert np.abs(two.tool @ plane).max() < 1e-9
        step = np.linalg.norm(np.diff(two.points, axis=0), axis=1)
        tilt = np.degrees(np.linalg.norm(np.diff(two.tool - one.tool, axis=0), axis=1))
        assert (tilt[step > 0.2] / step[step > 0.2]).max() < 15.0
    note = next(issue for issue in found.issues if issue.code == "TILT_BACK")
    angle = float(re.search(r"by up to ([\d.]+) deg", note.message)[1])
    assert angle == pytest.approx(turned(asked, found).max(), abs=0.006)
    place = found.layers[note.layer].beads[note.bead].tool[note.point]
    was = asked.layers[note.layer].beads[note.bead].tool[note.point]
    assert np.degrees(np.arccos(place @ was)) == pytest.approx(turned(asked, found).max(), abs=1e-6)


def test_beside_a_tall_face_the_tilt_is_the_least_that_clears_it():
    path = toolpath(bead(np.stack([np.zeros(41), np.linspace(0, 80, 41), np.zeros(41)], axis=1)))
    face = box([10, -200, -50], [30, 300, 150])
    told = []
    found = keep_clear(path, [face], NOZZLE, LOCAL, watch=Watch(lambda *work: told.append(work)))
    assert told == [(41, 1)]  # before the work, which may be long
    slope = np.tan(NOZZLE.half_angle)
    needed = brentq(lambda e: (0.5 + 60 * slope) * np.cos(e) - 60 * np.sin(e) - 10.0, 0.0, 1.0)
    tool = found.layers[0].beads[0].tool
    tilt = np.degrees(np.arccos(tool[:, 2]))
    assert tilt.min() >= np.degrees(needed) - 1e-9
    assert tilt[5:-5].max() <= np.degrees(needed) + FINEST
    assert (tool[:, 0] < 0).all() and np.degrees(np.abs(tool[:, 1])).max() < 1.0


def test_a_post_beside_the_way_is_passed_smoothly():
    angle = np.linspace(0, 2 * np.pi, 121)
    ring = np.stack([30 * np.cos(angle), 30 * np.sin(angle), np.zeros(121)], axis=1)
    ring[-1] = ring[0]
    post = box([38, -3, -20], [44, 3, 90], "post")
    path = toolpath(bead(ring, closed=True))
    found = keep_clear(path, [post], NOZZLE, LOCAL)
    tool = found.layers[0].beads[0].tool
    tilt = turned(path, found)
    solid = sampled(NOZZLE, left_out(NOZZLE) + ABOVE_FACES, ring, tool)
    inside = ((solid > [38, -3, -20]) & (solid < [44, 3, 90])).all(axis=2)
    assert not inside.any()
    asked = sampled(NOZZLE, left_out(NOZZLE) + ABOVE_FACES, ring, path.layers[0].beads[0].tool)
    assert ((asked > [38, -3, -20]) & (asked < [44, 3, 90])).all(axis=2).any()
    assert (tool[0] == tool[-1]).all() and tilt[60] < 1e-6 < tilt[0]
    turn = np.degrees(np.linalg.norm(np.diff(tool, axis=0), axis=1))
    assert turn.max() < 5.0


def test_where_nothing_helps_the_place_is_named():
    path = toolpath(
        bead([[0, -40, 0], [0, -20, 0]]),
        bead([[0, -10, 1], [0, 10, 1], [0, 30, 1]]),
    )
    lid = box([-90, 5, 8], [90, 90, 9], "lid")  # the nozzle does not fit under it
    found = keep_clear(
        path, [lid, disc(113.0, np.eye(4))], NOZZLE, BuildDirectionParameters(max_tilt=np.pi / 3)
    )
    error = next(issue for issue in found.issues if issue.code == "CLEARANCE")
    assert (error.level, error.layer, error.bead, error.point) == ("error", 1, 0, 1)


def test_max_tilt_holds():
    path = toolpath(bead(np.stack([np.zeros(11), np.linspace(0, 80, 11), np.zeros(11)], axis=1)))
    face = box([10, -200, -50], [30, 300, 150])
    tight = keep_clear(path, [face], NOZZLE, BuildDirectionParameters(max_tilt=np.radians(8.0)))
    assert "CLEARANCE" in codes(tight)
    wide = keep_clear(path, [face], NOZZLE, BuildDirectionParameters(max_tilt=np.radians(25.0)))
    assert codes(wide) == ["TILT_BACK"]
    assert np.degrees(np.arccos(wide.layers[0].beads[0].tool[:, 2])).max() <= 25.0


def test_only_what_is_laid_already_counts():
    wall = np.stack([np.full(5, 4.0), np.linspace(-20, 20, 5), np.full(5, 15.0)], axis=1)
    low = np.stack([np.zeros(9), np.linspace(-20, 20, 9), np.zeros(9)], axis=1)
    first = keep_clear(toolpath(bead(low), bead(wall)), [], NOZZLE, LOCAL)
    assert codes(first) == [] and touches_deposit(first, NOZZLE) == []
    after = toolpath(bead(wall), bead(low))
    assert touches_deposit(after, NOZZLE)
    found = keep_clear(after, [], NOZZLE, LOCAL)
    assert codes(found) == ["TILT_BACK"] and touches_deposit(found, NOZZLE) == []


def test_what_is_clear_stays_as_it_is_to_the_bit():
    path = toolpath(bead([[0, 0, 0], [5, 0, 0]]), bead([[0, 0, 1], [5, 0, 1]]))
    told = []
    clear = box([40, 40, 0], [50, 50, 50])
    assert (
        keep_clear(path, [clear], NOZZLE, LOCAL, watch=Watch(lambda *work: told.append(work)))
        is path
        and told == []
    )
    flat = box([-100, -100, -10], [100, 100, 0])
    assert keep_clear(path, [flat], NOZZLE, LOCAL) is path


def test_left_out_is_where_the_side_is_one_diameter_away():
    for nozzle in (NOZZLE, FAT):
        x = left_out(nozzle)
        assert np.hypot(x, 0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * x) == pytest.approx(
            nozzle.diameter
        )


def test_a_look_at_fixtures_names_the_first_place():
    path = toolpath(bead([[0, 0, 0], [20, 0, 0]]), bead([[0, 0, 1], [20, 0, 1]]))
    clamp = box([24, -5, 5], [40, 5, 30], "clamp")
    (issue,) = nozzle_issues(path, [clamp], NOZZLE)
    assert (issue.code, issue.layer, issue.bead, issue.point) == (
        "CLEARANCE",
        0,
        0,
        1,
    ) and "clamp" in issue.message
    assert nozzle_issues(path, [box([60, -5, 5], [70, 5, 30])], NOZZLE) == []


def between(path, count=40):
    """Tips and axes (n, 3) closely along all segments, the axes interpolated."""
    share = np.linspace(0, 1, count)[:, None]
    pairs = [
        (
            one.points[k] + share * (one.points[k + 1] - one.points[k]),
            one.tool[k] + share * (one.tool[k + 1] - one.tool[k]),
        )
        for _, _, one in path
        for k in range(len(one) - 1)
    ]
    tip, axis = (np.concatenate(some) for some in zip(*pairs))
    return tip, axis / np.linalg.norm(axis, axis=1, keepdims=True)


def test_a_thin_plate_that_reaches_in_between_two_points_is_seen():
    """Too narrow to touch the nozzle at any point of the bead, and beside it all the way."""
    along = np.arange(-20.0, 21.0, 4.0)
    path = toolpath(bead(np.stack([along, np.zeros(11), np.zeros(11)], axis=1)))
    low, high = np.array([1.9, 0.3, 1.3]), np.array([2.1, 1.5, 1.7])
    plate = box(low, high, "plate")
    solid = sampled(
        NOZZLE, left_out(NOZZLE), *(path.layers[0].beads[0].points, path.layers[0].beads[0].tool)
    )
    assert not ((solid > low) & (solid < high)).all(axis=2).any()
    (issue,) = nozzle_issues(path, [plate], NOZZLE)
    assert (issue.code, issue.point) == ("CLEARANCE", 5)
    found = keep_clear(path, [plate], NOZZLE, LOCAL)
    one = found.layers[0].beads[0]
    assert (
        codes(found) == ["TILT_BACK"]
        and 12 <= len(one) <= 16
        and np.isin(along, one.points[:, 0]).all()
    )
    assert (one.points[:, 1:] == 0).all() and nozzle_issues(found, [plate], NOZZLE) == []
    height = np.linspace(left_out(NOZZLE) + ABOVE_FACES, 4.0, 60)
    tip, axis = between(found)
    x, y = np.stack([np.linspace(low[0], high[0], 9), np.full(9, low[1])])
    for z in np.linspace(
        low[2], high[2], 9
    ):  # the plate's near edge, as deep in the nozzle as it is let pass
        offset = np.stack([x, y, np.full(9, z)], axis=1) - tip[:, None]
        up = np.einsum("kij,kj->ki", offset, axis)
        side = np.linalg.norm(offset - up[:, :, None] * axis[:, None], axis=2)
        above = up > height[0]
        assert (side - 0.5 * NOZZLE.diameter - np.tan(NOZZLE.half_angle) * up)[above].min() > -0.15


def test_a_plate_between_two_points_that_no_tilt_clears_is_an_error():
    path = toolpath(bead([[-4, 0, 0], [0, 0, 0], [4, 0, 0]]))
    ring = [box([1.9, low, 1.3], [2.1, low + 1.2, 1.7]) for low in (-1.5, 0.3)]
    found = keep_clear(path, ring, NOZZLE, BuildDirectionParameters(max_tilt=np.radians(5.0)))
    error = next(issue for issue in found.issues if issue.code == "CLEARANCE")
    assert (error.level, error.layer, error.bead) == ("error", 0, 0)


def test_tools_that_turn_as_fast_as_they_may_stay_below_that_where_they_are_tilted_clear():
    """A bend of the bead beside a post: what was asked turns at the limit already, the tilt would come on top."""
    most = np.radians(4.0)
    s = np.arange(0.0, 80.0, 0.5)
    lean = np.clip(0.95 * most * (s - 35.0), 0.0, 0.6)
    tool = np.stack([np.sin(lean), 0.0 * s, np.cos(lean)], axis=1)
    points = np.stack([s, np.zeros_like(s), np.zeros_like(s)], axis=1)
    post = box([46, 6, -20], [50, 12, 90], "post")
    path = toolpath(bead(points, tool))
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)

    def fastest(build):
        work.clear()
        found = keep_clear(
            path, [post], NOZZLE, build, watch=Watch(lambda *some: work.append(some))
        )
        axes = found.layers[0].beads[0].tool
        solid = sampled(NOZZLE, left_out(NOZZLE) + ABOVE_FACES, points, axes)
        assert not ((solid > [46, 6, -20]) & (solid < [50, 12, 90])).all(axis=2).any()
        return (np.linalg.norm(np.diff(axes, axis=0), axis=1) / step).max(), codes(found)

    work = []
    free, _ = fastest(BuildDirectionParameters(max_turn=np.inf, max_tilt=np.pi))
    assert free > 1.05 * most and work == [(len(s), 1)]
    kept, told = fastest(BuildDirectionParameters(max_turn=most, max_tilt=np.pi))
    assert work == [(len(s), 1), (len(s), 6)]  # each before it begins
    assert kept <= most * (1.0 + 1e-9) and "TURN_PASSED" not in told
    passed, told = fastest(
        BuildDirectionParameters(max_turn=most, max_tilt=0.61)
    )  # no room, and that is told
    assert passed <= most * (1.0 + 1e-9) or "TURN_PASSED" in told


def flank(tall, away, width):
    """A finished wall along y, and a bead beside it, `away` mm from its middle."""
    wall = [bead([[0, y, z] for y in np.linspace(-40, 40, 9)]) for z in range(tall)]
    beside = bead([[away, y, 0] for y in np.linspace(-40, 40, 21)])
    return dataclasses.replace(toolpath(*wall, beside), bead_width=width)


def deepest_in_wall(path, tall, width):
    """How deep (mm) points of the nozzle above the bead's height are in a wall of that width, x being across it."""
    last = path.layers[-1].beads[0]
    places = sampled(NOZZLE, 1.0, last.points, last.tool)
    # the flank is round from bead to bead: 0.5 mm at the edge of each
    inside = (places[..., 2] < tall) & (np.abs(places[..., 1]) < 40)
    return np.where(inside, 0.5 * width - np.abs(places[..., 0]), -np.inf).max()


def test_a_bead_beside_a_finished_wall_keeps_clear_of_its_flank():
    """8 mm beads to a height of 40 mm, the next one 16 mm from their middle: lines without width were clear."""
    asked = flank(40, 16.0, 8.0)
    assert keep_clear(dataclasses.replace(asked, bead_width=0.0), [], NOZZLE, LOCAL).issues == ()
    assert deepest_in_wall(asked, 40, 8.0) > 2.0
    found = keep_clear(asked, [], NOZZLE, LOCAL)
    assert codes(found) == ["TILT_BACK"] and deepest_in_wall(found, 40, 8.0) < 0.2
    assert keep_clear(flank(40, 30.0, 8.0), [], NOZZLE, LOCAL).issues == ()


def test_a_bead_of_many_points_is_tilted_at_some_and_is_clear_at_all(monkeypatch):
    """Points lie 0.1 mm apart; tilts are searched 2 mm apart, so that a look at all of them is one at what lies between."""
    asked = flank(40, 16.0, 8.0)
    many = bead([[16.0 + 3.0 * np.sin(0.1 * y), y, 0] for y in np.linspace(-40, 40, 801)])
    asked = dataclasses.replace(asked, layers=(*asked.layers[:-1], Layer((many,))))
    monkeypatch.setattr(clearance_knots, "MAX_POINTS", 41)
    searched = []
    cones = tilt_search.TiltSearch.coarse
    monkeypatch.setattr(
        tilt_search.TiltSearch,
        "coarse",
        lambda self, watch: searched.append(len(self.flat)) or cones(self, watch),
    )
    found = keep_clear(asked, [], NOZZLE, LOCAL)
    assert codes(found) == ["TILT_BACK"] and set(searched) == {41}
    assert deepest_in_wall(asked, 40, 8.0) > 2.0 and deepest_in_wall(found, 40, 8.0) < 0.3
    tool = found.layers[-1].beads[0].tool
    turns = np.degrees(np.arccos(np.clip((tool[1:] * tool[:-1]).sum(axis=1), -1.0, 1.0)))
    assert turns.max() < 1.0  # and not a step between candidates from one point to the next


def try_every_candidate(search, offsets, open_, tested, anchor, fixed):
    """Test all candidates that are not tested, before any way is sought."""
    rows, columns = np.nonzero(~tested)
    barred = ~search._clear(rows, offsets[rows, columns][:, None])[:, 0]
    tested[:] = True
    rows, columns = rows[barred], columns[barred]
    open_[rows, columns] = open_[search._twin[rows], columns] = False


@pytest.mark.parametrize("way", ["beside a wall", "around a post"])
def test_tilts_are_those_that_a_test_of_every_candidate_gives(way, monkeypatch):
    """The search tests candidates only where the best way leads through them, about half of them here."""
    bodies = []
    if way == "beside a wall":
        path = flank(40, 16.0, 8.0)
    else:
        angle = np.linspace(0, 2 * np.pi, 61)
        ring = np.stack([30 * np.cos(angle), 30 * np.sin(angle), np.zeros(61)], axis=1)
        ring[-1] = ring[0]
        path = toolpath(bead(ring, closed=True))
        bodies = [box([38, -3, -20], [44, 3, 90], "post")]
    looks = []
    clear = nozzle_check.Space.clear
    monkeypatch.setattr(
        nozzle_check.Space,
        "clear",
        lambda self, rows, axis: looks.append(len(rows)) or clear(self, rows, axis),
    )
    found = keep_clear(path, bodies, NOZZLE, LOCAL, remedy=False)
    few = sum(looks)
    looks.clear()
    least_clear = tilt_search.TiltSearch._least_clear

    def after_all_tests(self, offsets, open_, tested, anchor, fixed):
        try_every_candidate(self, offsets, open_, tested, anchor, fixed)
        return least_clear(self, offsets, open_, tested, anchor, fixed)

    monkeypatch.setattr(tilt_search.TiltSearch, "_least_clear", after_all_tests)
    monkeypatch.setattr(tilt_search.TiltSearch, "_near_best", lambda *search: None)
    monkeypatch.setattr(tilt_search.TiltSearch, "_useful", lambda self, states, open_, *rest: open_)
    best = keep_clear(path, bodies, NOZZLE, LOCAL, remedy=False)
    assert codes(found) == codes(best) and "TILT_BACK" in codes(found)
    for (_, _, one), (_, _, other) in zip(found, best, strict=True):
        assert (one.tool == other.tool).all()
    assert few < 0.8 * sum(looks)


def test_beads_of_one_layer_that_overlap_hinder_no_one():
    rows = [bead([[x, y, 0] for x in np.linspace(0, 30, 11)]) for y in np.arange(0.0, 30.0, 6.0)]
    lean = [
        dataclasses.replace(one, tool=np.tile([0.0, -np.sin(0.5), np.cos(0.5)], (11, 1)))
        for one in rows
    ]
    for beads in (rows, lean):
        path = Toolpath(
            (Layer(tuple(beads)),), np.eye(4), 2.0, 0.01, family="surface", bead_width=8.0
        )
        assert keep_clear(path, [], NOZZLE, LOCAL) is path


def test_where_some_points_of_a_bead_have_no_way_the_rest_is_not_searched_for_ever():
    """A tunnel: nothing frees the nozzle in it; 4,000 points cost no more than a few cones each."""
    count = 1000
    path = toolpath(
        bead(np.stack([np.linspace(-40, 40, count), np.zeros(count), np.zeros(count)], axis=1))
    )
    roof = [box([-90, -90, 8], [90, 90, 9], "roof"), box([-90, -90, -9], [90, 90, -8], "floor")]
    looks = []
    scenes = nozzle_check.Scene.find_touching

    def counted(self, solid, tip, *rest):
        looks.append(len(tip))
        return scenes(self, solid, tip, *rest)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(nozzle_check.Scene, "find_touching", counted)
        found = keep_clear(path, roof, NOZZLE, LOCAL, remedy=False)
    assert codes(found) == ["CLEARANCE"] and sum(looks) < 110 * count


def test_looking_needs_memory_that_grows_with_the_points_alone():
    def peak(count):
        s = np.linspace(-40, 40, count)
        known = np.zeros(count, dtype=bool)
        known[::3] = True
        tracemalloc.start()
        tilt_search.nearest(s[known], s, None)
        most = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return most

    assert peak(40_000) < 5e6
    s = np.sort(np.random.default_rng(1).uniform(0, 10, 80))
    known = s[::7]
    apart = np.abs(s[:, None] - known)
    assert np.abs(tilt_search.nearest(known, s, None) - apart.min(axis=1)).max() < 1e-12
    around = np.minimum(apart, 10.0 - apart).min(axis=1)
    assert np.abs(tilt_search.nearest(known, s, 10.0) - around).max() < 1e-12


def test_only_beads_that_get_points_are_tilted_anew(monkeypatch):
    """The nozzle is said to touch halfway in one bead once it is tilted: that bead alone is searched again, a point more;
    the others keep their axes to the bit, and all are clear."""
    asked = bend_on_pipe("local")[1]
    build = BuildDirectionParameters(mode="local", max_tilt=np.pi)
    plain = keep_clear(asked, [pipe()], FAT, build)
    searched, looks, (between, cleared) = (
        [],
        [],
        (wall_clearance.touched_between, wall_clearance._cleared),
    )
    counts = np.array([len(one) for _, _, one in asked])
    begin = int(counts[:2].sum())

    def looked(room, beads, tool, free):
        found = between(room, beads, tool, free)
        looks.append(len(found))
        if len(looks) == 1:
            found[begin + 7] = True  # in the third bead
        return found

    def noted(room, rows, *others):
        searched.append([int(row[0]) for row in rows])
        return cleared(room, rows, *others)

    monkeypatch.setattr(wall_clearance, "touched_between", looked)
    monkeypatch.setattr(wall_clearance, "_cleared", noted)
    found = keep_clear(asked, [pipe()], FAT, build)
    assert len(searched[0]) > 2 and searched[1:] == [[begin]] and looks[1] == looks[0] + 1
    for number, ((_, _, one), (_, _, two)) in enumerate(zip(plain, found)):
        assert len(two) == len(one) + (number == 2)
        if number != 2:
            np.testing.assert_array_equal(two.tool, one.tool)
    assert touches_deposit(found, FAT) == [] and "CLEARANCE" not in codes(found)
