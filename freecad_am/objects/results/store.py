# SPDX-License-Identifier: LGPL-2.1-or-later
"""Store results of the core in a document: one list of floats and one text.

Results consist of dataclasses, tuples, dicts, arrays, bytes and plain values. The text is a JSON
tree, which names a dataclass by its schema (`schemas`) and refers to an array by rows of a table.
Tables and bytes are members of an npz archive, compressed by zlib. The archive is stored in a
FloatList, seven bytes per float. FreeCAD saves such a property as a binary file, and the property
follows undo and object copies by value. An included file does neither.

Arrays at the same path of similar values, such as bead points, share a table, so that an archive of
thousands of beads has few members.
"""

from __future__ import annotations

import array
import dataclasses
import functools
import io
import json
import zipfile
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ...core.issues import InputError
from ...core.types import Array, NDArray
from . import schemas

FORMAT = 5  # version of text and archive
COMPRESSION_LEVEL = 1  # zlib level; higher levels triple the time and save a tenth of the size
BYTES_PREFIX = "bytes-"  # name prefix of archive members for bytes values
BYTES_PER_FLOAT = 7
HIGHEST_BYTE = 0x40  # most significant byte, which makes any seven bytes a normal float
DTYPES = (np.dtype("float64"), np.dtype("int64"), np.dtype("bool"))
Place = tuple[str | int, ...]


def pack(value: Any, key: str) -> tuple[list[float], str]:
    """Convert a value to floats and text.

    Parameters
    ----------
    value
        Dataclasses with a schema, tuples, lists, dicts, arrays, bytes and plain values.
    key
        Fingerprint of the value's inputs, with which floats and text are marked.

    Raises
    ------
    TypeError
        If the value contains an unsupported type.
    """
    packer = _Packer()
    tree = packer.tree(value, ())
    data = packer.archive()
    header = {
        "format": FORMAT,
        "schemas": packer.versions,
        "bytes": len(data),
        "value": tree,
    }
    floats = np.concatenate([[_mark(key)], _floats_of(data)])
    return floats.tolist(), f"{key} {json.dumps(header, separators=(',', ':'))}"


def numbers_of(floats: list[float]) -> Array:
    """Return the floats of a document as an array (n,)."""
    return np.frombuffer(array.array("d", floats))


def unpack(floats: Sequence[float] | Array, text: str, key: str, where: str) -> Any:
    """Return the value that was given to `pack`.

    Raises
    ------
    InputError
        BAD_RESULT at `where` if the data is damaged, has another key, or is of a later version.
        During undo, floats, text and key are restored one by one and temporarily do not match.
    """
    return unpack_parts(floats, text, key, where, ())[0]


def unpack_parts(
    floats: Sequence[float] | Array, text: str, key: str, where: str, *paths: Place
) -> tuple[Any, ...]:
    """Return parts of the value that was given to `pack`, reading only their arrays.

    Parameters
    ----------
    places
        Field names and indices that lead to each part; () for the complete value.

    Raises
    ------
    InputError
        As in `unpack`.
    """
    try:
        if not text.startswith(f"{key} ") or not len(floats) or floats[0] != _mark(key):
            raise ValueError("the result belongs to other inputs")
        header, numbers = json.loads(text[len(key) :]), np.asarray(floats)
        if not (isinstance(header, dict) and header.get("format")):
            from . import earlier_formats

            return earlier_formats.pick_parts(header, numbers, paths)
        if header["format"] != FORMAT:
            raise ValueError(f"format {header['format']} is of a later version")
        with zipfile.ZipFile(io.BytesIO(_bytes_of(numbers[1:], header["bytes"]))) as archive:
            reader = _Reader(archive, header["schemas"])
            return tuple(reader.value(_subtree(header["value"], path)) for path in paths)
    except (
        KeyError,
        ValueError,
        TypeError,
        AttributeError,
        ImportError,
        IndexError,
        EOFError,
        MemoryError,
        OSError,
        zlib.error,
        zipfile.BadZipFile,
    ) as error:
        raise InputError(
            "BAD_RESULT",
            where,
            "the stored result cannot be read ({}); recompute the object",
            error,
        ) from None


