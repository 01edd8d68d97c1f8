# SPDX-License-Identifier: LGPL-2.1-or-later
"""Settings by place: beads are cut where they change, judged point by point without the search."""

import os

import numpy as np
import pytest

from freecad_am.core.geometry.obstacles import Body, box
from freecad_am.core.issues import InputError
from freecad_am.core.parameters.process import ProcessParameters
from freecad_am.core.parameters.settings import SETTINGS, Setting
from freecad_am.core.strategies.by_place import UNUSED_CODE, Zone, apply_settings
from freecad_am.core.toolpath import Bead, BeadRole, Layer, Toolpath

UP = np.array([0.0, 0.0, 1.0])
SIZE = 40.0


def winding(body, points):
    """Winding numbers (n,) of a body about points (Van Oosterom and Strackee 1983)."""
    corners = body.vertices[body.triangles][None] - points[:, None, None]
    a, b, c = (corners[:, :, k] for k in range(3))
    u, v, w = (np.linalg.norm(side, axis=2) for side in (a, b, c))
    below = u * v * w + (a * b).sum(2) * w + (b * c).sum(2) * u + (c * a).sum(2) * v
    above = (a * np.cross(b, c)).sum(2)
    return np.arctan2(above, below).sum(axis=1) / (2.0 * np.pi)


def away(faces, points):
    """Distances (n,) of points from triangles, by nearest points on planes and edges."""
    nearest = np.full(len(points), np.inf)
    for a, b, c in faces:
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal)
        height = (points - a) @ normal
        foot = points - height[:, None] * normal
        inside = np.ones(len(points), dtype=bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.cross(q - p, foot - p) @ normal >= 0.0
            share = np.clip((points - p) @ (q - p) / ((q - p) @ (q - p)), 0.0, 1.0)
            nearest = np.minimum(
                nearest, np.linalg.norm(points - p - share[:, None] * (q - p), axis=1)
            )
        nearest = np.where(inside, np.minimum(nearest, np.abs(height)), nearest)
    return nearest


def holds(setting, zone, layer, points, ground):
    """Whether a setting holds at points (n, 3) of a layer, tested one condition after the other."""
    held = np.ones(len(points), dtype=bool)
    for end, sign, value in (
        (setting.first_layer, 1.0, float(layer)),
        (setting.last_layer, -1.0, float(layer)),
        (setting.low, 1.0, points[:, 2] - ground),
        (setting.high, -1.0, points[:, 2] - ground),
    ):
        if end is not None:
            held &= sign * (value - end) >= -1e-6
    if setting.box is not None:
        held &= (points >= np.array(setting.box[:3]) - 1e-6).all(axis=1)
        held &= (points <= np.array(setting.box[3:]) + 1e-6).all(axis=1)
    if zone.solid is not None:
        held &= np.abs(winding(zone.solid, points)) > 0.5
    if zone.faces is not None:
        held &= away(zone.faces, points) <= setting.within
    return held


def spiral(rng, layer, closed):
    """A bead of random shape in a layer, flat or rising."""
    count = int(rng.integers(3, 60))
    angle = np.linspace(0.0, 2.0 * np.pi * rng.uniform(0.3, 1.0), count)
    if closed:
        angle = np.linspace(0.0, 2.0 * np.pi, count + 3)
    radius = rng.uniform(3.0, 18.0) * (1.0 + 0.3 * np.sin(rng.integers(1, 5) * angle))
    height = 2.0 * layer + (0.0 if closed or rng.random() < 0.5 else rng.uniform(0.0, 0.5)) * angle
    middle = rng.uniform(0.0, SIZE, 2)
    points = np.column_stack(
        [middle[0] + radius * np.cos(angle), middle[1] + radius * np.sin(angle), height + 0 * angle]
    )
    if closed:
        points[-1] = points[0]
    across = np.tile(UP, (len(points), 1))
    arc = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))]
    speed = np.full(len(points), 6.0)
    name = "first_layer" if layer == 0 else ("contour", "fill")[rng.integers(2)]
    return Bead(points, across, across, arc, speed, closed, role=BeadRole(bead_class=name))


def random_toolpath(rng):
    layers = tuple(
        Layer(tuple(spiral(rng, k, rng.random() < 0.5) for _ in range(rng.integers(1, 3))))
        for k in range(int(rng.integers(1, 5)))
    )
    return Toolpath(layers, np.eye(4), 2.0, 0.01)


def turned(rng):
    pose = np.eye(4)
    basis, upper = np.linalg.qr(rng.normal(size=(3, 3)))
    basis *= np.sign(np.diag(upper))
    basis[:, 0] *= np.sign(np.linalg.det(basis))
    pose[:3, :3], pose[:3, 3] = basis, rng.uniform([-5.0, -5.0, -2.0], [SIZE, SIZE, 10.0])
    return pose


def round_body(rng):
    """A sphere of triangles, which is no box; from points on it by its own hull."""
    from scipy.spatial import ConvexHull

    directions = rng.normal(size=(60, 3))
    points = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    hull = ConvexHull(points)
    triangles = hull.simplices.copy()
    outwards = np.einsum(
        "nk,nk->n",
        np.cross(
            points[triangles[:, 1]] - points[triangles[:, 0]],
            points[triangles[:, 2]] - points[triangles[:, 0]],
        ),
        hull.equations[:, :3],
    )
    triangles[outwards < 0.0] = triangles[outwards < 0.0][:, ::-1]
    middle = rng.uniform([0.0, 0.0, -2.0], [SIZE, SIZE, 10.0])
    return Body("zone", middle + rng.uniform(0.5, 15.0) * points, triangles)


