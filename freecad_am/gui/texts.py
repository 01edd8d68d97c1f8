# SPDX-License-Identifier: LGPL-2.1-or-later
"""Texts of the window in the user's language."""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui

from ..core.issues import AmError
from .phrases import Phrases

CONTEXT = "RoboticAM"
KINDS = ("cell", "feature", "toolpath", "program", "inspection")  # stages, as messages call them
FOLDER = Path(__file__).resolve().parents[2] / "resources" / "translations"


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


def translated(text: str) -> str:
    """What the core wrote, which knows no language - a help, a word, a message with figures in it - in that of the window;
    itself where no translation is there."""
    if tr("en") == "en":  # each translation says its own code
        return text
    return _translated(text, tr("en"))


def translated_error(error: BaseException) -> str:
    """An error with the place it belongs to, in the language of the window."""
    if not isinstance(error, AmError):
        return str(error)
    return tr("{}: {}").format(translated(error.where), translated(error.message))


def error_line(error: AmError) -> str:
    """An error as a line of the report view, with the code that it has in the headless commands."""
    return f"error[{error.code}] {translated_error(error)}\n"


def sentence(text: str) -> str:
    """A text that begins small, such as a finding, as a sentence of its own, in the language of the window."""
    told = translated(text)
    return told[:1].upper() + told[1:]


@lru_cache(maxsize=4096)
def _translated(text: str, language: str) -> str:
    return _phrases().translated(text, tr)


@lru_cache(maxsize=1)
def _phrases() -> Phrases:
    return Phrases(json.loads((FOLDER / "messages.json").read_text(encoding="utf-8")), KINDS)
