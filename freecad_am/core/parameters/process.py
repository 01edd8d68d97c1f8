# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `process` of a job."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any

from . import bead_classes
from . import field as f
from . import settings as by_place
from .bead_classes import BeadClass, BeadEnd, BeadStart
from .records import Point, convert_texts
from .settings import Setting
from .vectors import direction_text, point_text

# what each of several features may have of its own, with _ for nested keys; the rest holds for the whole program
OF_FEATURE = (
    "travel_speed",
    "seam_angle",
    "seam_step",
    "seam_position",
    "seam_point",
    "seam_away_from",
    "seam_distance",
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
)  # class attributes that replace a key of the process


BY_ANGLE, BY_POINT, SHARPEST, SPREAD, HIDDEN = "angle", "point", "sharpest", "spread", "hidden"


@dataclass(frozen=True)
class SeamParameters:
    """Where closed beads start. rad about the axis, from the X of the feature frame; mm."""

    angle: float = f.parameter(0.0, f.ANGLE, "Start of closed beads.")
    step: float = f.parameter(0.0, f.ANGLE, "Shift of the start from layer to layer.")
    position: str = f.parameter(
        BY_ANGLE,
        f.CHOICE,
        "Start of closed beads: at the angle, nearest to the point, at the sharpest corner, "
        "spread at a distance from other starts, or hidden from a viewer.",
        choices=(BY_ANGLE, BY_POINT, SHARPEST, SPREAD, HIDDEN),
    )
    point: Point | None = f.parameter(
        None,
        f.VECTOR,
        "For position point: x y z in part coordinates, mm; every closed bead starts at its "
        "place nearest to this point.",
        records=point_text("process.seam.point", "none"),
        unit="mm",
    )
    away_from: Point | None = f.parameter(
        None,
        f.VECTOR,
        "For position hidden: direction x y z from the part to the viewer, in part coordinates; "
        "closed beads start on the far side.",
        records=direction_text("process.seam.away_from", "none"),
    )
    distance: float = f.parameter(
        15.0,
        f.LENGTH,
        "For position spread: least distance between the start of a closed bead and the starts of "
        "other beads of its layer and of the layer below.",
        low=0.0,
        open_low=True,
    )
    scarf: float = f.parameter(
        0.0,
        f.LENGTH,
        "Length over which the section of a closed bead rises at its start and falls at its end, "
        "on top of the start, so that the seam has no step; 0: none.",
        low=0.0,
    )

    def __post_init__(self) -> None:
        convert_texts(self)
        f.check(self, "process.seam")


