# SPDX-License-Identifier: LGPL-2.1-or-later
"""Asks where a picture is to be saved, and writes it beside the window."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import FreeCAD as App
import FreeCADGui as Gui
from PySide import QtGui

from ...objects.current import is_stale
from ...plots.chart import Picture
from ..background.later import Background
from ..background.worker import Worker
from ..texts.translation import tr
from .canvas import Canvas
from .sources import made_from

_writing: list[Background] = []  # Python must keep them as long as they write


def save(picture: Picture, metric: Picture, obj: Any, canvas: Canvas) -> None:
    """Ask for a file, and write to it the picture of an object as the canvas shows it, or its values, which are `metric`
    whatever the window's units are."""
    size, across, up = (canvas.width(), canvas.height()), dict(canvas.across), dict(canvas.up)

    def content(ending: str) -> bytes:
        from . import export  # with matplotlib, whose import takes some time

        shown = metric if ending == export.CSV else picture
        return export.content(shown, ending, size, across, up)

    ask(tr("Save the plot"), obj, picture.name, content)


def ask(title: str, obj: Any, name: str, content: Callable[[str], bytes]) -> None:
    """Ask for a file, and write to it, beside the window, what `content` gives for its ending, png, svg, pdf or csv. Say why
    not where the object that it shows is out of date."""
    stale = next((one for one in made_from(obj) if one is not None and is_stale(one)), None)
    if stale is not None:
        text = tr("{} is out of date; recompute the document, then save.").format(stale.Label)
        _say(text, App.Console.PrintError)
        return
    first = os.path.join(os.path.dirname(obj.Document.FileName), f"{obj.Label}-{name}.png")
    kinds = ";;".join(
        (tr("Image (*.png)"), tr("Drawing (*.svg)"), tr("Document (*.pdf)"), tr("Values (*.csv)"))
    )
    path, kind = QtGui.QFileDialog.getSaveFileName(Gui.getMainWindow(), title, first, kinds)
    if path:
        _write(content, path, kind)


def _write(content: Callable[[str], bytes], path: str, kind: str) -> None:
    def write() -> str:
        from . import export  # with matplotlib, whose import takes some time

        ending = next(
            (ending for ending in export.ENDINGS if f"*.{ending}" in kind), export.ENDINGS[0]
        )
        whole = path if path.rpartition(".")[2].lower() in export.ENDINGS else f"{path}.{ending}"
        export.write(content(whole.rpartition(".")[2].lower()), whole)
        return whole

    def written(worker: Worker) -> None:
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
    writing.start(write, written)


def _say(text: str, console: Any) -> None:
    console(text + "\n")
    Gui.getMainWindow().statusBar().showMessage(text, 8000)
