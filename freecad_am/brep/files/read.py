# SPDX-License-Identifier: LGPL-2.1-or-later
"""Read shapes from files, without a document; check STL files."""

from __future__ import annotations

import os
import struct
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import FreeCAD  # before Part, which crashes the process without
import Mesh
import numpy as np
import Part

from ...core.geometry.job_files import locate
from ...core.geometry.mesh.file_unit import HEAD, MESHES, unit_issues
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array, Index, Integers
from . import sandbox
from .sandbox import read_in_sandbox

STEP, IGES = (".step", ".stp"), (".iges", ".igs")
READABLE = (*STEP, *IGES, ".brep", ".brp")
# mm; a larger part has a damaged coordinate, on which the kernel hangs
MAX_COORDINATE_MM = 1e7


class FileContent(NamedTuple):
    """The content of a file.

    shape: the Part.Shape or Mesh.Mesh of the file. issues: notes on ignored content.
    """

    shape: Any
    issues: tuple[Issue, ...]


def read_shape(path: str | os.PathLike[str]) -> Any:
    """Return the Part.Shape of a STEP, IGES or BREP file, as `shape_content`."""
    return shape_content(path).shape


def shape_content(path: str | os.PathLike[str]) -> FileContent:
    """Read the Part.Shape of a STEP, IGES or BREP file, in the file's coordinates, mm.

    Raises InputError 'NO_FILE', 'EMPTY_FILE', 'UNSUPPORTED_FILE' or 'BAD_FILE' naming the file.
    """
    file = locate(path)
    where = file.name or str(path)
    suffix = file.suffix.lower()
    if not file.exists():
        raise InputError("NO_FILE", where, "the file does not exist; check its name and folder")
    if not file.is_file():
        raise InputError("NO_FILE", where, "the path is a folder; choose the file of the part")
    if suffix in MESHES:
        raise InputError(
            "UNSUPPORTED_FILE",
            where,
            "a mesh has no exact surfaces; export the part of revolution as STEP, IGES or BREP",
        )
    if suffix not in READABLE:
        raise InputError(
            "UNSUPPORTED_FILE",
            where,
            "{} files are not supported; use {}",
            suffix or "no extension",
            ", ".join((*READABLE, *MESHES)),
        )
    try:
        size = file.stat().st_size
        with file.open("rb") as stream:
            stream.read(1)
    except OSError as error:
        raise InputError(
            "BAD_FILE", where, "the file cannot be read: {}; choose another file", error.strerror
        ) from error
    if size == 0:
        raise InputError("EMPTY_FILE", where, "the file is empty; export the part again")
    return FileContent(*sandbox.read_in_sandbox(_shape, file, where))


def read_mesh(path: str | os.PathLike[str], scale: float = 1.0) -> Any:
    """Return the Mesh.Mesh of an STL, OBJ or 3MF file, as `mesh_content`."""
    return mesh_content(path, scale).shape


def mesh_content(path: str | os.PathLike[str], scale: float = 1.0) -> FileContent:
    """Read the Mesh.Mesh of an STL, OBJ or 3MF file, in the file's coordinates, mm.

    scale: mm of one unit of an STL or OBJ file, which states no unit; a 3MF file states its unit.
    Raises the InputErrors of `read_shape`.
    """
    file = locate(path)
    where = file.name or str(path)
    if not file.is_file():
        raise InputError("NO_FILE", where, "the file does not exist; check its name and folder")
    if file.stat().st_size == 0:
        raise InputError("EMPTY_FILE", where, "the file is empty; export the part again")
    return FileContent(*sandbox.read_in_sandbox(_mesh, file, where, scale))


def placed_mesh(mesh: Any, matrix: Any) -> Any:
    """Return a copy of a Mesh.Mesh without a placement, moved by its placement and then by a
    matrix.
    """
    copy = Mesh.Mesh()
    copy.addFacets(mesh.Topology)
    copy.transform(matrix)
    return copy


def _mesh(file: Path, where: str, scale: float) -> tuple[Any, tuple[Issue, ...]]:
    from . import obj_mesh, three_mf  # few parts are meshes

    mesh = Mesh.Mesh()
    issues: tuple[Issue, ...] = ()
    if file.suffix.lower() == ".3mf":
        points, corners, issues = three_mf.content(file)
        _refuse_far(float(np.abs(points).max()), where)
        _add_triangles(mesh, points, corners)
        return mesh, issues
    if file.suffix.lower() == ".obj":
        obj = obj_mesh.ObjMesh(file, where)
        issues = obj.issues()
        _add_triangles(mesh, obj.points, obj.corners)
        if obj.is_mixed:
            mesh.removeDuplicatedPoints()
    else:
        corners, issues = stl_triangles(file, where)
        _read_stl(mesh, file, corners)
    if not mesh.CountFacets:
        raise InputError(
            "EMPTY_FILE", where, "the file contains no triangles; export the part again"
        )
    with file.open("rb") as stream:
        issues += unit_issues(stream.read(HEAD), file.suffix.lower(), scale, where)
    _refuse_far(_reach(mesh.BoundBox) * scale, where)
    if scale != 1.0:
        larger = FreeCAD.Matrix()
        larger.scale(scale, scale, scale)
        mesh.transform(larger)
    return mesh, issues


