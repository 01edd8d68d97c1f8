# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fill of layers on hubs: equal solids filled once, bead roles, overlap, and issues with their
positions."""

import math
import re

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from freecad_am.core.geometry.developable import Developable
from freecad_am.core.geometry.obstacles import Body
from freecad_am.core.geometry.on_hub import Base, Group, SolidsOnHub
from freecad_am.core.issues import InfeasibleError, InputError
from freecad_am.core.parameters.build_direction import BuildDirectionParameters
from freecad_am.core.parameters.filled import DevelopableParameters
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.strategies.solids import filling
from freecad_am.core.strategies.solids.plan import plan as plan_solids
from freecad_am.objects.results.store import pack, unpack
from tests.core.strategies.test_developable import collar

HUBS = {"cylinder": Developable(30.0), "cone": Developable(60.0, 200.0)}


def box(turned, thick=24.0):
    """A box on the hub's side, rotated about its axis."""
    corners = np.array(
        [[x, y, z] for x in (20.0, 70.0) for y in (-0.5 * thick, 0.5 * thick) for z in (20.0, 60.0)]
    )
    hull = ConvexHull(corners)
    faces = hull.simplices.copy()
    a, b, c = (corners[faces[:, k]] for k in range(3))
    inward = (np.cross(b - a, c - a) * hull.equations[:, :3]).sum(axis=1) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    cos, sin = math.cos(turned), math.sin(turned)
    return Body(
        "blade",
        corners @ np.array([[cos, sin, 0], [-sin, cos, 0], [0, 0, 1.0]]),
        faces.astype(np.int64),
    )


def planned(hub, turns, thick=24.0, width=8.0, fill_width="auto", **values):
    bodies = tuple(box(turn, thick) for turn in turns)
    hub_solids = SolidsOnHub("part", (Group(Base("the hub", HUBS[hub], np.eye(4)), bodies),), 0.0)
    parameters = {"layer_height": 12.0, "bead_spacing": 6.0, "order": "feature", **values}
    return plan_solids(
        hub_solids,
        DevelopableParameters(**parameters),
        BuildDirectionParameters(),
        ProcessParameters(bead_width=width, fill_width=fill_width),
        None,
    )


@pytest.mark.parametrize("hub", HUBS)
@pytest.mark.parametrize("fill", ["contours", "lines"])
@pytest.mark.always
def test_equal_solids_are_filled_once_and_are_as_filled_alone(hub, fill, monkeypatch):
    """Equal solids are filled once, with the same beads as a single solid."""
    turns = (0.1, 0.1 + 2.0 * math.pi / 3.0, 4.0)
    calls = []
    real = filling.fill
    monkeypatch.setattr(
        filling, "fill", lambda *arguments: calls.append(arguments) or real(*arguments)
    )
    together = planned(hub, turns, fill=fill)
    layers = len(together.layers) // 3
    assert len(calls) == layers
    for number, turn in enumerate(turns):
        alone = planned(hub, (turn,), fill=fill)
        own_beads = [
            bead
            for layer in together.layers[number * layers : (number + 1) * layers]
            for bead in layer.beads
        ]
        single_beads = [bead for _, _, bead in alone]
        assert len(own_beads) == len(single_beads)
        for a, b in zip(own_beads, single_beads):
            assert (a.role.kind, a.role.ring) == (b.role.kind, b.role.ring) and abs(
                a.length - b.length
            ) < 1e-4
            assert np.linalg.norm(a.points[0] - b.points[0]) < 1e-4
    planned(hub, (0.1,), fill=fill, fill_angle=0.3)
    assert len(calls) == 5 * layers, "another filling is not the same"


@pytest.mark.parametrize(
    ("width", "counts", "inset"),
    [
        (8.0, "auto", 3.0),
        (8.0, "bead_width", 4.0),
        (8.0, "spacing", 3.0),
        (10.0, "auto", 5.0),
        (10.0, "spacing", 3.0),
    ],
)
def test_the_outermost_bead_ends_at_the_border_as_wide_as_it_counts(width, counts, inset):
    """A block 40 mm high on a cylinder: its outermost contours are half a bead inside its upper and
    lower borders."""
    path = planned("cylinder", (0.0,), width=width, fill_width=counts)
    outer = [
        bead.points for _, _, bead in path if bead.role.ring == 0 and bead.role.kind == "contour"
    ]
    assert len(outer) == len(path.layers)
    assert max(np.ptp(points[:, 2]) for points in outer) == pytest.approx(40.0 - 2.0 * inset)


