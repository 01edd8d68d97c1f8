# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `process` of a job."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from . import bead_classes
from . import field as f
from .bead_classes import BeadClass, BeadEnd, BeadStart

# what each of several features may have of its own, with _ for nested keys; the rest holds for the whole program
OF_FEATURE = (
    "travel_speed",
    "seam_angle",
    "seam_step",
    "direction",
    "bead_width",
    "fill_width",
    "bead_model",
    "acceleration",
)

IN_PROCESS = (
    "travel_speed",
    "schedule",
    "lead_on",
    "lead_off",
    "weave",
)  # what of a class stands for a key of the process


@dataclass(frozen=True)
class SeamParameters:
    """Where closed beads start. rad about the axis, from the X of the feature frame."""

    angle: float = f.parameter(0.0, f.ANGLE, "Where closed beads start.")
    step: float = f.parameter(0.0, f.ANGLE, "How far the start moves from layer to layer.")

    def __post_init__(self) -> None:
        f.check(self, "process.seam")


@dataclass(frozen=True)
class WireParameters:
    """The feedstock; carried to the report and to the deposit commands of a post."""

    diameter: float = f.parameter(1.2, f.LENGTH, "Diameter of the wire.", low=0.001, high=1000.0)
    feed: float | str = f.parameter(
        "auto",
        f.SPEED,
        "Speed of the wire; auto: what makes beads of their width and the layer height at the travel "
        "speed, or what the beads of the bead model were made with. 0: no wire.",
        low=0.0,
        words=("auto",),
    )
    feed_mode: str = f.parameter(
        "constant",
        f.CHOICE,
        "Speed of the wire: constant, or in proportion to the travel speed that a bead model sets, so "
        "that beads keep their section.",
        choices=("constant", "proportional"),
    )

    def __post_init__(self) -> None:
        f.check(self, "process.wire")

    @property
    def section(self) -> float:
        """Section of the wire, mm2."""
        return 0.25 * math.pi * self.diameter**2


@dataclass(frozen=True)
class BetweenLayersParameters:
    """What happens between two layers."""

    lift: float = f.parameter(
        20.0, f.LENGTH, "How far the tool is withdrawn along its axis between beads.", low=0.0
    )
    wait: float = f.parameter(0.0, f.TIME, "How long to wait between layers.", low=0.0)
    input: int | None = f.parameter(
        None,
        f.COUNT,
        "Number of the digital input to wait for between layers.",
        low=1,
        high=4096,
        optional=True,
    )
    call: str | None = f.parameter(
        None,
        f.TEXT,
        "Name of the program to call between layers, such as nozzle cleaning.",
        optional=True,
    )

    def __post_init__(self) -> None:
        f.check(self, "process.between_layers")


@dataclass(frozen=True)
class CoolingParameters:
    """The sensor that tells how hot a place is that the torch returns to."""

    below: float | None = f.parameter(
        None,
        f.NUMBER,
        "Temperature in degrees Celsius that a solid, or a wall, has to be below before its next layer; the "
        "torch waits above where that begins.",
        low=0.0,
        open_low=True,
        optional=True,
        unit="°C",
    )
    input: int = f.parameter(
        1, f.COUNT, "Number of the analogue input that the sensor is on.", low=1, high=64
    )
    gain: float = f.parameter(
        1.0,
        f.NUMBER,
        "By how much the input's value in a program rises with a degree.",
        low=0.0,
        open_low=True,
        advanced=True,
        unit="1/°C",
    )
    zero: float = f.parameter(
        0.0, f.NUMBER, "The input's value in a program at 0 degrees Celsius.", advanced=True
    )

    def __post_init__(self) -> None:
        f.check(self, "process.cooling")


@dataclass(frozen=True)
class MaterialParameters:
    """What is deposited, and where its figures are from."""

    name: str | None = f.parameter(
        None, f.TEXT, "Name of the material; carried to the report.", optional=True
    )
    source: str | None = f.parameter(
        None,
        f.TEXT,
        "Where the figures of the material are from; carried to the report.",
        optional=True,
        advanced=True,
    )
    slowest: float | None = f.parameter(
        None,
        f.SPEED,
        "Slowest travel speed at which the material is laid; slower beads are reported.",
        low=0.0,
        open_low=True,
        optional=True,
        advanced=True,
    )
    fastest: float | None = f.parameter(
        None,
        f.SPEED,
        "Fastest travel speed at which the material is laid; faster beads are reported.",
        low=0.0,
        open_low=True,
        optional=True,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, "process.material")


