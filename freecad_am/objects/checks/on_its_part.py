# SPDX-License-Identifier: LGPL-2.1-or-later
"""Distance of a finished toolpath from the shapes that it was made for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...core.process.deposit import on_part
from ...core.toolpath import Toolpath as CoreToolpath
from ..families.given import Given
from ..families.registry import planner_for
from ..shapes.bodies import Taken
from ..work import progress

LOOKED = 0.95  # of the time, after planning


def check_on_part(toolpath: CoreToolpath, inputs: Given, sources: Sequence[Taken]) -> CoreToolpath:
    """The toolpath with a judgement of its distance from the shapes that it was made for; unchanged
    if these have no faces.
    """
    planner = planner_for(inputs.strategy)
    if not planner.is_on_part(inputs.wall):
        return toolpath
    progress.report(LOOKED, "checking whether the deposit is on the part")
    distances = planner.part_distances(toolpath, inputs, sources, on_part.sample_places(toolpath))
    if distances is None:
        return toolpath
    places, off, limit = distances
    if (
        toolpath.checks.fitted is not None
    ):  # these layers follow the scan and are no farther off than they were moved
        from ...core.inspection.fit_layers import max_moves  # jobs without a scan need none of it

        off = np.maximum(off - max_moves(toolpath.checks.fitted, places.layer), 0.0)
    return on_part.check_on_part(toolpath, places, off, limit)