def test_beads_carry_their_kind_and_ring_through_documents():
    for fill, kinds in (
        ("contours", {"contour", "centre"}),
        ("lines", {"contour", "line", "closing"}),
        ("zigzag", {"contour", "zigzag", "closing"}),
        ("spiral", {"spiral", "closing", "centre"}),
    ):
        path = planned("cylinder", (0.0,), fill=fill)
        assert {bead.role.kind for _, _, bead in path} <= kinds
        again = unpack(*pack(path, "key"), "key", "toolpath")
        assert [(b.role.kind, b.role.ring) for _, _, b in again] == [
            (b.role.kind, b.role.ring) for _, _, b in path
        ]
        floats, text = pack(path, "key")
        old = re.sub(r'"kind":"[a-z]*","ring":\d+,', "", text)
        assert old != text and {
            bead.role.kind for _, _, bead in unpack(floats, old, "key", "toolpath")
        } == {""}


def test_overlap_sets_the_spacing():
    by_overlap = planned("cylinder", (0.0,), width=7.5, bead_overlap=0.2, bead_spacing=99.0)
    by_spacing = planned("cylinder", (0.0,), width=7.5, bead_spacing=6.0)
    assert [len(bead) for _, _, bead in by_overlap] == [len(bead) for _, _, bead in by_spacing]
    for (_, _, a), (_, _, b) in zip(by_overlap, by_spacing):
        assert np.array_equal(a.points, b.points)


def test_places_are_told_in_the_part():
    """Positions in messages are in part coordinates."""
    turn = 2.0
    with pytest.raises(InfeasibleError) as caught:
        planned("cylinder", (turn,), thick=3.0, thin="refuse")
    position = np.array(
        [float(word) for word in re.findall(r"\(([^)]*)\)", str(caught.value))[0].split(",")]
    )
    assert position.shape == (3,)
    assert math.hypot(position[0], position[1]) == pytest.approx(30.0, rel=1e-3)
    assert (
        math.atan2(position[1], position[0]) == pytest.approx(turn, abs=0.06)
        and 20.0 < position[2] < 60.0
    )


@pytest.mark.parametrize(("fill", "instead"), [("spiral", "contours"), ("zigzag", "lines")])
@pytest.mark.parametrize("hub", HUBS)
@pytest.mark.always
def test_patterns_that_end_are_others_round_the_hub_and_that_is_told(hub, fill, instead):
    """A collar and a blade on the same hub: the blade gets the requested pattern, the collar the
    reported substitute."""
    ring = collar(20.0, 80.0, 70.0, 90.0)
    hub_solids = SolidsOnHub(
        "part", (Group(Base("the hub", HUBS[hub], np.eye(4)), (box(0.3), ring)),), 0.0
    )

    def beads(pattern):
        path = plan_solids(
            hub_solids,
            DevelopableParameters(
                layer_height=12.0, bead_spacing=6.0, fill=pattern, order="feature"
            ),
            BuildDirectionParameters(),
            ProcessParameters(),
            None,
        )
        return path, [
            [bead for _, _, bead in path if (bead.points[:, 2].min() > 65.0) == on_collar]
            for on_collar in (True, False)
        ]

    path, (round_it, aside) = beads(fill)
    notes = [issue for issue in path.issues if issue.code == "PATTERN_ROUND_HUB"]
    for note in notes:
        assert note.level == "note" and f"is filled with {instead}" in note.message
        assert f"strategy.fill = {fill}" in note.message
    levels = {layer for layer, _, bead in path if bead.points[:, 2].min() > 65.0}
    assert len(notes) == len(levels) > 2
    with_substitute, (same, _) = beads(instead)
    assert not [issue for issue in with_substitute.issues if issue.code == "PATTERN_ROUND_HUB"]
    assert len(round_it) == len(same) and all(
        (bead_a.points == substitute_bead.points).all()
        for bead_a, substitute_bead in zip(round_it, same)
    )
    assert fill in {bead.role.kind for bead in aside} and fill not in {
        bead.role.kind for bead in round_it
    }


def test_beads_wider_apart_than_they_are_wide_are_refused():
    with pytest.raises(InputError) as caught:
        planned("cylinder", (0.0,), width=9.5, bead_spacing=14.0)
    assert caught.value.code == "BEAD_SPACING" and caught.value.where == "strategy.bead_spacing"
    assert "9.5 mm wide" in str(caught.value) and "stripes of 4.5 mm" in str(caught.value)
    assert planned("cylinder", (0.0,), width=9.5, bead_spacing=9.5).layers


