# SPDX-License-Identifier: LGPL-2.1-or-later
"""A whole cell from one URDF: robot, track and positioner told apart by the tree of its joints.

The robot is where six axes in a row turn, on nothing or on axes that slide, which are its track; what its tool moves further
on is left alone. What else moves against the floor carries the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np

from ...geometry import frames
from ...geometry.located import is_there
from ...issues import InputError, Text
from ...parameters.external import MORE, PART, ROBOT, WHERE, External, Pose
from ...types import Array
from .elements import CODE
from .machine import WHOLE
from .read import FIXED, TIPS, Urdf
from .read import ROBOT as AXES
from .reference import Reference, reference

TURNING, SLIDING = ("revolute", "continuous"), "prismatic"
Way = tuple[str, ...]  # the joints that move a link, from the floor on


class UrdfCell:
    """The mechanisms of a URDF: `robot` and `track`, the joints that move them, and `positioner`, all from the floor on;
    empty where there is none.

    Raises InputError BAD_URDF where they cannot be told apart.
    """

    def __init__(self, path: Path | str) -> None:
        self.urdf = Urdf(path)
        self.ways: dict[str, Way] = {link: self._way(link) for link in self.urdf.links}
        self.joints = {joint.text("name"): joint for joint in self.urdf.parent.values()}
        known = set(self.ways.values()) - {()}
        self.farthest = sorted(
            way for way in known if not any(one[: len(way)] == way and one != way for one in known)
        )
        robots = sorted({robot for way in self.farthest if (robot := self._robot(way))})
        if len(robots) != 1:
            self._refuse(self._several(robots) if robots else self._no_robot())
        whole = robots[0]
        self.track, self.robot = whole[:-AXES], whole[-AXES:]
        self.positioner = self._positioner(whole)

    def machine(self) -> Reference:
        """The robot."""
        return self._reference(self.robot, self._tip((*self.track, *self.robot)))

    def external(self) -> tuple[External, ...]:
        """Track and positioner, where they stand in the world: the robot's base frame with the track at zero."""
        robot = self.machine()
        assert robot.base is not None  # named by _reference
        world, found = frames.inverse(self._stands(robot)), []
        external = (
            (self.track, robot.base, ROBOT),
            (self.positioner, self._tip(self.positioner), PART),
        )
        for way, tip, carried in external:
            if way:
                meant = self._reference(way, tip)
                found.append(External(str(meant), _six(world @ self._stands(meant)), carried))
        return tuple(found)

    def _way(self, link: str) -> Way:
        above = [link, *self.urdf.above(link)][:-1]
        joints = [self.urdf.parent[one] for one in reversed(above)]
        return tuple(joint.text("name") for joint in joints if joint.text("type") != FIXED)

    def _turns(self, joint: str) -> bool:
        element = self.joints[joint]
        return element.text("type") in TURNING and element.first("mimic") is None

    def _slides(self, joint: str) -> bool:
        return self.joints[joint].text("type") == SLIDING

    def _robot(self, way: Way) -> Way:
        """The joints of a robot and of what it stands on, which a way begins with; none where there is none."""
        first = next((k for k, joint in enumerate(way) if not self._slides(joint)), len(way))
        end = first + AXES
        if len(way) < end or not all(self._turns(joint) for joint in way[first:end]):
            return ()
        further = {
            one[end] for one in self.ways.values() if one[:end] == way[:end] and len(one) > end
        }
        seventh = len(further) == 1 and self._turns(
            next(iter(further))
        )  # an arm; fingers are two, slide, or follow
        return () if seventh else way[:end]

    def _positioner(self, robot: Way) -> Way:
        """What carries the part: all that moves apart from the robot."""
        others = [way for way in self.farthest if way[: len(robot)] != robot]
        for way in others:
            if way[0] == robot[0]:
                self._refuse(
                    Text(
                        "{!r} is carried by {!r}, as the robot is; let the positioner stand on the floor",
                        way[-1],
                        way[0],
                    )
                )
        if len(others) > 1:
            names = ", ".join(" - ".join(way) for way in others)
            self._refuse(
                Text(
                    "{} chains move beside the robot ({}), and one can carry the part; name it in `{}`, with base "
                    "and tip",
                    len(others),
                    names,
                    WHERE,
                )
            )
        return others[0] if others else ()

    def _tip(self, way: Way) -> str:
        """The link that so many joints move and whose name tells that tools or parts stand on it; else one whose Z points
        out, farthest out."""
        if not way:
            return ""
        links = [link for link, moved in self.ways.items() if moved == way]
        depth = {link: len(self.urdf.above(link)) for link in links}
        return min(
            links,
            key=lambda link: (
                not self.urdf.points_out(link),
                not link.endswith(TIPS),
                -depth[link],
                link,
            ),
        )

    def _reference(self, way: Way, tip: str) -> Reference:
        return Reference(str(self.urdf.path), self.joints[way[0]].one("parent").text("link"), tip)

    def _stands(self, meant: Reference) -> Array:
        """(4, 4) the maker's base frame of a mechanism, seen from the first link of the file, all joints at zero."""
        assert meant.base is not None and meant.tip is not None
        found = self.urdf.between(meant.base, meant.tip)
        at = np.eye(4)
        for link in reversed([meant.base, *self.urdf.above(meant.base)][:-1]):
            at = at @ self.urdf.parent[link].pose()
        return at if found.base is None else np.asarray(at @ found.base)

    def _no_robot(self) -> str:
        longest = max(self.farthest, key=len, default=())
        return Text(
            "there is no robot in it: no chain has six turning axes on nothing but axes that slide; the longest is "
            "{}",
            " - ".join(longest) or "none",
        )

    def _several(self, robots: Sequence[Way]) -> str:
        return Text(
            "there are {} robots in it, the last axes of which are {}; name one in `cell.machine`, with base and "
            "tip, and what stands beside it in `{}`",
            len(robots),
            ", ".join(one[-1] for one in robots),
            WHERE,
        )

    def _refuse(self, message: str) -> NoReturn:
        raise InputError(CODE, self.urdf.path.name, message)


def texts_of(meant: Reference) -> tuple[str, str]:
    """What a cell names as its machine and its external axes, of a URDF that has them all.

    Raises InputError BAD_URDF where they cannot be told apart, BAD_VALUE where links of one of them are named.
    """
    if meant.base is not None or meant.tip is not None:
        raise InputError(
            "BAD_VALUE",
            WHERE,
            "{} takes all of the file; leave out base and tip of the machine, or name the "
            "mechanisms one by one",
            WHOLE,
        )
    if not is_there(meant.file):
        raise InputError(
            "UNKNOWN_MACHINE", "cell.machine", "there is no URDF {}; check the path", meant.file
        )
    found = UrdfCell(meant.file)
    external = f"{MORE} ".join(map(str, found.external()))
    return str(found.machine()), external or "none"


def texts_of_machine(machine: object) -> tuple[str, str]:
    """The same of what a cell names as its machine; InputError BAD_VALUE where that is no URDF."""
    meant = reference(machine) if isinstance(machine, str) else None
    if meant is None:
        raise InputError(
            "BAD_VALUE",
            WHERE,
            "{} is for a machine that is the URDF of the whole cell, such as machine: "
            "bay.urdf; or give a list of mechanisms",
            WHOLE,
        )
    return texts_of(meant)


def _six(pose: Array) -> Pose:
    x, y, z, a, b, c = (
        np.round([*pose[:3, 3], *frames.to_bryant(pose[:3, :3])], 12) + 0.0
    ).tolist()
    return x, y, z, a, b, c
