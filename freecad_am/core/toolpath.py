# SPDX-License-Identifier: LGPL-2.1-or-later
"""Beads, layers and the toolpath: deposit geometry, print order and directions.

Frames and units: points in mm and unit vectors in the part's own frame (the coordinates of the part
file); angles in rad; speeds in mm/s.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from .families.family import Family
from .families.registry import DEFAULT_KIND, KINDS
from .geometry.columns import lengths
from .geometry.curves.outline import Outline, at_points, estimate_outline, outline
from .geometry.frames import unit
from .geometry.obstacles import Body
from .geometry.section import Coverage, Section
from .geometry.toolpath_records import Fitted, PredictedShape
from .issues import Issue
from .types import Array, Index

PREDICTED = ("width", "height")  # columns of a bead that a bead model predicts


def _frozen(values: Any, shape: tuple[int | None, ...], name: str) -> Array:
    array = np.array(values, dtype=np.float64)
    if array.ndim != len(shape) or any(
        want is not None and have != want for have, want in zip(array.shape, shape)
    ):
        raise ValueError(f"{name} has the shape {array.shape}, expected {shape}")
    if not np.isfinite(array).all():
        raise ValueError(f"{name} holds a value that is not finite")
    array.setflags(write=False)
    return array


@dataclass(frozen=True)
class BeadRole:
    """Role of a bead in its layer.

    kind: role in the filling: 'contour', 'line', 'zigzag', 'spiral', 'centre' (centreline of
    contours or thin regions), 'closing' (fills a gap between beads); '' for strategies without
    fillings. ring: number of contours outside of the bead. closing: whether the bead fills a gap
    and is less than a layer height from adjacent beads. returns: whether the bead is the first of a
    layer on a solid that already has a layer. bead_class: one of `bead_classes.CLASSES`, or ''.
    """

    kind: str = ""
    ring: int = 0
    closing: bool = False
    returns: bool = False
    bead_class: str = ""


@dataclass(frozen=True)
class BeadEnds:
    """Separate speeds at the start and the end of a bead.

    Lengths and ramps in mm, speeds in mm/s. Speed 0 means the bead speed.
    """

    start_length: float
    start_speed: float
    end_length: float
    end_speed: float
    start_ramp: float = 0.0
    end_ramp: float = 0.0

    @property
    def has_ramps(self) -> bool:
        """Whether the speed ramps at either end."""
        return self.start_ramp > 0.0 or self.end_ramp > 0.0

    @property
    def length(self) -> float:
        """Total length of both ends and their ramps, mm."""
        return self.start_length + self.end_length + (self.start_ramp + self.end_ramp)


SCARF_END_MM = 0.02  # mm; a scarf may end at a point this far before its end
LEAST_SECTION = 0.25  # section at both ends of a scarf seam, as a fraction of the bead's section


@dataclass(frozen=True)
class Scarf:
    """A scarf seam: the section of a closed bead rises along its start and falls along its end.

    length: mm of either ramp. height: mm, layer height for beads without a height. The second ramp
    begins LEAST_SECTION of the length before the seam. Both ramps together deposit as much as the
    bead without a scarf.
    """

    length: float
    height: float

    @property
    def overlap(self) -> float:
        """Length by which the bead continues past its seam, mm."""
        return (1.0 - LEAST_SECTION) * self.length

    def positions(self, total: float, steps: int) -> Array:
        """Return the positions of the ramp steps along a closed bead, mm.

        Parameters
        ----------
        total : float
            Length of the bead, mm.
        steps : int
            Number of steps of a ramp.

        Returns
        -------
        (k,) array
            Ascending positions, without the seam.
        """
        share = np.arange(1, steps + 1) / steps
        before_seam = share[share <= LEAST_SECTION]
        falling = total - self.length * before_seam[::-1]
        return np.asarray(np.r_[self.length * share, falling])

    def sections(self, position: Array, total: float) -> Array:
        """Return the sections at positions along a bead, as fractions of its full section.

        Parameters
        ----------
        position : (n,) array
            Positions from the seam, mm; beyond `total` in the overlap.
        total : float
            Length of the bead without overlap, mm.

        Returns
        -------
        (n,) array
            Fractions.
        """
        rate = (1.0 - LEAST_SECTION) / self.length
        into = np.minimum(position, self.length)
        past = np.maximum(position - total + LEAST_SECTION * self.length, 0.0)
        return np.asarray(LEAST_SECTION + rate * into - rate * past)

    def _filled(self, position: Array, total: float) -> Array:
        """Return the integrals (n,) of the sections from the seam, mm; arguments as in `sections`."""
        rate = (1.0 - LEAST_SECTION) / self.length
        missing = np.minimum(position, self.length)
        past = np.maximum(position - total + LEAST_SECTION * self.length, 0.0)
        start = (1.0 - LEAST_SECTION) * missing - 0.5 * rate * missing**2
        return np.asarray(position - start - 0.5 * rate * past**2)

    def taper(self, bead: Bead, count: int) -> Bead:
        """Return a bead with its overlap, at the sections of the scarf.

        The overlap rises with the start below it. Speeds give the sections at a constant wire feed.

        Parameters
        ----------
        bead : Bead
            The bead of n points, continued past its seam.
        count : int
            Number of points without the overlap.

        Returns
        -------
        Bead
            The bead; its points up to the seam are unchanged.
        """
        step = lengths(np.diff(bead.points, axis=0))
        position = np.r_[0.0, np.cumsum(step)]
        total = float(position[count - 1])
        height = np.full(len(bead), self.height) if bead.height is None else bead.height
        past = np.maximum(position - total, 0.0) / self.length
        points = bead.points + (height * past)[:, None] * bead.build
        time = np.diff(self._filled(position, total)) / bead.speed[1:]
        ramped = time < (1.0 - 1e-9) * step / bead.speed[1:]
        surplus = time.sum() - (step / bead.speed[1:])[: count - 1].sum()
        # beads of varying speed need a small correction to deposit the same volume
        time[ramped] *= 1.0 - surplus / time[ramped].sum()
        speed = lengths(np.diff(points, axis=0)) / time
        tangents = bead.tangents
        if tangents is not None:
            rise = (height / self.length)[:, None] * bead.build
            tangents = tangents.copy()
            tangents[count - 1 :, 1] += rise[count - 1 :]
            tangents[count:, 0] += rise[count:]
            tangents /= np.linalg.norm(tangents, axis=2, keepdims=True)
        return dataclasses.replace(
            bead,
            points=points,
            speed=np.r_[speed[:1], speed],
            height=height * self.sections(position, total),
            tangents=tangents,
        )


@dataclass(frozen=True, eq=False)
class Bead:
    """One uninterrupted deposit of n points, n >= 2.

    A closed bead repeats its first point as its last point.

    points: (n, 3) mm. build, tool: (n, 3) unit vectors, the build direction and the tool axis (from
    the deposit towards the tool). parameter: (n,) strictly monotonic variable of the layer's
    polynomial, which is the unwrapped angle about the axis on parts of revolution, else the arc
    length normalised to 2 pi. speed: (n,) mm/s on the segment that ends at the point. width, height: (n,)
    mm, predicted; None without a bead model. wire_share: mm of wire per mm of bead if the wire feed
    follows the travel speed, else None. tangents: (n, 2, 3) unit tangents on arrival at and
    departure from each point, equal except at corners; None if the strategy does not provide them.
    ends: separate speeds at the ends, or None. scarf: shape of the seam of a closed bead, which
    `run_on` applies; on an open bead, the applied shape; or None. external: (n, k) external axis values, rad; None
    until planned. phase: (n,) segment phases, see `motion.PHASES`; None until planned. settings:
    (n,) settings by place on the segment that ends at the point, as the sum of 2^entry of
    `process.settings`; None without settings.
    """

    points: Array
    build: Array
    tool: Array
    parameter: Array
    speed: Array
    closed: bool
    width: Array | None = None
    tangents: Array | None = None
    height: Array | None = None
    wire_share: float | None = None
    role: BeadRole = BeadRole()
    ends: BeadEnds | None = None
    external: Array | None = None
    phase: Array | None = None
    scarf: Scarf | None = None
    settings: Array | None = None

    def __post_init__(self) -> None:
        n = len(self.points)
        if n < 2:
            raise ValueError("a bead has at least two points")
        for name in ("points", "build", "tool"):
            object.__setattr__(self, name, _frozen(getattr(self, name), (n, 3), name))
        for name in ("parameter", "speed", *PREDICTED, "phase", "settings"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, _frozen(getattr(self, name), (n,), name))
        if self.tangents is not None:
            object.__setattr__(self, "tangents", _frozen(self.tangents, (n, 2, 3), "tangents"))
        if self.external is not None:
            object.__setattr__(
                self, "external", _frozen(self.external, (n, self.external.shape[1]), "external")
            )
        for name in ("build", "tool", *(("tangents",) if self.tangents is not None else ())):
            if np.abs(np.linalg.norm(getattr(self, name), axis=-1) - 1.0).max() > 1e-9:
                raise ValueError(f"{name} holds a vector that is not of unit length")
        steps = np.diff(self.parameter)
        if not ((steps > 0).all() or (steps < 0).all()):
            raise ValueError("the parameter of a bead must rise or fall from point to point")
        if self.closed and np.abs(self.points[0] - self.points[-1]).max() > 1e-6:
            raise ValueError("a closed bead must end where it starts")

    def __len__(self) -> int:
        return len(self.points)

    @property
    def length(self) -> float:
        """Length of the polyline, mm."""
        return float(lengths(np.diff(self.points, axis=0)).sum())

    def _predicted(self, change: Callable[[Array], Array]) -> dict[str, Any]:
        """Return the predicted width and height, each passed through `change`."""
        held = {name: getattr(self, name) for name in PREDICTED}
        return {name: None if column is None else change(column) for name, column in held.items()}

    @cached_property
    def outline(self) -> Outline:
        """Smooth curve through the points.

        Without tangents it is estimated from circles through adjacent points. Corners stay sharp.
        """
        if self.tangents is not None:
            return outline(self.points, self.tangents)
        return estimate_outline(self.points, self.closed)

    def reversed(self) -> Bead:
        """Return the bead in the opposite direction."""
        return dataclasses.replace(
            self,
            points=self.points[::-1],
            build=self.build[::-1],
            tool=self.tool[::-1],
            parameter=self.parameter[::-1],
            speed=self.speed[::-1],
            tangents=None if self.tangents is None else -self.tangents[::-1, ::-1],
            external=None if self.external is None else self.external[::-1],
            settings=None if self.settings is None else np.roll(self.settings[::-1], 1),
            **self._predicted(lambda column: column[::-1]),
        )

    def started_at(self, index: int) -> Bead:
        """Return the closed bead with its seam at point `index`.

        The parameter continues across the old seam.
        """
        if not self.closed:
            raise ValueError("only a closed bead can be started elsewhere")
        n = len(self) - 1
        index %= n
        if index == 0:
            return self
        turn = self.parameter[-1] - self.parameter[0]
        order = np.r_[index:n, 0 : index + 1]
        segment = np.where(order == 0, n, order)
        parameter = self.parameter[order] + np.where(np.arange(n + 1) >= n - index, turn, 0.0)
        return dataclasses.replace(
            self,
            points=self.points[order],
            build=self.build[order],
            tool=self.tool[order],
            parameter=parameter,
            speed=self.speed[segment],
            settings=None if self.settings is None else self.settings[segment],
            tangents=None if self.tangents is None else self.tangents[order],
            external=self._external_from(index),
            **self._predicted(lambda column: column[order]),
        )

    def _external_from(self, index: int) -> Array | None:
        """Return the external axis values of the closed bead with its seam at point `index`.

        The values continue across the old seam.
        """
        if self.external is None:
            return None
        moved = self.external[-1] - self.external[0]
        return np.asarray(
            np.concatenate([self.external[index:-1], self.external[: index + 1] + moved])
        )

    def halved(self, segments: Index) -> Bead:
        """Return the bead with a point added at the midpoint of segments.

        Parameters
        ----------
        segments : (k,) array of int
            Indices of the segments, ascending.

        Returns
        -------
        Bead
            The bead with k more points.
        """
        return self.divided(segments, np.full(len(segments), 0.5))

    def divided(self, segments: Index, shares: Array, on_chord: bool = False) -> Bead:
        """Return the bead with points added on segments.

        Points are on the bead's smooth curve, or on the chords, so that the bead keeps its length.
        Their directions are interpolated between the adjacent points' directions.

        Parameters
        ----------
        segments : (k,) array of int
            Indices of the segments, ascending.
        shares : (k,) array
            Fractions of the segments, ascending on each segment.
        on_chord : bool, optional
            Whether points are on the chords.

        Returns
        -------
        Bead
            The bead with k more points.
        """
        at = segments + 1
        bead_tangents = self.tangents

        def between(column: Array) -> Array:
            share = shares if column.ndim == 1 else shares[:, None]
            return np.asarray((1.0 - share) * column[segments] + share * column[at])

        def inserted(column: Array) -> Array:
            return np.insert(column, at, between(column), axis=0)

        def inserted_directions(column: Array) -> Array:
            mean = between(column)
            return np.insert(column, at, mean / lengths(mean)[:, None], axis=0)

        points, tangents = self.outline.at(segments, shares)
        if on_chord:
            points = between(self.points)
            if bead_tangents is None:  # a point on a chord would bend an estimated curve
                bead_tangents = at_points(unit(self.outline.leaving), unit(self.outline.arriving))
        return dataclasses.replace(
            self,
            points=np.insert(self.points, at, points, axis=0),
            build=inserted_directions(self.build),
            tool=inserted_directions(self.tool),
            parameter=inserted(self.parameter),
            speed=np.insert(self.speed, at, self.speed[at]),
            settings=None
            if self.settings is None
            else np.insert(self.settings, at, self.settings[at]),
            **self._predicted(inserted),
            tangents=None
            if bead_tangents is None
            else np.insert(bead_tangents, at, tangents[:, None], axis=0),
            external=None if self.external is None else inserted(self.external),
        )

    def run_on(self, overlap: float) -> Bead:
        """Open a closed bead and extend it past the seam, by up to `overlap` mm or by its scarf."""
        overlap = self.overlap_of(overlap)
        if overlap <= 0.0 or not self.closed:
            return self
        along = np.r_[0.0, np.cumsum(lengths(np.diff(self.points, axis=0)))]
        overlap = min(overlap, float(along[-1]))
        slack = 0.0 if self.scarf is None else SCARF_END_MM
        count = max(1, int(np.searchsorted(along, overlap - slack)))
        share = float(min((overlap - along[count - 1]) / (along[count] - along[count - 1]), 1.0))

        def again(column: Array) -> Array:
            end = column[count - 1] + share * (column[count] - column[count - 1])
            return np.concatenate([column[1:count], [end]])

        def directions(column: Array) -> Array:
            repeated = again(column)
            return np.concatenate([column, repeated / lengths(repeated)[:, None]])

        position = again(self.points)
        last, tangent = self.outline.at(np.array([count - 1]), share)
        position[-1] = last[0]
        turn = self.parameter[-1] - self.parameter[0]
        extended = dataclasses.replace(
            self,
            points=np.concatenate([self.points, position]),
            build=directions(self.build),
            tool=directions(self.tool),
            parameter=np.concatenate([self.parameter, again(self.parameter) + turn]),
            speed=np.concatenate([self.speed, self.speed[1 : count + 1]]),
            settings=None
            if self.settings is None
            else np.concatenate([self.settings, self.settings[1 : count + 1]]),
            closed=False,
            tangents=None if self.tangents is None else self._tangents_run_on(count, tangent),
            external=None
            if self.external is None
            else np.concatenate(
                [
                    self.external,
                    again(self.external) + self.external[-1] - self.external[0],
                ]
            ),
            **self._predicted(lambda column: np.concatenate([column, again(column)])),
        )
        return extended if self.scarf is None else self.scarf.taper(extended, len(self))

    def overlap_of(self, overlap: float) -> float:
        """Return the seam overlap of the bead, mm; `overlap` is that of beads without a scarf."""
        return overlap if self.scarf is None else self.scarf.overlap

    def _tangents_run_on(self, count: int, last: Array) -> Array:
        """Return the tangents of the bead extended to its point `count`, ending along `last` (1, 3)."""
        assert self.tangents is not None
        seam = np.stack([self.tangents[-1, 0], self.tangents[0, 1]])[None]
        return np.concatenate(
            [self.tangents[:-1], seam, self.tangents[1:count], np.repeat(last[:, None], 2, axis=1)]
        )

    def part(self, rows: slice) -> Bead:
        """Return two or more consecutive points of the bead as an open bead."""
        role = dataclasses.replace(self.role, returns=self.role.returns and not rows.start)
        return dataclasses.replace(self, **self._rows(rows), closed=False, role=role)

    def thinned(self, index: Index) -> Bead:
        """Return the bead with only the given points.

        Parameters
        ----------
        index : (k,) array of int
            Indices of the points, ascending, including the first and the last point.

        Returns
        -------
        Bead
            The bead with k points.
        """
        return dataclasses.replace(self, **self._rows(index))

    def _rows(self, rows: slice | Index) -> dict[str, Any]:
        """Return the selected rows of each column."""
        columns = [(entry.name, getattr(self, entry.name)) for entry in dataclasses.fields(self)]
        return {name: column[rows] for name, column in columns if isinstance(column, np.ndarray)}


def settings_of(bead: Bead) -> Array:
    """Return the settings by place at the points of a bead, for its rows of a motion.

    Parameters
    ----------
    bead : Bead
        The bead of n points.

    Returns
    -------
    (n,) array
        Sums of 2^entry; the first point has those of the first segment.
    """
    if bead.settings is None:
        return np.zeros(len(bead))
    return np.asarray(np.r_[bead.settings[1], bead.settings[1:]])


@dataclass(frozen=True)
class SpeedLaw:
    """Bead width and height against travel speed v, mm/s.

    width, height: coefficients of v^(-1/3), mm (mm/s)^(1/3), at a constant wire feed. Beads with a
    wire share keep their section instead. slowest: mm/s, lowest measured speed. acceleration:
    mm/s^2, maximum rate of change of speed.
    """

    width: float
    height: float
    slowest: float
    acceleration: float

    def applied(self, bead: Bead, speed: Array) -> Bead:
        """Return the bead at other speeds, with the resulting width and height.

        Parameters
        ----------
        bead : Bead
            The bead, n points.
        speed : (n,) array
            Speeds on the segments that end at the points, mm/s.

        Returns
        -------
        Bead
            The bead. Width and height change only if both are predicted.
        """
        root = np.cbrt(1.0 / speed[1:]) - np.cbrt(1.0 / bead.speed[1:])
        more = 0.5 * (np.r_[root[:1], root] + np.r_[root, root[-1:]])
        if bead.width is None or bead.height is None:
            return dataclasses.replace(bead, speed=speed)
        width = bead.width + self.width * more
        height = (
            bead.height + self.height * more
            if bead.wire_share is None
            else bead.height * bead.width / width
        )
        return dataclasses.replace(bead, speed=speed, width=width, height=height)


@dataclass(frozen=True)
class Layer:
    """The beads of one slice, in print order.

    wait: pause of the machine before the layer, s, for the deposit below to cool. first: whether
    the feature has no layer below, as at the start of another solid. feature: index of the layer's
    feature in a toolpath with several features. section: section of the part in the layer's plane,
    None if unknown. coverage: how well the beads fill the section, None until measured. A layer too
    small for a bead is empty and keeps its index.
    """

    beads: tuple[Bead, ...]
    wait: float = 0.0
    first: bool = False
    feature: int = 0
    section: Section | None = None
    coverage: Coverage | None = None


@dataclass(frozen=True, eq=False)
class Checks:
    """Measurements of a deposit made during planning; None if not checked or unknown.

    unsupported: length of bead without support, mm. on_part: number of checked points on the part,
    their maximum distance from the part and the allowed distance, mm. volumes: volume of a filled
    part, volume missed by the beads and volume of stray beads, mm3. uneven: (k, 3) index, minimum
    and maximum height, mm, of layers of uneven height. twice: over-deposition, mm3, of beads as wide as
    their spacing on other beads of the layer. fitted: fit to a scan. predicted: comparison of the
    predicted deposit with the part.
    """

    unsupported: float | None = None
    on_part: tuple[float, float, float] | None = None
    volumes: tuple[float, float, float] | None = None
    uneven: Array | None = None
    twice: float | None = None
    fitted: Fitted | None = None
    predicted: PredictedShape | None = None


@dataclass(frozen=True)
class MotionRules:
    """Rules for the motion along the beads.

    overlap: seam overlap of closed beads, mm. retreat: mm, at bead ends. max_from_vertical: rad,
    maximum angle of the tool axis from the vertical in a cell with a positioner.
    """

    overlap: float = 0.0
    retreat: float = 0.0
    max_from_vertical: float = math.pi


@dataclass(frozen=True, eq=False)
class SequencedFeature:
    """One of several features in a toolpath.

    values: the feature's toolpath without layers. Each layer stores the index of its feature.
    """

    label: str
    values: Toolpath


@dataclass(frozen=True, eq=False)
class Toolpath:
    """All layers from the platform up.

    frame: (4, 4) pose of the feature frame in part coordinates (interface.md, `mount`). chord_error
    and layer_height: mm. issues: from slicing and strategy (spacing, tilt-back, clearance).
    surroundings: obstacles in part coordinates. law: bead size against travel speed, None without a
    bead model. bead_width: mm, for beads without a predicted width. wire_feed: mm/s, None if
    unknown. features: features printed together, empty if there is only one; the other fields then
    describe the first feature.
    """

    layers: tuple[Layer, ...]
    frame: Array
    layer_height: float
    chord_error: float
    issues: tuple[Issue, ...] = ()
    family: str = field(default=DEFAULT_KIND)
    surroundings: tuple[Body, ...] = ()
    law: SpeedLaw | None = None
    bead_width: float | None = None
    wire_feed: float | None = None
    features: tuple[SequencedFeature, ...] = ()
    rules: MotionRules = MotionRules()
    checks: Checks = field(default_factory=Checks)

    def __post_init__(self) -> None:
        object.__setattr__(self, "frame", _frozen(self.frame, (4, 4), "frame"))

    def __iter__(self) -> Iterator[tuple[int, int, Bead]]:
        """Yield (layer index, bead index, bead) in print order."""
        for i, layer in enumerate(self.layers):
            for j, bead in enumerate(layer.beads):
                yield i, j, bead

    def add_checks(self, **results: Any) -> Toolpath:
        """Return the toolpath with more check results; `results` are fields of `Checks`."""
        return dataclasses.replace(self, checks=dataclasses.replace(self.checks, **results))

    @property
    def deposited(self) -> Toolpath:
        """Return the toolpath without empty layers.

        For checks that compare each layer with its supporting layer.
        """
        if all(layer.beads for layer in self.layers):
            return self
        return dataclasses.replace(
            self, layers=tuple(layer for layer in self.layers if layer.beads)
        )

    @property
    def parts(self) -> tuple[tuple[Toolpath, Index], ...]:
        """Return the toolpath of each feature with its layers.

        Returns
        -------
        tuple of tuple of Toolpath and (n,) array of int
            Toolpaths, and the indices of their layers in this toolpath. With a single feature, this
            toolpath itself.
        """
        if not self.features:
            return ((self, np.arange(len(self.layers))),)
        owner = np.array([layer.feature for layer in self.layers])
        numbers = [np.flatnonzero(owner == k) for k in range(len(self.features))]
        return tuple(
            (dataclasses.replace(feature.values, layers=tuple(self.layers[k] for k in rows)), rows)
            for feature, rows in zip(self.features, numbers, strict=True)
        )

    @property
    def layer_heights(self) -> Array:
        """Return the nominal height of each layer.

        Returns
        -------
        (layers,) array
            Heights, mm.
        """
        heights = [feature.values.layer_height for feature in self.features]
        heights = heights or [self.layer_height]
        return np.array([heights[layer.feature if self.features else 0] for layer in self.layers])

    @property
    def traits(self) -> Family:
        """Return the properties of the toolpath's family."""
        return KINDS[self.family]

    @property
    def bead_count(self) -> int:
        """Number of beads in all layers."""
        return sum(len(layer.beads) for layer in self.layers)

    @property
    def point_count(self) -> int:
        """Number of deposit points in all beads."""
        return sum(len(bead) for _, _, bead in self)

    @property
    def widths(self) -> Array:
        """Return the bead widths at all points in print order.

        Returns
        -------
        (n,) array
            Widths, mm; 0 if unknown, as in old documents. Such beads count as lines.
        """
        usual = [feature.values.bead_width or 0.0 for feature in self.features]
        usual = usual or [self.bead_width or 0.0]
        return np.concatenate(
            [
                np.full(len(bead), usual[self.layers[i].feature if self.features else 0])
                if bead.width is None
                else bead.width
                for i, _, bead in self
            ]
        )

    @property
    def heights(self) -> Array:
        """Return the bead heights at all points in print order.

        Returns
        -------
        (n,) array
            Predicted heights, else layer heights, mm; 0 if the bead width is also unknown.
        """
        usual = self.layer_heights if self.bead_width else np.zeros(len(self.layers))
        return np.concatenate(
            [
                np.full(len(bead), usual[i]) if bead.height is None else bead.height
                for i, _, bead in self
            ]
        )

    @property
    def length(self) -> float:
        """Total length of the beads, mm."""
        return float(sum(bead.length for _, _, bead in self))
