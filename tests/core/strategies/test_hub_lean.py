# SPDX-License-Identifier: LGPL-2.1-or-later
"""Torch lean on beads of hubs, measured with independent normals and tangents on finer points than
planned."""

import math

import numpy as np
import pytest

from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters, SeamParameters
from tests.core.strategies.test_developable import (
    CONE,
    CYLINDER,
    box,
    collar,
    planned,
    solids,
    sound,
    unroll_points,
)

SURFACES = pytest.mark.parametrize("surface", [CYLINDER, CONE], ids=["cylinder", "cone"])


def normals(surface, points):
    """Outward normals of the hub."""
    tan = 0.0 if math.isinf(surface.height) else surface.radius / surface.height
    out = np.column_stack(
        [points[:, :2] / np.hypot(points[:, 0], points[:, 1])[:, None], np.full(len(points), tan)]
    )
    return out / math.hypot(1.0, tan)


def angle(a, b):
    """Angle between rows (n, 3) in deg."""
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1)))


def finer(bead, divisions=5):
    """Points and tools (m, 3) that divide the segments, the tool rotated evenly on each."""
    t = np.arange(divisions) / divisions
    arc = np.radians(angle(bead.tool[:-1], bead.tool[1:]))[:, None]
    ends = [
        np.where(arc > 1e-9, np.sin(share * arc) / np.maximum(np.sin(arc), 1e-12), share)
        for share in (1.0 - t, t)
    ]
    tool = (
        ends[0][..., None] * bead.tool[:-1, None] + ends[1][..., None] * bead.tool[1:, None]
    ).reshape(-1, 3)
    points = (bead.points[:-1, None] + t[:, None] * np.diff(bead.points, axis=0)[:, None]).reshape(
        -1, 3
    )
    return np.vstack([points, bead.points[-1:]]), np.vstack([tool, bead.tool[-1:]])


def turns(bead, divisions=5):
    """Tool rotation between these points in deg/mm."""
    points, tool = finer(bead, divisions)
    return angle(tool[1:], tool[:-1]) / np.linalg.norm(np.diff(points, axis=0), axis=1)


def corners(surface, bead, min_turn_deg=20.0):
    """Arc length (n,) in mm along an unrolled bead and at its corners (k,), in independently
    unrolled coordinates."""
    step = np.diff(unroll_points(surface, bead.points), axis=0)
    arc_length = np.r_[0.0, np.cumsum(np.hypot(*step.T))]
    heading = np.degrees(np.arctan2(step[:, 1], step[:, 0]))
    turn = np.abs(
        np.remainder(
            np.diff(heading, prepend=heading[-1] if bead.closed else heading[0]) + 180.0, 360.0
        )
        - 180.0
    )
    return arc_length, arc_length[:-1][turn > min_turn_deg]


def from_corners(surface, bead, divisions=1):
    """Distance (n,) in mm from points to the nearest corner along the bead, with `divisions` points
    per segment."""
    arc_length, corner_stations = corners(surface, bead)
    if bead.closed:
        corner_stations = np.r_[
            corner_stations - arc_length[-1], corner_stations, corner_stations + arc_length[-1]
        ]
    fine = np.interp(
        np.arange(divisions * (len(arc_length) - 1) + 1) / divisions,
        np.arange(len(arc_length)),
        arc_length,
    )
    return np.abs(fine[:, None] - corner_stations).min(axis=1)


def outer(path):
    """The longest closed bead of each layer."""
    return [
        max((bead for bead in layer.beads if bead.closed), key=lambda bead: bead.length)
        for layer in path.layers[:5]
    ]


@SURFACES
@pytest.mark.parametrize("lean", [10.0, 20.0])
@pytest.mark.parametrize("direction", ["clockwise", "counter-clockwise"])
@pytest.mark.always
def test_away_from_corners_the_torch_leans_as_asked(surface, lean, direction):
    """Away from corners the torch leans by the requested angle, perpendicular to the bead."""
    path = planned(
        solids(surface, box()),
        deflection=math.radians(lean),
        process=ProcessParameters(direction=direction),
    )
    for bead in outer(path):
        normal = normals(surface, bead.points)
        np.testing.assert_allclose(
            angle(bead.tool, normal), lean, atol=1e-6
        )  # everywhere, including corners
        points, tool = finer(bead)
        normal_there = normals(surface, points)
        free = from_corners(surface, bead, 5) > 0.8 * lean
        np.testing.assert_allclose(angle(tool, normal_there)[free], lean, atol=0.05)
        halfway = normal_there[1:] + normal_there[:-1]
        halfway /= np.linalg.norm(halfway, axis=1)[:, None]
        steps = np.diff(points, axis=0)
        steps -= (steps * halfway).sum(axis=1)[
            :, None
        ] * halfway  # along the surface, not along the chord
        across = angle(tool[1:] + tool[:-1], steps)[free[1:] & free[:-1]]
        assert len(across) > 4 and np.abs(across - 90.0).max() < 0.12
        middle = bead.points[:-1].mean(axis=0)
        assert ((bead.tool - normal) * (bead.points - middle)).sum(axis=1).min() > 0.0


