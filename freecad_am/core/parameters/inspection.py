# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of an inspection: how to read, register and evaluate measured points."""

from __future__ import annotations

from dataclasses import dataclass

from ..issues import InputError
from . import field as f

UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 1e-3, "inch": 25.4}
BEST, SHIFT, AXIS, NONE = "best", "shift", "axis", "none"
OUTER_SIDE, INNER, BOTH = "outer", "inner", "both"
AUTO = "auto"
PREFIX = "inspection"


@dataclass(frozen=True)
class InspectionParameters:
    """How measured points are compared with the planned surface."""

    tolerance: float = f.parameter(
        0.5,
        f.LENGTH,
        "Largest deviation, outside or inside, that is within tolerance.",
        low=0.0,
        open_low=True,
        high=1000.0,
    )
    unit: str = f.parameter(
        AUTO,
        f.CHOICE,
        "Unit of the measured coordinates; auto: the unit in the file, otherwise mm.",
        choices=(AUTO, *UNITS),
    )
    probe_radius: float = f.parameter(
        0.0,
        f.LENGTH,
        "Radius of the probe ball if its centre was measured; 0 if the points are on the surface.",
        low=0.0,
        high=100.0,
    )
    fit: str = f.parameter(
        BEST,
        f.CHOICE,
        "Motion allowed to fit the points to the part: best fit, shifts only, a turn about and a "
        "shift along the axis of the part, or only the motion that pairs of points define.",
        choices=(BEST, SHIFT, AXIS, NONE),
    )
    trim: float = f.parameter(
        0.0,
        f.RATIO,
        "Share of the farthest points that the fit ignores.",
        low=0.0,
        high=0.49,
    )
    pairs: str = f.parameter(
        "",
        f.TEXT,
        "Initial fit: three or more pairs of a measured point and the same point on the part, "
        "each x y z > x y z in mm, separated by semicolons; empty: automatic.",
        advanced=True,
    )
    side: str = f.parameter(
        OUTER_SIDE,
        f.CHOICE,
        "Measured side of a wall: the outer side, the inner side, or both.",
        choices=(OUTER_SIDE, INNER, BOTH),
    )
    thickness: float = f.parameter(
        0.0,
        f.LENGTH,
        "Planned thickness of the wall, centred on the planned surface; 0: the planned surface "
        "was measured directly.",
        low=0.0,
        high=1000.0,
    )
    heights: tuple[str, ...] = f.parameter(
        (),
        f.TEXT,
        "Heights above the base of the part, in mm, at which circularity is evaluated; none: one "
        "sixth, one half and five sixths of the measured height.",
        unit="mm",
    )
    band: float = f.parameter(
        0.5,
        f.LENGTH,
        "Points within this distance of an evaluated height are used, shifted to that height "
        "along the planned surface.",
        low=0.0,
        open_low=True,
        high=100.0,
        advanced=True,
    )

    def __post_init__(self) -> None:
        f.check(self, PREFIX, frozenset({"heights"}))
        if self.side == BOTH and self.thickness == 0.0:
            raise InputError(
                "BAD_VALUE",
                f"{PREFIX}.thickness",
                "both sides of a wall need its thickness; add the thickness",
            )
        self.levels()
        self.start_pairs()

    def levels(self) -> tuple[float, ...]:
        """The heights as numbers, mm. Raises InputError."""
        found = []
        for text in self.heights:
            try:
                found.append(float(text.removesuffix("mm")))
            except (ValueError, AttributeError):
                raise InputError(
                    "BAD_VALUE",
                    f"{PREFIX}.heights",
                    "{!r} is not a height; give numbers in mm",
                    text,
                ) from None
        return tuple(found)

    def start_pairs(self) -> tuple[tuple[tuple[float, ...], tuple[float, ...]], ...]:
        """The pairs of points as numbers, mm. Raises InputError."""
        found = []
        for text in filter(str.strip, self.pairs.split(";")):
            sides = [side.replace(",", " ").split() for side in text.split(">")]
            try:
                one, other = (tuple(map(float, side)) for side in sides)
            except ValueError:
                one = other = ()
            if len(one) != 3 or len(other) != 3:
                raise InputError(
                    "BAD_VALUE",
                    f"{PREFIX}.pairs",
                    "{!r} is not a pair of points; give x y z > x y z in mm",
                    text.strip(),
                )
            found.append((one, other))
        return tuple(found)
