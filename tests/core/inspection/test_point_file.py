# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every file format of measuring machines and scanners gives the same points, and a message states
the interpretation."""

import struct

import numpy as np
import pytest

from freecad_am.core.inspection import point_file
from freecad_am.core.issues import InputError

POINTS = np.random.default_rng(3).uniform(-120.0, 120.0, (40, 3)).round(4)


def table(delimiter, comma=".", head="", running=False):
    lines = [head] if head else []
    for number, point in enumerate(POINTS, 1):
        cells = [f"{value:.4f}".replace(".", comma) for value in point]
        lines.append(delimiter.join([str(number), *cells] if running else cells))
    return "\n".join(lines) + "\n"


def message_of(scan):
    return scan.issues[0].message


@pytest.mark.parametrize("running", [False, True])
@pytest.mark.parametrize(
    ("delimiter", "comma"),
    [
        (",", "."),
        (";", "."),
        (";", ","),
        ("\t", "."),
        ("\t", ","),
        (" ", "."),
        ("   ", ","),
        (", ", "."),
    ],
)
def test_delimiters_and_decimal_signs_are_told_from_the_text(delimiter, comma, running):
    """Delimiter and decimal sign are detected from the text and reported."""
    scan = point_file.parse(table(delimiter, comma, running=running).encode(), "scan.csv")
    assert (scan.points == POINTS).all()
    assert ("decimal commas" in message_of(scan)) == (comma == ",")
    assert ("running number" in message_of(scan)) == running


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_headings_choose_the_columns_and_name_the_unit(encoding):
    rows = "".join(
        f"P{k};{z / 25.4:.7f};0.1;{x / 25.4:.7f};{y / 25.4:.7f}\n"
        for k, (x, y, z) in enumerate(POINTS)
    )
    text = "# Prüfung, Maß\nname;Z [in];dev;X [in];Y [in]\n" + rows
    scan = point_file.parse(text.encode(encoding), "Teil.txt")
    assert np.abs(scan.points - POINTS).max() < 1e-5
    assert (
        "by their headings" in message_of(scan)
        and "2 more columns" in message_of(scan)
        and "in inch" in message_of(scan)
    )


@pytest.mark.parametrize(
    ("head", "unit", "scale"),
    [
        ("x_m,y_m,z_m", "auto", 1000.0),
        ("# units: cm", "auto", 10.0),
        ("# Units of coordinates in cm", "auto", 10.0),
        ("// Unit = millimeters", "auto", 1.0),
        ("x,y,z", "inch", 25.4),
        ("x_m,y_m,z_m", "mm", 1.0),
        ("X (µm),Y (µm),Z (µm)", "auto", 1e-3),
        ("", "auto", 1.0),
    ],
)
def test_units(head, unit, scale):
    scan = point_file.parse(table(",", head=head).encode(), "scan.xyz", unit)
    assert np.abs(scan.points - scale * POINTS).max() < 1e-9
    assert ("names no unit" in message_of(scan)) == (head == "")


def test_lines_that_are_no_points_are_left_out_and_told():
    """Lines that are not points are skipped and reported."""
    lines = table(";").splitlines()
    lines[5] = "probe error"
    lines[9] = "1;2"
    lines.append("nan;1;2")
    scan = point_file.parse("\n".join(lines).encode(), "scan.csv")
    assert len(scan.points) == len(POINTS) - 2
    assert "2 lines that are not points are ignored, the first in line 6" in message_of(scan)
    assert "1 points without finite" in message_of(scan) and scan.issues[0].level == "warning"


def binary_stl(corners):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *triangle.ravel(), 0) for triangle in corners)
    return b"solid by a scanner".ljust(80) + struct.pack("<I", len(corners)) + body


def ascii_stl(corners):
    text = "".join(
        "facet normal 0 0 0\n outer loop\n"
        + "".join(f"  vertex {x:.6e} {y:.6e} {z:.6e}\n" for x, y, z in triangle)
        + " endloop\nendfacet\n"
        for triangle in corners
    )
    return f"solid s\n{text}endsolid s\n".encode()


@pytest.mark.parametrize("write", [binary_stl, ascii_stl])
def test_vertices_of_stl_come_once(write):
    points = POINTS.astype(np.float32)
    corners = points[np.random.default_rng(0).permutation(np.r_[:40, :38]).reshape(-1, 3)]
    vertices = point_file.parse(write(corners), "scan.stl").points
    assert np.abs(vertices - np.unique(points.astype(float), axis=0)).max() < 1e-4


def ply(kind):
    head = (
        f"ply\nformat {kind} 1.0\ncomment by a scanner\nelement vertex {len(POINTS)}\nproperty float x\nproperty uchar red\n"
        "property double y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    if kind == "ascii":
        return (head + "".join(f"{x} 7 {y} {z}\n" for x, y, z in POINTS) + "3 0 1 2\n").encode()
    sign = "<" if kind == "binary_little_endian" else ">"
    return (
        head.encode()
        + b"".join(struct.pack(f"{sign}fBdf", x, 7, y, z) for x, y, z in POINTS)
        + b"\x03"
        + bytes(12)
    )


@pytest.mark.parametrize("kind", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_vertices_of_ply(kind):
    assert np.abs(point_file.parse(ply(kind), "scan.ply").points - POINTS).max() < 1e-5


def test_vertices_of_obj():
    text = (
        "# obj\n"
        + "".join(f"v {x} {y} {z} 0.5 0.5 0.5\nvn 0 0 1\n" for x, y, z in POINTS)
        + "f 1 2 3\n"
    )
    assert (point_file.parse(text.encode(), "scan.OBJ").points == POINTS).all()


def test_large_scans_are_thinned_evenly(monkeypatch):
    monkeypatch.setattr(point_file, "MAX_POINTS", 10)
    scan = point_file.parse(table(",").encode(), "scan.csv")
    assert (
        scan.points == POINTS[np.linspace(0, 39, 10).astype(int)]
    ).all() and "of 40 points, 10 evenly distributed ones are used" in message_of(scan)


@pytest.mark.parametrize(
    ("data", "name", "code"),
    [
        (b"", "scan.csv", "EMPTY_FILE"),
        (b" \n", "scan.stl", "EMPTY_FILE"),
        (b"a;b;c\nd;e;f\n", "scan.csv", "NO_POINTS"),
        (b"1 2\n3 4\n", "scan.txt", "NO_POINTS"),
        (b"1,25,2,50,3,75\n4,25,5,50,6,75\n", "scan.csv", "AMBIGUOUS"),
        (b"1 2 3\n" + b"no point\n" * 5, "scan.xyz", "BAD_FILE"),
        (b"nan nan nan\n", "scan.xyz", "NO_POINTS"),
        (b"ply\nformat ascii 1.0\n", "scan.ply", "BAD_FILE"),
        (ply("binary_little_endian")[:-200], "scan.ply", "BAD_FILE"),
        (b"v 1 2 three\n", "scan.obj", "BAD_FILE"),
        (b"no mesh at all", "scan.stl", "NO_POINTS"),
    ],
)
def test_what_is_no_points_is_refused(data, name, code):
    with pytest.raises(InputError) as caught:
        point_file.parse(data, name)
    assert caught.value.code == code and caught.value.where.startswith(name)


def test_files_are_told_by_their_ending_and_missing_ones_by_their_path(tmp_path):
    with pytest.raises(InputError, match="docx is not a supported point format"):
        point_file.read(tmp_path / "scan.docx")
    with pytest.raises(InputError) as caught:
        point_file.read(tmp_path / "scan.csv")
    assert caught.value.code == "NO_FILE"


@pytest.mark.parametrize(
    ("head", "code", "words"),
    [
        (
            "x nominal;y nominal;z nominal;x actual;y actual;z actual",
            "AMBIGUOUS",
            "x nominal, x actual",
        ),
        ("x [ft];y [ft];z [ft];a;b;c", "BAD_UNIT", "x [ft]"),
        ("x [mm];y [inch];z [mm];a;b;c", "BAD_UNIT", "different units"),
    ],
)
def test_headings_that_leave_a_choice_are_refused(head, code, words):
    rows = "".join(f"{k};{2 * k};{3 * k};{k + 1};{2 * k + 1};{3 * k + 1}\n" for k in range(5))
    with pytest.raises(InputError) as refused:
        point_file.parse(f"{head}\n{rows}".encode(), "scan.csv")
    assert refused.value.code == code and words in refused.value.message


PLY = "ply\nformat ascii 1.0\n{}element vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n"


@pytest.mark.parametrize(
    ("name", "text", "code", "words"),
    [
        ("a.csv", "x [furlong],y,z\n1,2,3\n", "BAD_UNIT", "x [furlong]"),
        ("a.csv", "# units: ft\nx,y,z\n1,2,3\n", "BAD_UNIT", "# units: ft"),
        ("a.csv", "# unit: yards\n1,2,3\n", "BAD_UNIT", "yards"),
        ("a.csv", "a,b,c\n1,2,3\n", "AMBIGUOUS", "called a, b, c"),
        ("a.csv", "east;north;up\n1,5;2;3\n", "AMBIGUOUS", "called east, north, up"),
        ("a.csv", "id,px,py,pz\n7,2,3,4\n1,2,3,4\n", "AMBIGUOUS", "id, px, py, pz"),
        ("a.csv", 'x,y,z\n1.5,5,6\n"1,5",6,7\n', "BAD_FILE", "4 values"),
        ("a.csv", "x,y,z\n1,2,3\n1,5,2,3\n", "BAD_FILE", "4 values"),
        ("a.ply", PLY.format("comment unit: feet\n"), "BAD_UNIT", "feet"),
        ("a.obj", "# units = yd\nv 1 2 3\nv 1 2 4\nv 1 3 4\nf 1 2 3\n", "BAD_UNIT", "yd"),
    ],
)
def test_units_and_columns_that_are_not_known_are_refused(name, text, code, words):
    with pytest.raises(InputError) as raised:
        point_file.parse(text.encode("utf-8"), name)
    assert raised.value.code == code and words in raised.value.message


@pytest.mark.parametrize(
    ("name", "text", "scale"),
    [
        ("a.ply", PLY.format("comment unit: inch\n"), 25.4),
        ("a.ply", PLY.format("obj_info units = m\n"), 1000.0),
        ("a.ply", PLY.format("comment made by a scanner in Minnesota\n"), 1.0),
        ("a.csv", "Points:0,Points:1,Points:2\n1,2,3\n", 1.0),
        ("a.csv", "\ufeffX [cm];Y [cm];Z [cm]\r\n1,0;2,0;3,0\r\n", 10.0),
        ("a.csv", "x,y,z,\n1,2,3,\n", 1.0),
    ],
)
def test_units_of_heads_and_remarks_are_read(name, text, scale):
    measured = point_file.parse(text.encode("utf-8"), name)
    np.testing.assert_allclose(measured.points, [[scale, 2 * scale, 3 * scale]])
