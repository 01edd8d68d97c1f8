# SPDX-License-Identifier: LGPL-2.1-or-later
"""Layers fitted to scans, judged by the equation of the scanned surface at and between points."""

import itertools

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.inspection import scan_heights
from freecad_am.core.inspection.fit_layers import fit_layers, max_moves
from freecad_am.core.inspection.planned import align_scan
from freecad_am.core.inspection.scan_heights import Scan, facing, scanned
from freecad_am.core.issues import InputError
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import SolidParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.scan import ScanParameters
from freecad_am.core.simulation import timeline
from freecad_am.core.strategies.solids.plan import plan

HEIGHT = 2.0
UP = np.array([[0.0, 0.0, 1.0]])


def hull(points, name):
    convex_hull = ConvexHull(points)
    faces = convex_hull.simplices.copy()
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * convex_hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    return Body(name, points, faces.astype(np.int64))


def box(low, high, name="box"):
    return hull(np.array(list(itertools.product(*zip(low, high, strict=True))), dtype=float), name)


PLATE = box((-100, -60, -10), (100, 60, 0), "plate")


def bent(x, y):
    """Height (mm) of a tilted and bent plate."""
    return 0.02 * x - 0.01 * y + 0.8 * (x / 100.0) ** 2 - 0.5 * np.sin(y / 25.0)


def points_on(surface, size=(100.0, 60.0), count=30_000, noise=0.02, outliers=0.01, seed=1):
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(-1.0, 1.0, (2, count)) * np.array(size)[:, None]
    z = surface(x, y) + rng.normal(0.0, noise, count)
    wrong = rng.choice(count, int(outliers * count), replace=False)
    z[wrong] += rng.uniform(-20.0, 60.0, len(wrong))
    return np.column_stack([x, y, z])


@pytest.fixture(scope="module")
def block():
    strategy = SolidParameters(layer_height=HEIGHT, bead_spacing=6.25, chord_error=0.05)
    solids = prepare_stack([box((-60, -25, 0), (60, 25, 30))], strategy, "block")
    return plan(
        solids, strategy, BuildDirectionParameters(), ProcessParameters(travel_speed=6.0), None
    )


@pytest.fixture(scope="module")
def laid(block):
    return fit(block, points_on(bent))


def fit(toolpath, points, **parameters):
    scan_parameters = ScanParameters(**parameters)
    return fit_layers(
        toolpath,
        Scan(points, "scan.csv", scan_parameters.scan_within),
        scan_parameters,
        0,
        np.eye(4),
    )


def between(layer):
    """Nine points between each two neighbouring points of a layer, on the straight line."""
    share = np.linspace(0.0, 1.0, 10)[:, None, None]
    return np.vstack(
        [
            (bead.points[:-1] + share * np.diff(bead.points, axis=0)).reshape(-1, 3)
            for bead in layer.beads
        ]
    )


def test_the_first_layer_lies_on_what_was_scanned_and_the_others_lead_back(block, laid):
    """The first layer follows the scanned surface, and the next layers return to the plan."""
    fitted = laid
    x, y, _ = fitted.checks.fitted.places.T
    assert np.abs(fitted.checks.fitted.off - bent(x, y)).max() < 0.06
    count = fitted.checks.fitted.layers
    assert (
        count - 1 < np.abs(fitted.checks.fitted.off).max() / (0.2 * HEIGHT) <= count
    )  # the fewest layers that keep heights within a fifth
    for number, layer in enumerate(fitted.layers):
        x, y, z = between(layer).T
        share = max(0.0, 1.0 - number / count)
        assert (
            np.abs(z - number * HEIGHT - share * bent(x, y)).max() < 0.06
        )  # three times the noise
    for planned_layer, fitted_layer in zip(
        block.layers[count:], fitted.layers[count:], strict=True
    ):
        assert planned_layer is fitted_layer  # a layer back at the plan is the planned object


def test_outliers_move_nothing(laid):
    """With one point in a hundred wrong, patches differ from the clean ones by less than their
    noise."""
    points, clean = points_on(bent), points_on(bent, outliers=0.0)
    points_of_bead = laid.layers[0].beads[0].points
    wrong, right = (
        Scan(cloud, "s", 5.0).heights(points_of_bead, np.tile(UP, (len(points_of_bead), 1))).off
        for cloud in (points, clean)
    )
    assert (np.abs(points - clean).max(axis=1) > 1.0).mean() > 0.009
    assert np.abs(wrong - right).max() < 0.02


