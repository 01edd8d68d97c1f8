# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert a motion to a program: joint values, deposit switching, actions between layers."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import motion as motions
from ..controller import Controller
from ..geometry import frames
from ..issues import InputError
from ..kinematics.cell import Cell
from ..kinematics.inverse import spherical_wrist
from ..kinematics.machines.machine import Machine
from ..motion import Motion
from ..parameters.bead_classes import CLASSES
from ..parameters.process import BetweenLayersParameters, ProcessParameters
from ..parameters.program import ProgramParameters, StartParameters
from ..program import (
    APPROACH,
    DEPOSIT,
    FIRST_TIME,
    JOINT_MOVE,
    LINEAR,
    LINEAR_MOVE,
    RAPID,
    RETRACT,
    ROTARY,
    TRAVEL,
    Block,
    Call,
    LayerStart,
    Moves,
    NcOptions,
    Program,
    Six,
    Wait,
    WaitBelow,
    WaitInput,
)
from ..toolpath import Toolpath
from ..types import Array, Integers, Mask
from . import linear_approach
from .joint_path import BeadPath
from .program_beads import ARC, deposited, divide, standing


def frames_of(cell: Cell, parameters: ProgramParameters) -> tuple[Array, Array]:
    """Return the fixed frame and the flange load frame of a program.

    The frame fixed to the part is moved to the program origin.

    Parameters
    ----------
    cell : Cell
        The cell.
    parameters : ProgramParameters
        Program settings, including the origin.

    Returns
    -------
    station : (4, 4) array
        Fixed frame in base_link.
    carried : (4, 4) array
        Load frame in the flange frame.
    """
    if isinstance(parameters.origin, str):
        return cell.poses.station, cell.poses.carried
    origin = frames.inverse(cell.poses.mount) @ frames.bryant(parameters.origin)
    if cell.torch_stands:
        return cell.poses.station, cell.poses.carried @ origin
    return cell.poses.station @ origin, cell.poses.carried


def six_of(pose: Array) -> Six:
    """Convert a pose to six numbers.

    Parameters
    ----------
    pose : (4, 4) array
        The pose, mm.

    Returns
    -------
    tuple of float
        x, y, z in mm and the Bryant angles rx, ry, rz in rad.
    """
    x, y, z = pose[:3, 3].tolist()
    rx, ry, rz = frames.to_bryant(pose[:3, :3]).tolist()
    return (x, y, z, rx, ry, rz)


def remarks_of(
    cell: Cell, parameters: ProgramParameters, moves: Sequence[Moves]
) -> tuple[str, ...]:
    """Return the header remarks of a program.

    Parameters
    ----------
    cell : Cell
        The cell.
    parameters : ProgramParameters
        Program settings.
    moves : sequence of Moves
        The moves, which give the speed and wire feed ranges.

    Returns
    -------
    tuple of str
        Machine, limits, frames and ranges, one remark per line.
    """
    moved = not isinstance(parameters.origin, str)
    station, carried = frames_of(cell, parameters)
    if not cell.machine.free:
        where = "Work offset" if parameters.motion == "cartesian" else "Platform on the table"
        frame = carried
    else:
        where = "User frame" if moved else "Platform"
        if cell.torch_stands:
            where = "Deposition point"
        if cell.external is not None and cell.external.turning:
            where += " on the face"
        frame = frames.inverse(cell.machine.base) @ station
    return (
        cell.machine.title,
        f"Limits: {cell.limits.name}",
        *_pose_remarks(where, six_of(frame)),
        *(
            ()
            if isinstance(parameters.origin, str)
            else _pose_remarks("Program origin on the part", parameters.origin)
        ),
        *_ranges(moves),
        *((cell.machine.controller_remark,) if cell.machine.controller_remark else ()),
        *(
            ("Base frame not known: positions count from base_link",)
            if parameters.motion == "cartesian" and not cell.machine.base_is_known
            else ()
        ),
    )


def _ranges(moves: Sequence[Moves]) -> list[str]:
    """Return remarks with the travel speed range and, if known, the wire feed range."""
    beads = [run for run in moves if run.kind == DEPOSIT]
    if not beads:
        return []
    wires = [run.wire for run in beads if run.wire is not None]
    return [
        f"Travel speed {_range(np.concatenate([run.speed for run in beads]))} mm/s",
        *([f"Wire in proportion to it {_range(np.concatenate(wires))} mm/s"] if wires else []),
    ]


def _range(values: Array) -> str:
    low, high = (f"{float(value):.4g}" for value in (values.min(), values.max()))
    return low if low == high else f"{low} to {high}"


