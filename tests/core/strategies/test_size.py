# SPDX-License-Identifier: LGPL-2.1-or-later
"""The size of a toolpath is estimated before planning, and absurd sizes are rejected at once."""

import dataclasses
import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from freecad_am.core.geometry.curves.profile import Meridian, RevolvedWall, arc, line
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.geometry.walls.mesh_wall import mesh_wall
from freecad_am.core.geometry.walls.patch_wall import CladFaces, FirstCurve
from freecad_am.core.issues import InputError
from freecad_am.core.layers.stacking import prepare_stack
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.cell import NozzleParameters
from freecad_am.core.parameters.filled import (
    CladdingParameters,
    DevelopableParameters,
    SolidParameters,
)
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.strategy import MOST_LAYERS, RevolutionParameters, SurfaceParameters
from freecad_am.core.strategies import cladding, estimated_size
from freecad_am.core.strategies.revolution import plan as revolution
from freecad_am.core.strategies.solids.plan import plan as plan_solids
from freecad_am.core.strategies.walls import fronts as wall_fronts
from freecad_am.core.strategies.walls import plan as surface
from tests.core.strategies.test_developable import CONE, CYLINDER, box, collar, solids
from tests.core.strategies.test_surface import TILTED, bend, tube
from tests.core.strategies.test_wall_fronts import WALLS

UNRESTRICTED = BuildDirectionParameters(clearance="none", max_tilt=np.pi)
DOME = RevolvedWall(Meridian.chained([arc((0.0, 0.0), 45.0, 0.0, np.pi / 2)]), np.eye(4))
VASE = RevolvedWall(
    Meridian.chained([line((60.0, 0.0), (20.0, 50.0)), line((20.0, 50.0), (45.0, 70.0))]), np.eye(4)
)
SECTOR = dataclasses.replace(VASE, start=0.3, end=1.7, full=False)
PROCESS = ProcessParameters()


def plan_revolution(wall, **values):
    strategy = RevolutionParameters(**values)
    return estimated_size.revolution_size(wall, strategy), revolution.plan(
        wall, strategy, UNRESTRICTED, PROCESS, NozzleParameters(), 0.0
    )


def plan_wall(wall, **values):
    strategy = SurfaceParameters(**values)
    family = surface if wall.closes_around else wall_fronts
    return estimated_size.wall_size(wall, strategy), family.plan(
        wall, strategy, UNRESTRICTED, PROCESS
    )


def plan_rotary_solid(hub_solids, **values):
    strategy = DevelopableParameters(**{"layer_height": 3.0, "bead_spacing": 3.0, **values})
    return estimated_size.solids_size(hub_solids, strategy), plan_solids(
        hub_solids, strategy, BuildDirectionParameters(), PROCESS, None
    )


def plan_cladding(wall, **values):
    sheet = dataclasses.replace(
        wall, first=(), rims=(), behind=np.zeros(len(wall.vertices), dtype=bool)
    )
    strategy = CladdingParameters(**values)
    faces = CladFaces("part", ("Face1",), (sheet,))
    return estimated_size.cladding_size(faces, strategy), cladding.plan(
        faces, strategy, BuildDirectionParameters(), PROCESS, None
    )


