# SPDX-License-Identifier: LGPL-2.1-or-later
"""A whole cell from one URDF: robot, track and positioner, identified by the joint tree.

The robot is the chain of six consecutive revolute axes, on the floor or on prismatic axes, which
are its track. Joints moved by its tool are ignored. Everything else that moves relative to the
floor carries the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NoReturn

import numpy as np

from ...geometry import frames
from ...geometry.job_files import is_there
from ...issues import InputError, Text
from ...parameters.cell_records import EXTERNAL_KEY, PART, ROBOT, ExternalMechanism
from ...parameters.records import Pose
from ...types import Array
from .elements import CODE
from .machine import WHOLE_CELL
from .read import FIXED, TIPS, Urdf
from .read import ROBOT as AXES
from .reference import Reference, reference

TURNING, SLIDING = ("revolute", "continuous"), "prismatic"
Way = tuple[str, ...]  # the joints that move a link, starting at the floor


class UrdfCell:
    """The mechanisms of a URDF.

    robot, track, positioner: joint names, starting at the floor; empty if absent. Raises InputError
    BAD_URDF if the mechanisms cannot be identified.
    """

    def __init__(self, path: Path | str) -> None:
        self.urdf = Urdf(path)
        self.ways: dict[str, Way] = {link: self._way(link) for link in self.urdf.links}
        self.joints = {joint.text("name"): joint for joint in self.urdf.parent.values()}
        moved_chains = set(self.ways.values()) - {()}

        def is_farthest(joint_names: Way) -> bool:
            longer_chains = (chain for chain in moved_chains if chain != joint_names)
            return all(chain[: len(joint_names)] != joint_names for chain in longer_chains)

        self.farthest = sorted(filter(is_farthest, moved_chains))
        robots = sorted(
            {robot for joint_names in self.farthest if (robot := self._robot(joint_names))}
        )
        if len(robots) != 1:
            self._refuse(self._several(robots) if robots else self._no_robot())
        robot_chain = robots[0]
        self.track, self.robot = robot_chain[:-AXES], robot_chain[-AXES:]
        self.positioner = self._positioner(robot_chain)

    def machine(self) -> Reference:
        """Return the reference to the robot."""
        return self._reference(self.robot, self._tip((*self.track, *self.robot)))

    def external(self) -> tuple[ExternalMechanism, ...]:
        """Return track and positioner at their poses in the world.

        Returns
        -------
        tuple of ExternalMechanism
            Mechanisms. The world is the base frame of the robot with the track at zero.
        """
        robot = self.machine()
        assert robot.base is not None  # set by _reference
        world, mechanisms = frames.inverse(self._stands(robot)), []
        external = (
            (self.track, robot.base, ROBOT),
            (self.positioner, self._tip(self.positioner), PART),
        )
        for joint_names, tip, carried in external:
            if joint_names:
                mechanism_reference = self._reference(joint_names, tip)
                mechanisms.append(
                    ExternalMechanism(
                        str(mechanism_reference),
                        _six(world @ self._stands(mechanism_reference)),
                        carried,
                    )
                )
        return tuple(mechanisms)

    def _way(self, link: str) -> Way:
        above = [link, *self.urdf.above(link)][:-1]
        joints = [self.urdf.parent[below] for below in reversed(above)]
        return tuple(joint.text("name") for joint in joints if joint.text("type") != FIXED)

    def _turns(self, joint: str) -> bool:
        element = self.joints[joint]
        return element.text("type") in TURNING and element.first("mimic") is None

    def _slides(self, joint: str) -> bool:
        return self.joints[joint].text("type") == SLIDING

    def _robot(self, joint_names: Way) -> Way:
        """Return the joints of robot and track at the start of a chain; empty without a robot."""
        first_revolute = next(
            (k for k, joint in enumerate(joint_names) if not self._slides(joint)), len(joint_names)
        )
        end = first_revolute + AXES
        if len(joint_names) < end or not all(
            self._turns(joint) for joint in joint_names[first_revolute:end]
        ):
            return ()
        further = {
            chain[end]
            for chain in self.ways.values()
            if chain[:end] == joint_names[:end] and len(chain) > end
        }
        seventh = len(further) == 1 and self._turns(
            next(iter(further))
        )  # this is a seven-axis arm; grippers have two fingers that are prismatic or mimic
        return () if seventh else joint_names[:end]

    def _positioner(self, robot: Way) -> Way:
        """Return the joints of the part carrier: all joints that are independent of the robot."""
        other_chains = [
            joint_names for joint_names in self.farthest if joint_names[: len(robot)] != robot
        ]
        for joint_names in other_chains:
            if joint_names[0] == robot[0]:
                self._refuse(
                    Text(
                        "{!r} is carried by {!r}, as the robot is; attach the positioner to the "
                        "floor",
                        joint_names[-1],
                        joint_names[0],
                    )
                )
        if len(other_chains) > 1:
            names = ", ".join(" - ".join(joint_names) for joint_names in other_chains)
            self._refuse(
                Text(
                    "besides the robot the file has {} chains ({}), but only one can carry the "
                    "part; name this chain in `{}`, with base and tip",
                    len(other_chains),
                    names,
                    EXTERNAL_KEY,
                )
            )
        return other_chains[0] if other_chains else ()

    def _tip(self, joint_names: Way) -> str:
        """Return the link moved by all these joints whose name marks a tool or part mount.

        Otherwise return a link whose Z points out, the farthest from the base.
        """
        if not joint_names:
            return ""
        links = [link for link, moved in self.ways.items() if moved == joint_names]
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

    def _reference(self, joint_names: Way, tip: str) -> Reference:
        return Reference(
            str(self.urdf.path), self.joints[joint_names[0]].one("parent").text("link"), tip
        )

    def _stands(self, mechanism_reference: Reference) -> Array:
        """Return the manufacturer's base frame (4, 4) of a mechanism relative to the first link of
        the file, with all joints at zero.
        """
        assert mechanism_reference.base is not None and mechanism_reference.tip is not None
        description = self.urdf.between(mechanism_reference.base, mechanism_reference.tip)
        pose = np.eye(4)
        for link in reversed(
            [mechanism_reference.base, *self.urdf.above(mechanism_reference.base)][:-1]
        ):
            pose = pose @ self.urdf.parent[link].pose()
        return pose if description.base is None else np.asarray(pose @ description.base)

    def _no_robot(self) -> str:
        longest = max(self.farthest, key=len, default=())
        return Text(
            "the file has no robot: no chain has six revolute axes on a fixed base or prismatic "
            "axes; the longest is {}",
            " - ".join(longest) or "none",
        )

    def _several(self, robots: Sequence[Way]) -> str:
        return Text(
            "the file has {} robots, with the last axes {}; name the robot in `cell.machine`, "
            "with base and tip, and its external axes in `{}`",
            len(robots),
            ", ".join(robot_joints[-1] for robot_joints in robots),
            EXTERNAL_KEY,
        )

    def _refuse(self, message: str) -> NoReturn:
        raise InputError(CODE, self.urdf.path.name, message)


def cell_values(cell_reference: Reference) -> tuple[str, tuple[ExternalMechanism, ...]]:
    """Return machine and external axes of a URDF that describes the whole cell.

    Parameters
    ----------
    cell_reference : Reference
        The file, without base and tip.

    Returns
    -------
    machine : str
        Text for the machine of the cell.
    external : tuple of ExternalMechanism
        The external axes.

    Raises
    ------
    InputError
        UNKNOWN_MACHINE if the file is missing, BAD_URDF if the mechanisms cannot be identified,
        BAD_VALUE if base or tip is given.
    """
    if cell_reference.base is not None or cell_reference.tip is not None:
        raise InputError(
            "BAD_VALUE",
            EXTERNAL_KEY,
            "{} uses the whole file; remove base and tip of the machine, or list the mechanisms",
            WHOLE_CELL,
        )
    if not is_there(cell_reference.file):
        raise InputError(
            "UNKNOWN_MACHINE",
            "cell.machine",
            "URDF {} does not exist; check the path",
            cell_reference.file,
        )
    urdf_cell = UrdfCell(cell_reference.file)
    return str(urdf_cell.machine()), urdf_cell.external()


def cell_values_of_machine(machine: object) -> tuple[str, tuple[ExternalMechanism, ...]]:
    """Return machine and external axes from the machine parameter of a cell.

    Parameters
    ----------
    machine : object
        Machine parameter of the cell.

    Returns
    -------
    machine : str
        Text for the machine of the cell.
    external : tuple of ExternalMechanism
        The external axes.

    Raises
    ------
    InputError
        BAD_VALUE if the machine is not a URDF; otherwise the errors of `cell_values`.
    """
    cell_reference = reference(machine) if isinstance(machine, str) else None
    if cell_reference is None:
        raise InputError(
            "BAD_VALUE",
            EXTERNAL_KEY,
            "{} needs a machine that is the URDF of the whole cell, such as machine: bay.urdf; "
            "otherwise give a list of mechanisms",
            WHOLE_CELL,
        )
    return cell_values(cell_reference)


def _six(pose: Array) -> Pose:
    x, y, z, a, b, c = (
        np.round([*pose[:3, 3], *frames.to_bryant(pose[:3, :3])], 12) + 0.0
    ).tolist()
    return x, y, z, a, b, c
