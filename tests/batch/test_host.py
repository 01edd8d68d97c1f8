# SPDX-License-Identifier: LGPL-2.1-or-later
"""The surroundings FreeCAD needs in a Python that is not its own."""

import os
import stat

import pytest

from freecad_am.batch import host


@pytest.mark.parametrize("closed", [True, False])
def test_a_closed_home_folder_is_replaced(monkeypatch, tmp_path, closed):
    """FreeCAD aborts where it cannot read the home folder, as after sudo, which keeps that of the caller."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(host.tempfile, "tempdir", None)
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    monkeypatch.setattr(
        host.os, "access", lambda path, mode: not (closed and path == str(tmp_path))
    )
    host.provide_home()
    given = os.environ.get("FREECAD_USER_HOME")
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    assert (given is not None) == closed
    if closed:
        assert os.path.isdir(given) and os.path.dirname(given) == str(tmp_path)
        monkeypatch.setenv("FREECAD_USER_HOME", "mine")
        host.provide_home()
        assert os.environ["FREECAD_USER_HOME"] == "mine"


def planted(folder, kind, others):
    """What somebody may have put where the folder would be."""
    if kind == "open to all":
        folder.mkdir(mode=0o777)
        folder.chmod(0o777)
    elif kind == "a link":
        others.mkdir(mode=0o700)
        folder.symlink_to(others)
    elif kind == "a file":
        folder.write_text("mine")
    else:
        folder.mkdir(mode=0o700)


@pytest.mark.parametrize("kind", ["open to all", "a link", "a file", "another's"])
def test_a_folder_that_another_may_have_made_is_not_taken_for_home(monkeypatch, tmp_path, kind):
    """FreeCAD runs Mod/*/Init.py of its home."""
    home, top = tmp_path / "home", tmp_path / "top"
    home.mkdir()
    top.mkdir()
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setattr(host.tempfile, "tempdir", str(top))
    monkeypatch.setattr(host.os, "access", lambda path, mode: path != str(home))
    user = os.getuid()
    if (
        kind == "another's"
    ):  # to make what belongs to another takes root: this user is another instead
        user += 1
        monkeypatch.setattr(host.os, "getuid", lambda: user)
    there = top / f"freecad-am-{user}"
    planted(there, kind, tmp_path / "others")
    given = []
    for _ in range(2):
        monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
        host.provide_home()
        given.append(os.environ["FREECAD_USER_HOME"])
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    assert all(
        os.path.dirname(path) == str(top) and os.path.basename(path) != there.name for path in given
    )
    for path in given:
        found = os.lstat(path)
        assert stat.S_ISDIR(found.st_mode) and stat.S_IMODE(found.st_mode) == 0o700
    if kind != "another's":
        assert given[0] == given[1]  # made once, used again


def test_the_folder_made_once_is_used_again(monkeypatch, tmp_path):
    monkeypatch.setattr(host.tempfile, "tempdir", str(tmp_path))
    assert host._private_folder("mine") == host._private_folder("mine") == str(tmp_path / "mine")
