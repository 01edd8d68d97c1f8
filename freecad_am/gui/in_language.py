# SPDX-License-Identifier: LGPL-2.1-or-later
"""Translate texts of the core: translate their templates and insert their values."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import FreeCAD as App
import FreeCADGui as Gui

from ..core.families.registry import FAMILIES
from ..core.issues import AmError, Text
from ..core.kinematics.links.contact import BASE, DEPOSIT, NOZZLE, OWN_PREFIX, PART, PLATFORM, TORCH
from ..core.number_texts import is_example, put_values
from ..core.parameters.build_direction import BuildDirectionParameters
from ..core.parameters.cell import CellParameters
from ..core.parameters.inspection import InspectionParameters
from ..core.parameters.joints import JointParameters
from ..core.parameters.process import ProcessParameters
from ..core.parameters.program import ProgramParameters
from ..objects.fields.preferences import in_user_units
from ..objects.fields.rows import group_of, rows

_SECTIONS = (
    ("cell", CellParameters),
    *(("strategy", family.parameters) for family in FAMILIES),
    ("build_direction", BuildDirectionParameters),
    ("process", ProcessParameters),
    ("joints", JointParameters),
    ("program", ProgramParameters),
    ("inspection", InspectionParameters),
)
# panel with the fields of a section, named after its stage or tool
_PANELS = {
    "cell": "Cell",
    "strategy": "Feature",
    "build_direction": "Feature",
    "process": "Toolpath",
    "joints": "Joint path",
    "program": "Program",
    "inspection": "Inspection",
}
_LINE = r"((?:[a-z_]+\.)*[a-z_]+): ([A-Za-z0-9+_-]+)"  # line of a job file
_QUOTED, _BARE = re.compile(f"`{_LINE}`"), re.compile(rf"(?<![\w./\\`-]){_LINE}(?!`)")
_KEY = re.compile(
    rf"(?<![\w./\\-])(?:{'|'.join(sorted({section for section, _ in _SECTIONS}))})(?:\.[a-z_]+)+(?![\w/\\-])"
)


@lru_cache(maxsize=1)
def _known() -> dict[str, tuple[str, str]]:
    """Return group within the panel ('' for none) and label of each parameter by its job file name.

    Also covers groups, and ranges, which have two fields.
    """
    labels: dict[str, tuple[str, str]] = {}
    for section, cls in _SECTIONS:
        for row in rows(cls):
            steps = [step for step in row.path if isinstance(step, str)]
            if len(steps) < len(row.path):
                labels.setdefault(".".join([section, *steps]), ("", group_of(row)))
            else:
                nested = len(steps) > 1
                labels.setdefault(
                    ".".join([section, *steps]), (group_of(row) if nested else "", row.label)
                )
                if nested:
                    labels.setdefault(f"{section}.{steps[0]}", ("", group_of(row)))
    return labels


@lru_cache(maxsize=1)
def _choices() -> dict[str, set[str]]:
    """Return the choices of each parameter, in any family, by its name in job files."""
    choices: dict[str, set[str]] = {}
    for section, cls in _SECTIONS:
        for row in rows(cls):
            name = ".".join([section, *(step for step in row.path if isinstance(step, str))])
            choices.setdefault(name, set()).update(row.spec.choices, row.spec.words)
    return choices


@lru_cache(maxsize=1)
def _short_names() -> dict[str, str]:
    """Map the last part of a parameter name to the full name, if no other section has this last
    part.
    """
    full_names: dict[str, list[str]] = {}
    for name in _known():
        full_names.setdefault(name.rpartition(".")[2], []).append(name)
    return {
        short: names[0]
        for short, names in full_names.items()
        if len({name.partition(".")[0] for name in names}) == 1 and names[0].count(".") == 1
    }


def as_in_panels(
    text: str, translate: Callable[[str], str], quoted: str = "“{}”", with_panel: bool = False
) -> str:
    """Replace parameter names in a message by their translated names in panels.

    “Bead width” replaces process.bead_width, and “Motion: joint” replaces motion: joint, with or
    without backticks. with_panel: append the panel, “Bead width” (Toolpath).
    """

    def quote_field(name: str, value: str = "") -> str:
        group, label = _known()[name]
        field_label = translate(label)
        field = f"{translate(group)}, {field_label.lower()}" if group else field_label
        panel = f" ({translate(_PANELS[name.partition('.')[0]])})" if with_panel else ""
        return quoted.format(f"{field}: {translate(value)}" if value else field) + panel

    def named(match: re.Match[str]) -> str:
        return quote_field(match[0]) if _known().get(match[0], ("", ""))[1] else match[0]

    def paired(match: re.Match[str]) -> str:
        name = match[1] if match[1] in _known() else _short_names().get(match[1])
        return match[0] if name is None else quote_field(name, match[2])

    def paired_bare(match: re.Match[str]) -> str:
        name = match[1] if match[1] in _known() else _short_names().get(match[1], "")
        return paired(match) if match[2] in _choices().get(name, ()) else match[0]

    return _KEY.sub(named, _BARE.sub(paired_bare, _QUOTED.sub(paired, text)))


KINDS = ("cell", "feature", "toolpath", "program", "inspection")  # stages, as messages call them


def in_language(
    text: str, translate: Callable[[str], str], in_units: Callable[[str], str] | None = None
) -> str:
    """Translate a text and convert its units.

    Parameters
    ----------
    text : str
        The text.
    translate : callable
        Returns the translation of a template, or the template without one.
    in_units : callable, optional
        Converts the quantities in a text of numbers to other units; None keeps them.

    Returns
    -------
    str
        The translation. Values are inserted as written; our own texts among them are also translated.
        Names stay unchanged.
    """
    template = (
        text.template if isinstance(text, Text) else text.replace("{", "{{").replace("}", "}}")
    )
    key = template.strip()
    if not key:
        return text
    values = (
        [_value(value, translate, in_units) for value in text.values]
        if isinstance(text, Text)
        else []
    )
    translation = template.replace(key, translate(key), 1)
    if in_units is None or is_example(key):
        return translation.format(*values)
    return put_values(translation, values, in_units)


def _value(
    value: str, translate: Callable[[str], str], in_units: Callable[[str], str] | None
) -> str:
    """Return a value for a text: our texts translated, names and numbers unchanged."""
    if isinstance(value, Text):
        return in_language(value, translate, in_units)
    return in_language(value, translate) if " " in value or value in KINDS else value


def names_first(text: str) -> bool:
    """Whether a text begins with the name of a part or a file, which is written as it is."""
    if not isinstance(text, Text) or not text.template.startswith("{0}"):
        return False
    first_value = text.values[0]
    return names_first(first_value) if isinstance(first_value, Text) else first_value not in KINDS


CONTEXT = "RoboticAM"
FOLDER = Path(__file__).resolve().parents[2] / "resources" / "translations"


def install() -> None:
    """Register our translations in FreeCAD and load the translation of its language."""
    Gui.addLanguagePath(str(FOLDER))
    Gui.updateLocale()


def tr(text: str) -> str:
    """Return the text in the language of FreeCAD's window, or unchanged without a translation.

    Call it with literals or `marked` texts, so that a script can collect them; insert values
    afterwards with `format`.
    """
    return str(App.Qt.translate(CONTEXT, text))


def marked(text: str) -> str:
    """Return the text unchanged. Marks it for the translation script; `tr` or FreeCAD translates it
    on display.
    """
    return text


def translated(text: str, user_units: bool = True) -> str:
    """Translate a text of the core to the window's language, with panel names of parameters.

    The text is a help, word or message with values; it is unchanged without a translation.
    user_units: False keeps quantities in mm, for files.
    """
    return as_in_panels(
        in_language(text, tr, in_user_units if user_units else None), translated, tr("“{}”"), True
    )


def translated_error(error: BaseException) -> str:
    """Format an error with its location, in the window's language."""
    if not isinstance(error, AmError):
        return str(error)
    where = as_in_panels(in_language(error.where, tr), translated, "{}")
    return tr("{}: {}").format(where, translated(error.message))


