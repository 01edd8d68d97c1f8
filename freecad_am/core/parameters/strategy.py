# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the section `strategy` of a job, one dataclass per family."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..geometry.curves import gcode, gcode_roles
from ..issues import InputError
from . import field as f
from .records import Point, convert_texts
from .vectors import direction_text

MIN_CHORD_ERROR = 0.01  # mm, for parts up to SMALL and for unknown sizes
SMALL_PART_SIZE = 250.0  # mm
GROWTH = 2e-4  # mm to a mm of size beyond SMALL
SHARE = 0.01  # of the width of a bead
BEAD_TO_LAYER = 2.5  # how much wider than high a bead usually is


class DefaultLength(float):
    """A default length in mm that depends on the part, as opposed to a given length."""


def scaled(extent: float, bead: float) -> float:
    """Return the chord error, mm, for a part `extent` mm long with beads `bead` mm wide.

    It is `LEAST` up to `SMALL`, grows with the part beyond, stays below `SHARE` of the bead, and
    has one digit.
    """
    wanted = min(MIN_CHORD_ERROR + GROWTH * (extent - SMALL_PART_SIZE), SHARE * bead)
    if not MIN_CHORD_ERROR < wanted < math.inf:
        return MIN_CHORD_ERROR
    return max(float(f"{wanted:.0e}"), MIN_CHORD_ERROR)


ISO = "iso-parameter"
SPACINGS = ("constant-distance", "smooth", ISO)
FRONTS = "fronts"  # a method
MEND = (
    "Largest hole in a mesh that is closed automatically, with a note; larger holes are rejected."
)
LAYER_TIME = (
    "Minimum time of a layer, from the start of its first bead to the start of the next layer; the machine "
    "waits if needed"
)
MOST_LAYERS = (
    20_000  # more is a mistake in the units: half a millimetre each on the widest platform, 10 m
)


@dataclass(frozen=True)
class LayerParameters:
    """The layer settings of all families. mm."""

    layer_height: float = f.parameter(
        1.0, f.LENGTH, "Distance between neighbouring layers.", low=0.0, open_low=True
    )
    chord_error: float = f.parameter(
        DefaultLength(MIN_CHORD_ERROR),
        f.LENGTH,
        "Largest distance between a bead and the straight segments that approximate it. The "
        "default of a new feature is 0.01 mm up to a size of 250 mm, and more for larger "
        "features, at most a hundredth of the bead width.",
        low=1e-5,
        high=10.0,
    )

    @property
    def has_curved_layers(self) -> bool:
        """Return whether layers are surfaces at equal distances from the support or from faces."""
        return False

    @property
    def follows_guide(self) -> bool:
        """Return whether layers are planes normal to a guide curve."""
        return False


@dataclass(frozen=True)
class RevolutionParameters(LayerParameters):
    """How a part of revolution is cut into layers (Chalvin 2020, section 2.1). mm and rad."""

    spacing: str = f.parameter(
        "arc-length",
        f.CHOICE,
        "Layers equally spaced along the wall (arc-length) or along the axis (iso-height).",
        choices=("arc-length", "iso-height"),
    )
    wall: str = f.parameter(
        "outer",
        f.CHOICE,
        "Which wall of a solid is deposited; middle runs halfway between outer and inner.",
        choices=("outer", "inner", "middle"),
    )
    path: str = f.parameter(
        "layers",
        f.CHOICE,
        "Closed beads layer by layer, or one continuous spiral.",
        choices=("layers", "spiral"),
    )
    min_points: int = f.parameter(
        24,
        f.COUNT,
        "Minimum number of points of a full turn, for any radius.",
        low=6,
        high=10000,
        advanced=True,
    )
    min_layer_time: float = f.parameter(0.0, f.TIME, f"{LAYER_TIME}.", low=0.0)

    def __post_init__(self) -> None:
        f.check(self, "strategy")


