# SPDX-License-Identifier: LGPL-2.1-or-later
"""Run ruff and mypy as CONTRIBUTING asks. They come from the package index and have their own
environment (.lint-env) that sees the distribution's numpy."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
ENVIRONMENT = ROOT / ".lint-env"
TOOLS = ("ruff==0.17.6", "mypy==2.4.1")


def run_command(*command):
    words = [str(word) for word in command]
    env = {**os.environ, "PYTHONPATH": ""}
    return subprocess.run(
        words,
        cwd=ROOT,
        env=env,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
    )


@pytest.fixture(scope="module")
def tools():
    """Return the folder of the lint programs. Skip the test if they cannot be installed, for
    example without a network or in another FreeCAD."""
    if os.environ.get("FREECAD_AM_VERSION"):
        pytest.skip("the same files are looked at once, beside the FreeCAD of this machine")
    noted = ENVIRONMENT / "tools.txt"
    if not noted.exists() or noted.read_text(encoding="utf-8").split() != list(TOOLS):
        process = run_command(sys.executable, "-m", "venv", "--system-site-packages", ENVIRONMENT)
        words = ("-q", "--no-compile", "--disable-pip-version-check")
        process = (
            process
            if process.returncode
            else run_command(ENVIRONMENT / "bin" / "pip", "install", *words, *TOOLS)
        )
        if process.returncode:
            pytest.skip(
                f"{' and '.join(TOOLS)} cannot be installed: {process.stderr.strip()[-200:]}"
            )
        noted.write_text("\n".join(TOOLS) + "\n", encoding="utf-8")
    return ENVIRONMENT / "bin"


def test_ruff_has_nothing_to_say(tools):
    process = run_command(tools / "ruff", "check", "--no-cache", "--output-format", "concise", ".")
    assert process.returncode == 0, process.stdout


def test_files_are_formatted(tools):
    process = run_command(tools / "ruff", "format", "--no-cache", "--check", ".")
    assert process.returncode == 0, f"run `ruff format`: {process.stdout}"


def test_mypy_has_nothing_to_say(tools):
    process = run_command(tools / "mypy")
    assert process.returncode == 0, process.stdout[-3000:]
