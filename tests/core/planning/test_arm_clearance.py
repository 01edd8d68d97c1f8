# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.arm_clearance`: links that a plan without it drives into a post keep clear of it, on rapids
too. Checked by PyKDL's link frames and the distance of points on the links from a box, at ten times
as many joint positions."""

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
# position of a post relative to the part, mm and deg, and a configuration that can avoid it
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


def planned(toolpath, cell, method="layer-by-layer", **options):
    """The motion of a job, and its issues."""
    rods, parameters = (
        external_links.robot_cylinders(cell.robot.chain),
        JointParameters(method=method, **options),
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
    """Points (n, 3) on the sides and ends of the capsules of a link."""
    points = []
    for rod in rods:
        axis = (rod.end - rod.start) / rod.length
        normal = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        normal /= np.linalg.norm(normal)
        binormal = np.cross(axis, normal)
        along = np.linspace(0.0, rod.length, 2 + int(rod.length / spacing))
        turn = np.linspace(0.0, 2.0 * np.pi, 8 + int(6.3 * rod.radius / spacing))
        ring = np.cos(turn)[:, None] * normal + np.sin(turn)[:, None] * binormal
        points.append((rod.start + along[:, None, None] * axis + rod.radius * ring).reshape(-1, 3))
        points += [
            end_point + share * rod.radius * ring
            for end_point in (rod.start, rod.end)
            for share in (0.25, 0.5, 0.75)
        ]
    return np.concatenate(points)


def nearest(motion, cell, low):
    """Distances (n,) in mm between the links, by PyKDL, and the post in part coordinates, at ten
    joint positions per move."""
    joints = motion.joints
    samples = [joints[:-1] + share * np.diff(joints, axis=0) for share in np.linspace(0.1, 1.0, 10)]
    return nearest_of(np.concatenate(samples)[::23], cell, low)


def nearest_of(joints, cell, low):
    """The same distances (k,) for joint positions (k, axes)."""
    arm, distances = KdlLinks(cell.machine), []
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
            points_in_world = points @ link[:3, :3].T + link[:3, 3]
            points_in_part = (points_in_world - mount[:3, 3]) @ mount[:3, :3]
            best = min(
                best,
                np.linalg.norm(
                    np.maximum(np.maximum(low - points_in_part, points_in_part - low - SIZE), 0.0),
                    axis=1,
                ).min(),
            )
        distances.append(best)
    return np.array(distances)


@pytest.mark.parametrize(("radius", "azimuth", "branch"), POSTS)
def test_links_that_met_a_post_keep_clear_of_it(dome, radius, azimuth, branch):
    """Links that touched a post keep clear of it with the key."""
    turn = np.radians(azimuth)
    low = np.array([radius * np.cos(turn), radius * np.sin(turn), 195.0]) - 0.5 * SIZE
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, box(low, SIZE, "post")))
    without = cells.resolve(CellParameters(**CELL, branch=DOWN), job.frame)
    motion, issues = planned(job, without)
    assert not has_errors(issues) and nearest(motion, without, low).min() < CLEARANCE
    cell_with_clearance = cells.resolve(
        CellParameters(**CELL, branch=branch, arm_clearance=CLEARANCE), job.frame
    )
    motion, issues = planned(job, cell_with_clearance)
    assert not has_errors(issues)
    assert nearest(motion, cell_with_clearance, low).min() >= CLEARANCE
    # and the deposit is the same, within limits
    tip, _ = cell_with_clearance.tip_in_part(
        KdlArm(cell_with_clearance.machine).forward(motion.joints[motion.deposit])
    )
    assert np.abs(tip - motion.position[motion.deposit]).max() < 1e-6
    assert not cell_with_clearance.limits.exceeded(motion.joints).any()


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
    cell_with_clearance = cells.resolve(
        CellParameters(**CELL, branch=branch, arm_clearance=CLEARANCE), job.frame
    )
    motion, issues = planned(job, cell_with_clearance, method)
    assert not has_errors(issues)
    assert nearest(motion, cell_with_clearance, low).min() >= CLEARANCE


def test_what_one_rotation_for_all_cannot_clear_is_named_with_what_may_help(dome):
    """An obstacle that no single rotation clears is reported with a possible remedy."""
    wall = box(np.array([-400.0, 75.0, -5.0]), np.array([800.0, 40.0, 900.0]), "back wall")
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, wall))
    cell = cells.resolve(CellParameters(**CELL, branch=DOWN, arm_clearance=60.0), job.frame)
    for method in ("constant", "point-by-point"):
        _, issues = planned(job, cell, method)
        errors = [issue for issue in issues if issue.code == "ARM_CLEARANCE"]
        assert any("back wall" in issue.message and issue.layer is not None for issue in errors)
        notes = [issue.message for issue in issues if issue.code == "RZ_CONSTANT"]
        assert len(notes) == (method == "constant") and all(
            "layer-by-layer" in note for note in notes
        )


def test_what_cannot_be_cleared_is_named(dome):
    """An obstacle that cannot be cleared is named."""
    wall = box(np.array([-400.0, 75.0, -5.0]), np.array([800.0, 40.0, 900.0]), "back wall")
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, wall))
    cell = cells.resolve(CellParameters(**CELL, branch=DOWN, arm_clearance=60.0), job.frame)
    _, issues = planned(job, cell)
    errors = [issue for issue in issues if issue.code == "ARM_CLEARANCE"]
    assert {issue.layer for issue in errors} == set(range(len(job.layers)))
    assert all(issue.message.startswith("link q") and "60 mm" in issue.message for issue in errors)
    assert any("back wall" in issue.message for issue in errors)


def beside_the_dome(dome, radius, azimuth):
    """The dome with a post next to it, and the post's lower corner."""
    turn = np.radians(azimuth)
    low = np.array([radius * np.cos(turn), radius * np.sin(turn), 195.0]) - 0.5 * SIZE
    return dataclasses.replace(dome, surroundings=(*dome.surroundings, box(low, SIZE, "post"))), low


