# SPDX-License-Identifier: LGPL-2.1-or-later
"""The map as an image, or its cells as comma separated values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...core.geometry.frames import TURN
from ...core.planning.redundancy_map import RZ, Picture
from ...core.types import Array
from ..colours import ramp
from ..in_language import tr
from .saving import ask

STEPS = 64  # of the ramp
TICKS = np.arange(-180, 181, 60)  # deg


def save(board: Any, branch: int, canvas: Any, obj: Any) -> None:
    """Ask for a file, and write to it the map of a joint path as the canvas shows it, or its cells; board: its
    `redundancy_map.board.Board`."""
    if canvas.painted is None:
        return
    picture, painted, curves = board.pictures[branch], canvas.painted, list(canvas.curves)
    size = canvas.width(), canvas.height()

    def content(ending: str) -> bytes:
        from ...plots import files

        if ending == "csv":
            return "".join(values(board, picture)).encode()
        return files.image(files.figure(_cells(board, painted, curves, files.Cells), *size), ending)

    ask(tr("Save the map"), obj, "map", content)


def values(board: Any, picture: Picture) -> Iterator[str]:
    """A header and a row for each cell, column by column, in the units of machine files; '' for a
    cell out of reach.

    `state`: the objection to a cell, '' without one.
    """
    names, across = _across(board)
    up_name, up = _up(board)
    yield (
        ",".join([*names, up_name, "phi_deg", "joint_margin_percent", "condition", "state"]) + "\n"
    )
    arm = np.zeros_like(picture.outside) if picture.arm is None else picture.arm
    state = np.select(
        [~picture.reachable, picture.past_limit, picture.singular, arm, picture.forbidden],
        ["unreachable", "beyond a limit", "near a singularity", "a link touches", "not allowed"],
        "",
    )
    phi = np.degrees(_phi(board, picture))
    for column, labels in enumerate(across):
        for row, value in enumerate(up):
            figures = 100.0 * picture.margin[row, column], picture.condition[row, column]
            cells = [
                f"{figure:.10g}" if picture.reachable[row, column] else "" for figure in figures
            ]
            yield (
                ",".join(
                    [
                        *labels,
                        f"{value:.10g}",
                        f"{phi[row, column]:.10g}",
                        *cells,
                        state[row, column],
                    ]
                )
                + "\n"
            )


def _across(board: Any) -> tuple[list[str], list[list[str]]]:
    """Return names and texts (C,) of the columns."""
    labels = [
        [str(number) for number in board.place(column)] for column in range(len(board.columns))
    ]
    if board.offsets is None or board.across is None:
        return ["layer", "bead", "point"], labels
    name, axis_values = _axis(board, board.across, board.offsets)
    return ["layer", "bead", "point", name], [
        [*row, f"{value:.10g}"] for row, value in zip(labels, axis_values, strict=True)
    ]


def _up(board: Any) -> tuple[str, Array]:
    """Return name and values (R,) of the rows."""
    if board.pair is not None:
        return _axis(board, board.pair.up, board.pair.values)
    assert board.map is not None
    return "rz_deg" if board.axis == RZ else "rotation_deg", np.degrees(board.map.values)


def _axis(board: Any, number: int, inside: Array) -> tuple[str, Array]:
    """An external axis: name and values as a machine file has them."""
    machine, index = board.source.cell.machine, board.source.cell.robot.chain.axes + number
    unit = "mm" if machine.chain.sliding[index] else "deg"
    return f"{machine.axes[index]}_{unit}", inside / machine.unit_values[index]


def _phi(board: Any, picture: Picture) -> Array:
    """(R, C) the rotation about the tool axis of each cell."""
    if board.pair is not None:
        return np.full(picture.margin.shape, board.pair.phi)
    assert board.map is not None
    return board.map.phi


def _cells(board: Any, painted: Any, curves: list[Any], factory: Any) -> Any:
    """The map for a figure."""
    count = len(painted.hatched)

    def row(value: Any) -> Any:
        return (np.asarray(value) + np.pi) / TURN * (count - 1)

    lines = []
    for curve in curves:
        rows = row((np.asarray(curve.values) + np.pi) % TURN - np.pi)
        jumps = np.abs(np.diff(rows, prepend=rows[:1])) > 0.5 * count
        lines.append(
            (np.where(jumps, np.nan, rows), tuple(channel / 255.0 for channel in curve.colour))
        )
    if board.pair is not None:
        up, rows_ = (
            board.pair.name,
            [(float(row(height)), text) for height, text in board.pair.labels],
        )
        across = [float(row(board.pair.planned))]
    else:
        up, across = (tr("RZ") if board.axis == RZ else tr("rotation")), []
        rows_ = [(float(row(np.radians(tick))), f"{tick}°") for tick in TICKS]
    scale = painted.scale
    return factory(
        title=board.title,
        up=up,
        colours=painted.colours,
        hatched=painted.hatched,
        columns=board.labels,
        rows=rows_,
        lines=([mark - 0.5 for mark in board.marks[1:]], across),
        curves=lines,
        ramp=ramp(np.linspace(0.0, 1.0, STEPS)),
        low=scale.low,
        high=max(scale.high, scale.low + 1e-9),
        scale=f"{tr(scale.title)} {scale.unit}".strip(),
        classes=[(tr(text), colour) for text, colour in painted.classes],
        hatching=tr("not allowed, or touching"),
    )
