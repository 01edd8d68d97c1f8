# SPDX-License-Identifier: LGPL-2.1-or-later
"""Solids: cut into layers, filled, ordered and deposited at speeds that keep the bead width (Dai 2020)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from ...collision.inside import Inside, inside_of
from ...filling.cover import Cover
from ...geometry.columns import dots, unit_rows
from ...geometry.curves.guide import Guide
from ...geometry.curves.plane_curve import divide_edges
from ...geometry.developable import Developable, Plane
from ...geometry.formatting import place
from ...geometry.mesh.coarsen import doubled_areas
from ...geometry.mesh.solid import SolidMesh, connected_pieces
from ...geometry.obstacles import Body, meeting_boxes
from ...geometry.on_hub import Group, SolidsOnHub, solids_beyond
from ...geometry.regions.region import Region
from ...geometry.section import Section
from ...geometry.step_count import step_counts
from ...issues import WARNING, InputError, Issue, Text
from ...layers import field
from ...layers.field import Stack
from ...layers.plane_field import CLEARANCE_SHARE, EXACT, Flat
from ...layers.surface import Slice
from ...parameters.build_direction import BuildDirectionParameters
from ...parameters.filled import FilledParameters
from ...parameters.process import ProcessParameters
from ...process.bead_model import BeadModel
from ...process.bead_order import Course, IslandOrder, RankedBead, order_beads
from ...process.cooling_waits import add_waits
from ...process.seams import SeamPlacer
from ...toolpath import Bead, Checks, Layer, MotionRules, Toolpath
from ...types import Array, Mask
from .. import estimated_size
from ..progress import Progress, silent
from .beads import BeadMaker, MadeBead, slab_volumes, start_beads, twice_volume, volumes
from .filling import Bare, Pictures, bead_width, over_fed, spaced
from .notes import notes

FINER = 8.0  # refinement factor where a solid cuts another solid
INWARDS = (
    1e-3  # fraction of the distance to the centroid by which a triangle corner is moved inwards
)
PLACES = (
    10_000  # number of squares on the surface of the solids; their size limits the triangle edges
)
CONTACT_CHORDS = 3.0  # chord errors; maximum distance of coinciding surfaces
MIN_CONTACT_MM = 1e-3  # mm; lower bound of this distance
TOUCHING = 3e-3  # fraction of the volume; solids that share less only touch, within accuracy


def part_volume(solids: SolidsOnHub) -> float | None:
    """Return the volume of the solids outside of their hubs, mm3; None if a solid is open.

    Volume shared by several solids counts once.
    """
    exact_volume = solids_beyond(solids)
    if exact_volume is not None:
        return exact_volume
    tolerance = max(CONTACT_CHORDS * solids.chord_error, MIN_CONTACT_MM)
    volumes = [_union_volume(group.bodies, tolerance) for group in solids.groups]
    return None if None in volumes else sum(volume for volume in volumes if volume is not None)


def _union_volume(bodies: Sequence[Body], tolerance: float) -> float | None:
    """Return the volume of the union of bodies, mm3; surfaces within `tolerance`, mm, coincide."""
    insides = [inside_of(body) for body in bodies]
    volumes = [SolidMesh(body.vertices, body.triangles).volume for body in bodies]
    if any(inside is None for inside in insides):
        return None
    closed = [inside for inside in insides if inside is not None]
    corners = [
        body.corners() if volume > 0.0 else body.corners()[:, ::-1]
        for body, volume in zip(bodies, volumes, strict=True)
    ]
    middle = np.vstack([corner.reshape(-1, 3) for corner in corners]).mean(axis=0)
    surface = (
        sum(float(np.linalg.norm(doubled_areas(corner_), axis=1).sum()) for corner_ in corners)
        / 2.0
    )
    longest = float(np.sqrt(surface / PLACES))
    total = sum(abs(volume) for volume in volumes)
    shared = 0.0
    boxes = (
        np.array([inside.low for inside in closed]),
        np.array([inside.high for inside in closed]),
    )
    for number, (corner, met) in enumerate(zip(corners, meeting_boxes(*boxes))):
        other_bodies = [(k, closed[k]) for k in met.tolist()]
        if other_bodies:
            shared += _hidden_volume(
                corner - middle, longest, _hiding(number, other_bodies, tolerance, middle)
            )
    return total if shared < TOUCHING * total else total - shared


def _hidden_volume(corner: Array, longest: float, hidden: Callable[[Array, Array], Mask]) -> float:
    """Return the volume, mm3, below the hidden parts of triangles (m, 3, 3), from the origin.

    Partly hidden pieces are divided FINER times finer. hidden: predicate for points (n, 3) with areas (n, 3).
    """
    triangles = _divided(corner, longest)
    areas, middles = doubled_areas(triangles) / 2.0, triangles.mean(axis=1)
    at_middle = hidden(middles, areas)
    at_corners = [
        hidden(triangles[:, k] + INWARDS * (middles - triangles[:, k]), areas) for k in range(3)
    ]
    mixed = np.any([mask != at_middle for mask in at_corners], axis=0)
    is_hidden = at_middle & ~mixed
    volume = float(dots(middles[is_hidden], areas[is_hidden]).sum()) / 3.0
    if mixed.any():
        fine = _divided(triangles[mixed], longest / FINER)
        areas, middles = doubled_areas(fine) / 2.0, fine.mean(axis=1)
        cut = hidden(middles, areas)
        volume += float(dots(middles[cut], areas[cut]).sum()) / 3.0
    return volume


def _hiding(
    number: int, other_bodies: Sequence[tuple[int, Inside]], tolerance: float, origin: Array
) -> Callable[[Array, Array], Mask]:
    """Return the predicate `hidden` for surface points (n, 3) of a body, from an origin, with outward areas (n, 3).

    A point is hidden inside another body, or on a coinciding surface that faces the opposite way. Of coinciding
    surfaces that face the same way, only the first body's surface is visible.
    """

    def hidden(points: Array, areas: Array) -> Mask:
        outwards, points = tolerance * unit_rows(areas), points + origin
        mask = np.zeros(len(points), dtype=bool)
        for k, inside in other_bodies:
            mask |= inside.holds(points + outwards)
            if k < number:
                mask |= inside.holds(points - outwards)
        return mask

    return hidden


def _divided(corner: Array, longest: float) -> Array:
    """Halve triangles (m, 3, 3) until no side is longer than `longest`; return triangles (n, 3, 3)."""
    triangles = []
    while len(corner):
        side = np.linalg.norm(np.roll(corner, -1, axis=1) - corner, axis=2)
        top = np.argmax(side, axis=1)
        small = side[np.arange(len(top)), top] <= longest
        triangles.append(corner[small])
        corner, top = corner[~small], top[~small]
        a, b, c = (corner[np.arange(len(top)), (top + k) % 3] for k in range(3))
        middle = 0.5 * (a + b)
        corner = np.concatenate(
            [np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)]
        )
    return np.concatenate(triangles)


class BareLayer(NamedTuple):
    """A layer of a stack that has regions of the part but no bead."""

    stack: Stack
    layer: Slice
    bare_places: Sequence[Bare]


def empty_layer_issues(bare: Sequence[BareLayer], course: Course) -> list[Issue]:
    """Return one issue per stack that lists the layers without beads, with area and largest location."""
    issues = []
    for stack in dict.fromkeys(bare_layer.stack for bare_layer in bare):
        stack_layers = [bare_layer for bare_layer in bare if bare_layer.stack == stack]
        largest, layer = max(
            (
                (bare_place, bare_layer.layer)
                for bare_layer in stack_layers
                for bare_place in bare_layer.bare_places
            ),
            key=lambda pair: pair[0].area,
        )
        numbers = [
            course.number(stack.group, stack.solid, bare_layer.layer.number)
            for bare_layer in stack_layers
        ]
        layer_numbers = [
            bare_layer.layer.number if number is None else number
            for number, bare_layer in zip(numbers, stack_layers)
        ]
        issues.append(
            Issue(
                WARNING,
                "LAYER_WITHOUT_BEAD",
                Text(
                    "{} layer(s) of {} get no bead, because all regions are too narrow: {}; the "
                    "largest, {:.3g} mm^2 and {:.3g} mm wide, is at {}; the total is {:.4g} "
                    "mm^2; use narrower beads, lower strategy.narrowest, or make the part "
                    "thicker there",
                    len(stack_layers),
                    stack.name,
                    ranges(layer_numbers),
                    largest.area,
                    largest.width,
                    layer.where(largest.point),
                    math.fsum(
                        bare_place.area
                        for bare_layer in stack_layers
                        for bare_place in bare_layer.bare_places
                    ),
                ),
                numbers[0],
            )
        )
    return issues


def ranges(numbers: Sequence[int]) -> str:
    """Format numbers, with consecutive numbers as ranges: 0-6, 9."""
    runs: list[list[int]] = []
    for number in sorted(set(numbers)):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return ", ".join(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}" for run in runs)


PLANE_TOLERANCE_MM = 1e-6  # mm; also the tolerance of cosines


def plan(
    solids: SolidsOnHub,
    strategy: FilledParameters,
    build: BuildDirectionParameters,
    process: ProcessParameters,
    model: BeadModel | None,
    progress: Progress = silent,
) -> Toolpath:
    """Plan the toolpath of solids; layer i is i layer heights above the base.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids with their bases.
    strategy : FilledParameters
        Layers, filling, margin and order.
    build : BuildDirectionParameters
        Build direction and its limits.
    process : ProcessParameters
        Speeds and bead width.
    model : BeadModel or None
        Bead model that sets the speeds; None to use the travel speed everywhere.
    progress : callable, optional
        Called with the completed fraction and a text; may raise to cancel.

    Returns
    -------
    Toolpath
        The toolpath in part coordinates.

    Raises
    ------
    InputError
        APEX_INSIDE, TOO_FAR_ROUND, BEAD_SPACING, NOTHING_TO_DEPOSIT, NOT_FOR_FAMILY,
        TOO_MANY.
    InfeasibleError
        THIN_REGION.

    References
    ----------
    Dai 2020.
    """
    _refuse_mode(solids.has_plane_layers(), strategy, build)
    strategy = spaced(strategy, process)
    estimated_size.refuse_absurd(
        estimated_size.solids_size(solids, strategy, strategy.bead_spacing),
        strategy,
        None if strategy.bead_overlap is None else process.bead_width,
    )
    width = bead_width(strategy, process, model)
    pictures = Pictures(strategy, process, width)
    maker = BeadMaker(strategy, build, process, model)
    ranked: list[RankedBead] = []
    made_beads: list[MadeBead] = []
    issues: list[tuple[Stack, Issue]] = []
    bare: list[BareLayer] = []
    covers: list[Cover] = []
    numbers: list[int] = []  # layer index of each cover
    sections: list[tuple[Stack, int, Section]] = []
    heights: dict[
        int, list[float]
    ] = {}  # minimum and maximum height of each uneven layer over all stacks
    order = IslandOrder(as_below=strategy.min_layer_time > 0.0)
    stacks = list(field.stacks(solids, strategy))
    for stack_number, stack in enumerate(stacks):
        order.below = None  # this stack has no layer yet
        placer = SeamPlacer(process.seam, strategy.chord_error, width)
        for layer in stack.layers:
            progress(
                (stack_number + layer.share_before) / len(stacks),
                f"{stack.name} layer {layer.number}",
            )
            picture = pictures.filled(layer, stack.name)
            issues += [(stack, issue) for issue in (*layer.issues, *picture.issues)]
            if picture.bare and not picture.curves:
                bare.append(BareLayer(stack, layer, picture.bare))
            if layer.heights is not None:
                heights.setdefault(layer.number, []).extend(layer.heights[::2])
            numbers.append(layer.number)
            section = section_of(layer, strategy)
            if section is not None:
                sections.append((stack, layer.number, section))
            covers.append(
                picture.cover.scaled(
                    1.0 if layer.heights is None else layer.heights[1] / strategy.layer_height
                )
            )
            made_in_layer = start_beads(
                [maker.bead_of(curve, layer) for curve in picture.curves], placer, layer.number
            )
            made_beads += made_in_layer
            beads = [made_bead.bead for made_bead in made_in_layer]
            if solids.has_plane_layers():
                ranked += [
                    RankedBead(stack.group, stack.solid, layer.number, -len(ranked) - rank, bead)
                    for rank, bead in enumerate(order.order_islands(beads, picture.islands))
                ]
            else:
                ranked += [
                    RankedBead(stack.group, stack.solid, layer.number, bead.role.ring, bead)
                    for bead in beads
                ]
        issues += [(stack, issue) for issue in placer.issues()]
    if not ranked:
        raise InputError(
            "NOTHING_TO_DEPOSIT",
            solids.label,
            "no bead of {:g} mm or more fits in any layer; use a smaller bead spacing, or "
            "strategy.thin: single",
            strategy.least_bead,
        )
    course = order_beads(ranked, strategy.order)
    layers = add_waits(course, strategy.wait, process.rapid_speed, strategy.min_layer_time)
    layers = add_sections(layers, sections, course)
    missed = uncut(solids, strategy, ranked, width)
    all_issues = [
        *solids.issues,
        *[_numbered(issue, stack, course) for stack, issue in issues],
        *empty_layer_issues(bare, course),
        *uncut_issues(missed, strategy),
        *over_fed(strategy, process, model, width),
        *notes(made_beads, layers, strategy, build, process, model),
    ]
    return Toolpath(
        layers,
        solids.frame,
        strategy.layer_height,
        strategy.chord_error,
        tuple(all_issues),
        "solid" if solids.has_plane_layers() else "developable",
        solids.surroundings,
        None if model is None else model.law(process.acceleration),
        width,
        checks=Checks(
            volumes=volumes(
                None if strategy.margin else part_volume(solids),
                strategy,
                covers,
                sum(piece.bare for piece in missed),
                slab_volumes(solids, strategy),
                numbers,
            ),
            twice=twice_volume(made_beads, strategy, covers, width),
            uneven=np.array(
                [
                    (number, min(extremes), max(extremes))
                    for number, extremes in sorted(heights.items())
                ]
            )
            if heights
            else None,
        ),
        rules=MotionRules(process.overlap),
    )


def _numbered(issue: Issue, stack: Stack, course: Course) -> Issue:
    """Return an issue of a stack's layer with the layer index in the toolpath, None if the toolpath lacks the layer."""
    if issue.layer is None:
        return issue
    return replace(issue, layer=course.number(stack.group, stack.solid, issue.layer))


