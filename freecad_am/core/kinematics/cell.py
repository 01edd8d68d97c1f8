# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell: a machine, its load, and the deposition point.

The one freedom at a point of the toolpath is the rotation phi about the tool axis. It is
measured from a reference carried along without twist: the smallest rotation that takes
the tool axis to the Z of the platform. With M the rotation from part coordinates to
coordinates of the deposition point, M = Rz(phi) S(t) and M t = Z (Chalvin 2020, eq. 10).
RZ of the paper is the last Bryant angle of the same M = Rx(RX) Ry(RY) Rz(RZ) (eq. 9); the
two differ, and RZ degenerates where t is horizontal (ERRATA).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..families.family import ON_FEATURE
from ..families.registry import DEFAULT_KIND, KINDS
from ..geometry import frames
from ..geometry.columns import columns
from ..geometry.obstacles import Body
from ..issues import InputError, Text, Word
from ..parameters.cell import CellParameters, NozzleParameters
from ..parameters.cell_records import PART, TOUCHED_KEY, TouchedPoint
from ..types import Array
from .arrangement import Arrangement, arrangement_of, planned_of
from .external import ExternalAxes, coupled, upward
from .inverse import spherical_wrist
from .limits import Limits, PoseFrames
from .links.external_links import ExternalLink, external_links
from .machines import machine as machines
from .machines.machine import Machine
from .torch import Torch

CODE = "TOUCHED"
MIN_POINTS = 3
LINE = 0.05  # minimum distance of points from a line, as a share of their spread
SAME_SIZE = 0.01  # allowed error of the distances between points, as a share
_UNITS = (
    (25.4, "inches"),
    (1000.0, "m"),
    (10.0, "cm"),
    (1.0 / 25.4, "inches"),
    (1e-3, "m"),
    (0.1, "cm"),
)


@dataclass(frozen=True, eq=False)
class WorkOffset:
    """pose: (4, 4) of the part's coordinates in the manufacturer's base frame. residual: (n,) mm,
    the distance of each point from its touched position.
    """

    pose: Array
    residual: Array

    def six(self) -> Array:
        """Return the pose as six numbers.

        Returns
        -------
        (6,) array
            x y z in mm and RX RY RZ in degrees (Bryant angles).
        """
        return np.concatenate([self.pose[:3, 3], np.degrees(frames.to_bryant(self.pose[:3, :3]))])


def offset_of_cell(parameters: CellParameters, arrangement: Arrangement) -> WorkOffset | None:
    """Return the pose of the part of a cell from touched points; None without any. Raises
    InputError TOUCHED.
    """
    points = parameters.touched
    if not points:
        return None
    carried = any(external_axis.carries == PART for external_axis in parameters.external)
    if arrangement.carries_part or carried:
        raise InputError(
            CODE,
            TOUCHED_KEY,
            "touched points calibrate a part that the robot moves, but here the part is fixed "
            "and the robot holds the tool; remove them, and measure cell.platform or the pose of "
            "the positioner",
        )
    return work_offset(points, parameters.touched_tolerance)


