# SPDX-License-Identifier: LGPL-2.1-or-later
"""Files that are read ahead: what comes of it is what reading gives, and nothing is left."""

import os
import sys
import time

import FreeCAD
import Part
import pytest

from freecad_am.brep.files import apart
from freecad_am.brep.files.read import read_shape, reading_shape
from freecad_am.core.issues import InputError

pytestmark = pytest.mark.skipif(
    FreeCAD.GuiUp or not sys.platform.startswith("linux"),
    reason="a window, and other systems, copy no process",
)


@pytest.fixture(autouse=True)
def copied(monkeypatch):
    """The processes that were copied, also on a machine with one processor."""
    fork, found = os.fork, []

    def counted():
        pid = fork()
        found.append(pid)
        return pid

    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0, 1})
    monkeypatch.setattr(os, "fork", counted)
    return found


@pytest.fixture
def cone(tmp_path):
    path = tmp_path / "cône.step"
    Part.makeCone(20, 10, 30).exportStep(str(tmp_path / "cone.step"))
    (tmp_path / "cone.step").rename(path)
    return path


def is_left(pids):
    """Whether one of the processes is there, be it one that has ended and that nobody waited for."""
    return any(os.path.exists(f"/proc/{pid}") for pid in pids)


def test_what_is_read_ahead_is_the_shape_and_is_read_once(cone, copied):
    before = read_shape(cone).exportBrepToString()
    descriptors = os.listdir("/proc/self/fd")
    del copied[:]
    with reading_shape(str(cone)):  # as a job has it
        assert len(copied) == 1
        assert read_shape(str(cone)).exportBrepToString() == before
        assert len(copied) == 1
        assert read_shape(str(cone)).exportBrepToString() == before  # a second time it is read anew
        assert len(copied) == 2
    assert not is_left(copied)
    assert os.listdir("/proc/self/fd") == descriptors


def test_what_nobody_asks_for_leaves_nothing(cone, copied):
    descriptors = os.listdir("/proc/self/fd")
    with pytest.raises(InputError, match="another key"), reading_shape(cone):
        raise InputError("BAD_VALUE", "another key", "it is wrong")
    assert len(copied) == 1 and not is_left(copied)
    assert os.listdir("/proc/self/fd") == descriptors
    Part.makeBox(10, 20, 30).exportStep(str(cone))
    assert read_shape(cone).Volume == pytest.approx(6000.0)


def test_a_file_that_is_another_one_by_then_is_read_again(cone, tmp_path):
    with reading_shape(cone):
        Part.makeBox(10, 20, 30).exportStep(str(tmp_path / "box.step"))
        (tmp_path / "box.step").replace(cone)
        assert read_shape(cone).Volume == pytest.approx(6000.0)


def test_what_was_read_long_ago_is_there(cone, monkeypatch):
    """The limit of time is one for reading, not for what is done before the shape is asked for."""
    monkeypatch.setattr(apart, "LONGER", 0.02)
    with reading_shape(cone):
        time.sleep(0.5)
        assert len(read_shape(cone).Faces) == 3


def test_without_a_process_to_be_had_nothing_is_read_ahead(cone, monkeypatch):
    def refused():
        raise BlockingIOError(11, "Resource temporarily unavailable")

    descriptors = os.listdir("/proc/self/fd")
    with monkeypatch.context() as patch:
        patch.setattr(os, "fork", refused)
        with reading_shape(cone):
            patch.undo()
            assert len(read_shape(cone).Faces) == 3
    assert os.listdir("/proc/self/fd") == descriptors


@pytest.mark.parametrize("content", ["", "no STEP at all", "ISO-10303-21;\nHEADER;\n"])
def test_what_cannot_be_read_is_refused_with_the_same_words(cone, content):
    cone.write_text(content)
    with pytest.raises(InputError) as alone:
        read_shape(cone)
    with reading_shape(cone), pytest.raises(InputError) as ahead:
        read_shape(cone)
    assert (ahead.value.code, ahead.value.where, str(ahead.value)) == (
        alone.value.code,
        alone.value.where,
        str(alone.value),
    )


@pytest.mark.parametrize(
    "name", ["there is none.step", "a folder.step", "part.FCStd", "mesh.stl", ""]
)
def test_nothing_is_begun_for_files_that_are_not_read_like_this(tmp_path, copied, name):
    if name.startswith("a folder"):
        (tmp_path / name).mkdir()
    elif name and not name.startswith("there"):
        (tmp_path / name).write_text("anything")
    with reading_shape(str(tmp_path / name)):
        assert not copied
