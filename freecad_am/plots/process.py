# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of the deposit: speed along the path, rate, distances between layers, and what a bead model predicts."""

from __future__ import annotations

from typing import Any

import numpy as np

from freecad_am.core.types import Array

from ..core.issues import Text, Word
from ..core.layers.planes.slabs import outline
from ..core.process.model import predicted
from .chart import LINE, MARKED, OUTLINE, STEP, Bars, Chart, Curve, Quantity
from .rows import Rows
from .source import Source

BINS = 48
# g/s in kg/h, and mm^3 in cm^3
KG_PER_HOUR, MM3_PER_CM3 = 3.6, 1000.0
LEAST_PART = 1e-3  # of the largest layer; a share of less means nothing


def travel(source: Source, rows: Rows) -> tuple[Chart, ...]:
    """The speed of the deposition point, as asked for and, where the machine cannot keep it, what it becomes."""
    motion, kept = source.motion, source.feed
    speed = np.where(motion.point > 0, motion.speed, np.nan)
    rapid, deposit = (
        rows.along(np.where(some, values, np.nan))
        for some, values in (
            (~motion.deposit, motion.speed),
            (motion.deposit, speed),
        )
    )
    rapid[rows.standing] = deposit[rows.standing] = np.nan
    curves = (
        [Curve("rapid", rows.x, rapid, "soft", STEP, rows.layer)] if (~motion.deposit).any() else []
    )
    curves.append(Curve("deposit", rows.x, deposit, 2, STEP, rows.layer))
    if kept is not None and (kept.slowed & motion.deposit).any():
        slowed = rows.along(np.where(kept.slowed & motion.deposit, kept.achieved, np.nan))
        slowed[rows.standing] = np.nan
        curves.append(Curve("as the axes can", rows.x, slowed, "bad", STEP, rows.layer))
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
    """The deposit rate of each segment, and the mass that has been deposited so far."""
    motion, density = source.motion, source.process.density
    mass = source.volumes / MM3_PER_CM3 * density
    rate = np.divide(
        KG_PER_HOUR * mass, motion.duration, out=np.zeros_like(mass), where=motion.duration > 0.0
    )
    so_far = np.cumsum(mass)
    most = float(rate.max(initial=0.0))
    return (
        Chart(
            "Deposit rate",
            rows.quantity,
            Quantity("rate", "kg/h"),
            (Curve("rate", rows.x, rows.along(rate), 2, STEP, rows.layer),),
            borders=rows.borders,
            layers=rows.layers,
            span=(0.0, 1.12 * most or 1.0),
        ),
        Chart(
            "Deposited mass",
            rows.quantity,
            Quantity("mass", "g"),
            (Curve("mass", rows.x, rows.at(so_far), 3, LINE, rows.layer),),
            borders=rows.borders,
            layers=rows.layers,
        ),
    )


def distances(values: Array, asked: float, band: float | None = None, name: str = "") -> Chart:
    """How the local distances (n,) mm between layers are spread about the layer height, and the band they may lie in. name:
    of the feature, where there are several."""
    low, high = float(values.min(initial=asked)), float(values.max(initial=asked))
    pad = max(0.15 * (high - low), 0.002 * asked)
    edges = np.linspace(low - pad, high + pad, BINS + 1)
    share = np.histogram(values, edges)[0] * (100.0 / max(len(values), 1))
    title = Text("{}: distance", name) if name else "Distance"
    return Chart(
        Text("{} to the layer before (asked: {:g} mm)", Word(title), asked),
        Quantity("local distance", "mm"),
        Quantity("share of the points", "%"),
        bars=Bars("share", edges, share),
        band=None if band is None else (asked * (1.0 - band), asked * (1.0 + band)),
        upright=((asked, "layer height"),),
    )


def spacing(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """`distances` of layers; none where no layer lies on another."""
    values, layer = source.distances
    taken = values[(layer >= layers[0]) & (layer <= layers[1])]
    return (distances(taken, source.toolpath.layer_height, source.band),) if len(taken) else ()


def spread(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """How travel speeds, bead widths and heights are spread over the length; none without a bead model."""
    found = source.segments(layers)
    if not len(found.length):
        return ()
    return (
        _histogram("Travel speed", Quantity("travel speed", "mm/min"), found.speed, found.length),
        _histogram(
            "Predicted width of the bead", Quantity("width", "mm"), found.width, found.length
        ),
        _histogram(
            "Predicted height of the bead", Quantity("height", "mm"), found.height, found.length
        ),
    )


def heights(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """Predicted heights against the layer height, layer by layer, and how far the layers are off by them; none without a
    bead model."""
    return height_charts(predicted.beads(source.toolpath), layers)


def height_charts(figures: dict[str, Any] | None, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """The charts of what `predicted.beads` finds."""
    rows = (
        []
        if figures is None
        else [row for row in figures["layers"] if layers[0] <= row["layer"] <= layers[1]]
    )
    if figures is None or not rows:
        return ()
    x, asked = np.array([row["layer"] for row in rows], float), float(figures["layer_height_mm"])

    def curve(name: str, values: list[float], colour: int) -> Curve:
        return Curve(name, x, np.array(values), colour, MARKED)

    spread = [
        curve(name, [row["height_mm"][kind] for row in rows], colour)
        for colour, (kind, name) in enumerate(
            (("min", "lowest"), ("mean", "mean"), ("max", "highest"))
        )
    ]
    layer = Quantity("layer")
    return (
        Chart(
            "Predicted height by layer",
            layer,
            Quantity("height", "mm"),
            tuple(spread),
            marks=((asked, f"layer height {asked:g} mm"),),
        ),
        Chart(
            "Sum of the heights, off the layers",
            layer,
            Quantity("off", "mm"),
            (curve("drift", [row["drift_mm"] for row in rows], 3),),
            marks=((0.0, ""),),
        ),
    )


def by_layer(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """What is deposited layer by layer beside what the part has there, and the share of it; none but of plane layers."""
    if source.slabs is None:
        return ()
    end = (
        layers[1] + 1 if layers[1] + 1 < len(source.toolpath.layers) else None
    )  # with what is left out at the top
    part, deposited = (values[layers[0] : end] / MM3_PER_CM3 for values in source.slabs)
    if not len(part):
        return ()
    x, layer = np.arange(layers[0], layers[0] + len(part), dtype=float), Quantity("layer")
    share = np.divide(
        100.0 * deposited,
        part,
        out=np.full(len(part), np.nan),
        where=part > LEAST_PART * part.max(),
    )
    whole = 100.0 * deposited.sum() / max(part.sum(), 1e-300)
    return (
        Chart(
            "Volume by layer",
            layer,
            Quantity("volume", "cm³"),
            (Curve("part", x, part, "soft", MARKED), Curve("deposited", x, deposited, 0, MARKED)),
        ),
        Chart(
            Text("Deposited of the part: {:.4g} %", whole),
            layer,
            Quantity("share", "%"),
            (Curve("share", x, share, 0, MARKED),),
            marks=((100.0, ""),),
        ),
    )


def section(source: Source, layers: tuple[int, int]) -> tuple[Chart, ...]:
    """The last of the layers as beads of their width, on the outline of the part where it is cut for it; none but of plane
    layers."""
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
