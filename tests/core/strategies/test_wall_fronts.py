# SPDX-License-Identifier: LGPL-2.1-or-later
"""Toolpaths of walls without a closed parameter: order, support, seams, directions and ends, on
analytic walls."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from freecad_am.core.geometry.columns import HalfSpace, Round
from freecad_am.core.geometry.walls.patch import CYLINDER, PLANE, TORUS, Patch
from freecad_am.core.geometry.walls.surface_wall import SurfaceWall
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.process import ProcessParameters, SeamParameters
from freecad_am.core.parameters.strategy import SurfaceParameters
from freecad_am.core.process.deposit.spacing import between_layers
from freecad_am.core.slicing.fronts import layers as fronts
from freecad_am.core.strategies.walls import fronts as wall_fronts
from freecad_am.core.strategies.walls import plan as tubes
from tests.core.patch_walls import ball, bend, grid, patch_wall, samples, sheet, tube

PIPE = Round.cylinder(32.0, [0, 0, 0], [0, 1, 0])
FLOOR = HalfSpace(np.zeros(3), np.array([0.0, 0.0, 1.0]))
SILL = HalfSpace(np.zeros(3), np.array([0.0, 1.0, 0.0]))


@pytest.fixture(scope="module", autouse=True)
def sliced_once():
    """Slice each wall once for all plans: its fronts depend only on wall, layer height and
    smoothing, and take most of the time of a plan."""
    slices, layers = {}, fronts.slice_layers

    def slice_once(wall, height, smoothing=None, progress=lambda fraction, text: None):
        key = id(wall), height, smoothing
        if key not in slices:
            slices[key] = (
                wall,
                layers(wall, height, smoothing, progress),
            )  # keep the wall too, so that its id stays unique
        return slices[key][1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fronts, "slice_layers", slice_once)
        yield


def planned(wall, height, process=None, strategy=None, **build):
    build = BuildDirectionParameters(**{"clearance": "none", "max_tilt": np.pi, **build})
    strategy = SurfaceParameters(
        **{"layer_height": height, "chord_error": 0.001, **(strategy or {})}
    )
    return wall_fronts.plan(wall, strategy, build, process or ProcessParameters())


def dense(beads):
    """Points along beads."""
    samples = []
    for bead in beads:
        share = np.arange(60)[:, None, None] / 60.0
        samples += [
            (bead.points[:-1] + share * np.diff(bead.points, axis=0)).reshape(-1, 3),
            bead.points[-1:],
        ]
    return np.vstack(samples)


def codes(toolpath):
    return {issue.code: issue for issue in toolpath.issues}


def gutter():
    """Three tangent faces: two flat sides joined by half a cylinder, 40 mm high, on Z = 0."""
    radius, flat = 10.0, 25.0
    arc = np.pi * radius
    s = np.linspace(-flat - arc / 2.0, flat + arc / 2.0, 96)
    s = np.sort(np.r_[s[np.abs(np.abs(s) - arc / 2.0) > 0.4], -arc / 2.0, arc / 2.0])

    def point(z, s):
        angle = np.clip(s, -arc / 2.0, arc / 2.0) / radius
        over = s - np.clip(s, -arc / 2.0, arc / 2.0)
        return np.stack([radius * np.cos(angle) - np.abs(over), radius * np.sin(angle), z], axis=1)

    vertices, triangles = grid(point, np.linspace(-4.0, 40.0, 45), s)
    middle = vertices[triangles].mean(axis=1)
    owner = np.where(middle[:, 0] > 0.0, 1, np.where(middle[:, 1] > 0.0, 2, 0)).astype(np.intp)
    sides = [
        np.array([[1.0, 0, 0, 0], [0, 0, y, y * radius], [0, -y, 0, 0], [0, 0, 0, 1.0]])
        for y in (-1.0, 1.0)
    ]
    round_ = Patch(CYLINDER, (radius,), np.eye(4), 1.0, (2.0 * np.pi, 0.0))
    patches = [Patch(PLANE, (), sides[0]), round_, Patch(PLANE, (), sides[1])]
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    out = np.einsum(
        "ij,ij->i",
        np.cross(b - a, c - a),
        middle * [1.0, 1.0, 0.0] - np.minimum(middle, 0.0) * [1.0, 0, 0],
    )
    triangles = np.where((out < 0.0)[:, None], triangles[:, ::-1], triangles)
    slanted = HalfSpace(np.zeros(3), np.array([0.1, 0.15, 1.0]))
    return patch_wall(
        vertices,
        triangles,
        patches,
        owner,
        slanted,
        lambda points: np.abs(points[:, 2] - 40.0) < 1e-9,
    )


WALLS = {
    "an opening": (lambda: sheet(SILL, [(2.0, 20.0, 9.0)]), 1.7),
    "a half shell": (lambda: bend(PIPE, 0.3, 1.3, 1.25, 0.5, np.pi), 2.5),
    "three tangent faces": (gutter, 2.0),
    "a bend": (lambda: bend(PIPE, 0.3, np.pi / 2, 1.25), 5.0),
    "a cap": (
        lambda: ball(HalfSpace(np.array([0, 0, -5.0]), np.array([0.1, 0.3, 1.0])), 2500),
        2.0,
    ),
}
MADE = {}


def planned_wall(name):
    """Wall, layer height, and a toolpath with a chord error of 0.0003 mm."""
    if name not in MADE:
        make, height = WALLS[name]
        wall = make()
        MADE[name] = (
            wall,
            height,
            planned(
                wall, height, ProcessParameters(direction="alternate"), {"chord_error": 0.0003}
            ),
        )
    return MADE[name]


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.always("a half shell", "a bend", "a cap")
def test_layers_are_a_height_apart_and_cover_the_wall(name):
    wall, height, toolpath = planned_wall(name)
    for below, layer in zip(toolpath.layers, toolpath.layers[1:]):  # chords are off by 0.0003 mm
        tree = cKDTree(dense([bead for bead in below.beads if not bead.role.closing]))
        for bead in layer.beads:
            assert bead.role.closing or tree.query(bead.points)[0] == pytest.approx(
                height, abs=1e-3
            )
    assert codes(toolpath)["SPACING"].level == "note"
    points = samples(wall, 2)
    off = cKDTree(dense([bead for _, _, bead in toolpath])).query(points)[0]
    assert off.max() < height
    ends = [rim.points for rim in wall.rims]
    inside = (
        cKDTree(np.vstack(ends)).query(points)[0] > height
        if ends
        else np.ones(len(points), dtype=bool)
    )
    assert off[inside].max() < 0.6 * height


@pytest.mark.parametrize("name", WALLS)
@pytest.mark.always("three tangent faces", "a bend", "a cap", "a half shell")
def test_every_bead_lies_on_something_deposited_before(name):
    """Every bead is supported by an earlier one."""
    _, height, toolpath = planned_wall(name)
    trees = []  # of each layer, the last one first
    for layer in toolpath.layers:
        for bead in layer.beads if trees else ():
            over = bead.points
            for tree in trees:
                over = over[tree.query(over)[0] >= 1.01 * height]
                if not len(over):
                    break
            assert not len(over)
        trees.insert(0, cKDTree(dense(layer.beads)))


@pytest.mark.always("a half shell", "three tangent faces", "a bend", "a cap")
@pytest.mark.parametrize("name", WALLS)
def test_directions_are_tangent_to_the_wall_normal_to_the_bead_and_continuous(name):
    wall, height, _ = planned_wall(name)
    toolpath = planned(wall, height, max_turn="inf")
    for _, _, bead in toolpath:
        normal = wall.project(bead.points)[1]
        assert np.abs((bead.build * normal).sum(axis=1)).max() < 1e-9
        smooth = (bead.tangents[:, 0] * bead.tangents[:, 1]).sum(axis=1) > 1.0 - 1e-9
        assert np.abs((bead.build * bead.tangents[:, 0]).sum(axis=1)[smooth]).max() < 1e-9
    for below, layer in zip(toolpath.layers, toolpath.layers[1:]):
        tree = cKDTree(np.vstack([bead.points for bead in below.beads]))
        for bead in layer.beads:
            if not bead.role.closing:  # away from the layer below
                foot = tree.data[tree.query(bead.points)[1]]
                assert ((bead.points - foot) * bead.build).sum(axis=1).min() > 0.0
    max_turn = np.radians(15.0)
    for _, _, bead in planned(wall, height, max_turn=max_turn):
        turn = np.arccos(np.clip((bead.tool[1:] * bead.tool[:-1]).sum(axis=1), -1.0, 1.0))
        assert (turn / np.linalg.norm(np.diff(bead.points, axis=0), axis=1)).max() < max_turn * (
            1.0 + 1e-6
        ) + 1e-6


def test_pieces_alternate_so_that_links_are_short():
    """Beads alternate in direction so that links are short."""
    wall, height, toolpath = planned_wall("an opening")
    assert codes(toolpath)["SPLIT"].message == "a front splits in 2 at layer 7"
    assert codes(toolpath)["MERGE"].message == "2 fronts merge at layer 21"
    beads = [bead for _, _, bead in toolpath]
    links = np.array(
        [
            np.linalg.norm(next_bead.points[0] - current.points[-1])
            for current, next_bead in zip(beads, beads[1:])
            if not current.role.closing and not next_bead.role.closing
        ]
    )
    assert (links < 1.01 * height).sum() >= len(
        links
    ) - 17  # except the links across the opening, once per layer
    assert links.max() < 40.0  # the sheet is 60 mm wide
    as_found = planned(wall, height)
    for _, _, bead in as_found:
        assert (
            bead.role.closing or (bead.points[-1] - bead.points[0])[0] > 0.0
        )  # all in the same direction


def test_seams_follow_each_other_at_the_angle_asked_for():
    """Seams of successive layers are at the requested angle."""
    wall, height, _ = planned_wall("a bend")
    seam = SeamParameters(np.radians(-60.0))
    planned_path = planned(wall, height, ProcessParameters(seam=seam), {"end": "whole"})
    starts = np.array([layer.beads[0].points[0] for layer in planned_path.layers])
    steps = np.linalg.norm(np.diff(starts, axis=0), axis=1)
    assert steps.min() > height - 1e-3 and steps.max() < 1.5 * height
    for layer in planned_path.layers[:3]:  # there the centre is almost that of the tube
        x, y, z = layer.beads[0].points[0]
        assert np.degrees(np.arctan2(y, np.hypot(x + 60.0, z) - 60.0)) == pytest.approx(
            -60.0, abs=8.0
        )
    clockwise = ProcessParameters(seam=SeamParameters(0.0, np.radians(30.0)), direction="clockwise")
    clockwise_path = planned(wall, height, clockwise, {"end": "whole"})
    for layer_a, layer_b in zip(planned_path.layers, clockwise_path.layers):
        turning = [
            np.cross(bead.points[:-1], bead.points[1:]).sum(axis=0) @ bead.build.mean(axis=0)
            for bead in (layer_a.beads[0], layer_b.beads[0])
        ]
        assert turning[0] > 0.0 > turning[1]


def test_seam_of_an_upright_tube():
    """The angle is about the axis, from X; steps add up."""
    toolpath = planned(
        tube(FLOOR, 20.0, 1.5), 5.0, ProcessParameters(seam=SeamParameters(0.4, 0.3))
    )
    for index, layer in enumerate(toolpath.layers):
        x, y, z = layer.beads[0].points[0]
        assert (np.arctan2(y, x), z) == (
            pytest.approx(0.4 + 0.3 * index, abs=1e-3),
            pytest.approx(5.0 * index, abs=1e-6),
        )


def test_whole_layers_stop_below_the_first_that_is_cut():
    """With whole layers the path stops below the first layer that is cut."""
    wall, height, _ = planned_wall("a bend")
    trimmed, whole_layers = planned(wall, height), planned(wall, height, strategy={"end": "whole"})
    assert [layer.beads[0].closed for layer in whole_layers.layers] == [True] * 10
    assert sum(bead.closed for _, _, bead in trimmed) == 10
    for _, _, bead in trimmed:
        if not bead.closed and not bead.role.closing:  # flush with the end, in the plane X = -60
            assert bead.points[[0, -1], 0] == pytest.approx(-60.0, abs=1e-6)
    assert "REMAINDER" in codes(whole_layers) and "REMAINDER" not in codes(trimmed)
    straight = planned(tube(FLOOR, 20.0, 1.5), 5.0, strategy={"end": "whole"})
    assert len(straight.layers) == 5 and "REMAINDER" not in codes(straight)


def test_lead_tilt_and_planes():
    wall = tube(FLOOR, 10.0, 1.5)
    leaning = planned(wall, 5.0, lead=0.2, tilt=0.3).layers[1].beads[0]
    out = leaning.points * [1.0, 1.0, 0.0] / 20.0
    assert (leaning.tool * out).sum(axis=1) == pytest.approx(np.sin(0.3), abs=1e-3)
    assert (leaning.tool * leaning.tangents[:, 1]).sum(axis=1) == pytest.approx(
        np.sin(0.2) * np.cos(0.3), abs=1e-3
    )
    flat = planned(wall, 5.0, mode="symmetry-plane", plane="1 0 0", tilt=0.3)
    assert all(np.abs(bead.tool[:, 0]).max() < 1e-12 for _, _, bead in flat)
    with pytest.raises(InputError) as caught:
        planned(wall, 5.0, mode="symmetry-plane")
    assert (
        caught.value.code == "NO_SYMMETRY_PLANE" and "build_direction.plane" in caught.value.message
    )


def test_layers_along_lines_need_a_parameter():
    with pytest.raises(InputError) as caught:
        planned(tube(FLOOR, 10.0, 2.0), 5.0, strategy={"spacing": "iso-parameter"})
    assert (caught.value.code, caught.value.where) == ("NO_PARAMETER", "strategy.spacing")


def test_smooth_layers_say_what_they_cost():
    wall, height, exact = planned_wall("a bend")
    smooth = planned(
        wall,
        height,
        ProcessParameters(direction="alternate"),
        {"spacing": "smooth", "chord_error": 0.0003},
    )
    assert codes(exact)["CORNERS"].level == "note"
    assert "CORNERS" not in codes(smooth) and codes(smooth)["SPACING"].level == "note"
    assert (
        codes(smooth)["TURN"].level == "warning"
        and "first layer 13" in codes(smooth)["TURN"].message
    )
    spacings = np.concatenate(between_layers(smooth))
    assert spacings.min() >= 0.8 * height and spacings.max() <= 1.2 * height
    straight = planned(tube(FLOOR, 20.0, 1.5), height, strategy={"spacing": "smooth"})
    assert codes(straight)["TURN"].level == "note"
    off = cKDTree(dense([bead for _, _, bead in smooth])).query(samples(wall, 2))[0]
    inside = (
        cKDTree(np.vstack([rim.points for rim in wall.rims])).query(samples(wall, 2))[0] > height
    )
    assert off.max() < height and off[inside].max() < 0.6 * height


@pytest.mark.parametrize("seed", range(3))
def test_random_walls(seed):
    rng = np.random.default_rng(seed)
    radius, height = rng.uniform(8.0, 25.0), rng.uniform(1.5, 4.0)
    start, width = rng.uniform(0.0, 6.0), rng.uniform(1.5, 5.5)
    floor = HalfSpace(np.zeros(3), np.r_[rng.uniform(-0.3, 0.3, 2), 1.0])
    wall = tube(floor, 20.0, min(0.8 * height, 0.25 * radius), radius, -10.0, start, width)
    toolpath = planned(wall, height, ProcessParameters(direction="alternate"))
    assert np.concatenate(between_layers(toolpath)) == pytest.approx(height, abs=1e-3)
    for _, _, bead in toolpath:
        assert not bead.closed
        assert np.hypot(*bead.points[:, :2].T) == pytest.approx(radius, abs=1e-4)
        assert np.abs((bead.build[:, :2] * bead.points[:, :2]).sum(axis=1)).max() < 0.01 * radius


def test_a_bend_of_one_surface_has_by_fronts_the_layers_that_its_parameter_gives():
    """Layers of 8 mm by the equation of the torus: at that distance, on it, and where the
    parametric method finds them; the tools in the plane of the bend. The fronts also close the gaps
    of their corners, which the parametric method does not."""
    v = 2.0 * np.pi * np.arange(480) / 480
    reach = 60.0 + 15.0 * np.cos(v)
    u = np.arccos((60.0**2 - 32.0**2 + reach**2) / (2.0 * 60.0 * reach))
    base_curve = np.stack([reach * np.cos(u) - 60.0, 15.0 * np.sin(v), reach * np.sin(u)], axis=1)
    parametric_wall = SurfaceWall(TORUS, (60.0, 15.0), np.eye(4), 0.5 * np.pi, base_curve)
    several = bend(PIPE, 0.4, 0.5 * np.pi, 3.0)
    toolpath = planned(several, 8.0, mode="symmetry-plane")
    build = BuildDirectionParameters("symmetry-plane", clearance="none", max_tilt=np.pi)
    by_parameter = tubes.plan(
        parametric_wall,
        SurfaceParameters(layer_height=8.0, chord_error=0.001),
        build,
        ProcessParameters(),
    )
    layers = [[bead for bead in layer.beads if not bead.role.closing] for layer in toolpath.layers]
    assert [len(layer) for layer in layers] == [len(layer.beads) for layer in by_parameter.layers]
    for below, above, parametric_layer in zip(layers, layers[1:], by_parameter.layers[1:]):
        points = np.vstack([bead.points for bead in above])
        x, y, z = points.T
        assert np.abs(np.hypot(np.hypot(x + 60.0, z) - 60.0, y) - 15.0).max() < 1e-6
        inside = np.vstack(
            [bead.points[slice(None) if bead.closed else slice(1, -1)] for bead in above]
        )
        assert cKDTree(dense(below)).query(inside)[0] == pytest.approx(8.0, abs=3e-3)
        assert cKDTree(dense(parametric_layer.beads)).query(points)[0].max() < 0.02
    assert max(np.abs(bead.tool[:, 1]).max() for _, _, bead in toolpath) < 1e-9


def test_other_directions_leave_the_layers_as_they_are(monkeypatch):
    """Remedies for contacts are tested with other directions; slicing the same layers again took a
    minute."""
    wall, heights, layers = tube(FLOOR, 40.0, 5.0), [], fronts.slice_layers
    monkeypatch.setattr(
        fronts,
        "slice_layers",
        lambda wall, height, *arguments: heights.append(height) or layers(wall, height, *arguments),
    )
    leaning, upright = planned(wall, 6.0), planned(wall, 6.0, mode="fixed")
    assert heights == [6.0]
    for (_, _, leaning_bead), (_, _, upright_bead) in zip(leaning, upright, strict=True):
        assert (leaning_bead.points == upright_bead.points).all()
    planned(wall, 7.0)
    planned(wall, 7.0, strategy={"spacing": "smooth"})
    assert heights == [6.0, 7.0, 7.0]
