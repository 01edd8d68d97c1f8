# SPDX-License-Identifier: LGPL-2.1-or-later
"""Arms without a spherical wrist as their manufacturers describe them, and independent solvers for
their poses."""

from types import SimpleNamespace

import numpy as np

from freecad_am.core.geometry import frames
from freecad_am.core.kinematics.chain import Chain
from freecad_am.kdl import KdlArm

# built-in machines of every manufacturer, wrist and size for expensive tests; test_machine_library
# covers all of them
EXAMPLES = (
    "abb-irb140",
    "abb-irb1600-6-12",
    "abb-irb1600-8-145",
    "abb-irb2400-12-155",
    "abb-irb4600-20-250",
    "abb-irb4600-60-205",
    "fanuc-arcmate120ic",
    "fanuc-arcmate120ic-10l",
    "fanuc-crx10ia",
    "fanuc-crx10ia-l",
    "head-table-xyzbc",
    "head-xyzab",
    "kuka-kr16-2",
    "kuka-kr16-r2010-2",
    "kuka-kr210-r2700-2",
    "kuka-kr6-r900-2",
    "kuka-kr6-r900-sixx",
    "kuka-kr8-r2100-2-arc-hw",
    "motoman-ar1440",
    "motoman-ar2010",
    "motoman-ma2010",
    "motoman-mh12",
    "staubli-rx160",
    "staubli-rx160l",
    "staubli-rx60b",
    "staubli-rx60bl",
    "staubli-tx2-60l",
    "staubli-tx60",
    "staubli-tx60l",
    "table-xyzac",
    "table-xyzbc",
    "ur-ur10e",
)

