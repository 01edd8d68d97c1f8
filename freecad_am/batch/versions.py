# SPDX-License-Identifier: LGPL-2.1-or-later
"""Inputs of a result's digits besides its job: versions of the software, and our own code."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import importlib.metadata
import io
import os
import platform
import zipfile
from collections.abc import Iterator

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
LAUNCHER, PACKAGE = "freecad-am", "freecad_am"
_WINDOW = os.path.join(PACKAGE, "gui")
_WHEN = (1980, 1, 1, 0, 0, 0)  # of every file in the archive: the same code is the same bytes


def found_versions() -> dict[str, str]:
    """Versions by the name of the program or library, in the current process, which has FreeCAD."""
    import FreeCAD
    import numpy as np
    import Part
    import scipy

    versions = {
        "FreeCAD": ".".join(FreeCAD.Version()[:3]),
        "OpenCASCADE": str(Part.OCC_VERSION),
        "Python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
    }
    with contextlib.suppress(importlib.metadata.PackageNotFoundError):
        versions["shapely"] = importlib.metadata.version("shapely")
    return versions


@functools.cache
def package() -> bytes:
    """An archive of our code and data without the window, which runs headless commands where it is unpacked."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in _files():
            entry = zipfile.ZipInfo(name.replace(os.sep, "/"), _WHEN)
            entry.compress_type = zipfile.ZIP_DEFLATED
            with open(os.path.join(ROOT, name), "rb") as stream:
                archive.writestr(entry, stream.read())
    return buffer.getvalue()


@functools.cache
def code() -> str:
    """The digest of our code and data without the window."""
    digest = hashlib.sha256()
    for name in _files():
        with open(os.path.join(ROOT, name), "rb") as stream:
            digest.update(f"{name} {hashlib.sha256(stream.read()).hexdigest()}\n".encode())
    return digest.hexdigest()


def _files() -> Iterator[str]:
    """Names below ROOT, sorted."""
    yield LAUNCHER
    for folder, _, files in sorted(os.walk(os.path.join(ROOT, PACKAGE))):
        name = os.path.relpath(folder, ROOT)
        if (
            name.split(os.sep)[-1] == "__pycache__"
            or name == _WINDOW
            or name.startswith(_WINDOW + os.sep)
        ):
            continue
        yield from (os.path.join(name, file) for file in sorted(files))
