# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids in plane layers: beads where the part is and nowhere else, by its equations and by counting pixels."""

import math
import re
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy import ndimage
from scipy.spatial import ConvexHull, cKDTree

from freecad_am.core.geometry.mesh.solid import SolidMesh
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import InputError, summarised
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters, SeamParameters, WireParameters
from freecad_am.core.process.deposit import spacing
from freecad_am.core.process.wire import load, set_wire_feed
from freecad_am.core.strategies.solids.plan import plan

ERROR = 0.05
GRID = 0.1  # mm of a pixel


def box(low, high, name="box"):
    return hull(np.array(list(product(*zip(low, high))), dtype=float), name)


def hull(points, name="hull"):
    made = ConvexHull(points)
    faces = made.simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * made.equations[:, :3]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return Body(name, points, faces.astype(np.int64))


def tube(profile, sides=240, name="tube"):
    """A part of revolution about Z from a closed profile (r, z), counter-clockwise."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rows = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(sides, z)], axis=1)
        for r, z in profile
    ]
    faces = []
    for k in range(len(rows)):
        for j in range(sides):
            a, b = k * sides + j, k * sides + (j + 1) % sides
            c, d = (k + 1) % len(rows) * sides + j, (k + 1) % len(rows) * sides + (j + 1) % sides
            faces += [(a, b, d), (a, d, c)]
    return Body(name, np.vstack(rows), np.array(faces, dtype=np.int64))


RING = [(12.0, 0.0), (40.0, 0.0), (40.0, 20.0), (12.0, 20.0)]
CONE = [(10.0, 0.0), (40.0, 0.0), (25.0, 30.0), (10.0, 30.0)]


def prism(outline, cap, low, high):
    """A T: an outline (x, z), counter-clockwise, and triangles of it, from y = low to high."""
    count = len(outline)
    points = np.array([[x, y, z] for y in (high, low) for x, z in outline], dtype=float)
    faces = [*cap, *((c + count, b + count, a + count) for a, b, c in cap)]
    for k in range(count):
        other = (k + 1) % count
        faces += [(k, k + count, other + count), (k, other + count, other)]
    body = Body("T", points, np.array(faces, dtype=np.int64)[:, ::-1])
    SolidMesh(body.vertices, body.triangles).refuse_unsound("T")
    return body


def planned(*bodies, build=None, process=None, **values):
    given = {"layer_height": 4.0, "chord_error": ERROR, "bead_spacing": 4.0, **values}
    strategy = SolidParameters(**given)
    solids = prepare_stack(bodies, strategy, "part")
    return plan(
        solids, strategy, build or BuildDirectionParameters(), process or ProcessParameters(), None
    )


@pytest.mark.parametrize("order", ["feature", "around-axis"])
def test_progress_goes_on_layer_by_layer(order):
    """Of one solid of twenty layers, and of two that lie apart."""
    for bodies in (
        [box((0, 0, 0), (20, 20, 40))],
        [box((0, 0, 0), (20, 20, 40)), box((40, 0, 0), (60, 20, 40), "other")],
    ):
        strategy = SolidParameters(
            layer_height=2.0, chord_error=ERROR, bead_spacing=8.0, order=order, fuse="none"
        )
        told = []
        plan(
            prepare_stack(bodies, strategy, "part"),
            strategy,
            BuildDirectionParameters(),
            ProcessParameters(),
            None,
            lambda share, text, told=told: told.append(share),
        )
        assert len(told) == 20 * len(bodies)
        assert told == pytest.approx(np.arange(len(told)) / len(told), abs=0.02)


def dense(bead, step=0.02):
    length = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
    count = np.maximum(np.ceil(length / step).astype(int), 1)
    row = np.repeat(np.arange(len(count)), count)
    share = (np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)) / count[row]
    return bead.points[row] + share[:, None] * (bead.points[row + 1] - bead.points[row])


def test_layers_lie_on_their_planes_and_count():
    made = planned(tube(RING))
    assert len(made.layers) == 5
    for number, layer in enumerate(made.layers):
        points = np.vstack([bead.points for bead in layer.beads])
        np.testing.assert_allclose(points[:, 2], 4.0 * number, atol=1e-12)
        for bead in layer.beads:
            np.testing.assert_array_equal(bead.tool, np.tile([0.0, 0.0, 1.0], (len(bead), 1)))


@pytest.mark.parametrize("cut_at, share", [("bottom", 0.0), ("middle", 0.5), ("top", 1.0)])
@pytest.mark.always("bottom-0.0", "top-1.0")
def test_outlines_are_those_where_it_is_cut(cut_at, share):
    """On a cone the outermost bead lies half a spacing inside of the section, within the chord error."""
    made = planned(tube(CONE), cut_at=cut_at, fill="contours")
    for number, layer in enumerate(made.layers):
        radius = 40.0 - 0.5 * min(4.0 * (number + share), 30.0)
        reach = max(np.hypot(*bead.points[:, :2].T).max() for bead in layer.beads)
        least = min(np.hypot(*bead.points[:, :2].T).min() for bead in layer.beads)
        assert radius - 2.0 - 3.0 * ERROR < reach < radius - 2.0 + ERROR
        assert 12.0 - ERROR < least < 12.0 + 3.0 * ERROR


@pytest.mark.parametrize("fill", ["contours", "lines", "zigzag", "spiral"])
@pytest.mark.always("contours")
def test_covers_what_beads_can_reach_and_nothing_else(fill):
    """Counted in pixels: what lies within half a spacing of a bead, against the section opened by a bead's half width."""
    bar = box((30, -15, 0), (75, 15, 8), "bar")
    made = planned(tube([(12.0, 0.0), (40.0, 0.0), (40.0, 8.0), (12.0, 8.0)]), bar, fill=fill)
    axis = np.arange(-45.0, 80.0, GRID)
    x, y = np.meshgrid(axis, axis, indexing="ij")
    rho = np.hypot(x, y)
    section = ((rho <= 40.0) & (rho >= 12.0)) | ((x >= 30.0) & (x <= 75.0) & (np.abs(y) <= 15.0))
    middles = ndimage.distance_transform_edt(section) * GRID >= 2.0
    reachable = ndimage.distance_transform_edt(~middles) * GRID <= 2.0
    for layer in made.layers:
        tree = cKDTree(np.vstack([dense(bead)[:, :2] for bead in layer.beads]))
        covered = (
            tree.query(np.stack([x, y], axis=-1).reshape(-1, 2), distance_upper_bound=2.0)[
                0
            ].reshape(x.shape)
            < 2.0
        )
        assert (covered & reachable).sum() >= 0.99 * reachable.sum()
        assert (covered & ~section).sum() <= 0.01 * section.sum()


