# SPDX-License-Identifier: LGPL-2.1-or-later
"""The document of a job does not compress packed results again, and it keeps the user's own
compression setting."""

import zipfile

import FreeCAD
import numpy as np
import pytest

from freecad_am import api
from freecad_am.batch.job import document as saving
from tests.batch.conftest import make_cup

LEVEL_PREFERENCE = "CompressionLevel"


@pytest.fixture
def stages(tmp_path):
    make_cup(tmp_path)
    document = FreeCAD.newDocument("Cup")
    imported_part = api.open_part(document, str(tmp_path / "cup.step"))
    cell = api.make_cell(document, limits="paper", platform_diameter=100)
    feature = api.make_feature(document, imported_part, layer_height=8, chord_error=0.1)
    return api.make_toolpath(document, feature, cell)


@pytest.fixture
def chosen():
    parameters = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Document")
    yield parameters
    parameters.RemInt(LEVEL_PREFERENCE)


def _sizes(path):
    """Return the bytes of the results in a file, uncompressed and as stored."""
    with zipfile.ZipFile(path) as file:
        assert file.testzip() is None
        return [
            (member.file_size, member.compress_size)
            for member in file.infolist()
            if member.filename.startswith("ResultData")
        ]


@pytest.mark.parametrize("before", [None, 0, 5])
def test_large_results_are_saved_as_they_are_packed(stages, tmp_path, chosen, monkeypatch, before):
    if before is not None:
        chosen.SetInt(LEVEL_PREFERENCE, before)
    path = str(tmp_path / "large results.FCStd")
    monkeypatch.setattr(saving, "MAX_DEFLATED_BYTES", 1)
    saving.save(stages.Document, path)
    sizes = _sizes(path)
    assert len(sizes) > 1 and all(packed >= size for size, packed in sizes)
    assert chosen.GetInt(LEVEL_PREFERENCE, -1) == (-1 if before is None else before)
    again = FreeCAD.openDocument(path)
    try:
        points = [
            [bead.points for _, _, bead in api.result(thing)]
            for thing in (stages, again.getObject(stages.Name))
        ]
        assert all(
            np.array_equal(expected, reopened) for expected, reopened in zip(*points, strict=True)
        )
    finally:
        FreeCAD.closeDocument(again.Name)


def test_small_ones_are_deflated_as_the_user_chose(stages, tmp_path, chosen):
    chosen.SetInt(LEVEL_PREFERENCE, 9)
    path = str(tmp_path / "small.FCStd")
    saving.save(stages.Document, path)
    assert (
        any(packed < size for size, packed in _sizes(path))
        and chosen.GetInt(LEVEL_PREFERENCE, -1) == 9
    )


def test_the_choice_comes_back_where_the_file_cannot_be_written(
    stages, tmp_path, chosen, monkeypatch
):
    class Full:
        """A document on a full disk."""

        Objects, MemSize = stages.Document.Objects, 0

        def saveAs(self, path):
            assert chosen.GetInt(LEVEL_PREFERENCE, -1) == 0
            raise OSError("no space left")

    monkeypatch.setattr(saving, "MAX_DEFLATED_BYTES", 1)
    chosen.SetInt(LEVEL_PREFERENCE, 4)
    with pytest.raises(saving.InputError, match="no space left"):
        saving.save(Full(), str(tmp_path / "x.FCStd"))
    assert chosen.GetInt(LEVEL_PREFERENCE, -1) == 4
