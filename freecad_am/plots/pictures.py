# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures by name: axis motion against limits, Jacobian condition, and layer charts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.issues import Text, Word
from ..core.kinematics.cell import Cell
from ..core.layers.plane_field import outline
from ..core.process import model_notes
from ..core.types import Array, Index, Integers, Mask
from .chart import (
    INF,
    LAYER_NUMBER,
    LINE,
    MARKED,
    OUTLINE,
    STEP,
    Bars,
    Chart,
    Curve,
    Picture,
    Quantity,
    fit,
)
from .source import Source

TIME, PATH = "time", "path"
OVER = (TIME, PATH)
# units of time in s and of path length in mm, largest first; a unit applies from 3 units upwards
TIMES: tuple[tuple[float, str], ...] = ((3600.0, "h"), (60.0, "min"), (1.0, "s"))
LENGTHS: tuple[tuple[float, str], ...] = ((1000.0, "m"), (1.0, "mm"))


@dataclass(frozen=True, eq=False)
class Rows:
    """k samples along a job.

    index: (k,) motion row of each sample. x: (k,) in the unit of `quantity`, never decreasing.
    standing: (k,) bool, whether the machine has waited at its row since the previous sample.
    borders: x of the layer starts. layers: numbers of these layers.
    """

    index: Index
    x: Array
    standing: Mask
    layer: Integers
    quantity: Quantity
    borders: Array
    layers: Integers

    def select(self, values: Array) -> Array:
        """Return row values (n, ...), such as axis positions, at the samples (k, ...)."""
        selected: Array = values[self.index]
        return selected

    def select_rates(self, values: Array) -> Array:
        """Return segment values (n, ...), such as speeds, at the samples (k, ...).

        A row has the value of the segment that ends at the row; the value is 0 during waits.
        """
        selected = values[self.index]
        selected[self.standing] = 0.0
        return selected


def rows(source: Source, over: str = TIME, layers: tuple[int, int] | None = None) -> Rows:
    """Return the samples of layers, first to last inclusive; all layers by default.

    over: TIME, job time including waits; or PATH, path length of the deposition point including
    rapid moves.
    """
    motion, times = source.motion, source.times
    waits = times.leave > times.arrive
    index = np.repeat(np.arange(len(motion)), 1 + waits)
    standing = np.concatenate([np.zeros(min(1, len(index)), dtype=bool), np.diff(index) == 0])
    if over == TIME:
        x, units, total = (
            np.where(standing, times.leave[index], times.arrive[index]),
            TIMES,
            times.total,
        )
    else:
        length = np.cumsum(
            np.nan_to_num(
                np.linalg.norm(
                    np.diff(motion.position, axis=0, prepend=motion.position[:1]), axis=1
                )
            )
        )
        x, units, total = length[index], LENGTHS, float(length[-1]) if len(length) else 0.0
    unit, name = next((size, name) for size, name in units if total >= 3.0 * size or size == 1.0)
    x = np.maximum.accumulate(x / unit)  # summed times may decrease by rounding
    layer = motion.layer[index]
    if layers is not None:
        selected = (layer >= layers[0]) & (layer <= layers[1])
        index, x, standing, layer = (
            index[selected],
            x[selected],
            standing[selected],
            layer[selected],
        )
    starts = np.flatnonzero(np.diff(layer, prepend=-1))
    return Rows(index, x, standing, layer, Quantity(over, name), x[starts], layer[starts])


CONTINUOUS = " (endless)"
# texts for limits missing in the machine file
NO_SPEED = "no limit known: the machine file has no max_speed"
NO_ACCELERATION = "no limit known: the machine file has no max_acceleration"
NO_JERK = "no limit known: the machine file has no max_jerk"
MOST_SHARE = 250.0  # % of the limit; maximum of the scale, so that lower values stay readable


