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
        """Show these, in place of those before."""
        self.widget.clear()
        for one in promises:
            self.widget.addItem(_row(one))

    def clear(self) -> None:
        """Show none."""
        self.widget.clear()


def summary(promises: Sequence[Promise]) -> str:
    """How many promises are kept, broken and not checked."""
    kept, broken = (sum(one.ok is ok for one in promises) for ok in (True, False))
    return tr("Preflight: {} passed, {} failed, {} not checked").format(
        kept, broken, len(promises) - kept - broken
    )


def _row(one: Promise) -> Any:
    """Two lines: what is promised, and how far it is kept and where. How it was checked is the tip."""
    mark, colour = {True: ("✓", GOOD), False: ("✗", INVALID), None: ("?", FAINT)}[one.ok]
    further = [translated(one.figure), "" if one.place is None else _where(one.place)]
    item = QtGui.QListWidgetItem(
        "\n".join(
            filter(
                None,
                (
                    f"{mark} {translated(one.promise)}",
                    "    ".join(["", *filter(None, further)]) if any(further) else "",
                ),
            )
        )
    )
    item.setForeground(QtGui.QBrush(of(colour)))
    item.setToolTip(sentence(one.how))
    item.setData(PLACE_ROLE, None if one.place is None else list(one.place))
    return item


def _where(place: Place) -> str:
    """The place as findings tell it."""
    return translated(Issue(NOTE, "", "", *place).where)


def _clicked(item: Any, go: Callable[[Place], None]) -> None:
    place = item.data(PLACE_ROLE)
    if place is not None:
        go(Place(*place))
