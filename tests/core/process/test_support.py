# SPDX-License-Identifier: LGPL-2.1-or-later
"""Unsupported beads, against lengths that follow from the positions of beads and against a test of
every pair of points."""

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
    path_layers = tuple(Layer(tuple(beads)) for beads in layers)
    return Toolpath(path_layers, np.eye(4), height, 0.01, family=family, bead_width=width)


def check_support(path, planes=(), bodies=(), bases=()):
    """Return the unsupported length and the issues."""
    checked = support.check_support(path, planes, bodies, bases)
    return checked.checks.unsupported, [
        issue for issue in checked.issues if issue.code == "UNSUPPORTED"
    ]


@pytest.mark.parametrize(
    "aside, over", [(0.0, 0.0), (0.45 * WIDTH, 0.0), (0.7 * WIDTH, 100.0), (-0.7 * WIDTH, 100.0)]
)
def test_a_bead_may_overhang_by_half_of_its_width(aside, over):
    length, issues = check_support(toolpath([rod(0, 100)], [rod(0, 100, aside, HEIGHT)]))
    assert length == pytest.approx(over)
    assert [(issue.level, issue.layer, issue.bead, issue.point) for issue in issues] == [
        ("warning", 1, 0, 0)
    ] * bool(over)


@pytest.mark.parametrize(
    "rise, over", [(0.5, 0.0), (1.0, 0.0), (1.4, 0.0), (1.6, 100.0), (20.0, 100.0)]
)
def test_what_is_below_is_no_farther_than_one_and_a_half_layers(rise, over):
    """The supporting layer is at most one and a half layer heights below."""
    assert check_support(toolpath([rod(0, 100)], [rod(0, 100, 0.0, rise * HEIGHT)]))[
        0
    ] == pytest.approx(over)


@pytest.mark.parametrize("ground", ["plane", "body"])
def test_ground_a_layer_below_carries_the_first_layer_alone(ground):
    """A flange over the platform, one layer above it on a narrower foot: its second layer is above
    air that is just as high."""
    path = toolpath(
        [rod(0, 100)], [rod(0, 100, 0.0, HEIGHT), rod(0, 100, 20.0, HEIGHT)], family="solid"
    )
    planes, bodies = (
        ((np.eye(4),), ()) if ground == "plane" else ((), (disc(400.0, np.eye(4), "plate"),))
    )
    length, issues = check_support(path, planes, bodies)
    assert length == pytest.approx(100.0)
    assert [(issue.layer, issue.bead) for issue in issues] == [(1, 1)]
    assert (
        check_support(toolpath([rod(0, 100, 0.0, HEIGHT)], family="solid"), planes, bodies)[0]
        == 0.0
    )
    half = toolpath(
        [rod(0, 100)], [rod(0, 100, 20.0, 0.6 * HEIGHT)], family="solid"
    )  # such steps occur next to a slope
    assert check_support(half, planes, bodies)[0] == 0.0


def test_ground_a_layer_below_carries_what_begins_there():
    """The first layer of a second solid, and of a second object that a slicer prints after the
    first."""
    plate = disc(400.0, np.eye(4), "plate")
    rods = [(rod(0, 100, aside, 0.9 * HEIGHT),) for aside in (0.0, 60.0)]
    solids = toolpath(*rods, family="solid")
    assert check_support(solids, (), (plate,))[0] == pytest.approx(100.0)
    with_first_layers = dataclasses.replace(
        solids, layers=tuple(Layer(beads, first=True) for beads in rods)
    )
    assert check_support(with_first_layers, (), (plate,)) == (0.0, [])
    assert check_support(dataclasses.replace(solids, family="curves"), (), (plate,)) == (0.0, [])


def test_beside_is_not_below_and_neither_is_later_or_above():
    """A neighbouring, later or higher bead gives no support."""
    over = [
        [rod(0, 100)],
        [rod(0, 100, 40.0, 2.0), rod(0, 100, 46.0, 2.0)],
        [rod(0, 100, 40.0, 0.0)],
    ]
    length, issues = check_support(toolpath(*over))
    assert length == pytest.approx(300.0)
    assert [(issue.layer, issue.bead) for issue in issues] == [(1, 0), (2, 0)]


