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

from ...core.types import Array, Index, Integers, NDArray
from . import schemas

# ---- Schema names of the classes that these documents name by module. The list is complete and
# stays as it is.

SCHEMA_NAMES = {
    ".core.geometry.clad_faces:CladFaces": "clad_faces",
    ".core.geometry.curves.bead_curves:BeadCurve": "bead_curve",
    ".core.geometry.curves.bead_curves:Curves": "curves",
    ".core.geometry.curves.guide:Guide": "guide",
    ".core.geometry.curves.profile:Meridian": "meridian",
    ".core.geometry.curves.profile:RevolvedWall": "revolved_wall",
    ".core.geometry.curves:BeadCurve": "bead_curve",
    ".core.geometry.curves:Curves": "curves",
    ".core.geometry.developable:Developable": "developable_surface",
    ".core.geometry.fitted:DeviationMap": "deviation_map",
    ".core.geometry.fitted:Fitted": "fitted",
    ".core.geometry.fitted:PredictedShape": "predicted_shape",
    ".core.geometry.guide:Guide": "guide",
    ".core.geometry.mesh.solid:SolidMesh": "solid_mesh",
    ".core.geometry.mesh.triangle_mesh:Mesh": "mesh",
    ".core.geometry.mesh:Mesh": "mesh",
    ".core.geometry.mesh_wall:MeshWall": "mesh_wall",
    ".core.geometry.obstacles:Body": "obstacle",
    ".core.geometry.on_hub:Base": "hub_base",
    ".core.geometry.on_hub:Group": "solid_group",
    ".core.geometry.on_hub:OwnHub": "own_hub",
    ".core.geometry.on_hub:SolidsOnHub": "solids_on_hub",
    ".core.geometry.part_depths:PartDepths": "part_depths",
    ".core.geometry.part_depths:Surface": "part_surface",
    ".core.geometry.patch:Patch": "surface_patch",
    ".core.geometry.patch_wall:FirstCurve": "first_curve",
    ".core.geometry.patch_wall:PatchWall": "patch_wall",
    ".core.geometry.patch_wall:Rim": "wall_rim",
    ".core.geometry.plane:Plane": "plane",
    ".core.geometry.profile:Meridian": "meridian",
    ".core.geometry.profile:RevolvedWall": "revolved_wall",
    ".core.geometry.solid_mesh:SolidMesh": "solid_mesh",
    ".core.geometry.surface:Cone": "cone_surface",
    ".core.geometry.surface:Torus": "torus_surface",
    ".core.geometry.surface_wall:Placed": "placed_surface",
    ".core.geometry.surface_wall:SurfaceWall": "surface_wall",
    ".core.geometry.surroundings:Body": "obstacle",
    ".core.geometry.walls.clad_faces:CladFaces": "clad_faces",
    ".core.geometry.walls.mesh_wall:MeshWall": "mesh_wall",
    ".core.geometry.walls.part_depths:PartDepths": "part_depths",
    ".core.geometry.walls.part_depths:Surface": "part_surface",
    ".core.geometry.walls.patch:Patch": "surface_patch",
    ".core.geometry.walls.patch_wall:FirstCurve": "first_curve",
    ".core.geometry.walls.patch_wall:PatchWall": "patch_wall",
    ".core.geometry.walls.patch_wall:Rim": "wall_rim",
    ".core.geometry.walls.surface:Cone": "cone_surface",
    ".core.geometry.walls.surface:Torus": "torus_surface",
    ".core.geometry.walls.surface_wall:Placed": "placed_surface",
    ".core.geometry.walls.surface_wall:SurfaceWall": "surface_wall",
    ".core.inspection.figures:Ball": "fitted_ball",
    ".core.inspection.figures:Circle": "fitted_circle",
    ".core.inspection.figures:Spread": "deviation_spread",
    ".core.inspection.figures:Thickness": "measured_thickness",
    ".core.inspection.inspect:Inspected": "inspection",
    ".core.inspection.roundness:Round": "roundness",
    ".core.issues:Issue": "issue",
    ".core.motion:Motion": "motion",
    ".core.parameters.cell:CellParameters": "cell_parameters",
    ".core.parameters.cell:NozzleParameters": "nozzle_parameters",
    ".core.planning.joint_path:BeadPath": "bead_path",
    ".core.planning.joint_path:JointPath": "joint_path",
    ".core.toolpath:Bead": "bead",
    ".core.toolpath:Layer": "layer",
    ".core.toolpath:SpeedLaw": "speed_law",
    ".core.toolpath:Toolpath": "toolpath",
    ".objects.joint_path:Planned": "planned_path",
    ".objects.program:Written": "program",
    ".verify:Verification": "verification",
}


