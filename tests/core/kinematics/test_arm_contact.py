# SPDX-License-Identifier: LGPL-2.1-or-later
"""Link contacts: every drawn solid that penetrates a body is reported, and every reported contact
is near."""

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


def cell_of(setup, **options):
    return cells.resolve(
        CellParameters(**{"limits": "paper", "platform_diameter": 0.0, **setup, **options}),
        np.eye(4),
    )


def drawn_links(cell):
    return robot_links.solids(cell.machine.chain)


def rods_of(cell):
    return [external_links.solid_cylinders(link) for link in drawn_links(cell)]


def build_bead(points, width=8.0, height=2.0):
    """One bead through points."""
    return build_deposit(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), width, height, [0])


def anywhere(cell, count, seed):
    full_turn = np.full(6, np.pi)
    low, high = (
        np.maximum(cell.limits.lower[:6], -full_turn),
        np.minimum(cell.limits.upper[:6], full_turn),
    )
    return np.random.default_rng(seed).uniform(low, high, (count, 6))


def seen_from_part(cell, q, link):
    placed_cell = placing(cell, q)
    return frames.inverse(placed_cell.part) @ placed_cell.links[link]


@SETUPS
def test_what_is_drawn_does_not_reach_into_a_box_untold_and_what_is_told_is_near(setup):
    """No drawn link penetrates a box without a report, and reported links are near the box."""
    cell = cell_of(setup)
    low = np.array([-50.0, -90.0, 20.0]) if setup else np.array([-130.0, 150.0, -300.0])
    arm, links = ArmContact(cell, rods_of(cell), [box(low)]), drawn_links(cell)
    q = anywhere(cell, 1500, 1)
    contacts = arm.touches(q)
    reported = np.flatnonzero(contacts.any & (contacts.what == arm.names.index("fixture")))
    assert len(reported) > 12 and (~contacts.any).sum() > 100
    checked_links = range(1, 7) if setup else range(5)
    for k in np.flatnonzero(~contacts.any)[:500]:
        for link in checked_links:
            link_pose = seen_from_part(cell, q[k], link)
            for solid in links[link]:
                points = solid.move(link_pose).points
                assert not ((points > low) & (points < low + SIZE)).all(axis=1).any(), (k, link)
    for k in reported:
        link_pose = seen_from_part(cell, q[k], contacts.link[k])
        points = np.concatenate(
            [
                solid.move(link_pose).points[solid.triangles].mean(axis=1)
                for solid in links[contacts.link[k]]
            ]
        )
        off = np.linalg.norm(
            np.maximum(np.maximum(low - points, points - low - SIZE), 0.0), axis=1
        ).min()
        # plates count as round cylinders, and tapering ones by their maximum width
        assert off < 90.0


def test_a_rod_and_a_box_touch_where_analysis_says():
    """A capsule and a box touch at the analytic distance."""
    cell = cell_of(TOOL_ON_ROBOT)
    rods = rods_of(cell)
    q = np.zeros(6)
    for link in (2, 4, 6):
        rod = max(rods[link], key=lambda candidate: candidate.radius)
        link_pose = seen_from_part(cell, q, link)
        middle = link_pose[:3, :3] @ (0.5 * (rod.start + rod.end)) + link_pose[:3, 3]
        only = [[rod] if k == link else [] for k in range(7)]
        axis = link_pose[:3, :3] @ (rod.end - rod.start) / rod.length
        side = np.eye(3)[np.argmin(np.abs(axis))]
        # extent of the cylinder along x, y or z: half its length along its axis, and its radius
        # across
        reach = 0.5 * rod.length * abs(axis @ side) + rod.radius * np.sqrt(1.0 - (axis @ side) ** 2)
        for gap, expected in ((-1.0, True), (1.0, False)):
            low = middle - 0.5 * SIZE
            low += side * (0.5 * (SIZE @ side) + reach + gap)
            assert (
                arm_contact.ArmContact(cell, only, [box(low)]).touches(q[None]).any[0] == expected
            ), (link, gap)


