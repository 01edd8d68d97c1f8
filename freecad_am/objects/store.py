# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results of the core as two values a document can hold: one list of floats and one text.

Dataclasses, tuples, arrays, bytes and plain values go in; the same come out. The floats are the arrays one after
the other (whole numbers and truth values are exact in a float; bytes go compressed together, six to a float), but for
runs of one number and stretches that are there before; the text is JSON that says what is where. A FloatList is kept as a
compressed binary file in the FCStd, and unlike an included file it follows undo and copies of the object by value.
"""

from __future__ import annotations

import array
import dataclasses
import functools
import importlib
import json
import lzma
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.issues import InputError
from . import repeats

_PACKAGE = __name__.split(".", maxsplit=1)[0]
_BYTES_PER_FLOAT = 6
Place = tuple[str | int, ...]
_DTYPES = ("float64", "int64", "bool")


def pack(value: Any, key: str) -> tuple[list[float], str]:
    """The floats and the text of a value, both marked with the key. TypeError for what is not data."""
    packer = _Packer()
    packer.put(np.array([_mark(key)]))
    tree = packer.tree(value)
    if packer.data:
        tree = {"z": packer.put_data(), "v": tree}
    numbers, runs = repeats.without_runs(np.concatenate(packer.parts))
    rest, copies = repeats.folded(numbers)
    if len(copies):
        tree = {"f": [len(numbers), len(copies)], "v": tree}
        rest = np.concatenate([rest, copies.astype(np.float64).ravel()])
    if len(runs):
        tree = {"r": len(runs), "v": tree}
        rest = np.concatenate([rest, runs.astype(np.float64).ravel()])
    return rest.tolist(), f"{key} {json.dumps(tree, separators=(',', ':'))}"


def numbers_of(floats: list[float]) -> NDArray[np.float64]:
    """The floats of a document as an array. The list is best let go then: Python looks through it now and again."""
    return np.frombuffer(array.array("d", floats))  # twice as fast as numpy by itself


def unpack(floats: Sequence[float] | NDArray[np.float64], text: str, key: str, where: str) -> Any:
    """The value of `pack`; InputError 'BAD_RESULT' naming `where` for one that is damaged, unknown, or of another key.

    While a step is undone, floats, text and key come back one after the other: for a moment they do not belong together.
    """
    return picked(floats, text, key, where, ())[0]


def picked(
    floats: Sequence[float] | NDArray[np.float64], text: str, key: str, where: str, *places: Place
) -> tuple[Any, ...]:
    """Values within that of `pack`, nothing else of it read: by the field names and indices that lead to each. Errors as
    `unpack`."""
    try:
        if not text.startswith(f"{key} ") or not len(floats) or floats[0] != _mark(key):
            raise ValueError("it belongs to other inputs")
        tree, numbers = json.loads(text[len(key):]), np.asarray(floats)
        runs, copies = np.zeros((0, 2), dtype=np.int64), np.zeros((0, 3), dtype=np.int64)
        if isinstance(tree, dict) and "r" in tree:
            numbers, runs = _split(numbers, tree["r"], 2)
            tree = tree["v"]
        size = len(numbers)
        if isinstance(tree, dict) and "f" in tree:
            (size, count), tree = tree["f"], tree["v"]
            numbers, copies = _split(numbers, count, 3)
        reader = _Reader(repeats.Unfolded(numbers, copies, size, runs))
        if isinstance(tree, dict) and "z" in tree:
            reader.data, tree = tuple(tree["z"]), tree["v"]
        return tuple(reader.value(_within(tree, place)) for place in places)
    except (KeyError, ValueError, TypeError, AttributeError, ImportError, IndexError, zlib.error,
            lzma.LZMAError) as error:
        raise InputError("BAD_RESULT", where, f"the stored result cannot be read ({error}); recompute it") from None


def _within(tree: Any, place: Place) -> Any:
    """What is at a place of a tree."""
    for step in place:
        tree = tree["t"][step] if isinstance(step, int) else tree["v"][step]
    return tree


def _split(numbers: NDArray[np.float64], count: int, columns: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """What comes before a table at the end, and the table."""
    rest, table = np.split(numbers, [len(numbers) - columns * count])
    return rest, table.astype(np.int64).reshape(-1, columns)


def _mark(key: str) -> float:
    return float(zlib.crc32(key.encode()))


class _Packer:
    def __init__(self) -> None:
        self.parts: list[NDArray[np.float64]] = []
        self.size = 0
        self.data = bytearray()

    def tree(self, value: Any) -> Any:
        if value is None or isinstance(value, (bool, int, float, str)):
            return value
        if isinstance(value, np.ndarray):
            dtype = _DTYPES.index(str(value.dtype))
            if value.ndim == 3:  # what comes before and behind each point is mostly the same: first all of one
                return {"s": [dtype, *self.put(value.transpose(1, 0, 2).ravel()), *value.shape]}
            return {"a": [dtype, *self.put(value.ravel()), *value.shape]}
        if isinstance(value, np.generic):
            return value.item()
        if isinstance(value, (bytes, bytearray)):
            self.data += value
            return {"y": [len(self.data) - len(value), len(value)]}
        if isinstance(value, (tuple, list)):
            return {"t": [self.tree(entry) for entry in value]}
        if isinstance(value, dict):
            return {"d": [[key, self.tree(entry)] for key, entry in value.items()]}
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            kind = type(value)
            names = [field.name for field in dataclasses.fields(value) if field.init]
            values = {name: self.tree(getattr(value, name)) for name in names}
            return {"c": f"{kind.__module__.removeprefix(_PACKAGE)}:{kind.__qualname__}", "v": values}
        raise TypeError(f"{type(value).__name__} cannot be stored")

    def put_data(self) -> list[int]:
        """All bytes: the files of a program are much alike, and far apart for zlib."""
        packed = lzma.compress(self.data, preset=1)
        return [len(packed), *self.put(_floats_of(packed))]

    def put(self, flat: NDArray[Any]) -> tuple[int]:
        start = self.size
        self.parts.append(flat.astype(np.float64))
        self.size += len(flat)
        return (start,)


class _Reader:
    def __init__(self, floats: repeats.Unfolded) -> None:
        self.floats = floats
        self.data: tuple[int, ...] = ()  # where the bytes are

    def value(self, tree: Any) -> Any:
        if not isinstance(tree, dict):
            return tree
        if "a" in tree:
            dtype, start, *shape = tree["a"]
            size = int(np.prod(shape)) if shape else 1
            return self.floats.part(start, size).astype(_DTYPES[dtype], copy=False).reshape(shape)
        if "s" in tree:
            dtype, start, rows, sides, columns = tree["s"]
            numbers = self.floats.part(start, rows * sides * columns).astype(_DTYPES[dtype], copy=False)
            turned = numbers.reshape(sides, rows, columns)
            return np.ascontiguousarray(turned.transpose(1, 0, 2))
        if "y" in tree:
            start, length = tree["y"]
            if start + length > len(self.bytes):
                raise ValueError("it is cut short")
            return self.bytes[start : start + length]
        if "b" in tree:  # as older documents have them
            return zlib.decompress(self.packed(*tree["b"]))
        if "t" in tree:
            return tuple(self.value(entry) for entry in tree["t"])
        if "d" in tree:
            return {key: self.value(entry) for key, entry in tree["d"]}
        return _class(tree["c"])(**{name: self.value(entry) for name, entry in tree["v"].items()})

    @functools.cached_property
    def bytes(self) -> bytes:
        """All bytes, one value after the other."""
        return lzma.decompress(self.packed(*self.data)) if self.data else b""

    def packed(self, length: int, start: int) -> bytes:
        """Bytes that are kept six to a float."""
        return _bytes_of(self.floats.part(start, -(-length // _BYTES_PER_FLOAT)), length)


def _class(name: str) -> Any:
    # only our own dataclasses: a document must not name what is called when it is opened
    module, _, qualified = name.partition(":")
    ours = module.startswith((".core.", ".objects.", ".verify"))
    kind = getattr(importlib.import_module(_PACKAGE + module), qualified) if ours else None
    if not (isinstance(kind, type) and dataclasses.is_dataclass(kind)):
        raise ValueError(f"{name} is not a result")
    return kind


def _floats_of(data: bytes) -> NDArray[np.float64]:
    padded = np.frombuffer(data + bytes(-len(data) % _BYTES_PER_FLOAT), dtype=np.uint8).reshape(-1, _BYTES_PER_FLOAT)
    whole = np.zeros((len(padded), 8), dtype=np.uint8)
    whole[:, :_BYTES_PER_FLOAT] = padded
    return whole.view("<u8").ravel().astype(np.float64)


def _bytes_of(floats: NDArray[np.float64], length: int) -> bytes:
    whole = floats.astype("<u8").view(np.uint8).reshape(-1, 8)
    return whole[:, :_BYTES_PER_FLOAT].tobytes()[:length]
