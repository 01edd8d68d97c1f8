# SPDX-License-Identifier: LGPL-2.1-or-later
"""Valid files are read completely, invalid ones give a reason, and nothing is printed."""

import re

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am import api
from freecad_am.brep.files.read import read_mesh, read_shape
from freecad_am.core.issues import InputError


@pytest.fixture
def cone():
    return Part.makeCone(20, 10, 30)


@pytest.mark.parametrize(
    "name", ["a.step", "a.STP", "b.brep", "with space.stp", "Hémisphère ø45 – été.step"]
)
def test_shapes_come_back_whole(tmp_path, cone, name):
    path = tmp_path / name
    cone.exportBrep(str(path)) if name.endswith("brep") else cone.exportStep(
        str(tmp_path / "x.step")
    )
    if not name.endswith("brep"):
        (tmp_path / "x.step").rename(path)
    shape = read_shape(path)
    assert shape.Volume == pytest.approx(cone.Volume, rel=1e-9)
    assert len(shape.Faces) == 3


def in_unit(path, cone, factor, name):
    """Write a cone with coordinates in mm to a file that states another unit."""
    cone.exportStep(str(path))
    text = path.read_text()
    (number,) = re.findall(
        r"(#\d+) ?= ?\( LENGTH_UNIT\(\) NAMED_UNIT\(\*\) SI_UNIT\(\.MILLI\.,\.METRE\.\) \);", text
    )
    unit = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({},.METRE.) )"
    prefix = {0.001: ".MICRO.", 10.0: ".CENTI.", 1000.0: "$"}.get(factor)
    lines = [f"{number} = {unit.format(prefix)};"]
    if prefix is None:
        lines = [
            f"{number} = ( CONVERSION_BASED_UNIT('{name}',#90001) LENGTH_UNIT() NAMED_UNIT(#90003) );",
            f"#90001 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({factor!r}),#90002);",
            f"#90002 = {unit.format('.MILLI.')};",
            "#90003 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);",
        ]
    path.write_text(re.sub(rf"{number} ?= ?\( LENGTH_UNIT[^;]*;", "\n".join(lines), text))


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("METRE", 1000.0),
        ("CENTIMETRE", 10.0),
        ("MICROMETRE", 0.001),
        ("INCH", 25.4),
        ("FOOT", 304.8),
        ("MIL", 0.0254),
    ],
)
def test_step_files_are_as_large_as_their_unit_says(tmp_path, cone, name, factor):
    """The next file, in mm, keeps its size too: the kernel remembers no unit, with and without a
    window."""
    cone.exportStep(str(tmp_path / "mm.step"))
    in_unit(tmp_path / "other.step", cone, factor, name)
    document = FreeCAD.newDocument("Units")
    try:
        for file, scale in (("other.step", factor), ("mm.step", 1.0), ("other.step", factor)):
            for shape in (
                read_shape(tmp_path / file),
                api.open_part(document, str(tmp_path / file)).Shape,
            ):
                box = shape.BoundBox
                sides = [box.XLength, box.YLength, box.ZLength]
                assert sides == pytest.approx([40 * scale, 40 * scale, 30 * scale], rel=1e-6)
                assert shape.Volume == pytest.approx(scale**3 * cone.Volume, rel=1e-9)
    finally:
        FreeCAD.closeDocument(document.Name)


def test_iges_comes_back(tmp_path, cone):
    cone.exportIges(str(tmp_path / "a.igs"))
    assert read_shape(str(tmp_path / "a.igs")).Area == pytest.approx(cone.Area, rel=1e-6)


