# SPDX-License-Identifier: LGPL-2.1-or-later
"""3MF files in the styles of several programs, and invalid ones."""

import itertools
import struct
import sys
import zipfile

import FreeCAD
import Mesh
import numpy as np
import pytest

from freecad_am import api
from freecad_am.brep.files import read, three_mf, three_mf_roles
from freecad_am.brep.files.read import mesh_content, read_mesh
from freecad_am.core.geometry.mesh.repair import repair_mesh
from freecad_am.core.geometry.mesh.solid import SolidMesh
from freecad_am.core.issues import InputError

pytestmark = pytest.mark.any_version

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


def holder(number, *components):
    return f'<object id="{number}"><components>{"".join(components)}</components></object>'


def place_item(tag, number, matrix=None, attributes=""):
    """Return an item or component moved by (4, 4) for columns."""
    text = (
        ""
        if matrix is None
        else ' transform="' + " ".join(map(repr, matrix[:3].T.ravel().tolist())) + '"'
    )
    return f'<{tag} objectid="{number}"{text}{attributes}/>'


def model(resources, items, unit="millimeter", extra=""):
    return (
        f'<?xml version="1.0" encoding="UTF-8"?><model unit="{unit}" xmlns="{three_mf.CORE}" {extra}>'
        f"<resources>{resources}</resources><build>{items}</build></model>"
    )


def write_file(
    folder, text, name="part.3mf", model_path=three_mf.MODEL, other_files=(), relations=None
):
    path = folder / name
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(model_path, text)
        for file_name, content in dict(other_files).items():
            archive.writestr(file_name, content)
        if relations is not None:
            archive.writestr("_rels/.rels", relations)
    return path


def random_move(seed, mirrored=False):
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
    sphere = Mesh.createSphere(10.0, 30)
    sphere.addMesh(Mesh.createBox(5.0, 5.0, 5.0).copy())
    sphere.write(Filename=str(tmp_path / "made.3mf"), Format="3MF")
    read_back = read_mesh(tmp_path / "made.3mf")
    assert (read_back.CountFacets, read_back.CountPoints) == (
        sphere.CountFacets,
        sphere.CountPoints,
    )
    theirs, ours = (
        np.array([tuple(p) for p in mesh_.Topology[0]])[np.array(mesh_.Topology[1])]
        for mesh_ in (sphere, read_back)
    )
    np.testing.assert_allclose(ours, theirs, atol=1e-5)


@pytest.mark.parametrize(("unit", "size"), sorted(three_mf.UNITS.items()))
def test_units(tmp_path, unit, size):
    points, corners = three_mf.triangles(
        write_file(tmp_path, model(mesh(1), place_item("item", 1), unit))
    )
    np.testing.assert_allclose(points, CORNERS * size, rtol=1e-15)
    np.testing.assert_array_equal(corners, FACES)


def test_moves_of_items_and_of_components_in_components_follow_one_another(tmp_path):
    """For mirrored ones too, faces look outwards, and the volume is that of the object times the
    scale."""
    moves_ = [random_move(seed, mirrored=seed % 2 == 1) for seed in range(5)]
    inner = holder(2, place_item("component", 1, moves_[0]), place_item("component", 7))
    outer = holder(3, place_item("component", 2, moves_[1]), place_item("component", 1, moves_[2]))
    resources = mesh(1) + mesh(7, CORNERS * 2.0) + inner + outer
    items = (
        place_item("item", 3, moves_[3])
        + place_item("item", 1, moves_[4])
        + place_item("item", 7, None, ' printable="0"')
    )
    points, corners = three_mf.triangles(write_file(tmp_path, model(resources, items)))
    expected = [
        in_place(moves_[3] @ moves_[1] @ moves_[0]),
        in_place(moves_[3] @ moves_[1], 2.0 * CORNERS),
        in_place(moves_[3] @ moves_[2]),
        in_place(moves_[4]),
    ]
    np.testing.assert_allclose(points, np.vstack(expected), atol=1e-11)
    for k, (own_points, move) in enumerate(
        zip(
            expected,
            (
                moves_[3] @ moves_[1] @ moves_[0],
                2.0 * (moves_[3] @ moves_[1]),
                moves_[3] @ moves_[2],
                moves_[4],
            ),
            strict=True,
        )
    ):
        solid = SolidMesh(points, corners[4 * k : 4 * k + 4])
        assert solid.volume == pytest.approx(abs(np.linalg.det(move[:3, :3])), rel=1e-12)
        assert (
            set(np.unique(solid.triangles)) == set(range(4 * k, 4 * k + 4)) and len(own_points) == 4
        )
    assert len(repair_mesh(points, corners, "part").solids) == 4


def test_objects_in_further_files_and_a_model_in_another_place(tmp_path):
    move = random_move(11)
    second_model = model(mesh(5), "")
    path = f' xmlns:p="{PRODUCTION}" p:path="/3D/Objects/blade.model"'
    text = model(
        holder(1, place_item("component", 5, move, path)),
        place_item("item", 1),
        extra=f'requiredextensions="p" xmlns:p="{PRODUCTION}"',
    )
    file = write_file(
        tmp_path,
        text,
        model_path="Odd/place.model",
        other_files={"3D/Objects/blade.model": second_model},
        relations=RELATIONS.format("Odd/place.model"),
    )
    np.testing.assert_allclose(three_mf.triangles(file)[0], in_place(move), atol=1e-12)


