# SPDX-License-Identifier: LGPL-2.1-or-later
"""The shipped examples of walls on existing parts: their expected values, and a folder in which
they are planned."""

import re
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from freecad_am.batch.job.job import read_job
from tests.batch import row_limits, wall_checks
from tests.batch.conftest import COMMANDS


def rod(x, z, radius):
    """Return the distance from a cylinder about a line along Y."""
    return lambda points: np.hypot(points[:, 0] - x, points[:, 2] - z) - radius


def dome(points):
    return np.linalg.norm(points - [-60.0, 35.0, 12.0], axis=1) - 40.0


def cone(points):
    """Return the distance from a cone 64 mm high, 48 mm wide at its foot and 16 mm at its top."""
    lean = np.hypot(64.0, 32.0)
    return ((np.hypot(points[:, 0], points[:, 1]) - 48.0) * 64.0 + points[:, 2] * 32.0) / lean


def sloping_block(points):
    """Return the distance from a block whose top rises by 6 mm over 60 mm along X, rotated by 30
    deg."""
    x, y, z = (points - [-85.0, 140.0, 10.0]).T
    along = np.cos(np.pi / 6.0) * x + np.sin(np.pi / 6.0) * y
    return (60.0 * z - 6.0 * along) / np.hypot(60.0, 6.0)


def plate(points):
    return points[:, 2] - 100.0


@dataclass(frozen=True)
class Example:
    """A job in resources/examples, the file of its wall, its layer height (mm), the distance of
    points from the skin of its substrate, the deviation of the substrate from that skin, and the
    largest error of the local distance at and between the points of the fronts (mm). thicker: the
    job is planned at this layer height, in a third of the time, instead of that in its file."""

    job: str
    wall: str
    height: float
    depth: Callable[[np.ndarray], np.ndarray] = field(repr=False)
    substrate_error: float = 1e-5
    spacing_error: float = 1e-4
    has_cell: bool = False
    thicker: bool = False


EXAMPLES = (
    Example("tube-on-pipe", "tube-on-pipe.step", 5.0, rod(0.0, 0.0, 32.0), has_cell=True),
    Example(
        "walls/spatial-pipe-on-cone",
        "walls/spatial-pipe.step",
        8.0,
        cone,
        spacing_error=1e-3,
        thicker=True,
    ),
    Example(
        "walls/half-shell-on-rod",
        "walls/half shell.step",
        4.0,
        rod(150.0, 40.0, 30.0),
        has_cell=True,
        spacing_error=1e-3,
    ),
)
LONG_EXAMPLES = (
    Example(
        "walls/elbow-on-block",
        "walls/elbow.step",
        4.0,
        sloping_block,
        has_cell=True,
        spacing_error=1e-3,
    ),
    Example("walls/flared-shell-on-dome", "walls/coque évasée.step", 4.0, dome),
    # its first layer bridges 240 flats smoothly, which are up to 0.033 mm off the pipe; where such
    # a curve forms its first corner, arcs between the points of a layer are 3e-4 mm off, within the
    # guaranteed 1e-3 mm
    Example(
        "walls/tube-on-scanned-pipe",
        "tube-on-pipe.step",
        5.0,
        rod(0.0, 0.0, 32.0),
        substrate_error=0.036,
        spacing_error=1e-3,
    ),
    Example("walls/wide-tube-on-pipe", "walls/wide-tube-on-pipe.step", 5.0, rod(0.0, 0.0, 32.0)),
    Example(
        "walls/skewed-bend", "walls/skewed-bend.step", 4.0, rod(200.0, 75.0, 30.0), has_cell=True
    ),
    Example(
        "walls/branched-tube-on-plate", "walls/branched-tube.step", 4.0, plate, spacing_error=1e-3
    ),
    Example("walls/spatial-pipe-on-cone", "walls/spatial-pipe.step", 4.0, cone, spacing_error=1e-3),
)


class Plans:
    """A copy of the examples, each planned once by the command."""

    def __init__(self, root: Path, folder: Path):
        self.folder = folder / "examples"
        shutil.copytree(
            root / "resources" / "examples",
            self.folder,
            ignore=shutil.ignore_patterns("out", "__pycache__"),
        )
        self._done = {}

    def text(self, job):
        return (self.folder / f"{job}.yaml").read_text(encoding="utf-8")

    def text_of(self, example):
        """Return the text of its job as shipped, except for its layer height."""
        text = self.text(example.job)
        changed = re.sub(
            r"(?m)^  layer_height: .*$", f"  layer_height: {example.height:g} mm", text
        )
        assert example.thicker == (changed != text)
        return changed

    def exact(self, text, chord_error):
        """Return a job without cell and clearance: only the fronts, with points so dense that
        chords represent the curve."""
        text = text.split("\ncell:")[0].replace("  clearance: none\n", "") + "\n"
        text = text.replace("build_direction:\n", "build_direction:\n  clearance: none\n")
        return re.sub(r"(  layer_height: .*\n)", rf"\1  chord_error: {chord_error:.6f} mm\n", text)

    def plan(self, job, text=None):
        """Return the plan of the job with its text changed; the job must succeed."""
        key = (job, text)
        if key not in self._done:
            self._done[key] = self._planned(job, text, self.folder / f"out{len(self._done)}")
        return self._done[key]

    def _planned(self, job, text, out):
        path = self.folder / f"{job}.yaml"
        if text is not None:
            path = path.with_name(f"{out.name}.yaml")
            path.write_text(text, encoding="utf-8")
        command = COMMANDS.run(self.folder, ["plan", str(path), "-o", str(out), "--no-page"])
        assert command.status == 0, command.err
        cell = read_job(str(path)).cell
        assert cell is None or row_limits.over_all(out, cell.machine, cell.limits) <= 0.0
        return wall_checks.read(out)
