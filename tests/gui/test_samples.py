# SPDX-License-Identifier: LGPL-2.1-or-later
"""The recorded samples open completely, without computing anything."""

import shutil
import zipfile

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.gui.path import legend
from freecad_am.objects.stage import Stage

MAX_BYTES = 1_500_000  # bytes
SAMPLES = {"hemisphere": 15, "tube-on-pipe": 15}  # the samples and their numbers of layers


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_is_there_at_once(person, root, tmp_path, monkeypatch, name):
    file = root / "resources" / "examples" / "samples" / f"{name}.FCStd"
    assert file.stat().st_size < MAX_BYTES
    path = shutil.copy(file, tmp_path)
    computed = []
    monkeypatch.setattr(Stage, "execute", lambda self, obj: computed.append(obj.Label))
    document = App.openDocument(str(path))
    person.idle(0.5)
    stages = api.stages_of(document)
    assert [(stage.Proxy.kind, stage.Status) for stage in stages] == [
        (stage.Proxy.kind, "up to date") for stage in stages
    ]
    assert {stage.Proxy.kind for stage in stages} == {
        "cell",
        "feature",
        "toolpath",
        "joint path",
        "program",
    }
    # FreeCAD 1.0 touches imported shapes of earlier versions, for its names of faces; the stages
    # stay up to date
    assert computed == [] and [stage.Label for stage in stages if "Touched" in stage.State] == []
    assert document.Toolpath.Layers == len(api.result(document.Toolpath).layers) == SAMPLES[name]
    assert np.isfinite(api.result(document.JointPath).motion.joints).all()
    assert api.result(document.Program).files
    blue, yellow = person.path_pixels()
    assert blue + yellow > 200, (blue, yellow)
    assert legend.visible_scales(document)
    person.screenshot(f"sample_{name}")


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_tells_nothing_of_where_it_was_made(root, name):
    with zipfile.ZipFile(root / "resources" / "examples" / "samples" / f"{name}.FCStd") as archive:
        text = b"".join(
            archive.read(entry) for entry in archive.namelist() if entry.endswith(".xml")
        )
    assert (
        b"/tmp" not in text
        and b"/root" not in text
        and b"/work" not in text
        and b"/home" not in text
    )