def test_supports_are_left_out_and_other_elements_do_not_matter(tmp_path):
    odd = '<x:vertex xmlns:x="urn:other" x="no number"/><basematerials id="9"><base name="a"/></basematerials>'
    text = model(
        odd + mesh(1) + mesh(2, CORNERS + 9.0, kind="support"),
        place_item("item", 1) + place_item("item", 2),
    )
    assert len(three_mf.triangles(write_file(tmp_path, text))[0]) == 4


def test_utf16(tmp_path):
    text = model(mesh(1), place_item("item", 1)).replace("UTF-8", "UTF-16").encode("utf-16")
    assert len(three_mf.triangles(write_file(tmp_path, text))[0]) == 4


NESTED = "".join(holder(k + 1, *[place_item("component", k)] * 4) for k in range(1, 30))
DEEP = "".join(holder(k + 1, place_item("component", k)) for k in range(1, 2000))


@pytest.mark.parametrize(
    ("text", "code", "told"),
    [
        (model("", ""), "EMPTY_FILE", "no triangles"),
        (model(mesh(1), ""), "EMPTY_FILE", "no triangles"),
        (model(mesh(1, kind="support"), place_item("item", 1)), "EMPTY_FILE", "no triangles"),
        (
            model(mesh(1, faces=[[0, 1, 4]]), place_item("item", 1)),
            "BAD_FILE",
            "missing vertices",
        ),
        (
            model(mesh(1, faces=[[0, 1, -1]]), place_item("item", 1)),
            "BAD_FILE",
            "missing vertices",
        ),
        (model(mesh(1), place_item("item", 2)), "BAD_FILE", "object 2"),
        (
            model(holder(1, place_item("component", 1)), place_item("item", 1)),
            "BAD_FILE",
            "contains itself",
        ),
        (
            model(mesh(1), place_item("item", 1, np.diag([1.0, 1.0, 0.0, 1.0]))),
            "BAD_FILE",
            "flattens",
        ),
        (model(mesh(1), '<item objectid="1" transform="1 0 0"/>'), "BAD_FILE", "transform"),
        (
            model(mesh(1), '<item objectid="1" transform="nan 0 0 0 1 0 0 0 1 0 0 0"/>'),
            "BAD_FILE",
            "transform",
        ),
        (model(mesh(1), "<item/>"), "BAD_FILE", "lacks 'objectid'"),
        (
            model(mesh(1).replace('x="1.0"', 'x="one"'), place_item("item", 1)),
            "BAD_FILE",
            "not a number",
        ),
        (
            model(mesh(1).replace('x="1.0"', 'y1="1"'), place_item("item", 1)),
            "BAD_FILE",
            "lacks 'x'",
        ),
        (model(mesh(1), place_item("item", 1), "furlong"), "BAD_FILE", "furlong"),
        (model(mesh(1), place_item("item", 1))[:-30], "BAD_FILE", "XML"),
        (
            '<!DOCTYPE a [<!ENTITY b "b">]>' + model(mesh(1), place_item("item", 1))[38:],
            "BAD_FILE",
            "document type",
        ),
        (
            model(
                mesh(1), place_item("item", 1), extra='requiredextensions="b" xmlns:b="urn:beams"'
            ),
            "UNSUPPORTED_FILE",
            "urn:beams",
        ),
        (
            model(
                mesh(1),
                place_item("item", 1),
                extra='requiredextensions="s" xmlns:s="urn:securecontent"',
            ),
            "UNSUPPORTED_FILE",
            "encrypted",
        ),
        (model(mesh(1) + NESTED, place_item("item", 30)), "UNSUPPORTED_FILE", "objects"),
        (model(mesh(1) + DEEP, place_item("item", 2000)), "UNSUPPORTED_FILE", "nested"),
    ],
)
def test_refused_with_what_is_wrong(tmp_path, monkeypatch, text, code, told):
    monkeypatch.setattr(
        three_mf, "MAX_PLACED_OBJECTS", 10_000
    )  # placing ten times as many nearly reaches the time limit
    with pytest.raises(InputError) as refused:
        read_mesh(write_file(tmp_path, text))
    assert (refused.value.code, refused.value.where) == (code, "part.3mf")
    assert told in refused.value.message


def count_calls(function):
    """Return the number of function calls, including compiled ones, while a function runs."""
    calls = itertools.count()

    def count(frame, event, argument):
        if event in ("call", "c_call"):
            next(calls)

    sys.setprofile(count)
    try:
        function()
    finally:
        sys.setprofile(None)
    return next(calls)