def objectives(path, cell):
    """The objective of eq. 17 for each bead, computed here."""
    weights = 1.0 / (cell.limits.upper - cell.limits.lower)
    weights[~np.isfinite(weights)] = 0.0
    return np.array([(weights * np.diff(bead.joints, axis=0) ** 2).sum() for bead in path.beads])


def test_what_came_too_near_is_refined_again_up_to_the_clearance(dome, monkeypatch):
    """A post prevents the optimum of two layers, which fell back to 25 and 50 % of the way to it.
    With gaps among the constraints they reach two thirds and four fifths, and come as near to the
    post as allowed."""
    full_job, low = beside_the_dome(dome, 120.0, 180.0)
    job = dataclasses.replace(full_job, layers=full_job.layers[:3])
    cell = cells.resolve(CellParameters(**CELL, branch=UP, arm_clearance=CLEARANCE), job.frame)
    rods, parameters = external_links.robot_cylinders(cell.robot.chain), JointParameters(degree=3)
    taken_back = []

    def return_start(task, clearance, points, bead_places, start):
        taken_back.extend(bead_place for bead_place in bead_places)
        return clear_rotations.Refined(
            start, np.zeros(len(start)), ("",) * len(start), (0,) * len(start)
        )

    with monkeypatch.context() as patch:
        patch.setattr(clear_rotations, "refined_clear", return_start)
        back = objectives(plan_joints(job, cell, parameters, cylinders=rods), cell)
    free_cell = dataclasses.replace(cell, arm_clearance=None)
    free = objectives(plan_joints(job, free_cell, parameters, cylinders=rods), cell)
    path = plan_joints(job, cell, parameters, cylinders=rods)
    now = objectives(path, cell)
    assert taken_back == [(0, 0), (1, 0)] and not has_errors(path.issues)
    assert (free[:2] < 0.97 * back[:2]).all() and (now[2:] == back[2:]).all()
    won = (back[:2] - now[:2]) / (back[:2] - free[:2])
    assert (won > [0.64, 0.78]).all() and (won < 1.0).all(), won  # a wrong gap rate would give less
    for bead in path.beads[:2]:
        between = np.linspace(0.0, 1.0, 10)[:, None, None]
        dense = (bead.joints[:-1] + between * np.diff(bead.joints, axis=0)).reshape(-1, 6)
        distances = nearest_of(dense[::5], cell, low)
        # links are enlarged by 0.2 mm, points on them up to 8 mm apart, and bodies are touched by
        # edges of enlarged links
        assert CLEARANCE <= distances.min() < 1.5 * CLEARANCE


# a UR whose wrist bends onto its own forearm with the nozzle across, and one whose forearm touches
# its base, mm
ACROSS = {
    "setup": "tool-on-robot",
    "platform_diameter": 0.0,
    "nozzle": NozzleParameters(length=60.0, tool=(0.0, 0.0, 200.0, 0.0, np.radians(90.0), 0.0)),
}
SELF_CONTACTS = [("ur-ur5e", (470.0, 20.0, -80.0)), ("ur-ur10e", (590.0, -260.0, -180.0))]


def self_distance(motion, cell):
    """Least distance (mm) between forearm and last link, by PyKDL, at ten joint positions per
    move."""
    arm = KdlLinks(cell.machine)
    rods = external_links.robot_cylinders(cell.robot.chain)
    samples = [
        motion.joints[:-1] + share * np.diff(motion.joints, axis=0)
        for share in np.linspace(0.1, 1.0, 10)
    ]
    distance = np.inf
    for q in np.concatenate(samples)[::17]:
        clouds = []
        for number in (3, 6):
            link = arm.frame(q, number)
            clouds.append(on_rods(rods[number], 6.0) @ link[:3, :3].T + link[:3, 3])
        distance = min(distance, cKDTree(clouds[0]).query(clouds[1])[0].min())
    return distance


