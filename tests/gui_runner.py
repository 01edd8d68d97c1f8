# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs pytest inside the FreeCAD main window:  PYTEST_ARGUMENTS="-q tests/gui" freecad tests/gui_runner.py

Arguments come by environment because FreeCAD opens every further word of its command line as a file. The exit
status is pytest's; the script never returns to FreeCAD's main loop. FAILED_TESTS names a file that gets the tests that
failed, one a line; LAST_TEST one that holds the test at hand, which is the last one when FreeCAD crashes.
"""

import faulthandler
import io
import os
import shlex
import sys

TEST_TIMEOUT = 600  # s; a test that hangs ends FreeCAD, and where it hangs is printed


class Notes:
    """Notes the tests that failed, for who may want to run them again, and the one at hand; ends one that hangs."""

    def __init__(self, failed, last, stderr):
        self.failed, self.last, self.stderr = failed, last, stderr

    def pytest_runtest_logstart(self, nodeid):
        faulthandler.dump_traceback_later(TEST_TIMEOUT, exit=True, file=self.stderr)
        if self.last:
            with open(self.last, "w", encoding="utf-8") as file:
                file.write(nodeid)

    def pytest_runtest_logfinish(self):
        faulthandler.cancel_dump_traceback_later()

    def pytest_runtest_logreport(self, report):
        if report.failed and self.failed:
            with open(self.failed, "a", encoding="utf-8") as file:
                file.write(report.nodeid + "\n")


def run():
    status = 3
    try:
        stderr = os.dup(2)  # pytest keeps what tests write to the other one
        # FreeCAD's window keeps stdout and stderr for its report view
        # unbuffered, so that a run that crashes or hangs shows how far it came (FreeCAD 1.0 heeds no PYTHONUNBUFFERED)
        sys.stdout = io.TextIOWrapper(
            io.FileIO(1, "w", closefd=False), errors="replace", write_through=True
        )
        sys.stderr = sys.__stderr__ or os.fdopen(2, "w")
        import pytest

        notes = Notes(os.environ.get("FAILED_TESTS"), os.environ.get("LAST_TEST"), stderr)
        status = int(
            pytest.main(shlex.split(os.environ.get("PYTEST_ARGUMENTS", "")), plugins=[notes])
        )
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


from PySide import QtCore  # noqa: E402

QtCore.QTimer.singleShot(0, run)
