# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links that touch: nothing that is drawn reaches into a body untold, and what is told is near."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.collision.deposit import build_deposit
from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.links import contact as arm_contact
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links import robot as robot_links
from freecad_am.core.kinematics.links.contact import DEPOSIT, NOZZLE, PLATFORM, ArmContact
from freecad_am.core.kinematics.links.self_collision import NONE
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.simulation.table_links import placing
from tests.posts.driven import bead_body

PART_ON_ROBOT = {}
TOOL_ON_ROBOT = {"setup": "tool-on-robot", "deposition_point": (900.0, 0.0, -100.0, 0.0, 0.0, 0.0)}
SETUPS = pytest.mark.parametrize(
    "setup", [PART_ON_ROBOT, TOOL_ON_ROBOT], ids=["part on robot", "tool on robot"]
)
SIZE = np.array([260.0, 180.0, 340.0])  # of a box


def box(low, name="fixture"):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * SIZE + low
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Body(
        name, corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])
    )


def cell_of(setup, **more):
    return cells.resolve(
        CellParameters(**{"limits": "paper", "platform_diameter": 0.0, **setup, **more}), np.eye(4)
    )


def drawn(cell):
    return robot_links.solids(cell.machine.chain)


def rods_of(cell):
    return [external_links.solid_cylinders(link) for link in drawn(cell)]


def laid(points, width=8.0, height=2.0):
    """One bead through points."""
    return build_deposit(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), width, height, [0])


def anywhere(cell, count, seed):
    most = np.full(6, np.pi)
    low, high = np.maximum(cell.limits.lower[:6], -most), np.minimum(cell.limits.upper[:6], most)
    return np.random.default_rng(seed).uniform(low, high, (count, 6))


def seen_from_part(cell, q, link):
    place = placing(cell, q)
    return frames.inverse(place.part) @ place.links[link]


@SETUPS
def test_what_is_drawn_does_not_reach_into_a_box_untold_and_what_is_told_is_near(setup):
    cell = cell_of(setup)
    low = np.array([-50.0, -90.0, 20.0]) if setup else np.array([-130.0, 150.0, -300.0])
    arm, links = ArmContact(cell, rods_of(cell), [box(low)]), drawn(cell)
    q = anywhere(cell, 1500, 1)
    found = arm.touches(q)
    told = np.flatnonzero(found.any & (found.what == arm.names.index("fixture")))
    assert len(told) > 12 and (~found.any).sum() > 100
    looked = range(1, 7) if setup else range(5)
    for k in np.flatnonzero(~found.any)[:500]:
        for link in looked:
            seen = seen_from_part(cell, q[k], link)
            for solid in links[link]:
                points = solid.move(seen).points
                assert not ((points > low) & (points < low + SIZE)).all(axis=1).any(), (k, link)
    for k in told:
        seen = seen_from_part(cell, q[k], found.link[k])
        points = np.concatenate(
            [
                solid.move(seen).points[solid.triangles].mean(axis=1)
                for solid in links[found.link[k]]
            ]
        )
        off = np.linalg.norm(
            np.maximum(np.maximum(low - points, points - low - SIZE), 0.0), axis=1
        ).min()
        # plates count as round cylinders, and tapering ones as wide as they are at most
        assert off < 90.0


def test_a_rod_and_a_box_touch_where_analysis_says():
    cell = cell_of(TOOL_ON_ROBOT)
    rods = rods_of(cell)
    q = np.zeros(6)
    for link in (2, 4, 6):
        rod = max(rods[link], key=lambda one: one.radius)
        seen = seen_from_part(cell, q, link)
        middle = seen[:3, :3] @ (0.5 * (rod.start + rod.end)) + seen[:3, 3]
        only = [[rod] if k == link else [] for k in range(7)]
        axis = seen[:3, :3] @ (rod.end - rod.start) / rod.length
        side = np.eye(3)[np.argmin(np.abs(axis))]
        # along x, y or z the cylinder reaches so far: half its length along its axis, and its radius across
        reach = 0.5 * rod.length * abs(axis @ side) + rod.radius * np.sqrt(1.0 - (axis @ side) ** 2)
        for gap, wanted in ((-1.0, True), (1.0, False)):
            low = middle - 0.5 * SIZE
            low += side * (0.5 * (SIZE @ side) + reach + gap)
            assert (
                arm_contact.ArmContact(cell, only, [box(low)]).touches(q[None]).any[0] == wanted
            ), (link, gap)


