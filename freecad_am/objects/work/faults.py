# SPDX-License-Identifier: LGPL-2.1-or-later
"""Failures of the computer while a stage is computed, as errors with a remedy."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ...brep.kernel.limits import reported
from ...core.issues import InputError


@contextmanager
def memory(label: str) -> Iterator[None]:
    """A lack of memory within, as an InputError NO_MEMORY that names `label`."""
    try:
        yield
    except MemoryError:
        raise InputError(
            "NO_MEMORY",
            label,
            "the computation needs more memory than available; use larger steps, such as layer "
            "height and chord error, or a smaller part",
        ) from None


@contextmanager
def kernel(obj: Any) -> Iterator[None]:
    """Faults of the geometry kernel within, as an InputError BAD_SHAPE that names what the stage `obj` is made from."""
    source = getattr(obj, "Source", None)
    origin = source[0] if source else obj
    with reported(str(origin.Label), getattr(origin, "Shape", None)):
        yield