def work_offset(points: Sequence[TouchedPoint], tolerance: float) -> WorkOffset:
    """Return the pose of the part.

    Raises InputError TOUCHED for fewer than three points, collinear points, points at another
    scale, and a point that is farther than `tolerance` mm from its touched position.
    """
    if len(points) < MIN_POINTS:
        raise InputError(
            CODE,
            TOUCHED_KEY,
            "{} point(s) cannot locate a part; touch at least {}, spread out and not collinear",
            len(points),
            MIN_POINTS,
        )
    part_points, robot_points = (
        np.array([getattr(touched_point, side) for touched_point in points])
        for side in ("part", "robot")
    )
    centred_part = part_points - part_points.mean(axis=0)
    centred_robot = robot_points - robot_points.mean(axis=0)
    for side, centred in (("part", centred_part), ("robot", centred_robot)):
        spread = np.linalg.svd(centred, compute_uv=False)
        if not spread[1] > LINE * spread[0]:
            raise InputError(
                CODE,
                TOUCHED_KEY,
                "the points {} are collinear or coincide, so the rotation about their line is "
                "undetermined; touch a point off that line",
                Word("touched" if side == "robot" else "on the part"),
            )
    _refuse_other_size(float(np.linalg.norm(centred_robot) / np.linalg.norm(centred_part)))
    u, _, vt = np.linalg.svd(centred_part.T @ centred_robot)
    turn = (u @ np.diag([1.0, 1.0, np.sign(np.linalg.det(u @ vt))]) @ vt).T
    pose = frames.pose(turn, robot_points.mean(axis=0) - turn @ part_points.mean(axis=0))
    residual = np.linalg.norm(part_points @ turn.T + pose[:3, 3] - robot_points, axis=1)
    worst = int(np.argmax(residual))
    if residual[worst] > tolerance:
        text = ", ".join(f"{value:.3g}" for value in residual)
        raise InputError(
            CODE,
            TOUCHED_KEY,
            "point {} is {:.3g} mm from its touched position (all points: {} mm), more than "
            "cell.touched_tolerance = {:g} mm; touch it again, and check the order of the "
            "points, the part, and the tip calibration",
            worst + 1,
            residual[worst],
            text,
            tolerance,
        )
    return WorkOffset(pose, residual)


def _refuse_other_size(ratio: float) -> None:
    """Reject touched points at another scale than the planned part."""
    if abs(ratio - 1.0) <= SAME_SIZE:
        return
    unit = next((name for factor, name in _UNITS if abs(ratio * factor - 1.0) <= SAME_SIZE), "")
    raise InputError(
        CODE,
        TOUCHED_KEY,
        "the touched points are {:.4g} times as far apart as planned; {}",
        ratio,
        Word(
            Text("one set is in {}; give both in mm", unit)
            if unit
            else "the points belong to another part, or are in another order"
        ),
    )


UP = (0.0, 0.0, 1.0)

# the tip's Z points out of the nozzle, the tool axis from the deposit towards the tool
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class CellShapes:
    """The shapes in a cell besides robot and part.

    obstacles: obstacles in the world, the manufacturer's base frame. torch: the holder of the
    nozzle, in the frame of its tip, Z into it. external_links: the known links of positioner
    and track, each in its own frame.
    """

    obstacles: tuple[Body, ...] = ()
    torch: Torch | None = None
    external_links: tuple[ExternalLink, ...] = ()


