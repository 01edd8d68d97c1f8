# SPDX-License-Identifier: LGPL-2.1-or-later
"""Charts of a predicted deposit against the part: from the front and from behind, by colours of what it reaches beyond the
faces, how that is spread, and layer by layer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..core.geometry.fitted import DeviationMap
from ..core.inspection.bands import band_of, bands, css, step_of
from ..core.process.shape.compare import name_of
from ..core.types import Array
from .chart import DOTS, MARKED, Bars, Chart, Curve, Quantity

TILT = math.radians(30.0)  # from above, as the part is looked at
FACING = 0.05  # cosine to the eye of faces that are seen


@dataclass(frozen=True)
class _View:
    """A picture's name, what is across in it, and where the eye is."""

    title: str
    across: tuple[float, float, float]
    eye: tuple[float, float, float]

    @property
    def up(self) -> Array:
        """What is up in it."""
        return np.cross(self.eye, self.across)


_VIEWS = (
    _View("Seen from the front", (1.0, 0.0, 0.0), (0.0, -math.cos(TILT), math.sin(TILT))),
    _View("Seen from behind", (-1.0, 0.0, 0.0), (0.0, math.cos(TILT), math.sin(TILT))),
    _View("Seen from below", (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
)
X = Quantity("across", "mm")


def charts(found: DeviationMap, allowance: float) -> tuple[Chart, ...]:
    """The part from the sides on which places face the eye, the spread of deviations, and the layers."""
    maps = [chart for view in _VIEWS if (chart := _map(found, view)) is not None]
    return (*maps, _spread(found, allowance), *_layers(found, allowance))


def _map(found: DeviationMap, view: _View) -> Chart | None:
    """What faces the eye, the most inside drawn last; of the view from below what no other one shows."""
    seen = found.normals @ np.asarray(view.eye) > FACING
    if view is _VIEWS[-1]:
        for other in _VIEWS[:-1]:
            seen &= found.normals @ np.asarray(other.eye) <= FACING
    if not seen.any():
        return None
    x, y = found.places @ np.asarray(view.across), found.places @ view.up
    number = band_of(found.beyond, step_of(found.beyond))
    dots = [
        Curve(band.text, x[rows], y[rows], css(band.colour), DOTS)
        for k, band in reversed(list(enumerate(bands(step_of(found.beyond)))))
        if (rows := seen & (number == k)).any()
    ]
    names = tuple(
        (float(x[k]), float(y[k]), name_of(k)) for k in range(len(found.worst)) if seen[k]
    )
    return Chart(
        view.title, X, Quantity("up in the picture", "mm"), tuple(dots), plane=True, names=names
    )


def _spread(found: DeviationMap, allowance: float) -> Chart:
    marks = [(allowance, "allowance")] + ([(0.0, "the part")] if allowance else [])
    return Chart(
        "Deposit beyond the faces",
        Quantity("beyond the faces", "mm"),
        Quantity("share of the area", "%"),
        bars=Bars("share", found.edges, 100.0 * found.shares),
        upright=tuple(marks),
    )


def _layers(found: DeviationMap, allowance: float) -> tuple[Chart, ...]:
    known = np.flatnonzero(np.isfinite(found.layers[:, 0]))
    if len(known) < 2:
        return ()
    least, mean = found.layers[known].T
    number = known.astype(np.float64)
    return (
        Chart(
            "Layer by layer",
            Quantity("layer"),
            Quantity("beyond the faces", "mm"),
            (Curve("least", number, least, 1, MARKED), Curve("mean", number, mean, 0, MARKED)),
            marks=((allowance, "allowance"),),
        ),
    )
