# SPDX-License-Identifier: LGPL-2.1-or-later
"""Penetration depth at which a contact is reported: upright nozzles next to a wall and a bead at
known distances, slightly below and above the tolerances promised in docs/architecture.md and the
tolerance module."""

import numpy as np
import pytest

from freecad_am.core.collision.deposit import build_deposit
from freecad_am.core.collision.frustum import Frustum, side_height
from freecad_am.core.collision.scene import depositing, scene, travelling
from freecad_am.core.geometry.cylinders import Cylinder
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.parameters.cell import CellParameters

RADIUS, LENGTH, UP = 3.0, 30.0, np.array([[0.0, 0.0, 1.0]])
WIDTH, HEIGHT = 4.0, 2.0


def wall(x):
    """A block with a face at x that faces -X, and large on all other sides."""
    corners = np.array(
        [[x + a, b, c] for a in (0.0, 50.0) for b in (-50.0, 50.0) for c in (-50.0, 50.0)]
    )
    sides = [
        (0, 1, 3),
        (0, 3, 2),
        (4, 7, 5),
        (4, 6, 7),
        (0, 5, 1),
        (0, 4, 5),
        (2, 3, 7),
        (2, 7, 6),
        (0, 2, 6),
        (0, 6, 4),
        (1, 5, 7),
        (1, 7, 3),
    ]
    return Body("wall", corners, np.array(sides))


def bead():
    """A bead along Y, centred on x = 0, from z = 0 up."""
    points = np.array([[0.0, -20.0, 0.0], [0.0, 20.0, 0.0]])
    return build_deposit(points, np.repeat(UP, 2, axis=0), WIDTH, HEIGHT, [0])


def meets(nozzle, x, bodies=(), deposit=None):
    tip = np.array([[x, 0.0, 0.0]])
    return bool(scene(bodies, tip, 100.0, deposit).find_touching(nozzle, tip, UP)[0])


# penetration of two solids in mm
@pytest.mark.parametrize(
    ("deep", "touched"), [(-0.02, False), (0.03, False), (0.07, True), (0.5, True)]
)
def test_on_rapids_a_nozzle_is_in_a_bead_by_no_more_than_its_chords_are_off(deep, touched):
    x = RADIUS + 0.5 * WIDTH - deep
    assert meets(travelling(RADIUS, 0.0, LENGTH), x, deposit=bead()) == touched


@pytest.mark.parametrize(
    ("deep", "touched"), [(-0.02, False), (0.08, False), (0.12, True), (0.5, True)]
)
def test_on_rapids_a_nozzle_is_in_a_body_by_no_more_than_triangles_are_off(deep, touched):
    assert meets(travelling(RADIUS, 0.0, LENGTH), deep - RADIUS, [wall(0.0)]) == touched


@pytest.mark.parametrize(
    ("deep", "let", "halfway"), [(0.02, True, False), (0.08, True, False), (0.12, True, True)]
)
def test_while_depositing_beads_are_met_exactly_and_halfway_within_a_tenth(deep, let, halfway):
    nozzle = depositing(RADIUS, 0.5, LENGTH, 0.0)
    low = nozzle.deposit.low
    tall = build_deposit(
        np.array([[0.0, -50.0, 0.0], [0.0, 50.0, 0.0]]),
        np.repeat(UP, 2, axis=0),
        WIDTH,
        2.0 * low,
        [0],
    )
    # the side of the cone is deepest in the bead's round flank, a quarter circle of half the height
    # about its upper edge
    round_, top = 0.5 * WIDTH, 2.0 * low - 0.5 * WIDTH
    lean = np.hypot(1.0, 0.5)
    x = (RADIUS + 0.5 * top) + lean * (round_ - deep)
    assert low < top - 0.5 * round_ / lean  # that point is above the exempt height
    assert (
        meets(nozzle, x, deposit=tall) == let
        and meets(nozzle.halfway(), x, deposit=tall) == halfway
    )
    assert not meets(nozzle, x + lean * (deep + 0.01), deposit=tall)


def test_over_the_bodies_that_a_nozzle_deposits_on_what_both_faces_may_be_off_is_left_out():
    nozzle, slope = depositing(RADIUS, 0.5, LENGTH, 0.0), 0.5
    assert nozzle.bodies.low == pytest.approx(side_height(RADIUS, slope) + 0.2)


@pytest.mark.parametrize(("gap", "touched"), [(-1.0, True), (0.15, True), (0.25, False)])
@pytest.mark.parametrize("clearance", [0.0, 10.0])
def test_links_are_kept_as_far_as_two_lots_of_triangles_are_off(gap, touched, clearance):
    """A capsule of link 2 along the wall touches from 0.2 mm on, and with a clearance
    correspondingly earlier."""
    cell = cells.resolve(
        CellParameters(
            setup="tool-on-robot",
            mount="part",
            deposition_point=(1000.0, 0.0, -100.0, 0.0, 0.0, 0.0),
            platform_diameter=0.0,
        ),
        np.eye(4),
        "developable",
    )
    joints = np.radians([[10.0, 20.0, -15.0, 5.0, 40.0, 30.0]])
    ends = np.array([[-5.0 - gap - clearance, y, 0.0, 1.0] for y in (-10.0, 10.0)])
    part_pose = cell.poses.station @ np.linalg.inv(cell.poses.mount)
    link_ends = (np.linalg.inv(cell.links(joints)[0, 2]) @ part_pose @ ends.T).T[:, :3]
    rods = [()] * 2 + [(Cylinder(*link_ends, 5.0),)] + [()] * 4
    contact = ArmContact(cell, rods, (wall(0.0),), clearance=clearance).touches(joints)
    assert bool(contact.any[0]) == touched and (not touched or contact.link[0] == 2)


def test_rounding_is_no_touch_and_a_nanometre_is_one():
    solid = Frustum(RADIUS, 0.0, 0.0, LENGTH)
    points = np.array([[0.0, -20.0, 5.0], [0.0, 20.0, 5.0]])
    line = build_deposit(points, np.repeat(UP, 2, axis=0), 0.0, 0.0, [0])
    for deep, touched in ((-1e-6, False), (1e-10, False), (1e-6, True)):
        assert meets(solid, RADIUS - deep, deposit=line) == touched