@pytest.mark.parametrize("fill", ["contours", "zigzag"])
@pytest.mark.parametrize("way", ["0 0 1", "1 2 -3"])
@pytest.mark.always
def test_plane_layers_are_as_far_apart_as_their_planes(fill, way):
    """However far beads are from the ones below; a layer left out, as between two plates, is a distance too."""
    made = planned(box((0, 0, 0), (40, 30, 12)), fill=fill, direction=way, layer_height=2.0)
    values = np.concatenate(spacing.between_layers(made))
    np.testing.assert_allclose(values, 2.0, atol=1e-9)
    assert len(values) == sum(
        len(bead) for layer, _, bead in made if layer and not bead.role.closing
    )
    local = spacing.local_distances(made)
    for (layer, _, bead), one in zip(made, local, strict=True):
        assert len(one) == len(bead) and (
            np.isnan(one).all() if layer == 0 else np.abs(one - 2.0).max() < 1e-9
        )
    plates = planned(
        box((0, 0, 0), (40, 30, 4)), box((0, 0, 8), (40, 30, 12)), fill=fill, layer_height=2.0
    )
    assert [round(float(one.max()), 9) for one in spacing.between_layers(plates)] == [2.0, 6.0, 2.0]


def test_deposits_the_volume_of_the_part():
    made = planned(tube(RING), fill="contours")
    volume = made.length * 4.0 * 4.0
    assert volume == pytest.approx(math.pi * (40.0**2 - 12.0**2) * 20.0, rel=0.03)


def test_what_beads_leave_and_what_lies_beside_is_known():
    """A plate filled, and a fin thinner than a bead: how much wider one bead is, and what is above the last cut."""
    part, left, beside = planned(
        box((0, 0, 0), (60, 30, 9)), fill="contours", layer_height=2.0
    ).checks.volumes
    assert part == pytest.approx(60 * 30 * 9) and beside < 1.0
    rounded = 4 * (1.0 - 0.25 * math.pi) * 2.0**2  # mm^2 that a contour leaves in its four corners
    assert (
        60 * 30 * 1 < left < 60 * 30 * 1 + 4 * 5 * 2.0 * rounded
    )  # at most five rings in four layers of 2 mm
    part, left, beside = planned(box((0, 0, 0), (60, 2, 8))).checks.volumes
    assert part == pytest.approx(960.0) and left < 0.01 * 960.0 and beside < 0.02 * 960.0
    part, left, beside = planned(box((0, 0, 0), (60, 2, 8)), widths="fixed").checks.volumes
    assert part == pytest.approx(960.0) and left < 1.0
    assert beside == pytest.approx(
        960.0 + 2 * 8 * math.pi * 2.0, rel=0.2
    )  # twice as wide, and round ends
    part, left, beside = planned(
        box((0, 0, 0), (60, 30, 10.5)), fill="contours", layer_height=4.0
    ).checks.volumes
    assert (
        part == pytest.approx(60 * 30 * 10.5) and left < 3 * 5 * 4.0 * rounded
    )  # three layers, the last cut 10 mm up
    assert beside == pytest.approx(60 * 30 * 1.5, abs=1.0)
    apart = planned(
        box((0, 0, 0), (30, 30, 9)), box((40, 0, 0), (60, 30, 9)), fill="contours", layer_height=2.0
    ).checks.volumes
    assert apart[0] == pytest.approx(
        50 * 30 * 9
    )  # of several solids too, where they cannot overlap


def test_what_beads_lay_twice_is_known():
    """Against a raster of how many beads are above each place; zigzags meet contours, lone beads meet nothing."""
    for part, values, least in (
        (box((0, 0, 0), (60, 30, 4)), {"fill": "zigzag"}, 0.05),
        (box((0, 0, 0), (50, 37, 4)), {"fill": "lines"}, 0.01),
        (box((0, 0, 0), (60, 8, 4)), {"fill": "contours"}, 0.0),
    ):
        made = planned(part, layer_height=4.0, narrowest=1.0, **values)
        lines = [bead.points[:, :2] for _, _, bead in made]
        x, y = np.meshgrid(np.arange(-2, 63, 0.2), np.arange(-2, 40, 0.2))
        once = np.zeros(x.shape, dtype=bool)
        for line in lines:
            for a, b in zip(line, line[1:]):
                way = b - a
                share = np.clip(((x - a[0]) * way[0] + (y - a[1]) * way[1]) / (way @ way), 0.0, 1.0)
                once |= np.hypot(x - a[0] - share * way[0], y - a[1] - share * way[1]) < 2.0
        laid = sum(np.hypot(*np.diff(line, axis=0).T).sum() for line in lines) * 4.0
        expected = (laid - once.sum() * 0.04) * 4.0
        volume = math.prod(np.ptp(part.vertices, axis=0))
        assert made.checks.twice == pytest.approx(expected, abs=0.01 * volume)
        assert made.checks.twice >= least * volume
    half = planned(
        box((0, 0, 0), (60, 30, 4)),
        fill="lines",
        fill_density=0.5,
        bead_spacing=4.0,
        layer_height=4.0,
    )
    assert half.checks.twice < 0.01 * 60 * 30 * 4  # lines farther apart, which meet their contour


