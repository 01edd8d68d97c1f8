# SPDX-License-Identifier: LGPL-2.1-or-later
"""The program: moves and process events that a post turns into a controller's text.

Joint values are those the controller shows (rad), poses those of its user frame (mm). A post reads this and
nothing else; it knows neither part nor kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

Six = tuple[float, float, float, float, float, float]

DEPOSIT, RAPID = "deposit", "rapid"


@dataclass(frozen=True)
class Moves:
    """A run of n moves without an event between; the last one comes to a stop, the others pass through.

    kind: 'deposit' or 'rapid'. layer, bead: the bead the moves belong or lead to. joints: (n, axes) controller
    values, rad. duration: (n,) s of the move that ends at each point, > 0. speed: (n,) mm/s at the deposition
    point on that move. Only where motion is Cartesian: position (n, 3) mm and rotation (n, 3, 3), seen from the program's
    origin, of the tool or, with the part on the robot, of the deposition point; and configuration, one (shoulder, elbow,
    wrist) per point.
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

    def __len__(self) -> int:
        return len(self.joints)


@dataclass(frozen=True)
class DepositOn:
    """Switch the deposit on and wait `lead` seconds before moving."""

    lead: float = 0.0


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
class Call:
    """Call another program of the controller, such as nozzle cleaning."""

    program: str


Block = Moves | DepositOn | DepositOff | LayerStart | Wait | WaitInput | Call


@dataclass(frozen=True)
class Program:
    """All of a job, in order.

    name: as the user named the job; a post derives its own file names or refuses. machine: title of the machine.
    endless: for each axis, whether it turns without end (continuous turn). remarks: lines a post writes as
    comments. motion: 'joint' or 'cartesian'. deposit points run at constant speed at the deposition point.
    max_speed: rad/s of each axis, infinite where not known. station, carried: X Y Z mm, RX RY RZ rad. With the part on
    the robot, of the deposition point in the maker's base frame and of the program's origin on the flange; with the tool
    on the robot, of the program's origin in the maker's base frame and of the nozzle's tip on the flange.
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

    @property
    def moves(self) -> tuple[Moves, ...]:
        """The moves alone, in order."""
        return tuple(block for block in self.blocks if isinstance(block, Moves))


@dataclass(frozen=True)
class ReadMoves:
    """What a post's reader found in a program's text, all moves in the order of execution.

    joints: (n, axes) controller values, rad, exactly as many digits as the text has; rows told in Cartesian positions
    are NaN, None when all are. digits: half of the last digit of the joint values, rad. duration: (n,) s, NaN where
    the text gives a speed. deposit: (n,) bool, whether the deposit is on during the move that ends at the point.
    position, rotation, position_digits (mm), rotation_digits (rad): the same for Cartesian texts.
    speed: (n,) mm/s at the deposition point, NaN where the text gives a time or a percentage; speed_digits: mm/s.
    share: (n,) of the axes' largest speeds that the fastest axis runs at, NaN where the text gives a time or a path
    speed; share_digits: half of its last digit.
    Where the text holds its own frames: frame (4, 4), in the maker's base frame, is what `position` is seen in;
    tool (n, 4, 4) on the flange is what is taken there, with the digits of the positions. lever: (n,) how far out a tool
    stands on another one that carries it. All mm.
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