def test_calls_grow_with_the_number_of_placed_objects(tmp_path):
    """Points before an object were once counted again for each: eight times as many objects took
    forty times as long."""
    small_count, large_count = 500, 4_000
    calls = {}
    for count in (small_count, large_count):
        path = write_file(tmp_path, model(mesh(1), place_item("item", 1) * count), f"{count}.3mf")
        calls[count] = count_calls(lambda path=path: three_mf.triangles(path))
    assert calls[small_count] > small_count
    assert calls[large_count] < 1.2 * (large_count / small_count) * calls[small_count]


def test_zips_that_are_none_and_zips_that_grow(tmp_path, monkeypatch):
    path = tmp_path / "part.3mf"
    path.write_bytes(b"solid\n")
    with pytest.raises(InputError, match="zip"):
        read_mesh(path)
    with pytest.raises(InputError, match="no model"):
        read_mesh(write_file(tmp_path, "x", model_path="readme.txt"))
    archive = write_file(tmp_path, model(mesh(1), place_item("item", 1)))
    content = bytearray(archive.read_bytes())
    offset = content.index(b"PK\x01\x02") + 8
    content[offset : offset + 2] = struct.pack("<H", 1)  # marked as encrypted
    path.write_bytes(content)
    with pytest.raises(InputError, match="encrypted"):
        read_mesh(path)
    monkeypatch.setattr("freecad_am.brep.files.three_mf.MAX_UNPACKED_BYTES", 1 << 20)
    path = write_file(tmp_path, model(mesh(1) + " " * (1 << 21), place_item("item", 1)))
    with pytest.raises(InputError) as refused:
        read._mesh(path, "part", 1.0)  # in this process, which has another limit
    assert refused.value.code == "UNSUPPORTED_FILE" and "unpacks" in refused.value.message


def test_damage_anywhere_is_refused_not_a_traceback(tmp_path):
    archive = write_file(
        tmp_path, model(mesh(1), place_item("item", 1)), relations=RELATIONS.format(three_mf.MODEL)
    ).read_bytes()
    random = np.random.default_rng(3)
    read_count = 0
    for _ in range(400):
        damaged = bytearray(archive)
        if random.random() < 0.3:
            damaged = damaged[: random.integers(1, len(archive))]
        for position in random.integers(0, len(damaged), random.integers(1, 4)):
            damaged[position] = random.integers(0, 256)
        (tmp_path / "damaged.3mf").write_bytes(damaged)
        try:
            three_mf.triangles(tmp_path / "damaged.3mf")
            read_count += 1
        except InputError as refused:
            assert refused.where == "damaged.3mf"
    assert read_count < 400


# ---- roles of volumes, and extensions

CUBE = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
CUBE_FACES = np.array(
    [
        *([0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5]),
        *([0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]),
        *([0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]),
    ]
)
BLOCK = CUBE * 30.0
TOOL = CUBE * 40.0 + [-5.0, -5.0, 15.0]
BOTH = np.vstack([BLOCK, TOOL])
BOTH_FACES = np.vstack([CUBE_FACES, CUBE_FACES + 8])
PRUSA, BAMBU = "Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"


def prusa(*volumes, number=1):
    """Return PrusaSlicer's file of roles for an object: (first, last, metadata)."""
    texts = "".join(
        f'<volume firstid="{first_triangle}" lastid="{last_triangle}">'
        + "".join(f'<metadata type="volume" key="{k}" value="{v}"/>' for k, v in keys.items())
        + "</volume>"
        for first_triangle, last_triangle, keys in volumes
    )
    return (
        '<?xml version="1.0" encoding="UTF-8"?><config>'
        f'<object id="{number}" instances_count="1"><metadata type="object" key="name" value="it"/>{texts}</object></config>'
    )


def bambu(number, **subtypes):
    volume_texts = "".join(
        f'<part id="{number[1:]}" subtype="{kind}"><metadata key="name" value="piece {number}"/></part>'
        for number, kind in subtypes.items()
    )
    return f'<config><object id="{number}">{volume_texts}</object></config>'


def volume_and_notes(path):
    mesh, issues = mesh_content(path)
    points, corners = (
        np.array([tuple(p) for p in mesh.Topology[0]]),
        np.array(mesh.Topology[1], dtype=np.intp),
    )
    assert all(issue.level == "note" and issue.code == "FILE_CONTENT" for issue in issues)
    return SolidMesh(points, corners).volume, [issue.message for issue in issues]


@pytest.mark.parametrize(
    ("role", "wanted", "word"),
    [
        ("ModelPart", 27000.0 + 64000.0, None),
        ("NegativeVolume", 13500.0, "subtracted"),
        ("ParameterModifier", 27000.0, "'tool': modifier"),
        ("SupportBlocker", 27000.0, "'tool': support blocker"),
        ("SupportEnforcer", 27000.0, "'tool': support enforcer"),
    ],
)
@pytest.mark.parametrize("moved_too", [False, True])
def test_roles_of_prusaslicer(tmp_path, role, wanted, word, moved_too):
    config = prusa(
        (0, 11, {"name": "body", "volume_type": "ModelPart"}),
        (12, 23, {"name": "tool", "volume_type": role}),
    )
    move = random_move(3) if moved_too else None
    size = 1.0 if move is None else np.linalg.det(move[:3, :3])
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1, move))
    volume, notes = volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: config}))
    assert volume == pytest.approx(wanted * size, rel=1e-5)
    assert len(notes) == (word is not None) and (word is None or word in notes[0])


