# SPDX-License-Identifier: LGPL-2.1-or-later
"""OBJ and STL files: every face is read as stated, or the error names the line."""

import struct

import FreeCAD  # noqa: F401
import numpy as np
import pytest

from freecad_am.brep.files.read import mesh_content, read_mesh
from freecad_am.core.issues import InputError

CUBE = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
QUADS = [(4, 3, 2, 1), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8)]


def vertices(points=CUBE, extra_lines=""):
    return "".join(f"v {x} {y} {z}{extra_lines}\n" for x, y, z in points)


def faces(rows=QUADS):
    return "".join("f " + " ".join(map(str, row)) + "\n" for row in rows)


def read(tmp_path, text, name="part.obj"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return mesh_content(path)


def refused(tmp_path, text, name="part.obj"):
    with pytest.raises(InputError) as caught:
        read(tmp_path, text, name)
    return caught.value.code, caught.value.message


def prism(ring, height):
    """Return the points of a prism over a polygon that turns left, and its faces by numbers from
    1."""
    n = len(ring)
    points = [(x, y, z) for z in (0.0, height) for x, y in ring]
    rows = [tuple(range(n, 0, -1)), tuple(range(n + 1, 2 * n + 1))]
    rows += [(k + 1, (k + 1) % n + 1, (k + 1) % n + 1 + n, k + 1 + n) for k in range(n)]
    return points, rows


@pytest.mark.parametrize("start", range(4))
@pytest.mark.parametrize("extra", [False, True])
def test_polygons_with_a_dent_are_cut_inside(tmp_path, start, extra):
    """Polygons with a dent and an extra point on a side, starting at any corner."""
    ring = [(0, 0), (4, 0), (1, 1), (0, 4)]
    ring = ring[start:] + ring[:start]
    if extra:
        ring.insert(ring.index((0, 0)), (0, 2))
    mesh, _ = read(tmp_path, vertices(prism(ring, 2.0)[0]) + faces(prism(ring, 2.0)[1]))
    assert mesh.isSolid()
    assert mesh.Volume == pytest.approx(8.0, rel=1e-6)
    assert mesh.Area == pytest.approx(8.0 + 2.0 * (8.0 + 2.0 * np.sqrt(10.0)), rel=1e-6)  # 36.65


def test_dents_of_leaning_polygons(tmp_path):
    """The faces of a rotated prism with a dent are only nearly flat."""
    points, rows = prism([(0, 0), (4, 0), (1, 1), (0, 4)], 2.0)
    turned = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turned *= np.sign(np.linalg.det(turned))
    bent = np.array(points) @ turned.T + np.random.default_rng(6).normal(size=(8, 3)) * 1e-3
    mesh, _ = read(tmp_path, vertices(bent.tolist()) + faces(rows))
    assert mesh.isSolid() and mesh.Area == pytest.approx(36.65, abs=0.05)


@pytest.mark.parametrize(
    "text",
    [
        vertices(extra_lines=" 2.0") + faces(),
        vertices(extra_lines=" 0.1 0.2 0.3") + faces(),
        vertices(extra_lines=" # a corner") + faces(),
        vertices().replace(" ", "\t") + faces().replace(" ", "\t"),
        (vertices() + faces()).replace("\n", "\r"),
        vertices().replace("v 0 0 1", "v 0 0 \\\n1") + faces().replace("4 3 2", "4 3 \\\r\n2"),
        vertices() + faces([tuple(k - 9 for k in row) for row in QUADS]),
        faces() + vertices(),
        vertices() + faces([(*row, row[0]) for row in QUADS]),
        vertices() + faces([(row[0], *row) for row in QUADS]),
        "o a\ng b\ns 1\nmtllib m.mtl\nusemtl n\nvt 0 0\nvn 0 0 1\n"
        + vertices()
        + faces().replace("4 3 2 1", "4/1/1 3/1/1 2//1 1"),
        vertices([*CUBE, (50, 50, 50), (float("nan"), 0, 0)]) + faces(),
    ],
)
def test_all_ways_to_write_a_cube(tmp_path, text):
    mesh, issues = read(tmp_path, text)
    assert mesh.isSolid() and mesh.Volume == pytest.approx(1.0) and mesh.CountPoints == 8
    assert issues == ()


def test_lines_points_and_curves_beside_faces_are_told(tmp_path):
    curve = "cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nparm u 0 1\nend\n"
    mesh, (issue,) = read(tmp_path, vertices() + faces() + "l 1 2 3\np 1\np 2\n" + curve)
    assert mesh.isSolid() and issue.level == "note"
    assert "1 x line, 2 x point, 1 x curve" in issue.message


@pytest.mark.parametrize(
    ("more", "code", "word"),
    [
        ("cstype bspline\ndeg 3 3\nsurf 0 1 0 1 1 2 3 4\nend\n", "UNSUPPORTED_FILE", "free-form"),
        ("call other.obj\n", "UNSUPPORTED_FILE", "another file"),
        ("f 1 2 99\n", "BAD_FILE", "vertex 99"),
        ("f 0 1 2\n", "BAD_FILE", "line 15"),
        ("f 1 2\n", "BAD_FILE", "line 15"),
        ("f -9 -1 -2\n", "BAD_FILE", "line 15"),
        ("f 1.5 2 3\n", "BAD_FILE", "line 15"),
        ("v 1,5 0 0\n", "BAD_FILE", "line 15"),
        ("v 1_0 0 0\n", "BAD_FILE", "line 15"),
        ("v 1 0\n", "BAD_FILE", "line 15"),
        ("V 1 0 0\n", "BAD_FILE", "line 15"),
        ("v nan 0 0\nf 1 2 9\n", "BAD_FILE", "not a number"),
        ("swoosh 1 2 3\n", "BAD_FILE", "'swoosh'"),
    ],
)
def test_what_cannot_be_read_of_an_obj_file_is_refused(tmp_path, more, code, word):
    error, message = refused(tmp_path, vertices() + faces() + more)
    assert error == code and word in message


# ---- STL

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
TRIANGLES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)