def _pose_remarks(what: str, six: Six) -> tuple[str, str]:
    x, y, z, *angles = six
    rx, ry, rz = np.degrees(angles) + 0.0
    return f"{what} {x:.3f} {y:.3f} {z:.3f}", f"RX RY RZ {rx:.3f} {ry:.3f} {rz:.3f}"


# role names, indexed by the role number of a motion row
ROLES = (DEPOSIT, RETRACT, TRAVEL, APPROACH)


def build(
    motion: Motion,
    cell: Cell,
    process: ProcessParameters,
    parameters: ProgramParameters,
    controller: Controller,
    name: str,
    waits: Sequence[float] = (),
    returns: Collection[tuple[int, int]] = (),
) -> Program:
    """Build the program of a motion for a controller.

    Parameters
    ----------
    motion : Motion
        The motion.
    cell : Cell
        The cell.
    process : ProcessParameters
        The process.
    parameters : ProgramParameters
        Program settings.
    controller : Controller
        The controller.
    name : str
        Name of the program.
    waits : sequence of float, optional
        Pause before each layer (`Layer.wait`), s; `between_layers.wait` runs at the same time.
        Empty for no pauses. The first executed layer never pauses.
    returns : Collection[tuple[int, int]], optional
        Beads (layer, index) that start above earlier deposit, see `returning`. The torch waits
        above such a bead until the deposit has cooled.

    Returns
    -------
    Program
        The program, ready for a post.

    Raises
    ------
    InputError
        START_AT if the start is past the last bead; NO_SCHEDULE or SCHEDULE for unsuitable
        schedules.
    """
    blocks = _Blocks(motion, cell, process, parameters, controller).build_all(waits, returns)
    remarks = remarks_of(cell, parameters, [block for block in blocks if isinstance(block, Moves)])
    return replace(build_header(cell, parameters, controller, name), blocks=blocks, remarks=remarks)


def build_header(
    cell: Cell, parameters: ProgramParameters, controller: Controller, name: str
) -> Program:
    """Return the program of a cell without blocks and remarks.

    Parameters
    ----------
    cell : Cell
        The cell.
    parameters : ProgramParameters
        Program settings.
    controller : Controller
        The controller.
    name : str
        Name of the program.

    Returns
    -------
    Program
        The program without blocks and remarks.
    """
    return Program(
        name=name,
        machine=cell.machine.title,
        blocks=(),
        continuous=tuple(bool(e) for e in cell.limits.continuous),
        motion=parameters.motion,
        setup=cell.setup,
        max_points=parameters.max_points,
        blend=parameters.blend,
        user_frame=parameters.user_frame,
        tool_frame=parameters.tool_frame,
        deposit_output=parameters.deposit_output,
        dry_run=parameters.dry_run,
        max_speed=tuple(cell.machine.max_speed.tolist()),
        pulses_per_degree=cell.machine.pulses_per_degree,
        speed_unit=cell.machine.speed_unit,
        station=six_of(frames.inverse(cell.machine.base) @ frames_of(cell, parameters)[0]),
        carried=six_of(frames_of(cell, parameters)[1]),
        axis_names=tuple(_letter(name) for name in cell.machine.axes)
        if cell.arrangement.named_axes
        else (),
        axis_kinds=tuple(LINEAR if slides else ROTARY for slides in cell.machine.chain.sliding)
        if cell.arrangement.named_axes
        else (),
        nc=NcOptions(
            parameters.nc.feed == "path",
            parameters.nc.compress,
            parameters.nc.smooth,
            parameters.nc.tolerance,
            parameters.nc.deposit_on or "",
            parameters.nc.deposit_off or "",
            parameters.nc.switch_kinematics,
            parameters.nc.wire_output,
            parameters.nc.wire_gain,
        ),
        external_kinds=external_kinds(cell),
        unit=_unit(cell, parameters, controller),
        first_external=parameters.axes.first,
        schedule_output=parameters.schedule.output,
        axis_machines=tuple(owner.title for owner in _owners(cell)),
        of_urdf=tuple(owner.of_urdf for owner in _owners(cell)),
    )


def _owners(cell: Cell) -> list[Machine]:
    """Return the machine that each axis belongs to: the robot or an external mechanism."""
    owners = (
        [cell.robot, *(mechanism.machine for mechanism in cell.external.mechanisms)]
        if cell.external
        else [cell.robot]
    )
    return [owner for owner in owners for _ in range(owner.chain.axes)]


def external_kinds(cell: Cell) -> tuple[str, ...]:
    """Return the kind of each external axis.

    Parameters
    ----------
    cell : Cell
        The cell.

    Returns
    -------
    tuple of str
        'linear' or 'rotary' for each external axis.
    """
    return tuple(
        LINEAR if slides else ROTARY
        for slides in cell.machine.chain.sliding[cell.robot.chain.axes :]
    )