@SETUPS
def test_only_what_was_there_before_is_touched(setup):
    """Only the deposit before the given moment counts."""
    cell = cell_of(setup)
    rods = rods_of(cell)
    points = np.random.default_rng(3).uniform([-300, -300, 0], [300, 300, 400], (300, 3))
    q = anywhere(cell, 200, 4)
    everything = ArmContact(cell, rods, (), build_bead(points))
    contacts = everything.touches(q)
    touches_deposit = contacts.any & (contacts.what == everything.names.index(DEPOSIT))
    assert touches_deposit.sum() > 10
    none = everything.touches(q, np.zeros(200, dtype=np.int64))
    assert not (none.what == everything.names.index(DEPOSIT)).any()
    # with the first k points the result is that of their deposit
    k = 120
    early_deposit = ArmContact(cell, rods, (), build_bead(points[:k]))
    assert (everything.touches(q, np.full(200, k)).link == early_deposit.touches(q).link).all()
    assert (everything.touches(q, np.full(200, k)).any != everything.touches(q).any).any()


@SETUPS
def test_links_touch_beads_as_wide_and_high_as_they_are(setup):
    """Against points in and on the beads, 1 mm apart: a point inside a capsule is reported, and a
    report has a point nearby."""
    cell = cell_of(setup)
    rods = rods_of(cell)
    turn = np.linspace(0.0, 4.0 * np.pi, 160)
    points = np.stack([250.0 * np.cos(turn), 250.0 * np.sin(turn), 150.0 + 8.0 * turn], axis=1)
    arm = ArmContact(cell, rods, (), build_bead(points))
    dense = bead_body(points, np.tile([0.0, 0.0, 1.0], (len(points), 1)), 8.0, 2.0)
    q = anywhere(cell, 400, 8)
    contacts = arm.touches(q)
    checked_links = range(1, 7) if setup else range(5)
    tree, tolerance = (
        cKDTree(dense),
        1.0,
    )  # mm; points farther than that from a capsule do not count
    distances = np.full((len(q), 7), np.inf)
    for k in range(len(q)):
        for link in checked_links:
            link_pose = seen_from_part(cell, q[k], link)
            part_in_link = frames.inverse(link_pose)
            for rod in rods[link]:
                ball = np.hypot(0.5 * rod.length, rod.radius) + tolerance
                around = tree.query_ball_point(
                    link_pose[:3, :3] @ (0.5 * (rod.start + rod.end)) + link_pose[:3, 3], ball
                )
                if not around:
                    continue
                points_in_link = dense[around] @ part_in_link[:3, :3].T + part_in_link[:3, 3]
                axis = (rod.end - rod.start) / rod.length
                along = (points_in_link - rod.start) @ axis
                radial_gap = (
                    np.linalg.norm(points_in_link - rod.start - along[:, None] * axis, axis=1)
                    - rod.radius
                )
                out = np.maximum(np.maximum(-along, along - rod.length), 0.0)
                distances[k, link] = min(
                    distances[k, link], np.hypot(np.maximum(radial_gap, 0.0), out).min()
                )
    reported = contacts.what == arm.names.index(DEPOSIT)
    other_contacts = contacts.any & ~reported
    assert reported.sum() > 8 and (~contacts.any).sum() > 100
    assert (distances[~other_contacts & ~reported].min(axis=1) > 0.0).all()
    assert all(distances[k, contacts.link[k]] < tolerance for k in np.flatnonzero(reported))


def test_platform_and_nozzle_are_looked_at():
    """Platform and nozzle are checked too."""
    cell = cell_of(
        PART_ON_ROBOT,
        platform_diameter=400.0,
        nozzle=NozzleParameters(length=500.0, half_angle=0.6),
    )
    arm = ArmContact(cell, rods_of(cell))
    assert arm.names[:2] == (NOZZLE, PLATFORM)
    q = anywhere(cell, 2000, 7)
    contacts = arm.touches(q)
    assert (
        {0, 1} <= set(np.unique(contacts.what)) <= {NONE, 0, 1, *range(2, 9)}
    )  # and links against each other
    # the forearm meets a large platform where the wrist is bent most, for all other joint values
    bent = np.abs(q[:, 4])
    platform = (contacts.what == 1) & (contacts.link == 4)
    assert (
        bent[platform].min() > np.radians(60) and contacts.any[bent > np.radians(115)].mean() > 0.9
    )
    # the nozzle is fixed: half a turn of the first axis moves the robot away from it
    touching = q[contacts.what == 0]
    assert len(touching) > 3
    touching[:, 0] += np.pi
    assert not (arm.touches(touching).what == 0).any()


def test_unreachable_points_touch_nothing():
    cell = cell_of(PART_ON_ROBOT)
    contacts = ArmContact(cell, rods_of(cell), [box(np.array([-130.0, -90.0, -170.0]))]).touches(
        np.full((3, 6), np.nan)
    )
    assert (contacts.link == NONE).all() and (contacts.what == NONE).all()
