# SPDX-License-Identifier: LGPL-2.1-or-later
"""Every robot of checkouts of ROS packages as a URDF: those that lie there, and those that xacro makes.

A program, run by a Python that has xacro: FOLDER of the checkouts, FOLDER for the URDFs. Packages are found by their
`package.xml`, those of the same checkout first, where ROS has them installed.
"""

from __future__ import annotations

import re
import sys
import types
from pathlib import Path

import xacro

FAMILY, MEMBERS = (
    "ur_type",
    "config",
)  # the argument that says which robot of a family it is, and where these are


def main(checkouts: Path, target: Path) -> None:
    for checkout in sorted(path for path in checkouts.iterdir() if path.is_dir()):
        packages = {
            name: folder
            for other in [*checkouts.iterdir(), checkout]
            for name, folder in _packages(other)
        }
        _installed(packages)
        for path in sorted(checkout.rglob("*.urdf")):
            _keep(path.read_text(encoding="utf-8"), target, checkout, path)
        for path in sorted(checkout.rglob("*.xacro")):
            for mappings in _variants(path):
                try:
                    text = xacro.process_file(str(path), mappings=mappings).toxml()
                except (
                    Exception
                ) as error:  # whatever xacro, and the Python within a file, may raise
                    print(
                        f"{path.relative_to(checkouts)}: {' '.join(str(error).split())[:160]}",
                        file=sys.stderr,
                    )
                    continue
                _keep(text, target, checkout, path, *mappings.get(FAMILY, "").split())


def _packages(checkout: Path) -> list[tuple[str, Path]]:
    found = []
    for path in checkout.rglob("package.xml"):
        name = re.search(r"<name>\s*(\S+?)\s*</name>", path.read_text(encoding="utf-8"))
        if name:
            found.append((name[1], path.parent))
    return found


def _installed(packages: dict[str, Path]) -> None:
    """The module that xacro asks where a package is."""
    index = types.ModuleType("ament_index_python.packages")
    index.get_package_share_directory = lambda name: str(packages[name])  # type: ignore[attr-defined]
    sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = index


def _variants(path: Path) -> list[dict[str, str]]:
    """Values of arguments: of a file for a family of robots, each of the family."""
    text = path.read_text(encoding="utf-8")
    members = path.parents[1] / MEMBERS
    if f'arg name="{FAMILY}"' not in text or not members.is_dir():
        return [{}]
    named = (
        one.name for one in sorted(members.iterdir()) if (one / "default_kinematics.yaml").is_file()
    )
    return [{FAMILY: name, "name": name} for name in named]


def _keep(text: str, target: Path, checkout: Path, path: Path, *more: str) -> None:
    """A file of it, where anything in it moves: files of macros and colours are none."""
    if re.search(r'<joint[^>]*type="(revolute|continuous|prismatic)"', text):
        words = [checkout.name, "urdfs", *path.relative_to(checkout).with_suffix("").parts, *more]
        (target / ("+".join(words) + ".urdf")).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