@pytest.mark.parametrize(
    ("name", "content", "code"),
    [
        ("missing.step", None, "NO_FILE"),
        ("empty.step", b"", "EMPTY_FILE"),
        ("bad.step", b"no STEP file\n", "BAD_FILE"),
        ("bad.brep", b"xx", "BAD_FILE"),
        ("bad.igs", b"xx", "BAD_FILE"),
        ("binary.step", bytes(range(256)) * 20, "BAD_FILE"),
        ("part.stl", b"solid x\nendsolid x\n", "UNSUPPORTED_FILE"),
        ("part.3mf", b"x", "UNSUPPORTED_FILE"),
        ("part.OBJ", b"x", "UNSUPPORTED_FILE"),
        ("part.txt", b"x", "UNSUPPORTED_FILE"),
        ("part", b"x", "UNSUPPORTED_FILE"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name(tmp_path, name, content, code):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError) as refused:
        read_shape(path)
    assert refused.value.code == code
    assert refused.value.where == name


@pytest.mark.parametrize(
    "name", ["part.ply", "part.amf", "part.glb", "part.off", "part.dxf", "part.sldprt", "part"]
)
def test_files_of_other_formats_are_refused_with_all_that_are_read(tmp_path, name):
    (tmp_path / name).write_bytes(b"x")
    endings = [".step", ".stp", ".iges", ".igs", ".brep", ".stl", ".obj", ".3mf"]
    with pytest.raises(InputError) as caught:
        read_shape(tmp_path / name)
    assert caught.value.code == "UNSUPPORTED_FILE"
    assert all(ending in caught.value.message for ending in endings)
    with pytest.raises(InputError) as caught:
        api.open_part(FreeCAD.newDocument("Formats"), str(tmp_path / name))
    FreeCAD.closeDocument("Formats")
    endings += [".FCStd", ".csv", ".gcode", ".ada3dp"]
    assert caught.value.code == "UNSUPPORTED_FILE" and caught.value.where == name
    assert all(ending in caught.value.message for ending in endings)


@pytest.mark.parametrize("share", [0.2, 0.5, 0.9, 0.98])
def test_truncated_files_are_refused_and_standard_output_stays_clean(tmp_path, cone, share, capfd):
    cone.exportStep(str(tmp_path / "whole.step"))
    capfd.readouterr()
    content = (tmp_path / "whole.step").read_bytes()
    (tmp_path / "cut.step").write_bytes(content[: int(share * len(content))])
    with pytest.raises(InputError) as refused:
        read_shape(tmp_path / "cut.step")
    assert refused.value.code == "BAD_FILE"
    assert capfd.readouterr().out == ""


def test_damaged_content_never_reaches_standard_output(tmp_path, cone, capfd):
    cone.exportStep(str(tmp_path / "whole.step"))
    capfd.readouterr()
    text = (tmp_path / "whole.step").read_text().replace("CONICAL_SURFACE", "COMICAL_SURFACE")
    (tmp_path / "odd.step").write_text(text)
    try:
        read_shape(tmp_path / "odd.step")
    except InputError as refused:
        assert refused.code in ("BAD_FILE", "EMPTY_FILE")
    assert capfd.readouterr().out == ""


def test_a_file_without_a_shape_is_empty(tmp_path):
    Part.makeCompound([]).exportBrep(str(tmp_path / "nothing.brep"))
    with pytest.raises(InputError) as refused:
        read_shape(tmp_path / "nothing.brep")
    assert refused.value.code == "EMPTY_FILE"


def test_a_folder_is_no_file(tmp_path):
    (tmp_path / "a.step").mkdir()
    with pytest.raises(InputError, match="folder"):
        read_shape(tmp_path / "a.step")


@pytest.mark.parametrize(
    ("relative", "between"), [(False, " "), (True, " "), (False, " \\\n"), (True, " \\\r\n  ")]
)
def test_faces_of_obj_files_with_many_corners_are_read(tmp_path, relative, between):
    """A prism over a star of 16 corners, with two faces of 16 corners and sides of four corners or
    two triangles. FreeCAD drops the two faces, whose lines may continue on the next ones."""
    count, height = 16, 10.0
    angle, radius = (
        2.0 * np.pi * np.arange(count) / count,
        np.where(np.arange(count) % 2, 12.0, 5.0),
    )
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    lines = [f"v {x!r} {y!r} {z!r}" for z in (0.0, height) for x, y in ring.tolist()]
    faces = [list(range(count, 0, -1)), list(range(count + 1, 2 * count + 1))]
    for i in range(count):
        a, b, c, d = i + 1, (i + 1) % count + 1, (i + 1) % count + 1 + count, i + 1 + count
        faces += [[a, b, c, d]] if i % 2 else [[a, b, c], [a, c, d]]
    shift = 2 * count + 1 if relative else 0
    lines += [
        "f " + (between if len(face) > 4 else " ").join(f"{corner - shift}//1" for corner in face)
        for face in faces
    ]
    (tmp_path / "star.obj").write_bytes(("\n".join(lines) + "\n").encode())
    mesh = read_mesh(tmp_path / "star.obj", 2.0)
    area = 0.5 * count * 12.0 * 5.0 * np.sin(2.0 * np.pi / count)
    assert mesh.CountFacets == 2 * (count - 2) + 2 * count and mesh.isSolid()
    assert mesh.Volume == pytest.approx(8.0 * area * height, rel=1e-5)
    (tmp_path / "star.obj").write_text("\n".join([*lines, "f 1 2 3 4 99"]) + "\n")
    with pytest.raises(InputError) as caught:
        read_mesh(tmp_path / "star.obj")
    assert caught.value.code == "BAD_FILE"
