# SPDX-License-Identifier: LGPL-2.1-or-later
"""Issues of a bead model that sets the speeds: fit, speeds outside the table, heights, wire feed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple, Protocol

import numpy as np

from ..geometry.columns import columns, dots, lengths
from ..geometry.curves.plane_curve import running_sums
from ..geometry.ramps import limit_growth
from ..issues import NOTE, WARNING, Issue, Text, Word
from ..parameters.process import ProcessParameters
from ..toolpath import Bead, Toolpath
from ..types import Array, Index, Mask
from .bead_model import MINUTE, BeadModel
from .wire import model_wire_feed

HEIGHTS = "BEAD_HEIGHT"
DRIFT = 0.2  # fraction of the layer height; maximum height deviation without a warning


@dataclass(frozen=True, eq=False)
class Segments:
    """Segments (n,) of beads.

    length: mm. speed: travel speed, mm/min. width, height: mm at the midpoint. wire: wire speed, mm/s, or NaN.
    """

    length: Array
    speed: Array
    width: Array
    height: Array
    wire: Array


def segments(beads: Sequence[Bead]) -> Segments:
    """Return the segments of the beads whose speed a bead model sets."""
    modelled = [
        (bead, bead.width, bead.height)
        for bead in beads
        if bead.width is not None and bead.height is not None
    ]
    if not modelled:
        return Segments(*(np.empty(0) for _ in range(5)))
    speed = [bead.speed[1:] for bead, _, _ in modelled]
    return Segments(
        np.concatenate(
            [np.linalg.norm(np.diff(bead.points, axis=0), axis=1) for bead, _, _ in modelled]
        ),
        MINUTE * np.concatenate(speed),
        np.concatenate([0.5 * (width[1:] + width[:-1]) for _, width, _ in modelled]),
        np.concatenate([0.5 * (height[1:] + height[:-1]) for _, _, height in modelled]),
        np.concatenate(
            [
                (np.nan if bead.wire_share is None else bead.wire_share) * speeds
                for (bead, _, _), speeds in zip(modelled, speed)
            ]
        ),
    )


def beads(
    toolpath: Toolpath, numbers: Sequence[int] | Index | None = None
) -> dict[str, Any] | None:
    """Return the value of the key `beads` in a report.

    `drift_mm` of a layer is the difference between predicted mean height and layer height, summed
    over the layers of its solid up to this layer.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    numbers : sequence of int, optional
        Indices of one feature's layers among the layers of several features.

    Returns
    -------
    dict or None
        Speeds, widths, heights and wire feed in the units given in the keys; None without a bead
        model, and for several features.
    """
    total = segments([] if toolpath.features else [bead for _, _, bead in toolpath])
    if not len(total.length):
        return None
    rows: list[dict[str, Any]] = []
    drift = 0.0
    for number, layer in enumerate(toolpath.layers):
        layer_segments = segments(layer.beads)
        if not len(layer_segments.length):
            continue
        height = _summarise(layer_segments.height, layer_segments.length)
        drift = (0.0 if layer.first else drift) + height["mean"] - toolpath.layer_height
        rows.append(
            {
                "layer": number if numbers is None else int(numbers[number]),
                "height_mm": height,
                "drift_mm": drift,
            }
        )
    return {
        "travel_speed_mm_min": _summarise(total.speed, total.length),
        "width_mm": _summarise(total.width, total.length),
        "height_mm": _summarise(total.height, total.length),
        "layer_height_mm": toolpath.layer_height,
        "wire_feed_mm_s": _summarise(total.wire, total.length)
        if np.isfinite(total.wire).all()
        else None,
        "layers": rows,
    }


def height_issue(
    beads: Sequence[Bead],
    layer_height: float,
    process: ProcessParameters,
    model: BeadModel,
    as_run: bool = False,
) -> Issue:
    """Return the issue that compares predicted bead heights with the layers.

    Parameters
    ----------
    beads : sequence of Bead
        The beads at the speeds of a model.
    layer_height : float
        Layer height, mm.
    process : ProcessParameters
        Bead width and wire.
    model : BeadModel
        The bead model.
    as_run : bool, optional
        Whether the speeds are limited to speeds that the axes can follow.

    Returns
    -------
    Issue
        A warning if the mean height deviates by more than DRIFT, else a note.
    """
    sized = segments(beads)
    height = _summarise(sized.height, sized.length)
    drift = abs(height["mean"] - layer_height) / layer_height
    return Issue(
        WARNING if drift > DRIFT else NOTE,
        HEIGHTS,
        Text(
            "{}beads are predicted {:.3g} to {:.3g} mm high, {:.3g} mm on average, for layers of "
            "{:g} mm{}{}",
            Word("limited to the speed of the axes, " if as_run else ""),
            height["min"],
            height["max"],
            height["mean"],
            layer_height,
            Word("; set strategy.layer_height to the predicted height" if drift > DRIFT else ""),
            _sections(sized, process, model),
        ),
    )


def _sections(sized: Segments, process: ProcessParameters, model: BeadModel) -> str:
    """Describe the proportional wire feed, actual or possible; '' if speeds hardly vary."""
    if np.isfinite(sized.wire).all():
        low, high = float(sized.wire.min()), float(sized.wire.max())
        return Text(
            ". The wire feed follows the speed, at {:.3g} to {:.3g} mm/s, and keeps the "
            "cross-section",
            low,
            high,
        )
    per_mm = model_wire_feed(process, model) / model.straight_speed(process.bead_width)
    slowest, fastest = (
        per_mm * float(value) / MINUTE for value in (sized.speed.min(), sized.speed.max())
    )
    if fastest < 1.05 * slowest:
        return ""
    return Text(
        ". At a constant wire feed faster stretches are lower; process.wire.feed_mode: "
        "proportional would keep the cross-section, at {:.3g} to {:.3g} mm/s of wire",
        slowest,
        fastest,
    )


def _summarise(values: Array, length: Array) -> dict[str, float]:
    """Return the minimum, the length-weighted mean and the maximum."""
    mean = float((values * length).sum() / length.sum())
    return {"min": float(values.min()), "mean": mean, "max": float(values.max())}


CLAMPED = 0.05  # fraction of the bead length


class Held(Protocol):
    """A bead at the speeds of a model.

    clamped: (n,) where the speed for the width is outside the table. tight: (n,) where the bend is tighter than in the
    table.
    """

    @property
    def bead(self) -> Bead: ...

    @property
    def clamped(self) -> Mask | None: ...

    @property
    def tight(self) -> Mask | None: ...


def model_issues(
    sized: Sequence[Held], layer_height: float, process: ProcessParameters, model: BeadModel
) -> list[Issue]:
    """Return all issues of beads at the speeds of a model.

    Parameters
    ----------
    sized : sequence of Held
        The beads, with points outside the table marked.
    layer_height : float
        Layer height, mm.
    process : ProcessParameters
        Bead width and wire.
    model : BeadModel
        The bead model.

    Returns
    -------
    list of Issue
        The fit, contradictions in the table, speeds outside the table, heights and wire feed.
    """
    length = np.concatenate(
        [np.linalg.norm(np.diff(sized_bead.bead.points, axis=0), axis=1) for sized_bead in sized]
    )
    speed = np.concatenate([sized_bead.bead.speed[1:] for sized_bead in sized]) * MINUTE
    fit = model.width
    issues = [
        Issue(
            NOTE,
            "BEAD_MODEL",
            Text(
                "w = {:.4g} v^(-1/3) + {:.4g} / r + {:.4g} with R2 = {:.4f} and RMSE = {:.3g} mm; a width "
                "of {:g} mm takes travel speeds of {:.4g} to {:.4g} mm/min",
                fit.m,
                fit.p,
                fit.t,
                fit.r_squared,
                fit.rmse,
                process.bead_width,
                speed.min(),
                speed.max(),
            ),
        )
    ]
    if model.contradictions:
        issues.append(
            Issue(
                WARNING,
                "TABLE_CONTRADICTS",
                Text(
                    "rows of the bead table have the same settings but different results: {}; "
                    "measure these beads again, or remove one row of each pair",
                    Text.joined(", ", model.contradictions),
                ),
            )
        )
    issues += _outside(sized, length, process.bead_width, model)
    issues.append(
        height_issue([sized_bead.bead for sized_bead in sized], layer_height, process, model)
    )
    feed = model_wire_feed(process, model)
    if abs(feed - model.wire_feed) > 0.01 * model.wire_feed:
        low, high = model.feeds or (model.wire_feed, model.wire_feed)
        measured = Text("{:.4g}", low) if low == high else Text("{:.4g} to {:.4g}", low, high)
        issues.append(
            Issue(
                WARNING,
                "WIRE_FEED",
                Text(
                    "the table was measured at a wire feed of {} mm/s, but the job uses {:.4g} "
                    "mm/s; set process.wire.feed to auto or to the measured feed, or measure a "
                    "table at the feed of the job",
                    Word(measured),
                    feed,
                ),
            )
        )
    return issues


def _outside(
    sized: Sequence[Held], length: Array, target_width: float, model: BeadModel
) -> list[Issue]:
    """Return the issues of beads outside the range of the table."""
    clamped = np.concatenate(
        [sized_bead.clamped[1:] for sized_bead in sized if sized_bead.clamped is not None]
    )
    tight = np.concatenate(
        [sized_bead.tight[1:] for sized_bead in sized if sized_bead.tight is not None]
    )
    low, high = (MINUTE * value for value in model.speeds)
    slow, bent = (float(length[mask].sum() / length.sum()) for mask in (clamped, tight))
    issues = []
    if slow > 0.0:
        beads = sum(
            bool(sized_bead.clamped[1:].any())
            for sized_bead in sized
            if sized_bead.clamped is not None
        )
        width = np.concatenate(
            [sized_bead.bead.width[1:] for sized_bead in sized if sized_bead.bead.width is not None]
        )[clamped]
        worst = float(width[np.abs(width - target_width).argmax()])
        narrowest, widest = np.sort(model.widths(np.array(model.speeds), np.full(2, np.inf)))
        issues.append(
            Issue(
                WARNING if slow > CLAMPED else NOTE,
                "OUTSIDE_TABLE",
                Text(
                    "on {:.3g} % of the length, in {} of {} beads and {} segments, the required "
                    "width needs a speed outside the {:.4g} to {:.4g} mm/min of the table; the "
                    "speed is clamped, and the bead width is {:.3g} mm at worst instead of {:g} "
                    "mm. Straight beads of the table are {:.4g} to {:.4g} mm wide: set "
                    "process.bead_width in this range, or measure beads at other speeds",
                    100.0 * slow,
                    beads,
                    len(sized),
                    len(width),
                    low,
                    high,
                    worst,
                    target_width,
                    narrowest,
                    widest,
                ),
            )
        )
    if bent > 0.0:
        issues.append(
            Issue(
                NOTE,
                "TIGHT_BENDS",
                Text(
                    "{:.3g} % of the length bends more tightly than the beads of the table, "
                    "which have radii of {:.4g} mm or more; the model uses the smallest radius "
                    "there, so widths are only estimates",
                    100.0 * bent,
                    model.radii[0],
                ),
            )
        )
    return issues


MIN_TURN_RAD = 1e-9  # rad; minimum turn over the window of a curved bead


def radii(flat: Array, closed: bool, window: float) -> Array:
    """Return the local radius of curvature of a flattened bead.

    The radius follows from the path's turn over the window about each point. A corner thus counts
    as an arc as long as the window, because a bead of this width has no sharper bend.

    Parameters
    ----------
    flat : (n, 2) array
        Points, mm; a closed bead repeats its first point.
    closed : bool
        Whether the bead is closed.
    window : float
        Length of the window, mm.

    Returns
    -------
    (n,) array
        Radii, mm; infinite where straight.
    """
    step = np.diff(flat, axis=0)
    x, y = columns(step)
    heading = np.unwrap(np.arctan2(y, x))
    round_turn = (
        float(np.unwrap([heading[-1], heading[0]])[1] - heading[0]) if closed else None
    )  # turn over one full loop
    return _radii(np.linalg.norm(step, axis=1), heading, round_turn, window)


def side_radii(points: Array, build: Array, closed: bool, window: float) -> Array:
    """Return the local radius of curvature of a bead about its build directions.

    Parameters
    ----------
    points : (n, 3) array
        Points, mm; a closed bead repeats its first point.
    build : (n, 3) array
        Build directions, unit vectors.
    closed : bool
        Whether the bead is closed.
    window : float
        Length of the window as in `radii`, mm.

    Returns
    -------
    (n,) array
        Radii, mm; infinite where straight.
    """
    step = np.diff(points, axis=0)
    incoming, outgoing, up = step[:-1], step[1:], build[1:-1]
    if closed:
        incoming, outgoing, up = (
            np.vstack([rows, closing_row[None]])
            for rows, closing_row in ((incoming, step[-1]), (outgoing, step[0]), (up, build[0]))
        )
    level = dots(incoming, outgoing) - dots(incoming, up) * dots(outgoing, up)
    turn = np.arctan2(dots(np.cross(incoming, outgoing), up), level)
    heading = np.r_[0.0, np.cumsum(turn[: len(step) - 1])]
    return _radii(lengths(step), heading, float(turn.sum()) if closed else None, window)


def _radii(length: Array, heading: Array, round_turn: float | None, window: float) -> Array:
    """Return the radii at the ends of segments with lengths (n-1,) and headings (n-1,).

    `round_turn` is the turn of a closed bead over one full loop, None for an open bead.
    """
    closed = round_turn is not None
    s = np.r_[0.0, np.cumsum(length)]
    if round_turn is not None:
        rounds = max(1, int(np.ceil(window / s[-1])))
        turns = np.arange(-rounds, rounds + 1)
        knots = np.concatenate([s[:-1] + k * s[-1] for k in turns])
        values = np.concatenate([heading + k * round_turn for k in turns])
    else:
        knots, values = s[:-1], heading
    # the heading is a step function of arc length; the difference of its means before and after a point is the turn
    total = np.r_[0.0, np.cumsum(values * np.diff(np.r_[knots, knots[-1] + length[-1]]))]
    ends = np.r_[knots, knots[-1] + length[-1]]
    low, high = np.maximum(s - window, ends[0]), np.minimum(s + window, ends[-1])
    mean_before = (np.interp(s, ends, total) - np.interp(low, ends, total)) / np.maximum(
        s - low, 1e-12
    )
    mean_after = (np.interp(high, ends, total) - np.interp(s, ends, total)) / np.maximum(
        high - s, 1e-12
    )
    spacing = 0.5 * (high - low)
    at_end = (s - low < 1e-9) | (high - s < 1e-9)
    turn = np.where(at_end, 0.0, np.abs(mean_after - mean_before))
    if not closed and len(s) > 2:
        turn[[0, -1]] = turn[[1, -2]] * (spacing[[0, -1]] / spacing[[1, -2]])
    radius: Array = np.where(turn > MIN_TURN_RAD, spacing / np.maximum(turn, MIN_TURN_RAD), np.inf)
    return radius


def limit_acceleration(points: Array, speed: Array, closed: bool, acceleration: float) -> Array:
    """Lower speeds to limit the acceleration along a path.

    Parameters
    ----------
    points : (n, k) array
        Points of the path, mm.
    speed : (n,) array
        Requested speeds, mm/s.
    closed : bool
        Whether the path is closed.
    acceleration : float
        Maximum acceleration, mm/s2.

    Returns
    -------
    (n,) array
        Speeds, mm/s.
    """
    s = running_sums(np.linalg.norm(np.diff(points, axis=0), axis=1))
    square = speed * speed
    if closed:
        s = np.concatenate([s[:-1] - s[-1], s, s[1:] + s[-1]])
        square = np.concatenate([square[:-1], square, square[1:]])
    limited = np.sqrt(limit_growth(square, 2.0 * acceleration * s))
    n = len(points)
    slowed: Array = limited[n - 1 : 2 * n - 1] if closed else limited
    return np.minimum(slowed, speed)


class AtSpeed(NamedTuple):
    """A bead at the speeds of a model.

    clamped: (n,) where the speed for the width is outside the table. tight: (n,) where the bend is tighter than in the
    table.
    """

    bead: Bead
    clamped: Mask
    tight: Mask


def at_speed(
    bead: Bead,
    radius: Array,
    course: Array,
    closed: bool,
    process: ProcessParameters,
    model: BeadModel,
    share: Array | float = 1.0,
) -> AtSpeed:
    """Return a bead at the speeds that keep its width.

    The acceleration of the process limits the change of speed along the path.

    Parameters
    ----------
    bead : Bead
        The bead of n points.
    radius : (n,) array
        Radii of curvature, mm.
    course : (n, k) array
        Points of the path, mm.
    closed : bool
        Whether the path is closed.
    process : ProcessParameters
        Bead width, acceleration and wire.
    model : BeadModel
        The bead model.
    share : float or (n,) array, optional
        Fraction of the bead width to keep.

    Returns
    -------
    AtSpeed
        The bead with speeds, widths and heights, and the points outside the table.
    """
    speeds = model.speed_for(process.bead_width * share, radius)
    speed = limit_acceleration(course, speeds.speed, closed, process.acceleration)
    widths, heights, wire_share = model.widths(speed, radius), model.heights(speed, radius), None
    if process.wire.feed_mode == "proportional":
        heights = model.heights_of_section(widths, process.bead_width)
        wire_share = model_wire_feed(process, model) / model.straight_speed(process.bead_width)
    sized_bead = replace(
        bead, speed=segment_speeds(speed), width=widths, height=heights, wire_share=wire_share
    )
    return AtSpeed(sized_bead, speeds.too_slow | speeds.too_fast, speeds.too_tight)


def segment_speeds(speed: Array) -> Array:
    """Convert speeds at points to speeds on segments.

    Parameters
    ----------
    speed : (n,) array
        Speeds at points, mm/s.

    Returns
    -------
    (n,) array
        Speed on the segment that ends at each point, mm/s.
    """
    return np.concatenate([speed[:1], 0.5 * (speed[:-1] + speed[1:])])


def hold_widths(toolpath: Toolpath, process: ProcessParameters, model: BeadModel) -> Toolpath:
    """Return a toolpath without filling at the speeds that keep the bead width.

    Parameters
    ----------
    toolpath : Toolpath
        The toolpath.
    process : ProcessParameters
        Bead width, acceleration and wire.
    model : BeadModel
        The bead model.

    Returns
    -------
    Toolpath
        The toolpath with bead sizes and the issues of the model.
    """
    sized: list[AtSpeed] = []
    layers = []
    for layer in toolpath.layers:
        layer_beads = [_hold_bead(bead, process, model) for bead in layer.beads]
        sized += layer_beads
        layers.append(replace(layer, beads=tuple(sized_bead.bead for sized_bead in layer_beads)))
    widened = model_issues(sized, toolpath.layer_height, process, model)
    return replace(
        toolpath,
        layers=tuple(layers),
        law=model.law(process.acceleration),
        issues=(*toolpath.issues, *widened),
    )


def _hold_bead(bead: Bead, process: ProcessParameters, model: BeadModel) -> AtSpeed:
    radius = side_radii(bead.points, bead.build, bead.closed, process.bead_width)
    return at_speed(bead, radius, bead.points, bead.closed, process, model)
