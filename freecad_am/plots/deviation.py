# SPDX-License-Identifier: LGPL-2.1-or-later
"""Charts of a predicted deposit against the part.

Maps from several sides coloured by deviation from the faces, the deviation histogram, and the
deviations by layer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..core.geometry.toolpath_records import DeviationMap
from ..core.inspection.bands import band_of, bands, css, step_of
from ..core.process.shape.compare import name_of
from ..core.types import Array
from .chart import DOTS, LAYER_NUMBER, MARKED, Bars, Chart, Curve, Quantity

TILT = math.radians(30.0)  # elevation of the viewing direction, as in the other views
FACING = 0.05  # minimum cosine between normal and viewing direction of visible faces


@dataclass(frozen=True)
class _View:
    """A view. across: horizontal direction of the view. eye: direction towards the viewer."""

    title: str
    across: tuple[float, float, float]
    eye: tuple[float, float, float]

    @property
    def up(self) -> Array:
        """Return the vertical direction of the view."""
        return np.cross(self.eye, self.across)


_VIEWS = (
    _View("Seen from the front", (1.0, 0.0, 0.0), (0.0, -math.cos(TILT), math.sin(TILT))),
    _View("Seen from behind", (-1.0, 0.0, 0.0), (0.0, math.cos(TILT), math.sin(TILT))),
    _View("Seen from below", (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
)
X, UP = Quantity("across", "mm"), Quantity("upwards in the view", "mm")


def charts(deviations: DeviationMap, allowance: float) -> tuple[Chart, ...]:
    """Chart the deviation maps of all views, the deviation histogram, and deviations by layer."""
    maps = [chart for view in _VIEWS if (chart := _map(deviations, view)) is not None]
    return (*maps, _histogram(deviations, allowance), *_layers(deviations, allowance))


def dots_by_band(x: Array, y: Array, deviation: Array, step: float) -> tuple[Curve, ...]:
    """Return dots coloured by deviation band, the lowest band last.

    Parameters
    ----------
    x, y : (n,) array
        Dot positions in the chart, mm.
    deviation : (n,) array
        Deviations of the dots, mm.
    step : float
        Band width, mm.

    Returns
    -------
    tuple of Curve
        One curve per band that contains dots.
    """
    number = band_of(deviation, step)
    return tuple(
        Curve(band.text, x[number == k], y[number == k], css(band.colour), DOTS)
        for k, band in reversed(list(enumerate(bands(step))))
        if (number == k).any()
    )


def _map(deviations: DeviationMap, view: _View) -> Chart | None:
    """Chart the points that face the viewer, the lowest deviations on top.

    The last view shows only points that no other view shows. None if no point faces the viewer.
    """
    facing = deviations.normals @ np.asarray(view.eye) > FACING
    if view is _VIEWS[-1]:
        for earlier in _VIEWS[:-1]:
            facing &= deviations.normals @ np.asarray(earlier.eye) <= FACING
    if not facing.any():
        return None
    x, y = deviations.places @ np.asarray(view.across), deviations.places @ view.up
    step = step_of(deviations.beyond)
    dots = dots_by_band(x[facing], y[facing], deviations.beyond[facing], step)
    names = tuple(
        (float(x[k]), float(y[k]), name_of(k)) for k in range(len(deviations.worst)) if facing[k]
    )
    return Chart(view.title, X, UP, dots, plane=True, names=names)


def _histogram(deviations: DeviationMap, allowance: float) -> Chart:
    marks = [(allowance, "allowance")] + ([(0.0, "the part")] if allowance else [])
    return Chart(
        "Deposit beyond the faces",
        Quantity("beyond the faces", "mm"),
        Quantity("share of the area", "%"),
        bars=Bars("share", deviations.edges, 100.0 * deviations.shares),
        upright=tuple(marks),
    )


def _layers(deviations: DeviationMap, allowance: float) -> tuple[Chart, ...]:
    layers = np.flatnonzero(np.isfinite(deviations.layers[:, 0]))
    if len(layers) < 2:
        return ()
    smallest, mean = deviations.layers[layers].T
    number = layers.astype(np.float64)
    return (
        Chart(
            "Layer by layer",
            LAYER_NUMBER,
            Quantity("beyond the faces", "mm"),
            (Curve("least", number, smallest, 1, MARKED), Curve("mean", number, mean, 0, MARKED)),
            marks=((allowance, "allowance"),),
        ),
    )
