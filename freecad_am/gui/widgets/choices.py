# SPDX-License-Identifier: LGPL-2.1-or-later
"""Lists that show words for the keys in job files, macros and documents: 'along the wall' for
arc-length, the full name of a machine for its id.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from PySide import QtCore, QtGui

from ...core.kinematics.machines import machine
from ...objects import user_machines
from ..in_language import marked, tr, translated

FEWEST_LETTERS = 8  # minimum width of a list, in letters, for narrow panels
WORDS = {  # labels of keys; `tr` translates them to the window's language
    "part-on-robot": marked("part on robot"),
    "tool-on-robot": marked("tool on robot"),
    "rotary-table": marked("five-axis machine"),
    "tool-on-robot+positioner": marked("tool on the robot, part on a positioner"),
    "arc-length": marked("along the wall"),
    "iso-height": marked("along the axis"),
    "constant-distance": marked("constant distance"),
    "iso-parameter": marked("lines of the surface"),
    "geodesic": marked("through the part, without support"),
    "offset": marked("parallel to its base"),
    "along": marked("normal to a guide curve"),
    "around-axis": marked("around the axis"),
    "symmetry-plane": marked("plane of symmetry"),
    "bead_width": marked("bead width"),
    "layer-by-layer": marked("layer by layer"),
    "point-by-point": marked("point by point"),
    "rz": marked("RZ of the paper"),
    "limits-liegeois": marked("joint limits (Liégeois)"),
    "limits-fournier": marked("joint limits (Fournier)"),
    "limits-klein": marked("joint limits (Klein)"),
    "um": marked("µm"),
    "sharpest": marked("sharpest corner"),
}
SIDES = {
    "front": marked("front"),
    "back": marked("back"),
    "up": marked("up"),
    "down": marked("down"),
    "flip": marked("flip"),
    "noflip": marked("no flip"),
}


def worded(key: str) -> str:
    """Return the label of a choice."""
    sides = key.split("-")
    if len(sides) == 3 and set(sides) <= set(SIDES):
        return ", ".join(tr(SIDES[side]) for side in sides)
    return tr(WORDS[key]) if key in WORDS else translated(key)


def machines() -> list[tuple[str, str]]:
    """Return id and full name of each machine; equal names get their ids appended."""
    entries = machine.known(user_machines.folders())
    names = [name for _, name in entries]
    return [
        (
            machine_id,
            machine_id
            if name.startswith(machine.REFUSED)
            else f"{name} ({machine_id})"
            if names.count(name) > 1
            else name,
        )
        for machine_id, name in entries
    ]


def offer(combo: Any, pairs: Iterable[tuple[str, str]]) -> None:
    """Fill a list with keys and texts; its popup is as wide as the longest entry.

    In an editable list, any part of an entry completes it.
    """
    for key, text in pairs:
        combo.addItem(text, key)
        combo.setItemData(combo.count() - 1, text, QtCore.Qt.ToolTipRole)
    if combo.isEditable():
        combo.completer().setFilterMode(QtCore.Qt.MatchContains)
        combo.completer().setCompletionMode(QtGui.QCompleter.PopupCompletion)
    shrink(combo)
    combo.view().setMinimumWidth(
        combo.view().sizeHintForColumn(0) + combo.view().verticalScrollBar().sizeHint().width()
    )


def entered(combo: Any) -> str:
    """Return the key of an editable list's text, or the text if it is not an entry."""
    text = str(combo.currentText()).strip()
    index = next((row for row in range(combo.count()) if combo.itemText(row) == text), -1)
    return str(combo.itemData(index) or text) if index >= 0 else text


def enter(combo: Any, key: str) -> None:
    """Show a key in an editable list, as words if it has any. The popup then opens at the key."""
    index = combo.findData(key)
    combo.setCurrentIndex(index)
    combo.setEditText(combo.itemText(index) if index >= 0 else key)
    combo.lineEdit().setCursorPosition(0)


def shrink(combo: Any) -> None:
    """Let a list be narrower than its longest text, because panels are narrow."""
    combo.setSizeAdjustPolicy(QtGui.QComboBox.AdjustToMinimumContentsLengthWithIcon)
    combo.setMinimumContentsLength(FEWEST_LETTERS)
