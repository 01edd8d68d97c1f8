# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolpaths of the paper's bend on a pipe (R = 60, r = 15, Rc = 32, ERRATA) and of a cylinder."""

import numpy as np
import pytest

from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.geometry.walls.surface_wall import CONE, TORUS, SurfaceWall
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters, SeamParameters
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.process.deposit.spacing import between_layers
from freecad_am.core.strategies.walls import plan as surface

BEND, TUBE, PIPE = 60.0, 15.0, 32.0
TILTED = np.array(
    [[0.36, 0.48, -0.8, 5.0], [-0.8, 0.6, 0.0, -7.0], [0.48, 0.64, 0.6, 11.0], [0, 0, 0, 1]]
)


def bend(frame=None, end=0.5 * np.pi):
    """The paper's wall; its first layer from the closed form of equation 3."""
    frame = np.eye(4) if frame is None else frame
    v = 2.0 * np.pi * np.arange(480) / 480
    reach = BEND + TUBE * np.cos(v)
    u = np.arccos((BEND**2 - PIPE**2 + reach**2) / (2.0 * BEND * reach))
    base_curve = Torus(BEND, TUBE).point(u, v) @ frame[:3, :3].T + frame[:3, 3]
    return SurfaceWall(TORUS, (BEND, TUBE), frame, end, base_curve, label="Bend")


def tube(height=20.0):
    v = 2.0 * np.pi * np.arange(480) / 480
    base_curve = np.column_stack([10.0 * np.cos(v), 10.0 * np.sin(v), 0.0 * v])
    return SurfaceWall(CONE, (10.0, 0.0), np.eye(4), height, base_curve, label="Tube")


def planned(
    wall,
    mode="local",
    process=None,
    lead=0.0,
    tilt=0.0,
    max_tilt=np.pi,
    max_turn="inf",
    plane="auto",
    **strategy,
):
    build = BuildDirectionParameters(mode, lead, tilt, max_tilt, max_turn, plane, "none")
    return surface.plan(
        wall,
        SurfaceParameters(**{"layer_height": 5.0, **strategy}),
        build,
        process or ProcessParameters(),
    )


def parameters(points, frame=None):
    """u and v of points of the bend by its equation only."""
    if frame is not None:
        points = (points - frame[:3, 3]) @ frame[:3, :3]
    x, y, z = points.T
    return np.arctan2(z, x + BEND), np.arctan2(y, np.hypot(x + BEND, z) - BEND)


def codes(toolpath):
    return {issue.code: issue for issue in toolpath.issues}


@pytest.mark.parametrize("frame", [None, TILTED], ids=["as the paper", "anywhere"])
def test_layers_trimmed_at_the_end(frame):
    toolpath = planned(bend(frame))
    assert len(toolpath.layers) == 15  # 16 including the one wholly beyond the end (ERRATA)
    for _, _, bead in toolpath:
        u, _ = parameters(bead.points, frame)
        reach = np.hypot(
            *(bead.points if frame is None else (bead.points - frame[:3, 3]) @ frame[:3, :3])[
                :, [0, 2]
            ].T
        )
        assert u.max() <= 0.5 * np.pi + 1e-7
        assert reach.min() > 0.0
        if not bead.closed:
            assert u[[0, -1]] == pytest.approx(0.5 * np.pi, abs=1e-7)
    distances = np.concatenate(between_layers(toolpath))
    assert distances == pytest.approx(5.0, abs=1e-3)
    assert np.linalg.norm(toolpath.frame - np.eye(4)) == 0.0


