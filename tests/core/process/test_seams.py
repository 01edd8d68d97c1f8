# SPDX-License-Identifier: LGPL-2.1-or-later
"""Seams by point, corner and viewer, against brute force over all points of the beads, and of moved parts."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from shapely.geometry import LinearRing, Point, Polygon

from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import InputError
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.bead_classes import BeadClass, BeadEnd
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import (
    ProcessParameters,
    SeamParameters,
    WireParameters,
)
from freecad_am.core.process import seams
from freecad_am.core.strategies.solids.plan import plan
from freecad_am.core.toolpath import LEAST_SECTION, Bead, Layer, Toolpath

CHORD_ERROR = 0.05  # mm
UP = np.array([0.0, 0.0, 1.0])
STAR = np.array(
    [
        (r * math.cos(k * math.pi / 5), r * math.sin(k * math.pi / 5))
        for k, r in enumerate([30.0, 14.0] * 5)
    ]
)
ELL = np.array([(0, 0), (60, 0), (60, 20), (20, 20), (20, 50), (0, 50)], dtype=float)


def closed_bead(flat, height=0.0, **more):
    points = np.column_stack([flat, np.full(len(flat), height)])
    points = np.vstack([points, points[:1]])
    arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    up = np.tile(UP, (len(points), 1))
    speed = np.full(len(points), 6.0)
    return Bead(points, up, up, 2.0 * math.pi * arc / arc[-1], speed, True, **more)


def circle(radius, count=90, centre=(0.0, 0.0)):
    angle = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    return np.column_stack([np.cos(angle), np.sin(angle)]) * radius + centre


def random_loop(seed, height=0.0):
    """A star-shaped loop of 5 to 40 points, at uneven distances."""
    random = np.random.default_rng(seed)
    angle = np.sort(random.uniform(0.0, 2.0 * math.pi, random.integers(5, 40)))
    angle = angle[np.r_[True, np.diff(angle) > 0.05]]
    radius = random.uniform(15.0, 40.0, len(angle))[:, None]
    flat = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    return closed_bead(flat if seed % 2 else flat[::-1], height)


def toolpath_of(*layers):
    return Toolpath(
        tuple(Layer(tuple(beads)) for beads in layers), np.eye(4), 2.0, CHORD_ERROR, bead_width=5.0
    )


def placed(toolpath, bead_width=5.0, **seam):
    process = ProcessParameters(seam=SeamParameters(**seam), bead_width=bead_width)
    return seams.place_seams(toolpath, process)


def dense(bead, step=0.02):
    """Points along the chords of a bead."""
    pieces = [
        start
        + np.linspace(0.0, 1.0, max(2, math.ceil(np.linalg.norm(end - start) / step)))[:, None]
        * (end - start)
        for start, end in zip(bead.points, bead.points[1:])
    ]
    return np.vstack(pieces)


def moved(bead, pose, shift):
    return dataclasses.replace(
        bead,
        points=pose.apply(bead.points) + shift,
        build=pose.apply(bead.build),
        tool=pose.apply(bead.tool),
    )


RULES = [
    {"position": "point", "point": (50.0, 13.0, 4.0)},
    {"position": "sharpest"},
    {"position": "hidden", "away_from": (0.3, -1.0, 0.0)},
    {"position": "spread", "distance": 11.0},
]


@pytest.mark.parametrize("seed", range(40))
def test_a_seam_by_point_is_the_nearest_place_of_the_bead(seed):
    bead = random_loop(seed)
    target = np.random.default_rng(seed + 1000).uniform(-60.0, 60.0, 3)
    ((_, _, started),) = placed(toolpath_of([bead]), position="point", point=tuple(target))
    flat = LinearRing(bead.points[:, :2])
    least = math.hypot(flat.distance(Point(target[:2])), target[2])
    reached = np.linalg.norm(started.points[0] - target)
    middle = bead.outline.at(np.arange(len(bead) - 1), 0.5)[0]
    bow = np.linalg.norm(middle - 0.5 * (bead.points[:-1] + bead.points[1:]), axis=1).max()
    assert abs(reached - least) < seams.SNAP_MM + bow
    assert reached <= np.linalg.norm(bead.points - target, axis=1).min() + seams.SNAP_MM
    assert started.closed and len(bead) <= len(started) <= len(bead) + 1
    assert started.length == pytest.approx(bead.length, abs=0.1)


@pytest.mark.parametrize("seed", range(40))
def test_the_seam_is_at_the_sharpest_corner_that_points_outwards(seed):
    bead = random_loop(seed)
    ((_, _, started),) = placed(toolpath_of([bead]), position="sharpest")
    flat = bead.points[:-1, :2]
    before, after = flat - np.roll(flat, 1, axis=0), np.roll(flat, -1, axis=0) - flat
    turn = np.degrees(
        np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], (before * after).sum(1))
    )
    turn *= 1.0 if Polygon(flat).exterior.is_ccw else -1.0
    index = int(np.argmin(np.linalg.norm(flat - started.points[0, :2], axis=1)))
    assert np.allclose(flat[index], started.points[0, :2], atol=1e-9)
    if turn.max() >= 35.0:
        assert turn[index] >= turn.max() - 1.0
    elif turn.min() <= -35.0:
        assert turn[index] <= turn.min() + 1.0
    else:
        assert index == 0


@pytest.mark.parametrize("seed", range(40))
def test_a_hidden_seam_is_farthest_from_the_viewer(seed):
    bead = random_loop(seed)
    direction = np.random.default_rng(seed + 500).normal(size=3)
    ((_, _, started),) = placed(
        toolpath_of([bead]), position="hidden", away_from=tuple(direction.tolist())
    )
    level = dense(bead) @ direction / np.linalg.norm(direction)
    here = started.points[0] @ direction / np.linalg.norm(direction)
    assert here <= level.min() + CHORD_ERROR + seams.SNAP_MM


def test_a_seam_hidden_behind_a_straight_side_is_in_its_middle():
    box = np.array([(0, 0), (40, 0), (40, 24), (0, 24)], dtype=float)
    for turn in range(4):
        bead = closed_bead(np.roll(box, turn, axis=0))
        ((_, _, started),) = placed(toolpath_of([bead]), position="hidden", away_from=(0, -1, 0))
        assert started.points[0] == pytest.approx([20.0, 24.0, 0.0], abs=0.05)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule["position"])
@pytest.mark.parametrize("seed", range(5))
def test_a_moved_part_has_the_same_seams(rule, seed):
    """Layers of several loops, with ties: turned and shifted with the point and the direction."""
    toolpath = toolpath_of(
        *[
            [closed_bead(STAR * scale, 2.0 * k) for scale in (1.0, 0.8)]
            + [closed_bead(ELL[:: -1 if k % 2 else 1] + (50.0, 0.0), 2.0 * k)]
            + [closed_bead(circle(8.0, centre=(-50.0, 0.0)), 2.0 * k)]
            for k in range(4)
        ]
    )
    pose = Rotation.random(random_state=seed)
    shift = np.array([100.0, -37.0, 12.5])
    turned = toolpath_of(
        *[[moved(bead, pose, shift) for bead in layer.beads] for layer in toolpath.layers]
    )
    there = dict(rule)
    if "point" in rule:
        there["point"] = tuple((pose.apply(rule["point"]) + shift).tolist())
    if "away_from" in rule:
        there["away_from"] = tuple(pose.apply(rule["away_from"]).tolist())
    beads = [bead for _, _, bead in placed(toolpath, **rule)]
    others = [bead for _, _, bead in placed(turned, **there)]
    for bead, other in zip(beads, others, strict=True):
        assert pose.apply(bead.points) + shift == pytest.approx(other.points, abs=1e-6)
        assert bead.parameter == pytest.approx(other.parameter, abs=1e-6)


def test_equal_corners_stay_above_each_other():
    """The five tips of a star are equally sharp; rounding must not move the seam among them, even as the star turns."""
    random = np.random.default_rng(3)
    layers = []
    for k in range(30):
        turn = Rotation.from_euler("z", 2.0 * k, degrees=True).as_matrix()[:2, :2]
        flat = STAR @ turn.T + random.normal(scale=1e-7, size=STAR.shape)
        layers.append([closed_bead(np.roll(flat, k, axis=0), 2.0 * k)])
    starts = np.array(
        [bead.points[0] for _, _, bead in placed(toolpath_of(*layers), position="sharpest")]
    )
    assert np.linalg.norm(np.diff(starts[:, :2], axis=0), axis=1).max() < 1.1
    assert np.hypot(*starts[:, :2].T) == pytest.approx(30.0, abs=1e-5)


def body_of(outline, height):
    """A prism over a star-shaped outline about the origin."""
    count = len(outline)
    rows = [np.column_stack([outline, np.full(count, z)]) for z in (0.0, height)]
    points = np.vstack([*rows, [(0.0, 0.0, 0.0), (0.0, 0.0, height)]])
    faces = []
    for k in range(count):
        other = (k + 1) % count
        faces += [(k, other, other + count), (k, other + count, k + count)]
        faces += [(other, k, 2 * count), (k + count, other + count, 2 * count + 1)]
    return Body("prism", points, np.array(faces, dtype=np.int64))


def solid_plan(seam, outline=STAR, **values):
    strategy = SolidParameters(
        layer_height=2.0, bead_spacing=4.0, chord_error=CHORD_ERROR, **values
    )
    process = ProcessParameters(seam=seam)
    stack = prepare_stack([body_of(outline, 12.0)], strategy, "part")
    return plan(stack, strategy, BuildDirectionParameters(), process, None)


@pytest.mark.parametrize("rule", RULES, ids=lambda rule: rule["position"])
def test_filled_solids_have_the_beads_of_the_usual_seam_started_elsewhere(rule):
    usual, other = solid_plan(SeamParameters()), solid_plan(SeamParameters(**rule))
    assert usual.bead_count == other.bead_count
    assert other.length == pytest.approx(usual.length, rel=1e-4)
    for before, after in zip(usual.layers, other.layers, strict=True):
        ours = sorted(bead.length for bead in before.beads)
        assert ours == pytest.approx(sorted(bead.length for bead in after.beads), rel=1e-3)
        outer = [bead for bead in after.beads if bead.closed and not bead.role.ring]
        assert outer
        for bead in outer:
            at = bead.points[0]
            if rule["position"] == "point":
                target = np.array(rule["point"])
                least = np.linalg.norm(dense(bead) - target, axis=1).min()
                assert np.linalg.norm(at - target) <= least + seams.SNAP_MM + CHORD_ERROR
            elif rule["position"] == "spread":
                continue
            elif rule["position"] == "hidden":
                way = np.array(rule["away_from"]) / np.linalg.norm(rule["away_from"])
                assert at @ way <= (dense(bead) @ way).min() + CHORD_ERROR + seams.SNAP_MM
            else:
                assert np.linalg.norm(at) == pytest.approx(
                    np.linalg.norm(bead.points, axis=1).max(), abs=1e-6
                )


def gaps_of_starts(toolpath, open_beads=False):
    """For every closed bead in print order: its gap to starts known before it, and the largest possible gap."""
    below = np.zeros((0, 3))
    for number, layer in enumerate(toolpath.layers):
        current = [bead.points[0] for bead in layer.beads if not bead.closed]
        for bead in layer.beads:
            if not bead.closed:
                continue
            others = (
                np.vstack([*current, *below]).reshape(-1, 3) if len(current) or len(below) else None
            )
            if others is not None:
                gap = np.linalg.norm(others - bead.points[0], axis=1).min()
                free = np.linalg.norm(dense(bead, 0.2)[:, None] - others, axis=2).min(axis=1).max()
                yield number, gap, free
            current.append(bead.points[0])
        below = np.array(current)


@pytest.mark.parametrize("seed", range(12))
def test_spread_starts_keep_their_distance_or_the_largest_possible_one(seed):
    random = np.random.default_rng(seed)
    distance = float(random.uniform(5.0, 45.0))
    layers = []
    for k in range(12):
        loops = [closed_bead(STAR * scale, 2.0 * k) for scale in (1.0, 0.85, 0.7)]
        loops += [closed_bead(ELL[:: (-1) ** k] * 0.6 + (35.0, -10.0), 2.0 * k)]
        line = closed_bead(circle(5.0, centre=(0.0, 3.0 * k)), 2.0 * k).part(slice(0, 20))
        layers.append([*loops, line])
    made = placed(toolpath_of(*layers), position="spread", distance=distance)
    short = {}
    for number, gap, free in gaps_of_starts(made):
        if gap < distance - 1e-9:
            assert free < gap + 0.3  # the samples of the bead are less than this apart
            short.setdefault(number, []).append(gap)
    if not short:
        assert codes(made) == []
        return
    (issue,) = made.issues
    assert issue.code == "SEAM_DISTANCE"
    assert min(short[issue.layer]) == min(map(min, short.values()))
    assert (
        f"{sum(map(len, short.values()))} closed bead(s) in {len(short)} layer(s)" in issue.message
    )


def test_some_spread_starts_keep_and_some_miss_their_distance():
    """The test above has seen both."""
    ring = [[closed_bead(circle(10.0), 2.0 * k)] for k in range(5)]
    assert codes(placed(toolpath_of(*ring), position="spread", distance=15.0)) == []
    made = placed(toolpath_of(*ring), position="spread", distance=25.0)
    assert codes(made) == ["SEAM_DISTANCE"]
    starts = np.array([bead.points[0] for _, _, bead in made])
    apart = np.linalg.norm(np.diff(starts, axis=0), axis=1)
    assert apart == pytest.approx(math.hypot(20.0, 2.0), abs=0.02)


def test_spread_starts_move_round_the_part_layer_by_layer():
    """15 mm apart on a circle of 40 mm radius, so after a turn of 16 or 17 layers the seam is near the first one again."""
    layers = [[closed_bead(circle(40.0)[:: -1 if k % 2 else 1], 1.0 * k)] for k in range(34)]
    made = placed(toolpath_of(*layers), position="spread", distance=15.0)
    starts = np.array([bead.points[0] for _, _, bead in made])
    turn = np.degrees(np.unwrap(np.arctan2(starts[:, 1], starts[:, 0])))
    chord = math.sqrt(15.0**2 - 1.0)
    step = math.degrees(2.0 * math.asin(chord / 80.0))
    assert np.diff(turn) == pytest.approx(step, abs=0.2)


def test_spread_starts_of_a_solid_keep_their_distance():
    seam = SeamParameters(position="spread", distance=9.0)
    made = solid_plan(seam, circle(30.0, 6), fill="zigzag", walls=2)
    layers = [list(layer.beads) for layer in made.layers]
    ordered = [sorted(layer, key=lambda bead: bead.role.ring) for layer in layers]
    for layer, below in zip(ordered[1:], ordered):
        for bead in layer:
            if bead.closed:
                others = [other.points[0] for other in (*layer, *below) if other is not bead]
                gap = np.linalg.norm(np.array(others) - bead.points[0], axis=1).min()
                assert gap >= 9.0 - 1e-9
    assert "SEAM_DISTANCE" not in codes(made)


def test_a_distance_longer_than_every_bead_is_rejected():
    ring = toolpath_of([closed_bead(circle(5.0))])
    seam = SeamParameters(position="spread", distance=40.0)
    with pytest.raises(InputError, match=r"longest closed bead is only 31\.41 mm") as raised:
        seams.check_distance(ring, seam)
    assert raised.value.where == "process.seam.distance"
    seams.check_distance(ring, SeamParameters(distance=40.0))


def codes(toolpath):
    return [issue.code for issue in toolpath.issues]


def test_a_point_inside_the_part_is_reported_and_one_beside_it_is_not():
    layers = [
        [closed_bead(circle(30.0), 2.0 * k), closed_bead(circle(6.0), 2.0 * k)] for k in range(3)
    ]
    ring = toolpath_of(*layers)
    inside = placed(ring, position="point", point=(18.0, 0.0, 2.0))
    assert codes(inside) == ["SEAM_POINT"] and inside.issues[0].layer == 1
    assert "12 mm" in inside.issues[0].message
    for point in ((36.0, 0.0, 2.0), (0.5, 0.0, 2.0), (27.0, 0.0, 2.0), (18.0, 0.0, 400.0)):
        made = placed(ring, position="point", point=point)
        expected = ["SEAM_POINT"] if point[2] > 10.0 else []
        assert codes(made) == expected


def test_no_corner_and_no_side_are_reported_and_the_usual_seam_stays():
    ring = toolpath_of([closed_bead(circle(30.0))])
    for rule, code in (
        ({"position": "sharpest"}, "NO_EFFECT"),
        ({"position": "hidden", "away_from": (0.0, 0.0, 1.0)}, "SEAM_SIDE"),
    ):
        made = placed(ring, **rule)
        assert codes(made) == [code]
        assert (made.layers[0].beads[0].points == ring.layers[0].beads[0].points).all()


def test_a_position_without_its_parameter_is_rejected():
    for position, key in (("point", "point"), ("hidden", "away_from")):
        with pytest.raises(InputError, match="needs a value") as raised:
            seams.check_parameters(SeamParameters(position=position))
        assert raised.value.where == f"process.seam.{key}"
    seams.check_parameters(SeamParameters(position="point", point=(0.0, 0.0, 0.0)))


def test_parameters_of_another_position_are_reported():
    ring = toolpath_of([closed_bead(circle(30.0))])
    seam = SeamParameters(angle=0.3, position="point", point=(50.0, 0.0, 0.0), away_from=(1, 0, 0))
    assert [issue.message.split()[0] for issue in seams.unused_issues(ring, seam)] == [
        "process.seam.angle",
        "process.seam.away_from",
    ]
    assert not seams.unused_issues(ring, SeamParameters(angle=0.3, step=0.1))
    open_only = toolpath_of([ring.layers[0].beads[0].part(slice(0, 20))])
    (issue,) = seams.unused_issues(open_only, SeamParameters(position="sharpest"))
    assert issue.code == "NO_EFFECT" and "no bead is closed" in issue.message


# ---- Scarf seams


def scarfed(bead, length, **process):
    given = ProcessParameters(seam=SeamParameters(scarf=length), **process)
    ((_, _, made),) = seams.set_scarfs(toolpath_of([bead]), given)
    return made


def deposited(bead):
    """Deposit time of each segment, s: volume at a constant wire feed."""
    return np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]


@pytest.mark.parametrize("tangents", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_a_scarf_deposits_the_volume_of_the_bead_without_one(seed, tangents):
    """Also where widths and so speeds vary, and from another seam than the scarf was made for."""
    random = np.random.default_rng(seed)
    bead = random_loop(seed)
    if seed >= 6:
        speed = random.uniform(3.0, 9.0, len(bead))
        bead = dataclasses.replace(bead, speed=speed)
    if tangents:
        outline = bead.outline
        around = np.stack(
            [
                np.r_[outline.arriving[-1:], outline.arriving],
                np.r_[outline.leaving, outline.leaving[:1]],
            ],
            axis=1,
        )
        around /= np.linalg.norm(around, axis=2, keepdims=True)
        bead = dataclasses.replace(bead, tangents=around)
    length = float(random.uniform(2.0, 0.5 * bead.length))
    prepared = scarfed(bead, length)
    assert prepared.closed and deposited(prepared).sum() == pytest.approx(
        deposited(bead).sum(), rel=1e-3
    )
    for start in (0, 3):
        uncut = prepared.started_at(start)
        made = uncut.run_on(0.0)
        assert deposited(made).sum() == pytest.approx(deposited(uncut).sum(), rel=1e-9)
        assert (made.points[: len(uncut)] == uncut.points).all() and not made.closed
        assert made.points[len(uncut) :, 2].min() > 0.0
        ramp = made.height * np.ones(len(made))
        assert ramp[[0, -1]] == pytest.approx(2.0 * LEAST_SECTION, abs=0.03)
        assert ramp.max() == pytest.approx(2.0, rel=1e-9)
        assert made.points[-1, 2] == pytest.approx(2.0 * (1.0 - LEAST_SECTION), abs=0.03)
        assert made.run_on(5.0) is made
    curve = made.outline.at(np.arange(len(made) - 1), 0.5)[0]
    assert curve[:, 2].min() > -0.1 and curve[:, 2].max() < 2.0


def test_both_ramps_of_a_scarf_fill_the_layer_without_a_step():
    """The heights of both ramps over each other, from the points by interpolation: full where they overlap, within 7 %."""
    bead = closed_bead(circle(20.0, 200))
    made = scarfed(bead, 20.0).run_on(0.0)
    flat = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(made.points[:, :2], axis=0), axis=1))]
    total = bead.length
    at = np.linspace(0.0, total, 4001)
    below = np.interp(at, flat, made.height)
    above = np.interp(at + total, flat, made.height, right=0.0)
    total_height = below + above
    assert total_height.mean() == pytest.approx(2.0, rel=1e-3)
    both = above > 0.0
    assert total_height[both] == pytest.approx(2.0 * (1.0 + LEAST_SECTION**2), rel=1e-3)
    assert total_height.min() > 2.0 * (1.0 - LEAST_SECTION)
    # the overlap rises with the deposit below it, and its top never passes the layer
    underside = np.interp(at + total, flat, made.points[:, 2], right=np.nan)[both]
    assert (np.abs(underside - below[both]) <= 2.0 * LEAST_SECTION + 1e-6).all()
    assert (underside + above[both] <= 2.0 + 1e-6).all()
    assert np.abs(np.diff(made.points[:, 2])).max() < 2.0 / 19.0
    speed = made.speed[1:]
    assert speed.max() / 6.0 < 1.0 / LEAST_SECTION + 0.1 and speed.min() == pytest.approx(
        6.0, rel=1e-3
    )
    assert (np.abs(np.log(speed[1:] / speed[:-1])) < 0.17).all()


@pytest.mark.parametrize("seed", range(3))
def test_a_moved_bead_has_the_same_scarf(seed):
    pose = Rotation.random(random_state=seed)
    shift = np.array([10.0, -3.0, 7.0])
    bead = random_loop(seed)
    made = scarfed(bead, 12.0).run_on(0.0)
    other = scarfed(moved(bead, pose, shift), 12.0).run_on(0.0)
    assert pose.apply(made.points) + shift == pytest.approx(other.points, abs=1e-6)
    assert made.speed == pytest.approx(other.speed, rel=1e-6)


def test_scarfs_that_do_not_fit_are_rejected_or_reported():
    ring, dot = closed_bead(circle(20.0)), closed_bead(circle(3.0))
    process = ProcessParameters(seam=SeamParameters(scarf=20.0), overlap=4.0)
    made = seams.set_scarfs(toolpath_of([ring], [ring, dot, dot]), process)
    (issue,) = made.issues
    assert (issue.code, issue.layer) == ("SEAM_SCARF", 1) and "2 closed bead(s)" in issue.message
    assert [bead.scarf is not None for _, _, bead in made] == [True, True, False, False]
    assert codes(seams.set_scarfs(toolpath_of([ring]), process)) == ["NO_EFFECT"]
    line = ring.part(slice(0, 30))
    assert codes(seams.set_scarfs(toolpath_of([line]), process)) == ["NO_EFFECT"]
    with pytest.raises(InputError, match=r"use at most 9\.4"):
        seams.set_scarfs(toolpath_of([dot]), process)
    slow_end = BeadEnd(length=5.0, travel_speed=3.0)
    for values, text in (
        ({"wire": WireParameters(feed_mode="proportional")}, "constant wire feed"),
        ({"end": slow_end}, "where the scarf does"),
        (
            {"classes": (BeadClass("contour", end_length=5.0, end_travel_speed=3.0),)},
            "where the scarf",
        ),
    ):
        with pytest.raises(InputError, match=text):
            seams.set_scarfs(toolpath_of([ring]), dataclasses.replace(process, **values))
