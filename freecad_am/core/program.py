# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program: moves and process events that a post translates into controller code.

Joint values are controller joint values (rad, and mm of prismatic axes); poses are in the
controller's user frame (mm). A post needs nothing else: neither part nor kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .types import Array, Mask

Six = tuple[float, float, float, float, float, float]

DEPOSIT, RAPID = "deposit", "rapid"
# roles of a move, besides DEPOSIT: away from the previous bead, to the next bead, onto its start
RETRACT, TRAVEL, APPROACH = "retract", "travel", "approach"
LINEAR, ROTARY = "linear", "rotary"
# interpolation of a move: straight in joint space, or a straight tip path
JOINT_MOVE, LINEAR_MOVE = "joint", "linear"
# The machine position before a program is unknown, so the first move has no planned time. It runs
# at this fraction of the maximum axis speeds, or takes this time, s, if the controller needs one
FIRST_SHARE, FIRST_TIME = 0.1, 10.0
SHORTEST_RAPID = 0.05  # s; minimum planned duration of a rapid of any length
# mm and rad; maximum deviation of the tip position and tool orientation on a linear rapid from the
# checked path, which is straight in joint space. The clearance includes this deviation. Planning
# subdivides the path to stay within it, and read-back checks the controller code against it
OFF_WAY_MM, OFF_WAY_RAD = 0.2, 1e-3


@dataclass(frozen=True, eq=False)
class Moves:
    """A run of n moves without an event between them.

    kind: 'deposit' or 'rapid'. interpolation: 'joint' (straight in joint space) or 'linear'
    (straight tip path). stops: (n,) bool, whether the machine stops at the end of a move. Otherwise
    it passes through and rounds the corner within `Program.blend` and `NcOptions.tolerance`. By
    default it stops at every point of a rapid and at the last point of a bead. halt: (n,) bool,
    stops within a bead. role: n words, the purpose of each move; by default a rapid of several
    moves begins with a retract. layer, bead: the bead that the moves belong or lead to. joints: (n,
    axes) controller joint values, rad, and mm for linear axes. duration: (n,) s of the move that
    ends at each point, > 0. speed: (n,) mm/s at the deposition point on that move.

    Only for Cartesian motion: position (n, 3) mm and rotation (n, 3, 3) of the tool in the
    program's origin or, with the part on the robot, of the deposition point; and configuration, one
    (shoulder, elbow, wrist) per point. A five-axis machine has no tool rotation and no
    configuration. It has the tip position and direction (n, 3), unit vectors from the deposit
    towards the torch, in the program's origin, which rotates with the part. flange: (n, 4, 4)
    flange pose in the manufacturer's base frame, mm, only for posts that need it
    (`Controller.flange`) with the part on the robot. wire: (n,) wire speed on that move, mm/s, if
    the program has to set it, else None.
    """

    kind: str
    layer: int
    bead: int
    joints: Array
    duration: Array
    speed: Array
    position: Array | None = None
    rotation: Array | None = None
    configuration: tuple[tuple[str, str, str], ...] | None = None
    direction: Array | None = None
    wire: Array | None = None
    flange: Array | None = None
    interpolation: str = JOINT_MOVE
    stops: Mask = None  # type: ignore[assignment]
    role: tuple[str, ...] = ()
    halt: Mask = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        count = len(self.joints)
        if self.halt is None:
            object.__setattr__(self, "halt", np.zeros(count, dtype=bool))
        if self.stops is None:
            last = np.arange(count) == count - 1
            object.__setattr__(self, "stops", last | (self.kind == RAPID))
        if not self.role:
            first = DEPOSIT if self.kind == DEPOSIT else RETRACT if count > 1 else TRAVEL
            other = DEPOSIT if self.kind == DEPOSIT else TRAVEL
            object.__setattr__(self, "role", (first, *(other,) * (count - 1)) if count else ())

    def __len__(self) -> int:
        return len(self.joints)


