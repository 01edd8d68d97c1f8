# SPDX-License-Identifier: LGPL-2.1-or-later
"""Poses of a box: a pose judged feasible by a few points is planned with all points; an infeasible
one is compared with single rotations and with the full plan; figures are compared with that
plan."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall
from freecad_am.core.issues import InputError, has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics import jacobian
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.motion import DEPOSIT
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.place import PlaceParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.placement import place
from freecad_am.core.placement.judge import UNREACHED, Job, Judge
from freecad_am.core.placement.place import Placed, place_part, ranked
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.simulation.timeline import timeline
from freecad_am.core.strategies.revolution import plan as revolution
from tests.core.planning.conftest import sphere

PROCESS = ProcessParameters(
    travel_speed=20.0,
    lead_on=0.3,
    between_layers=dataclasses.replace(ProcessParameters().between_layers, wait=5.0),
)
MARGIN_SHARE, TIME_SHARE = 0.02, 0.1  # promised in the docs: share of the range, and of the time
MOVABLE_CASES = {  # a cell with feasible and infeasible poses, the moved object, and the box
    "point": (CellParameters(limits="paper"), {"x": 400.0, "y": 400.0, "z": 300.0, "step": 300.0}),
    "platform on the flange": (
        CellParameters(limits="paper"), {"moves": "platform", "x": 300.0, "y": 0.0, "z": 200.0, "ry": np.pi / 3,
                                         "step": 300.0, "angle_step": np.pi / 3}),
    "tool on the robot": (
        CellParameters(setup="tool-on-robot", deposition_point=(900.0, 0.0, -100.0, 0.0, 0.0, 0.0),
                       branch=("front", "down", "noflip"),
                       nozzle=NozzleParameters(tool=(120.0, 0.0, 200.0, 0.0, np.radians(45.0), 0.0))),
        {"x": 600.0, "y": 600.0, "z": 0.0, "rz": np.pi / 2, "step": 600.0, "angle_step": np.pi / 2}),
    "positioner": (
        CellParameters(machine="kuka-kr8-r2100-2-arc-hw", setup="tool-on-robot", platform=20.0, branch="auto",
                       external="motoman-motopos-d500 at 1400 0 0 0 0 0 carries part",
                       nozzle=NozzleParameters(tool=(0.0, 0.0, 300.0, 0.0, 0.0, 0.0))),
        {"x": 600.0, "y": 0.0, "z": 500.0, "step": 500.0}),
    "table": (
        CellParameters(machine="table-xyzac", setup="rotary-table", platform=60.0),
        {"x": 400.0, "y": 0.0, "z": 0.0, "step": 200.0},
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def dome():
    """A hemisphere in layers of 9 mm."""
    wall = RevolvedWall(Meridian.chained(sphere()), np.eye(4))
    strategy = RevolutionParameters(layer_height=9.0, chord_error=0.1)
    return revolution.plan(
        wall, strategy, BuildDirectionParameters(), PROCESS, NozzleParameters(), 113.0
    )


def job_of(toolpath):
    return Job(
        toolpath,
        lambda settings: cells.resolve(settings, toolpath.frame, toolpath.family),
        lambda cell: (
            tuple(map(tuple, external_links.robot_cylinders(cell.robot.chain)))
            if cell.machine.free
            else ()
        ),
        PROCESS,
        JointParameters(),
    )


def plan_all_points(toolpath, settings):
    """Plan all points independently of the tested code; return cell, joint path, motion and
    feasibility."""
    cell = cells.resolve(settings, toolpath.frame, toolpath.family)
    path = plan_joints(toolpath, cell, JointParameters())
    motion, rapids = assemble(
        path, cell, PROCESS, toolpath.surroundings, JointParameters(), toolpath.layer_height
    )
    return cell, path, motion, not has_errors([*path.issues, *rapids])


@pytest.mark.parametrize("case", MOVABLE_CASES)
@pytest.mark.always("tool on the robot", "point", "table")
def test_what_is_said_of_a_pose_is_what_its_whole_plan_says(dome, case):
    """The verdict on a pose agrees with the plan of all points."""
    settings, box = MOVABLE_CASES[case]
    parameters = PlaceParameters(points=200, **box)
    moves = place.select_movable(settings, parameters.moves)
    poses = parameters.poses(place.pose_of(settings, moves))
    sampled_judge, full_judge = (
        Judge(job_of(dome), max_points) for max_points in (parameters.points, None)
    )
    assert sampled_judge.points < 0.6 * full_judge.points == 0.6 * dome.point_count
    verdicts, hidden = [], 0
    for pose in poses[np.unique(np.linspace(0, len(poses) - 1, 5).astype(int))]:
        moved_cell = place.replace_pose(settings, moves, pose)
        verdict = sampled_judge.evaluate(moved_cell)
        cell, path, motion, feasible = plan_all_points(dome, moved_cell)
        assert verdict.feasible or not feasible, (pose, verdict)
        verdicts.append(feasible)
        if (
            verdict.feasible and not feasible
        ):  # infeasible between the sampled points; detected before the pose is proposed
            hidden += 1
            assert not full_judge.evaluate(moved_cell).feasible
        if feasible:
            margin = cell.limits.smallest_share(motion.joints[motion.role == DEPOSIT]).min()
            assert verdict.share == 1.0 and verdict.branch == path.branch
            assert verdict.margin == pytest.approx(margin, abs=MARGIN_SHARE)
            assert verdict.time == pytest.approx(timeline(motion, PROCESS).total, rel=TIME_SHARE)
    assert {True, False} <= set(
        verdicts
    ) and hidden <= 1  # both verdicts occur, otherwise nothing was tested


def test_points_that_no_rotation_serves_are_counted_right(dome):
    """Each point with 1,440 rotations in turn: limits with whole turns, and the conditioning of a
    Jacobian by differences."""
    settings = CellParameters(
        limits="paper", deposition_point=(645.747, -830.155, 453.167, 0.0, 0.0, 0.0)
    )
    judge = Judge(job_of(dome), 40)
    verdict = judge.evaluate(settings)
    cell = cells.resolve(settings, dome.frame)
    beads = [bead for _, _, bead in judge._some.toolpath]
    position, tool = (
        np.concatenate([getattr(bead, name) for bead in beads]) for name in ("points", "tool")
    )
    turns, lower, upper = 2.0 * np.pi * np.arange(-2, 3), cell.limits.lower, cell.limits.upper
    served = np.zeros(len(position), dtype=bool)
    at_zero = np.zeros(len(position))
    spins = np.concatenate([[np.nan], np.linspace(-np.pi, np.pi, 1440, endpoint=False)])
    for k, spin in enumerate(spins):
        phi = (
            cell.poses.phi_of_rz(tool, np.zeros(len(tool)))[0]
            if k == 0
            else np.full(len(tool), spin)
        )
        flange = cell.flange_poses(position, tool, phi)
        q = cell.machine.arm.inverse_branch(flange, cell.branch)
        reached = np.isfinite(q).all(axis=1)
        condition = np.zeros(len(q))
        matrix = jacobian.jacobian(
            cell.robot.chain, q[reached], cell.deposition_point(flange)[reached]
        )
        scaled = matrix.copy()
        scaled[:, :3] /= 1000.0
        sigma = np.linalg.svd(scaled, compute_uv=False)
        condition[reached] = sigma[:, -1] / sigma[:, 0]
        if k == 0:
            at_zero = condition
            continue
        turned = q[..., None] + turns
        within = ((turned >= lower[:, None]) & (turned <= upper[:, None])).any(axis=2).all(axis=1)
        served |= reached & within & (condition >= np.maximum(0.25 * at_zero, 0.02))
    assert 0.1 < served.mean() < 0.95
    assert (verdict.share, verdict.code) == (pytest.approx(served.mean(), abs=1e-12), UNREACHED)


def test_the_best_is_planned_with_all_points_and_nearest_to_where_the_part_stands(dome):
    """The best pose is planned with all points and is the nearest to the present position."""
    settings = CellParameters(limits="paper")
    steps = []
    placement = place_part(
        job_of(dome),
        settings,
        PlaceParameters(points=60, x=300.0, y=0.0, z=300.0, step=300.0),
        lambda share, text: steps.append(share),
    )
    assert isinstance(placement, Placed) and len(placement.poses) == 9 and steps == sorted(steps)
    assert placement.best == next(reversed(placement.proven))
    assert plan_all_points(
        dome, dataclasses.replace(settings, **inner(placement.entries(placement.best)))
    )[3]
    margins = {number: placement.judged[number].margin for number in ranked(placement, "margin")}
    clear = [number for number in margins if placement.judged[number].clearance > 0.0]
    assert (
        placement.proven[placement.best].margin
        >= max(margins[number] for number in clear) - MARGIN_SHARE
    )
    times = [
        placement.judged[number].time for number in ranked(placement, "time") if number in clear
    ]
    assert times == pytest.approx(sorted(times), abs=0.11)
    assert set(ranked(placement, "clearance")) == set(ranked(placement, "time"))
    lines = list(place.rows(placement))
    assert (
        len(lines) == 10
        and lines[0].startswith("x_mm,")
        and all(line.count(",") == 13 for line in lines)
    )
    assert [line.split(",")[6] for line in lines[1:]] == [
        "yes" if pose_verdict.feasible else "no" for pose_verdict in placement.judged
    ]
    assert place.key(placement, placement.best).startswith("deposition_point: [")


def inner(entries):
    """Convert mm and deg to mm and rad."""
    return {name: (*pose[:3], *np.radians(pose[3:])) for name, pose in entries.items()}


def test_cancelling_ends_it(dome):
    class Enough(Exception):
        pass

    def progress(share, text):
        if text.startswith("pose 3 "):
            raise Enough

    with pytest.raises(Enough):
        place_part(
            job_of(dome), CellParameters(limits="paper"), PlaceParameters(points=20), progress
        )


def test_no_pose_serves(dome):
    unreachable = CellParameters(limits="paper", deposition_point=(5000.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    placement = place_part(
        job_of(dome),
        unreachable,
        PlaceParameters(x=100.0, y=0.0, z=0.0, step=100.0),
        lambda share, text: None,
    )
    assert (
        placement.best is None
        and not placement.proven
        and [pose_verdict.share for pose_verdict in placement.judged] == [0.0] * 3
    )


@pytest.mark.parametrize(("settings", "moves"), [
    (CellParameters(), "positioner"), (CellParameters(setup="tool-on-robot"), "platform"),
    (CellParameters(machine="table-xyzac", setup="rotary-table"), "deposition-point"),
])  # fmt: skip
def test_what_a_cell_has_not_is_not_moved(settings, moves):
    with pytest.raises(InputError, match="the part is not placed by") as error:
        place.select_movable(settings, moves)
    assert (error.value.code, error.value.where) == ("NOT_FOR_SETUP", "place.moves")


def test_too_many_poses_are_refused():
    with pytest.raises(InputError, match="68921 poses") as error:
        PlaceParameters(step=10.0)
    assert error.value.where == "place.step"


def test_a_box_has_where_the_part_stands_in_its_middle():
    parameters = PlaceParameters(
        x=250.0, y=0.0, z=100.0, rz=np.pi, step=100.0, angle_step=np.pi / 2
    )
    about = (10.0, 20.0, 30.0, 0.1, 0.2, 0.3)
    poses = parameters.poses(about)
    assert (
        len(poses) == 5 * 1 * 3 * 5
        and (np.abs(poses - np.array(about)) < 1e-12).all(axis=1).sum() == 1
    )
    assert np.allclose(np.sort(np.unique(poses[:, 0])), 10.0 + 100.0 * np.arange(-2, 3))
