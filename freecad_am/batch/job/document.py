# SPDX-License-Identifier: LGPL-2.1-or-later
"""The document of a job: made empty, saved at the end."""

from __future__ import annotations

import os
from typing import Any

from freecad_am.core.issues import InputError

from .job import Job


def made(job: Job) -> Any:
    """An empty document for a job."""
    import FreeCAD

    document = FreeCAD.newDocument("Job")
    document.Label, document.UndoMode = job.name, 0
    return document


def save(document: Any, path: str) -> None:
    """Save it into a file. Raises InputError UNWRITABLE."""
    try:
        document.saveAs(path)
    except (OSError, RuntimeError) as error:
        raise InputError("UNWRITABLE", path, "the document cannot be saved ({}); free the disk", error) from None
    if not os.path.isfile(path):
        raise InputError("UNWRITABLE", path, "the document cannot be saved; free the disk")