@pytest.mark.parametrize("hub", HUBS)
@pytest.mark.parametrize(
    ("fill", "contour"), [("contours", True), ("spiral", True), ("lines", False), ("zigzag", True)]
)
@pytest.mark.always
def test_no_bead_of_its_width_stands_out(hub, fill, contour):
    """The box's sides are planes: a straight bead 9.5 mm wide stays half its width away from them
    along the hub."""
    path = planned(hub, (0.0,), thick=40.0, width=9.5, bead_spacing=6.5, fill=fill, contour=contour)
    cos = math.cos(HUBS[hub].taper)
    for _, _, bead in path:
        assert (
            bead.points[:, 2].min() >= 20.0 + 4.75 * cos - 0.05
            and bead.points[:, 2].max() <= 60.0 - 4.75 * cos + 0.05
        )
        assert (
            np.abs(bead.points[:, 1]).max() <= 20.0 - 4.75 * math.cos(math.atan2(20.0, 30.0)) + 1.0
        )
    reach = [min(bead.points[:, 2].min() for bead in layer.beads) - 20.0 for layer in path.layers]
    assert np.allclose(
        reach[:2], 4.75 * cos, atol=0.06
    )  # farther out the cone meets the box away from its lower side


def test_a_single_bead_wider_than_its_region_is_told_with_place_and_overhang():
    """A single bead wider than its region is reported with position and overhang."""
    path = planned("cylinder", (0.0,), thick=3.0, width=9.5, bead_spacing=6.5)
    note = next(issue for issue in path.issues if issue.code == "THIN_SINGLE")
    assert note.level == "note" and "9.5 mm" in note.message
    out = float(re.findall(r"by up to ([\d.]+) mm", note.message)[0])
    position = np.array(
        [float(word) for word in re.findall(r"mm at \(([^)]*)\)", note.message)[0].split(",")]
    )
    y, z = abs(position[1]), position[2]
    border = min(1.5 - y, z - 20.0, 60.0 - z)
    assert out == pytest.approx(4.75 - border, abs=0.05) and out > 3.2
    assert not [
        issue for issue in planned("cylinder", (0.0,)).issues if issue.code == "THIN_SINGLE"
    ]


def lengths(path):
    return np.array([sum(bead.length for bead in layer.beads) for layer in path.layers])


@pytest.mark.parametrize("hub", HUBS)
@pytest.mark.always("cylinder")
def test_less_than_the_whole_between_solid_layers(hub):
    """First and last layers are filled at 100 %, those between at the density, also around hubs."""
    parameters = {
        "layer_height": 6.0,
        "bead_spacing": 1.5,
        "walls": 2,
        "chord_error": 0.05,
        "contour": True,
    }
    solid_path = planned(hub, (0.3,), 36.0, fill="lines", **parameters)
    sparse_path = planned(
        hub, (0.3,), 36.0, fill="gyroid", fill_density=0.25, solid_layers=1, **parameters
    )
    share = lengths(sparse_path) / lengths(solid_path)
    assert share[[0, -1]] == pytest.approx(1.0, abs=0.02)
    # two walls of 1.5 mm take 3 mm on all sides of 40 mm by 36 mm or slightly more
    assert (share[1:3] > 0.35).all() and (
        share[1:3] < 0.55
    ).all()  # farther out the flat top is nearer
    for layer in sparse_path.layers[:3]:
        assert sorted({bead.role.ring for bead in layer.beads if bead.role.kind == "contour"}) == [
            0,
            1,
        ]
    walls_only = planned(hub, (0.3,), 36.0, fill="grid", **{**parameters, "walls": "inf"})
    assert {bead.role.kind for _, _, bead in walls_only} <= {"contour", "centre"}
    assert not [issue for issue in sparse_path.issues if issue.code == "OPEN_GAP"]


