# SPDX-License-Identifier: LGPL-2.1-or-later
"""Base of the family planners: layers and beads, nozzle clearance, checks against the part.

A planner imports its strategy when it plans a feature, because importing every family takes longer
than planning a small part.
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

STRATEGY = 0.7  # progress fraction after layers and beads, before nozzle clearance
CHECKED = 0.92  # progress fraction before the final checks
CLEARING = "keeping the nozzle clear"


class PartDistances(NamedTuple):
    """Checked points, their distances (n,) from the part, mm, and the maximum distance, mm."""

    places: on_part.Places
    off: Array
    limit: float


class FeaturePlanner:
    """Base of planners, which connect a family of `core.families` to document objects.

    proxy: module and class of the feature objects in `objects`, a file format. allowance_remedy:
    remedy for a deposit that is too small, with {} for the shortfall. has_faces: whether parts of
    the family have faces to cover. recognition_rank: the family with the lowest rank that
    recognises a part is proposed; None if only a user chooses the family.
    """

    proxy: ClassVar[tuple[str, str]]
    recognition_rank: ClassVar[int | None] = None
    allowance_remedy: ClassVar[str] = (
        "Make beads {} mm wider on either side (process.bead_width), or use a smaller allowance"
    )
    has_faces: ClassVar[bool] = True

    def recognise(self, part: SelectedPart, remark: str) -> Proposal | Refusal:
        """Propose or refuse this family for a part, with a reason.

        remark: remark of a family with a lower rank, to add to the reason.
        """
        raise NotImplementedError

    def plan_layers(self, inputs: Given) -> Toolpath:
        """Plan layers and beads. Raises the InputErrors of the family."""
        raise NotImplementedError

    def keep_clear(
        self, toolpath: Toolpath, inputs: Given, bodies: Sequence[Body], feature: int | None
    ) -> Toolpath:
        """Tilt the tool axes of a toolpath clear of bodies and deposit.

        feature: index of the feature of `inputs` among several; only this feature is tilted.
        """
        return tilt_clear(toolpath, inputs, bodies, feature)

    def is_on_part(self, wall: Any) -> bool:
        """Whether a feature has a part to compare its toolpath with."""
        return True

    def part_distances(
        self, toolpath: Toolpath, inputs: Given, sources: Sequence[Taken], places: on_part.Places
    ) -> PartDistances | None:
        """Return the distances of points from the part, None if the part has no suitable faces."""
        limit = on_part.allowed_distance(toolpath)
        return PartDistances(
            places, distances_from_faces(inputs.wall, sources[0], places.points, limit), limit
        )

    def planned_surface(self, value: Any, name: str) -> Planned:
        """Return the nominal surface of a feature, for comparison with measured points.

        Raises InputError NOT_FOR_FAMILY, naming the feature, if the family has no such surface.
        """
        raise InputError(
            "NOT_FOR_FAMILY",
            name,
            "curves and cladding have no planned surface; compare the points with the part",
        )

    def bodies_to_cover(self, wall: Any) -> list[Body] | None:
        """Return the solids that a deposit must enclose, None if it must cover faces."""
        return None

    def faces_to_cover(self, wall: Any, selected: tuple[str, ...]) -> tuple[str, ...]:
        """Return the names of the faces to cover, empty for the whole part.

        selected: face names of the feature's link.
        """
        return selected


def distances_from_faces(wall: Any, source: Taken, points: Array, limit: float) -> Array:
    """Return distances (n,), mm, of points (n, 3) from the faces of a wall, exact up to `limit`."""
    if source.shape is not None:
        return off_faces(source.shape, wall.faces, points, limit)
    body = source.body()
    return np.maximum(off_facets(body.vertices, body.triangles, points) - wall.smoothing, 0.0)


def distances_from_solids(sources: Sequence[Taken], points: Array, limit: float) -> Array:
    """Return distances (n,), mm, of points (n, 3) from the nearest solid, exact up to `limit`."""
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
    """Report the progress of planning layers and beads."""
    progress.report(STRATEGY * fraction, text)


def tilt_clear(
    toolpath: Toolpath,
    inputs: Given,
    bodies: Sequence[Body],
    feature: int | None,
    build: BuildDirectionParameters | None = None,
    plane: Array | None = None,
) -> Toolpath:
    """Call `clear_by_tilt.keep_clear` with progress reports and a notice of long run time.

    build: build direction parameters that replace those of the feature.
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
