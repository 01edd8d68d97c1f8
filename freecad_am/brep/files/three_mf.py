# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a 3MF file, which FreeCAD reads since 0.21 only (decision 0011).

3MF core specification 1.3: a zip with an XML model of objects - a mesh, or components: other
objects, moved - and of items to build: objects, moved. The production extension puts objects into
further files of the zip. Roles that slicers give to objects are in `three_mf_roles`. What an
extension adds to an object changes its shape, unless the extension is known to be harmless: such an
object is rejected when it is built.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple
from xml.parsers import expat

import numpy as np

from ...core.issues import NOTE, InputError, Issue, Text, Word
from ...core.types import Array, Index
from . import three_mf_roles
from . import three_mf_roles as roles
from .three_mf_roles import NEGATIVE, PART, Volume

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
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
ALTERNATIVES = "http://schemas.3mf.io/3dmanufacturing/productionalternatives/2021/04"
SLICE = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"
VOLUMETRIC = "http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01"
# extensions that change nothing of a mesh's shape, or whose part we read
KNOWN = (
    PRODUCTION,
    ALTERNATIVES,
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
)
CURA = "http://software.ultimaker.com/xml/cura/3mf/2015/10"
SLIC3R = (
    "http://schemas.slic3r.org/3mf/2017/06",
    "http://schemas.slic3r.org/3mf/2017/06/",
)
# programs whose elements inside objects hold settings, except the roles that are read
PROGRAMS = (
    CURA,
    *SLIC3R,
    "http://schemas.bambulab.com/package/2021",
    "http://schemas.openxmlformats.org/markup-compatibility/2006",
    "http://www.w3.org/XML/1998/namespace",
)
# extensions whose resources are harmless where no object uses them
RESOURCES = ("/slice/", "/volumetric/", "/implicit/", "/displacement/", "/beamlattice/")
VOLUME_DATA = ("volumedata", "composite", "materialmapping", "color", "property")
CORE_IN_OBJECTS = (
    "object",
    "metadatagroup",
    "metadata",
    "mesh",
    "vertices",
    "triangles",
    "components",
)
CORE_ELSEWHERE = ("metadata", "metadatagroup", "resources", "build", "basematerials", "base")
DEPOSITED = ("model", "surface")  # types of objects that are part
NOT_DEPOSITED = {"support": roles.SUPPORT, "solidsupport": roles.SUPPORT, "other": "other"}
MAX_UNPACKED_BYTES = 1 << 29  # bytes of a file of the zip, unpacked
MAX_TRIANGLES = 20_000_000  # triangles, total over items
MAX_PLACED_OBJECTS, MAX_NESTING = 100_000, 100  # objects, total over items, and levels of nesting
CHUNK = 1 << 20
MAX_ELEMENT_BYTES = 4 << 20  # bytes of one element
MAX_CUT = 4000  # triangles that take part in all subtractions of negative volumes
MAX_NAMED = 5  # pieces that a note names
CONTENT = "FILE_CONTENT"
# files of a zip that hold no shape: pictures, settings, and what describes the zip
HARMLESS = re.compile(
    r"\[content_types\]\.xml|mimetype|.*/?_rels/.*|.*\.(png|jpe?g|gif|bmp|webp|svg|gcode|md5|rels|psmdcp)"
    r"|(?!metadata/).*\.(txt|ini|json|cfg)"
    r"|cura/.*|docprops/.*|auxiliaries/.*|3d/textures?/.*|thumbnails?/.*|.*/",
    re.IGNORECASE,
)
# settings files in Metadata: PrusaSlicer, SuperSlicer, Bambu Studio and OrcaSlicer
SETTINGS = re.compile(
    r"metadata/((slic3r(_pe)?|prusaslicer|superslicer)\.config|(slic3r|prusa|superslicer|slic3r_pe|prusa_slicer)_("
    r"layer_heights_profile|layer_config_ranges|sla_support_points|sla_drain_holes|custom_gcode_per_print_z|"
    r"wipe_tower_information|cut_information)\.(txt|xml)|(project_settings|slice_info|"
    r"(process|filament|machine|print)_settings_\d+)\.config|(layer_heights_profile|brim_ear_points)\.txt|"
    r"(layer_config_ranges|custom_gcode_per_layer|cut_information)\.xml|(plate_\d+|filament_sequence)\.json)",
    re.IGNORECASE,
)

