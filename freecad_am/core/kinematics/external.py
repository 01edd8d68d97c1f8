# SPDX-License-Identifier: LGPL-2.1-or-later
"""External axes: a robot and its mechanisms as one machine.

Seen from the part, robot and mechanisms form one chain. It starts at the face that carries the
part and runs backwards through the positioner to the floor; without a positioner it starts at the
floor. From there it continues through the track, if any, and the robot to the flange. All code
that works on a chain (limits, speeds, rapids, collisions, read-back) therefore handles external
axes without special cases. Only the robot inverse needs the position of the robot base.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..geometry import frames
from ..issues import InputError
from ..parameters.cell_records import EXTERNAL_KEY, PART, ROBOT, ExternalMechanism
from ..types import Array, Index
from .chain import Chain, Piece, join_chains
from .limits import Limits
from .links.solids import Solid
from .machines import machine as machines
from .machines.machine import MAKER, Machine
from .urdf import machine as urdf_machine
from .urdf.machine import is_mechanism
from .urdf.reference import reference

MECHANISMS = machines.BUILT_IN / "mechanisms"


@dataclass(frozen=True, eq=False)
class Mechanism:
    """A mechanism of a cell.

    frame: (4, 4) start of its chain in the world, or in the face of the mechanism `under` it.
    values: indices of its values among the external axes. under: index of the mechanism below;
    None on the floor.
    """

    machine: Machine
    carries: str
    frame: Array
    values: Index
    under: int | None


@dataclass(frozen=True, eq=False)
class ExternalAxes:
    """The k external axes of a robot.

    robot: the machine without external axes. to_robot: chain from the frame under the part
    (platform face or world) to the robot's base_link. up: (3,) unit vector against gravity in the
    world. turning: unit axes (3,) of the positioner in the world with all axes at zero, starting
    at the floor. turned: their value indices. at_zero: (3, 3) rotation from face to world at zero.
    along: (3,) unit direction of the track in the world, and slides: its value index; both None if
    the robot is fixed. carriers: machines that carry the part, starting at the floor. mechanisms:
    all mechanisms in the given order.
    """

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
        """The number of external axes, k."""
        return self.to_robot.axes

    def base(self, values: Array) -> Array:
        """Return the robot's base_link in the frame under the part.

        Parameters
        ----------
        values : (n, k) array
            Values of the external axes, rad or mm.

        Returns
        -------
        (n, 4, 4) array
            Poses, mm.
        """
        return self.to_robot.forward(values)

    def links(self, values: Array) -> list[Array]:
        """Return the link frames of each mechanism in the world.

        Parameters
        ----------
        values : (n, k) array
            Values of the external axes, rad or mm.

        Returns
        -------
        list of (n, axes + 1, 4, 4) array
            Frames of each mechanism, base first, mm.
        """
        link_frames: list[Array] = []
        for mechanism in self.mechanisms:
            start = mechanism.frame
            if mechanism.under is not None:
                start = (
                    link_frames[mechanism.under][:, -1:]
                    @ self.mechanisms[mechanism.under].machine.chain.flange
                    @ start
                )
            link_frames.append(start @ mechanism.machine.chain.links(values[:, mechanism.values]))
        return link_frames

    def upright(self, directions: Array, values: Array) -> Array:
        """Rotate directions from the frame under the part into the world.

        Parameters
        ----------
        directions : (n, 3) array
            Unit vectors in the frame under the part.
        values : (n, k) array
            Values of the external axes, rad or mm.

        Returns
        -------
        (n, 3) array
            Unit vectors in the world.
        """
        turned = directions @ self.at_zero.T
        for axis, angle in list(zip(self.turning, values.T[self.turned], strict=True))[::-1]:
            turned = np.einsum("nij,nj->ni", frames.rotation_about(axis, angle), turned)
        return turned


def coupled(
    robot: Machine,
    limits: Limits,
    named: Sequence[ExternalMechanism],
    up: Sequence[float],
    folders: Sequence[str] = (),
) -> tuple[Machine, Limits, ExternalAxes]:
    """Couple a robot with its external axes.

    Joint values are those of the robot, then those of the mechanisms in the order of `named`.

    Parameters
    ----------
    robot : Machine
        The robot.
    limits : Limits
        Limits of the robot.
    named : sequence of ExternalMechanism
        The mechanisms in the order of the cell.
    up : (3,) sequence of float
        Direction against gravity in the world.
    folders : sequence of str, optional
        Folders with user machines.

    Returns
    -------
    machine : Machine
        Robot and mechanisms as one machine.
    limits : Limits
        Limits of all axes.
    external : ExternalAxes
        The external axes.

    Raises
    ------
    InputError
        NOT_YET for cells that cannot be planned, UNKNOWN_MACHINE, BAD_MACHINE.
    """
    loaded = [(named_axis, load(named_axis.machine, folders)) for named_axis in named]
    _check_names(robot, loaded)
    _check(loaded)
    axes, ends = robot.chain.axes, np.cumsum([0, *(machine.chain.axes for _, machine in loaded)])
    values = [np.arange(begin, end) for begin, end in zip(ends[:-1], ends[1:], strict=True)]
    count = int(ends[-1])
    carriers = [k for k, (named_axis, _) in enumerate(loaded) if named_axis.carries == PART]
    in_world = frames.inverse(robot.base)
    sections, face, turned = [], np.eye(4), np.zeros(0, dtype=np.intp)
    turning: tuple[Array, ...] = ()
    if carriers:
        to_face, face = _chain([loaded[k] for k in carriers])
        turned = np.concatenate([values[k] for k in carriers])
        sections = [Piece(np.eye(4), to_face.reversed(), turned)]
        turning = tuple(to_face.frames(np.zeros(len(turned))).directions)
    along, slides = None, None
    for k, (named_axis, machine) in enumerate(loaded):
        if named_axis.carries == ROBOT:
            start = frames.bryant(named_axis.pose) @ frames.inverse(machine.base)
            # with the track at zero, the robot base is the world
            in_world = frames.inverse(start @ machine.chain.forward(np.zeros(1))) @ in_world
            sections.append(Piece(start, machine.chain, values[k]))
            along = start[:3, :3] @ machine.chain.frames(np.zeros(1)).directions[0]
            slides = int(values[k][0])
    to_robot = join_chains(sections, in_world)
    coupled_chain = join_chains(
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
        tuple(loaded[k][1] for k in carriers),
        _mechanisms(loaded, values),
    )
    machines_beside = [machine for _, machine in loaded]
    return (
        _together(robot, machines_beside, coupled_chain),
        _limits(limits, machines_beside),
        external,
    )


def _check(loaded: Sequence[tuple[ExternalMechanism, Machine]]) -> None:
    """Reject mechanisms that cannot be planned."""
    tracks = [machine for named_axis, machine in loaded if named_axis.carries == ROBOT]
    for machine in tracks:
        if machine.chain.axes != 1 or not machine.chain.sliding.all():
            raise InputError(
                "NOT_YET",
                EXTERNAL_KEY,
                "{} carries the robot but is not a track, a single prismatic axis; choose a track",
                machine.title,
            )
    if len(tracks) > 1:
        raise InputError(
            "NOT_YET",
            EXTERNAL_KEY,
            "{} mechanisms carry the robot; keep only one track",
            len(tracks),
        )
    carriers = [machine for named_axis, machine in loaded if named_axis.carries == PART]
    for machine in carriers:
        if machine.chain.sliding.any():
            raise InputError(
                "NOT_YET",
                EXTERNAL_KEY,
                "{} carries the part on a prismatic axis, which cannot be planned yet; use "
                "revolute axes",
                machine.title,
            )
    count = sum(machine.chain.axes for machine in carriers)
    if count > 2:
        raise InputError(
            "NOT_YET", EXTERNAL_KEY, "{} axes carry the part; use one or two revolute axes", count
        )


def _check_names(robot: Machine, loaded: Sequence[tuple[ExternalMechanism, Machine]]) -> None:
    """Reject a mechanism that is the robot itself or that is listed twice."""
    for k, (named_axis, machine) in enumerate(loaded):
        if machine.id == robot.id or (_alike(machine, robot) and named_axis.carries == ROBOT):
            raise InputError(
                "BAD_VALUE",
                EXTERNAL_KEY,
                "{} is the machine of the cell and cannot carry itself; name a track or positioner",
                machine.title,
            )
        for earlier_axis, earlier_machine in loaded[:k]:
            if machine.id != earlier_machine.id:
                continue
            if not _alike(machine, earlier_machine):
                raise InputError(
                    "BAD_VALUE",
                    EXTERNAL_KEY,
                    "{} and {} share the name {!r}; change the id of one file",
                    named_axis.machine,
                    earlier_axis.machine,
                    machine.id,
                )
            if named_axis.pose == earlier_axis.pose or named_axis.carries != earlier_axis.carries:
                raise InputError(
                    "BAD_VALUE",
                    EXTERNAL_KEY,
                    "{!r} is listed twice; remove one entry, or give the second entry its own pose",
                    machine.id,
                )


def _alike(machine: Machine, reference: Machine) -> bool:
    return machine.chain.axes == reference.chain.axes and np.array_equal(
        machine.chain.origins, reference.chain.origins
    )


def load(name: str, folders: Sequence[str] = ()) -> Machine:
    """Return the mechanism of an id, a machine file path or a URDF reference.

    An id is looked up in the user's folders, then among the built-in mechanisms. Raises InputError
    UNKNOWN_MACHINE, BAD_MACHINE, BAD_URDF.
    """
    description = reference(name)
    if description is not None:
        urdf_chain = urdf_machine.chain_of(description)
        # a file may describe several mechanisms, so the joints are part of the id
        called = f"{urdf_chain.name} {' - '.join(urdf_chain.joints)}"
        return dataclasses.replace(
            machines.machine_of_description(name, urdf_chain, None), id=called, title=called
        )
    try:
        return machines.load(name, (*folders, MECHANISMS))
    except InputError as error:
        if error.code != "UNKNOWN_MACHINE":
            raise
        built_in = ", ".join(sorted(path.stem for path in MECHANISMS.glob("*.json")))
        raise InputError(
            "UNKNOWN_MACHINE",
            EXTERNAL_KEY,
            "unknown mechanism {!r}; use one of {}, or the path of a machine file or a URDF",
            name,
            built_in,
        ) from None


def upward(up: Sequence[float]) -> Array:
    """Normalise a direction.

    Parameters
    ----------
    up : sequence of float
        Three numbers, not all 0.

    Returns
    -------
    (3,) array
        Unit vector.
    """
    vector = np.array(up, float)
    return np.asarray(vector / np.linalg.norm(vector))


def _chain(loaded: Sequence[tuple[ExternalMechanism, Machine]]) -> tuple[Chain, Array]:
    """Return the chain from the world to the face that carries the part, and this face (4, 4) at
    zero.

    Mechanism poses are given in the world with all axes at zero.
    """
    sections: list[Piece] = []
    flange, begin = np.eye(4), 0
    for named_axis, machine in loaded:
        start = frames.bryant(named_axis.pose) @ frames.inverse(machine.base)
        sections.append(
            Piece(
                frames.inverse(flange) @ start, machine.chain, begin + np.arange(machine.chain.axes)
            )
        )
        flange = start @ machine.chain.forward(np.zeros(machine.chain.axes))
        begin = begin + machine.chain.axes
    return join_chains(sections, np.eye(4)), flange


def _mechanisms(
    loaded: Sequence[tuple[ExternalMechanism, Machine]], values: Sequence[Index]
) -> tuple[Mechanism, ...]:
    """Return the mechanisms with their frames.

    Each mechanism that carries the part stands on the previous one.
    """
    adjacent: list[Mechanism] = []
    under: int | None = None
    face = np.eye(4)
    for k, (named_axis, machine) in enumerate(loaded):
        start = frames.bryant(named_axis.pose) @ frames.inverse(machine.base)
        if named_axis.carries == ROBOT:
            adjacent.append(Mechanism(machine, ROBOT, start, values[k], None))
            continue
        adjacent.append(Mechanism(machine, PART, frames.inverse(face) @ start, values[k], under))
        under, face = k, start @ machine.chain.forward(np.zeros(machine.chain.axes))
    return tuple(adjacent)


def _together(robot: Machine, machines_beside: Sequence[Machine], chain: Chain) -> Machine:
    """Return the robot with its external axes, which are named e1, e2 and so on."""
    count, axes = sum(machine.chain.axes for machine in machines_beside), robot.chain.axes
    matrix = np.eye(axes + count)
    matrix[:axes, :axes] = robot.controller_matrix
    offset = [robot.controller_offset]
    row = axes
    for machine in machines_beside:
        count_more = machine.chain.axes
        matrix[row : row + count_more, row : row + count_more] = machine.controller_matrix
        offset.append(machine.controller_offset)
        row += count_more
    all_ = (robot, *machines_beside)
    has_pulses = all(machine.pulses_per_degree for machine in all_)
    alike = {
        name: np.concatenate([getattr(machine, name) for machine in all_])
        for name in ("max_speed", "max_acceleration", "max_jerk")
    }
    return dataclasses.replace(
        robot,
        title=" + ".join(machine.title for machine in (robot, *machines_beside)),
        chain=chain,
        base=np.eye(4),
        external=count,
        axes=(*robot.axes, *(f"e{number + 1}" for number in range(count))),
        controller_matrix=matrix,
        controller_offset=np.concatenate(offset),
        pulses_per_degree=sum((machine.pulses_per_degree for machine in all_), ())
        if has_pulses
        else (),
        **alike,
    )


def _limits(robot: Limits, machines_beside: Sequence[Machine]) -> Limits:
    sets = [machine.limits(MAKER) for machine in machines_beside]
    count = sum(axis_limits.axes for axis_limits in sets)
    labels = [f"e{number + 1}" for number in range(count)]
    coupled_ = [np.pad(robot.coefficients.reshape(-1, robot.axes), ((0, 0), (0, count)))]
    column = robot.axes
    for axis_limits in sets:
        rows = axis_limits.coefficients.reshape(-1, axis_limits.axes)
        coupled_.append(
            np.pad(rows, ((0, 0), (column, robot.axes + count - column - axis_limits.axes)))
        )
        column += axis_limits.axes
    alike = {
        name: np.concatenate([getattr(axis_limits, name) for axis_limits in (robot, *sets)])
        for name in ("lower", "upper", "coupled_lower", "coupled_upper")
    }
    extra_labels = [
        label for axis_limits in sets for label in axis_limits.labels[axis_limits.axes :]
    ]
    return dataclasses.replace(
        robot,
        coefficients=np.concatenate(coupled_),
        source="; ".join(axis_limits.source for axis_limits in (robot, *sets)),
        labels=(*robot.labels[: robot.axes], *labels, *robot.labels[robot.axes :], *extra_labels),
        **alike,
    )


def tilt_from(directions: Array, up: Array) -> Array:
    """Return the angles between unit vectors and a direction.

    Parameters
    ----------
    directions : (n, 3) array
        Unit vectors.
    up : (3,) array
        Unit vector.

    Returns
    -------
    (n,) array
        Angles from 0 to pi, rad.
    """
    angle: Array = np.arctan2(np.linalg.norm(np.cross(directions, up), axis=1), directions @ up)
    return np.asarray(np.minimum(angle, math.pi))


def positioners(
    robot: Machine, mass: float, radius: float, folders: Sequence[str] = ()
) -> list[Machine]:
    """Return the known positioners with one or two revolute axes for a part, the best first.

    Prefer a table at least as wide as the part, then known axis speeds, then the robot's
    manufacturer, then the lowest payload.

    Parameters
    ----------
    robot : Machine
        The robot.
    mass : float
        Mass of the part, kg.
    radius : float
        Extent of the part about its axis, mm.
    folders : sequence of str, optional
        Folders with user machines.

    Returns
    -------
    list of Machine
        Mechanisms whose files state a sufficient payload.
    """
    candidates = [
        machine
        for machine in _known(folders)
        if not machine.chain.sliding.any() and machine.payload.kg >= mass
    ]
    return sorted(
        candidates, key=lambda machine: (_table(machine) < radius, *_rank(robot, machine))
    )


def tracks(robot: Machine, folders: Sequence[str] = ()) -> list[Machine]:
    """Return the known tracks with one prismatic axis, those of the robot's manufacturer first."""
    candidates = [
        machine
        for machine in _known(folders)
        if machine.chain.axes == 1 and machine.chain.sliding.all()
    ]
    return sorted(candidates, key=lambda machine: _rank(robot, machine))