@dataclass(frozen=True, eq=False)
class CellPoses:
    """The poses (4, 4) of a cell, mm.

    station: in base_link, the deposition point (part on robot, five-axis machine) or the
    fixed platform (tool on robot). carried: on the flange, the platform (part on robot,
    five-axis machine) or the nozzle's tip (tool on robot). A five-axis machine is a chain
    seen from the torch, so the part is on its flange wherever its axes are. mount: in part
    coordinates, the frame on the platform. offset: pose of the part from touched points.
    """

    station: Array
    carried: Array
    mount: Array
    offset: WorkOffset | None = None

    def to_flange(self, position: Array, tool: Array) -> tuple[Array, Array]:
        """Return points and tool axes of the part in the frame of the flange that carries it.

        Parameters
        ----------
        position : (n, 3) array
            Points in part coordinates, mm.
        tool : (n, 3) array
            Tool axes in part coordinates.

        Returns
        -------
        position : (n, 3) array
            Points in the flange frame, mm.
        tool : (n, 3) array
            Tool axes in the flange frame.
        """
        flange_frame = self.carried @ frames.inverse(self.mount)
        return position @ flange_frame[:3, :3].T + flange_frame[:3, 3], tool @ flange_frame[
            :3, :3
        ].T

    def phi_of_rz(self, tool: Array, rz: Array) -> tuple[Array, Array]:
        """Return the rotation phi for the RZ of the paper.

        Parameters
        ----------
        tool : (n, 3) array
            Tool axes in part coordinates, unit vectors.
        rz : (n,) array
            RZ, rad.

        Returns
        -------
        phi : (n,) array
            Rotation about the tool axes, rad.
        rate : (n,) array
            d phi / d RZ.

        References
        ----------
        Chalvin 2020, eqs. 14 and 15.
        """
        t = tool @ self.mount[:3, :3]
        cos, sin = np.cos(rz), np.sin(rz)
        sx = t[:, 1] * cos + t[:, 0] * sin
        sy = -(t[:, 0] * cos - t[:, 1] * sin)
        cx = np.sqrt(sy * sy + t[:, 2] ** 2)
        level = np.where(cx > 0.0, cx, 1.0)
        # Rx Ry Rz on the first row of the rotation that brings the tool upright; two of its entries give the angle
        x, y, z = columns(frames.smallest_rotation(t, UP)[:, 0])
        x, y = cos * x - sin * y, sin * x + cos * y
        cos_y, sin_y = np.where(cx > 0.0, t[:, 2], 1.0) / level, sy / level
        first_row = cos_y * x + sin_y * z, cx * y - sx * (cos_y * z - sin_y * x)
        return np.arctan2(first_row[1], first_row[0]), t[:, 2] / np.maximum(cx * cx, 1e-300)

    def rz_of_phi(self, tool: Array, phi: Array) -> Array:
        """Return the RZ of the paper for rotations phi.

        Parameters
        ----------
        tool : (n, 3) array
            Tool axes in part coordinates, unit vectors.
        phi : (n,) array
            Rotation about the tool axes, rad.

        Returns
        -------
        (n,) array
            RZ in -pi to pi, rad.
        """
        t = tool @ self.mount[:3, :3]
        upright = frames.smallest_rotation(t, UP)
        first_row = np.cos(phi)[:, None] * upright[:, 0] - np.sin(phi)[:, None] * upright[:, 1]
        side = np.where(t[:, 2] < 0.0, -1.0, 1.0)
        rz: Array = np.arctan2(-first_row[:, 1] * side, first_row[:, 0] * side)
        return rz