Place = tuple[str | int, ...]
_DTYPES = (np.dtype("float64"), np.dtype("int64"), np.dtype("bool"))
_BYTES_PER_FLOAT = 7
_OLDER_BYTES_PER_FLOAT = 6
FIRST_VERSION = 1  # of all schemas, as these documents have them
_PIECE = 8192  # numbers that have one order of differences
_HIGHEST_ORDER = 8  # of differences
_ALL_BUT_SIGN = np.int64(0x7FFFFFFFFFFFFFFF)
_ONE = np.uint64(1)


def pick_parts(layout: Any, floats: Array, paths: Sequence[Place]) -> tuple[Any, ...]:
    """Return parts of a stored value; the path () gives the complete value.

    Raises
    ------
    ValueError, KeyError, TypeError, IndexError, zlib.error
        If the result is damaged or of an unknown class.
    """
    try:
        newer = isinstance(layout, dict) and "n" in layout
        tree, reader = _newer(layout, floats, () in paths) if newer else _older(layout, floats)
        return tuple(reader.value(_subtree(tree, path), not path) for path in paths)
    except lzma.LZMAError as error:
        raise ValueError(str(error)) from None


def _subtree(tree: Any, path: Place) -> Any:
    """The node at a path of a tree."""
    for step in path:
        tree = tree["t"][step] if isinstance(step, int) else tree["v"][step]
    return tree


def _newer(layout: Any, floats: Array, all_of_it: bool) -> tuple[Any, _Reader]:
    """The tree of a layout, and a reader of its values from the floats."""
    packed, *lengths = layout["p"]
    ends = np.cumsum([packed, *lengths[0], *lengths[1]]).tolist()
    data = _bytes_of(floats[1:], ends[-1])
    chunks = [data[begin:end] for begin, end in zip(ends, ends[1:])]
    number_count, once, copies, runs = layout["n"]
    numbers = _Unpacked(chunks[: len(lengths[0])], number_count)
    indices = _Unpacked(chunks[len(lengths[0]) :], 3 * copies + 2 * runs)
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
    """The numbers before a table at the end, and the table."""
    head, table = np.split(numbers, [len(numbers) - columns * count])
    return head, _table(table, columns)


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
        sizes = [int(np.prod(shape)) for _, *shape in tables]
        self.starts = [0, *np.cumsum(sizes, dtype=np.int64).tolist()]
        self.whole: dict[int, NDArray[Any]] = {}  # tables that were read

    def value(self, tree: Any, all_of_it: bool) -> Any:
        """The value of a node of the text; tables are read at once if everything is read."""
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
                raise ValueError("the data are cut short")
            return self.bytes[start : start + length]
        if "b" in tree:  # as older documents have them
            return zlib.decompress(_older_bytes(self.numbers, *tree["b"]))
        if "t" in tree:
            return tuple(self.value(entry, all_of_it) for entry in tree["t"])
        if "d" in tree:
            return {key: self.value(entry, all_of_it) for key, entry in tree["d"]}
        fields = {name: self.value(entry, all_of_it) for name, entry in tree["v"].items()}
        return schemas.record(_schema_of(tree["c"]), FIRST_VERSION, fields)

    def array(self, number: int, first_row: int, rows: int, all_of_it: bool) -> NDArray[Any]:
        """Rows of a table, which they share where it is read at once."""
        if first_row < 0 or rows < 0 or first_row + rows > self.tables[number][1]:
            raise ValueError("the data are cut short")
        if not all_of_it:
            return self.rows(number, first_row, rows, "F")
        if number not in self.whole:
            self.whole[number] = self.rows(number, 0, self.tables[number][1], "C")
        return self.whole[number][first_row : first_row + rows]

    def rows(
        self, number: int, first_row: int, rows: int, order: Literal["C", "F"]
    ) -> NDArray[Any]:
        """Only the given rows of a table. Arrays that views only draw are ordered by columns, as
        stored, which is faster.
        """
        dtype, count, *shape = self.tables[number]
        if rows * math.prod(shape) > self.numbers.size:
            raise ValueError("the data are cut short")
        columns = np.empty((rows, math.prod(shape)), dtype=_DTYPES[dtype], order=order)
        for k in range(columns.shape[1]):
            self.numbers.fill(self.starts[number] + k * count + first_row, columns[:, k])
        columns.flags.writeable = False
        table = columns.reshape(rows, *shape)
        table.flags.writeable = False
        return table

    def older(self, dtype: int, start: int, *shape: int) -> NDArray[Any]:
        """An array that is stored row by row."""
        size = int(np.prod(shape)) if shape else 1
        return self.numbers.part(start, size).astype(_DTYPES[dtype], copy=False).reshape(shape)

    @functools.cached_property
    def bytes(self) -> bytes:
        """All bytes, one value after the other."""
        packed = self.packed()
        return lzma.decompress(packed) if packed else b""