def test_prefixes_that_prusaslicer_does_not_declare(tmp_path):
    """PrusaSlicer 2.9.2 writes its embossed texts in this form, in a file of roles without
    namespaces."""
    config = prusa((0, 11, {}), (12, 23, {"volume_type": "NegativeVolume"}))
    config = config.replace("</volume>", '<slic3rpe:text text="V"/></volume>')
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1))
    volume, _ = volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: config}))
    assert volume == pytest.approx(13500.0)


def test_sliced_files_name_their_program(tmp_path):
    path = write_file(tmp_path, model("", ""), other_files={"Metadata/plate_1.gcode": "G1 X1"})
    with pytest.raises(InputError, match=r"G-code \(Metadata/plate_1\.gcode\)"):
        three_mf.content(path)


def test_modifiers_of_older_slicers(tmp_path):
    old = prusa((0, 11, {}), (12, 23, {"modifier": "1"}))
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1))
    assert volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: old}))[0] == 27000.0
    volumes = (
        '<s:volumes xmlns:s="http://schemas.slic3r.org/3mf/2017/06"><s:volume ts="0" te="11" modifier="0"/>'
        '<s:volume ts="12" te="23" modifier="1"/></s:volumes></mesh>'
    )
    slic3r = model(mesh(1, BOTH, BOTH_FACES).replace("</mesh>", volumes), place_item("item", 1))
    assert volume_and_notes(write_file(tmp_path, slic3r))[0] == 27000.0


def test_a_negative_volume_cuts_the_item_it_belongs_to_alone(tmp_path):
    config = prusa((0, 11, {}), (12, 23, {"volume_type": "NegativeVolume"}))
    text = model(
        mesh(1, BOTH, BOTH_FACES) + mesh(2, BLOCK + [10.0, 0.0, 0.0], CUBE_FACES),
        place_item("item", 1) + place_item("item", 2),
    )
    volume, _ = volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: config}))
    assert volume == pytest.approx(13500.0 + 27000.0)


def test_a_round_negative_volume_leaves_what_is_outside_of_it(tmp_path):
    """The volume of a prism with n corners is known; FreeCAD's own difference of meshes is off by 4
    %."""
    n, radius = 48, 5.0
    turn = 2.0 * np.pi * np.arange(n) / n
    ring = np.stack([15.0 + radius * np.cos(turn), 15.0 + radius * np.sin(turn)], axis=1)
    rod = np.vstack([np.c_[ring, np.full(n, z)] for z in (-5.0, 35.0)])
    k, following = np.arange(n), (np.arange(n) + 1) % n
    fan = np.arange(1, n - 1)
    faces = np.vstack(
        [
            np.c_[k, following, n + following],
            np.c_[k, n + following, n + k],
            np.c_[np.zeros_like(fan), fan + 1, fan],
            np.c_[np.full_like(fan, n), n + fan, n + fan + 1],
        ]
    )
    points, corners = np.vstack([BLOCK, rod]), np.vstack([CUBE_FACES, faces + 8])
    config = prusa((0, 11, {}), (12, 11 + len(faces), {"volume_type": "NegativeVolume"}))
    text = model(mesh(1, points, corners), place_item("item", 1))
    volume, _ = volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: config}))
    area = 0.5 * n * radius**2 * np.sin(2.0 * np.pi / n)
    assert volume == pytest.approx(27000.0 - 30.0 * area, rel=1e-5)


def test_negative_volumes_that_cannot_be_cut_are_refused_by_name(tmp_path, monkeypatch):
    monkeypatch.setattr(f"{three_mf_roles.__name__}.MAX_TRIANGLES", 20)
    keys = {"name": "the hole", "volume_type": "NegativeVolume"}
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1))
    path = write_file(tmp_path, text, other_files={PRUSA: prusa((0, 11, {}), (12, 23, keys))})
    with pytest.raises(
        InputError, match=r"'the hole' is a negative volume.*: 24 triangles"
    ) as caught:
        read._mesh(path, "part", 1.0)  # in this process, which has another limit
    assert caught.value.code == "UNSUPPORTED_FILE"


def test_a_negative_volume_that_crosses_itself_is_refused(tmp_path):
    """Overlapping letters of a slicer's text are one closed mesh that crosses itself, and the
    kernel's difference is wrong."""
    size = np.array([10.0, 10.0, 10.0]) / 30.0
    letter = BLOCK * size + [5.0, 5.0, 25.0]
    points = np.vstack([BLOCK, letter, letter + [5.0, 3.0, 0.0]])
    corners = np.vstack([CUBE_FACES, CUBE_FACES + 8, CUBE_FACES + 16])
    keys = {"name": "text", "volume_type": "NegativeVolume"}
    text = model(mesh(1, points, corners), place_item("item", 1))
    path = write_file(tmp_path, text, other_files={PRUSA: prusa((0, 11, {}), (12, 35, keys))})
    with pytest.raises(InputError, match=r"'text' is a negative volume.* no valid result"):
        read_mesh(path)


