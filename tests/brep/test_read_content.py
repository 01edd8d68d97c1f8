# SPDX-License-Identifier: LGPL-2.1-or-later
"""STEP, IGES and BREP files contain more than the geometry kernel reads: dropped content is
rejected or reported."""

import re

import FreeCAD
import Part
import pytest

from freecad_am.brep.files import read
from freecad_am.brep.files.read import read_shape, shape_content
from freecad_am.brep.kernel.process import SANDBOXED
from freecad_am.core.issues import InputError

TETRA = """#9020=COORDINATES_LIST('',4,((0.,0.,0.),(10.,0.,0.),(0.,10.,0.),(0.,0.,10.)));
#9021=TRIANGULATED_FACE('',#9020,4,(),$,(),((1,3,2),(1,2,4),(2,3,4),(3,1,4)));
"""
SOLID = TETRA + "#9022=TESSELLATED_SOLID('te,tra (1)',(#9021),{});\n"
SHELL = TETRA + "#9022=TESSELLATED_SHELL('tetra',(#9021),{});\n"
REPRESENTED = "#9023=TESSELLATED_SHAPE_REPRESENTATION('',({}),#9013);\n"


def step_text(tmp_path, shape):
    path = tmp_path / "exact.step"
    shape.exportStep(str(path))
    return path.read_text()


def add_lines(text, lines):
    """Return a STEP file with additional entities."""
    return text.replace("ENDSEC;\nEND-ISO", lines + "ENDSEC;\nEND-ISO")


def remove_geometry(text, lines=""):
    """Return a STEP file that defines a product whose representation is given by `lines` as #9022,
    or empty."""
    header, data = text.split("DATA;")
    kept_lines = [
        line
        for line in data.split(";\n")
        if re.match(
            r"\s*#\d+ ?= ?(APPLICATION|PRODUCT|.*UNIT|UNCERTAINTY|\(? ?GEOMETRIC_REPRESENTATION_CONTEXT)",
            line,
        )
    ]
    return (
        header + "DATA;\n" + ";\n".join(kept_lines) + ";\n" + lines + "ENDSEC;\nEND-ISO-10303-21;\n"
    )


def refused(tmp_path, text, code, name="odd.step"):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_shape(path)
    assert caught.value.code == code and caught.value.where == name
    return caught.value.message


@pytest.fixture
def exact(tmp_path):
    return step_text(tmp_path, Part.makeBox(10, 20, 30))


@pytest.mark.parametrize(
    ("lines", "item"),
    [
        (SOLID.format("$"), "#9022"),
        (SHELL.format("$"), "#9022"),
        (TETRA, "#9021"),
        (TETRA.replace("9021=TRI", "9021=COMPLEX_TRI"), "#9021"),
    ],
)
def test_triangles_alone_are_refused_as_what_they_are(tmp_path, exact, lines, item):
    text = remove_geometry(exact, lines + REPRESENTED.format(item))
    message = refused(tmp_path, text, "UNSUPPORTED_FILE")
    assert "the faces have no surfaces" in message and "export exact faces" in message


@pytest.mark.parametrize("lines", [SOLID, SHELL])
def test_triangles_beside_exact_solids_are_refused_where_they_stand_for_no_other(
    tmp_path, exact, lines
):
    (number,) = re.findall(r"(#\d+) ?= ?MANIFOLD_SOLID_BREP", exact)
    message = refused(tmp_path, add_lines(exact, lines.format("$")), "UNSUPPORTED_FILE")
    assert "some faces have no surfaces" in message
    (tmp_path / "both.step").write_text(add_lines(exact, lines.format(number)))
    shape, issues = shape_content(tmp_path / "both.step")
    assert shape.Volume == pytest.approx(6000.0) and issues == ()


def test_faces_that_the_kernel_reads_without_surfaces_are_refused(tmp_path, monkeypatch):
    """FreeCAD 1.0 raises TypeError for the surface of such a face, from any file."""

    class Bare:
        @property
        def Surface(self):
            raise TypeError("undefined surface type")

    class Read:
        Faces = (Bare(), Part.makeBox(1, 1, 1).Faces[0])

    monkeypatch.setenv(SANDBOXED, "1")  # only this process has the replaced function
    monkeypatch.setattr(read, "_read_shape", lambda *_: Read())
    assert "1 of 2 faces" in refused(tmp_path, "any", "UNSUPPORTED_FILE", "bare.brep")


@pytest.mark.parametrize(
    "entity",
    [
        "#9030=SPHERE('',5.,#1);\n",
        "#9030=CSG_SOLID('',#1);\n",
        "#9030=EXTRUDED_AREA_SOLID('',#1,#2,5.);\n",
    ],
)
def test_constructed_solids_beside_exact_ones_are_refused(tmp_path, exact, entity):
    message = refused(tmp_path, add_lines(exact, entity), "UNSUPPORTED_FILE")
    assert "constructive geometry" in message and entity.split("=")[1].split("(")[0] in message


def test_parts_in_other_files_are_refused_by_their_names_and_papers_are_not(tmp_path, exact):
    lines = "#9030=DOCUMENT_FILE('{}','',$,#9031,'',$);\n#9031=DOCUMENT_TYPE('geometry');\n"
    message = refused(tmp_path, add_lines(exact, lines.format("wheel.stp")), "UNSUPPORTED_FILE")
    assert "wheel.stp" in message
    (tmp_path / "paper.step").write_text(add_lines(exact, lines.format("notes.pdf")))
    assert read_shape(tmp_path / "paper.step").Volume == pytest.approx(6000.0)


