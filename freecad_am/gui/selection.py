# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a tool is meant for: the objects that are selected, and the stages of a selected job."""

from __future__ import annotations

from typing import Any

import FreeCADGui as Gui

from ..objects.job_group import is_group, stages_in
from ..objects.stage import stage_of


def meant(document: str = "") -> list[Any]:
    """The selected objects of a document, by its name, or of the active one. For a job stand its joint paths, then its other
    stages in the order of the tree."""
    found: list[Any] = []
    for obj in Gui.Selection.getSelection(document) if document else Gui.Selection.getSelection():
        found += sorted(stages_in(obj), key=_is_no_joint_path) if is_group(obj) else [obj]
    return found


def _is_no_joint_path(obj: Any) -> bool:
    return str(stage_of(obj).kind) != "joint path"
