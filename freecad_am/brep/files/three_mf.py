# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a 3MF file, which FreeCAD reads since 0.21 only (decision 0011).

3MF core specification 1.3: a zip with an XML model of objects - a mesh, or components: other objects, moved - and of
what is to be built, items: objects, moved. The production extension puts objects into further files of the zip.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

import numpy as np

from freecad_am.core.types import Array, Index

from ...core.issues import InputError, Text, Word

UNITS = {
    "micron": 0.001,
    "millimeter": 1.0,
    "centimeter": 10.0,
    "inch": 25.4,
    "foot": 304.8,
    "meter": 1000.0,
}
MODEL = "3D/3dmodel.model"  # where it is when the zip does not say
MODEL_RELATION = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
# extensions that change nothing of a mesh's shape, or whose part we read
KNOWN = (
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
)
NOT_DEPOSITED = ("support", "other")  # types of objects that are not part
LARGEST = 1 << 29  # bytes of a file of the zip, unpacked
MAX_TRIANGLES = 20_000_000  # triangles of all items together
MOST_PLACED, DEEPEST = 100_000, 100  # objects of all items together, and one inside the other
CHUNK = 1 << 20
LONGEST = 4 << 20  # bytes of one element

Key = tuple[str, int]  # file of the zip, id


@dataclass
class _Object:
    kind: str = "model"
    points: list[tuple[float, float, float]] = field(default_factory=list)
    triangles: list[tuple[int, int, int]] = field(default_factory=list)
    parts: list[tuple[Key, Array]] = field(default_factory=list)


def triangles(path: Path) -> tuple[Array, Index]:
    """Points (n, 3) mm and corners (m, 3) of all that a 3MF file builds, pieces apart, mirrored ones outside out.

    Supports, and items that are not to be printed, are left out. InputError BAD_FILE, EMPTY_FILE, UNSUPPORTED_FILE.
    """
    where = path.name
    try:
        with zipfile.ZipFile(path) as archive:
            return _Package(archive, where).built()
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError) as error:
        raise _bad(where, Text("it is not a sound zip file ({})", error)) from None
    except expat.ExpatError as error:
        raise _bad(where, Text("its XML is damaged ({})", error)) from None
    except OverflowError:
        raise _bad(
            where, "a triangle in it has a point with a number of more than 64 bits"
        ) from None


class _Package:
    def __init__(self, archive: zipfile.ZipFile, where: str) -> None:
        self.archive, self.where = archive, where
        self.objects: dict[Key, _Object] = {}
        self.items: list[tuple[Key, Array]] = []
        self.read: dict[str, float] = {}  # files read, and their units in mm
        self.count = self.placed = self.points = 0  # triangles, objects and points built so far

    def built(self) -> tuple[Array, Index]:
        start = self._start()
        self._load(start)
        points: list[Array] = []
        corners: list[Index] = []
        for key, moved in self.items:
            self._add(key, moved, self.read[start], (), points, corners)
        if not corners:
            raise InputError(
                "EMPTY_FILE", self.where, "it builds no triangles; export the part again"
            )
        return np.vstack(points), np.vstack(corners)

    def _start(self) -> str:
        """The file of the zip that holds the model."""
        names = {name.lower(): name for name in self.archive.namelist()}
        if "_rels/.rels" in names:
            found: list[str] = []

            def relation(name: str, values: dict[str, str]) -> None:
                if name.endswith(" Relationship") and values.get("Type") == MODEL_RELATION:
                    found.append(values.get("Target", "").lstrip("/"))

            self._parse(names["_rels/.rels"], relation)
            if found and found[0].lower() in names:
                return names[found[0].lower()]
        if MODEL.lower() not in names:
            raise _bad(self.where, Text("there is no model in it ({})", MODEL))
        return names[MODEL.lower()]

    def _load(self, file: str) -> None:
        """Read a file of the zip and those that its components are in."""
        waiting = [file]
        while waiting:
            name = waiting.pop()
            if name in self.read:
                continue
            reader = _Model(self.where, name)
            self._parse(name, reader.start, reader.prefix)
            self.read[name] = reader.unit
            self.objects |= reader.objects
            if name == file:
                self.items = reader.items
            wanted = [key for made in reader.objects.values() for key, _ in made.parts] + [
                key for key, _ in reader.items
            ]
            waiting += [key[0] for key in wanted]

    def _parse(self, name: str, start: object, prefix: object = None) -> None:
        try:
            info = self.archive.getinfo(name)
        except KeyError:
            raise _bad(self.where, Text("{} is missing in it", name)) from None
        if info.flag_bits & 1:
            raise InputError(
                "UNSUPPORTED_FILE", self.where, "it is encrypted; export it without protection"
            )
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise _bad(self.where, "it is compressed in a way that 3MF does not allow")
        parser = expat.ParserCreate(namespace_separator=" ")
        parser.buffer_text = True
        parser.StartElementHandler = start  # type: ignore[assignment]
        parser.StartNamespaceDeclHandler = prefix  # type: ignore[assignment]
        parser.StartDoctypeDeclHandler = self._refuse_doctype
        size = 0
        with self.archive.open(info) as stream:
            while chunk := stream.read(CHUNK):
                size += len(chunk)  # what the zip tells of itself need not be true
                if size > LARGEST:
                    raise InputError(
                        "UNSUPPORTED_FILE",
                        self.where,
                        "{} unpacks to more than {} MB; export it with a coarser mesh",
                        name,
                        LARGEST >> 20,
                    )
                parser.Parse(chunk, False)
                if (
                    size - max(parser.CurrentByteIndex, 0) > LONGEST
                ):  # it would be read again with each chunk
                    raise _bad(
                        self.where,
                        Text("an element of {} is longer than {} MB", name, LONGEST >> 20),
                    )
            parser.Parse(b"", True)

    def _refuse_doctype(self, *_: object) -> None:
        raise _bad(self.where, "it has a document type, which 3MF does not allow")

    def _add(
        self,
        key: Key,
        moved: Array,
        unit: float,
        within: tuple[Key, ...],
        points: list[Array],
        corners: list[Index],
    ) -> None:
        """An object, moved (4, 3), behind the points and corners there are."""
        made = self.objects.get(key)
        if made is None or key in within:
            text = "holds itself" if made else "is not in it"
            raise _bad(self.where, Text("object {} of {} {}", key[1], key[0], Word(text)))
        self.placed += 1
        if self.placed > MOST_PLACED or len(within) > DEEPEST:
            text = Text("{:,} objects, or objects nested {} times", MOST_PLACED, DEEPEST)
            raise InputError(
                "UNSUPPORTED_FILE", self.where, "it builds more than {}; simplify it", Word(text)
            )
        if made.kind in NOT_DEPOSITED:
            return
        for part, way in made.parts:
            self._add(
                part,
                np.vstack([way[:3] @ moved[:3], way[3] @ moved[:3] + moved[3]]),
                unit,
                (*within, key),
                points,
                corners,
            )
        if not made.triangles:
            return
        self.count += len(made.triangles)
        if self.count > MAX_TRIANGLES:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "it builds more than {:,} triangles; simplify it",
                MAX_TRIANGLES,
            )
        own, some = np.array(made.points).reshape(-1, 3), np.array(made.triangles, dtype=np.intp)
        if some.min() < 0 or some.max() >= len(own):
            raise _bad(
                self.where,
                Text("object {} of {} has triangles with points that it has not", key[1], key[0]),
            )
        if self.points + len(own) > 3 * MAX_TRIANGLES:
            most = 3 * MAX_TRIANGLES
            raise InputError(
                "UNSUPPORTED_FILE", self.where, "it builds more than {:,} points; simplify it", most
            )
        turned = np.linalg.det(moved[:3])
        if abs(turned) <= 1e-12 * np.abs(moved[:3]).max() ** 3:
            raise _bad(
                self.where,
                Text("object {} of {} is moved by a matrix that flattens it", key[1], key[0]),
            )
        points.append((own @ moved[:3] + moved[3]) * unit)
        corners.append((some if turned > 0.0 else some[:, ::-1]) + self.points)
        self.points += len(own)


