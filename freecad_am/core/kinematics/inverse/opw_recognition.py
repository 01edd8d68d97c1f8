# SPDX-License-Identifier: LGPL-2.1-or-later
"""Recognition of the closed form of a chain of joint frames, and the chain of a closed form.

Conditions of `spherical_wrist` (Brandstoetter, Angerer, Hofbaur 2014): axis 1 is normal to axis 2;
axes 2 and 3 are parallel; axis 4 is normal to axis 3; axes 4, 5 and 6 meet in one point, and axis 5
is normal to axes 4 and 6. They are checked in this order. The first violated condition is the
reason why there is no closed form.
"""

from __future__ import annotations

import math

import numpy as np

from ...geometry import frames
from ...geometry.formatting import format_differing
from ...issues import InputError, Text, Word
from ...types import Array
from ..chain import Chain, JointFrames
from .spherical_wrist import OpwArm

# tolerances of directions (rad) and lines (mm), and maximum error of the closed form, as for
# machine files
PARALLEL_TOLERANCE, NEAR_MM = 1e-8, 1e-5
POSITION, ROTATION = 1e-6, 1e-9
ROBOT = 6  # number of axes of a robot
FLANGE = "flange"  # location of errors that concern only the flange
TOOL_FRAME = "take the frame tool0 of a URDF, or move the flange"
OTHER_GEOMETRY = "correct its geometry, or choose another machine"


def rooted(chain: Chain) -> tuple[Chain, Array]:
    """Return the chain of a robot relative to a base_link whose Z is axis 1.

    A base_link that already has its Z on axis 1, up or down, stays. Any other base_link is rotated
    by the smallest rotation and moved to the foot of its origin on the axis.

    Parameters
    ----------
    chain : Chain
        The chain.

    Returns
    -------
    chain : Chain
        The chain relative to the new base_link.
    base : (4, 4) array
        Previous base_link in the new base_link.
    """
    at_rest = chain.frames(np.zeros(chain.axes))
    axis, origin = at_rest.directions[0], at_rest.origins[0]
    foot = origin - axis * float(axis @ origin)
    if np.hypot(axis[0], axis[1]) < PARALLEL_TOLERANCE and np.linalg.norm(foot) < NEAR_MM:
        return chain, np.eye(4)
    up = axis if axis[2] >= 0.0 or abs(axis[2]) < PARALLEL_TOLERANCE else -axis
    new = frames.pose(frames.smallest_rotation((0.0, 0.0, 1.0), up), foot)
    old = frames.inverse(new)
    return Chain(
        np.concatenate((old @ chain.origins[:1], chain.origins[1:])),
        chain.directions,
        chain.flange,
        chain.sliding,
    ), old


def track_of(chain: Chain) -> int:
    """Return the number of track axes below a six-axis robot; 0 for any other chain."""
    return int(chain.axes == ROBOT + 1 and chain.sliding[0] and not chain.sliding[1:].any())


def recognise(chain: Chain) -> OpwArm:
    """Return the closed form of a chain, in its own base_link.

    Signs and offsets are chosen for c2, c3 > 0, a1 >= 0 and, if that leaves a choice, the smallest
    rotations. Raises InputError NO_CLOSED_FORM with the violated condition and its deviation.
    """
    if chain.axes != 6 or chain.sliding.any():
        slides = int(chain.sliding.sum())
        if track_of(chain):
            raise refused(
                "the first axis is prismatic and carries the six revolute axes, like a track",
                "start the machine at the base of the robot, and name the track in "
                "`cell.external` with `carries: robot`",
            )
        raise refused(
            Text("the machine has {} axes, {} prismatic", chain.axes, slides),
            "choose a robot with six revolute axes; if a gripper follows these axes, name the "
            "last link of the arm as `tip`; further axes belong in `cell.external`",
        )
    at_rest = chain.frames(np.zeros(6))
    centre = _wrist_centre(at_rest)
    arm = _arm(at_rest, centre)
    q = np.random.default_rng(6).uniform(-math.pi, math.pi, (32, 6))
    off = np.abs(arm.forward(q) - chain.forward(q))
    if off[:, :3, 3].max() > POSITION or off[:, :3, :3].max() > ROTATION:
        raise refused(
            Text(
                "the closed form is off by {:.3g} mm and {:.2g} (rotation matrix entries)",
                off[:, :3, 3].max(),
                off[:, :3, :3].max(),
            ),
            "give the geometry with more digits",
        )
    return arm


