# SPDX-License-Identifier: LGPL-2.1-or-later
"""`cell.obstacles`: links, part and nozzle keep clear of obstacles in the cell. Checked by PyKDL's
link frames and the distance of points on links, part and nozzle from a box, at ten times as many
joint positions as rows."""

import dataclasses

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.geometry.obstacles import box
from freecad_am.core.issues import InputError, has_errors
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.links import external_links
from freecad_am.core.parameters.cell import CellParameters
from freecad_am.core.parameters.cell_records import OBSTACLES, Obstacle
from freecad_am.core.simulation import rapid_contacts
from freecad_am.kdl import KdlArm
from tests.core.planning.test_arm_clearance import (
    CELL,
    CLEARANCE,
    DOWN,
    SIZE,
    dome,
    on_rods,
    planned,
)
from tests.kdl_links import KdlLinks

__all__ = ["dome"]  # a fixture

CARRIED = {
    "limits": "paper",
    "platform": 150.0,
    "platform_diameter": 0.0,
    "deposition_point": (1045.0, -630.0, 653.0, 0.0, 0.0, 0.0),
}


def cell_with(dome, pose, name="post", size=SIZE, **values):
    cell = cells.resolve(CellParameters(**values), dome.frame)
    return dataclasses.replace(
        cell, shapes=cells.CellShapes(obstacles=(box(tuple(size), pose, name),))
    )


def nearest(motion, cell, pose, carried, size=SIZE, every=23):
    """Distances (n,) in mm between a box, given in the manufacturer's base frame, and the links by
    PyKDL, or points (k, 3) carried on the flange, at ten joint positions per row."""
    arm, distances = KdlLinks(cell.machine), []
    joints = motion.joints
    dense = np.concatenate(
        [joints[:-1] + share * np.diff(joints, axis=0) for share in np.linspace(0.1, 1.0, 10)]
    )
    links = [
        (k, on_rods(rods))
        for k, rods in enumerate(external_links.robot_cylinders(cell.robot.chain))
        if k and rods
    ]
    to_box = np.linalg.inv(cell.machine.base @ pose)
    half = 0.5 * np.asarray(size)
    for q in dense[::every]:
        best = np.inf
        for number, points in [*links, (None, carried)]:
            link_in_box = to_box @ arm.frame(q, number)
            points_in_box = points @ link_in_box[:3, :3].T + link_in_box[:3, 3]
            best = min(
                best, np.linalg.norm(np.maximum(np.abs(points_in_box) - half, 0.0), axis=1).min()
            )
        distances.append(best)
    return np.array(distances)


def nozzle_points(cell):
    """Points on the cone of a nozzle that the flange carries."""
    nozzle, turn = cell.nozzle, np.linspace(0.0, 2.0 * np.pi, 48)
    height = np.linspace(0.0, nozzle.length, 30)[:, None]
    radius = 0.5 * nozzle.diameter + height * np.tan(nozzle.half_angle)
    points = np.stack(
        [radius * np.cos(turn), radius * np.sin(turn), -height + 0.0 * turn], axis=-1
    ).reshape(-1, 3)
    return points @ cell.poses.carried[:3, :3].T + cell.poses.carried[:3, 3]


def part_points(dome, cell):
    """Points on all sides of the beads of a part that the flange carries, by half their width and
    height."""
    points = np.concatenate([bead.points for _, _, bead in dome])
    part_in_flange = cell.poses.carried @ np.linalg.inv(cell.poses.mount)
    around = [
        points + [0.5 * dome.layer_height * a, 0.5 * dome.layer_height * b, 0.0]
        for a in (-1, 1)
        for b in (-1, 1)
    ]
    return np.concatenate(around) @ part_in_flange[:3, :3].T + part_in_flange[:3, 3]


def test_links_keep_clear_of_an_obstacle_in_a_cell_that_is_turned(dome):
    """Part and post of a job that collides without the key, both rotated about the robot's first
    axis."""
    turned = frames.bryant((0.0, 0.0, 0.0, 0.0, 0.0, np.radians(40.0)))
    turn = np.radians(60.0)
    middle = frames.pose(
        np.eye(3), np.array([900.0 + 160.0 * np.cos(turn), 160.0 * np.sin(turn), 95.0])
    )
    pose = turned @ middle
    x, y, z = (turned @ frames.bryant(CELL["deposition_point"]))[:3, 3]
    values = {**CELL, "deposition_point": (x, y, z, 0.0, 0.0, np.radians(40.0)), "branch": DOWN}
    without = cell_with(dome, pose, **values)
    motion, issues = planned(dome, without)
    assert (
        not has_errors(issues)
        and nearest(motion, without, pose, nozzle_points(without)).min() < CLEARANCE
    )
    cell_with_clearance = cell_with(dome, pose, **values, arm_clearance=CLEARANCE)
    motion, issues = planned(dome, cell_with_clearance)
    assert not has_errors(issues)
    distances = nearest(
        motion,
        cell_with_clearance,
        pose,
        on_rods(external_links.robot_cylinders(cell_with_clearance.robot.chain)[-1]),
    )
    assert distances.min() >= CLEARANCE
    assert (
        nearest(motion, cell_with_clearance, pose, nozzle_points(cell_with_clearance)).min() > 0.0
    )


