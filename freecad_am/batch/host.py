# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finds FreeCAD's modules for a Python that is not FreeCAD's own, or says that it is missing."""

from __future__ import annotations

import glob
import importlib.util
import os
import stat
import sys
import tempfile

LIBRARY_FOLDERS = (
    "/usr/lib/freecad-python3/lib",
    "/usr/lib/freecad/lib",
    "/usr/lib64/freecad/lib",
    "/usr/local/lib/freecad/lib",
    "/opt/freecad/lib",
)


def library_folders() -> list[str]:
    """Folders that may hold FreeCAD.so, the user's own choice (FREECAD_LIB) first."""
    user_folders = [os.environ[name] for name in ("FREECAD_LIB",) if os.environ.get(name)]
    python_folders = [
        os.path.join(sys.prefix, "lib"),
        os.path.join(sys.prefix, "lib", "freecad", "lib"),
    ]
    return user_folders + list(LIBRARY_FOLDERS) + python_folders


def find_freecad() -> bool:
    """Put FreeCAD on sys.path; True when it can be imported afterwards. Imports nothing itself."""
    if "FreeCAD" in sys.modules or importlib.util.find_spec("FreeCAD") is not None:
        return True
    for folder in library_folders():
        if glob.glob(os.path.join(folder, "FreeCAD.*")):
            sys.path.append(folder)
            _add_shims(folder)
            return True
    return False


def _add_shims(folder: str) -> None:
    # Debian's plain import takes the library's folder as FreeCAD's home: its Qt shim and Python modules stand elsewhere
    for share in ("/usr/share/freecad", os.path.dirname(folder)):
        modules = os.path.join(share, "Mod")
        # the folder of all modules too: PartDesign is a package there, and its objects are lost from a file without it
        extra = [
            os.path.join(share, "Ext"),
            *sorted(glob.glob(os.path.join(modules, "*", ""))),
            modules,
        ]
        for path in (entry.rstrip("/") for entry in extra):
            if os.path.isdir(path) and path not in sys.path:
                sys.path.append(path)


def provide_home() -> None:
    """Give FreeCAD another home folder if the user cannot enter the present one (sudo keeps
    root's): FreeCAD would abort.
    """
    home = os.path.expanduser("~")
    closed = os.path.isdir(home) and not os.access(home, os.R_OK | os.W_OK | os.X_OK)
    if closed and not os.environ.get("FREECAD_USER_HOME"):
        os.environ["FREECAD_USER_HOME"] = _private_folder(f"freecad-am-{os.getuid()}")


def _private_folder(name: str) -> str:
    """A folder that only the current user can enter, below the temporary one, with the given name
    or, if taken by another user, a derived one.

    FreeCAD runs the code that it finds in its home, and any user may make a folder there.
    """
    top = tempfile.gettempdir()
    path = os.path.join(top, name)
    try:
        os.mkdir(path, 0o700)
    except FileExistsError:
        candidates = (path, *sorted(glob.glob(os.path.join(glob.escape(top), f"{name}-*"))))
        return next(filter(_is_private, candidates), None) or tempfile.mkdtemp(prefix=f"{name}-")
    return path


def _is_private(path: str) -> bool:
    """Whether a path is a folder, not a link, that only the current user can enter."""
    try:
        status = os.lstat(path)
    except OSError:
        return False
    return (
        stat.S_ISDIR(status.st_mode)
        and stat.S_IMODE(status.st_mode) == 0o700
        and status.st_uid == os.getuid()
    )


def missing_modules() -> list[str]:
    """Names of the modules this Python lacks to run the headless commands."""
    missing = [] if find_freecad() else ["FreeCAD"]
    return missing + [
        name for name in ("numpy", "scipy", "yaml") if importlib.util.find_spec(name) is None
    ]


# ---- Makes FreeCAD importable, or raises an error that says it is missing


def require_freecad() -> None:
    """Make FreeCAD importable. Raises InputError NO_FREECAD where this Python has none."""
    if not find_freecad():
        from ..core.issues import InputError

        raise InputError(
            "NO_FREECAD",
            "Python",
            "FreeCAD cannot be imported; set FREECAD_AM_PYTHON to a Python that can",
        )
