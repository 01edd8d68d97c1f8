# SPDX-License-Identifier: LGPL-2.1-or-later
"""Calibrations of single robots as written by ROS' ur_calibration, against PyKDL on the poses of
the file."""

import numpy as np
import pytest
import yaml

from freecad_am.core.issues import InputError
from freecad_am.core.kinematics.jacobian import condition, jacobian
from freecad_am.core.kinematics.machines import machine

kdl = pytest.importorskip("PyKDL")

# fictitious; angles near pi are how the tool writes almost no rotation
FILE = """\
# made by ur_calibration
kinematics:
  shoulder:
    x: 0
    y: 0
    z: 0.1809123
    roll: -0
    pitch: 0
    yaw: 2.31e-05
  upper_arm:
    x: 0.000141
    y: 0
    z: 0
    roll: 1.5713123
    pitch: 0
    yaw: -1.7e-06
  forearm:
    x: -0.6131245
    y: 0
    z: 0
    roll: 0.0021345
    pitch: -0.0009123
    yaw: 3.1e-06
  wrist_1:
    x: -0.5718871
    y: -0.0006122
    z: 0.1746
    roll: 3.1385
    pitch: -3.1401
    yaw: 3.14151
  wrist_2:
    x: -2.1e-05
    y: -0.1199876
    z: 0.000113
    roll: 1.5699
    pitch: 0
    yaw: -4.2e-06
  wrist_3:
    x: 3.3e-05
    y: 0.1164321
    z: -0.000087
    roll: 1.5717211
    pitch: 3.141592653589793
    yaw: 3.1415911
  hash: calib_123456789
"""


@pytest.fixture(scope="module")
def calibration(tmp_path_factory):
    path = tmp_path_factory.mktemp("ur") / "my robot.yaml"
    path.write_text(FILE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def robot(calibration):
    return machine.load(f"ur-ur10e calibration={calibration}")


def _by_kdl(text, q):
    """(n, 4, 4) mm, tool0 in base_link, after UR's own URDF: base_link_inertia is base_link rotated
    by pi."""
    chain = kdl.Chain()
    chain.addSegment(kdl.Segment(kdl.Joint(), kdl.Frame(kdl.Rotation.RPY(0, 0, np.pi))))
    for name in ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3"):
        joint_values = yaml.safe_load(text)["kinematics"][name]
        turned = kdl.Rotation.RPY(*(float(joint_values[key]) for key in ("roll", "pitch", "yaw")))
        chain.addSegment(
            kdl.Segment(
                kdl.Joint(),
                kdl.Frame(turned, kdl.Vector(*(float(joint_values[key]) for key in "xyz"))),
            )
        )
        chain.addSegment(kdl.Segment(kdl.Joint(name, kdl.Joint.RotZ)))
    solver, frame, angles = kdl.ChainFkSolverPos_recursive(chain), kdl.Frame(), kdl.JntArray(6)
    result = np.tile(np.eye(4), (len(q), 1, 1))
    for row, pose in zip(q, result, strict=True):
        for joint in range(6):
            angles[joint] = row[joint]
        solver.JntToCart(angles, frame)
        pose[:3, 3] = [1000.0 * frame.p[k] for k in range(3)]
        pose[:3, :3] = [[frame.M[i, k] for k in range(3)] for i in range(3)]
    return result


def test_poses_are_those_of_the_calibrated_robot(robot):
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (200, 6))
    expected = _by_kdl(FILE, q)
    off = np.abs(robot.chain.forward(q) - expected)
    assert off[:, :3, 3].max() < 1e-9 and off[:, :3, :3].max() < 1e-12
    nominal = np.linalg.norm(
        (machine.load("ur-ur10e").chain.forward(q) - expected)[:, :3, 3], axis=1
    )
    assert 1.0 < nominal.max() < 10.0
    assert "my robot.yaml (calib_123456789)" in robot.sources


