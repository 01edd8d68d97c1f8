# SPDX-License-Identifier: LGPL-2.1-or-later
"""Adds the workbench to FreeCAD's window. FreeCAD runs this file without `__file__`."""

import FreeCADGui as Gui

from freecad_am.gui import former_names, in_language
from freecad_am.objects.work import hooks

former_names.install()
in_language.install()


class RoboticAMWorkbench(Gui.Workbench):
    """Robotic AM: from a part to a checked robot program."""

    MenuText = "Robotic AM"

    def __init__(self):
        from freecad_am.gui import icons
        from freecad_am.gui.in_language import tr

        self.__class__.ToolTip = tr(
            "Layers, joint paths and checked programs for robots that deposit material"
        )
        self.__class__.Icon = icons.path("workbench")

    def Initialize(self):
        """Called when the workbench is opened for the first time."""
        from freecad_am.gui.tools import commands, whats_this

        names = commands.register()
        whats_this.install()
        self.appendToolbar("Robotic AM", names)
        self.appendMenu("Robotic AM", [*names, "Separator", whats_this.NAME])

    def Activated(self):
        """Called when the workbench is chosen: its menu shows the tooltips, which say why a tool is greyed, and its toolbar
        all tools."""
        from freecad_am.gui.tools import tool

        tool.show_tooltips(self.MenuText)
        tool.keep_whole(self.MenuText)

    def ContextMenu(self, recipient):
        """Called for a right click in the tree or the 3D view."""
        from freecad_am.gui.tools import tool

        names = tool.for_selection()
        if names:
            self.appendContextMenu("", names)

    def GetClassName(self):
        """Workbenches written in Python say this."""
        return "Gui::PythonWorkbench"


def robotic_am_preferences():
    """Add the page of preferences, which are there before the workbench is opened."""
    from freecad_am.gui import icons
    from freecad_am.gui.preferences_page import RoboticAMPreferences

    Gui.addIconPath(icons.FOLDER)
    Gui.addPreferencePage(RoboticAMPreferences, "Robotic AM")


hooks.register("freecad_am.gui.views.attach")
robotic_am_preferences()
Gui.addWorkbench(RoboticAMWorkbench())
