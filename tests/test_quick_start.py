# SPDX-License-Identifier: LGPL-2.1-or-later
"""The quick start of CONTRIBUTING.md runs as printed, without FreeCAD."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
WITHOUT_FREECAD = "import sys; sys.modules['FreeCAD'] = None\n"


def test_the_quick_start_runs_without_freecad():
    pytest.importorskip("shapely")
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    script = re.search(r"<<'PYTHON'\n(.*?)PYTHON\n", page, re.DOTALL)[1]
    process = subprocess.run(
        [sys.executable, "-c", WITHOUT_FREECAD + script],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert process.returncode == 0, process.stderr
    kinds = [line.split()[0] for line in process.stdout.splitlines()]
    assert kinds.count("zigzag") > 1
    assert (ROOT / "freecad_am/core/filling/zigzag.py").is_file()
