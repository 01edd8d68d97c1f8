# SPDX-License-Identifier: LGPL-2.1-or-later
"""The default chord error of features, by the size of their deposit."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import Part

from ...brep.files.read import MAX_COORDINATE_MM
from ...brep.kernel import limits as kernel
from ...core.issues import NOTE, AmError, Issue, Text
from ...core.parameters.chord_error import (
    BEAD_TO_LAYER,
    LEAST,
    SMALL,
    DefaultLength,
    scaled,
)
from .bodies import global_shape
from .meshes import is_mesh, mesh_of

CODE = "CHORD_ERROR"
KEY, PROPERTY = "chord_error", "ChordError"


def fill_in(obj: Any, parameters: Sequence[Any], values: Mapping[str, Any]) -> None:
    """Set the chord error of a new feature by its size, unless `parameters` or `values` give one."""
    if PROPERTY in obj.PropertiesList and not _is_given(parameters, values):
        chord_error = suited(obj)
        if chord_error > LEAST:
            setattr(obj, PROPERTY, f"{chord_error!r} mm")


def suited(obj: Any) -> float:
    """The chord error, mm, that suits the size and the beads of a feature."""
    bead = getattr(obj, "BeadSpacing", None)
    width = BEAD_TO_LAYER * float(obj.LayerHeight) if bead is None else float(bead)
    return scaled(extent(obj), width)


def extent(obj: Any) -> float:
    """The largest extent, mm, of a feature's deposit along a coordinate axis; 0 if unknown."""
    sizes = [0.0]
    # the feature reports names that its source lacks, for which FreeCAD raises ValueError
    with contextlib.suppress(AmError, ValueError, *kernel.FAULTS):
        for box in _boxes(obj):
            sizes += [box.XLength, box.YLength, box.ZLength] if box.isValid() else []
    return max(sizes)


def notes(obj: Any) -> tuple[Issue, ...]:
    """A note if the chord error of a feature follows from its size and is not the one of small
    parts.
    """
    chord_error = float(getattr(obj, PROPERTY, LEAST))
    if chord_error <= LEAST or chord_error != suited(obj):
        return ()
    text = Text(
        "the chord error is {:g} mm, suitable for a part of {:.0f} mm and its beads; set "
        "strategy.chord_error to change it",
        chord_error,
        extent(obj),
    )
    return (Issue(NOTE, CODE, text),)


def _is_given(parameters: Sequence[Any], values: Mapping[str, Any]) -> bool:
    chord_errors = [getattr(entry, KEY) for entry in parameters if hasattr(entry, KEY)]
    return KEY in values or any(not isinstance(value, DefaultLength) for value in chord_errors)


def _boxes(obj: Any) -> Iterator[Any]:
    """The boxes around the objects, or the faces, that a feature deposits."""
    source, names = (obj.Source[0], obj.Source[1]) if obj.Source else (None, ())
    for deposit_source in (source, *getattr(obj, "Further", ())):
        if deposit_source is None:
            continue
        if is_mesh(deposit_source):
            yield (
                deposit_source.Mesh.BoundBox
                if "Mesh" in deposit_source.PropertiesList
                else mesh_of(deposit_source)[0].BoundBox
            )
            continue
        shape = global_shape(deposit_source)
        elements = []
        with contextlib.suppress(
            IndexError, ValueError, Part.OCCError
        ):  # reported when it is planned
            elements = (
                [shape.getElement(name) for name in names if name]
                if deposit_source is source
                else []
            )
        for element in elements or _bounded_parts(shape):
            yield _box(element)


def _bounded_parts(shape: Any) -> list[Any]:
    """The shape, or its solids if it reaches to infinity, as a container with a datum plane does."""
    if _extent(shape.BoundBox) <= MAX_COORDINATE_MM:
        return [shape]
    return [solid for solid in shape.Solids if _extent(solid.BoundBox) <= MAX_COORDINATE_MM]


def _extent(box: Any) -> float:
    return max(box.XLength, box.YLength, box.ZLength) if box.isValid() else 0.0


def _box(shape: Any) -> Any:
    """The box around a shape. A quick box is never too small but depends on triangles that the
    shape may have, so it only decides about small shapes.
    """
    box = shape.BoundBox
    if _extent(box) > SMALL:
        return shape.copy(True, False).optimalBoundingBox()  # without its triangles
    return box
