# SPDX-License-Identifier: LGPL-2.1-or-later
"""Charts of a predicted deposit against the part: maps from the front and from behind, coloured by
the deviation from the faces, its distribution, and its values by layer."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..core.geometry.toolpath_records import DeviationMap
from ..core.inspection.bands import band_of, bands, css, step_of
from ..core.process.shape.compare import name_of
from ..core.types import Array
from .chart import DOTS, LAYER_NUMBER, MARKED, Bars, Chart, Curve, Quantity

TILT = math.radians(30.0)  # from above, as in the other views
FACING = 0.05  # cosine to the eye of faces that are seen


@dataclass(frozen=True)
class _View:
    """A view: its title, its horizontal direction, and the direction to the eye."""

    title: str
    across: tuple[float, float, float]
    eye: tuple[float, float, float]

    @property
    def up(self) -> Array:
        """The vertical direction."""
        return np.cross(self.eye, self.across)


_VIEWS = (
    _View("Seen from the front", (1.0, 0.0, 0.0), (0.0, -math.cos(TILT), math.sin(TILT))),
    _View("Seen from behind", (-1.0, 0.0, 0.0), (0.0, math.cos(TILT), math.sin(TILT))),
    _View("Seen from below", (1.0, 0.0, 0.0), (0.0, 0.0, -1.0)),
)
X, UP = Quantity("across", "mm"), Quantity("upwards in the view", "mm")


def charts(deviations: DeviationMap, allowance: float) -> tuple[Chart, ...]:
    """The part from the sides on which places face the eye, the spread of deviations, and the layers."""
    maps = [chart for view in _VIEWS if (chart := _map(deviations, view)) is not None]
    return (*maps, _histogram(deviations, allowance), *_layers(deviations, allowance))


def dots_by_band(x: Array, y: Array, deviation: Array, step: float) -> tuple[Curve, ...]:
    """Return dots coloured by the band of their deviation, the lowest band last.

    Parameters
    ----------
    x, y : (n,) array
        Places in the picture, mm.
    deviation : (n,) array
        Their deviations, mm.
    step : float
        Width of a band, mm.

    Returns
    -------
    tuple of Curve
        A curve per band that has dots.
    """
    number = band_of(deviation, step)
    return tuple(
        Curve(band.text, x[number == k], y[number == k], css(band.colour), DOTS)
        for k, band in reversed(list(enumerate(bands(step))))
        if (number == k).any()
    )


def _map(deviations: DeviationMap, view: _View) -> Chart | None:
    """Draw the places that face the eye, the lowest deviation last; the view from below shows the
    places of no other view."""
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
