# SPDX-License-Identifier: LGPL-2.1-or-later
"""Reads the files of VAL 3 applications: statements of programs, values of data, paths of libraries. No motion yet."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...core.issues import InputError, Text
from ...core.types import Array

_NAMESPACE = "{http://www.staubli.com/robotics/VAL3/"
PROJECT, DATA, PROGRAM = (
    _NAMESPACE + space + "}" for space in ("Project/3", "Data/2", "Program/2")
)
AXES = ("j1", "j2", "j3", "j4", "j5", "j6")
POSE = ("x", "y", "z", "rx", "ry", "rz")
_PLAIN = re.compile(r"(?:-?[0-9]+(?:\.[0-9]+)? )*")
_LAYER = re.compile(r"// layer \d+$")
_DECIMALS = re.compile(r"\.([0-9]+) ")


@dataclass(frozen=True)
class Data:
    """One array of an application: its type and the attributes of its values, by index."""

    kind: str
    values: tuple[dict[str, str], ...]


@dataclass(frozen=True)
class Application:
    """A folder with a project: its programs' statements with their line numbers, its data and its libraries' paths."""

    folder: str
    programs: dict[str, list[tuple[int, str]]]
    data: dict[str, Data]
    libraries: dict[str, str]


def applications(files: dict[str, bytes]) -> dict[str, Application]:
    """The applications by folder. Raises InputError UNREADABLE_PROGRAM."""
    projects = [file for file in sorted(files) if file.endswith(".pjx")]
    by_folder = {_folder(file): _application(file, files) for file in projects}
    listed = sum(1 + len(by_folder[folder].programs) for folder in by_folder) + len(projects)
    if len(by_folder) < len(projects) or listed != len(files):
        raise unreadable("program", "there are files that belong to no project, or to two")
    return by_folder


def _folder(file: str) -> str:
    return file.rpartition("/")[0]


def _application(file: str, files: dict[str, bytes]) -> Application:
    folder, root = _folder(file), _parsed(file, files)
    parameters = root.find(f"{PROJECT}Parameters")
    if (
        root.tag != f"{PROJECT}Project"
        or parameters is None
        or parameters.get("millimeterUnit") != "true"
    ):
        raise unreadable(file, "it is not a project in millimetres")
    programs = {}
    for element in root.iterfind(f"{PROJECT}Programs/{PROJECT}Program"):
        name = str(element.get("file")).removesuffix(".pgx")
        programs[name] = _statements(name, f"{folder}/{name}.pgx", files)
    (data,) = [
        str(element.get("file")) for element in root.iterfind(f"{PROJECT}Database/{PROJECT}Data")
    ] or [""]
    libraries = {
        str(element.get("alias")): str(element.get("path"))
        for element in root.iterfind(f"{PROJECT}Libraries/{PROJECT}Library")
    }
    return Application(folder, programs, _data(f"{folder}/{data}", files), libraries)


def _parsed(file: str, files: dict[str, bytes]) -> ElementTree.Element:
    if file not in files:
        raise unreadable(file, "the file is missing")
    if b"\0" in files[file]:  # UTF-16, in which the next would not be seen
        raise unreadable(file, "it is not text in UTF-8")
    if b"<!DOCTYPE" in files[file]:
        raise unreadable(file, "it declares a document type, which no controller writes")
    try:
        return ElementTree.fromstring(files[file])
    except ElementTree.ParseError as error:
        raise unreadable(file, Text("it is not well-formed XML ({})", error)) from None


def _statements(name: str, file: str, files: dict[str, bytes]) -> list[tuple[int, str]]:
    program = _parsed(file, files).find(f"{PROGRAM}Program")
    code = None if program is None else program.findtext(f"{PROGRAM}Code")
    if program is None or code is None or program.get("name") != name:
        raise unreadable(file, Text("it does not contain the code of a program {}", name))
    lines = [(number, line.strip()) for number, line in enumerate(code.split("\n"), 1)]
    lines = [
        (number, line)
        for number, line in lines
        if line and (not line.startswith("//") or _LAYER.match(line))
    ]
    if len(lines) < 2 or lines[0][1] != "begin" or lines[-1][1] != "end":
        raise unreadable(file, "its code does not run from begin to end")
    return lines[1:-1]


def _data(file: str, files: dict[str, bytes]) -> dict[str, Data]:
    data: dict[str, Data] = {}
    for element in _parsed(file, files).iterfind(f"{DATA}Datas/{DATA}Data"):
        name, values = (
            str(element.get("name")),
            [dict(value.attrib) for value in element.iterfind(f"{DATA}Value")],
        )
        keys = [value.pop("key", "") for value in values]
        if (
            name in data
            or keys != [str(key) for key in range(len(values))]
            or element.get("size") != str(len(values))
        ):
            raise unreadable(
                file, Text("the values of {} do not run from 0 to its size, each once", name)
            )
        data[name] = Data(str(element.get("type")), tuple(values))
    return data


def numbers(data: Data, names: Sequence[str], where: str) -> tuple[Array, float]:
    """Return attributes of values as numbers.

    Parameters
    ----------
    data : Data
        The values.
    names : sequence of str
        Names of the attributes; absent ones are 0.
    where : str
        Position of the data, for messages.

    Returns
    -------
    values : (n, names) array
        The numbers.
    digits : float
        Half of the last digit written.

    Raises
    ------
    InputError
        UNREADABLE_PROGRAM for a value that is not a plain number.
    """
    texts = [value.get(name, "0") for value in data.values for name in names]
    together = " ".join(texts) + " "
    if texts and not _PLAIN.fullmatch(together):
        raise unreadable(where, "a value is not a plain number")
    decimals = max(map(len, _DECIMALS.findall(together)), default=0)
    return np.array(texts, dtype=np.float64).reshape(-1, len(names)), 0.5 * 10.0**-decimals


def rotations(degrees: Array) -> Array:
    """Return the rotations Rx Ry Rz.

    Parameters
    ----------
    degrees : (n, 3) array
        RX, RY, RZ in degrees.

    Returns
    -------
    (n, 3, 3) array
        Rotations.
    """
    cx, cy, cz = np.cos(np.radians(degrees)).T
    sx, sy, sz = np.sin(np.radians(degrees)).T
    rows = (
        (cy * cz, -cy * sz, sy),
        (cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy),
        (sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy),
    )
    return np.moveaxis(np.array(rows), -1, 0)


def poses(values: Array) -> Array:
    """Return poses of six numbers each.

    Parameters
    ----------
    values : (n, 6) array
        x y z in mm, rx ry rz in degrees.

    Returns
    -------
    (n, 4, 4) array
        Poses, mm.
    """
    result = np.zeros((len(values), 4, 4))
    result[:, :3, :3], result[:, :3, 3], result[:, 3, 3] = (
        rotations(values[:, 3:]),
        values[:, :3],
        1.0,
    )
    return result


def unreadable(where: str, why: str) -> InputError:
    """The error for text that is not understood."""
    return InputError("UNREADABLE_PROGRAM", where, "{}; write the program again", why)
