# SPDX-License-Identifier: LGPL-2.1-or-later
"""Nozzle clearance from all earlier deposit, by brute force: beads as swept solids, and a plain
test of the cone."""

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc, line
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.strategies.revolution import plan as revolution
from tests.swept_beads import Cone, Swept, in_platform

DOME = Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)])
SMALL_DOME = Meridian.chained([arc((0.0, 0.0), 12.0, 0.0, np.pi / 2)])
BOTTLE = Meridian.chained(
    [
        line((20.0, 0.0), (20.0, 15.0)),
        arc((8.0, 15.0), 12.0, 0.0, np.pi / 2),
        line((8.0, 27.0), (4.0, 27.0)),
    ]
)
LAVAL = Meridian.chained(
    [
        line((30.0, 0.0), (30.0, 10.0)),
        arc((15.0, 10.0), 15.0, 0.0, np.pi / 3),
        arc((30.0, 36.0), 15.0, np.pi * 4 / 3, np.pi),
        line((15.0, 36.0), (28.0, 80.0)),
    ]
)
VASE = Meridian.chained(
    [arc((30.0, 20.0), 20.0, -np.pi / 2, 0.0), arc((15.0, 20.0), 35.0, 0.0, np.pi / 2.5)]
)
HORN = Meridian.chained(
    [arc((60.0, 0.0), 20.0, np.pi, np.pi / 2), line((60.0, 20.0), (75.0, 20.0))]
)
LOW_HORN = Meridian.chained(
    [arc((40.0, 0.0), 6.0, np.pi, np.pi / 2), line((40.0, 6.0), (50.0, 6.0))]
)
SLIM = NozzleParameters(half_angle=np.radians(8.0), diameter=0.4, length=40.0)
STUBBY = NozzleParameters(half_angle=np.radians(50.0), diameter=3.0, length=15.0)
DEFAULT_NOZZLE = NozzleParameters()


def planned(
    meridian, nozzle, platform=0.0, turn=None, height=3.0, width=8.0, path="layers", **build
):
    start, end = turn or (0.0, 2.0 * np.pi)
    wall = RevolvedWall(meridian, np.eye(4), start, end, turn is None)
    strategy = RevolutionParameters(layer_height=height, chord_error=0.05, path=path)
    process = ProcessParameters(bead_width=width)
    return revolution.plan(
        wall, strategy, BuildDirectionParameters(**build), process, nozzle, platform
    )


def swept(toolpath):
    return Swept(
        [
            (
                bead.points,
                bead.build,
                np.full(len(bead), toolpath.bead_width),
                np.full(len(bead), toolpath.layer_height),
                layer,
            )
            for layer, _, bead in toolpath
        ]
    )


def cone(nozzle):
    return Cone(0.5 * nozzle.diameter, nozzle.half_angle, nozzle.length)


def lowest(toolpath, nozzle, lead=0.0, tilt=0.0):
    return cone(nozzle).clear_of(toolpath.layer_height, np.arccos(np.cos(lead) * np.cos(tilt)))


def tilted(direction, back):
    """Tilt a direction towards the vertical by `back`."""
    level = np.hypot(direction[0], direction[1])
    angle = np.arctan2(level, direction[2]) - back
    return np.array([*(direction[:2] / level * np.sin(angle)), np.cos(angle)])


def backs(free, toolpath):
    """Tilt-back angle of each bead in rad."""
    return [
        np.arccos(np.clip((bead.build[0] * unrestricted.build[0]).sum(), -1.0, 1.0))
        for (_, _, bead), (_, _, unrestricted) in zip(free, toolpath, strict=True)
    ]


CASES = [
    (DOME, DEFAULT_NOZZLE, {}),
    (DOME, SLIM, {}),
    (DOME, STUBBY, {}),
    (SMALL_DOME, DEFAULT_NOZZLE, {}),
    (BOTTLE, DEFAULT_NOZZLE, {}),
    (BOTTLE, SLIM, {}),
    (DOME, DEFAULT_NOZZLE, {"lead": 0.2}),
    (DOME, DEFAULT_NOZZLE, {"lead": -0.3, "tilt": 0.1}),
    (BOTTLE, STUBBY, {"tilt": -0.2}),
    (BOTTLE, DEFAULT_NOZZLE, {"lead": 0.4}),
    (HORN, STUBBY, {}),
    (LAVAL, DEFAULT_NOZZLE, {}),
    (VASE, DEFAULT_NOZZLE, {}),
    (VASE, STUBBY, {}),
]


