# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance`: links that a plan without it drives into a post keep clear of it, on rapids too. Judged by PyKDL's
frames of the links, and by how far points on these are from a box, at ten times as many places."""

import dataclasses

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.issues import has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.links import external_links, self_collision
from freecad_am.core.kinematics.links.self_collision import OwnLinks
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters
from freecad_am.core.parameters.joints import JointParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import RevolutionParameters
from freecad_am.core.planning import arm_clearance, clear_rotations
from freecad_am.core.planning.motion import assemble
from freecad_am.core.planning.plan import plan_joints
from freecad_am.core.planning.points import gather
from freecad_am.core.planning.rotation import global_search
from freecad_am.core.planning.task import Task
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.kdl import KdlArm
from tests.core.planning.conftest import sphere
from tests.kdl_links import KdlLinks

CLEARANCE = 10.0
SIZE = np.array([60.0, 60.0, 400.0])  # of a post, mm
CELL = {
    "limits": "paper",
    "setup": "tool-on-robot",
    "deposition_point": (1000.0, 0.0, -100.0, 0.0, 0.0, 0.0),
    "nozzle": NozzleParameters(length=60.0, tool=(120.0, 0.0, 200.0, 0.0, np.radians(45.0), 0.0)),
}
DOWN, UP = ("front", "down", "noflip"), ("front", "up", "flip")
# where a post stands about the part, mm and deg, and a configuration that can do without touching it
POSTS = [(160.0, 60.0, DOWN), (120.0, 180.0, UP)]


@pytest.fixture(scope="module")
def dome():
    """A hemisphere in layers of 15 mm, the nozzle upright."""
    wall = RevolvedWall(Meridian.chained(sphere()), np.eye(4))
    return revolution.plan(
        wall,
        RevolutionParameters(layer_height=15.0, chord_error=0.2),
        BuildDirectionParameters(mode="fixed"),
        ProcessParameters(),
        NozzleParameters(),
        113.0,
    )


def box(low, size, name):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size + low
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Body(
        name, corners, np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])
    )


def planned(toolpath, cell, method="layer-by-layer", **more):
    """The motion of a job, and its issues."""
    rods, parameters = (
        external_links.robot_cylinders(cell.robot.chain),
        JointParameters(method=method, **more),
    )
    path = plan_joints(toolpath, cell, parameters, cylinders=rods)
    motion, rapids = assemble(
        path,
        cell,
        ProcessParameters(),
        toolpath.surroundings,
        parameters,
        toolpath.layer_height,
        rods,
    )
    return motion, [*path.issues, *rapids]


def on_rods(rods, spacing=8.0):
    """Points (n, 3) on the sides and ends of the rods of a link."""
    points = []
    for rod in rods:
        axis = (rod.end - rod.start) / rod.length
        one = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        one /= np.linalg.norm(one)
        other = np.cross(axis, one)
        along = np.linspace(0.0, rod.length, 2 + int(rod.length / spacing))
        turn = np.linspace(0.0, 2.0 * np.pi, 8 + int(6.3 * rod.radius / spacing))
        ring = np.cos(turn)[:, None] * one + np.sin(turn)[:, None] * other
        points.append((rod.start + along[:, None, None] * axis + rod.radius * ring).reshape(-1, 3))
        points += [
            at + share * rod.radius * ring
            for at in (rod.start, rod.end)
            for share in (0.25, 0.5, 0.75)
        ]
    return np.concatenate(points)


def nearest(motion, cell, low):
    """(n,) mm between the links, by PyKDL, and the post in part coordinates, at ten places of each move of a motion."""
    joints = motion.joints
    parts = [joints[:-1] + share * np.diff(joints, axis=0) for share in np.linspace(0.1, 1.0, 10)]
    return nearest_of(np.concatenate(parts)[::23], cell, low)


def nearest_of(joints, cell, low):
    """(k,) the same with joints (k, axes)."""
    arm, found = KdlLinks(cell.machine), []
    mount = cell.poses.station @ np.linalg.inv(cell.poses.mount)
    links = [
        (number, on_rods(rods))
        for number, rods in enumerate(external_links.robot_cylinders(cell.robot.chain))
        if number and rods
    ]
    for q in joints:
        best = np.inf
        for number, points in links:
            link = arm.frame(q, number)
            place = points @ link[:3, :3].T + link[:3, 3]
            seen = (place - mount[:3, 3]) @ mount[:3, :3]
            best = min(
                best,
                np.linalg.norm(
                    np.maximum(np.maximum(low - seen, seen - low - SIZE), 0.0), axis=1
                ).min(),
            )
        found.append(best)
    return np.array(found)


@pytest.mark.parametrize(("radius", "azimuth", "branch"), POSTS)
def test_links_that_met_a_post_keep_clear_of_it(dome, radius, azimuth, branch):
    turn = np.radians(azimuth)
    low = np.array([radius * np.cos(turn), radius * np.sin(turn), 195.0]) - 0.5 * SIZE
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, box(low, SIZE, "post")))
    without = cells.resolve(CellParameters(**CELL, branch=DOWN), job.frame)
    motion, issues = planned(job, without)
    assert not has_errors(issues) and nearest(motion, without, low).min() < CLEARANCE
    kept = cells.resolve(CellParameters(**CELL, branch=branch, arm_clearance=CLEARANCE), job.frame)
    motion, issues = planned(job, kept)
    assert not has_errors(issues)
    assert nearest(motion, kept, low).min() >= CLEARANCE
    # and it is the same deposit, within limits
    tip, _ = kept.tip_in_part(KdlArm(kept.machine).forward(motion.joints[motion.deposit]))
    assert np.abs(tip - motion.position[motion.deposit]).max() < 1e-6
    assert not kept.limits.exceeded(motion.joints).any()


@pytest.mark.parametrize(
    ("method", "branch"), [("constant", DOWN), ("constant", UP), ("point-by-point", UP)]
)
@pytest.mark.always("constant-branch0", "point-by-point-branch2")
def test_other_methods_keep_clear_too(dome, method, branch):
    low = np.array([80.0, 80.0 * np.sqrt(3.0), 195.0]) - 0.5 * SIZE
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, box(low, SIZE, "post")))
    without = cells.resolve(CellParameters(**CELL, branch=branch), job.frame)
    motion, issues = planned(job, without, method)
    assert not has_errors(issues) and nearest(motion, without, low).min() < CLEARANCE
    kept = cells.resolve(CellParameters(**CELL, branch=branch, arm_clearance=CLEARANCE), job.frame)
    motion, issues = planned(job, kept, method)
    assert not has_errors(issues)
    assert nearest(motion, kept, low).min() >= CLEARANCE


def test_what_one_rotation_for_all_cannot_clear_is_named_with_what_may_help(dome):
    wall = box(np.array([-400.0, 75.0, -5.0]), np.array([800.0, 40.0, 900.0]), "back wall")
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, wall))
    cell = cells.resolve(CellParameters(**CELL, branch=DOWN, arm_clearance=60.0), job.frame)
    for method in ("constant", "point-by-point"):
        _, issues = planned(job, cell, method)
        told = [issue for issue in issues if issue.code == "ARM_CLEARANCE"]
        assert any("back wall" in issue.message and issue.layer is not None for issue in told)
        notes = [issue.message for issue in issues if issue.code == "RZ_CONSTANT"]
        assert len(notes) == (method == "constant") and all(
            "layer-by-layer" in note for note in notes
        )


def test_what_cannot_be_cleared_is_named(dome):
    wall = box(np.array([-400.0, 75.0, -5.0]), np.array([800.0, 40.0, 900.0]), "back wall")
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, wall))
    cell = cells.resolve(CellParameters(**CELL, branch=DOWN, arm_clearance=60.0), job.frame)
    _, issues = planned(job, cell)
    told = [issue for issue in issues if issue.code == "ARM_CLEARANCE"]
    assert {issue.layer for issue in told} == set(range(len(job.layers)))
    assert all(issue.message.startswith("link q") and "60 mm" in issue.message for issue in told)
    assert any("back wall" in issue.message for issue in told)


def beside_the_dome(dome, radius, azimuth):
    """The dome with a post beside it, and the post's lower corner."""
    turn = np.radians(azimuth)
    low = np.array([radius * np.cos(turn), radius * np.sin(turn), 195.0]) - 0.5 * SIZE
    return dataclasses.replace(dome, surroundings=(*dome.surroundings, box(low, SIZE, "post"))), low


