# SPDX-License-Identifier: LGPL-2.1-or-later
"""URDFs of all robots of the makers' public description repositories, fetched and expanded: nothing of them is kept here.

`ROBOT_DESCRIPTIONS` names a folder with checkouts, `owner+name` each; without it they are cloned into `.test-env`, and xacro
is put into a Python environment there. What cannot be had is told as the reason to skip.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve()
ENVIRONMENT = HERE.parents[2] / ".test-env"
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
READ = r"\.(xacro|urdf|yaml|xml)$"  # of a checkout: no meshes
LIMIT = 600  # s, of one command


def expanded(target: Path) -> list[tuple[str, Path]]:
    """Maker and file of each URDF, put into a folder; skips, with the reason, where they cannot be had."""
    python = _with_xacro()
    for repository in MAKERS:
        _checkout(repository)
    _done(
        [python, str(HERE.with_name("expand_descriptions.py")), str(_checkouts()), str(target)],
        "xacro ended in an error",
    )
    names = {repository.replace("/", "+"): maker for repository, maker in MAKERS.items()}
    return [(names[path.name.split("+urdfs+")[0]], path) for path in sorted(target.glob("*.urdf"))]


def _checkouts() -> Path:
    named = os.environ.get("ROBOT_DESCRIPTIONS", "")
    return Path(named) if named else ENVIRONMENT / "descriptions"


def _checkout(repository: str) -> None:
    """The newest text files of a repository."""
    folder = _checkouts() / repository.replace("/", "+")
    if not folder.is_dir():
        source = f"https://github.com/{repository}"
        reason = f"{source} cannot be cloned: put a checkout at {folder.name} in the folder that ROBOT_DESCRIPTIONS names"
        folder.parent.mkdir(parents=True, exist_ok=True)
        _done(
            ["git", "clone", "-q", "-n", "--depth", "1", "--filter=blob:none", source, str(folder)],
            reason,
        )
        listed = f"git ls-files | grep -E '{READ}' | git checkout -q HEAD --pathspec-from-file=-"
        _done(
            ["sh", "-c", f"cd '{folder}' && git reset -q && {listed}"],
            f"{source} cannot be checked out",
        )


def _with_xacro() -> str:
    """A Python that has xacro."""
    python = ENVIRONMENT / "xacro" / "bin" / "python"
    if not python.exists():
        _done(
            [sys.executable, "-m", "venv", str(python.parents[1])],
            "no Python environment can be made",
        )
    if subprocess.run(
        [str(python), "-c", "import xacro"], capture_output=True, check=False
    ).returncode:
        _done(
            [str(python), "-m", "pip", "install", "-q", "xacro", "PyYAML"],
            "xacro cannot be installed by pip",
        )
    return str(python)


def _done(command: list[str], reason: str) -> None:
    """Run a command, or skip with the reason and the last line that it said."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        pytest.skip(f"{reason}: {error}")
    if done.returncode:
        pytest.skip(f"{reason}: {(done.stderr.strip().splitlines() or ['no word'])[-1]}")
