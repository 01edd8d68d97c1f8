# SPDX-License-Identifier: LGPL-2.1-or-later
"""External axes: a robot and the mechanisms beside it as one machine.

Seen from where the part stands, robot and mechanisms are one chain: from what the last mechanism that carries it has on its
face backwards through the positioner to the floor, or from the floor itself, and on through the track that carries the
robot, and the robot, to its flange. So everything that drives a chain - limits,
speeds, rapids, collisions, read-back - knows of external axes without being told; the robot's own inverse alone has to
be told where its base then is.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..geometry import frames
from ..issues import InputError
from ..parameters.external import PART, ROBOT, WHERE, External
from ..types import Array, Index
from .chain import Chain, Piece, joined
from .limits import Limits
from .machines import machine as machines
from .machines.machine import MAKER, Machine
from .urdf import machine as urdf_machine
from .urdf.reference import reference

MECHANISMS = machines.BUILT_IN / "mechanisms"


@dataclass(frozen=True, eq=False)
class Mechanism:
    """One of the mechanisms beside a robot. place: (4, 4) where its chain begins, seen from the world, or from the face of
    the mechanism it stands on, `under`, by its place among all. values: which of the external axes' values are its own."""

    machine: Machine
    carries: str
    place: Array
    values: Index
    under: int | None


@dataclass(frozen=True, eq=False)
class ExternalAxes:
    """The k external axes of a robot. robot: the machine without them. to_robot: the chain from where the part stands,
    the platform's face or the world, to the robot's base_link. up: (3,) against gravity, in the world. turning: the unit
    axes (3,) of the positioner in the world with all axes at zero, from the floor on, and `turned` which of the values these
    are. at_zero: (3, 3) turns directions on the face into the world, at zero. along: (3,) the unit way of the track in the
    world and `slides` its value's place, None where the robot stands. carriers: what carries the part, from the floor on.
    mechanisms: all, in the order they are named in."""

    robot: Machine
    to_robot: Chain
    up: Array
    turning: tuple[Array, ...]
    turned: Index
    at_zero: Array
    along: Array | None = None
    slides: int | None = None
    carriers: tuple[Machine, ...] = ()
    mechanisms: tuple[Mechanism, ...] = ()

    @property
    def axes(self) -> int:
        """How many there are, k."""
        return self.to_robot.axes

    def base(self, values: Array) -> Array:
        """(n, 4, 4) the robot's base_link seen from where the part stands, mm, for values (n, k) rad and mm."""
        return self.to_robot.forward(values)

    def links(self, values: Array) -> list[Array]:
        """(n, axes + 1, 4, 4) the frames of each mechanism's links in the world, its base first, for values (n, k)."""
        found: list[Array] = []
        for one in self.mechanisms:
            start = one.place
            if one.under is not None:
                start = (
                    found[one.under][:, -1:]
                    @ self.mechanisms[one.under].machine.chain.flange
                    @ start
                )
            found.append(start @ one.machine.chain.links(values[:, one.values]))
        return found

    def upright(self, directions: Array, values: Array) -> Array:
        """(n, 3) unit vectors seen from where the part stands (n, 3) in the world, for values (n, k) rad and mm."""
        turned = directions @ self.at_zero.T
        for axis, angle in list(zip(self.turning, values.T[self.turned], strict=True))[::-1]:
            turned = np.einsum("nij,nj->ni", frames.rotation_about(axis, angle), turned)
        return turned