@pytest.mark.parametrize(
    "make",
    [
        lambda: plan_revolution(DOME, layer_height=0.7),
        lambda: plan_revolution(VASE, layer_height=0.5, chord_error=0.002),
        lambda: plan_revolution(VASE, layer_height=0.4, spacing="iso-height"),
        lambda: plan_revolution(SECTOR, layer_height=0.5),
        lambda: plan_revolution(DOME, layer_height=0.5, min_points=300, chord_error=0.1),
        lambda: plan_wall(tube(), layer_height=1.0),
        lambda: plan_wall(bend(TILTED), layer_height=3.0, chord_error=0.001),
        lambda: plan_wall(WALLS["three tangent faces"][0](), layer_height=2.0),
        lambda: plan_wall(WALLS["a bend"][0](), layer_height=5.0, chord_error=0.001),
        lambda: plan_rotary_solid(
            solids(CYLINDER, collar(40.0, 70.0, 0.0, 40.0)), chord_error=0.01
        ),
        lambda: plan_rotary_solid(
            solids(CONE, box(), box(turned=2.0)), chord_error=0.002, fill="lines"
        ),
        lambda: plan_rotary_solid(
            solids(CYLINDER, box()), margin=30.0, layer_height=6.0, bead_spacing=8.0
        ),
        lambda: plan_cladding(WALLS["a bend"][0](), layers=1, chord_error=0.01),
        # layers around a bent pipe become three times as long
        lambda: plan_cladding(
            WALLS["a half shell"][0](),
            layers=3,
            layer_height=14.0,
            bead_spacing=15.0,
            chord_error=0.05,
        ),
    ],
)
@pytest.mark.always(
    "<lambda>0",
    "<lambda>1",
    "<lambda>2",
    "<lambda>3",
    "<lambda>4",
    "<lambda>5",
    "<lambda>6",
    "<lambda>8",
    "<lambda>10",
    "<lambda>13",
)
def test_counts_are_about_right(make):
    """Estimated counts are about right."""
    estimate, toolpath = make()
    assert 0.65 < estimate.layers / len(toolpath.layers) < 1.35, (estimate, len(toolpath.layers))
    assert 0.2 < estimate.points / toolpath.point_count < 1.6, (estimate, toolpath.point_count)


