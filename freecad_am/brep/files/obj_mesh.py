# SPDX-License-Identifier: LGPL-2.1-or-later
"""Triangles of a Wavefront OBJ file.

FreeCAD's own reader silently drops faces with more than four corners or with a missing corner,
points with a weight or a comment, and continued lines. It also triangulates concave polygons
wrongly.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.geometry.mesh.coarsen import doubled_areas
from ...core.geometry.mesh.polygon import triangulate
from ...core.issues import NOTE, InputError, Issue, Text
from ...core.types import Array, Index

CONTENT = "FILE_CONTENT"
CONTINUED = re.compile(rb"\\[ \t]*\r?\n")  # end of a line that continues on the next one
VERTEX_NUMBERS = (3, 4, 6, 7, 8)  # with a weight, or a colour
# statements that say nothing of the shape of faces
HARMLESS = {
    "vt",
    "vn",
    "vp",
    "vc",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "cstype",
    "deg",
    "bmat",
    "step",
    "parm",
    "trim",
    "hole",
    "scrv",
    "sp",
    "end",
    "con",
    "ctech",
    "stech",
    "curv2",
}
LEFT_OUT = {"l": "line", "p": "point", "curv": "curve"}
SURFACES = ("surf", "bzp", "bsp", "cdp")  # free-form surfaces, of today and of old
CALLS = ("call", "csh")


class ObjMesh:
    """points (n, 3) and corners (m, 3) in units of the file, without points that no face uses.

    is_mixed: whether it has faces of more than four corners.
    """

    def __init__(self, file: Path, where: str) -> None:
        self.where = where
        self.left_out: Counter[str] = Counter()
        self._vertices: list[tuple[float, float, float]] = []
        self._faces: list[list[int]] = []
        text = CONTINUED.sub(b" ", file.read_bytes())
        for number, line in enumerate(text.splitlines(), start=1):
            self._read(line, number)
        self.is_mixed = any(len(face) > 4 for face in self._faces)
        self.points, self.corners = self._triangles()

    def issues(self) -> tuple[Issue, ...]:
        """Return notes on ignored lines, points and curves."""
        if not self.left_out:
            return ()
        counts = ", ".join(f"{count} x {name}" for name, count in self.left_out.items())
        text = Text(
            "{}: these entries are ignored, as they define no shape: {}", self.where, counts
        )
        return (Issue(NOTE, CONTENT, text),)

    def _read(self, line: bytes, number: int) -> None:
        words = line.split(b"#", 1)[0].split()
        if not words:
            return
        key = words[0].decode("latin-1")
        try:
            if key in ("v", "f", "fo") and b"_" in line:  # Python reads 1_0 as 10
                raise ValueError
            if key == "v":
                self._read_vertex(words[1:])
            elif key in ("f", "fo"):
                self._read_face(words[1:])
            elif key in LEFT_OUT:
                self.left_out[LEFT_OUT[key]] += 1
            elif key not in HARMLESS:
                self._refuse(key, number)
        except ValueError:
            raise InputError(
                "BAD_FILE",
                self.where,
                "line {} cannot be read: {!r}; export the part again",
                number,
                line[:60].decode("latin-1"),
            ) from None

    def _refuse(self, key: str, number: int) -> None:
        if key in SURFACES:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "the file has free-form surfaces ({} in line {}), which are not supported; "
                "export triangles, or STEP",
                key,
                number,
            )
        if key in CALLS:
            raise InputError(
                "UNSUPPORTED_FILE",
                self.where,
                "line {} refers to another file, which is not read; export the part as a single "
                "file",
                number,
            )
        raise InputError(
            "BAD_FILE",
            self.where,
            "line {} begins with {!r}, which is not an OBJ statement; export the part again",
            number,
            key[:40],
        )

    def _read_vertex(self, words: Sequence[bytes]) -> None:
        if len(words) not in VERTEX_NUMBERS:
            raise ValueError
        x, y, z = (float(word) for word in words[:3])
        self._vertices.append((x, y, z))

    def _read_face(self, words: Sequence[bytes]) -> None:
        count = len(self._vertices)  # what negative numbers count back from
        corners = []
        for word in words:
            number = int(word.split(b"/", 1)[0])
            if number == 0 or count + number < 0:
                raise ValueError
            corners.append(number - 1 if number > 0 else count + number)
        if len(corners) < 3:
            raise ValueError
        distinct_corners = [corner for k, corner in enumerate(corners) if corner != corners[k - 1]]
        if len(distinct_corners) > 2:  # else it has no area
            self._faces.append(distinct_corners)

    def _triangles(self) -> tuple[Array, Index]:
        vertices = np.array(self._vertices, dtype=np.float64).reshape(-1, 3)
        largest = max(map(max, self._faces), default=-1)
        if largest >= len(vertices):
            raise InputError(
                "BAD_FILE",
                self.where,
                "a face refers to vertex {}, but the file has {} vertices; export the part again",
                largest + 1,
                len(vertices),
            )
        large = [
            np.array(face)[triangulate(vertices[face])] for face in self._faces if len(face) > 4
        ]
        corners = np.concatenate([self._small_faces(vertices), *large])
        used, corners = np.unique(corners, return_inverse=True)
        points = vertices[used]
        if not np.isfinite(points).all():
            raise InputError(
                "BAD_FILE",
                self.where,
                "a vertex index of a face is not a number; export the part again",
            )
        return points, corners.reshape(-1, 3).astype(np.intp)

    def _small_faces(self, vertices: Array) -> Index:
        """Return the triangles of faces with three and four corners, in the order of the file.

        A face with four corners is cut from its first corner, unless it is concave there.
        """
        counts = np.array([len(face) for face in self._faces], dtype=np.intp)
        threes, fours = (
            np.array([face for face in self._faces if len(face) == n], dtype=np.intp).reshape(-1, n)
            for n in (3, 4)
        )
        halves = np.stack([fours[:, [0, 1, 2]], fours[:, [2, 3, 0]]], axis=1)
        normals = doubled_areas(vertices[halves].reshape(-1, 3, 3)).reshape(-1, 2, 3)
        dented = (normals[:, 0] * normals[:, 1]).sum(axis=1) <= 0.0
        for k in np.flatnonzero(dented):
            halves[k] = fours[k][triangulate(vertices[fours[k]])]
        numbers = np.r_[np.flatnonzero(counts == 3), np.repeat(np.flatnonzero(counts == 4), 2)]
        in_order = np.argsort(numbers, kind="stable")
        return np.concatenate([threes, halves.reshape(-1, 3)])[in_order]
