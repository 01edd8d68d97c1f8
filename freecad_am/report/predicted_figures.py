# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a report says of the deposit that is predicted, against the part."""

from __future__ import annotations

from typing import Any

import numpy as np

from freecad_am.core.geometry.fitted import PredictedShape
from freecad_am.core.geometry.formatting import place

from .tables import pairs_of

MM3 = 1000.0  # in a cm3


def as_dict(found: PredictedShape) -> dict[str, Any]:
    """The key `predicted_shape` of a report. Of `layers` those that have beads."""
    return {
        "fed_cm3": found.fed / MM3, "laid_cm3": found.laid / MM3, "cube_mm": found.edge, "allowance_mm": found.allowance,
        "places": found.places, "reach_mm": found.reach,
        "beyond_mm": {"min": found.least, "mean": found.mean, "max": found.most},
        "short": found.short, "outside": found.outside, "bare": found.bare,
        "worst": {
            "place": found.worst.tolist(), "layer": found.layer, "bead": found.bead, "point": found.point,
        },
        "layers": [
            {"layer": int(layer), "drift_mm": float(found.drift[layer])}
            for layer in np.flatnonzero(np.isfinite(found.drift))
        ],
    }


def section(found: PredictedShape) -> str:
    """The section of the page."""
    known = found.drift[np.isfinite(found.drift)]
    return pairs_of("Predicted deposit against the part", {
        "Fed by the wire": f"{found.fed / MM3:.4g} cm3",
        "Predicted deposit": f"{found.laid / MM3:.4g} cm3 in cubes of {found.edge:.3g} mm",
        "Allowance asked for": f"{found.allowance:g} mm",
        "Deposit beyond the faces, least": f"{found.least:.3g} mm at {place(found.worst)}, layer {found.layer}",
        "mean and largest": f"{found.mean:.3g} mm, {found.most:.3g} mm",
        "Faces with less than the allowance": f"{100.0 * found.short:.3g} % of {found.places} places",
        "Faces that stick out": f"{100.0 * found.outside:.3g} %",
        "Layers end off where the next begins": f"{known.min(initial=0.0):.3g} to {known.max(initial=0.0):.3g} mm",
    })