@pytest.mark.parametrize(
    "part,fill",
    [
        (box((0, 0, 0), (60, 9.6, 4)), "contours"),  # a middle bead with 2 of its 4 mm of room
        (box((0, 0, 0), (60, 6.4, 4)), "connected"),  # both sides of one contour, 2.4 mm apart
        (tube([(14.0, 0.0), (24.0, 0.0), (24.0, 4.0), (14.0, 4.0)]), "lines"),
        (box((0, 0, 0), (50, 37, 4)), "zigzag"),
    ],
)
def test_beads_deposit_the_volume_of_the_part_where_they_crowd(part, fill):
    """What each segment lays, its time at the usual wire feed; its width tells the same. With all beads as wide as ever it
    would be more than 3 % too much."""
    process = ProcessParameters(travel_speed=20.0)

    def laid(made):
        time = sum(
            (np.hypot(*np.diff(bead.points, axis=0)[:, :2].T) / bead.speed[1:]).sum()
            for _, _, bead in made
        )
        wide = sum(
            (
                np.hypot(*np.diff(bead.points, axis=0)[:, :2].T)
                * (4.0 if bead.width is None else 0.5 * (bead.width[1:] + bead.width[:-1]))
            ).sum()
            for _, _, bead in made
        )
        assert wide == pytest.approx(time * 20.0 * 4.0, rel=0.03)
        return wide * 4.0

    volume = SolidMesh(part.vertices, part.triangles).volume
    made = planned(part, fill=fill, process=process)
    assert laid(made) == pytest.approx(volume, rel=0.03) and made.checks.twice < 0.03 * volume
    assert (
        min(bead.width.min() for _, _, bead in made if bead.width is not None) >= 0.3 * 4.0 - 1e-9
    )
    (told,) = [issue for issue in made.issues if issue.code == "SPEED_VARIES"]
    beads = [bead for _, _, bead in made]
    others = [bead for bead in beads if np.abs(bead.speed[1:] / 20.0 - 1.0).max() > 0.01]
    number, numbers = r"(\d+\.?\d*)", r"(\d+\.?\d*(?: to \d+\.?\d*)?)"
    words = re.match(
        f"{number} of {number} beads are deposited at {numbers} mm/s instead of {number} mm/s, so that "
        f"a constant wire feed makes the beads as wide as the available space, {numbers} mm",
        told.message,
    )
    count, every, speeds, usual, widths = (
        [float(value) for value in group.split(" to ")] for group in words.groups()
    )
    (count,), (every,), (usual,), slow, fast = count, every, usual, speeds[0], speeds[-1]
    thin, wide = widths[0], widths[-1]
    assert (count, every, usual) == (len(others), len(beads), 20.0)
    for said, exact in (
        (slow, min(bead.speed[1:].min() for bead in others)),
        (fast, max(bead.speed[1:].max() for bead in others)),
        (thin, min(bead.width.min() for bead in others)),
        (wide, max(bead.width.max() for bead in others)),
    ):
        assert said == pytest.approx(exact, rel=5e-3)
    assert told.level == "note" and made.layers[told.layer].beads[told.bead] in others
    full = planned(part, fill=fill, process=process, narrowest=1.0)
    assert laid(full) > 1.03 * volume and not [
        issue for issue in full.issues if issue.code == "SPEED_VARIES"
    ]
    assert [bead.closed for _, _, bead in full] == [bead.closed for _, _, bead in made]


@pytest.mark.parametrize(
    ("asked", "remedy"),
    [
        ({"fill": "contours"}, "strategy.narrowest: 100 %"),
        ({"fill": "zigzag"}, "strategy.narrowest: 100 %"),
        ({"fill": "connected"}, "strategy.fill: contours and strategy.narrowest: 100 %"),
        ({"fill": "connected", "narrowest": 1.0}, "strategy.fill: contours"),
        (
            {"fill": "lines", "spacing_range": (0.7, 1.4)},
            "a spacing range of 100 % to 100 % and strategy.narrowest: 100 %",
        ),
        (
            {"fill": "spiral", "spacing_range": (0.7, 1.4), "narrowest": 1.0},
            "a spacing range of 100 % to 100 %",
        ),
    ],
)
def test_what_is_told_to_give_one_speed_does(asked, remedy):
    part = box((0, 0, 0), (60, 9.6, 4))
    (told,) = [issue for issue in planned(part, **asked).issues if issue.code == "SPEED_VARIES"]
    assert told.message.endswith(f"; for a constant speed set {remedy}")
    meant = {
        "strategy.narrowest: 100 %": {"narrowest": 1.0},
        "strategy.fill: contours": {"fill": "contours"},
        "a spacing range of 100 % to 100 %": {"spacing_range": (1.0, 1.0)},
    }
    changed = {
        key: value
        for words, setting in meant.items()
        if words in remedy
        for key, value in setting.items()
    }
    made = planned(part, **{**asked, **changed})
    assert not [issue for issue in made.issues if issue.code == "SPEED_VARIES"]
    speeds = np.concatenate([bead.speed[1:] for _, _, bead in made])
    assert speeds == pytest.approx(ProcessParameters().travel_speed, abs=1e-12)


def test_a_note_on_equal_speeds_gives_one_number():
    """Beads 5.5 mm across 20 mm: six of 3.57 mm at one speed."""
    process = ProcessParameters(bead_width=4.0)
    made = planned(box((0, 0, 0), (30, 20, 4)), bead_spacing=3.5, process=process)
    (told,) = [issue for issue in made.issues if issue.code == "SPEED_VARIES"]
    assert re.search(r"deposited at \d+\.?\d* mm/s instead", told.message)
    assert "as wide as the available space, 3.57 mm" in told.message


def test_where_beads_do_not_crowd_all_are_as_wide_as_ever():
    for fill in ("contours", "lines", "spiral"):
        made = planned(box((0, 0, 0), (60, 32, 4)), fill=fill)
        assert all(bead.width is None and np.ptp(bead.speed) == 0.0 for _, _, bead in made)
        assert not [issue for issue in made.issues if issue.code == "SPEED_VARIES"]


def test_beads_are_as_short_as_their_spacing_where_that_is_less_than_2_mm():
    """A rod of 2 mm in beads of 0.6: one ring, and what that leaves in the middle is 0.8 mm wide."""
    angle = np.linspace(0.0, 2.0 * np.pi, 90, endpoint=False)
    rod = hull(np.array([(np.cos(a), np.sin(a), z) for a in angle for z in (0.0, 2.0)]), "rod")
    thin = {"layer_height": 0.25, "bead_spacing": 0.6, "chord_error": 0.01}
    made = planned(rod, **thin)
    part, left, beside = made.checks.volumes
    assert (
        part == pytest.approx(2.0 * math.pi, rel=0.01)
        and left + beside + made.checks.twice < 0.03 * part
    )
    made = planned(rod, shortest=2.0, **thin)  # it goes on over the ring
    assert made.checks.volumes[1] + made.checks.twice > 0.1 * part
    for apart, least in ((0.6, 0.6), (2.0, 2.0), (5.0, 2.0)):
        assert SolidParameters(bead_spacing=apart).least_bead == least


@pytest.mark.parametrize("fill", ["lines", "contours", "gyroid"])
def test_a_density_too_low_for_a_region_is_told_with_its_place(fill):
    """Lines 400 mm apart miss both of two blocks; lines 5 mm apart do not."""
    blocks = [box((-100, 0, 0), (-70, 20, 8)), box((105, 103, 0), (135, 123, 8))]
    low, usual = (
        planned(*blocks, fill=fill, fill_density=density, solid_layers=0) for density in (0.01, 0.8)
    )
    told = [issue for issue in low.issues if issue.code == "NO_INFILL"]
    assert [issue.layer for issue in told] == [0, 1]
    number, density, area = told[0].message.values[:3]
    assert (number, density) == ("2", "1")
    # 30 x 20 mm less a wall 4 mm wide all round
    assert float(area) == pytest.approx(22 * 12)
    assert not [issue for issue in usual.issues if issue.code == "NO_INFILL"]