def random_setting(rng):
    """A setting of one to three conditions and its zone; zones may be outside, empty or whole."""
    fields, zone = {}, Zone()
    kinds = rng.choice(5, size=int(rng.integers(1, 4)), replace=False)
    for kind in kinds.tolist():
        if kind == 0:
            low, high = np.sort(rng.integers(0, 6, 2)).tolist()
            fields |= {"first_layer": low, "last_layer": high}
        elif kind == 1:
            low, high = np.sort(rng.uniform(0.0, 10.0, 2)).tolist()
            fields |= {"low": low} if rng.random() < 0.3 else {"low": low, "high": high}
        elif kind == 2 and "inside" not in fields:
            low = rng.uniform([-20.0, -20.0, -5.0], [SIZE, SIZE, 8.0])
            fields["box"] = (*low, *(low + rng.uniform(0.01, 40.0, 3)))
        elif kind == 3 and "box" not in fields:
            fields["inside"] = "zone"
            solid = round_body(rng)
            if rng.random() < 0.5:
                solid = box(tuple(rng.uniform(1.0, 30.0, 3)), turned(rng), "zone")
            zone = zone._replace(solid=solid)
        elif kind == 4:
            faces = rng.uniform([0.0, 0.0, -3.0], [SIZE, SIZE, 12.0], (rng.integers(1, 5), 3, 3))
            fields |= {"faces": ("Face1",), "within": float(rng.uniform(0.2, 20.0))}
            zone = zone._replace(faces=faces)
    if not fields:
        fields["first_layer"] = 1
    return Setting(**fields, travel_speed=float(rng.uniform(1.0, 20.0))), zone


def check_round(rng):
    toolpath = random_toolpath(rng)
    settings, zones = zip(*(random_setting(rng) for _ in range(int(rng.integers(1, 5)))))
    process = ProcessParameters(settings=settings)
    placed = apply_settings(toolpath, process, zones, UP)
    ground = min(bead.points[:, 2].min() for _, _, bead in toolpath)
    met = 0
    for (layer, number, before), (_, _, bead) in zip(toolpath, placed, strict=True):
        assert abs(bead.length - before.length) < 1e-9 * max(1.0, before.length)
        assert np.array_equal(bead.points[[0, -1]], before.points[[0, -1]])
        assert bead.closed == before.closed and bead.role == before.role
        size = np.linalg.norm(np.diff(bead.points, axis=0), axis=1)
        if len(bead) > len(before):
            assert size.min() > 2e-3
        wide = size > 0.02
        own = (np.zeros(len(size)) if bead.settings is None else bead.settings[1:])[wide]
        for share in (0.0, 0.5, 1.0):
            clear = np.clip(share * size[wide], 6e-3, size[wide] - 6e-3) / size[wide]
            points = bead.points[:-1][wide]
            points = points + clear[:, None] * np.diff(bead.points, axis=0)[wide]
            expected = np.zeros(len(points), dtype=int)
            for k, (setting, zone) in enumerate(zip(settings, zones)):
                expected |= holds(setting, zone, layer, points, ground).astype(int) << k
            assert np.array_equal(own, expected), (layer, number)
        for k in range(len(settings)):
            met |= int((own.astype(int) & 1 << k).any()) << k
        last = [max((k for k in range(4) if int(h) >> k & 1), default=None) for h in own]
        wanted = [6.0 if k is None else settings[k].travel_speed for k in last]
        assert np.allclose(bead.speed[1:][wide], wanted)
    unused = sum(issue.code == UNUSED_CODE for issue in placed.issues)
    assert unused <= len(settings) - bin(met).count("1")
    return met


def test_pieces_have_the_settings_of_their_place_and_beads_their_length():
    rng = np.random.default_rng(20261130)
    met = sum(check_round(rng) > 0 for _ in range(300))
    assert met > 100  # most rounds meet a place


@pytest.mark.long
def test_ten_thousand_random_settings():
    rng = np.random.default_rng(int(os.environ.get("ROBUST_SEED", "7")))
    for _ in range(4000):  # 2.5 settings a round on average
        check_round(rng)


def test_the_notation_of_panels_and_the_json_of_documents_keep_settings():
    rng = np.random.default_rng(3)
    texts = "layers 0 to 4: travel_speed 4, schedule 3; layers from 7: weave 0; height to 5 and inside Zone: lead_on 0.5"
    settings = SETTINGS.read(texts)
    assert settings[0] == Setting(first_layer=0, last_layer=4, travel_speed=4.0, schedule=3)
    assert settings[1] == Setting(first_layer=7, weave=0)
    assert settings[2] == Setting(high=5.0, inside="Zone", lead_on=0.5)
    some = tuple(random_setting(rng)[0] for _ in range(100))
    for group in (settings, some):
        assert SETTINGS.read(SETTINGS.to_json(group)) == group
        again = SETTINGS.read(SETTINGS.text(group))
        for one, other in zip(group, again, strict=True):
            assert one.conditions() == other.conditions()
            assert one.own_values().keys() == other.own_values().keys()
    for wrong in (
        "layers 0 to 4",
        "somewhere: weave 1",
        "layers 4 to 0: weave 1",
        "layers 0: bead_width 2",
    ):
        with pytest.raises(InputError):
            SETTINGS.read(wrong)


def test_an_open_mesh_has_no_inside():
    solid = box((5.0, 5.0, 5.0), np.eye(4), "zone")
    process = ProcessParameters(settings=(Setting(inside="zone", weave=1),))
    zone = Zone(Body("zone", solid.vertices, solid.triangles[1:]))
    with pytest.raises(InputError) as error:
        apply_settings(random_toolpath(np.random.default_rng(1)), process, (zone,), UP)
    assert error.value.code == "OPEN_MESH"
