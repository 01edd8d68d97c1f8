# SPDX-License-Identifier: LGPL-2.1-or-later
"""How a family plans a feature of a document: layers and beads, clearance of the nozzle, checks
against the part.

A planner imports its strategy when a feature is planned: importing every family takes longer than
planning a small part.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np

from ...brep.shapes.off_part import off_faces, off_facets, off_mesh, off_solids
from ...core.geometry.obstacles import Body
from ...core.issues import InputError, Issue
from ...core.parameters.build_direction import BuildDirectionParameters
from ...core.process.deposit import on_part
from ...core.strategies.revolution import clearance
from ...core.toolpath import Toolpath
from ...core.types import Array
from ..shapes.bodies import Taken
from ..work import progress
from .given import Given, platform_frame
from .recognition import Proposal, Refusal, SelectedPart

if TYPE_CHECKING:
    from ...core.inspection.planned import Planned

STRATEGY = 0.7  # share of the time for layers and beads, the rest keeps the nozzle clear
CHECKED = 0.92  # the remaining share is for the final checks
CLEARING = "keeping the nozzle clear"


class PartDistances(NamedTuple):
    """Checked places, their distances (n,) mm from the part, and the allowed distance, mm."""

    places: on_part.Places
    off: Array
    limit: float


class FeaturePlanner:
    """What a family of `core.families` does with document objects; the file has its kind as name.

    proxy: module and class of its features in `objects`, a file format. allowance_remedy: how to
    deposit more where a deposit is too small, with {} for by how much. has_faces: whether its parts
    have faces that a deposit can cover. recognition_rank: of families that recognise a part, the one
    with the lowest rank is proposed; None: a user chooses the family.
    """

    proxy: ClassVar[tuple[str, str]]
    recognition_rank: ClassVar[int | None] = None
    allowance_remedy: ClassVar[str] = (
        "Make beads {} mm wider on either side (process.bead_width), or use a smaller allowance"
    )
    has_faces: ClassVar[bool] = True

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Return whether to propose this family for a part, and why. remark: of a family with a lower
        rank, for the reason.
        """
        raise NotImplementedError

    def plan_layers(self, inputs: Given) -> Toolpath:
        """Return layers and beads. Raises the InputErrors of the family."""
        raise NotImplementedError

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        """Return the toolpath with tools tilted clear of bodies and deposit.

        feature: the number of the feature of `inputs` among several, which is kept clear.
        """
        return tilt_clear(toolpath, inputs, bodies, feature)

    def is_on_part(self, wall: Any) -> bool:
        """Return whether a feature has a part to compare its toolpath with."""
        return True

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return the distances of places from the part; None if the part has no faces there."""
        limit = on_part.allowed_distance(toolpath)
        return PartDistances(
            places, distances_from_faces(inputs.wall, sources[0], places.points, limit), limit
        )

    def planned_surface(self, value: Any, name: str) -> Planned:
        """Return the surface of a feature's wall or solids to compare measured points with. Raises
        InputError NOT_FOR_FAMILY naming it.
        """
        raise InputError(
            "NOT_FOR_FAMILY",
            name,
            "curves and cladding have no planned surface; compare the points with the part",
        )

    def bodies_to_cover(self, wall: Any) -> list[Body] | None:
        """Return the solids that a deposit is to enclose; None if it is to cover faces."""
        return None

    def faces_to_cover(self, wall: Any, selected: tuple[str, ...]) -> tuple[str, ...]:
        """Return the names of the faces to cover, none for the whole part. selected: of the link."""
        return selected


def distances_from_faces(wall: Any, source: Taken, points: Array, limit: float) -> Array:
    """Return the distances (n,) mm of points (n, 3) from the faces of a wall, exact up to a limit."""
    if source.shape is not None:
        return off_faces(source.shape, wall.faces, points, limit)
    body = source.body()
    return np.maximum(off_facets(body.vertices, body.triangles, points) - wall.smoothing, 0.0)


def distances_from_solids(sources: Sequence[Taken], points: Array, limit: float) -> Array:
    """Return the distances (n,) mm of points (n, 3) from the nearest solid, exact up to a limit."""
    distances: Array = np.min(
        [_distances_from_solid(source, points, limit) for source in sources], axis=0
    )
    return distances


def _distances_from_solid(source: Taken, points: Array, limit: float) -> Array:
    if source.shape is not None:
        return off_solids(source.shape, points, limit)
    body = source.body()
    return off_mesh(body.vertices, body.triangles, points)


def refuse_below(toolpath: Toolpath, inputs: Given, remedy: str = clearance.MOVE) -> None:
    """Raise InputError OFF_PLATFORM for beads below the platform of the cell."""
    if inputs.cell is None:
        return
    points = np.vstack([bead.points for _, _, bead in toolpath])
    stands = platform_frame(toolpath, inputs, inputs.cell)
    clearance.refuse_below(inputs.wall.label, points, stands, inputs.cell.platform_diameter, remedy)


def share_strategy(fraction: float, text: str) -> None:
    """Report the progress of layers and beads."""
    progress.report(STRATEGY * fraction, text)


def tilt_clear(
    toolpath: Toolpath,
    inputs: Given,
    bodies: Sequence[Body],
    feature: int | None,
    build: BuildDirectionParameters | None = None,
    plane: Array | None = None,
) -> Toolpath:
    """As `clear_by_tilt.keep_clear`; reports its progress, and once that it takes long. build: in place
    of the feature's.
    """
    from ...core.strategies import estimated_size
    from ...core.strategies.clearance import clear_by_tilt
    from ...core.strategies.progress import Watch

    issues: list[Issue] = []

    def report_points(points: int, times: int) -> None:
        for issue in () if issues else estimated_size.tilting_issues(points, times):
            issues.append(issue)
            progress.report_issue(issue)

    def share(fraction: float) -> None:
        progress.report(STRATEGY + fraction * (CHECKED - STRATEGY), CLEARING)

    return clear_by_tilt.keep_clear(
        toolpath,
        bodies,
        inputs.nozzle,
        build or inputs.build,
        plane,
        feature,
        Watch(report_points, share),
    )