Key = tuple[str, int]  # file of the zip, id


@dataclass
class _Object:
    kind: str = "model"
    name: str = ""
    points: list[tuple[float, float, float]] = field(default_factory=list)
    triangles: list[tuple[int, int, int]] = field(default_factory=list)
    components: list[tuple[Key, Array]] = field(default_factory=list)
    role: str = PART
    volumes: list[Volume] = field(default_factory=list)  # ranges of its triangles
    unread: str = ""  # unread content that changes its shape
    laid: list[str] = field(default_factory=list)  # settings by which a slicer lays it otherwise


class _Item(NamedTuple):
    key: Key
    moved: Array
    role: str
    unread: str = ""  # as of an object
    laid: tuple[str, ...] = ()


class _Piece(NamedTuple):
    points: Array
    corners: Index
    role: str
    name: str
    item: int


class Content(NamedTuple):
    """Points (n, 3) mm and corners (m, 3) of all built items, and notes on ignored content."""

    points: Array
    corners: Index
    issues: tuple[Issue, ...]


def triangles(path: Path) -> tuple[Array, Index]:
    """Return points (n, 3) mm and corners (m, 3) of all items that a 3MF file builds, as `content`."""
    return content(path)[:2]


def content(path: Path) -> Content:
    """Read all items that a 3MF file builds.

    Pieces stay separate, mirrored pieces get outward normals, and negative volumes are subtracted.
    Supports, modifiers, and items that are not printed are ignored, and a note names them. Raises
    InputError BAD_FILE, EMPTY_FILE, UNSUPPORTED_FILE.
    """
    where = path.name
    try:
        with zipfile.ZipFile(path) as archive:
            return _Package(archive, where).built()
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError) as error:
        raise _bad(where, Text("the file is not a valid zip file ({})", error)) from None
    except expat.ExpatError as error:
        raise _bad(where, Text("the XML in the file is damaged ({})", error)) from None
    except OverflowError:
        raise _bad(where, "a triangle refers to a point by a number of more than 64 bits") from None


