# SPDX-License-Identifier: LGPL-2.1-or-later
"""The predicted deposit: what it holds against what the wire feeds, and walls, tubes, layers on a cylinder and filled blocks
whose shape is known by a formula."""

import math

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.process.shape import compare
from freecad_am.core.process.shape.compare import BOTH, faces
from freecad_am.core.process.shape.laying import feature_parts, predicted_deposit
from freecad_am.core.toolpath import Bead, Layer, SpeedLaw, Toolpath

WIDE, HIGH, SPEED = 6.0, 2.0, 8.0
KNOWN = 0.35  # of a cube's edge, by which one place of a surface may be off its formula; in the mean a tenth of that
PROCESS = ProcessParameters()


def bead(points, build=(0.0, 0.0, 1.0), closed=False, **more):
    points = np.asarray(points, float)
    if closed:
        points[-1] = points[0]
    up = np.broadcast_to(np.asarray(build, float), points.shape)
    speed = more.pop("speed", np.full(len(points), SPEED))
    return Bead(
        points=points,
        build=up,
        tool=up,
        parameter=np.linspace(0.0, 2.0 * math.pi, len(points)),
        speed=speed,
        closed=closed,
        **more,
    )


def straight(start, end, count=40, **more):
    share = np.linspace(0.0, 1.0, count)[:, None]
    return bead((1.0 - share) * np.asarray(start, float) + share * np.asarray(end, float), **more)


def ring(radius, height, count=241, **more):
    angle = np.linspace(0.0, 2.0 * math.pi, count)
    points = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=1
    )
    return bead(points, closed=True, **more)


def toolpath(layers, height=HIGH, width=WIDE, **more):
    return Toolpath(
        tuple(Layer(tuple(beads)) for beads in layers),
        np.eye(4),
        height,
        0.01,
        bead_width=width,
        **more,
    )


def deposit(path, process=PROCESS, edge=None):
    return predicted_deposit(
        feature_parts(path, [process] * len(path.parts)), lambda share, text: None, edge
    )


def box(low, high):
    """Triangles of a box, outwards."""
    corners = np.array(
        [[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)], float
    )
    squares = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return corners, np.array(
        [(a, b, c) for a, b, c, _ in squares] + [(a, c, d) for a, _, c, d in squares]
    )


