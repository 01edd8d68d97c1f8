# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rotary solids against known geometry: beads are on their cones, inside the solid and nowhere
else."""

import math

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.mesh.solid import SolidMesh
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.geometry.on_hub import Base, Group, SolidsOnHub, upright
from freecad_am.core.issues import InfeasibleError, InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import DevelopableParameters
from freecad_am.core.parameters.process import ProcessParameters, WireParameters
from freecad_am.core.process import wire
from freecad_am.core.strategies.solids.plan import plan as plan_solids

CYLINDER, CONE = Developable(45.0), Developable(60.0, 200.0)
BOX_LOW, BOX_HIGH = (
    np.array([20.0, -17.0, 20.0]),
    np.array([84.0, 17.0, 95.0]),
)  # of the box that is a blade
ERROR = 0.05


def box(low=BOX_LOW, high=BOX_HIGH, turned=0.0, name="blade"):
    """A box rotated about the hub's axis."""
    corners = np.array(
        [[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    )
    hull = ConvexHull(corners)
    faces = hull.simplices.copy()
    a, b, c = (corners[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    cos, sin = math.cos(turned), math.sin(turned)
    return Body(
        name,
        corners @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1.0]]),
        faces.astype(np.int64),
    )


def collar(inner, outer, low, high, sides=180, name="collar"):
    """A ring about the axis with flat ends."""
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rows = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(sides, z)], axis=1)
        for r, z in ((inner, low), (outer, low), (outer, high), (inner, high))
    ]
    faces = []
    for k in range(4):
        for j in range(sides):
            a, b = k * sides + j, k * sides + (j + 1) % sides
            c, d = (k + 1) % 4 * sides + j, (k + 1) % 4 * sides + (j + 1) % sides
            faces += [(a, b, d), (a, d, c)]
    return sound(Body(name, np.vstack(rows), np.array(faces, dtype=np.int64)))


def sound(body):
    """Check that the body is a closed solid with outward triangles, and return it."""
    SolidMesh(body.vertices, body.triangles).refuse_unsound(body.name)
    return body


def solids(surface, *bodies, frame=None):
    base = Base("the hub", surface, np.eye(4) if frame is None else frame)
    return SolidsOnHub("part", (Group(base, bodies),), 0.0)


def planned(hub_solids, build=None, process=None, model=None, **values):
    parameters = {"layer_height": 6.0, "chord_error": ERROR, "bead_spacing": 6.0, **values}
    return plan_solids(
        hub_solids,
        DevelopableParameters(**parameters),
        build or BuildDirectionParameters(),
        process or ProcessParameters(),
        model,
    )


def distance_from_hub(surface, points):
    """Distance from the hub along the normal of its meridian line."""
    rho, z = np.hypot(points[:, 0], points[:, 1]), points[:, 2]
    if math.isinf(surface.height):
        return rho - surface.radius
    start, end = np.array([surface.radius, 0.0]), np.array([0.0, surface.height])
    direction = (end - start) / np.hypot(*(end - start))
    return (rho - start[0]) * direction[1] - (z - start[1]) * direction[0]


def unroll_points(surface, points):
    """The unrolled plane by polar coordinates about the apex, or by arc length, independent of the
    tested code."""
    theta = np.arctan2(points[:, 1], points[:, 0])
    if math.isinf(surface.height):
        return np.stack([np.hypot(points[:, 0], points[:, 1]) * theta, points[:, 2]], axis=1)
    rho = np.hypot(points[:, 0], points[:, 1])
    sine = surface.radius / math.hypot(surface.radius, surface.height)
    s, phi = rho / sine, theta * sine
    return np.stack([s * np.sin(phi), -s * np.cos(phi)], axis=1)