@pytest.mark.parametrize("end", ["trim", "whole"])
@pytest.mark.parametrize("spacing", ["constant-distance", "smooth", "iso-parameter"])
@pytest.mark.parametrize("turn", [90.0, 120.0, 150.0, 170.0, 179.0])
@pytest.mark.always
def test_bends_end_at_their_end_however_far_they_turn(turn, spacing, end):
    """Angles about the bend's axis from its start, 0 to a full turn; the farthest points of the
    wall are covered."""
    end_angle = np.radians(turn)
    toolpath = planned(bend(end=end_angle), spacing=spacing, end=end, layer_height=8.0)
    points = np.vstack([bead.points for _, _, bead in toolpath])
    x, y, z = points.T
    assert np.hypot(np.hypot(x + BEND, z) - BEND, y) == pytest.approx(TUBE, abs=1e-4)
    around = np.mod(parameters(points)[0], 2.0 * np.pi)
    assert around.max() <= end_angle + 1e-7
    v = np.linspace(0.0, 2.0 * np.pi, 50)
    rim = Torus(BEND, TUBE).point(np.full(50, end_angle), v)
    distances = np.linalg.norm(rim[:, None] - points, axis=2).min(axis=1)
    assert (
        distances.min() < 12.0
    )  # no layer stops far before the end on the inside of the bend, where layers reach it first
    if end == "trim":
        assert distances.max() < 12.0


def test_points_lie_on_the_wall_and_the_first_layer_on_the_pipe():
    toolpath = planned(bend(), layer_height=2.0)
    for _, _, bead in toolpath:
        x, y, z = bead.points.T
        assert np.hypot(np.hypot(x + BEND, z) - BEND, y) == pytest.approx(TUBE, abs=1e-4)
    x, _, z = toolpath.layers[0].beads[0].points.T
    assert np.hypot(x, z) == pytest.approx(PIPE, abs=1e-4)


def test_whole_layers_stop_below_the_end():
    toolpath = planned(bend(), end="whole")
    assert all(len(layer.beads) == 1 and layer.beads[0].closed for layer in toolpath.layers)
    trimmed = planned(bend())
    assert len(toolpath.layers) == sum(layer.beads[0].closed for layer in trimmed.layers) == 10
    assert "REMAINDER" in codes(toolpath)


def test_a_straight_tube_ends_at_its_end():
    """Layers at 0, 5, 10, 15 and 20 mm of a tube of 20 mm, with either treatment of the end."""
    for end in ("trim", "whole"):
        toolpath = planned(tube(), end=end)
        heights = [layer.beads[0].points[:, 2] for layer in toolpath.layers]
        assert len(heights) == 5
        for index, height in enumerate(heights):
            assert height == pytest.approx(5.0 * index, abs=1e-6)
        assert "REMAINDER" not in codes(toolpath)


def test_iso_parameter_layers_gather_and_say_so():
    toolpath = planned(bend(), spacing="iso-parameter")
    assert len(toolpath.layers) == 18  # 19 including the one wholly beyond the end
    issue = codes(toolpath)["SPACING"]
    # 2.49 mm including the one wholly beyond the end, which is not deposited: see
    # test_wall_comparison
    assert issue.level == "warning" and "2.58" in issue.message and issue.layer == 17
    exact = codes(planned(bend()))["SPACING"]
    assert exact.level == "note"


def test_build_directions_are_tangent_to_the_wall_and_normal_to_the_bead():
    for layer, _, bead in planned(bend(), chord_error=0.0005):
        u, v = parameters(bead.points)
        normal = np.column_stack([np.cos(v) * np.cos(u), np.sin(v), np.cos(v) * np.sin(u)])
        rising = np.column_stack([-np.sin(u), 0 * u, np.cos(u)])
        assert np.abs((bead.build * normal).sum(axis=1)).max() < 1e-6
        assert (bead.build * rising).sum(axis=1).min() > 0.0
        assert np.abs(bead.build - bead.tool).max() == 0.0
        step = np.diff(bead.points, axis=0)
        step /= np.linalg.norm(step, axis=1)[:, None]
        smooth = (step[:-1] * step[1:]).sum(axis=1) > np.cos(0.1)
        along = (step[:-1] + step[1:])[smooth] / 2.0
        assert np.abs((along * bead.build[1:-1][smooth]).sum(axis=1)).max() < 0.02, layer


