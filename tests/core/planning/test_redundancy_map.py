# SPDX-License-Identifier: LGPL-2.1-or-later
"""Each cell of the redundancy map agrees with the planner and PyKDL for a point."""

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


def map_of_bead(toolpath, axis=spin_map.RZ, branch=FLIP, rows=61, **options):
    setup = options.pop("setup", PART_ON_ROBOT)
    cell = cells.resolve(CellParameters(**{"limits": "paper", **setup}), toolpath.frame)
    task = Task(cell, branch, JointParameters(**options))
    columns = spin_map.columns(beads_of(toolpath)[0], cell, 50)
    redundancy = spin_map.redundancy_map(
        task, columns, axis, values=np.linspace(-np.pi, np.pi, rows)
    )
    return task, redundancy, spin_map.picture(task, redundancy, branch)


@pytest.mark.parametrize(
    "setup", [PART_ON_ROBOT, TOOL_ON_ROBOT], ids=["part on robot", "tool on robot"]
)
@pytest.mark.parametrize("axis", [spin_map.RZ, spin_map.ROTATION])
def test_cells_are_where_pykdl_finds_them(funnel, setup, axis):
    """Cells agree with PyKDL."""
    task, redundancy, _ = map_of_bead(funnel, axis, setup=setup)
    cell, arm = task.cell, KdlArm(task.cell.machine)
    random = np.random.default_rng(1)
    points = redundancy.columns.points
    rows = random.integers(0, len(redundancy.values), 60)
    columns = random.integers(0, len(points), 60)
    reached = 0
    for row, column in zip(rows, columns):
        for branch, q in enumerate(
            spin_map.joints_at(
                task, redundancy.columns, int(column), float(redundancy.phi[row, column])
            )
        ):
            margin = redundancy.margin[branch, row, column]
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
            ):  # the last Bryant angle of the same rotation, from PyKDL's flange
                mounted = np.eye(3) if setup is not PART_ON_ROBOT else None
                platform = flange[0] @ cell.poses.carried
                turned = (
                    (cell.poses.station[:3, :3].T @ platform[:3, :3]) if mounted is None else None
                )
                if turned is not None:
                    rz = np.arctan2(-turned[0, 1], turned[0, 0])
                    assert abs((rz - redundancy.values[row] + np.pi) % TURN - np.pi) < 1e-6
    assert reached > 100


@pytest.mark.parametrize("branch", [1, 0, 3])
def test_cells_are_what_the_planner_says_of_points(funnel, branch):
    """Cells agree with the planner's values at points."""
    task, redundancy, picture = map_of_bead(funnel, branch=branch)
    points = redundancy.columns.points
    threshold = task.thresholds(points)
    for row in (0, 13, 30, 47):
        phi, _ = task.cell.poses.phi_of_rz(
            points.tool, np.full(len(points), redundancy.values[row])
        )
        assert np.abs(np.exp(1j * phi) - np.exp(1j * redundancy.phi[row])).max() < 1e-7
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
    """The flipped wrist is equally near to a singularity."""
    task, redundancy, flipped = map_of_bead(dome)
    noflip = spin_map.picture(task, redundancy, FLIP - 1)
    assert np.abs(flipped.condition - noflip.condition).max() < 1e-9


