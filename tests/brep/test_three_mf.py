# SPDX-License-Identifier: LGPL-2.1-or-later
"""3MF files as others write them, and as nobody should."""

import struct
import time
import zipfile

import FreeCAD  # noqa: F401
import Mesh
import numpy as np
import pytest

from freecad_am.brep.files import three_mf
from freecad_am.brep.files.read import read_mesh
from freecad_am.core.geometry.mesh.repair import repaired
from freecad_am.core.geometry.mesh.solid import SolidMesh
from freecad_am.core.issues import InputError

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 2, 0], [0, 0, 3]], dtype=float)  # a volume of 1
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
RELATIONS = (
    '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">'
    f'<Relationship Target="/{{}}" Id="r" Type="{three_mf.MODEL_RELATION}"/></Relationships>'
)


def mesh(number, points=CORNERS, faces=FACES, kind="model"):
    vertices = "".join(
        f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in np.asarray(points).tolist()
    )
    corners = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in faces)
    return (
        f'<object id="{number}" type="{kind}"><mesh><vertices>{vertices}</vertices>'
        f"<triangles>{corners}</triangles></mesh></object>"
    )


def holder(number, *parts):
    return f'<object id="{number}"><components>{"".join(parts)}</components></object>'


def placed(tag, number, matrix=None, more=""):
    """An item or component moved by (4, 4) for columns."""
    text = (
        ""
        if matrix is None
        else ' transform="' + " ".join(map(repr, matrix[:3].T.ravel().tolist())) + '"'
    )
    return f'<{tag} objectid="{number}"{text}{more}/>'


def model(resources, items, unit="millimeter", more=""):
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><model unit="{unit}" xmlns="{three_mf.CORE}" {more}>'
        f"<resources>{resources}</resources><build>{items}</build></model>"
    )


def written(folder, text, name="part.3mf", at=three_mf.MODEL, more=(), relations=None):
    path = folder / name
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(at, text)
        for other, content in dict(more).items():
            archive.writestr(other, content)
        if relations is not None:
            archive.writestr("_rels/.rels", relations)
    return path


def moved(seed, mirrored=False):
    random = np.random.default_rng(seed)
    turned = np.linalg.qr(random.normal(size=(3, 3)))[0]
    turned *= np.sign(np.linalg.det(turned)) * (-1.0 if mirrored else 1.0)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = (
        turned @ np.diag(random.uniform(0.5, 2.0, 3)),
        random.uniform(-50.0, 50.0, 3),
    )
    return matrix


def in_place(matrix, points=CORNERS):
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def test_what_freecad_writes_comes_back(tmp_path):
    made = Mesh.createSphere(10.0, 30)
    made.addMesh(Mesh.createBox(5.0, 5.0, 5.0).copy())
    made.write(Filename=str(tmp_path / "made.3mf"), Format="3MF")
    read = read_mesh(tmp_path / "made.3mf")
    assert (read.CountFacets, read.CountPoints) == (made.CountFacets, made.CountPoints)
    theirs, ours = (
        np.array([tuple(p) for p in one.Topology[0]])[np.array(one.Topology[1])]
        for one in (made, read)
    )
    np.testing.assert_allclose(ours, theirs, atol=1e-5)


@pytest.mark.parametrize(("unit", "size"), sorted(three_mf.UNITS.items()))
def test_units(tmp_path, unit, size):
    points, corners = three_mf.triangles(written(tmp_path, model(mesh(1), placed("item", 1), unit)))
    np.testing.assert_allclose(points, CORNERS * size, rtol=1e-15)
    np.testing.assert_array_equal(corners, FACES)


