# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of flattened layers, where a layer is too narrow for any bead."""

from types import SimpleNamespace

from freecad_am.report.charts import layer_charts


def test_a_layer_without_beads_has_no_picture():
    layers = [SimpleNamespace(first=number == 0, beads=()) for number in range(3)]
    solids = SimpleNamespace(groups=[SimpleNamespace(bodies=[0])])
    assert layer_charts(solids, SimpleNamespace(layers=layers, layer_height=1.0)) == []