def test_a_seam_between_beads_is_no_gap_but_a_gap_is_one():
    """Two beads below with increasing distance, and one above the middle between them."""
    for distance, over in ((1.0 * WIDTH, 0.0), (1.4 * WIDTH, 0.0), (1.8 * WIDTH, 100.0)):
        below = [rod(0, 100, -0.5 * distance), rod(0, 100, 0.5 * distance)]
        assert check_support(toolpath(below, [rod(0, 100, 0.0, HEIGHT)]))[0] == pytest.approx(
            over
        ), distance


def test_the_free_end_of_a_bead_is_told_by_its_length():
    """The bead below ends at 70 mm and extends half a width beyond its points."""
    length, (issue,) = check_support(toolpath([rod(0, 70)], [rod(0, 100, 0.0, HEIGHT)]))
    assert length == pytest.approx(30.0 - 0.5 * WIDTH, abs=0.2 * WIDTH)
    assert f"{length:.4g} mm of bead are unsupported" in issue.message
    assert check_support(toolpath([rod(0, 94)], [rod(0, 100, 0.0, HEIGHT)]))[0] == 0.0
    assert check_support(toolpath([rod(0, 89)], [rod(0, 100, 0.0, HEIGHT)]))[0] == pytest.approx(
        11.0 - 0.5 * WIDTH, abs=0.2 * WIDTH
    )


def test_gaps_no_longer_than_a_width_are_bridged():
    """Gaps up to one width are bridged."""
    for gap, bridged in ((1.5 * WIDTH, True), (2.5 * WIDTH, False), (4.0 * WIDTH, False)):
        below = [rod(0, 50 - 0.5 * gap), rod(50 + 0.5 * gap, 100)]
        length, _ = check_support(toolpath(below, [rod(0, 100, 0.0, HEIGHT)]))
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
    assert check_support(path)[0] == pytest.approx(100.0)
    assert check_support(path, planes=(np.eye(4),))[0] == 0.0
    assert check_support(path, bodies=(Body("block", block, np.array(sides)),))[0] == pytest.approx(
        40.0, abs=0.4 * WIDTH
    )
    low = np.eye(4)
    low[2, 3] = -2.5
    assert check_support(path, planes=(low,))[0] == pytest.approx(100.0)
    hub = Base(
        "hub",
        Developable(49.0),
        np.array([[0.0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, -49.0], [0, 0, 0, 1]]),
    )
    assert check_support(path, bases=(hub,))[0] == 0.0


def test_beads_that_close_gaps_lie_on_what_is_beside_them():
    """Beads that close gaps are supported by their neighbours."""
    ring = [rod(0, 100, -2.5), rod(0, 100, 2.5)]
    close = bead([[0, 0, 0.5], [100, 0, 0.5]], closing=True)
    assert check_support(toolpath([rod(0, 100, 30.0)], ring, [close]), planes=())[
        0
    ] == pytest.approx(200.0)


def spiral(pitch, height, turns=6):
    angle = np.linspace(0.0, 2.0 * np.pi * turns, 200 * turns + 1)
    points = np.stack(
        [30.0 * np.cos(angle), 30.0 * np.sin(angle), pitch * angle / (2.0 * np.pi)], axis=1
    )
    return toolpath([bead(points)], family="revolution", height=height)


def test_a_spiral_lies_on_itself():
    """A spiral supports itself."""
    assert check_support(spiral(2.0, 2.0), (np.eye(4),))[0] == 0.0
    length, _ = check_support(spiral(4.0, 2.0), (np.eye(4),))
    round_ = math.hypot(2.0 * np.pi * 30.0, 4.0)
    assert length == pytest.approx(
        (6.0 - 3.0 / 4.0) * round_, abs=WIDTH
    )  # except within 3 mm of the platform