@pytest.mark.parametrize(
    ("config", "code"),
    [
        (prusa((0, 11, {}), (12, 24, {"volume_type": "ModelPart"})), "BAD_FILE"),
        (prusa((0, 12, {}), (12, 23, {"volume_type": "ModelPart"})), "BAD_FILE"),
        (prusa((0, 11, {}), (12, "x", {})), "BAD_FILE"),
        (prusa((0, 11, {}), (12, 23, {"volume_type": "Wizardry"})), "UNSUPPORTED_FILE"),
    ],
)
def test_roles_that_cannot_be_understood_are_refused(tmp_path, config, code):
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1))
    with pytest.raises(InputError) as caught:
        read_mesh(write_file(tmp_path, text, other_files={PRUSA: config}))
    assert caught.value.code == code


@pytest.mark.parametrize("name", ["SuperSlicer_model", "Slic3r_pe_MODEL", "Other_model"])
def test_files_of_roles_of_other_slicers_are_read(tmp_path, name):
    """The second of two boxes is left out."""
    config = prusa((0, 11, {}), (12, 23, {"volume_type": "SupportBlocker"}))
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1))
    expected, _ = volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: config}))
    other_file = write_file(tmp_path, text, other_files={f"Metadata/{name}.config": config})
    volume, notes = volume_and_notes(other_file)
    assert volume == pytest.approx(expected) and any("support blocker" in str(n) for n in notes)


@pytest.mark.parametrize("kind", ["model", "other"])
@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize(
    ("subtype", "wanted"),
    [
        ("normal_part", 8000.0 + 1000.0),
        ("negative_part", 7000.0),
        ("modifier_part", 8000.0),
        ("support_blocker", 8000.0),
        ("support_enforcer", 8000.0),
    ],
)
def test_roles_of_bambu_studio_and_orca(tmp_path, kind, split, subtype, wanted):
    """These slicers give objects other than parts the type 'other', and keep the meshes of an
    object in a separate file."""
    if subtype == "normal_part" and kind == "other":
        wanted = 8000.0
    meshes = mesh(1, CUBE * 20.0, CUBE_FACES) + mesh(2, CUBE * 10.0, CUBE_FACES, kind)
    path = f' xmlns:p="{PRODUCTION}" p:path="/3D/Objects/object_1.model"' if split else ""
    components = [place_item("component", number, None, path) for number in (1, 2)]
    container = holder(3, *components)
    text = model(container if split else meshes + container, place_item("item", 3))
    more_files = {BAMBU: bambu(3, p1="normal_part", p2=subtype)}
    if split:
        more_files["3D/Objects/object_1.model"] = model(meshes, "")
    assert volume_and_notes(write_file(tmp_path, text, other_files=more_files))[0] == pytest.approx(
        wanted
    )


@pytest.mark.parametrize(
    "setting", ["infill_mesh", "anti_overhang_mesh", "support_mesh", "cutting_mesh"]
)
@pytest.mark.parametrize("at", ["object", "item", "old"])
@pytest.mark.parametrize("value", ["True", "False"])
def test_roles_of_cura(tmp_path, setting, at, value):
    group = f'<metadatagroup><metadata name="cura:{setting}" type="xs:boolean">{value}</metadata></metadatagroup>'
    old = f'<c:settings xmlns:c="http://software.ultimaker.com/xml/cura/3mf/2015/10"><c:setting key="{setting}">{value}</c:setting></c:settings>'
    tool = mesh(2, TOOL, CUBE_FACES)
    if at != "item":
        tool = tool.replace("<mesh>", (group if at == "object" else old) + "<mesh>")
    item = '<item objectid="2">' + group + "</item>" if at == "item" else place_item("item", 2)
    text = model(mesh(1, BLOCK, CUBE_FACES) + tool, place_item("item", 1) + item)
    volume, notes = volume_and_notes(write_file(tmp_path, text))
    assert volume == (27000.0 if value == "True" else 27000.0 + 64000.0)
    assert len(notes) == (value == "True")


def add_cura_setting(key, value, owner):
    group = f'<metadatagroup><metadata name="cura:{key}">{value}</metadata></metadatagroup>'
    old = f'<c:settings xmlns:c="http://software.ultimaker.com/xml/cura/3mf/2015/10"><c:setting key="{key}">{value}</c:setting></c:settings>'
    if owner == "item":
        return model(mesh(1), '<item objectid="1">' + group + "</item>")
    if owner == "holder":
        container = holder(2, place_item("component", 1)).replace(
            "<components>", group + "<components>"
        )
        return model(mesh(1) + container, place_item("item", 2))
    setting = group if owner == "object" else old
    return model(mesh(1).replace("<mesh>", setting + "<mesh>"), place_item("item", 1))