def _unit(cell: Cell, parameters: ProgramParameters, controller: Controller) -> str:
    """Return the controller's name for the mechanism of the external axes.

    A track has no name by default, because it is always active.
    """
    if cell.external is None:
        return ""
    return parameters.axes.unit or (controller.positioner if cell.external.turning else "")


def returning(toolpath: Toolpath, paths: Sequence[BeadPath]) -> frozenset[tuple[int, int]]:
    """Return the beads (layer, index) of a joint path that start above earlier deposit.

    For a rotary slicing solid, the bead roles mark them. Otherwise they are the first beads of
    the layers that no feature begins with.
    """
    if any(path.bead.role.returns for path in paths):
        return frozenset((path.layer, path.index) for path in paths if path.bead.role.returns)
    if any(bead.role.kind for _, _, bead in toolpath):
        return frozenset()
    return frozenset((k, 0) for k, layer in enumerate(toolpath.layers) if k and not layer.first)


def _letter(axis: str) -> str:
    """Return the controller's letter of an axis: X for mx, A for a.

    The m of mx distinguishes the axis from the part coordinate x.
    """
    return (axis[1:] if len(axis) == 2 and axis[0] == "m" else axis).upper()


def carried_pose(cell: Cell, parameters: ProgramParameters) -> Six | None:
    """Return the load frame of a program in the flange frame.

    None if the origin depends on the toolpath.
    """
    return six_of(frames_of(cell, parameters)[1]) if isinstance(parameters.origin, str) else None


def rows_from(motion: Motion, start: StartParameters) -> Mask:
    """Return the motion rows to run when a job resumes at a bead.

    Parameters
    ----------
    motion : Motion
        The motion, n rows.
    start : StartParameters
        Layer and bead at which the job resumes.

    Returns
    -------
    (n,) array of bool
        True from the rapids to that bead on, except for the retract from the previous bead.

    Raises
    ------
    InputError
        START_AT if the bead does not exist.
    """
    run = (motion.layer > start.layer) | (motion.layer == start.layer) & (motion.bead >= start.bead)
    if (
        not (run & motion.deposit).any()
        or not ((motion.layer == start.layer) & (motion.bead == start.bead)).any()
    ):
        raise InputError(
            "START_AT",
            "program.start_at",
            "there is no bead {} in a layer {}; choose from layers 0 to {}",
            start.bead,
            start.layer,
            motion.layer.max(),
        )
    first_row = int(np.flatnonzero(run)[0])
    ahead = np.arange(len(motion)) < first_row + int(motion.deposit[first_row:].argmax())
    run[ahead & (motion.role == motions.RETRACT)] = False
    return np.asarray(run, dtype=np.bool_)