def test_thinner_layers_are_laid_faster_by_as_much(laid):
    """Thinner layers are printed faster in proportion, so that the deposited volume per mm
    stays."""
    fitted = laid
    for number in range(fitted.checks.fitted.layers):
        low, high = fitted.checks.uneven[number, 1:]
        assert 0.79 * HEIGHT < low < high < 1.21 * HEIGHT
        for bead in fitted.layers[number].beads:
            middle = 0.5 * (bead.height[1:] + bead.height[:-1])
            assert bead.speed[1:] * middle == pytest.approx(
                6.0 * HEIGHT, rel=1e-9
            )  # the same flow everywhere
    tops = [np.concatenate([bead.points[:, 2] for bead in layer.beads]) for layer in fitted.layers]
    assert fitted.layers[0].beads[0].height[0] == pytest.approx(
        HEIGHT - bent(*fitted.layers[0].beads[0].points[0, :2]) / fitted.checks.fitted.layers,
        abs=0.02,
    )
    assert tops[-1] == pytest.approx((len(fitted.layers) - 1) * HEIGHT)


def test_after_a_layer_the_next_lies_on_what_has_grown(block):
    """After a measured layer the next one follows the measured surface."""

    def measured_height(x, y):
        return 10.0 - 0.4 + 0.004 * x + 0.2 * (y / 25.0) ** 2

    fitted = fit(block, points_on(measured_height, (60.0, 25.0), 15_000), after_layer=4)
    x, y, z = between(fitted.layers[5]).T
    assert np.abs(z - measured_height(x, y)).max() < 0.06
    for number in range(5):  # lower layers are spread evenly up to the measured height
        x, y, z = between(fitted.layers[number]).T
        assert np.abs(z - number / 5.0 * measured_height(x, y)).max() < 0.06
    assert all(
        fitted_layer is planned_layer
        for fitted_layer, planned_layer in zip(fitted.layers[9:], block.layers[9:], strict=True)
    )


def test_scans_that_do_not_serve_are_refused(block):
    """Unusable scans are rejected with a code."""
    points = points_on(bent)
    for code, cloud, options in (
        ("SCAN_MISSES", points[points[:, 0] < 0.0], {}),
        ("SCAN_MISSES", points[:5], {}),
        ("SCAN_OFF", points + (0.0, 0.0, 4.0), {}),
        ("NO_LAYER", points, {"after_layer": 14}),
    ):
        with pytest.raises(InputError) as error:
            fit(block, cloud, **options)
        assert error.value.code == code
    assert fit(block, points + (0.0, 0.0, 4.0), scan_within=7.0).checks.fitted.off.min() > 2.0


def test_a_part_with_few_layers_tells_what_remains(block):
    """A part with too few layers to compensate reports the remaining deviation."""
    fitted = fit(block, points_on(lambda x, y: 4.5 + 0.0 * x), scan_band=0.1)
    warnings = [issue for issue in fitted.issues if issue.code == "SCAN_REMAINS"]
    remaining = (
        np.concatenate([bead.points[:, 2] for bead in fitted.layers[-1].beads]) - 14 * HEIGHT
    )
    assert len(warnings) == 1 and remaining.max() > 1.0
    assert f"up to {fitted.checks.fitted.remains:.3f} mm" in warnings[0].message
    assert fitted.checks.fitted.remains == pytest.approx(remaining.max(), abs=0.02)


def test_units_and_other_parts_are_told_from_the_part():
    points = points_on(bent)
    scan_heights.refuse_size(points, "s", PLATE)
    for factor, unit in ((1e-3, "m"), (1.0 / 25.4, "inch"), (0.1, "cm")):
        with pytest.raises(InputError, match=rf"the size would match in {unit};") as error:
            scan_heights.refuse_size(points * factor, "s", PLATE)
        assert error.value.code == "SCAN_UNIT"
    scan_heights.refuse_other(points, "s", PLATE, 5.0)
    ball = np.random.default_rng(2).normal(size=(5000, 3))
    ball *= 80.0 / np.linalg.norm(ball, axis=1, keepdims=True)
    with pytest.raises(
        InputError, match=r"% of the 5000 scanned points are within 5 mm of plate"
    ) as error:
        scan_heights.refuse_other(ball, "s", PLATE, 5.0)
    assert error.value.code == "SCAN_OTHER"