def _rank(robot: Machine, machine: Machine) -> tuple[bool, bool, float, str]:
    unknown = not np.isfinite(machine.max_speed).all()
    return (
        unknown,
        machine.title.split()[0] != robot.title.split()[0],
        machine.payload.kg,
        machine.id,
    )


def _known(folders: Sequence[str]) -> list[Machine]:
    """Return the mechanisms in the user's folders and the built-in ones.

    Skip files that are invalid or describe no mechanism.
    """
    mechanisms: dict[str, Machine] = {}
    for folder in [MECHANISMS, *map(Path, folders)]:
        for path in sorted(folder.expanduser().glob("*.json")):
            try:
                machine = machines.load(str(path))
            except InputError:
                continue
            if is_mechanism(machine.chain):
                mechanisms[path.stem] = machine
    return list(mechanisms.values())


def _table(machine: Machine) -> float:
    """Return the distance of the farthest point of the last link from its axis, mm.

    Infinite if the shape is unknown.
    """
    point_sets = [
        solid.points
        for solid in (machine.bodies[-1] if machine.bodies else ())
        if isinstance(solid, Solid)
    ]
    if not point_sets:
        return math.inf
    axis = machine.chain.directions[-1]
    return float(np.linalg.norm(np.cross(np.concatenate(point_sets), axis), axis=1).max())