def test_a_file_of_product_data_alone_is_empty_not_damaged(tmp_path, exact):
    assert "no shape" in refused(tmp_path, remove_geometry(exact), "EMPTY_FILE")


def test_a_lost_solid_is_refused_with_the_counts(tmp_path):
    two = Part.makeCompound([Part.makeBox(1, 1, 1), Part.makeBox(1, 1, 1, FreeCAD.Vector(5, 0, 0))])
    text = step_text(tmp_path, two)
    damaged_text = re.sub(r"(MANIFOLD_SOLID_BREP\('[^']*',)#\d+", r"\1#99999", text, count=1)
    message = refused(tmp_path, damaged_text, "BAD_FILE")
    assert "1 of 2 solids and 6 of 12 faces" in message


def test_a_solid_that_is_read_as_faces_alone_is_warned_about(tmp_path, monkeypatch):
    """A real file has this effect; here the kernel's answer is replaced."""
    box = Part.makeBox(1, 1, 1)
    text = step_text(tmp_path, box)
    monkeypatch.setenv(SANDBOXED, "1")  # only this process has the replaced function
    monkeypatch.setattr(read, "_read_shape", lambda *_: box.Shells[0])
    (tmp_path / "shell.step").write_text(text)
    _, (issue,) = shape_content(tmp_path / "shell.step")
    assert issue.level == "warning" and "1 of 1 solids" in issue.message
    monkeypatch.setattr(read, "_read_shape", lambda *_: Part.makeCompound([box.Faces[0], box]))
    assert shape_content(tmp_path / "shell.step")[1] == ()


def test_invisible_items_and_construction_geometry_are_told(tmp_path, exact):
    lines = "#9030=INVISIBILITY((#1));\n#9031=CONSTRUCTIVE_GEOMETRY_REPRESENTATION('',(),#1);\n"
    (tmp_path / "told.step").write_text(add_lines(exact, lines))
    shape, issues = shape_content(tmp_path / "told.step")
    assert shape.Volume == pytest.approx(6000.0)
    assert [issue.level for issue in issues] == ["note", "note"]
    assert "invisible" in issues[0].message and "construction" in issues[1].message


def test_assemblies_in_which_a_part_is_there_often_are_read_without_a_word(tmp_path):
    document = FreeCAD.newDocument("Often")
    try:
        cup = Part.makeCylinder(5, 10)
        copies = [Part.Shape(cup) for _ in range(4)]
        for k, copy in enumerate(copies):
            copy.translate(FreeCAD.Vector(20 * k, 0, 0))
        Part.makeCompound(copies).exportStep(str(tmp_path / "often.step"))
    finally:
        FreeCAD.closeDocument(document.Name)
    shape, issues = shape_content(tmp_path / "often.step")
    assert len(shape.Solids) == 4 and issues == ()


def iges(entities, hidden=()):
    """Return an IGES file of entities of these types, with empty parameters."""
    lines = [("an IGES file", "S")]
    lines += [("1H,,1H;,1Hx,1Hx,1Hx,1Hx,32,38,6,308,15,1Hx,1.,2,2HMM,1,0.1,", "G")]
    lines += [("15H20260101.000000,1E-06,100.,1Hx,1Hx,11,0,15H20260101.000000;", "G")]
    directory, parameters = [], []
    for k, (kind, values) in enumerate(entities):
        number = 2 * k + 1
        first_fields = [kind, k + 1, 0, 0, 0, 0, 0, 0]
        directory.append(
            (
                "".join(f"{v:>8}" for v in first_fields)
                + ("01" if k in hidden else "00")
                + 6 * "0",
                "D",
            )
        )
        directory.append(("".join(f"{v:>8}" for v in (kind, 0, 0, 1, 0)), "D"))
        parameters.append((f"{kind},{values};".ljust(64) + f"{number:>8}", "P"))
    lines += directory + parameters
    counts, texts = dict.fromkeys("SGDP", 0), []
    for text, section in lines:
        counts[section] += 1
        texts.append(f"{text:<72}{section}{counts[section]:>7}")
    ends = "".join(f"{section}{counts[section]:>7}" for section in "SGDP")
    return "\n".join([*texts, f"{ends:<72}T{1:>7}"]) + "\n"


LINE = (110, "0.,0.,0.,10.,0.,0.")


def test_iges_files_with_what_the_kernel_does_not_read(tmp_path):
    sphere = iges([LINE, (158, "5.,0.,0.,0.")])
    assert "sphere" in refused(tmp_path, sphere, "UNSUPPORTED_FILE", "ball.igs")
    second_line = iges([LINE, (416, "5Hother")])
    assert "other files" in refused(tmp_path, second_line, "UNSUPPORTED_FILE", "ref.igs")
    note = iges([(212, "1,4,4.,1.,1,1.5708,0.,0,0,0.,0.,0.,4Htext")])
    assert "no shape" in refused(tmp_path, note, "EMPTY_FILE", "note.igs")
    second_line = (110, "0.,5.,0.,10.,5.,0.")
    (tmp_path / "lines.igs").write_text(iges([LINE, second_line]))
    shape, issues = shape_content(tmp_path / "lines.igs")
    assert len(shape.Edges) == 2 and issues == ()
    (tmp_path / "lines.igs").write_text(iges([LINE, second_line], hidden=[1]))
    shape, (issue,) = shape_content(tmp_path / "lines.igs")
    assert len(shape.Edges) == 1 and issue.level == "note" and "invisible" in issue.message
    hidden = iges([LINE, second_line], hidden=[0, 1])
    assert "invisible" in refused(tmp_path, hidden, "EMPTY_FILE", "hidden.igs")
