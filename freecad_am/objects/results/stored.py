# SPDX-License-Identifier: LGPL-2.1-or-later
"""The result of a stage, read back from its document object on first use, completely or in parts."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

from ...core.issues import InputError
from . import store


class Stored:
    """Base of stages with a result in their object. A complete result is cached with the key of its
    inputs.
    """

    _kept: tuple[str, Any] | None = None

    def value(self, obj: Any) -> Any:
        """The stored result, read on first use. InputError 'NO_RESULT' without one."""
        return self.reader(obj)()

    def parts(self, obj: Any, *paths: store.Place) -> tuple[Any, ...]:
        """Parts of the stored result, by the field names and indices that lead to them. Errors as
        `value`.
        """
        return tuple(self.reader(obj)(*paths))

    def reader(self, obj: Any) -> Callable[..., Any]:
        """A function that gives the current stored result, or only the given paths, as `value` and
        `parts` do, without the document: for other threads, and for later use. Errors as `value`;
        errors about damage when it reads.
        """
        _check_made(obj)
        cached, key = self._kept, obj.Key
        if cached is not None and cached[0] == key:
            result = cached[1]
            return lambda *paths: _values_at(paths, result)
        stored = store.numbers_of(obj.ResultData), obj.ResultLayout, key, obj.Label

        def read(*paths: store.Place) -> Any:
            cached = self._kept  # another thread may have set it
            if cached is None or cached[0] != key:
                if paths:
                    return store.unpack_parts(*stored, *paths)
                self._kept = cached = key, store.unpack(*stored)
            return _values_at(paths, cached[1])

        return read


def _check_made(obj: Any) -> None:
    if not obj.Key:
        raise InputError("NO_RESULT", obj.Label, "the result is missing; recompute it")


def _values_at(paths: Sequence[store.Place], value: Any) -> Any:
    """The values at paths of a result; the complete result without paths."""
    return tuple(functools.reduce(_step, path, value) for path in paths) if paths else value


def _step(value: Any, step: str | int) -> Any:
    return value[step] if isinstance(step, int) else getattr(value, step)
