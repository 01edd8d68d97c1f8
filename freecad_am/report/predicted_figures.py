# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a report says of the deposit that is predicted, against the part."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..core.geometry.fitted import DeviationMap, PredictedShape
from ..core.geometry.formatting import place
from ..core.inspection.bands import step_of
from ..core.process.shape.compare import name_of
from . import units
from .places import place_of
from .scan_figures import key_of
from .tables import grid_of, pairs_of
from .turned.columns import Shown

MM3 = 1000.0  # in a cm3


def as_dict(found: PredictedShape) -> dict[str, Any]:
    """The key `predicted_shape` of a report. Of `layers` those that have beads."""
    return {
        "fed_cm3": found.fed / MM3,
        "laid_cm3": found.laid / MM3,
        "cube_mm": found.edge,
        "allowance_mm": found.allowance,
        "places": found.places,
        "reach_mm": found.reach,
        "beyond_mm": {"min": found.least, "mean": found.mean, "max": found.most},
        "short": found.short,
        "outside": found.outside,
        "bare": found.bare,
        "worst": {
            "place": found.worst.tolist(),
            "layer": found.layer,
            "bead": found.bead,
            "point": found.point,
        },
        "layers": [_layer(found, int(layer)) for layer in np.flatnonzero(np.isfinite(found.drift))],
        **({} if found.deviation is None else _deviation(found.deviation)),
    }


def _layer(found: PredictedShape, layer: int) -> dict[str, Any]:
    """A row of `layers`; least and mean are those of the places nearest to it, None where there are none."""
    row: dict[str, Any] = {"layer": layer, "drift_mm": float(found.drift[layer])}
    if found.deviation is not None:
        least, mean = (
            None if np.isnan(value) else float(value) for value in found.deviation.layers[layer]
        )
        row["beyond_mm"] = {"min": least, "mean": mean}
    return row


def _deviation(found: DeviationMap) -> dict[str, Any]:
    """The worst places by name, and how deviations are spread over the area."""
    return {
        "worst_places": [
            {
                "name": name_of(k),
                "place": found.places[k].tolist(),
                "beyond_mm": float(found.beyond[k]),
                "layer": int(layer),
                "bead": int(bead),
                "point": int(point),
            }
            for k, (layer, bead, point) in enumerate(found.worst)
        ],
        "spread": {"edges_mm": found.edges.tolist(), "area_share": found.shares.tolist()},
    }


def section(found: PredictedShape, pictures: Sequence[str], shown: Shown) -> str:
    """The section of the page, with the maps and charts that are drawn of it."""
    known = found.drift[np.isfinite(found.drift)]
    figures = pairs_of(
        "Predicted deposit against the part",
        {
            "Fed by the wire": f"{found.fed / MM3:.4g} cm3",
            "Predicted deposit": f"{found.laid / MM3:.4g} cm3 in cubes of {found.edge:.3g} mm",
            "Allowance asked for": f"{found.allowance:g} mm",
            "Deposit beyond the faces, least": f"{found.least:.3g} mm at {place(found.worst)}, layer {found.layer}",
            "mean and largest": f"{found.mean:.3g} mm, {found.most:.3g} mm",
            "Faces with less than the allowance": f"{100.0 * found.short:.3g} % of {found.places} places",
            "Faces that stick out": f"{100.0 * found.outside:.3g} %",
            "Layers end off where the next begins": f"{known.min(initial=0.0):.3g} to {known.max(initial=0.0):.3g} mm",
        },
    )
    if found.deviation is None:
        return figures
    key = (
        f'<p class="sub">Deposit beyond the faces, {_unit(found)[1]}: '
        f"{key_of(_unit(found)[0] * step_of(found.deviation.beyond))}</p>"
        if pictures
        else ""
    )
    return figures + grid_of(pictures) + key + _worst(found.deviation, shown)


def _unit(found: PredictedShape) -> tuple[float, str]:
    """The factor and the unit of deviations."""
    return units.scale(max(abs(found.least), abs(found.most)), "mm")


def _worst(found: DeviationMap, shown: Shown) -> str:
    """The worst places with their names in the maps; a click shows what of the path is nearest."""
    rows = "".join(
        f"<tr><td>{one['name']}</td><td>{units.text(format(one['beyond_mm'], '.3f') + ' mm')}</td>"
        f"<td>{units.text(place(np.array(one['place'])) + ' mm')}</td>"
        f'<td class="place">{place_of(one, shown)}</td></tr>'
        for one in _deviation(found)["worst_places"]
    )
    head = "".join(
        f"<th>{word}</th>" for word in ("worst places", "beyond the faces", "place", "of the path")
    )
    return f'<div class="table"><table><tr>{head}</tr>{rows}</table></div>'
