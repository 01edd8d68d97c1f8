# SPDX-License-Identifier: LGPL-2.1-or-later
"""The predicted deposit: its volume against the wire feed, and walls, tubes, layers on a cylinder
and filled blocks against formulas of their shape."""

import math

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.process.shape import compare
from freecad_am.core.process.shape.compare import BOTH, faces
from freecad_am.core.process.shape.laying import feature_parts, predicted_deposit
from freecad_am.core.toolpath import Bead, Layer, SpeedLaw, Toolpath

WIDTH_MM, HEIGHT_MM, SPEED = 6.0, 2.0, 8.0
TOLERANCE_SHARE = 0.35  # share of a voxel edge: maximum error of one surface position; the mean error is a tenth of it
PROCESS = ProcessParameters()


def bead(points, build=(0.0, 0.0, 1.0), closed=False, **options):
    points = np.asarray(points, float)
    if closed:
        points[-1] = points[0]
    up = np.broadcast_to(np.asarray(build, float), points.shape)
    speed = options.pop("speed", np.full(len(points), SPEED))
    return Bead(
        points=points,
        build=up,
        tool=up,
        parameter=np.linspace(0.0, 2.0 * math.pi, len(points)),
        speed=speed,
        closed=closed,
        **options,
    )


def straight(start, end, count=40, **options):
    share = np.linspace(0.0, 1.0, count)[:, None]
    return bead(
        (1.0 - share) * np.asarray(start, float) + share * np.asarray(end, float), **options
    )


def ring(radius, height, count=241, **options):
    angle = np.linspace(0.0, 2.0 * math.pi, count)
    points = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=1
    )
    return bead(points, closed=True, **options)


def toolpath(layers, height=HEIGHT_MM, width=WIDTH_MM, **options):
    return Toolpath(
        tuple(Layer(tuple(beads)) for beads in layers),
        np.eye(4),
        height,
        0.01,
        bead_width=width,
        **options,
    )


def deposit(path, process=PROCESS, edge=None):
    return predicted_deposit(
        feature_parts(path, [process] * len(path.parts)), lambda share, text: None, edge
    )


def box(low, high):
    """Outward triangles of a box."""
    corners = np.array(
        [[(low, high)[k >> axis & 1][axis] for axis in range(3)] for k in range(8)], float
    )
    squares = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))
    return corners, np.array(
        [(a, b, c) for a, b, c, _ in squares] + [(a, c, d) for a, _, c, d in squares]
    )


def tube(inner, outer, height, sides=720):
    """Triangles of the two round faces of a tube, facing away from its wall."""
    angle = np.linspace(0.0, 2.0 * math.pi, sides, endpoint=False)
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(sides)], axis=1)
    up = np.array([0.0, 0.0, height])
    points = np.concatenate(
        [outer * circle, outer * circle + up, inner * circle, inner * circle + up]
    )
    k, following = np.arange(sides), np.roll(np.arange(sides), -1)
    outer_faces = np.concatenate(
        [
            np.stack([k, following, sides + following], 1),
            np.stack([k, sides + following, sides + k], 1),
        ]
    )
    return points, np.concatenate([outer_faces, outer_faces[:, ::-1] + 2 * sides])


def first_air(grid, start, direction, reach):
    """Distance from a point to the end of the deposit along a direction, in steps of a hundredth of
    a voxel."""
    steps = np.arange(0.0, reach, 0.01 * grid.edge)
    air = grid.fill_at(np.asarray(start) + steps[:, None] * np.asarray(direction)) < 0.5
    return steps[np.argmax(air)]


def mixed_layers(rng):
    """Walls, rings that cross them and repeated beads, of several widths and speeds, in inclined
    layers."""
    lean = np.array([0.2, -0.1, 1.0]) / math.sqrt(1.05)
    for k in range(4):
        origin = HEIGHT_MM * k * lean
        speed = np.r_[5.0, rng.uniform(5.0, 12.0, 39)]
        yield [
            straight(origin, origin + [50.0, 9.0, 0.0], build=lean, speed=speed),
            straight(origin + [0, 9, 0], origin + [50, 0, 0], build=lean),
            bead(
                ring(14.0, 0.0).points + origin + [25.0, 5.0, 0.0],
                build=lean,
                closed=True,
                width=rng.uniform(4.0, 8.0, 241),
                height=np.full(241, HEIGHT_MM),
            ),
            straight(origin, origin + [50.0, 9.0, 0.0], build=lean, speed=speed),
        ]


