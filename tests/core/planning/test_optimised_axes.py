# SPDX-License-Identifier: LGPL-2.1-or-later
"""External axes `optimised`: less motion and no less margin than with `level`, with the right tool
pose in the world."""

import dataclasses
import math

import numpy as np
import pytest

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.parameters.joints import GivenPolynomial, JointParameters
from freecad_am.core.planning.external import optimised
from freecad_am.core.planning.external.freedom import IRRELEVANT_MARGIN
from freecad_am.core.planning.external.optimised import least_margin
from freecad_am.core.planning.external.stroke import directions_on_face
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.task import Task
from freecad_am.core.toolpath import MotionRules

from .test_external_axes import (
    POSITIONER,
    UP,
    cell_for,
    file_of_built_in,
    in_the_world,
    levelled_to,
)

MAX_TILT_DEG = 20.0  # deg from the vertical
WITH_TRACK = f"{POSITIONER} at 1400 120 -50 0 0 30 carries part; kuka-kl100-2 at 0 0 -356 0 0 90 carries robot"


@pytest.fixture(scope="module")
def hemisphere(sliced):
    return levelled_to(sliced("sphere", 10.0, chord_error=0.1), MAX_TILT_DEG)


@pytest.fixture(scope="module")
def both(hemisphere):
    cell = cell_for(hemisphere)
    return [
        plan_joints(hemisphere, cell, JointParameters(external_axes=rule))
        for rule in ("level", "optimised")
    ]


def motion(cell, path):
    """Eq. 17 over all beads, from the joints only, independent of the planner."""
    stroke = cell.limits.upper - cell.limits.lower
    stroke = np.where(np.isfinite(stroke), stroke, 1e6 * 2.0 * math.pi)
    return sum(
        float((np.diff(bead_path.joints, axis=0) ** 2 / stroke).sum()) for bead_path in path.beads
    )


def share_left(cell, path):
    """The least remaining share of a range to a limit, and of the condition to its minimum."""
    reserve = math.radians(0.05)  # docs/decisions/0009
    half, middle = (
        0.5 * (cell.limits.upper - cell.limits.lower) - reserve,
        0.5 * (cell.limits.upper + cell.limits.lower),
    )
    ends = np.isfinite(half)
    off = np.abs(path.joints[:, ends] - middle[ends]) / half[ends]
    return min(
        1.0 - off.max(),
        min((1.0 - bead_path.threshold / bead_path.condition).min() for bead_path in path.beads),
    )


def test_less_motion_and_a_larger_least_margin(hemisphere, both):
    cell = cell_for(hemisphere)
    level, better = both
    assert level.feasible and better.feasible and level.of_level is None
    assert motion(cell, better) < 0.9 * motion(cell, level)
    assert share_left(cell, better) > share_left(cell, level) + 0.01
    assert better.of_level["objective_value"] == pytest.approx(
        sum(path.objective for path in level.beads), rel=1e-12
    )
    assert better.of_level["least_margin"] == pytest.approx(share_left(cell, level), abs=1e-9)
    task = Task(cell, spherical_wrist.branch_index(better.branch), JointParameters())
    assert least_margin(task, better.beads) == pytest.approx(share_left(cell, better), abs=1e-9)


def test_every_point_is_met_and_the_tool_is_upright_enough(hemisphere, both):
    """At all points, of which the optimiser evaluates some, and on the moves between them."""
    frame, (_, path) = hemisphere.frame, both
    points = np.concatenate([bead_path.bead.points for bead_path in path.beads])
    axes = np.concatenate([bead_path.bead.tool for bead_path in path.beads])
    tip, tool, upward = in_the_world(path.joints, file_of_built_in())
    assert np.abs(tip @ frame[:3, :3].T + frame[:3, 3] - points).max() < 1e-6
    assert np.abs(tool @ frame[:3, :3].T - axes).max() < 1e-6
    assert np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0))).max() < MAX_TILT_DEG + 1e-6
    assert max(len(bead_path.bead) for bead_path in path.beads) > 2 * optimised.POINTS_PER_BEAD
    for bead_path in path.beads[::3]:
        start, end = bead_path.joints[:-1], bead_path.joints[1:]
        for share in (0.3, 0.7):
            tip, _, upward = in_the_world(start + share * (end - start), file_of_built_in())
            along = np.diff(bead_path.bead.points, axis=0)
            gap = tip @ frame[:3, :3].T + frame[:3, 3] - bead_path.bead.points[:-1]
            share_of_segment = np.clip((gap * along).sum(1) / (along * along).sum(1), 0.0, 1.0)
            assert (
                np.linalg.norm(gap - share_of_segment[:, None] * along, axis=1).max()
                <= hemisphere.chord_error + 1e-6
            )
            assert (
                np.degrees(np.arccos(np.clip(upward @ UP, -1.0, 1.0))).max() < MAX_TILT_DEG + 0.05
            )


def test_what_is_added_to_level_is_a_polynomial(both):
    """The difference from level is a polynomial."""
    level, better = both
    moved = 0
    for level_path, optimised_path in zip(level.beads, better.beads, strict=True):
        parameter = level_path.bead.parameter
        for axis in (6, 7):
            # points added in between are on chords of it
            added = (
                np.interp(parameter, optimised_path.bead.parameter, optimised_path.joints[:, axis])
                - level_path.joints[:, axis]
            )
            added -= 2.0 * math.pi * np.round(added[0] / (2.0 * math.pi))
            assert (
                np.abs(np.polynomial.Polynomial.fit(parameter, added, 1)(parameter) - added).max()
                < 1e-9
            )
            moved += bool(np.ptp(added) > 1e-3 or abs(added[0]) > 1e-3)
    assert moved > 3


