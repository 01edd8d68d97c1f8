# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs pytest inside the FreeCAD main window:  PYTEST_ARGUMENTS="-q tests/gui" freecad tests/gui_runner.py

Arguments come by environment because FreeCAD opens every further word of its command line as a file. The exit
status is pytest's; the script never returns to FreeCAD's main loop. FAILED_TESTS names a file that gets the tests that
failed, one a line.
"""

import io
import os
import shlex
import sys


class Failures:
    """Notes the tests that failed, for who may want to run them again."""

    def __init__(self, path):
        self.path = path

    def pytest_runtest_logreport(self, report):
        if report.failed and self.path:
            with open(self.path, "a", encoding="utf-8") as file:
                file.write(report.nodeid + "\n")


def run():
    status = 3
    try:
        # FreeCAD's window keeps stdout and stderr for its report view
        # unbuffered, so that a run that crashes or hangs shows how far it came (FreeCAD 1.0 heeds no PYTHONUNBUFFERED)
        sys.stdout = io.TextIOWrapper(io.FileIO(1, "w", closefd=False), errors="replace", write_through=True)
        sys.stderr = sys.__stderr__ or os.fdopen(2, "w")
        import pytest

        status = int(pytest.main(
            shlex.split(os.environ.get("PYTEST_ARGUMENTS", "")), plugins=[Failures(os.environ.get("FAILED_TESTS"))]
        ))
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


from PySide import QtCore  # noqa: E402

QtCore.QTimer.singleShot(0, run)
