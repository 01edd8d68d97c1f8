# SPDX-License-Identifier: LGPL-2.1-or-later
"""The proposed position of a robot works, checked by its chain on poses other than the tested
ones."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.cell import resolve
from freecad_am.core.kinematics.inverse import spherical_wrist
from freecad_am.core.kinematics.links import robot as robot_links
from freecad_am.core.kinematics.machines import machine as machines
from freecad_am.core.kinematics.proposed_cell import BALL, cell_of, proposed, search_cell
from freecad_am.core.parameters.cell import CellParameters
from tests.core.kinematics.arms import EXAMPLES

ROBOTS = [name for name in EXAMPLES if machines.load(name).opw is not None]
OF_EACH_MAKER = {name.partition("-")[0]: name for name in ROBOTS}.values()


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.always(*OF_EACH_MAKER)
def test_every_robot_holds_a_dome_there_within_its_limits(name):
    """For any point of the dome and any lean some rotation is feasible, by the chain's poses and
    the limits of the file."""
    parameters = proposed(CellParameters(machine=name))
    assert cell_of(name) == parameters
    cell = resolve(parameters, np.eye(4))
    random = np.random.default_rng(1)
    tilt, round_about = np.radians(random.uniform(0, 85, 60)), random.uniform(-np.pi, np.pi, 60)
    axes = np.column_stack(
        [np.sin(tilt) * np.cos(round_about), np.sin(tilt) * np.sin(round_about), np.cos(tilt)]
    )
    phi = np.linspace(-np.pi, np.pi, 91)[:, None]
    poses = (
        cell.pose_frames(BALL * axes, axes)
        .flange_poses(np.broadcast_to(phi, (91, 60)))
        .reshape(-1, 4, 4)
    )
    joints = cell.machine.opw.inverse_branch(poses, cell.branch)
    good = np.isfinite(joints).all(axis=1)
    assert np.abs(cell.machine.chain.forward(joints[good]) - poses[good]).max() < 1e-6
    within = (cell.limits.margin(joints)[:, :5] > 0.0).all(axis=1) & good
    assert within.reshape(91, 60).any(axis=0).all()
    assert parameters.branch == spherical_wrist.branch_name(cell.branch)


@pytest.mark.always(*OF_EACH_MAKER)
@pytest.mark.parametrize("name", ROBOTS)
def test_every_robot_deposits_round_a_dome_on_the_platform_that_is_proposed(name):
    """With a torch at 45 deg the robot reaches a dome of 50 mm from all sides, leaning by up to 28
    deg."""
    tool = (80.0, 0.0, 250.0, 0.0, np.radians(45.0), 0.0)
    parameters = cell_of(name, setup="tool-on-robot", tool=tool)
    assert (
        parameters.setup == "tool-on-robot"
        and parameters.nozzle.tool == tool
        and parameters.deposition_point[2] >= 0.0
    )
    cell = resolve(parameters, np.eye(4))
    random = np.random.default_rng(2)
    tilt, round_about = np.radians(random.uniform(0, 28, 40)), random.uniform(-np.pi, np.pi, 40)
    axes = np.column_stack(
        [np.sin(tilt) * np.cos(round_about), np.sin(tilt) * np.sin(round_about), np.cos(tilt)]
    )
    phi = np.linspace(-np.pi, np.pi, 73)[:, None]
    poses = (
        cell.pose_frames(BALL * axes, axes)
        .flange_poses(np.broadcast_to(phi, (73, 40)))
        .reshape(-1, 4, 4)
    )
    joints = cell.machine.opw.inverse_branch(poses, cell.branch)
    good = np.isfinite(joints).all(axis=1)
    tips = cell.machine.chain.forward(joints[good]) @ frames.bryant(tool)
    placed = (
        np.broadcast_to(BALL * axes, (73, 40, 3)).reshape(-1, 3)[good]
        + parameters.deposition_point[:3]
    )
    assert (
        np.abs(
            tips[:, :3, 3] - (placed @ cell.machine.base[:3, :3].T + cell.machine.base[:3, 3])
        ).max()
        < 1e-6
    )
    within = (cell.limits.margin(joints) > 0.0).all(axis=1) & good
    assert within.reshape(73, 40).any(axis=0).all()


def test_what_is_no_robot_stays_as_it_is():
    parameters = CellParameters(machine="table-xyzac", setup="rotary-table")
    assert proposed(parameters) == parameters


def test_machines_with_rotary_axes_get_their_set_up_and_none_given_is_the_default():
    assert cell_of("table-xyzac") == CellParameters(machine="table-xyzac", setup="rotary-table")
    assert cell_of("") == proposed(CellParameters())


def test_what_is_kept_for_the_usual_cell_is_what_is_found():
    assert proposed(CellParameters()) == search_cell(CellParameters())


def test_a_branch_of_ones_own_is_kept():
    """A configuration chosen by the user is kept."""
    custom = CellParameters(branch=("front", "up", "flip"))
    assert proposed(custom, own_branch=True).branch == custom.branch
    assert proposed(custom, own_branch=True).deposition_point != proposed(custom).deposition_point


def inside_hulls(points, hulls):
    """Whether points (n, 3) are within one of the hulls, by the planes of its facets."""
    return np.any(
        [(points @ planes[:, :3].T + planes[:, 3] <= 0.0).all(axis=1) for planes in hulls], axis=0
    )


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.always(*OF_EACH_MAKER)
def test_links_as_drawn_need_not_touch_the_platform_that_is_carried(name):
    """Points on a platform 10 mm larger on all sides, and hulls of the drawn links: at any lean a
    rotation within the limits keeps all points outside. At the papers' point an upright tool has no
    such rotation with the default robot."""
    parameters = proposed(CellParameters(machine=name))
    assert all(clear_rotations(parameters, tilt).any() for tilt in np.radians([0.0, 45.0, 85.0]))
    if name == CellParameters().machine:
        assert not clear_rotations(CellParameters(), 0.0).any()


def clear_rotations(parameters, tilt):
    """Whether rotations (k,) keep an axis leaning by `tilt` within the limits and the platform out
    of links 0 to 4."""
    cell = resolve(parameters, np.eye(4))
    chain = cell.machine.chain
    hulls = [
        [ConvexHull(solid.points).equations for solid in link] for link in robot_links.solids(chain)
    ]
    axis = np.array([[np.sin(tilt), 0.0, np.cos(tilt)]])
    poses = cell.pose_frames(BALL * axis, axis).flange_poses(
        np.linspace(-np.pi, np.pi, 16)[:, None]
    )[:, 0]
    joints = cell.machine.opw.inverse_branch(poses, cell.branch)
    good = np.isfinite(joints).all(axis=1)
    good[good] &= (cell.limits.margin(joints[good])[:, :5] > 0.0).all(axis=1)
    radius, angle = np.meshgrid(
        np.linspace(0.0, 0.5 * cell.platform_diameter + 10.0, 5), np.linspace(0.0, 2 * np.pi, 24)
    )
    disc = np.stack(
        [radius * np.cos(angle), radius * np.sin(angle), 0.0 * radius, 0.0 * radius + 1.0], axis=-1
    )
    disc = disc.reshape(-1, 4)
    for k in np.flatnonzero(good):
        links = chain.links(joints[k])
        platform = disc @ (links[-1] @ chain.flange @ cell.poses.carried).T
        platform_in_links = [
            (platform @ frames.inverse(links[number]).T)[:, :3] for number in range(5)
        ]
        good[k] = not any(
            hulls[number] and inside_hulls(platform_in_links[number], hulls[number]).any()
            for number in range(5)
        )
    return good
