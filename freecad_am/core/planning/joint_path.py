# SPDX-License-Identifier: LGPL-2.1-or-later
"""The joint path: the planning result for every bead."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..issues import Issue, has_errors
from ..motion import Motion
from ..toolpath import Bead, Toolpath
from ..types import Array


@dataclass(frozen=True, eq=False)
class BeadPath:
    """The joints of one bead of n points.

    bead: the bead as planned; its seam may have moved, or it may be a piece of a split bead. phi:
    (n,) rotation about the tool axis, rad. joints: (n, axes) serial joint values, rad or mm,
    unwrapped within the bead, NaN where unreachable. condition, threshold: (n,) sigma_min /
    sigma_max and its required minimum. coefficients: of the layer's rotation polynomial in
    ascending order; None without a polynomial. reason, iterations: stop reason and iteration count
    of the optimiser.
    """

    layer: int
    index: int
    bead: Bead
    phi: Array
    joints: Array
    condition: Array
    threshold: Array
    objective: float
    margin: float
    coefficients: Array | None = None
    reason: str = ""
    iterations: int = 0

    @property
    def reachable(self) -> bool:
        """Whether every point has joint values."""
        return bool(np.isfinite(self.joints).all())


def numbered(paths: Sequence[BeadPath]) -> list[BeadPath]:
    """Renumber beads within each layer, because planning may have split some."""
    count: dict[int, int] = {}
    result = []
    for path in paths:
        index = count.get(path.layer, 0)
        count[path.layer] = index + 1
        result.append(replace(path, index=index))
    return result


@dataclass(frozen=True)
class JointPath:
    """The joint path of a toolpath: beads in print order, and issues."""

    method: str
    objective: str
    branch: tuple[str, ...]  # empty for a five-axis machine
    limits: str
    beads: tuple[BeadPath, ...]
    issues: tuple[Issue, ...]
    comparison: tuple[dict[str, object], ...] = ()
    optimality: dict[str, object] | None = None  # with joints.certificate: objective, bound and gap
    of_level: dict[str, object] | None = (
        None  # with optimised external axes: statistics of the `level` plan
    )

    @property
    def feasible(self) -> bool:
        """Whether the path has no errors (reach, limits, condition, collisions, speeds)."""
        return not has_errors(self.issues)

    @property
    def joints(self) -> Array:
        """Return the joints of all deposit points.

        Returns
        -------
        (T, axes) array
            Joints, rad or mm.
        """
        return np.concatenate([bead.joints for bead in self.beads])

    def conditions(self, motion: Motion) -> tuple[Array, Array]:
        """Return condition and threshold of the deposit rows of a motion.

        Parameters
        ----------
        motion : Motion
            The motion of this joint path, with T deposit rows.

        Returns
        -------
        condition, threshold : (T,) array
            NaN for the seam overlap of a bead.
        """
        starts = np.flatnonzero(motion.point[motion.deposit] == 0)
        condition = np.full(int(motion.deposit.sum()), np.nan)
        threshold = condition.copy()
        for start, path in zip(starts.tolist(), self.beads):
            condition[start : start + len(path.condition)] = path.condition
            threshold[start : start + len(path.threshold)] = path.threshold
        return condition, threshold

    def toolpath(self, planned: Toolpath) -> Toolpath:
        """Return the toolpath with its beads as executed, with moved seams and split beads."""
        layers = []
        for index, layer in enumerate(planned.layers):
            beads = tuple(path.bead for path in self.beads if path.layer == index)
            layers.append(replace(layer, beads=beads))
        return replace(planned, layers=tuple(layers))
