# SPDX-License-Identifier: LGPL-2.1-or-later
"""URDFs of all robots in the manufacturers' public description repositories, downloaded and
expanded; the project keeps none of them. `ROBOT_DESCRIPTIONS` names a folder with checkouts,
`owner+name` each; without it they are cloned into `.test-env`, where xacro gets a Python
environment. If they are unavailable, the tests skip with the reason."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

THIS_FILE = Path(__file__).resolve()
ENVIRONMENT = THIS_FILE.parents[2] / ".test-env"
MAKERS = {
    "ros-industrial/abb": "ABB",
    "ros-industrial/abb_experimental": "ABB",
    "ros-industrial/fanuc": "FANUC",
    "ros-industrial/fanuc_experimental": "FANUC",
    "FANUC-CORPORATION/fanuc_description": "FANUC",
    "ros-industrial/kuka_experimental": "KUKA",
    "kroshu/kuka_robot_descriptions": "KUKA",
    "ros-industrial/motoman": "Motoman",
    "ros-industrial/staubli": "Staubli",
    "ros-industrial/staubli_experimental": "Staubli",
    "ros-industrial/universal_robot": "Universal Robots",
    "UniversalRobots/Universal_Robots_ROS2_Description": "Universal Robots",
    "Kawasaki-Robotics/khi_robot": "Kawasaki",
    "doosan-robotics/doosan-robot2": "Doosan",
}
TEXT_FILES = r"\.(xacro|urdf|yaml|xml)$"  # the files of a checkout without meshes
TIMEOUT_S = 600  # s, for one command


def expanded(target: Path) -> list[tuple[str, Path]]:
    """Return manufacturer and file of each URDF in a folder. Skip with the reason if they are
    unavailable."""
    python = _python_with_xacro()
    for repository in MAKERS:
        _checkout(repository)
    _run_or_skip(
        [
            python,
            str(THIS_FILE.with_name("expand_descriptions.py")),
            str(_checkouts()),
            str(target),
        ],
        "xacro ended in an error",
    )
    names = {repository.replace("/", "+"): maker for repository, maker in MAKERS.items()}
    return [(names[path.name.split("+urdfs+")[0]], path) for path in sorted(target.glob("*.urdf"))]


def _checkouts() -> Path:
    named = os.environ.get("ROBOT_DESCRIPTIONS", "")
    return Path(named) if named else ENVIRONMENT / "descriptions"


def _checkout(repository: str) -> None:
    """Return the newest text files of a repository."""
    folder = _checkouts() / repository.replace("/", "+")
    if not folder.is_dir():
        source = f"https://github.com/{repository}"
        reason = f"{source} cannot be cloned: put a checkout at {folder.name} in the folder that ROBOT_DESCRIPTIONS names"
        folder.parent.mkdir(parents=True, exist_ok=True)
        _run_or_skip(
            ["git", "clone", "-q", "-n", "--depth", "1", "--filter=blob:none", source, str(folder)],
            reason,
        )
        listed = (
            f"git ls-files | grep -E '{TEXT_FILES}' | git checkout -q HEAD --pathspec-from-file=-"
        )
        _run_or_skip(
            ["sh", "-c", f"cd '{folder}' && git reset -q && {listed}"],
            f"{source} cannot be checked out",
        )


def _python_with_xacro() -> str:
    """Return a Python that has xacro."""
    python = ENVIRONMENT / "xacro" / "bin" / "python"
    if not python.exists():
        _run_or_skip(
            [sys.executable, "-m", "venv", str(python.parents[1])],
            "no Python environment can be made",
        )
    if subprocess.run(
        [str(python), "-c", "import xacro"], capture_output=True, check=False
    ).returncode:
        _run_or_skip(
            [str(python), "-m", "pip", "install", "-q", "xacro", "PyYAML"],
            "xacro cannot be installed by pip",
        )
    return str(python)


def _run_or_skip(command: list[str], reason: str) -> None:
    """Run a command, or skip with the reason and the last line of its output."""
    try:
        process = subprocess.run(
            command, capture_output=True, text=True, timeout=TIMEOUT_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        pytest.skip(f"{reason}: {error}")
    if process.returncode:
        pytest.skip(f"{reason}: {(process.stderr.strip().splitlines() or ['no word'])[-1]}")
