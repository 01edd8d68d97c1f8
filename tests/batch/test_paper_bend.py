# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command plans the bend of Chalvin 2019, and the test measures the figures of the errata
without the program's own code. The errata count layers to the first that is entirely past 90 deg,
so the wall of these jobs continues to 175 deg."""

import math
from pathlib import Path

import FreeCAD
import numpy as np
import Part
import pytest

from tests.batch import wall_checks
from tests.batch.wall_examples import Plans, rod

BEND, TUBE, WIDE_TUBE, PIPE = 60.0, 15.0, 25.0, 32.0
PASSED = math.radians(90.0)


@pytest.fixture(scope="module")
def plans(tmp_path_factory):
    example_plans = Plans(Path(__file__).resolve().parents[2], tmp_path_factory.mktemp("paper"))
    for name, tube in (("long-tube", TUBE), ("long-wide-tube", WIDE_TUBE)):
        torus = Part.Toroid()
        torus.MajorRadius, torus.MinorRadius = BEND, tube
        torus.Center, torus.Axis = FreeCAD.Vector(-BEND, 0, 0), FreeCAD.Vector(0, -1, 0)
        torus.toShape(0.0, math.radians(175.0), 0.0, 2.0 * math.pi).exportStep(
            str(example_plans.folder / f"{name}.step")
        )
    return example_plans


@pytest.fixture(scope="module")
def sliced(plans):
    """Return the beads of the layers up to the first entirely past 90 deg, for (tube, layer height,
    spacing, chord error, method)."""

    def beads(tube, height, spacing, chord_error, method="auto"):
        text = plans.exact(plans.text("tube-on-pipe"), chord_error)
        text = text.replace(
            "layer_height: 5 mm", f"layer_height: {height:g} mm\n  method: {method}"
        )
        text = text.replace("constant-distance", spacing)
        text = text.replace(
            "tube-on-pipe.step", "long-tube.step" if tube == TUBE else "long-wide-tube.step"
        )
        layers = plans.plan("tube-on-pipe", text).layers
        rings = [[bead for bead in layer if bead.closed] for layer in layers]
        past = next(
            number for number, layer in enumerate(rings) if angle(layer[0].points).min() > PASSED
        )
        assert all(len(ring) == 1 for ring in rings[: past + 1])
        # fronts close the gaps at their corners with beads of their own
        assert method == "fronts" or all(len(layer) == 1 for layer in layers[: past + 1])
        return [ring[0] for ring in rings[: past + 1]]

    return beads


def angle(points):
    """Return the angle around the axis of the bend from its start."""
    return np.arctan2(points[:, 2], points[:, 0] + BEND)


def distances(beads):
    return [
        wall_checks.nearest(above.points, [below.points]).distance
        for below, above in zip(beads, beads[1:])
    ]


@pytest.mark.parametrize(
    "tube, height, count, chord_error, method",
    [
        (TUBE, 5.0, 16, 2e-5, "auto"),
        pytest.param(TUBE, 5.0, 16, 2e-5, "fronts", marks=pytest.mark.long),
        pytest.param(TUBE, 1.0, 72, 5e-5, "auto", marks=pytest.mark.long),
        pytest.param(WIDE_TUBE, 5.0, None, 2e-5, "auto", marks=pytest.mark.long),
    ],
)
def test_corrected_layers(sliced, tube, height, count, chord_error, method):
    """Thousands of points around each layer, corners included, are at the corrected distances;
    fronts give the same layers."""
    beads = sliced(tube, height, "constant-distance", chord_error, method)
    if count is not None:
        assert len(beads) == count
    assert min(len(bead.points) for bead in beads) > (1200 if height == 5.0 else 900)
    assert np.abs(np.concatenate(distances(beads)) - height).max() <= 1e-4
    for bead in beads:
        x, y, z = bead.points.T
        assert np.abs(np.hypot(np.hypot(x + BEND, z) - BEND, y) - tube).max() <= 1e-5
    # fronts start from a curve through points of both surfaces, off the pipe by at most the chord
    # error
    assert np.abs(rod(0.0, 0.0, PIPE)(beads[0].points)).max() <= (
        1e-5 if method == "auto" else chord_error
    )


@pytest.mark.parametrize(
    "height, count, chord_error",
    [(5.0, 19, 1e-4), pytest.param(1.0, 87, 1e-2, marks=pytest.mark.long)],
)
def test_layers_of_equation_2(sliced, height, count, chord_error):
    beads = sliced(TUBE, height, "iso-parameter", chord_error)
    assert len(beads) == count
    if height == 5.0:
        assert min(layer_distances.min() for layer_distances in distances(beads)) == pytest.approx(
            2.49, abs=0.005
        )
        assert max(layer_distances.max() for layer_distances in distances(beads)) <= 5.0 + 1e-4


@pytest.mark.parametrize(
    "tube, turn", [(TUBE, 97.0), pytest.param(WIDE_TUBE, 105.0, marks=pytest.mark.long)]
)
def test_the_corner_on_the_outside_of_the_bend(sliced, tube, turn):
    """The corner is a single point of the last layer, in the plane of the bend, and as sharp as the
    errata state."""
    points = sliced(tube, 5.0, "constant-distance", 2e-5)[-1].points[:-1]
    step = np.diff(points, axis=0, append=points[:1])
    into = np.roll(step, 1, axis=0)
    cosine = (into * step).sum(1) / np.linalg.norm(into, axis=1) / np.linalg.norm(step, axis=1)
    turns = np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))
    corner = int(np.argmax(turns))
    assert turns[corner] == pytest.approx(turn, abs=0.5)
    assert np.delete(turns, corner).max() < 1.0
    assert (
        abs(points[corner, 1]) < 1e-5
        and np.hypot(points[corner, 0] + BEND, points[corner, 2]) > BEND
    )


@pytest.mark.long
def test_fronts_and_the_parameter_find_the_same_layers(sliced):
    """Each layer of one method lies on that of the other and has the same length."""
    both_methods = [
        sliced(TUBE, 5.0, "constant-distance", 2e-5, method) for method in ("auto", "fronts")
    ]
    for layer, front_layer in zip(*both_methods, strict=True):
        assert (
            max(
                wall_checks.nearest(a.points, [b.points]).distance.max()
                for a, b in ((layer, front_layer), (front_layer, layer))
            )
            < 1e-3
        )
        lengths = [
            np.linalg.norm(np.diff(bead.points, axis=0), axis=1).sum()
            for bead in (layer, front_layer)
        ]
        assert lengths[0] == pytest.approx(lengths[1], abs=1e-2)


@pytest.mark.long
@pytest.mark.parametrize("method", ["auto", "fronts"])
def test_smooth_layers_keep_the_band_by_either_method(sliced, method):
    all_distances = np.concatenate(distances(sliced(TUBE, 5.0, "smooth", 1e-3, method)))
    assert 4.0 - 2e-3 <= all_distances.min() < 4.2 and 5.8 < all_distances.max() <= 6.0 + 2e-3