def stl_text(points=CORNERS, name="cube"):
    rows = "".join(
        "facet normal 0 0 0\n outer loop\n"
        + "".join(f"  vertex {x} {y} {z}\n" for x, y, z in points[triangle].tolist())
        + " endloop\nendfacet\n"
        for triangle in TRIANGLES
    )
    return f"solid {name}\n{rows}endsolid {name}\n"


def stl_binary(points=CORNERS, head=b"", count=12):
    rows = b"".join(
        struct.pack("<12fH", 0, 0, 0, *points[triangle].ravel(), 7) for triangle in TRIANGLES
    )
    return head.ljust(80)[:80] + struct.pack("<I", count) + rows


@pytest.mark.parametrize(
    ("text", "volume"),
    [
        (stl_text(), 1.0),
        (stl_text().upper(), 1.0),
        (stl_text().replace("\n", "\r\n"), 1.0),
        (stl_text().replace("\n", "\r"), 1.0),
        ("\ufeff" + stl_text(), 1.0),
        ("# made by hand\n" + stl_text(), 1.0),
        (stl_text().replace("1.0", "1.0E+00"), 1.0),
        (stl_text().replace("normal 0 0 0", "normal nan nan nan"), 1.0),
        (stl_text() + "\n\n" + stl_text(CORNERS * 2.0 + 5.0, "solid facet vertex"), 9.0),
        (stl_binary(), 1.0),
        (stl_binary(head=b"solid facet normal"), 1.0),
        (stl_binary(head=b"COLOR=\x01\x02\x03\xff"), 1.0),
        (stl_binary() + bytes(100), 1.0),
    ],
)
def test_stl_files_of_all_kinds(tmp_path, text, volume):
    mesh, issues = read(tmp_path, text, "part.stl")
    assert mesh.isSolid() and mesh.Volume == pytest.approx(volume) and issues == ()


def test_a_few_bytes_after_the_triangles_are_told(tmp_path):
    mesh, (issue,) = read(tmp_path, stl_binary() + b"made by x", "part.stl")
    assert mesh.isSolid() and issue.level == "note" and "9 bytes" in issue.message


@pytest.mark.parametrize(
    ("text", "word"),
    [
        (stl_binary() + stl_binary(CORNERS + 5.0), "684 bytes follow"),
        (stl_binary(count=6), "300 bytes follow"),
        (stl_binary(count=13), "truncated"),
        (stl_binary(count=2**31), "truncated"),
        (stl_binary(np.where(CORNERS == 1.0, np.nan, CORNERS)), "not a number"),
        (stl_text()[:-300], "truncated"),
        (stl_text().replace("endsolid cube\n", ""), "truncated"),
        (stl_text().replace("1.0", "1,0"), "line 5"),
        (stl_text().replace("1.0", "x", 1), "line 5"),
        (stl_text().replace("1.0", "nan", 1), "not a number"),
        (stl_text().replace("1.0", "1_0", 1), "line 5"),
        (stl_text().replace("  vertex 0.0 0.0 0.0\n", "", 1), "line 6"),
        (stl_text().replace(" endloop", "  vertex 9 9 9\n endloop", 1), "line 8"),
        (stl_text() + "more\n", "line 87"),
        (stl_text().encode() + stl_binary(), ""),
    ],
)
def test_what_cannot_be_read_of_an_stl_file_is_refused(tmp_path, text, word):
    code, message = refused(tmp_path, text, "part.stl")
    assert code == "BAD_FILE" and word in message


def test_the_unit_is_that_of_the_scale(tmp_path):
    (tmp_path / "part.stl").write_bytes(stl_binary())
    assert read_mesh(tmp_path / "part.stl", 25.4).Volume == pytest.approx(25.4**3, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "text", "scale"),
    [
        ("part.obj", "# Units: inches\n{}", "25.4"),
        ("part.obj", "# made by us\n#  file units = meters\n{}", "1000"),
        ("part.obj", "# Units in mm\n{}", None),
        ("part.obj", "# a unit cube\n{}", None),
        ("part.stl", "solid part UNITS=cm\n{}", "10"),
    ],
)
def test_a_unit_that_a_file_states_is_told_unless_it_is_given(tmp_path, name, text, scale):
    body = stl_text().split("\n", 1)[1] if name.endswith("stl") else vertices() + faces()
    (tmp_path / name).write_text(text.format(body))
    issues = mesh_content(tmp_path / name).issues
    assert [(issue.level, issue.code) for issue in issues] == [("warning", "FILE_CONTENT")] * bool(
        scale
    )
    assert not scale or f"part.scale to {scale} mm" in issues[0].message
    assert not mesh_content(tmp_path / name, float(scale or 2.0)).issues
    head = b"UNITS=inch".ljust(80, b"\0")
    (tmp_path / "part.stl").write_bytes(head + stl_binary()[80:])
    assert "'inch'" in mesh_content(tmp_path / "part.stl").issues[0].message
