# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adds the workbench to FreeCAD's window. FreeCAD runs this file without `__file__`."""

import FreeCADGui as Gui

from freecad_am.objects import hooks


class RoboticAMWorkbench(Gui.Workbench):
    """Robotic AM: from a part to a checked robot program."""

    MenuText = "Robotic AM"
    ToolTip = "Layers, joint paths and checked programs for robots that deposit material"

    def __init__(self):
        from freecad_am.gui import icons

        self.__class__.Icon = icons.path("workbench")

    def Initialize(self):
        """Called when the workbench is opened for the first time."""
        from freecad_am.gui import commands

        names = commands.register()
        self.appendToolbar("Robotic AM", names)
        self.appendMenu("Robotic AM", names)

    def GetClassName(self):
        """Workbenches written in Python say this."""
        return "Gui::PythonWorkbench"


hooks.register("freecad_am.gui.views")
Gui.addWorkbench(RoboticAMWorkbench())
