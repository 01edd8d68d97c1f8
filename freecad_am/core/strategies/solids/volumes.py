# SPDX-License-Identifier: LGPL-2.1-or-later
"""Printed, missed, stray and over-deposited volume of solids."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...filling.cover import Cover, total
from ...geometry.on_hub import SolidsOnHub
from ...layers.planes.slabs import group_of, slabs
from ...parameters.filled import FilledParameters
from ...types import Array
from .beads import MadeBead

EXACT = 3e-3  # of the volume of a part; solids that share more overlap


def layer_volumes(
    strategy: FilledParameters, covers: Sequence[Cover]
) -> tuple[float, float, float]:
    """mm3 of the layers, of their missed volume, and of stray deposit."""
    total_, missed, outside, _ = (strategy.layer_height * area for area in total(covers))
    return total_, missed, outside


def volumes(
    part_volume: float | None,
    strategy: FilledParameters,
    covers: Sequence[Cover],
    uncut: float = 0.0,
    within: Array | None = None,
    numbers: Sequence[int] = (),
) -> tuple[float, float, float]:
    """mm3 of the part, of its missed volume, and of stray deposit.

    The cut solids count as high as their layers, so that the volume above the last cut is missed, and layers beyond the part are
    stray.

    Parameters
    ----------
    part_volume
        mm3; None, with a margin or an open part, for a part as large as its layers.
    uncut
        mm3 of solids without a layer cut, which are missed, whatever layers of others reach beyond them.
    within
        (k,) mm3 of the part within each layer, so that missed volume of one layer is not balanced by stray deposit of another.
        None: only the sum over the layers is compared.
    numbers
        Layer numbers of the covers.
    """
    layer_volume, missed, outside = layer_volumes(strategy, covers)
    if part_volume is None:
        return layer_volume, missed, outside
    if within is not None and abs(float(within.sum()) - part_volume) <= EXACT * part_volume:
        areas = np.bincount(
            np.asarray(numbers, dtype=np.intp),
            [cover.area for cover in covers],
            minlength=len(within),
        )
        within = np.r_[within, np.zeros(len(areas) - len(within))]
        lacking = within - strategy.layer_height * areas
        return (
            part_volume,
            missed + float(np.maximum(lacking, 0.0).sum()),
            outside + float(np.maximum(-lacking, 0.0).sum()),
        )
    uncut = min(uncut, part_volume)
    cut = part_volume - uncut
    return (
        part_volume,
        missed + uncut + max(cut - layer_volume, 0.0),
        outside + max(layer_volume - cut, 0.0),
    )


def slab_volumes(solids: SolidsOnHub, strategy: FilledParameters) -> Array | None:
    """mm3 (k,) that solids in plane layers have between the planes of each; None for other layers."""
    group = group_of(solids)
    if group is None or getattr(strategy, "layers", "planes") != "planes":
        return None  # curved layers may begin on a plane too
    return slabs(group, strategy.layer_height, np.zeros((0, 3)), np.zeros(0)).part_volume


def twice_volume(
    made_beads: Sequence[MadeBead],
    strategy: FilledParameters,
    covers: Sequence[Cover],
    width: float,
) -> float:
    """mm3 of beads that count as `width` mm wide, each as wide as its spacing, beyond the area they cover."""
    area = 0.0
    for bead in (made_bead.bead for made_bead in made_beads):
        step = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        wide = np.full(len(bead), width) if bead.width is None else bead.width
        high = np.ones(len(bead)) if bead.height is None else bead.height / strategy.layer_height
        section = wide * high * strategy.bead_spacing / width
        area += float((0.5 * (section[1:] + section[:-1])) @ step)
    return max(total(covers).over(area), 0.0) * strategy.layer_height