def error_line(error: AmError) -> str:
    """Format an error as a line of the report view, with its code from the headless commands."""
    return f"error[{error.code}] {translated_error(error)}\n"


def sentence(text: str) -> str:
    """Translate a text to the window's language and capitalise it as a sentence.

    A leading name of a part or file stays unchanged.
    """
    translation = translated(text)
    return translation if names_first(text) else translation[:1].upper() + translation[1:]


def link_touches(link: str, what: str) -> str:
    """Return the message that a robot link touches an object.

    link: as in `ArmContact.links`. what: as in `ArmContact.names`; an obstacle has its own name.
    """
    names = {
        NOZZLE: tr("the nozzle"),
        PLATFORM: tr("the platform"),
        DEPOSIT: tr("the deposit"),
        TORCH: tr("the torch"),
    }
    names[BASE] = tr("the base")
    if what.startswith(OWN_PREFIX):
        names[what] = tr("the link of {axis}").format(axis=what[len(OWN_PREFIX) :])
    if " " in link:  # a link of positioner or track, with its own name
        return tr("{link} touches {what}").format(link=link, what=names.get(what, what))
    if link == BASE:
        return tr("the base touches {what}").format(what=names.get(what, what))
    if link == PART:
        return tr("the part touches {what}").format(what=names.get(what, what))
    if link == NOZZLE:
        return tr("the nozzle touches {what}").format(what=names.get(what, what))
    if link == TORCH:
        return tr("the torch touches {what}").format(what=names.get(what, what))
    return tr("the link of {axis} touches {what}").format(axis=link, what=names.get(what, what))


# ---- Labels of objects as texts of the window


def escape_mnemonic(label: str) -> str:
    """Escape `&` in a label for a menu, title, tab or button, where Qt uses it to mark a key."""
    return label.replace("&", "&&")
