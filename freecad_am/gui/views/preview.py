# SPDX-License-Identifier: LGPL-2.1-or-later
"""Preview a panel's entries: computed outside the document and shown in its 3D views until removed."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, TypeVar

import FreeCADGui as Gui

from ...objects.stage import Stage
from ...objects.stage_parts import Work
from ...objects.work import progress

NAME = "RoboticAM_Preview"
_VIEW = "Gui::View3DInventor"
T = TypeVar("T")


class Draft:
    """A read-only stage outside the document: all links and outer values by property name.

    Errors name `label` instead of the object's Label.
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
        """Raise InputError for a parameter that the stage rejects."""
        for section in self.stage.sections:
            self.stage.parameters(self.obj, section.cls)

    def prepare(self) -> Work:
        """Return a function that computes the stage's result without the document. Both raise the
        stage's errors.
        """
        return self.stage.prepare(self.obj)

    def reporting(self, work: Callable[[], T]) -> Callable[[], T]:
        """Wrap a preview's work to report lack of memory and kernel faults as the stage does."""

        def run_guarded() -> T:
            with progress.kernel_faults(self.obj), progress.memory_faults(self.obj.Label):
                return work()

        return run_guarded


class Preview:
    """Nodes in the 3D views of a document, which does not store them."""

    def __init__(self, document: Any, node: Any) -> None:
        self.node = node
        self.node.setName(NAME)
        self.scenes = [
            view.getSceneGraph() for view in Gui.getDocument(document.Name).mdiViewsOfType(_VIEW)
        ]
        for scene in self.scenes:
            scene.addChild(node)

    def remove(self) -> None:
        """Remove the preview from the views; may be called repeatedly."""
        for scene in self.scenes:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view is closed
                scene.removeChild(self.node)
        self.scenes = []


class Aside:
    """Hides the drawings of stages that a preview replaces."""

    def __init__(self) -> None:
        self.objects: list[Any] = []

    def put(self, *objects: Any) -> None:
        """Hide these objects instead of the previous objects; ignore None."""
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
            with contextlib.suppress(RuntimeError, ReferenceError, AttributeError):  # deleted
                obj.ViewObject.Proxy.stand_back(aside)