def test_symmetry_plane_turns_the_tool_about_one_axis():
    for frame in (None, TILTED):
        normal = np.array([0.0, 1.0, 0.0]) if frame is None else frame[:3, 1]
        for _, _, bead in planned(bend(frame), mode="symmetry-plane", lead=0.1):
            for vectors in (bead.build, bead.tool):
                assert np.abs(vectors @ normal).max() < 1e-12
    with pytest.raises(InputError, match="plane of symmetry") as caught:
        planned(tube(), mode="symmetry-plane")
    assert caught.value.code == "NO_SYMMETRY_PLANE"


def test_lead_turns_forward_and_tilt_outward():
    ahead = planned(tube(), lead=0.2).layers[1].beads[0]
    forward = np.diff(ahead.points, axis=0)
    forward /= np.linalg.norm(forward, axis=1)[:, None]
    assert (ahead.tool[:-1] * forward).sum(axis=1) == pytest.approx(np.sin(0.2), abs=1e-3)
    assert ahead.tool[:, 2] == pytest.approx(np.cos(0.2), abs=1e-12)
    aside = planned(tube(), tilt=0.3).layers[1].beads[0]
    outward = aside.points[:, :2] / 10.0
    assert (aside.tool[:, :2] * outward).sum(axis=1) == pytest.approx(np.sin(0.3), abs=1e-6)


def test_fixed_layer_and_capped_directions():
    assert all((bead.tool == [0, 0, 1]).all() for _, _, bead in planned(bend(), mode="fixed"))
    for _, _, bead in planned(bend(), mode="layer"):
        assert np.abs(bead.tool - bead.tool[0]).max() == 0.0
    capped = planned(bend(), max_tilt=np.radians(60.0))
    assert max(np.arccos(bead.tool[:, 2]).max() for _, _, bead in capped) == pytest.approx(
        np.radians(60.0), abs=1e-9
    )
    assert "TILT_CAPPED" in codes(capped)


def turns(bead, vectors):
    """Rotation per mm from point to point, rad."""
    cosine = np.clip((vectors[1:] * vectors[:-1]).sum(axis=1), -1.0, 1.0)
    return np.arccos(cosine) / np.linalg.norm(np.diff(bead.points, axis=0), axis=1)


@pytest.mark.parametrize(
    ("mode", "lead", "degrees"),
    [("local", 0.0, 10.0), ("local", 0.3, 10.0), ("symmetry-plane", 0.2, 2.0)],
)
def test_directions_turn_no_faster_than_their_limit(mode, lead, degrees):
    """Fronts turn by up to 97 degrees at their corners (ERRATA), and the unlimited directions with
    them."""
    limit = np.radians(degrees)
    free, limited = (
        planned(bend(), mode=mode, lead=lead, max_turn=turn) for turn in ("inf", limit)
    )
    fastest = [max(turns(bead, bead.tool).max() for _, _, bead in path) for path in (free, limited)]
    assert fastest[0] > 1.5 * limit and fastest[1] <= limit + 1e-6
    departure = max(
        np.arccos(np.clip((a.tool * b.tool).sum(axis=1), -1.0, 1.0)).max()
        for (_, _, a), (_, _, b) in zip(free, limited, strict=True)
    )
    note = codes(limited)["TURN_LIMITED"]
    assert f"{np.degrees(departure):.3g} deg" in note.message and "TURN_LIMITED" not in codes(free)
    for (_, _, a), (_, _, b) in zip(free, limited, strict=True):
        assert np.abs(a.points - b.points).max() < 1e-12
        assert np.linalg.norm(b.tool, axis=1) == pytest.approx(1.0)
        if mode == "symmetry-plane":
            assert np.abs(b.tool[:, 1]).max() < 1e-9
        if b.closed:
            assert b.tool[0] == pytest.approx(b.tool[-1], abs=1e-9)
    assert (
        all(
            np.abs(a.tool - b.tool).max() < 1e-9
            for a, b in zip(  # no corner yet
                free.layers[1].beads, limited.layers[1].beads, strict=True
            )
        )
        or lead
    )


