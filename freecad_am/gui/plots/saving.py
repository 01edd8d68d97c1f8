# SPDX-License-Identifier: LGPL-2.1-or-later
"""Asks where a picture is to be saved, and writes it beside the window."""

from __future__ import annotations

import os
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...plots.chart import Picture
from ..background.later import Background
from ..background.worker import Worker
from ..texts.translation import tr
from .canvas import Canvas

_writing: list[Background] = []  # Python must keep them as long as they write


def save(picture: Picture, obj: Any, canvas: Canvas) -> None:
    """Ask for a file, and write to it the picture of an object as the canvas shows it, or its values."""
    first = os.path.join(os.path.dirname(obj.Document.FileName), f"{obj.Label}-{picture.name}.png")
    kinds = ";;".join((tr("Image (*.png)"), tr("Drawing (*.svg)"), tr("Document (*.pdf)"), tr("Values (*.csv)")))
    path, kind = QtGui.QFileDialog.getSaveFileName(Gui.getMainWindow(), tr("Save the plot"), first, kinds)
    if path:
        _write(picture, path, kind, canvas)


def _write(picture: Picture, path: str, kind: str, canvas: Canvas) -> None:
    size, across, up = (canvas.width(), canvas.height()), dict(canvas.across), dict(canvas.up)

    def write() -> str:
        from . import export  # with matplotlib, whose import takes some time

        ending = next((ending for ending in export.ENDINGS if f"*.{ending}" in kind), export.ENDINGS[0])
        whole = path if path.rpartition(".")[2].lower() in export.ENDINGS else f"{path}.{ending}"
        export.write(picture, whole, size, across, up)
        return whole

    def written(worker: Worker) -> None:
        _writing.remove(writing)
        try:
            _say(tr("{} is written.").format(worker.result()), App.Console.PrintMessage)
        except OSError as error:
            _say(tr("{} cannot be written: {}").format(path, error.strerror or error), App.Console.PrintError)

    writing = Background(Gui.getMainWindow())
    _writing.append(writing)
    writing.start(write, written)


def _say(text: str, console: Any) -> None:
    console(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
