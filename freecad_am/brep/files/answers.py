# SPDX-License-Identifier: LGPL-2.1-or-later
"""The result of reading a file in another process, handed over in two files: one holds a pickle,
the other a shape or a mesh in FreeCAD's own binary form where that form is exact to the last digit.
"""

from __future__ import annotations

import io
import os
import pickle
from collections.abc import Callable
from typing import Any

import Mesh
import Part

from ...core.issues import InputError

AGAIN = "it is sound: read it again, here"  # IGES may give a zero the other sign in the binary form


class _Inexact(Exception):
    """A shape is not quite the same in the binary form."""


class _Pickler(pickle.Pickler):
    """Writes shapes and meshes to a file of their own."""

    def __init__(self, stream: Any, geometry: str) -> None:
        super().__init__(stream, protocol=pickle.HIGHEST_PROTOCOL)
        self.geometry = geometry

    def persistent_id(self, value: Any) -> str | None:
        if isinstance(value, Part.Shape):
            value.exportBinary(self.geometry)
            again = Part.Shape()
            again.importBinary(self.geometry)
            if again.exportBrepToString() != value.exportBrepToString():
                raise _Inexact
            return "shape"
        if isinstance(value, Mesh.Mesh):
            value.write(self.geometry, "BMS")
            return "mesh"
        return None


class _Unpickler(pickle.Unpickler):
    def __init__(self, stream: Any, geometry: str) -> None:
        super().__init__(stream)
        self.geometry = geometry

    def persistent_load(self, kind: str) -> Any:
        if kind == "shape":
            shape = Part.Shape()
            shape.importBinary(self.geometry)
            return shape
        mesh = Mesh.Mesh()
        with open(self.geometry, "rb") as stream:
            mesh.read(stream, "BMS")
        return mesh


def write_answer(
    answer_file: str,
    geometry: str,
    reader: Callable[..., Any],
    path: str | os.PathLike[str],
    arguments: tuple[Any, ...],
) -> None:
    """In the other process: run `reader` and write its result or InputError into the files."""
    try:
        answer: Any = (True, reader(path, *arguments))
    except InputError as error:
        answer = (False, (error.code, error.where, error.message))
    text = io.BytesIO()
    try:
        _Pickler(text, geometry).dump(answer)
    except _Inexact:
        text = io.BytesIO(pickle.dumps((True, AGAIN)))
    with open(answer_file, "wb") as stream:
        stream.write(text.getbuffer())


def read_answer(answer_file: str, geometry: str) -> Any:
    """Return the result of the other process; raises its InputError."""
    with open(answer_file, "rb") as stream:
        sound, answer = _Unpickler(stream, geometry).load()
    if sound:
        return answer
    raise InputError(*answer)