@pytest.mark.parametrize(("meridian", "nozzle", "build"), CASES)
@pytest.mark.parametrize("turn", [None, (0.3, 2.0)])
@pytest.mark.always
def test_the_nozzle_is_clear_of_wide_beads_and_would_not_be_with_less_tilt_back(
    meridian, nozzle, build, turn
):
    """The planned tilt-back clears the nozzle of wide beads, and less would not."""
    free = planned(meridian, nozzle, turn=turn, clearance="none", max_tilt=np.pi, **build)
    toolpath = planned(meridian, nozzle, turn=turn, max_tilt=np.pi, **build)
    assert not [issue for issue in toolpath.issues if issue.level == "error"]
    deposit, low = swept(toolpath), lowest(toolpath, nozzle, **build)
    touched = 0
    for k, ((_, _, bead), back) in enumerate(zip(toolpath, backs(free, toolpath), strict=True)):
        samples, layer_start = (
            np.unique(np.linspace(0, len(bead) - 1, 5).astype(int)),
            deposit.layer_began(k),
        )

        def deepest(point, tool, k=k, bead=bead, layer_start=layer_start):
            return deposit.deepest(
                bead.points[point],
                tool,
                deposit.begin[k] + point + 1,
                layer_start,
                cone(nozzle),
                low,
            )

        assert max(deepest(j, bead.tool[j]) for j in samples) < 1e-4
        # for the blunt nozzle, beads tilt back further than necessary so that later beads find
        # space
        if back > np.radians(3.0) and not build and nozzle is not STUBBY:
            touched += 1
            free_directions = free.layers[k].beads[0].build
            # the nozzle is enlarged by the chord error of the deposit, which tilts it slightly
            # further
            less = 0.96 * back - np.radians(0.8)
            assert max(deepest(j, tilted(free_directions[j], less)) for j in samples) > 0.0
    if (
        (meridian is DOME or meridian is BOTTLE)
        and turn is None
        and not build
        and nozzle is not STUBBY
    ):
        assert touched > 0


def test_where_directions_differ_along_a_bead_each_of_its_points_is_clear():
    toolpath = planned(DOME, DEFAULT_NOZZLE, turn=(0.3, 5.0), mode="layer")
    assert not [issue for issue in toolpath.issues if issue.level == "error"]
    laid, low = swept(toolpath), lowest(toolpath, DEFAULT_NOZZLE)
    depths = [
        laid.deepest(
            bead.points[j],
            bead.tool[j],
            laid.begin[k] + j + 1,
            laid.layer_began(k),
            cone(DEFAULT_NOZZLE),
            low,
        )
        for k, (_, _, bead) in enumerate(toolpath)
        for j in range(0, len(bead), 3)
    ]
    assert max(depths) < 1e-4
    assert any(issue.code == "TILT_BACK" for issue in toolpath.issues)


@pytest.mark.parametrize(
    ("meridian", "nozzle", "build"),
    [
        (LOW_HORN, DEFAULT_NOZZLE, {}),
        (LOW_HORN, STUBBY, {}),
        (LOW_HORN, STUBBY, {"lead": 0.2}),
        (HORN, STUBBY, {"tilt": 0.3}),
    ],
)
def test_the_nozzle_is_clear_of_the_platform_and_no_more_tilted_than_that_needs(
    meridian, nozzle, build
):
    free = planned(meridian, nozzle, platform=0.0, max_tilt=np.pi, width=1.0, height=1.5, **build)
    toolpath = planned(
        meridian, nozzle, platform=200.0, max_tilt=np.pi, width=1.0, height=1.5, **build
    )
    low = (
        cone(nozzle).clear_of(0.0, 0.0) + 0.2
    )  # contact of a nozzle that stands on a face, and the tolerance of faces
    touched = 0
    for (_, _, bead), back in zip(toolpath, backs(free, toolpath), strict=True):
        assert in_platform(bead.points[0], bead.tool[0], cone(nozzle), low, 100.0) < 1e-4
        if back > np.radians(2.0) and not build:
            touched += 1
            less = tilted(bead.build[0], -0.04 * back - np.radians(0.5))
            assert in_platform(bead.points[0], less, cone(nozzle), low, 100.0) > 0.0
    assert touched > 0 or build


