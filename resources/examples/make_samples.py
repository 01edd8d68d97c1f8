# SPDX-License-Identifier: LGPL-2.1-or-later
"""Computes the results of the documents in `samples` anew with the code of today, and keeps how the window shows them.

`docs/images/make_tutorials.py` makes the documents themselves, as a reader of the tutorials does. Run this script after a
change of results, with any Python that finds FreeCAD: python3 resources/examples/make_samples.py
"""

from __future__ import annotations

import shutil
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
SAMPLES = HERE / "samples"
WINDOW = "GuiDocument.xml"  # views, colours and camera; FreeCAD without a window does not save it


def renew_sample(path: Path) -> None:
    """Compute all stages of a sample and save it at its place, without a trace of where that was done."""
    import FreeCAD as App

    from freecad_am import api

    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / path.name
        shutil.copy(path, copy)
        document = App.openDocument(str(copy))
        try:
            for stage in in_order(api.stages_of(document)):
                stage.Proxy.renew(stage, force=True)
            document.recompute()
            document.save()
        finally:
            App.closeDocument(document.Name)
        _write_with_window(copy, path)


def in_order(stages: Any) -> list[Any]:
    """Stages, each after those that it is made of."""
    return sorted(stages, key=lambda stage: len(stage.OutListRecursive))


def _write_with_window(computed: Path, sample: Path) -> None:
    """Put the part of the window, which the sample has, into the computed document, and that in place of the sample."""
    with (
        zipfile.ZipFile(sample) as old,
        zipfile.ZipFile(computed, "a", zipfile.ZIP_DEFLATED) as new,
    ):
        known = set(new.namelist())
        if WINDOW not in known:
            text = old.read(WINDOW)
            files = [name for name in old.namelist() if f'file="{name}"'.encode() in text]
            for name in (WINDOW, *files):
                new.writestr(name, old.read(name))
    shutil.move(computed, sample)


if __name__ == "__main__":
    sys.path.insert(0, str(HERE.parents[1]))
    from freecad_am.batch import host

    host.find_freecad()
    for sample in sorted(SAMPLES.glob("*.FCStd")):
        renew_sample(sample)
        print(sample.name)
