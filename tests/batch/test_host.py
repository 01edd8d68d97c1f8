# SPDX-License-Identifier: LGPL-2.1-or-later
"""The environment that FreeCAD needs in a Python other than its own."""

import os
import stat

import pytest

from freecad_am.batch import host


@pytest.mark.parametrize("closed", [True, False])
def test_a_closed_home_folder_is_replaced(monkeypatch, tmp_path, closed):
    """FreeCAD aborts if it cannot read the home folder, as after sudo, which keeps the home of the
    caller."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(host.tempfile, "tempdir", None)
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    monkeypatch.setattr(
        host.os, "access", lambda path, mode: not (closed and path == str(tmp_path))
    )
    host.provide_home()
    home = os.environ.get("FREECAD_USER_HOME")
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    assert (home is not None) == closed
    if closed:
        assert os.path.isdir(home) and os.path.dirname(home) == str(tmp_path)
        monkeypatch.setenv("FREECAD_USER_HOME", "mine")
        host.provide_home()
        assert os.environ["FREECAD_USER_HOME"] == "mine"


def planted(folder, kind, other_user):
    """Create what another user may have put at the folder's path."""
    if kind == "open to all":
        folder.mkdir(mode=0o777)
        folder.chmod(0o777)
    elif kind == "a link":
        other_user.mkdir(mode=0o700)
        folder.symlink_to(other_user)
    elif kind == "a file":
        folder.write_text("mine")
    else:
        folder.mkdir(mode=0o700)


@pytest.mark.parametrize("kind", ["open to all", "a link", "a file", "another's"])
def test_a_folder_that_another_may_have_made_is_not_taken_for_home(monkeypatch, tmp_path, kind):
    """FreeCAD runs Mod/*/Init.py of its home, so a folder that another user may have created is
    unsafe."""
    home, top = tmp_path / "home", tmp_path / "top"
    home.mkdir()
    top.mkdir()
    monkeypatch.setenv("HOME", str(home))
    monkeypatch.setattr(host.tempfile, "tempdir", str(top))
    monkeypatch.setattr(host.os, "access", lambda path, mode: path != str(home))
    user = os.getuid()
    if (
        kind == "another's"
    ):  # only root can create files of another user, so the test changes its own user instead
        user += 1
        monkeypatch.setattr(host.os, "getuid", lambda: user)
    default_home = top / f"freecad-am-{user}"
    planted(default_home, kind, tmp_path / "others")
    homes = []
    for _ in range(2):
        monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
        host.provide_home()
        homes.append(os.environ["FREECAD_USER_HOME"])
    monkeypatch.delenv("FREECAD_USER_HOME", raising=False)
    assert all(
        os.path.dirname(path) == str(top) and os.path.basename(path) != default_home.name
        for path in homes
    )
    for path in homes:
        status = os.lstat(path)
        assert stat.S_ISDIR(status.st_mode) and stat.S_IMODE(status.st_mode) == 0o700
    if kind != "another's":
        assert homes[0] == homes[1]  # created once and reused


def test_the_folder_made_once_is_used_again(monkeypatch, tmp_path):
    monkeypatch.setattr(host.tempfile, "tempdir", str(tmp_path))
    assert host._private_folder("mine") == host._private_folder("mine") == str(tmp_path / "mine")
