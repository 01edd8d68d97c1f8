"""URDFs of whole cells, and the poses of their links by an independent traversal."""

import math
import re
import xml.etree.ElementTree as ElementTree

import numpy as np

from freecad_am.core.kinematics import external
from freecad_am.core.kinematics.machines import machine
from freecad_am.core.kinematics.urdf import text as urdf_text

ROBOT, TRACK, POSITIONER = "kuka-kr8-r2100-2-arc-hw", "kuka-kl100-2", "motoman-motopos-d500"
WHERE_TRACK, WHERE_POSITIONER = ("0.3 0.2 0", "0 0 1.5707963267948966"), ("1.7 0.25 0.3", "0 0 0.4")
FINGERS = """\
<link name="robot_left"/><link name="robot_right"/>
<joint name="left" type="revolute"><parent link="robot_tool0"/><child link="robot_left"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" velocity="1"/></joint>
<joint name="right" type="revolute"><parent link="robot_tool0"/><child link="robot_right"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" velocity="1"/><mimic joint="left"/></joint>
"""


def add_prefix(robot, prefix):
    """The links and joints of a machine, each with a prefix."""
    text = re.sub(r'<\?xml.*?\?>\n<robot name="[^"]*">\n', "", urdf_text.text(robot)).replace(
        "</robot>\n", ""
    )
    return re.sub(
        r'(link|joint name|link name)="([^"]+)"',
        lambda match: f'{match[1]}="{prefix}{match[2]}"',
        text,
    )


def fixed(parent, child, xyz="0 0 0", rpy="0 0 0"):
    return (
        f'<joint name="{parent}-{child}" type="fixed"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{rpy}"/></joint>\n'
    )


def whole_cell(track=True, positioner=True, extra=""):
    """A robot on a track or on the floor, and a positioner, all on a link `world`."""
    text = '<link name="world"/>\n' + add_prefix(machine.load(ROBOT), "robot_")
    if track:
        text += add_prefix(external.load(TRACK), "track_") + fixed(
            "world", "track_base_link", *WHERE_TRACK
        )
        text += fixed("track_tool0", "robot_base_link", "0 0 0", f"0 0 {-math.pi / 2!r}")
    else:
        text += fixed("world", "robot_base_link", "0.1 0 0.5", "0 0 0.2")
    if positioner:
        text += add_prefix(external.load(POSITIONER), "positioner_")
        text += fixed("world", "positioner_base_link", *WHERE_POSITIONER)
    return f'<robot name="cell">{text}{extra}</robot>\n'


def link_poses(text, values):
    """(4, 4) mm of each link of a URDF for joint values by name, rad and m."""
    top = ElementTree.fromstring(text)
    # other joint elements, of transmissions, are nested deeper
    above = {joint.find("child").get("link"): joint for joint in top.findall("joint")}

    def numbers(element, key, default):
        return np.array(
            [
                float(word)
                for word in (default if element is None else element.get(key, default)).split()
            ]
        )

    def rotation_about(axis, angle):
        x, y, z = axis
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross

    def pose(link):
        joint = above.get(link)
        if joint is None:
            return np.eye(4)
        origin, moved = np.eye(4), np.eye(4)
        roll, pitch, yaw = numbers(joint.find("origin"), "rpy", "0 0 0")
        origin[:3, :3] = (
            rotation_about((0, 0, 1), yaw)
            @ rotation_about((0, 1, 0), pitch)
            @ rotation_about((1, 0, 0), roll)
        )
        origin[:3, 3] = 1000.0 * numbers(joint.find("origin"), "xyz", "0 0 0")
        if joint.get("type") != "fixed":
            axis, value = numbers(joint.find("axis"), "xyz", "1 0 0"), values[joint.get("name")]
            if joint.get("type") == "prismatic":
                moved[:3, 3] = 1000.0 * value * axis
            else:
                moved[:3, :3] = rotation_about(axis, value)
        return pose(joint.find("parent").get("link")) @ origin @ moved

    return {link.get("name"): pose(link.get("name")) for link in top.iter("link")}
