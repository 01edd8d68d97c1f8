# SPDX-License-Identifier: LGPL-2.1-or-later
"""Data of one feature for the report, in a module that imports no drawing code, for jobs without a
page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.types import Array

if TYPE_CHECKING:  # slow to import, and a job of other families never needs it
    from freecad_am.core.strategies.walls.comparison import Compared, Refused
    from freecad_am.core.toolpath import Toolpath


class OfFeature(NamedTuple):
    """Data of a feature. name: empty if the job has one feature. spacing: (points,) mm from each
    layer to the surface below; band: its tolerance as a share of the layer height. compared, rows:
    other spacings of its wall."""

    name: str
    toolpath: Toolpath
    spacing: Sequence[Array]
    band: float | None = None
    compared: Sequence[Compared | Refused] = ()
    rows: Sequence[dict[str, Any]] = ()
