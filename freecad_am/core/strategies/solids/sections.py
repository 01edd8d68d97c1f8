# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sections of the part in plane layers, kept in the toolpath to measure how well the beads fill them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...geometry.regions.region import Region
from ...geometry.section import Section
from ...layers.field import Stack
from ...layers.plane_field import Flat
from ...layers.surface import Slice
from ...parameters.filled import FilledParameters
from ...process.order import Course
from ...toolpath import Layer


def section_of(layer: Slice, strategy: FilledParameters) -> Section | None:
    """The section of a part in a layer; None where the layer is curved."""
    surface = layer.surface
    regions = [region for region in layer.regions if isinstance(region, Region)]
    if not isinstance(surface, Flat) or not regions:
        return None
    origin, x, y = layer.base.to_part(
        surface.wrap(np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])).points
    )
    frame = np.eye(4)
    frame[:3] = np.column_stack([x - origin, y - origin, np.cross(x - origin, y - origin), origin])
    is_sparse = strategy.is_sparse and layer.buried != ()
    loops = tuple(border for region in regions for border in region.borders())
    return Section(frame, loops, strategy.bead_spacing, is_sparse)


def add_sections(
    layers: Sequence[Layer], sections: Sequence[tuple[Stack, int, Section]], course: Course
) -> tuple[Layer, ...]:
    """The layers with the sections they fill.

    Parameters
    ----------
    layers : sequence of Layer
        All layers of the toolpath, in the order of the course.
    sections : sequence of (Stack, int, Section)
        A section, its stack, and the number of its layer in this stack.
    course : Course
        Finds the layer of the toolpath; sections of layers it leaves out are dropped.

    Returns
    -------
    tuple of Layer
        Several sections in one layer are joined, and sparse if one of them is. Layers without a section have None.
    """
    by_layer: dict[int, Section] = {}
    for stack, stack_layer, section in sections:
        number = course.number(stack.group, stack.solid, stack_layer)
        if number is None:
            continue
        if (earlier := by_layer.get(number)) is not None:
            section = replace(
                earlier,
                loops=(*earlier.loops, *section.loops),
                is_sparse=earlier.is_sparse or section.is_sparse,
            )
        by_layer[number] = section
    return tuple(
        replace(layer, section=by_layer.get(number)) for number, layer in enumerate(layers)
    )