@dataclass(frozen=True)
class SurfaceParameters(LayerParameters):
    """How a wall on an existing part is cut into layers (Chalvin 2019, section II). mm."""

    spacing: str = f.parameter(
        "constant-distance",
        f.CHOICE,
        "Layers at the layer height from the nearest point below (constant-distance), within a "
        "band around this height and without corners (smooth), or along the lines up the wall "
        "(iso-parameter).",
        choices=SPACINGS,
    )
    method: str = f.parameter(
        "auto",
        f.CHOICE,
        "Method for layers: by the closed parameter on a tube of one surface and as fronts on "
        "all other walls (auto), or as fronts on every wall (fronts).",
        choices=("auto", FRONTS),
        advanced=True,
    )
    band: float = f.parameter(
        0.2,
        f.RATIO,
        "Share of the layer height by which the local distance of smooth layers may differ; for "
        "iso-parameter layers, the limit for a warning.",
        low=0.0,
        high=1.0,
    )
    bead_turn: float = f.parameter(
        math.radians(6.0),
        f.TURN_RATE,
        "Turn of the bead within the wall that smooth layers stay below if the band allows.",
        low=0.0,
        open_low=True,
    )
    tolerance: float = f.parameter(
        1e-4,
        f.LENGTH,
        "Largest error of the local distance of constant-distance layers.",
        low=1e-6,
        high=1.0,
    )
    end: str = f.parameter(
        "trim",
        f.CHOICE,
        "Last layers trimmed at the upper edge of the wall, or whole layers only.",
        choices=("trim", "whole"),
    )
    compare: tuple[str, ...] = f.parameter(
        (),
        f.TEXT,
        "Further spacings to plan for the comparison in the report.",
    )
    mend: float = f.parameter(5.0, f.LENGTH, MEND, low=0.0, high=10000.0, advanced=True)
    min_layer_time: float = f.parameter(0.0, f.TIME, f"{LAYER_TIME}.", low=0.0)

    def __post_init__(self) -> None:
        f.check(self, "strategy", skip=frozenset({"compare"}))
        object.__setattr__(self, "compare", tuple(self.compare))
        for spacing in self.compare:
            if spacing not in SPACINGS:
                raise f.unknown_choice("strategy.compare", spacing, SPACINGS)
        if self.method == FRONTS and ISO in (self.spacing, *self.compare):
            raise InputError(
                "NO_PARAMETER",
                "strategy.method",
                "iso-parameter layers follow surface lines, but fronts do not; remove "
                "strategy.method, or use constant-distance or smooth",
            )


@dataclass(frozen=True)
class CurvesParameters(LayerParameters):
    """How to print curves as beads; lengths in mm."""

    direction: Point = f.parameter(
        (0.0, 0.0, 1.0),
        f.VECTOR,
        "Direction x y z from the deposit towards the tool, in part coordinates, used where "
        "neither curves nor faces define a direction.",
        records=direction_text("strategy.direction"),
    )
    repeat: int = f.parameter(
        1,
        f.COUNT,
        "Number of layers along the curves, one layer height apart.",
        low=1,
        high=MOST_LAYERS,
    )
    roles: str = f.parameter(
        gcode_roles.PART,
        f.TEXT,
        "G-code: moves to deposit: part, all, or groups and types of the slicer, separated by "
        "commas, such as part, support. Skirt, brim, raft, support, towers, ironing and purge "
        "lines do not belong to part.",
        advanced=True,
    )
    rotary: str = f.parameter(
        gcode.NO_ROTARY,
        f.CHOICE,
        "G-code: meaning of the words A, B and C while X, Y and Z are the tip in the part: the "
        "head turns by C and then A (head-ac) or B (head-bc), or the part turns below the head "
        "(table-ac, table-bc); none rejects these words.",
        choices=gcode.ROTARY,
        advanced=True,
    )
    min_layer_time: float = f.parameter(0.0, f.TIME, f"{LAYER_TIME}.", low=0.0)

    def __post_init__(self) -> None:
        convert_texts(self)
        f.check(self, "strategy")
        if not gcode_roles.split_entries(self.roles):
            raise InputError(
                "BAD_VALUE",
                "strategy.roles",
                "{!r} names no roles; give part, all, or a list",
                self.roles,
            )
