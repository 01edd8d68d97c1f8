# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of the window in the user's language."""

from __future__ import annotations

from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui

from ...core.issues import AmError
from ...objects.fields.shown_units import in_user_units
from .field_names import as_in_panels
from .in_language import in_language, names_first

CONTEXT = "RoboticAM"
FOLDER = Path(__file__).resolve().parents[3] / "resources" / "translations"


def install() -> None:
    """Let FreeCAD find our translations, and use that of its language."""
    Gui.addLanguagePath(str(FOLDER))
    Gui.updateLocale()


def tr(text: str) -> str:
    """The text in the language of FreeCAD's window; itself where no translation is there.

    Called with literals, or what was `marked`, so that a script can collect them; figures are put in afterwards, by
    `format`.
    """
    return str(App.Qt.translate(CONTEXT, text))


def marked(text: str) -> str:
    """The text as it is, for a script to collect: it is translated when it is shown, by `tr` or by FreeCAD."""
    return text


def translated(text: str, user_units: bool = True) -> str:
    """What the core wrote, which knows no language and no panel - a help, a word, a message with figures in it - in that of
    the window, with parameters as its panels call them; itself where no translation is there. user_units: False
    keeps quantities in mm, for files."""
    return as_in_panels(
        in_language(text, tr, in_user_units if user_units else None), translated, tr("“{}”"), True
    )


def translated_error(error: BaseException) -> str:
    """An error with the place it belongs to, in the language of the window."""
    if not isinstance(error, AmError):
        return str(error)
    where = as_in_panels(in_language(error.where, tr), translated, "{}")
    return tr("{}: {}").format(where, translated(error.message))


def error_line(error: AmError) -> str:
    """An error as a line of the report view, with the code that it has in the headless commands."""
    return f"error[{error.code}] {translated_error(error)}\n"


def sentence(text: str) -> str:
    """A text that begins small, such as a finding, as a sentence of its own, in the language of the window. One that begins
    with the name of a part or file keeps that as it is."""
    shown = translated(text)
    return shown if names_first(text) else shown[:1].upper() + shown[1:]