def test_a_scan_from_anywhere_is_laid_onto_the_part():
    """All sides of a wedge, which no rotation maps onto itself; a part with half-turn symmetry is
    rejected."""
    wedge = hull(
        np.array(
            [(0, 0, 0), (90, 0, 0), (0, 50, 0), (90, 50, 0), (0, 0, 40), (0, 30, 40)], dtype=float
        ),
        "wedge",
    )
    rng, corner = np.random.default_rng(3), wedge.corners()
    area = np.linalg.norm(
        np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1
    )
    share = rng.dirichlet((1.0, 1.0, 1.0), 8000)
    points = np.einsum(
        "nk,nkc->nc", share, corner[rng.choice(len(corner), 8000, p=area / area.sum())]
    )
    points += rng.normal(0.0, 0.02, points.shape)
    points[:80] += rng.uniform(-40.0, 40.0, (80, 3))
    turn = Rotation.from_euler("xyz", [70.0, -40.0, 130.0], degrees=True).as_matrix()
    motion = align_scan(points @ turn.T + (500.0, -200.0, 90.0), wedge, "s")
    back = (points @ turn.T + (500.0, -200.0, 90.0)) @ motion[:3, :3].T + motion[:3, 3]
    assert np.linalg.norm(back - points, axis=1).max() < 0.1
    top = points_on(bent)
    with pytest.raises(InputError) as error:
        align_scan(top @ turn.T + (500.0, -200.0, 90.0), PLATE, "s")
    assert error.value.code == "SCAN_AMBIGUOUS"


def test_the_body_to_keep_clear_of_is_where_it_was_scanned():
    """The obstacle follows the scanned surface."""
    points = points_on(bent)
    body = scanned(PLATE, Scan(points, "s", 5.0), UP)
    x, y, z = body.vertices[body.vertices[:, 2] > -3.0].T
    inside = (np.abs(x) < 95.0) & (np.abs(y) < 55.0)
    assert inside.sum() > 100 and np.abs(z - bent(x, y))[inside].max() < 0.06
    assert (
        body.vertices[:, 2].min() == -10.0 and (body.vertices[:, 2] == -10.0).sum() > 100
    )  # its underside stays
    two_sided = np.vstack([points[:500], points[:500] - (0.0, 0.0, 10.0)])
    assert (
        facing(two_sided, PLATE, UP)[:500].mean() > 0.95
        and facing(two_sided, PLATE, UP)[500:].mean() < 0.05
    )


@pytest.mark.parametrize(
    ("surface", "parameters"),
    [
        (bent, {}),
        (bent, {"scan_band": 0.05}),
        (lambda x, y: 10.0 - 0.4 + 0.004 * x, {"after_layer": 4}),
        (lambda x, y: 4.5 + 0.0 * x, {"scan_band": 0.1}),
    ],
)
def test_how_far_layers_are_moved_at_most_is_known_of_each(block, surface, parameters):
    """The maximum displacement of each layer is known in advance."""
    fitted = fit(block, points_on(surface), **parameters)
    max_moves_of_layers = max_moves(fitted.checks.fitted, np.arange(len(fitted.layers)))
    moves = np.array(
        [
            max(np.abs(bead.points[:, 2] - number * HEIGHT).max() for bead in layer.beads)
            for number, layer in enumerate(fitted.layers)
        ]
    )
    assert (
        moves <= max_moves_of_layers + 0.03
    ).all()  # patches of neighbours extend slightly beyond the first layer
    assert (
        np.abs(moves - max_moves_of_layers).max() < 0.1 * max_moves_of_layers.max() + 0.03
        and max_moves_of_layers[fitted.checks.fitted.layer] > 0.1
    )


def test_the_volume_is_that_of_layers_as_high_as_they_were_fitted(block):
    """A plate that lies 1.2 mm lower takes correspondingly more volume."""
    process = ProcessParameters(travel_speed=6.0)
    low = fit(block, points_on(lambda x, y: -1.2 + 0.0 * x))
    planned, laid = (
        timeline.volumes(timeline.deposit_motion(path), process, path).sum()
        for path in (block, low)
    )
    total = HEIGHT * len(block.layers)
    assert laid / planned == pytest.approx((total + 1.2) / total, rel=2e-3)
