# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's three parts (Chalvin 2020, eqs. 20 to 22) against their equations, and the rules of
seams and beads."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc, line, sample_curve
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters, SeamParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies.revolution import plan as revolution

NOZZLE = NozzleParameters()
UNRESTRICTED = BuildDirectionParameters(clearance="none", max_tilt=np.pi)


def parabola(rho, theta, low, high):
    def curve(z):
        x = np.sqrt(2.0 * rho * (z - theta))
        return np.stack([x, z], axis=1), np.stack([rho / x, np.ones_like(z)], axis=1)

    return sample_curve(curve, [low, high])


SPHERE = Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)])
LAVAL = Meridian.chained([parabola(-10.0, 100.0, 0.0, 96.5), parabola(3.0, 85.0, 96.5, 128.0)])
FUNNEL = Meridian.chained([arc((90.0, 0.0), 45.0, np.pi, np.pi / 2)])
CYLINDER = Meridian.chained([line((10.0, 0.0), (10.0, 30.0))])
MOVED = np.array(
    [[0.6, 0.0, 0.8, 11.0], [0.0, 1.0, 0.0, -7.0], [-0.8, 0.0, 0.6, 3.0], [0.0, 0.0, 0.0, 1.0]]
)


def plan(
    meridian, build=UNRESTRICTED, process=None, platform=0.0, frame=None, turn=None, **strategy
):
    start, end = turn or (0.0, 2.0 * np.pi)
    wall = RevolvedWall(meridian, np.eye(4) if frame is None else frame, start, end, turn is None)
    process = process or ProcessParameters()
    return revolution.plan(wall, RevolutionParameters(**strategy), build, process, NOZZLE, platform)


def cylindrical(bead, frame=None):
    """Radius, height and unwrapped azimuth of the points, and build directions along radius,
    azimuth and axis."""
    frame = np.eye(4) if frame is None else frame
    p, b = (bead.points - frame[:3, 3]) @ frame[:3, :3], bead.build @ frame[:3, :3]
    azimuth = np.arctan2(p[:, 1], p[:, 0])
    c, s = np.cos(azimuth), np.sin(azimuth)
    turned = np.stack([b[:, 0] * c + b[:, 1] * s, b[:, 1] * c - b[:, 0] * s, b[:, 2]], axis=1)
    return np.hypot(p[:, 0], p[:, 1]), p[:, 2], np.unwrap(azimuth), turned


def sphere_truth(s):
    a = s / 45.0
    return 45.0 * np.cos(a), 45.0 * np.sin(a), -np.sin(a), np.cos(a)


def funnel_truth(s):
    a = s / 45.0
    return 90.0 - 45.0 * np.cos(a), 45.0 * np.sin(a), np.sin(a), np.cos(a)


@pytest.mark.parametrize(("meridian", "truth"), [(SPHERE, sphere_truth), (FUNNEL, funnel_truth)])
@pytest.mark.parametrize("frame", [None, MOVED])
def test_layers_and_directions_of_arcs_are_the_analytic_ones(meridian, truth, frame):
    toolpath = plan(meridian, frame=frame)
    assert len(toolpath.layers) == 71
    for i, _, bead in toolpath:
        r, h, _, b = cylindrical(bead, frame)
        radius, height, outward, upward = truth(float(i))
        assert np.abs(r - radius).max() < 1e-9
        assert np.abs(h - height).max() < 1e-9
        assert np.abs(b - [outward, 0.0, upward]).max() < 1e-9
        assert (bead.tool == bead.build).all()


def test_the_laval_nozzle_has_137_layers_on_its_two_parabolas():
    toolpath = plan(LAVAL)
    assert len(toolpath.layers) == 137
    for _, _, bead in toolpath:
        r, h, _, b = cylindrical(bead)
        z = h[0]
        rho, theta = (-10.0, 100.0) if z <= 96.5 else (3.0, 85.0)
        x = np.sqrt(2.0 * rho * (z - theta))
        assert np.abs(r - x).max() < 1e-7
        slope = np.array([rho / x, 0.0, 1.0])
        assert np.abs(b - slope / np.linalg.norm(slope)).max() < 1e-8
    # along either parabola layers are exactly a layer height apart: arc length of x^2 = 2 p z in
    # closed form
    along = [_parabola_length(*cylindrical(layer.beads[0])[:2]) for layer in toolpath.layers]
    steps = np.diff(along)
    inside = np.abs(steps - 1.0) < 0.3  # all except the one across the throat
    assert inside.sum() == 135
    assert np.abs(steps[inside] - 1.0).max() < 1e-7


def _parabola_length(radius, height):
    """Signed arc length from the apex of the parabola through the point, rising along the wall."""
    p, sign = (10.0, -1.0) if height[0] <= 96.5 else (3.0, 1.0)
    q = radius[0] / p
    return sign * 0.5 * p * (q * np.hypot(1.0, q) + np.arcsinh(q))


@pytest.mark.parametrize("meridian", [SPHERE, LAVAL, FUNNEL])
@pytest.mark.parametrize("chord_error", [0.01, 0.0007])
def test_the_chord_error_holds_on_the_true_circle(meridian, chord_error):
    for _, _, bead in plan(meridian, chord_error=chord_error):
        share = np.linspace(0.0, 1.0, 11)[:, None, None]
        between = (bead.points[:-1] * (1.0 - share) + bead.points[1:] * share).reshape(-1, 3)
        radius = np.hypot(bead.points[0, 0], bead.points[0, 1])
        off = radius - np.hypot(between[:, 0], between[:, 1])
        assert off.max() <= chord_error * (1.0 + 1e-9)
        assert len(bead) - 1 >= 24