# joints: origin mm, rpy deg, axis; then the flange
UR5E = (
    ((0, 0, 162.5), (0, 0, 0), (0, 0, 1)),
    ((0, 0, 0), (90, 0, 0), (0, 0, 1)),
    ((-425, 0, 0), (0, 0, 0), (0, 0, 1)),
    ((-392.2, 0, 133.3), (0, 0, 0), (0, 0, 1)),
    ((0, -99.7, 0), (90, 0, 0), (0, 0, 1)),
    ((0, 99.6, 0), (90, 180, 180), (0, 0, 1)),
    ((0, 0, 0), (0, 0, 0)),
)
UR10E = (
    ((0, 0, 180.7), (0, 0, 180), (0, 0, 1)),
    ((0, 0, 0), (90, 0, 0), (0, 0, 1)),
    ((-612.7, 0, 0), (0, 0, 0), (0, 0, 1)),
    ((-571.55, 0, 174.15), (0, 0, 0), (0, 0, 1)),
    ((0, -119.85, 0), (90, 0, 0), (0, 0, 1)),
    ((0, 116.55, 0), (-90, 0, 0), (0, 0, 1)),
    ((0, 0, 0), (0, 0, 0)),
)
CRX_10IA = (
    ((0, 0, 245), (0, 0, 0), (0, 0, 1)),
    ((0, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 540), (0, 0, 0), (0, -1, 0)),
    ((0, 0, 0), (0, 0, 0), (-1, 0, 0)),
    ((540, 0, 0), (0, 0, 0), (0, -1, 0)),
    ((0, -150, 0), (0, 0, 0), (-1, 0, 0)),
    ((160, 0, 0), (180, -90, 0)),
)
HC10 = (
    ((0, 0, 275), (0, 0, 0), (0, 0, 1)),
    ((0, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 700), (0, 0, 0), (0, -1, 0)),
    ((0, 0, -500), (0, 0, 0), (0, 0, 1)),
    ((0, 162, 0), (0, 0, 0), (0, -1, 0)),
    ((0, 0, 0), (0, 0, 0), (0, 0, 1)),
    ((0, 0, -130), (180, 0, 0)),
)
GOFA_5 = (
    ((0, 0, 265), (0, 0, 0), (0, 0, 1)),
    ((0, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 444), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 110), (0, 0, 0), (1, 0, 0)),
    ((470, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((101, 0, 80), (0, 0, 0), (1, 0, 0)),
    ((0, 0, 0), (0, 90, 0)),
)
# axis 2 is ahead of axis 1: GoFa 10 by RobotComponents' preset CRB15000-10/1.52 (150 -110 -80 0 400
# 707 637 101), FANUC's M-710iC/50E by its description
GOFA_10 = (
    ((0, 0, 400), (0, 0, 0), (0, 0, 1)),
    ((150, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 707), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 110), (0, 0, 0), (1, 0, 0)),
    ((637, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((101, 0, 80), (0, 0, 0), (1, 0, 0)),
    ((0, 0, 0), (0, 90, 0)),
)
M710IC_50E = (
    ((0, 0, 565), (0, 0, 0), (0, 0, 1)),
    ((150, 0, 0), (0, 0, 0), (0, 1, 0)),
    ((0, 0, 870), (0, 0, 0), (0, -1, 0)),
    ((0, 0, 170), (0, 0, 0), (-1, 0, 0)),
    ((1016, 0, 0), (0, 0, 0), (0, 0, 1)),
    ((0, 0, 160), (0, 0, 0), (-1, 0, 0)),
    ((170, 0, 0), (180, -90, 0)),
)
# fictitious: shifted zeros, axes 4 to 6 at 70 deg, axis 6 off axis 5, the flange next to axis 6 and
# rotated
CROOKED_CRX = (
    ((0, 0, 300), (180, 0, 25), (0, 0, 1)),
    ((0, 0, 20), (90, 40, 10), (0, 0, 1)),
    ((350, 30, 45), (0, 0, 0), (0, 0, -1)),
    ((-60, 20, -45), (0, 90, 0), (0, 0, 1)),
    ((0, 0, 420), (70, 0, 30), (0, 0, 1)),
    ((40, 20, 90), (70, 0, 0), (0, 0, 1)),
    ((10, 20, 60), (30, 40, 50)),
)
# fictitious: axis 2 before axis 1, a forearm at an angle, axis 5 next to axis 4, the flange next to
# axis 6 and rotated
CROOKED_UR = (
    ((0, 0, 200), (180, 0, 30), (0, 0, 1)),
    ((60, 15, -10), (90, 25, 0), (0, 0, -1)),
    ((300, 90, 20), (0, 0, 0), (0, 0, 1)),
    ((-250, 60, 100), (180, 0, 40), (0, 0, 1)),
    ((35, -90, 40), (90, 0, 20), (0, 0, -1)),
    ((0, 0, 80), (90, 0, 0), (0, 0, 1)),
    ((10, 20, 60), (30, 40, 50)),
)


def chain(arm):
    """Return the chain of one of these arms."""
    *joints, (origin, rpy) = arm
    return Chain(
        np.stack([_pose(origin, rpy) for origin, rpy, _ in joints]),
        np.array([axis for *_, axis in joints], float),
        _pose(origin, rpy),
    )


def _pose(origin, rpy):
    roll, pitch, yaw = np.radians(rpy)
    return frames.pose(
        frames.about_z(yaw) @ frames.about_y(pitch) @ frames.about_x(roll), np.array(origin, float)
    )


def second_opinion(arm_chain):
    """Return PyKDL's arm for a chain only."""
    return KdlArm(SimpleNamespace(axes=range(6), chain=arm_chain))


def numeric(arm_chain, pose, rng, starts):
    """Distinct joint angles (k, 6) in [-pi, pi] that PyKDL's solver reached from random starts."""
    scale = np.ones((4, 4))
    scale[:3, 3] = 1e-3  # its weights assume metres
    kdl = second_opinion(
        Chain(arm_chain.origins * scale, arm_chain.directions, arm_chain.flange * scale)
    )
    seeds = rng.uniform(-np.pi, np.pi, (starts, 6))
    q = kdl.inverse(np.broadcast_to(pose * scale, (starts, 4, 4)), seeds, "lma", 1e-9)
    q = q[np.isfinite(q).all(axis=1)]
    q = q[np.abs(kdl.forward(q) - pose * scale).max(axis=(1, 2), initial=0.0) < 1e-7]
    q -= 2.0 * np.pi * np.round(q / (2.0 * np.pi))
    solutions = []
    for candidate in q:
        if all(joint_difference(candidate, solution) > 1e-3 for solution in solutions):
            solutions.append(candidate)
    return np.array(solutions).reshape(-1, 6)


def joint_difference(vector_a, vector_b):
    """Largest difference of two joint vectors along leading axes, modulo whole turns."""
    return np.abs(np.exp(1j * np.asarray(vector_a)) - np.exp(1j * np.asarray(vector_b))).max(
        axis=-1
    )


def mount_on_track(text):
    """Return the URDF of a robot whose base_link is mounted on a track, as one robot."""
    return text.replace('"base_link"', '"carriage"').replace(
        "</robot>",
        """<link name="base_link"/>
<joint name="rail" type="prismatic"><parent link="base_link"/><child link="carriage"/><origin xyz="0 0 0.3"/>
<axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="0"/></joint></robot>""",
    )
