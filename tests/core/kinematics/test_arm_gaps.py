# SPDX-License-Identifier: LGPL-2.1-or-later
"""Gaps between links and what they are kept clear of: by points on the sides of larger cylinders, and how gaps change by
differences of what they are."""

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

CLEARANCE, ABOUT = 10.0, 0.2  # mm, the second as links are larger than they are
WITHIN = 250.0
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
    wanted = np.ones((len(gaps.pairs), len(joints)), dtype=bool)
    return gaps.gaps_and_rates(joints, rates, np.zeros(len(joints), dtype=np.int64), wanted)


@pytest.mark.parametrize(
    ("setup", "low"), [pytest.param(*BOXES[0], marks=pytest.mark.long), BOXES[1]]
)
def test_a_gap_is_that_of_points_on_larger_links_and_none_where_they_touch(setup, low):
    cell, contact = looked_at(setup, low)
    gaps, joints = Gaps(contact, WITHIN), anywhere(cell, 20, 3)
    found, _ = every_gap(gaps, joints, np.zeros_like(joints))
    assert np.array_equal((found < 0.0).any(axis=0), contact.touches(joints).any)
    larger = [
        [
            dataclasses.replace(
                rod,
                radius=rod.radius + CLEARANCE + ABOUT,
                start=rod.start - way,
                end=rod.end + way,
            )
            for rod in link
            for way in [(CLEARANCE + ABOUT) * (rod.end - rod.start) / rod.length]
        ]
        for link in contact.cylinders
    ]
    apart = 0
    for row, pair in enumerate(gaps.pairs):
        if isinstance(pair.against, int) or pair.against.seen_from != "part" or pair.link > 6:
            continue
        for k, q in enumerate(joints):
            place = placing(cell, q)
            seen = np.linalg.inv(place.part) @ place.links[pair.link]
            points = on_rods(larger[pair.link], 15.0) @ seen[:3, :3].T + seen[:3, 3]
            outside = np.linalg.norm(
                np.maximum(np.maximum(low - points, points - low - SIZE), 0.0), axis=1
            ).min()
            if outside > 0.0:
                assert min(outside, WITHIN) - 15.0 <= found[row, k] <= outside + 1e-6
                apart += outside < WITHIN
    assert apart > 2


@pytest.mark.parametrize(
    ("setup", "low", "count"),
    [(*BOXES[1], 8), *(pytest.param(*one, 120, marks=pytest.mark.long) for one in BOXES)],
)
def test_gaps_change_as_their_differences_say(setup, low, count):
    cell, contact = looked_at(setup, low)
    gaps, joints = Gaps(contact, WITHIN), anywhere(cell, count, 5)
    rates = np.random.default_rng(5).normal(size=joints.shape)
    found, change = every_gap(gaps, joints, rates)
    step = 2e-5
    ahead, behind = (
        every_gap(gaps, joints + sign * step * rates, rates)[0] for sign in (1.0, -1.0)
    )
    # where another edge or face comes next the gap has a kink, which the differences on both sides tell
    kink = np.abs((ahead - found) - (found - behind)) / step > 2.0
    for inside in (False, True):
        some = (
            (found < WITHIN)
            & (ahead < WITHIN)
            & (behind < WITHIN)
            & ~kink
            & ((found < 0.0) == inside)
            & (found > -50.0)
        )
        off = np.abs((ahead - behind) / (2.0 * step) - change)[some] / np.maximum(
            np.abs(change[some]), 100.0
        )
        assert len(off) > (count // 10 if inside else 2 * count)
        if inside:  # reached into: exact where a face or a side is met
            assert np.median(off) < 1e-5
        else:
            assert off.max() < 0.02 and np.percentile(off, 98.0) < 2e-3
    assert (change[found == WITHIN] == 0.0).all() and (
        np.abs(change[found < WITHIN]) > 1.0
    ).mean() > 0.5
