# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measured points from files of measuring machines and scanners, with notes on their interpretation."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..geometry.job_files import read_content
from ..issues import NOTE, WARNING, InputError, Issue, Text, Word
from ..parameters.inspection import AUTO, UNITS
from ..types import Array, Mask

_PLY_TYPES = {
    "char": "i1",
    "int8": "i1",
    "uchar": "u1",
    "uint8": "u1",
    "short": "i2",
    "int16": "i2",
    "ushort": "u2",
    "uint16": "u2",
    "int": "i4",
    "int32": "i4",
    "uint": "u4",
    "uint32": "u4",
    "float": "f4",
    "float32": "f4",
    "double": "f8",
    "float64": "f8",
}
_STL_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])


def stl(data: bytes, where: str) -> Array:
    """Return the unique vertices of an STL file.

    Parameters
    ----------
    data : bytes
        Content of the file, text or binary.
    where : str
        Name of the file, for messages.

    Returns
    -------
    (n, 3) array
        Vertices in the unit of the file.

    Raises
    ------
    InputError
        BAD_FILE for coordinates that are not numbers.
    """
    count = int(np.frombuffer(data[80:84], dtype="<u4")[0]) if len(data) >= 84 else 0
    if len(data) == 84 + 50 * count:
        corners = np.frombuffer(data, dtype=_STL_TRIANGLE, offset=84)["corners"].reshape(-1, 3)
    else:
        corners = _numbers(re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data), where)
    points = corners.astype(np.float64)
    points = points[
        np.lexsort(points.T[::-1])
    ]  # same order as np.unique by rows, which would block other threads
    differs: Mask = np.ones(len(points), dtype=bool)
    differs[1:] = (points[1:] != points[:-1]).any(axis=1)
    unique: Array = points[differs]
    return unique


def obj(data: bytes, where: str) -> Array:
    """Return the vertices of an OBJ file.

    Parameters
    ----------
    data : bytes
        Content of the file.
    where : str
        Name of the file, for messages.

    Returns
    -------
    (n, 3) array
        Vertices in the unit of the file.

    Raises
    ------
    InputError
        BAD_FILE for coordinates that are not numbers.
    """
    return _numbers(re.findall(rb"^v[ \t]+(\S+)[ \t]+(\S+)[ \t]+(\S+)", data, re.MULTILINE), where)


