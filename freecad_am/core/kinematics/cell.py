# SPDX-License-Identifier: LGPL-2.1-or-later
"""The cell: a machine, its load and the deposition point.

On a robot, one degree of freedom remains at each toolpath point: the rotation phi about the
tool axis. Its zero is the smallest rotation that takes the tool axis t to the platform Z, so the
reference does not twist along a path. Let M be the rotation from part coordinates to deposition
point coordinates. Then M = Rz(phi) S(t) and M t = Z (Chalvin 2020, eq. 10). RZ in the paper is
the last Bryant angle of the same M = Rx(RX) Ry(RY) Rz(RZ) (eq. 9). phi and RZ differ, and RZ
degenerates where t is horizontal (ERRATA).
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
LINE = 0.05  # minimum distance of points from a line, fraction of their spread
SAME_SIZE = 0.01  # maximum relative error of the distances between points
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
    """Pose of the part from touched points.

    pose: (4, 4) part coordinates in the manufacturer's base frame, mm. residual: (n,) distance of
    each point from its touched position, mm.
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
    """Return the part pose of a cell from its touched points; None without touched points.

    Raises InputError TOUCHED.
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
            "and the robot holds the tool; remove the touched points, and measure cell.platform "
            "or the pose of the positioner",
        )
    return work_offset(points, parameters.touched_tolerance)


def work_offset(points: Sequence[TouchedPoint], tolerance: float) -> WorkOffset:
    """Return the part pose that best fits the touched points.

    Raises InputError TOUCHED for fewer than three points, collinear points, points at a different
    scale, or a residual over `tolerance` mm.
    """
    if len(points) < MIN_POINTS:
        raise InputError(
            CODE,
            TOUCHED_KEY,
            "{} point(s) cannot locate a part; touch at least {} points, spread out and not "
            "collinear",
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
            "cell.touched_tolerance = {:g} mm; touch the point again, and check the order of the "
            "points, the part, and the tip calibration",
            worst + 1,
            residual[worst],
            text,
            tolerance,
        )
    return WorkOffset(pose, residual)


def _refuse_other_size(ratio: float) -> None:
    """Reject touched points whose scale differs from the planned part."""
    if abs(ratio - 1.0) <= SAME_SIZE:
        return
    unit = next((name for factor, name in _UNITS if abs(ratio * factor - 1.0) <= SAME_SIZE), "")
    raise InputError(
        CODE,
        TOUCHED_KEY,
        "the touched points are {:.4g} times as far apart as planned; {}",
        ratio,
        Word(
            Text("one set is in {}; give both sets in mm", unit)
            if unit
            else "the points belong to another part, or are in another order"
        ),
    )


UP = (0.0, 0.0, 1.0)

# the tip Z points out of the nozzle; the tool axis points from the deposit to the tool
_TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True, eq=False)
class CellShapes:
    """The shapes in a cell other than robot and part.

    obstacles: in the world, which is the manufacturer's base frame. torch: the nozzle holder, in
    the tip frame with Z into the holder. external_links: known links of positioner and track, each
    in its own frame.
    """

    obstacles: tuple[Body, ...] = ()
    torch: Torch | None = None
    external_links: tuple[ExternalLink, ...] = ()


@dataclass(frozen=True, eq=False)
class CellPoses:
    """The poses (4, 4) of a cell, mm.

    station: fixed frame in base_link. It is the deposition point (part on robot, five-axis
    machine) or the platform (tool on robot). carried: load frame on the flange. It is the platform
    (part on robot, five-axis machine) or the nozzle tip (tool on robot). The chain of a five-axis
    machine begins at the torch, so its flange always carries the part. mount: platform frame in
    part coordinates. offset: part pose from touched points, if any.
    """

    station: Array
    carried: Array
    mount: Array
    offset: WorkOffset | None = None

    def to_flange(self, position: Array, tool: Array) -> tuple[Array, Array]:
        """Transform points and tool axes from part coordinates to the frame of the carrying flange.

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
        """Convert RZ of the paper to the rotation phi.

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
        # Rx Ry Rz times the first row of the rotation that brings the tool upright; the first two
        # components of the product give phi
        x, y, z = columns(frames.smallest_rotation(t, UP)[:, 0])
        x, y = cos * x - sin * y, sin * x + cos * y
        cos_y, sin_y = np.where(cx > 0.0, t[:, 2], 1.0) / level, sy / level
        first_row = cos_y * x + sin_y * z, cx * y - sx * (cos_y * z - sin_y * x)
        return np.arctan2(first_row[1], first_row[0]), t[:, 2] / np.maximum(cx * cx, 1e-300)

    def rz_of_phi(self, tool: Array, phi: Array) -> Array:
        """Convert rotations phi to RZ of the paper.

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
    """A resolved cell: a machine, its limits and its surroundings.

    branch: branch index (spherical_wrist.branch_index); None to search all branches. external:
    external axes, if any. `machine` then includes robot and external axes, and base_link of its
    chain is the face that carries the part, or the world if only the robot is carried. up: (3,)
    unit vector against gravity in the world, which is the manufacturer's base frame. shapes: bodies
    in the cell other than robot and part.
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
        """The machine without external axes; the closed-form inverse applies to it."""
        return self.machine if self.external is None else self.external.robot

    def external_of(self, joints: Array) -> Array | None:
        """Return the external axis values of joint vectors.

        Parameters
        ----------
        joints : (..., axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (..., k) array or None
            External axis values, rad or mm; None without external axes.
        """
        return None if self.external is None else joints[..., self.robot.chain.axes :]

    def links(self, joints: Array) -> Array:
        """Return the link frames of the robot.

        Parameters
        ----------
        joints : (..., axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (..., axes + 1, 4, 4) array
            Frames in the first frame of the machine chain, base_link first, mm.
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
        """Return the world frame in the first frame of the machine chain.

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
        ):  # the robot stands in the world as it does with the track at zero
            values[:, self.external.slides] = 0.0
        base_frames: Array = self.external.base(values) @ self.robot.base
        return base_frames

    def external_link_frames(self, joints: Array) -> Array:
        """Return the link frames of the external axes.

        Parameters
        ----------
        joints : (n, axes) array
            Joints of robot and external axes, rad or mm.

        Returns
        -------
        (n, links, 4, 4) array
            Frames of `shapes.external_links` in the first frame of the machine chain, mm.
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
        """The set-up record: what the flange carries, and its consequences."""
        return arrangement_of(self.setup)

    @property
    def part_moves(self) -> bool:
        """Whether the part moves in the world."""
        return self.arrangement.carries_part or (
            self.external is not None and bool(self.external.turning)
        )

    @property
    def carriers(self) -> tuple[Machine, ...]:
        """Return the machines that carry and move the part, starting at the floor.

        Returns
        -------
        tuple of Machine
            The last one holds the part on its face or flange. Empty if the part does not move.
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
        """Return the factors of the flange poses that do not depend on the rotation.

        Parameters
        ----------
        position : (n, 3) array
            Points in part coordinates, mm.
        tool : (n, 3) array
            Tool axes in part coordinates, unit vectors.
        external : (n, k) array or None, optional
            External axis values; required in a cell with external axes.

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
            assert external is not None  # a cell with external axes needs their values
            stands = frames.inverse(self.external.base(external)) @ stands
        return PoseFrames(stands, -1.0, (_TURNED @ frames.inverse(self.poses.carried))[None])

    def to_carrier(self, position: Array) -> Array:
        """Transform points from part coordinates to the frame of the carrying flange or face.

        Parameters
        ----------
        position : (n, 3) array
            Points in part coordinates, mm.

        Returns
        -------
        (n, 3) array
            Points in the frame of the last carrier (see `carriers`), mm.
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
            Joints that give the external axis values.

        Returns
        -------
        (n, 4, 4) array
            Poses in base_link, mm.
        """
        return self.pose_frames(
            position, tool, None if joints is None else self.external_of(joints)
        ).flange_poses(phi)

    def tip_in_part(self, flange: Array) -> tuple[Array, Array]:
        """Return the nozzle tip and the tool axis in part coordinates.

        Parameters
        ----------
        flange : (n, 4, 4) array
            Flange poses in base_link.

        Returns
        -------
        tip : (n, 3) array
            Nozzle tip, mm.
        axis : (n, 3) array
            Tool axes, unit vectors.
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
        """Return the nozzle tip alone, in a third of the time of `tip_in_part`.

        Parameters
        ----------
        joints : (..., axes) array
            Joints, rad or mm.

        Returns
        -------
        (..., 3) array
            Nozzle tip in part coordinates, mm.
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
        """Whether the torch is fixed and the machine moves the part."""
        return self.arrangement.carries_part

    def deposition_point(self, flange: Array) -> Array:
        """Return the deposition point for flange poses.

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
        """Return the angular velocity of the flange per unit rate of phi.

        Parameters
        ----------
        flange : (n, 4, 4) array
            Flange poses in base_link.

        Returns
        -------
        (n, 3) array
            Unit vectors in base_link, for a rotation about the deposition point.
        """
        if self.torch_stands:
            return np.broadcast_to(self.poses.station[:3, 2], (len(flange), 3))
        axis: Array = (flange @ self.poses.carried)[:, :3, 2]
        return axis


def mounted(parameters: CellParameters, feature_frame: Array, family: str) -> Array:
    """Return the frame of the part that coincides with the platform.

    Parameters
    ----------
    parameters : CellParameters
        The cell, including `mount`.
    feature_frame : (4, 4) array
        Feature frame in part coordinates.
    family : str
        Kind of the feature, which decides for mount 'auto'.

    Returns
    -------
    (4, 4) array
        Feature frame, or the identity for the frame of the part file.
    """
    mount = parameters.mount if parameters.mount != "auto" else KINDS[family].mount
    return np.array(feature_frame) if mount == ON_FEATURE else np.eye(4)


def resolve(
    parameters: CellParameters,
    feature_frame: Array,
    family: str = DEFAULT_KIND,
    folders: Sequence[str] = (),
) -> Cell:
    """Read the machine file of a job and combine the frames of its cell.

    Parameters
    ----------
    parameters : CellParameters
        The cell parameters of the job.
    feature_frame : (4, 4) array
        Feature frame in part coordinates. It coincides with the platform if `mount` is 'feature',
        the default for parts of revolution; otherwise the frame of the part file does.
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
        UNKNOWN_MACHINE, BAD_MACHINE, UNKNOWN_LIMITS, NOT_YET for set-ups that are not available
        yet, WRONG_SETUP if the machine does not suit the set-up, NO_CLOSED_FORM.
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
    """Raise InputError WRONG_SETUP if the machine or external axes do not suit the set-up.

    Raise InputError NO_CLOSED_FORM for an arm without a known inverse.
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