def test_moves_of_items_and_of_components_in_components_follow_one_another(tmp_path):
    """Mirrored ones too: what is built is outside out, and its volume that of the object times the scale."""
    ways = [moved(seed, mirrored=seed % 2 == 1) for seed in range(5)]
    inner = holder(2, placed("component", 1, ways[0]), placed("component", 7))
    outer = holder(3, placed("component", 2, ways[1]), placed("component", 1, ways[2]))
    resources = mesh(1) + mesh(7, CORNERS * 2.0) + inner + outer
    items = (
        placed("item", 3, ways[3])
        + placed("item", 1, ways[4])
        + placed("item", 7, None, ' printable="0"')
    )
    points, corners = three_mf.triangles(written(tmp_path, model(resources, items)))
    wanted = [
        in_place(ways[3] @ ways[1] @ ways[0]),
        in_place(ways[3] @ ways[1], 2.0 * CORNERS),
        in_place(ways[3] @ ways[2]),
        in_place(ways[4]),
    ]
    np.testing.assert_allclose(points, np.vstack(wanted), atol=1e-11)
    for k, (own, way) in enumerate(
        zip(
            wanted,
            (
                ways[3] @ ways[1] @ ways[0],
                2.0 * (ways[3] @ ways[1]),
                ways[3] @ ways[2],
                ways[4],
            ),
            strict=True,
        )
    ):
        solid = SolidMesh(points, corners[4 * k : 4 * k + 4])
        assert solid.volume == pytest.approx(abs(np.linalg.det(way[:3, :3])), rel=1e-12)
        assert set(np.unique(solid.triangles)) == set(range(4 * k, 4 * k + 4)) and len(own) == 4
    assert len(repaired(points, corners, "part").solids) == 4


def test_objects_in_further_files_and_a_model_in_another_place(tmp_path):
    way = moved(11)
    other = model(mesh(5), "")
    path = f' xmlns:p="{PRODUCTION}" p:path="/3D/Objects/blade.model"'
    text = model(
        holder(1, placed("component", 5, way, path)),
        placed("item", 1),
        more=f'requiredextensions="p" xmlns:p="{PRODUCTION}"',
    )
    file = written(
        tmp_path,
        text,
        at="Odd/place.model",
        more={"3D/Objects/blade.model": other},
        relations=RELATIONS.format("Odd/place.model"),
    )
    np.testing.assert_allclose(three_mf.triangles(file)[0], in_place(way), atol=1e-12)


def test_supports_are_left_out_and_other_elements_do_not_matter(tmp_path):
    odd = '<x:vertex xmlns:x="urn:other" x="no number"/><basematerials id="9"><base name="a"/></basematerials>'
    text = model(
        odd + mesh(1) + mesh(2, CORNERS + 9.0, kind="support"),
        placed("item", 1) + placed("item", 2),
    )
    assert len(three_mf.triangles(written(tmp_path, text))[0]) == 4


def test_utf16(tmp_path):
    text = model(mesh(1), placed("item", 1)).replace("UTF-8", "UTF-16").encode("utf-16")
    assert len(three_mf.triangles(written(tmp_path, text))[0]) == 4


NESTED = "".join(holder(k + 1, *[placed("component", k)] * 4) for k in range(1, 30))
DEEP = "".join(holder(k + 1, placed("component", k)) for k in range(1, 2000))


