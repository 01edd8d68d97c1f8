# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads over nothing: against lengths that follow from how beads were put, and against every pair of places tried."""

import dataclasses
import math
import re

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc, line
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.obstacles import Body, disc
from freecad_am.core.geometry.on_hub import Base, Group, SolidsOnHub
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.filled import DevelopableParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.process.deposit import support as pieces_of_beads
from freecad_am.core.strategies import support
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.core.strategies.solids.plan import plan as plan_solids
from freecad_am.core.toolpath import Bead, BeadRole, Layer, Toolpath

WIDTH, HEIGHT = 8.0, 2.0
UP = np.array([0.0, 0.0, 1.0])


def bead(points, closed=False, build=UP, closing=False):
    points = np.asarray(points, dtype=float)
    n = len(points)
    along = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    build = np.broadcast_to(build, (n, 3))
    return Bead(
        points, build, build, along, np.full(n, 6.0), closed, role=BeadRole(closing=closing)
    )


def rod(low, high, y=0.0, z=0.0):
    return bead([[low, y, z], [high, y, z]])


def toolpath(*layers, family="surface", height=HEIGHT, width=WIDTH):
    made = tuple(Layer(tuple(beads)) for beads in layers)
    return Toolpath(made, np.eye(4), height, 0.01, family=family, bead_width=width)


def told(path, planes=(), bodies=(), bases=()):
    """Length over nothing, and the issues."""
    found = support.check_support(path, planes, bodies, bases)
    return found.checks.unsupported, [
        issue for issue in found.issues if issue.code == "UNSUPPORTED"
    ]


@pytest.mark.parametrize(
    "aside, over", [(0.0, 0.0), (0.45 * WIDTH, 0.0), (0.7 * WIDTH, 100.0), (-0.7 * WIDTH, 100.0)]
)
def test_a_bead_may_overhang_by_half_of_its_width(aside, over):
    length, issues = told(toolpath([rod(0, 100)], [rod(0, 100, aside, HEIGHT)]))
    assert length == pytest.approx(over)
    assert [(issue.level, issue.layer, issue.bead, issue.point) for issue in issues] == [
        ("warning", 1, 0, 0)
    ] * bool(over)


@pytest.mark.parametrize(
    "rise, over", [(0.5, 0.0), (1.0, 0.0), (1.4, 0.0), (1.6, 100.0), (20.0, 100.0)]
)
def test_what_is_below_is_no_farther_than_one_and_a_half_layers(rise, over):
    assert told(toolpath([rod(0, 100)], [rod(0, 100, 0.0, rise * HEIGHT)]))[0] == pytest.approx(
        over
    )


@pytest.mark.parametrize("ground", ["plane", "body"])
def test_ground_a_layer_below_carries_the_first_layer_alone(ground):
    """A flange over the platform, a layer above it on a narrower foot: its second layer hangs over air as high as one."""
    path = toolpath(
        [rod(0, 100)], [rod(0, 100, 0.0, HEIGHT), rod(0, 100, 20.0, HEIGHT)], family="solid"
    )
    planes, bodies = (
        ((np.eye(4),), ()) if ground == "plane" else ((), (disc(400.0, np.eye(4), "plate"),))
    )
    length, issues = told(path, planes, bodies)
    assert length == pytest.approx(100.0)
    assert [(issue.layer, issue.bead) for issue in issues] == [(1, 1)]
    assert told(toolpath([rod(0, 100, 0.0, HEIGHT)], family="solid"), planes, bodies)[0] == 0.0
    half = toolpath(
        [rod(0, 100)], [rod(0, 100, 20.0, 0.6 * HEIGHT)], family="solid"
    )  # beside a slope there are such steps
    assert told(half, planes, bodies)[0] == 0.0


def test_ground_a_layer_below_carries_what_begins_there():
    """The first layer of another solid, and of a second object that a slicer lays after the first one."""
    plate = disc(400.0, np.eye(4), "plate")
    rods = [(rod(0, 100, aside, 0.9 * HEIGHT),) for aside in (0.0, 60.0)]
    solids = toolpath(*rods, family="solid")
    assert told(solids, (), (plate,))[0] == pytest.approx(100.0)
    begun = dataclasses.replace(solids, layers=tuple(Layer(beads, first=True) for beads in rods))
    assert told(begun, (), (plate,)) == (0.0, [])
    assert told(dataclasses.replace(solids, family="curves"), (), (plate,)) == (0.0, [])


