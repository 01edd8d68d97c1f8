# SPDX-License-Identifier: LGPL-2.1-or-later
"""Write every robot in checkouts of ROS packages as a URDF: existing ones, and those that xacro
generates. This program runs in a Python with xacro: FOLDER of the checkouts, FOLDER for the URDFs.
It finds packages by their `package.xml`, those of the same checkout first, where ROS has them
installed."""

from __future__ import annotations

import re
import sys
import types
from pathlib import Path

import xacro

FAMILY, MEMBERS = (
    "ur_type",
    "config",
)  # the argument that names a robot of a family, and their folder


def main(checkouts: Path, target: Path) -> None:
    for checkout in sorted(path for path in checkouts.iterdir() if path.is_dir()):
        packages = {
            name: folder
            for other_checkout in [*checkouts.iterdir(), checkout]
            for name, folder in _packages(other_checkout)
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
                ) as error:  # xacro, and the Python within a file, may raise anything
                    print(
                        f"{path.relative_to(checkouts)}: {' '.join(str(error).split())[:160]}",
                        file=sys.stderr,
                    )
                    continue
                _keep(text, target, checkout, path, *mappings.get(FAMILY, "").split())


def _packages(checkout: Path) -> list[tuple[str, Path]]:
    packages = []
    for path in checkout.rglob("package.xml"):
        name = re.search(r"<name>\s*(\S+?)\s*</name>", path.read_text(encoding="utf-8"))
        if name:
            packages.append((name[1], path.parent))
    return packages


def _installed(packages: dict[str, Path]) -> None:
    """Return the module that xacro asks for the location of a package."""
    index = types.ModuleType("ament_index_python.packages")
    index.get_package_share_directory = lambda name: str(packages[name])  # type: ignore[attr-defined]
    sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = index


def _variants(path: Path) -> list[dict[str, str]]:
    """Return values of arguments: for a file of a robot family, one set for each robot."""
    text = path.read_text(encoding="utf-8")
    members = path.parents[1] / MEMBERS
    if f'arg name="{FAMILY}"' not in text or not members.is_dir():
        return [{}]
    named = (
        member.name
        for member in sorted(members.iterdir())
        if (member / "default_kinematics.yaml").is_file()
    )
    return [{FAMILY: name, "name": name} for name in named]


def _keep(text: str, target: Path, checkout: Path, path: Path, *arguments: str) -> None:
    """Keep a file if anything in it moves; files of macros and colours have no moving joints."""
    if re.search(r'<joint[^>]*type="(revolute|continuous|prismatic)"', text):
        words = [
            checkout.name,
            "urdfs",
            *path.relative_to(checkout).with_suffix("").parts,
            *arguments,
        ]
        (target / ("+".join(words) + ".urdf")).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
