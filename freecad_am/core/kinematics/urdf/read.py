# SPDX-License-Identifier: LGPL-2.1-or-later
"""Machines from URDF: the serial chain between two links of a robot description.

It reads origins, axes, types, limits and speeds of joints, fixed joints and link meshes. Metres are
converted to mm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...geometry import frames
from ...geometry.job_files import is_there, locate
from ...issues import InputError, Text
from ...types import Array
from ..chain import Chain
from ..links.bodies import FORMATS, LinkShape, Pieces
from . import elements as urdf_xml
from .elements import CODE, Element

MOVING = ("revolute", "continuous", "prismatic")
FIXED = "fixed"
# names of flange links in ROS-Industrial and FANUC files
BASES, TIPS = ("base_link",), ("tool0", "flange", "fanuc_flange")
ROBOT = 6  # number of joints of a robot
PARALLEL_TOLERANCE_RAD, BEHIND_MM = (
    math.radians(0.25),
    1e-3,
)  # tolerances of a tip: angle of its Z to the axis, rad, and distance behind the last axis, mm
DEGREE = math.radians(1.0)
MOST_RAD, FARTHEST_M = 50.0, 50.0  # larger values must be in degrees or mm
# child elements of a joint; SINGLE_TAGS may occur only once
SINGLE_TAGS = ("parent", "child", "origin", "axis", "limit", "mimic")
JOINT_TAGS = (*SINGLE_TAGS, "dynamics", "calibration", "safety_controller", "physics", "gazebo")
ATTRIBUTES = {
    "origin": {"xyz", "rpy"},
    "axis": {"xyz", "rpy"},  # old exporters write rpy, always zero
    "limit": {"lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"},
}


@dataclass(frozen=True, eq=False)
class Description:
    """A chain and its data from a URDF.

    lower, upper, max_speed: (axes,) rad or mm, per s; infinite if continuous or unknown. base:
    (4, 4) frame of a link `base` fixed to the first link, the manufacturer's base frame; None if
    there is none. shapes: (axes + 1) link meshes, first link first. notes: omissions and
    substitutions. bodies: (axes + 1) link bodies of a mechanism (`urdf.machine.collision`).
    """

    name: str
    joints: tuple[str, ...]
    chain: Chain
    lower: Array
    upper: Array
    max_speed: Array
    base: Array | None
    shapes: tuple[LinkShape | None, ...]
    notes: tuple[str, ...]
    bodies: tuple[Pieces, ...] = ()


class Urdf:
    """The tree of links and joints of a file. Raises InputError BAD_URDF with the line."""

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path).expanduser()
        if self.path.suffix.lower() == ".xacro":
            raise InputError(
                CODE,
                self.path.name,
                "the file is xacro; convert it to URDF first, with the ROS program xacro",
            )
        self.top = urdf_xml.read(self.path)
        if self.top.tag != "robot":
            raise self.top.bad(
                Text(
                    "the file contains <{}>, not the <robot> of a URDF; choose a robot URDF",
                    self.top.tag,
                )
            )
        # files expanded by xacro may still declare its namespace
        unexpanded = _xacro_in(self.top)
        if unexpanded is not None:
            raise unexpanded.bad(
                "the file is xacro; convert it to URDF first, with the ROS program xacro"
            )
        self.name = self.top.attributes.get("name", self.path.stem)
        self.links = self._named("link")
        self.parent: dict[str, Element] = {}  # the joint that moves a link
        for joint in self._named("joint").values():
            for end in ("parent", "child"):
                link = joint.one(end).text("link")
                if link not in self.links:
                    raise joint.one(end).bad(
                        Text("the link {!r} does not exist; choose an existing link", link)
                    )
            child = joint.one("child").text("link")
            if child in self.parent:
                raise joint.bad(
                    Text(
                        "the link {!r} already has a parent joint, {!r}",
                        child,
                        self.parent[child].text("name"),
                    )
                )
            self.parent[child] = joint

    def _named(self, tag: str) -> dict[str, Element]:
        elements: dict[str, Element] = {}
        for element in self.top.all(tag):
            name = element.text("name")
            if name in elements:
                raise element.bad(
                    Text(
                        "a {} {!r} already exists, in line {}; rename one of them",
                        tag,
                        name,
                        elements[name].line,
                    )
                )
            elements[name] = element
        if not elements:
            raise self.top.bad(Text("the file has no <{}>; choose a robot URDF", tag))
        return elements

    def bases(self) -> list[str]:
        """Return the links that a machine may begin with, the most likely first."""
        return sorted(
            self.links,
            key=lambda link: (link not in BASES, link in self.parent, link in self._leaves()),
        )

    def tips(self, base: str) -> list[str]:
        """Return the links that a machine from `base` may end with, the most likely first.

        The first links have as many joints as the link with the usual name, or the maximum number.
        Among them, links whose Z points out along the last axis come first, then the order is by
        name.
        """
        moving: dict[str, int] = {}
        for link in self.links:
            carried = [link, *self.above(link)]
            if base in carried[1:]:
                joints = [self.parent[below] for below in carried[: carried.index(base)]]
                moving[link] = sum(joint.text("type") != FIXED for joint in joints)
        named = [link for link in TIPS if moving.get(link, 0) >= ROBOT - 1]
        axes = moving[named[0]] if named else max(moving.values(), default=0)

        def rank(link: str) -> tuple[object, ...]:
            crooked = moving[link] == axes == ROBOT and not self.points_out(link)
            return moving[link] != axes, crooked, link not in named, link != TIPS[0], -moving[link]

        return sorted((link for link, count in moving.items() if count), key=rank)

    def moved_by(self, joint: str) -> str:
        """Return the link that an existing joint moves."""
        return next(
            link for link, parent_joint in self.parent.items() if parent_joint.text("name") == joint
        )

    def points_out(self, link: str) -> bool:
        """Whether the Z of a link is along the axis of its last moving joint, and does not point
        back to the joint before.
        """
        last_joint, to_link = self._moving_joint(link, np.eye(4))
        axis = _axis(last_joint)
        _, from_before = self._moving_joint(
            last_joint.one("parent").text("link"), last_joint.pose() @ to_link
        )
        ahead = from_before[:3, 2] @ from_before[:3, 3]
        return _is_along(to_link[:3, 2], axis) and float(ahead) > -BEHIND_MM

    def _moving_joint(self, link: str, to_link: Array) -> tuple[Element, Array]:
        """Return the joint that moves a link, and a pose (4, 4) in this link relative to it."""
        while self.parent[link].text("type") == FIXED:
            to_link = self.parent[link].pose() @ to_link
            link = self.parent[link].one("parent").text("link")
        return self.parent[link], to_link

    def between(self, base: str, tip: str) -> Description:
        """Return the chain from one link to a link that it carries."""
        joints = list(self._between(base, tip))
        moving = [joint for joint in joints if joint.text("type") != FIXED]
        if not moving:
            raise InputError(
                CODE,
                self.path.name,
                "no joint moves {!r} relative to {!r}; choose another link",
                tip,
                base,
            )
        origins, to_tip = [], np.eye(4)
        for joint in joints:
            to_tip = to_tip @ joint.pose()
            if joint in moving:
                origins.append(to_tip)
                to_tip = np.eye(4)
        limits = [_limits(joint) for joint in moving]
        notes = [*_rounded_angles(joints), *_joint_notes(moving)]
        shapes = tuple(
            self._mesh(link, notes)
            for link in (base, *(joint.one("child").text("link") for joint in moving))
        )
        sliding = np.array([joint.text("type") == "prismatic" for joint in moving])
        if len(moving) == ROBOT and not sliding.any():
            to_tip = _turn_out(to_tip, _axis(moving[-1]), tip, notes)
        chain = Chain(
            np.stack(origins), np.stack([_axis(joint) for joint in moving]), to_tip, sliding
        )
        lower, upper, speed = (np.array(values) for values in zip(*limits, strict=True))
        names = tuple(joint.text("name") for joint in moving)
        return Description(
            self.name, names, chain, lower, upper, speed, self._makers(base), shapes, tuple(notes)
        )

    def above(self, link: str) -> list[str]:
        """Return the links that carry a link, the nearest first."""
        carriers: list[str] = []
        while link in self.parent:
            link = self.parent[link].one("parent").text("link")
            if link in carriers:
                raise self.parent[link].bad(
                    Text(
                        "the link {!r} carries itself; correct `parent` and `child` of its joints",
                        link,
                    )
                )
            carriers.append(link)
        return carriers

    def children_of(self, link: str) -> list[str]:
        """Return the links mounted on a link."""
        return [
            child
            for child, joint in self.parent.items()
            if joint.one("parent").text("link") == link
        ]

    def _leaves(self) -> set[str]:
        return set(self.links) - {
            joint.one("parent").text("link") for joint in self.parent.values()
        }

    def _between(self, base: str, tip: str) -> Iterator[Element]:
        """Yield the joints from one link to another, in order."""
        above = [tip, *self.above(tip)]
        if base not in above:
            raise InputError(
                CODE,
                self.path.name,
                "the link {!r} does not carry {!r}; choose other links",
                base,
                tip,
            )
        for link in reversed(above[: above.index(base)]):
            joint = self.parent[link]
            kind = joint.text("type")
            if kind not in (*MOVING, FIXED):
                raise joint.bad(
                    Text(
                        "the joint {!r} is {}; use only {} and fixed joints",
                        joint.text("name"),
                        kind,
                        ", ".join(MOVING),
                    )
                )
            mimic = joint.first("mimic")
            if mimic is not None:
                raise mimic.bad(
                    Text(
                        "the joint {!r} mimics another joint, which a serial chain cannot; "
                        "remove the mimic tag",
                        joint.text("name"),
                    )
                )
            _check_joint(joint)
            yield joint

    def _makers(self, base: str) -> Array | None:
        if "base" not in self.parent or base == "base":
            return None
        joint = self.parent["base"]
        fixed = joint.text("type") == FIXED and joint.one("parent").text("link") == base
        return joint.pose() if fixed else None

    def _mesh(self, link: str, notes: list[str]) -> LinkShape | None:
        """Return the first drawable mesh of a link, and note the obstacles."""
        meshes = (
            self.mesh_of(visual, f"{link} is drawn plain", notes)
            for visual in self.links[link].all("visual")
        )
        return next((shape for shape in meshes if shape is not None), None)

    def mesh_of(self, element: Element, otherwise: str, notes: list[str]) -> LinkShape | None:
        """Return the mesh of a <visual> or <collision>.

        Parameters
        ----------
        element : Element
            The element.
        otherwise : str
            Consequence of an unusable mesh, for the note.
        notes : list of str
            List to which notes are appended.

        Returns
        -------
        LinkShape or None
            The mesh; None if it is missing or unusable.
        """
        geometry = element.first("geometry")
        mesh = None if geometry is None else geometry.first("mesh")
        if mesh is None:
            return None
        name = mesh.text("filename")
        file = self._file(name)
        scales = mesh.numbers("scale", 3, "1 1 1")
        if file is None:
            notes.append(f"line {mesh.line}: {name} is not there; {otherwise}")
        elif file.suffix.lower() not in FORMATS:
            notes.append(f"line {mesh.line}: {file.name} cannot be drawn; {otherwise}")
        elif (scales <= 0.0).any():
            notes.append(
                f"line {mesh.line}: {file.name} is mirrored or flat by its scale {mesh.attributes['scale']}; "
                f"export the mirrored mesh itself; {otherwise}"
            )
        elif np.ptp(scales) > 1e-9:
            notes.append(f"line {mesh.line}: {file.name} has unequal scales; {otherwise}")
        else:
            where = f"{self.path.name}: line {mesh.line}"
            return LinkShape(
                file, element.pose(), 1000.0 * float(scales[0]), self._colour(element), where
            )
        return None

    def _file(self, name: str) -> Path | None:
        """Return the file of a mesh.

        A package is a folder of its name above the URDF, or next to a folder above the URDF.
        """
        if name.startswith("package://"):
            package, _, relative_path = name[len("package://") :].partition("/")
            folders = [folder / package for folder in locate(self.path).resolve().parents]
            return next(
                (folder / relative_path for folder in folders if is_there(folder / relative_path)),
                None,
            )
        file = Path(name.removeprefix("file://"))
        file = file if file.is_absolute() else locate(self.path).resolve().parent / file
        return file if is_there(file) else None

    def _colour(self, visual: Element) -> tuple[float, float, float] | None:
        material = visual.first("material")
        if material is None:
            return None
        shared = {element.attributes.get("name"): element for element in self.top.all("material")}
        for element in (material, shared.get(material.attributes.get("name"))):
            colour = None if element is None else element.first("color")
            if colour is not None:
                red, green, blue = np.clip(
                    colour.numbers("rgba", 4, "0.8 0.8 0.8 1")[:3], 0.0, 1.0
                ).tolist()
                return (red, green, blue)
        return None


def _is_along(direction: Array, axis: Array) -> bool:
    return bool(np.linalg.norm(np.cross(direction, axis)) < PARALLEL_TOLERANCE_RAD)


def _turn_out(to_tip: Array, axis: Array, tip: str, notes: list[str]) -> Array:
    """Return the pose (4, 4) of a tip in its last moving link, with Z rotated to X if X is along
    the axis (3,).

    In ROS-Industrial, X of `flange` points outwards, as Z of tool0 does.
    """
    if _is_along(to_tip[:3, 2], axis) or not _is_along(to_tip[:3, 0], axis):
        return to_tip
    notes.append(
        Text(
            "the X of {} points out of the flange, not its Z; the flange frame is rotated, as "
            "tool0 is from flange",
            tip,
        )
    )
    inwards = float(to_tip[:3, 0] @ to_tip[:3, 3]) < -BEHIND_MM
    return np.asarray(
        to_tip
        @ frames.pose(frames.about_y(-0.5 * math.pi if inwards else 0.5 * math.pi), (0.0, 0.0, 0.0))
    )


def _xacro_in(element: Element) -> Element | None:
    """Return the first element that only xacro understands: in its namespace, or with an expression
    in a name.
    """
    expressions = ("${", "$(")
    if element.tag.startswith("xacro:") or any(
        mark in element.attributes.get(name, "")
        for name in ("name", "link", "joint")
        for mark in expressions
    ):
        return element
    return next(
        (inner for child in element.children if (inner := _xacro_in(child)) is not None), None
    )


def _check_joint(joint: Element) -> None:
    """Raise InputError BAD_URDF for unknown content of a joint that may move its link, and for
    lengths that are not in m.
    """
    for child in joint.children:
        if child.tag not in JOINT_TAGS:
            raise child.bad(
                Text(
                    "unknown <{}> in the joint {!r}, which may move links; remove the element",
                    child.tag,
                    joint.text("name"),
                )
            )
        if child.tag in SINGLE_TAGS and len(list(joint.all(child.tag))) > 1:
            raise child.bad(
                Text(
                    "the joint {!r} has several <{}>; keep one element",
                    joint.text("name"),
                    child.tag,
                )
            )
        unknown = set(child.attributes) - ATTRIBUTES.get(child.tag, set(child.attributes))
        if unknown:
            raise child.bad(
                Text(
                    "<{}> has no attribute {}; remove the attribute", child.tag, sorted(unknown)[0]
                )
            )
    axis = joint.first("axis")
    if axis is not None and axis.numbers("rpy", 3, "0 0 0").any():
        raise axis.bad("<axis> has no rpy; turn its xyz")
    distance_m = 0.001 * float(np.abs(joint.pose()[:3, 3]).max())
    if distance_m > FARTHEST_M:
        raise joint.bad(
            Text(
                "the origin of the joint {!r} is {:g} m away; a URDF uses metres: divide "
                "millimetres by 1000",
                joint.text("name"),
                distance_m,
            )
        )


def _joint_notes(joints: Sequence[Element]) -> list[str]:
    """Return notes on limits that are substituted or unused."""
    notes: list[str] = []
    for joint in joints:
        limit, soft = joint.first("limit"), joint.first("safety_controller")
        if limit is not None and joint.text("type") != "continuous":
            missing = [name for name in ("lower", "upper") if name not in limit.attributes]
            notes += [
                Text("line {}: the limit has no {}; 0 is used", limit.line, name)
                for name in missing
            ]
        if soft is not None and {"soft_lower_limit", "soft_upper_limit"} & set(soft.attributes):
            notes.append(Text("line {}: soft limits are not used", soft.line))
    return notes


def _rounded_angles(joints: Sequence[Element]) -> list[str]:
    """Return notes on angles that count as right angles although they deviate by more than rounding
    of their last digit.
    """
    notes: list[str] = []
    for joint in joints:
        origin = joint.first("origin")
        for word in [] if origin is None else origin.words("rpy", 3, "0 0 0"):
            off = abs(urdf_xml.unrounded(word) - float(word))
            if off >= 10.0 ** -len(word.partition(".")[2]):
                line = joint.line if origin is None else origin.line
                notes.append(Text("line {}: {} is treated as a right angle", line, word))
    return notes


def _axis(joint: Element) -> Array:
    element = joint.first("axis")
    axis = np.array([1.0, 0.0, 0.0]) if element is None else element.numbers("xyz", 3, "1 0 0")
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        raise (element or joint).bad(Text("the axis of {!r} has no direction", joint.text("name")))
    return np.asarray(axis / length)


def unrounded_limit(word: str) -> float:
    """Return the joint limit that a number represents, rad: a whole degree, or the number itself.

    With two decimals only multiples of five degrees count, because every number is near a whole
    degree.
    """
    has_few_decimals = len(word.partition(".")[2]) < 3
    return urdf_xml.nearest(word, 5.0 * DEGREE if has_few_decimals else DEGREE)


def _limits(joint: Element) -> tuple[float, float, float]:
    """Return lower limit, upper limit and speed; rounded whole degrees become exact."""
    kind = joint.text("type")
    limit = joint.first("limit")
    unit = 1000.0 if kind == "prismatic" else 1.0
    if limit is None:
        if kind != "continuous":
            raise joint.bad(
                Text(
                    "the joint {!r} has no <limit>; add the limit, or make the joint continuous",
                    joint.text("name"),
                )
            )
        return -math.inf, math.inf, math.inf
    values = []
    for name in ("lower", "upper", "velocity"):
        value = limit.number(name, "0")
        values.append(
            unit * value
            if unit != 1.0
            else unrounded_limit(limit.attributes.get(name, "0").strip())
        )
    lower, upper, speed = values
    if speed < 0.0:
        raise limit.bad(Text("the velocity {:g} is negative; give a positive velocity", speed))
    if kind == "revolute" and max(abs(lower), abs(upper)) > MOST_RAD:
        raise limit.bad(
            Text(
                "the limits of {!r} run from {:g} to {:g} rad, many turns; a URDF uses radians: "
                "convert degrees, or make the joint continuous",
                joint.text("name"),
                lower,
                upper,
            )
        )
    if kind == "continuous":
        lower, upper = -math.inf, math.inf
    if not lower < upper:
        raise limit.bad(
            Text(
                "the limits of {!r} run from {:g} to {:g}; give the lower limit first",
                joint.text("name"),
                lower,
                upper,
            )
        )
    return lower, upper, speed if speed > 0.0 else math.inf