def test_beads_close_to_the_bit_and_say_their_speed():
    for _, _, bead in plan(SPHERE, process=ProcessParameters(travel_speed=4.5)):
        assert bead.closed
        assert (bead.points[0] == bead.points[-1]).all()
        assert (bead.speed == 4.5).all()
        assert bead.width is None


def test_what_is_left_at_the_top_is_told():
    notes = {issue.code: issue for issue in plan(SPHERE).issues}
    assert "0.686 mm" in notes["REMAINDER"].message
    assert "REMAINDER" not in {issue.code for issue in plan(CYLINDER).issues}


def test_beads_that_are_points_are_left_out():
    height = 22.5 * np.pi / 10.0
    toolpath = plan(SPHERE, layer_height=height)
    assert len(toolpath.layers) == 10  # the eleventh is the pole
    assert "POINT_BEADS" in {issue.code for issue in toolpath.issues}


@pytest.mark.parametrize(
    ("direction", "signs"),
    [
        ("counter-clockwise", (1, 1, 1)),
        ("clockwise", (-1, -1, -1)),
        ("alternate", (1, -1, 1)),
        ("as found", (1, 1, 1)),
    ],
)
def test_seams_move_and_beads_run_as_asked(direction, signs):
    process = ProcessParameters(seam=SeamParameters(0.4, 0.1), direction=direction)
    toolpath = plan(CYLINDER, process=process, frame=MOVED, layer_height=10.0)
    for i, _, bead in toolpath:
        _, _, azimuth, _ = cylindrical(bead, MOVED)
        assert azimuth[0] == pytest.approx(0.4 + 0.1 * i)
        assert bead.parameter[0] == pytest.approx(0.4 + 0.1 * i)
        if i < 3:
            assert azimuth[-1] - azimuth[0] == pytest.approx(signs[i] * 2.0 * np.pi)
            assert np.diff(bead.parameter) == pytest.approx(np.diff(azimuth))


@pytest.mark.parametrize(
    ("direction", "signs"), [("counter-clockwise", (1, 1)), ("alternate", (1, -1))]
)
def test_a_part_of_a_turn_gives_open_beads(direction, signs):
    toolpath = plan(SPHERE, process=ProcessParameters(direction=direction), turn=(0.5, 2.5))
    assert len(toolpath.layers) == 71
    for i, _, bead in toolpath:
        _, _, azimuth, _ = cylindrical(bead)
        ends = (0.5, 2.5) if signs[i % 2] > 0 else (2.5, 0.5)
        assert not bead.closed
        assert azimuth[[0, -1]] == pytest.approx(ends)


def test_iso_height_says_where_the_spacing_leaves_the_band():
    """Constant height reports the layers whose spacing leaves the band."""
    toolpath = plan(SPHERE, spacing="iso-height")
    heights = [cylindrical(layer.beads[0])[1][0] for layer in toolpath.layers]
    assert heights == pytest.approx(np.arange(45.0), abs=1e-9)
    warning = next(issue for issue in toolpath.issues if issue.code == "SPACING")
    z = np.arange(46.0)
    distances = np.hypot(1.0, np.diff(np.sqrt(45.0**2 - z**2)))
    assert f"{int((distances > 1.2).sum())} of 46 layers" in warning.message
    assert warning.level == "warning"
    assert "SPACING" not in {issue.code for issue in plan(CYLINDER, spacing="iso-height").issues}
    assert "SPACING" not in {issue.code for issue in plan(SPHERE).issues}


@pytest.mark.parametrize("mode", ["layer", "fixed"])
def test_one_direction_per_layer_of_full_turns_is_the_axis(mode):
    for _, _, bead in plan(SPHERE, BuildDirectionParameters(mode=mode), frame=MOVED):
        assert bead.build == pytest.approx(np.tile(MOVED[:3, 2], (len(bead), 1)), abs=1e-15)


@pytest.mark.parametrize("cap", [0.0, 0.7, 1.2])
def test_the_cap_holds_the_tool_near_the_vertical(cap):
    toolpath = plan(SPHERE, BuildDirectionParameters(max_tilt=cap, clearance="none"))
    for i, _, bead in toolpath:
        leaning = np.arctan2(np.hypot(bead.tool[:, 0], bead.tool[:, 1]), bead.tool[:, 2])
        assert leaning == pytest.approx(np.full(len(bead), min(cap, i / 45.0)), abs=1e-9)
    assert "MAX_TILT" in {issue.code for issue in toolpath.issues}


def test_the_cap_counts_lead_and_tilt():
    build = BuildDirectionParameters(lead=0.3, tilt=-0.2, max_tilt=0.8, clearance="none")
    angles = []
    for _, _, bead in plan(SPHERE, build):
        assert (bead.build * bead.tool).sum(axis=1) == pytest.approx(
            np.full(len(bead), np.cos(0.3) * np.cos(0.2))
        )
        angles.append(np.arccos(bead.tool[0, 2]))
    assert max(angles) == pytest.approx(0.8, abs=1e-6)


def test_a_cap_that_lead_alone_breaks_is_an_error():
    issues = plan(CYLINDER, BuildDirectionParameters(lead=0.3, max_tilt=0.2)).issues
    assert [issue.level for issue in issues if issue.code == "MAX_TILT"] == ["error"]


def test_what_is_not_for_parts_of_revolution_is_refused():
    with pytest.raises(InputError, match="symmetry-plane") as refused:
        plan(SPHERE, BuildDirectionParameters(mode="symmetry-plane"))
    assert refused.value.code == "NOT_FOR_FAMILY"
    with pytest.raises(InputError, match="layer_height") as refused:
        plan(SPHERE, layer_height=71.0)
    assert refused.value.code == "LAYER_HEIGHT"