@dataclass(frozen=True)
class DepositOn:
    """Switch the deposit on and wait `lead` seconds before moving.

    wire: wire speed at the start, mm/s, if the program has to set it. schedule: schedule number in
    the arc instruction, None if an output switches the deposit. ahead: switching time before the
    end of the approach, s; None if the machine switches at standstill.
    """

    lead: float = 0.0
    wire: float | None = None
    schedule: int | None = None
    ahead: float | None = None


@dataclass(frozen=True)
class DepositOff:
    """Wait `lead` seconds at the end of the bead, then switch the deposit off.

    schedule: as in `DepositOn`. ahead: switching time before the end of the bead's last move, s;
    None as in `DepositOn`.
    """

    lead: float = 0.0
    schedule: int | None = None
    ahead: float | None = None


@dataclass(frozen=True)
class Schedule:
    """Set a schedule number on the output `Program.schedule_output`.

    inside: whether this happens within a bead, without a stop.
    """

    number: int
    inside: bool = False


@dataclass(frozen=True)
class Weave:
    """Start the controller's weave `number`, from 1; 0 ends the weave."""

    number: int


@dataclass(frozen=True)
class LayerStart:
    """Mark the start of a layer, where a program can be resumed."""

    layer: int


@dataclass(frozen=True)
class Wait:
    """Wait for a fixed time."""

    seconds: float


@dataclass(frozen=True)
class WaitInput:
    """Wait until a digital input is on."""

    number: int


@dataclass(frozen=True)
class WaitBelow:
    """Wait until an analogue input, from 1, falls below a value.

    layer, bead: the bead that waits. Each bead has a separate wait.
    """

    number: int
    below: float
    layer: int
    bead: int


@dataclass(frozen=True)
class Call:
    """Call another program on the controller, such as nozzle cleaning.

    where: the job parameter that names the program.
    """

    program: str
    where: str = "process.between_layers.call"


Block = (
    Moves
    | DepositOn
    | DepositOff
    | Schedule
    | Weave
    | LayerStart
    | Wait
    | WaitInput
    | WaitBelow
    | Call
)


@dataclass(frozen=True)
class NcOptions:
    """Options of programs for five-axis machines.

    A post uses the options that its controller supports.

    path_feed: whether to write the speed of the linear axes wherever they move, instead of the time
    of each move. compress: block compressor. smooth: rounding, jerk limit and feed forward.
    tolerance: mm, maximum corner rounding. deposit_on, deposit_off: words that switch the deposit,
    empty for the numbered output. switch_kinematics: whether the program must select between the
    controller's axis kinematics and tip kinematics. wire_output: analogue output, from 1, for the
    wire speed if moves give it. wire_gain: output value at 1 m/min.
    """

    path_feed: bool = False
    compress: bool = True
    smooth: bool = True
    tolerance: float = 0.05
    deposit_on: str = ""
    deposit_off: str = ""
    switch_kinematics: bool = True
    wire_output: int = 1
    wire_gain: float = 1.0


