# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers at a constant distance along the lines v = const of the wall (Chalvin 2019, equation 2)."""

from __future__ import annotations

import numpy as np

from ...geometry.walls.surface import Surface, dot
from ...issues import InputError
from ...types import Array
from ..first_layer import ROUNDS, finer_grid
from ..smoothest_heights import refuse_too_many
from .smooth_spacing import WallLayer

STEPS = 40


def next_layer(surface: Surface, below: WallLayer, height: float, label: str = "wall") -> WallLayer:
    """Compute the layer at a constant chord length from the points below with equal v.

    The chord is measured in space.

    Parameters
    ----------
    surface : Surface
        The wall.
    below : WallLayer
        The layer below.
    height : float
        The chord length, mm.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    WallLayer
        The layer.

    Raises
    ------
    InputError
        LAYER_HEIGHT if the wall bends too sharply for such a layer.

    References
    ----------
    Chalvin 2019, equation 2, which is the closed form for a torus.
    """
    v, u, into, out = below.v, below.u, *below.slopes(surface)
    for _ in range(ROUNDS):
        new, slopes = _step(surface, v, u, (into, out), height, label)
        layer = WallLayer.of(surface, v, new, *slopes)
        added = finer_grid(layer.curve)
        if not len(added):
            break
        v = np.sort(np.r_[v, added])
        u, into, out = below.heights(surface, v)
    return layer


def layers(
    surface: Surface, first_layer: WallLayer, height: float, u_end: float, label: str = "wall"
) -> list[WallLayer]:
    """Compute all layers, from the first layer to the first one completely beyond the end.

    Parameters
    ----------
    surface : Surface
        The wall.
    first_layer : WallLayer
        The first layer.
    height : float
        Chord length from layer to layer, mm.
    u_end : float
        End of the wall in u.
    label : str, optional
        Name of the wall, for messages.

    Returns
    -------
    list of WallLayer
        The layers, including `first_layer`.

    Raises
    ------
    InputError
        LAYER_HEIGHT as in `next_layer`, or for too many layers.
    """
    wall_layers = [first_layer]
    while wall_layers[-1].u.min() < u_end:
        refuse_too_many(len(wall_layers), height, label)
        wall_layers.append(next_layer(surface, wall_layers[-1], height, label))
    return wall_layers


def _step(
    surface: Surface, v: Array, u: Array, slopes: tuple[Array, Array], height: float, label: str
) -> tuple[Array, tuple[Array, Array]]:
    """Return the new u (m,) and the slopes du/dv before and after each node.

    Slopes are implicit derivatives of the chord equation.
    """
    base, along, around = surface.derivatives(u, v)
    new = u + height / np.linalg.norm(along, axis=1)
    for _ in range(STEPS):
        point, rise, turn = surface.derivatives(new, v)
        chord = point - base
        rate = 2.0 * dot(chord, rise)
        step = (dot(chord, chord) - height * height) / np.where(rate > 0.0, rate, np.inf)
        new = new - step
        if np.abs(step * np.linalg.norm(rise, axis=1)).max() < 1e-12 * max(1.0, height):
            break
    if not np.allclose(
        np.linalg.norm(surface.point(new, v) - base, axis=1), height, rtol=1e-9, atol=0.0
    ):
        raise InputError(
            "LAYER_HEIGHT",
            label,
            "a layer height of {:g} mm is too large for the bend of the wall; reduce the layer "
            "height",
            height,
        )
    point, rise, turn = surface.derivatives(new, v)
    chord = point - base
    into, out = (
        (dot(chord, around + slope[:, None] * along) - dot(chord, turn)) / dot(chord, rise)
        for slope in slopes
    )
    return new, (into, out)