@dataclass(frozen=True)
class ProcessParameters:
    """Speeds, seams and the switching of the deposit. mm, mm/s, s, rad."""

    travel_speed: float = f.parameter(
        6.0,
        f.SPEED,
        "Speed of the torch along the deposit while depositing.",
        low=0.0,
        open_low=True,
    )
    rapid_speed: float = f.parameter(100.0, f.SPEED, "Speed between beads.", low=0.0, open_low=True)
    seam: SeamParameters = f.group(SeamParameters, "Where closed beads start.")
    direction: str = f.parameter(
        "counter-clockwise",
        f.CHOICE,
        "Direction of closed beads seen against the build direction; open beads run as found unless alternate.",
        choices=("counter-clockwise", "clockwise", "alternate", "as found"),
    )
    bead_width: float = f.parameter(
        8.0,
        f.LENGTH,
        "Width of the bead; held by the bead model. Solids on hubs are filled with beads that wide.",
        low=0.0,
        open_low=True,
    )
    fill_width: str = f.parameter(
        "auto",
        f.CHOICE,
        "How wide the beads of solids on hubs count in filling: as the spacing, or as the bead width; "
        "auto: as the bead width where it is given, held by a bead model, or an overlap counts with it.",
        choices=("auto", "spacing", "bead_width"),
        advanced=True,
    )
    wire: WireParameters = f.group(WireParameters, "The feedstock.")
    density: float = f.parameter(
        7.85,
        f.NUMBER,
        "Density of the deposit in g/cm\u00b3, for its mass.",
        low=0.0,
        open_low=True,
        unit="g/cm³",
    )
    temperature: float | None = f.parameter(
        None, f.NUMBER, "Temperature in degrees Celsius; carried along.", optional=True, unit="°C"
    )
    gas: str | None = f.parameter(None, f.TEXT, "Shielding gas; carried along.", optional=True)
    stand_off: float | None = f.parameter(
        None, f.LENGTH, "Stand-off of the nozzle; carried along.", optional=True
    )
    lead_on: float = f.parameter(
        0.0, f.TIME, "Deposit switched on this long before a bead starts.", low=0.0
    )
    lead_off: float = f.parameter(
        0.0, f.TIME, "Deposit switched off this long after a bead ends.", low=0.0
    )
    overlap: float = f.parameter(
        0.0, f.LENGTH, "How far a closed bead runs on past its seam.", low=0.0
    )
    retreat: float = f.parameter(
        0.0,
        f.LENGTH,
        "How far the torch goes back over an open bead from its end, still depositing, so that its crater is "
        "filled.",
        low=0.0,
    )
    between_layers: BetweenLayersParameters = f.group(
        BetweenLayersParameters, "What happens between two layers."
    )
    cooling: CoolingParameters = f.group(
        CoolingParameters, "A temperature to wait for before returning to a place."
    )
    bead_model: str = f.parameter(
        "none",
        f.TEXT,
        "Sets the travel speed so that beads keep their width in bends: none, csw (steel, Dai 2020), "
        "li-2025 (aluminium), or the path of a calibration table.",
    )
    acceleration: float = f.parameter(
        20.0,
        f.NUMBER,
        "Largest change of the travel speed along a bead, in mm/s per second, where a bead model sets it.",
        low=0.0,
        open_low=True,
        advanced=True,
        unit="mm/s²",
    )

    schedule: int | None = f.parameter(
        None,
        f.COUNT,
        "Number of the schedule by which the welder or extruder lays beads; program.schedule says how it "
        "is sent.",
        low=1,
        high=bead_classes.LARGEST_SCHEDULE,
        optional=True,
    )
    classes: str = f.parameter(
        bead_classes.NONE,
        f.TEXT,
        "What differs for classes of beads (first_layer, contour, fill, closing, link, wall), "
        "such as: contour: travel_speed 8, schedule 3; fill: lead 5; or none.",
    )

    weave: int | None = f.parameter(
        None,
        f.COUNT,
        "Number of the controller's own weave that beads are laid with; 0 or none: straight.",
        low=0,
        high=bead_classes.LARGEST_WEAVE,
        optional=True,
        advanced=True,
    )
    start: BeadStart = f.group(BeadStart, "What differs where beads begin.")
    end: BeadEnd = f.group(BeadEnd, "What differs where beads end.")
    material: MaterialParameters = f.group(MaterialParameters, "What is deposited.")
    machining_allowance: float | None = f.parameter(
        None,
        f.LENGTH,
        "How far the deposit is to reach beyond the part everywhere, to be machined off: its shape is "
        "predicted and compared with the part; none: it is not.",
        low=0.0,
        optional=True,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, "process")
        bead_classes.classes(self.classes)  # whether it is understood

    def of_class(self, name: str) -> BeadClass:
        """What beads of a class have of their own; nothing of a class that is not named."""
        return bead_classes.classes(self.classes).get(name, BeadClass())

    def for_class(self, name: str) -> ProcessParameters:
        """The process as beads of a class are laid by."""
        own = self.of_class(name).own_values()
        mine: dict[str, Any] = {key: value for key, value in own.items() if key in IN_PROCESS}
        for phase in (bead_classes.START, bead_classes.END):
            ends = {
                key.removeprefix(f"{phase}_"): value
                for key, value in own.items()
                if key.startswith(f"{phase}_")
            }
            if ends:
                mine[phase] = dataclasses.replace(getattr(self, phase), **ends)  # type: ignore[arg-type]
        return dataclasses.replace(self, **mine) if mine else self

    @property
    def weaves(self) -> bool:
        """Whether any bead is laid with a weave of the controller's."""
        return any(
            (self.weave, *(one.weave for one in bead_classes.classes(self.classes).values()))
        )

    @property
    def ramped(self) -> bool:
        """Whether starts or ends of any beads have ramps."""
        named = [self, *(self.for_class(name) for name in bead_classes.classes(self.classes))]
        return any(
            phase.there and phase.ramp > 0.0 for one in named for phase in (one.start, one.end)
        )

    @property
    def scheduled(self) -> bool:
        """Whether any bead has a schedule."""
        classes = bead_classes.classes(self.classes).values()
        keys = ("schedule", "start_schedule", "end_schedule")
        ends = (self.schedule, self.start.schedule, self.end.schedule)
        return any(one is not None for one in ends) or any(
            key in one.own_values() for one in classes for key in keys
        )
