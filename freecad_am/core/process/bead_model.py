# SPDX-License-Identifier: LGPL-2.1-or-later
"""Width and height of a bead from travel speed and curvature: w = m v^(-1/3) + p / r + t (Dai 2020, section 4).

The model holds the width, not the section: at one wire feed a bead that runs faster in a bend is lower there (ERRATA), so
the height has a fit of its own, of the same form, and is predicted beside the width. Inside the fit the speed is in
mm/min, as in the paper; all arguments are mm and mm/s. The radius has no sign: inside and outside of a bend are not told
apart.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..issues import InputError

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

MINUTE = 60.0
FEWEST = 4  # rows; three coefficients and one that says how well they fit
FLATTEST = 1e-8  # least relative singular value of a table that determines the coefficients


@dataclass(frozen=True)
class Fit:
    """coefficients of v^(-1/3) [mm (mm/min)^(1/3)], 1/r [mm^2] and one [mm]; r_squared; rmse in mm with the degrees of
    freedom left as divisor."""

    m: float
    p: float
    t: float
    r_squared: float
    rmse: float

    def at(self, speed: Array, radius: Array) -> Array:
        """Value (...,) mm at speeds mm/s and radii of curvature mm, infinite where straight."""
        value: Array = self.m * np.cbrt(1.0 / (MINUTE * speed)) + self.p / radius + self.t
        return value


@dataclass(frozen=True)
class Asked:
    """speed (n,) mm/s; too_slow, too_fast, too_tight (n,) where the width asked for, or the radius, is outside the table."""

    speed: Array
    too_slow: Mask
    too_fast: Mask
    too_tight: Mask


@dataclass(frozen=True)
class BeadModel:
    """The fits of width and height, and what they were made from: speeds mm/s, radii mm, wire_feed mm/s."""

    width: Fit
    height: Fit
    speeds: tuple[float, float]
    radii: tuple[float, float]
    wire_feed: float

    def widths(self, speed: Array, radius: Array) -> Array:
        """Width (...,) mm at travel speeds mm/s; radii below the table's count as its least."""
        return self.width.at(speed, np.maximum(radius, self.radii[0]))

    def heights(self, speed: Array, radius: Array) -> Array:
        """Height (...,) mm of the bead, the same way."""
        return self.height.at(speed, np.maximum(radius, self.radii[0]))

    def speed_for(self, width: float, radius: Array) -> Asked:
        """The travel speed that keeps `width` mm at radii of curvature (n,) mm, kept within the speeds of the table."""
        tight = radius < self.radii[0] * (1.0 - 1e-9)
        rest = width - self.width.p / np.maximum(radius, self.radii[0]) - self.width.t
        with np.errstate(divide="ignore", over="ignore"):
            speed = np.where(rest > 0.0, (self.width.m / np.where(rest > 0.0, rest, 1.0)) ** 3, np.inf) / MINUTE
        slowest, fastest = self.speeds
        slack = 1e-9 * fastest
        return Asked(
            np.clip(speed, slowest, fastest), speed < slowest - slack, speed > fastest + slack, np.asarray(tight)
        )


def fit(radius: Array, speed: Array, width: Array, height: Array, wire_feed: float, label: str = "table") -> BeadModel:
    """The model of a calibration table: columns (n,) in mm and mm/s. Least squares, linear in the three coefficients.

    InputError 'TOO_FEW_ROWS', 'BAD_TABLE' (values that are no beads: not positive, not finite), 'COLLINEAR_TABLE' (radii
    or speeds do not vary, or only together) or 'NO_MODEL' (width does not fall with speed).
    """
    columns = {"radius": radius, "travel speed": speed, "width": width, "height": height}
    if len(radius) < FEWEST:
        raise InputError("TOO_FEW_ROWS", label, f"it has {len(radius)} rows; measure at least {FEWEST} beads")
    for name, column in columns.items():
        wrong = np.flatnonzero(~(np.isfinite(column) & (column > 0.0)))
        if len(wrong):
            where = f"{label} row {wrong[0] + 1}"
            raise InputError("BAD_TABLE", where, f"{name} {column[wrong[0]]:g} is not a positive number")
    terms = np.stack([np.cbrt(1.0 / (MINUTE * speed)), 1.0 / radius, np.ones(len(radius))], axis=1)
    scaled = terms / np.linalg.norm(terms, axis=0)
    singular = np.linalg.svd(scaled, compute_uv=False)
    if singular[-1] < FLATTEST * singular[0]:
        raise InputError(
            "COLLINEAR_TABLE", label, "speeds and radii do not vary independently; measure at least two speeds and two radii"
        )
    fits = [_fit(terms, column) for column in (width, height)]
    if fits[0].m <= 0.0:
        raise InputError("NO_MODEL", label, f"beads get wider with speed (m = {fits[0].m:.4g}); check the table's columns")
    return BeadModel(
        fits[0], fits[1], (float(speed.min()), float(speed.max())), (float(radius.min()), float(radius.max())), wire_feed
    )


def _fit(terms: Array, values: Array) -> Fit:
    found = np.linalg.lstsq(terms, values, rcond=None)[0]
    rest = float(((values - terms @ found) ** 2).sum())
    spread = float(((values - values.mean()) ** 2).sum())
    return Fit(
        float(found[0]), float(found[1]), float(found[2]), 1.0 - rest / spread if spread > 0.0 else 1.0,
        float(np.sqrt(rest / (len(values) - 3))),
    )
