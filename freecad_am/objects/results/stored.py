# SPDX-License-Identifier: LGPL-2.1-or-later
"""The result of a stage, read back from its document object when it is first asked for; all of it, or parts alone."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

from ...core.issues import InputError
from . import store


class Stored:
    """What has a result in its object. It is kept once all of it was read, with the key of the inputs it is of."""

    _kept: tuple[str, Any] | None = None

    def value(self, obj: Any) -> Any:
        """The stored result, read when first asked for. InputError 'NO_RESULT' when there is none."""
        return self.reader(obj)()

    def picked(self, obj: Any, *places: store.Place) -> tuple[Any, ...]:
        """Values within the stored result, by the field names and indices that lead to them, when not all of it is needed.
        Errors as `value`."""
        return tuple(self.reader(obj)(*places))

    def reader(self, obj: Any) -> Callable[..., Any]:
        """What gives the stored result of now, or given places these alone, as `value` and `picked` do, without the
        document: for other threads, and for when more of it may be needed. Errors as `value`, those of what is damaged when
        it reads.
        """
        _check_made(obj)
        kept, key = self._kept, obj.Key
        if kept is not None and kept[0] == key:
            whole = kept[1]
            return lambda *places: _at(places, whole)
        stored = store.numbers_of(obj.ResultData), obj.ResultLayout, key, obj.Label

        def read(*places: store.Place) -> Any:
            kept = self._kept  # which another thread may have put there
            if kept is None or kept[0] != key:
                if places:
                    return store.picked(*stored, *places)
                self._kept = kept = key, store.unpack(*stored)
            return _at(places, kept[1])

        return read


def _check_made(obj: Any) -> None:
    if not obj.Key:
        raise InputError("NO_RESULT", obj.Label, "there is no result yet; recompute it")


def _at(places: Sequence[store.Place], value: Any) -> Any:
    """What is at places of a result, all of it without any."""
    return tuple(functools.reduce(_step, place, value) for place in places) if places else value


def _step(value: Any, step: str | int) -> Any:
    return value[step] if isinstance(step, int) else getattr(value, step)
