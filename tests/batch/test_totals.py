# SPDX-License-Identifier: LGPL-2.1-or-later
"""Time, length, volume and mass in the report equal the properties of the toolpath and the joint
path."""

import json
from dataclasses import replace

import numpy as np
import pytest

from freecad_am import api


def test_the_joint_path_and_the_report_tell_the_same_sums(doc, tmp_path):
    sphere = doc.addObject("Part::Sphere", "Sphere")
    sphere.Radius, sphere.Angle1, sphere.Angle2 = 45, 0, 90
    doc.recompute()
    feature = api.make_feature(doc, sphere, layer_height=15)
    cell = api.make_cell(doc, limits="paper")
    toolpath = api.make_toolpath(
        doc,
        feature,
        cell,
        between_layers_wait=3.0,
        lead_on=0.5,
        lead_off=0.25,
        bead_width=4.0,
        density=2.7,
    )
    path = api.make_joint_path(doc, toolpath, cell)
    beads = [bead for _, _, bead in api.result(toolpath)]
    length = sum(bead.length for bead in beads)
    assert path.DepositLength.Value == pytest.approx(length, rel=1e-6)
    assert path.DepositVolume == pytest.approx(length * 4.0 * 15.0 / 1000.0, rel=1e-6)
    assert path.DepositMass == pytest.approx(2.7 * path.DepositVolume, rel=1e-12)
    assert path.DepositTime == pytest.approx(length / 6.0, rel=1e-6)
    assert path.WaitTime == pytest.approx(
        0.75 * len(beads) + 3.0 * (len(api.result(toolpath).layers) - 1)
    )
    assert path.TotalTime == pytest.approx(path.Duration + path.WaitTime)
    assert np.isfinite(path.TotalTime)

    from freecad_am.core.parameters.process import ProcessParameters
    from freecad_am.report import figures  # only after FreeCAD is found

    process = toolpath.Proxy.parameters(toolpath, ProcessParameters)
    figures_ = figures.build("x", api.result(toolpath), api.result(path).motion, process, ())
    sums = json.loads(figures.text(figures_))["totals"]
    assert figures_["duration_s"] == pytest.approx(path.TotalTime)
    assert [
        sums[key] for key in ("time_s", "deposit_s", "wait_s", "deposit_mm", "volume_cm3", "mass_g")
    ] == pytest.approx(
        [
            path.TotalTime,
            path.DepositTime,
            path.WaitTime,
            path.DepositLength.Value,
            path.DepositVolume,
            path.DepositMass,
        ]
    )
    for density in (7.85, 11.34):
        other_figures = figures.build(
            "x",
            api.result(toolpath),
            api.result(path).motion,
            replace(process, density=density),
            (),
        )
        mass = json.loads(figures.text(other_figures))["totals"]["mass_g"]
        assert mass == pytest.approx(density * length * 4.0 * 15.0 / 1000.0, rel=1e-6)
    assert sums["fed_cm3"] == pytest.approx(
        path.DepositVolume, rel=1e-6
    )  # the wire balances by default
    wire = figures_["process"]["wire"]
    assert wire["feed"] == "auto" and wire["feed_mm_s"] * np.pi * 0.6**2 == pytest.approx(
        4.0 * 15.0 * 6.0
    )


def test_solids_on_hubs_count_as_wide_as_they_are_filled(doc):
    """A box on a rod has nearly its own volume with beads at a spacing of 4 mm; beads counted 8 mm
    wide would give twice that."""
    import Part
    from FreeCAD import Vector

    from freecad_am.core.parameters.process import ProcessParameters
    from freecad_am.core.simulation import timeline

    rod, box = doc.addObject("Part::Feature", "Rod"), doc.addObject("Part::Feature", "Block")
    rod.Shape = Part.makeCylinder(20.0, 100.0)
    solid = Part.makeBox(24.0, 24.0, 40.0, Vector(15.0, -12.0, 30.0)).cut(rod.Shape)
    box.Shape = solid
    feature = api.make_developable_feature(
        doc, box, rod, layer_height=2.0, bead_spacing=4.0, chord_error=0.1
    )
    volumes = {}
    for width, options in ((4.0, {}), (5.0, {"bead_width": 5.0})):
        toolpath = api.make_toolpath(doc, feature, **options)
        toolpath_result, process = (
            api.result(toolpath),
            toolpath.Proxy.parameters(toolpath, ProcessParameters),
        )
        volumes[width] = timeline.volumes(
            timeline.deposit_motion(toolpath_result), process, toolpath_result
        ).sum()
        assert volumes[width] == pytest.approx(toolpath_result.length * width * 2.0, rel=1e-9)
    assert volumes[4.0] == pytest.approx(solid.Volume, rel=0.15)