SECTIONS = {  # radius and height of a part of revolution about z, mm; a cylinder on the axis is a disc
    "a disc": [(0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (0.0, 8.0)],
    "a cone": [(0.0, 0.0), (20.0, 0.0), (12.0, 8.0), (0.0, 8.0)],
    "a tube": [(9.0, 0.0), (20.0, 0.0), (20.0, 8.0), (9.0, 8.0)],
}


def turned_solid(corners, sides):
    """A closed mesh of a profile around the axis."""
    angle = 2.0 * np.pi * np.arange(sides) / sides
    rings = [np.stack([r * np.cos(angle), r * np.sin(angle), 0 * angle + z], 1) for r, z in corners]
    k, on = np.arange(sides), (np.arange(sides) + 1) % sides
    triangles = []
    for low in range(len(rings)):
        high = (low + 1) % len(rings)
        a, b, c, d = k + low * sides, on + low * sides, on + high * sides, k + high * sides
        triangles += [np.stack([a, b, c], 1), np.stack([a, c, d], 1)]
    vertices, inverse = np.unique(np.vstack(rings).round(9) + 0.0, axis=0, return_inverse=True)
    found = inverse.ravel()[np.vstack(triangles)]
    whole = (found != np.roll(found, 1, axis=1)).all(axis=1)
    on_axis = np.hypot(*vertices[:, :2].T)[found].max(axis=1) == 0.0
    return Body("part", vertices, found[whole & ~on_axis])


@pytest.mark.parametrize(
    ("section", "sides", "chord_error", "fill"),
    [
        ("a disc", 300, 0.01, "contours"),
        ("a disc", 300, 0.01, "zigzag"),
        ("a disc", 300, 0.01, "lines"),
        ("a disc", 4, 0.01, "contours"),
        ("a disc", 4, 0.01, "lines"),
        ("a disc", 4, 0.01, "zigzag"),
        ("a cone", 120, 0.05, "contours"),
        ("a cone", 120, 0.05, "zigzag"),
        ("a cone", 120, 0.05, "lines"),
        ("a tube", 300, 0.01, "contours"),
        ("a tube", 300, 0.01, "zigzag"),
        ("a tube", 300, 0.01, "lines"),
    ],
)
def test_points_of_solids_in_planes_are_estimated_within_a_factor_of_2(
    section, sides, chord_error, fill
):
    """Round parts were told a tenth of their points, square ones five times as many."""
    strategy = SolidParameters(
        layer_height=2.0, bead_spacing=2.0, chord_error=chord_error, fill=fill, direction="0 0 1"
    )
    made = prepare_stack([turned_solid(SECTIONS[section], sides)], strategy, "part")
    told = estimated_size.solids_size(made, strategy)
    path = plan_solids(made, strategy, BuildDirectionParameters(), PROCESS, None)
    assert told.layers == pytest.approx(len(path.layers), rel=0.01)
    assert 0.5 < told.points / path.point_count < 2.0, (told, path.point_count)


def test_the_turns_of_a_spiral_count_as_layers():
    estimate, toolpath = plan_revolution(VASE, layer_height=0.5, path="spiral")
    assert estimate.points == pytest.approx(toolpath.point_count, rel=0.2)
    assert estimate.layers == pytest.approx(
        np.ptp(next(iter(toolpath))[2].parameter) / (2.0 * np.pi), rel=0.05
    )


FINE = {
    "a dome": lambda **values: plan_revolution(DOME, **values),
    "a spiral": lambda **values: plan_revolution(VASE, path="spiral", **values),
    "planes": lambda **values: plan_revolution(VASE, spacing="iso-height", **values),
    "a tube": lambda **values: plan_wall(tube(), **values),
    "a smooth tube": lambda **values: plan_wall(bend(), spacing="smooth", **values),
    "lines up a tube": lambda **values: plan_wall(tube(), spacing="iso-parameter", **values),
    "a sheet": lambda **values: plan_wall(WALLS["an opening"][0](), **values),
    "a collar": lambda **values: plan_rotary_solid(
        solids(CYLINDER, collar(40.0, 70.0, 0.0, 40.0)), **values
    ),
    "a blade": lambda **values: plan_rotary_solid(solids(CONE, box()), **values),
}


@pytest.mark.parametrize("name", FINE)
def test_layers_that_are_too_many_are_refused_at_once_with_what_is_enough(name):
    """Planning them would take hours, so they are rejected at once with a sufficient value."""
    with pytest.raises(InputError) as caught:
        FINE[name](layer_height=1e-6)
    error = caught.value
    assert (error.code, error.where) == ("TOO_MANY", "strategy.layer_height")
    match = re.fullmatch(
        r"0.000001 mm gives about ([\d,]+) layers, above the limit of 20,000; use at least ([\d.e-]+) mm",
        error.message,
    )
    assert match, error.message
    layers, enough = int(match[1].replace(",", "")), float(match[2])
    assert layers * 1e-6 == pytest.approx(enough * MOST_LAYERS, rel=0.15)  # both are rounded


@pytest.mark.parametrize(
    ("family", "values", "key"),
    [
        (RevolutionParameters, {"chord_error": 1e-5}, "strategy.chord_error"),
        (
            RevolutionParameters,
            {"layer_height": 1e-3, "chord_error": 1e-3},
            "strategy.layer_height",
        ),
        (SurfaceParameters, {"chord_error": 1e-5, "layer_height": 0.9}, "strategy.chord_error"),
        (DevelopableParameters, {"bead_spacing": 1e-4}, "strategy.bead_spacing"),
        (DevelopableParameters, {"chord_error": 1e-5}, "strategy.chord_error"),
        (DevelopableParameters, {"layer_height": 2e-3}, "strategy.layer_height"),
    ],
)
def test_points_that_are_too_many_are_told_by_what_makes_them(family, values, key):
    """An excess of points is attributed to the parameter that causes it."""
    strategy = family(**values)
    with pytest.raises(InputError) as caught:
        estimated_size.refuse_absurd(
            estimated_size.Size(10.0, 4.0 * estimated_size.MOST_POINTS), strategy
        )
    error = caught.value
    assert (error.code, error.where) == ("TOO_MANY", key)
    value = getattr(strategy, key.split(".")[1])
    value_text, remainder = error.message.split(" mm gives about ", 1)
    assert float(value_text) == value and "e" not in value_text  # without an exponent
    assert remainder.startswith("200,000,000 points, above the limit of 50,000,000")
    enough = float(error.message.split("at least ")[1].split()[0])
    assert (
        enough == pytest.approx(value * (16.0 if key.endswith("error") else 4.0), rel=0.1)
        and enough >= 4.0 * value
    )


def test_what_is_said_to_be_enough_is_taken():
    for values in ({"layer_height": 1e-6}, {"layer_height": 0.1, "chord_error": 1e-5}):
        wide = RevolvedWall(Meridian.chained([line((4000.0, 0.0), (4000.0, 900.0))]), np.eye(4))
        with pytest.raises(InputError) as caught:
            estimated_size.refuse_absurd(
                estimated_size.revolution_size(wide, RevolutionParameters(**values)),
                RevolutionParameters(**values),
            )
        key, enough = (
            caught.value.where.split(".")[1],
            float(caught.value.message.split("at least ")[1].split()[0]),
        )
        strategy = RevolutionParameters(**{**values, key: enough})
        estimated_size.refuse_absurd(estimated_size.revolution_size(wide, strategy), strategy)


def test_beads_by_overlap_are_told_by_their_width():
    hub_solids, thin = (
        solids(CYLINDER, collar(40.0, 70.0, 0.0, 40.0)),
        dataclasses.replace(PROCESS, bead_width=1e-5),
    )
    strategy = DevelopableParameters(layer_height=3.0, bead_overlap=0.3)
    estimated_size.refuse_absurd(
        estimated_size.solids_size(hub_solids, strategy), strategy
    )  # the feature has no width yet
    with pytest.raises(InputError, match=r"0.00001 mm gives about [\d,]+ points") as caught:
        plan_solids(hub_solids, strategy, BuildDirectionParameters(), thin, None)
    assert (caught.value.code, caught.value.where) == ("TOO_MANY", "process.bead_width")


def test_large_jobs_are_not_refused():
    """A tank 4 m wide and 5 m high at half a millimetre, and a fine one of 40 million points."""
    tank = RevolvedWall(Meridian.chained([line((2000.0, 0.0), (2000.0, 5000.0))]), np.eye(4))
    for strategy in (
        RevolutionParameters(layer_height=0.5),
        RevolutionParameters(layer_height=0.5, chord_error=0.001),
    ):
        estimate = estimated_size.revolution_size(tank, strategy)
        estimated_size.refuse_absurd(estimate, strategy)
    assert 25e6 < estimate.points < estimated_size.MOST_POINTS


@pytest.mark.parametrize(
    ("family", "points", "told"),
    [
        (RevolutionParameters, 200_000, None),
        (RevolutionParameters, 1_000_000, "0.92 min of processor time and 1.5 GB"),
        (SurfaceParameters, 10_000, None),
        (SurfaceParameters, 60_000, "2 min of processor time and 0.09 GB"),
        (CladdingParameters, 19_000, None),
        (CladdingParameters, 76_000, "1.9 min of processor time and 0.12 GB"),
        (DevelopableParameters, 100_000, None),
        (DevelopableParameters, 370_000, "1.6 min of processor time and 0.56 GB"),
    ],
)
def test_large_jobs_are_told(family, points, told):
    """Large jobs are announced with time and memory."""
    issues = estimated_size.size_issues(estimated_size.Size(180.0, points), family())
    assert [(issue.level, issue.code) for issue in issues] == (
        [] if told is None else [("note", "LARGE")]
    )
    if told:
        assert issues[0].message.startswith(
            f"planning about {points:,} points in 180 layers takes about {told} of"
        )


def test_many_layers_of_few_points_are_told():
    """A cup in layers of 8 um with 25 points each: minutes, which the number of points does not
    show."""
    assert (
        estimated_size.size_issues(estimated_size.Size(500.0, 12_500.0), RevolutionParameters())
        == ()
    )
    (issue,) = estimated_size.size_issues(
        estimated_size.Size(6_000.0, 150_000.0), RevolutionParameters()
    )
    assert issue.code == "LARGE" and "150,000 points in 6,000 layers" in issue.message
    assert "takes about 5 min of processor time" in issue.message


def test_what_is_absurd_is_refused_and_not_told():
    with pytest.raises(InputError, match="points"):
        estimated_size.size_issues(
            estimated_size.Size(180.0, 2.0 * estimated_size.MOST_POINTS), RevolutionParameters()
        )


def test_tilts_that_take_long_to_find_are_told():
    assert estimated_size.tilting_issues(3_000) == ()
    (issue,) = estimated_size.tilting_issues(
        6_812
    )  # 60 s of processor time for the first tilts, 174 s in total
    assert (issue.level, issue.code) == ("note", "LARGE") and "6,800 points" in issue.message
    assert "takes about 1.1 min of processor time" in issue.message
    # a wall whose beads all turn too fast: 6 s for its first tilts, 70 s for slower ones
    assert estimated_size.tilting_issues(1_065) == estimated_size.tilting_issues(500, 6) == ()
    (issue,) = estimated_size.tilting_issues(1_065, 6)
    assert (issue.level, issue.code) == (
        "note",
        "LARGE",
    ) and "on beads of 1,100 points" in issue.message
    assert "takes up to 0.96 min of processor time" in issue.message


def test_layers_of_a_wide_margin_are_told_by_what_filling_them_takes():
    """Its layers are all different, and consist of long straight beads with few points."""
    block = estimated_size.solids_size(
        solids(CYLINDER, box()), DevelopableParameters(layer_height=6.0, bead_spacing=8.0)
    )
    assert block.squares == 0.0
    strategy = DevelopableParameters(layer_height=6.0, bead_spacing=8.0, margin=300.0)
    assert estimated_size.solids_size(solids(CYLINDER, box()), strategy).squares > 200_000
    (issue,) = estimated_size.size_issues(estimated_size.Size(40.0, 95_000.0, 330_000.0), strategy)
    assert issue.code == "LARGE" and "takes about 0.83 min of processor time" in issue.message


def test_remedies_that_take_long_to_find_are_told():
    assert estimated_size.remedy_issues(0, 8e-3) == estimated_size.remedy_issues(3_700, 8e-3) == ()
    (issue,) = estimated_size.remedy_issues(15_516, 8e-3)
    assert (issue.level, issue.code) == (
        "note",
        "LARGE",
    ) and "takes up to 2.1 min of processor time" in issue.message


@pytest.mark.parametrize(
    ("height", "told"), [(1.0, "1,500,000 nodes takes about 1.3 min"), (2.0, None)]
)
def test_curved_layers_are_told_by_their_grid(height, told):
    """A plate of 96 cm3 whose layers of 1 mm took 105 s of processor time, which its 60,000 points
    do not show."""
    hub_solids = solids(CYLINDER, box((-60.0, -40.0, 0.0), (60.0, 40.0, 10.0)))
    strategy = SolidParameters(layer_height=height, bead_spacing=1.9 * height, layers="geodesic")
    issues = estimated_size.size_issues(estimated_size.solids_size(hub_solids, strategy), strategy)
    assert [issue.code for issue in issues] == ([] if told is None else ["LARGE"])
    assert told is None or (told in issues[0].message and "layers: planes" in issues[0].message)
    assert (
        estimated_size.size_issues(
            estimated_size.solids_size(hub_solids, dataclasses.replace(strategy, layers="planes")),
            strategy,
        )
        == ()
    )


@pytest.mark.parametrize(
    ("points", "told"),
    [
        (600_000, ["nodes"]),
        (700_000, ["nodes", "1.1 GB"]),
        (12_000_000, ["18 GB"]),
    ],
)
def test_curved_layers_that_take_much_memory_too_are_told_by_both(points, told):
    """For a grid that takes 1,000 s of processor time, and points that take 150 s, 175 s and 1,125
    s."""
    issues = estimated_size.size_issues(
        estimated_size.Size(100.0, points, nodes=2e7), SolidParameters(layers="geodesic")
    )
    assert len(issues) == len(told)
    for issue, word in zip(issues, told, strict=True):
        assert issue.code == "LARGE" and word in issue.message


def bellows(high):
    """A mesh of rings of 60 and 72 mm, 12 mm apart, that meet at right angles, on its lowest
    ring."""
    angle = 2.0 * np.pi * np.arange(72) / 72
    rings = [
        np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(72, 12.0 * k)])
        for k, r in enumerate([60.0, 72.0] * high)
    ]
    k, on = np.arange(72), np.roll(np.arange(72), -1)
    band = np.vstack([np.column_stack([k, on, on + 72]), np.column_stack([k, on + 72, k + 72])])
    return np.vstack(rings), np.vstack([band + 72 * k for k in range(len(rings) - 1)])


