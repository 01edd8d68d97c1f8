# SPDX-License-Identifier: LGPL-2.1-or-later
"""The document of a job: created empty and saved at the end."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ...core.issues import InputError
from .job import Job

MAX_DEFLATED_BYTES = 4_000_000  # bytes of results, beyond which they are not deflated once more
_LEVEL_PREFERENCE = "CompressionLevel"


def new_document(job: Job) -> Any:
    """Create an empty document for a job."""
    import FreeCAD

    document = FreeCAD.newDocument("Job")
    document.Label, document.UndoMode = job.name, 0
    return document


def save(document: Any, path: str) -> None:
    """Save the document to a file. Raises InputError UNWRITABLE."""
    try:
        with _disable_deflating(document):
            document.saveAs(path)
    except (OSError, RuntimeError) as error:
        raise InputError(
            "UNWRITABLE", path, "the document cannot be saved ({}); free disk space", error
        ) from None
    if not os.path.isfile(path):
        raise InputError("UNWRITABLE", path, "the document cannot be saved; free disk space")


@contextmanager
def _disable_deflating(document: Any) -> Iterator[None]:
    """Save a document with large results without compression.

    Results are compressed already. Compressing again takes 50 ns a byte and saves a twentieth. The
    user's setting is restored.
    """
    results = sum(
        thing.MemSize for thing in document.Objects if thing.isDerivedFrom("App::FeaturePython")
    )
    if results < max(MAX_DEFLATED_BYTES, 0.5 * document.MemSize):
        yield
        return
    import FreeCAD

    settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Document")
    old_level = settings.GetInt(_LEVEL_PREFERENCE, -1)
    settings.SetInt(_LEVEL_PREFERENCE, 0)
    try:
        yield
    finally:
        if old_level < 0:
            settings.RemInt(_LEVEL_PREFERENCE)
        else:
            settings.SetInt(_LEVEL_PREFERENCE, old_level)
