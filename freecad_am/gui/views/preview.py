# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel's entries would make, computed beside the document, and shown in its 3D views until it is taken away."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, TypeVar

import FreeCADGui as Gui

from ...objects.stage import Stage
from ...objects.stage_parts import Work
from ...objects.work import faults

NAME = "RoboticAM_Preview"
_VIEW = "Gui::View3DInventor"
T = TypeVar("T")


class Draft:
    """A stage that is not in the document, which is only read: all links and outer values by property name.

    Errors name `label` where the object's Label would stand.
    """

    def __init__(
        self,
        proxy: type[Stage],
        document: Any,
        label: str,
        links: dict[str, Any],
        values: dict[str, Any],
    ) -> None:
        self.stage = proxy.__new__(proxy)
        self.obj = SimpleNamespace(Label=label, Name=label, Document=document, **values, **links)

    def check(self) -> None:
        """Raises InputError for a parameter that the stage refuses."""
        for section in self.stage.sections:
            self.stage.parameters(self.obj, section.cls)

    def prepare(self) -> Work:
        """The work that computes what the stage would, without the document. Raises what it raises, as does the work."""
        return self.stage.prepare(self.obj)

    def reporting(self, work: Callable[[], T]) -> Callable[[], T]:
        """Work of a preview that tells a lack of memory and faults of the geometry kernel as the stage itself does."""

        def run_guarded() -> T:
            with faults.kernel(self.obj), faults.memory(self.obj.Label):
                return work()

        return run_guarded


class Preview:
    """Nodes in the 3D views of a document, which keeps nothing of them."""

    def __init__(self, document: Any, node: Any) -> None:
        self.node = node
        self.node.setName(NAME)
        self.scenes = [
            view.getSceneGraph() for view in Gui.getDocument(document.Name).mdiViewsOfType(_VIEW)
        ]
        for scene in self.scenes:
            scene.addChild(node)

    def remove(self) -> None:
        """Take it out of the views; once or more often."""
        for scene in self.scenes:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view is closed
                scene.removeChild(self.node)
        self.scenes = []


class Aside:
    """What stages themselves draw, which stands back while a preview stands for it."""

    def __init__(self) -> None:
        self.objects: list[Any] = []

    def put(self, *objects: Any) -> None:
        """Let these stand back, in place of those before; None is none."""
        new_objects = [obj for obj in objects if obj is not None]
        self._stand_back(
            False,
            [
                obj
                for obj in self.objects
                if not any(obj is new_object for new_object in new_objects)
            ],
        )
        self._stand_back(True, new_objects)
        self.objects = new_objects

    def _stand_back(self, aside: bool, objects: list[Any]) -> None:
        for obj in objects:
            with contextlib.suppress(RuntimeError, ReferenceError, AttributeError):  # it is gone
                obj.ViewObject.Proxy.stand_back(aside)
