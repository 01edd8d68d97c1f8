# SPDX-License-Identifier: LGPL-2.1-or-later
"""Flange poses from points of the part and back; the rotation about the tool axis and the paper's
RZ."""

import json

import numpy as np
import pytest

from freecad_am.core.geometry import frames
from freecad_am.core.issues import InputError
from freecad_am.core.kinematics import cell as cells
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.parameters.cell import CellParameters, NozzleParameters

SETUPS = ("part-on-robot", "tool-on-robot")


def directions(rng, n):
    vectors = rng.normal(size=(n, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def random_cell(rng, setup, mount="feature"):
    def six(size):
        return tuple(np.r_[rng.uniform(-size, size, 3), rng.uniform(-3, 3, 3)])

    parameters = CellParameters(
        setup=setup,
        deposition_point=six(1500.0),
        platform=six(50.0),
        nozzle=NozzleParameters(tool=six(300.0)),
        mount=mount,
    )
    return cells.resolve(parameters, frames.bryant(six(400.0)))


@pytest.mark.parametrize("setup", SETUPS)
@pytest.mark.parametrize("mount", ["feature", "part"])
def test_the_tip_stands_on_the_point_along_the_tool_axis_for_every_rotation(setup, mount):
    rng = np.random.default_rng(1)
    for _ in range(5):
        cell = random_cell(rng, setup, mount)
        position, tool, phi = (
            rng.uniform(-200, 200, (50, 3)),
            directions(rng, 50),
            rng.uniform(-9, 9, 50),
        )
        flange = cell.flange_poses(position, tool, phi)
        assert (
            np.abs(flange[:, :3, :3] @ np.swapaxes(flange[:, :3, :3], 1, 2) - np.eye(3)).max()
            < 1e-12
        )
        tip, axis = cell.tip_in_part(flange)
        assert np.abs(tip - position).max() < 1e-9
        assert np.abs(axis - tool).max() < 1e-12


@pytest.mark.parametrize("setup", SETUPS)
def test_the_tip_alone_is_where_the_closed_form_takes_it(setup):
    """The tip position agrees with the closed form."""
    rng = np.random.default_rng(6)
    cell = random_cell(rng, setup)
    position, tool, phi = (
        rng.uniform(-300, 300, (3000, 3)),
        directions(rng, 3000),
        rng.uniform(-9, 9, 3000),
    )
    joints = cell.machine.arm.inverse(cell.flange_poses(position, tool, phi))
    reached = np.isfinite(joints).all(axis=2)
    assert np.count_nonzero(reached) > 1000
    points = np.broadcast_to(position, (len(joints), *position.shape))[reached]
    assert np.abs(cell.tip_at(joints[reached]) - points).max() < 1e-7
    block = joints[reached][:6]
    assert np.array_equal(cell.tip_at(block.reshape(2, 3, 6)).reshape(6, 3), cell.tip_at(block))


@pytest.mark.parametrize("machine", ["table-xyzac", "head-xyzab"])
def test_the_tip_alone_of_machines_with_sliding_axes(machine):
    rng = np.random.default_rng(7)
    cell = cells.resolve(
        CellParameters(machine=machine, setup="rotary-table"),
        frames.bryant((10, 20, 30, 0.1, 0.2, 0.3)),
    )
    axes = rng.uniform(-3.0, 3.0, (50, 5)) * np.where(cell.machine.chain.sliding, 100.0, 1.0)
    assert (
        np.abs(cell.tip_at(axes) - cell.tip_in_part(cell.machine.chain.forward(axes))[0]).max()
        < 1e-10
    )


@pytest.mark.parametrize("setup", SETUPS)
def test_the_spin_turns_the_flange_about_the_deposition_point(setup):
    """The tool rotation rotates the flange about the deposition point."""
    rng = np.random.default_rng(2)
    cell = random_cell(rng, setup)
    position, tool, phi = (
        rng.uniform(-200, 200, (50, 3)),
        directions(rng, 50),
        rng.uniform(-3, 3, 50),
    )
    step = 1e-6
    earlier, later = (cell.flange_poses(position, tool, phi + d) for d in (-step, step))
    middle = cell.flange_poses(position, tool, phi)
    change = (
        (later[:, :3, :3] - earlier[:, :3, :3]) / (2 * step) @ np.swapaxes(middle[:, :3, :3], 1, 2)
    )
    turning = np.stack([change[:, 2, 1], change[:, 0, 2], change[:, 1, 0]], axis=1)
    spin, point = cell.rotation_axis(middle), cell.deposition_point(middle)
    assert np.abs(turning - spin).max() < 1e-8
    velocity = (later[:, :3, 3] - earlier[:, :3, 3]) / (2 * step)
    assert np.abs(velocity - np.cross(spin, middle[:, :3, 3] - point)).max() < 1e-5


def test_rz_is_the_last_bryant_angle_of_the_rotation_that_takes_the_build_direction_to_z():
    """Chalvin 2020, eqs. 9 to 11, written independently: b = [0 0 1] Rx Ry Rz in row form."""
    rng = np.random.default_rng(3)
    cell = cells.resolve(CellParameters(limits="paper"), np.eye(4))
    tool, rz = directions(rng, 200), rng.uniform(-np.pi, np.pi, 200)
    phi, _ = cell.poses.phi_of_rz(tool, rz)
    part_to_robot = frames.about_z(phi) @ frames.smallest_rotation(tool, (0.0, 0.0, 1.0))
    assert np.abs(np.einsum("nij,nj->ni", part_to_robot, tool) - [0, 0, 1]).max() < 1e-12
    back = frames.to_bryant(part_to_robot)
    rebuilt = frames.about_x(back[:, 0]) @ frames.about_y(back[:, 1]) @ frames.about_z(back[:, 2])
    assert np.abs(rebuilt - part_to_robot).max() < 1e-12
    up = tool[:, 2] > 0.0
    assert np.abs(np.exp(1j * back[up, 2]) - np.exp(1j * rz[up])).max() < 1e-9
    assert np.abs(np.exp(1j * cell.poses.rz_of_phi(tool, phi)) - np.exp(1j * rz)).max() < 1e-9


def test_the_rate_of_the_rotation_by_rz():
    rng = np.random.default_rng(4)
    cell = cells.resolve(CellParameters(limits="paper"), np.eye(4))
    tool, rz, step = directions(rng, 200), rng.uniform(-3, 3, 200), 1e-6
    _, rate = cell.poses.phi_of_rz(tool, rz)
    later, earlier = (
        cell.poses.phi_of_rz(tool, rz + step)[0],
        cell.poses.phi_of_rz(tool, rz - step)[0],
    )
    measured = np.angle(np.exp(1j * (later - earlier))) / (2 * step)
    assert np.abs(measured / rate - 1.0).max() < 1e-5


def test_rz_degenerates_where_the_build_direction_is_nearly_horizontal():
    """ERRATA: at 85 deg tilt |d phi / d RZ| ranges from 0.09 to 11."""
    cell = cells.resolve(CellParameters(limits="paper"), np.eye(4))
    tool = np.repeat([[np.sin(np.radians(85.0)), 0.0, np.cos(np.radians(85.0))]], 3600, axis=0)
    _, rate = cell.poses.phi_of_rz(tool, np.linspace(-np.pi, np.pi, 3600))
    assert np.abs(rate).min() == pytest.approx(0.0872, abs=1e-3)
    assert np.abs(rate).max() == pytest.approx(11.47, abs=0.1)


@pytest.mark.parametrize(
    ("parameters", "code"),
    [
        ({"setup": "tool-on-robot+positioner"}, "NOT_YET"),
        ({"setup": "rotary-table"}, "WRONG_SETUP"),
        ({"machine": "fanuc-arcmate120id"}, "UNKNOWN_MACHINE"),
        ({"limits": "pape"}, "UNKNOWN_LIMITS"),
    ],
)
def test_what_cannot_be_resolved_is_refused(parameters, code):
    with pytest.raises(InputError) as error:
        cells.resolve(CellParameters(**parameters), np.eye(4))
    assert error.value.code == code


@pytest.mark.parametrize("setup", [*SETUPS, "rotary-table"])
def test_a_machine_file_of_a_robot_with_its_track_is_refused_whatever_the_setup(setup, tmp_path):
    """Such a file was once taken for a five-axis machine, or caused an internal error."""
    description = json.loads((machine.BUILT_IN / "kuka-kr16-2.json").read_text(encoding="utf-8"))
    description["joints"].insert(
        0,
        {
            "name": "rail",
            "type": "prismatic",
            "origin": [0, 0, 0],
            "rpy": [0, 0, 0],
            "axis": [1, 0, 0],
            "max_speed": 1000,
        },
    )
    description["controller"] |= {"matrix": np.eye(7).tolist(), "offset": [0] * 7}
    description["limits"]["maker"]["axes"].insert(0, [-1000, 1000])
    for pose in description["check_poses"]:
        along = 100 if any(pose["q"]) else 0
        pose["q"].insert(0, along)
        pose["origin"][0] += along
    del description["opw"], description["id"]
    path = tmp_path / "rail.json"
    path.write_text(json.dumps({"id": "rail", **description}), encoding="utf-8")
    with pytest.raises(InputError) as info:
        cells.resolve(CellParameters(machine=str(path), setup=setup), np.eye(4))
    if setup == "rotary-table":
        assert (info.value.code, info.value.where) == ("WRONG_SETUP", "cell.setup")
        assert "is a robot; use part-on-robot or tool-on-robot" in info.value.message
    else:
        assert (info.value.code, info.value.where) == ("NO_CLOSED_FORM", "cell.machine")
        assert "like a track" in info.value.message and "`cell.external`" in info.value.message