def test_beside_is_not_below_and_neither_is_later_or_above():
    over = [
        [rod(0, 100)],
        [rod(0, 100, 40.0, 2.0), rod(0, 100, 46.0, 2.0)],
        [rod(0, 100, 40.0, 0.0)],
    ]
    length, issues = told(toolpath(*over))
    assert length == pytest.approx(300.0)
    assert [(issue.layer, issue.bead) for issue in issues] == [(1, 0), (2, 0)]


def test_a_seam_between_beads_is_no_gap_but_a_gap_is_one():
    """Two beads below, ever farther apart, and one over the middle between them."""
    for apart, over in ((1.0 * WIDTH, 0.0), (1.4 * WIDTH, 0.0), (1.8 * WIDTH, 100.0)):
        below = [rod(0, 100, -0.5 * apart), rod(0, 100, 0.5 * apart)]
        assert told(toolpath(below, [rod(0, 100, 0.0, HEIGHT)]))[0] == pytest.approx(over), apart


def test_the_free_end_of_a_bead_is_told_by_its_length():
    """The bead below ends at 70 mm and is half a width longer than its points."""
    length, (issue,) = told(toolpath([rod(0, 70)], [rod(0, 100, 0.0, HEIGHT)]))
    assert length == pytest.approx(30.0 - 0.5 * WIDTH, abs=0.2 * WIDTH)
    assert f"{length:.4g} mm of bead are unsupported" in issue.message
    assert told(toolpath([rod(0, 94)], [rod(0, 100, 0.0, HEIGHT)]))[0] == 0.0
    assert told(toolpath([rod(0, 89)], [rod(0, 100, 0.0, HEIGHT)]))[0] == pytest.approx(
        11.0 - 0.5 * WIDTH, abs=0.2 * WIDTH
    )


def test_gaps_no_longer_than_a_width_are_bridged():
    for gap, bridged in ((1.5 * WIDTH, True), (2.5 * WIDTH, False), (4.0 * WIDTH, False)):
        below = [rod(0, 50 - 0.5 * gap), rod(50 + 0.5 * gap, 100)]
        length, _ = told(toolpath(below, [rod(0, 100, 0.0, HEIGHT)]))
        assert length == pytest.approx(0.0 if bridged else gap - WIDTH, abs=0.2 * WIDTH)


def test_platform_body_and_hub_carry():
    path = toolpath([rod(0, 100, 0.0, 1.0)], family="developable")
    block = np.array([[x, y, z] for x in (0.0, 60.0) for y in (-20.0, 20.0) for z in (-5.0, 0.0)])
    sides = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 7, 5),
        (4, 6, 7),
        (0, 5, 1),
        (0, 4, 5),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
        (1, 5, 7),
        (1, 7, 3),
    ]
    assert told(path)[0] == pytest.approx(100.0)
    assert told(path, planes=(np.eye(4),))[0] == 0.0
    assert told(path, bodies=(Body("block", block, np.array(sides)),))[0] == pytest.approx(
        40.0, abs=0.4 * WIDTH
    )
    low = np.eye(4)
    low[2, 3] = -2.5
    assert told(path, planes=(low,))[0] == pytest.approx(100.0)
    hub = Base(
        "hub",
        Developable(49.0),
        np.array([[0.0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, -49.0], [0, 0, 0, 1]]),
    )
    assert told(path, bases=(hub,))[0] == 0.0


def test_beads_that_close_gaps_lie_on_what_is_beside_them():
    ring = [rod(0, 100, -2.5), rod(0, 100, 2.5)]
    close = bead([[0, 0, 0.5], [100, 0, 0.5]], closing=True)
    assert told(toolpath([rod(0, 100, 30.0)], ring, [close]), planes=())[0] == pytest.approx(200.0)


def spiral(pitch, height, turns=6):
    angle = np.linspace(0.0, 2.0 * np.pi * turns, 200 * turns + 1)
    points = np.stack(
        [30.0 * np.cos(angle), 30.0 * np.sin(angle), pitch * angle / (2.0 * np.pi)], axis=1
    )
    return toolpath([bead(points)], family="revolution", height=height)


def test_a_spiral_lies_on_itself():
    assert told(spiral(2.0, 2.0), (np.eye(4),))[0] == 0.0
    length, _ = told(spiral(4.0, 2.0), (np.eye(4),))
    round_ = math.hypot(2.0 * np.pi * 30.0, 4.0)
    assert length == pytest.approx(
        (6.0 - 3.0 / 4.0) * round_, abs=WIDTH
    )  # but what is within 3 mm of the platform


MERIDIANS = {
    "sphere": Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)]),
    "funnel": Meridian.chained([arc((90.0, 0.0), 45.0, np.pi, np.pi / 2)]),
    "bent": Meridian.chained([line((10.0, 0.0), (10.0, 5.0)), line((10.0, 5.0), (4.0, 13.0))]),
}