def tube(inner, outer, height, sides=720):
    """Triangles of the two round faces of a tube, away from its wall."""
    angle = np.linspace(0.0, 2.0 * math.pi, sides, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
    up = np.array([0.0, 0.0, height])
    points = np.concatenate(
        [outer * circle, outer * circle + up, inner * circle, inner * circle + up]
    )
    k, following = np.arange(sides), np.roll(np.arange(sides), -1)
    first = np.concatenate(
        [
            np.stack([k, following, sides + following], 1),
            np.stack([k, sides + following, sides + k], 1),
        ]
    )
    return points, np.concatenate([first, first[:, ::-1] + 2 * sides])


def first_air(grid, start, way, reach):
    """How far the deposit goes on from a point, by places one hundredth of a cube apart."""
    steps = np.arange(0.0, reach, 0.01 * grid.edge)
    air = grid.fill_at(np.asarray(start) + steps[:, None] * np.asarray(way)) < 0.5
    return steps[np.argmax(air)]


def mixed_layers(rng):
    """Walls, rings that cross them, and beads laid twice, of several widths and speeds, in layers that lean."""
    lean = np.array([0.2, -0.1, 1.0]) / math.sqrt(1.05)
    for k in range(4):
        at = HIGH * k * lean
        speed = np.r_[5.0, rng.uniform(5.0, 12.0, 39)]
        yield [
            straight(at, at + [50.0, 9.0, 0.0], build=lean, speed=speed),
            straight(at + [0, 9, 0], at + [50, 0, 0], build=lean),
            bead(
                ring(14.0, 0.0).points + at + [25.0, 5.0, 0.0],
                build=lean,
                closed=True,
                width=rng.uniform(4.0, 8.0, 241),
                height=np.full(241, HIGH),
            ),
            straight(at, at + [50.0, 9.0, 0.0], build=lean, speed=speed),
        ]


@pytest.mark.parametrize("feed", [0.0, 31.0])
def test_it_holds_what_is_fed(feed):
    """Summed over a lattice of our own, askew to its cubes: between their middles it is told in proportion, so that the sum
    is theirs. What is fed: of wire by its section and the time, without one width x height x length of every segment."""
    path = toolpath(mixed_layers(np.random.default_rng(15)), wire_feed=feed)
    found = deposit(path, ProcessParameters(wire=WireParameters(diameter=1.6)))
    fed = 0.0
    for layer in path.layers:
        for one in layer.beads:
            for k in range(1, len(one)):
                step = math.dist(one.points[k - 1], one.points[k])
                counted = (
                    WIDE * HIGH
                    if one.width is None
                    else 0.5 * HIGH * (one.width[k - 1] + one.width[k])
                )
                fed += step / one.speed[k] * math.pi * 0.8**2 * feed if feed else step * counted
    edge = found.grid.edge
    axes = [
        np.arange(-20.0, 75.0, edge),
        np.arange(-30.0, 45.0, edge),
        np.arange(-12.0, 60.0, edge),
    ]
    lattice = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3) + [
        0.31 * edge,
        0.17 * edge,
        0.73 * edge,
    ]
    assert abs(edge**3 * found.grid.fill_at(lattice).sum() / fed - 1.0) < 1e-9
    assert abs(found.fed / fed - 1.0) < 1e-9 and abs(found.deposited / fed - 1.0) < 1e-9
    assert found.grid.filled.min() >= 0.0 and found.grid.filled.max() <= 1.0 + 1e-12


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_one_bead_alone_is_a_parabola(turn):
    """As wide as it counts, half as high again as its mean; round ends take of it no farther than their own width."""
    way, side = (
        np.array([math.cos(turn), math.sin(turn), 0.0]),
        np.array([-math.sin(turn), math.cos(turn), 0.0]),
    )
    found = deposit(toolpath([[straight(-60.0 * way, 60.0 * way)]]), edge=0.5)
    for aside in (0.0, 0.5, 1.0, 1.5, 2.0):
        up = first_air(found.grid, aside * side, (0, 0, 1), 6.0)
        assert abs(up - 1.5 * HIGH * (1.0 - (2.0 * aside / WIDE) ** 2)) < KNOWN * 0.5, aside


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_a_wall_has_straight_sides_and_a_round_top(turn):
    """Sides half of a width from the middle, every layer one layer height higher, the parabola on top of all."""
    way, side = (
        np.array([math.cos(turn), math.sin(turn), 0.0]),
        np.array([-math.sin(turn), math.cos(turn), 0.0]),
    )
    layers = [
        [straight((0, 0, k * HIGH) - 80.0 * way, (0, 0, k * HIGH) + 80.0 * way)] for k in range(6)
    ]
    found = deposit(toolpath(layers), edge=0.5)
    for height in (2.0, 5.0, 8.0, 9.0):
        for sense in (1.0, -1.0):
            assert (
                abs(first_air(found.grid, (0, 0, height), sense * side, 6.0) - 0.5 * WIDE)
                < KNOWN * 0.5
            )
    for aside in (0.0, 1.0, 2.0):
        tops = [
            5.0
            + first_air(
                found.grid, np.array([0, 0, 5.0]) + along * way + aside * side, (0, 0, 1), 15.0
            )
            for along in np.linspace(-9.0, 9.0, 19)
        ]
        formula = 6 * HIGH + 0.5 * HIGH - 1.5 * HIGH * (2.0 * aside / WIDE) ** 2
        assert abs(np.mean(tops) - formula) < 0.1 * HIGH and (
            aside > 1.0 or np.ptp(tops) < 0.25 * HIGH
        )


