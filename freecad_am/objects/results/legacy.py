# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read results that documents stored before format 5.

They name classes by module, and their numbers went through a codec of our own: runs of one number and repeated stretches were
left out, the rest was kept as differences of bits. Nothing is written in these formats any more.
"""

from __future__ import annotations

import functools
import lzma
import math
import zlib
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal

import numpy as np

from freecad_am.core.types import Array, Index, Integers, NDArray

from . import schemas
from .former_names import SCHEMA_NAMES

Place = tuple[str | int, ...]
_DTYPES = (np.dtype("float64"), np.dtype("int64"), np.dtype("bool"))
_BYTES_PER_FLOAT = 7
_OLDER_BYTES_PER_FLOAT = 6
_PIECE = 8192  # numbers that have one order of differences
_HIGHEST_ORDER = 8  # of differences
_ALL_BUT_SIGN = np.int64(0x7FFFFFFFFFFFFFFF)
_ONE = np.uint64(1)


def picked(layout: Any, floats: Array, places: Sequence[Place]) -> tuple[Any, ...]:
    """Return parts of a stored value, all of it for the place ().

    Raises
    ------
    ValueError, KeyError, TypeError, IndexError, zlib.error
        If the result is damaged or of a class that is not known.
    """
    try:
        newer = isinstance(layout, dict) and "n" in layout
        tree, reader = _newer(layout, floats, () in places) if newer else _older(layout, floats)
        return tuple(reader.value(_within(tree, place), not place) for place in places)
    except lzma.LZMAError as error:
        raise ValueError(str(error)) from None


def _within(tree: Any, place: Place) -> Any:
    """What is at a place of a tree."""
    for step in place:
        tree = tree["t"][step] if isinstance(step, int) else tree["v"][step]
    return tree


def _newer(layout: Any, floats: Array, all_of_it: bool) -> tuple[Any, _Reader]:
    """The tree of a layout, and what reads it, or parts of it, from the floats."""
    packed, *lengths = layout["p"]
    ends = np.cumsum([packed, *lengths[0], *lengths[1]]).tolist()
    data = _bytes_of(floats[1:], ends[-1])
    pieces = [data[begin:end] for begin, end in zip(ends, ends[1:])]
    rest, once, copies, runs = layout["n"]
    numbers = _Unpacked(pieces[: len(lengths[0])], rest)
    indices = _Unpacked(pieces[len(lengths[0]) :], 3 * copies + 2 * runs)
    where = _table(indices[: 3 * copies], 3), once, _table(indices[3 * copies :], 2)
    unfolded = _Unfolded(numbers[:] if all_of_it else numbers, *where)
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
    unfolded = _Unfolded(numbers, copies, size, runs)
    return tree, _Reader(unfolded, lambda: _older_bytes(unfolded, *data), ())


def _split(numbers: Array, count: int, columns: int) -> tuple[Array, Integers]:
    """What comes before a table at the end, and the table."""
    rest, table = np.split(numbers, [len(numbers) - columns * count])
    return rest, _table(table, columns)


def _table(numbers: Array, columns: int) -> Integers:
    return numbers.astype(np.int64).reshape(-1, columns)


class _Reader:
    def __init__(
        self,
        numbers: _Unfolded,
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
            return zlib.decompress(_older_bytes(self.numbers, *tree["b"]))
        if "t" in tree:
            return tuple(self.value(entry, all_of_it) for entry in tree["t"])
        if "d" in tree:
            return {key: self.value(entry, all_of_it) for key, entry in tree["d"]}
        return _class_of(tree["c"])(
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


class _Unfolded:
    """The numbers again that were left out, part by part: nothing is put back that is not asked for.

    From a list `rest`, or what is sliced like one, of which `copies` were left out, which had `size` numbers before, and
    from that `runs`. ValueError where they do not belong together.
    """

    def __init__(self, rest: Any, copies: Index, size: int, runs: Index) -> None:
        place, source, length = copies.T
        sound = (length > 0).all() and (source >= 0).all() and (source + length <= place).all()
        if not sound or (place[1:] < (place + length)[:-1]).any() or (place + length > size).any():
            raise ValueError("its repetitions are damaged")
        if size - int(length.sum()) != len(rest):
            raise ValueError("it is cut short")
        at, count = runs.T
        if (at < 0).any() or (at >= size).any() or (np.diff(at) <= 0).any() or (count < 1).any():
            raise ValueError("its runs are damaged")
        self.rest = rest
        before = np.cumsum(count - 1)  # that the runs up to each add
        self.runs, self.runs_end = runs.tolist(), (at + 1 + before).tolist()
        self.added = [0, *before.tolist()]
        self.size = size + self.added[-1]
        self.copies, self.copies_end = copies.tolist(), (place + length).tolist()
        self.left_out = [0, *np.cumsum(length).tolist()]

    def part(self, start: int, size: int) -> Array:
        """The numbers (size,) from `start` on, not copied where they stand in one piece. ValueError beyond the end."""
        self._check(start, size)
        return _joined(list(self._pieces(start, start + size)), size)

    def fill(self, start: int, column: NDArray[Any]) -> None:
        """Put the numbers from `start` on into (n,), which may be a column of an array. ValueError beyond the end."""
        self._check(start, len(column))
        end = 0
        for piece, count in self._pieces(start, start + len(column)):
            column[end : end + count] = piece
            end += count

    def _check(self, start: int, size: int) -> None:
        if start < 0 or start + size > self.size:
            raise ValueError("it is cut short")

    def _pieces(self, start: int, end: int) -> Iterator[tuple[Array, int]]:
        """Stretches of numbers with how long they are, and for runs (1,) with how long it is."""
        k = bisect_right(self.runs_end, start)
        while start < end:
            at, count = self.runs[k] if k < len(self.runs) else (self.size, 0)
            first = at + self.added[k]  # of the run
            if start < first:
                stop = min(first, end)
                yield from self._stretches(start - self.added[k], stop - self.added[k])
            else:
                stop = min(first + count, end)
                ((number, _),) = self._stretches(at, at + 1)
                yield number, stop - start
                k += 1
            start = stop

    def _stretches(self, start: int, end: int) -> Iterator[tuple[Array, int]]:
        """Stretches, with how long they are, of numbers with one of each run. A copy may be of others before it, and these
        again: what is asked for is followed to where it stands, and nothing else of them."""
        waiting = [(start, end)]
        while waiting:
            start, end = waiting.pop()
            k = bisect_right(self.copies_end, start)
            place, source, length = self.copies[k] if k < len(self.copies) else (end, 0, 0)
            stop = min(end, place + length if start >= place else place)
            if stop < end:
                waiting.append((stop, end))
            if start < place:
                yield self.rest[start - self.left_out[k] : stop - self.left_out[k]], stop - start
            else:
                waiting.append((source + start - place, source + stop - place))


def _joined(pieces: list[tuple[Array, int]], size: int) -> Array:
    if len(pieces) == 1 and len(pieces[0][0]) == size:
        return pieces[0][0]
    numbers, end = np.empty(size), 0
    for piece, count in pieces:
        numbers[end : end + count] = piece
        end += count
    numbers.flags.writeable = False
    return numbers


class _Unpacked:
    """The numbers again: as long as they were, and sliced as an array of them, of which only what is asked for is read.

    ValueError or zlib.error for pieces that are damaged, at the latest when they are read.
    """

    def __init__(self, pieces: Sequence[bytes], size: int) -> None:
        if len(pieces) != -(-size // _PIECE):
            raise ValueError("it is cut short")
        self.pieces, self.missing = pieces, [True] * len(pieces)
        self.numbers = np.empty(size)

    def __len__(self) -> int:
        return len(self.numbers)

    def __getitem__(self, some: slice) -> Array:
        start, end, _ = some.indices(len(self.numbers))
        for k in range(start // _PIECE, -(-end // _PIECE)):
            if self.missing[k]:
                _unpack(self.pieces[k], self.numbers[k * _PIECE : (k + 1) * _PIECE].view(np.int64))
                self.missing[k] = False
        found = self.numbers[start:end]
        found.flags.writeable = False  # parts may share it
        return found


def _unpack(piece: bytes, bits: Integers) -> None:
    """Fill the bits of the numbers of a piece."""
    planes = np.frombuffer(
        zlib.decompress(memoryview(piece)[1:], bufsize=8 * len(bits)), dtype=np.uint8
    )
    if len(planes) != 8 * len(bits) or piece[0] > _HIGHEST_ORDER:
        raise ValueError("it is damaged")
    planes = planes.reshape(8, -1)
    folded = np.zeros(len(bits), dtype="<u8")
    places, used = folded.view(np.uint8).reshape(-1, 8), 8
    while used and not planes[used - 1].any():  # of small differences the higher bytes are 0
        used -= 1
    for k in range(used):
        places[:, k] = planes[k]
    differences = folded.astype(np.uint64, copy=False)
    sums = np.empty((len(bits), 2), dtype=np.int64)[
        :, 0
    ]  # numpy sums up what stands apart in a fourth of the time
    np.negative((differences & _ONE).view(np.int64), out=sums)
    differences >>= _ONE
    sums ^= differences.view(np.int64)
    for _ in range(piece[0]):
        np.add.accumulate(sums, out=sums)
    sign = np.right_shift(sums, 63, out=differences.view(np.int64))
    sign &= _ALL_BUT_SIGN
    np.bitwise_xor(sums, sign, out=bits)


def _bytes_of(floats: Array, length: int) -> bytes:
    whole = (
        floats[: -(-length // _BYTES_PER_FLOAT)]
        .astype("<f8", copy=False)
        .view(np.uint8)
        .reshape(-1, 8)
    )
    return np.ascontiguousarray(whole[:, :_BYTES_PER_FLOAT]).ravel()[:length].tobytes()


def _older_bytes(numbers: _Unfolded, length: int, start: int) -> bytes:
    """Bytes that stand among the numbers, six to a whole number."""
    whole = (
        numbers.part(start, -(-length // _OLDER_BYTES_PER_FLOAT))
        .astype("<u8")
        .view(np.uint8)
        .reshape(-1, 8)
    )
    return whole[:, :_OLDER_BYTES_PER_FLOAT].tobytes()[:length]


def _class_of(name: str) -> Any:
    """Return the class of a former name, `.module:class`; only of results, so that opening a document calls nothing else."""
    if name not in SCHEMA_NAMES:
        raise ValueError(f"{name} is not a result")
    return schemas.class_of(SCHEMA_NAMES[name])