@pytest.mark.parametrize("path", ["layers", "spiral"])
@pytest.mark.parametrize("name", MERIDIANS)
def test_parts_of_revolution_stand(name, path):
    wall = RevolvedWall(MERIDIANS[name], np.eye(4), 0.0, 2.0 * np.pi, True)
    made = revolution.plan(
        wall,
        RevolutionParameters(path=path, layer_height=2.0),
        BuildDirectionParameters(),
        ProcessParameters(),
        NozzleParameters(),
        0.0,
    )
    assert told(made, (made.frame,)) == (0.0, [])


def mushroom():
    """A stem 20 mm long on a rod of radius 10 mm, and from radius 22 to 34 mm a cap 60 mm long: turned about the rod."""
    sides = 120
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    outline = [
        (5.0, 0.0),
        (22.0, 0.0),
        (22.0, -20.0),
        (34.0, -20.0),
        (34.0, 40.0),
        (22.0, 40.0),
        (22.0, 20.0),
        (5.0, 20.0),
    ]
    rows = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(sides, z)], axis=1)
        for r, z in outline
    ]
    a = np.arange(sides)
    b, faces = (a + 1) % sides, []
    for k in range(len(outline)):
        one, other = k * sides, (k + 1) % len(outline) * sides
        faces += [
            np.stack([one + a, other + b, one + b], axis=1),
            np.stack([one + a, other + a, other + b], axis=1),
        ]
    triangles = np.concatenate(faces)
    body = Body("mushroom", np.vstack(rows), triangles)
    corner = body.corners()
    volume = np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6.0
    return body if volume > 0.0 else Body("mushroom", np.vstack(rows), triangles[:, ::-1].copy())


@pytest.fixture(scope="module")
def mushroom_path():
    base = Base("the rod", Developable(10.0), np.eye(4))
    made = plan_solids(
        SolidsOnHub("part", (Group(base, (mushroom(),)),), 0.0),
        DevelopableParameters(
            layer_height=4.0, chord_error=0.05, bead_spacing=6.0, fill="lines", fill_angle_step=0.0
        ),
        BuildDirectionParameters(),
        ProcessParameters(),
        None,
    )
    return support.check_support(made, (), (), (base,))


def test_the_mushroom_is_told_with_its_length(mushroom_path):
    """Lines round the rod are rings; the first ones of the cap lie over nothing where the stem's do not reach."""
    layers = [
        [(bead.points[0, 2], np.hypot(*bead.points[0, :2]), bead.length) for bead in layer.beads]
        for layer in mushroom_path.layers
    ]
    first = next(k for k, layer in enumerate(layers) if min(z for z, _, _ in layer) < -3.0)
    below = np.array([z for z, _, _ in layers[first - 1]])
    over = [length for z, _, length in layers[first] if np.abs(below - z).min() > 4.0]
    assert len(over) == 6
    assert mushroom_path.checks.unsupported == pytest.approx(sum(over), rel=1e-9)
    assert mushroom_path.checks.unsupported == pytest.approx(
        6 * 2.0 * np.pi * layers[first][0][1], rel=2e-3
    )
    (issue,) = [one for one in mushroom_path.issues if one.code == "UNSUPPORTED"]
    assert issue.layer == first


def test_every_pair_of_places_tried_gives_the_same_length():
    """Random beads: each place of a bead against every other one that was there before."""
    rng = np.random.default_rng(4)
    layers = []
    for level in range(4):
        beads = []
        for _ in range(6):
            start = np.array([*rng.uniform(-40, 40, 2), level * HEIGHT])
            way = rng.uniform(0.0, 2.0 * np.pi)
            beads.append(
                bead(
                    [
                        start,
                        start + rng.uniform(60, 120) * np.array([np.cos(way), np.sin(way), 0.0]),
                    ]
                )
            )
        layers.append(beads)
    path = toolpath(*layers, family="revolution")
    step = 0.4
    places = []
    for level, beads in enumerate(layers):
        for one in beads:
            t = (np.arange(int(one.length / step)) + 0.5) * step / one.length
            places.append((level, one.points[0] + t[:, None] * (one.points[1] - one.points[0])))
    total = 0.0
    for level, mine in places:
        below = [others for at, others in places if at == level - 1]
        if not below:
            continue
        under, travel = np.vstack(below), (mine[-1] - mine[0]) / np.linalg.norm(mine[-1] - mine[0])
        across = np.cross(UP, travel)

        def held(at, under=under):
            return (
                np.linalg.norm(at[:, None, :2] - under[None, :, :2], axis=2).min(axis=1)
                <= 0.5 * WIDTH * 1.1 + 0.01
            )

        free = ~(
            held(mine) | (held(mine + 0.25 * WIDTH * across) & held(mine - 0.25 * WIDTH * across))
        )
        ends = np.flatnonzero(np.diff(np.r_[False, free, False].astype(int)))
        for a, b in ends.reshape(-1, 2):
            at_end = a == 0 or b == len(mine)
            total += (b - a) * step if (b - a) * step > (0.5 if at_end else 1.0) * WIDTH else 0.0
    ground = np.eye(4)
    ground[2, 3] = -HEIGHT  # the second layer is too high above it
    assert told(path, (ground,))[0] == pytest.approx(total, rel=0.04)