def chain_of(arm: OpwArm) -> Chain:
    """Return the chain of joint frames of a closed form.

    The joint frames are parallel to base_link where the opw angles are zero.
    """
    steps = np.array(
        [
            (0.0, 0.0, 0.0),
            (arm.a1, arm.b, arm.c1),
            (0.0, 0.0, arm.c2),
            (arm.a2, 0.0, arm.c3),
            (0.0,) * 3,
            (0.0,) * 3,
        ]
    )
    axes = np.array(
        [
            (0.0, 0.0, 1.0),
            (0.0, 1.0, 0.0),
            (0.0, 1.0, 0.0),
            (0.0, 0.0, 1.0),
            (0.0, 1.0, 0.0),
            (0.0, 0.0, 1.0),
        ]
    )
    turns = frames.rotation_about(axes, -np.array(arm.offsets))
    return Chain(
        frames.pose(turns, steps),
        axes * np.array(arm.signs, float)[:, None],
        frames.pose(np.eye(3), (0.0, 0.0, arm.c4)),
    )


def _wrist_centre(at_rest: JointFrames) -> Array:
    """Check the directions of all axes, and return the point (3,) where the wrist axes meet."""
    z, p = at_rest.directions, at_rest.origins
    foot = p[0] - z[0] * float(z[0] @ p[0])
    if np.hypot(z[0, 0], z[0, 1]) > PARALLEL_TOLERANCE or np.linalg.norm(foot) > NEAR_MM:
        raise refused("axis 1 is not the Z of the base frame")
    if all(float(np.linalg.norm(np.cross(z[1], z[axis]))) < PARALLEL_TOLERANCE for axis in (2, 3)):
        raise refused(
            "the wrist is not spherical: axis 4 is parallel to axes 2 and 3, as in arms of "
            "Universal Robots"
        )
    for first_axis, second_axis in ((0, 1), (2, 3), (3, 4), (4, 5)):
        off = math.asin(min(1.0, abs(float(z[first_axis] @ z[second_axis]))))
        if off > PARALLEL_TOLERANCE:
            raise refused(
                Text(
                    "axes {} and {} are {} deg apart, not 90 deg",
                    first_axis + 1,
                    second_axis + 1,
                    format_differing(90.0 - math.degrees(off), 90.0),
                )
            )
    off = math.asin(min(1.0, float(np.linalg.norm(np.cross(z[1], z[2])))))
    if off > PARALLEL_TOLERANCE:
        raise refused(
            Text("axes 2 and 3 are not parallel, but {:.6g} deg apart", math.degrees(off))
        )
    # the point of axis 5 nearest to axis 4, and its distances from axes 4 and 6
    across = p[3] - p[4]
    centre: Array = p[4] + z[4] * float(z[4] @ across)
    for axis in (3, 5):
        to = centre - p[axis]
        off = float(np.linalg.norm(to - z[axis] * float(z[axis] @ to)))
        if off > NEAR_MM:
            raise refused(
                Text(
                    "the wrist is not spherical: axis {} passes {:.6g} mm off the point where "
                    "axes {} meet",
                    axis + 1,
                    off,
                    Word("5 and 6" if axis == 3 else "4 and 5"),
                )
            )
    return centre


