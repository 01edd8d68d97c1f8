# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trees of URDFs by an independent reader: moving joints, the end of a machine, and whether a
rejection is justified."""

import collections
import math
import re
import xml.etree.ElementTree as ElementTree

import numpy as np

from tests.core.kinematics.urdf_cells import link_poses

TURNS = ("revolute", "continuous")
EXACT, PARALLEL_TOLERANCE = 1e-6, 1e-6  # mm, rad: files have at least six digits
BACK = 1e-6  # rad
SQUARE = 2e-3  # rad: maximum deviation of a written right angle


def joints_of(text):
    """The joints of a tree: other joint elements, of transmissions, are nested deeper."""
    return ElementTree.fromstring(text).findall("joint")


def moving(text):
    """The moving joints on the path from the ground to the link with the most of them."""
    above = {joint.find("child").get("link"): joint for joint in joints_of(text)}
    longest = []
    for link in above:
        chain = []
        while link in above and above[link] not in chain:
            chain.append(above[link])
            link = above[link].find("parent").get("link")
        longest = max(
            longest, [joint for joint in chain[::-1] if joint.get("type") != "fixed"], key=len
        )
    return longest


def is_six_axis_arm(axes):
    """Return whether the moving joints of a file are six revolute ones."""
    return len(axes) == 6 and all(
        joint.get("type") in TURNS and joint.find("mimic") is None for joint in axes
    )


def assert_pose(text, robot, described, arm):
    """For random joints: the end of the chain is at the tip of the file, its Z along axis 6, and
    the inverse restores the joints."""
    base = robot.bases()[0]
    tip = robot.tips(base)[0]
    random = np.random.default_rng(1)
    joints = random.uniform(
        np.maximum(described.lower, -2.5), np.minimum(described.upper, 2.5), (3, 6)
    )
    text = squared(text)
    joint_of = {joint.find("child").get("link"): joint for joint in joints_of(text)}
    last_joint = next(
        joint for joint in joint_of.values() if joint.get("name") == described.joints[-1]
    )
    makers = joint_of.get("base") if base != "base" else None
    makers = (
        makers is not None
        and makers.get("type") == "fixed"
        and makers.find("parent").get("link") == base
    )
    for row in joints:
        links = link_poses(text, collections.defaultdict(float, zip(described.joints, row)))
        # the chain starts where axis 1 is the Z; `described.base` is the manufacturer's base, or
        # that of the file, from there
        begins = links["base" if makers else base] @ np.linalg.inv(described.base)
        axis = links[last_joint.find("child").get("link")][:3, :3] @ np.array(
            last_joint.find("axis").get("xyz").split(), float
        )
        z, x = links[tip][:3, 2], links[tip][:3, 0]
        out = z if np.linalg.norm(np.cross(z, axis)) < PARALLEL_TOLERANCE else x
        assert np.linalg.norm(np.cross(out, axis)) < PARALLEL_TOLERANCE
        pose = begins @ described.chain.forward(row)
        assert np.abs(pose[:3, 3] - links[tip][:3, 3]).max() < EXACT
        assert np.abs(np.cross(pose[:3, 2], axis)).max() < PARALLEL_TOLERANCE
        assert out is x or np.abs(pose[:3, :3] - links[tip][:3, :3]).max() < PARALLEL_TOLERANCE
        back = arm.inverse(described.chain.forward(row)[None])[:, 0]
        off = (back - row + math.pi) % (2.0 * math.pi) - math.pi
        assert np.nanmin(np.abs(off).max(axis=1)) < BACK


def squared(text):
    """The file with exact right angles: files have 1.571 and 1.57079, and 2e-4 rad are a tenth of a
    mm."""

    def exact_angles(match):
        words = [str(float(word)) for word in match[2].split()]
        turns = [round(float(word) / (0.5 * math.pi)) for word in words]
        exact = [
            0.5 * math.pi * turn
            if abs(float(word) - 0.5 * math.pi * turn) < SQUARE
            else float(word)
            for word, turn in zip(words, turns)
        ]
        return f'{match[1]}{" ".join(map(repr, exact))}"'

    return re.sub(r'(\brpy=")([^"]+)"', exact_angles, text)


def is_so(text, axes, message):
    """Return whether the tree of a file justifies the reason of its rejection."""
    if any(joint.find("mimic") is not None for joint in axes):
        return "mimics another joint" in message
    children = [joint.find("child").get("link") for joint in joints_of(text)]
    twice = [link for link, count in collections.Counter(children).items() if count > 1]
    if twice:
        return any(f"the link {link!r} already has a parent joint" in message for link in twice)
    slide = sum(joint.get("type") == "prismatic" for joint in axes)
    if len(axes) != 6 or slide:
        return f"the machine has {len(axes)} axes, {slide} prismatic" in message
    # six revolute joints: the named end is off axis 6
    name = re.search(r"from \S+ to (\S+):", message)
    is_off_axis = name is not None and "the flange origin is not on axis 6" in message
    return is_off_axis and beside(text, axes[-1], name[1]) > 0.01


def beside(text, last_axis, tip):
    """Distance (mm) from a link's origin to the line of a joint."""
    links = link_poses(text, collections.defaultdict(float))
    joint = links[last_axis.find("child").get("link")]
    axis = joint[:3, :3] @ np.array(last_axis.find("axis").get("xyz").split(), float)
    return float(np.linalg.norm(np.cross(links[tip][:3, 3] - joint[:3, 3], axis)))
