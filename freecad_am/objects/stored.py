# SPDX-License-Identifier: LGPL-2.1-or-later
"""The result of a stage, read back from its document object when it is first asked for; all of it, or parts alone."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from typing import Any

from ..core.issues import InputError
from . import store


class Stored:
    """What has a result in its object. It is kept once all of it was read, with the key of the inputs it is of."""

    _kept: tuple[str, Any] | None = None

    def value(self, obj: Any) -> Any:
        """The stored result, read when first asked for. InputError 'NO_RESULT' when there is none."""
        _check_made(obj)
        kept, key = self._kept, obj.Key  # a reader in another thread may put another one there
        if kept is None or kept[0] != key:
            self._kept = kept = key, store.unpack(store.numbers_of(obj.ResultData), obj.ResultLayout, key, obj.Label)
        return kept[1]

    def reader(self, obj: Any) -> Callable[[], Any]:
        """What gives the stored result without the document, of which all is read now: for other threads. Errors as
        `value`."""
        return self.partly(obj)[1]

    def picked(self, obj: Any, *places: store.Place) -> tuple[Any, ...]:
        """Values within the stored result, by the field names and indices that lead to them, when not all of it is needed.
        Errors as `value`."""
        return self.partly(obj, *places)[0]

    def partly(self, obj: Any, *places: store.Place) -> tuple[tuple[Any, ...], Callable[..., Any]]:
        """`picked`, and a `reader` of the same result for when more of it is needed: all of it, or given places these alone,
        as `picked` has them."""
        _check_made(obj)
        kept, key = self._kept, obj.Key
        if kept is not None and kept[0] == key:
            whole = kept[1]
            return _picked(whole, places), lambda *more: _picked(whole, more) if more else whole
        stored = store.numbers_of(obj.ResultData), obj.ResultLayout, key, obj.Label

        def read(*more: store.Place) -> Any:
            kept = self._kept
            if kept is None or kept[0] != key:
                if more:
                    return store.picked(*stored, *more)
                self._kept = kept = key, store.unpack(*stored)
            return _picked(kept[1], more) if more else kept[1]

        return store.picked(*stored, *places), read


def _check_made(obj: Any) -> None:
    if not obj.Key:
        raise InputError("NO_RESULT", obj.Label, "there is no result yet; recompute it")


def _picked(value: Any, places: Sequence[store.Place]) -> tuple[Any, ...]:
    """What is at places of a result."""
    return tuple(functools.reduce(_step, place, value) for place in places)


def _step(value: Any, step: str | int) -> Any:
    return value[step] if isinstance(step, int) else getattr(value, step)