def test_the_largest_tilt_back_is_told():
    toolpath = planned(DOME, DEFAULT_NOZZLE)
    note = next(issue for issue in toolpath.issues if issue.code == "TILT_BACK")
    back = np.degrees(backs(planned(DOME, DEFAULT_NOZZLE, clearance="none"), toolpath))
    back[back < 1e-5] = 0.0
    assert f"layer {int(np.argmax(back > 1e-6))} on" in note.message
    assert f"{back.max():.2f} deg" in note.message
    assert note.layer == int(np.argmax(back))


def test_a_wall_that_turns_down_outside_cannot_be_reached():
    # up inside and down again outside: the nozzle would have to pass through the inner wall
    gutter = Meridian.chained(
        [
            line((20.0, 0.0), (20.0, 15.0)),
            arc((21.0, 15.0), 1.0, np.pi, 0.0),
            line((22.0, 15.0), (22.0, 5.0)),
        ]
    )
    issue = next(
        issue
        for issue in planned(gutter, DEFAULT_NOZZLE, height=1.5).issues
        if issue.code == "CLEARANCE"
    )
    assert issue.level == "error"
    assert issue.layer >= 11


def test_beads_too_wide_for_what_is_left_open_are_told_with_layer_and_remedy():
    # up, over and down into the remaining well: at every tilt the nozzle touches the wall
    well = Meridian.chained(
        [
            line((20.0, 0.0), (20.0, 20.0)),
            arc((14.0, 20.0), 6.0, 0.0, np.pi),
            line((8.0, 20.0), (8.0, 6.0)),
        ]
    )
    issue = next(
        issue
        for issue in planned(well, DEFAULT_NOZZLE, height=2.0).issues
        if issue.code == "CLEARANCE"
    )
    assert issue.level == "error" and issue.layer >= 10 and issue.bead == 0
    assert "beads of 8 mm" in issue.message and "process.bead_width" in issue.message


def test_without_clearance_nothing_is_tilted():
    for i, layer in enumerate(planned(DOME, DEFAULT_NOZZLE, clearance="none").layers):
        assert np.arccos(layer.beads[0].build[0, 2]) == pytest.approx(3.0 * i / 45.0, abs=1e-7)


def test_beads_as_thin_as_lines_are_tilted_less():
    thin, wide = (planned(DOME, DEFAULT_NOZZLE, width=width, height=1.0) for width in (0.5, 8.0))
    free = planned(DOME, DEFAULT_NOZZLE, clearance="none", height=1.0)
    assert np.all(np.array(backs(free, thin)) < np.array(backs(free, wide)) + 1e-5)
    assert backs(free, thin)[60] < backs(free, wide)[60] - np.radians(5.0)


@pytest.mark.parametrize(
    ("sense", "build"), [("counter-clockwise", {}), ("clockwise", {"lead": 0.2})]
)
def test_a_spiral_is_clear_of_all_its_earlier_turns(sense, build):
    """A spiral clears all its earlier turns."""
    wall = RevolvedWall(SMALL_DOME, np.eye(4))
    strategy = RevolutionParameters(path="spiral", chord_error=0.02, layer_height=1.5)
    process = ProcessParameters(direction=sense)
    toolpath = revolution.plan(
        wall, strategy, BuildDirectionParameters(**build), process, DEFAULT_NOZZLE, 0.0
    )
    deposit, low = swept(toolpath), lowest(toolpath, DEFAULT_NOZZLE, **build)
    bead = toolpath.layers[0].beads[0]
    turned = np.abs(bead.parameter - bead.parameter[0])
    turn_start = np.searchsorted(turned, turned - 2.0 * np.pi - 1e-6)
    depths = [
        deposit.deepest(
            bead.points[i], bead.tool[i], i + 1, turn_start[i], cone(DEFAULT_NOZZLE), low
        )
        for i in range(1, len(bead), 7)
    ]
    assert -1.0 < max(depths) < 1e-4
