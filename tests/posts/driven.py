# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drive a text with PyKDL from its reader's values (straight moves, stops and roundings), and
measure how deep the nozzle gets into the hub and into densely sampled beads. It shares only two
things with planning, posts and verification: the frames of the cell, and the closed form that turns
a position with a CONFIG into joints, which PyKDL confirms."""

import numpy as np

from freecad_am.kdl import KdlArm

STEP_MM, STEP_RAD = 2.0, np.radians(2.0)
# largest rounding in mm, where a text sets no limit
ROUNDED = 0.5
TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


class Drive:
    """The positions of a text: tip and axis of the torch in part coordinates, move by move.
    way(row) returns (k, 3) tips and (k, 3) axes on the move that ends at a row; a rounded move runs
    from one stop to the next."""

    def __init__(self, cell, readback, start):
        self.cell, self.read, self.arm = cell, readback, KdlArm(cell.machine)
        self.user = cell.poses.station
        self.poses = self._poses()
        self.joints = self._joints(start)

    def _poses(self):
        """Return flange poses (n, 4, 4) of the rows that state robot positions."""
        readback = self.read
        if readback.position is None or readback.rotation is None:
            return None
        poses = np.tile(np.eye(4), (len(readback.deposit), 1, 1))
        poses[:, :3, :3], poses[:, :3, 3] = readback.rotation, readback.position
        if readback.tool is not None:
            return self.cell.machine.base @ readback.frame @ poses @ np.linalg.inv(readback.tool)
        return self.user @ poses @ np.linalg.inv(self.cell.poses.carried)

    def _joints(self, start):
        """Return serial joints (n, axes) of all rows: as stated, or by PyKDL or finite differences
        from the row before."""
        readback, machine = self.read, self.cell.machine
        rows = [start]
        for row in range(len(readback.deposit)):
            controller_joints = None if readback.joints is None else readback.joints[row]
            if controller_joints is not None and np.isfinite(controller_joints).all():
                joints = machine.from_controller(controller_joints)
                continuous = self.cell.limits.continuous
                joints[continuous] += (
                    2.0 * np.pi * np.round((rows[-1] - joints)[continuous] / (2.0 * np.pi))
                )
            elif (
                controller_joints is not None
                and self.cell.external is not None
                and self.poses is not None
            ):
                joints = self._beside(row, controller_joints, rows[-1])
            elif self.poses is not None and readback.configuration is not None:
                joints = self._by_configuration(row)
            elif self.poses is not None:
                seed = (
                    rows[-1]
                    if readback.near is None or readback.linear[row]
                    else machine.from_controller(readback.near[row])
                )
                joints = self.arm.inverse(self.poses[row][None], seed[None], "nr", 1e-7)[0]
            else:
                joints = self._by_tip(row, rows[-1])
            assert np.isfinite(joints).all(), row
            rows.append(joints)
        return np.array(rows[1:])

    def _beside(self, row, controller_joints, seed):
        """Return the joints of a position: external axes as stated, robot axes nearest to the
        seed."""
        cell, robot_axes = self.cell, len(self.cell.robot.axes)
        values = cell.machine.from_controller(
            np.where(np.isnan(controller_joints), 0.0, controller_joints)
        )[robot_axes:]
        face = KdlArm(cell.machine).forward(np.r_[np.zeros(robot_axes), values][None])[
            0
        ] @ np.linalg.inv(KdlArm(cell.robot).forward(np.zeros((1, robot_axes)))[0])
        pose = np.linalg.inv(face) @ self.poses[row]  # relative to the robot
        return np.r_[
            KdlArm(cell.robot).inverse(pose[None], seed[None, :robot_axes], "nr", 1e-7)[0], values
        ]

    def _by_configuration(self, row):
        """Return the joints of a position with the configuration and turns that the text names; no
        other joints enter."""
        machine, configuration = self.cell.machine, self.read.configuration
        branch = (
            4 * (not configuration.front[row])
            + 2 * (not configuration.up[row])
            + (not configuration.flip[row])
        )
        controller_joints = machine.to_controller(
            machine.opw.inverse_branch(self.poses[row][None], branch)[0]
        )
        controller_joints -= 2.0 * np.pi * np.round(controller_joints / (2.0 * np.pi))
        controller_joints[-1] += 2.0 * np.pi * configuration.turns[row, -1]
        joints = machine.from_controller(controller_joints)
        assert np.abs(self.arm.forward(joints[None])[0] - self.poses[row]).max() < 1e-6
        return joints

    def _by_tip(self, row, seed):
        """Return the nearest axis values, by Newton's method, that bring the tip of a machine with
        rotary axes to its stated position."""
        readback, cell = self.read, self.cell
        rotary = None if readback.joints is None else readback.joints[row]
        axis_values, free = seed.copy(), np.ones(len(seed), dtype=bool)
        if rotary is not None:
            free = np.isnan(rotary)
            axis_values[~free] = rotary[~free]
        target = (
            [self.told_tip[row]]
            if readback.direction is None
            else [self.told_tip[row], 300.0 * self.told_axis[row]]
        )
        target = np.concatenate(target)

        def tip_and_axis(values):
            tip, axis = cell.tip_in_part(self.arm.forward(values))
            return np.hstack([tip, 300.0 * axis])[:, : len(target)]

        for _ in range(8):
            nudged = np.vstack([axis_values, axis_values + 1e-6 * np.eye(len(axis_values))])
            moved = tip_and_axis(nudged)
            slope = ((moved[1:] - moved[0]) / 1e-6).T[:, free]
            axis_values[free] += np.linalg.lstsq(slope, target - moved[0], rcond=1e-9)[0]
        assert np.abs(tip_and_axis(axis_values[None])[0] - target).max() < 1e-3
        return axis_values

    @property
    def told_tip(self):
        """Return the tips (n, 3) of positions of a machine with rotary axes, in part
        coordinates."""
        return self.read.position @ self._in_part[:3, :3].T + self._in_part[:3, 3]

    @property
    def told_axis(self):
        """Return the directions (n, 3) of a machine with rotary axes, in part coordinates."""
        return self.read.direction @ self._in_part[:3, :3].T

    @property
    def _in_part(self):
        return self.cell.poses.mount  # the program's origin is the part on the table

    def ends(self, row):
        """Return tip and axis (3,) at the end of a move."""
        tip, axis = self.cell.tip_in_part(self.arm.forward(self.joints[row][None]))
        return tip[0], axis[0]

    def _between(self, row, share):
        """Return tips and axes on the straight move to a row."""
        share = np.atleast_1d(share)[:, None]
        if not self.read.linear[row]:
            joints = self.joints[row - 1] + share * (self.joints[row] - self.joints[row - 1])
            return self.cell.tip_in_part(self.arm.forward(joints))
        moving = (
            self.read.tool is not None and self.cell.setup == "part-on-robot" and not self.read.held
        )
        if self.poses is not None and moving:
            tool = self.read.tool[row]
            start, end = (
                self.arm.forward(self.joints[row - 1][None])[0] @ tool,
                self.poses[row] @ tool,
            )
            moved = np.array([_slid(start, end, s) for s in share[:, 0]]) @ np.linalg.inv(tool)
            return self.cell.tip_in_part(moved)
        (from_tip, from_axis), (to_tip, to_axis) = self.ends(row - 1), self.ends(row)
        axis = from_axis + share * (to_axis - from_axis)
        return from_tip + share * (to_tip - from_tip), axis / np.linalg.norm(
            axis, axis=1, keepdims=True
        )

    def way(self, row):
        """Return tips and axes on the move to a row; a rounded corner is cut straight."""
        start, end = self.ends(row - 1)[0], self.ends(row)[0]
        turn = np.abs(self.joints[row] - self.joints[row - 1])[
            ~self.cell.machine.chain.sliding
        ].max()
        count = 2 + int(max(np.linalg.norm(end - start) / STEP_MM, turn / STEP_RAD))
        share = np.linspace(0.0, 1.0, count)
        tips, axes = self._between(row, share)
        if row + 1 < len(self.joints) and not self.read.stops[row] and not self.read.deposit[row]:
            cut, chord = share >= 1.0 - ROUNDED, np.linspace(0.0, 1.0, 12)[:, None]
            (from_tip, from_axis), (to_tip, to_axis) = (
                self._between(row, 1.0 - ROUNDED),
                self._between(row + 1, ROUNDED),
            )
            axis = from_axis + chord * (to_axis - from_axis)
            tips = np.vstack([tips[~cut], from_tip + chord * (to_tip - from_tip)])
            axes = np.vstack([axes[~cut], axis / np.linalg.norm(axis, axis=1, keepdims=True)])
        return tips, axes


def _slid(start, end, share):
    """Return the pose at a share of the move from start to end (4, 4), turning about one axis."""
    turn = start[:3, :3].T @ end[:3, :3]
    angle = np.arccos(np.clip(0.5 * (np.trace(turn) - 1.0), -1.0, 1.0))
    pose = np.eye(4)
    pose[:3, 3] = start[:3, 3] + share * (end - start)[:3, 3]
    pose[:3, :3] = start[:3, :3]
    if angle > 1e-12:
        about = np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        ) / (2.0 * np.sin(angle))
        cross = np.array(
            [[0, -about[2], about[1]], [about[2], 0, -about[0]], [-about[1], about[0], 0]]
        )
        turned = share * angle
        pose[:3, :3] = start[:3, :3] @ (
            np.eye(3) + np.sin(turned) * cross + (1.0 - np.cos(turned)) * cross @ cross
        )
    return pose


def nozzle_skin(nozzle):
    """Return (k, 2) height above the tip and distance from the axis of points on the nozzle."""
    height = np.linspace(0.0, nozzle.length, 16)
    return np.stack([height, 0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * height], axis=1)


def depth_in_hub(tips, axes, nozzle, hub, top):
    """Return how deep, in mm, the nozzle gets into a cone from z = 0 to `top`; 0 if it stays
    outside."""
    angle = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    side = np.cross(axes, np.where(np.abs(axes[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    third_axis = np.cross(axes, side)
    ring = np.cos(angle)[:, None, None] * side + np.sin(angle)[:, None, None] * third_axis
    deepest = 0.0
    for height, radius in nozzle_skin(nozzle):
        points = tips + height * axes + radius * ring
        inside = np.minimum(-hub.distance(points), np.minimum(points[..., 2], top - points[..., 2]))
        deepest = max(deepest, float(inside.max()))
    return deepest


def bead_body(tips, axes, width, height):
    """Return points (k, 3) in and on a bead along tips (n, 3) with build directions (n, 3): a
    stadium every mm."""
    arc_length = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))]
    samples = np.linspace(0.0, arc_length[-1], 2 + int(arc_length[-1]))
    tips, axes = (
        np.stack([np.interp(samples, arc_length, column) for column in vectors.T], axis=1)
        for vectors in (tips, axes)
    )
    side = np.cross(axes, np.gradient(tips, axis=0))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    angle = np.linspace(0.0, 2.0 * np.pi, 16, endpoint=False)
    round_, flat = 0.5 * height, 0.5 * (width - height)
    across = np.r_[
        flat * np.sign(np.cos(angle)) + round_ * np.cos(angle),
        np.linspace(-0.5 * width, 0.5 * width, 7),
    ]
    up = round_ + np.r_[round_ * np.sin(angle), np.zeros(7)]
    points = tips[:, None] + across[:, None] * side[:, None] + up[:, None] * axes[:, None]
    return points.reshape(-1, 3)


def depths_in_nozzle(tips, axes, nozzle, points):
    """Return how deep (n, k) points (k, 3) are in the nozzle at tips and axes (n, 3), and their
    height above the tip, in mm; negative outside."""
    from_tip = points[None] - tips[:, None]
    height = np.einsum("npi,ni->np", from_tip, axes)
    side = np.linalg.norm(from_tip - height[..., None] * axes[:, None], axis=2)
    room = (0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * height - side) * np.cos(
        nozzle.half_angle
    )
    return np.minimum(np.minimum(room, height), nozzle.length - height), height