def objectives(path, cell):
    """Of each bead the objective of eq. 17, here."""
    weights = 1.0 / (cell.limits.upper - cell.limits.lower)
    weights[~np.isfinite(weights)] = 0.0
    return np.array([(weights * np.diff(bead.joints, axis=0) ** 2).sum() for bead in path.beads])


def test_what_came_too_near_is_refined_again_up_to_the_clearance(dome, monkeypatch):
    """Two layers were taken back to 25 and 50 % of the way from the search to the optimum, which a post is in the way of:
    with gaps among the constraints they win two thirds and four fifths of that, and come to the post as near as they may."""
    whole, low = beside_the_dome(dome, 120.0, 180.0)
    job = dataclasses.replace(whole, layers=whole.layers[:3])
    cell = cells.resolve(CellParameters(**CELL, branch=UP, arm_clearance=CLEARANCE), job.frame)
    rods, parameters = external_links.robot_cylinders(cell.robot.chain), JointParameters(degree=3)
    taken_back = []

    def kept(task, kept, points, places, start):
        taken_back.extend(place for place in places)
        return clear_rotations.Refined(
            start, np.zeros(len(start)), ("",) * len(start), (0,) * len(start)
        )

    with monkeypatch.context() as before:
        before.setattr(clear_rotations, "refined_clear", kept)
        back = objectives(plan_joints(job, cell, parameters, cylinders=rods), cell)
    free_cell = dataclasses.replace(cell, arm_clearance=None)
    free = objectives(plan_joints(job, free_cell, parameters, cylinders=rods), cell)
    path = plan_joints(job, cell, parameters, cylinders=rods)
    now = objectives(path, cell)
    assert taken_back == [(0, 0), (1, 0)] and not has_errors(path.issues)
    assert (free[:2] < 0.97 * back[:2]).all() and (now[2:] == back[2:]).all()
    won = (back[:2] - now[:2]) / (back[:2] - free[:2])
    assert (won > [0.64, 0.78]).all() and (won < 1.0).all(), (
        won
    )  # along a gap that is known wrongly it is less
    for bead in path.beads[:2]:
        between = np.linspace(0.0, 1.0, 10)[:, None, None]
        dense = (bead.joints[:-1] + between * np.diff(bead.joints, axis=0)).reshape(-1, 6)
        least = nearest_of(dense[::5], cell, low)
        # links are 0.2 mm larger than they are, points on them up to 8 mm apart, and bodies are met by edges of larger links
        assert CLEARANCE <= least.min() < 1.5 * CLEARANCE