class _Package:
    def __init__(self, archive: zipfile.ZipFile, where: str) -> None:
        self.archive, self.where = archive, where
        self.objects: dict[Key, _Object] = {}
        self.items: list[_Item] = []
        self.units: dict[str, float] = {}  # files read, and their units in mm
        self.count = self.placed = 0  # triangles and objects built so far
        self.points = 0
        self.start = ""
        self.parts: dict[int, dict[int, Volume]] = {}  # of an object's id, by that of a component
        self.encrypted: set[str] = set()
        self.spaces: dict[str, None] = {}  # unknown namespaces, in their order
        self.left_out: list[tuple[str, str]] = []  # names and roles
        self.pieces: list[_Piece] = []
        self.cut = 0  # triangles that took part in subtractions
        self.subtracted: list[tuple[str, str]] = []
        self.laid: dict[
            str, None
        ] = {}  # settings of slicers that are not applied, with their objects
        self.plates = 0  # on which a slicer's project has something

    def built(self) -> Content:
        self._read_keystore()
        self.start = self._start()
        self._load(self.start)
        self._read_roles()
        for number, item in enumerate(self.items):
            model = self.objects.get(item.key)
            if model is not None:  # settings of an item are those of what it places
                model = replace(
                    model, unread=item.unread or model.unread, laid=[*model.laid, *item.laid]
                )
            self._add(item.key, item.moved, item.role, (), number, model)
        self._read_profiles()
        points, corners = self._merge_pieces()
        if not len(corners):
            raise self._empty_file()
        return Content(points, corners, tuple(self._notes()))

    def _empty_file(self) -> InputError:
        sliced = [name for name in self.archive.namelist() if name.lower().endswith(".gcode")]
        if sliced and not self.objects:
            return InputError(
                "EMPTY_FILE",
                self.where,
                "the file is sliced: it contains G-code ({}) and no triangles; export the "
                "project with its meshes, or unpack the G-code and plan it as curves",
                ", ".join(sliced[:MAX_NAMED]),
            )
        return InputError(
            "EMPTY_FILE",
            self.where,
            "the file contains no triangles{}; export the part again",
            self._names_left_out(),
        )

    def _merge_pieces(self) -> tuple[Array, Index]:
        """Return the parts, with the negative volumes of the same item subtracted."""
        negatives = [piece for piece in self.pieces if piece.role == NEGATIVE]
        points: list[Array] = [np.zeros((0, 3))]
        corners: list[Index] = [np.zeros((0, 3), dtype=np.intp)]
        count = 0
        for piece in self.pieces:
            if piece.role != PART:
                continue
            vertices, faces = piece.points, piece.corners
            for negative in negatives:
                if negative.item == piece.item:
                    vertices, faces = self._subtracted(vertices, faces, negative)
            points.append(vertices)
            corners.append(faces + count)
            count += len(vertices)
        self.left_out += [
            (piece.name, NEGATIVE)
            for piece in negatives
            if (piece.name, NEGATIVE) not in self.subtracted
        ]
        return np.vstack(points), np.vstack(corners)

    def _subtracted(self, points: Array, corners: Index, tool: _Piece) -> tuple[Array, Index]:
        if not len(corners) or not _meet(points, tool.points):
            return points, corners
        count = len(corners) + len(tool.corners)
        self.cut += count
        max_triangles = three_mf_roles.MAX_TRIANGLES
        if count > max_triangles or self.cut > MAX_CUT:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "{!r} is a negative volume that cannot be subtracted here: {} triangles are "
                "involved, and the limit is {}; subtract the volume in the CAD system, or remove "
                "it in the slicer, and export again",
                tool.name,
                count if count > max_triangles else self.cut,
                max_triangles if count > max_triangles else MAX_CUT,
            )
        remainder = three_mf_roles.difference(points, corners, tool.points, tool.corners)
        if remainder is None:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "{!r} is a negative volume that cannot be subtracted here: the geometry kernel "
                "finds no valid result, as when a mesh touches or crosses itself; subtract the "
                "volume in the CAD system, or remove it in the slicer, and export again",
                tool.name,
            )
        self.subtracted.append((tool.name, NEGATIVE))
        return remainder

    def _names_left_out(self) -> str:
        if not self.left_out:
            return ""
        return Text(", as all objects are excluded from the shape ({})", _listed(self.left_out))

    def _notes(self) -> list[Issue]:
        notes = []
        if self.left_out:
            message = Text(
                "{}: these objects are ignored, as they are not part of the shape: {}",
                self.where,
                _listed(self.left_out),
            )
            notes.append(Issue(NOTE, CONTENT, message))
        if self.subtracted:
            message = Text("{}: subtracted from the part: {}", self.where, _listed(self.subtracted))
            notes.append(Issue(NOTE, CONTENT, message))
        if self.laid:
            message = Text(
                "{}: slicer settings that change the shape are not applied, and the meshes are "
                "deposited unchanged: {}{}",
                self.where,
                Text.joined(", ", list(self.laid)[:MAX_NAMED]),
                "" if len(self.laid) <= MAX_NAMED else ", ...",
            )
            notes.append(Issue(NOTE, CONTENT, message))
        if self.plates > 1:
            message = Text(
                "{}: the objects on all {} plates are deposited, as far apart as the plates; to "
                "deposit a single plate, export only that plate",
                self.where,
                self.plates,
            )
            notes.append(Issue(NOTE, CONTENT, message))
        if self.spaces:
            message = Text(
                "{}: data of these extensions is ignored, as no object uses it for its shape: {}",
                self.where,
                ", ".join(list(self.spaces)[:MAX_NAMED]),
            )
            notes.append(Issue(NOTE, CONTENT, message))
        read_names = {name.lower() for name in self.units}
        unused = [
            name
            for name in self.archive.namelist()
            if name.lower() not in read_names
            and not (HARMLESS.fullmatch(name) or SETTINGS.fullmatch(name) or roles.is_config(name))
        ]
        if unused:
            message = Text(
                "{}: these files are ignored, as no built object uses them: {}",
                self.where,
                ", ".join(unused[:MAX_NAMED]),
            )
            notes.append(Issue(NOTE, CONTENT, message))
        return notes

    def _named(self, name: str) -> str | None:
        """Return the file of the zip with a name, ignoring case."""
        return next(
            (entry for entry in self.archive.namelist() if entry.lower() == name.lower()), None
        )

    def _read_keystore(self) -> None:
        """Read which files of the zip are encrypted by the extension for secure content."""
        name = self._named("Secure/keystore.xml")
        if name is None:
            return

        def resource(element: str, values: dict[str, str]) -> None:
            if element.rpartition(" ")[2] == "resourcedata":
                self.encrypted.add(values.get("path", "").lstrip("/").lower())

        self._parse(name, resource)

    def _read_roles(self) -> None:
        """Assign the roles in the slicer's own files to the objects."""
        for name in filter(roles.is_config, self.archive.namelist()):
            reader = roles.ConfigReader()
            try:
                self._parse(name, reader.start, None, reader.end, separator=None)
            except ValueError as error:
                raise _bad(
                    self.where, Text("{} has a value that is not a number ({})", name, error)
                ) from None
            if reader.unknown:
                raise InputError(
                    "UNSUPPORTED_FILE",
                    self.where,
                    "{} gives a volume the unknown role {!r}; export only the part",
                    name,
                    reader.unknown[0],
                )
            self.plates = max(self.plates, reader.plates)
            for number, volumes in reader.volumes.items():
                self._give_roles(number, volumes, name)
            for number, settings in reader.settings.items():
                self._give_settings(number, settings)
        name = self._named(roles.DRAIN_HOLES)
        if name is not None and len(self.archive.read(name).split(b"\n", 1)[-1].strip()):
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "{} contains holes drilled by the slicer, which the mesh lacks; remove the "
                "holes, or export the drilled part as a mesh",
                name,
            )

    def _read_profiles(self) -> None:
        """Note settings for all objects, from the profiles that slicers save with a project."""
        for name in self.archive.namelist():
            if roles.CURA_PROFILE.fullmatch(name):
                pattern = roles.CURA_VALUES
            elif roles.PROFILE.fullmatch(name):
                pattern = roles.PROFILE_VALUES
            else:
                continue
            with self.archive.open(name) as stream:
                text = stream.read(CHUNK).decode("utf-8", "replace")
            for key, value in pattern.findall(text):
                if roles.is_used(value):
                    self.laid[Text("{!r}: {} = {}", name, key, value)] = None

    def _give_settings(self, number: int, settings: dict[str, str]) -> None:
        """Note settings of an object by which a slicer prints another shape than the mesh."""
        model = self.objects.get((self.start, number))
        if model is None:
            return
        for key, value in settings.items():
            setting = Text("{} = {}", key, value)
            if key in roles.SHAPES:
                model.unread = model.unread or Text("the setting {} of the slicer", setting)
            else:
                model.laid.append(setting)

    def _give_roles(self, number: int, volumes: list[Volume], name: str) -> None:
        """Assign roles to the pieces of an object. Raises InputError for pieces that the model does
        not have.
        """
        model = self.objects.get((self.start, number))
        ranges = [volume for volume in volumes if volume.start is not None]
        if model is not None and model.triangles and ranges:
            if model.volumes and model.volumes != ranges:
                raise _bad(
                    self.where,
                    Text("two files in the archive assign different roles to object {}", number),
                )
            model.volumes = ranges
            return
        parts = {volume.component: volume for volume in volumes if volume.component is not None}
        there = set() if model is None else {key[1] for key, _ in model.components}
        if model is not None and model.triangles and len(volumes) == 1:
            model.role = volumes[0].role if model.role == PART else model.role
            model.name = volumes[0].name or model.name
            there.add(volumes[0].component or 0)
        strange = [one for one in volumes if one.role != PART and (one.component or 0) not in there]
        if strange:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "{} names {!r}, a volume of object {}, with the role {}, but the model lacks "
                "this volume; save the project in the slicer again, or export only the part",
                name,
                strange[0].name or str(strange[0].component or strange[0].start),
                number,
                roles.NAMES.get(strange[0].role, strange[0].role),
            )
        self.parts[number] = parts

    def _start(self) -> str:
        """Return the file of the zip that contains the model."""
        names = {name.lower(): name for name in self.archive.namelist()}
        if "_rels/.rels" in names:
            targets: list[str] = []

            def relation(name: str, values: dict[str, str]) -> None:
                if name.endswith(" Relationship") and values.get("Type") == MODEL_RELATION:
                    targets.append(values.get("Target", "").lstrip("/"))

            self._parse(names["_rels/.rels"], relation)
            if targets and targets[0].lower() in names:
                return names[targets[0].lower()]
        if MODEL.lower() not in names:
            raise _bad(self.where, Text("the archive contains no model ({})", MODEL))
        return names[MODEL.lower()]

    def _load(self, file: str) -> None:
        """Read a file of the zip and the files of its components."""
        waiting = [file]
        while waiting:
            name = waiting.pop()
            if name in self.units:
                continue
            if name.lower() in self.encrypted:
                raise _encrypted(self.where)
            reader = _Model(self.where, name)
            self._parse(name, reader.start, reader.prefix, reader.end, reader.text)
            self.units[name] = reader.unit
            if reader.unit_is_given and reader.unit != self.units[file]:
                raise InputError(
                    "UNSUPPORTED_FILE",
                    self.where,
                    "{} has a unit other than {}, which programs interpret differently; use one "
                    "unit and export again",
                    name,
                    file,
                )
            self.objects |= reader.objects
            self.spaces |= reader.spaces
            if name == file:
                self.items = reader.items
            keys = [key for model in reader.objects.values() for key, _ in model.components] + [
                item.key for item in reader.items
            ]
            waiting += [key[0] for key in keys]

    def _parse(
        self,
        name: str,
        start: object,
        prefix: object = None,
        end: object = None,
        text: object = None,
        separator: str | None = " ",
    ) -> None:
        """Call the handlers with the elements of a file of the zip.

        separator: between namespace and name of an element; None reads prefixes as part of names,
        as PrusaSlicer declares none for the texts in its file of roles.
        """
        try:
            info = self.archive.getinfo(name)
        except KeyError:
            raise _bad(self.where, Text("the archive has no {}", name)) from None
        if info.flag_bits & 1:
            raise _encrypted(self.where)
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise _bad(self.where, "the archive is compressed in a way that 3MF does not allow")
        parser = expat.ParserCreate(namespace_separator=separator)
        parser.buffer_text = True
        parser.StartElementHandler = start  # type: ignore[assignment]
        parser.EndElementHandler = end  # type: ignore[assignment]
        parser.StartNamespaceDeclHandler = prefix  # type: ignore[assignment]
        parser.CharacterDataHandler = text  # type: ignore[assignment]
        parser.StartDoctypeDeclHandler = self._refuse_doctype
        size = 0
        with self.archive.open(info) as stream:
            while chunk := stream.read(CHUNK):
                size += len(chunk)  # the size in the zip's directory may be wrong
                if size > MAX_UNPACKED_BYTES:
                    raise InputError(
                        "UNSUPPORTED_FILE",
                        self.where,
                        "{} unpacks to more than {} MB; export a coarser mesh",
                        name,
                        MAX_UNPACKED_BYTES >> 20,
                    )
                parser.Parse(chunk, False)
                if (
                    size - max(parser.CurrentByteIndex, 0) > MAX_ELEMENT_BYTES
                ):  # it would be read again with each chunk
                    raise _bad(
                        self.where,
                        Text(
                            "an element of {} is longer than {} MB", name, MAX_ELEMENT_BYTES >> 20
                        ),
                    )
            parser.Parse(b"", True)

    def _refuse_doctype(self, *_: object) -> None:
        raise _bad(self.where, "the XML has a document type, which 3MF does not allow")

    def _add(
        self,
        key: Key,
        moved: Array,
        role: str,
        within: tuple[Key, ...],
        item: int,
        model: _Object | None,
    ) -> None:
        """Add an object, moved (4, 3), to the pieces. role: the role of its container. model: None
        if the file has no such object.
        """
        if model is None or key in within:
            text = "contains itself" if model else "is missing"
            raise _bad(self.where, Text("object {} of {} {}", key[1], key[0], Word(text)))
        self.placed += 1
        if self.placed > MAX_PLACED_OBJECTS or len(within) > MAX_NESTING:
            text = Text("{:,} objects, or objects nested {} times", MAX_PLACED_OBJECTS, MAX_NESTING)
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "the file contains more than {}; simplify the model",
                Word(text),
            )
        volume = self._volume(key, within)
        name = (volume and volume.name) or model.name or str(key[1])
        role = self._role(model, role, volume)
        if role not in (PART, NEGATIVE):
            self.left_out.append((name, role))
            return
        if model.unread:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "object {!r} has {}, which changes its shape and is not supported; export it as "
                "plain triangles",
                name,
                model.unread,
            )
        for setting in model.laid:
            self.laid[Text("{!r}: {}", name, setting)] = None
        for component, transform in model.components:
            placed = np.vstack([transform[:3] @ moved[:3], transform[3] @ moved[:3] + moved[3]])
            self._add(component, placed, role, (*within, key), item, self.objects.get(component))
        if model.triangles:
            self._add_mesh(model, key, moved, role, name, item)

    def _volume(self, key: Key, within: tuple[Key, ...]) -> Volume | None:
        """Return the slicer's volume of a component, searched from its innermost container
        outwards.
        """
        for file, number in reversed(within):
            if file == self.start and key[1] in self.parts.get(number, {}):
                return self.parts[number][key[1]]
        return None

    def _role(self, model: _Object, role: str, volume: Volume | None) -> str:
        """Return the role of an object: its own, else the slicer's, its type's, or its container's."""
        if model.kind not in (*DEPOSITED, *NOT_DEPOSITED):
            raise _bad(
                self.where,
                Text("an object has the type {!r}, which 3MF does not define", model.kind),
            )
        if role not in (PART, NEGATIVE):
            return role
        own_role = model.role
        if volume is not None:
            # Bambu Studio gives whatever is not part the type 'other'
            own_role = volume.role if own_role == PART else own_role
            if volume.role == PART:
                own_role = NOT_DEPOSITED.get(model.kind, own_role)
        elif own_role == PART:
            own_role = NOT_DEPOSITED.get(model.kind, PART)
        return role if own_role == PART else own_role

    def _add_mesh(
        self, model: _Object, key: Key, moved: Array, role: str, name: str, item: int
    ) -> None:
        unit = self.units[self.start]
        self.count += len(model.triangles)
        if self.count > MAX_TRIANGLES:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "the file contains more than {:,} triangles; simplify the mesh",
                MAX_TRIANGLES,
            )
        vertices, faces = (
            np.array(model.points).reshape(-1, 3),
            np.array(model.triangles, dtype=np.intp),
        )
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise _bad(
                self.where,
                Text("object {} of {} has triangles with missing vertices", key[1], key[0]),
            )
        self.points += len(vertices)
        if self.points > 3 * MAX_TRIANGLES:
            max_points = 3 * MAX_TRIANGLES
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "the file contains more than {:,} points; simplify the mesh",
                max_points,
            )
        turned = np.linalg.det(moved[:3])
        if abs(turned) <= 1e-12 * np.abs(moved[:3]).max() ** 3:
            raise _bad(
                self.where,
                Text("object {} of {} has a transformation that flattens it", key[1], key[0]),
            )
        placed = (vertices @ moved[:3] + moved[3]) * unit
        faces = faces if turned > 0.0 else faces[:, ::-1]
        if not model.volumes:
            self.pieces.append(_Piece(placed, faces, role, name, item))
            return
        for corners, volume in self._ranges(model, faces, name):
            own_role = volume.role if role == PART else role
            title = volume.name or name
            if own_role not in (PART, NEGATIVE):
                self.left_out.append((title, own_role))
                continue
            used, corners = np.unique(corners, return_inverse=True)
            self.pieces.append(_Piece(placed[used], corners.reshape(-1, 3), own_role, title, item))

    def _ranges(self, model: _Object, corners: Index, name: str) -> list[tuple[Index, Volume]]:
        """Return the triangles of each volume of an object; triangles outside all volumes belong to
        the part.
        """
        free = np.ones(len(corners), dtype=bool)
        ranges = []
        for volume in model.volumes:
            begin, end = volume.start or 0, min(volume.end, len(corners) - 1)
            if volume.end < begin:  # a volume without triangles
                continue
            if (
                begin < 0
                or begin >= len(corners)
                or roles.END_OF_TRIANGLES > volume.end >= len(corners)
            ):
                raise _bad(
                    self.where,
                    Text(
                        "the slicer's roles name triangles {} to {} of object {!r}, which has "
                        "only {} triangles",
                        volume.start,
                        volume.end,
                        name,
                        len(corners),
                    ),
                )
            if not free[begin : end + 1].all():
                raise _bad(
                    self.where,
                    Text("the slicer's roles name triangle {} of {!r} twice", begin, name),
                )
            free[begin : end + 1] = False
            ranges.append((corners[begin : end + 1], volume))
        if free.any():
            ranges.append((corners[free], Volume()))
        return ranges


