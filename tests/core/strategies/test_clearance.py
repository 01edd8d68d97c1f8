# SPDX-License-Identifier: LGPL-2.1-or-later
"""The nozzle against all that was deposited before, by brute force: dense points, a plain test of the cone in space."""

import numpy as np
import pytest

from freecad_am.core.geometry.profile import Meridian, RevolvedWall
from freecad_am.core.geometry.sampling import arc, line
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies import revolution
from freecad_am.core.strategies.clearance import Deposit
from freecad_am.core.strategies.platform import Platform

DOME = Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)])
SMALL_DOME = Meridian.chained([arc((0.0, 0.0), 12.0, 0.0, np.pi / 2)])
BOTTLE = Meridian.chained([
    line((20.0, 0.0), (20.0, 15.0)), arc((8.0, 15.0), 12.0, 0.0, np.pi / 2), line((8.0, 27.0), (4.0, 27.0)),
])
HORN = Meridian.chained([arc((60.0, 0.0), 20.0, np.pi, np.pi / 2), line((60.0, 20.0), (75.0, 20.0))])
LOW_HORN = Meridian.chained([arc((40.0, 0.0), 6.0, np.pi, np.pi / 2), line((40.0, 6.0), (50.0, 6.0))])
SLIM = NozzleParameters(half_angle=np.radians(8.0), diameter=0.4, length=40.0)
STUBBY = NozzleParameters(half_angle=np.radians(50.0), diameter=3.0, length=15.0)
USUAL = NozzleParameters()
SAMPLES = 1201


def planned(meridian, nozzle, platform=0.0, turn=None, **build):
    start, end = turn or (0.0, 2.0 * np.pi)
    wall = RevolvedWall(meridian, np.eye(4), start, end, turn is None)
    strategy = RevolutionParameters(layer_height=1.5)
    return revolution.plan(wall, strategy, BuildDirectionParameters(**build), ProcessParameters(), nozzle, platform)


def circles(toolpath, turn):
    """The circle or arc of every layer as a curve: azimuths (n,) -> points (n, 3), with its ends."""
    first, last = turn or (0.0, 2.0 * np.pi)
    curves = []
    for layer in toolpath.layers:
        x, y, height = layer.beads[0].points[0]
        radius = np.hypot(x, y)

        def curve(at, r=radius, h=height):
            return np.stack([r * np.cos(at), r * np.sin(at), np.full(len(at), h)], axis=1)

        curves.append((curve, first, last))
    return curves


def platform(diameter, tip, tool):
    """Lines across the platform's disc: under the tool axis, where a touch begins, and beside it."""
    lean = np.array([tool[0], tool[1], 0.0]) / np.hypot(tool[0], tool[1])
    side = np.array([-lean[1], lean[0], 0.0])
    curves = []
    for off in np.linspace(-0.45, 0.45, 31) * diameter:
        through = side * (tip @ side if abs(off) < 1e-9 else off)
        half = np.sqrt(0.25 * diameter**2 - through @ through)
        curves.append((lambda p, through=through: through + p[:, None] * lean, -half, half))
    return curves


def depth(tip, tool, curves, nozzle):
    """How deep the deepest point of the curves is in the nozzle, mm, by sampling and zooming in; negative when clear."""
    deepest = -1.0
    for curve, first, last in curves:
        low, high = first, last
        for count in (SAMPLES, 201, 201, 201):
            at = np.linspace(max(low, first), min(high, last), count)
            inside = depth_of_points(tip, tool, curve(at), nozzle)
            best = int(np.argmax(inside))
            deepest = max(deepest, inside[best])
            if inside[best] < -0.2:
                break
            step = at[1] - at[0]
            low, high = at[best] - 2.0 * step, at[best] + 2.0 * step
    return deepest


