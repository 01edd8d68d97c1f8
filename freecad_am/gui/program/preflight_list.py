# SPDX-License-Identifier: LGPL-2.1-or-later
"""The preflight in a panel: every promise with its mark, its worst value and its place, to which a click goes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from PySide import QtCore, QtGui

from ...core.issues import NOTE, Issue
from ...core.preflight.promise import Place, Promise
from ..colours import FAINT, GOOD, INVALID, of
from ..texts.in_language import sentence, tr, translated

HIGH = 16  # lines that are seen at once, about
PLACE_ROLE = QtCore.Qt.UserRole


class PreflightList:
    """A list of promises. go: called with the place of the one that is clicked."""

    def __init__(self, go: Callable[[Place], None]) -> None:
        self.widget = QtGui.QListWidget()
        self.widget.setObjectName("Preflight")
        self.widget.setWordWrap(True)
        self.widget.setResizeMode(QtGui.QListView.Adjust)
        self.widget.setHorizontalScrollBarPolicy(QtCore.Qt.ScrollBarAlwaysOff)
        self.widget.setMinimumHeight(HIGH * self.widget.fontMetrics().lineSpacing())
        help = tr(
            "Checks of this program, how they were made and their worst points; click one to "
            "show it"
        )
        self.widget.setToolTip(help)
        self.widget.setWhatsThis(help)
        self.widget.itemClicked.connect(lambda item: _clicked(item, go))

    def show(self, promises: Sequence[Promise]) -> None:
        """Replace the list by these promises."""
        self.widget.clear()
        for promise in promises:
            self.widget.addItem(_row(promise))

    def clear(self) -> None:
        """Show none."""
        self.widget.clear()


def summary(promises: Sequence[Promise]) -> str:
    """How many promises are kept, broken and not checked."""
    passed, broken = (sum(promise.ok is ok for promise in promises) for ok in (True, False))
    return tr("Preflight: {} passed, {} failed, {} not checked").format(
        passed, broken, len(promises) - passed - broken
    )


def _row(promise: Promise) -> Any:
    """Return an item of two lines: the promise; its figure and position. The tooltip explains the
    check."""
    mark, colour = {True: ("✓", GOOD), False: ("✗", INVALID), None: ("?", FAINT)}[promise.ok]
    further = [translated(promise.figure), "" if promise.place is None else _where(promise.place)]
    item = QtGui.QListWidgetItem(
        "\n".join(
            filter(
                None,
                (
                    f"{mark} {translated(promise.promise)}",
                    "    ".join(["", *filter(None, further)]) if any(further) else "",
                ),
            )
        )
    )
    item.setForeground(QtGui.QBrush(of(colour)))
    item.setToolTip(sentence(promise.how))
    item.setData(PLACE_ROLE, None if promise.place is None else list(promise.place))
    return item


def _where(position: Place) -> str:
    """Format the position as in issues."""
    return translated(Issue(NOTE, "", "", *position).where)


def _clicked(item: Any, go: Callable[[Place], None]) -> None:
    position = item.data(PLACE_ROLE)
    if position is not None:
        go(Place(*position))