@dataclass(frozen=True)
class Program:
    """A complete job, in execution order.

    name: given by the user. A post derives file names from it or rejects it. machine: title of the
    machine. continuous: whether each axis is continuous. remarks: lines that a post writes as
    comments. motion: 'joint' or 'cartesian', whether targets are joint values or positions. Rapids
    are joint moves with either motion. The deposition point moves at constant speed. blend: percent
    of the controller's corner rounding at points that moves pass through. max_speed: rad/s of each
    axis, mm/s of linear axes, infinite if unknown. pulses_per_degree of each axis and speed_unit of
    path speeds: from the machine file, for controllers that count in these units.

    station, carried: X Y Z mm, RX RY RZ rad. With the part on the robot: the deposition point in
    the manufacturer's base frame, and the program's origin on the flange. With the tool on the
    robot, they are the program's origin in the manufacturer's base frame, and the nozzle tip on the flange.
    On a five-axis machine: the torch tip with all axes at zero, and the program's origin on the
    face that carries the part (the work offset with the rotary axes at zero).

    axis_names: the controller's name of each axis, such as X Y Z A C. axis_kinds: 'linear' or
    'rotary' for each axis. Both are empty for robots, whose axes are numbered. nc: only for
    five-axis machines.

    external_kinds: 'linear' or 'rotary' for each external axis; external axes come last. With
    rotary external axes the part is on the last mechanism, and station is the program's origin on
    that mechanism's face. A linear external axis is a track that carries the robot. unit: the
    controller's name for the part's mechanism, or for the track if there is no such mechanism.
    first_external: the controller's number, from 1, of the first external axis. schedule_output:
    the output for schedule numbers. axis_machines: title of the machine or mechanism whose file
    describes each axis. of_urdf: whether that file is a URDF.
    """

    name: str
    machine: str
    blocks: tuple[Block, ...]
    continuous: tuple[bool, ...]
    motion: str = "joint"
    setup: str = "part-on-robot"
    max_points: int = 2000
    blend: int = 100
    user_frame: int = 1
    tool_frame: int = 1
    deposit_output: int = 1
    dry_run: bool = False
    remarks: tuple[str, ...] = ()
    max_speed: tuple[float, ...] = ()
    pulses_per_degree: tuple[float, ...] = ()
    speed_unit: str = ""
    station: Six | None = None
    carried: Six | None = None
    axis_names: tuple[str, ...] = ()
    axis_kinds: tuple[str, ...] = ()
    nc: NcOptions = NcOptions()
    external_kinds: tuple[str, ...] = ()
    unit: str = ""
    first_external: int = 1
    schedule_output: int = 2
    axis_machines: tuple[str, ...] = ()
    of_urdf: tuple[bool, ...] = ()

    @property
    def holds_part(self) -> bool:
        """Whether the robot holds the part under a fixed tool."""
        return self.setup == "part-on-robot"

    @property
    def own_axes(self) -> int:
        """Number of machine axes, excluding external axes."""
        return len(self.continuous) - len(self.external_kinds)

    @property
    def on_track(self) -> bool:
        """Whether a track carries the robot."""
        return LINEAR in self.external_kinds

    @property
    def on_positioner(self) -> bool:
        """Whether a positioner carries the part; positions are then relative to the positioner."""
        return ROTARY in self.external_kinds

    @property
    def slides(self) -> Mask:
        """Return which of the robot's own and external axes are tracks, (axes,) bool."""
        return np.array(
            [*(False,) * self.own_axes, *(kind == LINEAR for kind in self.external_kinds)],
            dtype=np.bool_,
        )

    @property
    def moves(self) -> tuple[Moves, ...]:
        """The blocks that are moves, in order."""
        return tuple(block for block in self.blocks if isinstance(block, Moves))

    @property
    def woven(self) -> frozenset[tuple[int, int]]:
        """Layer and bead indices of the beads with a weave."""
        pairs = zip(self.blocks, self.blocks[1:])
        return frozenset(
            (run.layer, run.bead)
            for block, run in pairs
            if isinstance(block, Weave) and block.number and isinstance(run, Moves)
        )


def slide_feeds(before: Array, joints: Array, duration: Array, kinds: tuple[str, ...]) -> Array:
    """Return the speed of the linear axes on moves.

    V_s = |P1' P2''| V / |P1 P2|, Dai 2020, section 3. The duration of a move is |P1 P2| / V.

    Parameters
    ----------
    before : (axes,) array
        Joint values at the start of the first move, rad or mm.
    joints : (n, axes) array
        Joint values at the end of each move, rad or mm.
    duration : (n,) array
        Durations of the moves, s.
    kinds : tuple of str
        LINEAR or ROTARY for each axis.

    Returns
    -------
    (n,) array
        Speeds, mm/s. 0 where only rotary axes move; the block then needs an inverse-time feed.
    """
    linear = np.array([kind == LINEAR for kind in kinds])
    way = np.diff(np.concatenate([before[None], joints])[:, linear], axis=0)
    feeds: Array = np.linalg.norm(way, axis=1) / duration
    return feeds