def _refuse_mode(planes: bool, strategy: FilledParameters, build: BuildDirectionParameters) -> None:
    if (strategy.has_curved_layers or strategy.follows_guide) and build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY",
            "build_direction.mode",
            "{} does not apply to curved layers, which grow along their normals; use local",
            build.mode,
        )
    if planes:
        if build.mode == "symmetry-plane":
            raise InputError(
                "NOT_FOR_FAMILY",
                "build_direction.mode",
                "symmetry-plane is for walls; planar layers grow along their normal: use local "
                "or fixed",
            )
    elif build.mode != "local":
        raise InputError(
            "NOT_FOR_FAMILY",
            "build_direction.mode",
            "{} does not apply to solids on a hub, which grow along its normals; use local",
            build.mode,
        )


def clear_by_itself(toolpath: Toolpath, solids: SolidsOnHub) -> bool:
    """Whether nothing can be above the nozzle tip.

    This is so if each layer is a plane below the next layer, the tool is upright, and all obstacles are below the first
    layer.
    """
    up, origin = solids.groups[0].base.frame[:3, 2], solids.groups[0].base.frame[:3, 3]
    previous_height = -np.inf
    for _, _, bead in toolpath:
        height = float((bead.points[0] - origin) @ up)
        if (
            height < previous_height - PLANE_TOLERANCE_MM
            or (bead.tool @ up).min() < 1.0 - PLANE_TOLERANCE_MM
        ):
            return False
        previous_height = height
    return all(
        float(((body.vertices - origin) @ up).max()) < PLANE_TOLERANCE_MM
        for body in solids.surroundings
    )