# a UR whose wrist is bent onto its own forearm where the nozzle lies across, and one whose forearm meets its base, mm
ACROSS = {
    "setup": "tool-on-robot",
    "platform_diameter": 0.0,
    "nozzle": NozzleParameters(length=60.0, tool=(0.0, 0.0, 200.0, 0.0, np.radians(90.0), 0.0)),
}
OWN = [("ur-ur5e", (470.0, 20.0, -80.0)), ("ur-ur10e", (590.0, -260.0, -180.0))]


def apart(motion, cell):
    """The least mm between forearm and last link, by PyKDL, at ten places of each move of a motion."""
    arm = KdlLinks(cell.machine)
    rods = external_links.robot_cylinders(cell.robot.chain)
    parts = [
        motion.joints[:-1] + share * np.diff(motion.joints, axis=0)
        for share in np.linspace(0.1, 1.0, 10)
    ]
    least = np.inf
    for q in np.concatenate(parts)[::17]:
        clouds = []
        for number in (3, 6):
            link = arm.frame(q, number)
            clouds.append(on_rods(rods[number], 6.0) @ link[:3, :3].T + link[:3, 3])
        least = min(least, cKDTree(clouds[0]).query(clouds[1])[0].min())
    return least


@pytest.mark.parametrize(("robot", "place"), OWN)
@pytest.mark.always("ur-ur5e-place0")
def test_links_that_met_each_other_keep_apart(dome, robot, place):
    cell = {**ACROSS, "machine": robot, "deposition_point": (*place, 0.0, 0.0, 0.0)}
    without = cells.resolve(CellParameters(**cell), dome.frame)
    motion, issues = planned(dome, without)
    assert not has_errors(issues) and apart(motion, without) < CLEARANCE
    kept = cells.resolve(CellParameters(**cell, arm_clearance=CLEARANCE), dome.frame)
    motion, issues = planned(dome, kept)
    assert not has_errors(issues) and apart(motion, kept) >= CLEARANCE