@pytest.mark.parametrize(
    ("high", "told"), [(1, None), (8, "takes about 1.5 min of processor time")]
)
def test_folds_of_a_mesh_are_told_by_their_length(high, told):
    """A real mesh of 40,000 vertices took 90 s of processor time without a notice, because its
    beads have few points. This one takes 36 s."""
    wall = mesh_wall(*bellows(high), 3.0, "bellows", 5.0)
    edge = wall.vertices[:, 2] < 1e-6
    wall = dataclasses.replace(
        wall, first=(FirstCurve(wall.vertices[edge], *2 * (np.eye(3)[[0] * edge.sum()],), True),)
    )
    strategy = SurfaceParameters(layer_height=3.0, chord_error=0.2)
    estimate = estimated_size.wall_size(wall, strategy)
    assert estimate.folds < 4_000.0 * (
        2 * high - 1
    )  # around each ring it bends over some rows of facets
    issues = estimated_size.size_issues(estimate, strategy)
    assert [issue.code for issue in issues] == ([] if told is None else ["LARGE"])
    assert told is None or (told in issues[0].message and "rounded edges" in issues[0].message)


ROOT = Path(__file__).resolve().parents[3]
MEMORY_SCRIPT = """
import dataclasses, json, re
import numpy as np
from freecad_am.core.geometry.walls.mesh_wall import mesh_wall
from freecad_am.core.geometry.walls.patch_wall import FirstCurve
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.strategies import estimated_size

def peak():
    return int(re.search(r"VmHWM:\\s+(\\d+)", open("/proc/self/status").read()).group(1)) * 1024e-9

count, rows, edge = {count}, {rows}, {edge}
angle = 2.0 * np.pi * np.arange(count) / count
rings = []
for z in np.linspace(0.0, 120.0, rows + 1):
    r = 60.0 + 10.0 * np.sin(z / 20.0) + {wave} * np.sin(7.0 * angle)
    rings.append(np.column_stack([r * np.cos(angle), r * np.sin(angle), np.full(count, z)]))
k = np.arange(count)
on = np.roll(k, -1)
band = np.vstack([np.column_stack([k, on, on + count]), np.column_stack([k, on + count, k + count])])
before = peak()
wall = mesh_wall(np.vstack(rings), np.vstack([band + count * k for k in range(rows)]), edge, "vase", 5.0)
wall.project(wall.vertices)
used = peak() - before
first = FirstCurve(rings[0], *2 * (np.eye(3)[[0] * count],), True)
wall = dataclasses.replace(wall, first=(first,))
size = estimated_size.wall_size(wall, SurfaceParameters(layer_height=edge, chord_error=0.05))
print(json.dumps([size.gigabytes, used, size.points, size.vertices]))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the peak is read from /proc")
@pytest.mark.parametrize(
    ("count", "rows", "edge", "wave"),
    [(180, 60, 3.0, 0.0), (48, 16, 1.5, 0.0), (240, 80, 2.0, 4.0)],
)
def test_the_memory_of_a_mesh_wall_is_announced_as_it_is_used(count, rows, edge, wave):
    """The announced memory was a thirtieth of the use, because only points were counted. The use is
    measured in a separate process, to a factor of 2.5."""
    script = MEMORY_SCRIPT.format(count=count, rows=rows, edge=edge, wave=wave)
    process = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, cwd=ROOT
    )
    announced, used, points, vertices = json.loads(process.stdout)
    assert used / 2.5 < announced < 2.5 * used
    assert 0 < points * estimated_size.GIGABYTES_A_POINT < announced and vertices > 5000
