# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command plans the shipped walls on existing parts, and the test measures them without the
program's own code."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from tests.batch import wall_checks
from tests.batch.wall_examples import EXAMPLES, LONG_EXAMPLES, Plans
from tests.swept_beads import Cone, Swept

CHORD_MM = 0.01  # mm, the chord error of the jobs
FINE_CHORD_MM = 2e-5  # mm, at which chords represent the curve
TOLERANCE = 1e-4  # mm, of the local distance
NOZZLE_TIP, NOZZLE_ANGLE = (
    0.5,
    np.radians(20.0),
)  # mm, rad; radius of the tip, half the cone's angle
BEND, TUBE, PIPE = (
    60.0,
    15.0,
    32.0,
)  # mm, radii of the paper's bend, its tube and the pipe
TURN = 30.0  # deg/mm, the largest turn of the build direction, build_direction.max_turn


@pytest.fixture(scope="module")
def plans(tmp_path_factory):
    return Plans(Path(__file__).resolve().parents[2], tmp_path_factory.mktemp("walls"))


def name_of(example):
    return example.job.split("/")[-1] + " in thicker layers" * example.thicker


ALL = [*EXAMPLES, *(pytest.param(example, marks=pytest.mark.long) for example in LONG_EXAMPLES)]


@pytest.fixture(scope="module", params=ALL, ids=name_of)
def example(request):
    return request.param


@pytest.fixture(scope="module")
def planned(example, plans):
    """Return the job as shipped, or in thicker layers."""
    return plans.plan(example.job, plans.text_of(example) if example.thicker else None)


@pytest.fixture(scope="module")
def exact(example, plans):
    """Return the same without a cell and with dense points."""
    return plans.plan(example.job, plans.exact(plans.text_of(example), FINE_CHORD_MM))


@pytest.fixture(scope="module")
def wall(example, plans):
    return wall_checks.read_wall(plans.folder / example.wall, example.depth)


@pytest.mark.parametrize(
    "job", [example.job for example in (*EXAMPLES, *LONG_EXAMPLES) if example.has_cell]
)
def test_a_platform_of_an_example_is_under_what_it_carries(job, plans):
    """The plate is under the frame of the part; a part outside that frame hangs in a clamp and has
    no plate."""
    settings = yaml.safe_load(plans.text(job))
    cell, path = settings["cell"], (plans.folder / job).parent / settings["substrate"]["file"]
    box = wall_checks.bounds(path)
    beside = np.hypot(
        *np.maximum(np.abs((box[0] + box[1])[:2] / 2.0) - (box[1] - box[0])[:2] / 2.0, 0.0)
    )
    diameter = float(str(cell.get("platform_diameter", "113 mm")).split()[0])
    assert diameter == 0.0 or (2.0 * beside < diameter and abs(box[0, 2]) < 1.0)


def test_jobs_with_a_cell_end_in_a_verified_program(example, planned):
    assert planned.report["status"] == "ok"
    assert bool(planned.report["programs"]) == example.has_cell
    if example.has_cell:
        assert planned.report["joints"]["feasible"] is True
        assert (
            min(
                margin
                for margin in planned.report["joints"]["limit_margin_deg"]
                if margin is not None
            )
            > 0.0
        )


def test_points_lie_on_the_wall(planned, exact, wall):
    shuffle = np.random.default_rng(20).permutation
    assert wall.off(shuffle(planned.points)[:150]) <= CHORD_MM
    assert wall.off(shuffle(exact.points)[:150]) <= TOLERANCE


def test_the_first_layer_lies_on_the_substrate(example, planned, exact):
    for run, error in ((planned, CHORD_MM), (exact, TOLERANCE)):
        for bead in run.layers[0]:
            assert np.abs(example.depth(bead.points)).max() <= error + example.substrate_error
    assert all(
        example.depth(bead.points).min() > 0.0 for layer in exact.layers[2:] for bead in layer
    )


def test_layers_are_at_the_layer_height_everywhere(example, exact):
    """At every point, hundreds of times denser than the jobs require and corners included, the
    distance is the layer height."""
    spacing = wall_checks.spacing(exact, example.height, 10.0 * TOLERANCE)
    assert np.abs(spacing.inside - example.height).max() <= example.spacing_error
    if len(spacing.at_ends):  # cut at an edge of the wall, where the curve continued below
        assert spacing.at_ends.min() >= example.height - example.spacing_error
    messages = [issue["message"] for issue in exact.report["issues"] if issue["code"] == "CLOSING"]
    assert len(spacing.closing) == sum(int(message.split()[0]) for message in messages)
    assert all(distance.min() >= 0.4 * example.height for distance in spacing.closing)


def test_the_wall_is_covered(example, planned, wall):
    anywhere, at_end = wall_checks.coverage(planned, wall, 0.2 * example.height, example.height)
    assert anywhere <= 0.6 * example.height + wall_checks.SAMPLING
    assert at_end <= example.height


def test_beads_lie_on_what_was_deposited_before(example, exact):
    max_distance = wall_checks.support(exact, example.depth)
    assert max_distance <= example.height + 2.0 * example.spacing_error + example.substrate_error


def test_seams_follow_one_another(example, planned):
    """The step between seams is the layer height, or more where the front itself takes longer steps
    up the lines of the wall."""
    steps = wall_checks.seam_steps(planned)
    assert steps.size == 0 or (
        steps.min() >= example.height - CHORD_MM and steps.max() <= 1.75 * example.height
    )


def test_build_directions_are_continuous(planned):
    assert wall_checks.turn_rate(planned) <= 1.01 * TURN