def lift_axis_limits(build: BuildDirectionParameters) -> BuildDirectionParameters:
    """Remove the tilt limit: on a hub tool axes point in any direction, because the machine rotates the hub."""
    return replace(build, max_tilt=np.pi)


# ---- Sections of the part in planar layers, kept in the toolpath to measure how well beads fill them


def section_of(layer: Slice, strategy: FilledParameters) -> Section | None:
    """Return the section of the part in a layer; None for a curved layer."""
    surface = layer.surface
    regions = [region for region in layer.regions if isinstance(region, Region)]
    if not isinstance(surface, Flat) or not regions:
        return None
    origin, x, y = layer.base.to_part(
        surface.wrap(np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])).points
    )
    frame = np.eye(4)
    frame[:3] = np.column_stack([x - origin, y - origin, np.cross(x - origin, y - origin), origin])
    is_sparse = strategy.is_sparse and layer.buried != ()
    loops = tuple(border for region in regions for border in region.borders())
    narrowest = strategy.narrowest if strategy.adapts_widths else 1.0
    return Section(frame, loops, strategy.bead_spacing, is_sparse, narrowest)


def add_sections(
    layers: Sequence[Layer], sections: Sequence[tuple[Stack, int, Section]], course: Course
) -> tuple[Layer, ...]:
    """Store in each layer the section that its beads fill.

    Parameters
    ----------
    layers : sequence of Layer
        All layers of the toolpath, in the order of the course.
    sections : sequence of (Stack, int, Section)
        Stack, layer index in this stack, and section.
    course : Course
        Maps layers of stacks to layers of the toolpath. Sections of omitted layers are dropped.

    Returns
    -------
    tuple of Layer
        The layers. Several sections in one layer are joined, and sparse if any of them is sparse. Layers without a
        section have None.
    """
    by_layer: dict[int, Section] = {}
    for stack, stack_layer, section in sections:
        number = course.number(stack.group, stack.solid, stack_layer)
        if number is None:
            continue
        if (earlier := by_layer.get(number)) is not None:
            section = replace(
                earlier,
                loops=(*earlier.loops, *section.loops),
                is_sparse=earlier.is_sparse or section.is_sparse,
            )
        by_layer[number] = section
    return tuple(
        replace(layer, section=by_layer.get(number)) for number, layer in enumerate(layers)
    )