@pytest.mark.parametrize(
    ("surface", "fill", "most"),
    [
        (CYLINDER, "contours", 2.0),
        (CONE, "contours", 6.0),
        (CYLINDER, "contours", 30.0),
        (CONE, "spiral", 2.0),
        (CYLINDER, "spiral", 6.0),
        (CONE, "lines", 6.0),
        (CYLINDER, "zigzag", 2.5),
        (CONE, "zigzag", 30.0),
    ],
)
@pytest.mark.always
def test_nowhere_does_the_torch_turn_faster(surface, fill, most):
    """The torch rotates no faster than the limit anywhere."""
    build = BuildDirectionParameters(
        lead=math.radians(5.0), tilt=math.radians(12.0), max_turn=math.radians(most)
    )
    path = planned(
        solids(surface, box()),
        build=build,
        fill=fill,
        deflection=math.radians(8.0),
        layer_height=12.0,
    )
    for _, _, bead in path:
        assert turns(bead).max() <= most * (1.0 + 1e-6)
        assert turns(bead.halved(np.arange(len(bead) - 1))).max() <= most * 1.001
    issues = {issue.code: issue for issue in path.issues}
    assert issues["TURN_LIMITED"].level == "note" and "TURN_OF_NORMALS" not in issues
    assert f"({most:g} deg/mm)" in issues["TURN_LIMITED"].message


@SURFACES
@pytest.mark.parametrize("most", ["inf", "auto"])
@pytest.mark.always
def test_the_lean_is_exact_at_points_and_kept_between_them(surface, most):
    """At corners too the torch leans by 15 deg: exactly at the points of a bead, and within 0.1 deg
    between them."""
    build = BuildDirectionParameters(tilt=math.radians(15.0), max_turn=most)
    path = planned(solids(surface, box()), build=build, layer_height=6.0)
    for _, _, bead in path:
        lean = angle(bead.tool, normals(surface, bead.points))
        lean_of_bead = lean[0]
        assert most == "auto" or abs(lean_of_bead - 15.0) < 1e-9
        assert np.abs(lean - lean_of_bead).max() < 1e-9
        points, tool = finer(bead)
        assert np.abs(angle(tool, normals(surface, points)) - lean_of_bead).max() < 0.1


def test_without_a_limit_the_torch_jumps_at_corners_and_nowhere_else():
    """Without a limit the torch rotates abruptly at corners only."""
    build = BuildDirectionParameters(tilt=math.radians(12.0), max_turn="inf")
    path = planned(solids(CYLINDER, box()), build=build, layer_height=12.0)
    assert not [issue for issue in path.issues if issue.code.startswith(("TURN", "LEAN"))]
    bead = outer(path)[1]
    near_corner = from_corners(CYLINDER, bead) < 0.2
    fast = turns(bead, 1)
    assert fast.max() > 50.0 and fast[~(near_corner[1:] & near_corner[:-1])].max() < 1.3


def azimuth(bead):
    """Unwrapped azimuth of the torch lean in the plane of a cylinder, rad."""
    radial = normals(CYLINDER, bead.points)
    around = np.column_stack([-radial[:, 1], radial[:, 0], np.zeros(len(radial))])
    return np.unwrap(np.arctan2(bead.tool[:, 2], (bead.tool * around).sum(axis=1)))


@pytest.mark.parametrize(
    "seam", [0.0, 45.0, 90.0]
)  # the seam in the middle of an edge, and at a corner
def test_corners_are_rounded_alike_on_both_sides_and_smoothly(seam):
    """Corners are rounded smoothly and symmetrically."""
    process = ProcessParameters(seam=SeamParameters(angle=math.radians(seam)))
    path = planned(solids(CYLINDER, box()), process=process, deflection=math.radians(10.0))
    bead = outer(path)[1]
    arc_length, corner_stations = corners(CYLINDER, bead)
    assert len(corner_stations) == 4
    to = azimuth(bead)
    s = np.r_[arc_length[:-1] - arc_length[-1], arc_length, arc_length[1:] + arc_length[-1]]
    turn = to[-1] - to[0]
    assert abs(abs(turn) - 2.0 * math.pi) < 1e-9  # one turn, continuous across the seam
    to = np.r_[to[:-1] - turn, to, to[1:] + turn]
    x = np.linspace(0.0, 12.0, 60)
    for corner in corner_stations:
        ahead, behind = np.interp(corner - x, s, to), np.interp(corner + x, s, to)
        np.testing.assert_allclose(ahead + behind, 2.0 * np.interp(corner, s, to), atol=0.02)
        assert abs(abs(behind[-1] - ahead[-1]) - 0.5 * math.pi) < 0.03
    slope = np.abs(np.diff(to) / np.diff(s))
    assert np.abs(np.diff(slope)).max() < 0.5 * slope.max()


