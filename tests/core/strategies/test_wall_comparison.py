# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's bend sliced by every method: the figures of the errata; an inapplicable method gives
its reason."""

import numpy as np
import pytest

from freecad_am.core.geometry.columns import Round
from freecad_am.core.geometry.walls.surface import Torus
from freecad_am.core.geometry.walls.surface_wall import SurfaceWall
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.slicing.first_layer import intersect_implicit
from freecad_am.core.slicing.tubes.smooth_spacing import even_grid
from freecad_am.core.strategies.walls import comparison as wall_comparison
from freecad_am.core.strategies.walls.comparison import NORMAL, Refused


def bend(tube=15.0):
    torus = Torus(60.0, tube)
    base_layer = intersect_implicit(
        torus, Round.cylinder(32.0, [0, 0, 0], [0, 1, 0]), (0.0, 1.5), even_grid(torus, 360)
    )
    return SurfaceWall("torus", (60.0, tube), np.eye(4), 0.5 * np.pi, base_layer.curve.points[:-1])


@pytest.fixture(scope="module")
def compared():
    return {
        method_result.method: method_result
        for method_result in wall_comparison.compare(bend(), SurfaceParameters(layer_height=5.0))
    }


def test_iso_parameter_and_constant_distance_are_those_of_the_errata(compared):
    """Both methods have the figures of the errata."""
    iso_parameter, constant_distance = compared["iso-parameter"], compared["constant-distance"]
    assert (iso_parameter.layers, constant_distance.layers) == (19, 16)
    assert iso_parameter.smallest == pytest.approx(2.49, abs=0.005)
    assert iso_parameter.largest == pytest.approx(5.0, abs=1e-4)
    assert (constant_distance.smallest, constant_distance.largest) == pytest.approx(
        (5.0, 5.0), abs=1e-3
    )
    # figure 9: the step along the lines v = const is the layer height for iso-parameter, and up to
    # 1.52 times as much for constant distance
    assert all(np.allclose(step, 5.0, atol=1e-4) for step in iso_parameter.step)
    assert max(step.max() for step in constant_distance.step) == pytest.approx(5.0 * 1.52, abs=0.03)
    assert iso_parameter.corners == 0 and iso_parameter.corner == 0.0
    assert constant_distance.corners == 11 and np.degrees(
        constant_distance.corner
    ) == pytest.approx(94.0, abs=1.0)  # 97 beyond the end


def test_layers_normal_to_the_centreline_fan_out(compared):
    normal = compared[NORMAL]
    angle = 5.0 / 60.0
    assert normal.largest == pytest.approx(2.0 * 75.0 * np.sin(0.5 * angle), abs=1e-4)
    assert normal.smallest == pytest.approx(2.0 * 45.0 * np.sin(0.5 * angle), abs=1e-4)
    assert normal.turn == pytest.approx(0.0, abs=1e-6)  # meridians are geodesics
    starts = [np.isfinite(distance).any() for distance in normal.distance]
    assert all(starts)
    last_distances, positions = normal.distance[-1], normal.around[-1]
    assert positions[np.argmax(last_distances)] == pytest.approx(
        0.0, abs=2e-3
    )  # v = 0 is the outside of the bend
    assert np.isnan(normal.distance[0]).any() and np.isfinite(normal.distance[-1]).all()


def test_smooth_keeps_band_and_turn(compared):
    smooth, exact = compared["smooth"], compared["constant-distance"]
    assert smooth.smallest >= 4.0 and smooth.largest <= 6.0 and smooth.corners == 0
    assert smooth.turn <= np.radians(6.0)
    assert (
        np.radians(6.0) < exact.turn < np.radians(60.0)
    )  # next to corners; a corner is not a turn per mm


def test_the_figures_hang_together(compared):
    """The figures of a method are consistent with each other."""
    for method_result in compared.values():
        assert (
            len(method_result.around)
            == len(method_result.distance)
            == len(method_result.step)
            == method_result.layers - 1
            == len(method_result.curves) - 1
        )
        assert method_result.smallest <= method_result.mean <= method_result.largest
        for around, distance, step in zip(
            method_result.around, method_result.distance, method_result.step, strict=True
        ):
            assert len(around) == len(distance) == len(step)
            assert -0.5 <= around[0] < around[-2] <= 0.5 and (np.diff(around) > 0.0).all()
            assert around[-1] == pytest.approx(around[0] + 1.0)
            assert [distance[0], step[0]] == pytest.approx([distance[-1], step[-1]], nan_ok=True)
            assert (step >= distance - 1e-3)[
                np.isfinite(step)
            ].all()  # the nearest point is nearer than the one below
        reach = np.concatenate(method_result.curves)
        assert (
            np.nanmin(reach[:, 0] ** 2 + reach[:, 2] ** 2) >= (32.0 - 1e-3) ** 2
        )  # above the pipe
        assert np.nanmin(reach[:, 0]) >= -60.0 - 1e-6  # below the end


def test_a_method_that_cannot_be_is_told_with_its_reason(monkeypatch):
    def refuse(*_, **__):
        raise InputError("NOT_NORMAL", "wall", "not for this wall")

    monkeypatch.setattr(wall_comparison.normal_layers, "layers", refuse)
    results = wall_comparison.compare(bend(), SurfaceParameters(layer_height=10.0))
    assert Refused(NORMAL, "not for this wall") in results
    assert sum(isinstance(method_result, Refused) for method_result in results) == 1


def test_unknown_spacings_are_refused():
    with pytest.raises(InputError, match="smooth"):
        SurfaceParameters(compare=("smoth",))
