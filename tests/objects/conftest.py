# SPDX-License-Identifier: LGPL-2.1-or-later
"""A document with a hemisphere and all stages made from it."""

from types import SimpleNamespace

import pytest

from freecad_am import api
from tests import plans

LABEL = "Hémisphère n° 1"


def sphere(doc, radius=45.0):
    """Return a parametric hemisphere whose label has blanks and accents."""
    sphere_object = doc.addObject("Part::Sphere", "Sphere")
    sphere_object.Label = LABEL
    sphere_object.Radius, sphere_object.Angle1, sphere_object.Angle2 = radius, 0, 90
    doc.recompute()
    return sphere_object


@pytest.fixture
def part(doc):
    return sphere(doc)


@pytest.fixture
def job(doc, part):
    """Return all stages with few layers, planned for the first test that needs them."""
    with plans.share_plans():
        cell = api.make_cell(doc, limits="paper")
        feature = api.make_feature(doc, part, layer_height=10)
        toolpath = api.make_toolpath(doc, feature, cell)
        joint_path = api.make_joint_path(doc, toolpath, cell)
        program = api.make_program(doc, joint_path, name="CUP")
    return SimpleNamespace(
        doc=doc,
        part=part,
        cell=cell,
        feature=feature,
        toolpath=toolpath,
        joint_path=joint_path,
        program=program,
        stages=(cell, feature, toolpath, joint_path, program),
    )
