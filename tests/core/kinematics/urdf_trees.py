# SPDX-License-Identifier: LGPL-2.1-or-later
"""Trees of URDFs by a reading of our own: what moves in one, where a machine of it ends, whether a refusal is so."""

import collections
import math
import re
import xml.etree.ElementTree as ElementTree

import numpy as np

from tests.core.kinematics.urdf_cells import placed

TURNS = ("revolute", "continuous")
EXACT, STRAIGHT = 1e-6, 1e-6  # mm, rad: files have six digits and more
BACK = 1e-6  # rad
SQUARE = 2e-3  # rad: what is written for a right angle is nearer to it


def joints_of(text):
    """The joints of a tree: others, of transmissions, are named deeper in."""
    return ElementTree.fromstring(text).findall("joint")


def moving(text):
    """The joints that move on the way from the ground to the link that most of them move."""
    above = {joint.find("child").get("link"): joint for joint in joints_of(text)}
    longest = []
    for link in above:
        way = []
        while link in above and above[link] not in way:
            way.append(above[link])
            link = above[link].find("parent").get("link")
        longest = max(
            longest, [joint for joint in way[::-1] if joint.get("type") != "fixed"], key=len
        )
    return longest


def is_six_axis_arm(axes):
    """Whether what moves in a file are six joints that turn."""
    return len(axes) == 6 and all(
        joint.get("type") in TURNS and joint.find("mimic") is None for joint in axes
    )


def assert_pose(text, robot, found, arm):
    """Joints at random: the chain's end is where the tip is in the file, its Z out of axis 6, and the inverse leads back."""
    base = robot.bases()[0]
    tip = robot.tips(base)[0]
    random = np.random.default_rng(1)
    joints = random.uniform(np.maximum(found.lower, -2.5), np.minimum(found.upper, 2.5), (3, 6))
    text = squared(text)
    joint_of = {joint.find("child").get("link"): joint for joint in joints_of(text)}
    last = next(joint for joint in joint_of.values() if joint.get("name") == found.joints[-1])
    makers = joint_of.get("base") if base != "base" else None
    makers = (
        makers is not None
        and makers.get("type") == "fixed"
        and makers.find("parent").get("link") == base
    )
    for row in joints:
        links = placed(text, collections.defaultdict(float, zip(found.joints, row)))
        # the chain begins where axis 1 is the Z; `found.base` is the maker's base, or that of the file, from there
        begins = links["base" if makers else base] @ np.linalg.inv(found.base)
        axis = links[last.find("child").get("link")][:3, :3] @ np.array(
            last.find("axis").get("xyz").split(), float
        )
        z, x = links[tip][:3, 2], links[tip][:3, 0]
        out = z if np.linalg.norm(np.cross(z, axis)) < STRAIGHT else x
        assert np.linalg.norm(np.cross(out, axis)) < STRAIGHT
        pose = begins @ found.chain.forward(row)
        assert np.abs(pose[:3, 3] - links[tip][:3, 3]).max() < EXACT
        assert np.abs(np.cross(pose[:3, 2], axis)).max() < STRAIGHT
        assert out is x or np.abs(pose[:3, :3] - links[tip][:3, :3]).max() < STRAIGHT
        back = arm.inverse(found.chain.forward(row)[None])[:, 0]
        off = (back - row + math.pi) % (2.0 * math.pi) - math.pi
        assert np.nanmin(np.abs(off).max(axis=1)) < BACK


def squared(text):
    """The file with its right angles whole: 1.571 and 1.57079 are written for one, and 2e-4 rad are a tenth of a mm."""

    def whole(found):
        words = [str(float(word)) for word in found[2].split()]
        turns = [round(float(word) / (0.5 * math.pi)) for word in words]
        exact = [
            0.5 * math.pi * turn
            if abs(float(word) - 0.5 * math.pi * turn) < SQUARE
            else float(word)
            for word, turn in zip(words, turns)
        ]
        return f'{found[1]}{" ".join(map(repr, exact))}"'

    return re.sub(r'(\brpy=")([^"]+)"', whole, text)


def is_so(text, axes, message):
    """Whether what a file is refused for is what the tree of it shows."""
    if any(joint.find("mimic") is not None for joint in axes):
        return "mimics another joint" in message
    children = [joint.find("child").get("link") for joint in joints_of(text)]
    twice = [link for link, count in collections.Counter(children).items() if count > 1]
    if twice:
        return any(f"the link {link!r} already has a parent joint" in message for link in twice)
    slide = sum(joint.get("type") == "prismatic" for joint in axes)
    if len(axes) != 6 or slide:
        return f"it has {len(axes)} axes, {slide} prismatic" in message
    # six that turn: the end that is named lies beside axis 6
    name = re.search(r"from \S+ to (\S+):", message)
    told = name is not None and "the flange origin is not on axis 6" in message
    return told and beside(text, axes[-1], name[1]) > 0.01


def beside(text, last, tip):
    """mm from a link's origin to the line of a joint."""
    links = placed(text, collections.defaultdict(float))
    joint = links[last.find("child").get("link")]
    axis = joint[:3, :3] @ np.array(last.find("axis").get("xyz").split(), float)
    return float(np.linalg.norm(np.cross(links[tip][:3, 3] - joint[:3, 3], axis)))
