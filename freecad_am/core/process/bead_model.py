# SPDX-License-Identifier: LGPL-2.1-or-later
"""Width and height of a bead from travel speed and curvature: w = m v^(-1/3) + p / r + t (Dai 2020, section 4).

The model predicts the width, not the cross-section. At constant wire feed, a bead that is faster in a bend is lower
there (ERRATA), so the height has a separate fit of the same form. Inside the fit the speed is in mm/min, as in the
paper; all arguments are in mm and mm/s. The radius is unsigned: the model does not distinguish the inside and the
outside of a bend.

The wire length per millimetre determines the bead. A bead measured at wire feed f therefore enters the fit at the
equivalent speed v f0 / f, where f0 is the nominal feed. For another feed within the measured range, the speeds scale by
the same ratio.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..issues import WARNING, InputError, Issue, Text, Word
from ..parameters.process import ProcessParameters
from ..toolpath import SpeedLaw, Toolpath
from ..types import Array, Mask

MINUTE = 60.0
MIN_ROWS = 4  # minimum rows: three coefficients and one degree of freedom for the residual
CONTRADICTING = 0.25  # fraction of the mean; maximum difference between repeated measurements
FLATTEST = 1e-8  # minimum relative singular value of a table that determines the coefficients


@dataclass(frozen=True)
class Fit:
    """Coefficients and quality of a fit.

    m, p, t: coefficients of v^(-1/3) [mm (mm/min)^(1/3)], 1/r [mm^2] and 1 [mm]. rmse: mm, root mean square error per
    residual degree of freedom.
    """

    m: float
    p: float
    t: float
    r_squared: float
    rmse: float

    def value_at(self, speed: Array, radius: Array) -> Array:
        """Evaluate the fit.

        Parameters
        ----------
        speed : (...) array
            Travel speeds, mm/s.
        radius : (...) array
            Radii of curvature, mm; infinite for straight segments.

        Returns
        -------
        (...) array
            m v^(-1/3) + p / r + t, mm, with v in mm/min.

        References
        ----------
        Dai 2020, section 4.
        """
        value: Array = self.m * np.cbrt(1.0 / (MINUTE * speed)) + self.p / radius + self.t
        return value


@dataclass(frozen=True, eq=False)
class Asked:
    """Travel speeds for a requested width.

    speed: (n,) mm/s. too_slow, too_fast: (n,) where the required speed is outside the table. too_tight: (n,) where the
    radius is below the table's minimum.
    """

    speed: Array
    too_slow: Mask
    too_fast: Mask
    too_tight: Mask


@dataclass(frozen=True)
class BeadModel:
    """Fits of width and height, with the range of the measured beads.

    speeds: minimum and maximum, mm/s. radii: minimum and maximum, mm, infinite for straight beads. wire_feed: nominal
    feed, mm/s. feeds: minimum and maximum wire feed, mm/s. speed_ratios: minimum and maximum ratio of speed to wire
    feed. contradictions: texts that name table rows with equal settings and different results.
    """

    width: Fit
    height: Fit
    speeds: tuple[float, float]
    radii: tuple[float, float]
    wire_feed: float
    feeds: tuple[float, float] | None = field(default=None, repr=False)
    speed_ratios: tuple[float, float] | None = field(default=None, repr=False)
    contradictions: tuple[str, ...] = field(default=(), repr=False)

    def at_feed(self, feed: float) -> BeadModel:
        """Return the model at another wire feed, mm/s; unchanged if the feed is outside the measured range."""
        if (
            self.feeds is None
            or self.speed_ratios is None
            or not self.feeds[0] <= feed <= self.feeds[1]
        ):
            return self
        more = float(np.cbrt(feed / self.wire_feed))
        low, high = (feed * ratio for ratio in self.speed_ratios)
        return replace(
            self,
            width=replace(self.width, m=more * self.width.m),
            height=replace(self.height, m=more * self.height.m),
            speeds=(max(low, self.speeds[0]), min(high, self.speeds[1])),
            wire_feed=feed,
        )

    def widths(self, speed: Array, radius: Array) -> Array:
        """Return the widths of beads.

        Parameters
        ----------
        speed : (...) array
            Travel speeds, mm/s.
        radius : (...) array
            Radii of curvature, mm. Radii below the table's minimum count as the minimum.

        Returns
        -------
        (...) array
            Widths, mm.
        """
        return self.width.value_at(speed, np.maximum(radius, self.radii[0]))

    def heights(self, speed: Array, radius: Array) -> Array:
        """Return the heights of beads.

        Parameters
        ----------
        speed : (...) array
            Travel speeds, mm/s.
        radius : (...) array
            Radii of curvature, mm. Radii below the table's minimum count as the minimum.

        Returns
        -------
        (...) array
            Heights, mm.
        """
        return self.height.value_at(speed, np.maximum(radius, self.radii[0]))

    def law(self, acceleration: float) -> SpeedLaw:
        """Return the change of bead size with speed; speeds change by at most `acceleration` mm/s^2."""
        root = float(np.cbrt(1.0 / MINUTE))
        return SpeedLaw(self.width.m * root, self.height.m * root, self.speeds[0], acceleration)

    def straight_speed(self, width: float) -> float:
        """Return the speed, mm/s, that gives a straight bead `width` mm at the nominal wire feed."""
        return float(self.speed_for(width, np.array([np.inf])).speed[0])

    def heights_of_section(self, widths: Array, width: float) -> Array:
        """Return the heights of beads with the cross-section of a straight bead.

        A wire feed proportional to the speed keeps the cross-section constant. For
        cross-sections of similar shape, height times width is then constant.

        Parameters
        ----------
        widths : (n,) array
            Widths of the beads, mm.
        width : float
            Width of the straight bead, mm.

        Returns
        -------
        (n,) array
            Heights, mm.
        """
        speed, straight = np.array([self.straight_speed(width)]), np.array([np.inf])
        section: Array = self.heights(speed, straight) * self.widths(speed, straight)
        return section / widths

    def speed_for(self, width: float | Array, radius: Array) -> Asked:
        """Return the travel speed for a requested width, limited to the speeds of the table.

        Parameters
        ----------
        width : float or (n,) array
            Requested width, mm.
        radius : (n,) array
            Radii of curvature, mm; infinite for straight segments.

        Returns
        -------
        Asked
            Speeds, mm/s, and where speed or radius is outside the table.
        """
        straight_only = np.isinf(self.radii[0])  # a table without bends does not limit the radius
        tight = (radius < self.radii[0] * (1.0 - 1e-9)) & (not straight_only)
        speed_term = width - self.width.p / np.maximum(radius, self.radii[0]) - self.width.t
        with np.errstate(divide="ignore", over="ignore"):
            speed = (
                np.where(
                    speed_term > 0.0,
                    (self.width.m / np.where(speed_term > 0.0, speed_term, 1.0)) ** 3,
                    np.inf,
                )
                / MINUTE
            )
        slowest, fastest = self.speeds
        slack = 1e-9 * fastest
        return Asked(
            np.clip(speed, slowest, fastest),
            speed < slowest - slack,
            speed > fastest + slack,
            np.asarray(tight),
        )


def fit(
    radius: Array,
    speed: Array,
    width: Array,
    height: Array,
    wire_feed: float,
    label: str = "table",
    lines: Sequence[int] = (),
    feeds: Array | None = None,
) -> BeadModel:
    """Fit the model to a calibration table by least squares.

    The model is linear in its three coefficients, or in two if all beads are straight.

    Parameters
    ----------
    radius : (n,) array
        Radii of curvature, mm; infinite for straight beads.
    speed : (n,) array
        Travel speeds, mm/s.
    width, height : (n,) array
        Measured sizes, mm.
    wire_feed : float
        Wire feed, mm/s; the nominal wire feed if `feeds` is given.
    label : str, optional
        Name of the table, for messages.
    lines : sequence of int, optional
        Line number of each row in its file, for messages; empty if unknown.
    feeds : (n,) array or None, optional
        Wire feed of each bead, mm/s, if the feeds differ.

    Returns
    -------
    BeadModel
        The model.

    Raises
    ------
    InputError
        TOO_FEW_ROWS, BAD_TABLE (values that are not positive or not finite),
        COLLINEAR_TABLE (radii or speeds do not vary, or vary only together), TABLE_CONTRADICTS
        (contradictory rows, and width does not fall with speed) or NO_MODEL (width does not
        fall with speed).

    References
    ----------
    Dai 2020, section 4.
    """
    columns = {
        "radius": (radius, "mm"),
        "travel speed": (MINUTE * speed, "mm/min"),
        "width": (width, "mm"),
        "height": (height, "mm"),
    }
    if len(radius) < MIN_ROWS:
        rows = "1 row" if len(radius) == 1 else Text("{} rows", len(radius))
        raise InputError(
            "TOO_FEW_ROWS",
            label,
            "the bead table has {}; measure at least {} beads",
            Word(rows),
            MIN_ROWS,
        )
    for name, (column, unit) in columns.items():
        wrong = np.flatnonzero(~((np.isfinite(column) | (column is radius)) & (column > 0.0)))
        if len(wrong):
            text = Text(
                "{} {:.9g} {} is not a positive number; correct or remove the row",
                name,
                column[wrong[0]],
                unit,
            )
            raise InputError("BAD_TABLE", row_name(label, int(wrong[0]), lines), text)
    equivalent = speed if feeds is None else speed * (wire_feed / feeds)
    terms = np.stack([np.cbrt(1.0 / (MINUTE * equivalent)), np.ones(len(radius))], axis=1)
    if np.isfinite(radius).any():
        terms = np.insert(terms, 1, 1.0 / radius, axis=1)
    scaled = terms / np.linalg.norm(terms, axis=0)
    singular = np.linalg.svd(scaled, compute_uv=False)
    contradictions = _contradictions(
        radius, speed, feeds, {"width": width, "height": height}, lines
    )
    if singular[-1] < FLATTEST * singular[0]:
        raise InputError(
            "COLLINEAR_TABLE",
            label,
            "{}{}",
            _alike(radius, speed, equivalent),
            _besides(contradictions),
        )
    fits = [_fit(terms, column) for column in (width, height)]
    if fits[0].m <= 0.0:
        if contradictions:
            raise InputError(
                "TABLE_CONTRADICTS",
                label,
                "rows with the same settings have different results: {}; with both rows of each "
                "pair the bead width would increase with speed; measure these beads again, or "
                "remove the wrong rows",
                Text.joined(", ", contradictions),
            )
        raise InputError(
            "NO_MODEL",
            label,
            "the bead width increases with speed (m = {:.4g}); check the columns of the table",
            fits[0].m,
        )
    model = BeadModel(
        fits[0],
        fits[1],
        (float(speed.min()), float(speed.max())),
        (float(radius.min()), float(radius.max())),
        wire_feed,
        contradictions=contradictions,
    )
    return (
        model
        if feeds is None
        else replace(model, feeds=_ends(feeds), speed_ratios=_ends(speed / feeds))
    )


def _contradictions(
    radius: Array,
    speed: Array,
    feeds: Array | None,
    measured: dict[str, Array],
    lines: Sequence[int],
) -> tuple[str, ...]:
    """Describe pairs of contradictory rows.

    Two rows with equal radius, speed and wire feed contradict if width or height differs by more than `CONTRADICTING`
    of the mean.
    """
    settings = [radius, speed, np.zeros(len(speed)) if feeds is None else feeds]
    groups: dict[tuple[str, ...], list[int]] = {}
    for row in range(len(radius)):
        groups.setdefault(tuple(f"{column[row]:.9g}" for column in settings), []).append(row)
    pairs = []
    for rows in groups.values():
        for name, values in measured.items():
            low, high = (rows[int(pick)] for pick in (values[rows].argmin(), values[rows].argmax()))
            mean = 0.5 * (values[low] + values[high])
            if values[high] - values[low] > CONTRADICTING * mean:
                pairs.append(
                    Text(
                        "{} and {} ({} {:g} and {:g} mm)",
                        row_name("", low, lines).strip(),
                        row_name("", high, lines).strip(),
                        Word("width" if name == "width" else "height"),
                        values[low],
                        values[high],
                    )
                )
    return tuple(pairs)


def _besides(contradictions: Sequence[str]) -> str:
    """Format contradictory rows as the second fault of a rejected table."""
    if not contradictions:
        return ""
    return Text(
        "; and rows with the same settings have different results: {}; measure these beads again",
        Text.joined(", ", contradictions),
    )


def _ends(values: Array) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def row_name(label: str, row: int, lines: Sequence[int] = ()) -> str:
    """Return the name of a table row in messages.

    Parameters
    ----------
    label : str
        Name of the table.
    row : int
        Index of the row, from 0.
    lines : sequence of int, optional
        Line of each row in the file; empty if unknown.

    Returns
    -------
    str
        The name, counted from 1.
    """
    return Text(
        "{} row {}{}", label, row + 1, Word(Text(" (line {})", lines[row]) if len(lines) else "")
    )


def _alike(radius: Array, speed: Array, equivalent: Array) -> str:
    """Explain why the speeds and radii of a table do not determine the coefficients, and what to measure."""
    straight = np.isinf(radius).all()
    same = [
        Text("all beads have the {} {:.9g} {}", name, column[0], unit)
        for name, column, unit in (
            ("radius", radius, "mm"),
            ("travel speed", MINUTE * speed, "mm/min"),
        )
        if not np.isinf(column).any() and np.ptp(column) <= FLATTEST * column.max()
    ]
    if not same and np.ptp(equivalent) <= FLATTEST * equivalent.max():
        return Text(
            "all beads have the same wire length per millimetre; measure at least two speeds at "
            "one wire feed"
        )
    text = Text.joined(", and ", same) if same else Text("speeds and radii vary only together")
    return Text(
        "{}; measure at least two speeds{}", text, Word("" if straight else " and two radii")
    )


def _fit(terms: Array, values: Array) -> Fit:
    coefficients = np.linalg.lstsq(terms, values, rcond=None)[0]
    residual = float(((values - terms @ coefficients) ** 2).sum())
    spread = float(((values - values.mean()) ** 2).sum())
    bend = float(coefficients[1]) if len(coefficients) == 3 else 0.0
    return Fit(
        float(coefficients[0]),
        bend,
        float(coefficients[-1]),
        1.0 - residual / spread if spread > 0.0 else 1.0,
        float(np.sqrt(residual / (len(values) - len(coefficients)))),
    )


# ---- Travel speeds against the range of the material

CODE = "MATERIAL_SPEED"
ROUNDING = 1e-6  # relative rounding error of a speed


def check_speeds(toolpath: Toolpath, process: ProcessParameters) -> Toolpath:
    """Return the toolpath with a warning if travel speeds are outside the material's range.

    The warning is at the bead with the largest relative deviation.

    Raises InputError BAD_VALUE if the slowest speed is above the fastest.
    """
    slowest, fastest = process.material.slowest or 0.0, process.material.fastest
    if fastest is not None and slowest > fastest:
        raise InputError(
            "BAD_VALUE",
            "process.material.slowest",
            "{:g} mm/s is above the fastest speed, {:g} mm/s; give a slower speed",
            slowest,
            fastest,
        )
    if not slowest and fastest is None:
        return toolpath
    worst, where, speed_range = 1.0 + ROUNDING, (0, 0), [float("inf"), 0.0]
    for layer, number, bead in toolpath:
        ends = bead.ends
        at_ends = [speed for speed in (ends.start_speed, ends.end_speed) if speed] if ends else []
        low = float(min(bead.speed[1:].min(), *at_ends, np.inf))
        high = float(max(bead.speed[1:].max(), *at_ends, 0.0))
        speed_range = [min(speed_range[0], low), max(speed_range[1], high)]
        off = max(slowest / low, 0.0 if fastest is None else high / fastest)
        if off > worst:
            worst, where = off, (layer, number)
    if worst <= 1.0 + ROUNDING:
        return toolpath
    bounds = (
        Text("at {:.4g} mm/s or more", slowest)
        if fastest is None
        else Text("at {:.4g} to {:.4g} mm/s", slowest, fastest)
    )
    return replace(
        toolpath,
        issues=(
            *toolpath.issues,
            Issue(
                WARNING,
                CODE,
                Text(
                    "the travel speed of beads is {:.4g} to {:.4g} mm/s, but {} {}; change "
                    "process.travel_speed, process.bead_width or process.classes, or measure "
                    "beads at these speeds",
                    speed_range[0],
                    speed_range[1],
                    process.material.name or "the material",
                    Word(bounds),
                ),
                *where,
            ),
        ),
    )