@pytest.mark.parametrize("feed", [0.0, 31.0])
def test_it_holds_what_is_fed(feed):
    """Sum the fill over a lattice offset from the voxels: interpolation between voxel centres is
    linear, so the sum is theirs. The fed volume comes from the wire section and time, or from width
    x height x length of every segment."""
    path = toolpath(mixed_layers(np.random.default_rng(15)), wire_feed=feed)
    predicted = deposit(path, ProcessParameters(wire=WireParameters(diameter=1.6)))
    fed = 0.0
    for layer in path.layers:
        for fed_bead in layer.beads:
            for k in range(1, len(fed_bead)):
                step = math.dist(fed_bead.points[k - 1], fed_bead.points[k])
                counted = (
                    WIDTH_MM * HEIGHT_MM
                    if fed_bead.width is None
                    else 0.5 * HEIGHT_MM * (fed_bead.width[k - 1] + fed_bead.width[k])
                )
                fed += (
                    step / fed_bead.speed[k] * math.pi * 0.8**2 * feed if feed else step * counted
                )
    edge = predicted.grid.edge
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
    assert abs(edge**3 * predicted.grid.fill_at(lattice).sum() / fed - 1.0) < 1e-9
    assert abs(predicted.fed / fed - 1.0) < 1e-9 and abs(predicted.deposited / fed - 1.0) < 1e-9
    assert predicted.grid.filled.min() >= 0.0 and predicted.grid.filled.max() <= 1.0 + 1e-12


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_one_bead_alone_is_a_parabola(turn):
    """A single bead is a parabola: as wide as nominal, half as high again as its mean; round ends
    affect no more than their own width."""
    direction, side = (
        np.array([math.cos(turn), math.sin(turn), 0.0]),
        np.array([-math.sin(turn), math.cos(turn), 0.0]),
    )
    predicted = deposit(toolpath([[straight(-60.0 * direction, 60.0 * direction)]]), edge=0.5)
    for aside in (0.0, 0.5, 1.0, 1.5, 2.0):
        up = first_air(predicted.grid, aside * side, (0, 0, 1), 6.0)
        assert (
            abs(up - 1.5 * HEIGHT_MM * (1.0 - (2.0 * aside / WIDTH_MM) ** 2))
            < TOLERANCE_SHARE * 0.5
        ), aside


@pytest.mark.parametrize("turn", [0.0, 0.5])
def test_a_wall_has_straight_sides_and_a_round_top(turn):
    """The sides are half a width from the middle, every layer adds one layer height, and the top is
    the parabola."""
    direction, side = (
        np.array([math.cos(turn), math.sin(turn), 0.0]),
        np.array([-math.sin(turn), math.cos(turn), 0.0]),
    )
    layers = [
        [
            straight(
                (0, 0, k * HEIGHT_MM) - 80.0 * direction, (0, 0, k * HEIGHT_MM) + 80.0 * direction
            )
        ]
        for k in range(6)
    ]
    predicted = deposit(toolpath(layers), edge=0.5)
    for height in (2.0, 5.0, 8.0, 9.0):
        for sense in (1.0, -1.0):
            assert (
                abs(first_air(predicted.grid, (0, 0, height), sense * side, 6.0) - 0.5 * WIDTH_MM)
                < TOLERANCE_SHARE * 0.5
            )
    for aside in (0.0, 1.0, 2.0):
        tops = [
            5.0
            + first_air(
                predicted.grid,
                np.array([0, 0, 5.0]) + along * direction + aside * side,
                (0, 0, 1),
                15.0,
            )
            for along in np.linspace(-9.0, 9.0, 19)
        ]
        formula = 6 * HEIGHT_MM + 0.5 * HEIGHT_MM - 1.5 * HEIGHT_MM * (2.0 * aside / WIDTH_MM) ** 2
        assert abs(np.mean(tops) - formula) < 0.1 * HEIGHT_MM and (
            aside > 1.0 or np.ptp(tops) < 0.25 * HEIGHT_MM
        )