def coupled(
    robot: Machine,
    limits: Limits,
    named: Sequence[External],
    up: Sequence[float],
    folders: Sequence[str] = (),
) -> tuple[Machine, Limits, ExternalAxes]:
    """The machine that a robot is together with its external axes, its limits, and these axes.

    Joint values are the robot's and then those of the mechanisms in the order of `named`; `up` (3,) is against gravity.
    Raises InputError NOT_YET for what cannot be planned, UNKNOWN_MACHINE, BAD_MACHINE.
    """
    found = [(one, load(one.machine, folders)) for one in named]
    _check_names(robot, found)
    _check(found)
    axes, ends = robot.chain.axes, np.cumsum([0, *(machine.chain.axes for _, machine in found)])
    values, count = (
        [np.arange(first, last) for first, last in zip(ends[:-1], ends[1:], strict=True)],
        int(ends[-1]),
    )
    carriers = [k for k, (one, _) in enumerate(found) if one.carries == PART]
    in_world = frames.inverse(robot.base)
    pieces, face, turned = [], np.eye(4), np.zeros(0, dtype=np.intp)
    turning: tuple[Array, ...] = ()
    if carriers:
        to_face, face = _chain([found[k] for k in carriers])
        turned = np.concatenate([values[k] for k in carriers])
        pieces = [Piece(np.eye(4), to_face.reversed(), turned)]
        turning = tuple(to_face.frames(np.zeros(len(turned))).directions)
    along, slides = None, None
    for k, (one, machine) in enumerate(found):
        if one.carries == ROBOT:
            start = frames.bryant(one.pose) @ frames.inverse(machine.base)
            # at zero the robot's base is that of the world
            in_world = frames.inverse(start @ machine.chain.forward(np.zeros(1))) @ in_world
            pieces.append(Piece(start, machine.chain, values[k]))
            along, slides = (
                start[:3, :3] @ machine.chain.frames(np.zeros(1)).directions[0],
                int(values[k][0]),
            )
    to_robot = joined(pieces, in_world)
    whole = joined(
        [
            Piece(np.eye(4), to_robot, axes + np.arange(count)),
            Piece(np.eye(4), robot.chain, np.arange(axes)),
        ],
        np.eye(4),
    )
    external = ExternalAxes(
        robot,
        to_robot,
        upward(up),
        turning,
        turned,
        face[:3, :3],
        along,
        slides,
        tuple(found[k][1] for k in carriers),
        _mechanisms(found, values),
    )
    others = [machine for _, machine in found]
    return _together(robot, others, whole), _limits(limits, others), external


def _check(found: Sequence[tuple[External, Machine]]) -> None:
    """Refuse what cannot be planned."""
    tracks = [machine for one, machine in found if one.carries == ROBOT]
    for machine in tracks:
        if machine.chain.axes != 1 or not machine.chain.sliding.all():
            raise InputError(
                "NOT_YET",
                WHERE,
                "{} carries the robot and is not a track, which is one axis that slides; "
                "choose a track",
                machine.title,
            )
    if len(tracks) > 1:
        raise InputError(
            "NOT_YET", WHERE, "{} mechanisms carry the robot; give one track", len(tracks)
        )
    others = [machine for one, machine in found if one.carries == PART]
    for machine in others:
        if machine.chain.sliding.any():
            raise InputError(
                "NOT_YET",
                WHERE,
                "{} has an axis that slides and carries the part, which cannot be planned "
                "yet; use turning axes",
                machine.title,
            )
    count = sum(machine.chain.axes for machine in others)
    if count > 2:
        raise InputError(
            "NOT_YET", WHERE, "{} axes carry the part; give one or two turning axes", count
        )


def _check_names(robot: Machine, found: Sequence[tuple[External, Machine]]) -> None:
    """Refuse mechanisms that are the robot itself, or each other."""
    for k, (one, machine) in enumerate(found):
        if machine.id == robot.id or (_alike(machine, robot) and one.carries == ROBOT):
            raise InputError(
                "BAD_VALUE",
                WHERE,
                "{} is the machine of the cell, which cannot carry itself; name what "
                "stands beside it",
                machine.title,
            )
        for other, before in found[:k]:
            if machine.id != before.id:
                continue
            if not _alike(machine, before):
                raise InputError(
                    "BAD_VALUE",
                    WHERE,
                    "{} and {} are two mechanisms of one name, {!r}; give one of the files "
                    "another id",
                    one.machine,
                    other.machine,
                    machine.id,
                )
            if one.pose == other.pose or one.carries != other.carries:
                raise InputError(
                    "BAD_VALUE",
                    WHERE,
                    "{!r} stands there twice; leave one of them out, or give a second one "
                    "of the same kind a pose of its own",
                    machine.id,
                )


def _alike(one: Machine, other: Machine) -> bool:
    return one.chain.axes == other.chain.axes and np.array_equal(
        one.chain.origins, other.chain.origins
    )


def load(name: str, folders: Sequence[str] = ()) -> Machine:
    """A mechanism by its id, in the user's folders or built in, by the path of a machine file, or the links of a URDF.

    Raises InputError UNKNOWN_MACHINE, BAD_MACHINE, BAD_URDF.
    """
    meant = reference(name)
    if meant is not None:
        found = urdf_machine.chain_of(meant)
        called = f"{found.name} {' - '.join(found.joints)}"  # a file may describe several
        return dataclasses.replace(
            machines.of_description(name, found, None), id=called, title=called
        )
    try:
        return machines.load(name, (*folders, MECHANISMS))
    except InputError as error:
        if error.code != "UNKNOWN_MACHINE":
            raise
        known = ", ".join(sorted(path.stem for path in MECHANISMS.glob("*.json")))
        raise InputError(
            "UNKNOWN_MACHINE",
            WHERE,
            "{!r} is not known; built in are {}; or give the path of a machine file or a URDF",
            name,
            known,
        ) from None