class _Model:
    """What the elements of one model file say."""

    def __init__(self, where: str, name: str) -> None:
        self.where, self.name = where, name
        self.unit = 1.0
        self.objects: dict[Key, _Object] = {}
        self.items: list[tuple[Key, Array]] = []
        self.prefixes: dict[str, str] = {}
        self.now = _Object()

    def prefix(self, prefix: str | None, space: str) -> None:
        self.prefixes[prefix or ""] = space

    def start(self, element: str, values: dict[str, str]) -> None:
        space, _, name = element.rpartition(" ")
        if space != CORE:
            return
        try:
            if name == "vertex":
                self.now.points.append((float(values["x"]), float(values["y"]), float(values["z"])))
            elif name == "triangle":
                self.now.triangles.append((int(values["v1"]), int(values["v2"]), int(values["v3"])))
            elif name == "object":
                self.now = self.objects[self.name, int(values["id"])] = _Object(
                    values.get("type", "model")
                )
            elif name == "component":
                self.now.parts.append((self._key(values), _matrix(values)))
            elif name == "item" and values.get("printable", "1") not in ("0", "false"):
                self.items.append((self._key(values), _matrix(values)))
            elif name == "model":
                self._model(values)
        except KeyError as error:
            raise _bad(self.where, Text("a {} in {} lacks {}", name, self.name, error)) from None
        except ValueError as error:
            raise _bad(
                self.where,
                Text("a {} in {} has a value that is not a number ({})", name, self.name, error),
            ) from None

    def _key(self, values: dict[str, str]) -> Key:
        path = next((text for name, text in values.items() if name.endswith(" path")), "")
        return path.lstrip("/") or self.name, int(values["objectid"])

    def _model(self, values: dict[str, str]) -> None:
        unit = values.get("unit", "millimeter")
        if unit not in UNITS:
            raise _bad(self.where, Text("its unit {!r} is none of {}", unit, ", ".join(UNITS)))
        self.unit = UNITS[unit]
        for prefix in values.get("requiredextensions", "").split():
            space = self.prefixes.get(prefix, prefix)
            if space not in KNOWN:
                text = (
                    "it is encrypted"
                    if "securecontent" in space
                    else Text("it needs an extension that is not read ({})", space)
                )
                raise InputError(
                    "UNSUPPORTED_FILE", self.where, "{}; export plain triangles", Word(text)
                )


def _matrix(values: dict[str, str]) -> Array:
    """(4, 3): a point (x, y, z, 1) as a row times it is the point moved."""
    numbers = np.array(
        re.split(r"\s+", values.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").strip()),
        dtype=np.float64,
    )
    if len(numbers) != 12 or not np.isfinite(numbers).all():
        raise ValueError(f"transform {values['transform']!r}")
    return numbers.reshape(4, 3)


def _bad(where: str, what: str) -> InputError:
    return InputError("BAD_FILE", where, "{}; export the part again", what)