@pytest.mark.parametrize("azimuth", [0.0, 330.0])
@pytest.mark.always("0.0")
def test_a_part_that_the_robot_carries_keeps_clear_of_an_obstacle(dome, azimuth):
    """A part that the robot carries keeps clear of an obstacle."""
    turn = np.radians(azimuth)
    pose = frames.pose(
        np.eye(3), np.array([1045.0 + 100.0 * np.cos(turn), -630.0 + 100.0 * np.sin(turn), 900.0])
    )
    without = cell_with(dome, pose, **CARRIED)
    points = part_points(dome, without)
    motion, issues = planned(dome, without)
    assert not has_errors(issues) and nearest(motion, without, pose, points).min() < CLEARANCE
    cell_with_clearance = cell_with(dome, pose, **CARRIED, arm_clearance=CLEARANCE)
    motion, issues = planned(dome, cell_with_clearance)
    assert not has_errors(issues)
    assert nearest(motion, cell_with_clearance, pose, points).min() >= CLEARANCE


def test_rapids_of_a_carried_nozzle_go_over_an_obstacle_that_links_are_not_kept_clear_of(dome):
    """Between beads that start on opposite sides of a low bar the direct travel would take the
    nozzle through it."""
    ring = dome.layers[0].beads[0]
    half = len(ring) // 2
    ends = [
        dataclasses.replace(
            ring,
            **{
                name: getattr(ring, name)[selection]
                for name in ("points", "build", "tool", "parameter", "speed")
            },
            tangents=None,
            closed=False,
        )
        for selection in (slice(0, 4), slice(half, half + 4))
    ]
    job = dataclasses.replace(
        dome, layers=(dataclasses.replace(dome.layers[0], beads=tuple(ends)),)
    )
    size = (20.0, 60.0, 60.0)
    pose = frames.pose(np.eye(3), np.array([1000.0, 0.0, -60.0]))
    values = {**CELL, "branch": DOWN}
    for obstacles_, low in (
        ((), 0.0),
        (cell_with(dome, pose, size=size, **values).shapes.obstacles, 1e-3),
    ):
        cell = dataclasses.replace(
            cells.resolve(CellParameters(**values), dome.frame),
            shapes=cells.CellShapes(obstacles=obstacles_),
        )
        motion, issues = planned(job, cell)
        assert not has_errors(issues)
        distance = nearest(motion, cell, pose, nozzle_points(cell)[48:], size, every=1).min()
        assert distance == 0.0 if not obstacles_ else distance > low
        # the check of rapids, independent of planning, reports it for the cell with the bar
        cell_with_bar = cell_with(dome, pose, size=size, **values)
        contacts = rapid_contacts.looked_at(motion, ends, cell_with_bar, (), 0.0, 0.0, 50_000)
        assert (len(contacts.rows) == 0) == bool(obstacles_)
        without = dataclasses.replace(cell_with_bar, shapes=cells.CellShapes())
        assert not len(rapid_contacts.looked_at(motion, ends, without, (), 0.0, 0.0, 50_000).rows)


def test_a_floor_is_a_box_that_the_elbow_stays_above(dome):
    """A plan with the elbow down passes through the floor below the robot; the lowest points of
    links by PyKDL."""
    foot = np.linalg.inv(cells.resolve(CellParameters(**CELL), dome.frame).machine.base)[2, 3]
    size = (5000.0, 5000.0, 100.0)
    pose = frames.pose(np.eye(3), np.array([0.0, 0.0, foot - 0.5 * size[2]]))
    lowest = []
    for options in ({"branch": DOWN}, {"branch": "auto", "arm_clearance": CLEARANCE}):
        cell = cell_with(dome, pose, "floor", size, **CELL, **options)
        motion, issues = planned(dome, cell)
        assert not has_errors(issues)
        arm, above = KdlLinks(cell.machine), np.inf
        links = [
            (k, on_rods(rods))
            for k, rods in enumerate(external_links.robot_cylinders(cell.robot.chain))
            if k and rods
        ]
        joints, shares = motion.joints, np.linspace(0.1, 1.0, 10)
        dense = np.concatenate([joints[:-1] + share * np.diff(joints, axis=0) for share in shares])
        for q in dense[::23]:
            for number, points in links:
                link_pose = arm.frame(q, number)
                above = min(above, (points @ link_pose[2, :3] + link_pose[2, 3]).min())
        lowest.append(above)
    assert lowest[0] < 0.0 and lowest[1] >= CLEARANCE


def test_an_impossible_one_is_refused_by_name(dome):
    """An obstacle that cannot be cleared is rejected by name."""
    pose = frames.pose(np.eye(3), np.array([450.0, 0.0, 0.0]))
    cell = cell_with(
        dome, pose, "screen", (40.0, 3000.0, 3000.0), **CELL, branch=DOWN, arm_clearance=CLEARANCE
    )
    _, issues = planned(dome, cell)
    errors = [issue for issue in issues if issue.code == "ARM_CLEARANCE"]
    assert {issue.layer for issue in errors} == set(range(len(dome.layers)))
    assert all(
        issue.message.startswith("link q") and "10 mm to screen" in issue.message
        for issue in errors
    )


