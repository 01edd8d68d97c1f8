# SPDX-License-Identifier: LGPL-2.1-or-later
"""The document of a job: made empty, saved at the end."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from freecad_am.core.issues import InputError

from .job import Job

LARGE = 4_000_000  # bytes of results, beyond which they are not deflated once more
_LEVEL = "CompressionLevel"


def made(job: Job) -> Any:
    """An empty document for a job."""
    import FreeCAD

    document = FreeCAD.newDocument("Job")
    document.Label, document.UndoMode = job.name, 0
    return document


def save(document: Any, path: str) -> None:
    """Save it into a file. Raises InputError UNWRITABLE."""
    try:
        with _without_deflating(document):
            document.saveAs(path)
    except (OSError, RuntimeError) as error:
        raise InputError(
            "UNWRITABLE", path, "the document cannot be saved ({}); free the disk", error
        ) from None
    if not os.path.isfile(path):
        raise InputError("UNWRITABLE", path, "the document cannot be saved; free the disk")


@contextmanager
def _without_deflating(document: Any) -> Iterator[None]:
    """While a document of large results is saved FreeCAD leaves its parts as they are: results are packed already, and to
    pack them once more takes 50 ns a byte for a twentieth of them. The user's own choice comes back."""
    results = sum(
        thing.MemSize for thing in document.Objects if thing.isDerivedFrom("App::FeaturePython")
    )
    if results < max(LARGE, 0.5 * document.MemSize):
        yield
        return
    import FreeCAD

    chosen = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Document")
    before = chosen.GetInt(_LEVEL, -1)
    chosen.SetInt(_LEVEL, 0)
    try:
        yield
    finally:
        if before < 0:
            chosen.RemInt(_LEVEL)
        else:
            chosen.SetInt(_LEVEL, before)
