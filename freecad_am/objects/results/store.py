# SPDX-License-Identifier: LGPL-2.1-or-later
"""Results of the core as two values a document can hold: one list of floats and one text.

Dataclasses, tuples, arrays, bytes and plain values go in; the same come out. Arrays that stand at the same place of alike
values, such as the points of all beads, are one table, which is kept column by column as numbers (whole numbers and truth
values are exact in a float). Of these are left out runs of one number and stretches that are there before; the rest is kept
as differences, packed. That, and bytes, which are compressed together, go into the floats, seven to each. The text is JSON
that says what is where. A FloatList is kept as a compressed binary file in the FCStd, and unlike an included file it follows
undo and copies of the object by value; FreeCAD reads it float by float: the fewer, the sooner a document is open.
"""

from __future__ import annotations

import array
import dataclasses
import functools
import importlib
import json
import lzma
import math
import zlib
from collections.abc import Callable, Sequence
from typing import Any, Literal

import numpy as np

from freecad_am.core.types import Array, Integers, NDArray

from ...core.issues import InputError
from . import differences, repeats
from .former_names import MOVED
from .store_bytes import bytes_of, floats_of, older_bytes

_PACKAGE = __name__.split(".", maxsplit=1)[0]
Place = tuple[str | int, ...]
_DTYPES = (np.dtype("float64"), np.dtype("int64"), np.dtype("bool"))
# of files that are much alike: hash chains of which but the first place is looked at find them in half the time that the
# library's own presets take, and better
_FILTERS = [
    {
        "id": lzma.FILTER_LZMA2,
        "preset": 1,
        "dict_size": 1 << 20,
        "mode": lzma.MODE_FAST,
        "mf": lzma.MF_HC3,
        "depth": 1,
        "nice_len": 32,
    }
]
_WHOLE = 2**53  # up to here floats know all whole numbers


def pack(value: Any, key: str) -> tuple[list[float], str]:
    """The floats and the text of a value, both marked with the key. TypeError for what is not data."""
    packer = _Packer()
    tree = packer.tree(value, ())
    once, runs = repeats.without_runs(packer.columns())
    rest, copies = repeats.folded(once)
    sizes = [len(rest), len(once), len(copies), len(runs)]
    del once  # as large as all that comes after it
    indices = np.concatenate([copies.ravel(), runs.ravel()]).astype(np.float64)
    pieces, where = differences.packed(rest), differences.packed(indices)
    data = packer.bytes()
    layout = {
        "n": sizes,
        "p": [len(data), [*map(len, pieces)], [*map(len, where)]],
        "t": packer.table_shapes(),
        "v": tree,
    }
    floats = np.concatenate([[_mark(key)], floats_of(b"".join([data, *pieces, *where]))])
    return floats.tolist(), f"{key} {json.dumps(layout, separators=(',', ':'))}"


def numbers_of(floats: list[float]) -> Array:
    """The floats of a document as an array. The list is best let go then: Python looks through it now and again."""
    return np.frombuffer(array.array("d", floats))  # twice as fast as numpy by itself


def unpack(floats: Sequence[float] | Array, text: str, key: str, where: str) -> Any:
    """The value of `pack`; InputError 'BAD_RESULT' naming `where` for one that is damaged, unknown, or of another key.

    While a step is undone, floats, text and key come back one after the other: for a moment they do not belong together.
    """
    return picked(floats, text, key, where, ())[0]


def picked(
    floats: Sequence[float] | Array, text: str, key: str, where: str, *places: Place
) -> tuple[Any, ...]:
    """Values within that of `pack`, nothing else of it read: by the field names and indices that lead to each. Errors as
    `unpack`."""
    try:
        if not text.startswith(f"{key} ") or not len(floats) or floats[0] != _mark(key):
            raise ValueError("it belongs to other inputs")
        layout, numbers = json.loads(text[len(key) :]), np.asarray(floats)
        newer = isinstance(layout, dict) and "n" in layout
        tree, reader = _newer(layout, numbers, () in places) if newer else _older(layout, numbers)
        return tuple(reader.value(_within(tree, place), not place) for place in places)
    except (
        KeyError,
        ValueError,
        TypeError,
        AttributeError,
        ImportError,
        IndexError,
        zlib.error,
        lzma.LZMAError,
    ) as error:
        raise InputError(
            "BAD_RESULT", where, "the stored result cannot be read ({}); recompute it", error
        ) from None


def _within(tree: Any, place: Place) -> Any:
    """What is at a place of a tree."""
    for step in place:
        tree = tree["t"][step] if isinstance(step, int) else tree["v"][step]
    return tree