def test_every_solution_gives_its_pose_and_none_is_lost_where_the_arm_can_move(robot):
    """Every solution gives its pose, and none is missing where the arm can move."""
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (1000, 6))
    poses = _by_kdl(FILE, q)
    solutions = robot.arm.inverse(poses)
    reached = np.isfinite(solutions).all(axis=2)
    assert (reached == np.isfinite(solutions).any(axis=2)).all() and np.nanmax(
        np.abs(solutions)
    ) <= np.pi + 1e-12
    for words in range(8):
        mask = reached[words]
        assert (robot.arm.branch_of(solutions[words, mask]) == words).all()
        off = np.abs(_by_kdl(FILE, solutions[words, mask][:100]) - poses[mask][:100])
        assert off[:, :3, 3].max() < 1e-6 and off[:, :3, :3].max() < 1e-9
    assert np.array_equal(robot.arm.inverse_branch(poses, 5), solutions[5], equal_nan=True)
    own_solutions = solutions[robot.arm.branch_of(q), np.arange(len(q))]
    movable = condition(jacobian(robot.chain, q, poses[:, :3, 3]), 1000.0) > 0.01
    assert movable.sum() > 700
    assert np.abs(np.exp(1j * own_solutions) - np.exp(1j * q))[movable].max() < 1e-6
    several = machine.load("ur-ur10e").arm.inverse(poses)
    assert reached.sum() > 0.99 * np.isfinite(several[..., 0]).sum()


@pytest.mark.parametrize(
    ("old", "new", "where", "says"),
    [
        ("kinematics:", "kinematik:", "kinematics.shoulder.x", "the key is missing"),
        ("    roll: 0.0021345\n", "", "kinematics.forearm.roll", "the key is missing"),
        ("x: -0.6131245", "x: 0.6 m", "kinematics.forearm.x", "'0.6 m' is not a number"),
        ("x: -0.6131245", "x: nan", "kinematics.forearm.x", "'nan' is not a number"),
        ("x: -0.6131245", "x -0.6131245", "line 18", "is not `key: value`"),
        (
            "x: -0.6131245",
            "x: -0.6131245\n    x: 1",
            "line 19",
            "the key kinematics.forearm.x is duplicated",
        ),
        ("x: -0.6131245", "x: -0.425", "kinematics.forearm", "the calibrated joint is 188 mm and"),
        ("x: -0.6131245", "x: -613.1", "kinematics.forearm", "choose the calibrated machine"),
        (
            "roll: 1.5713123",
            "roll: 90.02",
            "kinematics.upper_arm",
            "deg from the joint in the machine file",
        ),
    ],
)
def test_a_broken_calibration_is_refused_with_its_place(tmp_path, old, new, where, says):
    path = tmp_path / "broken.yaml"
    assert old in FILE
    path.write_text(FILE.replace(old, new), encoding="utf-8")
    with pytest.raises(InputError) as caught:
        machine.load(f"ur-ur10e calibration={path}")
    assert caught.value.code == "BAD_CALIBRATION"
    assert caught.value.where == f"{path}: {where}" and says in caught.value.message


def test_what_takes_no_calibration_says_so(calibration, tmp_path):
    for name, code, says in (
        (
            f"fanuc-arcmate120ic calibration={calibration}",
            "BAD_CALIBRATION",
            "only Universal Robots arms have a calibration, not",
        ),
        (f"ur-ur5e calibration={calibration}", "BAD_CALIBRATION", "choose the calibrated machine"),
        (
            f"ur-ur10e calibration={tmp_path / 'none.yaml'}",
            "UNKNOWN_MACHINE",
            "the calibration",
        ),
        (f"ur-ur11 calibration={calibration}", "UNKNOWN_MACHINE", "did you mean"),
    ):
        with pytest.raises(InputError) as caught:
            machine.load(name)
        assert caught.value.code == code and says in caught.value.message
    (tmp_path / "image.yaml").write_bytes(b"\xff\xd8\xff\x00")
    with pytest.raises(InputError, match="cannot be read as a calibration"):
        machine.load(f"ur-ur10e calibration={tmp_path / 'image.yaml'}")