@pytest.mark.parametrize("at", ["object", "item", "old", "holder"])
@pytest.mark.parametrize(
    "key", ["mold_enabled", "conical_overhang_enabled", "meshfix_union_all_remove_holes"]
)
def test_settings_of_cura_that_make_another_solid_are_refused(tmp_path, key, at):
    """Cura deposits a mould around the mesh, or fills overhangs; the mesh was once deposited
    without a message."""
    with pytest.raises(
        InputError, match=f"{key} = True of Cura, which changes its shape"
    ) as caught:
        read_mesh(write_file(tmp_path, add_cura_setting(key, "True", at)))
    assert caught.value.code == "UNSUPPORTED_FILE"
    assert volume_and_notes(write_file(tmp_path, add_cura_setting(key, "False", at))) == (1.0, [])


@pytest.mark.parametrize("at", ["object", "item", "old", "holder"])
@pytest.mark.parametrize(
    "key, value, unused",
    [
        ("xy_offset", "-0.3", "0.0"),
        ("hole_xy_offset", "0.1", "0"),
        ("magic_mesh_surface_mode", "surface", "normal"),
        ("magic_spiralize", "True", "False"),
    ],
)
def test_settings_of_cura_that_are_not_applied_are_named(tmp_path, key, value, unused, at):
    volume, notes = volume_and_notes(write_file(tmp_path, add_cura_setting(key, value, at)))
    assert volume == 1.0 and len(notes) == 1 and f"{key} = {value}" in notes[0]
    assert volume_and_notes(write_file(tmp_path, add_cura_setting(key, unused, at))) == (1.0, [])


def test_settings_of_a_project_of_cura_are_named(tmp_path):
    name = "Cura/custom.inst.cfg"
    profile = (
        "[general]\nname = custom\n[values]\nmold_enabled = {}\nxy_offset = {}\nspeed_print = 40\n"
    )
    text = model(mesh(1), place_item("item", 1))
    path = write_file(tmp_path, text, other_files={name: profile.format("True", "0")})
    volume, notes = volume_and_notes(path)
    assert volume == 1.0 and len(notes) == 1
    assert name in notes[0] and "mold_enabled = True" in notes[0] and "xy_offset" not in notes[0]
    path = write_file(tmp_path, text, other_files={name: profile.format("False", "0.0")})
    assert volume_and_notes(path) == (1.0, [])


@pytest.mark.parametrize("kind", ["support", "solidsupport", "other"])
def test_objects_that_are_not_part_are_named(tmp_path, kind):
    text = model(
        mesh(1) + mesh(2, CORNERS + 9.0, kind=kind), place_item("item", 1) + place_item("item", 2)
    )
    volume, notes = volume_and_notes(write_file(tmp_path, text))
    assert volume == 1.0 and len(notes) == 1 and "'2'" in notes[0]


def test_an_item_that_is_not_printed_is_named(tmp_path):
    text = model(
        mesh(1) + mesh(2), place_item("item", 1) + place_item("item", 2, None, ' printable="0"')
    )
    volume, notes = volume_and_notes(write_file(tmp_path, text))
    assert volume == 1.0 and "'2': not printable" in notes[0]


SLICE = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"
SLICES = f'<s:slicestack xmlns:s="{SLICE}" id="9" zbottom="0"><s:slice ztop="20"/></s:slicestack>'


def add_attribute(text, attribute):
    return text.replace("<object ", f"<object {attribute} ", 1)


def add_child(text, child):
    return text.replace("</mesh>", f"</mesh>{child}", 1)


def in_mesh(text, child):
    return text.replace("</mesh>", f"{child}</mesh>", 1)


SHAPED = {
    "slices": SLICES + add_attribute(mesh(1), f'xmlns:s="{SLICE}" s:slicestackid="9"'),
    "beams": in_mesh(
        mesh(1),
        '<b:beamlattice xmlns:b="http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02" radius="1"/>',
    ),
    "boolean": add_child(
        mesh(1),
        '<o:booleanshape xmlns:o="http://schemas.3mf.io/3dmanufacturing/booleans/2023/07" objectid="1"/>',
    ),
    "level set": add_child(
        mesh(1),
        '<v:levelset xmlns:v="http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01"/>',
    ),
    "displacement": add_child(
        mesh(1),
        '<d:displacementmesh xmlns:d="http://schemas.3mf.io/3dmanufacturing/displacement/2023/10"/>',
    ),
    "unknown": in_mesh(mesh(1), '<x:bulge xmlns:x="urn:of-tomorrow"/>'),
    "unknown in core": add_child(mesh(1), "<curvedmesh/>"),
    "low-resolution": add_attribute(
        mesh(1),
        'xmlns:a="http://schemas.3mf.io/3dmanufacturing/productionalternatives/2021/04" a:modelresolution="lowres"',
    ),
}


@pytest.mark.parametrize("what", sorted(SHAPED))
def test_what_changes_the_shape_of_an_object_is_refused_though_the_file_does_not_require_it(
    tmp_path, what
):
    with pytest.raises(InputError, match=r"object '1' has .*changes its shape") as caught:
        read_mesh(write_file(tmp_path, model(SHAPED[what], place_item("item", 1))))
    assert caught.value.code == "UNSUPPORTED_FILE"
    unused = model(SHAPED[what] + mesh(2), place_item("item", 2))
    assert volume_and_notes(write_file(tmp_path, unused))[0] == 1.0


