# SPDX-License-Identifier: LGPL-2.1-or-later
"""Joint trajectories against the timeline, scipy's Hermite spline, and a reader of ROS messages."""

import dataclasses
import json
import subprocess
import sys

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.simulation.joint_trajectory import joint_trajectory, trajectory_text
from freecad_am.core.simulation.timeline import timeline
from tests.posts import interpreters

NAMES = ("rail", "j1", "j2", "j3", "j4", "j5")
IS_PRISMATIC = (True, False, False, False, False, False)
PROCESS = ProcessParameters(lead_on=0.4, lead_off=0.3)
SCALE = np.where(IS_PRISMATIC, 1e-3, 1.0)


@pytest.fixture
def times(a_motion):
    """A motion with lead times at both ends of each bead and a wait between layers."""
    return timeline(a_motion(5), PROCESS, [0.0, 3.0, 2.0, 1.0])


def test_positions_follow_the_timeline(times):
    trajectory = joint_trajectory(times, NAMES, IS_PRISMATIC)
    assert (np.diff(trajectory.time) > 0).all()
    assert trajectory.time[0] == 0
    assert trajectory.time[-1] == pytest.approx(times.total * 1e9, abs=1.0)
    state = times.state_at(trajectory.time * 1e-9)
    np.testing.assert_allclose(trajectory.position, state.joints * SCALE, atol=1e-7)
    arrivals = np.round(times.arrive * 1e9)
    assert np.isin(arrivals, trajectory.time).all()


def test_a_controller_stands_still_at_stops_and_waits(times):
    trajectory = joint_trajectory(times, NAMES, IS_PRISMATIC)
    spline = CubicHermiteSpline(trajectory.time * 1e-9, trajectory.position, trajectory.velocity)
    motion = times.motion
    ends = np.unique(times.arrive[motion.stops])
    assert np.abs(spline(ends, 1)).max() < 1e-6
    waiting = np.flatnonzero(times.waits > 0.0)
    assert len(waiting) > 10
    during = 0.5 * (times.arrive + times.leave)[waiting]
    np.testing.assert_allclose(spline(during), motion.joints[waiting] * SCALE, atol=1e-9)
    assert np.abs(spline(during, 1)).max() < 1e-6


def test_velocities_are_the_derivative_of_a_smooth_path(a_motion):
    """A parabola over uneven steps is met exactly."""
    motion = a_motion(3, layers=1, beads=1, points=40)
    time = np.cumsum(motion.duration)
    factors = np.arange(1.0, 7.0)
    joints = factors * (0.2 * time**2 - 0.5 * time + 1.0)[:, None]
    motion = dataclasses.replace(motion, joints=joints)
    trajectory = joint_trajectory(timeline(motion, ProcessParameters()), NAMES, [False] * 6)
    seconds = trajectory.time * 1e-9
    inside = slice(3, -3)
    derivative = factors * (0.4 * seconds - 0.5)[:, None]
    np.testing.assert_allclose(trajectory.velocity[inside], derivative[inside], atol=1e-6)


def test_rows_without_joint_values_are_refused(times):
    joints = times.motion.joints.copy()
    joints[7] = np.nan
    motion = dataclasses.replace(times.motion, joints=joints)
    with pytest.raises(ValueError, match="joint values"):
        joint_trajectory(timeline(motion, PROCESS), NAMES, IS_PRISMATIC)


READER = """
import json, sys
import numpy as np
sys.path.append(sys.argv[1])
from rosbags.typesys import Stores, get_typestore
store = get_typestore(Stores.ROS2_HUMBLE)
name = "trajectory_msgs/msg/JointTrajectory"

def build(kind, value):
    made = {}
    for field, (node, detail) in store.fielddefs[kind][1]:
        if node.name == "NAME":
            made[field] = build(detail, value[field])
        elif node.name == "BASE":
            made[field] = value[field]
        elif detail[0][0].name == "NAME":
            made[field] = [build(detail[0][1], entry) for entry in value[field]]
        elif detail[0][1][0] == "string":
            made[field] = value[field]
        else:
            made[field] = np.array(value[field], dtype=detail[0][1][0])
    assert set(made) == set(value), (kind, set(value))
    return store.types[kind](**made)

message = store.serialize_cdr(build(name, json.load(open(sys.argv[2]))), name)
read = store.deserialize_cdr(message, name)
times = [point.time_from_start.sec + point.time_from_start.nanosec * 1e-9 for point in read.points]
print(json.dumps([
    read.joint_names,
    times,
    [point.positions.tolist() for point in read.points],
    [point.velocities.tolist() for point in read.points],
]))
"""


def test_a_reader_of_ros_messages_takes_the_file(times, tmp_path):
    """rosbags has the message definitions of ROS 2; it puts the text into the wire format and back."""
    packages = interpreters.ros_packages()
    if packages is None:
        pytest.skip("rosbags is not in .test-env")
    trajectory = joint_trajectory(times, NAMES, IS_PRISMATIC)
    file = tmp_path / "path.json"
    file.write_text("".join(trajectory_text(trajectory)), encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", READER, str(packages), str(file)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    names, seconds, positions, velocities = json.loads(done.stdout)
    assert tuple(names) == NAMES
    np.testing.assert_allclose(seconds, trajectory.time * 1e-9, rtol=0, atol=1e-9)
    np.testing.assert_allclose(positions, trajectory.position, rtol=0, atol=1e-9)
    np.testing.assert_allclose(velocities, trajectory.velocity, rtol=0, atol=1e-9)