def test_pairs_that_are_looked_at_grow_as_the_number_of_points(monkeypatch):
    """Four times as many layers, no more than five times as many pairs of pieces; all of them over nothing."""
    looked = []

    def stack(count):
        angle = np.linspace(0.0, 2.0 * np.pi, 200)
        ring = np.stack([30.0 * np.cos(angle), 30.0 * np.sin(angle), 0.0 * angle], axis=1)
        ring[-1] = ring[0]
        return toolpath(
            *([bead(ring + k * 4.0 * UP, closed=True)] for k in range(count)), family="revolution"
        )

    def pairs(path):
        looked.clear()
        assert told(path, (np.eye(4),))[0] == pytest.approx(
            path.length * (1.0 - 1.0 / len(path.layers))
        )
        return sum(looked)

    below = pieces_of_beads._below

    def counted(pieces, mine, *rest):
        looked.append(len(mine))
        return below(pieces, mine, *rest)

    monkeypatch.setattr(pieces_of_beads, "_below", counted)
    few, many = stack(15), stack(60)
    of_few, of_many = pairs(few), pairs(many)
    assert 0 < of_many < 5.0 * of_few


def test_beads_that_tell_their_width_carry_no_farther():
    one = bead([[0, 0, 0], [100, 0, 0]])
    narrow = Bead(
        one.points, one.build, one.tool, one.parameter, one.speed, False, width=np.full(2, 2.0)
    )
    above = rod(0, 100, 2.0, HEIGHT)
    assert told(toolpath([one], [above]))[0] == 0.0
    assert told(toolpath([narrow], [above]))[0] == pytest.approx(100.0)


def test_beads_of_no_width_to_speak_of_take_no_memory():
    """The chord error bounds the number of pieces: 11 TB were asked for here. Above nothing all of the bead is told."""
    low, high = rod(0.0, 10.0), rod(0.0, 10.0, 0.0, HEIGHT)
    assert told(toolpath([low], [high], width=1e-9))[0] == 0.0
    assert told(toolpath([low], [rod(0.0, 10.0, 1.0, HEIGHT)], width=1e-9))[0] == pytest.approx(
        10.0
    )


@pytest.mark.parametrize(
    "lift, radius, over",
    [
        (0.0, 50.0, 200.0 - 2.0 * math.sqrt(54.0**2 - 20.0**2)),
        (0.0, 90.0, 200.0 - 2.0 * math.sqrt(94.0**2 - 20.0**2)),
        (0.0, 120.0, 0.0),
        (3.0, 50.0, 0.0),
    ],
)
def test_a_first_layer_over_the_edge_of_the_platform_is_told(lift, radius, over):
    """A bead of 200 mm, 20 mm from the middle of a disc: it may stand out by half of its width. What begins higher up is
    not the platform's."""
    frame = np.eye(4)
    frame[:3, 3] = 10.0, -20.0, 5.0
    path = toolpath([rod(-90, 110, 0.0, 5.0 + lift)], [rod(-90, 110, 0.0, 7.0 + lift)])
    found = support.over_edge(path, frame, 2.0 * radius, ())
    assert bool(found) == bool(over)
    if over:
        (issue,) = found
        length, most = (float(word) for word in re.findall(r"([\d.]+) mm", issue.message))
        assert (issue.code, issue.level, issue.layer, issue.bead) == (
            "OVER_PLATFORM",
            "warning",
            0,
            0,
        )
        assert length == pytest.approx(over, abs=2.0 * WIDTH * support.support.PIECE)
        assert most == pytest.approx(
            math.hypot(100.0, 20.0) - radius, abs=WIDTH * support.support.PIECE
        )


