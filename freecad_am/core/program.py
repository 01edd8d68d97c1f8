# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program: moves and process events that a post turns into a controller's text.

Joint values are those the controller shows (rad, and mm of axes that slide), poses those of its user frame (mm). A post
reads this and nothing else; it knows neither part nor kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Six = tuple[float, float, float, float, float, float]

DEPOSIT, RAPID = "deposit", "rapid"
LINEAR, ROTARY = "linear", "rotary"


@dataclass(frozen=True)
class Moves:
    """A run of n moves without an event between; the last one comes to a stop, the others pass through.

    kind: 'deposit' or 'rapid'. layer, bead: the bead the moves belong or lead to. joints: (n, axes) controller
    values, rad, and mm of linear axes. duration: (n,) s of the move that ends at each point, > 0. speed: (n,) mm/s at the
    deposition point on that move. Only where motion is Cartesian: position (n, 3) mm and rotation (n, 3, 3), seen from the
    program's origin, of the tool or, with the part on the robot, of the deposition point; and configuration, one
    (shoulder, elbow, wrist) per point. On a rotary table, which has no rotation about the tool and no configuration:
    position of the tip, and direction (n, 3), unit vectors from the deposit towards the torch, seen from the program's
    origin, which turns with the part. wire: (n,) mm/s of the wire on that move where the program has to tell it, else None.
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

    def __len__(self) -> int:
        return len(self.joints)


@dataclass(frozen=True)
class DepositOn:
    """Switch the deposit on and wait `lead` seconds before moving. wire: mm/s of the wire it begins with, where the program
    has to tell it."""

    lead: float = 0.0
    wire: float | None = None


@dataclass(frozen=True)
class DepositOff:
    """Wait `lead` seconds at the end of the bead, then switch the deposit off."""

    lead: float = 0.0


@dataclass(frozen=True)
class LayerStart:
    """A new layer begins; a place to resume at."""

    layer: int


@dataclass(frozen=True)
class Wait:
    """Stand still for some seconds."""

    seconds: float


@dataclass(frozen=True)
class WaitInput:
    """Stand still until a digital input is on."""

    number: int


@dataclass(frozen=True)
class WaitBelow:
    """Stand still until the analogue input, from 1, is below a value. layer, bead: what it is waited for, which no other one
    is."""

    number: int
    below: float
    layer: int
    bead: int


@dataclass(frozen=True)
class Call:
    """Call another program of the controller, such as nozzle cleaning."""

    program: str


Block = Moves | DepositOn | DepositOff | LayerStart | Wait | WaitInput | WaitBelow | Call


@dataclass(frozen=True)
class NcOptions:
    """How programs of five-axis machines are written; a post reads what its controller knows.

    path_feed: speed of the linear axes wherever they move, in place of the time of each move. compress, smooth: block
    compressor; rounding, jerk limit and feed forward. tolerance: mm, largest rounding of corners. deposit_on, deposit_off:
    words that switch the deposit, empty for the numbered output. switch_kinematics: the controller knows a kinematics for
    axes and one for the tip, and is told which. wire_output: analogue output, from 1, of the wire's speed where moves tell
    it; wire_gain: its value at 1 m/min.
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
    """All of a job, in order.

    name: as the user named the job; a post derives its own file names or refuses. machine: title of the machine.
    endless: for each axis, whether it turns without end (continuous turn). remarks: lines a post writes as
    comments. motion: 'joint' or 'cartesian'. deposit points run at constant speed at the deposition point.
    max_speed: rad/s of each axis, mm/s of linear ones, infinite where not known. station, carried: X Y Z mm, RX RY RZ
    rad. With the part on the robot, of the deposition point in the maker's base frame and of the program's origin on the
    flange; with the tool on the robot, of the program's origin in the maker's base frame and of the nozzle's tip on the
    flange. On a rotary table, of the torch's tip with all axes at zero, and of the program's origin on the table's face:
    the work offset with the rotary axes at zero. axis_names: how the controller writes each axis, such as X Y Z A C;
    axis_kinds: 'linear' or 'rotary', one each. Both are empty for robots, whose axes go by number. nc: for five-axis
    machines alone.
    """

    name: str
    machine: str
    blocks: tuple[Block, ...]
    endless: tuple[bool, ...]
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
    station: Six | None = None
    carried: Six | None = None
    axis_names: tuple[str, ...] = ()
    axis_kinds: tuple[str, ...] = ()
    nc: NcOptions = NcOptions()

    @property
    def moves(self) -> tuple[Moves, ...]:
        """The moves alone, in order."""
        return tuple(block for block in self.blocks if isinstance(block, Moves))

    @property
    def awaited(self) -> Array:
        """(n, 2) of all moves: which analogue input is waited for right before, and below what; 0 and NaN where none is."""
        found: list[Array] = [np.zeros((0, 2))]
        before = (0.0, np.nan)
        for block in self.blocks:
            if isinstance(block, WaitBelow):
                before = float(block.number), block.below
            elif isinstance(block, Moves) and len(block):
                found.append(np.vstack([before, np.tile((0.0, np.nan), (len(block) - 1, 1))]))
                before = (0.0, np.nan)
        return np.concatenate(found)


