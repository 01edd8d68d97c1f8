# SPDX-License-Identifier: LGPL-2.1-or-later
"""A job for window tests: a part of revolution on a positioner, under a torch on a robot."""

from freecad_am import api


def make_positioner_job(source, layer_height):
    """Return the joint path, with feature, cell and toolpath in the document of a part."""
    doc = source.Document
    feature = api.make_feature(doc, source, layer_height=layer_height, max_from_vertical=10)
    cell = api.make_cell(
        doc,
        machine="kuka-kr8-r2100-2-arc-hw",
        setup="tool-on-robot",
        branch="auto",
        platform=20,
        external="motoman-motopos-d500 at 1400 0 0 0 0 0 carries part",
        nozzle_tool=(0.0, 0.0, 300.0, 0.0, 0.0, 0.0),
    )
    return api.make_joint_path(doc, api.make_toolpath(doc, feature, cell), cell)