def angles(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the position of each axis, and of each axis sum with coupled limits."""
    cell = _cell(source)
    limits, units, values = cell.limits, cell.machine.units, cell.machine.unit_values
    joints = rows.select(source.motion.joints)
    charts = [
        _axis_chart(
            rows,
            axis,
            limits.labels[axis] + ("" if np.isfinite(low) or np.isfinite(high) else CONTINUOUS),
            Quantity("place" if units[axis] == "mm" else "angle", units[axis]),
            joints[:, axis] / values[axis],
            (low, high),
            LINE,
        )
        for axis, (low, high) in enumerate(
            zip((limits.lower / values).tolist(), (limits.upper / values).tolist())
        )
    ]
    for number, coefficients in enumerate(limits.coefficients):
        ends = (np.degrees(limits.coupled_lower[number]), np.degrees(limits.coupled_upper[number]))
        label = limits.labels[limits.axes + number]
        sums = np.degrees(joints @ coefficients)
        charts.append(
            _axis_chart(
                rows, limits.axes + number, label, Quantity("angle", "deg"), sums, ends, LINE
            )
        )
    return tuple(charts)


def speeds(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the speed of each axis while depositing, as segment means."""
    return _rates(
        source,
        rows,
        rows.select_rates(source.rates.speed),
        "speed",
        "/s",
        _cell(source).machine.max_speed,
        STEP,
        NO_SPEED,
    )


def accelerations(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the acceleration of each axis while depositing, at points inside beads."""
    limits = _cell(source).machine.max_acceleration
    return _rates(
        source,
        rows,
        rows.select(source.rates.acceleration),
        "acceleration",
        "/s²",
        limits,
        LINE,
        NO_ACCELERATION,
    )


def jerks(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the jerk of each axis while depositing."""
    limits = _cell(source).machine.max_jerk
    return _rates(
        source, rows, rows.select_rates(source.rates.jerk), "jerk", "/s³", limits, STEP, NO_JERK
    )


def shares(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the speeds of all axes while depositing, as percentages of their limits."""
    machine = _cell(source).machine
    values = 100.0 * np.abs(rows.select_rates(source.rates.speed)) / machine.max_speed
    largest = float(np.nanmax(values, initial=0.0))
    top = (
        max(1.12 * largest, 125.0) if largest > 40.0 else 1.12 * largest or 1.0
    )  # show the limit if speeds come close to it
    curves = tuple(
        _curve(rows, name, values[:, axis], axis, STEP) for axis, name in enumerate(machine.axes)
    )
    chart = Chart(
        "Joint speeds while depositing",
        rows.quantity,
        Quantity("share of the limit", "%"),
        curves,
        limits=(-INF, 100.0),
        borders=rows.borders,
        layers=rows.layers,
        span=(0.0, min(top, MOST_SHARE)),
    )
    return (chart,)


def condition(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the inverse condition number of the Jacobian while depositing, and its minimum.

    The number is sigma_min / sigma_max of the scaled Jacobian. Empty for machines without one.
    """
    if (
        source.condition is None
        or source.threshold is None
        or not np.isfinite(source.condition).any()
    ):
        return ()
    values, threshold = rows.select(source.condition), rows.select(source.threshold)
    curves = (
        _curve(rows, "least allowed", threshold, "bad", LINE),
        _curve(rows, "condition", values, 0, LINE),
    )
    top = 1.15 * float(np.nanmax(values, initial=0.05))
    chart = Chart(
        "Condition of the Jacobian (0 is singular)",
        rows.quantity,
        Quantity("σmin / σmax"),
        curves,
        borders=rows.borders,
        layers=rows.layers,
        span=(0.0, top),
    )
    return (chart,)


def _rates(
    source: Source,
    rows: Rows,
    values: Array,
    name: str,
    per: str,
    limits: Array,
    kind: str,
    unlimited: str,
) -> tuple[Chart, ...]:
    machine = _cell(source).machine
    scaled, ends = values / machine.unit_values, limits / machine.unit_values
    return tuple(
        _axis_chart(
            rows,
            axis,
            label,
            Quantity(name, machine.units[axis] + per),
            scaled[:, axis],
            (-end, end),
            kind,
            unlimited if np.isinf(end) else "",
        )
        for axis, (label, end) in enumerate(zip(machine.axes, ends.tolist(), strict=True))
    )


def _axis_chart(
    rows: Rows,
    axis: int,
    title: str,
    y: Quantity,
    values: Array,
    limits: tuple[float, float],
    kind: str,
    unlimited: str = "",
) -> Chart:
    curve = _curve(rows, title.removesuffix(CONTINUOUS), values, axis, kind)
    return Chart(
        title,
        rows.quantity,
        y,
        (curve,),
        limits=(float(limits[0]), float(limits[1])),
        borders=rows.borders,
        layers=rows.layers,
        unlimited=unlimited,
    )


def _curve(rows: Rows, name: str, values: Array, colour: int | str, kind: str) -> Curve:
    return Curve(name, rows.x, values, colour, kind, rows.layer)


def _cell(source: Source) -> Cell:
    if source.cell is None:
        raise ValueError("a picture of axes needs a cell")
    return source.cell


BINS = 48
# conversion factors: g/s to kg/h, and mm^3 per cm^3
KG_PER_HOUR, MM3_PER_CM3 = 3.6, 1000.0
VOID_COLOUR, DOUBLE_COLOUR = "#d42020", "#2050d0"
LEAST_PART = 1e-3  # fraction of the maximum layer volume; smaller layers have no ratio


def travel(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the programmed speed of the deposition point.

    Include the achieved speed where the axes cannot keep the programmed speed.
    """
    motion, feed = source.motion, source.feed
    speed = np.where(motion.point > 0, motion.speed, np.nan)
    rapid, deposit = (
        rows.select_rates(np.where(mask, values, np.nan))
        for mask, values in (
            (~motion.deposit, motion.speed),
            (motion.deposit, speed),
        )
    )
    rapid[rows.standing] = deposit[rows.standing] = np.nan
    curves = (
        [Curve("rapid", rows.x, rapid, "soft", STEP, rows.layer)] if (~motion.deposit).any() else []
    )
    curves.append(Curve("deposit", rows.x, deposit, 2, STEP, rows.layer))
    if feed is not None and (feed.slowed & motion.deposit).any():
        slowed = rows.select_rates(np.where(feed.slowed & motion.deposit, feed.achieved, np.nan))
        slowed[rows.standing] = np.nan
        curves.append(Curve("limited by the axes", rows.x, slowed, "bad", STEP, rows.layer))
    top = 1.12 * float(np.nanmax([np.nanmax(curve.y, initial=0.0) for curve in curves])) or 1.0
    chart = Chart(
        "Speed along the path",
        rows.quantity,
        Quantity("speed", "mm/s"),
        tuple(curves),
        borders=rows.borders,
        layers=rows.layers,
        span=(0.0, top),
    )
    return (chart,)


def deposit(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """Chart the deposit rate of each segment and the cumulative mass."""
    motion, density = source.motion, source.process.density
    mass = source.volumes / MM3_PER_CM3 * density
    rate = np.divide(
        KG_PER_HOUR * mass, motion.duration, out=np.zeros_like(mass), where=motion.duration > 0.0
    )
    so_far = np.cumsum(mass)
    highest = float(rate.max(initial=0.0))
    return (
        Chart(
            "Deposit rate",
            rows.quantity,
            Quantity("rate", "kg/h"),
            (Curve("rate", rows.x, rows.select_rates(rate), 2, STEP, rows.layer),),
            borders=rows.borders,
            layers=rows.layers,
            span=(0.0, 1.12 * highest or 1.0),
        ),
        Chart(
            "Deposited mass",
            rows.quantity,
            Quantity("mass", "g"),
            (Curve("mass", rows.x, rows.select(so_far), 3, LINE, rows.layer),),
            borders=rows.borders,
            layers=rows.layers,
        ),
    )


def distances(
    values: Array, layer_height: float, band: float | None = None, name: str = ""
) -> Chart:
    """Chart the distribution of local layer distances (n,), mm, with layer height and tolerance.

    band: tolerance as a fraction of the layer height. name: feature name, if the job has several.
    """
    low, high = float(values.min(initial=layer_height)), float(values.max(initial=layer_height))
    pad = max(0.15 * (high - low), 0.002 * layer_height)
    edges = np.linspace(low - pad, high + pad, BINS + 1)
    share = np.histogram(values, edges)[0] * (100.0 / max(len(values), 1))
    title = Text("{}: distance", name) if name else "Distance"
    return Chart(
        Text("{} to the previous layer (requested: {:g} mm)", Word(title), layer_height),
        Quantity("local distance", "mm"),
        Quantity("share of the points", "%"),
        bars=Bars("share", edges, share),
        band=None if band is None else (layer_height * (1.0 - band), layer_height * (1.0 + band)),
        upright=((layer_height, "layer height"),),
    )


def spacing(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart `distances` of the layers; empty if no layer rests on another layer."""
    values, layer = source.distances
    selected = values[(layer >= layers[0]) & (layer <= layers[1])]
    return (
        (distances(selected, source.toolpath.layer_height, source.band),) if len(selected) else ()
    )


def distributions(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart the distributions of travel speed, bead width and bead height over the bead length.

    Empty without a bead model.
    """
    segments = source.segments(layers)
    if not len(segments.length):
        return ()
    return (
        _histogram(
            "Travel speed", Quantity("travel speed", "mm/min"), segments.speed, segments.length
        ),
        _histogram(
            "Predicted width of the bead", Quantity("width", "mm"), segments.width, segments.length
        ),
        _histogram(
            "Predicted height of the bead",
            Quantity("height", "mm"),
            segments.height,
            segments.length,
        ),
    )


def heights(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart predicted and nominal layer height per layer, and the accumulated height error.

    Empty without a bead model.
    """
    return height_charts(model_notes.beads(source.toolpath), layers)


def height_charts(figures: dict[str, Any] | None, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart the predicted heights in the result of `model_notes.beads`; empty for None."""
    rows = (
        []
        if figures is None
        else [row for row in figures["layers"] if layers[0] <= row["layer"] <= layers[1]]
    )
    if figures is None or not rows:
        return ()
    x, layer_height = (
        np.array([row["layer"] for row in rows], float),
        float(figures["layer_height_mm"]),
    )

    def curve(name: str, values: list[float], colour: int) -> Curve:
        return Curve(name, x, np.array(values), colour, MARKED)

    spread = [
        curve(name, [row["height_mm"][kind] for row in rows], colour)
        for colour, (kind, name) in enumerate(
            (("min", "lowest"), ("mean", "mean"), ("max", "highest"))
        )
    ]
    return (
        Chart(
            "Predicted height by layer",
            LAYER_NUMBER,
            Quantity("height", "mm"),
            tuple(spread),
            marks=((layer_height, f"layer height {layer_height:g} mm"),),
        ),
        Chart(
            "Sum of the heights, minus the planned layers",
            LAYER_NUMBER,
            Quantity("off", "mm"),
            (curve("drift", [row["drift_mm"] for row in rows], 3),),
            marks=((0.0, ""),),
        ),
    )


def by_layer(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart deposited volume and part volume by layer, and their ratio.

    Empty for layers that are not plane.
    """
    if source.slabs is None:
        return ()
    end = (
        layers[1] + 1 if layers[1] + 1 < len(source.toolpath.layers) else None
    )  # include the part volume above the last layer
    part_volume, deposited = (values[layers[0] : end] / MM3_PER_CM3 for values in source.slabs)
    if not len(part_volume):
        return ()
    x = np.arange(layers[0], layers[0] + len(part_volume), dtype=float)
    share = np.divide(
        100.0 * deposited,
        part_volume,
        out=np.full(len(part_volume), np.nan),
        where=part_volume > LEAST_PART * part_volume.max(),
    )
    percent = 100.0 * deposited.sum() / max(part_volume.sum(), 1e-300)
    return (
        Chart(
            "Volume by layer",
            LAYER_NUMBER,
            Quantity("volume", "cm³"),
            (
                Curve("part", x, part_volume, "soft", MARKED),
                Curve("deposited", x, deposited, 0, MARKED),
            ),
        ),
        Chart(
            Text("Deposited share of the part: {:.4g} %", percent),
            LAYER_NUMBER,
            Quantity("share", "%"),
            (Curve("share", x, share, 0, MARKED),),
            marks=((100.0, ""),),
        ),
    )


def infill(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart void and double deposit of plane layers; empty if no layer was measured."""
    measured = [
        (number, layer.coverage)
        for number, layer in enumerate(source.toolpath.layers)
        if layers[0] <= number <= layers[1] and layer.coverage is not None
    ]
    if not measured:
        return ()
    x = np.array([number for number, _ in measured], dtype=float)
    void, over = (
        100.0 * np.array([getattr(coverage, name) for _, coverage in measured])
        for name in ("void", "over")
    )
    curves = (Curve("double deposit", x, over, DOUBLE_COLOUR, MARKED),)
    if np.isfinite(void).any():
        curves = (Curve("void", x, void, VOID_COLOUR, MARKED), *curves)
    limit = 100.0 * source.max_void
    return (
        Chart(
            "Void and double deposit by layer",
            LAYER_NUMBER,
            Quantity("share of the section", "%"),
            curves,
            marks=((limit, f"limit of void {limit:g} %"),) if limit < 100.0 else (),
        ),
    )


def section(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Chart the beads of the last layer to scale, on the part outline at its cut height.

    Empty for layers that are not plane.
    """
    if source.group is None:
        return ()
    number, height = layers[1], source.toolpath.layer_height
    base, rows = source.group.base, source.motion.deposit & (source.motion.layer == layers[1])
    if not rows.any():
        return ()
    beads = source.toolpath.layers[number].beads
    plane = float(np.median(base.inside(beads[0].points)[:, 2]))
    nominal = (
        source.process.bead_width
        if source.toolpath.bead_width is None
        else source.toolpath.bead_width
    )
    curves = [
        Curve(
            "" if k else "bead",
            *base.inside(bead.points)[:, :2].T,
            0,
            OUTLINE,
            width=nominal if bead.width is None else float(np.mean(bead.width)),
        )
        for k, bead in enumerate(beads)
    ]
    loops = outline(source.group, plane + source.cut_at * height)
    curves += [Curve("" if k else "part", *loop.T, "ink", OUTLINE) for k, loop in enumerate(loops)]
    return (
        Chart(
            Text("Section of layer {}", number),
            Quantity("x", "mm"),
            Quantity("y", "mm"),
            tuple(curves),
            plane=True,
        ),
    )


def _histogram(title: str, x: Quantity, values: Array, length: Array) -> Chart:
    low, high = float(values.min()), float(values.max())
    pad = max(0.05 * (high - low), 0.002 * high)
    edges = np.linspace(low - pad, high + pad, BINS + 1)
    share = np.histogram(values, edges, weights=length)[0] * (100.0 / length.sum())
    return Chart(title, x, Quantity("share of the length", "%"), bars=Bars("share", edges, share))


# ---- All pictures by name

Charts = tuple[Chart, ...]


@dataclass(frozen=True)
class Entry:
    """A picture of the catalogue.

    along: function that makes charts over time or path. from_layers: function that makes charts
    from layers, if `along` is None. machine: whether the picture needs a cell. lacking: reason why
    there are no charts.
    """

    title: str
    along: Callable[[Source, Rows], Charts] | None = None
    from_layers: Callable[[Source, tuple[int, int]], Charts] | None = None
    machine: bool = False
    lacking: str = "these layers have no values to show"


def _fit(source: Source, layers: tuple[int, int]) -> Charts:
    model = source.model
    return () if model is None else (fit(*model, source.process.bead_width),)


_NO_PLANES = "only solids in planar layers have sections and volumes of layers"
_NO_MODEL = "no bead model sets the speeds (process.bead_model)"
PICTURES = {
    "angles": Entry("Joint angles", angles, machine=True),
    "speeds": Entry("Joint speeds", speeds, machine=True),
    "shares": Entry("Joint speeds in %", shares, machine=True),
    "accelerations": Entry("Joint accelerations", accelerations, machine=True),
    "jerks": Entry("Joint jerks", jerks, machine=True),
    "condition": Entry(
        "Condition", condition, machine=True, lacking="the machine has no condition number"
    ),
    "travel": Entry("Speed along the path", travel),
    "deposit": Entry("Deposit rate", deposit),
    "spacing": Entry(
        "Distance between layers",
        from_layers=spacing,
        lacking="no layer shown rests on another layer",
    ),
    "volumes": Entry("Volume by layer", from_layers=by_layer, lacking=_NO_PLANES),
    "infill": Entry(
        "Void and double deposit",
        from_layers=infill,
        lacking="only solids in planar layers are measured for void and double deposit",
    ),
    "section": Entry("Section of the last layer", from_layers=section, lacking=_NO_PLANES),
    "heights": Entry("Predicted heights", from_layers=heights, lacking=_NO_MODEL),
    "spread": Entry("Predicted widths and speeds", from_layers=distributions, lacking=_NO_MODEL),
    "fit": Entry("Fit of the bead widths", from_layers=_fit, lacking=_NO_MODEL),
}


def picture(
    name: str, source: Source, over: str = TIME, layers: tuple[int, int] | None = None
) -> Picture:
    """Make a picture of PICTURES.

    over: TIME or PATH, for pictures along the job. layers: first and last layer; None for all. A
    picture without data has no charts but a reason. Raises InputError for an unreadable bead model
    table.
    """
    entry = PICTURES[name]
    if entry.machine and source.cell is None:
        return Picture(name, entry.title, (), "a toolpath has no joints yet; choose a joint path")
    if entry.along is not None:
        charts = entry.along(source, rows(source, over, layers))
    else:
        assert entry.from_layers is not None
        charts = entry.from_layers(source, layers or (0, len(source.toolpath.layers) - 1))
    return Picture(name, entry.title, charts, "" if charts else entry.lacking)
