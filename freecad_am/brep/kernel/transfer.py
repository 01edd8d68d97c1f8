# SPDX-License-Identifier: LGPL-2.1-or-later
"""Values with shapes and meshes, on their way between two processes.

Shapes travel as files in FreeCAD's lossless binary forms, all other values as a pickle.
"""

from __future__ import annotations

import io
import os
import pickle
from typing import Any

import FreeCAD  # noqa: F401  before Part, which crashes the process without
import Mesh
import Part


class InexactShape(Exception):
    """A shape differs from its binary form; for example IGES may give a zero the other sign."""


def dump_value(value: Any, folder: str, exact: bool = False) -> bytes:
    """Return the pickle of a value, with its shapes and meshes as files in `folder`.

    Raises InexactShape if a shape must be `exact` and its file is not.
    """
    stream = io.BytesIO()
    _Pickler(stream, folder, exact).dump(value)
    return stream.getvalue()


def load_value(data: bytes, folder: str) -> Any:
    """Return the value that `dump_value` wrote."""
    return _Unpickler(io.BytesIO(data), folder).load()


class _Pickler(pickle.Pickler):
    def __init__(self, stream: Any, folder: str, exact: bool) -> None:
        super().__init__(stream, protocol=pickle.HIGHEST_PROTOCOL)
        self._folder, self._exact, self._count = folder, exact, 0

    def persistent_id(self, value: Any) -> tuple[str, str] | None:
        if not isinstance(value, (Part.Shape, Mesh.Mesh)):
            return None
        self._count += 1
        name = f"{os.getpid()}-{self._count}"
        path = os.path.join(self._folder, name)
        if isinstance(value, Mesh.Mesh):
            value.write(path, "BMS")
            return "mesh", name
        value.exportBinary(path)
        if self._exact and _read_shape(path).exportBrepToString() != value.exportBrepToString():
            raise InexactShape
        return "shape", name


class _Unpickler(pickle.Unpickler):
    def __init__(self, stream: Any, folder: str) -> None:
        super().__init__(stream)
        self._folder = folder

    def persistent_load(self, kind_and_name: tuple[str, str]) -> Any:
        kind, name = kind_and_name
        path = os.path.join(self._folder, name)
        if kind == "shape":
            return _read_shape(path)
        mesh = Mesh.Mesh()
        with open(path, "rb") as stream:
            mesh.read(stream, "BMS")
        return mesh


def _read_shape(path: str) -> Any:
    shape = Part.Shape()
    shape.importBinary(path)
    return shape