def test_what_changes_no_shape_is_read_past_and_what_is_unknown_is_named(tmp_path):
    sets = '<t:trianglesets xmlns:t="http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"><t:triangleset name="a" identifier="b"><t:ref index="0"/></t:triangleset></t:trianglesets>'
    colours = '<m:colorgroup xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" id="8"><m:color color="#FFF"/></m:colorgroup>'
    text = model(colours + in_mesh(mesh(1), sets) + SLICES, place_item("item", 1))
    assert volume_and_notes(write_file(tmp_path, text)) == (1.0, [])
    odd = model('<x:thing xmlns:x="urn:odd"/>' + mesh(1), place_item("item", 1))
    volume, notes = volume_and_notes(
        write_file(tmp_path, odd, other_files={"Other/shape.dat": "?"})
    )
    assert volume == 1.0 and "urn:odd" in notes[0] and "Other/shape.dat" in notes[1]


def test_encrypted_content_that_is_not_required_is_refused_as_such(tmp_path):
    store = (
        '<keystore xmlns="http://schemas.microsoft.com/3dmanufacturing/securecontent/2019/04">'
        '<resourcedatagroup><resourcedata path="/3D/3dmodel.model"/></resourcedatagroup></keystore>'
    )
    with pytest.raises(InputError, match="encrypted"):
        read_mesh(write_file(tmp_path, "%3McF noise", other_files={"Secure/keystore.xml": store}))


def test_holes_that_a_slicer_drills_are_refused(tmp_path):
    name = "Metadata/Slic3r_PE_sla_drain_holes.txt"
    text = model(mesh(1), place_item("item", 1))
    holes = "drain_holes_format_version=1\nobject_id=1|1 2 3 0 0 1 2 5"
    with pytest.raises(InputError, match="holes drilled by the slicer"):
        read_mesh(write_file(tmp_path, text, other_files={name: holes}))
    assert (
        volume_and_notes(write_file(tmp_path, text, other_files={name: holes.split("obj")[0]}))[0]
        == 1.0
    )


def test_the_feature_of_a_part_tells_what_was_left_out_of_its_file(tmp_path):
    config = prusa((0, 11, {}), (12, 23, {"name": "tool", "volume_type": "ParameterModifier"}))
    path = write_file(
        tmp_path,
        model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1)),
        other_files={PRUSA: config},
    )
    document = FreeCAD.newDocument("Roles")
    try:
        feature = api.make_solid_feature(document, api.open_part(document, str(path)))
        (note,) = [issue for issue in api.issues(feature) if issue.code == "FILE_CONTENT"]
        assert note.level == "note" and "'tool': modifier" in note.message
        assert note.message.values  # it can be said in another language
    finally:
        FreeCAD.closeDocument(document.Name)


@pytest.mark.parametrize(
    ("unit", "right"), [("", True), ('unit="inch"', True), ('unit="millimeter"', False)]
)
def test_a_file_of_a_component_has_the_unit_of_the_model(tmp_path, unit, right):
    inner = (
        f'<?xml version="1.0"?><model {unit} xmlns="{three_mf.CORE}"><resources>{mesh(1)}'
        "</resources><build/></model>"
    )
    outer = model(
        holder(2, place_item("component", 1, attributes=' p:path="/3D/inner.model"')),
        place_item("item", 2),
        "inch",
        f'xmlns:p="{three_mf.PRODUCTION}"',
    )
    path = write_file(tmp_path, outer, other_files={"3D/inner.model": inner})
    if right:
        points, _ = three_mf.triangles(path)
        assert np.ptp(points[:, 0]) == pytest.approx(25.4 * np.ptp(CORNERS[:, 0]))
    else:
        with pytest.raises(InputError, match=r"inner\.model has a unit other") as raised:
            read_mesh(path)
        assert raised.value.code == "UNSUPPORTED_FILE"


@pytest.mark.parametrize(
    ("name", "noted"),
    [
        ("Metadata/parts.config", True),
        ("Metadata/edges.xml", True),
        ("Metadata/holes.json", True),
        ("Metadata/holes.txt", True),
        ("Metadata/more/parts.bin", True),
        ("Metadata/Slic3r_PE.config", False),
        ("Metadata/Prusa_Slicer_wipe_tower_information.xml", False),
        ("Metadata/project_settings.config", False),
        ("Metadata/process_settings_1.config", False),
        ("Metadata/plate_1.json", False),
        ("Metadata/thumbnail.png", False),
        ("Metadata/plate_1.gcode", False),
    ],
)
def test_settings_that_are_not_known_are_noted(tmp_path, name, noted):
    path = write_file(tmp_path, model(mesh(1), place_item("item", 1)), other_files={name: "{}"})
    volume, notes = volume_and_notes(path)
    assert volume == 1.0 and len(notes) == noted
    assert not noted or name in notes[0]


COMPONENTS = (
    '<object id="3" type="model"><components><component objectid="1"/><component objectid="2"/>'
    "</components></object>"
)
TWO = mesh(1, BLOCK, CUBE_FACES) + mesh(2, TOOL, CUBE_FACES)
NEGATIVE = (12, 23, {"volume_type": "NegativeVolume", "name": "tool"})