@dataclass(frozen=True, eq=False)
class Cell:
    """A resolved cell: a machine with its limits and its surroundings.

    poses: of deposition point, platform, nozzle and part. branch: index of the branch
    (spherical_wrist.branch_index), or None to search all. external: external axes; the machine is then
    the robot together with them, and base_link of its chain is the face that carries the
    part, or the world if only the robot is carried. up: (3,) against gravity in the world,
    the manufacturer's base frame. shapes: the bodies in the cell besides robot and part.
    """

    machine: Machine
    limits: Limits
    setup: str
    poses: CellPoses
    branch: int | None
    nozzle: NozzleParameters = field(default_factory=NozzleParameters)
    platform_diameter: float = 0.0
    external: ExternalAxes | None = None
    arm_clearance: float | None = None
    up: Array = field(default_factory=lambda: np.array(UP))
    shapes: CellShapes = CellShapes()

    @property
    def robot(self) -> Machine:
        """The machine without external axes, for which an inverse exists."""
        return self.machine if self.external is None else self.external.robot

    def external_of(self, joints: Array) -> Array | None:
        """Return the values of the external axes among joints.

        Parameters
        ----------
        joints : (..., axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (..., k) array or None
            None without external axes.
        """
        return None if self.external is None else joints[..., self.robot.chain.axes :]

    def links(self, joints: Array) -> Array:
        """Return the frames of the robot's links.

        Parameters
        ----------
        joints : (..., axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (..., axes + 1, 4, 4) array
            Frames seen from the start of the machine's chain, base_link first, mm.
        """
        external = self.external_of(joints)
        if self.external is None or external is None:
            return self.machine.chain.links(joints)
        robot_chain = self.robot.chain
        moved: Array = self.external.base(external)[..., None, :, :] @ robot_chain.links(
            joints[..., : robot_chain.axes]
        )
        return moved

    def world(self, joints: Array) -> Array:
        """Return the world frame, seen from the start of the chain.

        The world is the manufacturer's base frame.

        Parameters
        ----------
        joints : (n, axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (n, 4, 4) array
            Poses, mm.
        """
        if self.external is None:
            return np.broadcast_to(self.machine.base, (len(joints), 4, 4))
        values = np.array(joints[..., self.robot.chain.axes :])
        if (
            self.external.slides is not None
        ):  # with its track at zero the robot has the same pose in the world as without a track
            values[:, self.external.slides] = 0.0
        base_frames: Array = self.external.base(values) @ self.robot.base
        return base_frames

    def external_link_frames(self, joints: Array) -> Array:
        """Return the frames of the links of external axes.

        Parameters
        ----------
        joints : (n, axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (n, links, 4, 4) array
            Frames of `shapes.external_links`, seen from the start of the machine's chain, mm.
        """
        values = self.external_of(joints)
        if not self.shapes.external_links or self.external is None or values is None:
            return np.zeros((len(joints), 0, 4, 4))
        links = self.external.links(values)
        in_world = np.stack(
            [links[link.mechanism][:, link.link] for link in self.shapes.external_links], axis=1
        )
        return np.asarray(self.world(joints)[:, None] @ in_world)

    @property
    def arrangement(self) -> Arrangement:
        """The load of the flange, and its consequences."""
        return arrangement_of(self.setup)

    @property
    def part_moves(self) -> bool:
        """Whether the part moves in the world."""
        return self.arrangement.carries_part or (
            self.external is not None and bool(self.external.turning)
        )

    @property
    def carriers(self) -> tuple[Machine, ...]:
        """Return the machines that carry and move the part, from the floor on.

        Returns
        -------
        tuple of Machine
            The part is on the face, or the flange, of the last one; empty if it does
            not move.
        """
        if self.arrangement.carries_part:
            return (self.machine,)
        return () if self.external is None else self.external.carriers

    def in_part(self) -> tuple[Body, ...]:
        """Return the obstacles in part coordinates.

        Returns
        -------
        tuple of Body
            Empty if the part moves in the world.
        """
        if self.part_moves or not self.shapes.obstacles:
            return ()
        world = self.world(np.zeros((1, self.machine.chain.axes)))[0]
        to_part = self.poses.mount @ frames.inverse(self.poses.station) @ world
        return tuple(body.move(to_part) for body in self.shapes.obstacles)

    def pose_frames(
        self, position: Array, tool: Array, external: Array | None = None
    ) -> PoseFrames:
        """Return the factors of flange poses that stay constant while the rotation varies.

        Parameters
        ----------
        position : (n, 3) array
            Points in part coordinates, mm.
        tool : (n, 3) array
            Tool axes in part coordinates, unit vectors.
        external : (n, k) array or None, optional
            Values of the external axes; required in a cell that has some.

        Returns
        -------
        PoseFrames
            Factors in base_link.
        """
        to_platform = frames.inverse(self.poses.mount)
        points = position @ to_platform[:3, :3].T + to_platform[:3, 3]
        axes = tool @ to_platform[:3, :3].T
        upright = frames.smallest_rotation(axes, UP)
        if self.arrangement.carries_part:
            moved = frames.pose(upright, -np.einsum("nij,nj->ni", upright, points))
            return PoseFrames(
                self.poses.station[None], 1.0, moved @ frames.inverse(self.poses.carried)
            )
        stands = self.poses.station @ frames.pose(np.swapaxes(upright, 1, 2), points)
        if self.external is not None:
            assert (
                external is not None
            )  # callers must pass the values of external axes for such a cell
            stands = frames.inverse(self.external.base(external)) @ stands
        return PoseFrames(stands, -1.0, (_TURNED @ frames.inverse(self.poses.carried))[None])

    def to_carrier(self, position: Array) -> Array:
        """Return points of the part in the frame of the flange or face that carries it.

        Parameters
        ----------
        position : (n, 3) array
            Points in part coordinates, mm.

        Returns
        -------
        (n, 3) array
            Points in the frame of the last of `carriers`, mm.
        """
        carrier_frame = (
            self.poses.carried if self.arrangement.carries_part else self.poses.station
        ) @ frames.inverse(self.poses.mount)
        return np.asarray(position @ carrier_frame[:3, :3].T + carrier_frame[:3, 3])

    def flange_poses(
        self, position: Array, tool: Array, phi: Array, joints: Array | None = None
    ) -> Array:
        """Return flange poses for points and rotations.

        Parameters
        ----------
        position : (n, 3) array
            Points in part coordinates, mm.
        tool : (n, 3) array
            Tool axes in part coordinates, unit vectors.
        phi : (n,) array
            Rotations about the tool axes, rad.
        joints : (n, axes) array or None, optional
            Joints nearby, from which the external axes are taken.

        Returns
        -------
        (n, 4, 4) array
            Poses in base_link, mm.
        """
        return self.pose_frames(
            position, tool, None if joints is None else self.external_of(joints)
        ).flange_poses(phi)

    def tip_in_part(self, flange: Array) -> tuple[Array, Array]:
        """Return tip and axis of the nozzle in part coordinates.

        Parameters
        ----------
        flange : (n, 4, 4) array
            Flange poses in base_link.

        Returns
        -------
        tip : (n, 3) array
            The tip, mm.
        axis : (n, 3) array
            The tool axis, unit vectors.
        """
        if self.torch_stands:
            platform = flange @ self.poses.carried
            in_platform = frames.inverse(platform) @ self.poses.station
        else:
            in_platform = frames.inverse(self.poses.station) @ (
                flange @ self.poses.carried @ _TURNED
            )
        in_part = self.poses.mount @ in_platform
        return in_part[:, :3, 3], in_part[:, :3, 2]

    def tip_at(self, joints: Array) -> Array:
        """Return only the tip of the nozzle, in a third of the time of `tip_in_part`.

        Parameters
        ----------
        joints : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., 3) array
            The tip in part coordinates, mm.
        """
        chain = self.machine.chain
        if self.torch_stands:
            tip = chain.point_from_flange(joints, self.poses.station[:3, 3])
            into = self.poses.mount @ frames.inverse(self.poses.carried)
        else:
            tip = chain.point_position(joints, self.poses.carried[:3, 3])
            into = self.poses.mount @ frames.inverse(self.poses.station)
        in_part: Array = tip @ into[:3, :3].T + into[:3, 3]
        return in_part

    @property
    def torch_stands(self) -> bool:
        """Whether the machine moves only the part, under a fixed torch."""
        return self.arrangement.carries_part

    def deposition_point(self, flange: Array) -> Array:
        """Return the point of deposit for flange poses.

        Parameters
        ----------
        flange : (n, 4, 4) array
            Flange poses in base_link.

        Returns
        -------
        (n, 3) array
            Points in base_link, mm.
        """
        if self.torch_stands:
            return np.broadcast_to(self.poses.station[:3, 3], (len(flange), 3))
        tip: Array = (flange @ self.poses.carried)[:, :3, 3]
        return tip

    def rotation_axis(self, flange: Array) -> Array:
        """Return the angular velocity of the flange per unit of phi.

        Parameters
        ----------
        flange : (n, 4, 4) array
            Flange poses in base_link.

        Returns
        -------
        (n, 3) array
            Unit vectors in base_link; the rotation is about the deposition point.
        """
        if self.torch_stands:
            return np.broadcast_to(self.poses.station[:3, 2], (len(flange), 3))
        axis: Array = (flange @ self.poses.carried)[:, :3, 2]
        return axis


