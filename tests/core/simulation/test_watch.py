# SPDX-License-Identifier: LGPL-2.1-or-later
"""Findings along a motion: each violation is reported at its row, and nothing else."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.issues import ERROR, NOTE, Issue
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.simulation import watch as watching
from freecad_am.core.simulation.achievable_feed import achievable_feed
from freecad_am.core.simulation.watch import ArmTouches, bad_links, shown_margins, watch

LINKS = ("base", "q1", "q2", "q3", "q4", "q5", "q6", "part", "nozzle")


@pytest.fixture(scope="module")
def cell():
    return cells.resolve(CellParameters(), np.eye(4))


@pytest.fixture
def calm(cell, a_motion):
    """A slow motion in the middle of the limits."""
    motion = a_motion(1)
    joints = 0.01 * motion.joints + np.radians([0, 10, 20, 0, 40, 0])
    return dataclasses.replace(motion, joints=joints)


def watch_motion(motion, cell, condition=None, issues=()):
    n = len(motion)
    condition = np.full(n, 0.5) if condition is None else condition
    return watch(
        motion,
        cell,
        achievable_feed(motion, cell.machine.max_speed),
        condition,
        np.full(n, 0.1),
        issues,
    )


def test_a_calm_motion_has_no_findings(calm, cell):
    result = watch_motion(calm, cell)
    assert result.findings == ()
    assert result.margin.min() > 40.0


def test_what_is_made_wrong_is_found_where_it_was_made(calm, cell):
    """Each introduced violation is reported at its row."""
    motion = calm
    joints, duration = motion.joints.copy(), motion.duration.copy()
    joints[5:8, 0] = np.radians([169.8, 171.5, 169.7])  # near, beyond, near the limit of 170
    joints[20] = np.nan
    joints[30, 3] = joints[29, 3] + 1.0
    duration[30] = 1.0 / (5.0 * cell.machine.max_speed[3])
    condition = np.full(len(motion), 0.5)
    condition[40:44] = [0.09, 0.04, 0.06, 0.099]
    condition[60] = np.nan
    motion = dataclasses.replace(motion, joints=joints, duration=duration)
    issues = (Issue(ERROR, "X", "made up", 2, 1, 3), Issue(NOTE, "Y", "only a note", 1))
    result = watch_motion(motion, cell, condition, issues)
    by_kind = {
        kind: [finding for finding in result.findings if finding.kind == kind]
        for kind in {finding.kind for finding in result.findings}
    }
    assert set(by_kind) == {
        watching.UNREACHABLE,
        watching.LIMIT,
        watching.NEAR_LIMIT,
        watching.SINGULAR,
        watching.SLOWED,
        watching.ISSUE,
    }
    assert [finding.row for finding in by_kind[watching.UNREACHABLE]] == [20]
    (limit,) = by_kind[watching.LIMIT]
    assert (limit.row, limit.label) == (6, "q1") and limit.value == pytest.approx(-1.5)
    assert [(finding.row, finding.label) for finding in by_kind[watching.NEAR_LIMIT]] == [
        (5, "q1"),
        (7, "q1"),
    ]
    (singular,) = by_kind[watching.SINGULAR]
    assert (singular.row, singular.value, singular.than) == (41, 0.04, 0.1)  # the worst row
    slowed = {finding.row: finding for finding in by_kind[watching.SLOWED]}
    assert slowed[30].label == "q4" and slowed[30].value == pytest.approx(motion.speed[30] / 5.0)
    (issue,) = by_kind[watching.ISSUE]
    assert (motion.layer[issue.row], motion.bead[issue.row], motion.point[issue.row]) == (2, 1, 3)
    assert motion.deposit[issue.row] and issue.label == "made up"
    rows = [finding.row for finding in result.findings]
    assert rows == sorted(rows)


def test_links_are_marked_for_their_own_axis(cell):
    q = np.radians([0, 10, 20, 0, 40, 0])
    none = np.zeros(6)
    assert not bad_links(cell, shown_margins(cell, q), none, False, True).any()
    q[4] = np.radians(139.8)
    assert bad_links(cell, shown_margins(cell, q), none, False, True).tolist() == [False] * 5 + [
        True,
        False,
    ]
    q[4], ratios = 0.5, np.array([0, 0, 0, 1.2, 0, 0.9])
    assert (
        bad_links(cell, shown_margins(cell, q), ratios, False, True).tolist()
        == [False] * 4 + [True] + [False] * 2
    )
    q[1], q[2] = np.radians([-80.0, 200.0])  # each within its own limits, q3 - q2 beyond 273
    assert (
        bad_links(cell, shown_margins(cell, q), none, False, True).tolist()
        == [False, False, True, True] + [False] * 3
    )
    for singular, reachable in ((True, True), (False, False)):
        marked = bad_links(cell, shown_margins(cell, 0.1 * np.ones(6)), none, singular, reachable)
        assert marked.tolist() == [False] + [True] * 6


def test_runs_of_rows_on_which_a_link_touches_one_thing_are_one_finding(calm, cell):
    """Consecutive rows in which a link touches the same body are one finding."""
    n = len(calm)
    link, what = np.full(n, -1), np.full(n, -1)
    link[4:9], what[4:9] = 5, 1
    link[9:11], what[9:11] = 5, 0
    link[30], what[30] = 0, 2
    arm = ArmTouches(link, what, ("nozzle", "platform", "fixture"), 0.01, LINKS)
    unknown = np.full(n, np.nan)
    result = watch(
        calm, cell, achievable_feed(calm, cell.machine.max_speed), unknown, unknown, arm=arm
    )
    assert [
        (finding.row, finding.kind, finding.label, finding.other) for finding in result.findings
    ] == [
        (4, watching.TOUCHES, "q5", "platform"),
        (9, watching.TOUCHES, "q5", "nozzle"),
        (30, watching.TOUCHES, "base", "fixture"),
    ]
    assert result.arm_known and (result.touching == link).all()
    assert (
        not watch_motion(calm, cell).arm_known and (watch_motion(calm, cell).touching == -1).all()
    )
    margins = shown_margins(cell, calm.joints[4])
    assert np.flatnonzero(bad_links(cell, margins, np.zeros(6), False, True, 5)).tolist() == [5]
    assert not bad_links(cell, margins, np.zeros(6), False, True).any()
