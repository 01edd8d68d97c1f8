# SPDX-License-Identifier: LGPL-2.1-or-later
"""Convert memory and kernel failures during a computation to errors with a remedy."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ...brep.kernel.limits import reported
from ...core.issues import InputError


@contextmanager
def memory(label: str) -> Iterator[None]:
    """Within the context, convert MemoryError to InputError NO_MEMORY, naming `label`."""
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
    """Within the context, convert kernel faults to InputError BAD_SHAPE, naming the source."""
    source = getattr(obj, "Source", None)
    origin = source[0] if source else obj
    with reported(str(origin.Label), getattr(origin, "Shape", None)):
        yield