class _Unfolded:
    """Restores omitted repetitions of numbers, part by part and on demand.

    `remaining` is a list, or an object sliced like one, without the `copies`; with them it has
    `size` numbers, without the `runs`. ValueError if they do not fit together.
    """

    def __init__(self, remaining: Any, copies: Index, size: int, runs: Index) -> None:
        target, source, length = copies.T
        sound = (length > 0).all() and (source >= 0).all() and (source + length <= target).all()
        if (
            not sound
            or (target[1:] < (target + length)[:-1]).any()
            or (target + length > size).any()
        ):
            raise ValueError("the repetitions in the data are damaged")
        if size - int(length.sum()) != len(remaining):
            raise ValueError("the data are cut short")
        run_positions, count = runs.T
        if (
            (run_positions < 0).any()
            or (run_positions >= size).any()
            or (np.diff(run_positions) <= 0).any()
            or (count < 1).any()
        ):
            raise ValueError("the runs in the data are damaged")
        self.rest = remaining
        added = np.cumsum(count - 1)  # numbers added by the runs up to each one
        self.runs, self.runs_end = runs.tolist(), (run_positions + 1 + added).tolist()
        self.added = [0, *added.tolist()]
        self.size = size + self.added[-1]
        self.copies, self.copies_end = copies.tolist(), (target + length).tolist()
        self.left_out = [0, *np.cumsum(length).tolist()]

    def part(self, start: int, size: int) -> Array:
        """The numbers (size,) from `start` on, without a copy if they are contiguous. ValueError
        beyond the end.
        """
        self._check(start, size)
        return _join(list(self._pieces(start, start + size)), size)

    def fill(self, start: int, column: NDArray[Any]) -> None:
        """Put the numbers from `start` on into (n,), which may be a column of an array. ValueError beyond the end."""
        self._check(start, len(column))
        end = 0
        for chunk, count in self._pieces(start, start + len(column)):
            column[end : end + count] = chunk
            end += count

    def _check(self, start: int, size: int) -> None:
        if start < 0 or start + size > self.size:
            raise ValueError("the data are cut short")

    def _pieces(self, start: int, end: int) -> Iterator[tuple[Array, int]]:
        """Stretches of numbers with how long they are, and for runs (1,) with how long it is."""
        k = bisect_right(self.runs_end, start)
        while start < end:
            position, count = self.runs[k] if k < len(self.runs) else (self.size, 0)
            run_start = position + self.added[k]  # of the run
            if start < run_start:
                stop = min(run_start, end)
                yield from self._stretches(start - self.added[k], stop - self.added[k])
            else:
                stop = min(run_start + count, end)
                ((number, _),) = self._stretches(position, position + 1)
                yield number, stop - start
                k += 1
            start = stop

    def _stretches(self, start: int, end: int) -> Iterator[tuple[Array, int]]:
        """Stretches, with their lengths, of numbers with one number per run. A copy may refer to
        earlier copies: only the requested numbers are followed to their origin.
        """
        waiting = [(start, end)]
        while waiting:
            start, end = waiting.pop()
            k = bisect_right(self.copies_end, start)
            target, source, length = self.copies[k] if k < len(self.copies) else (end, 0, 0)
            stop = min(end, target + length if start >= target else target)
            if stop < end:
                waiting.append((stop, end))
            if start < target:
                yield self.rest[start - self.left_out[k] : stop - self.left_out[k]], stop - start
            else:
                waiting.append((source + start - target, source + stop - target))