MERIDIANS = {
    "sphere": Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)]),
    "funnel": Meridian.chained([arc((90.0, 0.0), 45.0, np.pi, np.pi / 2)]),
    "bent": Meridian.chained([line((10.0, 0.0), (10.0, 5.0)), line((10.0, 5.0), (4.0, 13.0))]),
}


@pytest.mark.parametrize("path", ["layers", "spiral"])
@pytest.mark.parametrize("name", MERIDIANS)
def test_parts_of_revolution_stand(name, path):
    """Parts of revolution are supported throughout."""
    wall = RevolvedWall(MERIDIANS[name], np.eye(4), 0.0, 2.0 * np.pi, True)
    planned_path = revolution.plan(
        wall,
        RevolutionParameters(path=path, layer_height=2.0),
        BuildDirectionParameters(),
        ProcessParameters(),
        NozzleParameters(),
        0.0,
    )
    assert check_support(planned_path, (planned_path.frame,)) == (0.0, [])


def mushroom():
    """A stem 20 mm long on a rod of radius 10 mm, and a cap 60 mm long from radius 22 to 34 mm:
    revolved about the rod."""
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
        current, following = k * sides, (k + 1) % len(outline) * sides
        faces += [
            np.stack([current + a, following + b, current + b], axis=1),
            np.stack([current + a, following + a, following + b], axis=1),
        ]
    triangles = np.concatenate(faces)
    body = Body("mushroom", np.vstack(rows), triangles)
    corner = body.corners()
    volume = np.einsum("ij,ij->", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])) / 6.0
    return body if volume > 0.0 else Body("mushroom", np.vstack(rows), triangles[:, ::-1].copy())


@pytest.fixture(scope="module")
def mushroom_path():
    base = Base("the rod", Developable(10.0), np.eye(4))
    planned_path = plan_solids(
        SolidsOnHub("part", (Group(base, (mushroom(),)),), 0.0),
        DevelopableParameters(
            layer_height=4.0, chord_error=0.05, bead_spacing=6.0, fill="lines", fill_angle_step=0.0
        ),
        BuildDirectionParameters(),
        ProcessParameters(),
        None,
    )
    return support.check_support(planned_path, (), (), (base,))


def test_the_mushroom_is_told_with_its_length(mushroom_path):
    """Lines around the rod are rings; the first rings of the cap are unsupported where the stem
    does not reach."""
    layers = [
        [(bead.points[0, 2], np.hypot(*bead.points[0, :2]), bead.length) for bead in layer.beads]
        for layer in mushroom_path.layers
    ]
    first_cap_layer = next(
        k for k, layer in enumerate(layers) if min(z for z, _, _ in layer) < -3.0
    )
    below = np.array([z for z, _, _ in layers[first_cap_layer - 1]])
    over = [length for z, _, length in layers[first_cap_layer] if np.abs(below - z).min() > 4.0]
    assert len(over) == 6
    assert mushroom_path.checks.unsupported == pytest.approx(sum(over), rel=1e-9)
    assert mushroom_path.checks.unsupported == pytest.approx(
        6 * 2.0 * np.pi * layers[first_cap_layer][0][1], rel=2e-3
    )
    (issue,) = [candidate for candidate in mushroom_path.issues if candidate.code == "UNSUPPORTED"]
    assert issue.layer == first_cap_layer


