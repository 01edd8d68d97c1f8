# SPDX-License-Identifier: LGPL-2.1-or-later
"""How much two shapes have in common."""

from __future__ import annotations

from typing import Any


def common_volume(shape: Any, other_shape: Any) -> float:
    """Volume, mm3, that the solids of two Part.Shapes share; 0 if they only touch, or a shape has
    no solid.
    """
    if (
        not shape.Solids
        or not other_shape.Solids
        or not shape.BoundBox.intersect(other_shape.BoundBox)
    ):
        return 0.0
    volume = 0.0
    for own_solid in shape.Solids:
        for other_solid in other_shape.Solids:
            if own_solid.BoundBox.intersect(other_solid.BoundBox):
                volume += sum(abs(solid.Volume) for solid in own_solid.common(other_solid).Solids)
    return volume


def volume(shape: Any) -> float:
    """mm3 of the solids of a Part.Shape."""
    return sum(abs(solid.Volume) for solid in shape.Solids)


def touching(shape: Any, other_shape: Any, tolerance: float) -> bool:
    """Whether two Part.Shapes come within a tolerance, mm, of one another."""
    box = shape.BoundBox
    box.enlarge(tolerance)
    return bool(
        box.intersect(other_shape.BoundBox) and shape.distToShape(other_shape)[0] <= tolerance
    )
