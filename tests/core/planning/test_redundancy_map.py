# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map of the free rotation says of each cell what the planner, and PyKDL, say of a point."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.collision.bead_ends import Beads
from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import Body, disc
from freecad_am.core.issues import ERROR, InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.kinematics.links import robot as robot_links
from freecad_am.core.kinematics.links.contact import ArmContact
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import (
    BRANCHES,
    GIVEN,
    GivenPolynomial,
    JointParameters,
)
from freecad_am.core.planning import criteria, plan
from freecad_am.core.planning import redundancy_curve as spin_curve
from freecad_am.core.planning import redundancy_map as spin_map
from freecad_am.core.planning.points import TURN, gather
from freecad_am.core.planning.task import Task
from freecad_am.core.toolpath import MotionRules
from freecad_am.kdl import KdlArm

PART_ON_ROBOT = {}
TOOL_ON_ROBOT = {"setup": "tool-on-robot", "deposition_point": (900.0, 0.0, -100.0, 0.0, 0.0, 0.0)}
FLIP = 1  # front up flip


@pytest.fixture(scope="module")
def dome(sliced):
    return sliced("sphere", 9.0)


@pytest.fixture(scope="module")
def funnel(sliced):
    return sliced("intake funnel", 9.0)


def beads_of(toolpath):
    return [bead for _, _, bead in toolpath], [(layer, index) for layer, index, _ in toolpath]


def seen(toolpath, axis=spin_map.RZ, branch=FLIP, rows=61, **more):
    setup = more.pop("setup", PART_ON_ROBOT)
    cell = cells.resolve(CellParameters(**{"limits": "paper", **setup}), toolpath.frame)
    task = Task(cell, branch, JointParameters(**more))
    at = spin_map.columns(beads_of(toolpath)[0], cell, 50)
    found = spin_map.redundancy_map(task, at, axis, values=np.linspace(-np.pi, np.pi, rows))
    return task, found, spin_map.picture(task, found, branch)


@pytest.mark.parametrize(
    "setup", [PART_ON_ROBOT, TOOL_ON_ROBOT], ids=["part on robot", "tool on robot"]
)
@pytest.mark.parametrize("axis", [spin_map.RZ, spin_map.ROTATION])
def test_cells_are_where_pykdl_finds_them(funnel, setup, axis):
    task, found, _ = seen(funnel, axis, setup=setup)
    cell, arm = task.cell, KdlArm(task.cell.machine)
    random = np.random.default_rng(1)
    points = found.columns.points
    rows = random.integers(0, len(found.values), 60)
    columns = random.integers(0, len(points), 60)
    reached = 0
    for row, column in zip(rows, columns):
        for branch, q in enumerate(
            spin_map.joints_at(task, found.columns, int(column), float(found.phi[row, column]))
        ):
            margin = found.margin[branch, row, column]
            assert (margin > -np.inf) == np.isfinite(q).all()
            if not np.isfinite(q).all():
                continue
            reached += 1
            flange = arm.forward([q])
            tip, tool = cell.tip_in_part(flange)
            assert np.abs(tip[0] - points.position[column]).max() < 1e-6
            assert np.abs(tool[0] - points.tool[column]).max() < 1e-9
            assert cell.machine.opw.branch_of(q) == branch
            low, high = cell.limits.lower, cell.limits.upper
            share = [
                2 * min(v - a, b - v) / (b - a)
                for v, a, b in zip(q, low, high)
                if np.isfinite(b - a)
            ]
            share += [
                2 * min(v - a, b - v) / (b - a)
                for v, a, b in zip(
                    cell.limits.coefficients @ q,
                    cell.limits.coupled_lower,
                    cell.limits.coupled_upper,
                )
            ]
            assert margin == pytest.approx(min(share), abs=1e-9)
            if (
                axis == spin_map.RZ
            ):  # the last Bryant angle of the same rotation, from the flange that PyKDL finds
                mounted = np.eye(3) if setup is not PART_ON_ROBOT else None
                platform = flange[0] @ cell.poses.carried
                turned = (
                    (cell.poses.station[:3, :3].T @ platform[:3, :3]) if mounted is None else None
                )
                if turned is not None:
                    rz = np.arctan2(-turned[0, 1], turned[0, 0])
                    assert abs((rz - found.values[row] + np.pi) % TURN - np.pi) < 1e-6
    assert reached > 100