def to_lines(points, lines):
    """Distance (n,) of points from polylines."""
    best = np.full(len(points), np.inf)
    for line in lines:
        a, b = line[:-1], line[1:]
        segments = b - a
        for block in np.array_split(
            np.arange(len(points)), max(1, len(points) * len(a) // 2_000_000)
        ):
            off = points[block, None] - a
            share = np.clip(
                (off * segments).sum(axis=2)
                / np.maximum((segments * segments).sum(axis=1), 1e-300),
                0.0,
                1.0,
            )
            best[block] = np.minimum(
                best[block], np.linalg.norm(off - share[..., None] * segments, axis=2).min(axis=1)
            )
    return best


@pytest.mark.parametrize("fill", ["contours", "lines", "spiral", "zigzag"])
@pytest.mark.parametrize("surface", [CYLINDER, CONE], ids=["cylinder", "cone"])
@pytest.mark.always
def test_beads_lie_on_their_surfaces_and_in_the_solid(surface, fill):
    """Points on the cone to rounding, chords within the chord error, layers one layer height
    apart."""
    path = planned(solids(surface, box()), fill=fill)
    assert path.family == "developable" and len(path.layers) >= 6
    for index, layer in enumerate(path.layers):
        for bead in layer.beads:
            assert np.abs(distance_from_hub(surface, bead.points) - 6.0 * index).max() < 1e-9
            middle = 0.5 * (bead.points[1:] + bead.points[:-1])
            assert np.abs(distance_from_hub(surface, middle) - 6.0 * index).max() < ERROR
            inside = ((bead.points > BOX_LOW - ERROR) & (bead.points < BOX_HIGH + ERROR)).all(
                axis=1
            )
            assert inside.all()
            normal = np.stack(
                [
                    bead.points[:, 0]
                    / np.hypot(bead.points[:, 0], bead.points[:, 1])
                    * math.cos(surface.taper),
                    bead.points[:, 1]
                    / np.hypot(bead.points[:, 0], bead.points[:, 1])
                    * math.cos(surface.taper),
                    np.full(len(bead), math.sin(surface.taper)),
                ],
                axis=1,
            )
            np.testing.assert_allclose(bead.build, normal, atol=1e-9)
            np.testing.assert_allclose(bead.tool, normal, atol=1e-9)


@pytest.mark.parametrize("fill", ["contours", "lines", "spiral", "zigzag"])
@pytest.mark.parametrize("surface", [CYLINDER, CONE], ids=["cylinder", "cone"])
@pytest.mark.always
def test_beads_cover_the_solid_and_nothing_else(surface, fill):
    """A raster over the surface, inside or outside the box by its planes, against beads as wide as
    their spacing."""
    path = planned(solids(surface, box()), fill=fill)
    layer = 3
    offset = surface.offset(6.0 * layer)
    z = np.arange(BOX_LOW[2] - 6.0, BOX_HIGH[2] + 6.0, 0.7)
    theta = np.arange(-0.6, 0.6, 0.7 / offset.radius)
    theta, z = (grid.ravel() for grid in np.meshgrid(theta, z))
    rho = offset.radius if math.isinf(offset.height) else offset.radius * (1.0 - z / offset.height)
    raster = np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)
    inside = ((raster > BOX_LOW) & (raster < BOX_HIGH)).all(axis=1)
    lines = [unroll_points(offset, bead.points) for bead in path.layers[layer].beads]
    plane = unroll_points(offset, raster)
    distance = to_lines(plane, lines)
    area = (
        np.cos(np.arctan2(1.0, 1.0)) * rho if np.ndim(rho) else np.ones(len(z))
    )  # of a raster cell, to a factor
    covered = distance <= 3.0 + 0.02
    assert area[covered & inside].sum() > 0.99 * area[inside].sum() - 4.0 * 0.25 * (6.0**2) * (
        1 - math.pi / 4
    )
    assert area[covered & ~inside].sum() < 0.01 * area[inside].sum()
    assert (
        distance[inside].max() < 3.0 * math.sqrt(2.0) + 0.2
    )  # nothing open except the sharp corners of the box


@pytest.mark.parametrize("surface", [CYLINDER, CONE], ids=["cylinder", "cone"])
def test_neighbouring_contours_are_the_spacing_apart(surface):
    path = planned(solids(surface, box()))
    for index in (0, 4):
        offset = surface.offset(6.0 * index)
        beads = [bead for bead in path.layers[index].beads if bead.closed]
        assert len(beads) >= 2
        outer, inner = (
            unroll_points(offset, bead.points)
            for bead in sorted(beads, key=lambda bead: -bead.length)[:2]
        )
        assert np.abs(to_lines(inner, [outer]) - 6.0).max() < 0.06