@SETUPS
def test_only_what_was_there_before_is_touched(setup):
    cell = cell_of(setup)
    rods = rods_of(cell)
    points = np.random.default_rng(3).uniform([-300, -300, 0], [300, 300, 400], (300, 3))
    q = anywhere(cell, 200, 4)
    everything = ArmContact(cell, rods, (), laid(points))
    found = everything.touches(q)
    there = found.any & (found.what == everything.names.index(DEPOSIT))
    assert there.sum() > 10
    none = everything.touches(q, np.zeros(200, dtype=np.int64))
    assert not (none.what == everything.names.index(DEPOSIT)).any()
    # with the first k points it is what a deposit of those alone says
    k = 120
    first = ArmContact(cell, rods, (), laid(points[:k]))
    assert (everything.touches(q, np.full(200, k)).link == first.touches(q).link).all()
    assert (everything.touches(q, np.full(200, k)).any != everything.touches(q).any).any()


@SETUPS
def test_links_touch_beads_as_wide_and_high_as_they_are(setup):
    """Against points in and on the beads, a mm apart: where one is in a rod it is told, where it is told one is near."""
    cell = cell_of(setup)
    rods = rods_of(cell)
    turn = np.linspace(0.0, 4.0 * np.pi, 160)
    points = np.stack([250.0 * np.cos(turn), 250.0 * np.sin(turn), 150.0 + 8.0 * turn], axis=1)
    arm = ArmContact(cell, rods, (), laid(points))
    dense = bead_body(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), 8.0, 2.0)
    q = anywhere(cell, 400, 8)
    found = arm.touches(q)
    looked = range(1, 7) if setup else range(5)
    tree, near = cKDTree(dense), 1.0  # mm; points farther than that from a rod are none that count
    apart = np.full((len(q), 7), np.inf)
    for k in range(len(q)):
        for link in looked:
            place = seen_from_part(cell, q[k], link)
            seen = frames.inverse(place)
            for rod in rods[link]:
                ball = np.hypot(0.5 * rod.length, rod.radius) + near
                around = tree.query_ball_point(
                    place[:3, :3] @ (0.5 * (rod.start + rod.end)) + place[:3, 3], ball
                )
                if not around:
                    continue
                own = dense[around] @ seen[:3, :3].T + seen[:3, 3]
                axis = (rod.end - rod.start) / rod.length
                along = (own - rod.start) @ axis
                away = np.linalg.norm(own - rod.start - along[:, None] * axis, axis=1) - rod.radius
                out = np.maximum(np.maximum(-along, along - rod.length), 0.0)
                apart[k, link] = min(apart[k, link], np.hypot(np.maximum(away, 0.0), out).min())
    told = found.what == arm.names.index(DEPOSIT)
    other = found.any & ~told
    assert told.sum() > 8 and (~found.any).sum() > 100
    assert (apart[~other & ~told].min(axis=1) > 0.0).all()
    assert all(apart[k, found.link[k]] < near for k in np.flatnonzero(told))


def test_platform_and_nozzle_are_looked_at():
    cell = cell_of(
        PART_ON_ROBOT,
        platform_diameter=400.0,
        nozzle=NozzleParameters(length=500.0, half_angle=0.6),
    )
    arm = ArmContact(cell, rods_of(cell))
    assert arm.names[:2] == (NOZZLE, PLATFORM)
    q = anywhere(cell, 2000, 7)
    found = arm.touches(q)
    assert (
        {0, 1} <= set(np.unique(found.what)) <= {NONE, 0, 1, *range(2, 9)}
    )  # and links each other
    # the forearm meets a large platform where the wrist is bent most, whatever the other joints
    bent = np.abs(q[:, 4])
    platform = (found.what == 1) & (found.link == 4)
    assert bent[platform].min() > np.radians(60) and found.any[bent > np.radians(115)].mean() > 0.9
    # the nozzle stands still: turned about by the first axis a robot that touches it does not
    touching = q[found.what == 0]
    assert len(touching) > 3
    touching[:, 0] += np.pi
    assert not (arm.touches(touching).what == 0).any()


def test_unreachable_points_touch_nothing():
    cell = cell_of(PART_ON_ROBOT)
    found = ArmContact(cell, rods_of(cell), [box(np.array([-130.0, -90.0, -170.0]))]).touches(
        np.full((3, 6), np.nan)
    )
    assert (found.link == NONE).all() and (found.what == NONE).all()