def test_touching_and_overlapping_solids_are_one():
    """Two halves of a block, and one with a third that overlaps both: the beads of the block."""
    whole = planned(box((0, 0, 0), (60, 30, 8)))
    halves = planned(box((0, 0, 0), (30, 30, 8)), box((30, 0, 0), (60, 30, 8)))
    over = planned(
        box((0, 0, 0), (30, 30, 8)), box((30, 0, 0), (60, 30, 8)), box((20, 10, 0), (40, 20, 8))
    )
    apart = planned(box((0, 0, 0), (30, 30, 8)), box((30, 0, 0), (60, 30, 8)), fuse="none")
    for other in (halves, over):
        assert other.bead_count == whole.bead_count
        assert other.length == pytest.approx(whole.length, rel=1e-6)
    assert apart.bead_count == 2 * planned(box((0, 0, 0), (30, 30, 8))).bead_count
    assert apart.length < whole.length * 1.1 and apart.bead_count != whole.bead_count


def test_islands_are_finished_one_after_the_other():
    rods = [box((40 * k, 0, 0), (40 * k + 25, 25, 8), f"rod {k}") for k in range(3)]
    made = planned(*rods, fill="contours")
    for layer in made.layers:
        island = [round(float(bead.points[:, 0].mean() - 12.5) / 40.0) for bead in layer.beads]
        assert len(layer.beads) > 3 and sum(a != b for a, b in zip(island, island[1:])) == 2
        rings = [bead.role.ring for bead, at in zip(layer.beads, island) if at == island[0]]
        assert rings == sorted(rings, reverse=True)


def test_connected_contours_have_one_start_per_island_and_layer():
    """Islands counted by hand: a post, a frame round a window, and a block that ends lower; each all in one bead."""
    post, block = box((0, 0, 0), (26, 30, 24), "post"), box((110, 0, 0), (150, 40, 12), "block")
    frame = tube([(14.0, 0.0), (32.0, 0.0), (32.0, 24.0), (14.0, 24.0)], 60)
    frame = Body("frame", frame.vertices + [70.0, 15.0, 0.0], frame.triangles)
    made = planned(post, frame, block, fill="connected", bead_spacing=4.0)
    assert len(made.layers) == 6
    for number, layer in enumerate(made.layers):
        starts = np.array([bead.points[0] for bead in layer.beads])
        assert sorted(np.searchsorted([40.0, 105.0], starts[:, 0]).tolist()) == (
            [0, 1, 2] if number < 3 else [0, 1]
        )
        assert all(np.allclose(bead.points[0], bead.points[-1]) for bead in layer.beads)
    for bead in made.layers[
        0
    ].beads:  # the whole island is in it: no place farther from it than beads beside each other
        mine = [(0.0, 0.0, 26.0, 30.0), (38.0, -17.0, 102.0, 47.0), (110.0, 0.0, 150.0, 40.0)]
        x0, y0, x1, y1 = mine[int(np.searchsorted([40.0, 105.0], bead.points[0, 0]))]
        places = np.stack(
            np.meshgrid(np.arange(x0 + 0.5, x1, 0.5), np.arange(y0 + 0.5, y1, 0.5)), axis=-1
        ).reshape(-1, 2)
        if x0 == 38.0:
            radius = np.hypot(*(places - [70.0, 15.0]).T)
            places = places[(radius > 14.0) & (radius < 32.0)]
        away = cKDTree(dense(bead, 0.1)[:, :2]).query(places)[0]
        assert (away <= 2.05).mean() > 0.97 and away.max() < 4.0


def _share(bead):
    """Where on its way round a rectangle a contour starts, counted from its lower left corner."""
    flat = bead.points[:, :2]
    way = np.r_[0.0, np.cumsum(np.hypot(*np.diff(flat, axis=0).T))]
    return float(-way[np.argmin(flat.sum(axis=1))] / way[-1] % 1.0)


def test_starts_that_are_spread_keep_away_from_neighbours_and_from_the_layers_below():
    made = planned(box((0, 0, 0), (60, 44, 40)), fill="contours", starts="spread")
    rings = [
        [bead for bead in layer.beads if np.allclose(bead.points[0], bead.points[-1])]
        for layer in made.layers
    ]
    shares = np.array([[_share(bead) for bead in layer] for layer in rings])
    assert shares.shape == (10, 5)
    for axis, away in (
        (0, 1),
        (0, 2),
        (0, 3),
        (1, 1),
    ):  # up to three layers below, and the contour beside
        apart = np.abs(np.roll(shares, -away, axis=axis) - shares).take(
            range(shares.shape[axis] - away), axis=axis
        )
        assert np.minimum(apart, 1.0 - apart).min() > 0.13
    aligned = planned(box((0, 0, 0), (60, 44, 40)), fill="contours")
    assert len({tuple(np.round(layer.beads[-1].points[0][:2], 6)) for layer in aligned.layers}) == 1


def test_lines_of_every_second_layer_start_at_their_other_end():
    made = planned(box((0, 0, 0), (60, 44, 16)), fill="lines", starts="spread", fill_angle_step=0.0)
    lines = [
        [bead.points[:, :2] for bead in layer.beads if len(bead.points) == 2]
        for layer in made.layers
    ]
    ends = [np.round(layer, 6) for layer in lines]
    assert len(ends) == 4 and len(ends[0]) > 8
    for below, above in zip(ends, ends[1:]):
        turned = {(*line[0], *line[1]) for line in above}
        assert {(*line[1], *line[0]) for line in below} == turned