def _newer(layout: Any, floats: Array, all_of_it: bool) -> tuple[Any, _Reader]:
    """The tree of a layout, and what reads it, or parts of it, from the floats."""
    packed, *lengths = layout["p"]
    ends = np.cumsum([packed, *lengths[0], *lengths[1]]).tolist()
    data = bytes_of(floats[1:], ends[-1])
    pieces = [data[begin:end] for begin, end in zip(ends, ends[1:])]
    rest, once, copies, runs = layout["n"]
    numbers = differences.Unpacked(pieces[: len(lengths[0])], rest)
    indices = differences.Unpacked(pieces[len(lengths[0]) :], 3 * copies + 2 * runs)
    where = _table(indices[: 3 * copies], 3), once, _table(indices[3 * copies :], 2)
    unfolded = repeats.Unfolded(numbers[:] if all_of_it else numbers, *where)
    return layout["v"], _Reader(unfolded, lambda: data[:packed], layout["t"])


def _older(tree: Any, floats: Array) -> tuple[Any, _Reader]:
    """As `_newer`, of a result that was stored before there were tables and differences."""
    numbers = floats[:]
    numbers.flags.writeable = False  # parts share it
    runs, copies, data = np.zeros((0, 2), dtype=np.int64), np.zeros((0, 3), dtype=np.int64), (0, 0)
    if isinstance(tree, dict) and "r" in tree:
        numbers, runs = _split(numbers, tree["r"], 2)
        tree = tree["v"]
    size = len(numbers)
    if isinstance(tree, dict) and "f" in tree:
        (size, count), tree = tree["f"], tree["v"]
        numbers, copies = _split(numbers, count, 3)
    if isinstance(tree, dict) and "z" in tree:
        data, tree = tuple(tree["z"]), tree["v"]
    unfolded = repeats.Unfolded(numbers, copies, size, runs)
    return tree, _Reader(unfolded, lambda: older_bytes(unfolded, *data), ())


def _split(numbers: Array, count: int, columns: int) -> tuple[Array, Integers]:
    """What comes before a table at the end, and the table."""
    rest, table = np.split(numbers, [len(numbers) - columns * count])
    return rest, _table(table, columns)


def _table(numbers: Array, columns: int) -> Integers:
    return numbers.astype(np.int64).reshape(-1, columns)


def _mark(key: str) -> float:
    return float(zlib.crc32(key.encode()))


@functools.cache
def _kind_of(dataclass: type[Any]) -> tuple[str, tuple[str, ...]]:
    """What a dataclass is called in the text, and the fields that it is made of."""
    names = tuple(field.name for field in dataclasses.fields(dataclass) if field.init)
    return f"{dataclass.__module__.removeprefix(_PACKAGE)}:{dataclass.__qualname__}", names


