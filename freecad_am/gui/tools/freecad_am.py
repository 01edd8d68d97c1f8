# SPDX-License-Identifier: LGPL-2.1-or-later
"""Add commands to FreeCAD under the module name `freecad_am`.

FreeCAD stores the file name of the script that adds a command, and writes `import NAME` into every
macro that uses the command. This file therefore has the name of the package, which a macro can
import with and without a window.
"""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui


def add_command(name: str, command: Any) -> None:
    """Add a command to FreeCAD under its full name."""
    Gui.addCommand(name, command)
