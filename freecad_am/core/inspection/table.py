# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results of an inspection as table rows, as in table 2 of Chalvin 2020, and as data for files."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ..issues import Text, Word
from .figures import Round
from .inspect import Inspected


class Row(NamedTuple):
    """A result with name, value and unit ('' for a count).

    short: name in a narrow panel, '' to omit the row there. group: heading of the row in the panel.
    """

    name: str
    value: float
    unit: str
    short: str = ""
    group: str = ""

    @property
    def text(self) -> str:
        """The value as displayed."""
        if self.unit == "":
            return f"{self.value:.0f}"
        return f"{self.value:.1f}" if self.unit == "%" else f"{self.value:.4f}"


def rows(inspected: Inspected) -> tuple[Row, ...]:
    """Return all results.

    Defects are minimum zone widths (ISO 1101), followed by the zone widths about the least-squares centre.
    """
    spread = inspected.spread
    figures_ = [
        Row("Points", spread.count, "", "Points"),
        Row("Mean deviation", spread.mean, "mm", "Mean"),
        Row("Standard deviation", spread.deviation, "mm", "Std. deviation"),
        Row("Root mean square", spread.rms, "mm", "RMS"),
        Row("Largest deviation outside", spread.most, "mm", "Most"),
        Row("Largest deviation inside", spread.least, "mm", "Least"),
        Row("95 % of the absolute deviations within", spread.within_95, "mm", "95 % within"),
        Row("Within tolerance", 100.0 * spread.within, "%", "In tolerance"),
    ]
    if inspected.ball is not None:
        ball = inspected.ball
        figures_ += [
            Row("Spherical defect", ball.zone.zone, "mm", "Sphericity"),
            Row("Spherical defect, least squares", ball.fitted.zone, "mm"),
            Row("Radius of the sphere", ball.fitted.radius, "mm", "Radius"),
        ]
    for circle in inspected.circles:
        at_height, height = Text("at {:g} mm", circle.height), f"{circle.height:g} mm"
        figures_ += [
            Row(
                Text("Circularity defect {}", Word(at_height)),
                circle.zone.zone,
                "mm",
                "Circularity",
                f"At height {height}",
            ),
            Row(
                Text("Circularity defect {}, least squares", Word(at_height)),
                circle.fitted.zone,
                "mm",
            ),
            Row(
                Text("Diameter {}", Word(at_height)),
                2.0 * circle.fitted.radius,
                "mm",
                "Diameter",
                f"At height {height}",
            ),
            Row(
                Text("Eccentricity {}", Word(at_height)),
                circle.eccentricity,
                "mm",
                "Off axis",
                f"At height {height}",
            ),
        ]
    if inspected.thickness is not None:
        wall = inspected.thickness
        figures_ += [
            Row("Mean thickness", wall.mean, "mm", "Thickness"),
            Row("Standard deviation of the thickness", wall.deviation, "mm", "… std. dev."),
            Row("Smallest thickness", wall.least, "mm", "… least"),
            Row("Largest thickness", wall.most, "mm", "… most"),
        ]
    return tuple(figures_)


def as_data(inspected: Inspected) -> dict[str, Any]:
    """Return the results by key, in mm, for a JSON file."""
    spread = inspected.spread
    data: dict[str, Any] = {
        "measured": inspected.file,
        "planned": inspected.against,
        "tolerance_mm": inspected.tolerance,
        "points": len(inspected.points),
        "counted": spread.count,
        "deviation_mm": {
            "mean": spread.mean,
            "sd": spread.deviation,
            "rms": spread.rms,
            "min": spread.least,
            "max": spread.most,
            "p95": spread.within_95,
        },
        "within_tolerance": spread.within,
        "histogram": {"edges_mm": spread.edges.tolist(), "counts": spread.counts.tolist()},
        "motion": inspected.motion.tolist(),
        "free_motions": list(inspected.free),
        "sphericity_mm": None,
        "thickness_mm": None,
        "circles": [
            {
                "height_mm": circle.height,
                "points": circle.count,
                **_round(circle.fitted, circle.zone),
                "eccentricity": circle.eccentricity,
                "diameter": 2.0 * circle.fitted.radius,
            }
            for circle in inspected.circles
        ],
        "issues": [issue.as_dict() for issue in inspected.issues],
    }
    if inspected.ball is not None:
        ball = inspected.ball
        data["sphericity_mm"] = {
            "points": ball.count,
            "planned_radius": ball.planned,
            **_round(ball.fitted, ball.zone),
        }
    if inspected.thickness is not None:
        wall = inspected.thickness
        data["thickness_mm"] = {
            "pairs": wall.count,
            "mean": wall.mean,
            "sd": wall.deviation,
            "min": wall.least,
            "max": wall.most,
        }
    return data


def deviations(inspected: Inspected) -> Iterable[str]:
    """Yield the lines of a CSV file with points in part coordinates and deviations."""
    yield "x_mm,y_mm,z_mm,deviation_mm,counted,fitted\n"
    columns = (inspected.points, inspected.deviation, inspected.counted, inspected.fitted)
    for point, deviation, within, fitted in zip(*columns, strict=True):
        yield (
            "{:.6f},{:.6f},{:.6f},".format(*point)
            + f"{deviation:.6f},{int(within)},{int(fitted)}\n"
        )


def compared(
    inspections: list[Inspected],
) -> list[tuple[str, str, list[float | None], float | None, float | None]]:
    """Compare the results of several inspections.

    Parameters
    ----------
    inspections : list of Inspected
        The inspections.

    Returns
    -------
    list of tuple
        Name, unit, value in each inspection (None if absent), mean and standard deviation (n
        - 1) over the inspections; None for fewer than two values.

    References
    ----------
    Chalvin 2020, table 2: mean and standard deviation for three spheres.
    """
    tables = [{row.name: row for row in rows(table)} for table in inspections]
    names = dict.fromkeys(name for table in tables for name in table)
    compared_rows: list[tuple[str, str, list[float | None], float | None, float | None]] = []
    for name in names:
        values = [table[name].value if name in table else None for table in tables]
        present = [value for value in values if value is not None]
        unit = next(table[name].unit for table in tables if name in table)
        several = len(present) > 1
        compared_rows.append(
            (
                name,
                unit,
                values,
                float(np.mean(present)) if several else None,
                float(np.std(present, ddof=1)) if several else None,
            )
        )
    return compared_rows


def _round(fitted: Round, zone: Round) -> dict[str, Any]:
    return {
        "minimum_zone": zone.zone,
        "least_squares_zone": fitted.zone,
        "radius": fitted.radius,
        "centre": fitted.centre.tolist(),
    }