# ---- Solids and closed mesh pieces without a layer cut: thinner than a layer, or between two cuts.
# They count as deposited where beads of other solids cover them, such as a thin sheet below a thick
# one.

PIECE_PLACES = 4000  # number of sample points in the bounding box of a piece
MIN_SAMPLES, MAX_SAMPLES = 3, 60  # limits of the sample points along one axis
LEAST_SHARE = (
    0.05  # fraction of a piece; a smaller uncovered fraction is due to sampling at the borders
)
STEPS = 4  # number of sample points per bead width along a bead
MAX_NAMED = 8  # maximum number of pieces named in a message
MM3 = 1000.0  # mm3 per cm3


class Uncut(NamedTuple):
    """A solid or closed piece without a layer cut.

    volume: mm3. bare: volume without bead, mm3. point: (3,) point in the piece, in part coordinates. height: height
    across the layers, mm.
    """

    name: str
    volume: float
    bare: float
    point: Array
    height: float


def uncut(
    solids: SolidsOnHub, strategy: FilledParameters, ranked: Sequence[RankedBead], width: float
) -> list[Uncut]:
    """Return the pieces of solids without a layer cut that other beads do not cover.

    Curved layers are not checked, because they reach everything connected with their start.

    Parameters
    ----------
    solids : SolidsOnHub
        The solids.
    strategy : FilledParameters
        Layer height and cut.
    ranked : sequence of RankedBead
        The beads.
    width : float
        Width of beads without a predicted width, mm.

    Returns
    -------
    list of Uncut
        Pieces of which more than LEAST_SHARE is uncovered.
    """
    if strategy.has_curved_layers:
        return []
    missed = []
    for number, group in enumerate(solids.groups):
        for solid in (solid for body in group.bodies for solid in _pieces(body)):
            levels = _levels(group, solid.vertices[np.unique(solid.triangles)])
            if _is_cut(float(levels.min()), float(levels.max()), strategy):
                continue
            group_beads = [bead for bead in ranked if bead.group == number]
            missed_piece = _missed(group, solid, strategy, group_beads, width)
            if missed_piece.bare > LEAST_SHARE * missed_piece.volume:
                missed.append(missed_piece)
    return missed