def test_texts_of_obstacles_say_what_they_are():
    text = "table = /a b/table.step at 0 0 -200 0 0 90; box 60 60 400 at 900, 200, 0, 0, 0, 0; post.stl at 1 2 3 0 0 0"
    table, beam, post = obstacles_ = OBSTACLES.read(text)
    assert (table.name, table.file, table.pose) == (
        "table",
        "/a b/table.step",
        (0, 0, -200, 0, 0, np.radians(90.0)),
    )
    assert (beam.name, beam.file, beam.box) == ("box 2", "", (60.0, 60.0, 400.0))
    assert (post.name, post.file) == ("post", "post.stl")
    assert (
        OBSTACLES.read("; ".join(map(str, obstacles_))) == obstacles_
        and OBSTACLES.read("none") == OBSTACLES.read("") == ()
    )


@pytest.mark.parametrize(("text", "told"), [
    ("table.step", "'table.step' is not an obstacle; write, for example: "),
    ("table.step at 0 0 0", "'0 0 0' are not 6 numbers"),
    ("table.step at 0 0 zero 0 0 0", "are not 6 numbers"),
    ("box 1 2 at 0 0 0 0 0 0", "'1 2' are not 3 numbers"),
    ("box 1 2 0 at 0 0 0 0 0 0", "1 2 0 mm is not a box"),
    ("a.stl at 0 0 0 0 0 0; b/a.stl at 0 0 0 0 0 0", "2 obstacles are called 'a'"),
])  # fmt: skip
def test_texts_that_say_nothing_are_refused(text, told):
    with pytest.raises(InputError, match=r"cell\.obstacles") as error:
        OBSTACLES.read(text)
    assert told in error.value.message
    with pytest.raises(InputError):
        CellParameters(obstacles=text)


def test_an_obstacle_is_a_file_or_a_box():
    for options in ({}, {"file": "a.step", "box": (1.0, 1.0, 1.0)}):
        with pytest.raises(InputError, match="either a file or a box"):
            Obstacle("a", (0.0,) * 6, **options)


def row_of_beads(dome):
    """Two straight beads, one above the other, 240 mm long, with a few points each."""
    bead = dome.layers[0].beads[0]
    x = np.linspace(-120.0, 120.0, 5)
    beads = []
    for high in (0.0, 15.0):
        points = np.column_stack([x, 0.0 * x, high + 0.0 * x])
        up = np.tile([0.0, 0.0, 1.0], (5, 1))
        beads.append(
            dataclasses.replace(
                bead,
                points=points,
                build=up,
                tool=up,
                parameter=np.linspace(0.0, 6.0, 5),
                speed=np.full(5, 8.0),
                tangents=None,
                closed=False,
            )
        )
    layers = tuple(dataclasses.replace(dome.layers[0], beads=(row,)) for row in beads)
    return dataclasses.replace(dome, layers=layers, family="surface")


@pytest.mark.parametrize("aside", [0.0, 45.0])
@pytest.mark.parametrize("clearance", [None, CLEARANCE])
@pytest.mark.always
def test_a_nozzle_that_runs_into_an_obstacle_within_a_bead_is_refused(dome, aside, clearance):
    """A contact between two points of a bead, far from its ends, is detected with and without link
    clearance."""
    job = row_of_beads(dome)
    pose = frames.pose(np.eye(3), np.array([900.0 + 30.0, 20.0 + aside, -60.0]))
    cell = cell_with(job, pose, size=(8.0, 20.0, 30.0), **{**CELL, "branch": DOWN})
    free = dataclasses.replace(cell, arm_clearance=clearance)
    motion, issues = planned(job, free)
    deposit_rows = np.flatnonzero(motion.deposit[1:] & motion.deposit[:-1]) + 1
    dense = np.concatenate(
        [
            motion.joints[deposit_rows - 1]
            + share * (motion.joints[deposit_rows] - motion.joints[deposit_rows - 1])
            for share in np.linspace(0.0, 1.0, 60)
        ]
    )
    arm, to_box = KdlArm(cell.machine), np.linalg.inv(cell.machine.base @ pose)
    cone = np.c_[nozzle_points(cell), np.ones(len(nozzle_points(cell)))]
    cone_in_box = np.einsum("nij,kj->nki", (to_box @ arm.forward(dense))[:, :3], cone)
    deep = (np.abs(cone_in_box) < [4.0, 10.0, 15.0]).all(axis=2).any()
    error_codes = {issue.code for issue in issues if issue.level == "error"}
    assert deep == (aside == 0.0)
    assert ("CLEARANCE" in error_codes) == deep
    (issue_found,) = [issue for issue in issues if issue.code == "CLEARANCE"] or [None]
    assert issue_found is None or (
        "the nozzle touches post on " in issue_found.message and issue_found.layer in (0, 1)
    )
