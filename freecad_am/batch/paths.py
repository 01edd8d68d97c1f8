# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes FreeCAD importable, or says that it is not there; and loads its libraries while Python makes our modules."""

from __future__ import annotations

import ctypes
import importlib.util
import os
import sys
import threading

from freecad_am.core.issues import InputError

from . import host

LAST = "MeshPart"  # the module of FreeCAD that needs most of the others, and of the libraries below


def require_freecad() -> None:
    """Make FreeCAD importable. Raises InputError NO_FREECAD where this Python has none."""
    if not host.find_freecad():
        raise InputError(
            "NO_FREECAD",
            "Python",
            "FreeCAD cannot be imported; set FREECAD_AM_PYTHON to a Python that can",
        )


def load_meanwhile() -> None:
    """Have a thread load FreeCAD's libraries, and import what most commands need of ours: either takes a tenth of a second.

    Who imports FreeCAD before the libraries are there waits for them. Where it is loaded already, or is not found, nothing
    is done.
    """
    linux = sys.platform.startswith("linux")
    spec = importlib.util.find_spec(LAST) if linux and "FreeCAD" not in sys.modules else None
    if spec is None or not spec.origin:
        return
    import scipy.spatial  # noqa: F401 - it has libraries too, of which the system loads one at a time

    load = ctypes.CDLL(
        None
    ).dlopen  # this call lets other threads have Python, which an import does not
    load.restype, load.argtypes = ctypes.c_void_p, (ctypes.c_char_p, ctypes.c_int)
    thread = threading.Thread(
        target=load, args=(os.fsencode(spec.origin), os.RTLD_NOW), daemon=True
    )
    thread.start()
    os.register_at_fork(
        before=thread.join
    )  # a copy of a process whose libraries are half loaded does not live
    from freecad_am import verify  # noqa: F401 - like the others it needs no FreeCAD
    from freecad_am.core.planning import plan  # noqa: F401
    from freecad_am.report import made  # noqa: F401