def _arm(at_rest: JointFrames, centre: Array) -> OpwArm:
    """Return the closed form for checked axes and this wrist centre."""
    z, p, flange = at_rest.directions, at_rest.origins, at_rest.flange
    turn1, sign2, shoulder = _shoulder(z, p)
    x, y, up = frames.about_z(turn1).T
    side = float(y @ centre)
    to_elbow = p[2] - shoulder
    ahead, above = float(to_elbow @ x), float(to_elbow @ up)
    upper = math.hypot(ahead, above)
    if upper < NEAR_MM:
        raise refused("axes 2 and 3 coincide")
    turn2 = math.atan2(ahead, above)
    to_wrist = centre - p[2]
    length = float(to_wrist @ z[3])
    if abs(length) < NEAR_MM:
        raise refused("the wrist centre is above axis 3, without a forearm along axis 4")
    sign4 = 1 if length > 0.0 else -1
    forearm = z[3] * sign4
    turn23 = math.atan2(float(forearm @ x), float(forearm @ up))
    across = np.cos(turn23) * x - np.sin(turn23) * up
    out = flange[:3, 2]
    if np.linalg.norm(np.cross(out, z[5])) > PARALLEL_TOLERANCE:
        raise refused(
            "the Z of the flange is not parallel to axis 6",
            "take the frame tool0 of a URDF, or turn the flange",
            FLANGE,
        )
    offset = flange[:3, 3] - centre
    if np.linalg.norm(offset - out * float(offset @ out)) > NEAR_MM:
        raise refused("the flange origin is not on axis 6", TOOL_FRAME, FLANGE)
    if float(offset @ out) < -NEAR_MM and float(out @ forearm) < 0.0:
        raise refused(
            "the Z of the flange points into the wrist instead of outwards",
            "take another link of a URDF, such as tool0 or fanuc_flange, or turn the flange",
            FLANGE,
        )
    # axis 5 in the forearm: along its y, rotated about the forearm by turn4, at most a right angle
    turn4 = math.atan2(-float(z[4] @ across), float(z[4] @ y))
    sign5 = 1
    if turn4 <= -math.pi / 2.0 + PARALLEL_TOLERANCE or turn4 > math.pi / 2.0 + PARALLEL_TOLERANCE:
        turn4 = turn4 + math.pi if turn4 <= 0.0 else turn4 - math.pi
        sign5 = -1
    five_x = math.cos(turn4) * across + math.sin(turn4) * y
    five_y = -math.sin(turn4) * across + math.cos(turn4) * y
    bent = math.atan2(float(out @ five_x), float(out @ forearm))
    turn5 = bent if abs(bent) > PARALLEL_TOLERANCE else 0.0
    six_x = math.cos(turn5) * five_x - math.sin(turn5) * forearm
    turn6 = math.atan2(float(flange[:3, 0] @ five_y), float(flange[:3, 0] @ six_x))
    turns = (turn1, turn2, _wrapped(turn23 - turn2), turn4, turn5, turn6)
    signs = (
        1 if z[0, 2] > 0.0 else -1,
        sign2,
        sign2 if float(z[2] @ z[1]) > 0.0 else -sign2,
        sign4,
        sign5,
        1 if float(z[5] @ out) > 0.0 else -1,
    )
    return OpwArm(
        a1=clean(float(shoulder @ x)),
        a2=clean(float(to_wrist @ across)),
        b=clean(side),
        c1=clean(float(p[1, 2])),
        c2=clean(upper),
        c3=clean(abs(length)),
        c4=clean(float(offset @ out)),
        offsets=tuple(_offset(turn) for turn in turns),
        signs=signs,
    )


def _shoulder(z: Array, p: Array) -> tuple[float, int, Array]:
    """Return the zero of axis 1, the sign of axis 2, and the point of axis 2 nearest to axis 1."""
    point = p[1] - z[1] * float(z[1] @ p[1])
    point = np.array([point[0], point[1], p[1, 2]])
    sign = 1
    turn = math.atan2(-z[1, 0], z[1, 1])  # axis 2 is the Y of the arm plane
    ahead = float(point[0] * math.cos(turn) + point[1] * math.sin(turn))
    turned = ahead < -NEAR_MM or (
        abs(ahead) <= NEAR_MM
        and not -0.5 * math.pi + PARALLEL_TOLERANCE < turn <= 0.5 * math.pi + PARALLEL_TOLERANCE
    )
    if turned:
        turn, sign = (turn + math.pi if turn <= 0.0 else turn - math.pi), -1
    return turn, sign, point


def _wrapped(angle: float) -> float:
    return math.atan2(math.sin(angle), math.cos(angle))


def _offset(turn: float) -> float:
    """Return the offset for an angle at zero, rad; a half turn becomes positive."""
    degrees = -clean(math.degrees(turn))
    return math.radians(degrees + 360.0 if degrees <= -180.0 else degrees + 0.0)


def clean(value: float) -> float:
    """Round off numerical noise."""
    rounded = round(value, 9)
    return rounded + 0.0 if abs(rounded - value) < 1e-11 else value


def refused(reason: str, remedy: str = "", where: str = "geometry") -> InputError:
    """Return the error for a machine that cannot be planned.

    Parameters
    ----------
    reason : str
        Why its kinematics are unsuitable.
    remedy : str, optional
        Remedy; empty for the default.
    where : str, optional
        Key of the machine file.

    Returns
    -------
    InputError
        Error NO_CLOSED_FORM.
    """
    return InputError(
        "NO_CLOSED_FORM",
        where,
        "the kinematics of the machine is not supported: {}; {}",
        reason,
        remedy or OTHER_GEOMETRY,
    )
