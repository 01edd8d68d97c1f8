# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a command puts off until it is needed, if it ever is: starting is a third of the time of a small job.

Python compiles six functions for each dataclass, of two hundred of which a job makes a fraction, and scipy's trees come with
its sparse solvers and rotations. Nothing here changes what anything does.
"""

from __future__ import annotations

import dataclasses
import importlib.abc
import importlib.machinery
import importlib.util
import inspect
import sys
from collections.abc import Sequence
from typing import Any

# packages of scipy that others of it name in passing
UNUSED = ("scipy.sparse.csgraph", "scipy.spatial.transform")
_KNOWN = ("name", "args", "body", "globals", "locals", "return_type")  # up to Python 3.12


def functions_of_dataclasses() -> None:
    """From now on functions of dataclasses are compiled when they are first called; nothing where Python makes them in
    another way than this knows."""
    create: Any = getattr(dataclasses, "_create_fn", None)
    if create is None or tuple(inspect.signature(create).parameters) != _KNOWN:
        return

    def later(name: str, *given: Any, **more: Any) -> Any:
        made: list[Any] = []

        def function(*args: Any, **keywords: Any) -> Any:
            if not made:
                made.append(create(name, *given, **more))
                made[0].__qualname__ = function.__qualname__
            return made[0](*args, **keywords)

        function.__name__ = name
        return function

    vars(dataclasses)["_create_fn"] = later


def modules() -> None:
    """From now on those of UNUSED are loaded when something of them is first asked for."""
    sys.meta_path.insert(0, _Later())


class _Later(importlib.abc.MetaPathFinder):
    def find_spec(self, name: str, path: Sequence[str] | None, target: Any = None) -> importlib.machinery.ModuleSpec | None:
        found = importlib.machinery.PathFinder.find_spec(name, path, target) if name in UNUSED else None
        if found is not None and found.loader is not None:
            found.loader = importlib.util.LazyLoader(found.loader)
        return found
