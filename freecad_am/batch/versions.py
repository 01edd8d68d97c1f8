# SPDX-License-Identifier: LGPL-2.1-or-later
"""Software versions and package code, which affect the digits of a result besides the job."""

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
_WHEN = (1980, 1, 1, 0, 0, 0)  # fixed date of all archive files, for reproducible archives


def found_versions() -> dict[str, str]:
    """Return versions by program or library name, for the current process with FreeCAD."""
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
    """Return an archive of code and data, without the GUI, that can run headless commands."""
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
    """Return the digest of code and data, without the GUI."""
    digest = hashlib.sha256()
    for name in _files():
        with open(os.path.join(ROOT, name), "rb") as stream:
            digest.update(f"{name} {hashlib.sha256(stream.read()).hexdigest()}\n".encode())
    return digest.hexdigest()


def _files() -> Iterator[str]:
    """Yield sorted file names relative to ROOT."""
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