@pytest.mark.parametrize(
    ("family", "told_of"), [("solid", True), ("surface", False), ("developable", False)]
)
def test_a_solid_that_begins_beside_the_platform_and_below_it_is_told(family, told_of):
    """160 mm below the plane of the disc and 20 mm beside it; a wall or a hub may stand on what is not in the file."""
    path = toolpath(
        [rod(70.0, 110.0, 0.0, -160.0)], [rod(70.0, 110.0, 0.0, HEIGHT - 160.0)], family=family
    )
    found = support.over_edge(path, np.eye(4), 100.0, ())
    assert [issue.code for issue in found] == (["OVER_PLATFORM"] if told_of else [])
    low = Body("plate", square(200.0)[0] - [0.0, 0.0, 160.0], square(200.0)[1])
    assert not support.over_edge(path, np.eye(4), 100.0, (low,))


def test_the_frame_of_the_feature_is_a_remedy_where_it_does():
    """A bead of 40 mm, beside a disc of 30 mm radius: with its middle on that of the disc it stands there, unless the disc
    is smaller, or the frame turned or higher; so it does not where it would bury a body."""
    path = toolpath([rod(40.0, 80.0)], [rod(40.0, 80.0, 0.0, HEIGHT)])
    middle, higher, turned = np.eye(4), np.eye(4), np.eye(4)
    middle[0, 3] = higher[0, 3] = turned[0, 3] = 60.0
    higher[2, 3] = 5.0
    turned[:3, :3] = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]
    low, flush = (
        Body("low", square(9.0)[0] - [0, 0, 3.0], square(9.0)[1]),
        Body("flush", *square(9.0)),
    )
    for radius, frame, bodies, mended in (
        (30.0, middle, (), True),
        (30.0, None, (), False),
        (30.0, np.eye(4), (), False),
        (12.0, middle, (), False),
        (30.0, higher, (), False),
        (30.0, turned, (), False),
        (30.0, middle, (low,), False),
        (30.0, middle, (flush,), True),
    ):
        (issue,) = support.over_edge(path, np.eye(4), 2.0 * radius, bodies, frame)
        assert ("centre the part by cell.mount: feature" in issue.message) == mended, (
            radius,
            frame,
        )
        if frame is not None and mended:
            assert not support.over_edge(path, frame, 2.0 * radius, bodies)


def test_a_substrate_beyond_the_edge_of_the_platform_carries():
    frame, plate = np.eye(4), disc(400.0, np.eye(4), "plate")
    path = toolpath([rod(-100, 100)])
    assert support.over_edge(path, frame, 60.0, ()) and not support.over_edge(
        path, frame, 60.0, (plate,)
    )


def test_beside_the_edge_of_a_platform_nothing_carries():
    """Beads of a first layer beside a disc, a layer height from its edge and more: a sheet has no inside below it."""
    away = [0.4 * HEIGHT, 1.2 * HEIGHT, 1.6 * HEIGHT]
    long = toolpath([bead([[50.0 + x, -0.2, 0.0], [50.0 + x, 0.2, 0.0]]) for x in away])
    plate = Body("platform", *square(50.0))
    ground = support._Ground(long, (), (plate,), ())
    points = np.vstack([one.points for _, _, one in long])
    assert ground(points, np.tile(UP, (len(points), 1))).tolist() == [
        True,
        True,
        False,
        False,
        False,
        False,
    ]


def square(half):
    corners = np.array([[x, y, 0.0] for x in (-half, half) for y in (-half, half)])
    return corners, np.array([[0, 2, 3], [0, 3, 1]], dtype=np.int64)


@pytest.mark.parametrize(("lift", "told_of"), [(0.0, False), (1.4 * HEIGHT, False), (20.0, True)])
def test_a_first_layer_above_the_platform_is_told_where_nothing_carries_it(lift, told_of):
    frame = np.eye(4)
    frame[:3, 3] = 10.0, -20.0, 5.0
    path = toolpath([rod(-90, 110, 0.0, 5.0 + lift)], [rod(-90, 110, 0.0, 7.0 + lift)])
    found = support.above(path, frame, ())
    assert bool(found) == told_of
    under = np.eye(4)
    under[2, 3] = 5.0 + lift
    assert not support.above(path, frame, (disc(400.0, under, "plate"),))
    if told_of:
        length, height = (float(word) for word in re.findall(r"([\d.]+) mm", found[0].message))
        assert (found[0].code, found[0].level, found[0].layer) == ("ABOVE_PLATFORM", "warning", 0)
        assert (length, height) == (pytest.approx(200.0), pytest.approx(20.0))


def test_a_part_of_the_first_layer_on_the_platform_is_no_news():
    path = toolpath([rod(0.0, 60.0, 0.0, 0.0), rod(0.0, 50.0, 20.0, 9.0)])
    assert not support.above(path, np.eye(4), ())
