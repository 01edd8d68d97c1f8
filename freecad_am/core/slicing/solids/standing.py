# SPDX-License-Identifier: LGPL-2.1-or-later
"""Assign each solid to the cylinder or cone with the longest contact contour."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...geometry.formatting import place
from ...geometry.mesh.coarsen import doubled_areas
from ...geometry.mesh.solid import Search, SolidMesh, divide_triangles
from ...geometry.obstacles import Body
from ...geometry.on_hub import Base, Group, Seat, SolidsOnHub, downwards, middle_azimuth
from ...issues import InputError, Issue, Text, Word
from ...types import Array, Mask
from .equidistant import Facets, cut

STEP = 2.0  # mm; distance between test points on the surface of a solid
DEEP = 5.0  # in chord errors; tolerated overlap, because meshes of touching solids overlap


def refuse_overlaps(groups: Sequence[Group], chord_error: float) -> None:
    """Raise InputError OVERLAP if solids overlap outside their base surfaces.

    chord_error: distance between triangles and solids, mm. Overlaps smaller than STEP can be
    missed.
    """
    standing = [(group.base, body) for group in groups for body in group.bodies]
    boxes = [(body.vertices.min(axis=0), body.vertices.max(axis=0)) for _, body in standing]
    deep = DEEP * chord_error
    for k, (base, body) in enumerate(standing):
        for j in range(k + 1, len(standing)):
            box = np.maximum(boxes[k][0], boxes[j][0]), np.minimum(boxes[k][1], boxes[j][1])
            if (box[1] - box[0] <= deep).any():
                continue
            other_base, second_body = standing[j]
            for probed, against in ((body, second_body), (second_body, body)):
                overlap = _deepest_overlap(probed, against, box, (base, other_base), deep)
                if overlap is not None:
                    raise InputError(
                        "OVERLAP",
                        body.name,
                        "the solid and {} overlap, as at {}, and the overlap would be deposited "
                        "twice; fuse the two solids, or move one of them",
                        second_body.name,
                        place(overlap),
                    )


def _deepest_overlap(
    probed: Body, against: Body, box: tuple[Array, Array], bases: Sequence[Base], deep: float
) -> Array | None:
    """Return the deepest point (3,) in `against` on or slightly below the surface of `probed`.

    Returns None if no point is deeper than `deep` mm.
    """
    corners = probed.corners()
    # include faces in a side of the box, because points below them may be inside the other solid
    corners = corners[
        ((corners.min(axis=1) <= box[1]) & (corners.max(axis=1) >= box[0])).all(axis=1)
    ]
    points, triangle = divide_triangles(corners, STEP)
    normal = doubled_areas(corners)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    # test also points below the surface, because coincident surfaces are ambiguous
    points = np.vstack([corners.reshape(-1, 3), points, points - 2.0 * deep * normal[triangle]])
    points = points[((points > box[0]) & (points < box[1])).all(axis=1)]
    for base in bases:
        points = points[base.surface.distance(base.inside(points)) > deep]
    if not len(points):
        return None
    distance = _searched(against).signed(points)[0]
    points, distance = points[distance < -deep], distance[distance < -deep]
    on_surface = (
        _searched(probed).signed(points)[0] < 0.5 * deep if len(points) else np.zeros(0, dtype=bool)
    )
    return points[on_surface][np.argmin(distance[on_surface])] if on_surface.any() else None


def _searched(body: Body) -> Search:
    return SolidMesh(body.vertices, body.triangles.astype(np.intp)).searched(STEP)


UNITS = ((25.4, "inches"), (10.0, "cm"), (1000.0, "m"))  # unit in mm, and name
PAST_END_MM = 0.05  # mm; distance beyond the ends of a face within which a solid still stands on it


def group_by_base(
    bodies: Sequence[Body],
    seats: Sequence[Seat],
    chord_error: float,
    label: str,
    issues: tuple[Issue, ...] = (),
    hub: str = "",
    unitless: Sequence[Body] = (),
) -> SolidsOnHub:
    """Group bodies by base; a body belongs to the base with the longest contact contour.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    seats : sequence of Seat
        The bases.
    chord_error : float
        Chord error, mm.
    label : str
        Name of the part, for errors.
    issues : tuple of Issue, optional
        Issues to attach.
    hub : str, optional
        Name of the object with the bases, for errors, if different from `label`.
    unitless : sequence of Body, optional
        Bodies from files without units.

    Returns
    -------
    SolidsOnHub
        The groups, ordered by height along the axis of the first base.

    Raises
    ------
    InputError
        NOT_ON_HUB for a solid that is on no base, NO_BASE without bases, OVERLAP.
    """
    if not seats:
        raise InputError(
            "NO_BASE",
            hub or label,
            "the hub has no outer cylinder or cone; choose a face, or set strategy.base",
        )
    standing: dict[int, list[Body]] = {}
    for body in bodies:
        standing.setdefault(
            _seat_of(
                body, seats, chord_error, any(body is unitless_body for unitless_body in unitless)
            ),
            [],
        ).append(body)
    axis = seats[min(standing)].base.frame[:3, 2]
    axis = -axis if downwards(axis) else axis
    groups = [
        Group(
            seats[k].base,
            tuple(
                sorted(group_bodies, key=lambda body: middle_azimuth(seats[k].base, body.vertices))
            ),
        )
        for k, group_bodies in standing.items()
    ]
    groups.sort(key=lambda group: min(float((body.vertices @ axis).min()) for body in group.bodies))
    refuse_overlaps(groups, chord_error)
    return SolidsOnHub(label, tuple(groups), chord_error, (), issues)


def _seat_of(body: Body, seats: Sequence[Seat], chord_error: float, unitless: bool = False) -> int:
    contact, adjacent = np.zeros(len(seats)), np.zeros(len(seats))
    ranges = np.zeros((len(seats), 2))
    for k, seat in enumerate(seats):
        # seats are on cylinders and cones
        vertices = seat.base.inside(body.vertices)
        facets = Facets(
            seat.base.surface,  # type: ignore[arg-type]
            vertices,
            body.triangles,
            body.name,
        )
        ranges[k] = facets.distances.min(), facets.distances.max()
        for loop in cut(facets, 0.0, chord_error):
            step = np.linalg.norm(np.roll(loop.points, -1, axis=0) - loop.points, axis=1)
            middle = 0.5 * (loop.points + np.roll(loop.points, -1, axis=0))
            contact[k] += step[_near(seat, middle)].sum()
            adjacent[k] += step[_near(seat, middle, all_round=True)].sum() if seat.chosen else 0.0
    contact = contact if contact.any() else adjacent
    best = int(np.argmax(contact))
    if contact[best] > 0.0:
        return best
    nearest = int(np.argmin(np.where(ranges[:, 1] > 0.0, np.maximum(ranges[:, 0], 0.0), np.inf)))
    where = place(
        body.vertices[
            np.argmin(
                seats[nearest].base.surface.distance(seats[nearest].base.inside(body.vertices))
            )
        ]
    )
    if (ranges[:, 1] <= 0.0).all():
        text = "the solid is inside the hub"
    elif ranges[nearest, 0] > 0.0:
        text = Text(
            "the solid starts {:.4g} mm outside {}, at {}",
            ranges[nearest, 0],
            seats[nearest].base.name,
            where,
        )
    else:
        text = Text("the solid passes {} off the face, near {}", seats[nearest].base.name, where)
    hint = _unit_hint(body, seats) if unitless else ""
    raise InputError(
        "NOT_ON_HUB",
        body.name,
        "not on the hub: {}; move the solid, or choose its base{}",
        Word(text),
        hint,
    )


def _unit_hint(body: Body, seats: Sequence[Seat]) -> str:
    """Return a hint if the body would intersect a base with its coordinates in another unit."""
    for factor, unit in UNITS:
        for seat in seats:
            vertices = seat.base.inside(factor * body.vertices)
            heights = seat.base.surface.distance(vertices)
            z = vertices[:, 2]
            adjacent = any(face.low <= z.max() and face.high >= z.min() for face in seat.faces)
            if heights.min() <= PAST_END_MM < heights.max() and adjacent:
                return Text(
                    ". Multiplied by {:g} the solid would reach {}: is its file in {}? If so, "
                    "export the file in mm, or set scale: {:g} mm, as part.scale (in the window: "
                    "Meshes, Scale)",
                    factor,
                    seat.base.name,
                    unit,
                    factor,
                )
    return ""


def _near(seat: Seat, points: Array, all_round: bool = False) -> Mask:
    return np.asarray(
        np.any([face.near(points, PAST_END_MM, all_round) for face in seat.faces], axis=0),
        dtype=np.bool_,
    )


def hub_among(
    bodies: Sequence[Body], seats: Sequence[Sequence[Seat]], chord_error: float, label: str
) -> int:
    """Find the solid that is the hub of a part: the solid that carries most other solids.

    Parameters
    ----------
    bodies : sequence of Body
        The solids.
    seats : sequence of sequence of Seat
        The bases of each solid.
    chord_error : float
        Chord error, mm.
    label : str
        Name of the part, for errors.

    Returns
    -------
    int
        Index of the hub.

    Raises
    ------
    InputError
        NO_HUB if no solid is on a cylinder or cone of another.
    """
    votes = np.zeros(len(bodies), dtype=int)
    for k in range(len(bodies)):
        for j, body in enumerate(bodies):
            if j == k or not seats[k]:
                continue
            try:
                _seat_of(body, seats[k], chord_error)
            except InputError:
                continue
            votes[k] += 1
    if not votes.any():
        raise InputError(
            "NO_HUB",
            label,
            "none of the solids is on a cylinder or cone of another solid; name the hub as "
            "substrate, choose a face, or set strategy.base; for a flat base use kind: solid",
        )
    return int(np.argmax(votes))
