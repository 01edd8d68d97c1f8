# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much of solids their beads lay, leave out, lay beside them, and lay twice."""

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


def of_layers(strategy: FilledParameters, covers: Sequence[Cover]) -> tuple[float, float, float]:
    """mm3 of all layers, of what beads leave of them, and of what of beads lies beside."""
    whole, left, outside, _ = (strategy.layer_height * area for area in total(covers))
    return whole, left, outside


def volumes(
    part: float | None,
    strategy: FilledParameters,
    covers: Sequence[Cover],
    uncut: float = 0.0,
    within: Array | None = None,
    numbers: Sequence[int] = (),
) -> tuple[float, float, float]:
    """mm3 of the part, of what beads leave of it, and of what of them lies beside it; what is cut of it counts as high as
    its layers, so that what is above the last cut is left, and what layers reach beyond it lies beside. uncut: mm3 of solids
    that no layer is cut in, which are left, whatever layers of others reach beyond these. A part of which the volume (mm3)
    is None, as a margin is added to it or it is open, is as large as its layers are.

    within: (k,) mm3 that the part has within each layer, so that what one layer leaves is not made up for by what another
    reaches beyond the part; numbers: of the layers of the covers. None: only the sum of all layers is compared."""
    whole, left, outside = of_layers(strategy, covers)
    if part is None:
        return whole, left, outside
    if within is not None and abs(float(within.sum()) - part) <= EXACT * part:
        areas = np.bincount(
            np.asarray(numbers, dtype=np.intp),
            [cover.area for cover in covers],
            minlength=len(within),
        )
        within = np.r_[within, np.zeros(len(areas) - len(within))]
        lacking = within - strategy.layer_height * areas
        return (
            part,
            left + float(np.maximum(lacking, 0.0).sum()),
            outside + float(np.maximum(-lacking, 0.0).sum()),
        )
    uncut = min(uncut, part)
    cut = part - uncut
    return part, left + uncut + max(cut - whole, 0.0), outside + max(whole - cut, 0.0)


def of_slabs(solids: SolidsOnHub, strategy: FilledParameters) -> Array | None:
    """mm3 (k,) that solids in plane layers have between the planes of each; None for other layers."""
    group = group_of(solids)
    if group is None or getattr(strategy, "layers", "planes") != "planes":
        return None  # curved layers may begin on a plane too
    return slabs(group, strategy.layer_height, np.zeros((0, 3)), np.zeros(0)).part_volume


def twice(
    made: Sequence[MadeBead], strategy: FilledParameters, covers: Sequence[Cover], width: float
) -> float:
    """mm3 of beads that count as `width` mm wide, each as wide as they are apart, beyond what they cover."""
    area = 0.0
    for bead in (one.bead for one in made):
        step = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        wide = np.full(len(bead), width) if bead.width is None else bead.width
        high = np.ones(len(bead)) if bead.height is None else bead.height / strategy.layer_height
        section = wide * high * strategy.bead_spacing / width
        area += float((0.5 * (section[1:] + section[:-1])) @ step)
    return max(total(covers).over(area), 0.0) * strategy.layer_height
