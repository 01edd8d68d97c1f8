# SPDX-License-Identifier: LGPL-2.1-or-later
"""Make a FreeCAD main window a worker of pytest-xdist (tests/window.py starts it).

xdist sends the code of its worker as one line. The process ends with the worker and never returns to FreeCAD's main loop.
"""

import os
import sys


def work():
    """Run the tests that xdist sends."""
    status = 3
    try:
        for stream, pipe in enumerate(map(int, os.environ.pop("WORKER_PIPES").split())):
            os.dup2(pipe, stream)
            os.close(pipe)
        # FreeCAD's window has replaced the streams by its report view
        sys.stdin, sys.stdout = open(0, closefd=False), open(1, "w", closefd=False)  # noqa: SIM115
        sys.stderr = sys.__stderr__ or open(2, "w", closefd=False)  # noqa: SIM115
        # xdist replaces sys.path; tests/conftest.py adds these folders again
        os.environ["FREECAD_MODULE_PATH"] = os.pathsep.join(sys.path)
        exec(eval(sys.stdin.readline()), {"__name__": "__main__"})
        status = 0
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        os._exit(status)


from PySide import QtCore  # noqa: E402

QtCore.QTimer.singleShot(0, work)