@pytest.mark.parametrize("branch", [1, 0, 3])
def test_cells_are_what_the_planner_says_of_points(funnel, branch):
    task, found, picture = seen(funnel, branch=branch)
    points = found.columns.points
    threshold = task.thresholds(points)
    for row in (0, 13, 30, 47):
        phi, _ = task.cell.poses.phi_of_rz(points.tool, np.full(len(points), found.values[row]))
        assert np.abs(np.exp(1j * phi) - np.exp(1j * found.phi[row])).max() < 1e-7
        joints = task.joints(points, phi)
        assert (
            np.abs(picture.margin[row] - task.given_rows.margin(joints))[
                picture.reachable[row]
            ].max(initial=0.0)
            < 1e-7
        )
        assert np.abs(picture.condition[row] - task.condition(points, phi, joints)).max() < 1e-7
    assert np.array_equal(picture.threshold, threshold)


def test_a_wrist_turned_over_is_as_near_to_a_singularity(dome):
    task, found, flipped = seen(dome)
    other = spin_map.picture(task, found, FLIP - 1)
    assert np.abs(flipped.condition - other.condition).max() < 1e-9


@pytest.mark.parametrize("part", ["dome", "funnel"])
@pytest.mark.parametrize("rz", [-2.0, -0.4, 0.9, 2.6])
@pytest.mark.always
def test_a_constant_rz_lies_in_good_cells_just_when_the_planner_finds_it_feasible(
    request, part, rz
):
    """But for axes that run out of turns along a bead, which no cell can know."""
    toolpath = request.getfixturevalue(part)
    beads, places = beads_of(toolpath)
    verdicts = []
    for branch in range(8):
        cell = cells.resolve(
            CellParameters(limits="paper", branch=spherical_wrist.branch_name(branch)),
            toolpath.frame,
        )
        task = Task(cell, branch, JointParameters(method="constant", rz=rz))
        paths, issues = plan.METHODS["constant"](task, beads, places, lambda *_: None)
        issues = [issue for path in paths for issue in spin_curve.findings(task, path)]
        at = spin_map.columns(beads, cell, 10**6)
        assert len(at) == sum(map(len, beads))
        picture = spin_map.picture(
            task, spin_map.redundancy_map(task, at, values=np.array([rz])), branch
        )
        points = gather(beads, cell)
        followed = spin_curve.follow(
            task,
            points,
            task.thresholds(points),
            spin_curve.durations(beads),
            np.concatenate([path.phi for path in paths]),
        )
        feasible = not any(issue.level == ERROR for issue in issues)
        assert followed.good.all() == feasible
        assert np.array_equal(picture.feasible[0] & ~followed.wound, followed.good)
        # an axis that runs out of turns is off by whole turns from where the cell has it
        if followed.wound.any():
            k = int(np.flatnonzero(followed.wound)[0])
            off = followed.joints[k] - spin_map.joints_at(task, at, k, followed.phi[k])[branch]
            assert (
                np.abs(off - TURN * np.round(off / TURN)).max() < 1e-6
                and np.abs(off[~task.continuous]).max() > 6.0
            )
        verdicts.append(feasible)
    assert len(set(verdicts)) == 2 or part == "funnel"


def test_what_the_job_does_not_allow_is_outside(dome):
    _, found, picture = seen(
        dome, spin_map.ROTATION, rotation_range=(np.radians(-30.0), np.radians(200.0))
    )
    turned = np.degrees(found.values)
    allowed = (turned >= -30.0) | (turned <= -160.0)
    assert np.array_equal(~found.outside, np.repeat(allowed[:, None], len(found.columns), axis=1))
    assert not picture.feasible[~allowed].any()