def test_order_of_beads_is_around_the_axis_inner_rings_first():
    """Beads are ordered around the axis, inner rings first."""
    hub_solids = solids(
        CYLINDER, *(box(turned=turn, name=f"blade {k}") for k, turn in enumerate((0.1, 2.2, 4.3)))
    )
    path = planned(hub_solids)
    layer = path.layers[2].beads
    middles = [bead.points[:-1].mean(axis=0) for bead in layer]
    angle = [math.atan2(middle[1], middle[0]) % (2.0 * np.pi) for middle in middles]
    blade = [int(np.argmin([abs(value - turn) for turn in (0.1, 2.2, 4.3)])) for value in angle]
    closed = [k for k, bead in enumerate(layer) if bead.closed]
    outer = closed[-3:]
    assert [blade[k] for k in outer] == [0, 1, 2]
    inner = closed[:3]
    assert [blade[k] for k in inner] == [0, 1, 2] and layer[inner[0]].length < layer[
        outer[0]
    ].length
    assert path.layers[0].first and not any(value.first for value in path.layers[1:])
    one_by_one = planned(hub_solids, order="feature")
    assert len(one_by_one.layers) == 3 * len(path.layers)
    assert [index for index, value in enumerate(one_by_one.layers) if value.first] == [
        k * len(path.layers) for k in range(3)
    ]
    assert one_by_one.length == pytest.approx(path.length)


def test_a_turned_hub_has_the_same_beads_turned():
    """Frames and cuts do not change the beads: a blade across the half turn is cut like any
    other."""
    plain = planned(solids(CONE, box()), fill="zigzag")
    astride = planned(solids(CONE, box(turned=math.pi)), fill="zigzag")
    frame = upright(np.array([5.0, -3.0, 8.0]), np.array([0.6, 0.0, 0.8]))
    moved = Body("blade", box().vertices @ frame[:3, :3].T + frame[:3, 3], box().triangles)
    leaning = planned(solids(CONE, moved, frame=frame), fill="zigzag")
    for (_, _, bead), (_, _, astride_bead), (_, _, leaning_bead) in zip(
        plain, astride, leaning, strict=True
    ):
        np.testing.assert_allclose(astride_bead.points, bead.points * [-1.0, -1.0, 1.0], atol=1e-6)
        np.testing.assert_allclose(
            leaning_bead.points, bead.points @ frame[:3, :3].T + frame[:3, 3], atol=1e-6
        )
        np.testing.assert_allclose(leaning_bead.build, bead.build @ frame[:3, :3].T, atol=1e-9)


def test_the_cut_is_turned_until_no_contour_crosses_it():
    """Two parts of one body, one of them at the default cut, opposite to the middle of both."""
    blades = [box(turned=turn) for turn in (0.0, 2.0, 4.2)]
    count = np.cumsum([0, *(len(blade.vertices) for blade in blades)])
    body = Body(
        "blades",
        np.vstack([blade.vertices for blade in blades]),
        np.vstack([blade.triangles + start for blade, start in zip(blades, count)]),
    )
    one_body = planned(solids(CONE, body))
    single = planned(solids(CONE, *blades))
    assert one_body.length == pytest.approx(single.length, rel=2e-5)
    assert one_body.bead_count == single.bead_count


def test_solids_all_round_the_hub_have_closed_beads():
    for surface, body in (
        (CYLINDER, collar(40.0, 60.0, 10.0, 40.0)),
        (CONE, collar(30.0, 80.0, 10.0, 40.0)),
    ):
        path = planned(solids(surface, body), layer_height=4.0)
        for index, layer in enumerate(path.layers):
            round_ = [bead for bead in layer.beads if bead.closed]
            assert len(round_) >= 2
            for bead in layer.beads:
                assert np.abs(distance_from_hub(surface, bead.points) - 4.0 * index).max() < 1e-9
                step = np.diff(np.unwrap(np.arctan2(bead.points[:, 1], bead.points[:, 0])))
                assert abs(abs(step.sum()) - 2.0 * np.pi) < 1e-6 or not bead.closed
                assert np.linalg.norm(np.diff(bead.points, axis=0), axis=1).max() < 30.0
    assert max(bead.points[:, 2].max() for _, _, bead in path) < 40.0


