# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a panel's entries would make, computed beside the document, and shown in its 3D views until it is taken away."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, TypeVar

import FreeCADGui as Gui
from pivy import coin

from ..objects import faults
from ..objects.stage import Stage, Work

NAME = "RoboticAM_Preview"
_VIEW = "Gui::View3DInventor"
T = TypeVar("T")


class Draft:
    """A stage that is not in the document, which is only read: all links and outer values by property name.

    Errors name `label` where the object's Label would stand.
    """

    def __init__(
        self, proxy: type[Stage], document: Any, label: str, links: dict[str, Any], values: dict[str, Any]
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

    def told(self, work: Callable[[], T]) -> Callable[[], T]:
        """Work of a preview that tells a lack of memory and faults of the geometry kernel as the stage itself does."""

        def within() -> T:
            with faults.kernel(self.obj), faults.memory(self.obj.Label):
                return work()

        return within


class Preview:
    """Nodes in the 3D views of a document, which keeps nothing of them."""

    def __init__(self, document: Any, node: Any) -> None:
        self.node = node
        self.node.setName(NAME)
        self.scenes = [view.getSceneGraph() for view in Gui.getDocument(document.Name).mdiViewsOfType(_VIEW)]
        for scene in self.scenes:
            scene.addChild(node)

    def remove(self) -> None:
        """Take it out of the views; once or more often."""
        for scene in self.scenes:
            with contextlib.suppress(RuntimeError, ReferenceError):  # the view is closed
                scene.removeChild(self.node)
        self.scenes = []


class Aside:
    """What objects themselves draw, switched off while a preview stands for it; their properties stay as they are."""

    def __init__(self) -> None:
        self.drawn: dict[str, tuple[Any, int]] = {}

    def put(self, *objects: Any) -> None:
        """Switch off what these draw, in place of those before."""
        wanted = {obj.Name: obj for obj in objects if obj is not None}
        self.take_back(*(name for name in self.drawn if name not in wanted))
        for name, obj in wanted.items():
            switch = obj.ViewObject.SwitchNode
            which = int(switch.whichChild.getValue())
            if which != coin.SO_SWITCH_NONE:
                self.drawn[name] = obj, which
                switch.whichChild = coin.SO_SWITCH_NONE

    def take_back(self, *names: str) -> None:
        """Switch on again what these draw, all where none are named; not what has been hidden meanwhile, or is gone."""
        for name in names or tuple(self.drawn):
            obj, which = self.drawn.pop(name)
            with contextlib.suppress(RuntimeError, ReferenceError, AttributeError):
                switch = obj.ViewObject.SwitchNode
                if obj.ViewObject.Visibility and switch.whichChild.getValue() == coin.SO_SWITCH_NONE:
                    switch.whichChild = which