def _join(chunks: list[tuple[Array, int]], size: int) -> Array:
    if len(chunks) == 1 and len(chunks[0][0]) == size:
        return chunks[0][0]
    numbers, end = np.empty(size), 0
    for chunk, count in chunks:
        numbers[end : end + count] = chunk
        end += count
    numbers.flags.writeable = False
    return numbers


class _Unpacked:
    """The unpacked numbers, sliced like an array, of which only the requested part is read.

    ValueError or zlib.error for damaged pieces, at the latest when they are read.
    """

    def __init__(self, chunks: Sequence[bytes], size: int) -> None:
        if len(chunks) != -(-size // _PIECE):
            raise ValueError("the data are cut short")
        self.pieces, self.missing = chunks, [True] * len(chunks)
        self.numbers = np.empty(size)

    def __len__(self) -> int:
        return len(self.numbers)

    def __getitem__(self, selection: slice) -> Array:
        start, end, _ = selection.indices(len(self.numbers))
        for k in range(start // _PIECE, -(-end // _PIECE)):
            if self.missing[k]:
                _unpack(self.pieces[k], self.numbers[k * _PIECE : (k + 1) * _PIECE].view(np.int64))
                self.missing[k] = False
        values = self.numbers[start:end]
        values.flags.writeable = False  # parts may share it
        return values


def _unpack(chunk: bytes, bits: Integers) -> None:
    """Fill the bits of the numbers of a chunk."""
    planes = np.frombuffer(
        zlib.decompress(memoryview(chunk)[1:], bufsize=8 * len(bits)), dtype=np.uint8
    )
    if len(planes) != 8 * len(bits) or chunk[0] > _HIGHEST_ORDER:
        raise ValueError("the data are damaged")
    planes = planes.reshape(8, -1)
    folded = np.zeros(len(bits), dtype="<u8")
    byte_columns, used = folded.view(np.uint8).reshape(-1, 8), 8
    while used and not planes[used - 1].any():  # of small differences the higher bytes are 0
        used -= 1
    for k in range(used):
        byte_columns[:, k] = planes[k]
    differences = folded.astype(np.uint64, copy=False)
    sums = np.empty((len(bits), 2), dtype=np.int64)[
        :, 0
    ]  # numpy sums strided values in a fourth of the time
    np.negative((differences & _ONE).view(np.int64), out=sums)
    differences >>= _ONE
    sums ^= differences.view(np.int64)
    for _ in range(chunk[0]):
        np.add.accumulate(sums, out=sums)
    sign = np.right_shift(sums, 63, out=differences.view(np.int64))
    sign &= _ALL_BUT_SIGN
    np.bitwise_xor(sums, sign, out=bits)


def _bytes_of(floats: Array, length: int) -> bytes:
    integers = (
        floats[: -(-length // _BYTES_PER_FLOAT)]
        .astype("<f8", copy=False)
        .view(np.uint8)
        .reshape(-1, 8)
    )
    return np.ascontiguousarray(integers[:, :_BYTES_PER_FLOAT]).ravel()[:length].tobytes()


def _older_bytes(numbers: _Unfolded, length: int, start: int) -> bytes:
    """Bytes stored among the numbers, six to an integer."""
    integers = (
        numbers.part(start, -(-length // _OLDER_BYTES_PER_FLOAT))
        .astype("<u8")
        .view(np.uint8)
        .reshape(-1, 8)
    )
    return integers[:, :_OLDER_BYTES_PER_FLOAT].tobytes()[:length]


def _schema_of(name: str) -> str:
    """Return the schema of a former name, `.module:class`; only of results, so that opening a document calls nothing else."""
    if name not in SCHEMA_NAMES:
        raise ValueError(f"{name} is not a result")
    return SCHEMA_NAMES[name]