def helix(turns, radius=(38.0, 60.0), pitch=40.0, height=14.0, steps=90):
    """A thread of rectangular section about the axis."""
    angle = np.linspace(0.0, 2.0 * np.pi * turns, int(steps * turns) + 1)
    rings = []
    for rho, up in ((radius[0], 0.0), (radius[1], 0.0), (radius[1], height), (radius[0], height)):
        rings.append(
            np.stack(
                [rho * np.cos(angle), rho * np.sin(angle), pitch * angle / (2.0 * np.pi) + up],
                axis=1,
            )
        )
    n = len(angle)
    faces = [
        (0, n, 2 * n),
        (0, 2 * n, 3 * n),
        (n - 1, 3 * n - 1, 2 * n - 1),
        (n - 1, 4 * n - 1, 3 * n - 1),
    ]
    for k in range(4):
        for j in range(n - 1):
            a, b, c, d = k * n + j, k * n + j + 1, (k + 1) % 4 * n + j, (k + 1) % 4 * n + j + 1
            faces += [(a, b, d), (a, d, c)]
    return sound(Body("thread", np.vstack(rings), np.array(faces, dtype=np.int64)))


def test_a_thread_stays_in_one_piece():
    path = planned(solids(CYLINDER, helix(2.5)), layer_height=5.0, chord_error=0.1)
    lengths = [max(bead.length for bead in layer.beads) for layer in path.layers]
    assert min(lengths) > 2.0 * 2.5 * 2.0 * np.pi * 44.0  # out and back
    assert all(
        np.abs(distance_from_hub(CYLINDER, bead.points) - 5.0 * index).max() < 1e-9
        for index, _, bead in path
    )


def test_margin_stands_out_beside_and_above():
    plain, blank = planned(solids(CYLINDER, box())), planned(solids(CYLINDER, box()), margin=7.0)
    assert len(blank.layers) >= len(plain.layers) + 1
    for index, _, bead in blank:
        assert np.abs(distance_from_hub(CYLINDER, bead.points) - 6.0 * index).max() < 1e-9
    low = min(bead.points[:, 2].min() for bead in blank.layers[2].beads)
    assert low == pytest.approx(BOX_LOW[2] - 7.0 + 3.0, abs=0.06)
    top = max(distance_from_hub(CYLINDER, box().vertices))
    assert 6.0 * (len(blank.layers) - 1) < top + 7.0


@pytest.mark.parametrize("direction", ["counter-clockwise", "clockwise", "alternate"])
def test_the_torch_leans_outwards_on_outer_contours_alone(direction):
    """The torch leans outwards on outer contours only."""
    path = planned(
        solids(CYLINDER, box()),
        process=ProcessParameters(direction=direction),
        deflection=math.radians(12.0),
    )
    for layer in path.layers[:4]:
        closed = sorted(
            (bead for bead in layer.beads if bead.closed), key=lambda bead: -bead.length
        )
        outer, inner = closed[:2]
        lean = np.degrees(np.arccos(np.clip((outer.tool * outer.build).sum(axis=1), -1.0, 1.0)))
        np.testing.assert_allclose(lean, 12.0, atol=1e-6)
        out = outer.points - outer.points[:-1].mean(axis=0)
        assert ((outer.tool - outer.build) * out).sum(axis=1).min() > 0.0
        np.testing.assert_allclose(inner.tool, inner.build, atol=1e-12)