@pytest.mark.parametrize(
    ("text", "code", "told"),
    [
        (model("", ""), "EMPTY_FILE", "no triangles"),
        (model(mesh(1), ""), "EMPTY_FILE", "no triangles"),
        (model(mesh(1, kind="support"), placed("item", 1)), "EMPTY_FILE", "no triangles"),
        (
            model(mesh(1, faces=[[0, 1, 4]]), placed("item", 1)),
            "BAD_FILE",
            "points that it has not",
        ),
        (
            model(mesh(1, faces=[[0, 1, -1]]), placed("item", 1)),
            "BAD_FILE",
            "points that it has not",
        ),
        (model(mesh(1), placed("item", 2)), "BAD_FILE", "object 2"),
        (model(holder(1, placed("component", 1)), placed("item", 1)), "BAD_FILE", "holds itself"),
        (model(mesh(1), placed("item", 1, np.diag([1.0, 1.0, 0.0, 1.0]))), "BAD_FILE", "flattens"),
        (model(mesh(1), '<item objectid="1" transform="1 0 0"/>'), "BAD_FILE", "transform"),
        (
            model(mesh(1), '<item objectid="1" transform="nan 0 0 0 1 0 0 0 1 0 0 0"/>'),
            "BAD_FILE",
            "transform",
        ),
        (model(mesh(1), "<item/>"), "BAD_FILE", "lacks 'objectid'"),
        (
            model(mesh(1).replace('x="1.0"', 'x="one"'), placed("item", 1)),
            "BAD_FILE",
            "not a number",
        ),
        (model(mesh(1).replace('x="1.0"', 'y1="1"'), placed("item", 1)), "BAD_FILE", "lacks 'x'"),
        (model(mesh(1), placed("item", 1), "furlong"), "BAD_FILE", "furlong"),
        (model(mesh(1), placed("item", 1))[:-30], "BAD_FILE", "XML"),
        (
            '<!DOCTYPE a [<!ENTITY b "b">]>' + model(mesh(1), placed("item", 1))[38:],
            "BAD_FILE",
            "document type",
        ),
        (
            model(mesh(1), placed("item", 1), more='requiredextensions="b" xmlns:b="urn:beams"'),
            "UNSUPPORTED_FILE",
            "urn:beams",
        ),
        (
            model(
                mesh(1),
                placed("item", 1),
                more='requiredextensions="s" xmlns:s="urn:securecontent"',
            ),
            "UNSUPPORTED_FILE",
            "encrypted",
        ),
        (model(mesh(1) + NESTED, placed("item", 30)), "UNSUPPORTED_FILE", "objects"),
        (model(mesh(1) + DEEP, placed("item", 2000)), "UNSUPPORTED_FILE", "nested"),
    ],
)
def test_refused_with_what_is_wrong(tmp_path, monkeypatch, text, code, told):
    monkeypatch.setattr(
        three_mf, "MOST_PLACED", 10_000
    )  # to place ten times as many comes near the limit of time
    with pytest.raises(InputError) as refused:
        read_mesh(written(tmp_path, text))
    assert (refused.value.code, refused.value.where) == (code, "part.3mf")
    assert told in refused.value.message


def test_many_placed_objects_take_time_as_they_are_many(tmp_path):
    """Points before an object were counted anew for each: eight times as many took forty times as long."""
    spent = {}
    for count in (3_000, 24_000):
        path = written(tmp_path, model(mesh(1), placed("item", 1) * count), f"{count}.3mf")
        began = time.process_time()
        found = read_mesh(path)
        spent[count] = time.process_time() - began
        assert found.CountFacets > 0
    assert spent[24_000] < 16.0 * spent[3_000]


def test_zips_that_are_none_and_zips_that_grow(tmp_path, monkeypatch):
    path = tmp_path / "part.3mf"
    path.write_bytes(b"solid\n")
    with pytest.raises(InputError, match="zip"):
        read_mesh(path)
    with pytest.raises(InputError, match="no model"):
        read_mesh(written(tmp_path, "x", at="readme.txt"))
    whole = written(tmp_path, model(mesh(1), placed("item", 1)))
    content = bytearray(whole.read_bytes())
    at = content.index(b"PK\x01\x02") + 8
    content[at : at + 2] = struct.pack("<H", 1)  # marked as encrypted
    path.write_bytes(content)
    with pytest.raises(InputError, match="encrypted"):
        read_mesh(path)
    monkeypatch.setattr(three_mf, "LARGEST", 1 << 20)
    with pytest.raises(InputError) as refused:
        read_mesh(written(tmp_path, model(mesh(1) + " " * (1 << 21), placed("item", 1))))
    assert refused.value.code == "UNSUPPORTED_FILE" and "unpacks" in refused.value.message


def test_damage_anywhere_is_refused_not_a_traceback(tmp_path):
    whole = written(
        tmp_path, model(mesh(1), placed("item", 1)), relations=RELATIONS.format(three_mf.MODEL)
    ).read_bytes()
    random = np.random.default_rng(3)
    read = 0
    for _ in range(400):
        damaged = bytearray(whole)
        if random.random() < 0.3:
            damaged = damaged[: random.integers(1, len(whole))]
        for at in random.integers(0, len(damaged), random.integers(1, 4)):
            damaged[at] = random.integers(0, 256)
        (tmp_path / "damaged.3mf").write_bytes(damaged)
        try:
            three_mf.triangles(tmp_path / "damaged.3mf")
            read += 1
        except InputError as refused:
            assert refused.where == "damaged.3mf"
    assert read < 400
