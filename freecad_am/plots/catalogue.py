# SPDX-License-Identifier: LGPL-2.1-or-later
"""All pictures by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from . import joints
from .chart import Chart, Picture, fit
from .joints import TIME, Rows, rows
from .source import Source

Charts = tuple[Chart, ...]


@dataclass(frozen=True)
class Entry:
    """A picture. along: drawn over time or path, by which its charts come; else `of`, from layers. machine: needs a cell."""

    title: str
    along: Callable[[Source, Rows], Charts] | None = None
    from_layers: Callable[[Source, tuple[int, int]], Charts] | None = None
    machine: bool = False
    lacking: str = "these layers have nothing to show"


def _fit(source: Source, layers: tuple[int, int]) -> Charts:
    model = source.model
    return () if model is None else (fit(*model, source.process.bead_width),)


_NO_PLANES = "only solids in planar layers have sections and volumes of layers"
_NO_MODEL = "no bead model sets the speeds (process.bead_model)"
PICTURES = {
    "angles": Entry("Joint angles", joints.angles, machine=True),
    "speeds": Entry("Joint speeds", joints.speeds, machine=True),
    "shares": Entry("Joint speeds in %", joints.shares, machine=True),
    "accelerations": Entry("Joint accelerations", joints.accelerations, machine=True),
    "jerks": Entry("Joint jerks", joints.jerks, machine=True),
    "condition": Entry(
        "Condition", joints.condition, machine=True, lacking="this machine has no condition"
    ),
    "travel": Entry("Speed along the path", joints.travel),
    "deposit": Entry("Deposit rate", joints.deposit),
    "spacing": Entry(
        "Distance between layers",
        from_layers=joints.spacing,
        lacking="none of these layers rests on another",
    ),
    "volumes": Entry("Volume by layer", from_layers=joints.by_layer, lacking=_NO_PLANES),
    "infill": Entry(
        "Void and double deposit",
        from_layers=joints.infill,
        lacking="only solids in planar layers are measured for void and double deposit",
    ),
    "section": Entry("Section of the last layer", from_layers=joints.section, lacking=_NO_PLANES),
    "heights": Entry("Predicted heights", from_layers=joints.heights, lacking=_NO_MODEL),
    "spread": Entry(
        "Predicted widths and speeds", from_layers=joints.distributions, lacking=_NO_MODEL
    ),
    "fit": Entry("Fit of the bead widths", from_layers=_fit, lacking=_NO_MODEL),
}


def picture(
    name: str, source: Source, over: str = TIME, layers: tuple[int, int] | None = None
) -> Picture:
    """A picture of PICTURES, over TIME or PATH where it is one along the job. layers: first and last, all when left out.

    One that there is not has no charts and says why. Raises InputError where a table of a bead model cannot be read.
    """
    entry = PICTURES[name]
    if entry.machine and source.cell is None:
        return Picture(name, entry.title, (), "a toolpath has no joints yet; choose a joint path")
    if entry.along is not None:
        charts = entry.along(source, rows(source, over, layers))
    else:
        assert entry.from_layers is not None
        charts = entry.from_layers(source, layers or (0, len(source.toolpath.layers) - 1))
    return Picture(name, entry.title, charts, "" if charts else entry.lacking)