def test_lead_and_tilt_are_those_asked_for():
    """Lead and tilt have the requested angles away from bends."""
    build = BuildDirectionParameters(
        lead=math.radians(10.0), tilt=math.radians(-7.0), max_turn="inf"
    )
    lines = {"fill": "lines", "contour": False, "layer_height": 15.0, "chord_error": 0.2 * ERROR}
    path = planned(solids(CONE, box()), build=build, **lines)
    bead = max(path.layers[1].beads, key=lambda bead: bead.length)
    step = (
        np.diff(bead.points, axis=0) / np.linalg.norm(np.diff(bead.points, axis=0), axis=1)[:, None]
    )
    along = step[1:] + step[:-1]
    along /= np.linalg.norm(along, axis=1)[:, None]
    flat = np.diff(unroll_points(CONE, bead.points), axis=0)
    heading = np.unwrap(np.arctan2(flat[:, 1], flat[:, 0]))
    turn = np.abs(np.diff(heading))
    arc_length = np.cumsum(np.hypot(*flat.T))[:-1]
    bend_stations = arc_length[turn > np.radians(5.0)]  # there the torch rotates around the normal
    straight = (turn < np.radians(0.15)) & (
        np.abs(arc_length[:, None] - bend_stations).min(axis=1, initial=np.inf) > 0.15
    )
    assert straight.sum() > 3
    along, tool, normal = along[straight], bead.tool[1:-1][straight], bead.build[1:-1][straight]
    forward = np.degrees(np.arctan2((tool * along).sum(axis=1), (tool * normal).sum(axis=1)))
    np.testing.assert_allclose(forward, 10.0, atol=0.05)
    np.testing.assert_allclose(
        np.degrees(np.arcsin((tool * np.cross(along, normal)).sum(axis=1))), -7.0, atol=0.05
    )


def test_speeds_hold_the_width():
    """Speeds hold the width within the table and the acceleration limit."""
    model = wire.load("csw")
    process = ProcessParameters(bead_width=9.5, wire=WireParameters(feed=model.wire_feed))
    path = planned(solids(CONE, box()), process=process, model=model)
    speed = np.concatenate([bead.speed[1:] for _, _, bead in path]) * 60.0
    assert speed.min() > 410.0 and speed.max() < 830.0  # the paper's range
    straight = (model.width.m / (9.5 - model.width.t)) ** 3
    assert straight <= speed.min() < 1.001 * straight
    for _, _, bead in path:
        assert (np.abs(np.diff(bead.speed[1:] ** 2)) <= 2.0 * 20.0 * bead.length).all()
        steps = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        gain = np.abs(np.diff(bead.speed[1:] ** 2)) / (steps[1:] + steps[:-1])
        assert gain.max() < 20.0 * 1.2  # mm/s2, between middles of segments
        assert bead.width.min() > 9.5 - 1e-6  # never faster than the width allows
    issues = {issue.code: issue for issue in path.issues}
    assert {"BEAD_MODEL", "BEAD_HEIGHT", "TIGHT_BENDS"} <= set(issues) and "WIRE_FEED" not in issues
    assert issues["BEAD_HEIGHT"].level == "warning" and "6 mm" in issues["BEAD_HEIGHT"].message
    ten = ProcessParameters(bead_width=14.0, wire=WireParameters(feed=10.0))
    with_low_feed = planned(solids(CONE, box()), process=ten, model=model)
    assert {"WIRE_FEED", "OUTSIDE_TABLE"} <= {
        issue.code for issue in with_low_feed.issues if issue.level == "warning"
    }
    assert all(bead.width is None for _, _, bead in planned(solids(CONE, box())))


def test_waits_keep_solids_apart_in_time():
    """Waits between layers let each solid cool for the requested time."""
    path = planned(
        solids(CYLINDER, box(), box(turned=2.0)),
        wait=40.0,
        process=ProcessParameters(travel_speed=20.0),
    )
    assert any(layer.wait > 0.0 for layer in path.layers)
    now, end_times, position = 0.0, {}, None
    for layer in path.layers:
        now += layer.wait
        this = {}
        for bead in layer.beads:
            blade = bead.points[:, 0].mean() > 0.0
            now += 0.0 if position is None else np.linalg.norm(bead.points[0] - position) / 100.0
            if blade not in this and blade in end_times:
                assert now - end_times[blade] > 40.0 - 1e-9
            now += bead.length / 20.0
            this[blade], position = now, bead.points[-1]
        end_times.update(this)
    assert not any(layer.wait for layer in planned(solids(CYLINDER, box())).layers)