def slide_feeds(before: Array, joints: Array, duration: Array, kinds: tuple[str, ...]) -> Array:
    """(n,) mm/s of the linear axes alone on moves that take `duration` (n,) s: V_s = |P1' P2''| V / |P1 P2| of Dai 2020,
    section 3, for |P1 P2| / V is that time. It is 0 where only rotary axes move: such blocks need an inverse-time feed.

    before: (axes,) where the first move starts. joints: (n, axes) where the moves end.
    """
    linear = np.array([kind == LINEAR for kind in kinds])
    way = np.diff(np.concatenate([before[None], joints])[:, linear], axis=0)
    feeds: Array = np.linalg.norm(way, axis=1) / duration
    return feeds


@dataclass(frozen=True)
class ReadMoves:
    """What a post's reader found in a program's text, all moves in the order of execution.

    joints: (n, axes) controller values, rad, and mm of linear axes, exactly as many digits as the text has; rows told in
    Cartesian positions are NaN, None when all are; of texts that give positions and rotary axes, the linear axes alone
    are NaN. digits: half of the last digit of the joint values, rad; linear_digits: of linear axes, mm. duration: (n,) s,
    NaN where the text gives a speed; duration_digits: (n,) s by which its digits may be off, milliseconds and tenths
    when left out. deposit: (n,) bool, whether the deposit is on during the move that ends at the point.
    position, rotation, position_digits (mm), rotation_digits (rad): the same for Cartesian texts; direction (n, 3), as
    in `Moves`, and direction_digits, half of the last digit of its numbers, for texts that tell of no rotation.
    speed: (n,) mm/s at the deposition point, NaN where the text gives a time or a percentage; speed_digits: mm/s.
    share: (n,) of the axes' largest speeds that the fastest axis runs at, NaN where the text gives a time or a path
    speed; share_digits: half of its last digit.
    shorter_way: (axes,) rotary axes of machine tools that the text sends the shorter way, so that it tells no turns.
    Where the text holds its own frames: frame (4, 4), in the maker's base frame, is what `position` is seen in;
    tool (n, 4, 4) on the flange is what is taken there, with the digits of the positions. lever: (n,) how far out a tool
    stands on another one that carries it. All mm.
    wire: (n,) value of the analogue output that the text sets, during each move, NaN before the first; None in texts that
    set none. wire_digits: (n,) half of its last digit. awaited: (n, 2) as of a program; None: nothing is waited for.
    """

    joints: Array | None
    digits: float
    duration: Array
    deposit: NDArray[np.bool_]
    position: Array | None = None
    rotation: Array | None = None
    position_digits: float = 0.0
    rotation_digits: float = 0.0
    speed: Array | None = None
    speed_digits: float = 0.05
    share: Array | None = None
    share_digits: float = 0.0
    frame: Array | None = None
    tool: Array | None = None
    lever: Array | None = None
    direction: Array | None = None
    direction_digits: float = 0.0
    linear_digits: float = 0.0
    duration_digits: Array | None = None
    shorter_way: NDArray[np.bool_] | None = None
    wire: Array | None = None
    wire_digits: Array | float = 0.0
    awaited: Array | None = None


def waits_otherwise(program: Program, read: ReadMoves) -> NDArray[np.bool_]:
    """(n,) the moves before which a text waits for another analogue input than the program, or for another value."""
    wanted = program.awaited
    found = np.tile((0.0, np.nan), (len(wanted), 1)) if read.awaited is None else read.awaited
    off = ~(np.abs(found[:, 1] - wanted[:, 1]) <= 1e-6) & (wanted[:, 0] > 0.0)
    return np.asarray((found[:, 0] != wanted[:, 0]) | off)