def test_a_spiral_leans_on_its_first_lap_and_stands_straight_after():
    """A spiral leans on its first lap and is upright afterwards."""
    lean = 10.0
    path = planned(solids(CYLINDER, box()), fill="spiral", deflection=math.radians(lean))
    around = planned(solids(CYLINDER, box()))
    for layer, ring in zip(path.layers[:4], outer(around)):
        bead = max(layer.beads, key=lambda bead: bead.length)
        assert not bead.closed
        arc_length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        lean_angles = angle(bead.tool, normals(CYLINDER, bead.points))
        is_first_lap = arc_length < ring.length - 20.0
        np.testing.assert_allclose(lean_angles[is_first_lap], lean, atol=1e-6)
        np.testing.assert_allclose(lean_angles[arc_length > ring.length + 10.0], 0.0, atol=1e-6)
        out = bead.points - ring.points[:-1].mean(axis=0)
        assert ((bead.tool - normals(CYLINDER, bead.points)) * out).sum(axis=1)[
            is_first_lap
        ].min() > 0.0
        assert turns(bead).max() <= 3.0 * (1.0 + 1e-6)


@pytest.mark.parametrize("fill", ["contours", "spiral"])
def test_both_borders_of_a_strip_are_leant_over_wherever_they_run(fill):
    """A collar whose upper border rises to five times its height in the middle of one side."""
    plain = collar(40.0, 60.0, 10.0, 40.0, sides=72)
    vertices = plain.vertices.copy()
    top = vertices[:, 2] > 25.0
    vertices[top, 2] += 45.0 * (1.0 + np.cos(np.arctan2(vertices[top, 1], vertices[top, 0])))
    body = sound(Body("collar", vertices, plain.triangles))
    path = planned(
        solids(CYLINDER, body),
        fill=fill,
        deflection=math.radians(15.0),
        chord_error=0.2,
        layer_height=12.0,
    )
    for layer in path.layers[:2]:
        leaning = [
            bead
            for bead in layer.beads
            if angle(bead.tool, normals(CYLINDER, bead.points)).max() > 1.0
        ]
        assert len(leaning) == 2
        low, high = sorted(leaning, key=lambda bead: bead.points[:, 2].mean())
        assert (low.tool[:, 2] < 0.0).all() and (high.tool[:, 2] > 0.0).all()
        assert low.points[:, 2].max() < 13.1 < 36.0 < high.points[:, 2].min()


def test_holes_are_leant_over_and_beads_further_in_are_not():
    """The torch leans over holes but not on inner beads."""
    path = planned(solids(CYLINDER, box()), deflection=math.radians(12.0))
    for layer in path.layers[:4]:
        lean_angles = [angle(bead.tool, bead.build).max() for bead in layer.beads]
        assert sorted(round(value, 6) for value in lean_angles)[-2:] == [0.0, 12.0]


def test_a_ring_too_short_leans_less_and_that_is_told():
    """A short ring leans less, and a warning states the angle."""
    small = box(np.array([20.0, -6.0, 40.0]), np.array([60.0, 6.0, 52.0]), name="stud")
    build = BuildDirectionParameters(max_turn=math.radians(4.0))
    path = planned(
        solids(CYLINDER, small), build=build, deflection=math.radians(40.0), bead_spacing=4.0
    )
    (warning,) = [issue for issue in path.issues if issue.code == "LEAN_REDUCED"]
    assert warning.level == "warning" and "40 deg" in warning.message
    bead = path.layers[warning.layer].beads[warning.bead]
    lean_angles = angle(bead.tool, normals(CYLINDER, bead.points))
    assert (
        np.ptp(lean_angles) < 1e-6
        and 8.0 < lean_angles[0] < 35.0
        and f"{lean_angles[0]:.3g} to" in warning.message
    )
    # 4 deg/mm over the length of the ring limits the rotation around the normal
    assert math.degrees(2.0 * math.pi * math.sin(math.radians(lean_angles[0]))) / bead.length > 2.0
    assert turns(bead).max() <= 4.0 * (1.0 + 1e-6)


def test_normals_that_turn_faster_are_followed():
    """Normals that rotate faster than the limit are followed with a warning."""
    path = planned(
        solids(CYLINDER, box()), build=BuildDirectionParameters(max_turn=math.radians(0.5))
    )
    (warning,) = [issue for issue in path.issues if issue.code.startswith("TURN")]
    assert (
        warning.code == "TURN_OF_NORMALS"
        and warning.level == "warning"
        and "1.27 deg/mm" in warning.message
    )
    assert all((bead.tool == bead.build).all() for _, _, bead in path)
    quiet = planned(solids(CYLINDER, box()))
    assert not [issue for issue in quiet.issues if issue.code.startswith(("TURN", "LEAN"))]


@pytest.mark.parametrize("lean", [12.0, 35.0])
def test_without_a_limit_the_torch_goes_round_the_normal_at_corners(lean):
    """At a corner, where it rotates directly from one point to the next, the torch keeps its
    lean."""
    build = BuildDirectionParameters(max_turn="inf")
    path = planned(
        solids(CYLINDER, box()), build=build, deflection=math.radians(lean), layer_height=12.0
    )
    for bead in outer(path):
        points, tool = finer(bead, 4)
        assert np.abs(angle(tool, normals(CYLINDER, points)) - lean).max() < 0.1
