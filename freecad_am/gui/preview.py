# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel's entries would make, computed beside the document, and shown in its 3D views until it is taken away."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import FreeCADGui as Gui

from ..objects.stage import Outcome, Stage
from .lines import Array
from .wall_nodes import WallNodes

NAME = "RoboticAM_Preview"
_VIEW = "Gui::View3DInventor"


def outcome(proxy: type[Stage], document: Any, label: str, links: dict[str, Any], values: dict[str, Any]) -> Outcome:
    """What a stage would compute from all its links and outer values by property name; the document is only read.

    Raises what the stage raises, naming `label` where the object's Label would stand.
    """
    draft = SimpleNamespace(Label=label, Name=label, Document=document, **values, **links)
    return proxy.compute(proxy.__new__(proxy), draft)


class WallPreview:
    """A wall drawn in the 3D views of a document, which keeps nothing of it."""

    def __init__(self, document: Any) -> None:
        self.nodes = WallNodes(pickable=False)
        self.nodes.switch.setName(NAME)
        self.scenes = [view.getSceneGraph() for view in Gui.getDocument(document.Name).mdiViewsOfType(_VIEW)]
        for scene in self.scenes:
            scene.addChild(self.nodes.switch)

    def show(self, source: Any, faces: Sequence[str], first: Sequence[Array]) -> None:
        """Draw the faces of a source, and first layers."""
        self.nodes.set_first(first)
        if source is None:
            self.nodes.faces.show(False)
        else:
            self.nodes.set_faces(source, faces)
            self.nodes.faces.show(True)

    def remove(self) -> None:
        """Take it out of the views; once or more often."""
        for scene in self.scenes:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view is closed
                scene.removeChild(self.nodes.switch)
        self.scenes = []
