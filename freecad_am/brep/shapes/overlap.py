# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much two shapes have in common."""

from __future__ import annotations

from typing import Any


def common_volume(one: Any, other: Any) -> float:
    """mm3 that the solids of two Part.Shapes have in common, 0 where they only touch, or one of them has no solid."""
    if not one.Solids or not other.Solids or not one.BoundBox.intersect(other.BoundBox):
        return 0.0
    found = 0.0
    for first in one.Solids:
        for second in other.Solids:
            if first.BoundBox.intersect(second.BoundBox):
                found += sum(abs(solid.Volume) for solid in first.common(second).Solids)
    return found


def volume(shape: Any) -> float:
    """mm3 of the solids of a Part.Shape."""
    return sum(abs(solid.Volume) for solid in shape.Solids)


def touching(one: Any, other: Any, tolerance: float) -> bool:
    """Whether two Part.Shapes come within a tolerance, mm, of one another."""
    near = one.BoundBox
    near.enlarge(tolerance)
    return bool(near.intersect(other.BoundBox) and one.distToShape(other)[0] <= tolerance)
