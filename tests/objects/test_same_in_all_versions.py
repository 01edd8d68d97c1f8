# SPDX-License-Identifier: LGPL-2.1-or-later
"""One job gives the same program in every version of FreeCAD: run in 0.20 and, as all tests of this folder, in 1.0 and 1.1."""

import hashlib
import shutil

from tests.batch.conftest import Workshop

PROGRAMS = (  # of the bracket, the same in all versions
    "b357eb42df111ea5467851420b023e00d7abe0053984cc6f94f91ca4baee0693"
)


def test_the_bracket_is_one_program(tmp_path, root):
    for name in ("bracket.yaml", "bracket.step"):
        shutil.copy(root / "resources" / "examples" / name, tmp_path)
    done = Workshop(tmp_path, root / "freecad-am").run(
        "plan", "bracket.yaml", "-o", "out", "--no-page"
    )
    assert done.status == 0, done.err
    texts = hashlib.sha256()
    for file in sorted((tmp_path / "out" / "program").iterdir()):
        texts.update(file.name.encode() + file.read_bytes())
    assert texts.hexdigest() == PROGRAMS