def depth_of_points(tip, tool, points, nozzle):
    apart = points - tip
    x = apart @ tool
    across = np.sqrt(np.maximum((apart * apart).sum(axis=1) - x * x, 0.0))
    counts = (x > 0.0) & (x <= nozzle.length) & ((apart * apart).sum(axis=1) >= nozzle.diameter**2)
    inside = (0.5 * nozzle.diameter + x * np.tan(nozzle.half_angle) - across) * np.cos(nozzle.half_angle)
    return np.where(counts, inside, -1.0)


def tilted(direction, back):
    """Turned towards the vertical by `back`."""
    level = np.hypot(direction[0], direction[1])
    angle = np.arctan2(level, direction[2]) - back
    return np.array([*(direction[:2] / level * np.sin(angle)), np.cos(angle)])


def held(build, point, lead, tilt):
    around = np.array([-point[1], point[0], 0.0]) / np.hypot(point[0], point[1])
    out = np.cross(around, build)
    out /= np.linalg.norm(out)
    return np.cos(tilt) * (np.cos(lead) * build + np.sin(lead) * np.cross(build, out)) + np.sin(tilt) * out


CASES = [
    (DOME, USUAL, {}), (DOME, SLIM, {}), (DOME, STUBBY, {}), (SMALL_DOME, USUAL, {}), (BOTTLE, USUAL, {}),
    (BOTTLE, SLIM, {}), (DOME, USUAL, {"lead": 0.2}), (DOME, USUAL, {"lead": -0.3, "tilt": 0.1}),
    (BOTTLE, STUBBY, {"tilt": -0.2}), (BOTTLE, USUAL, {"lead": 0.4}), (HORN, STUBBY, {}),
]


