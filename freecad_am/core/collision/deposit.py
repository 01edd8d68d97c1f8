# SPDX-License-Identifier: LGPL-2.1-or-later
"""The deposit as a solid: bead pieces with width and height that exist from their print moment on.

A bead extends from its points along the build direction. Its section is a stadium of the bead's
width and height; the radius is half the smaller dimension. The solid between two points is the hull
of both sections. At corners the outer side is filled.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..geometry.columns import columns, lengths, unit_rows
from ..types import Array, Index, Mask
from .frustum import Frustum
from .obstacles import Obstacles

# rad; maximum direction change within a joined piece, which keeps it as close as the bead's chords
BENT = 0.2
CORNER = np.cos(
    np.radians(10.0)
)  # cosine of the direction change between segments above which a corner is filled
PART = 25_000  # points per part of a deposit that is rebuilt on each query (`InParts`)


def build_deposit(
    points: Array,
    build: Array,
    width: Array | float,
    height: Array | float,
    starts: Mask | Index,
    moments: Index | None = None,
    grain: float = 0.0,
    foot: float = 0.0,
    short: bool = False,
    like: Obstacles | None = None,
) -> Obstacles:
    """Build the deposit of points in print order.

    A piece exists from the moment of its end point on. If all widths or all heights are zero, the
    pieces are lines.

    Parameters
    ----------
    points : (n, 3) array
        Points in part coordinates, mm.
    build : (n, 3) array
        Build directions, unit vectors.
    width, height : float or (n,) array
        Size of the beads, mm.
    starts : int or bool array
        First points of beads, as indices or a mask (n,).
    moments : (n,) int array or None, optional
        Moments at which the points are printed, rising; None for the point indices.
    grain : float, optional
        Maximum length of joined pieces, mm; 0 joins no pieces.
    foot : float, optional
        Pieces of the current layer count as adjacent to the tip within their width or this
        distance, mm, whichever is larger.
    short : bool, optional
        Whether pieces are short compared with the queried solids.
    like : Obstacles or None, optional
        Deposit of the same points with other build directions, whose tree is reused with new
        corners.

    Returns
    -------
    Obstacles
        The pieces as obstacles.
    """
    n = len(points)
    is_first = np.zeros(n, dtype=bool)
    is_first[starts] = True
    is_first[:1] = True
    kept_rows = _join_points(points, is_first, grain) if grain > 0.0 and n else np.arange(n)
    moment = np.arange(n) if moments is None else moments
    wide, tall = (
        np.broadcast_to(np.asarray(size_of, dtype=float), n)[kept_rows]
        for size_of in (width, height)
    )
    points = points[kept_rows]
    build = build[kept_rows]
    moment = moment[kept_rows]
    is_first = is_first[kept_rows]
    end = np.flatnonzero(~is_first)
    along = points[end] - points[end - 1]
    size = lengths(along)
    end, along, size = end[size > 0.0], along[size > 0.0], size[size > 0.0]
    begin = end - 1
    line = np.stack([points[begin], points[end]], axis=1)
    since = moment[end]
    if not (wide.any() and tall.any()):
        return Obstacles(line, since)
    along /= size[:, None]
    wide, tall = 0.5 * (wide[begin] + wide[end]), 0.5 * (tall[begin] + tall[end])
    round_ = 0.5 * np.minimum(wide, tall)
    sideways = [unit_rows(np.cross(build[point_end], along)) for point_end in (begin, end)]
    corners = []
    for point_rows, side in zip((begin, end), sideways):
        middle = points[point_rows] + (0.5 * tall)[:, None] * build[point_rows]
        # straight part of the section: across a bead wider than high, otherwise upright
        flat = (
            (0.5 * (wide - tall))[:, None] * side
            if (wide >= tall).all()
            else np.where(
                (wide >= tall)[:, None],
                (0.5 * (wide - tall))[:, None] * side,
                (0.5 * (tall - wide))[:, None] * build[point_rows],
            )
        )
        corners += [middle - flat, middle + flat]
    hull = np.stack(corners, axis=1)
    turned = np.flatnonzero(
        (end[:-1] == begin[1:]) & (np.einsum("ij,ij->i", along[:-1], along[1:]) < CORNER)
    )
    wedge = np.concatenate([hull[turned][:, 2:], hull[turned + 1][:, :2]], axis=1)
    hulls = np.concatenate([hull, wedge])
    if like is not None:
        return like.replace_corners(hulls)
    return Obstacles(
        hulls,
        np.concatenate([since, since[turned + 1]]),
        np.concatenate([round_, np.maximum(round_[turned], round_[turned + 1])]),
        np.concatenate([line, line[turned + 1]]),
        np.maximum(np.concatenate([wide, wide[turned]]), foot),
        short,
    )


def _join_points(points: Array, is_first: Mask, grain: float) -> Index:
    """Return the indices of points (n, 3) that remain after joining pieces up to `grain` mm.

    is_first: (n,) mask of the first points of beads.
    """
    is_last = np.append(is_first[1:], True)
    directions = np.diff(points, axis=0, prepend=points[:1])
    size = lengths(directions)
    step = np.where(is_first, 0.0, size)
    directions /= np.maximum(size, 1e-12)[:, None]
    # direction change at a point, as the difference of unit vectors
    turn = np.where(
        is_first | is_last, 0.0, lengths(np.diff(directions, axis=0, append=directions[-1:]))
    )
    return np.flatnonzero(
        is_first
        | is_last
        | (np.diff(np.floor(np.cumsum(step) / grain), prepend=0.0) > 0.0)
        | (np.diff(np.floor(np.cumsum(turn) / BENT), prepend=0.0) > 0.0)
    )


def in_parts(
    points: Array, build: Array, width: Array, height: Array, starts: Index, **what: Any
) -> InParts:
    """Return the deposit for few queries, rebuilt part by part on each query.

    Parameters
    ----------
    points : (n, 3) array
        Points in part coordinates, mm.
    build : (n, 3) array
        Build directions, unit vectors.
    width, height : (n,) array
        Size of the beads, mm.
    starts : int array
        First points of beads.
    **what : Any
        Further arguments of `build_deposit`.

    Returns
    -------
    InParts
        The deposit.
    """
    return InParts(points, build, width, height, starts, what)


@dataclass(frozen=True, eq=False)
class InParts:
    """The deposit of `build_deposit`, rebuilt part by part on each query.

    This suits few queries of a long deposit, whose pieces take more memory than its points. what:
    further arguments of `build_deposit`.
    """

    points: Array
    build: Array
    width: Array
    height: Array
    starts: Index
    what: dict[str, Any]

    def find_touching(
        self,
        solid: Frustum,
        tip: Array,
        axis: Array,
        moment: Index | None = None,
        layer_start: Index | None = None,
    ) -> Mask:
        """Return whether solids meet the deposit, as `Obstacles.find_touching` does.

        Parameters
        ----------
        solid : Frustum
            The k solids.
        tip : (k, 3) array
            Tips in part coordinates, mm.
        axis : (k, 3) array
            Axes, unit vectors.
        moment : (k,) int array or None, optional
            Moment of each solid; only earlier deposit counts. None for all deposit.
        layer_start : (k,) int array or None, optional
            Moment at which the current layer of each solid began.

        Returns
        -------
        (k,) bool array
            True on contact.
        """
        hits, count = np.zeros(len(tip), dtype=bool), len(self.points)
        begins = np.zeros(count, dtype=bool)
        begins[self.starts] = True
        for begin in range(0, count, PART):
            rows = np.flatnonzero(~hits if moment is None else ~hits & (moment > begin))
            # include two earlier points: the corner at the start of the part needs both its pieces
            rows_of_part = slice(max(begin - 2, 0), min(begin + PART, count))
            rows = rows[self._near(rows_of_part, solid.rows(rows), tip[rows], axis[rows])]
            if not len(rows):
                continue
            deposited = build_deposit(
                self.points[rows_of_part],
                self.build[rows_of_part],
                self.width[rows_of_part],
                self.height[rows_of_part],
                begins[rows_of_part],
                np.arange(rows_of_part.start, rows_of_part.stop),
                short=True,
                **self.what,
            )
            hits[rows] = deposited.find_touching(
                solid.rows(rows),
                tip[rows],
                axis[rows],
                None if moment is None else moment[rows],
                None if layer_start is None else layer_start[rows],
            )
        return hits

    def _near(self, rows_of_part: slice, solid: Frustum, tip: Array, axis: Array) -> Mask:
        """Return False for solids (k,) that certainly miss all pieces of a part.

        A piece extends at most its width plus its height from its points.
        """
        low, high = self.points[rows_of_part].min(axis=0), self.points[rows_of_part].max(axis=0)
        size = float(self.width[rows_of_part].max() + self.height[rows_of_part].max())
        half, centre = 0.5 * (high - low)[:, None], 0.5 * (low + high)
        return solid.near_box(columns(centre - tip), columns(axis), half, np.full(len(tip), size))