def test_a_tube_is_known_from_both_faces():
    """A tube 3 mm thick leaves 1.5 mm of the 6 mm beads on either side, and a closed wall loses no
    height."""
    predicted = deposit(toolpath([[ring(30.0, k * HEIGHT_MM)] for k in range(8)]), edge=0.75)
    comparison = compare.compare_deposit(predicted, faces(*tube(28.5, 31.5, 15.0)))
    middle = comparison.faces.points[:, 2] < 12.0
    assert len(comparison.deviation) > 5000 and not comparison.bare.any()
    assert np.abs(comparison.deviation[middle] - 1.5).max() < TOLERANCE_SHARE * 0.75
    shape = compare.figures(predicted, comparison, 1.5 - TOLERANCE_SHARE * 0.75)
    # the round top leaves less at its edge: h / 2 above the last layer, less the fall of the
    # parabola
    top = 16.0 + 1.0 - 1.5 * HEIGHT_MM * (1.5 / 3.0) ** 2
    assert top > 15.0 and shape.outside == 0.0 and shape.least > 0.0
    assert np.abs(shape.drift - shape.drift[0]).max() < 0.15


def test_layers_on_a_cylinder_grow_by_what_is_fed():
    """Rings next to each other along a roller, built outwards: the radius follows from the volume
    of all rings."""

    def layer(k):
        rings = []
        for x in np.arange(2.0, 40.0, 4.0):
            angle = np.linspace(0.0, 2.0 * math.pi, 361)
            out = np.stack([np.zeros(361), np.cos(angle), np.sin(angle)], axis=1)
            out[-1] = out[0]
            rings.append(bead((40.0 + HEIGHT_MM * k) * out + [x, 0, 0], build=out, closed=True))
        return rings

    predicted = deposit(toolpath([layer(k) for k in range(3)], width=4.0), edge=0.75)
    squared = 40.0**2 + 2.0 * HEIGHT_MM * sum(40.0 + HEIGHT_MM * k for k in range(3))
    directions = [
        (0.0, math.cos(angle), math.sin(angle)) for angle in np.linspace(0.0, 2.0 * math.pi, 60)
    ]
    for x in (14.0, 16.0, 19.0, 22.0, 26.0):
        outer = [
            40.5
            + first_air(
                predicted.grid, np.array([x, 0, 0]) + 40.5 * np.array(direction), direction, 9.0
            )
            for direction in directions
        ]
        assert np.abs(np.array(outer) - math.sqrt(squared)).max() < TOLERANCE_SHARE * 0.75
        assert abs(np.mean(outer) - math.sqrt(squared)) < 0.1 * TOLERANCE_SHARE * 0.75


@pytest.mark.parametrize(("pitch", "valley"), [(0.7, 0.0), (0.738, 0.0), (0.9, 1.0)])
@pytest.mark.always("0.738-0.0", "0.9-1.0")
def test_the_area_is_kept_where_beads_overlap(pitch, valley):
    """In the middle of many beads the mean height is their section over their distance; up to 0.738
    widths apart the surface is flat, beyond that valleys remain."""
    across = pitch * WIDTH_MM
    real = {"width": np.full(40, WIDTH_MM), "height": np.full(40, HEIGHT_MM)}
    beads = [straight((-60.0, y, 0.0), (60.0, y, 0.0), **real) for y in across * np.arange(-6, 7)]
    law = SpeedLaw(0.0, 0.0, 1.0, math.inf)  # widths come from a bead model
    predicted = deposit(toolpath([beads], law=law), edge=0.5)
    tops = np.array(
        [
            [
                first_air(predicted.grid, (x, y, 0.01), (0, 0, 1), 6.0)
                for y in np.linspace(-across, across, 21)[:-1]
            ]
            for x in np.linspace(-15.0, 15.0, 21)
        ]
    )
    assert abs(tops.mean() - WIDTH_MM * HEIGHT_MM / across) < 0.03 * HEIGHT_MM * WIDTH_MM / across
    profile = tops.mean(axis=0)
    assert np.ptp(profile) > 0.3 if valley else np.ptp(profile) < 0.1 * TOLERANCE_SHARE * 0.5