def test_a_plane_may_be_given():
    toolpath = planned(tube(), mode="symmetry-plane", plane="0 3 0", tilt=0.3)
    assert all(np.abs(bead.tool[:, 1]).max() < 1e-12 for _, _, bead in toolpath)
    assert max(np.abs(bead.tool[:, 0]).max() for _, _, bead in toolpath) == pytest.approx(
        np.sin(0.3), abs=0.01
    )
    with pytest.raises(InputError) as caught:
        planned(tube(), mode="symmetry-plane", plane="0 0 0")
    assert caught.value.where == "build_direction.plane"


def turning(bead):
    """Positive where a bead runs counter-clockwise as seen from its tool."""
    return np.cross(bead.points[:-1], bead.points[1:]).sum(axis=0) @ bead.build.mean(axis=0)


def test_seams_and_directions():
    process = ProcessParameters(seam=SeamParameters(np.radians(90.0), np.radians(30.0)))
    for index, layer in enumerate(planned(tube(), process=process).layers):
        x, y, _ = layer.beads[0].points[0]
        angle = np.radians(90.0 + 30.0 * index)
        assert (x, y) == pytest.approx((10.0 * np.cos(angle), 10.0 * np.sin(angle)), abs=1e-6)
    for direction, signs in (
        ("counter-clockwise", [1, 1]),
        ("clockwise", [-1, -1]),
        ("alternate", [1, -1]),
    ):
        layers = planned(
            bend(TILTED), process=ProcessParameters(direction=direction), end="whole"
        ).layers
        assert [np.sign(turning(layer.beads[0])) for layer in layers[:2]] == signs


def test_parameter_is_the_arc_length_of_a_turn():
    for _, _, bead in planned(bend()):
        length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(bead.points, axis=0), axis=1))]
        assert bead.parameter == pytest.approx(2.0 * np.pi * length / length[-1], abs=1e-12)


def test_smooth_layers_have_no_corners_and_keep_the_band():
    toolpath = planned(bend(), spacing="smooth", band=0.2)
    assert "CORNERS" in codes(planned(bend())) and "CORNERS" not in codes(toolpath)
    assert codes(toolpath)["SPACING"].level == "note"
    distances = np.concatenate(between_layers(toolpath))
    assert distances.min() >= 4.0 - 1e-3 and distances.max() <= 6.0 + 1e-3
    for _, _, bead in toolpath:
        step = np.diff(bead.points, axis=0)
        step /= np.linalg.norm(step, axis=1)[:, None]
        assert (step[:-1] * step[1:]).sum(axis=1).min() > np.cos(np.radians(30.0))


def test_refusals():
    with pytest.raises(InputError) as caught:
        planned(bend(), layer_height=100.0)
    assert caught.value.code == "LAYER_HEIGHT"
    with pytest.raises(InputError) as caught:
        planned(bend(end=0.2))
    assert caught.value.code == "TOO_LOW"


@pytest.mark.parametrize(
    "options", [{}, {"end": "whole"}, {"spacing": "smooth"}, {"spacing": "iso-parameter"}], ids=str
)
def test_notes_tell_of_layers_that_are_deposited(options):
    """Notes refer only to deposited layers."""
    toolpath = planned(bend(), **options)
    count = len(toolpath.layers)
    assert all(issue.layer is None or issue.layer < count for issue in toolpath.issues)
    note = codes(toolpath).get("CORNERS")
    if note is None:
        assert options.get("spacing") or options == {"end": "whole"}
        return
    turning = [0.0] * count
    for layer, _, bead in toolpath:
        into, out = bead.tangents[:, 0], bead.tangents[:, 1]
        turning[layer] = max(
            turning[layer],
            float(np.degrees(np.arccos(np.clip((into * out).sum(axis=1), -1, 1)).max())),
        )
    cornered = [index for index, turn in enumerate(turning) if turn > 1e-3]
    assert note.message.startswith(
        f"{len(cornered)} of {count} fronts have corners, first in layer {cornered[0]}"
    )
    assert f"by {max(turning):.3g} deg" in note.message and note.layer == int(np.argmax(turning))