@dataclass(frozen=True)
class _Blocks:
    """Builds the blocks of a program from motion rows."""

    motion: Motion
    cell: Cell
    process: ProcessParameters
    parameters: ProgramParameters
    controller: Controller

    def build_all(
        self, waits: Sequence[float], returns: Collection[tuple[int, int]]
    ) -> tuple[Block, ...]:
        """Return the blocks of the executed rows. `waits` and `returns`: see `build`."""
        groups = _groups(
            self.motion, np.flatnonzero(rows_from(self.motion, self.parameters.start_at))
        )
        blocks: list[Block] = []
        layer: int | None = None
        for number, rows in enumerate(groups):
            first_row = int(rows[0])
            if self.motion.deposit[first_row]:
                blocks += self._bead(number, rows)
                continue
            layer_number = int(self.motion.layer[first_row])
            if layer is None:
                blocks += [LayerStart(layer_number), *self._approach(rows, returns, arriving=True)]
            elif number == len(groups) - 1:
                blocks.append(self._moves(rows, RAPID))
            elif layer_number == layer:
                blocks += self._approach(rows, returns)
            else:
                retract = self.motion.role[rows] == motions.RETRACT
                blocks += [self._moves(rows[retract], RAPID)] if retract.any() else []
                blocks += _between(
                    self.process.between_layers, waits[layer_number] if len(waits) else 0.0
                )
                blocks += [LayerStart(layer_number), *self._approach(rows[~retract], returns)]
            layer = layer_number
        return standing(blocks)

    def _bead(self, number: int, rows: Integers) -> list[Block]:
        """Return the blocks of bead group `number`, including deposit switching."""
        kind, rows = _class_of(self.motion, int(rows[0])), rows[1:]
        motion = self.motion
        sections = divide(motion.phase[rows], motion.settings[rows], kind, self.process)
        runs = [(self._moves(rows[section.rows], DEPOSIT), section) for section in sections]
        return deposited(runs, kind, self.process, self.parameters)

    def _approach(
        self, rows: Integers, returns: Collection[tuple[int, int]], arriving: bool = False
    ) -> list[Block]:
        """Return the rapids to a bead, with a wait for cooling above earlier deposit."""
        cooling = self.process.cooling
        bead_id = int(self.motion.layer[rows[-1]]), int(self.motion.bead[rows[-1]])
        if cooling.below is None or bead_id not in returns:
            return self._onto(rows, arriving)
        onto = self.motion.role[rows] == motions.APPROACH
        if not onto.any():
            onto[-1] = True
        above = [self._moves(rows[~onto], RAPID, arriving)] if not onto.all() else []
        down = self._onto(rows[onto], arriving and not above)
        return [
            *above,
            WaitBelow(cooling.input, cooling.zero + cooling.gain * cooling.below, *bead_id),
            *down,
        ]

    def _onto(self, rows: Integers, arriving: bool) -> list[Block]:
        """Return the rapids to a bead; the last is a linear move if the controller needs one."""
        if not linear_approach.asked(self.parameters, self.controller):
            return [self._moves(rows, RAPID, arriving)]
        linear_approach.check(
            self.motion, self.cell, rows, arriving, self.parameters.schedule.by == ARC
        )
        leading_moves = [self._moves(rows[:-1], RAPID, arriving)] if len(rows) > 1 else []
        return [*leading_moves, replace(self._moves(rows[-1:], RAPID), interpolation=LINEAR_MOVE)]

    def _moves(self, rows: Integers, kind: str, arriving: bool = False) -> Moves:
        """Return the moves of the rows; `arriving` means that the machine starts from an unknown
        position.
        """
        motion, cell, parameters = self.motion, self.cell, self.parameters
        duration = motion.duration[rows].copy()
        if arriving:
            duration[0] = FIRST_TIME
        position = rotation = direction = flange = None
        configuration = None
        if self.controller.flange and cell.arrangement.holds_part:
            flange = frames.inverse(cell.machine.base) @ cell.machine.chain.forward(
                motion.joints[rows]
            )
        if parameters.motion == "cartesian":
            station, carried = frames_of(cell, parameters)
            tip = cell.machine.chain.forward(motion.joints[rows]) @ carried
            tool_poses = (
                frames.inverse(tip) @ station
                if cell.torch_stands
                else frames.inverse(station) @ tip
            )
            position, arm = tool_poses[:, :3, 3], cell.machine.arm
            if arm is None:
                direction = tool_poses[:, :3, 2]
            else:
                rotation = tool_poses[:, :3, :3]
                robot_joints = motion.joints[rows, : cell.robot.chain.axes]
                configuration = tuple(
                    spherical_wrist.branch_name(int(index)) for index in arm.branch_of(robot_joints)
                )
        wire = motion.wire[rows]
        with_wire = kind == DEPOSIT and not parameters.dry_run and bool(np.isfinite(wire).all())
        return Moves(
            kind=kind,
            layer=int(motion.layer[rows[0]]),
            bead=int(motion.bead[rows[0]]),
            joints=cell.machine.to_controller(motion.joints[rows]),
            duration=duration,
            speed=motion.speed[rows],
            position=position,
            rotation=rotation,
            configuration=configuration,
            direction=direction,
            wire=wire if with_wire else None,
            flange=flange,
            interpolation=LINEAR_MOVE
            if kind == DEPOSIT and parameters.motion == "cartesian"
            else JOINT_MOVE,
            stops=motion.stops[rows],
            halt=motion.halt[rows],
            role=_roles(motion.role[rows]),
        )


def _class_of(motion: Motion, row: int) -> str:
    number = int(motion.bead_class[row])
    return "" if number == motions.UNKNOWN else CLASSES[number]


def _groups(motion: Motion, rows: Integers) -> list[Integers]:
    """Split rows wherever the deposit state, layer or bead changes."""
    new = (
        (np.diff(motion.deposit[rows].astype(int)) != 0)
        | (np.diff(motion.layer[rows]) != 0)
        | (np.diff(motion.bead[rows]) != 0)
    )
    return np.split(rows, np.flatnonzero(new) + 1)


def _between(between: BetweenLayersParameters, cooling: float) -> list[Block]:
    blocks: list[Block] = []
    wait = max(between.wait, cooling)
    if wait > 0.0:
        blocks.append(Wait(wait))
    if between.input is not None:
        blocks.append(WaitInput(between.input))
    if between.call is not None:
        blocks.append(Call(between.call))
    return blocks


def _roles(role: Integers) -> tuple[str, ...]:
    """Return the role name (n,) of each row; short cut for rows with one role."""
    if (role == role[0]).all():
        return (ROLES[int(role[0])],) * len(role)
    return tuple(ROLES[number] for number in role.tolist())
