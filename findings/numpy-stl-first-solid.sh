#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# numpy-stl reads the first solid of a text STL and leaves out the others.
#
# numpy-stl 4.1.1, seen on 2026-11-28: of a file with solids of one and two triangles `Mesh.from_file` returns one triangle,
# without a message; `from_multi_file` returns both. meshio 5.3.5 merges all three triangles.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip -q install numpy-stl==4.1.1 meshio==5.3.5
venv/bin/python -W ignore - <<'PYTHON'
from pathlib import Path

import meshio
from stl.mesh import Mesh


def facet(height):
    corners = "".join(f"vertex {x} {y} {height}\n" for x, y in ((0, 0), (1, 0), (0, 1)))
    return f"facet normal 0 0 1\nouter loop\n{corners}endloop\nendfacet\n"


Path("two.stl").write_text(
    f"solid a\n{facet(0)}endsolid a\nsolid b\n{facet(5)}{facet(6)}endsolid b\n"
)
first = len(Mesh.from_file("two.stl").vectors)
each = [len(solid.vectors) for solid in Mesh.from_multi_file("two.stl")]
merged = sum(len(block.data) for block in meshio.read("two.stl").cells)
print(f"triangles: from_file {first}, from_multi_file {each}, meshio {merged}")
assert (first, each, merged) == (1, [1, 2], 3)
PYTHON