def upward(up: Sequence[float]) -> Array:
    """(3,) the unit vector along three numbers."""
    vector = np.array(up, float)
    return np.asarray(vector / np.linalg.norm(vector))


def _chain(found: Sequence[tuple[External, Machine]]) -> tuple[Chain, Array]:
    """The chain from the world to the face that carries the part, and that face (4, 4) at zero. Poses of mechanisms are
    those they stand at in the world with all axes at zero."""
    pieces: list[Piece] = []
    before, first = np.eye(4), 0
    for one, machine in found:
        start = frames.bryant(one.pose) @ frames.inverse(machine.base)
        pieces.append(
            Piece(
                frames.inverse(before) @ start, machine.chain, first + np.arange(machine.chain.axes)
            )
        )
        before, first = (
            start @ machine.chain.forward(np.zeros(machine.chain.axes)),
            first + machine.chain.axes,
        )
    return joined(pieces, np.eye(4)), before


def _mechanisms(
    found: Sequence[tuple[External, Machine]], values: Sequence[Index]
) -> tuple[Mechanism, ...]:
    """The mechanisms where they stand: those that carry the part on one another."""
    adjacent: list[Mechanism] = []
    under: int | None = None
    face = np.eye(4)
    for k, (one, machine) in enumerate(found):
        start = frames.bryant(one.pose) @ frames.inverse(machine.base)
        if one.carries == ROBOT:
            adjacent.append(Mechanism(machine, ROBOT, start, values[k], None))
            continue
        adjacent.append(Mechanism(machine, PART, frames.inverse(face) @ start, values[k], under))
        under, face = k, start @ machine.chain.forward(np.zeros(machine.chain.axes))
    return tuple(adjacent)


def _together(robot: Machine, others: Sequence[Machine], chain: Chain) -> Machine:
    """The robot with further axes e1, e2 ...."""
    count, axes = sum(other.chain.axes for other in others), robot.chain.axes
    matrix = np.eye(axes + count)
    matrix[:axes, :axes] = robot.controller_matrix
    offset = [robot.controller_offset]
    at = axes
    for other in others:
        more = other.chain.axes
        matrix[at : at + more, at : at + more] = other.controller_matrix
        offset.append(other.controller_offset)
        at += more
    all_ = (robot, *others)
    known = all(one.pulses_per_degree for one in all_)
    alike = {
        name: np.concatenate([getattr(one, name) for one in all_])
        for name in ("max_speed", "max_acceleration", "max_jerk")
    }
    return dataclasses.replace(
        robot,
        title=" + ".join(one.title for one in (robot, *others)),
        chain=chain,
        base=np.eye(4),
        external=count,
        axes=(*robot.axes, *(f"e{number + 1}" for number in range(count))),
        controller_matrix=matrix,
        controller_offset=np.concatenate(offset),
        pulses_per_degree=sum((one.pulses_per_degree for one in all_), ()) if known else (),
        **alike,
    )


def _limits(robot: Limits, others: Sequence[Machine]) -> Limits:
    sets = [other.limits(MAKER) for other in others]
    count = sum(one.axes for one in sets)
    labels = [f"e{number + 1}" for number in range(count)]
    coupled_ = [np.pad(robot.coefficients.reshape(-1, robot.axes), ((0, 0), (0, count)))]
    at = robot.axes
    for one in sets:
        rows = one.coefficients.reshape(-1, one.axes)
        coupled_.append(np.pad(rows, ((0, 0), (at, robot.axes + count - at - one.axes))))
        at += one.axes
    alike = {
        name: np.concatenate([getattr(one, name) for one in (robot, *sets)])
        for name in ("lower", "upper", "coupled_lower", "coupled_upper")
    }
    rest = [label for one in sets for label in one.labels[one.axes :]]
    return dataclasses.replace(
        robot,
        coefficients=np.concatenate(coupled_),
        source="; ".join(one.source for one in (robot, *sets)),
        labels=(*robot.labels[: robot.axes], *labels, *robot.labels[robot.axes :], *rest),
        **alike,
    )


def tilt_from(directions: Array, up: Array) -> Array:
    """(n,) rad, the angles of unit vectors (n, 3) to a unit vector (3,)."""
    angle: Array = np.arctan2(np.linalg.norm(np.cross(directions, up), axis=1), directions @ up)
    return np.asarray(np.minimum(angle, math.pi))