def test_a_tube_is_known_from_both_faces():
    """Of a tube 3 mm thick beads of 6 mm leave 1.5 mm on either side, and no height is lost in a closed wall."""
    found = deposit(toolpath([[ring(30.0, k * HIGH)] for k in range(8)]), edge=0.75)
    told = compare.compare_deposit(found, faces(*tube(28.5, 31.5, 15.0)))
    middle = told.faces.points[:, 2] < 12.0
    assert len(told.deviation) > 5000 and not told.bare.any()
    assert np.abs(told.deviation[middle] - 1.5).max() < KNOWN * 0.75
    shape = compare.figures(found, told, 1.5 - KNOWN * 0.75)
    # the round top leaves less at its edge: h / 2 above the last layer, less a parabola's fall
    top = 16.0 + 1.0 - 1.5 * HIGH * (1.5 / 3.0) ** 2
    assert top > 15.0 and shape.outside == 0.0 and shape.least > 0.0
    assert np.abs(shape.drift - shape.drift[0]).max() < 0.15


def test_layers_on_a_cylinder_grow_by_what_is_fed():
    """Rings side by side along a roller, built outwards: the radius is that of the volume of all rings."""

    def layer(k):
        rings = []
        for x in np.arange(2.0, 40.0, 4.0):
            angle = np.linspace(0.0, 2.0 * math.pi, 361)
            out = np.stack([np.zeros(361), np.cos(angle), np.sin(angle)], axis=1)
            out[-1] = out[0]
            rings.append(bead((40.0 + HIGH * k) * out + [x, 0, 0], build=out, closed=True))
        return rings

    found = deposit(toolpath([layer(k) for k in range(3)], width=4.0), edge=0.75)
    squared = 40.0**2 + 2.0 * HIGH * sum(40.0 + HIGH * k for k in range(3))
    ways = [
        (0.0, math.cos(angle), math.sin(angle)) for angle in np.linspace(0.0, 2.0 * math.pi, 60)
    ]
    for x in (14.0, 16.0, 19.0, 22.0, 26.0):
        outer = [
            40.5 + first_air(found.grid, np.array([x, 0, 0]) + 40.5 * np.array(way), way, 9.0)
            for way in ways
        ]
        assert np.abs(np.array(outer) - math.sqrt(squared)).max() < KNOWN * 0.75
        assert abs(np.mean(outer) - math.sqrt(squared)) < 0.1 * KNOWN * 0.75


@pytest.mark.parametrize(("pitch", "valley"), [(0.7, 0.0), (0.738, 0.0), (0.9, 1.0)])
@pytest.mark.always("0.738-0.0", "0.9-1.0")
def test_the_area_is_kept_where_beads_overlap(pitch, valley):
    """In the middle of many beads the mean height is their section over their distance; up to 0.738 widths apart they are
    flat, farther a valley is left between them."""
    across = pitch * WIDE
    real = {"width": np.full(40, WIDE), "height": np.full(40, HIGH)}
    beads = [straight((-60.0, y, 0.0), (60.0, y, 0.0), **real) for y in across * np.arange(-6, 7)]
    law = SpeedLaw(0.0, 0.0, 1.0, math.inf)  # widths are from a bead model
    found = deposit(toolpath([beads], law=law), edge=0.5)
    tops = np.array(
        [
            [
                first_air(found.grid, (x, y, 0.01), (0, 0, 1), 6.0)
                for y in np.linspace(-across, across, 21)[:-1]
            ]
            for x in np.linspace(-15.0, 15.0, 21)
        ]
    )
    assert abs(tops.mean() - WIDE * HIGH / across) < 0.03 * HIGH * WIDE / across
    profile = tops.mean(axis=0)
    assert np.ptp(profile) > 0.3 if valley else np.ptp(profile) < 0.1 * KNOWN * 0.5