def test_a_track_and_a_positioner_together(sliced):
    hemisphere = levelled_to(sliced("sphere", 20.0, chord_error=0.2), MAX_TILT_DEG)
    cell = cell_for(hemisphere, external=WITH_TRACK)
    level, better = (
        plan_joints(hemisphere, cell, JointParameters(external_axes=rule))
        for rule in ("level", "optimised")
    )
    assert better.feasible
    assert motion(cell, better) < 0.9 * motion(cell, level)
    assert share_left(cell, better) >= share_left(cell, level) - 1e-12


@pytest.mark.parametrize("external", [None, WITH_TRACK])
@pytest.mark.parametrize("objective", ["displacement", "condition"])
@pytest.mark.always
def test_derivatives(hemisphere, external, objective):
    """Derivatives by all coefficients of the rotation and of every external axis agree with central
    differences."""
    cell = cell_for(hemisphere, **({} if external is None else {"external": external}))
    planned = plan_joints(hemisphere, cell, JointParameters())
    task = Task(
        cell,
        spherical_wrist.branch_index(planned.branch),
        JointParameters(degree=2, objective=objective),
    )
    path = planned.beads[3]
    freedom = optimised._freedom(
        task,
        path,
        path.coefficients,
        lambda tool: directions_on_face(cell, tool),
        math.radians(MAX_TILT_DEG),
    )
    x = 0.01 * np.random.default_rng(5).normal(
        size=(1 + cell.external.axes) * freedom.shape.shape[1]
    )
    state, step = freedom.look(x), 1e-6
    of_condition = np.arange(len(state.margins)) >= len(state.margins) - len(freedom.points)
    is_relevant = ~(of_condition & (state.margins >= IRRELEVANT_MARGIN))
    assert (is_relevant & of_condition).any()
    for number in range(len(x)):
        change = np.where(np.arange(len(x)) == number, step, 0.0)
        ahead, behind = freedom.look(x + change), freedom.look(x - change)
        assert (ahead.objective - behind.objective) / (2 * step) == pytest.approx(
            state.slope[number], rel=1e-4, abs=1e-6
        )
        np.testing.assert_allclose(
            ((ahead.margins - behind.margins) / (2 * step))[is_relevant],
            state.margin_slopes[is_relevant, number],
            rtol=1e-4,
            atol=1e-6,
        )
        np.testing.assert_allclose(
            (ahead.hard - behind.hard) / (2 * step),
            state.hard_slopes[:, number],
            rtol=1e-4,
            atol=1e-5,
        )


def test_what_is_no_better_stays(hemisphere, both, monkeypatch):
    """With a bad result of the descent, rotations by half a radian that reduce the margin, the
    level solution is kept."""
    monkeypatch.setattr(
        optimised,
        "_optimise_in_stages",
        lambda freedom, path: (
            freedom,
            np.full((1 + freedom.external.axes) * freedom.shape.shape[1], 0.5),
            0,
        ),
    )
    path = plan_joints(hemisphere, cell_for(hemisphere), JointParameters(external_axes="optimised"))
    level = both[0]
    for kept_path, level_path in zip(path.beads, level.beads, strict=True):
        assert kept_path.objective <= level_path.objective and kept_path.margin >= min(
            level_path.margin, optimised.SUFFICIENT_MARGIN
        )
    assert motion(cell_for(hemisphere), path) <= motion(cell_for(hemisphere), level)


def test_given_polynomials_stay(hemisphere, both):
    """Given polynomials are kept."""
    level, better = both
    polynomials = tuple(
        GivenPolynomial((planned_path.layer, planned_path.index), tuple(planned_path.coefficients))
        for planned_path in level.beads[2:]
    )
    path = plan_joints(
        hemisphere,
        cell_for(hemisphere),
        JointParameters(external_axes="optimised", given=polynomials),
    )
    assert path.feasible
    for planned_path, level_path in zip(path.beads[2:], level.beads[2:], strict=True):
        assert np.allclose(planned_path.bead.external, level_path.bead.external, rtol=0.0, atol=0.0)
    assert any(
        not np.allclose(planned_path.bead.external, level_path.bead.external)
        for planned_path, level_path in zip(better.beads, level.beads)
    )


def test_what_it_cannot_serve_is_told(hemisphere):
    with pytest.raises(InputError, match="layer-by-layer") as error:
        plan_joints(
            hemisphere,
            cell_for(hemisphere),
            JointParameters(external_axes="optimised", method="constant"),
        )
    assert error.value.code == "NOT_FOR_SETUP"
    alone = cell_for(
        hemisphere, external="none", deposition_point=(1400.0, 0.0, 300.0, 0.0, 0.0, 0.0)
    )
    free = dataclasses.replace(hemisphere, rules=MotionRules())
    path = plan_joints(free, alone, JointParameters(external_axes="optimised"))
    assert [issue.code for issue in path.issues if "joints.external_axes" in issue.message] == [
        "NOT_USED"
    ]