@pytest.mark.parametrize("edge", [0.5, 0.9, 1.0])
def test_beads_of_several_widths_side_by_side_are_as_high(edge):
    """Each bead fills its space without a bead model: six layers end flat, however voxels and bead
    segments are divided."""
    widths = np.array([6.0, 6.0, 4.0, 3.0, 5.0, 3.0, 4.0, 6.0, 6.0])
    middles = np.cumsum(widths) - 0.5 * widths
    layers = [
        [
            straight((-60.0, y, k * HEIGHT_MM), (60.0, y, k * HEIGHT_MM), width=np.full(40, wide))
            for y, wide in zip(middles, widths)
        ]
        for k in range(6)
    ]
    predicted = deposit(toolpath(layers), edge=edge)
    tops = np.array(
        [
            [
                first_air(predicted.grid, (x, y, 1.0), (0, 0, 1), 20.0) + 1.0
                for y in np.linspace(8.0, widths.sum() - 8.0, 40)
            ]
            for x in np.linspace(-25.0, 25.0, 40)
        ]
    )
    assert np.abs(tops - 6.0 * HEIGHT_MM).max() < 0.2 * HEIGHT_MM


@pytest.mark.parametrize("share", [0.85, 1.1])
def test_what_the_wire_feeds_makes_the_height(share):
    """The wire feed determines the height: each layer of the ring is lower or higher by the share,
    the ninth by nine times as much, and the message states the layer height to plan."""
    process = ProcessParameters()
    feed = share * WIDTH_MM * HEIGHT_MM * SPEED / process.wire.section
    path = toolpath([[ring(40.0, k * HEIGHT_MM)] for k in range(9)], wire_feed=feed)
    predicted = deposit(path, process)
    expected = (share - 1.0) * HEIGHT_MM * np.arange(1, 10)
    assert np.abs(predicted.drift - expected).max() < 0.25
    assert (
        abs(np.polyfit(np.arange(9), predicted.drift, 1)[0] - (share - 1.0) * HEIGHT_MM)
        < 0.02 * HEIGHT_MM
    )
    is_first = np.arange(9) == 0
    shape = compare.figures(
        predicted, compare.compare_deposit(predicted, faces(*tube(38.0, 42.0, 14.0))), 0.0
    )
    drift = next(
        issue
        for issue in compare.issues(shape, path.layer_heights, is_first, "{}")
        if issue.code == compare.DRIFT
    )
    assert drift.layer == 8 and ("below" in drift.message) == (share < 1.0)
    proposed_height = float(drift.message.split("set strategy.layer_height to ")[1].split(" mm")[0])
    assert abs(proposed_height - share * HEIGHT_MM) < 0.03 * HEIGHT_MM