def mounted(parameters: CellParameters, feature_frame: Array, family: str) -> Array:
    """Return the frame that sits on the platform.

    Parameters
    ----------
    parameters : CellParameters
        The cell, with `mount`.
    feature_frame : (4, 4) array
        The feature's own frame in part coordinates.
    family : str
        Kind of the feature; it decides for the mount 'auto'.

    Returns
    -------
    (4, 4) array
        The feature's frame, or the identity for the frame of the part file.
    """
    mount = parameters.mount if parameters.mount != "auto" else KINDS[family].mount
    return np.array(feature_frame) if mount == ON_FEATURE else np.eye(4)


def resolve(
    parameters: CellParameters,
    feature_frame: Array,
    family: str = DEFAULT_KIND,
    folders: Sequence[str] = (),
) -> Cell:
    """Return the cell of a job: the machine file read, the frames combined.

    Parameters
    ----------
    parameters : CellParameters
        The cell as the job describes it.
    feature_frame : (4, 4) array
        The feature's own frame in part coordinates; it sits on the platform when `mount` is
        'feature' (the default for parts of revolution), else the frame of the part file
        does.
    family : str, optional
        Kind of the feature.
    folders : sequence of str, optional
        Folders with user machines.

    Returns
    -------
    Cell
        The cell.

    Raises
    ------
    InputError
        UNKNOWN_MACHINE, BAD_MACHINE, UNKNOWN_LIMITS, NOT_YET for set-ups to come,
        WRONG_SETUP for a robot as a table or the reverse, NO_CLOSED_FORM.
    """
    arrangement = planned_of(parameters.setup)
    machine = machines.load(parameters.machine, tuple(folders))
    mechanisms = parameters.external
    _refuse_otherwise(machine, arrangement, bool(mechanisms))
    platform = parameters.platform
    platform_pose = (
        (0.0, 0.0, platform, 0.0, 0.0, 0.0) if isinstance(platform, (int, float)) else platform
    )
    limits, external = machine.limits(parameters.limits), None
    # the chain of a five-axis machine begins at its torch
    station = frames.bryant(parameters.deposition_point) if arrangement.free else np.eye(4)
    mount = mounted(parameters, feature_frame, family)
    offset = offset_of_cell(parameters, arrangement)
    station = station if offset is None else offset.pose @ mount
    if mechanisms:
        machine, limits, external = coupled(
            machine, limits, mechanisms, parameters.world_up, folders
        )
        station = station if not external.turning else frames.bryant(platform_pose)
    return Cell(
        machine=machine,
        limits=limits,
        setup=parameters.setup,
        poses=CellPoses(
            machine.base @ station,
            frames.bryant(platform_pose if arrangement.carries_part else parameters.nozzle.tool),
            mount,
            offset,
        ),
        branch=None
        if isinstance(parameters.branch, str)
        else spherical_wrist.branch_index(parameters.branch),
        nozzle=parameters.nozzle,
        platform_diameter=parameters.platform_diameter,
        external=external,
        arm_clearance=parameters.arm_clearance,
        up=upward(parameters.world_up),
        shapes=CellShapes(external_links=external_links(external)),
    )


def _refuse_otherwise(machine: Machine, arrangement: Arrangement, has_external: bool) -> None:
    """Raise InputError WRONG_SETUP for a set-up that the machine or external axes do not support,
    NO_CLOSED_FORM for an arm without a known inverse.
    """
    if arrangement not in machine.arrangements:
        kind = "is a robot" if machine.free else "has prismatic axes"
        setups = Text.joined(
            " or ", (candidate.setup for candidate in machine.arrangements if candidate.planned)
        )
        raise InputError(
            "WRONG_SETUP",
            "cell.setup",
            "{} {}; use {}, or choose another machine",
            machine.title,
            Word(kind),
            setups,
        )
    if machine.no_arm:
        raise InputError("NO_CLOSED_FORM", "cell.machine", "{}: {}", machine.title, machine.no_arm)
    if has_external and arrangement.carries_part:
        raise InputError(
            "WRONG_SETUP",
            "cell.external",
            "{}: external axes need the tool on the robot; use setup: tool-on-robot, or remove "
            "external",
            arrangement.setup,
        )
