# SPDX-License-Identifier: LGPL-2.1-or-later
"""Drives a text as its reader tells it - what runs straight, where it stops or rounds - through PyKDL, and tells how deep
the nozzle gets into hub and into beads, whose bodies are sampled densely. Shares nothing with planning, posts and verifying
but the frames of the cell, and the closed form that turns a position with a CONFIG into joints, which PyKDL confirms."""

import numpy as np

from freecad_am.kdl import KdlArm

STEP_MM, STEP_RAD = 2.0, np.radians(2.0)
# mm of a move that is rounded, at most, where a text lets it round as it likes
ROUNDED = 0.5
TURNED = np.diag([1.0, -1.0, -1.0, 1.0])


class Drive:
    """The places of a text: tip and axis of the torch in part coordinates, move by move.

    way(row) gives (k, 3) tips and (k, 3) axes on the move that ends at a row, from one stop to the next where it rounds.
    """

    def __init__(self, cell, read, start):
        self.cell, self.read, self.arm = cell, read, KdlArm(cell.machine)
        self.user = cell.poses.station
        self.poses = self._poses()
        self.joints = self._joints(start)

    def _poses(self):
        """(n, 4, 4) flange poses of rows told in positions of a robot."""
        read = self.read
        if read.position is None or read.rotation is None:
            return None
        told = np.tile(np.eye(4), (len(read.deposit), 1, 1))
        told[:, :3, :3], told[:, :3, 3] = read.rotation, read.position
        if read.tool is not None:
            return self.cell.machine.base @ read.frame @ told @ np.linalg.inv(read.tool)
        return self.user @ told @ np.linalg.inv(self.cell.poses.carried)

    def _joints(self, start):
        """(n, axes) serial joints of all rows: as told, or by PyKDL, or by differences, from the row before."""
        read, machine = self.read, self.cell.machine
        rows = [start]
        for row in range(len(read.deposit)):
            shown = None if read.joints is None else read.joints[row]
            if shown is not None and np.isfinite(shown).all():
                found = machine.from_controller(shown)
                continuous = self.cell.limits.continuous
                found[continuous] += (
                    2.0 * np.pi * np.round((rows[-1] - found)[continuous] / (2.0 * np.pi))
                )
            elif shown is not None and self.cell.external is not None and self.poses is not None:
                found = self._beside(row, shown, rows[-1])
            elif self.poses is not None and read.configuration is not None:
                found = self._by_configuration(row)
            elif self.poses is not None:
                near = (
                    rows[-1]
                    if read.near is None or read.linear[row]
                    else machine.from_controller(read.near[row])
                )
                found = self.arm.inverse(self.poses[row][None], near[None], "nr", 1e-7)[0]
            else:
                found = self._by_tip(row, rows[-1])
            assert np.isfinite(found).all(), row
            rows.append(found)
        return np.array(rows[1:])

    def _beside(self, row, shown, near):
        """The joints of a position with the values of the external axes as told; the robot's own from those near."""
        cell, own = self.cell, len(self.cell.robot.axes)
        values = cell.machine.from_controller(np.where(np.isnan(shown), 0.0, shown))[own:]
        face = KdlArm(cell.machine).forward(np.r_[np.zeros(own), values][None])[0] @ np.linalg.inv(
            KdlArm(cell.robot).forward(np.zeros((1, own)))[0]
        )
        pose = np.linalg.inv(face) @ self.poses[row]  # seen from the robot
        return np.r_[
            KdlArm(cell.robot).inverse(pose[None], near[None, :own], "nr", 1e-7)[0], values
        ]

    def _by_configuration(self, row):
        """The joints of a position with the arm and the turns that the text names; no other joints enter."""
        machine, told = self.cell.machine, self.read.configuration
        branch = 4 * (not told.front[row]) + 2 * (not told.up[row]) + (not told.flip[row])
        shown = machine.to_controller(machine.opw.inverse_branch(self.poses[row][None], branch)[0])
        shown -= 2.0 * np.pi * np.round(shown / (2.0 * np.pi))
        shown[-1] += 2.0 * np.pi * told.turns[row, -1]
        found = machine.from_controller(shown)
        assert np.abs(self.arm.forward(found[None])[0] - self.poses[row]).max() < 1e-6
        return found

    def _by_tip(self, row, near):
        """Axes that bring the tip of a machine with rotary axes where it is told to be, the nearest ones: Newton."""
        read, cell = self.read, self.cell
        rotary = None if read.joints is None else read.joints[row]
        found, free = near.copy(), np.ones(len(near), dtype=bool)
        if rotary is not None:
            free = np.isnan(rotary)
            found[~free] = rotary[~free]
        target = (
            [self.told_tip[row]]
            if read.direction is None
            else [self.told_tip[row], 300.0 * self.told_axis[row]]
        )
        target = np.concatenate(target)

        def seen(values):
            tip, axis = cell.tip_in_part(self.arm.forward(values))
            return np.hstack([tip, 300.0 * axis])[:, : len(target)]

        for _ in range(8):
            nudged = np.vstack([found, found + 1e-6 * np.eye(len(found))])
            at = seen(nudged)
            slope = ((at[1:] - at[0]) / 1e-6).T[:, free]
            found[free] += np.linalg.lstsq(slope, target - at[0], rcond=1e-9)[0]
        assert np.abs(seen(found[None])[0] - target).max() < 1e-3
        return found

    @property
    def told_tip(self):
        """(n, 3) tips of positions of a machine with rotary axes, in part coordinates."""
        return self.read.position @ self._in_part[:3, :3].T + self._in_part[:3, 3]

    @property
    def told_axis(self):
        """(n, 3) directions of a machine with rotary axes, in part coordinates."""
        return self.read.direction @ self._in_part[:3, :3].T

    @property
    def _in_part(self):
        return self.cell.poses.mount  # the program's origin is what sits on the table

    def ends(self, row):
        """Tip and axis (3,) at the end of a move."""
        tip, axis = self.cell.tip_in_part(self.arm.forward(self.joints[row][None]))
        return tip[0], axis[0]

    def _between(self, row, share):
        """Tips and axes on the straight way to a row, as that is told."""
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
        """Tips and axes on the move to a row; a corner that is rounded is cut straight."""
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
    """The pose at a share of the way from start to end (4, 4), turning about one axis."""
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
        part = share * angle
        pose[:3, :3] = start[:3, :3] @ (
            np.eye(3) + np.sin(part) * cross + (1.0 - np.cos(part)) * cross @ cross
        )
    return pose


