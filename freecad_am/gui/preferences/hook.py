# SPDX-License-Identifier: LGPL-2.1-or-later
"""What FreeCAD knows of the page of preferences when it starts: little, so that it starts as fast as without."""

from __future__ import annotations

from typing import Any


class RoboticAMPreferences:
    """Makes the page when FreeCAD's dialog is opened."""

    def __init__(self, *_: Any) -> None:
        from .page import PreferencesPage

        self.page = PreferencesPage()
        self.form = self.page.form

    def loadSettings(self) -> None:
        """Show what is kept; called by FreeCAD."""
        self.page.loadSettings()

    def saveSettings(self) -> None:
        """Keep what is shown; called by FreeCAD."""
        self.page.saveSettings()