@pytest.mark.parametrize("edge", [0.5, 0.9, 1.0])
def test_beads_of_several_widths_side_by_side_are_as_high(edge):
    """Each as wide as its room, without a bead model: six layers end flat, however cubes and pieces of beads are divided."""
    widths = np.array([6.0, 6.0, 4.0, 3.0, 5.0, 3.0, 4.0, 6.0, 6.0])
    middles = np.cumsum(widths) - 0.5 * widths
    layers = [
        [
            straight((-60.0, y, k * HIGH), (60.0, y, k * HIGH), width=np.full(40, wide))
            for y, wide in zip(middles, widths)
        ]
        for k in range(6)
    ]
    found = deposit(toolpath(layers), edge=edge)
    tops = np.array(
        [
            [
                first_air(found.grid, (x, y, 1.0), (0, 0, 1), 20.0) + 1.0
                for y in np.linspace(8.0, widths.sum() - 8.0, 40)
            ]
            for x in np.linspace(-25.0, 25.0, 40)
        ]
    )
    assert np.abs(tops - 6.0 * HIGH).max() < 0.2 * HIGH


@pytest.mark.parametrize("share", [0.85, 1.1])
def test_what_the_wire_feeds_makes_the_height(share):
    """A ring fed less or more than its layers take: each comes out lower or higher by that share, and the ninth is off by
    nine times it, which is told with the height to plan."""
    process = ProcessParameters()
    feed = share * WIDE * HIGH * SPEED / process.wire.section
    path = toolpath([[ring(40.0, k * HIGH)] for k in range(9)], wire_feed=feed)
    found = deposit(path, process)
    expected = (share - 1.0) * HIGH * np.arange(1, 10)
    assert np.abs(found.drift - expected).max() < 0.25
    assert abs(np.polyfit(np.arange(9), found.drift, 1)[0] - (share - 1.0) * HIGH) < 0.02 * HIGH
    first = np.arange(9) == 0
    shape = compare.figures(
        found, compare.compare_deposit(found, faces(*tube(38.0, 42.0, 14.0))), 0.0
    )
    drift = next(
        one
        for one in compare.issues(shape, path.layer_heights, first, "{}")
        if one.code == compare.DRIFT
    )
    assert drift.layer == 8 and ("below" in drift.message) == (share < 1.0)
    told = float(drift.message.split("set strategy.layer_height to ")[1].split(" mm")[0])
    assert abs(told - share * HIGH) < 0.03 * HIGH


def test_layers_sink_by_what_their_ends_and_overhangs_take():
    """Fed as much as they have room for on their path, rings stay as high as planned. Open beads are rounded past their
    ends, and layers sink by just what lies there; where each hangs over the one below they sink more."""
    count, wide, long = 10, 5.0, 40.0
    round_about = deposit(toolpath([[ring(40.0, k * HIGH)] for k in range(count)]), edge=0.75)
    assert abs(np.polyfit(np.arange(count), round_about.drift, 1)[0]) < 0.01 * HIGH

    def slab(aside):
        return deposit(
            toolpath(
                [
                    [
                        straight((0.0, y + aside * k, k * HIGH), (long, y + aside * k, k * HIGH))
                        for y in wide * np.arange(4)
                    ]
                    for k in range(count)
                ],
                width=wide,
            ),
            edge=0.5,
        )

    upright = slab(0.0)
    x, _, _ = upright.grid.centres(np.arange(len(upright.grid.filled))).T
    ends = (x < 0.0) | (x > long)
    taken = float(upright.grid.filled[ends].sum()) * upright.grid.edge**3 / count  # mm3 of a layer
    slope = np.polyfit(np.arange(2, 8), upright.drift[2:8], 1)[0]
    assert 0.04 * HIGH < -slope < 0.1 * HIGH
    assert abs(-slope * long * 4.0 * wide - taken) < 0.1 * taken
    sunk = [float(slab(aside).drift[-1]) for aside in (0.5, 1.0, 2.0)]
    assert upright.drift[-1] > sunk[0] > sunk[1] > sunk[2]


