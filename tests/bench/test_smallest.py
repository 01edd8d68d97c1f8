# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every benchmark runs at its smallest size, so that a rename in the package cannot break one
unnoticed. The test judges no time."""

import os
import re
import subprocess

import pytest

from bench.run import BENCHMARKS

TIMEOUT_S = 300  # s


@pytest.mark.parametrize("name", BENCHMARKS)
def test_a_benchmark_runs_at_its_smallest_size(root, name):
    if os.environ.get("FREECAD_AM_VERSION"):
        pytest.skip("benchmarks run beside the FreeCAD of this machine")
    process = subprocess.run(
        [root / "freecad-am", "bench", "--smallest", name],
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    assert process.returncode == 0, process.stderr[-3000:]
    header, *rows = process.stdout.splitlines()
    assert header.startswith(f"{name} (load ")
    assert rows and all(re.match(r" +(ran|--) +\S", row) for row in rows), process.stdout


def test_every_module_with_rows_is_listed(root):
    modules = {
        path.stem
        for path in (root / "bench").glob("*.py")
        if re.search(r"^def run\(\) -> list\[Row\]", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert modules - {"arm_apart"} == set(BENCHMARKS)  # `arm` runs `arm_apart`


def test_an_unknown_benchmark_is_rejected(root):
    process = subprocess.run(
        [root / "freecad-am", "bench", "--smallest", "slicin"],
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    assert process.returncode == 2
    assert "error[USAGE] bench: there is no benchmark 'slicin'" in process.stderr
