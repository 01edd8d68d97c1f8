# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report section on the predicted deposit compared with the part."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.geometry.formatting import place
from ..core.geometry.toolpath_records import DeviationMap, PredictedShape
from ..core.inspection.bands import step_of
from ..core.process.shape.compare import name_of
from . import units
from .places import place_of
from .scan_figures import key_of
from .tables import grid_of, pairs_of
from .viewer_3d.columns import Shown

MM3 = 1000.0  # mm3 per cm3


def as_dict(shape: PredictedShape) -> dict[str, Any]:
    """Return the report key `predicted_shape`; `layers` lists only layers with beads."""
    return {
        "fed_cm3": shape.fed / MM3,
        "laid_cm3": shape.laid / MM3,
        "cube_mm": shape.edge,
        "allowance_mm": shape.allowance,
        "places": shape.places,
        "reach_mm": shape.reach,
        "beyond_mm": {"min": shape.least, "mean": shape.mean, "max": shape.most},
        "short": shape.short,
        "outside": shape.outside,
        "bare": shape.bare,
        "worst": {
            "place": shape.worst.tolist(),
            "layer": shape.layer,
            "bead": shape.bead,
            "point": shape.point,
        },
        "layers": [_layer(shape, int(layer)) for layer in np.flatnonzero(np.isfinite(shape.drift))],
        **({} if shape.deviation is None else _deviation(shape.deviation)),
    }


def _layer(shape: PredictedShape, layer: int) -> dict[str, Any]:
    """Return a row of `layers`.

    Minimum and mean deviation refer to the points nearest to the layer, None without points.
    """
    row: dict[str, Any] = {"layer": layer, "drift_mm": float(shape.drift[layer])}
    if shape.deviation is not None:
        smallest, mean = (
            None if np.isnan(value) else float(value) for value in shape.deviation.layers[layer]
        )
        row["beyond_mm"] = {"min": smallest, "mean": mean}
    return row


def _deviation(deviation: DeviationMap) -> dict[str, Any]:
    """Return the worst points by name, and the distribution of deviations over the area."""
    return {
        "worst_places": [
            {
                "name": name_of(k),
                "place": deviation.places[k].tolist(),
                "beyond_mm": float(deviation.beyond[k]),
                "layer": int(layer),
                "bead": int(bead),
                "point": int(point),
            }
            for k, (layer, bead, point) in enumerate(deviation.worst)
        ],
        "spread": {"edges_mm": deviation.edges.tolist(), "area_share": deviation.shares.tolist()},
    }


def section(shape: PredictedShape, pictures: Sequence[str], path_rows: Shown) -> str:
    """Return the page section with maps and charts."""
    drifts = shape.drift[np.isfinite(shape.drift)]
    figures = pairs_of(
        "Predicted deposit against the part",
        {
            "Fed by the wire": f"{shape.fed / MM3:.4g} cm3",
            "Predicted deposit": f"{shape.laid / MM3:.4g} cm3 in cubes of {shape.edge:.3g} mm",
            "Requested allowance": f"{shape.allowance:g} mm",
            "Deposit beyond the faces, least": f"{shape.least:.3g} mm at {place(shape.worst)}, layer {shape.layer}",
            "mean and largest": f"{shape.mean:.3g} mm, {shape.most:.3g} mm",
            "Faces with less than the allowance": f"{100.0 * shape.short:.3g} % of {shape.places} places",
            "Faces beyond the deposit": f"{100.0 * shape.outside:.3g} %",
            "Height error at the end of the layers": f"{drifts.min(initial=0.0):.3g} to {drifts.max(initial=0.0):.3g} mm",
        },
    )
    if shape.deviation is None:
        return figures
    key = (
        f'<p class="sub">Deposit beyond the faces, {_unit(shape)[1]}: '
        f"{key_of(_unit(shape)[0] * step_of(shape.deviation.beyond))}</p>"
        if pictures
        else ""
    )
    return figures + grid_of(pictures) + key + _worst(shape.deviation, path_rows)


def _unit(shape: PredictedShape) -> tuple[float, str]:
    """Return the conversion factor and the unit of deviations."""
    return units.scale(max(abs(shape.least), abs(shape.most)), "mm")


def _worst(deviation: DeviationMap, path_rows: Shown) -> str:
    """Return the table of the worst points, named as in the maps.

    A click shows the nearest path point.
    """
    rows = "".join(
        f"<tr><td>{row['name']}</td><td>{units.text(format(row['beyond_mm'], '.3f') + ' mm')}</td>"
        f"<td>{units.text(place(np.array(row['place'])) + ' mm')}</td>"
        f'<td class="place">{place_of(row, path_rows)}</td></tr>'
        for row in _deviation(deviation)["worst_places"]
    )
    head = "".join(
        f"<th>{word}</th>" for word in ("worst places", "beyond the faces", "place", "of the path")
    )
    return f'<div class="table"><table><tr>{head}</tr>{rows}</table></div>'
