# SPDX-License-Identifier: LGPL-2.1-or-later
"""Data of pictures. Derived data is computed on demand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..core.geometry.on_hub import Group, SolidsOnHub
from ..core.kinematics.cell import Cell
from ..core.layers.plane_field import Slabs, group_of, slabs
from ..core.motion import Motion
from ..core.parameters.process import ProcessParameters
from ..core.process import bead_model, model_notes, wire
from ..core.process.bead_model import BeadModel
from ..core.process.deposit import spacing
from ..core.process.wire import Measured
from ..core.simulation.achievable_feed import AchievableFeed, achievable_feed
from ..core.simulation.joint_trajectory import Rates, rates
from ..core.simulation.timeline import Timeline, timeline, volumes
from ..core.toolpath import Toolpath
from ..core.types import Array, Integers


@dataclass(frozen=True, eq=False)
class Source:
    """A job: the executed toolpath and its motion, without rapids if the job has no cell.

    condition, threshold: (n,) inverse condition number and its minimum per motion row, NaN if
    undefined. band: tolerance of local layer distances as a fraction of the layer height, None
    without a tolerance. solids: the filled solids, in place. cut_at: height above a layer's plane
    at which the layer is sliced, as a fraction of the layer height. max_void: void fraction above
    which a plane layer causes a warning.
    """

    toolpath: Toolpath
    motion: Motion
    process: ProcessParameters
    cell: Cell | None = None
    condition: Array | None = None
    threshold: Array | None = None
    band: float | None = None
    solids: SolidsOnHub | None = None
    cut_at: float = 0.5
    max_void: float = 1.0

    @cached_property
    def group(self) -> Group | None:
        """Return the bodies in plane layers, None for other layers."""
        return None if self.solids is None else group_of(self.solids)

    @cached_property
    def slabs(self) -> Slabs | None:
        """Return the volumes of part and deposit in each plane layer, None for other layers."""
        if self.group is None:
            return None
        return slabs(self.group, self.toolpath.layer_height, self.motion.position, self.volumes)

    @cached_property
    def times(self) -> Timeline:
        """Return the times at which each row is reached and left."""
        return timeline(self.motion, self.process, [layer.wait for layer in self.toolpath.layers])

    @cached_property
    def rates(self) -> Rates:
        """Return speeds, accelerations and jerks of the axes."""
        return rates(self.motion)

    @cached_property
    def volumes(self) -> Array:
        """Return the deposit volume (n,) of each row's segment, mm^3."""
        return volumes(self.motion, self.process, self.toolpath)

    @cached_property
    def feed(self) -> AchievableFeed | None:
        """Return the achievable feed of the machine; None without a cell."""
        if self.cell is None:
            return None
        return achievable_feed(
            self.motion, self.cell.machine.max_speed, self.cell.machine.max_acceleration
        )

    @cached_property
    def distances(self) -> tuple[Array, Integers]:
        """Return the known local layer distances (n,), mm, and their layers (n,).

        Beads that close gaps are excluded.
        """
        beads = list(self.toolpath)
        local = spacing.local_distances(self.toolpath)
        selected = [
            values
            for (_, _, bead), values in zip(beads, local, strict=True)
            if not bead.role.closing
        ]
        layers = [np.full(len(bead), layer) for layer, _, bead in beads if not bead.role.closing]
        values, layer = (
            np.concatenate([*selected, np.zeros(0)]),
            np.concatenate([*layers, np.zeros(0, np.int64)]),
        )
        finite = np.isfinite(values)
        return values[finite], layer[finite].astype(np.int64)

    @cached_property
    def model(self) -> tuple[Measured, BeadModel] | None:
        """Return the bead model table and its fit, None without a bead model.

        Raises InputError for an unreadable table.
        """
        if self.process.bead_model == "none":
            return None
        measured = wire.read_table(self.process.bead_model)
        return measured, bead_model.fit(*measured)

    def segments(self, layers: tuple[int, int]) -> model_notes.Segments:
        """Return the bead model's prediction for layers, first to last inclusive."""
        low, high = layers
        return model_notes.segments(
            [bead for layer, _, bead in self.toolpath if low <= layer <= high]
        )