def test_layers_sink_by_what_their_ends_and_overhangs_take():
    """Rings with the required feed keep their planned height. Open beads are rounded beyond their
    ends, and layers sink by just that volume; overhanging layers sink more."""
    count, wide, long = 10, 5.0, 40.0
    round_about = deposit(toolpath([[ring(40.0, k * HEIGHT_MM)] for k in range(count)]), edge=0.75)
    assert abs(np.polyfit(np.arange(count), round_about.drift, 1)[0]) < 0.01 * HEIGHT_MM

    def slab(aside):
        return deposit(
            toolpath(
                [
                    [
                        straight(
                            (0.0, y + aside * k, k * HEIGHT_MM),
                            (long, y + aside * k, k * HEIGHT_MM),
                        )
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
    end_volume = (
        float(upright.grid.filled[ends].sum()) * upright.grid.edge**3 / count
    )  # mm3 of a layer
    slope = np.polyfit(np.arange(2, 8), upright.drift[2:8], 1)[0]
    assert 0.04 * HEIGHT_MM < -slope < 0.1 * HEIGHT_MM
    assert abs(-slope * long * 4.0 * wide - end_volume) < 0.1 * end_volume
    sunk = [float(slab(aside).drift[-1]) for aside in (0.5, 1.0, 2.0)]
    assert upright.drift[-1] > sunk[0] > sunk[1] > sunk[2]


def test_where_the_part_sticks_out_is_told():
    """A block filled to its border with a boss outside all beads: the message states the boss, how
    far it protrudes from the deposit, and the remedy."""
    layers = [
        [
            straight((2.5, y, k * HEIGHT_MM), (57.5, y, k * HEIGHT_MM))
            for y in np.arange(2.5, 40.0, 5.0)
        ]
        for k in range(8)
    ]
    predicted = deposit(toolpath(layers, width=5.0, family="solid"))
    inner, boss = (
        box((12.0, 4.0, 0.0), (48.0, 36.0, 13.0)),
        box((26.0, 36.0, 4.0), (34.0, 46.0, 10.0)),
    )
    comparison = compare.compare_deposit(predicted, faces(*inner))
    assert comparison.faces.normals[:, 2].min() > -0.5  # the base is not machined
    shape = compare.figures(predicted, comparison, 0.5)
    assert shape.least > 0.5 and not compare.issues(
        shape, np.full(8, HEIGHT_MM), np.arange(8) == 0, "{}"
    )
    with_boss = compare.compare_deposit(
        predicted, faces(np.vstack([inner[0], boss[0]]), np.vstack([inner[1], boss[1] + 8]))
    )
    shape = compare.figures(predicted, with_boss, 0.5)
    # the boss ends at y = 46, the outermost bead reaches y = 40
    end = with_boss.faces.normals[:, 1] > 0.9
    end &= with_boss.faces.points[:, 1] > 45.0
    assert np.abs(with_boss.deviation[end] + 6.0).max() < 2.0 * TOLERANCE_SHARE
    issue = compare.issues(shape, np.full(8, HEIGHT_MM), np.arange(8) == 0, "Add {} mm")[-1]
    assert (
        issue.code == compare.CODE
        and 1 <= issue.layer <= 5
        and "the part protrudes by 6" in issue.message
    )
    assert shape.worst[1] > 36.0 and 25.9 < shape.worst[0] < 34.1
    area = with_boss.faces.areas
    assert (
        abs(
            shape.outside
            - area[with_boss.deviation < -compare.KNOWN * predicted.grid.edge].sum() / area.sum()
        )
        < 1e-12
    )


def test_of_an_open_face_the_side_with_less_counts():
    """For a sheet 1 mm off the middle of a 6 mm wall the thinner side of 2 mm counts, not the 4 mm
    of the other."""
    predicted = deposit(
        toolpath([[straight((-60, 0, k * HEIGHT_MM), (60, 0, k * HEIGHT_MM))] for k in range(8)]),
        edge=0.75,
    )
    sheet = np.array([(-40, 1, 2), (40, 1, 2), (40, 1, 11), (-40, 1, 11)], float)
    for turned in (1, -1):
        comparison = compare.compare_deposit(
            predicted, faces(sheet, np.array([(0, 1, 2), (0, 2, 3)])[:, ::turned], BOTH)
        )
        assert np.abs(comparison.deviation - 2.0).max() < TOLERANCE_SHARE * 0.75
        assert np.allclose(comparison.surface[:, 1], 3.0, atol=TOLERANCE_SHARE * 0.75)


def test_an_allowance_is_a_length_from_nothing_on():
    with pytest.raises(InputError, match="machining_allowance"):
        ProcessParameters(machining_allowance=-1.0)


def helix(radius, turns, sides=120):
    """A spiral as planned for parts of revolution: a flat first turn, rising turns, a flat last
    one."""
    angle = np.linspace(0.0, 2.0 * math.pi * (turns + 2), sides * (turns + 2) + 1)
    height = HEIGHT_MM * np.clip(angle / (2.0 * math.pi) - 1.0, 0.0, turns)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    up = np.broadcast_to([0.0, 0.0, 1.0], points.shape)
    return Bead(points, up, up, angle, np.full(len(angle), SPEED), False)


@pytest.mark.parametrize("feed", [1.0, 1.2])
def test_turns_of_a_spiral_are_as_high_as_layers(feed):
    """With a fifth more wire the last of 10 rising turns is two layer heights too high."""
    fed = WireParameters(1.2, SPEED * WIDTH_MM * HEIGHT_MM * feed / (math.pi * 0.36))
    process = ProcessParameters(wire=fed)
    layers = toolpath([[ring(30.0, HEIGHT_MM * k)] for k in range(11)], wire_feed=fed.feed)
    spiral = toolpath([[helix(30.0, 11)]], wire_feed=fed.feed, family="revolution")
    turns, rings = deposit(spiral, process), deposit(layers, process)
    assert turns.fed == pytest.approx(13 / 11 * rings.fed, rel=2e-3)
    assert turns.deposited == pytest.approx(turns.fed, rel=1e-6)
    grown = rings.drift[-1] - rings.drift[0]
    assert turns.drift == pytest.approx([grown], abs=0.2 * HEIGHT_MM)
    assert grown == pytest.approx((feed - 1.0) * 10 * HEIGHT_MM, abs=0.2 * HEIGHT_MM)