def uncut_issues(missed: Sequence[Uncut], strategy: FilledParameters) -> list[Issue]:
    """Return one warning that names the missed pieces, largest first."""
    if not missed:
        return []
    named = [
        Text(
            "{} at {} ({:.3g} mm high, {:.4g} of its {:.4g} cm3)",
            uncut.name,
            place(uncut.point),
            uncut.height,
            uncut.bare / MM3,
            uncut.volume / MM3,
        )
        for uncut in sorted(missed, key=lambda uncut: -uncut.bare)[:MAX_NAMED]
    ]
    return [
        Issue(
            WARNING,
            "NOT_DEPOSITED",
            Text(
                "{} solid(s) fit between the cuts of two layers, {:g} mm apart, and get no bead, "
                "{:.4g} cm3 in total: {}{}; set strategy.layer_height to at most their height, "
                "or fuse these solids with adjacent ones",
                len(missed),
                strategy.layer_height,
                sum(uncut.bare for uncut in missed) / MM3,
                Text.joined(", ", named),
                "" if len(missed) <= MAX_NAMED else ", ...",
            ),
        )
    ]


def _pieces(body: Body) -> Iterator[Body]:
    """Yield the closed pieces of a body, without the walls of internal hollows."""
    triangles = np.asarray(body.triangles, dtype=np.intp)
    label = connected_pieces(triangles)
    volume = SolidMesh(body.vertices, triangles).volume
    for number in range(int(label.max(initial=-1)) + 1):
        piece_triangles = triangles[label == number]
        if SolidMesh(body.vertices, piece_triangles).volume * volume > 0.0:
            yield Body(body.name, body.vertices, piece_triangles)


