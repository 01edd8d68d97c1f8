# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find view provider classes of documents that were saved before modules moved.

Documents store view providers by module and class. FreeCAD saves them under their current names.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Sequence
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from types import ModuleType

_GUI = __name__.rpartition(".")[0]
MOVED = {
    f"{_GUI}.view_{name}": f"{_GUI}.views.{name}"
    for name in (
        "cell",
        "cladding",
        "curves",
        "feature",
        "hub",
        "job",
        "joint_path",
        "program",
        "toolpath",
    )
}


class _FormerNames(MetaPathFinder, Loader):
    """Finds modules under their former names, with their current classes."""

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        return ModuleSpec(name, self) if name in MOVED else None

    def exec_module(self, module: ModuleType) -> None:
        now = importlib.import_module(MOVED[module.__name__])
        vars(module).update(
            {name: value for name, value in vars(now).items() if isinstance(value, type)}
        )


def install() -> None:
    """Install the finder; InitGui calls this before the first document can open."""
    sys.meta_path.append(_FormerNames())