def test_links_that_cannot_keep_apart_are_named_with_their_place(dome):
    """The forearm meets the base however the tool is turned: told is this, and not what another configuration lacks."""
    nozzle = NozzleParameters(length=60.0, tool=(0.0, 0.0, 100.0, 0.0, np.radians(45.0), 0.0))
    cell = cells.resolve(
        CellParameters(
            machine="ur-ur10e",
            setup="tool-on-robot",
            platform_diameter=0.0,
            nozzle=nozzle,
            arm_clearance=CLEARANCE,
            deposition_point=(250.0, 0.0, -200.0, 0.0, 0.0, 0.0),
        ),
        dome.frame,
    )
    _, issues = planned(dome, cell)
    errors = [issue for issue in issues if issue.level == "error"]
    assert {issue.code for issue in errors} == {"ARM_CLEARANCE"} and (
        errors[0].layer,
        errors[0].bead,
    ) == (0, 0)
    assert errors[0].message.startswith("link q3 comes closer than 10 mm to base, or touches it;")


def test_beads_that_no_rotation_serves_are_found_by_few_points_as_by_all(dome, monkeypatch):
    """The same candidates are left whether beads are given up at their ends or looked at everywhere."""
    wall = box(np.array([-140.0, -60.0, -5.0]), np.array([12.0, 120.0, 420.0]), "wall")
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, wall))
    cell = cells.resolve(CellParameters(**CELL, branch=DOWN, arm_clearance=CLEARANCE), job.frame)
    kept = arm_clearance.build_arm_clearance(
        job, cell, external_links.robot_cylinders(cell.robot.chain)
    )
    beads, places = [bead for _, _, bead in job], [(layer, index) for layer, index, _ in job]
    points = gather(beads, cell, clear_rotations.POINTS_PER_BEAD)
    found, looked = [], []
    for branch in range(8):
        task = Task(cell, branch, JointParameters(), False, kept)
        candidates = global_search.everywhere(task, points, task.thresholds(points))
        for ends in (clear_rotations.ENDS, clear_rotations.POINTS_PER_BEAD):
            monkeypatch.setattr(clear_rotations, "ENDS", ends)
            asked = []
            monkeypatch.setattr(arm_clearance.ArmKept, "rotations_near", counting(asked))
            found.append(
                clear_rotations.exclude_touching(task, kept, points, places, candidates).margin
            )
            looked.append(sum(asked))
            monkeypatch.undo()
    assert all(np.array_equal(one, other) for one, other in zip(found[::2], found[1::2]))
    assert 0 < sum(looked[::2]) < 0.7 * sum(looked[1::2])


def counting(asked, own=arm_clearance.ArmKept.rotations_near):
    """`rotations_near` that notes how many joint vectors it is asked about."""

    def rotations_near(self, joints, bead, places):
        asked.append(joints.shape[0] * joints.shape[1])
        return own(self, joints, bead, places)

    return rotations_near


def test_pairs_of_links_are_found_once_for_the_same_robot_and_anew_for_another():
    robot = cells.resolve(CellParameters(machine="ur-ur5e"), np.eye(4)).robot
    limits, rods = robot.limits("maker"), external_links.robot_cylinders(robot.chain)
    first = OwnLinks.of(robot.chain, limits, rods, CLEARANCE)
    assert (
        OwnLinks.of(robot.chain, limits, external_links.robot_cylinders(robot.chain), CLEARANCE)
        is first
    )
    other = machine.load("ur-ur10e")
    thick = [[dataclasses.replace(rod, radius=4.0 * rod.radius) for rod in link] for link in rods]
    narrow = dataclasses.replace(
        limits, upper=np.append(limits.upper[:2], [*limits.lower[2:3] + 1e-3, *limits.upper[3:]])
    )
    for chain, among, links, clearance in [
        (other.chain, limits, rods, CLEARANCE),
        (robot.chain, narrow, rods, CLEARANCE),
        (robot.chain, limits, thick, CLEARANCE),
        (robot.chain, limits, rods, 8.0 * CLEARANCE),
    ]:
        found = OwnLinks.of(chain, among, links, clearance)
        fresh = self_collision._find_pairs.__wrapped__(
            self_collision._Asked(chain, among, links, clearance)
        )  # not remembered
        assert found is not first and (found.gap, found.pairs) == (fresh.gap, fresh.pairs)
    assert fresh.pairs != first.pairs