def test_every_pair_of_places_tried_gives_the_same_length():
    """Random beads: each point of a bead against every earlier point."""
    rng = np.random.default_rng(4)
    layers = []
    for level in range(4):
        beads = []
        for _ in range(6):
            start = np.array([*rng.uniform(-40, 40, 2), level * HEIGHT])
            heading = rng.uniform(0.0, 2.0 * np.pi)
            beads.append(
                bead(
                    [
                        start,
                        start
                        + rng.uniform(60, 120) * np.array([np.cos(heading), np.sin(heading), 0.0]),
                    ]
                )
            )
        layers.append(beads)
    path = toolpath(*layers, family="revolution")
    step = 0.4
    samples = []
    for level, beads in enumerate(layers):
        for layer_bead in beads:
            t = (np.arange(int(layer_bead.length / step)) + 0.5) * step / layer_bead.length
            samples.append(
                (
                    level,
                    layer_bead.points[0]
                    + t[:, None] * (layer_bead.points[1] - layer_bead.points[0]),
                )
            )
    total = 0.0
    for level, own_points in samples:
        below = [points_below for level_below, points_below in samples if level_below == level - 1]
        if not below:
            continue
        under, travel = (
            np.vstack(below),
            (own_points[-1] - own_points[0]) / np.linalg.norm(own_points[-1] - own_points[0]),
        )
        across = np.cross(UP, travel)

        def is_supported(level_below, under=under):
            return (
                np.linalg.norm(level_below[:, None, :2] - under[None, :, :2], axis=2).min(axis=1)
                <= 0.5 * WIDTH * 1.1 + 0.01
            )

        free = ~(
            is_supported(own_points)
            | (
                is_supported(own_points + 0.25 * WIDTH * across)
                & is_supported(own_points - 0.25 * WIDTH * across)
            )
        )
        ends = np.flatnonzero(np.diff(np.r_[False, free, False].astype(int)))
        for a, b in ends.reshape(-1, 2):
            at_end = a == 0 or b == len(own_points)
            total += (b - a) * step if (b - a) * step > (0.5 if at_end else 1.0) * WIDTH else 0.0
    ground = np.eye(4)
    ground[2, 3] = -HEIGHT  # the second layer is too high above it
    assert check_support(path, (ground,))[0] == pytest.approx(total, rel=0.04)


def test_pairs_that_are_looked_at_grow_as_the_number_of_points(monkeypatch):
    """Four times as many layers take at most five times as many candidate pairs; all of them are
    unsupported."""
    pair_counts = []

    def stack(count):
        angle = np.linspace(0.0, 2.0 * np.pi, 200)
        ring = np.stack([30.0 * np.cos(angle), 30.0 * np.sin(angle), 0.0 * angle], axis=1)
        ring[-1] = ring[0]
        return toolpath(
            *([bead(ring + k * 4.0 * UP, closed=True)] for k in range(count)), family="revolution"
        )

    def pairs(path):
        pair_counts.clear()
        assert check_support(path, (np.eye(4),))[0] == pytest.approx(
            path.length * (1.0 - 1.0 / len(path.layers))
        )
        return sum(pair_counts)

    below = pieces_of_beads._below

    def count_pairs(segments, candidates, *arguments):
        pair_counts.append(len(candidates))
        return below(segments, candidates, *arguments)

    monkeypatch.setattr(pieces_of_beads, "_below", count_pairs)
    small_stack, large_stack = stack(15), stack(60)
    small_count, large_count = pairs(small_stack), pairs(large_stack)
    assert 0 < large_count < 5.0 * small_count


def test_beads_that_tell_their_width_carry_no_farther():
    """A narrow bead supports no farther than its width."""
    nominal = bead([[0, 0, 0], [100, 0, 0]])
    narrow = Bead(
        nominal.points,
        nominal.build,
        nominal.tool,
        nominal.parameter,
        nominal.speed,
        False,
        width=np.full(2, 2.0),
    )
    above = rod(0, 100, 2.0, HEIGHT)
    assert check_support(toolpath([nominal], [above]))[0] == 0.0
    assert check_support(toolpath([narrow], [above]))[0] == pytest.approx(100.0)


