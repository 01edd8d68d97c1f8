# SPDX-License-Identifier: LGPL-2.1-or-later
"""Base class of the view providers of all stages. Their class paths are part of the file format."""

from __future__ import annotations

from typing import Any, ClassVar

import FreeCAD as App
from pivy import coin

from ...core.issues import InputError
from ...objects.job_group import is_group
from .. import icons, registry
from ..in_language import error_line

MODE = "Drawing"


class StageView:
    """Draws the stored result of a stage; its icon shows the status."""

    icon: ClassVar[str] = ""
    # view property: FreeCAD type, default (for an enumeration all choices, the default first), help
    options: ClassVar[dict[str, tuple[str, Any, str]]] = {}
    obj: Any = None
    root: Any = None
    drawn = ""

    def __init__(self, vobj: Any) -> None:
        vobj.Proxy = self
        self.complete(vobj)

    def complete(self, vobj: Any) -> None:
        """Add the view properties and choices that the object lacks."""
        have = set(vobj.PropertiesList)
        for name, (type_name, default, help) in self.options.items():
            if name not in have:
                vobj.addProperty(type_name, name, "Drawing", help)
                setattr(vobj, name, list(default) if isinstance(default, tuple) else default)
            elif (
                isinstance(default, tuple)
                and tuple(vobj.getEnumerationsOfProperty(name)) != default
            ):
                old_choice = getattr(vobj, name)  # from a document of an earlier version
                setattr(vobj, name, list(default))
                setattr(vobj, name, old_choice if old_choice in default else default[0])

    # ---- to be defined by a view

    def scene(self, root: Any) -> None:
        """Add the nodes to the root, once."""

    def read(self, obj: Any) -> Any:
        """Return the input of `draw`: the stored result or its drawn part. Raises InputError as
        `Stage.value`.
        """
        return obj.Proxy.value(obj)

    def draw(self, obj: Any, value: Any) -> None:
        """Fill the nodes from the result."""

    def style(self, vobj: Any) -> None:
        """Apply the view properties."""

    def preferences_changed(self) -> None:
        """Apply the current preferences; most views depend on none."""

    def edit(self, obj: Any) -> None:
        """Open the panel or window for a double click."""
        registry.edit(obj)

    # ---- called by FreeCAD

    def attach(self, vobj: Any) -> None:
        """Create the scene; called when the view provider is set, and when a document opens."""
        self.obj = vobj.Object
        self.root, self.switch = coin.SoSeparator(), coin.SoSwitch()
        self.scene(self.root)
        self.switch.addChild(self.root)
        self.stand_back(False)
        vobj.addDisplayMode(self.switch, MODE)

    def stand_back(self, aside: bool) -> None:
        """Draw nothing while a preview replaces the view; the properties stay."""
        self.switch.whichChild = coin.SO_SWITCH_NONE if aside else coin.SO_SWITCH_ALL

    def refresh(self) -> None:
        """Draw the stored result."""
        obj = self.obj
        if obj is None or self.root is None or not getattr(obj, "Key", ""):
            return
        try:
            self.draw(obj, self.read(obj))
            self.drawn = obj.Key
        except InputError as error:
            if (
                not obj.Document.Transacting
            ):  # during undo, the parts of a result are restored one by one
                App.Console.PrintError(error_line(error))
            return
        self.style(obj.ViewObject)

    def updateData(self, obj: Any, name: str) -> None:
        """Handle a changed property of the object."""
        if self.obj is None or obj.Document.Restoring:
            return
        if name in ("Key", "ResultLayout", "ResultData") and obj.Key != self.drawn:
            self.refresh()
        elif name == "Status":
            for target in (obj, *filter(is_group, obj.InList)):
                target.ViewObject.signalChangeIcon()

    def onChanged(self, vobj: Any, name: str) -> None:
        """Handle a changed view property."""
        if (
            name in self.options
            and all(hasattr(vobj, option) for option in self.options)
            and self.root is not None
        ):
            self.style(vobj)

    def getDisplayModes(self, vobj: Any) -> list[str]:
        """Return the only display mode."""
        return [MODE]

    def getDefaultDisplayMode(self) -> str:
        """Return the only display mode."""
        return MODE

    def setDisplayMode(self, mode: str) -> str:
        """Accept the only display mode."""
        return mode

    def getIcon(self) -> str:
        """Return the icon, with a badge for problems."""
        return icons.badge_path(self.icon, getattr(self.obj, "Status", ""))

    def doubleClicked(self, vobj: Any) -> bool:
        """Open the panel."""
        self.edit(vobj.Object)
        return True

    def setupContextMenu(self, vobj: Any, menu: Any) -> None:
        """Add entries to the context menu in the tree."""
        registry.fill_menu_of_stage(menu, vobj.Object)

    def dumps(self) -> None:
        """Store nothing."""

    def loads(self, state: Any) -> None:
        """Restore nothing."""

    __getstate__ = dumps
    __setstate__ = loads