@pytest.mark.parametrize(("robot", "place"), SELF_CONTACTS)
@pytest.mark.always("ur-ur5e-place0")
def test_links_that_met_each_other_keep_apart(dome, robot, place):
    """Links that touched each other keep their distance with the key."""
    cell = {**ACROSS, "machine": robot, "deposition_point": (*place, 0.0, 0.0, 0.0)}
    without = cells.resolve(CellParameters(**cell), dome.frame)
    motion, issues = planned(dome, without)
    assert not has_errors(issues) and self_distance(motion, without) < CLEARANCE
    cell_with_clearance = cells.resolve(CellParameters(**cell, arm_clearance=CLEARANCE), dome.frame)
    motion, issues = planned(dome, cell_with_clearance)
    assert not has_errors(issues) and self_distance(motion, cell_with_clearance) >= CLEARANCE


def test_links_that_cannot_keep_apart_are_named_with_their_place(dome):
    """The forearm touches the base for every tool rotation; the message says so instead of
    describing another configuration."""
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
    """The same candidates remain whether beads are rejected by their ends or by all points."""
    wall = box(np.array([-140.0, -60.0, -5.0]), np.array([12.0, 120.0, 420.0]), "wall")
    job = dataclasses.replace(dome, surroundings=(*dome.surroundings, wall))
    cell = cells.resolve(CellParameters(**CELL, branch=DOWN, arm_clearance=CLEARANCE), job.frame)
    clearance = arm_clearance.build_arm_clearance(
        job, cell, external_links.robot_cylinders(cell.robot.chain)
    )
    beads, bead_places = [bead for _, _, bead in job], [(layer, index) for layer, index, _ in job]
    points = gather(beads, cell, clear_rotations.POINTS_PER_BEAD)
    margins, check_counts = [], []
    for branch in range(8):
        task = Task(cell, branch, JointParameters(), False, clearance)
        candidates = global_search.everywhere(task, points, task.thresholds(points))
        for ends in (clear_rotations.ENDS, clear_rotations.POINTS_PER_BEAD):
            monkeypatch.setattr(clear_rotations, "ENDS", ends)
            calls = []
            monkeypatch.setattr(arm_clearance.ArmKept, "rotations_near", counting(calls))
            margins.append(
                clear_rotations.exclude_touching(
                    task, clearance, points, bead_places, candidates
                ).margin
            )
            check_counts.append(sum(calls))
            monkeypatch.undo()
    assert all(
        np.array_equal(by_ends, by_points)
        for by_ends, by_points in zip(margins[::2], margins[1::2])
    )
    assert 0 < sum(check_counts[::2]) < 0.7 * sum(check_counts[1::2])


def counting(calls, original=arm_clearance.ArmKept.rotations_near):
    """A `rotations_near` that counts the joint vectors it receives."""

    def rotations_near(self, joints, bead, bead_places):
        calls.append(joints.shape[0] * joints.shape[1])
        return original(self, joints, bead, bead_places)

    return rotations_near


def test_pairs_of_links_are_found_once_for_the_same_robot_and_anew_for_another():
    """Pairs of links are computed once per robot, and again for a different one."""
    robot = cells.resolve(CellParameters(machine="ur-ur5e"), np.eye(4)).robot
    limits, rods = robot.limits("maker"), external_links.robot_cylinders(robot.chain)
    cached = OwnLinks.of(robot.chain, limits, rods, CLEARANCE)
    assert (
        OwnLinks.of(robot.chain, limits, external_links.robot_cylinders(robot.chain), CLEARANCE)
        is cached
    )
    second_robot = machine.load("ur-ur10e")
    thick = [[dataclasses.replace(rod, radius=4.0 * rod.radius) for rod in link] for link in rods]
    narrow = dataclasses.replace(
        limits, upper=np.append(limits.upper[:2], [*limits.lower[2:3] + 1e-3, *limits.upper[3:]])
    )
    for chain, among, links, clearance in [
        (second_robot.chain, limits, rods, CLEARANCE),
        (robot.chain, narrow, rods, CLEARANCE),
        (robot.chain, limits, thick, CLEARANCE),
        (robot.chain, limits, rods, 8.0 * CLEARANCE),
    ]:
        own_links = OwnLinks.of(chain, among, links, clearance)
        fresh = self_collision._find_pairs.__wrapped__(
            self_collision._Asked(chain, among, links, clearance)
        )  # not cached
        assert own_links is not cached and (own_links.gap, own_links.pairs) == (
            fresh.gap,
            fresh.pairs,
        )
    assert fresh.pairs != cached.pairs