@pytest.mark.parametrize(
    ("objects", "built", "config", "text"),
    [
        (mesh(1, BOTH, BOTH_FACES), 1, prusa((0, 11, {}), NEGATIVE, number=9), "object 9"),
        (TWO + COMPONENTS, 3, prusa((0, 11, {}), NEGATIVE, number=3), "'tool'"),
        (TWO + COMPONENTS, 3, bambu(3, p1="normal_part", p7="negative_part"), "'piece p7'"),
        (mesh(1, BOTH, BOTH_FACES), 1, bambu(1, p1="normal_part", p2="modifier_part"), "modifier"),
    ],
)
def test_roles_of_pieces_that_the_model_does_not_have_are_refused(
    tmp_path, objects, built, config, text
):
    name = PRUSA if "firstid" in config else BAMBU
    path = write_file(
        tmp_path, model(objects, place_item("item", built)), other_files={name: config}
    )
    with pytest.raises(InputError) as refused:
        three_mf.content(path)
    assert refused.value.code == "UNSUPPORTED_FILE"
    assert "lacks this volume" in refused.value.message and text in refused.value.message


def test_two_files_of_different_roles_are_refused(tmp_path):
    roles = prusa((0, 11, {}), NEGATIVE)
    more_files = {PRUSA: roles, "Metadata/SuperSlicer_model.config": roles}
    text = model(mesh(1, BOTH, BOTH_FACES), place_item("item", 1))
    assert volume_and_notes(write_file(tmp_path, text, other_files=more_files))[0] == pytest.approx(
        13500.0
    )
    more_files[PRUSA] = roles.replace("NegativeVolume", "ModelPart")
    with pytest.raises(InputError, match="different roles"):
        three_mf.content(write_file(tmp_path, text, other_files=more_files))


def test_a_negative_volume_that_cuts_nothing_is_named(tmp_path):
    text = model(TWO, place_item("item", 1) + place_item("item", 2))
    config = prusa((0, 11, {"volume_type": "NegativeVolume", "name": "tool"}), number=2)
    volume, notes = volume_and_notes(write_file(tmp_path, text, other_files={PRUSA: config}))
    assert volume == pytest.approx(27000.0)
    assert len(notes) == 1 and "ignored" in notes[0] and "'tool': negative volume" in notes[0]


def test_objects_on_several_plates_are_noted(tmp_path):
    plate = '<plate><metadata key="plater_id" value="{0}"/>{1}</plate>'
    instance = '<model_instance><metadata key="object_id" value="{0}"/></model_instance>'
    text = model(TWO, place_item("item", 1) + place_item("item", 2))
    for stands, wanted in (((1, 2), ["2 plates"]), ((1,), []), ((), [])):
        plates = "".join(
            plate.format(k, 2 * instance.format(k) if k in stands else "") for k in (1, 2, 3)
        )
        more_files = {BAMBU: f"<config>{plates}</config>"}
        notes = volume_and_notes(write_file(tmp_path, text, other_files=more_files))[1]
        assert len(notes) == len(wanted) and all(w in n for w, n in zip(wanted, notes))


INI = "; spiral_vase = {0}\n; fuzzy_skin = none\n; xy_size_compensation = 0\n"
JSON = (
    '{{"spiral_mode": "0",\n  "xy_contour_compensation": [\n    "{0}"\n  ], "fuzzy_skin": "nil"}}'
)


@pytest.mark.parametrize(
    ("name", "text", "word"),
    [
        ("Metadata/Slic3r_PE.config", INI, "spiral_vase = 1"),
        ("Metadata/project_settings.config", JSON, "xy_contour_compensation = 1"),
    ],
)
def test_settings_of_slicers_that_are_not_applied_are_named(tmp_path, name, text, word):
    model_text = model(mesh(1, BLOCK, CUBE_FACES), place_item("item", 1))
    for value, count in ((0, 0), (1, 1)):
        path = write_file(tmp_path, model_text, other_files={name: text.format(value)})
        notes = volume_and_notes(path)[1]
        assert len(notes) == count and all(word in note for note in notes)


@pytest.mark.parametrize("level", ["object", "volume"])
def test_settings_of_an_object_are_named_or_refused(tmp_path, level):
    model_text = model(mesh(1, BLOCK, CUBE_FACES), place_item("item", 1))
    setting = '<metadata type="object" key="{}" value="{}"/>'
    marker = "<volume" if level == "object" else "</volume>"
    config = prusa((0, 11, {"volume_type": "ModelPart"}))

    def path_with(key, value):
        text = config.replace(marker, setting.format(key, value) + marker, 1)
        return write_file(tmp_path, model_text, other_files={PRUSA: text})

    (note,) = volume_and_notes(path_with("xy_size_compensation", "-0.2"))[1]
    assert "'1': xy_size_compensation = -0.2" in note
    assert not volume_and_notes(path_with("make_overhang_printable", "0"))[1]
    with pytest.raises(InputError, match="make_overhang_printable = 1"):
        three_mf.content(path_with("make_overhang_printable", "1"))
