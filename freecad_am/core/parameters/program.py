# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `program` of a job."""

from __future__ import annotations

from dataclasses import dataclass

from . import field as f
from .records import Pose

MOTIONS = ("joint", "cartesian")


@dataclass(frozen=True)
class StartParameters:
    """Where a job resumes; both count from 0."""

    layer: int = f.parameter(0, f.COUNT, "First layer to deposit.", low=0)
    bead: int = f.parameter(0, f.COUNT, "First bead of the first layer to deposit.", low=0)

    def __post_init__(self) -> None:
        f.check(self, "program.start_at")


@dataclass(frozen=True)
class NcParameters:
    """The options of programs for five-axis machines; each controller uses those that it supports."""

    feed: str = f.parameter(
        "time",
        f.CHOICE,
        "Feed of joint moves: the time of each move (G93), or the speed of the linear axes "
        "wherever they move (G94).",
        choices=("time", "path"),
    )
    compress: bool = f.parameter(
        True, f.FLAG, "SINUMERIK: block compressor (COMPCAD) in beads whose feed is a speed."
    )
    smooth: bool = f.parameter(
        True, f.FLAG, "SINUMERIK: rounding (G642), jerk limit (SOFT) and feed forward (FFWON)."
    )
    tolerance: float = f.parameter(
        0.05,
        f.LENGTH,
        "LinuxCNC: tolerance for rounding corners (G64 P).",
        low=0.0,
        high=10.0,
        open_low=True,
    )
    deposit_on: str | None = f.parameter(
        None,
        f.TEXT,
        "M or H word that switches the deposit on, such as M7 or H2=1; if empty, the digital "
        "output switches the deposit.",
        optional=True,
    )
    deposit_off: str | None = f.parameter(
        None, f.TEXT, "M or H word that switches the deposit off.", optional=True
    )
    wire_output: int = f.parameter(
        1,
        f.COUNT,
        "Analogue output for the wire speed, if the wire feed follows the travel speed.",
        low=1,
        high=64,
    )
    wire_gain: float = f.parameter(
        1.0,
        f.NUMBER,
        "Value of the analogue output at 1 m/min of wire.",
        low=0.0,
        open_low=True,
        high=1e6,
        unit="min/m",
    )
    switch_kinematics: bool = f.parameter(
        True,
        f.FLAG,
        "LinuxCNC: whether M428 and M429 switch between tip and axis coordinates; false for "
        "machines that only move axes.",
    )

    def __post_init__(self) -> None:
        f.check(self, "program.nc")


@dataclass(frozen=True)
class AxesParameters:
    """The controller's names of the external axes."""

    unit: str | None = f.parameter(
        None,
        f.TEXT,
        "Name or number of the positioner on the controller: mechanical unit of ABB (default "
        "STN1), MACHINE_DEF of KUKA (default 2), motion group of FANUC (default 2).",
        optional=True,
        advanced=True,
    )
    first: int = f.parameter(
        1,
        f.COUNT,
        "Number of the controller's external axis for e1; further axes follow. eax_a and E1 are 1.",
        low=1,
        high=6,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, "program.axes")


@dataclass(frozen=True)
class ScheduleParameters:
    """How to set the schedule of the welder or extruder."""

    by: str = f.parameter(
        "output",
        f.CHOICE,
        "Transmission of the schedule number: on a group output, in arc instructions that also "
        "switch the deposit, or as the number of the program to call.",
        choices=("output", "arc", "call"),
    )
    output: int = f.parameter(
        2,
        f.COUNT,
        "Group output, H word, register or analogue output that carries the schedule number; for "
        "KUKA the first of eight outputs.",
        low=1,
        high=4096,
    )
    call: str = f.parameter(
        "SCHEDULE",
        f.TEXT,
        "Name of the called programs without their number, such as SCHEDULE for SCHEDULE3.",
    )

    def __post_init__(self) -> None:
        f.check(self, "program.schedule")


@dataclass(frozen=True)
class TriggerParameters:
    "Switching of the deposit during the motion, ahead of a point."

    lead: float | None = f.parameter(
        None,
        f.TIME,
        "Time by which the deposit is switched early, during the motion, to compensate for the "
        "delay of the equipment. None: the robot stops to switch.",
        low=0.0,
        high=0.5,
        optional=True,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, "program.trigger")


@dataclass(frozen=True)
class ProgramParameters:
    """The options of the output for the controller."""

    post: str = f.parameter("fanuc", f.TEXT, "The controller of the program, or none.")
    motion: str = f.parameter(
        "joint", f.CHOICE, "Points as joint values, or as positions of the tool.", choices=MOTIONS
    )
    max_points: int = f.parameter(
        2000, f.COUNT, "Maximum points per program file; longer programs are chained.", low=10
    )
    origin: str | Pose = f.parameter(
        "auto",
        f.POSE,
        "Frame of the positions of Cartesian programs, in part coordinates: x y z mm, RX RY RZ "
        "deg; auto: the frame on the platform.",
        words=("auto",),
    )
    dry_run: bool = f.parameter(False, f.FLAG, "Dry run: the same motion without deposit.")
    start_at: StartParameters = f.group(StartParameters, "Layer and bead at which a job resumes.")
    blend: int = f.parameter(
        100,
        f.COUNT,
        "Corner rounding within a bead, percent: CNT of FANUC, and of the maximum of other "
        "controllers.",
        low=0,
        high=100,
        advanced=True,
    )
    nc: NcParameters = f.group(NcParameters, "Programs of five-axis machines.")
    user_frame: int = f.parameter(
        1, f.COUNT, "Number of the user frame named in the program.", low=0, high=61
    )
    tool_frame: int = f.parameter(
        1, f.COUNT, "Number of the tool frame named in the program.", low=1, high=29
    )
    deposit_output: int = f.parameter(
        1, f.COUNT, "Digital output that switches the deposit.", low=1, high=4096
    )
    axes: AxesParameters = f.group(AxesParameters, "Names of the external axes on the controller.")
    schedule: ScheduleParameters = f.group(
        ScheduleParameters, "Transmission of the schedule to the welder or extruder."
    )
    trigger: TriggerParameters = f.group(
        TriggerParameters, "Switching of the deposit during the motion, ahead of a point."
    )

    def __post_init__(self) -> None:
        if self.origin is None:  # an empty property of a document
            object.__setattr__(self, "origin", "auto")
        f.check(self, "program")
