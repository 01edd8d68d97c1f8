# SPDX-License-Identifier: LGPL-2.1-or-later
"""The surroundings FreeCAD needs in a Python that is not its own."""

import os

import pytest

from freecad_am.batch import host


@pytest.mark.parametrize("closed", [True, False])
def test_a_closed_home_folder_is_replaced(monkeypatch, tmp_path, closed):
    """FreeCAD aborts where it cannot read the home folder, as after sudo, which keeps that of the caller."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(host.tempfile, "tempdir", None)
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    monkeypatch.setattr(host.os, "access", lambda path, mode: not (closed and path == str(tmp_path)))
    host.provide_home()
    given = os.environ.get("FREECAD_USER_HOME")
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    assert (given is not None) == closed
    if closed:
        assert os.path.isdir(given) and os.path.dirname(given) == str(tmp_path)
        monkeypatch.setenv("FREECAD_USER_HOME", "mine")
        host.provide_home()
        assert os.environ["FREECAD_USER_HOME"] == "mine"
