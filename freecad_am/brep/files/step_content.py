# SPDX-License-Identifier: LGPL-2.1-or-later
"""Content of a STEP or IGES file that the geometry kernel skips.

The kernel skips these without a message: solids by constructive geometry, triangles without
surfaces, and parts in other files. The text of the file names them.
"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import Any

from ...core.issues import NOTE, WARNING, InputError, Issue, Text, Word

CONTENT = "FILE_CONTENT"
TYPE = re.compile(rb"#(\d+)\s*=\s*(?:\(\s*)?([A-Z][A-Z0-9_]*)\s*\(")
TESSELLATED = re.compile(rb"\bTESSELLATED_(?:SOLID|SHELL)\s*\(")
FACE_SETS = re.compile(rb"=\s*(?:COMPLEX_)?TRIANGULATED_SURFACE_SET\s*\(")
DOCUMENT_FILE = re.compile(rb"=\s*DOCUMENT_FILE\s*\(\s*'((?:[^']|'')*)'")
REFERENCE = re.compile(rb"#(\d+)")
CAD_FILES = (
    ".stp",
    ".step",
    ".p21",
    ".stpx",
    ".igs",
    ".iges",
    ".prt",
    ".catpart",
    ".sldprt",
    ".ipt",
    ".jt",
)
SOLIDS = ("MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP")
FACES = ("ADVANCED_FACE", "FACE_SURFACE")
# every file with a shape has at least one of these kinds
GEOMETRY = (
    *SOLIDS,
    *FACES,
    "SHELL_BASED_SURFACE_MODEL",
    "FACE_BASED_SURFACE_MODEL",
    "GEOMETRIC_SET",
    "GEOMETRIC_CURVE_SET",
    "EDGE_BASED_WIREFRAME_MODEL",
    "SHELL_BASED_WIREFRAME_MODEL",
    "POLY_LOOP",
    "TRIMMED_CURVE",
)
# solids that the kernel does not read
CONSTRUCTED = (
    "CSG_SOLID",
    "BOOLEAN_RESULT",
    "EXTRUDED_AREA_SOLID",
    "EXTRUDED_FACE_SOLID",
    "REVOLVED_AREA_SOLID",
    "REVOLVED_FACE_SOLID",
    "SURFACE_CURVE_SWEPT_AREA_SOLID",
    "SURFACE_CURVE_SWEPT_FACE_SOLID",
    "SWEPT_DISK_SOLID",
    "SOLID_REPLICA",
    "HALF_SPACE_SOLID",
    "BLOCK",
    "SPHERE",
    "TORUS",
    "ELLIPSOID",
    "RIGHT_ANGULAR_WEDGE",
    "RIGHT_CIRCULAR_CYLINDER",
    "RIGHT_CIRCULAR_CONE",
    "FACETED_PRIMITIVE",
    "B_SPLINE_VOLUME",
    "B_SPLINE_VOLUME_WITH_KNOTS",
)
PLAIN = Text("export exact faces (AP203, AP214 or AP242 with B-rep), or a mesh (STL, OBJ, 3MF)")
# types of IGES entities
IGES_CONSTRUCTED = {
    150: "block",
    152: "wedge",
    154: "cylinder",
    156: "cone",
    158: "sphere",
    160: "torus",
    162: "solid of revolution",
    164: "solid of extrusion",
    168: "ellipsoid",
    180: "boolean tree",
    182: "selected component",
}
IGES_ELEMENTS = {134: "node", 136: "finite element", 138: "nodal displacement", 146: "nodal result"}
IGES_EXTERNAL = 416
IGES_GROUPS = (308, 402, 408)
IGES_SHAPES = (*range(100, 135), 140, 141, 142, 143, 144, 186, 190, 192, 194, 196, 198)


class StepContent:
    """The kinds of entities in a STEP file."""

    def __init__(self, file: Path, where: str) -> None:
        self.where = where
        self.data = file.read_bytes()
        self.kinds: Counter[str] = Counter()
        self._representations: list[int] = []  # where their texts begin
        self._solids: set[bytes] = set()
        for match in TYPE.finditer(self.data):
            kind = match.group(2).decode("ascii")
            self.kinds[kind] += 1
            if kind in SOLIDS:
                self._solids.add(match.group(1))
            elif kind.endswith("SHAPE_REPRESENTATION"):
                self._representations.append(match.end())

    @property
    def is_whole(self) -> bool:
        """Whether the text is a complete STEP file."""
        text = self.data.rstrip()
        return self.data.lstrip()[:12] == b"ISO-10303-21" and text.endswith(b"END-ISO-10303-21;")

    @property
    def has_geometry(self) -> bool:
        return any(self.kinds[kind] for kind in GEOMETRY)

    def refuse_unread(self) -> None:
        """Raise InputError UNSUPPORTED_FILE for triangles without surfaces, constructed solids, and
        parts in other files.
        """
        self._refuse_triangles()
        constructed = [kind for kind in CONSTRUCTED if self.kinds[kind]]
        if constructed:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "the file has solids by constructive geometry ({}), which are not supported; {}",
                ", ".join(constructed),
                PLAIN,
            )
        names = [name.decode("utf-8", "replace") for name in DOCUMENT_FILE.findall(self.data)]
        references = [name for name in names if name.lower().endswith(CAD_FILES)]
        if references:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "the file refers to other files ({}), which are not read; export the assembly as "
                "one file",
                ", ".join(dict.fromkeys(references)),
            )

    def _refuse_triangles(self) -> None:
        """Raise InputError for tessellated solids, shells and sets without an exact counterpart."""
        loose = sum(
            _last_argument(self.data, match.end()) == b"$"
            for match in TESSELLATED.finditer(self.data)
        )
        if not self.has_geometry:  # their linked geometry is missing
            loose += len(TESSELLATED.findall(self.data)) + len(FACE_SETS.findall(self.data))
            loose += self.kinds["TRIANGULATED_FACE"] + self.kinds["COMPLEX_TRIANGULATED_FACE"]
        if loose:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "{} have no surfaces, only triangles (AP242 tessellated geometry); {}",
                Word("some faces" if self.has_geometry else "the faces"),
                PLAIN,
            )

    def compare(self, shape: Any) -> list[Issue]:
        """Return notes and warnings on content of the file that is missing in its shape.

        Raises InputError BAD_FILE if solids are lost.
        """
        issues = []
        solids, faces = len(self._represented()), sum(self.kinds[kind] for kind in FACES)
        lost_solids, lost_faces = solids - len(shape.Solids), faces - len(shape.Faces)
        if lost_solids > 0 and lost_faces > 0:
            raise InputError(
                "BAD_FILE",
                self.where,
                "{} of {} solids and {} of {} faces cannot be read; check the part in the CAD "
                "system, and export it again",
                lost_solids,
                solids,
                lost_faces,
                faces,
            )
        if lost_solids > 0:
            issues.append(
                Issue(
                    WARNING,
                    CONTENT,
                    Text(
                        "{}: {} of {} solids are read as faces that enclose no volume; check the "
                        "part (Part, Check geometry)",
                        self.where,
                        lost_solids,
                        solids,
                    ),
                )
            )
        elif lost_faces > 0:
            issues.append(
                Issue(
                    WARNING,
                    CONTENT,
                    Text(
                        "{}: {} of {} faces belong to no shape; check the part (Part, Check "
                        "geometry)",
                        self.where,
                        lost_faces,
                        faces,
                    ),
                )
            )
        if self.kinds["INVISIBILITY"]:
            issues.append(
                Issue(
                    NOTE,
                    CONTENT,
                    Text("{}: items marked as invisible are read like visible ones", self.where),
                )
            )
        if self.kinds["CONSTRUCTIVE_GEOMETRY_REPRESENTATION"]:
            issues.append(
                Issue(
                    NOTE,
                    CONTENT,
                    Text("{}: construction geometry (axes, planes) is not read", self.where),
                )
            )
        return issues

    def _represented(self) -> set[bytes]:
        """Return the numbers of the solids in a shape representation."""
        listed: set[bytes] = set()
        for start in self._representations:
            end = self.data.find(b";", start)
            listed.update(REFERENCE.findall(self.data[start : end if end >= 0 else None]))
        return self._solids & listed


def _last_argument(data: bytes, start: int) -> bytes:
    """Return the last argument of an argument list that begins at `start`, after its bracket."""
    depth, index, begin = 1, start, start
    while index < len(data) and depth:
        sign = data[index : index + 1]
        if sign == b"'":
            index = data.find(b"'", index + 1)
            if index < 0:
                break
        elif sign == b"(":
            depth += 1
        elif sign == b")":
            depth -= 1
        elif sign == b"," and depth == 1:
            begin = index + 1
        index += 1
    return data[begin : index - 1].strip()


def refuse_iges(file: Path, where: str) -> list[Issue]:
    """Return notes on IGES content that is not read.

    Raises InputError UNSUPPORTED_FILE for constructed solids and references to other files, and
    EMPTY_FILE if no entity is a shape.
    """
    kinds, blanked, visible = _iges_kinds(file)
    constructed = [name for kind, name in IGES_CONSTRUCTED.items() if kinds[kind]]
    if constructed:
        raise InputError(
            "UNSUPPORTED_FILE",
            where,
            "the file has solids by constructive geometry ({}), which are not supported; {}",
            ", ".join(constructed),
            PLAIN,
        )
    if kinds[IGES_EXTERNAL]:
        raise InputError(
            "UNSUPPORTED_FILE",
            where,
            "the file refers to other files (entity {}), which are not read; export the assembly "
            "as one file",
            IGES_EXTERNAL,
        )
    if kinds and not any(kinds[kind] for kind in IGES_SHAPES):
        raise InputError(
            "EMPTY_FILE",
            where,
            "the file contains no shape, only annotations; export the part again",
        )
    if blanked and not visible:
        raise InputError(
            "EMPTY_FILE",
            where,
            "all shapes in the file are marked as invisible and therefore not read; show the "
            "part and export it again",
        )
    issues = []
    elements = [name for kind, name in IGES_ELEMENTS.items() if kinds[kind]]
    if elements:
        issues.append(Issue(NOTE, CONTENT, Text("{}: not read: {}", where, ", ".join(elements))))
    if blanked:
        issues.append(
            Issue(
                NOTE,
                CONTENT,
                Text(
                    "{}: {} entities marked as invisible are ignored",
                    where,
                    blanked,
                ),
            )
        )
    return issues


def _iges_kinds(file: Path) -> tuple[Counter[int], int, int]:
    """Count the entities of an IGES file by type, and the independent entities that are blanked and
    visible.
    """
    kinds: Counter[int] = Counter()
    blanked = visible = 0
    with file.open("rb") as stream:
        for line in stream:
            number = line[73:80].strip()
            if line[72:73] != b"D" or not number.isdigit() or int(number) % 2 == 0:
                continue  # each entity has two lines
            kind = line[:8].strip()
            if not kind.isdigit():
                continue
            kinds[int(kind)] += 1
            status = line[64:72].replace(b" ", b"0")
            if status[2:4] == b"00" and int(kind) in IGES_SHAPES + IGES_GROUPS:
                blanked += status[:2] == b"01"
                visible += status[:2] != b"01"
    return kinds, blanked, visible