def test_where_the_part_sticks_out_is_told():
    """A block filled to its border but with a boss on one side that no bead lies in: the boss is named, how far it stands
    out of the deposit, and what to do."""
    layers = [
        [straight((2.5, y, k * HIGH), (57.5, y, k * HIGH)) for y in np.arange(2.5, 40.0, 5.0)]
        for k in range(8)
    ]
    found = deposit(toolpath(layers, width=5.0, family="solid"))
    inner, boss = (
        box((12.0, 4.0, 0.0), (48.0, 36.0, 13.0)),
        box((26.0, 36.0, 4.0), (34.0, 46.0, 10.0)),
    )
    told = compare.compare_deposit(found, faces(*inner))
    assert told.faces.normals[:, 2].min() > -0.5  # what it stands on is not machined
    shape = compare.figures(found, told, 0.5)
    assert shape.least > 0.5 and not compare.issues(
        shape, np.full(8, HIGH), np.arange(8) == 0, "{}"
    )
    both = compare.compare_deposit(
        found, faces(np.vstack([inner[0], boss[0]]), np.vstack([inner[1], boss[1] + 8]))
    )
    shape = compare.figures(found, both, 0.5)
    # its outer end is at y = 46, and the outermost bead reaches to y = 40
    end = both.faces.normals[:, 1] > 0.9
    end &= both.faces.points[:, 1] > 45.0
    assert np.abs(both.deviation[end] + 6.0).max() < 2.0 * KNOWN
    issue = compare.issues(shape, np.full(8, HIGH), np.arange(8) == 0, "Add {} mm")[-1]
    assert (
        issue.code == compare.CODE
        and 1 <= issue.layer <= 5
        and "the part protrudes by 6" in issue.message
    )
    assert shape.worst[1] > 36.0 and 25.9 < shape.worst[0] < 34.1
    area = both.faces.areas
    assert (
        abs(
            shape.outside
            - area[both.deviation < -compare.KNOWN * found.grid.edge].sum() / area.sum()
        )
        < 1e-12
    )


def test_of_an_open_face_the_side_with_less_counts():
    """A sheet 1 mm beside the middle of a wall of 6 mm has 2 mm on its one side and 4 on the other."""
    found = deposit(
        toolpath([[straight((-60, 0, k * HIGH), (60, 0, k * HIGH))] for k in range(8)]), edge=0.75
    )
    sheet = np.array([(-40, 1, 2), (40, 1, 2), (40, 1, 11), (-40, 1, 11)], float)
    for turned in (1, -1):
        told = compare.compare_deposit(
            found, faces(sheet, np.array([(0, 1, 2), (0, 2, 3)])[:, ::turned], BOTH)
        )
        assert np.abs(told.deviation - 2.0).max() < KNOWN * 0.75
        assert np.allclose(told.surface[:, 1], 3.0, atol=KNOWN * 0.75)


def test_an_allowance_is_a_length_from_nothing_on():
    with pytest.raises(InputError, match="machining_allowance"):
        ProcessParameters(machining_allowance=-1.0)


def helix(radius, turns, sides=120):
    """A spiral as parts of revolution have them: a flat first turn, rising ones, a flat last one."""
    angle = np.linspace(0.0, 2.0 * math.pi * (turns + 2), sides * (turns + 2) + 1)
    height = HIGH * np.clip(angle / (2.0 * math.pi) - 1.0, 0.0, turns)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    up = np.broadcast_to([0.0, 0.0, 1.0], points.shape)
    return Bead(points, up, up, angle, np.full(len(angle), SPEED), False)


@pytest.mark.parametrize("feed", [1.0, 1.2])
def test_turns_of_a_spiral_are_as_high_as_layers(feed):
    """Turn by turn; with a fifth more wire the last of 10 rising turns is two layer heights too high."""
    fed = WireParameters(1.2, SPEED * WIDE * HIGH * feed / (math.pi * 0.36))
    process = ProcessParameters(wire=fed)
    layers = toolpath([[ring(30.0, HIGH * k)] for k in range(11)], wire_feed=fed.feed)
    spiral = toolpath([[helix(30.0, 11)]], wire_feed=fed.feed, family="revolution")
    turns, rings = deposit(spiral, process), deposit(layers, process)
    assert turns.fed == pytest.approx(13 / 11 * rings.fed, rel=2e-3)
    assert turns.deposited == pytest.approx(turns.fed, rel=1e-6)
    grown = rings.drift[-1] - rings.drift[0]
    assert turns.drift == pytest.approx([grown], abs=0.2 * HIGH)
    assert grown == pytest.approx((feed - 1.0) * 10 * HIGH, abs=0.2 * HIGH)
