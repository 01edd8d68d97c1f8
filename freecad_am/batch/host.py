# SPDX-License-Identifier: LGPL-2.1-or-later
"""Find FreeCAD's modules for a Python other than FreeCAD's own, or report FreeCAD as missing."""

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
    """Return folders that may contain FreeCAD.so, the user's choice (FREECAD_LIB) first."""
    user_folders = [os.environ[name] for name in ("FREECAD_LIB",) if os.environ.get(name)]
    python_folders = [
        os.path.join(sys.prefix, "lib"),
        os.path.join(sys.prefix, "lib", "freecad", "lib"),
    ]
    return user_folders + list(LIBRARY_FOLDERS) + python_folders


def find_freecad() -> bool:
    """Add FreeCAD to sys.path, without importing it. Return whether FreeCAD can be imported."""
    if "FreeCAD" in sys.modules or importlib.util.find_spec("FreeCAD") is not None:
        return True
    for folder in library_folders():
        if glob.glob(os.path.join(folder, "FreeCAD.*")):
            sys.path.append(folder)
            _add_shims(folder)
            return True
    return False


def _add_shims(folder: str) -> None:
    # on Debian, a plain import uses the library folder as FreeCAD's home, but the Qt shim and the
    # Python modules are elsewhere
    for share in ("/usr/share/freecad", os.path.dirname(folder)):
        modules = os.path.join(share, "Mod")
        # add the folder of all modules too: without the PartDesign package, files lose its objects
        extra = [
            os.path.join(share, "Ext"),
            *sorted(glob.glob(os.path.join(modules, "*", ""))),
            modules,
        ]
        for path in (entry.rstrip("/") for entry in extra):
            if os.path.isdir(path) and path not in sys.path:
                sys.path.append(path)


def provide_home() -> None:
    """Set another home folder for FreeCAD if the user cannot access the current home folder.

    FreeCAD would abort otherwise, for example with root's home folder after sudo.
    """
    home = os.path.expanduser("~")
    closed = os.path.isdir(home) and not os.access(home, os.R_OK | os.W_OK | os.X_OK)
    if closed and not os.environ.get("FREECAD_USER_HOME"):
        os.environ["FREECAD_USER_HOME"] = _private_folder(f"freecad-am-{os.getuid()}")


def _private_folder(name: str) -> str:
    """Return a folder in the temporary folder that only the current user can enter.

    The folder has the given name, or a derived name if another user has taken the name. FreeCAD
    runs code from its home folder, and any user may make folders in the temporary folder.
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
    """Whether a path is a folder, not a link, that only the current user can access."""
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
    """Return the names of missing modules that headless commands need."""
    missing = [] if find_freecad() else ["FreeCAD"]
    return missing + [
        name for name in ("numpy", "scipy", "yaml") if importlib.util.find_spec(name) is None
    ]


# ---- Make FreeCAD importable, or raise an error


def require_freecad() -> None:
    """Make FreeCAD importable. Raises InputError NO_FREECAD if this Python has no FreeCAD."""
    if not find_freecad():
        from ..core.issues import InputError

        raise InputError(
            "NO_FREECAD",
            "Python",
            "FreeCAD cannot be imported; set FREECAD_AM_PYTHON to a Python with FreeCAD",
        )