def nozzle_skin(nozzle):
    """(k, 2) height above the tip and distance from the axis of points on the nozzle."""
    height = np.linspace(0.0, nozzle.length, 16)
    return np.stack([height, 0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * height], axis=1)


def depth_in_hub(tips, axes, nozzle, hub, top):
    """How deep, mm, the nozzle gets into a cone that stands from z = 0 to `top`; 0 where it stays outside."""
    angle = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    side = np.cross(axes, np.where(np.abs(axes[:, :1]) < 0.9, [[1.0, 0.0, 0.0]], [[0.0, 1.0, 0.0]]))
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    other = np.cross(axes, side)
    ring = np.cos(angle)[:, None, None] * side + np.sin(angle)[:, None, None] * other
    deepest = 0.0
    for height, radius in nozzle_skin(nozzle):
        points = tips + height * axes + radius * ring
        inside = np.minimum(-hub.distance(points), np.minimum(points[..., 2], top - points[..., 2]))
        deepest = max(deepest, float(inside.max()))
    return deepest


def bead_body(tips, axes, width, height):
    """Points (k, 3) in and on a bead laid along tips (n, 3), on which it stands along axes (n, 3): a stadium every mm."""
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))]
    at = np.linspace(0.0, way[-1], 2 + int(way[-1]))
    tips, axes = (
        np.stack([np.interp(at, way, column) for column in each.T], axis=1) for each in (tips, axes)
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
    """(n, k) how deep, mm, points (k, 3) are in the nozzle at tips and axes (n, 3), and how high over the tip; negative
    outside."""
    away = points[None] - tips[:, None]
    height = np.einsum("npi,ni->np", away, axes)
    side = np.linalg.norm(away - height[..., None] * axes[:, None], axis=2)
    room = (0.5 * nozzle.diameter + np.tan(nozzle.half_angle) * height - side) * np.cos(
        nozzle.half_angle
    )
    return np.minimum(np.minimum(room, height), nozzle.length - height), height
