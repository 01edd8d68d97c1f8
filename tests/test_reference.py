# SPDX-License-Identifier: LGPL-2.1-or-later
"""The API reference builds from the docstrings without a warning and contains every macro
function."""

import re
import subprocess

import pytest

from freecad_am.core.parameters.filled import SolidParameters


def test_the_reference_has_every_macro_function_and_parameter(root, tmp_path):
    pytest.importorskip("FreeCAD")
    from freecad_am import api

    target = tmp_path / "reference"
    process = subprocess.run(
        [root / "freecad-am", "docs", target], capture_output=True, text=True, check=False
    )
    assert process.returncode == 0, process.stderr
    assert "WARNING" not in process.stderr and "ERROR" not in process.stderr
    assert process.stdout.split() == [str(target / "index.html")]
    macros = (target / "macros.html").read_text(encoding="utf-8")
    documented = set(re.findall(r'<dt [^>]*id="freecad_am\.api\.(\w+)"', macros))
    assert documented == set(api.__all__)
    parameters = (target / "parameters.html").read_text(encoding="utf-8")
    for name in SolidParameters.__dataclass_fields__:
        assert f">{name}<" in parameters