def test_no_layer_takes_less_than_asked_for_and_islands_cool_alike():
    """Rods of unequal height, so that upper layers are shorter; times along the beads and straight between them."""
    process = ProcessParameters()
    rods = [
        box((40 * k, 0, 0), (40 * k + 25 - 5 * k, 25, 24 - 8 * k), f"rod {k}") for k in (2, 0, 1)
    ]
    made = planned(*rods, fill="contours", process=process, min_layer_time=60.0)
    took, at = [], None
    for layer in made.layers:
        seconds = 0.0
        for bead in layer.beads:
            if at is not None:
                seconds += np.linalg.norm(bead.points[0] - at) / process.rapid_speed
            seconds += (np.linalg.norm(np.diff(bead.points, axis=0), axis=1) / bead.speed[1:]).sum()
            at = bead.points[-1]
        took.append(seconds)
    waits = [layer.wait for layer in made.layers]
    assert waits[0] == 0.0 and min(took) < 50.0 and max(took) > 60.0
    np.testing.assert_allclose(waits[1:], np.maximum(60.0 - np.array(took[:-1]), 0.0), atol=1e-9)
    for number, layer in enumerate(made.layers):
        island = [int(bead.points[:, 0].mean() // 40) for bead in layer.beads]
        first = [one for k, one in enumerate(island) if k == 0 or island[k - 1] != one]
        assert first == [
            k for k in range(3) if 4 * number < 24 - 8 * k
        ]  # the same in every layer, each once
    (issue,) = [issue for issue in made.issues if issue.code == "WAITS"]
    assert (
        f"before {sum(wait > 0.0 for wait in waits)} of 6 layers" in issue.message
        and "60 s" in issue.message
    )
    usual = planned(*rods, fill="contours", process=process)
    assert usual.length == pytest.approx(made.length) and not any(
        layer.wait for layer in usual.layers
    )


@pytest.mark.parametrize("way", [(0, 0, 1), (1, 0, 0), (0, -1, 0), (1, 2, -3)])
@pytest.mark.always("way1", "way3")
def test_any_direction(way):
    """The same part turned is deposited alike: as many layers, as long beads, the tool along the direction."""
    unit = np.array(way) / np.linalg.norm(way)
    made = planned(tube(CONE), direction=" ".join(map(str, way)))
    heights = np.array(
        [
            [float((bead.points @ unit).min()), float((bead.points @ unit).max())]
            for _, _, bead in made
        ]
    )
    lowest = float((tube(CONE).vertices @ unit).min())
    np.testing.assert_allclose(heights[:, 0], heights[:, 1], atol=1e-9)
    steps = (heights[:, 0] - lowest) / 4.0
    np.testing.assert_allclose(steps, np.round(steps), atol=1e-9)
    for _, _, bead in made:
        np.testing.assert_allclose(bead.tool, np.tile(unit, (len(bead), 1)), atol=1e-12)
    np.testing.assert_allclose(made.frame[:3, 2], unit, atol=1e-12)


def test_the_best_direction_is_the_one_that_needs_no_support():
    """A T that lies down leaves nothing over nothing, as upside down, and is lower."""
    outline = [(-5, 0), (5, 0), (5, 30), (40, 30), (40, 40), (-40, 40), (-40, 30), (-5, 30)]
    cap = [(0, 1, 2), (0, 2, 7), (6, 7, 5), (7, 2, 5), (2, 3, 4), (2, 4, 5)]
    solids = prepare_stack(
        [prism(outline, cap, -10.0, 10.0)], SolidParameters(direction="auto", layer_height=2.0), "T"
    )
    np.testing.assert_allclose(solids.groups[0].base.frame[:3, 2], [0.0, 1.0, 0.0], atol=1e-12)
    (issue,) = [issue for issue in solids.issues if issue.code == "DIRECTION"]
    assert "the height is 20 mm" in issue.message and "1400 mm^2" in issue.message


def test_faces_where_touching_solids_meet_lean_over_nothing():
    """A T of a stem and a plate, drawn apart and overlapping by a millimetre: as good to lay down as the T in one piece, and
    what leans out along Z is what the plate has beside the stem."""

    def told(*bodies, fuse="auto"):
        solids = prepare_stack(
            bodies, SolidParameters(direction="auto", layer_height=2.0, fuse=fuse), "T"
        )
        (issue,) = [issue for issue in solids.issues if issue.code == "DIRECTION"]
        return solids.groups[0].base.frame[:3, 2], issue.message

    def along_z(message):
        return float(message.split("along (0, 0, 1) the overhang would be ")[1].split(" mm^2")[0])

    plate = box((-40, -10, 30), (40, 10, 40))
    for stem in (box((-5, -10, 0), (5, 10, 30)), box((-5, -10, 0), (5, 10, 31))):
        way, message = told(stem, plate)
        assert abs(way[1]) == 1.0 and "the height is 20 mm" in message
        assert along_z(message) == pytest.approx(1400.0, rel=0.02)
    assert along_z(told(stem, plate, fuse="none")[1]) == pytest.approx(1600.0)
    # a foot that the stem stands on does not count either: none of its area is over nothing
    way, message = told(
        box((-5, -10, 0), (5, 10, 30)),
        box((-20, -10, -10), (20, 10, 0)),
        box((-20, -10, 30), (20, 10, 40)),
    )
    assert abs(way[1]) == 1.0 and along_z(message) == pytest.approx(600.0, rel=0.02)


@pytest.mark.parametrize(
    "lean, most, told",
    [(30, 45, False), (50, 45, True), (50, 60, False), (80, 89, False), (88, 90, False)],
)
@pytest.mark.always("30-45-False", "50-45-True", "50-60-False", "80-89-False")
def test_walls_that_lean_out_are_told(lean, most, told):
    """A frustum upside down; its area over each layer is that of the ring by which it is wider, less what may lean out."""
    height = 10.0 if told else 6.0  # three layers: wide ones take long
    out = height * math.tan(math.radians(lean))
    cone = tube([(0.5, 0.0), (30.0, 0.0), (30.0 + out, height), (0.5, height)])
    made = planned(cone, layer_height=2.0, max_overhang=math.radians(most), fill="contours")
    found = [issue for issue in made.issues if issue.code == "OVERHANG"]
    assert bool(found) == told
    if told:
        inner = 30.0 + 1.0 * math.tan(math.radians(lean))
        outer = inner + 2.0 * math.tan(math.radians(lean))
        free = math.pi * (outer**2 - (inner + 2.0 * math.tan(math.radians(most)) + ERROR) ** 2)
        assert float(found[0].message.split(" mm^2")[0]) == pytest.approx(free, rel=0.05)
        assert [issue.layer for issue in found] == [1, 2, 3, 4]  # every layer stays in the report
        (line,) = summarised(found)
        assert line.layer == 4 and line.message.startswith(
            "4 findings in layers 1 to 4, of which the worst is: "
        )


def test_a_wall_thinner_than_a_bead_gets_one_bead_and_says_so():
    made = planned(box((0, 0, 0), (60, 2, 8)), widths="fixed")
    assert all(len(layer.beads) == 1 for layer in made.layers)
    assert {issue.code for issue in made.issues} >= {"THIN_SINGLE"}


def test_a_wall_thinner_than_a_bead_gets_one_bead_as_wide_as_it_is():
    made = planned(box((0, 0, 0), (60, 2, 8)), widths="adaptive")
    assert all(len(layer.beads) == 1 for layer in made.layers)
    for layer in made.layers:
        assert layer.beads[0].width == pytest.approx(2.0, abs=0.02)
    assert not [issue.message for issue in made.issues if issue.code == "THIN_SINGLE"]


@pytest.mark.parametrize("low", [0.0, 23.7, -0.3])
def test_a_wall_as_thick_as_a_bead_is_wide_has_none_that_stands_out(low):
    made = planned(box((0, low, 0), (60, low + 4.0, 8)))
    assert all(len(layer.beads) == 1 for layer in made.layers)
    assert not [issue.message for issue in made.issues if issue.code == "THIN_SINGLE"]


@pytest.mark.parametrize(
    "height, cut_at, layers",
    [
        (10.0, "middle", 5),
        (9.0, "middle", 4),
        (9.1, "middle", 5),
        (1.1, "middle", 1),
        (10.0, "bottom", 5),
        (10.0, "top", 5),
        (9.9, "top", 4),
        (8.1, "bottom", 5),
    ],
)
def test_number_of_layers(height, cut_at, layers):
    made = planned(box((0, 0, 0), (30, 30, height)), layer_height=2.0, cut_at=cut_at)
    assert len(made.layers) == layers


def test_a_part_lower_than_any_cut_is_refused():
    with pytest.raises(InputError) as caught:
        planned(box((0, 0, 5), (30, 30, 5.9)), layer_height=2.0)
    assert caught.value.code == "TOO_LOW" and "0.9 mm high" in caught.value.message
    assert "use at most 1.78 mm" in caught.value.message
    assert len(planned(box((0, 0, 5), (30, 30, 5.9)), layer_height=1.79).layers) == 1


@pytest.mark.parametrize("text", ["0 0 0", "up", "1 2", "nan 0 1", "0 0 inf"])
def test_a_direction_along_no_axis_is_refused(text):
    with pytest.raises(InputError) as caught:
        SolidParameters(direction=text)
    assert caught.value.code == "BAD_VALUE" and caught.value.where == "strategy.direction"


def test_a_margin_stands_out_beside_and_above():
    made = planned(box((0, 0, 0), (40, 30, 8)), margin=5.0, fill="contours")
    low, high = (
        f([f(bead.points, axis=0) for _, _, bead in made], axis=0) for f in (np.min, np.max)
    )
    np.testing.assert_allclose(low, [-3.0, -3.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(high[:2], [43.0, 33.0], atol=1e-6)
    assert high[2] == pytest.approx(8.0)  # 5 mm above: one layer more


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.always("0", "1")
def test_random_hulls_are_filled(seed):
    rng = np.random.default_rng(seed)
    body = hull(rng.normal(size=(20, 3)) * (25.0, 20.0, 15.0))
    made = planned(body, layer_height=3.0, fill=("contours", "zigzag")[seed % 2])
    equations = ConvexHull(body.vertices).equations
    for _, _, bead in made:
        at = bead.points + (0.0, 0.0, 1.5)  # where it was cut
        out = (at @ equations[:, :3].T + equations[:, 3]).max()
        assert out < 2.0 + ERROR  # single beads of narrow tips stand out by up to half a bead
    volume = ConvexHull(body.vertices).volume
    assert 0.9 * volume < made.length * 12.0 < 1.2 * volume  # beads that close gaps overlap others


@pytest.mark.parametrize(
    ("angle", "step"), [(0.0, 0.0), (90.0, 0.0), (30.0, 40.0), (-15.0, -120.0)]
)
@pytest.mark.always("0.0-0.0", "30.0-40.0", "-15.0--120.0")
def test_closed_beads_of_plane_layers_start_where_the_seam_says(angle, step):
    """On a ring that lies beside the origin: each layer's by the azimuth about its middle; where a box is farthest out that
    way. With a step no layer's start lies over that of the layer below."""
    process = ProcessParameters(seam=SeamParameters(math.radians(angle), math.radians(step)))
    ring = tube(RING)
    ring = Body("ring", ring.vertices + [25.0, -70.0, 0.0], ring.triangles)
    made = planned(ring, process=process)
    starts = []
    for number, layer in enumerate(made.layers):
        closed = [bead for bead in layer.beads if bead.closed]
        assert len(closed) > 3
        for bead in closed:
            off = bead.points[0, :2] - bead.points[:-1, :2].mean(axis=0)
            asked = angle + number * step
            turned = math.degrees(math.atan2(off[1], off[0])) - asked
            assert abs((turned + 180.0) % 360.0 - 180.0) < math.degrees(4.0 / np.hypot(*off)), (
                number,
                turned,
            )
        starts.append(max(closed, key=lambda bead: np.ptp(bead.points[:, 0])).points[0, :2])
    apart = np.linalg.norm(np.diff(starts, axis=0), axis=1)
    assert (apart > 8.0).all() if step else (apart < 0.1).all()
    for number, layer in enumerate(planned(box((0, 0, 0), (40, 24, 12)), process=process).layers):
        way = np.array(
            [
                math.cos(math.radians(angle + number * step)),
                math.sin(math.radians(angle + number * step)),
            ]
        )
        for bead in layer.beads:
            reach = bead.points[:, :2] @ way
            assert not bead.closed or reach[0] > reach.max() - 1e-6


def pins(radius, names=("plate", "pin")):
    """A plate on four round pins, 14 mm long, and how much of it is pins, mm2 a layer."""
    plate = box((0, 0, 14), (60, 60, 20), names[0])
    angle = np.linspace(0.0, 2.0 * np.pi, 48, endpoint=False)
    ring = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    bodies = [plate]
    for x, y in product((10.0, 50.0), repeat=2):
        points = np.vstack([np.column_stack([ring + (x, y), np.full(48, z)]) for z in (0.0, 14.0)])
        bodies.append(hull(points, names[1]))
    return bodies


def test_round_pins_narrower_than_a_bead_get_a_dot_in_every_layer():
    made = planned(*pins(2.2), layer_height=2.0, bead_spacing=5.0, direction="0 0 1")
    assert [len(layer.beads) for layer in made.layers[:7]] == [4] * 7 and len(made.layers) == 10
    area = 24.0 * math.sin(math.pi / 24.0) * 2.2**2
    for number, layer in enumerate(made.layers[:7]):
        for bead in layer.beads:
            assert bead.points[:, 2] == pytest.approx(2.0 * number)
            wide = 5.0 if bead.width is None else bead.width[0]
            assert wide * bead.length == pytest.approx(area, rel=0.01)
    assert not [issue for issue in made.issues if issue.code in ("NO_BEAD", "LAYER_WITHOUT_BEAD")]


def test_layers_without_beads_keep_their_number_and_are_named():
    """Pins of 1 mm: seven layers without a bead under the plate, which is layer 7 in all messages."""
    made = planned(*pins(0.5), layer_height=2.0, bead_spacing=5.0, direction="0 0 1")
    assert [len(layer.beads) > 0 for layer in made.layers] == [False] * 7 + [True] * 3
    assert [layer.first for layer in made.layers] == [False] * 7 + [True, False, False]
    for number, _, bead in made:
        assert bead.points[:, 2] == pytest.approx(2.0 * number)
    named = {issue.code: issue for issue in made.issues}
    assert named["OVERHANG"].layer == 7
    told = named["LAYER_WITHOUT_BEAD"]
    assert told.layer == 0 and "7 layer(s)" in told.message and " 0-6; " in told.message
    area = 7 * 4 * 24.0 * math.sin(math.pi / 24.0) * 0.5**2
    found = float(re.search(r"the total is ([\d.]+) mm\^2", str(told.message))[1])
    assert found == pytest.approx(area, rel=0.01)


@pytest.mark.parametrize("fill", ["contours", "lines", "zigzag"])
def test_open_beads_of_a_thin_plate_begin_at_alternate_ends(fill):
    process = ProcessParameters(direction="alternate")
    plate = box((0, 0, 0), (60, 5, 20))
    made = planned(plate, fill=fill, bead_spacing=5.0, process=process, fill_angle_step=0.0)
    starts = [float(layer.beads[0].points[0, 0]) for layer in made.layers]
    assert len(starts) == 5 and not any(layer.beads[0].closed for layer in made.layers)
    assert all((a > 30.0) != (b > 30.0) for a, b in zip(starts, starts[1:]))
    usual = planned(plate, fill=fill, bead_spacing=5.0, fill_angle_step=0.0)
    assert len({float(layer.beads[0].points[0, 0]) > 30.0 for layer in usual.layers}) == 1


@pytest.mark.parametrize("width, apart, times", [(15.0, 5.0, "3 times"), (8.0, 5.0, "1.6 times")])
def test_beads_much_wider_than_they_are_apart_are_told(width, apart, times):
    """The wire feeds for their width what has no room at their spacing; not where a feed, or the spacing, is what counts."""
    block, wide = box((0, 0, 0), (60, 40, 10)), {"bead_width": width, "fill_width": "bead_width"}

    def told(**process):
        path = planned(
            block, process=ProcessParameters(**process), bead_spacing=apart, layer_height=2.0
        )
        return [issue for issue in path.issues if issue.code == "BEAD_SPACING"]

    (issue,) = told(**wide)
    assert issue.level == "warning" and times in issue.message
    assert f"{width:g} mm wide" in issue.message and f"{apart:g} mm apart" in issue.message
    assert not told(**wide, wire=WireParameters(1.2, 50.0))
    assert not told(bead_width=width, fill_width="spacing")
    assert not told(bead_width=apart / 0.7, fill_width="bead_width")


def test_a_solid_between_two_cuts_is_named_with_its_place_and_volume():
    """A cover of 0.8 mm lies between the cuts at 9 and 11 mm; the foot, counted 2 mm high for 1.2 mm, hides it in the sum."""
    foot = box((0, 0, 0), (60, 40, 1.2), "foot")
    wall = box((0, 0, 1.2), (6, 40, 9.2), "wall")
    cover = box((0, 0, 9.2), (60, 40, 10.0), "cover")
    made = planned(foot, wall, cover, layer_height=2.0, bead_spacing=3.0, direction="0 0 1")
    (issue,) = [issue for issue in made.issues if issue.code == "NOT_DEPOSITED"]
    assert issue.level == "warning" and "1 solid(s)" in issue.message and "cover" in issue.message
    bare = float(re.search(r"mm high, ([\d.]+) of its 1.92 cm3", str(issue.message))[1])
    # over the wall the layer at 8 mm reaches up to 10 mm and covers it, a bead's half beyond the middles of its beads
    assert bare == pytest.approx(0.8 * (60 - 6) * 40 / 1000.0, rel=0.02)
    x, y, z = map(
        float, re.search(r"at \(([-\d.]+), ([-\d.]+), ([-\d.]+)\)", issue.message).groups()
    )
    assert 6.0 < x < 60.0 and 0.0 < y < 40.0 and 9.2 < z < 10.0
    part, left, _ = made.checks.volumes
    assert part == pytest.approx(60 * 40 * 2.0 + 6 * 40 * 8.0) and left >= 1000.0 * bare


@pytest.mark.parametrize("low, high", [(0.0, 0.8), (9.2, 9.9)])
def test_a_thin_solid_that_beads_of_another_cover_is_not_named(low, high):
    thick = box((0, 0, high if low == 0.0 else 0.0), (60, 40, 10.0 if low == 0.0 else 9.2))
    thin = box((0, 0, low), (60, 40, high), "sheet")
    made = planned(thick, thin, layer_height=2.0, bead_spacing=3.0, direction="0 0 1")
    assert not [issue for issue in made.issues if issue.code == "NOT_DEPOSITED"]


def test_a_closed_piece_of_a_mesh_between_two_cuts_is_named_and_a_hollow_is_not():
    block, chip = box((0, 0, 0), (40, 40, 10)), box((60, 0, 5.2), (90, 40, 6.8))
    hollow = box((18, 18, 5.2), (22, 22, 6.8))
    mesh = Body(
        "mesh",
        np.vstack([block.vertices, chip.vertices, hollow.vertices]),
        np.vstack([block.triangles, chip.triangles + 8, hollow.triangles[:, ::-1] + 16]),
    )
    made = planned(mesh, layer_height=2.0, bead_spacing=3.0, direction="0 0 1")
    (issue,) = [issue for issue in made.issues if issue.code == "NOT_DEPOSITED"]
    assert "1 solid(s)" in issue.message and "1.92 of its 1.92 cm3" in issue.message


def rod(radius, sides):
    angle = 2.0 * np.pi * (np.arange(sides) + 0.5) / sides
    ring = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return hull(np.vstack([np.column_stack([ring, np.full(sides, z)]) for z in (0.0, 12.0)]), "rod")


@pytest.mark.parametrize("fill", ["contours", "connected", "spiral", "lines", "zigzag"])
@pytest.mark.parametrize("sides, radius", [(96, 2.6), (96, 3.0), (96, 4.0), (4, 4.4), (6, 3.3)])
def test_a_rod_hardly_wider_than_a_bead_is_fed_its_volume(fill, sides, radius):
    """A contour half a bead inside the border fed 55 % of a rod of 3 mm with beads of 5 mm, and nothing of one of 2.6 mm."""
    made = planned(
        rod(radius, sides), layer_height=2.0, bead_spacing=5.0, direction="0 0 1", fill=fill
    )
    area = 0.5 * sides * math.sin(2.0 * math.pi / sides) * radius**2
    assert len(made.layers) == 6
    for layer in made.layers:
        volume = 0.0
        for bead in layer.beads:
            step = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
            wide = np.full(len(bead), 5.0) if bead.width is None else bead.width
            volume += float(0.5 * (wide[1:] + wide[:-1]) @ step)
            assert np.hypot(*bead.points[:, :2].T).max() < radius
        assert volume == pytest.approx(area, rel=0.025)
    assert not [one for one in made.issues if one.code in ("DEPOSITED_TWICE", "NO_BEAD")]


def spacing_issues(overlap, model=None, **process):
    strategy = SolidParameters(
        layer_height=2.5,
        chord_error=ERROR,
        bead_spacing=7.0,
        bead_overlap=overlap,
        direction="0 0 1",
    )
    solids = prepare_stack([box((0, 0, 0), (60, 60, 5))], strategy, "part")
    made = plan(solids, strategy, BuildDirectionParameters(), ProcessParameters(**process), model)
    return [issue for issue in made.issues if issue.code == "BEAD_SPACING"]


@pytest.mark.parametrize("overlap, told", [(0.3, False), (0.6, True), (None, False)])
def test_an_overlap_that_a_bead_model_overfills_is_told(overlap, told):
    """The model's wire feeds a bead of 9.5 mm whatever lies beside it."""
    model = load("csw")
    issues = spacing_issues(overlap, model, bead_width=9.5, bead_model="csw")
    assert len(issues) == told
    if told:
        section = math.pi * 0.6**2 * model.wire_feed / model.straight_speed(9.5)
        room = 0.4 * 9.5 * 2.5
        assert f"{section / room:.3g} times the available {room:.4g} mm3" in issues[0].message
        balanced = 100.0 * (1.0 - section / 2.5 / 9.5)
        assert f"strategy.bead_overlap to {balanced:.3g} %" in issues[0].message
        assert not spacing_issues(balanced / 100.0, model, bead_width=9.5, bead_model="csw")


def test_an_overlap_that_the_wire_overfills_is_told_with_a_feed_of_its_own_too():
    (issue,) = spacing_issues(0.5, bead_width=9.5)
    assert "2 times" in issue.message and "bead_overlap to 26.2 %" in issue.message
    travel = ProcessParameters().travel_speed
    wire = WireParameters(1.2, 9.5 * 2.5 * travel / (math.pi * 0.36))  # for the width
    (issue,) = spacing_issues(0.5, bead_width=9.5, wire=wire)
    assert "2 times" in issue.message
    half = WireParameters(1.2, wire.feed / 2.0)  # for the spacing
    assert not spacing_issues(0.5, bead_width=9.5, wire=half)


@pytest.mark.parametrize("share, codes", [(1.0, []), (0.5, []), (0.75, ["FEED_BALANCE"])])
def test_a_feed_for_the_room_of_beads_that_overlap_balances(share, codes):
    """Beads of 9.5 mm half over one another fill the part at half the feed that their width would take."""
    travel = ProcessParameters().travel_speed
    wire = WireParameters(1.2, share * 9.5 * 2.5 * travel / (math.pi * 0.36))
    process = ProcessParameters(bead_width=9.5, wire=wire)
    made = planned(
        box((0, 0, 0), (160, 160, 5)), layer_height=2.5, bead_overlap=0.5, process=process
    )
    issues = set_wire_feed(replace(made, issues=()), process, None).issues
    assert [issue.code for issue in issues] == codes


def test_a_thin_flange_of_one_solid_is_not_made_up_for_by_a_foot_that_counts_too_high():
    """A flange of 0.8 mm between two cuts, and a foot of 1.2 mm that counts as high as a layer of 2 mm, of one solid."""
    bodies = [
        box((0, 0, 0), (60, 40, 1.2)),
        box((0, 0, 1.2), (6, 40, 9.2)),
        box((0, 0, 9.2), (60, 40, 10.0)),
    ]
    outline = [(0, 0), (60, 0), (60, 1.2), (6, 1.2), (6, 9.2), (60, 9.2), (60, 10), (0, 10)]
    cap = [(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 7), (4, 5, 6), (4, 6, 7)]
    one = prism(outline, cap, 0.0, 40.0)
    for made in (
        planned(one, layer_height=2.0, bead_spacing=3.0, direction="0 0 1"),
        planned(*bodies, layer_height=2.0, bead_spacing=3.0, direction="0 0 1"),
    ):
        part, left, beside = made.checks.volumes
        assert part == pytest.approx(60 * 40 * 2.0 + 6 * 40 * 8.0)
        assert (
            1728.0 < left < 1.04 * 1728.0
        )  # 0.8 x 54 x 40 mm of the flange, and corners that are round
        assert beside == pytest.approx(0.8 * 54 * 40, rel=0.02)  # above the foot


def test_curved_layers_are_not_compared_with_what_lies_between_planes():
    """Layers round a corner, from a foot along an arm: by the heights of planes a third of it would be left and beside."""
    foot, arm = box((0, 0, 0), (16, 16, 32)), box((16, 0, 16), (48, 16, 32))
    made = planned(foot, arm, layers="geodesic", bead_spacing=4.0, direction="0 0 1")
    part, left, beside = made.checks.volumes
    assert part == pytest.approx(2 * 16 * 16 * 32.0, rel=1e-3)
    assert left < 0.06 * part and beside < 0.06 * part


@pytest.mark.parametrize("radius", [1.5, 2.2, 2.6, 3.0, 3.5, 4.0])
def test_rods_of_beads_that_overlap_are_fed_by_the_width_of_these(radius):
    """The wire is fed for 5 mm, also where beads are 4 mm apart."""
    made = planned(
        rod(radius, 96),
        layer_height=2.0,
        bead_spacing=4.0,
        direction="0 0 1",
        process=ProcessParameters(bead_width=5.0),
    )
    assert made.bead_width == 5.0 and len(made.layers) == 6
    for layer in made.layers:
        (bead,) = layer.beads
        wide = np.full(len(bead), 5.0) if bead.width is None else bead.width
        step = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        volume = float(0.5 * (wide[1:] + wide[:-1]) @ step)
        assert volume == pytest.approx(math.pi * radius**2, rel=0.025)
    assert not [one for one in made.issues if one.code in ("OPEN_GAP", "NO_BEAD")]