def ply(data: bytes, where: str) -> Array:
    """Return the vertices of a PLY file, text or binary.

    Parameters
    ----------
    data : bytes
        Content of the file.
    where : str
        Name of the file, for messages.

    Returns
    -------
    (n, 3) array
        Vertices in the unit of the file.

    Raises
    ------
    InputError
        BAD_FILE for another format or a truncated file.
    """
    head, mark, body = data.partition(b"end_header")
    body = body.partition(b"\n")[2]
    lines = [line.split() for line in head.decode("latin-1").splitlines()]
    kind = next((line[1] for line in lines if line[:1] == ["format"] and len(line) > 1), "")
    element_lines = [number for number, line in enumerate(lines) if line[:1] == ["element"]]
    first_element = lines[element_lines[0]] if element_lines else []
    if (
        not mark
        or first_element[1:2] != ["vertex"]
        or not first_element[2:3]
        or not first_element[2].isdecimal()
    ):
        raise InputError(
            "BAD_FILE", where, "the file is not a PLY file with vertices first; export it again"
        )
    end = element_lines[1] if len(element_lines) > 1 else len(lines)
    fields = [line for line in lines[element_lines[0] + 1 : end] if line[:1] == ["property"]]
    names = [line[-1] for line in fields]
    if not {"x", "y", "z"} <= set(names) or any(line[1] not in _PLY_TYPES for line in fields):
        raise InputError(
            "BAD_FILE",
            where,
            "the vertices in the file lack plain x, y and z; export the file again",
        )
    count = int(first_element[2])
    if kind == "ascii":
        rows = [line.split() for line in body.splitlines()[:count]]
        columns = [names.index(axis) for axis in "xyz"]
        vertices = _numbers(
            [[row[k] for k in columns] for row in rows if len(row) >= len(names)], where
        )
    else:
        order = ">" if kind == "binary_big_endian" else "<"
        row = np.dtype(
            [(name, order + _PLY_TYPES[line[1]]) for name, line in zip(names, fields, strict=True)]
        )
        row_count = min(count, len(body) // row.itemsize)
        table = np.frombuffer(body, dtype=row, count=row_count)
        vertices = np.column_stack([table[axis].astype(np.float64) for axis in "xyz"])
    if len(vertices) < count:
        raise InputError(
            "BAD_FILE",
            where,
            "the file is truncated after {} of {} vertices; export it again",
            len(vertices),
            count,
        )
    return vertices


def _numbers(texts: list[list[bytes]], where: str) -> Array:
    try:
        return np.array(texts, dtype=np.float64).reshape(-1, 3)
    except ValueError:
        raise InputError(
            "BAD_FILE", where, "a vertex coordinate is not a number; export the file again"
        ) from None


TABLES, MESHES = (
    (".csv", ".txt", ".xyz", ".asc"),
    {".stl": stl, ".obj": obj, ".ply": ply},
)
MAX_POINTS = 200_000  # maximum number of points kept, evenly selected
MAX_FILE_MB = 1000  # MB
SAMPLE_ROWS = 200  # number of rows that decide the separators of a table
HEAD = 10_000  # bytes; start of a mesh file that is searched for a unit
LONGEST_REMARK = 60  # maximum number of characters of a remark in a message
_MARKS = ("#", "//", "%", "!", "'", '"#')
_SIGNS = ((";", "."), (";", ","), ("\t", "."), ("\t", ","), (",", "."), (None, "."), (None, ","))
_NAMES = {None: "blanks", ";": "semicolons", "\t": "tabs", ",": "commas"}
_UNIT = re.compile(
    r"(?<![a-z])(mm|cm|m|um|µm|μm|inch|inches|in|millimet(?:er|re)s?|met(?:er|re)s?)(?![a-z])"
)
_OTHER_UNIT = re.compile(
    r"(?<![a-z])(ft|feet|foot|mils?|thou|yd|yards?|nm|km|dm|px|pixels?|pt)(?![a-z])"
)
_UNIT_NAMES = {"in": "inch", "inches": "inch", "µm": "um", "μm": "um"}


@dataclass(frozen=True, eq=False)
class Measured:
    """Measured points (n, 3) in measuring coordinates, mm.

    label: file name. issues: notes on the interpretation of the file.
    """

    points: Array
    label: str
    issues: tuple[Issue, ...]


def read(path: str | Path, unit: str = AUTO) -> Measured:
    """Read the points of a CSV, TXT, XYZ or ASC table, or the vertices of an STL, OBJ or PLY mesh.

    unit: unit of the coordinates; `auto` takes the unit stated in the file, else mm.

    Raises InputError NO_FILE, EMPTY_FILE, UNSUPPORTED_FILE, BAD_FILE, NO_POINTS, AMBIGUOUS.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in (*TABLES, *MESHES):
        suffixes = ", ".join((*TABLES, *MESHES))
        raise InputError(
            "UNSUPPORTED_FILE",
            file.name,
            "{} is not a supported point format; use {}",
            suffix or "no extension",
            suffixes,
        )
    try:
        data = read_content(file, MAX_FILE_MB, "BAD_FILE", file.name)
    except (OSError, ValueError) as error:
        why = (getattr(error, "strerror", None) or str(error)).lower()
        raise InputError(
            "NO_FILE", str(path), "the measured points cannot be read ({}); check the path", why
        ) from None
    return parse(data, file.name, unit)


def parse(data: bytes, label: str, unit: str = AUTO) -> Measured:
    """Parse measured points from the content of a file.

    Parameters
    ----------
    data : bytes
        Content of the file.
    label : str
        Name of the file; its suffix decides the format.
    unit : str, optional
        Unit of the coordinates; AUTO takes the unit stated in the file, else mm.

    Returns
    -------
    Measured
        Points in mm, with a note on the interpretation.

    Raises
    ------
    InputError
        EMPTY_FILE, NO_POINTS, BAD_FILE, BAD_UNIT.
    """
    if not data.strip():
        raise InputError("EMPTY_FILE", label, "the file is empty; export the points again")
    suffix = Path(label).suffix.lower()
    if suffix in MESHES:
        points = MESHES[suffix](data, label)
        messages = ["the vertices of a mesh are taken as points"]
        named = _unit_of_remarks(_remarks_of_mesh(data, suffix), label) if unit == AUTO else ""
    else:
        points, messages, named = _table(_text(data), label)
    level = NOTE
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        messages.append(
            Text("{} points without finite coordinates are ignored", int((~finite).sum()))
        )
        points, level = points[finite], WARNING
    if not len(points):
        raise InputError("NO_POINTS", label, "the file has no points; give rows of x y z")
    unit_name = unit if unit != AUTO else named or "mm"
    messages.append(
        Text(
            "coordinates in {}{}",
            unit_name,
            Word("" if unit != AUTO or named else ", as the file names no unit"),
        )
    )
    if len(points) > MAX_POINTS:
        messages.append(
            Text("of {} points, {} evenly distributed ones are used", len(points), MAX_POINTS)
        )
        points = points[np.linspace(0, len(points) - 1, MAX_POINTS).astype(np.intp)]
    return Measured(
        points * UNITS[unit_name],
        label,
        (Issue(level, "POINTS_READ", Text("{}: {}", label, Text.joined("; ", messages))),),
    )


def _text(data: bytes) -> str:
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return data.decode("utf-16", "replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _table(text: str, label: str) -> tuple[Array, list[str], str]:
    """Parse a table; return points (n, 3) in its unit, notes on the interpretation, and the stated unit or ''."""
    lines = [line.strip() for line in text.splitlines()]
    remarks = [line for line in lines if line.startswith(_MARKS)]
    rows = [
        (number, line)
        for number, line in enumerate(lines, 1)
        if line and not line.startswith(_MARKS)
    ]
    delimiter, comma = _signs([line for _, line in rows], label)
    cells = [(number, _cells(line, delimiter)) for number, line in rows]
    is_row = [sum(_is_number(cell, comma) for cell in row) >= 3 for _, row in cells]
    first_row = is_row.index(True)
    heads = [row for _, row in cells[:first_row]]
    width = len(cells[first_row][1])
    columns, named, messages = _columns(heads, cells[first_row:][:SAMPLE_ROWS], width, comma, label)
    messages.insert(
        0, f"columns between {_NAMES[delimiter]}" + (", decimal commas" if comma == "," else "")
    )
    points, bad = [], []
    for number, row in cells[first_row:]:
        picked = [row[k] for k in columns if k < len(row)]
        if len(picked) == 3 and all(_is_number(cell, comma) for cell in picked):
            points.append(
                [float(cell.replace(",", ".")) if comma == "," else float(cell) for cell in picked]
            )
        else:
            bad.append(number)
    if len(bad) > len(points):
        raise InputError(
            "BAD_FILE",
            f"{label} line {bad[0]}",
            "like most lines, this line is not a point; give rows of x y z",
        )
    if bad:
        messages.append(
            f"{len(bad)} lines that are not points are ignored, the first in line {bad[0]}"
        )
    _check_widths(cells[first_row:], width, delimiter, label)
    texts = [
        *named,
        *(" ".join(head) for head in heads if "unit" in " ".join(head).lower()),
        *(remark for remark in remarks if "unit" in remark.lower()),
    ]
    unit = _unit_of_remarks(texts, label)
    return np.array(points).reshape(-1, 3), messages, unit


def _unit_of_remarks(texts: list[str], label: str) -> str:
    """Return the unit stated in remarks or headings, or ''. Raises InputError BAD_UNIT for unsupported units."""
    unit = next((name for name in map(_unit_in, texts) if name), "")
    for text in texts:
        if not unit and _OTHER_UNIT.search(text.lower().replace("_", " ")) is not None:
            raise InputError(
                "BAD_UNIT",
                label,
                "the unit in {!r} is not supported; use mm, cm, m, um or inch",
                text[:LONGEST_REMARK],
            )
    return unit


def _remarks_of_mesh(data: bytes, suffix: str) -> list[str]:
    """Return the header lines of a PLY file, or remarks of an OBJ file, that mention a unit."""
    marks: tuple[str, ...]
    if suffix == ".ply":
        head, marks = data[: max(data.find(b"end_header"), 0)], ("comment", "obj_info")
    elif suffix == ".obj":
        head, marks = data[:HEAD], ("#",)
    else:
        return []
    lines = [line.strip() for line in head.decode("latin-1").splitlines()]
    return [line for line in lines if line.startswith(marks) and "unit" in line.lower()]


def _check_widths(
    rows: list[tuple[int, list[str]]], width: int, delimiter: str | None, label: str
) -> None:
    """Raise InputError BAD_FILE for a row with more cells than the first row.

    Its commas may be decimal separators.
    """
    if delimiter != ",":
        return
    for number, row in rows:
        if len([cell for cell in row if cell]) > width:
            raise InputError(
                "BAD_FILE",
                f"{label} line {number}",
                "the row has {} values, the first {}, so commas may be decimal separators too; "
                "export the file with decimal points",
                len(row),
                width,
            )


def _signs(lines: list[str], label: str) -> tuple[str | None, str]:
    """Detect the column separator, None for blanks, and the decimal separator.

    The pair with the most numeric rows wins.
    """
    tail = lines[max(0, len(lines) - SAMPLE_ROWS) :]
    scores = []
    for delimiter, comma in _SIGNS:
        rows = [_cells(line, delimiter) for line in tail]
        counts = [sum(_is_number(cell, comma) for cell in row) for row in rows]
        scores.append(sum(count >= 3 for count in counts))
    best = int(np.argmax(scores))
    if not lines or scores[best] == 0:
        raise InputError("NO_POINTS", label, "no line contains three numbers; give rows of x y z")
    delimiter, comma = _SIGNS[best]
    if delimiter == ",":
        rows = [_cells(line, delimiter) for line in tail]
        only_integers = all(re.fullmatch(r"[-+]?\d+", cell) for row in rows for cell in row)
        if only_integers and all(len(row) >= 6 and len(row) % 2 == 0 for row in rows):
            raise InputError(
                "AMBIGUOUS",
                label,
                "commas separate both columns and decimals; export the file with decimal points, "
                "or with semicolons between columns",
            )
    return delimiter, comma


def _cells(line: str, delimiter: str | None) -> list[str]:
    return [cell.strip().strip('"') for cell in line.split(delimiter)]


def _is_number(cell: str, comma: str) -> bool:
    if comma == ",":
        if "." in cell:
            return False
        cell = cell.replace(",", ".")
    try:
        float(cell)
    except ValueError:
        return False
    return "_" not in cell


def _columns(
    heads: list[list[str]],
    rows: list[tuple[int, list[str]]],
    width: int,
    comma: str,
    label: str,
) -> tuple[list[int], list[str], list[str]]:
    """Return the columns of x, y and z, their headings, and notes on the choice."""
    for head in reversed(heads):
        plain = [re.sub(r"[^a-z].*", "", cell.strip().lower()) for cell in head]
        if len(head) == width and {"x", "y", "z"} <= set(plain):
            twice = next((axis for axis in "xyz" if plain.count(axis) > 1), None)
            if twice is not None:
                raise InputError(
                    "AMBIGUOUS",
                    label,
                    "several columns are called {}: {}; keep only the measured column",
                    twice,
                    ", ".join(cell for cell, name in zip(head, plain) if name == twice),
                )
            columns = [plain.index(axis) for axis in "xyz"]
            _check_units([head[k] for k in columns], label)
            surplus = width - 3
            messages = ["x, y and z by their headings"] + (
                [f"{surplus} more columns not used"] if surplus else []
            )
            return columns, [head[k] for k in columns], messages
    for head in heads[-1:]:
        names = [cell.lower() for cell in head]
        if len(head) == width and all(map(_is_name, names)) and not _are_of_points(names):
            raise InputError(
                "AMBIGUOUS",
                label,
                "the columns are called {}; name the coordinates x, y and z",
                ", ".join(head),
            )
    full_rows = [row for _, row in rows if len(row) == width]
    columns = [k for k in range(width) if all(_is_number(row[k], comma) for row in full_rows)]
    messages = []
    if len(columns) > 3 and _running([row[columns[0]] for row in full_rows]):
        columns, messages = columns[1:], ["the first column is a running number"]
    if len(columns) > 3:
        messages.append(
            f"x, y and z are the first three columns{' of the others' if messages else ''}"
        )
    return columns[:3], [], messages


def _is_name(cell: str) -> bool:
    """Whether a heading is a name rather than a number or remark."""
    return re.fullmatch(r"[^\W\d][\w .:/()\[\]°µ-]*", cell) is not None


def _are_of_points(names: list[str]) -> bool:
    """Whether headings are ParaView's points:0 to points:2, in this order."""
    numbered = [name[-1] for name in names if re.fullmatch(r"points?[:_ ][012]", name)]
    return numbered == ["0", "1", "2"]


def _check_units(names: list[str], label: str) -> None:
    """Raise InputError BAD_UNIT for an unsupported unit or for different units."""
    for name in names:
        bracket = re.search(r"\[(.*)\]", name)
        is_unknown = bracket is not None and bool(bracket[1].strip()) and not _unit_in(bracket[1])
        if is_unknown or _OTHER_UNIT.search(name.lower().replace("_", " ")) is not None:
            raise InputError(
                "BAD_UNIT",
                label,
                "the unit of the column {!r} is not supported; use mm, cm, m, um or inch",
                name,
            )
    units = {_unit_in(name) for name in names} - {""}
    if len(units) > 1:
        raise InputError(
            "BAD_UNIT",
            label,
            "the columns have different units: {}; export all columns in one unit",
            ", ".join(names),
        )


def _running(cells: list[str]) -> bool:
    """Whether the cells count up by one."""
    if len(cells) < 2 or not all(cell.isdecimal() for cell in cells):
        return False
    return bool((np.diff([int(cell) for cell in cells]) == 1).all())


def _unit_in(text: str) -> str:
    """Return the unit stated in a heading or remark, or ''."""
    names = _UNIT.findall(text.lower().replace("_", " "))
    if not names:
        return ""
    name = next((one for one in names if one != "in"), "in")  # as in "unit: exported in mm"
    if name.startswith("millim"):
        return "mm"
    return "m" if name.startswith("met") else _UNIT_NAMES.get(name, name)
