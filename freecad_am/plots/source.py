# SPDX-License-Identifier: LGPL-2.1-or-later
"""The data of pictures, with derived data computed on demand."""

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
from ..core.simulation.table_links import Rates, rates
from ..core.simulation.timeline import Timeline, timeline, volumes
from ..core.toolpath import Toolpath
from ..core.types import Array, Integers


@dataclass(frozen=True, eq=False)
class Source:
    """A job: its toolpath as run and its motion, without rapids if it has no cell.

    condition, threshold: (n,) per row of the motion, NaN if undefined. band: tolerance of local
    distances as a share of the layer height, None without one. solids: the filled solids in place;
    cut_at: share of a layer height above its plane at which a plane layer is cut. max_void: share
    of void above which a plane layer is warned about.
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
        """The bodies in plane layers, None for other layers."""
        return None if self.solids is None else group_of(self.solids)

    @cached_property
    def slabs(self) -> Slabs | None:
        """Return the sections of part and deposit in each planar layer."""
        if self.group is None:
            return None
        return slabs(self.group, self.toolpath.layer_height, self.motion.position, self.volumes)

    @cached_property
    def times(self) -> Timeline:
        """When each row is reached and left."""
        return timeline(self.motion, self.process, [layer.wait for layer in self.toolpath.layers])

    @cached_property
    def rates(self) -> Rates:
        """Speeds, accelerations and jerks of the axes."""
        return rates(self.motion)

    @cached_property
    def volumes(self) -> Array:
        """(n,) mm^3 of each row's segment."""
        return volumes(self.motion, self.process, self.toolpath)

    @cached_property
    def feed(self) -> AchievableFeed | None:
        """Return the feed that the machine achieves; None without a machine."""
        if self.cell is None:
            return None
        return achievable_feed(
            self.motion, self.cell.machine.max_speed, self.cell.machine.max_acceleration
        )

    @cached_property
    def distances(self) -> tuple[Array, Integers]:
        """(n,) mm, the local distances between layers that are known, beads that close gaps left out; the layer of each."""
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
        """The table of the bead model and its fit; None without one.
        Raises InputError where the table cannot be read."""
        if self.process.bead_model == "none":
            return None
        measured = wire.read_table(self.process.bead_model)
        return measured, bead_model.fit(*measured)

    def segments(self, layers: tuple[int, int]) -> model_notes.Segments:
        """What the bead model predicts of the beads of layers, the last one included."""
        low, high = layers
        return model_notes.segments(
            [bead for layer, _, bead in self.toolpath if low <= layer <= high]
        )
