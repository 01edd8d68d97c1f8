# SPDX-License-Identifier: LGPL-2.1-or-later
"""Links of a robot against each other, by PyKDL's frames and points on the links: reports are near,
near pairs are reported; and which pairs are omitted."""

import numpy as np
import pytest

from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.contact import ArmContact, min_distance
from freecad_am.core.kinematics.links.self_collision import NONE, OwnLinks, positions
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.parameters.cell import CellParameters
from tests.core.planning.test_arm_clearance import on_rods
from tests.kdl_links import KdlLinks

SPACING, CLEARANCE = 12.0, 10.0


def own_of(name, clearance=CLEARANCE):
    robot = machine.load(name)
    limits = robot.limits("maker")
    rods = external_links.robot_cylinders(robot.chain)
    return robot, limits, rods, OwnLinks.of(robot.chain, limits, rods, clearance)


def clouds(robot, rods, q):
    """Points on all links by PyKDL in the robot's base frame."""
    arm, link_points = KdlLinks(robot), []
    for number, link in enumerate(rods):
        pose = arm.frame(q, number)
        link_points.append(on_rods(link, SPACING) @ pose[:3, :3].T + pose[:3, 3])
    return link_points


@pytest.mark.parametrize("name", ["ur-ur5e", "fanuc-arcmate120ic"])
@pytest.mark.always("ur-ur5e")
def test_what_is_told_is_near_and_what_is_near_is_told(name):
    """A reported pair is near, and a near pair is reported."""
    from scipy.spatial import cKDTree

    robot, limits, rods, own_links = own_of(name)
    q = np.random.default_rng(5).uniform(
        np.maximum(limits.lower, -np.pi), np.minimum(limits.upper, np.pi), (1500, 6)
    )
    outer, inner = own_links.touches(robot.chain.links(q))
    reported = np.flatnonzero(outer != NONE)
    assert len(reported) > 20
    for k in [*reported[:25], *np.flatnonzero(outer == NONE)[:40]]:
        points = clouds(robot, rods, q[k])
        trees = [cKDTree(cloud) for cloud in points]
        distances = {
            (outer_link, inner_link): trees[inner_link].query(points[outer_link])[0].min()
            for outer_link, inner_link in own_links.pairs
        }
        if outer[k] != NONE:
            assert distances[outer[k], inner[k]] < CLEARANCE + 2.0 * SPACING
        else:
            assert min(distances.values()) >= CLEARANCE, (k, min(distances, key=distances.get))


def test_pairs_that_are_left_out_are_those_of_the_rule():
    """The omitted pairs are those of the rule."""
    all_pairs = {(outer, inner) for outer in range(7) for inner in range(outer)}
    joined = {(outer, inner) for outer, inner in all_pairs if outer - inner == 1}
    for name in ("ur-ur5e", "fanuc-arcmate120ic", "abb-irb4600-40-255"):
        assert all_pairs - set(own_of(name)[-1].pairs) == joined | {(2, 0), (6, 4)}
    # a pair nearer than the clearance almost everywhere is omitted
    wide = own_of("fanuc-arcmate120ic", 300.0)[-1]
    assert all_pairs - set(wide.pairs) == joined | {(2, 0), (4, 2), (6, 4)}


def test_positions_are_in_all_parts_of_all_ranges_and_keep_coupled_limits():
    """Sampled joint positions cover all ranges and keep coupled limits."""
    robot = machine.load("fanuc-arcmate120ic")
    limits = robot.limits("maker")
    assert len(limits.coupled_lower)
    samples = positions(limits, 6)
    assert len(samples) > 50 and not limits.exceeded(samples).any()
    share = (samples - limits.lower) / (limits.upper - limits.lower)
    assert all(np.histogram(column, 5, (0.0, 1.0))[0].min() > 3 for column in share.T)
    assert (positions(limits, 6) == samples).all()


def test_links_of_each_other_have_names_and_leave_no_distance():
    """A wrist folded onto the forearm."""
    cell = cells.resolve(
        CellParameters(
            machine="ur-ur5e",
            setup="tool-on-robot",
            deposition_point=(400.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        ),
        np.eye(4),
    )
    rods = external_links.robot_cylinders(cell.robot.chain)
    contact = ArmContact(cell, rods)
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (600, 6))
    met = contact.touches(q)
    names = {(contact.links[a], contact.names[b]) for a, b in zip(met.link, met.what) if a != NONE}
    assert {("Elbow", "base"), ("Wrist 3", "link Elbow")} <= names
    is_own_contact = met.what >= len(contact.groups)
    assert is_own_contact.sum() > 20 and all(
        min_distance(contact, q[[k]], np.zeros(1, dtype=np.int64), 500.0) == 0.0
        for k in np.flatnonzero(is_own_contact)[:5]
    )