def test_round_hubs_lines_stand_farther_apart_between_solid_layers():
    """Around hubs, lines between solid layers have a larger spacing."""
    base, body = Base("the hub", Developable(40.0), np.eye(4)), collar(40.0, 65.0, 10.0, 60.0)
    hub_solids = SolidsOnHub("part", (Group(base, (body,)),), 0.0)

    def path(**values):
        parameters = {
            "layer_height": 5.0,
            "bead_spacing": 2.0,
            "chord_error": 0.05,
            "fill_angle_step": 0.0,
            **values,
        }
        return plan_solids(
            hub_solids,
            DevelopableParameters(**parameters),
            BuildDirectionParameters(),
            ProcessParameters(),
            None,
        )

    solid_path, sparse_path = (
        path(fill="lines"),
        path(fill="grid", fill_density=0.2, solid_layers=1),
    )
    share = lengths(sparse_path) / lengths(solid_path)
    assert share[[0, -1]] == pytest.approx(1.0, abs=0.01)
    assert share[1:-1] == pytest.approx(
        0.2 + 0.8 * 4.0 / 50.0, abs=0.05
    )  # the contour along both borders exists in any case
    assert "PATTERN_ROUND_HUB" in {issue.code for issue in sparse_path.issues}


def test_tops_of_a_step_are_filled():
    """One body of two boxes with different heights: layers under the lower top are filled."""
    low, high = box(0.2, 20.0), box(0.9, 20.0)
    squeezed = (
        low.vertices
        * np.where(np.hypot(low.vertices[:, 0], low.vertices[:, 1]) > 50.0, 0.8, 1.0)[:, None]
    )
    squeezed[:, 2] = low.vertices[:, 2]
    body = Body(
        "step", np.vstack([squeezed, high.vertices]), np.vstack([low.triangles, high.triangles + 8])
    )
    hub_solids = SolidsOnHub(
        "part", (Group(Base("the hub", HUBS["cylinder"], np.eye(4)), (body,)),), 0.0
    )

    def lengths_of_layer(layer, **values):
        parameters = {
            "layer_height": 4.0,
            "bead_spacing": 1.0,
            "fill": "lines",
            "chord_error": 0.05,
            **values,
        }
        beads = (
            plan_solids(
                hub_solids,
                DevelopableParameters(**parameters),
                BuildDirectionParameters(),
                ProcessParameters(),
                None,
            )
            .layers[layer]
            .beads
        )
        angle = [math.atan2(*bead.points.mean(axis=0)[1::-1]) for bead in beads]
        return [
            sum(b.length for b, a in zip(beads, angle) if (a < 0.55) == lower)
            for lower in (True, False)
        ]

    top = 6  # 24 mm above the hub; the lower top is at 56 mm or slightly less
    solid_lengths, sparse_lengths = (
        lengths_of_layer(top),
        lengths_of_layer(top, fill_density=0.2, solid_layers=1),
    )
    assert (
        sparse_lengths[0] == pytest.approx(solid_lengths[0], rel=0.02)
        and sparse_lengths[1] < 0.5 * solid_lengths[1]
    )
    beside, under = (
        lengths_of_layer(top - 2),
        lengths_of_layer(top - 2, fill_density=0.2, solid_layers=1),
    )
    assert under[0] < 0.5 * beside[0] and under[1] < 0.5 * beside[1]


@pytest.mark.parametrize("hub", HUBS)
def test_connected_contours_start_once_and_narrow_places_run_faster(hub):
    """One closed bead per solid and layer; the wire per mm follows its width."""
    path = planned(
        hub,
        (0.3, 2.4),
        31.0,
        fill="connected",
        bead_spacing=5.0,
        order="around-axis",
        layer_height=6.0,
    )
    usual = planned(
        hub,
        (0.3, 2.4),
        31.0,
        fill="contours",
        bead_spacing=5.0,
        order="around-axis",
        layer_height=6.0,
    )
    assert [len(layer.beads) for layer in path.layers[:4]] == [2] * min(4, len(path.layers))
    assert all(
        bead.closed and bead.role.kind == "connected"
        for layer in path.layers[:4]
        for bead in layer.beads
    )
    assert path.bead_count < 0.4 * usual.bead_count
    narrow = 0
    for _, _, bead in path:
        if bead.width is None:
            assert np.unique(bead.speed) == pytest.approx([6.0])
            continue
        assert bead.width.max() == pytest.approx(5.0) and bead.width.min() > 1.4
        middle = 0.5 * (bead.width[1:] + bead.width[:-1])
        even = np.abs(np.diff(bead.width)) < 1e-9
        assert bead.speed[1:][even] * middle[even] == pytest.approx(6.0 * 5.0)
        steps = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        nominal_speed = 6.0 * 5.0 / bead.width  # at the points; the acceleration limit is 500 mm/s2
        assert (np.abs(np.diff(nominal_speed**2)) <= 2.0 * 500.0 * steps * 1.01 + 1e-9).all()
        narrow += int((bead.width < 4.0).sum())
    assert narrow > 0
