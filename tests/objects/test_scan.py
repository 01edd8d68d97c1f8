# SPDX-License-Identifier: LGPL-2.1-or-later
"""A toolpath fitted to a scan in a document, by macro: saved with it, and renewed when the scan
changes."""

import FreeCAD as App
import numpy as np
import pytest

from freecad_am import api
from freecad_am.core.inspection import fit_layers
from freecad_am.core.issues import InputError
from freecad_am.objects.checks import preflight
from tests.core.inspection.test_scan import bent, points_on

pytestmark = pytest.mark.any_version


def heights(toolpath):
    return np.vstack([bead.points for bead in api.result(toolpath).layers[0].beads])


def test_a_fitted_toolpath_is_kept_and_follows_its_scan(doc, tmp_path):
    plate, block = doc.addObject("Part::Box", "Plate"), doc.addObject("Part::Box", "Block")
    plate.Length, plate.Width, plate.Height, plate.Placement.Base = (
        200,
        120,
        10,
        App.Vector(-100, -60, -10),
    )
    block.Length, block.Width, block.Height, block.Placement.Base = (
        60,
        20,
        12,
        App.Vector(-30, -10, 0),
    )
    doc.recompute()
    path = tmp_path / "scan.xyz"
    np.savetxt(path, points_on(bent, count=6000))
    scan = api.make_scan(doc, plate, str(path))
    feature = api.make_solid_feature(doc, block, substrate=plate, layer_height=4, bead_spacing=10)
    toolpath = api.make_toolpath(doc, feature, scan=scan, scan_band=10)
    x, y, z = heights(toolpath).T
    assert np.abs(z - bent(x, y)).max() < 0.06
    assert api.result(toolpath).checks.fitted.layers == int(
        np.ceil(np.abs(api.result(toolpath).checks.fitted.off).max() / 0.4)
    )
    copy = str(tmp_path / "copy.FCStd")
    doc.saveCopy(copy)
    again = App.openDocument(copy)
    reopened = again.getObject(toolpath.Name)
    assert heights(reopened) == pytest.approx(heights(toolpath), abs=0.0)
    assert reopened.Scan.Name == scan.Name and reopened.Status == "up to date"
    App.closeDocument(again.Name)
    np.savetxt(path, points_on(lambda x, y: bent(x, y) + 0.5, count=6000))
    api.recompute(toolpath)
    x, y, z = heights(toolpath).T
    assert np.abs(z - 0.5 - bent(x, y)).max() < 0.06
    with pytest.raises(InputError, match="compares with") as error:
        api.make_toolpath(doc, feature, scan=api.inspect(doc, feature, str(path), fit="none"))
    assert error.value.code == "BAD_INPUT"


def test_a_fitted_wall_is_held_against_its_faces_once_it_is_fitted(doc, tmp_path, monkeypatch):
    """The check subtracts the scan's shift of the layer from the distance to the faces. It finds a
    bead that was shifted twice, and the preflight states the remaining deviation of a part with too
    few layers."""
    plate, tube = doc.addObject("Part::Box", "Plate"), doc.addObject("Part::Cylinder", "Tube")
    plate.Length, plate.Width, plate.Height, plate.Placement.Base = (
        120,
        120,
        10,
        App.Vector(-60, -60, -10),
    )
    tube.Radius, tube.Height = 30, 24
    doc.recompute()
    path = tmp_path / "scan.xyz"

    def toolpath(low):
        np.savetxt(path, points_on(lambda x, y: low + 0.01 * x, (60.0, 60.0), 6000))
        scan = api.make_scan(doc, plate, str(path))
        feature = api.make_surface_feature(
            doc, tube, substrate=plate, faces=["Face1"], layer_height=4, chord_error=0.1
        )
        toolpath_ = api.make_toolpath(doc, feature, scan=scan)
        (promise,) = [
            bead
            for bead in preflight.stage_preflight(toolpath_)
            if bead.promise == "The deposit lies on the part"
        ]
        return api.result(toolpath_), promise

    sound, promise = toolpath(-1.0)
    lowest = min(bead.points[:, 2].min() for bead in sound.layers[0].beads)
    assert lowest == pytest.approx(-1.3, abs=0.06) and "OFF_PART" not in {
        issue.code for issue in sound.issues
    }
    assert promise.ok and promise.worst < 0.12 and "without the layer shift" in promise.how
    short_toolpath, promise = toolpath(-4.6)  # 24 mm reduce it by 4.8 mm, a fifth of them
    assert "SCAN_REMAINS" in {issue.code for issue in short_toolpath.issues} and promise.ok is False
    moved = fit_layers.move_bead
    monkeypatch.setattr(
        fit_layers, "move_bead", lambda bead, share, *options: moved(bead, 2.0 * share, *options)
    )
    wrong, promise = toolpath(-1.0)
    (issue,) = [issue for issue in wrong.issues if issue.code == "OFF_PART"]
    assert (
        issue.level == "error"
        and promise.ok is False
        and promise.worst == pytest.approx(1.3, abs=0.1)
    )
