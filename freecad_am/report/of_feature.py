# SPDX-License-Identifier: LGPL-2.1-or-later
"""What the report shows of one feature, apart from what draws it: jobs without a page need none of that."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core.types import Array

if TYPE_CHECKING:  # slow to import, and a job of other families never needs it
    from freecad_am.core.strategies.walls.comparison import Compared, Refused
    from freecad_am.core.toolpath import Toolpath


class OfFeature(NamedTuple):
    """What is shown of each feature. name: empty of a single one. spacing: (points,) mm from each of its layers to what lies
    below it; band: share of the layer height by which that may differ. compared, rows: how else its wall may be cut."""

    name: str
    toolpath: Toolpath
    spacing: Sequence[Array]
    band: float | None = None
    compared: Sequence[Compared | Refused] = ()
    rows: Sequence[dict[str, Any]] = ()