def _levels(group: Group, points: Array) -> Array:
    """Return the heights (n,) of points (n, 3) above the base of a group's layers, mm."""
    surface, inside = group.base.surface, group.base.inside(points)
    if isinstance(surface, Plane):
        height: Array = inside[:, 2]
        return height
    assert isinstance(surface, (Guide, Developable))
    return surface.distance(inside)


def _is_cut(low: float, high: float, strategy: FilledParameters) -> bool:
    """Whether a layer is cut between two levels, mm; as in `plane_field`, a cut in a face is moved aside."""
    aside = CLEARANCE_SHARE * strategy.chord_error
    share = strategy.share_of_cut
    if share == 1.0:  # at the top
        low, high = low + 2.0 * aside, high + 2.0 * aside
    first_layer = max(0, int(np.ceil((low - aside) / strategy.layer_height - share - EXACT)))
    return (first_layer + share) * strategy.layer_height < high - aside


def _missed(
    group: Group,
    body: Body,
    strategy: FilledParameters,
    ranked: Sequence[RankedBead],
    width: float,
) -> Uncut:
    """Estimate the volume of a piece that no bead covers."""
    corners = body.vertices[np.unique(body.triangles)]
    points = _places_in(body, corners)
    levels = _levels(group, points)
    layer = np.floor(levels / strategy.layer_height + EXACT)
    covered = np.zeros(len(points), dtype=bool)
    reach = 0.5 * width / strategy.fill_density
    for number in np.unique(layer):
        beads = [bead.bead for bead in ranked if bead.layer == number]
        if beads:
            rows = np.flatnonzero(layer == number)
            rise = levels[rows] - number * strategy.layer_height
            distance = cKDTree(_sample_beads(beads, width / STEPS)).query(points[rows])[0]
            covered[rows] = distance**2 - rise**2 <= reach**2 + (0.5 * width / STEPS) ** 2
    volume = abs(SolidMesh(body.vertices, np.asarray(body.triangles, dtype=np.intp)).volume)
    bare = points[~covered] if (~covered).any() else points
    middle = bare[int(((bare - bare.mean(axis=0)) ** 2).sum(axis=1).argmin())]
    high = float(np.ptp(_levels(group, corners)))
    return Uncut(body.name, volume, volume * float((~covered).mean()), middle, high)


def _places_in(body: Body, corners: Array) -> Array:
    """Return points (n, 3) in a piece from an even grid in the bounding box of its corners (k, 3).

    If no grid point is inside, return the centroids of the triangles.
    """
    low, size = corners.min(axis=0), np.maximum(np.ptp(corners, axis=0), 1e-9)
    step = float((np.prod(size) / PIECE_PLACES) ** (1.0 / 3.0))
    count = np.clip(np.rint(size / step), MIN_SAMPLES, MAX_SAMPLES).astype(np.intp)
    axes = [low[k] + size[k] * (np.arange(count[k]) + 0.5) / count[k] for k in range(3)]
    grid = np.stack([axis.ravel() for axis in np.meshgrid(*axes, indexing="ij")], axis=1)
    inside = inside_of(body)
    inside_points = grid[inside.holds(grid)] if inside is not None else grid[:0]
    middles: Array = body.corners().mean(axis=1)
    return inside_points if len(inside_points) else middles


def _sample_beads(beads: Sequence[Bead], step: float) -> Array:
    """Return points (n, 3) along beads, at most `step` mm apart."""
    points = []
    for bead in beads:
        lengths = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        points.append(divide_edges(bead.points, step_counts(lengths, step))[0])
    return np.concatenate(points)
