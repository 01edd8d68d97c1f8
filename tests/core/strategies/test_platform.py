# SPDX-License-Identifier: LGPL-2.1-or-later
"""A wall that is not on the platform, and the position of the platform under one that is."""

import tracemalloc

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, line
from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.geometry.on_hub import Base, Group, SolidsOnHub, upright
from freecad_am.core.issues import InputError
from freecad_am.core.strategies.revolution import clearance

FRAME = np.array(
    [[0.0, -1.0, 0.0, 30.0], [1.0, 0.0, 0.0, 40.0], [0.0, 0.0, 1.0, 5.0], [0.0, 0.0, 0.0, 1.0]]
)
WALL = RevolvedWall(Meridian.chained([line((20.0, 0.0), (20.0, 10.0))]), FRAME, label="Cup")


def pose_at(x, y, z, lean=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    c, s = np.cos(lean), np.sin(lean)
    pose[:3, :3] = [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
    return pose


def test_under_the_feature_frame_the_disc_is_at_its_origin():
    assert clearance.under(WALL, 50.0, None) == clearance.Platform(25.0, 0.0)
    assert clearance.under(WALL, 50.0, FRAME) == clearance.Platform(25.0, 0.0)
    assert clearance.under(WALL, 0.0, pose_at(900.0, 0.0, 0.0, 1.0)).radius == 0.0


def test_a_disc_below_and_beside_is_taken_on_the_safe_side():
    disc = clearance.under(WALL, 200.0, pose_at(0.0, 0.0, 0.0))
    assert disc.radius == pytest.approx(150.0) and disc.off == pytest.approx(50.0)
    assert disc.height == pytest.approx(-5.0)


@pytest.mark.parametrize(
    ("diameter", "frame", "said"),
    [
        (90.0, pose_at(0.0, 0.0, 0.0), "50 mm off the middle"),
        (300.0, pose_at(0.0, 0.0, 6.0), "1 mm below"),
        (300.0, pose_at(30.0, 40.0, 5.0, 0.1), r"5\.73 deg"),
        (300.0, pose_at(30, 40, 5, np.pi), "180 deg"),
    ],
)
def test_what_misses_the_platform_is_refused(diameter, frame, said):
    with pytest.raises(InputError, match=said) as refused:
        clearance.under(WALL, diameter, frame)
    assert refused.value.code == "OFF_PLATFORM"
    assert "Cup" in refused.value.message


@pytest.mark.parametrize(
    ("diameter", "frame", "over"),
    [
        (30.0, None, True),
        (40.0, None, False),
        (0.0, None, False),
        (130.0, pose_at(0.0, 0.0, 0.0), True),
        (140.0, pose_at(0.0, 0.0, 0.0), False),
    ],
)
def test_a_base_that_reaches_over_the_edge_is_deposited_with_a_warning(diameter, frame, over):
    issues = clearance.overhanging(WALL, clearance.under(WALL, diameter, frame))
    assert [(issue.level, issue.code) for issue in issues] == (
        [("warning", "OVER_PLATFORM")] if over else []
    )
    assert all("Cup has a diameter of 40 mm" in issue.message for issue in issues)


@pytest.mark.parametrize(
    ("diameter", "frame", "mended"),
    [
        (30.0, None, False),
        (130.0, pose_at(0.0, 0.0, 0.0), True),
        (40.0, pose_at(29.0, 40.0, 0.0), True),
        (39.9, pose_at(29, 40, 0), False),
    ],
)
def test_the_frame_of_the_feature_is_a_remedy_where_it_does(diameter, frame, mended):
    (issue,) = clearance.overhanging(WALL, clearance.under(WALL, diameter, frame))
    assert ("use cell.mount: feature" in issue.message) == mended
    assert mended == (
        frame is not None and not clearance.overhanging(WALL, clearance.under(WALL, diameter, None))
    )


@pytest.mark.parametrize("depth", [0.0, 7.5])
def test_of_a_part_far_larger_than_the_platform_only_what_is_over_it_is_looked_at(depth):
    """A plate of 6 m, whose underside would take 70 million samples, is above the disc only with
    the middle of its underside, far from every corner."""
    corner = np.array(
        [[x, y, z] for x in (-3000.0, 3000.0) for y in (-3000.0, 3000.0) for z in (-depth, 50.0)]
    )
    sides = [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
        [1, 5, 7],
        [1, 7, 3],
    ]
    base = Base(
        "hub", Developable(1.0), upright(np.array([0.0, 4000.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    )
    solids = SolidsOnHub(
        "plate", (Group(base, (Body("plate", corner, np.array(sides, dtype=np.int64)),)),), 0.01
    )
    tracemalloc.start()
    if depth:
        with pytest.raises(InputError, match=r"plate extends 7\.5 mm below the platform"):
            clearance.refuse_solids_below(solids, np.eye(4), 40.0)
    else:
        clearance.refuse_solids_below(solids, np.eye(4), 40.0)
    _, peak_memory = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak_memory < 10e6


@pytest.mark.parametrize(
    ("drop", "diameter", "refused"),
    [
        (0.0, 300.0, False),
        (0.04, 300.0, False),
        (7.5, 300.0, True),
        (7.5, 0.0, False),
        (7.5, 110.0, False),
    ],
)
def test_solids_that_reach_below_the_platform_are_refused_with_their_depth(drop, diameter, refused):
    """A bar next to a hub of 40 mm: the share inside the hub does not count, nor does the share
    beyond the platform."""
    corner = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
    sides = [
        [0, 1, 3],
        [0, 3, 2],
        [4, 6, 7],
        [4, 7, 5],
        [0, 4, 5],
        [0, 5, 1],
        [2, 3, 7],
        [2, 7, 6],
        [0, 2, 6],
        [0, 6, 4],
        [1, 5, 7],
        [1, 7, 3],
    ]
    bar = corner * [250.0, 20.0, 60.0] - [-60.0, 10.0, drop]
    within = corner * [10.0, 20.0, 90.0] - [5.0, 10.0, 20.0]
    faces = np.array(sides, dtype=np.int64)
    base = Base("hub", Developable(40.0), upright(np.zeros(3), np.array([0.0, 0.0, 1.0])))
    bar_and_core = Body("bar", np.vstack([bar, within]), np.vstack([faces, faces + 8]))
    solids = SolidsOnHub("bars", (Group(base, (bar_and_core,)),), 0.01)
    if not refused:
        clearance.refuse_solids_below(solids, np.eye(4), diameter)
        return
    with pytest.raises(
        InputError, match=r"bar extends 7\.5 mm below the platform, at \("
    ) as caught:
        clearance.refuse_solids_below(solids, np.eye(4), diameter)
    assert "use mount: feature" in caught.value.message
    assert caught.value.code == "OFF_PLATFORM" and caught.value.where == "cell.platform_diameter"
