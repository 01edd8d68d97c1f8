# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gaps between links and obstacles against points on the sides of enlarged cylinders, and gap rates
against differences."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.kinematics.links.gaps import Gaps
from freecad_am.core.simulation.table_links import placing
from tests.core.kinematics.test_arm_contact import (
    PART_ON_ROBOT,
    SIZE,
    TOOL_ON_ROBOT,
    anywhere,
    box,
    cell_of,
)
from tests.core.planning.test_arm_clearance import on_rods

CLEARANCE, ENLARGEMENT_MM = 10.0, 0.2  # mm; links are enlarged by the second value
MAX_GAP_MM = 250.0
BOXES = [
    (PART_ON_ROBOT, np.array([300.0, -90.0, 150.0])),
    (TOOL_ON_ROBOT, np.array([-500.0, 100.0, 300.0])),
]


def looked_at(setup, low):
    cell = cell_of(setup)
    return cell, ArmContact(
        cell, external_links.robot_cylinders(cell.robot.chain), [box(low)], clearance=CLEARANCE
    )


def every_gap(gaps, joints, rates):
    mask = np.ones((len(gaps.pairs), len(joints)), dtype=bool)
    return gaps.gaps_and_rates(joints, rates, np.zeros(len(joints), dtype=np.int64), mask)


@pytest.mark.parametrize(
    ("setup", "low"), [pytest.param(*BOXES[0], marks=pytest.mark.long), BOXES[1]]
)
def test_a_gap_is_that_of_points_on_larger_links_and_none_where_they_touch(setup, low):
    """A gap is the distance of points on enlarged links, and negative in contact."""
    cell, contact = looked_at(setup, low)
    gaps, joints = Gaps(contact, MAX_GAP_MM), anywhere(cell, 20, 3)
    gaps_found, _ = every_gap(gaps, joints, np.zeros_like(joints))
    assert np.array_equal((gaps_found < 0.0).any(axis=0), contact.touches(joints).any)
    larger = [
        [
            dataclasses.replace(
                rod,
                radius=rod.radius + CLEARANCE + ENLARGEMENT_MM,
                start=rod.start - extension,
                end=rod.end + extension,
            )
            for rod in link
            for extension in [(CLEARANCE + ENLARGEMENT_MM) * (rod.end - rod.start) / rod.length]
        ]
        for link in contact.cylinders
    ]
    separate_count = 0
    for row, pair in enumerate(gaps.pairs):
        if isinstance(pair.against, int) or pair.against.seen_from != "part" or pair.link > 6:
            continue
        for k, q in enumerate(joints):
            placed_cell = placing(cell, q)
            link_in_part = np.linalg.inv(placed_cell.part) @ placed_cell.links[pair.link]
            points = on_rods(larger[pair.link], 15.0) @ link_in_part[:3, :3].T + link_in_part[:3, 3]
            outside = np.linalg.norm(
                np.maximum(np.maximum(low - points, points - low - SIZE), 0.0), axis=1
            ).min()
            if outside > 0.0:
                assert min(outside, MAX_GAP_MM) - 15.0 <= gaps_found[row, k] <= outside + 1e-6
                separate_count += outside < MAX_GAP_MM
    assert separate_count > 2


@pytest.mark.parametrize(
    ("setup", "low", "count"),
    [(*BOXES[1], 8), *(pytest.param(*box_case, 120, marks=pytest.mark.long) for box_case in BOXES)],
)
def test_gaps_change_as_their_differences_say(setup, low, count):
    """Gap rates agree with differences."""
    cell, contact = looked_at(setup, low)
    gaps, joints = Gaps(contact, MAX_GAP_MM), anywhere(cell, count, 5)
    rates = np.random.default_rng(5).normal(size=joints.shape)
    gap_values, change = every_gap(gaps, joints, rates)
    step = 2e-5
    ahead, behind = (
        every_gap(gaps, joints + sign * step * rates, rates)[0] for sign in (1.0, -1.0)
    )
    # where the nearest edge or face changes the gap has a kink, which the one-sided differences
    # reveal
    kink = np.abs((ahead - gap_values) - (gap_values - behind)) / step > 2.0
    for inside in (False, True):
        mask = (
            (gap_values < MAX_GAP_MM)
            & (ahead < MAX_GAP_MM)
            & (behind < MAX_GAP_MM)
            & ~kink
            & ((gap_values < 0.0) == inside)
            & (gap_values > -50.0)
        )
        off = np.abs((ahead - behind) / (2.0 * step) - change)[mask] / np.maximum(
            np.abs(change[mask]), 100.0
        )
        assert len(off) > (count // 10 if inside else 2 * count)
        if inside:  # penetration: exact where a face or a side is nearest
            assert np.median(off) < 1e-5
        else:
            assert off.max() < 0.02 and np.percentile(off, 98.0) < 2e-3
    assert (change[gap_values == MAX_GAP_MM] == 0.0).all() and (
        np.abs(change[gap_values < MAX_GAP_MM]) > 1.0
    ).mean() > 0.5