class _Model:
    """Handler of the elements of one model file."""

    def __init__(self, where: str, name: str) -> None:
        self.where, self.name = where, name
        self.unit, self.unit_is_given = 1.0, False
        self.objects: dict[Key, _Object] = {}
        self.items: list[_Item] = []
        self.prefixes: dict[str, str] = {}
        self.spaces: dict[str, None] = {}  # unknown namespaces outside objects
        self.now = _Object()
        self.inside = False  # of an object
        self.item: int | None = None  # the one that metadata belongs to
        self.setting = ""  # of Cura, whose value is being read
        self.value: list[str] = []

    def prefix(self, prefix: str | None, space: str) -> None:
        self.prefixes[prefix or ""] = space

    def start(self, element: str, values: dict[str, str]) -> None:
        space, _, name = element.rpartition(" ")
        try:
            if space != CORE:
                self._start_foreign(space, name, values)
            elif name == "vertex":
                self.now.points.append((float(values["x"]), float(values["y"]), float(values["z"])))
            elif name == "triangle":
                self.now.triangles.append((int(values["v1"]), int(values["v2"]), int(values["v3"])))
            else:
                self._start_core(name, values)
        except KeyError as error:
            raise _bad(self.where, Text("a {} in {} lacks {}", name, self.name, error)) from None
        except ValueError as error:
            raise _bad(
                self.where,
                Text("a {} in {} has a value that is not a number ({})", name, self.name, error),
            ) from None

    def end(self, element: str) -> None:
        if self.setting and element.endswith((" metadata", " setting")):
            self._finish_setting()
        elif element == CORE + " object":
            self.inside = False
        elif element == CORE + " item":
            self.item = None

    def text(self, text: str) -> None:
        if self.setting:
            self.value.append(text)

    def _start_core(self, name: str, values: dict[str, str]) -> None:
        if name == "object":
            self._start_object(values)
        elif name == "component":
            self._check_attributes(values)
            self.now.components.append((self._key(values), _matrix(values)))
        elif name == "item":
            self._check_attributes(values)
            printed = values.get("printable", "1").strip().lower() not in ("0", "false")
            role = PART if printed else "not printable"
            self.item = len(self.items)
            self.items.append(_Item(self._key(values), _matrix(values), role))
        elif name == "metadata":
            self._start_setting(values.get("name", ""))
        elif name == "model":
            self._model(values)
        elif self.inside and name not in CORE_IN_OBJECTS:
            self._leave_unread(Text("the unknown element {}", name))
        elif not self.inside and name not in CORE_ELSEWHERE:
            self.spaces[name] = None

    def _start_object(self, values: dict[str, str]) -> None:
        self.now = self.objects[self.name, int(values["id"])] = _Object(
            values.get("type", "model"), values.get("name", "")
        )
        self.inside = True
        self._check_attributes(values)

    def _check_attributes(self, values: dict[str, str]) -> None:
        """Note attributes of extensions, and mark the object unread if they change its shape."""
        for attribute, value in values.items():
            space, _, name = attribute.rpartition(" ")
            if not space or space in (CORE, PRODUCTION, *PROGRAMS):
                continue
            if name == "slicestackid":
                self._leave_unread(Text("a stack of slices"))
            elif name == "meshresolution" and value == "lowres":
                self._leave_unread(Text("a low-resolution mesh that accompanies slices"))
            elif name == "modelresolution":
                if value != "fullres":
                    self._leave_unread(Text("a model with only the resolution {!r}", value))
            elif space not in KNOWN and space != SLICE:
                self.spaces[space] = None

    def _start_foreign(self, space: str, name: str, values: dict[str, str]) -> None:
        if name == "setting" and "key" in values:
            self._start_setting(values["key"])
        elif space in SLIC3R:
            if name == "volume" and self.inside:
                role = roles.MODIFIER if values.get("modifier", "0") in roles.TRUE else PART
                volume = Volume(role, "", int(values["ts"]), int(values["te"]))
                self.now.volumes.append(volume)
        elif space in (*KNOWN, *PROGRAMS):
            return
        elif self.inside:
            if not (space == VOLUMETRIC and name in VOLUME_DATA):
                self._leave_unread(Text("{} of the extension {}", name, space or "(none)"))
        elif not any(word in space for word in RESOURCES):
            self.spaces[space or name] = None

    def _leave_unread(self, what: str) -> None:
        if self.inside:
            self.now.unread = self.now.unread or what

    def _start_setting(self, name: str) -> None:
        """Begin to read a Cura setting of an object or an item."""
        key = name.rpartition(":")[2].strip()
        known_settings = (*roles.CURA_ROLES, *roles.CURA_SHAPES, *roles.CURA_LAID)
        if key in known_settings and (self.inside or self.item is not None):
            self.setting, self.value = key, []

    def _finish_setting(self) -> None:
        key, value = self.setting, "".join(self.value).strip()
        self.setting = ""
        if key in roles.CURA_ROLES:
            if value.lower() in roles.TRUE:
                self._finish_role(roles.CURA_ROLES[key])
        elif roles.is_used(value):
            self._finish_shape(key, Text("{} = {}", key, value))

    def _finish_role(self, role: str) -> None:
        if self.inside:
            self.now.role = role
        elif self.item is not None:
            self.items[self.item] = self.items[self.item]._replace(role=role)

    def _finish_shape(self, key: str, setting: str) -> None:
        """Note a setting by which Cura prints another shape than the mesh."""
        if key in roles.CURA_SHAPES:
            unread = Text("the setting {} of Cura", setting)
            self._leave_unread(unread)
            if not self.inside and self.item is not None:
                self.items[self.item] = self.items[self.item]._replace(unread=unread)
        elif self.inside:
            self.now.laid.append(setting)
        elif self.item is not None:
            item = self.items[self.item]
            self.items[self.item] = item._replace(laid=(*item.laid, setting))

    def _key(self, values: dict[str, str]) -> Key:
        path = next((text for name, text in values.items() if name.endswith(" path")), "")
        return path.lstrip("/") or self.name, int(values["objectid"])

    def _model(self, values: dict[str, str]) -> None:
        unit = values.get("unit", "millimeter")
        if unit not in UNITS:
            raise _bad(self.where, Text("the unit {!r} is not one of {}", unit, ", ".join(UNITS)))
        self.unit, self.unit_is_given = UNITS[unit], "unit" in values
        for prefix in values.get("requiredextensions", "").split():
            space = self.prefixes.get(prefix, prefix)
            if space not in KNOWN:
                if "securecontent" in space:
                    raise _encrypted(self.where)
                text = Text("the file needs an unsupported extension ({})", space)
                raise InputError(
                    "UNSUPPORTED_FILE", self.where, "{}; export plain triangles", Word(text)
                )


