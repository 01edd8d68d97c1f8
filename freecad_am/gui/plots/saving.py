# SPDX-License-Identifier: LGPL-2.1-or-later
"""Ask for the file of a picture, an image or CSV, and write it in the background."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, replace
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
import numpy as np
from PySide import QtGui

from ...core.geometry.frames import TURN
from ...core.kinematics import cell as cells
from ...core.motion import Motion
from ...core.parameters.process import ProcessParameters
from ...core.parameters.program import ProgramParameters
from ...core.planning import program as programs
from ...core.planning.redundancy_map import RZ
from ...core.planning.redundancy_map import Picture as MapPicture
from ...core.simulation import timeline
from ...core.simulation.achievable_feed import spread_to_deposit_rows
from ...core.types import Array
from ...objects import user_machines
from ...objects.current import is_stale
from ...objects.families.registry import stage_family
from ...objects.stage import stage_of
from ...plots.chart import LIGHT, Picture
from ...plots.draw import Range, Window, figure
from ...plots.files import KINDS, image, values
from ...plots.source import Source
from ..colours import ramp
from ..in_language import tr
from ..views.toolpath import band_of
from ..worker import Background, Worker
from .canvas import Canvas
from .reading import frame_words

TOOLPATH, JOINT_PATH, PROGRAM = "toolpath", "joint path", "program"


def plottable(obj: Any) -> bool:
    """Whether an object is a computed toolpath, joint path or program."""
    return kind_of(obj) in (TOOLPATH, JOINT_PATH, PROGRAM) and all(
        stage is not None and bool(stage.Key) for stage in made_from(obj)
    )


def kind_of(obj: Any) -> str:
    """Return the stage kind of an object; '' if it is not a stage."""
    stage = stage_of(obj) if obj is not None else None
    return "" if stage is None else str(stage.kind)


def made_from(obj: Any) -> list[Any]:
    """Return the source objects for pictures of a toolpath, joint path or program; None for missing
    objects.
    """
    if kind_of(obj) == PROGRAM:
        return [obj.JointPath] if kind_of(obj.JointPath) != JOINT_PATH else made_from(obj.JointPath)
    if kind_of(obj) == JOINT_PATH:
        return [obj, obj.Toolpath, obj.Cell]
    return [obj]


def key_of(obj: Any) -> tuple[Any, ...]:
    """Return a key that changes whenever the pictures of an object change."""
    start = (
        obj.Proxy.parameters(obj, ProgramParameters).start_at if kind_of(obj) == PROGRAM else None
    )
    return (obj.Document.Name, obj.Name, start, *(stage.Key for stage in made_from(obj)))


def maker_of(obj: Any) -> Callable[[], Source]:
    """Return a function that builds the source of an object's pictures; it touches no document and
    may take a moment.
    """
    path, toolpath_object = made_from(obj)[0], made_from(obj)[min(1, len(made_from(obj)) - 1)]
    toolpath = toolpath_object.Proxy.value(toolpath_object)
    process = toolpath_object.Proxy.parameters(toolpath_object, ProcessParameters)
    band = band_of(toolpath_object) if hasattr(toolpath_object.Feature, "Band") else None
    filled = _filled(toolpath_object.Feature)
    if kind_of(path) == TOOLPATH:
        return lambda: Source(
            toolpath,
            timeline.deposit_motion(toolpath),
            process,
            band=band,
            **filled,
        )
    planned, settings, folders = (
        path.Proxy.value(path),
        path.Cell.Proxy.value(path.Cell),
        user_machines.folders(),
    )
    start = (
        obj.Proxy.parameters(obj, ProgramParameters).start_at if kind_of(obj) == PROGRAM else None
    )

    def make() -> Source:
        motion, run = planned.motion, planned.joint_path.toolpath(toolpath)
        cell = cells.resolve(settings, toolpath.frame, toolpath.family, folders)
        condition, threshold = (
            spread_to_deposit_rows(motion.deposit, column)
            for column in planned.joint_path.conditions(motion)
        )
        if start is not None:
            rows = programs.rows_from(motion, start)
            motion = Motion(
                **{field.name: getattr(motion, field.name)[rows] for field in fields(motion)}
            )
            condition, threshold = condition[rows], threshold[rows]
        return Source(run, motion, process, cell, condition, threshold, band, **filled)

    return make


def _filled(feature: Any) -> dict[str, Any]:
    """Return the `Source` fields of a feature with stacked layers: its solids in plane layers, the
    position of the cuts, and the void limit. Return nothing for other features.
    """
    stage = stage_of(feature)
    family = None if stage is None else stage_family(stage)
    if stage is None or family is None or not family.stacks_layers or not feature.Key:
        return {}
    strategy: Any = stage.parameters(feature, family.parameters)
    return {
        "solids": stage.value(feature) if strategy.has_plane_layers else None,
        "cut_at": strategy.share_of_cut,
        "max_void": strategy.max_void,
    }


_writing: list[Background] = []  # keeps running work alive


def save(picture: Picture, metric: Picture, obj: Any, canvas: Canvas) -> None:
    """Ask for a file, and write an object's picture as the canvas shows it, or its values.

    metric: the picture in mm; its values are written whatever the window's units are.
    """
    size, (across, up) = (canvas.width(), canvas.height()), canvas.ranges()

    def plot_content(ending: str) -> bytes:
        exported = metric if ending == CSV else picture
        return file_content(exported, ending, size, across, up)

    ask(tr("Save the plot"), obj, picture.name, plot_content)


def ask(title: str, obj: Any, name: str, content: Callable[[str], bytes]) -> None:
    """Ask for a file and write in the background what `content` returns for its extension (png,
    svg, pdf, csv).

    Show an error if the object is out of date.
    """
    stale = next((stage for stage in made_from(obj) if stage is not None and is_stale(stage)), None)
    if stale is not None:
        text = tr("{} is out of date; recompute the document, then save.").format(stale.Label)
        _say(text, App.Console.PrintError)
        return
    proposal = os.path.join(os.path.dirname(obj.Document.FileName), f"{obj.Label}-{name}.png")
    kinds = ";;".join(
        (tr("Image (*.png)"), tr("Drawing (*.svg)"), tr("Document (*.pdf)"), tr("Values (*.csv)"))
    )
    path, kind = QtGui.QFileDialog.getSaveFileName(Gui.getMainWindow(), title, proposal, kinds)
    if path:
        _write(content, path, kind)


def _write(content: Callable[[str], bytes], path: str, kind: str) -> None:
    def write_target() -> str:
        ending = next((ending for ending in ENDINGS if f"*.{ending}" in kind), ENDINGS[0])
        target = path if path.rpartition(".")[2].lower() in ENDINGS else f"{path}.{ending}"
        write_file(content(target.rpartition(".")[2].lower()), target)
        return target

    def show_result(worker: Worker) -> None:
        _writing.remove(writing)
        try:
            _say(tr("{} was saved.").format(worker.result()), App.Console.PrintMessage)
        except OSError as error:
            _say(
                tr("{} cannot be written: {}").format(path, error.strerror or error),
                App.Console.PrintError,
            )

    writing = Background(Gui.getMainWindow())
    _writing.append(writing)
    writing.start(write_target, show_result)


def _say(text: str, console: Any) -> None:
    console(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)


# ---- Save pictures as images and as comma-separated values

Ranges = Mapping[int, Range]
CSV = "csv"
ENDINGS = (*KINDS, CSV)


def file_content(
    picture: Picture, ending: str, size: tuple[int, int], across: Ranges, up: Ranges
) -> bytes:
    """Return the file for an extension, one of ENDINGS.

    Images have a white background and the visible range (`draw.Window`); csv has all values of the
    picture.
    """
    if ending == CSV:
        return "".join(values(picture)).encode()
    return image(
        figure(picture.charts, replace(LIGHT, words=frame_words()), *size, Window(across, up))[0],
        ending,
    )


def write_file(content: bytes, path: str) -> None:
    """Write a file completely or not at all. Raises OSError if it cannot be written."""
    unfinished = f"{path}.unfinished"
    try:
        with open(unfinished, "wb") as stream:
            stream.write(content)
        os.replace(unfinished, path)
    finally:
        if os.path.exists(unfinished):
            os.remove(unfinished)


# ---- Save the Redundancy Map as an image, or its cells as comma-separated values

STEPS = 64  # steps of the ramp
TICKS = np.arange(-180, 181, 60)  # deg


def save_map(board: Any, branch: int, canvas: Any, obj: Any) -> None:
    """Ask for a file, and write the map of a joint path as the canvas shows it, or its cells.

    board: the map's `redundancy_map.board.Board`.
    """
    if canvas.painted is None:
        return
    picture, painted, curves = board.pictures[branch], canvas.painted, list(canvas.curves)
    size = canvas.width(), canvas.height()

    def content(ending: str) -> bytes:
        from ...plots import files

        if ending == "csv":
            return "".join(map_values(board, picture)).encode()
        return files.image(files.figure(_cells(board, painted, curves, files.Cells), *size), ending)

    ask(tr("Save the map"), obj, "map", content)


def map_values(board: Any, picture: MapPicture) -> Iterator[str]:
    """Yield a header and a row for each cell, column by column, in the units of machine files; ''
    out of reach.

    `state` is the reason why a cell is infeasible, '' for feasible cells.
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
    """Return name and values of an external axis in the units of machine files."""
    machine, index = board.source.cell.machine, board.source.cell.robot.chain.axes + number
    unit = "mm" if machine.chain.sliding[index] else "deg"
    return f"{machine.axes[index]}_{unit}", inside / machine.unit_values[index]


def _phi(board: Any, picture: MapPicture) -> Array:
    """Return the rotation (R, C) about the tool axis of each cell."""
    if board.pair is not None:
        return np.full(picture.margin.shape, board.pair.phi)
    assert board.map is not None
    return board.map.phi


def _cells(board: Any, painted: Any, curves: list[Any], factory: Any) -> Any:
    """Return the map in the form of a figure."""
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
