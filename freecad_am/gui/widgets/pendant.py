# SPDX-License-Identifier: LGPL-2.1-or-later
"""A line to type a pose into as the pendant of a controller shows it; what is typed is entered into the six fields above."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from typing import Any

from PySide import QtGui

from ...core.issues import InputError
from ...objects.fields import pendants
from ..colours import PLAIN, WRONG, set_role
from ..texts.translation import tr, translated


class PendantLine:
    """Pendants to choose from, and the line. `read` and `show` are of the fields above: x y z RX RY RZ in mm and deg."""

    def __init__(
        self,
        name: str,
        read: Callable[[], tuple[Any, ...]],
        show: Callable[[tuple[float, ...]], None],
    ) -> None:
        self.name, self.read, self.show = name, read, show
        self.put = ""  # what the line shows by itself
        self.choice, self.line = QtGui.QComboBox(), QtGui.QLineEdit()
        self.choice.setObjectName(f"{name}Pendant")
        self.line.setObjectName(f"{name}Shown")
        self.choice.addItem(tr("as on the pendant of"), "")
        for controller, pendant in pendants.pendants().items():
            self.choice.addItem(pendant.maker, controller)
        self.choice.setToolTip(
            tr("Type the pose as this controller's pendant shows it, X Y Z in mm first")
        )
        self.line.hide()
        self.choice.currentIndexChanged.connect(lambda *_: self.tell())
        self.line.editingFinished.connect(self.enter)

    def tell(self) -> None:
        """Show in the line what the fields hold, as the chosen pendant would."""
        controller = self.choice.currentData()
        self.line.setVisible(bool(controller))
        self._wrong("")
        if not controller:
            return
        pendant = pendants.pendants()[controller]
        self.line.setPlaceholderText(" ".join(("X", "Y", "Z", *pendant.letters)))
        self.line.clear()
        with contextlib.suppress(
            InputError, TypeError, ValueError
        ):  # a field holds an expression, or nothing
            x, y, z, *angles = self.read()
            numbers = pendants.pendant_values(controller, (x, y, z, *map(math.radians, angles)))
            text = " ".join(
                f"{number + 0.0:.{3 if k < 3 else pendant.digits}f}"
                for k, number in enumerate(numbers)
            )
            self.line.setText(text.replace(".", str(self.line.locale().decimalPoint())))
        self.put = self.line.text()
        self.line.setCursorPosition(0)

    def enter(self) -> None:
        """Enter what was typed into the fields; what cannot be read is told, and they stay."""
        controller = self.choice.currentData()
        if not controller or self.line.text() == self.put or not self.line.text().strip():
            return
        try:
            point = str(self.line.locale().decimalPoint())
            words = self.line.text().replace(point, ".").replace(",", " ").split()
            pose = pendants.six([controller, *words], self.name)
        except InputError as error:
            self._wrong(translated(error.message))
            return
        self._wrong("")
        self.put = self.line.text()
        self.show((*pose[:3], *(round(math.degrees(angle), 10) for angle in pose[3:])))

    def _wrong(self, text: str) -> None:
        self.line.setToolTip(text)
        set_role(self.line, WRONG if text else PLAIN)
