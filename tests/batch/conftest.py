# SPDX-License-Identifier: LGPL-2.1-or-later
"""A small part and job in a folder of their own, and the launcher to run them."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import FreeCAD
import Part
import pytest

JOB = """\
version: 1
name: cup
part: {file: cup.step}
strategy:
  layer_height: 4 mm
  chord_error: 0.1 mm
cell:
  limits: paper
  platform_diameter: 100 mm
process:
  travel_speed: 6 mm/s
program:
  post: fanuc
"""


@dataclass
class Ended:
    """How a command ended."""

    status: int
    out: str
    err: str


@dataclass
class Workshop:
    """A folder with a part and a job, and the commands run in it."""

    folder: Path
    launcher: Path

    text = JOB

    @property
    def job(self) -> Path:
        return self.folder / "cup.yaml"

    def write_job(self, text: str = JOB) -> Path:
        self.job.write_text(text, encoding="utf-8")
        return self.job

    def change(self, old: str, new: str) -> Path:
        assert old in JOB
        return self.write_job(JOB.replace(old, new, 1))

    def environment(self) -> dict:
        return {**os.environ, "FREECAD_USER_HOME": str(self.folder), "PYTHONDONTWRITEBYTECODE": "1"}

    def run(self, *words: object) -> Ended:
        done = subprocess.run(
            [str(self.launcher), *map(str, words)], cwd=self.folder, env=self.environment(), capture_output=True,
            text=True, encoding="utf-8", timeout=120, check=False, stdin=subprocess.DEVNULL,
        )
        return Ended(done.returncode, done.stdout, done.stderr)

    def files(self, folder: str = "out/cup") -> dict[str, bytes]:
        """Every file below a folder, hidden ones too, by its name relative to it."""
        top = self.folder / folder
        return {str(path.relative_to(top)): path.read_bytes() for path in sorted(top.rglob("*")) if path.is_file()}


@pytest.fixture
def workshop(tmp_path, root):
    """A hemisphere of 40 mm radius as STEP, and its job."""
    shape = Part.makeSphere(40.0, FreeCAD.Vector(), FreeCAD.Vector(0, 0, 1), 0, 90, 360)
    shape.exportStep(str(tmp_path / "cup.step"))
    shop = Workshop(tmp_path, root / "freecad-am")
    shop.write_job()
    return shop
