# SPDX-License-Identifier: LGPL-2.1-or-later
"""Report data of one feature. This module imports no drawing code, for jobs without a page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.types import Array

if TYPE_CHECKING:  # slow to import and not needed by other families
    from freecad_am.core.strategies.walls.comparison import Compared, Refused
    from freecad_am.core.toolpath import Toolpath


class OfFeature(NamedTuple):
    """Data of a feature.

    name: empty if the job has one feature. spacing: distances (points,) from each layer to the
    surface below, mm. band: tolerance of the distances as a fraction of the layer height. compared,
    rows: spacing comparison of a wall.
    """

    name: str
    toolpath: Toolpath
    spacing: Sequence[Array]
    band: float | None = None
    compared: Sequence[Compared | Refused] = ()
    rows: Sequence[dict[str, Any]] = ()