@dataclass(frozen=True)
class WireParameters:
    """The feedstock; the report and the deposit commands of a post use it."""

    diameter: float = f.parameter(1.2, f.LENGTH, "Diameter of the wire.", low=0.001, high=1000.0)
    feed: float | str = f.parameter(
        "auto",
        f.SPEED,
        "Wire feed; auto: the feed for the bead width and layer height at the travel speed, or "
        "the feed of the bead model. 0: no wire.",
        low=0.0,
        words=("auto",),
    )
    feed_mode: str = f.parameter(
        "constant",
        f.CHOICE,
        "Wire feed: constant, or proportional to the travel speed of a bead model, so that beads "
        "keep their cross-section.",
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
    """The settings between two layers."""

    lift: float = f.parameter(
        20.0, f.LENGTH, "Retract distance along the tool axis between beads.", low=0.0
    )
    wait: float = f.parameter(0.0, f.TIME, "Waiting time between layers.", low=0.0)
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
    """The sensor for the temperature of a place to which the torch returns."""

    below: float | None = f.parameter(
        None,
        f.NUMBER,
        "Temperature in degrees Celsius below which a solid or a wall must cool before its next "
        "layer; the torch waits above the start of that layer.",
        low=0.0,
        open_low=True,
        optional=True,
        unit="°C",
    )
    input: int = f.parameter(
        1, f.COUNT, "Number of the analogue input of the sensor.", low=1, high=64
    )
    gain: float = f.parameter(
        1.0,
        f.NUMBER,
        "Change of the input value, as the program reads it, per degree.",
        low=0.0,
        open_low=True,
        advanced=True,
        unit="1/°C",
    )
    zero: float = f.parameter(
        0.0, f.NUMBER, "Input value, as the program reads it, at 0 degrees Celsius.", advanced=True
    )

    def __post_init__(self) -> None:
        f.check(self, "process.cooling")


@dataclass(frozen=True)
class MaterialParameters:
    """The deposited material and the source of its data."""

    name: str | None = f.parameter(
        None, f.TEXT, "Name of the material; copied to the report.", optional=True
    )
    source: str | None = f.parameter(
        None,
        f.TEXT,
        "Source of the material data; copied to the report.",
        optional=True,
        advanced=True,
    )
    slowest: float | None = f.parameter(
        None,
        f.SPEED,
        "Slowest travel speed for the material; slower beads are reported.",
        low=0.0,
        open_low=True,
        optional=True,
        advanced=True,
    )
    fastest: float | None = f.parameter(
        None,
        f.SPEED,
        "Fastest travel speed for the material; faster beads are reported.",
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
        "Travel speed while depositing.",
        low=0.0,
        open_low=True,
    )
    rapid_speed: float = f.parameter(100.0, f.SPEED, "Speed between beads.", low=0.0, open_low=True)
    seam: SeamParameters = f.group(SeamParameters, "Start of closed beads.")
    direction: str = f.parameter(
        "counter-clockwise",
        f.CHOICE,
        "Direction of closed beads seen against the build direction; open beads keep their "
        "direction unless alternate.",
        choices=("counter-clockwise", "clockwise", "alternate", "as found"),
    )
    bead_width: float = f.parameter(
        8.0,
        f.LENGTH,
        "Width of the bead; a bead model keeps this width. Solids on hubs are filled with beads "
        "of this width.",
        low=0.0,
        open_low=True,
    )
    fill_width: str = f.parameter(
        "auto",
        f.CHOICE,
        "Effective bead width when solids on hubs are filled: the bead spacing, or the bead "
        "width; auto: the bead width if it is set, kept by a bead model, or used by an overlap.",
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
        None,
        f.NUMBER,
        "Temperature in degrees Celsius; copied to the report.",
        optional=True,
        unit="°C",
    )
    gas: str | None = f.parameter(
        None, f.TEXT, "Shielding gas; copied to the report.", optional=True
    )
    stand_off: float | None = f.parameter(
        None, f.LENGTH, "Nozzle stand-off; copied to the report.", optional=True
    )
    lead_on: float = f.parameter(
        0.0, f.TIME, "Time from switching the deposit on until a bead starts.", low=0.0
    )
    lead_off: float = f.parameter(
        0.0, f.TIME, "Time from the end of a bead until the deposit is switched off.", low=0.0
    )
    overlap: float = f.parameter(
        0.0, f.LENGTH, "Length by which a closed bead continues past its seam.", low=0.0
    )
    retreat: float = f.parameter(
        0.0,
        f.LENGTH,
        "Length by which the torch returns over an open bead from its end, still depositing, to "
        "fill the crater.",
        low=0.0,
    )
    between_layers: BetweenLayersParameters = f.group(
        BetweenLayersParameters, "Settings between two layers."
    )
    cooling: CoolingParameters = f.group(
        CoolingParameters, "Temperature to wait for before the next layer."
    )
    bead_model: str = f.parameter(
        "none",
        f.TEXT,
        "Model that sets the travel speed so that beads keep their width in bends: none, csw "
        "(steel, Dai 2020), li-2025 (aluminium), or the path of a calibration table.",
    )
    acceleration: float = f.parameter(
        20.0,
        f.NUMBER,
        "Largest change of the travel speed along a bead, in mm/s per second, if a bead model "
        "sets the speed.",
        low=0.0,
        open_low=True,
        advanced=True,
        unit="mm/s²",
    )

    schedule: int | None = f.parameter(
        None,
        f.COUNT,
        "Schedule number with which the welder or extruder deposits beads; program.schedule "
        "defines the transmission.",
        low=1,
        high=bead_classes.LARGEST_SCHEDULE,
        optional=True,
    )
    classes: tuple[BeadClass, ...] = f.parameter(
        (),
        f.RECORDS,
        "Settings of bead classes (first_layer, contour, fill, closing, link, wall), such as: "
        "contour: travel_speed 8, schedule 3; fill: lead 5; or none.",
        records=bead_classes.BEAD_CLASSES,
    )

    settings: tuple[Setting, ...] = f.parameter(
        (),
        f.RECORDS,
        "Settings by place; later ones win, and all win over bead classes, such as: layers 0 to 4: "
        "travel_speed 4, schedule 3; inside Zone: travel_speed 5; or none.",
        records=by_place.SETTINGS,
    )

    weave: int | None = f.parameter(
        None,
        f.COUNT,
        "Weave number of the controller for the beads; 0 or none: straight.",
        low=0,
        high=bead_classes.LARGEST_WEAVE,
        optional=True,
        advanced=True,
    )
    start: BeadStart = f.group(BeadStart, "Settings at the start of beads.")
    end: BeadEnd = f.group(BeadEnd, "Settings at the end of beads.")
    material: MaterialParameters = f.group(MaterialParameters, "The deposited material.")
    machining_allowance: float | None = f.parameter(
        None,
        f.LENGTH,
        "Required machining allowance around the whole part: the deposit is predicted and "
        "compared with the part; none: no comparison.",
        low=0.0,
        optional=True,
        advanced=True,
    )

    def __post_init__(self) -> None:
        convert_texts(self)
        f.check(self, "process")
        bead_classes.check_twice(self.classes)
        by_place.check_number(self.settings)

    def of_class(self, name: str) -> BeadClass:
        """Return the own settings of a bead class; none for a class that is not listed."""
        named = (bead_class for bead_class in self.classes if bead_class.name == name)
        return next(named, BeadClass())

    def for_class(self, name: str) -> ProcessParameters:
        """Return the process for beads of a class."""
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

    def at_place(self, name: str, active: int) -> ProcessParameters:
        """Return the process for beads of a class where settings by place hold.

        Parameters
        ----------
        name : str
            Name of the class.
        active : int
            Sum of 2^entry of the settings that hold; 0 for none.

        Returns
        -------
        ProcessParameters
            The process of the class, with the values of the settings; later ones win.
        """
        values: dict[str, Any] = {}
        # a motion that is stale may have more of them
        for number in by_place.entries_of(active & (1 << len(self.settings)) - 1):
            values |= self.settings[number].own_values()
        process = self.for_class(name)
        return dataclasses.replace(process, **values) if values else process

    @property
    def weaves(self) -> bool:
        """Return whether any bead uses a weave of the controller."""
        by_class = (bead_class.weave for bead_class in self.classes)
        return any((self.weave, *by_class, *(setting.weave for setting in self.settings)))

    @property
    def ramped(self) -> bool:
        """Whether starts or ends of any beads have ramps."""
        processes = [self, *(self.for_class(bead_class.name) for bead_class in self.classes)]
        phases = [phase for process in processes for phase in (process.start, process.end)]
        return any(phase.there and phase.ramp > 0.0 for phase in phases)

    @property
    def scheduled(self) -> bool:
        """Whether any bead has a schedule."""
        keys = ("schedule", "start_schedule", "end_schedule")
        by_place = (setting.schedule for setting in self.settings)
        ends = (self.schedule, self.start.schedule, self.end.schedule, *by_place)
        return any(schedule is not None for schedule in ends) or any(
            key in bead_class.own_values() for bead_class in self.classes for key in keys
        )