def test_beads_of_no_width_to_speak_of_take_no_memory():
    """The chord error bounds the number of segments; they once took 11 TB. The whole bead is
    unsupported."""
    low, high = rod(0.0, 10.0), rod(0.0, 10.0, 0.0, HEIGHT)
    assert check_support(toolpath([low], [high], width=1e-9))[0] == 0.0
    assert check_support(toolpath([low], [rod(0.0, 10.0, 1.0, HEIGHT)], width=1e-9))[
        0
    ] == pytest.approx(10.0)


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
    """A bead of 200 mm, 20 mm from the centre of a disc, may extend beyond its edge by half its
    width. Higher starts are not checked against the platform."""
    frame = np.eye(4)
    frame[:3, 3] = 10.0, -20.0, 5.0
    path = toolpath([rod(-90, 110, 0.0, 5.0 + lift)], [rod(-90, 110, 0.0, 7.0 + lift)])
    issues = support.over_edge(path, frame, 2.0 * radius, ())
    assert bool(issues) == bool(over)
    if over:
        (issue,) = issues
        length, overhang = (float(word) for word in re.findall(r"([\d.]+) mm", issue.message))
        assert (issue.code, issue.level, issue.layer, issue.bead) == (
            "OVER_PLATFORM",
            "warning",
            0,
            0,
        )
        assert length == pytest.approx(over, abs=2.0 * WIDTH * support.support.PIECE)
        assert overhang == pytest.approx(
            math.hypot(100.0, 20.0) - radius, abs=WIDTH * support.support.PIECE
        )


@pytest.mark.parametrize(
    ("family", "told_of"), [("solid", True), ("surface", False), ("developable", False)]
)
def test_a_solid_that_begins_beside_the_platform_and_below_it_is_told(family, told_of):
    """160 mm below the plane of the disc and 20 mm next to it; a wall or a rotary solid may have a
    base outside the file."""
    path = toolpath(
        [rod(70.0, 110.0, 0.0, -160.0)], [rod(70.0, 110.0, 0.0, HEIGHT - 160.0)], family=family
    )
    issues = support.over_edge(path, np.eye(4), 100.0, ())
    assert [issue.code for issue in issues] == (["OVER_PLATFORM"] if told_of else [])
    low = Body("plate", square(200.0)[0] - [0.0, 0.0, 160.0], square(200.0)[1])
    assert not support.over_edge(path, np.eye(4), 100.0, (low,))


def test_the_frame_of_the_feature_is_a_remedy_where_it_does():
    """A bead of 40 mm next to a disc of 30 mm radius: centred on the disc it is supported, unless
    the disc is smaller, the frame rotated or higher, or a body would be buried."""
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
    """Beads of a first layer next to a disc, at distances from its edge: a sheet has no inside
    below it."""
    distances = [0.4 * HEIGHT, 1.2 * HEIGHT, 1.6 * HEIGHT]
    long = toolpath([bead([[50.0 + x, -0.2, 0.0], [50.0 + x, 0.2, 0.0]]) for x in distances])
    plate = Body("platform", *square(50.0))
    ground = support._Ground(long, (), (plate,), ())
    points = np.vstack([first_bead.points for _, _, first_bead in long])
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
    """A first layer above the platform is reported if nothing supports it."""
    frame = np.eye(4)
    frame[:3, 3] = 10.0, -20.0, 5.0
    path = toolpath([rod(-90, 110, 0.0, 5.0 + lift)], [rod(-90, 110, 0.0, 7.0 + lift)])
    issues = support.above(path, frame, ())
    assert bool(issues) == told_of
    under = np.eye(4)
    under[2, 3] = 5.0 + lift
    assert not support.above(path, frame, (disc(400.0, under, "plate"),))
    if told_of:
        length, height = (float(word) for word in re.findall(r"([\d.]+) mm", issues[0].message))
        assert (issues[0].code, issues[0].level, issues[0].layer) == (
            "ABOVE_PLATFORM",
            "warning",
            0,
        )
        assert (length, height) == (pytest.approx(200.0), pytest.approx(20.0))


def test_a_part_of_the_first_layer_on_the_platform_is_no_news():
    """A first layer that is partly on the platform gives no issue."""
    path = toolpath([rod(0.0, 60.0, 0.0, 0.0), rod(0.0, 50.0, 20.0, 9.0)])
    assert not support.above(path, np.eye(4), ())