@pytest.mark.parametrize(("meridian", "nozzle", "build"), CASES)
@pytest.mark.parametrize("turn", [None, (0.3, 2.0), (0.0, 4.5)])
def test_the_nozzle_is_clear_and_would_not_be_with_one_percent_less_tilt_back(meridian, nozzle, build, turn):
    free = planned(meridian, nozzle, turn=turn, clearance="none", max_tilt=np.pi, **build)
    toolpath = planned(meridian, nozzle, turn=turn, max_tilt=np.pi, **build)
    assert not [issue for issue in toolpath.issues if issue.level == "error"]
    everything = circles(toolpath, turn)
    touched = 0
    for i, layer in enumerate(toolpath.layers):
        bead, before = layer.beads[0], everything[: i + 1]
        some = [0] if turn is None else [0, len(bead) // 3, len(bead) - 1]
        assert max(depth(bead.points[j], bead.tool[j], before, nozzle) for j in some) < 1e-6
        wanted = free.layers[i].beads[0].build
        back = np.arccos(np.clip((wanted[0] * bead.build[0]).sum(), -1.0, 1.0))
        if back > 1e-3:
            touched += 1
            less = [
                held(tilted(wanted[j], 0.99 * back), bead.points[j], build.get("lead", 0.0), build.get("tilt", 0.0))
                for j in some
            ]
            assert max(depth(bead.points[j], tool, before, nozzle) for j, tool in zip(some, less, strict=True)) > 0.0
    if (meridian is DOME or meridian is BOTTLE) and turn is None:
        assert touched > 0


@pytest.mark.parametrize(("meridian", "nozzle", "build"), [
    (LOW_HORN, USUAL, {}), (LOW_HORN, STUBBY, {}), (LOW_HORN, STUBBY, {"lead": 0.2}), (HORN, STUBBY, {"tilt": 0.3}),
])
def test_the_nozzle_is_clear_of_the_platform_and_no_more_tilted_than_that_needs(meridian, nozzle, build):
    free = planned(meridian, nozzle, platform=0.0, max_tilt=np.pi, **build)
    toolpath = planned(meridian, nozzle, platform=200.0, max_tilt=np.pi, **build)
    touched = 0
    for layer, before in zip(toolpath.layers, free.layers, strict=True):
        bead, unhindered = layer.beads[0], before.beads[0]
        plate = platform(200.0, bead.points[0], bead.tool[0] + [1e-9, 0.0, 0.0])
        assert depth(bead.points[0], bead.tool[0], plate, nozzle) < 1e-6
        back = np.arccos(np.clip((unhindered.build[0] * bead.build[0]).sum(), -1.0, 1.0))
        if back > 1e-2:
            touched += 1
            lead, tilt = build.get("lead", 0.0), build.get("tilt", 0.0)
            less = held(tilted(unhindered.build[0], 0.99 * back), bead.points[0], lead, tilt)
            assert depth(bead.points[0], less, plate, nozzle) > 0.0
    assert touched > 0


def test_the_largest_tilt_back_is_told():
    toolpath = planned(DOME, USUAL)
    note = next(issue for issue in toolpath.issues if issue.code == "TILT_BACK")
    leaning = [np.degrees(np.arccos(layer.beads[0].build[0, 2])) for layer in toolpath.layers]
    back = np.degrees(1.5 * np.arange(len(leaning)) / 45.0) - leaning
    assert f"layer {int(np.argmax(back > 1e-7))} on" in note.message
    assert f"{back.max():.2f} deg" in note.message
    assert note.layer == int(np.argmax(back))


def test_a_wall_that_turns_down_outside_cannot_be_reached():
    # up inside and down again outside: the nozzle would have to come through what stands there
    gutter = Meridian.chained([
        line((20.0, 0.0), (20.0, 15.0)), arc((21.0, 15.0), 1.0, np.pi, 0.0), line((22.0, 15.0), (22.0, 5.0)),
    ])
    issue = next(issue for issue in planned(gutter, USUAL).issues if issue.code == "CLEARANCE")
    assert issue.level == "error"
    assert issue.layer >= 11


def test_without_clearance_nothing_is_tilted():
    for i, layer in enumerate(planned(DOME, USUAL, clearance="none").layers):
        assert np.arccos(layer.beads[0].build[0, 2]) == pytest.approx(1.5 * i / 45.0, abs=1e-7)


def test_a_spiral_is_clear_of_all_its_earlier_turns():
    wall = RevolvedWall(SMALL_DOME, np.eye(4))
    strategy = RevolutionParameters(path="spiral", chord_error=0.001)
    toolpath = revolution.plan(wall, strategy, BuildDirectionParameters(), ProcessParameters(), USUAL, 0.0)
    bead = toolpath.layers[0].beads[0]
    for i in range(10, len(bead), 97):
        assert depth_of_points(bead.points[i], bead.tool[i], bead.points[:i], USUAL).max() < 1e-6


@pytest.mark.parametrize("seed", range(6))
def test_any_tool_over_any_arcs_is_judged_as_by_brute_force(seed):
    random = np.random.default_rng(seed)
    radius, height = random.uniform(1.0, 60.0, 12), np.sort(random.uniform(0.0, 60.0, 12))
    nozzle = NozzleParameters(
        half_angle=random.uniform(0.0, 1.2), diameter=random.uniform(0.1, 4.0), length=random.uniform(5.0, 80.0)
    )
    bead = random.integers(0, 12, 60)
    tool = random.normal(size=(60, 3))
    tool[:20, 1] = 0.0  # some in the plane of the axis
    tool /= np.linalg.norm(tool, axis=1, keepdims=True)
    reach = np.where(random.random((60, 1)) < 0.5, [[-np.pi, np.pi]], random.uniform(0.0, 3.0, (60, 2)) * [-1.0, 1.0])
    clear = Deposit(radius, height, nozzle, Platform(0.0)).clear(bead, tool, reach)
    assert 0 < clear.sum() < 60
    for i in range(60):
        tip = np.array([radius[bead[i]], 0.0, height[bead[i]]])
        curves = []
        for j in range(bead[i] + 1):
            def curve(at, r=radius[j], h=height[j]):
                return np.stack([r * np.cos(at), r * np.sin(at), np.full(len(at), h)], axis=1)

            curves.append((curve, *reach[i]))
        deepest = depth(tip, tool[i], curves, nozzle)
        assert deepest < 1e-6 if clear[i] else deepest > -1e-3