def _subtree(tree: Any, path: Place) -> Any:
    """Return the node of a tree at a path."""
    for step in path:
        tree = tree["tuple"][step] if isinstance(step, int) else tree["fields"][step]
    return tree


def _mark(key: str) -> float:
    return float(zlib.crc32(key.encode()))


def _floats_of(data: bytes) -> Array:
    """Convert bytes to floats (n,), seven bytes per float."""
    padded = np.zeros(-(-len(data) // BYTES_PER_FLOAT) * BYTES_PER_FLOAT, dtype=np.uint8)
    padded[: len(data)] = np.frombuffer(data, dtype=np.uint8)
    words = np.full((len(padded) // BYTES_PER_FLOAT, 8), HIGHEST_BYTE, dtype=np.uint8)
    words[:, :BYTES_PER_FLOAT] = padded.reshape(-1, BYTES_PER_FLOAT)
    return words.view("<f8").ravel().astype(np.float64, copy=False)


def _bytes_of(floats: Array, length: int) -> bytes:
    """Convert floats from `_floats_of` back to bytes."""
    words = np.ascontiguousarray(floats, dtype="<f8").view(np.uint8).reshape(-1, 8)
    data = np.ascontiguousarray(words[:, :BYTES_PER_FLOAT]).ravel()[:length].tobytes()
    if len(data) != length:
        raise ValueError("the data are cut short")
    return data


class _Packer:
    """Convert a value to a tree, and collect its arrays in tables and its bytes."""

    def __init__(self) -> None:
        self.numbers: dict[Any, int] = {}  # table index for each kind of array
        self.tables: list[list[NDArray[Any]]] = []
        self.rows: list[int] = []  # number of rows of each table
        self.data: list[bytes | bytearray] = []
        self.versions: dict[str, int] = {}  # versions of the schemas in use

    def tree(self, value: Any, path: Place) -> Any:
        """Return the tree node of a value; arrays with equal `path` share a table."""
        if value is None or isinstance(value, (bool, int, float, str)):
            return value
        if isinstance(value, np.generic):
            return value.item()
        if isinstance(value, np.ndarray):
            return {"array": self.put(value, path)}
        if isinstance(value, (bytes, bytearray)):
            self.data.append(value)
            return {"bytes": len(self.data) - 1}
        if isinstance(value, (tuple, list)):
            return {"tuple": [self.tree(entry, (*path, "")) for entry in value]}
        if isinstance(value, dict):
            entries = [[key, self.tree(entry, (*path, ""))] for key, entry in value.items()]
            return {"dict": entries}
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            return self.record(value, path)
        raise TypeError(f"{type(value).__name__} cannot be stored")

    def record(self, value: Any, path: Place) -> dict[str, Any]:
        """Return the tree node of a dataclass."""
        name, schema = schemas.schema_of_class(type(value))
        self.versions[name] = schema.version
        names = [field.name for field in dataclasses.fields(value) if field.init]
        fields = {name: self.tree(getattr(value, name), (*path, name)) for name in names}
        return {"schema": name, "fields": fields}

    def put(self, value: NDArray[Any], path: Place) -> list[int]:
        """Add an array to a table; return table index, first row and row count."""
        if not value.ndim or value.dtype not in DTYPES:
            message = f"an array of {value.dtype} with {value.ndim} dimensions cannot be stored"
            raise TypeError(message)
        kind = (path, value.dtype.str, value.shape[1:])
        number = self.numbers.setdefault(kind, len(self.tables))
        if number == len(self.tables):
            self.tables.append([])
            self.rows.append(0)
        first_row = self.rows[number]
        self.tables[number].append(value)
        self.rows[number] += len(value)
        return [number, first_row, len(value)]

    def archive(self) -> bytes:
        """Return the npz archive of the tables and bytes."""
        buffer = io.BytesIO()
        with zipfile.ZipFile(
            buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=COMPRESSION_LEVEL
        ) as archive:
            for number, arrays in enumerate(self.tables):
                # column-major order compresses better
                _add(archive, str(number), np.asfortranarray(np.concatenate(arrays)))
            for number, data in enumerate(self.data):
                _add(archive, f"{BYTES_PREFIX}{number}", np.frombuffer(data, dtype=np.uint8))
        return buffer.getvalue()


def _add(archive: zipfile.ZipFile, name: str, values: NDArray[Any]) -> None:
    """Add an array to an archive in npy format, with reproducible bytes."""
    with archive.open(f"{name}.npy", "w", force_zip64=True) as member:
        np.lib.format.write_array(member, values, allow_pickle=False)


class _Reader:
    """Convert a tree back to the value; tables are read on first use."""

    def __init__(self, archive: zipfile.ZipFile, versions: Mapping[str, int]) -> None:
        self.archive, self.versions = archive, versions
        self.tables: dict[str, NDArray[Any]] = {}

    def value(self, tree: Any) -> Any:
        """Return the value of a tree node."""
        if not isinstance(tree, dict):
            return tree
        if "array" in tree:
            number, first_row, rows = tree["array"]
            return self.rows(str(number), first_row, rows)
        if "bytes" in tree:
            return self.table(f"{BYTES_PREFIX}{tree['bytes']}").tobytes()
        if "tuple" in tree:
            return tuple(map(self.value, tree["tuple"]))
        if "dict" in tree:
            return {key: self.value(entry) for key, entry in tree["dict"]}
        name = tree["schema"]
        fields = {field: self.value(entry) for field, entry in tree["fields"].items()}
        return schemas.record(name, self.versions[name], fields)

    def rows(self, name: str, first_row: int, count: int) -> NDArray[Any]:
        """Return rows of a table, as a view."""
        table = self.table(name)
        if first_row < 0 or count < 0 or first_row + count > len(table):
            raise ValueError("the data are cut short")
        return table[first_row : first_row + count]

    def table(self, name: str) -> NDArray[Any]:
        """Return a table of the archive, which is read once."""
        if name not in self.tables:
            with self.archive.open(f"{name}.npy") as member:
                values = np.lib.format.read_array(member, allow_pickle=False)
            table = np.ascontiguousarray(values)
            table.flags.writeable = False
            self.tables[name] = table
        return self.tables[name]


class Stored:
    """Base of stages that store a result in their object.

    A complete result is cached with its input key.
    """

    _kept: tuple[str, Any] | None = None

    def value(self, obj: Any) -> Any:
        """Return the stored result, read on first use. Raises InputError NO_RESULT."""
        return self.reader(obj)()

    def parts(self, obj: Any, *paths: Place) -> tuple[Any, ...]:
        """Return parts of the stored result by paths of field names and indices.

        Errors as in `value`.
        """
        return tuple(self.reader(obj)(*paths))

    def reader(self, obj: Any) -> Callable[..., Any]:
        """Return a function that gives the current stored result, or only the given paths.

        The function does not use the document, so other threads can call it, also later. Errors as
        in `value`; the function raises errors for damaged data.
        """
        _check_made(obj)
        cached, key = self._kept, obj.Key
        if cached is not None and cached[0] == key:
            result = cached[1]
            return lambda *paths: _values_at(paths, result)
        stored = numbers_of(obj.ResultData), obj.ResultLayout, key, obj.Label

        def read(*paths: Place) -> Any:
            cached = self._kept  # another thread may have set the cache
            if cached is None or cached[0] != key:
                if paths:
                    return unpack_parts(*stored, *paths)
                self._kept = cached = key, unpack(*stored)
            return _values_at(paths, cached[1])

        return read


def _check_made(obj: Any) -> None:
    if not obj.Key:
        raise InputError("NO_RESULT", obj.Label, "the result is missing; recompute the object")


def _values_at(paths: Sequence[Place], value: Any) -> Any:
    """Return the values at paths of a result, or the complete result without paths."""
    return tuple(functools.reduce(_step, path, value) for path in paths) if paths else value


def _step(value: Any, step: str | int) -> Any:
    return value[step] if isinstance(step, int) else getattr(value, step)