@pytest.mark.parametrize("part", ["dome", "funnel"])
@pytest.mark.parametrize("rz", [-2.0, -0.4, 0.9, 2.6])
@pytest.mark.always
def test_a_constant_rz_lies_in_good_cells_just_when_the_planner_finds_it_feasible(
    request, part, rz
):
    """Except for axes that run out of turns along a bead, which a cell cannot show."""
    toolpath = request.getfixturevalue(part)
    beads, bead_places = beads_of(toolpath)
    verdicts = []
    for branch in range(8):
        cell = cells.resolve(
            CellParameters(limits="paper", branch=spherical_wrist.branch_name(branch)),
            toolpath.frame,
        )
        task = Task(cell, branch, JointParameters(method="constant", rz=rz))
        paths, issues = plan.METHODS["constant"](task, beads, bead_places, lambda *_: None)
        issues = [issue for path in paths for issue in spin_curve.findings(task, path)]
        columns = spin_map.columns(beads, cell, 10**6)
        assert len(columns) == sum(map(len, beads))
        picture = spin_map.picture(
            task, spin_map.redundancy_map(task, columns, values=np.array([rz])), branch
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
        # an axis that runs out of turns differs by whole turns from its cell
        if followed.wound.any():
            k = int(np.flatnonzero(followed.wound)[0])
            off = followed.joints[k] - spin_map.joints_at(task, columns, k, followed.phi[k])[branch]
            assert (
                np.abs(off - TURN * np.round(off / TURN)).max() < 1e-6
                and np.abs(off[~task.continuous]).max() > 6.0
            )
        verdicts.append(feasible)
    assert len(set(verdicts)) == 2 or part == "funnel"


def test_what_the_job_does_not_allow_is_outside(dome):
    """Rotations outside the range of the job are marked."""
    _, redundancy, picture = map_of_bead(
        dome, spin_map.ROTATION, rotation_range=(np.radians(-30.0), np.radians(200.0))
    )
    turned = np.degrees(redundancy.values)
    allowed = (turned >= -30.0) | (turned <= -160.0)
    assert np.array_equal(
        ~redundancy.outside, np.repeat(allowed[:, None], len(redundancy.columns), axis=1)
    )
    assert not picture.feasible[~allowed].any()


def test_columns_with_a_body_under_the_nozzle_are_forbidden(dome):
    """Columns with an obstacle below the nozzle are forbidden."""
    cell = cells.resolve(CellParameters(limits="paper"), dome.frame)
    task = Task(cell, FLIP, JointParameters())
    columns = spin_map.columns(beads_of(dome)[0], cell, 60)
    centre = columns.points.position[20] + 30.0 * columns.points.tool[20]
    corners = centre + np.array([[-1.0, -1, -1], [1, -1, 1], [0, 1, 0]])
    body = Body("flag", corners, np.array([[0, 1, 2]]))
    clear, touching = (
        spin_map.redundancy_map(task, columns, bodies=bodies) for bodies in ((), (body,))
    )
    assert not clear.touching.any() and touching.touching[20] and not touching.touching.all()
    # a nozzle that stands on a part may touch it next to its tip
    floor = Body(
        "floor",
        columns.points.position[20] + 0.3 * columns.points.tool[20] + 0.2 * (corners - centre),
        body.triangles,
    )
    assert not spin_map.redundancy_map(task, columns, bodies=(floor,)).touching[20]
    assert spin_map.picture(task, touching, FLIP).forbidden[:, 20].all()


def test_columns_are_even_and_have_the_ends_of_beads(dome, funnel):
    """Columns are evenly spaced and include the ends of beads."""
    for toolpath in (dome, funnel):
        beads, _ = beads_of(toolpath)
        cell = cells.resolve(CellParameters(limits="paper"), toolpath.frame)
        columns = spin_map.columns(beads, cell, 100)
        assert 80 <= len(columns) <= 100
        for k, bead in enumerate(beads):
            of_bead = columns.point[columns.bead == k]
            assert of_bead[0] == 0 and of_bead[-1] == len(bead) - 1 and (np.diff(of_bead) > 0).all()
            assert np.array_equal(columns.points.position[columns.bead == k], bead.points[of_bead])
            assert np.array_equal(
                columns.points.parameter[columns.bead == k], bead.parameter[of_bead]
            )
        few_columns = spin_map.columns(beads, cell, 3 * spin_map.MIN_POINTS_PER_BEAD)
        assert list(np.unique(few_columns.bead)) == [0, len(beads) // 2, len(beads) - 1]
        assert (
            np.bincount(few_columns.bead)[np.unique(few_columns.bead)]
            == spin_map.MIN_POINTS_PER_BEAD
        ).all()
        for k in np.unique(few_columns.bead):
            assert few_columns.point[few_columns.bead == k][-1] == len(beads[k]) - 1


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
    """The planner's result can be given back to it."""
    _, free = planned(dome)
    texts = tuple(
        str(GivenPolynomial((path.layer, path.index), tuple(path.coefficients)))
        for path in free.beads
    )
    _, again = planned(dome, given=texts)
    assert again.feasible and [path.reason for path in again.beads] == ["given"] * len(free.beads)
    for free_path, given_path in zip(free.beads, again.beads):
        assert (
            np.abs(free_path.phi - given_path.phi).max() < 1e-9
            and np.abs(free_path.joints - given_path.joints).max() < 1e-7
        )
        assert given_path.objective == pytest.approx(free_path.objective, rel=1e-6)


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
    """At a constant rotation the last axis needs an additional turn, and other limits are violated
    too."""
    cell, path = planned(dome, given=("*:0",))
    beads, bead_places = beads_of(dome)
    points = gather(beads, cell)
    task = Task(cell, FLIP, JointParameters())
    followed = spin_curve.follow(
        task, points, task.thresholds(points), spin_curve.durations(beads), np.zeros(len(points))
    )
    assert path.feasible == followed.good.all()
    ends = np.append(points.first, len(points))
    error_layers = {issue.layer for issue in path.issues if issue.level == ERROR}
    for k, (layer, _) in enumerate(bead_places):
        assert (layer in error_layers) == (not followed.good[ends[k] : ends[k + 1]].all())
    assert np.allclose(
        followed.displacement, [bead_path.objective for bead_path in path.beads], rtol=1e-9
    )


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
    polynomials = GIVEN.read(("*:90:-360", "4:10"))
    assert {polynomial.bead: polynomial.coefficients for polynomial in polynomials} == {
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
    """A curve evaluates the planner's path."""
    cell, path = planned(funnel)
    beads, _ = beads_of(funnel)
    task = Task(cell, FLIP, JointParameters())
    points = gather(beads, cell)
    coefficients = np.array([bead_path.coefficients for bead_path in path.beads])
    followed = spin_curve.follow(
        task,
        points,
        task.thresholds(points),
        spin_curve.durations(beads),
        points.polynomial(coefficients),
    )
    assert np.allclose(
        followed.displacement, [bead_path.objective for bead_path in path.beads], rtol=1e-9
    )
    sums = spin_curve.sums(followed)
    figures = criteria.path_figures(
        dataclasses.replace(
            path,
            beads=tuple(
                dataclasses.replace(
                    bead_path,
                    bead=bead,
                    joints=followed.joints[a:b],
                    condition=followed.condition[a:b],
                    phi=followed.phi[a:b],
                )
                for bead_path, bead, a, b in zip(
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
        expected = random.uniform(-1, 1, (len(beads), degree + 1)) / 3.0 ** np.arange(degree + 1)
        fitted = spin_curve.fitted(points, points.polynomial(expected), degree)
        assert np.abs(points.polynomial(fitted) - points.polynomial(expected)).max() < 1e-8


@pytest.mark.parametrize("joined", [False, True])
def test_a_handle_moves_alone(funnel, joined):
    """A handle moves without the others."""
    beads, _ = beads_of(funnel)
    cell = cells.resolve(CellParameters(limits="paper"), funnel.frame)
    points = gather(beads, cell)
    task = Task(cell, FLIP, JointParameters(), joined)
    random = np.random.default_rng(7)
    for degree in range(7):
        start = np.zeros(degree + 1)
        start[0] = random.uniform(-1, 1)
        handle_positions = spin_curve.handles(task, points, 1, degree)
        assert len(handle_positions) == (max(degree, 1) if joined else degree + 1)
        for handle in range(len(handle_positions)):
            pulled = start + 0.3 * spin_curve.pull(task, points, 1, degree, handle)
            value = np.polynomial.polynomial.polyval(handle_positions, pulled) - start[0]
            assert value == pytest.approx(
                np.where(np.arange(len(handle_positions)) == handle, 0.3, 0.0), abs=1e-6
            )
            if joined:
                low, high = (end[1] for end in points.ends)
                ends = np.polynomial.polynomial.polyval(np.array([low, high]), pulled)
                assert ends[1] - ends[0] == pytest.approx(0.0, abs=1e-6)


def test_methods_side_by_side_are_those_of_the_planner(dome):
    """The comparison of methods shows the planner's results."""
    beads, bead_places = beads_of(dome)
    cell, path = planned(dome)
    methods = spin_curve.compared(
        Task(cell, FLIP, JointParameters(given=("*:0",))), beads, bead_places, lambda *_: None
    )
    assert [method.name for method in methods] == list(plan.METHODS)
    by_layer = methods[0]
    assert by_layer.feasible
    assert by_layer.sums.displacement == pytest.approx(
        sum(method.objective for method in path.beads), rel=1e-6
    )
    assert by_layer.sums.displacement < 1.001 * min(
        method.sums.displacement for method in methods[1:] if method.feasible
    )


@pytest.mark.parametrize(
    "setup", [PART_ON_ROBOT, TOOL_ON_ROBOT], ids=["part on robot", "tool on robot"]
)
def test_cells_where_the_arm_touches_are_those_in_which_a_link_does(funnel, setup):
    """Cells marked for arm contact are those in which a link touches."""
    # a wall next to the part, in the way of one robot or the other
    wall = disc(900.0, frames.pose(frames.about_y(np.pi / 2), (260.0, 0.0, 200.0)), "wall")
    task, redundancy, picture = map_of_bead(funnel, spin_map.ROTATION, setup=setup)
    cell, columns = task.cell, redundancy.columns
    rods = [external_links.solid_cylinders(link) for link in robot_links.solids(cell.machine.chain)]
    beads = beads_of(funnel)[0]
    starts = np.concatenate([[0], np.cumsum([len(bead) for bead in beads])])
    moment = starts[columns.bead] + columns.point
    contact = ArmContact(cell, rods, [wall], Beads.of(beads, 6.0, 9.0).solid())
    touched = spin_map.arm_touched(task, redundancy, FLIP, contact, moment)
    is_checked = picture.reachable & ~picture.past_limit & ~picture.outside & ~redundancy.touching
    assert 0 < touched.sum() < is_checked.sum() and not (touched & ~is_checked).any()
    random = np.random.default_rng(2)
    for row, column in zip(
        random.integers(0, touched.shape[0], 80), random.integers(0, touched.shape[1], 80)
    ):
        q = spin_map.joints_at(task, columns, int(column), float(redundancy.phi[row, column]))[FLIP]
        touches = contact.touches(q[None], moment[[column]]).any[0]
        assert touched[row, column] == (bool(touches) and is_checked[row, column])
    with_arm = dataclasses.replace(picture, arm=touched)
    assert (with_arm.hatched == (picture.forbidden | touched)).all() and (
        picture.hatched == picture.forbidden
    ).all()
    rough = spin_map.arm_touched(task, redundancy, FLIP, contact, moment, 4)
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
    """A plan with e1 to e3, of which e3 rotates continuously; its task and beads."""
    toolpath = dataclasses.replace(dome, rules=MotionRules(max_from_vertical=np.radians(10.0)))
    cell = cells.resolve(CellParameters(**ON_POSITIONER), toolpath.frame)
    planned = plan.plan_joints(
        toolpath, cell, JointParameters(method="constant", min_condition=0.0)
    )
    return Task(cell, 0, JointParameters()), [path.bead for path in planned.beads]


def test_two_external_axes_against_each_other_are_as_one_at_a_time(on_positioner):
    """Each row is the map of the other axis at this value of the first, at the same rotation;
    joints are PyKDL's."""
    task, beads = on_positioner
    cell, selected, rotation = task.cell, (1, 7), 0.4
    values = tuple(
        spin_map.span(task, beads[1], 7, axis, count) for axis, count in ((2, 9), (1, 5))
    )
    pairs = spin_map.across_two_axes(beads, cell, selected, (2, 1), values)
    assert len(pairs) == 45 and (pairs.bead == 1).all() and (pairs.point == 7).all()
    redundancy = spin_map.redundancy_map(
        task, pairs, spin_map.ROTATION, values=np.array([rotation])
    )
    rows_of_pairs = spin_map.in_rows(spin_map.picture(task, redundancy, 0), 5)
    assert (
        rows_of_pairs.margin.shape
        == rows_of_pairs.condition.shape
        == rows_of_pairs.singular.shape
        == rows_of_pairs.forbidden.shape
        == (5, 9)
    )
    full_arm, reached = KdlArm(cell.machine), 0
    for row, upwards in enumerate(values[1]):
        external = beads[1].external.copy()
        external[7, 1] = upwards
        line = spin_map.across(
            [beads[0], dataclasses.replace(beads[1], external=external)],
            cell,
            selected,
            2,
            values[0],
        )
        alone = spin_map.redundancy_map(task, line, spin_map.ROTATION, values=np.array([rotation]))
        picture = spin_map.picture(task, alone, 0)
        np.testing.assert_allclose(rows_of_pairs.margin[row], picture.margin[0], atol=1e-12)
        np.testing.assert_allclose(rows_of_pairs.condition[row], picture.condition[0], atol=1e-12)
        assert np.array_equal(rows_of_pairs.feasible[row], picture.feasible[0])
        for column, across in enumerate(values[0]):
            q = spin_map.joints_at(task, pairs, row * 9 + column, rotation)[0]
            assert np.isfinite(q).all() == (rows_of_pairs.margin[row, column] > -np.inf)
            if np.isfinite(q).all():
                reached += 1
                np.testing.assert_allclose(q[[7, 8]], [upwards, across], atol=1e-12)
                tip, tool = cell.tip_in_part(full_arm.forward([q]))
                assert np.abs(tip[0] - beads[1].points[7]).max() < 1e-6
                assert np.abs(tool[0] - beads[1].tool[7]).max() < 1e-9
    assert reached > 5


@pytest.mark.parametrize("across", [None, 0, 1, 2])
def test_cells_beside_a_positioner_are_where_pykdl_finds_them(on_positioner, across):
    """Along the path with the planned external axes, or across one of them at one point."""
    task, beads = on_positioner
    cell, robot_axes = task.cell, 6
    if across is None:
        columns = spin_map.columns(beads, cell, 40)
        expected = np.array([beads[k].external[n] for k, n in zip(columns.bead, columns.point)])
        assert np.ptp(expected[:, 2]) > 1.0
    else:
        values = spin_map.span(task, beads[1], 7, across, 21)
        lower, upper = (
            cell.limits.lower[robot_axes + across],
            cell.limits.upper[robot_axes + across],
        )
        assert values[0] >= lower - 1e-12 and values[-1] <= upper + 1e-12
        assert np.ptp(values) == pytest.approx(
            min(upper - lower, np.inf if across == 0 else TURN), rel=0.5
        )
        columns = spin_map.across(beads, cell, (1, 7), across, values)
        expected = np.tile(beads[1].external[7], (21, 1))
        expected[:, across] = values
        assert (columns.bead == 1).all() and (columns.point == 7).all()
    redundancy = spin_map.redundancy_map(
        task, columns, spin_map.ROTATION, values=np.linspace(-np.pi, np.pi, 25)
    )
    full_arm, reached = KdlArm(cell.machine), 0
    for row, column in np.random.default_rng(3).integers(0, (25, len(columns)), (60, 2)):
        flange = columns.points.select_points(np.array([column])).frames.flange_poses(
            redundancy.phi[row, [column]]
        )
        for branch, q in enumerate(
            spin_map.joints_at(task, columns, int(column), float(redundancy.phi[row, column]))
        ):
            margin = redundancy.margin[branch, row, column]
            assert (margin > -np.inf) == np.isfinite(q).all()
            if not np.isfinite(q).all():
                continue
            reached += 1
            np.testing.assert_allclose(q[robot_axes:], expected[column], atol=1e-12)
            np.testing.assert_allclose(
                KdlArm(cell.robot).forward([q[:robot_axes]]), flange, atol=1e-6
            )
            tip, tool = cell.tip_in_part(full_arm.forward([q]))
            assert (
                np.abs(tip[0] - beads[columns.bead[column]].points[columns.point[column]]).max()
                < 1e-6
            )
            assert (
                np.abs(tool[0] - beads[columns.bead[column]].tool[columns.point[column]]).max()
                < 1e-9
            )
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
    picture = spin_map.picture(task, redundancy, 0)
    reachable_cells = np.argwhere(picture.reachable)
    for row, column in reachable_cells[:: max(1, len(reachable_cells) // 20)]:
        point = columns.points.select_points(np.array([column]))
        q = spin_map.joints_at(task, columns, int(column), float(redundancy.phi[row, column]))[0]
        assert picture.condition[row, column] == pytest.approx(
            float(task.condition(point, redundancy.phi[row, [column]], q[None])[0]), abs=1e-9
        )