def test_the_nozzle_keeps_clear_of_the_substrate(example, planned):
    """Only the rim of the flat tip dips in, where the first layer leans on the substrate."""
    if example.job == "tube-on-pipe":  # as in the paper, which does not change the directions
        return
    for bead in planned.passes:
        clearance = wall_checks.nozzle_depth(bead, example.depth, NOZZLE_TIP, 60.0, NOZZLE_ANGLE)
        assert clearance >= -(NOZZLE_TIP if bead.layer == 0 else CHORD_MM)


def depth_in_deposit(example, planned, points, step):
    """Return how many mm earlier beads, with their full width and height, are in the nozzle, at a
    limited number of points of each bead. Beads that close gaps are left out: they are nearer to
    their neighbours than a layer height, and their number is checked against the report."""
    assert planned.report["process"]["bead_width_counted_mm"] == 8.0
    laid = Swept(
        [
            (
                bead_pass.points,
                bead_pass.build,
                np.full(len(bead_pass.points), 8.0),
                np.full(len(bead_pass.points), example.height),
                bead_pass.layer,
            )
            for bead_pass in planned.passes
        ],
        step,
    )
    cone = Cone(NOZZLE_TIP, NOZZLE_ANGLE, 60.0)
    low, deepest, closing = cone.clear_of(example.height, 0.0), -np.inf, 0
    for k, bead_pass in enumerate(planned.passes):
        if bead_pass.layer:
            below = [lower_pass.points for lower_pass in planned.layers[bead_pass.layer - 1]]
            if (
                wall_checks.nearest(bead_pass.points, below).distance < 0.99 * example.height
            ).mean() > 0.9:
                closing += 1
                continue
        for j in np.unique(
            np.linspace(0, len(bead_pass.points) - 1, min(points, len(bead_pass.points))).astype(
                int
            )
        ):
            number = laid.begin[k] + j + 1
            deepest = max(
                deepest,
                laid.deepest(
                    bead_pass.points[j], bead_pass.tool[j], number, laid.layer_began(k), cone, low
                ),
            )
    messages = [
        issue["message"] for issue in planned.report["issues"] if issue["code"] == "CLOSING"
    ]
    assert closing == sum(int(message.split()[0]) for message in messages)
    return deepest


@pytest.fixture(scope="module")
def without_cell(example, plans, request):
    """Return the job with the toolpath's own points only; None for the paper's job, which does not
    change the directions."""
    if example.job == "tube-on-pipe":
        return None
    if not example.has_cell:
        return request.getfixturevalue("planned")
    return plans.plan(example.job, plans.text(example.job).split("\ncell:")[0] + "\n")


def test_the_nozzle_keeps_clear_of_beads_as_wide_as_they_are(example, without_cell):
    if without_cell is None:
        return
    assert depth_in_deposit(example, without_cell, 12, 1.5) <= CHORD_MM


@pytest.mark.long
def test_the_nozzle_keeps_clear_of_beads_as_wide_as_they_are_at_all_points(example, without_cell):
    if without_cell is None:
        return
    assert depth_in_deposit(example, without_cell, 400, 0.4) <= CHORD_MM


def test_the_bend_grows_on_the_pipe_as_in_the_paper(plans):
    run = plans.plan("tube-on-pipe")
    assert run.report["counts"]["layers"] == 15  # the 16th of the errata is entirely past the end
    assert run.report["joints"]["feasible"] is True and run.report["programs"] == [
        "program/TUBE_ON_PIPE.LS"
    ]
    x, y, z = run.points.T
    off = np.hypot(np.hypot(x + BEND, z) - BEND, y) - TUBE
    assert np.abs(off).max() < 0.0105  # the chord error, because planning adds points on the chords
    first_layer = np.concatenate([bead.points for bead in run.passes if bead.layer == 0])
    assert np.abs(np.hypot(first_layer[:, 0], first_layer[:, 2]) - PIPE).max() < 0.0105
    assert np.arctan2(z, x + BEND).max() <= 0.5 * np.pi + 1e-6
    tool = np.concatenate([bead.tool for bead in run.passes])
    assert (
        np.abs(tool[:, 1]).max() < 1e-9 and np.degrees(np.arccos(tool[:, 2].min())) <= 85.0 + 1e-6
    )


def test_the_half_shell_is_deposited_to_and_fro(plans):
    layers = plans.plan("walls/half-shell-on-rod").layers
    assert all(len(layer) == 1 and not layer[0].closed for layer in layers[:5])
    towards = np.array([layer[0].points[-1, 1] - layer[0].points[0, 1] for layer in layers[:6]])
    assert (np.sign(towards) == np.sign(towards[0]) * (-1.0) ** np.arange(6)).all()


@pytest.mark.long
def test_the_front_of_the_branched_tube_splits_in_two(plans):
    layers = plans.plan("walls/branched-tube-on-plate").layers
    closed = [sum(bead.closed for bead in layer) for layer in layers]
    split = closed.index(2)
    assert all(len(layer) == 1 and layer[0].closed for layer in layers[:split])
    assert closed[split : split + 3] == [2, 2, 2]
    centres = np.array([bead.points.mean(axis=0) for bead in layers[split + 2]])
    assert np.linalg.norm(centres[0] - centres[1]) > 12.0


def test_a_mesh_serves_as_well_as_the_solid(plans):
    solid = plans.plan("tube-on-pipe", plans.exact(plans.text("tube-on-pipe"), FINE_CHORD_MM))
    mesh = plans.plan(
        "walls/tube-on-scanned-pipe",
        plans.exact(plans.text("walls/tube-on-scanned-pipe"), FINE_CHORD_MM),
    )
    assert len(mesh.layers) == len(solid.layers) == 15
    for mesh_layer, solid_layer in zip(mesh.layers, solid.layers):
        assert (
            wall_checks.nearest(mesh_layer[0].points, [solid_layer[0].points]).distance.max()
            <= 0.05
        )
