# SPDX-License-Identifier: LGPL-2.1-or-later
"""One job gives the same program in every version of FreeCAD: this test runs in 0.20 and, like all
of its folder, in 1.0 and 1.1."""

import hashlib
import shutil

from tests.batch.conftest import Workshop

PROGRAMS = (  # hashes of the bracket's programs, equal in all versions
    "4eaf400439cd4386022579faf42d5675f4c954023d11ec70d54e215d9340f7d0"
)


def test_the_bracket_is_one_program(tmp_path, root):
    for name in ("bracket.yaml", "bracket.step"):
        shutil.copy(root / "resources" / "examples" / name, tmp_path)
    command = Workshop(tmp_path, root / "freecad-am").run(
        "plan", "bracket.yaml", "-o", "out", "--no-page"
    )
    assert command.status == 0, command.err
    texts = hashlib.sha256()
    for file in sorted((tmp_path / "out" / "program").iterdir()):
        texts.update(file.name.encode() + file.read_bytes())
    assert texts.hexdigest() == PROGRAMS