def test_thin_regions_get_a_single_bead_or_are_refused():
    thin = box(np.array([20.0, -1.5, 20.0]), np.array([70.0, 1.5, 90.0]))
    path = planned(solids(CYLINDER, thin))
    assert all(len(layer.beads) == 1 and not layer.beads[0].closed for layer in path.layers)
    assert np.abs(np.concatenate([bead.points[:, 1] for _, _, bead in path])).max() < 0.3
    with pytest.raises(InfeasibleError) as caught:
        planned(solids(CYLINDER, thin), thin="refuse")
    assert caught.value.code == "THIN_REGION" and "blade" in caught.value.where
    with pytest.raises(InputError) as refused:
        planned(solids(CYLINDER, thin), shortest=500.0)
    assert refused.value.code == "NOTHING_TO_DEPOSIT"


def test_what_is_refused():
    over = box(np.array([-20.0, -20.0, 120.0]), np.array([20.0, 20.0, 260.0]), name="cap")
    with pytest.raises(InputError) as caught:
        planned(solids(CONE, over))
    assert caught.value.code == "APEX_INSIDE" and caught.value.where.startswith("cap layer")
    with pytest.raises(InputError) as caught:
        planned(
            solids(Developable(60.0, 20.0), helix(2.5, (5.0, 60.0), 4.0, 2.0)), layer_height=2.0
        )
    assert caught.value.code in ("TOO_FAR_ROUND", "APEX_INSIDE")
    with pytest.raises(InputError) as caught:
        planned(solids(CONE, box()), build=BuildDirectionParameters(mode="fixed"))
    assert caught.value.code == "NOT_FOR_FAMILY"


@pytest.mark.parametrize("direction", ["counter-clockwise", "clockwise"])
@pytest.mark.always("clockwise")
def test_collars_have_margins_and_the_torch_leans_away_from_them(direction):
    """Collars have margins, and the torch leans away from them."""
    hub_solids = solids(CONE, collar(30.0, 80.0, 10.0, 40.0))
    path = planned(
        hub_solids,
        process=ProcessParameters(direction=direction),
        margin=5.0,
        deflection=math.radians(10.0),
        layer_height=8.0,
    )
    first_rings = [bead for bead in path.layers[0].beads if bead.closed]
    low, high = (
        min(first_rings, key=lambda bead: bead.points[:, 2].min()),
        max(first_rings, key=lambda bead: bead.points[:, 2].max()),
    )
    # along the cone a distance s is a height of s cos(a); beads are half a spacing inside the 5 mm
    # margin
    reach = 2.0 * math.cos(CONE.taper)
    assert low.points[:, 2] == pytest.approx(np.full(len(low), 10.0 - reach), abs=0.06)
    assert high.points[:, 2] == pytest.approx(np.full(len(high), 40.0 + reach), abs=0.06)
    assert (low.tool[:, 2] < low.build[:, 2]).all() and (high.tool[:, 2] > high.build[:, 2]).all()
    turn = np.cross(low.points[:-1], low.points[1:])[:, 2]
    assert (turn > 0.0).all() if direction == "counter-clockwise" else (turn < 0.0).all()


def test_a_piece_on_a_hub_between_two_layers_is_named():
    """A chip 32 to 34 mm off the hub, between layers at 30 and 36 mm, next to a blade, in one mesh
    or separate."""
    blade, chip = box((44, -10, 0), (75, 10, 40)), box((77, -5, 60), (79, 5, 80), name="chip")
    mesh = Body(
        "mesh",
        np.vstack([blade.vertices, chip.vertices]),
        np.vstack([blade.triangles, chip.triangles + len(blade.vertices)]),
    )
    for bodies in ((blade, chip), (mesh,)):
        planned_path = planned(solids(Developable(45.0), *bodies))
        (issue,) = [
            candidate for candidate in planned_path.issues if candidate.code == "NOT_DEPOSITED"
        ]
        assert "0.4 of its 0.4 cm3" in issue.message and bodies[-1].name in issue.message
    assert not planned(solids(Developable(45.0), blade)).issues