def _listed(entries: list[tuple[str, str]]) -> str:
    names = list(dict.fromkeys(entries))
    texts = [
        Text("{!r}: {}", name, roles.NAMES.get(role, role)) for name, role in names[:MAX_NAMED]
    ]
    if len(names) > MAX_NAMED:
        texts.append(Text("{} more", len(names) - MAX_NAMED))
    return Text.joined(", ", texts)


def _meet(points: Array, other_points: Array) -> bool:
    """Whether the boxes around two sets of points overlap."""
    low = np.maximum(points.min(axis=0), other_points.min(axis=0))
    high = np.minimum(points.max(axis=0), other_points.max(axis=0))
    return bool((low < high).all())


def _matrix(values: dict[str, str]) -> Array:
    """Return the matrix (4, 3) that moves a point, given as a row (x, y, z, 1)."""
    numbers = np.array(
        re.split(r"\s+", values.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0").strip()),
        dtype=np.float64,
    )
    if len(numbers) != 12 or not np.isfinite(numbers).all():
        raise ValueError(f"transform {values['transform']!r}")
    return numbers.reshape(4, 3)


def _encrypted(where: str) -> InputError:
    return InputError(
        "UNSUPPORTED_FILE", where, "the file is encrypted; export it without protection"
    )


def _bad(where: str, what: str) -> InputError:
    return InputError("BAD_FILE", where, "{}; export the part again", what)
