# SPDX-License-Identifier: LGPL-2.1-or-later
"""A patch of a face's surface gives the same points as FreeCAD's own evaluation."""

import FreeCAD
import numpy as np
import Part
import pytest

from freecad_am.brep.walls.surface_patch import patch_of


def loft():
    """Return a surface that is periodic in one span, like OpenCASCADE's loft of circle and
    ellipse."""
    low = Part.Wire([Part.makeCircle(16.0)])
    high = Part.Ellipse(FreeCAD.Vector(0, 0, 40), 28.0, 18.0).toShape()
    return Part.makeLoft([low, Part.Wire([high])], False, False).Faces[0]


def sweep():
    spine = Part.BSplineCurve()
    spine.interpolate(
        [FreeCAD.Vector(*point) for point in ((0, 0, 0), (0, 0, 20), (12, 4, 42), (30, 20, 55))]
    )
    profile = Part.Wire([Part.makeCircle(11.0, spine.value(0.0), spine.tangent(0.0)[0])])
    return Part.Wire([spine.toShape()]).makePipeShell([profile], False, False).Faces[0]


@pytest.mark.parametrize("make", [loft, sweep])
def test_closed_splines(make):
    face = make()
    patch = patch_of(face, "Face1")
    low_u, high_u, low_v, high_v = face.ParameterRange
    u, v = (
        grid.ravel()
        for grid in np.meshgrid(np.linspace(low_u, high_u, 23), np.linspace(low_v, high_v, 19))
    )
    exact = np.array([tuple(face.Surface.value(a, b)) for a, b in zip(u, v)])
    assert np.abs(patch.at(np.column_stack([u, v]))[0] - exact).max() < 1e-9