def test_columns_with_a_body_under_the_nozzle_are_forbidden(dome):
    cell = cells.resolve(CellParameters(limits="paper"), dome.frame)
    task = Task(cell, FLIP, JointParameters())
    at = spin_map.columns(beads_of(dome)[0], cell, 60)
    here = at.points.position[20] + 30.0 * at.points.tool[20]
    corners = here + np.array([[-1.0, -1, -1], [1, -1, 1], [0, 1, 0]])
    body = Body("flag", corners, np.array([[0, 1, 2]]))
    clear, touching = (spin_map.redundancy_map(task, at, bodies=bodies) for bodies in ((), (body,)))
    assert not clear.touching.any() and touching.touching[20] and not touching.touching.all()
    # where the nozzle stands on a part it may touch it beside its tip
    floor = Body(
        "floor",
        at.points.position[20] + 0.3 * at.points.tool[20] + 0.2 * (corners - here),
        body.triangles,
    )
    assert not spin_map.redundancy_map(task, at, bodies=(floor,)).touching[20]
    assert spin_map.picture(task, touching, FLIP).forbidden[:, 20].all()


def test_columns_are_even_and_have_the_ends_of_beads(dome, funnel):
    for toolpath in (dome, funnel):
        beads, _ = beads_of(toolpath)
        cell = cells.resolve(CellParameters(limits="paper"), toolpath.frame)
        at = spin_map.columns(beads, cell, 100)
        assert 80 <= len(at) <= 100
        for k, bead in enumerate(beads):
            of_bead = at.point[at.bead == k]
            assert of_bead[0] == 0 and of_bead[-1] == len(bead) - 1 and (np.diff(of_bead) > 0).all()
            assert np.array_equal(at.points.position[at.bead == k], bead.points[of_bead])
            assert np.array_equal(at.points.parameter[at.bead == k], bead.parameter[of_bead])
        few = spin_map.columns(beads, cell, 3 * spin_map.MIN_POINTS_PER_BEAD)
        assert list(np.unique(few.bead)) == [0, len(beads) // 2, len(beads) - 1]
        assert (np.bincount(few.bead)[np.unique(few.bead)] == spin_map.MIN_POINTS_PER_BEAD).all()
        for k in np.unique(few.bead):
            assert few.point[few.bead == k][-1] == len(beads[k]) - 1


def test_values_and_rotations_are_each_others_inverse(funnel):
    cell = cells.resolve(CellParameters(limits="paper"), funnel.frame)
    tool = np.concatenate([bead.tool for bead in beads_of(funnel)[0]])
    tool = tool[np.abs(tool @ cell.poses.mount[:3, 2]) > 0.05]
    random = np.random.default_rng(3).uniform(-np.pi, np.pi, len(tool))
    for axis in (spin_map.RZ, spin_map.ROTATION):
        phi = spin_map.rotation_of(cell, tool, random, axis)
        assert np.abs(spin_map.value_of(cell, tool, phi, axis) - random).max() < 1e-7
    assert (
        np.abs(
            np.exp(1j * spin_map.rotation_of(cell, tool, random, spin_map.RZ))
            - np.exp(1j * cell.poses.phi_of_rz(tool, random)[0])
        ).max()
        < 1e-7
    )


# ---- given polynomials


def planned(toolpath, **joints):
    cell = cells.resolve(CellParameters(limits="paper"), toolpath.frame)
    return cell, plan.plan_joints(toolpath, cell, JointParameters(**joints))


def test_what_the_planner_found_can_be_given_back_to_it(dome):
    _, free = planned(dome)
    given = tuple(
        str(GivenPolynomial((path.layer, path.index), tuple(path.coefficients)))
        for path in free.beads
    )
    _, again = planned(dome, given=given)
    assert again.feasible and [path.reason for path in again.beads] == ["given"] * len(free.beads)
    for one, other in zip(free.beads, again.beads):
        assert (
            np.abs(one.phi - other.phi).max() < 1e-9
            and np.abs(one.joints - other.joints).max() < 1e-7
        )
        assert other.objective == pytest.approx(one.objective, rel=1e-6)


def test_some_beads_may_be_given_and_the_rest_is_searched(dome):
    _, free = planned(dome)
    constant, slope = free.beads[2].coefficients
    text = str(GivenPolynomial((2, 0), (constant + 0.1, slope)))
    _, mixed = planned(dome, given=(text,))
    assert mixed.feasible
    assert np.allclose(mixed.beads[2].coefficients, [constant + 0.1, slope], atol=1e-9)
    assert [path.reason == "given" for path in mixed.beads] == [
        k == 2 for k in range(len(mixed.beads))
    ]
    assert mixed.beads[0].objective == pytest.approx(free.beads[0].objective, rel=1e-6)


def test_what_is_given_is_judged_like_all_else(dome):
    """A rotation at rest asks the last axis for a turn more, and others for what the planner would avoid."""
    cell, path = planned(dome, given=("*:0",))
    beads, places = beads_of(dome)
    points = gather(beads, cell)
    task = Task(cell, FLIP, JointParameters())
    followed = spin_curve.follow(
        task, points, task.thresholds(points), spin_curve.durations(beads), np.zeros(len(points))
    )
    assert path.feasible == followed.good.all()
    ends = np.append(points.first, len(points))
    lost = {issue.layer for issue in path.issues if issue.level == ERROR}
    for k, (layer, _) in enumerate(places):
        assert (layer in lost) == (not followed.good[ends[k] : ends[k + 1]].all())
    assert np.allclose(followed.displacement, [one.objective for one in path.beads], rtol=1e-9)


def test_the_branch_of_a_joint_path_is_its_own(dome):
    _, path = planned(dome, own_branch="front-up-noflip")
    assert path.branch == ("front", "up", "noflip")
    assert list(BRANCHES) == ["-".join(spherical_wrist.branch_name(k)) for k in range(8)]


def test_given_texts_are_read_back():
    random = np.random.default_rng(2)
    for degree in range(7):
        values = tuple(random.uniform(-3, 3, degree + 1))
        text = str(GivenPolynomial((12, 3), values))
        (polynomial,) = GIVEN.read((text,))
        assert polynomial.bead == (12, 3)
        assert polynomial.coefficients == pytest.approx(values, abs=1e-9)
        assert GIVEN.text(GIVEN.read((text,))) == (text,)
    read = GIVEN.read(("*:90:-360", "4:10"))
    assert {polynomial.bead: polynomial.coefficients for polynomial in read} == {
        None: pytest.approx((np.pi / 2, -1.0)),
        (4, 0): pytest.approx((np.radians(10),)),
    }


@pytest.mark.parametrize(
    "given",
    [
        ("1/0",),
        ("1/0:",),
        ("a:1",),
        ("1/0:x",),
        ("-1:3",),
        ("1:nan",),
        ("1:inf",),
        ("1:1:1:1:1:1:1:1:1",),
        ("2:1", "2/0:3"),
        ("*:1", "*:2"),
        ("",),
    ],
)
def test_what_cannot_be_read_is_refused(given):
    with pytest.raises(InputError) as refused:
        JointParameters(given=given)
    assert refused.value.where == "joints.given"


def test_beads_that_are_not_there_are_told(dome):
    _, path = planned(dome, given=("99/0:10",))
    assert path.feasible and [
        issue.message for issue in path.issues if issue.code == "GIVEN_NOT_USED"
    ]
    _, path = planned(dome, method="constant", given=("*:10",))
    assert [issue.code for issue in path.issues if issue.code == "GIVEN_NOT_USED"]


# ---- curves


def test_a_curve_follows_what_the_planner_planned(funnel):
    cell, path = planned(funnel)
    beads, _ = beads_of(funnel)
    task = Task(cell, FLIP, JointParameters())
    points = gather(beads, cell)
    coefficients = np.array([one.coefficients for one in path.beads])
    followed = spin_curve.follow(
        task,
        points,
        task.thresholds(points),
        spin_curve.durations(beads),
        points.polynomial(coefficients),
    )
    assert np.allclose(followed.displacement, [one.objective for one in path.beads], rtol=1e-9)
    sums = spin_curve.sums(followed)
    figures = criteria.path_figures(
        dataclasses.replace(
            path,
            beads=tuple(
                dataclasses.replace(
                    one,
                    bead=bead,
                    joints=followed.joints[a:b],
                    condition=followed.condition[a:b],
                    phi=followed.phi[a:b],
                )
                for one, bead, a, b in zip(
                    path.beads, beads, points.first, np.append(points.first[1:], len(points))
                )
            ),
        ),
        cell,
        JointParameters(),
    )
    assert sums.lost == 0
    assert sums.ratio == pytest.approx(max(figures["speed_ratio_max"]), rel=1e-9)
    assert sums.condition == pytest.approx(figures["condition_min"], rel=1e-9)
    assert sums.displacement == pytest.approx(figures["objective_value"], rel=1e-9)


def test_polynomials_are_fitted_exactly_where_there_is_one(funnel):
    beads, _ = beads_of(funnel)
    cell = cells.resolve(CellParameters(limits="paper"), funnel.frame)
    points = gather(beads, cell)
    random = np.random.default_rng(5)
    for degree in range(5):
        wanted = random.uniform(-1, 1, (len(beads), degree + 1)) / 3.0 ** np.arange(degree + 1)
        found = spin_curve.fitted(points, points.polynomial(wanted), degree)
        assert np.abs(points.polynomial(found) - points.polynomial(wanted)).max() < 1e-8


@pytest.mark.parametrize("joined", [False, True])
def test_a_handle_moves_alone(funnel, joined):
    beads, _ = beads_of(funnel)
    cell = cells.resolve(CellParameters(limits="paper"), funnel.frame)
    points = gather(beads, cell)
    task = Task(cell, FLIP, JointParameters(), joined)
    random = np.random.default_rng(7)
    for degree in range(7):
        start = np.zeros(degree + 1)
        start[0] = random.uniform(-1, 1)
        at = spin_curve.handles(task, points, 1, degree)
        assert len(at) == (max(degree, 1) if joined else degree + 1)
        for handle in range(len(at)):
            after = start + 0.3 * spin_curve.pull(task, points, 1, degree, handle)
            value = np.polynomial.polynomial.polyval(at, after) - start[0]
            assert value == pytest.approx(
                np.where(np.arange(len(at)) == handle, 0.3, 0.0), abs=1e-6
            )
            if joined:
                low, high = (end[1] for end in points.ends)
                ends = np.polynomial.polynomial.polyval(np.array([low, high]), after)
                assert ends[1] - ends[0] == pytest.approx(0.0, abs=1e-6)


def test_methods_side_by_side_are_those_of_the_planner(dome):
    beads, places = beads_of(dome)
    cell, path = planned(dome)
    found = spin_curve.compared(
        Task(cell, FLIP, JointParameters(given=("*:0",))), beads, places, lambda *_: None
    )
    assert [one.name for one in found] == list(plan.METHODS)
    by_layer = found[0]
    assert by_layer.feasible
    assert by_layer.sums.displacement == pytest.approx(
        sum(one.objective for one in path.beads), rel=1e-6
    )
    assert by_layer.sums.displacement < 1.001 * min(
        one.sums.displacement for one in found[1:] if one.feasible
    )


@pytest.mark.parametrize(
    "setup", [PART_ON_ROBOT, TOOL_ON_ROBOT], ids=["part on robot", "tool on robot"]
)
def test_cells_where_the_arm_touches_are_those_in_which_a_link_does(funnel, setup):
    # a wall beside the part, in the way of one robot or the other
    wall = disc(900.0, frames.pose(frames.about_y(np.pi / 2), (260.0, 0.0, 200.0)), "wall")
    task, found, picture = seen(funnel, spin_map.ROTATION, setup=setup)
    cell, at = task.cell, found.columns
    rods = [external_links.solid_cylinders(link) for link in robot_links.solids(cell.machine.chain)]
    beads = beads_of(funnel)[0]
    starts = np.concatenate([[0], np.cumsum([len(bead) for bead in beads])])
    moment = starts[at.bead] + at.point
    contact = ArmContact(cell, rods, [wall], Beads.of(beads, 6.0, 9.0).solid())
    touched = spin_map.arm_touched(task, found, FLIP, contact, moment)
    looked = picture.reachable & ~picture.past_limit & ~picture.outside & ~found.touching
    assert 0 < touched.sum() < looked.sum() and not (touched & ~looked).any()
    random = np.random.default_rng(2)
    for row, column in zip(
        random.integers(0, touched.shape[0], 80), random.integers(0, touched.shape[1], 80)
    ):
        q = spin_map.joints_at(task, at, int(column), float(found.phi[row, column]))[FLIP]
        one = contact.touches(q[None], moment[[column]]).any[0]
        assert touched[row, column] == (bool(one) and looked[row, column])
    shown = dataclasses.replace(picture, arm=touched)
    assert (shown.hatched == (picture.forbidden | touched)).all() and (
        picture.hatched == picture.forbidden
    ).all()
    rough = spin_map.arm_touched(task, found, FLIP, contact, moment, 4)
    assert (rough[2::4] == touched[2::4]).all() and (rough != touched).mean() < 0.1


# ---- with external axes

ON_POSITIONER = {
    "machine": "kuka-kr8-r2100-2-arc-hw",
    "setup": "tool-on-robot",
    "branch": "auto",
    "limits": "maker",
    "external": "kuka-kl100-2 at 0 0 -356 0 0 90 carries robot; motoman-motopos-d500 at 1400 120 -50 0 0 30 carries part",
    "nozzle": NozzleParameters(tool=(20.0, 0.0, 300.0, 0.0, 0.6, 0.0)),
}


@pytest.fixture(scope="module")
def on_positioner(dome):
    """A plan with e1 to e3, of which e3 turns all the time; its task and beads."""
    toolpath = dataclasses.replace(dome, rules=MotionRules(max_from_vertical=np.radians(10.0)))
    cell = cells.resolve(CellParameters(**ON_POSITIONER), toolpath.frame)
    planned = plan.plan_joints(
        toolpath, cell, JointParameters(method="constant", min_condition=0.0)
    )
    return Task(cell, 0, JointParameters()), [path.bead for path in planned.beads]


def test_two_external_axes_against_each_other_are_as_one_at_a_time(on_positioner):
    """Each row is the map of the other axis across, with this one there, at the same rotation; joints are PyKDL's."""
    task, beads = on_positioner
    cell, at, rotation = task.cell, (1, 7), 0.4
    values = tuple(
        spin_map.span(task, beads[1], 7, axis, count) for axis, count in ((2, 9), (1, 5))
    )
    pairs = spin_map.across_two_axes(beads, cell, at, (2, 1), values)
    assert len(pairs) == 45 and (pairs.bead == 1).all() and (pairs.point == 7).all()
    found = spin_map.redundancy_map(task, pairs, spin_map.ROTATION, values=np.array([rotation]))
    shown = spin_map.in_rows(spin_map.picture(task, found, 0), 5)
    assert (
        shown.margin.shape
        == shown.condition.shape
        == shown.singular.shape
        == shown.forbidden.shape
        == (5, 9)
    )
    whole, reached = KdlArm(cell.machine), 0
    for row, upwards in enumerate(values[1]):
        external = beads[1].external.copy()
        external[7, 1] = upwards
        line = spin_map.across(
            [beads[0], dataclasses.replace(beads[1], external=external)], cell, at, 2, values[0]
        )
        alone = spin_map.redundancy_map(task, line, spin_map.ROTATION, values=np.array([rotation]))
        picture = spin_map.picture(task, alone, 0)
        np.testing.assert_allclose(shown.margin[row], picture.margin[0], atol=1e-12)
        np.testing.assert_allclose(shown.condition[row], picture.condition[0], atol=1e-12)
        assert np.array_equal(shown.feasible[row], picture.feasible[0])
        for column, across in enumerate(values[0]):
            q = spin_map.joints_at(task, pairs, row * 9 + column, rotation)[0]
            assert np.isfinite(q).all() == (shown.margin[row, column] > -np.inf)
            if np.isfinite(q).all():
                reached += 1
                np.testing.assert_allclose(q[[7, 8]], [upwards, across], atol=1e-12)
                tip, tool = cell.tip_in_part(whole.forward([q]))
                assert np.abs(tip[0] - beads[1].points[7]).max() < 1e-6
                assert np.abs(tool[0] - beads[1].tool[7]).max() < 1e-9
    assert reached > 5


@pytest.mark.parametrize("across", [None, 0, 1, 2])
def test_cells_beside_a_positioner_are_where_pykdl_finds_them(on_positioner, across):
    """Along the path with the external axes as they are planned, or one of them across at one point."""
    task, beads = on_positioner
    cell, own = task.cell, 6
    if across is None:
        at = spin_map.columns(beads, cell, 40)
        expected = np.array([beads[k].external[n] for k, n in zip(at.bead, at.point)])
        assert np.ptp(expected[:, 2]) > 1.0
    else:
        values = spin_map.span(task, beads[1], 7, across, 21)
        lower, upper = cell.limits.lower[own + across], cell.limits.upper[own + across]
        assert values[0] >= lower - 1e-12 and values[-1] <= upper + 1e-12
        assert np.ptp(values) == pytest.approx(
            min(upper - lower, np.inf if across == 0 else TURN), rel=0.5
        )
        at = spin_map.across(beads, cell, (1, 7), across, values)
        expected = np.tile(beads[1].external[7], (21, 1))
        expected[:, across] = values
        assert (at.bead == 1).all() and (at.point == 7).all()
    found = spin_map.redundancy_map(
        task, at, spin_map.ROTATION, values=np.linspace(-np.pi, np.pi, 25)
    )
    whole, reached = KdlArm(cell.machine), 0
    for row, column in np.random.default_rng(3).integers(0, (25, len(at)), (60, 2)):
        flange = at.points.select_points(np.array([column])).frames.flange_poses(
            found.phi[row, [column]]
        )
        for branch, q in enumerate(
            spin_map.joints_at(task, at, int(column), float(found.phi[row, column]))
        ):
            margin = found.margin[branch, row, column]
            assert (margin > -np.inf) == np.isfinite(q).all()
            if not np.isfinite(q).all():
                continue
            reached += 1
            np.testing.assert_allclose(q[own:], expected[column], atol=1e-12)
            np.testing.assert_allclose(KdlArm(cell.robot).forward([q[:own]]), flange, atol=1e-6)
            tip, tool = cell.tip_in_part(whole.forward([q]))
            assert np.abs(tip[0] - beads[at.bead[column]].points[at.point[column]]).max() < 1e-6
            assert np.abs(tool[0] - beads[at.bead[column]].tool[at.point[column]]).max() < 1e-9
            low, high = cell.limits.lower, cell.limits.upper
            share = [
                2 * min(v - a, b - v) / (b - a)
                for v, a, b in zip(q, low, high)
                if np.isfinite(b - a)
            ]
            share += [
                2 * min(v - a, b - v) / (b - a)
                for v, a, b in zip(
                    cell.limits.coefficients @ q,
                    cell.limits.coupled_lower,
                    cell.limits.coupled_upper,
                )
            ]
            assert margin == pytest.approx(min(share), abs=1e-9)
    assert reached > 60
    shown = spin_map.picture(task, found, 0)
    there = np.argwhere(shown.reachable)
    for row, column in there[:: max(1, len(there) // 20)]:
        part = at.points.select_points(np.array([column]))
        q = spin_map.joints_at(task, at, int(column), float(found.phi[row, column]))[0]
        assert shown.condition[row, column] == pytest.approx(
            float(task.condition(part, found.phi[row, [column]], q[None])[0]), abs=1e-9
        )