def _read_stl(mesh: Any, file: Path, corners: Array) -> None:
    """Read an STL file with FreeCAD, or from its triangles (m, 3, 3) if FreeCAD reads a different
    number.
    """
    with suppress(Exception), _quiet():
        mesh.read(str(file))
    if mesh.CountFacets != len(corners):
        mesh.clear()
        mesh.addFacets([[FreeCAD.Vector(*corner) for corner in row] for row in corners.tolist()])
        mesh.removeDuplicatedPoints()


def _add_triangles(mesh: Any, points: Array, corners: Index) -> None:
    mesh.addFacets(
        (
            [FreeCAD.Vector(*point) for point in points.tolist()],
            [tuple(row) for row in corners.tolist()],
        )
    )


def _shape(file: Path, where: str) -> tuple[Any, tuple[Issue, ...]]:
    from .step_content import StepContent, refuse_iges

    issues: list[Issue] = []
    step = None
    if file.suffix.lower() in STEP:
        step = StepContent(file, where)
        step.refuse_unread()
        if step.is_whole and not step.has_geometry:
            raise InputError(
                "EMPTY_FILE",
                where,
                "the file contains no shape, only product data or annotations; export the part "
                "again",
            )
    elif file.suffix.lower() in IGES:
        issues += refuse_iges(file, where)
    shape = _read_shape(file, where)
    _refuse_bare(shape, where)
    if step is not None:
        issues += step.compare(shape)
    _refuse_far(_reach(shape.BoundBox), where)
    return shape, tuple(issues)


def _read_shape(file: Path, where: str) -> Any:
    bad = InputError(
        "BAD_FILE",
        where,
        "the file is damaged, or its extension does not match its content; export the part again",
    )
    shape = Part.Shape()
    try:
        with _quiet():
            shape.read(str(file))
    except (RuntimeError, OSError, ValueError, Part.OCCError) as error:
        raise bad from error
    if shape.isNull():
        raise bad
    if not (shape.Faces or shape.Edges):
        raise InputError("EMPTY_FILE", where, "the file contains no shape; export the part again")
    return shape


def _refuse_bare(shape: Any, where: str) -> None:
    """Raise InputError UNSUPPORTED_FILE if a face has triangles but no surface."""
    bare = sum(not _has_surface(face) for face in shape.Faces)
    if bare:
        raise InputError(
            "UNSUPPORTED_FILE",
            where,
            "{} of {} faces have no surfaces, only triangles; export exact faces, or a mesh "
            "(STL, OBJ, 3MF)",
            bare,
            len(shape.Faces),
        )


def _has_surface(face: Any) -> bool:
    try:
        return face.Surface is not None
    except (TypeError, RuntimeError, AttributeError, Part.OCCError):
        return False


def _reach(box: Any) -> float:
    """Return the largest absolute coordinate of a box, nan if a coordinate is nan."""
    return float(np.abs([box.XMin, box.XMax, box.YMin, box.YMax, box.ZMin, box.ZMax]).max())


def _refuse_far(reach: float, where: str) -> None:
    if not reach <= MAX_COORDINATE_MM:
        raise InputError(
            "BAD_FILE",
            where,
            "the part extends to {:.3g} mm, beyond the limit of {:.3g} mm, so a coordinate is "
            "damaged or the unit is wrong; export the part again",
            reach,
            MAX_COORDINATE_MM,
        )


@contextmanager
def _quiet() -> Iterator[None]:
    """Redirect what the geometry kernel prints from standard output to standard error."""
    sys.stdout.flush()
    stdout_copy = os.dup(1)
    try:
        os.dup2(2, 1)
        yield
    finally:
        os.dup2(stdout_copy, 1)
        os.close(stdout_copy)


# how far triangles may be off a shape's surface, as a share of its size
FINENESS = 2e-3


def triangles(path: Path) -> tuple[Array, Integers]:
    """Return points (n, 3) in the file's units and triangles (m, 3) of a mesh or a shape;
    read-only.

    A file is read again only if it has changed. Raises InputError 'NO_FILE', 'EMPTY_FILE',
    'UNSUPPORTED_FILE' or 'BAD_FILE' naming the file.
    """
    path = locate(path)
    try:
        now = path.stat()
    except OSError:
        return _triangles(path)  # raises the reason
    return _known(path, now.st_mtime_ns, now.st_size)


