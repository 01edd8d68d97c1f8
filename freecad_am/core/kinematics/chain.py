# SPDX-License-Identifier: LGPL-2.1-or-later
"""Forward kinematics of a serial chain of revolute and prismatic joints from its joint frames.

This code shares nothing with the closed form in `inverse.spherical_wrist`, so each checks the
other. Joint frames follow the machine file: T is the product of Trans(origin) Rz(yaw) Ry(pitch)
Rx(roll) Rot(axis, q_i), then the flange. A prismatic joint has Trans(axis q_i) instead of
Rot(axis, q_i).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..geometry import frames
from ..types import Array, ArrayLike, Index, Mask

# poses per batch: small enough for the processor cache, large enough to keep call overhead low
PIECE = 4096


class JointFrames(NamedTuple):
    """The axes of a chain in base_link.

    directions: (..., axes, 3) unit vectors. origins: (..., axes, 3) a point on each axis, mm.
    flange: (..., 4, 4), mm.
    """

    directions: Array
    origins: Array
    flange: Array


@dataclass(frozen=True, eq=False)
class Chain:
    """A serial chain.

    origins: (axes, 4, 4) joint frames in the previous link at zero, mm. directions: (axes, 3) unit
    axes in the joint frames. flange: (4, 4) in the last link, mm. sliding: (axes,) whether each
    joint value is prismatic, in mm; by default none is. order: (axes,) value index of each joint;
    by default joint k has value k. A chain from the part through a positioner to the robot needs
    an order, because robot values come first.
    """

    origins: Array
    directions: Array
    flange: Array
    sliding: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))
    order: Index = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    _links: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if not len(self.sliding):
            object.__setattr__(self, "sliding", np.zeros(len(self.directions), dtype=bool))
        if not len(self.order):
            object.__setattr__(self, "order", np.arange(len(self.directions)))
        # express each joint as a rotation about its own Z, with constant poses between joints
        to_axis = frames.pose(
            frames.smallest_rotation((0.0, 0.0, 1.0), self.directions), np.zeros(3)
        )
        from_axis = np.concatenate((np.eye(4)[None], frames.inverse(to_axis)))
        to_next = np.concatenate((self.origins @ to_axis, self.flange[None]))
        object.__setattr__(self, "_links", from_axis @ to_next)
        for array in (
            self.origins,
            self.directions,
            self.flange,
            self.sliding,
            self.order,
            self._links,
        ):
            array.flags.writeable = False

    @property
    def axes(self) -> int:
        """The number of joints."""
        return len(self.directions)

    def forward(self, q: ArrayLike) -> Array:
        """Return the flange poses for joint values.

        Parameters
        ----------
        q : (..., axes) array
            Joint values, rad or mm.

        Returns
        -------
        (..., 4, 4) array
            Poses in base_link, mm.
        """
        angles = np.asarray(q, float)
        by_joint = self._by_joint(angles)
        flange = _upright(by_joint.shape[1])
        for start in range(0, len(flange), PIECE):
            rows = slice(start, start + PIECE)
            self._run_piece(by_joint[:, rows], None, flange[rows])
        return flange.reshape(angles.shape[:-1] + (4, 4))

    def frames(self, q: ArrayLike) -> JointFrames:
        """Return the axes and the flange pose in base_link.

        Parameters
        ----------
        q : (..., axes) array_like
            Joint values, rad and mm.

        Returns
        -------
        JointFrames
            Directions and origins of the axes in value order, and the flange pose, mm.
        """
        angles = np.asarray(q, float)
        lead = angles.shape[:-1]
        by_joint = self._by_joint(angles)
        flange = _upright(by_joint.shape[1])
        directions, origins = self._axes(by_joint, flange)
        return JointFrames(
            directions.transpose(2, 0, 1).reshape(lead + (self.axes, 3)),
            origins.transpose(2, 0, 1).reshape(lead + (self.axes, 3)),
            flange.reshape(lead + (4, 4)),
        )

    def axes_at(self, q: ArrayLike) -> tuple[Array, Array]:
        """Return only the axis directions and origins of `frames`.

        Parameters
        ----------
        q : (n, axes) array
            Joint values, rad or mm.

        Returns
        -------
        directions : (axes, 3, n) array
            Unit vectors in base_link.
        origins : (axes, 3, n) array
            A point on each axis in base_link, mm.
        """
        return self._axes(self._by_joint(np.asarray(q, float)), None)

    def _axes(self, by_joint: Array, flange: Array | None) -> tuple[Array, Array]:
        """Return directions and origins (axes, 3, n) in value order.

        Fill in the flange poses (n, 4, 4) if given.
        """
        count = by_joint.shape[1]
        directions, origins = np.empty((self.axes, 3, count)), np.empty((self.axes, 3, count))
        for start in range(0, count, PIECE):
            rows = slice(start, start + PIECE)
            axes = directions[:, :, rows], origins[:, :, rows]
            self._run_piece(by_joint[:, rows], axes, None if flange is None else flange[rows])
        if self._is_mixed:
            positions = np.argsort(self.order)
            directions, origins = directions[positions], origins[positions]
        return directions, origins

    def point_from_flange(self, q: ArrayLike, point: Array) -> Array:
        """Transform a fixed point to the flange frame.

        Parameters
        ----------
        q : (..., axes) array
            Joint values, rad or mm.
        point : (3,) array
            The point in base_link, mm.

        Returns
        -------
        (..., 3) array
            The point in the flange frame, mm.
        """
        return self._transform_point(q, point, range(self.axes), frames.inverse(self._links), -1.0)

    def point_position(self, q: ArrayLike, point: Array) -> Array:
        """Transform a point of the flange to base_link.

        Parameters
        ----------
        q : (..., axes) array
            Joint values, rad or mm.
        point : (3,) array
            The point in the flange frame, mm.

        Returns
        -------
        (..., 3) array
            The point in base_link, mm.
        """
        return self._transform_point(q, point, range(self.axes)[::-1], self._links[::-1], 1.0)

    def links(self, q: ArrayLike) -> Array:
        """Return the link frames.

        Parameters
        ----------
        q : (..., axes) array
            Joint values, rad or mm.

        Returns
        -------
        (..., axes + 1, 4, 4) array
            Frames in base_link, mm: base_link itself, then the frame of each joint after its
            motion, along the chain.
        """
        angles = np.asarray(q, float)
        result = np.empty((*angles.shape[:-1], self.axes + 1, 4, 4))
        result[..., 0, :, :] = np.eye(4)
        for joint in range(self.axes):
            direction, value = self.directions[joint], angles[..., self.order[joint]]
            moved = (
                (np.eye(3), value[..., None] * direction)
                if self.sliding[self.order[joint]]
                else (frames.rotation_about(direction, value), np.zeros(3))
            )
            link_frame = result[..., joint, :, :]
            still = (link_frame.reshape(-1, 4) @ self.origins[joint]).reshape(
                link_frame.shape
            )  # one matrix product for all poses
            result[..., joint + 1, :, :] = still @ frames.pose(*moved)
        return result

    def _transform_point(
        self, q: ArrayLike, point: Array, order: range, links: Array, sense: float
    ) -> Array:
        """Transform a point by `links` (axes + 1, 4, 4), with the joints in `order` between them.

        sense: 1 applies the joint motions, -1 their inverses. Transforming a point takes a third
        of the time of transforming a frame.
        """
        angles = np.asarray(q, float)
        by_joint = self._by_joint(angles)
        points = np.empty((by_joint.shape[1], 3))
        start_point = links[0, :3, :3] @ point + links[0, :3, 3]
        for start in range(0, len(points), PIECE):
            values = by_joint[:, start : start + PIECE]
            sines, cosines = sense * np.sin(values), np.cos(values)
            point_now = np.empty((3, values.shape[1]))
            point_now[:] = start_point[:, None]
            for joint, link in zip(order, links[1:], strict=True):
                if self.sliding[self.order[joint]]:
                    point_now[2] += sense * values[joint]
                else:
                    across = point_now[0] * cosines[joint]
                    across -= point_now[1] * sines[joint]
                    point_now[1] *= cosines[joint]
                    point_now[1] += point_now[0] * sines[joint]
                    point_now[0] = across
                point_now = link[:3, :3] @ point_now
                point_now += link[:3, 3:]
            points[start : start + PIECE] = point_now.T
        return points.reshape(angles.shape[:-1] + (3,))

    @property
    def _is_mixed(self) -> bool:
        """Whether the order of joint values differs from the order of joints."""
        return bool((self.order[1:] < self.order[:-1]).any())

    def _by_joint(self, angles: Array) -> Array:
        """Rearrange joint values (..., axes) to (axes, n) in chain order."""
        by_value: Array = np.moveaxis(angles, -1, 0).reshape(self.axes, -1)
        return by_value[self.order] if self._is_mixed else by_value

    def reversed(self) -> Chain:
        """Return the reversed chain, from the flange to the base."""
        back = frames.inverse(np.concatenate((self.origins, self.flange[None])))[::-1]
        return Chain(
            back[:-1], -self.directions[::-1], back[-1], self.sliding, self.order[::-1].copy()
        )

    def _run_piece(
        self, angles: Array, axes: tuple[Array, Array] | None, flange: Array | None
    ) -> None:
        """Fill in directions and origins (axes, 3, n) and flange poses (n, 4, 4) if given.

        angles: (axes, n) joint values in chain order.
        """
        sines, cosines = np.sin(angles), np.cos(angles)
        count = angles.shape[1]
        # one row per column of the rotation matrix and one for the position, each with x, y, z of
        # all poses; the first link does not depend on the joints
        moved = np.empty((4, 3, count))
        moved[:] = self._links[0, :3].T[:, :, None]
        columns, position = moved[:3].reshape(3, 3 * count), moved[3].ravel()
        for joint in range(self.axes):
            if joint:
                columns, position = _advance(columns, position, self._links[joint])
            if axes is not None:
                axes[0][joint], axes[1][joint] = (
                    columns[2].reshape(3, count),
                    position.reshape(3, count),
                )
            if self.sliding[self.order[joint]]:
                position = position + (columns[2].reshape(3, count) * angles[joint]).ravel()
            else:
                _turn(columns.reshape(3, 3, count), sines[joint], cosines[joint])
        if flange is None:
            return
        columns, position = _advance(columns, position, self._links[-1])
        flange[:, :3, :3] = columns.reshape(3, 3, count).T
        flange[:, :3, 3] = position.reshape(3, count).T


def _upright(count: int) -> Array:
    """Return poses (count, 4, 4) with only the last row set."""
    poses = np.zeros((count, 4, 4))
    poses[:, 3, 3] = 1.0
    return poses


def _advance(columns: Array, position: Array, link: Array) -> tuple[Array, Array]:
    """Multiply frames (columns (3, 3n), position (3n,)) by the constant pose `link`."""
    moved: Array = link[:3].T @ columns
    return moved[:3], position + moved[3]


def _turn(columns: Array, sine: Array, cosine: Array) -> None:
    """Rotate frames, given by their columns (3, 3, n), about their own Z in place."""
    first_column = columns[0] * cosine
    first_column += columns[1] * sine
    columns[1] *= cosine
    columns[1] -= columns[0] * sine
    columns[0] = first_column


class Piece(NamedTuple):
    """Piece of a longer chain.

    start: (4, 4) pose of the piece in the flange frame of the previous piece. values: (axes,)
    indices of its joint values in the whole chain.
    """

    start: Array
    chain: Chain
    values: Index


def join_chains(sections: Sequence[Piece], end: Array) -> Chain:
    """Join consecutive pieces into one chain.

    Parameters
    ----------
    sections : sequence of Piece
        The pieces, starting at the base.
    end : (4, 4) array
        Flange of the chain in the flange frame of the last piece, mm.

    Returns
    -------
    Chain
        The chain, with values in the order given by the pieces.
    """
    origins: list[Array] = []
    flange = np.eye(4)
    for section in sections:
        origins += [flange @ section.start @ section.chain.origins[0], *section.chain.origins[1:]]
        flange = section.chain.flange
    order = np.concatenate([section.values[section.chain.order] for section in sections])
    sliding = np.zeros(len(order), dtype=bool)
    for section in sections:
        sliding[section.values] = section.chain.sliding
    return Chain(
        np.stack(origins),
        np.concatenate([section.chain.directions for section in sections]),
        flange @ end,
        sliding,
        order,
    )
