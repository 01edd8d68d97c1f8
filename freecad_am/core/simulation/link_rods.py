# SPDX-License-Identifier: LGPL-2.1-or-later
"""The links of a robot as rods, by what is drawn of them: its plain solids, or the shapes a user attached."""

from __future__ import annotations

from collections.abc import Sequence

from ..geometry.rods import Rod, about, needed
from .solids import Solid


def of_solids(link: Sequence[Solid]) -> list[Rod]:
    """The rods that hold the solids of a link, in the same frame."""
    points = [solid.points for solid in link]
    return needed([about(each) for each in points], points)