@lru_cache(maxsize=64)
def _known(path: Path, changed: int, size: int) -> tuple[Array, Integers]:
    arrays = read_in_sandbox(_triangles, path)
    for array in arrays:
        array.flags.writeable = False
    return arrays


def _triangles(path: Path) -> tuple[Array, Integers]:
    if path.suffix.lower() in MESHES:
        points, corners = read_mesh(path).Topology
    else:
        shape = read_shape(path)
        points, corners = shape.tessellate(max(FINENESS * shape.BoundBox.DiagonalLength, 1e-3))
    return np.array([(p.x, p.y, p.z) for p in points], dtype=float), np.array(
        corners, dtype=np.int64
    ).reshape(-1, 3)


# ---- The triangles of an STL file, all accounted for
#
# FreeCAD's own reader drops triangles with a number that it cannot read, anything after the last
# one, and the rest of a truncated file, without a message.

CONTENT = "FILE_CONTENT"
HEADER_BYTES, RECORD = 84, 50  # bytes of the head of a binary file, and of a triangle
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
COMMENTS = ("#", ";", "//")
BETWEEN = ("outer", "endfacet", "end", "color")


def stl_triangles(file: Path, where: str) -> tuple[Array, tuple[Issue, ...]]:
    """Return the corners (m, 3, 3) of the triangles of all solids in an STL file, and a note on
    bytes after them.

    Raises InputError BAD_FILE if the file is truncated or contains other data.
    """
    data = file.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= HEADER_BYTES else -1
    is_binary = count >= 0 and (len(data) == HEADER_BYTES + RECORD * count or not _is_text(data))
    corners, issues = _binary(data, count, where) if is_binary else (_ascii(data, where), ())
    if not np.isfinite(corners).all():
        raise InputError(
            "BAD_FILE", where, "a vertex of a triangle is not a number; export the part again"
        )
    return corners, issues


def _is_text(data: bytes) -> bool:
    """Whether a file that is not a valid binary STL is text."""
    head = data[:4096].removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    return b"\0" not in head and (head.startswith((b"solid", b"#", b"//")) or b"facet" in head)


def _binary(data: bytes, count: int, where: str) -> tuple[Array, tuple[Issue, ...]]:
    available = (len(data) - HEADER_BYTES) // RECORD
    if available < count:
        raise InputError(
            "BAD_FILE",
            where,
            "the file is truncated, or is not an STL file: its header announces {:,} triangles, "
            "but its size fits {:,}; export the part again",
            count,
            available,
        )
    trailing = data[HEADER_BYTES + RECORD * count :]
    if len(trailing.strip(b"\0 \t\r\n")) >= RECORD:
        raise InputError(
            "BAD_FILE",
            where,
            "{:,} bytes follow the {:,} triangles, and may be more triangles; export the part "
            "again, as one solid",
            len(trailing),
            count,
        )
    issues: tuple[Issue, ...] = ()
    if trailing.strip(b"\0 \t\r\n"):
        message = Text("{}: {} bytes after the triangles are ignored", where, len(trailing))
        issues = (Issue(NOTE, CONTENT, message),)
    records = np.frombuffer(data, TRIANGLE, count, HEADER_BYTES)
    return records["corners"].astype(np.float64), issues


def _ascii(data: bytes, where: str) -> Array:
    corners: list[tuple[float, float, float]] = []
    in_loop = -1  # corners of the current loop, -1 outside loops
    is_open = False  # a solid
    for number, line in enumerate(data.decode("latin-1").splitlines(), start=1):
        words = line.split()
        key = words[0].lower() if words else ""
        if not key or key.startswith(COMMENTS):
            continue
        if key == "vertex" and in_loop >= 0:
            corners.append(_corner(words, number, line, where))
            in_loop += 1
        elif key.startswith("facet") and is_open and in_loop < 0:
            in_loop = 0
        elif key == "endloop" and in_loop == 3:
            in_loop = -1
        elif key.removeprefix("ï»¿") == "solid" and in_loop < 0:
            is_open = True
        elif key.startswith("endsolid") and in_loop < 0:
            is_open = False
        elif key not in BETWEEN:
            raise _bad_line(number, line, where)
    if is_open or in_loop >= 0:
        raise InputError(
            "BAD_FILE",
            where,
            "the file is truncated: the last solid has no end; export the part again",
        )
    return np.array(corners, dtype=np.float64).reshape(-1, 3, 3)


def _corner(words: list[str], number: int, line: str, where: str) -> tuple[float, float, float]:
    try:
        if len(words) != 4 or "_" in line:
            raise ValueError
        x, y, z = (float(word) for word in words[1:])
    except ValueError:
        raise _bad_line(number, line, where) from None
    return x, y, z


def _bad_line(number: int, line: str, where: str) -> InputError:
    return InputError(
        "BAD_FILE",
        where,
        "line {} cannot be read: {!r}; export the part again",
        number,
        line.strip()[:60],
    )
