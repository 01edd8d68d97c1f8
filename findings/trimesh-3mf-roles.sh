#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# trimesh counts support objects and items that are not to be printed as parts of a 3MF file.
#
# trimesh 5.2.0, seen on 2026-11-28: of two cubes of 1000 mm^3 the second is an object of type "support", or an item with
# printable="0" as slicers write it; trimesh returns 2000 mm^3 for both files and no message. lib3mf 2.5.0 accepts the first
# file, and warns about the attribute `printable` of the second, which the core specification does not have.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip -q install trimesh==5.2.0 numpy networkx lxml lib3mf==2.5.0
venv/bin/python - <<'PYTHON'
import itertools
import zipfile

import lib3mf
import trimesh

NAMESPACE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
RELATIONS = "http://schemas.openxmlformats.org/package/2006"
SIDES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def cube(number, kind, start):
    corners = itertools.product((start, start + 10), (0, 10), (0, 10))
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in corners)
    halves = [half for a, b, c, d in SIDES for half in ((a, b, c), (a, c, d))]
    triangles = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in halves)
    mesh = f"<mesh><vertices>{vertices}</vertices><triangles>{triangles}</triangles></mesh>"
    return f'<object id="{number}" type="{kind}">{mesh}</object>'


def write(name, kind, attribute):
    resources = cube(1, "model", 0) + cube(2, kind, 20)
    build = f'<item objectid="1"/><item objectid="2"{attribute}/>'
    with zipfile.ZipFile(name, "w") as file:
        file.writestr(
            "[Content_Types].xml",
            f'<Types xmlns="{RELATIONS}/content-types"><Default Extension="rels" '
            'ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default '
            'Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
        )
        file.writestr(
            "_rels/.rels",
            f'<Relationships xmlns="{RELATIONS}/relationships"><Relationship Target="/3D/3dmodel.model" '
            'Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
        )
        file.writestr(
            "3D/3dmodel.model",
            f'<model unit="millimeter" xmlns="{NAMESPACE}"><resources>{resources}</resources>'
            f"<build>{build}</build></model>",
        )


def warnings(name):
    reader = lib3mf.get_wrapper().CreateModel().QueryReader("3mf")
    reader.ReadFromFile(name)
    return [reader.GetWarning(number)[1] for number in range(reader.GetWarningCount())]


write("support.3mf", "support", "")
write("not-printed.3mf", "model", ' printable="0"')
for name in ("support.3mf", "not-printed.3mf"):
    volume = trimesh.load(name).to_mesh().volume
    print(f"{name}: trimesh says {volume:.0f} mm^3, lib3mf warns {warnings(name)}")
    assert round(volume) == 2000
assert warnings("support.3mf") == []
assert warnings("not-printed.3mf") == ["Invalid Attribute in namespace."]
PYTHON