class _Packer:
    def __init__(self) -> None:
        self.kinds: dict[Any, int] = {}  # the table of arrays of each kind
        self.tables: list[list[NDArray[Any]]] = []
        self.rows: list[int] = []  # of each table
        # the files of a program are much alike, and far apart for zlib; one by one, for together they take much memory
        self.compressor = lzma.LZMACompressor(filters=_FILTERS)
        self.compressed: list[bytes] = []
        self.size = 0  # of all bytes

    def bytes(self) -> bytes:
        """All bytes, compressed; none of none. Once, at the end."""
        return b"".join([*self.compressed, self.compressor.flush()]) if self.size else b""

    def tree(self, value: Any, place: Place) -> Any:
        """What stands for a value in the text; `place`: names that lead to it, where entries have none."""
        if value is None or isinstance(value, (bool, int, float, str)):
            return value
        if isinstance(value, np.generic):
            return value.item()
        if isinstance(value, np.ndarray):
            return {"a": self.put(value, place)}
        if isinstance(value, (bytes, bytearray)):
            self.compressed.append(self.compressor.compress(value))
            self.size += len(value)
            return {"y": [self.size - len(value), len(value)]}
        if isinstance(value, (tuple, list)):
            return {"t": [self.tree(entry, (*place, "")) for entry in value]}
        if isinstance(value, dict):
            return {"d": [[key, self.tree(entry, (*place, ""))] for key, entry in value.items()]}
        if dataclasses.is_dataclass(value) and not isinstance(value, type):
            kind, names = _kind_of(type(value))
            return {
                "c": kind,
                "v": {name: self.tree(getattr(value, name), (*place, name)) for name in names},
            }
        raise TypeError(f"{type(value).__name__} cannot be stored")

    def put(self, value: NDArray[Any], place: Place) -> list[int]:
        """The table that an array becomes part of, from which row on, and how many rows. TypeError for what is none, and
        for whole numbers that a float cannot tell apart."""
        if not value.ndim or value.dtype not in _DTYPES:
            raise TypeError(
                f"an array of {value.dtype} with {value.ndim} dimensions cannot be stored"
            )
        if (
            value.dtype == np.int64
            and value.size
            and not -_WHOLE <= value.min() <= value.max() <= _WHOLE
        ):
            raise TypeError(f"whole numbers beyond {_WHOLE} cannot be stored")
        kind = (place, _DTYPES.index(value.dtype), value.shape[1:])
        number = self.kinds.setdefault(kind, len(self.tables))
        if number == len(self.tables):
            self.tables.append([])
            self.rows.append(0)
        first = self.rows[number]
        self.tables[number].append(value)
        self.rows[number] += len(value)
        return [number, first, len(value)]

    def table_shapes(self) -> list[list[int]]:
        """Of each table dtype, rows, and the shape of a row."""
        return [
            [dtype, rows, *shape]
            for (_, dtype, shape), rows in zip(self.kinds, self.rows, strict=True)
        ]

    def columns(self) -> Array:
        """All tables column by column."""
        whole, start = np.empty(sum(value.size for arrays in self.tables for value in arrays)), 0
        for arrays, rows in zip(self.tables, self.rows, strict=True):
            size = sum(value.size for value in arrays)
            table, row = whole[start : start + size].reshape(size // max(rows, 1), rows), 0
            for value in arrays:
                table[:, row : row + len(value)] = value.reshape(len(value), len(table)).T
                row += len(value)
            start += size
        return whole


class _Reader:
    def __init__(
        self,
        numbers: repeats.Unfolded,
        packed: Callable[[], bytes],
        tables: Sequence[Sequence[int]],
    ) -> None:
        self.numbers, self.packed, self.tables = numbers, packed, tables
        sizes = [int(np.prod(rest)) for _, *rest in tables]
        self.starts = [0, *np.cumsum(sizes, dtype=np.int64).tolist()]
        self.whole: dict[int, NDArray[Any]] = {}  # tables that were read

    def value(self, tree: Any, all_of_it: bool) -> Any:
        """What a part of the text stands for; tables are read at once where all is."""
        if not isinstance(tree, dict):
            return tree
        if "a" in tree:
            return self.array(*tree["a"], all_of_it) if self.tables else self.older(*tree["a"])
        if "s" in tree:
            dtype, start, rows, sides, columns = tree["s"]
            turned = self.older(dtype, start, sides, rows, columns)
            return np.ascontiguousarray(turned.transpose(1, 0, 2))
        if "y" in tree:
            start, length = tree["y"]
            if start + length > len(self.bytes):
                raise ValueError("it is cut short")
            return self.bytes[start : start + length]
        if "b" in tree:  # as older documents have them
            return zlib.decompress(older_bytes(self.numbers, *tree["b"]))
        if "t" in tree:
            return tuple(self.value(entry, all_of_it) for entry in tree["t"])
        if "d" in tree:
            return {key: self.value(entry, all_of_it) for key, entry in tree["d"]}
        return _class(tree["c"])(
            **{name: self.value(entry, all_of_it) for name, entry in tree["v"].items()}
        )

    def array(self, number: int, first: int, rows: int, all_of_it: bool) -> NDArray[Any]:
        """Rows of a table, which they share where it is read at once."""
        if first < 0 or rows < 0 or first + rows > self.tables[number][1]:
            raise ValueError("it is cut short")
        if not all_of_it:
            return self.rows(number, first, rows, "F")
        if number not in self.whole:
            self.whole[number] = self.rows(number, 0, self.tables[number][1], "C")
        return self.whole[number][first : first + rows]

    def rows(self, number: int, first: int, rows: int, order: Literal["C", "F"]) -> NDArray[Any]:
        """Rows of a table, and nothing else of it. What views draw, and compute with nothing, stands column by column, as it
        is kept: that is filled sooner."""
        dtype, count, *shape = self.tables[number]
        if rows * math.prod(shape) > self.numbers.size:
            raise ValueError("it is cut short")
        columns = np.empty((rows, math.prod(shape)), dtype=_DTYPES[dtype], order=order)
        for k in range(columns.shape[1]):
            self.numbers.fill(self.starts[number] + k * count + first, columns[:, k])
        columns.flags.writeable = False
        table = columns.reshape(rows, *shape)
        table.flags.writeable = False
        return table

    def older(self, dtype: int, start: int, *shape: int) -> NDArray[Any]:
        """An array that stands row by row."""
        size = int(np.prod(shape)) if shape else 1
        return self.numbers.part(start, size).astype(_DTYPES[dtype], copy=False).reshape(shape)

    @functools.cached_property
    def bytes(self) -> bytes:
        """All bytes, one value after the other."""
        packed = self.packed()
        return lzma.decompress(packed) if packed else b""


def _class(name: str) -> Any:
    # only our own dataclasses: a document must not name what is called when it is opened
    module, _, qualified = name.partition(":")
    ours = module.startswith((".core.", ".objects.", ".verify"))
    kind = (
        getattr(importlib.import_module(_PACKAGE + MOVED.get(module, module)), qualified)
        if ours
        else None
    )
    if not (isinstance(kind, type) and dataclasses.is_dataclass(kind)):
        raise ValueError(f"{name} is not a result")
    return kind
